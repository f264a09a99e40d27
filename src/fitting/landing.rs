//! Where a shot falls through the height of the hoop, and the release that leads there.

use super::measured_release::{Covariance, OwnPath, Place, Values, nominal_of};
use crate::dynamics::Simulator;
use crate::model::BallState;
use crate::shooter::Nominal;
use crate::units::INCH_M;
use nalgebra::{Matrix3, Vector3};

/// Where and how steeply the ball's centre falls through the height of the hoop, without any touch.
/// Gym sensors report this of a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// Distance from the front of the ring along the line from the release to the hoop's centre, m.
    pub depth_m: f64,
    /// To the right of that line as the shooter sees it, m.
    pub right_m: f64,
    /// Below the horizontal, rad.
    pub entry_angle_rad: f64,
}

/// Why a landing has no release.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("no release from this place lands like this")]
pub struct LandingError;

/// Depth at the hoop's centre in the sensors' scale, m: it runs from 0 at the front to 18 in at the
/// back.
pub const CENTRE_DEPTH_M: f64 = 9.0 * INCH_M;

/// Steps of Newton's method, and where they end: a landing as near as this, m and rad.
const MAX_STEPS: u32 = 60;
const TOLERANCE: f64 = 1e-9;
/// Differences of the derivatives: speed (m/s), pitch and polar angle (rad).
const DIFFERENCES: [f64; 3] = [1e-4, 1e-5, 1e-5];

/// The state at the release of a shot from a place.
pub(super) fn start_of(simulator: &Simulator, place: &Place, values: &Values) -> BallState {
    let Nominal {
        speed_m_s,
        pitch_rad,
        polar_rad,
        backspin_rad_s,
        ..
    } = nominal_of(values);
    crate::dynamics::Release {
        distance_m: place.location.distance_m,
        court_angle_rad: place.location.angle_rad,
        height_above_hoop_m: place.release_height_m - simulator.physics().hoop_plane_height_m(),
        speed_m_s,
        pitch_rad,
        polar_rad,
        backspin_rad_s,
        rifle_spin_rad_s: 0.0,
        side_spin_rad_s: 0.0,
    }
    .state()
}

/// The landing of a release; `None` if it does not rise to the hoop.
#[must_use]
pub fn landing_of(simulator: &Simulator, place: &Place, values: &Values) -> Option<Landing> {
    let start = start_of(simulator, place, values);
    landing_of_state(simulator, &start, place.location.angle_rad)
}

/// The landing of a flight, seen along the line from a place at this court angle to the hoop.
pub(super) fn landing_of_state(
    simulator: &Simulator,
    state: &BallState,
    court_angle_rad: f64,
) -> Option<Landing> {
    let (end, _) = simulator.undisturbed_fall_to_hoop(state)?;
    let (p, v) = (end.position_m, end.velocity_m_s);
    let (sin, cos) = libm::sincos(court_angle_rad);
    Some(Landing {
        depth_m: CENTRE_DEPTH_M - (p.x * cos + p.y * sin),
        right_m: p.y * cos - p.x * sin,
        entry_angle_rad: libm::atan2(-v.z, libm::hypot(v.x, v.y)),
    })
}

pub(super) fn vector(landing: &Landing) -> Vector3<f64> {
    Vector3::new(landing.depth_m, landing.right_m, landing.entry_angle_rad)
}

/// The derivatives of the landing by speed, pitch and polar angle.
pub(super) fn jacobian(
    simulator: &Simulator,
    place: &Place,
    values: &Values,
) -> Option<Matrix3<f64>> {
    let mut columns = Matrix3::zeros();
    for (i, difference) in DIFFERENCES.into_iter().enumerate() {
        let at = |sign: f64| {
            let mut moved = *values;
            moved[i] += sign * difference;
            landing_of(simulator, place, &moved).map(|landing| vector(&landing))
        };
        columns.set_column(i, &((at(1.0)? - at(-1.0)?) / (2.0 * difference)));
    }
    Some(columns)
}

/// The release from a place, with this backspin, that has a landing, and the covariance of its
/// values where those of the landing err independently by `noise` (m, m, rad).
///
/// # Errors
/// No release lands like this.
pub fn release_of_landing(
    simulator: &Simulator,
    place: &Place,
    landing: &Landing,
    noise: &[f64; 3],
    backspin_rad_s: f64,
) -> Result<(Values, Covariance), LandingError> {
    let variances = Vector3::from_fn(|i, _| noise[i] * noise[i]);
    let covariance = Matrix3::from_diagonal(&variances);
    release_of_uncertain_landing(simulator, place, (landing, &covariance), backspin_rad_s)
}

/// The release from a place, with this backspin, that has a landing, and the covariance of its
/// values where the landing (depth, right, entry angle) has this covariance.
///
/// # Errors
/// No release lands like this.
pub fn release_of_uncertain_landing(
    simulator: &Simulator,
    place: &Place,
    (landing, landing_covariance): (&Landing, &Matrix3<f64>),
    backspin_rad_s: f64,
) -> Result<(Values, Covariance), LandingError> {
    let target = vector(landing);
    let mut values = first_guess(simulator, place, landing, backspin_rad_s);
    let mut missed = difference(simulator, place, &values, &target).ok_or(LandingError)?;
    for _ in 0..MAX_STEPS {
        let derivatives = jacobian(simulator, place, &values).ok_or(LandingError)?;
        let inverse = derivatives.try_inverse().ok_or(LandingError)?;
        if missed.norm() < TOLERANCE {
            let small = inverse * landing_covariance * inverse.transpose();
            let mut covariance = Covariance::zeros();
            covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&small);
            return Ok((values, covariance));
        }
        let step = inverse * missed;
        // Shorter until it comes nearer.
        let mut share = 1.0;
        loop {
            let moved = [
                values[0] - share * step.x,
                values[1] - share * step.y,
                values[2] - share * step.z,
                values[3],
            ];
            match difference(simulator, place, &moved, &target) {
                Some(next) if next.norm() < missed.norm() => {
                    (values, missed) = (moved, next);
                    break;
                }
                _ if share < 1e-3 => return Err(LandingError),
                _ => share *= 0.5,
            }
        }
    }
    Err(LandingError)
}

/// The path of a shot that belongs to a group of shots at another place: how its own speed, pitch
/// and polar angle change with those that land alike from the place of the group.
///
/// `None` where one of the two does not rise to the hoop.
#[must_use]
pub fn own_path(
    simulator: &Simulator,
    (own_place, own_values): (&Place, &Values),
    (place, values): (&Place, &Values),
) -> Option<OwnPath> {
    let own = jacobian(simulator, own_place, own_values)?.try_inverse()?;
    Some(OwnPath {
        place: *own_place,
        values: *own_values,
        change: own * jacobian(simulator, place, values)?,
    })
}

/// The landing of a release less the target.
fn difference(
    simulator: &Simulator,
    place: &Place,
    values: &Values,
    target: &Vector3<f64>,
) -> Option<Vector3<f64>> {
    let is_sane = values[0] > 0.0 && values[0] < 60.0 && values[1].abs() < 1.56;
    let landing = is_sane.then(|| landing_of(simulator, place, values))??;
    Some(vector(&landing) - target)
}

/// The parabola with this landing, a little faster for the drag.
fn first_guess(
    simulator: &Simulator,
    place: &Place,
    landing: &Landing,
    backspin_rad_s: f64,
) -> Values {
    let physics = simulator.physics();
    let length = (place.location.distance_m + landing.depth_m - CENTRE_DEPTH_M).max(0.1);
    let rise = physics.hoop_plane_height_m() - place.release_height_m;
    // z = x tan(pitch) - x^2 k, and the slope at the end is -tan(entry).
    let tangent_of = libm::sin(landing.entry_angle_rad) / libm::cos(landing.entry_angle_rad);
    let tangent = (2.0 * rise / length + tangent_of).max(0.05);
    let pitch = libm::atan(tangent);
    let curvature = (tangent - rise / length).max(0.01) / length;
    let horizontal = (physics.gravity_m_s2 / (2.0 * curvature)).sqrt();
    let drag = if physics.air.density_kg_m3 > 0.0 {
        1.02
    } else {
        1.0
    };
    let polar = place.location.angle_rad - libm::atan2(landing.right_m, length);
    [
        drag * horizontal / libm::cos(pitch),
        pitch,
        polar,
        backspin_rad_s,
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Preset;
    use crate::shooter::Location;
    use crate::units::{DEGREE_RAD, FOOT_M};
    use proptest::prelude::*;

    /// Figures of the sensors' noise at the free throw (0.5 in, 0.5 in, 0.5 deg).
    #[test]
    fn val_noise_of_a_gym_sensor_at_the_free_throw() {
        let physics = Preset::named("ncaa").unwrap().physics();
        let simulator = Simulator::new(&physics).unwrap();
        let place = Place {
            location: Location {
                distance_m: 13.75 * FOOT_M,
                angle_rad: 0.0,
            },
            release_height_m: 7.0 * FOOT_M,
        };
        let landing = Landing {
            depth_m: 11.0 * INCH_M,
            right_m: 0.0,
            entry_angle_rad: 44.0 * DEGREE_RAD,
        };
        let noise = [0.5 * INCH_M, 0.5 * INCH_M, 0.5 * DEGREE_RAD];
        let (_, covariance) =
            release_of_landing(&simulator, &place, &landing, &noise, 0.0).unwrap();
        let sd = |i: usize, unit: f64| covariance[(i, i)].sqrt() / unit;
        assert!((sd(0, FOOT_M) - 0.03).abs() < 0.015, "{}", sd(0, FOOT_M));
        assert!(
            (sd(1, DEGREE_RAD) - 0.33).abs() < 0.05,
            "{}",
            sd(1, DEGREE_RAD)
        );
        assert!(
            (sd(2, DEGREE_RAD) - 0.17).abs() < 0.02,
            "{}",
            sd(2, DEGREE_RAD)
        );
    }

    proptest! {
        /// Authority: the flight itself.
        #[test]
        fn prop_a_landing_leads_back_to_its_release(
            distance in 3.0..9.0_f64, angle in -1.4..1.4_f64, height in 1.6..2.5_f64,
            pitch in 0.7..1.15_f64, long in -0.25..0.25_f64, aside in -0.02..0.02_f64, lift in 0.0..1.0_f64,
        ) {
            let mut physics = Preset::named("ncaa").unwrap().physics();
            physics.air.lift_slope = lift;
            let simulator = Simulator::new(&physics).unwrap();
            let place = Place { location: Location { distance_m: distance, angle_rad: angle }, release_height_m: height };
            let reach = distance + long;
            let rise = physics.hoop_plane_height_m() - height;
            let tangent = libm::sin(pitch) / libm::cos(pitch);
            prop_assume!(reach * tangent - rise > 0.5);
            let speed = 1.02 * reach / libm::cos(pitch) * (physics.gravity_m_s2 * 0.5 / (reach * tangent - rise)).sqrt();
            let values = [speed, pitch, angle + aside, 12.0];
            let landing = landing_of(&simulator, &place, &values).unwrap();
            let (found, _) = release_of_landing(&simulator, &place, &landing, &[0.01; 3], 12.0).unwrap();
            for i in 0..4 {
                prop_assert!((found[i] - values[i]).abs() < 1e-5, "{found:?} {values:?}");
            }
        }
    }
}
