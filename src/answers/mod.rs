//! Answers to the questions of players, coaches and robot builders, as plain data in SI units.
//!
//! Text, JSON, CSV, HTML and Python are renderings of them; nothing is read back from a sentence.
//! Each question has a file. [`json::in_units`] makes the JSON that the program prints.

pub mod advice;
pub mod best_shots;
pub mod json;
pub mod physics;
pub mod probability;
