//! A table of best shots: as text, CSV, JSON, and as source of a program that interpolates in it.

pub mod by_pitch;
mod columns;
pub mod csv_json;
mod notes;
pub mod pitch_over_distances;
pub mod source_code;
pub mod table_text;
pub mod unfinished;

pub use notes::notes;
