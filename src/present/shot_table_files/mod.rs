//! A table of best shots as text, and as source of a program that interpolates in it. Its CSV and
//! JSON are the rows of `answers/table_rows.rs`.

pub mod by_pitch;
pub mod notes;
pub mod pitch_over_distances;
pub mod source_code;
pub mod table_answer;
pub mod table_text;
pub mod unfinished;

pub use notes::notes;
