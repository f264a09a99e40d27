//! The same flight seen at another height of the release.

use super::landing::start_of;
use super::measured_release::{Place, Values};
use crate::dynamics::Simulator;

/// Newton steps to the height: the path is nearly straight over a hand's height.
const STEPS: u32 = 6;
/// Where they end, m.
const TOLERANCE_M: f64 = 1e-9;

/// Speed, pitch, polar angle and backspin that a release has where its rising path is at another
/// height above the floor; `None` if it does not rise through it. Tests of one player whose heights
/// of release were estimated apart are compared at one height: 1 cm is worth 0.02 m/s and 0.1 deg.
#[must_use]
pub fn values_at_height(
    simulator: &Simulator,
    place: &Place,
    values: &Values,
    height_m: f64,
) -> Option<Values> {
    let start = start_of(simulator, place, values);
    let goal_m = height_m - simulator.physics().hoop_plane_height_m();
    let mut seconds = 0.0;
    for _ in 0..STEPS {
        let state = simulator.undisturbed_state(&start, seconds);
        let (missing_m, rise_m_s) = (goal_m - state.position_m.z, state.velocity_m_s.z);
        if !(rise_m_s > 0.0) {
            return None;
        }
        if missing_m.abs() < TOLERANCE_M {
            let v = state.velocity_m_s;
            let horizontal = libm::hypot(v.x, v.y);
            let before = start.velocity_m_s;
            let turned = libm::atan2(v.y, v.x) - libm::atan2(before.y, before.x);
            return Some([
                libm::hypot(horizontal, v.z),
                libm::atan2(v.z, horizontal),
                values[2] + turned,
                values[3],
            ]);
        }
        seconds += missing_m / rise_m_s;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Physics;
    use crate::shooter::Location;

    /// Authority: in a vacuum energy is conserved, and the horizontal velocity.
    #[test]
    fn prop_a_vacuum_keeps_energy_and_horizontal_velocity() {
        let physics = Physics::paper();
        let simulator = Simulator::new(&physics).unwrap();
        let place = Place {
            location: Location {
                distance_m: 4.19,
                angle_rad: 0.3,
            },
            release_height_m: 2.1,
        };
        let values = [7.4, 0.9, 0.28, 14.0];
        for height_m in [1.95, 2.1, 2.25] {
            let [v, pitch, polar, spin] =
                values_at_height(&simulator, &place, &values, height_m).unwrap();
            let gained = 2.0 * physics.gravity_m_s2 * (height_m - 2.1);
            assert!((v * v - (7.4 * 7.4 - gained)).abs() < 1e-6);
            assert!((v * libm::cos(pitch) - 7.4 * libm::cos(0.9)).abs() < 1e-8);
            assert!((polar - 0.28).abs() < 1e-12 && spin == 14.0);
        }
        assert_eq!(values_at_height(&simulator, &place, &values, 9.0), None);
    }
}
