//! Answers to the questions of players, coaches and robot builders, as plain data in SI units.
//!
//! Text, JSON, CSV, HTML and Python are renderings of them; nothing is read back from a sentence.
//! Each question has a file. [`json::in_units`] makes the JSON that the program prints.

pub mod advice;
pub mod along_variable;
pub mod best_shots;
pub mod checks;
pub mod csv;
pub mod fit;
pub mod json;
pub mod nominal_shot;
pub mod physics;
pub mod probability;
pub mod rebounds;
pub mod requests;
pub mod sample_size;
#[cfg(test)]
mod schema;
pub mod sessions;
pub mod shot_file;
pub mod swarm;
pub mod sweep_status;
pub mod table_rows;
pub mod trace;
