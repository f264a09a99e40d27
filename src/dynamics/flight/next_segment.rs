//! The next segment of a flight.

use super::drag_segment::drag_segment;
use super::flight_segment::FlightSegment;
use super::lift_segment::lift_segment;
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;

/// The segment that starts at `state`.
pub(crate) fn next_segment(params: &ModelParams, state: &BallState) -> FlightSegment {
    if params.ball.has_lift {
        lift_segment(params, state)
    } else {
        drag_segment(params, state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::Vec3;
    use crate::model::Preset;
    use crate::model::solids::Solid;
    use proptest::prelude::*;

    fn gaps(params: &ModelParams, state: &BallState) -> f64 {
        gap_and_rate(params, state).0
    }

    /// The gap to the nearer solid, and its rate.
    fn gap_and_rate(params: &ModelParams, state: &BallState) -> (f64, f64) {
        let board = params.board.gap(&params.ball, state);
        let ring = params.ring.gap(&params.ball, state);
        if board.0 < ring.0 { board } else { ring }
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            max_global_rejects: 200_000,
            ..ProptestConfig::with_cases(20_000)
        })]
        /// Authority: the gap at 400 times of the segment.
        #[test]
        fn prop_no_touch_is_missed(
            x in -0.5..1.2_f64, y in -1.3..1.3_f64, z in -0.6..1.8_f64,
            vx in -6.0..3.0_f64, vy in -4.0..4.0_f64, vz in -7.0..4.0_f64,
            w in prop::array::uniform3(-40.0..40.0_f64),
            (density, slope) in prop_oneof![Just((0.0, 0.0)), Just((1.19, 0.0)), Just((1.19, 1.0))],
        ) {
            let mut physics = Preset::named("ncaa").unwrap().physics();
            (physics.air.density_kg_m3, physics.air.lift_slope) = (density, slope);
            let params = ModelParams::new(&physics);
            let start = BallState {
                position_m: Vec3::new(x, y, z),
                velocity_m_s: Vec3::new(vx, vy, vz),
                spin_rad_s: w.into(),
            };
            prop_assume!(gaps(&params, &start) > 1e-6);
            let segment = next_segment(&params, &start);
            prop_assert!(!segment.unresolved);
            let end = segment.end;
            if segment.touches.contains(&true) {
                // The search of the ring ends with a step from 6e-8 m. Its error is greater where
                // the ball only grazes the ring.
                let (gap, rate) = gap_and_rate(&params, &end);
                let allowed = if rate < -0.05 { 1e-9 } else { 1e-7 };
                prop_assert!(gap.abs() < allowed, "{rate} {segment:?}");
            }
            // Classical Runge-Kutta.
            let h = segment.dt / 400.0;
            let a = |v| params.ball.free_acceleration(v, start.spin_rad_s);
            let mut state = start;
            for i in 0..400 {
                let gap = gaps(&params, &state);
                prop_assert!(gap > -1e-6, "{gap} at {i} of {segment:?}");
                let v = state.velocity_m_s;
                let k1 = a(v);
                let k2 = a(v + k1 * (0.5 * h));
                let k3 = a(v + k2 * (0.5 * h));
                let k4 = a(v + k3 * h);
                state.position_m += v * h + (k1 + k2 + k3) * (h * h / 6.0);
                state.velocity_m_s += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
            }
            prop_assert!((end.position_m - state.position_m).norm() < 3e-6, "{segment:?}");
            prop_assert!((end.velocity_m_s - state.velocity_m_s).norm() < 7e-5, "{segment:?}");
            if segment.fell {
                let at_bottom = (end.position_m.z + params.ring.reach).abs() < 1e-9;
                let at_top = end.velocity_m_s.z.abs() < 1e-6 || segment.dt == 0.0;
                prop_assert!(at_bottom || at_top, "{segment:?}");
            }
            if segment.behind_board {
                let core = params.board.core.low.x;
                prop_assert!((end.position_m.x - core).abs() < 1e-9 || segment.dt == 0.0);
            }
        }
    }
}
