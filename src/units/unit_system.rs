//! The unit systems that results are printed in.

use super::constants::{FOOT_M, INCH_M};
use serde::Serialize;

/// Units of tables and files. Angles are in degrees and spins in rev/s in both.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum UnitSystem {
    /// ft, ft/s, in.
    #[default]
    Imperial,
    /// m, m/s, cm.
    Metric,
}

impl UnitSystem {
    /// Suffix and size (m) of the unit of length.
    #[must_use]
    pub fn length(self) -> (&'static str, f64) {
        match self {
            Self::Imperial => ("ft", FOOT_M),
            Self::Metric => ("m", 1.0),
        }
    }

    /// Suffix and size (m) of the unit of short lengths.
    #[must_use]
    pub fn short_length(self) -> (&'static str, f64) {
        match self {
            Self::Imperial => ("in", INCH_M),
            Self::Metric => ("cm", 0.01),
        }
    }
}
