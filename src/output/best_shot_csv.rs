//! The best shots, their probability curves and their sensitivity as CSV.

use super::best_shot_json::shot_record;
use crate::analysis::sensitivity::Difference;
use crate::best_shot::BestShots;
use crate::shooter::{NominalVariable, Profile};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem, rounded};
use serde_json::Value;

/// The header of [`curves_csv`].
pub const CURVES_HEADER: [&str; 6] = [
    "kind",
    "variable",
    "unit",
    "value",
    "probability",
    "standard_error",
];
/// The header of [`sensitivity_csv`].
pub const SENSITIVITY_HEADER: [&str; 7] = [
    "kind",
    "topic",
    "variable",
    "unit",
    "value",
    "gain",
    "standard_error",
];

/// A CSV text in memory.
struct MemoryCsv(csv::Writer<Vec<u8>>);

impl MemoryCsv {
    fn new() -> Self {
        Self(csv::Writer::from_writer(Vec::new()))
    }

    fn row<T: AsRef<[u8]>>(&mut self, fields: impl IntoIterator<Item = T>) {
        // Writing to memory does not fail.
        let _ = self.0.write_record(fields);
    }

    fn into_bytes(self) -> Vec<u8> {
        self.0.into_inner().unwrap_or_default()
    }
}

/// The unit of a nominal variable and its size in SI units.
fn unit_of(variable: NominalVariable, units: UnitSystem) -> (String, f64) {
    let (long, metre) = units.length();
    match variable {
        NominalVariable::Speed => (format!("{long}/s"), metre),
        NominalVariable::Pitch | NominalVariable::Polar => ("deg".to_owned(), DEGREE_RAD),
        NominalVariable::Backspin | NominalVariable::SideSpin | NominalVariable::RifleSpin => {
            ("rev/s".to_owned(), REV_RAD)
        }
    }
}

/// The best shots: one row for each kind that was found.
#[must_use]
pub fn best_shots_csv(profile: &Profile, best: &BestShots, units: UnitSystem) -> Vec<u8> {
    let mut csv = MemoryCsv::new();
    let mut has_header = false;
    for (kind, shot) in best.by_kind() {
        let Ok(shot) = shot else { continue };
        let record = shot_record(profile, shot, units);
        if !has_header {
            let names = record.iter().map(|(name, _)| name.as_str());
            csv.row(std::iter::once("kind").chain(names));
            has_header = true;
        }
        let cells = record.iter().map(|(_, value)| match value {
            Value::String(text) => text.clone(),
            Value::Null => String::new(),
            other => other.to_string(),
        });
        csv.row(std::iter::once(kind.name().to_owned()).chain(cells));
    }
    csv.into_bytes()
}

/// P along each variable of the best shots, with the columns of [`CURVES_HEADER`].
#[must_use]
pub fn curves_csv(best: &BestShots, units: UnitSystem) -> Vec<u8> {
    let mut csv = MemoryCsv::new();
    csv.row(CURVES_HEADER);
    for (kind, shot) in best.by_kind() {
        let Ok(shot) = shot else { continue };
        for curve in &shot.curves {
            let (unit, scale) = unit_of(curve.variable, units);
            for point in &curve.points {
                let words = [kind.name(), curve.variable.name(), &unit].map(str::to_owned);
                let numbers = [point.value / scale, point.probability, point.standard_error];
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

/// The sensitivity of the best shots, with the columns of [`SENSITIVITY_HEADER`]. The gains are
/// differences of P. The topic is `window_low` or `window_high` (no gain), `without` or
/// `a_tenth_less` error in the variable, or another `backspin` or `release_height`.
#[must_use]
pub fn sensitivity_csv(best: &BestShots, units: UnitSystem) -> Vec<u8> {
    let (long, metre) = units.length();
    let mut csv = MemoryCsv::new();
    csv.row(SENSITIVITY_HEADER);
    for (kind, shot) in best.by_kind() {
        let Ok(shot) = shot else { continue };
        let sensitivity = &shot.sensitivity;
        let mut row = |topic: &str,
                       variable: &str,
                       unit: &str,
                       value: Option<f64>,
                       gain: Option<&Difference>| {
            let numbers = [
                value,
                gain.map(|gain| gain.value),
                gain.map(|gain| gain.standard_error),
            ]
            .map(|x| x.map_or_else(String::new, |x| rounded(x).to_string()));
            let words = [kind.name(), topic, variable, unit].map(str::to_owned);
            csv.row(words.iter().chain(&numbers));
        };
        for window in &sensitivity.windows {
            let (unit, scale) = unit_of(window.variable, units);
            let name = window.variable.name();
            let low = window.ends.map(|ends| ends.0 / scale);
            let high = window.ends.map(|ends| ends.1 / scale);
            row("window_low", name, &unit, low, None);
            row("window_high", name, &unit, high, None);
        }
        for cost in &sensitivity.errors {
            let name = cost.variable.name();
            row("without", name, "", None, Some(&cost.without));
            row("a_tenth_less", name, "", None, Some(&cost.a_tenth_less));
        }
        for spin in &sensitivity.backspins {
            let value = Some(spin.value / REV_RAD);
            row("backspin", "backspin", "rev/s", value, Some(&spin.gain));
        }
        for height in &sensitivity.heights {
            let value = Some(height.value / metre);
            row("release_height", "height", long, value, Some(&height.gain));
        }
    }
    csv.into_bytes()
}
