//! Results for people and programs: tables and records with units in their names, and files that
//! are complete or absent.

pub mod best_shot_csv;
pub mod best_shot_text;
pub mod fit_files;
pub mod layout;
pub mod physics_text;
pub mod probability_along_variable;
pub mod probability_text;
pub mod rebounds_text;
pub mod sensitivity_rows;
pub mod shot_note_text;
pub mod shot_table_files;
pub mod simulation_files;
pub mod words;
