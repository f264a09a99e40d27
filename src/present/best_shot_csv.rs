//! The best shots, their probability curves and their sensitivity as CSV.

use super::sensitivity_rows::sensitivity_rows;
use crate::answers::best_shots::ShotAnswer;
use crate::answers::json::in_units;
use crate::best_shot::BestShots;
use crate::files::csv_text::CsvText;
use crate::shooter::Profile;
use crate::units::{UnitSystem, rounded};
use serde_json::Value;

/// The header of [`curves_csv`].
const CURVES_HEADER: [&str; 6] = [
    "kind",
    "variable",
    "unit",
    "value",
    "probability",
    "standard_error",
];
/// The header of [`sensitivity_csv`].
const SENSITIVITY_HEADER: [&str; 7] = [
    "kind",
    "topic",
    "variable",
    "unit",
    "value",
    "gain",
    "standard_error",
];

/// The best shots: one row for each kind that was found.
#[must_use]
pub fn best_shots_csv(profile: &Profile, best: &BestShots, units: UnitSystem) -> Vec<u8> {
    let mut csv = CsvText::default();
    let mut has_header = false;
    for (kind, shot) in best.by_kind() {
        let Ok(shot) = shot else { continue };
        let Value::Object(record) = in_units(&ShotAnswer::new(profile, shot), units) else {
            continue;
        };
        if !has_header {
            let names = record.keys().map(String::as_str);
            csv.row(std::iter::once("kind").chain(names));
            has_header = true;
        }
        let cells = record.values().map(|value| match value {
            Value::String(text) => text.clone(),
            Value::Null => String::new(),
            other => other.to_string(),
        });
        csv.row(std::iter::once(kind.name().to_owned()).chain(cells));
    }
    csv.into_bytes()
}

/// P along each variable of the best shots.
#[must_use]
pub fn curves_csv(best: &BestShots, units: UnitSystem) -> Vec<u8> {
    let mut csv = CsvText::default();
    csv.row(CURVES_HEADER);
    for (kind, shot) in best.by_kind() {
        let Ok(shot) = shot else { continue };
        for curve in &shot.curves {
            let unit = units.unit(curve.variable.dimension());
            for point in &curve.points {
                let words = [kind.name(), curve.variable.name(), unit.name].map(str::to_owned);
                let numbers = [
                    point.value / unit.size,
                    point.probability,
                    point.standard_error,
                ];
                csv.row(
                    words
                        .into_iter()
                        .chain(numbers.map(|x| rounded(x).to_string())),
                );
            }
        }
    }
    csv.into_bytes()
}

/// The sensitivity of the best shots. The gains are differences of P. The topic is `window_low` or
/// `window_high` (no gain), `without` or `a_tenth_less` error in the variable, or another
/// `backspin` or `release_height`.
#[must_use]
pub fn sensitivity_csv(best: &BestShots, units: UnitSystem) -> Vec<u8> {
    let mut csv = CsvText::default();
    csv.row(SENSITIVITY_HEADER);
    for (kind, shot) in best.by_kind() {
        let Ok(shot) = shot else { continue };
        for row in sensitivity_rows(&shot.sensitivity, units) {
            let gain = row.gain;
            let numbers = [
                row.value,
                gain.map(|gain| gain.value),
                gain.map(|gain| gain.standard_error),
            ]
            .map(|x| x.map_or_else(String::new, |x| rounded(x).to_string()));
            let words = [kind.name(), row.topic.name(), row.variable, row.unit].map(str::to_owned);
            csv.row(words.iter().chain(&numbers));
        }
    }
    csv.into_bytes()
}
