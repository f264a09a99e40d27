//! What a constant error of the tracker does to measured releases.
//!
//! A sensor that reads the entry angle of every landing 3 deg too steep does not make every release
//! steeper by the same: the ball still came down where it was seen. So the error is taken off the
//! landing, shot by shot.

use super::draw_probabilities::lagrange;
use super::landing::{jacobian, landing_of, release_of_landing};
use super::measured_release::{Place, Values};
use super::prior::ConstantErrorPrior;
use crate::dynamics::Simulator;
use nalgebra::{Matrix3, Vector3};

/// Errors of the entry angle, in scales, for which releases are found; those between are
/// interpolated.
const NODES: [f64; 5] = [-4.0, -2.0, 0.0, 2.0, 4.0];
/// An error beyond this, in scales, is taken as this.
const MOST: f64 = 5.0;

/// Constant errors of depth, left and right, and entry angle, or of speed, pitch and polar angle,
/// in scales of their prior.
#[derive(Clone, Debug)]
pub(super) struct ConstantErrors {
    pub(super) scales: Vector3<f64>,
    /// The weight of each node in the last of them: the same for all shots.
    weights: [f64; NODES.len()],
}

impl From<Vector3<f64>> for ConstantErrors {
    fn from(scales: Vector3<f64>) -> Self {
        Self {
            scales,
            weights: lagrange(&NODES, scales.z.clamp(-MOST, MOST)),
        }
    }
}

/// How speed, pitch and polar angle of a measured release change when a constant error is taken
/// off.
pub(super) struct Correction {
    /// For an error of one scale of each value.
    linear: Matrix3<f64>,
    /// For errors of the entry angle at the nodes.
    of_entry_angle: Option<[Vector3<f64>; NODES.len()]>,
    /// How deviations from the release turn at the nodes.
    turns: Option<[Matrix3<f64>; NODES.len()]>,
}

impl Correction {
    /// That of a release from a place. A release that has no such landing is not changed.
    pub(super) fn new(
        simulator: &Simulator,
        place: &Place,
        values: &Values,
        prior: Option<ConstantErrorPrior>,
    ) -> Self {
        let none = Self {
            linear: Matrix3::zeros(),
            of_entry_angle: None,
            turns: None,
        };
        match prior {
            None => none,
            Some(ConstantErrorPrior::Release(scales)) => Self {
                linear: -Matrix3::from_diagonal(&scales.into()),
                ..none
            },
            Some(ConstantErrorPrior::Landing(scales)) => {
                Self::of_landing(simulator, place, values, scales).unwrap_or(none)
            }
        }
    }

    fn of_landing(
        simulator: &Simulator,
        place: &Place,
        values: &Values,
        [depth, right, entry]: [f64; 3],
    ) -> Option<Self> {
        let own = jacobian(simulator, place, values)?;
        let landing = landing_of(simulator, place, values)?;
        let at = |t: f64| -> Option<(Vector3<f64>, Matrix3<f64>)> {
            let mut corrected = landing;
            corrected.entry_angle_rad -= t * entry;
            let found = release_of_landing(simulator, place, &corrected, &[0.0; 3], values[3]);
            let (found, _) = found.ok()?;
            let turn = jacobian(simulator, place, &found)?.try_inverse()? * own;
            Some((Vector3::from_fn(|i, _| found[i] - values[i]), turn))
        };
        let mut of_entry_angle = [Vector3::zeros(); NODES.len()];
        let mut turns = [Matrix3::zeros(); NODES.len()];
        for (k, t) in NODES.into_iter().enumerate() {
            (of_entry_angle[k], turns[k]) = at(t)?;
        }
        let scales = Matrix3::from_diagonal(&Vector3::new(depth, right, 0.0));
        Some(Self {
            linear: -own.try_inverse()? * scales,
            of_entry_angle: Some(of_entry_angle),
            turns: Some(turns),
        })
    }

    /// The change for errors of so many scales.
    pub(super) fn change(&self, errors: &ConstantErrors) -> Vector3<f64> {
        let along = self.of_entry_angle.map_or_else(Vector3::zeros, |nodes| {
            let each = nodes.iter().zip(errors.weights);
            each.map(|(change, weight)| change * weight).sum()
        });
        self.linear * errors.scales + along
    }

    /// How deviations from the release turn for errors of so many scales.
    pub(super) fn turn(&self, errors: &ConstantErrors) -> Matrix3<f64> {
        self.turns.map_or_else(Matrix3::identity, |nodes| {
            let each = nodes.iter().zip(errors.weights);
            each.map(|(turn, weight)| turn * weight).sum()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Preset;
    use crate::shooter::Location;
    use crate::units::{DEGREE_RAD, FOOT_M, INCH_M};

    /// Authority: the landing itself. The corrected release comes down at the same depth, as much
    /// flatter as the sensor read too steep.
    #[test]
    fn val_a_corrected_release_lands_where_it_was_seen() {
        let simulator = Simulator::new(&Preset::named("ncaa").unwrap().physics()).unwrap();
        let place = Place {
            location: Location {
                distance_m: 13.75 * FOOT_M,
                angle_rad: 0.0,
            },
            release_height_m: 7.0 * FOOT_M,
        };
        let scales = [0.5 * INCH_M, 0.5 * INCH_M, 1.5 * DEGREE_RAD];
        for (pitch_deg, errors) in [(48.0, [0.0, 0.0, 1.3]), (54.0, [1.0, -2.0, -3.1])] {
            let values = [24.1 * FOOT_M, pitch_deg * DEGREE_RAD, 0.01, 14.0];
            let prior = Some(ConstantErrorPrior::Landing(scales));
            let correction = Correction::new(&simulator, &place, &values, prior);
            let change = correction.change(&Vector3::from(errors).into());
            let corrected =
                std::array::from_fn(|i| values[i] + if i < 3 { change[i] } else { 0.0 });
            let [seen, true_one] =
                [values, corrected].map(|values| landing_of(&simulator, &place, &values).unwrap());
            let read = [
                (seen.depth_m - true_one.depth_m) / scales[0],
                (seen.right_m - true_one.right_m) / scales[1],
                (seen.entry_angle_rad - true_one.entry_angle_rad) / scales[2],
            ];
            for (read, wanted) in read.iter().zip(errors) {
                assert!((read - wanted).abs() < 0.1, "{read} {wanted}");
            }
        }
    }
}
