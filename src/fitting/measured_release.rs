//! Measured releases and the places that they are from.

use crate::shooter::{Location, Nominal};
use nalgebra::SMatrix;

/// Speed, pitch angle, polar angle, backspin; m/s, rad, rad, rad/s.
pub type Values = [f64; 4];

/// A covariance of [`Values`].
pub type Covariance = SMatrix<f64, 4, 4>;

/// The names of the values.
pub const VALUE_NAMES: [&str; 4] = ["speed", "pitch", "polar", "backspin"];

/// Where shots are released.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// On the court.
    pub location: Location,
    /// Height of the ball's centre above the floor, m.
    pub release_height_m: f64,
}

/// One measured release.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRelease {
    /// The line or row of the file.
    pub row: u64,
    /// Index of its place.
    pub place: usize,
    /// What was measured. Where the backspin was not, the model has three values.
    pub values: Values,
    /// The covariance of the measurement's error.
    pub noise: Covariance,
    /// Whether the shot went in, where that is known.
    pub made: Option<bool>,
}

/// A nominal shot with these values.
#[must_use]
pub fn nominal_of(values: &Values) -> Nominal {
    let [speed_m_s, pitch_rad, polar_rad, backspin_rad_s] = *values;
    Nominal {
        speed_m_s,
        pitch_rad,
        polar_rad,
        backspin_rad_s,
        rifle_spin_rad_s: 0.0,
        side_spin_rad_s: 0.0,
    }
}

/// The values of a nominal shot.
#[must_use]
pub fn values_of(nominal: &Nominal) -> Values {
    [
        nominal.speed_m_s,
        nominal.pitch_rad,
        nominal.polar_rad,
        nominal.backspin_rad_s,
    ]
}
