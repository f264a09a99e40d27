//! The columns that a simulation adds to the rows of a file.

use crate::dynamics::Outcome;
use crate::model::SolidId;
use crate::units::DEGREE_RAD;
use parquet::basic::Type as Physical;

/// The columns that a simulation adds.
pub const OUTCOME_COLUMNS: [&str; 8] = [
    "made",
    "kind",
    "contacts",
    "n_board",
    "n_ring",
    "flight_time_s",
    "entry_angle_deg",
    "first_touch_s",
];

/// Their types in Parquet.
pub const OUTCOME_TYPES: [Physical; 8] = [
    Physical::INT64,
    Physical::BYTE_ARRAY,
    Physical::BYTE_ARRAY,
    Physical::INT64,
    Physical::INT64,
    Physical::DOUBLE,
    Physical::DOUBLE,
    Physical::DOUBLE,
];

/// The added cells of a simulated row, in the order of [`OUTCOME_COLUMNS`].
#[must_use]
pub fn outcome_cells(outcome: &Outcome) -> [String; 8] {
    let contacts = &outcome.verdict.contacts;
    [
        u8::from(outcome.verdict.made).to_string(),
        outcome.kind.name().to_owned(),
        contacts.to_string(),
        contacts.count_of(SolidId::Board).to_string(),
        contacts.count_of(SolidId::Ring).to_string(),
        outcome.verdict.time_s.to_string(),
        outcome.entry.map_or_else(String::new, |entry| {
            (entry.angle_rad / DEGREE_RAD).to_string()
        }),
        outcome
            .first_touch_s
            .map_or_else(String::new, |time_s| time_s.to_string()),
    ]
}
