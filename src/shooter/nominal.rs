//! Nominal shots: what the shooter intends.

use super::release_variable::NominalVariable;
use serde::{Deserialize, Serialize};

/// A nominal shot: the release without errors.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Nominal {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Pitch angle, rad.
    pub pitch_rad: f64,
    /// Polar angle, rad.
    pub polar_rad: f64,
    /// Backspin, rad/s.
    pub backspin_rad_s: f64,
    /// Spin about the horizontal direction of the shot, rad/s.
    pub rifle_spin_rad_s: f64,
    /// Spin about the vertical, rad/s.
    pub side_spin_rad_s: f64,
}

impl Nominal {
    /// The value of a variable, SI units.
    #[must_use]
    pub fn get(&self, variable: NominalVariable) -> f64 {
        let mut copy = *self;
        *copy.get_mut(variable)
    }

    /// The value of a variable, SI units.
    pub fn get_mut(&mut self, variable: NominalVariable) -> &mut f64 {
        match variable {
            NominalVariable::Speed => &mut self.speed_m_s,
            NominalVariable::Pitch => &mut self.pitch_rad,
            NominalVariable::Polar => &mut self.polar_rad,
            NominalVariable::Backspin => &mut self.backspin_rad_s,
            NominalVariable::SideSpin => &mut self.side_spin_rad_s,
            NominalVariable::RifleSpin => &mut self.rifle_spin_rad_s,
        }
    }

    /// The same shot with another value of a variable, SI units.
    #[must_use]
    pub fn with(mut self, variable: NominalVariable, value: f64) -> Self {
        *self.get_mut(variable) = value;
        self
    }
}

/// The values that a profile's `[nominal]` table fixes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct NominalOverrides {
    /// Speed, m/s.
    pub speed_m_s: Option<f64>,
    /// Pitch angle, rad.
    pub pitch_rad: Option<f64>,
    /// Polar angle, rad.
    pub polar_rad: Option<f64>,
    /// Backspin, rad/s.
    pub backspin_rad_s: Option<f64>,
    /// Spin about the horizontal direction of the shot, rad/s.
    pub rifle_spin_rad_s: Option<f64>,
    /// Spin about the vertical, rad/s.
    pub side_spin_rad_s: Option<f64>,
}

impl NominalOverrides {
    /// The whole shot, if speed and pitch angle are fixed: aimed `towards_rad` and without spin
    /// where no other value is.
    #[must_use]
    pub fn whole_shot(&self, towards_rad: f64) -> Option<Nominal> {
        Some(Nominal {
            speed_m_s: self.speed_m_s?,
            pitch_rad: self.pitch_rad?,
            polar_rad: self.polar_rad.unwrap_or(towards_rad),
            backspin_rad_s: self.backspin_rad_s.unwrap_or(0.0),
            rifle_spin_rad_s: self.rifle_spin_rad_s.unwrap_or(0.0),
            side_spin_rad_s: self.side_spin_rad_s.unwrap_or(0.0),
        })
    }

    /// The value of a variable, if it is fixed, SI units.
    #[must_use]
    pub fn get(&self, variable: NominalVariable) -> Option<f64> {
        match variable {
            NominalVariable::Speed => self.speed_m_s,
            NominalVariable::Pitch => self.pitch_rad,
            NominalVariable::Polar => self.polar_rad,
            NominalVariable::Backspin => self.backspin_rad_s,
            NominalVariable::SideSpin => self.side_spin_rad_s,
            NominalVariable::RifleSpin => self.rifle_spin_rad_s,
        }
    }

    /// Fixes a variable, SI units.
    pub fn set(&mut self, variable: NominalVariable, value: f64) {
        let field = match variable {
            NominalVariable::Speed => &mut self.speed_m_s,
            NominalVariable::Pitch => &mut self.pitch_rad,
            NominalVariable::Polar => &mut self.polar_rad,
            NominalVariable::Backspin => &mut self.backspin_rad_s,
            NominalVariable::SideSpin => &mut self.side_spin_rad_s,
            NominalVariable::RifleSpin => &mut self.rifle_spin_rad_s,
        };
        *field = Some(value);
    }
}
