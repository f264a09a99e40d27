//! The nominal shots whose probabilities a table gives.

use crate::math::evenly_spaced::Linspace;
use crate::shooter::{Nominal, NominalVariable};
use serde::Serialize;

/// A grid of nominal shots.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NominalGrid {
    /// Speeds, m/s.
    pub speed: Linspace,
    /// Pitch angles, rad.
    pub pitch: Linspace,
    /// Polar angles, rad.
    pub polar: Linspace,
    /// Backspins, rad/s.
    pub backspin: Linspace,
    /// Spin about the horizontal direction of the shot, the same for all, rad/s.
    pub rifle_spin_rad_s: f64,
    /// Spin about the vertical, the same for all, rad/s.
    pub side_spin_rad_s: f64,
}

impl NominalGrid {
    /// The values of one variable.
    #[must_use]
    pub fn axis(&self, variable: NominalVariable) -> Linspace {
        match variable {
            NominalVariable::Speed => self.speed,
            NominalVariable::Pitch => self.pitch,
            NominalVariable::Polar => self.polar,
            NominalVariable::Backspin => self.backspin,
            NominalVariable::SideSpin => Linspace::single(self.side_spin_rad_s),
            NominalVariable::RifleSpin => Linspace::single(self.rifle_spin_rad_s),
        }
    }

    /// Whether a nominal shot lies at an end of an axis beyond which the grid `next` would reach.
    #[must_use]
    pub fn is_at_edge(&self, nominal: &Nominal, next: &Self) -> bool {
        NominalVariable::TABLE_AXES.into_iter().any(|variable| {
            let (here, next) = (self.axis(variable), next.axis(variable));
            let x = nominal.get(variable);
            let width = here.high - here.low;
            let (tolerance, beyond) = (1e-6 * width, 0.25 * width);
            (x <= here.low + tolerance && next.low < here.low - beyond)
                || (x >= here.high - tolerance && next.high > here.high + beyond)
        })
    }
}
