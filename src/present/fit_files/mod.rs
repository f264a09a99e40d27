//! The files and texts of a fitted shooter.

pub mod advice_for_team;
pub mod advice_text;
pub mod change_in_words;
pub mod coach_text;
pub mod fit_checks_text;
pub mod fit_note_text;
pub mod fit_text;
pub mod fitted_profile_toml;
pub mod session_changes_text;
pub mod shots_table;
