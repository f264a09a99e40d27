//! A table of best shots: as text, CSV, JSON, and as source of a program that interpolates in it.

pub mod source_code;
pub mod table_text;
