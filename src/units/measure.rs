//! Values that carry their unit, for data whose names cannot say it.

use super::quantity::Dimension;
use super::unit_system::UnitSystem;
use serde::{Deserialize, Serialize};

/// A value and its unit.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measure {
    /// The unit.
    pub unit: UnitName,
    /// The value in it.
    pub value: f64,
}

impl Measure {
    /// A value in SI units.
    #[must_use]
    pub fn si(value: f64, dimension: Dimension) -> Self {
        Self {
            unit: UnitName::si(dimension),
            value,
        }
    }

    /// The value in SI units.
    #[must_use]
    pub fn in_si(self) -> f64 {
        self.value * self.unit.size()
    }
}

/// The units of results and of SI, by name.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, schemars(with = "String"))]
#[serde(into = "&'static str", try_from = "String")]
pub enum UnitName {
    /// A bare number.
    None,
    /// Metres per second.
    MetresPerSecond,
    /// Feet per second.
    FeetPerSecond,
    /// Radians.
    Radians,
    /// Degrees.
    Degrees,
    /// Radians per second.
    RadiansPerSecond,
    /// Revolutions per second.
    RevolutionsPerSecond,
    /// Metres.
    Metres,
    /// Feet.
    Feet,
    /// Centimetres: short lengths, in SI units and in metric results.
    Centimetres,
    /// Inches.
    Inches,
    /// Seconds per metre.
    SecondsPerMetre,
    /// Seconds per foot.
    SecondsPerFoot,
    /// Per second.
    PerSecond,
}

impl From<UnitName> for &'static str {
    fn from(unit: UnitName) -> Self {
        unit.name()
    }
}

impl TryFrom<String> for UnitName {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let mut all = Self::ALL.into_iter();
        all.find(|unit| unit.name() == name)
            .ok_or_else(|| format!("\"{name}\" is no unit of a result"))
    }
}

impl UnitName {
    /// Every unit.
    const ALL: [Self; 14] = [
        Self::None,
        Self::MetresPerSecond,
        Self::FeetPerSecond,
        Self::Radians,
        Self::Degrees,
        Self::RadiansPerSecond,
        Self::RevolutionsPerSecond,
        Self::Metres,
        Self::Feet,
        Self::Centimetres,
        Self::Inches,
        Self::SecondsPerMetre,
        Self::SecondsPerFoot,
        Self::PerSecond,
    ];

    /// That of SI.
    ///
    /// # Panics
    /// For a dimension that no result has.
    #[must_use]
    pub fn si(dimension: Dimension) -> Self {
        match dimension {
            Dimension::Number => Self::None,
            Dimension::Speed => Self::MetresPerSecond,
            Dimension::Angle => Self::Radians,
            Dimension::Spin => Self::RadiansPerSecond,
            Dimension::Length => Self::Metres,
            Dimension::PerSpeed => Self::SecondsPerMetre,
            other => unreachable!("no result has {other:?}"),
        }
    }

    /// The name, such as `ft/s`; empty for a bare number.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "",
            Self::MetresPerSecond => "m/s",
            Self::FeetPerSecond => "ft/s",
            Self::Radians => "rad",
            Self::Degrees => "deg",
            Self::RadiansPerSecond => "rad/s",
            Self::RevolutionsPerSecond => "rev/s",
            Self::Metres => "m",
            Self::Feet => "ft",
            Self::Centimetres => "cm",
            Self::Inches => "in",
            Self::SecondsPerMetre => "s/m",
            Self::SecondsPerFoot => "s/ft",
            Self::PerSecond => "1/s",
        }
    }

    /// The unit of results for this one.
    #[must_use]
    pub fn in_results(self, units: UnitSystem) -> Self {
        match (self, units) {
            (Self::Radians, _) => Self::Degrees,
            (Self::RadiansPerSecond, _) => Self::RevolutionsPerSecond,
            (Self::MetresPerSecond, UnitSystem::Imperial) => Self::FeetPerSecond,
            (Self::Metres, UnitSystem::Imperial) => Self::Feet,
            (Self::Centimetres, UnitSystem::Imperial) => Self::Inches,
            (Self::SecondsPerMetre, UnitSystem::Imperial) => Self::SecondsPerFoot,
            (other, _) => other,
        }
    }

    /// Its size in SI units.
    #[must_use]
    pub fn size(self) -> f64 {
        let of = |units: UnitSystem, dimension| units.unit(dimension).size;
        match self {
            Self::Degrees => of(UnitSystem::Imperial, Dimension::Angle),
            Self::RevolutionsPerSecond => of(UnitSystem::Imperial, Dimension::Spin),
            Self::FeetPerSecond => of(UnitSystem::Imperial, Dimension::Speed),
            Self::Feet => of(UnitSystem::Imperial, Dimension::Length),
            Self::SecondsPerFoot => of(UnitSystem::Imperial, Dimension::PerSpeed),
            Self::Inches => UnitSystem::Imperial.short_length().1,
            Self::Centimetres => UnitSystem::Metric.short_length().1,
            _ => 1.0,
        }
    }
}
