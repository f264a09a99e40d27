//! What the best shots depend on, one change a row: for the CSV file and for the page.

use crate::analysis::sensitivity::{Difference, Sensitivity};
use crate::units::{REV_RAD, Unit, UnitSystem};

/// One change, and what it gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensitivityRow {
    /// What changes.
    pub topic: Topic,
    /// The variable.
    pub variable: &'static str,
    /// Its unit; empty for none.
    pub unit: &'static str,
    /// The value, in that unit.
    pub value: Option<f64>,
    /// By how much P is greater.
    pub gain: Option<Difference>,
}

/// What changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Topic {
    /// The least value of a variable that goes in without errors.
    WindowLow,
    /// The greatest.
    WindowHigh,
    /// No error in a variable.
    Without,
    /// An error less by a tenth.
    ATenthLess,
    /// Another backspin.
    Backspin,
    /// Another height of the release.
    ReleaseHeight,
}

impl Topic {
    /// Its name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::WindowLow => "window_low",
            Self::WindowHigh => "window_high",
            Self::Without => "without",
            Self::ATenthLess => "a_tenth_less",
            Self::Backspin => "backspin",
            Self::ReleaseHeight => "release_height",
        }
    }
}

/// The rows of a shot's sensitivity.
#[must_use]
pub fn sensitivity_rows(sensitivity: &Sensitivity, units: UnitSystem) -> Vec<SensitivityRow> {
    let mut rows = Vec::new();
    let mut add = |topic, variable, unit, value, gain| {
        rows.push(SensitivityRow {
            topic,
            variable,
            unit,
            value,
            gain,
        });
    };
    for window in &sensitivity.windows {
        let Unit {
            name: unit, size, ..
        } = units.unit(window.variable.dimension());
        let name = window.variable.name();
        let [low, high] = [
            window.ends.map(|ends| ends.0 / size),
            window.ends.map(|ends| ends.1 / size),
        ];
        add(Topic::WindowLow, name, unit, low, None);
        add(Topic::WindowHigh, name, unit, high, None);
    }
    for cost in &sensitivity.errors {
        let name = cost.variable.name();
        add(Topic::Without, name, "", None, Some(cost.without));
        add(Topic::ATenthLess, name, "", None, Some(cost.a_tenth_less));
    }
    for spin in &sensitivity.backspins {
        let value = Some(spin.value / REV_RAD);
        add(Topic::Backspin, "backspin", "rev/s", value, Some(spin.gain));
    }
    let (long, metre) = units.length();
    for height in &sensitivity.heights {
        let value = Some(height.value / metre);
        add(
            Topic::ReleaseHeight,
            "height",
            long,
            value,
            Some(height.gain),
        );
    }
    rows
}
