//! Measured releases and the places that they are from.

use crate::dynamics::Release;
use crate::shooter::{Location, Nominal, Profile};
use nalgebra::{Matrix3, SMatrix, Vector3};

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

/// How far the releases of one place lie apart: standard deviations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaceScatter {
    /// Distance from the hoop's centre, m.
    pub distance_m: f64,
    /// Court angle, rad.
    pub court_angle_rad: f64,
    /// Height above the floor, m.
    pub height_m: f64,
}

/// The path of a shot that began elsewhere than at the place of its group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OwnPath {
    /// Where it began.
    pub place: Place,
    /// Its release there.
    pub values: Values,
    /// How speed, pitch and polar angle there change with those at the place of the group, for
    /// equal changes of the landing.
    pub change: Matrix3<f64>,
}

/// One measured release.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRelease {
    /// The line or row of the file.
    pub row: u64,
    /// Index of its place.
    pub place: usize,
    /// The release from its place that lands as the shot did. Where the backspin was not measured,
    /// the model has three values.
    pub values: Values,
    /// The covariance of the measurement's error.
    pub noise: Covariance,
    /// Whether the shot went in, where that is known.
    pub made: Option<bool>,
    /// Its own path, where it began elsewhere than at its place.
    pub own: Option<OwnPath>,
}

/// The shots of each place, in their order.
pub(super) fn by_place(shots: &[MeasuredRelease], places: usize) -> Vec<Vec<&MeasuredRelease>> {
    let mut of_places = vec![Vec::new(); places];
    for shot in shots {
        of_places[shot.place].push(shot);
    }
    of_places
}

impl MeasuredRelease {
    /// The release on the shot's own path where that at its place has these values; `profile` is
    /// that of the place.
    #[must_use]
    pub fn release(&self, profile: &Profile, values: &Values) -> Release {
        let Some(own) = &self.own else {
            return profile.release(&nominal_of(values));
        };
        let change = own.change * Vector3::from_fn(|i, _| values[i] - self.values[i]);
        let values: Values = std::array::from_fn(|i| {
            if i < 3 {
                own.values[i] + change[i]
            } else {
                values[i]
            }
        });
        Release {
            distance_m: own.place.location.distance_m,
            court_angle_rad: own.place.location.angle_rad,
            height_above_hoop_m: own.place.release_height_m
                - profile.physics().hoop_plane_height_m(),
            ..profile.release(&nominal_of(&values))
        }
    }
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
