//! A table of best shots for programs.

use super::notes::{notes, physics_note, shooter_note};
use crate::answers::table_rows::{TableAnswer, TableWords};
use crate::best_shot::ShotTable;
use crate::shooter::Profile;
use crate::units::UnitSystem;

/// The table with what it says of itself.
#[must_use]
pub fn table_answer(table: &ShotTable, profile: &Profile, units: UnitSystem) -> TableAnswer {
    let words = TableWords {
        shooter: shooter_note(table, profile, units),
        physics: physics_note(profile, units),
        notes: notes(table, profile, units),
    };
    TableAnswer::new(table, profile, words)
}
