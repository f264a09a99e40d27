//! The unit systems that results are printed in.

use super::constants::{DEGREE_RAD, FOOT_M, INCH_M, REV_RAD};
use super::quantity::Dimension;
use serde::{Deserialize, Serialize};

/// Units of tables and files. Angles are in degrees and spins in rev/s in both.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum UnitSystem {
    /// ft, ft/s, in.
    #[default]
    Imperial,
    /// m, m/s, cm.
    Metric,
}

/// A unit that results are printed in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Its name, such as `ft/s`; empty for none.
    pub name: &'static str,
    /// What it is in the names of columns and keys, such as `ft_s`.
    pub suffix: &'static str,
    /// Its size in SI units.
    pub size: f64,
}

impl UnitSystem {
    /// The unit of the quantities of a shot.
    ///
    /// # Panics
    /// For a dimension that no result has.
    #[must_use]
    pub fn unit(self, dimension: Dimension) -> Unit {
        let (name, suffix, size) = match (dimension, self) {
            (Dimension::Number, _) => ("", "", 1.0),
            (Dimension::Length, _) => {
                let (name, size) = self.length();
                (name, name, size)
            }
            (Dimension::Speed, Self::Imperial) => ("ft/s", "ft_s", FOOT_M),
            (Dimension::Speed, Self::Metric) => ("m/s", "m_s", 1.0),
            (Dimension::PerSpeed, Self::Imperial) => ("s/ft", "s_ft", 1.0 / FOOT_M),
            (Dimension::PerSpeed, Self::Metric) => ("s/m", "s_m", 1.0),
            (Dimension::Angle, _) => ("deg", "deg", DEGREE_RAD),
            (Dimension::Spin, _) => ("rev/s", "rev_s", REV_RAD),
            (Dimension::Time, _) => ("s", "s", 1.0),
            other => unreachable!("no result has {other:?}"),
        };
        Unit { name, suffix, size }
    }

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
