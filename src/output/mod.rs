//! Results for people and programs: tables and records with units in their names, and files that
//! are complete or absent.

pub mod atomic_file;
pub mod best_shot_csv;
pub mod best_shot_json;
pub mod best_shot_text;
pub mod fit_files;
pub mod json_object;
pub mod probability_along_variable;
pub mod probability_text_json;
pub mod shot_table_files;
pub mod simulation_files;
