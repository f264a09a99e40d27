//! A flight under drag and lift, or at solids with edges and bracket, in segments: each is the time for which one
//! [`FlightPath`] holds, or less if the flight ends in it.
//!
//! The first touch is found with certainty, however short a graze. The search steps through the segment; at each time it
//! asks every solid how long no touch is possible, and goes on by the least of the answers.
//!
//! - Board and bracket: their cores are convex, so the distance d of the centre is a convex function of its position, and
//!   `d'' >= -A`, with A a bound on the acceleration. A gap G with the rate G' cannot close within
//!   `2 G/(sqrt(G'^2 + 2 A G) - G')`.
//! - The ring's circle is not convex. There the search has the regions of a ball above the ring, outside, within
//!   the circle, and near the rod. In the last one the bound is on `F = (R_H - D)^2 + z^2 - reach^2`:
//!
//! ```text
//! F''/2 = v^2 + z a_z + (D - R_H)/D p.a_h - R_H L^2/D^3 >= v^2 - reach (|a_z| + |a_h|) - R_H L^2/D^3
//! ```
//!
//! (p and the index h for the horizontal part, D the distance from the hoop's axis, L = x v_y - y v_x.)

use super::flight_path::FlightPath;
use crate::math::real::{Mask, Real};
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::Solid;
use crate::model::{BallState, SolidId};

/// Gap at which an approaching ball touches, m.
const TOUCH_M: f64 = 1e-11;
/// Shortest step of a ball that moves away, s.
const PARTING_STEP_S: f64 = 1e-6;
/// Limit on the iterations. The search needs five or ten; a ball that parts with hardly any speed more.
const MAX_ITERATIONS: u32 = 10_000;
/// Longest step near the rod, s: the bounds on F'' hold for so long.
const LONGEST_STEP_S: f64 = 0.05;
/// Near the rod is what is nearer to its circle, along and across the plane of the hoop, than this share of the reach.
const NEAR: f64 = 1.01;
/// Within the circle is a distance from the axis below this share of that at which the ball touches; the
/// bounds near the rod hold down to the second share.
const WITHIN: (f64, f64) = (0.9, 0.8);

/// A segment of a flight. At most one of the masks holds in a lane; where none does, the flight goes on at its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlightSegment<T: Real = f64> {
    pub(crate) path: FlightPath<T>,
    /// Its length, s.
    pub(crate) dt: T,
    /// The ball touches a solid; by [`SolidId::index`].
    pub(crate) touches: [T::Mask; SolidId::COUNT],
    /// The centre falls below the reach of the ring, or is at its highest point below it.
    pub(crate) fell: T::Mask,
    /// The centre passes the plane of the board's core. (On the paper's board also: the ball touches it beside its
    /// face, where it does not act.)
    pub(crate) behind_board: T::Mask,
    /// The search reached its iteration limit.
    pub(crate) unresolved: T::Mask,
}

impl<T: Real> FlightSegment<T> {
    /// The segment that starts at `state`.
    #[inline(always)]
    pub(crate) fn new(params: &ModelParams<T>, state: &BallState<T>) -> Self {
        let path = FlightPath::new(&params.ball, state);
        let (never, none) = (params.ball.never_s, params.splat_mask(false));
        let (end_p, end_v) = path.position_and_velocity(path.longest_s);
        let fell_s = fall_time(params, &path, state, (end_p.z, end_v.z));
        let core_x = params.board.core.low.x;
        let mut behind_s = never;
        let passes = end_p.x.lt(core_x);
        if passes.any() {
            behind_s = passing_time(&path, state, core_x, (end_p.x, end_v.x)).select(passes, never);
        }
        let end = Real::min(path.longest_s, Real::min(fell_s, behind_s));
        let near = near_solids(params, &path, state, &end_p);
        let mut search = Touches {
            time: end,
            solids: [none; SolidId::COUNT],
            beside_face: none,
            unresolved: none,
        };
        if near.any() {
            search = first_touch(params, &path, end, near);
        }
        let [board, ring] = search.solids;
        let touched = board | ring | search.beside_face;
        let ended = !touched & !search.unresolved;
        let behind = ended & behind_s.le(end);
        Self {
            path,
            dt: search.time,
            touches: search.solids,
            fell: ended & fell_s.le(end) & !behind,
            behind_board: behind | search.beside_face,
            unresolved: search.unresolved,
        }
    }

    /// Whether the flight ends with this segment.
    #[inline(always)]
    pub(crate) fn ends(&self) -> T::Mask {
        let [board, ring] = self.touches;
        board | ring | self.fell | self.behind_board | self.unresolved
    }
}

/// Time at which the centre falls through z = -reach, or is at its highest point below it; never if neither happens
/// on the path.
#[inline(always)]
fn fall_time<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    start: &BallState<T>,
    (end_z, end_vz): (T, T),
) -> T {
    let (zero, never) = (params.zero(), params.ball.never_s);
    let bottom = -params.ring.reach;
    let falls = end_z.lt(bottom) & end_vz.is_negative();
    if !falls.any() {
        return never;
    }
    // From the end of the path backwards, with the mean acceleration.
    let (z, vz) = (start.position_m.z, start.velocity_m_s.z);
    let mean = (vz - end_vz) / path.longest_s;
    let below = (bottom - end_z).positive_part();
    let root = (end_vz.squared() - mean * below * 2.0)
        .positive_part()
        .sqrt();
    let back = below * 2.0 / Real::max(root - end_vz, params.splat(1e-9));
    let mut time = path.falls_through(bottom, path.longest_s - back);
    let starts_below = z.lt(bottom);
    if starts_below.any() {
        let rises = vz.is_positive();
        let highest = path.highest_s(&params.ball);
        let (top, _) = path.height_and_rate(highest);
        let never_rose = starts_below & (!rises | top.lt(bottom));
        time = highest.select(rises, zero).select(never_rose, time);
    }
    Real::max(time, zero).select(falls, never)
}

/// Time at which the centre passes the plane of the board's core.
#[inline(always)]
fn passing_time<T: Real>(
    path: &FlightPath<T>,
    start: &BallState<T>,
    core_x: T,
    (end_x, end_vx): (T, T),
) -> T {
    const NEWTON_STEPS: u32 = 5;
    let (zero, one) = (core_x.zero(), core_x.one());
    let mean = (end_x - start.position_m.x) / path.longest_s;
    let slope = Real::min(mean, end_vx);
    let falls = slope.is_negative();
    let mut t = path.longest_s - (end_x - core_x) / slope.select(falls, one);
    for _ in 0..NEWTON_STEPS {
        let (x, rate) = path.x_and_rate(t);
        let falls = rate.is_negative();
        let next = t - (x - core_x) / rate.select(falls, one);
        t = next.select(falls, t);
    }
    Real::max(Real::min(t, path.longest_s), zero)
}

/// Whether the ball may come near a solid on the path: whether a box about the path meets that about all solids.
#[inline(always)]
fn near_solids<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    start: &BallState<T>,
    end: &Vec3<T>,
) -> T::Mask {
    // A coordinate is beyond its values at both ends by at most A dt^2/8.
    let slack = path.acceleration_bound * path.longest_s.squared() * 0.125;
    let core = &params.board.core;
    let front = params.ring.radius + params.ring.reach;
    let side = Real::max(core.high.y + core.reach, front);
    let (x_0, y_0) = (start.position_m.x, start.position_m.y);
    let before = (Real::min(x_0, end.x) - slack).lt(front);
    let left = (-side).lt(Real::max(y_0, end.y) + slack);
    let right = (Real::min(y_0, end.y) - slack).lt(side);
    let above = (-Real::max(params.ring.reach, core.reach - core.low.z))
        .lt(Real::max(start.position_m.z, end.z) + slack);
    before & left & right & above
}

/// The first touch on a path.
struct Touches<T: Real> {
    /// Its time, or that of the end.
    time: T,
    solids: [T::Mask; SolidId::COUNT],
    /// The paper's board is touched beside its face.
    beside_face: T::Mask,
    unresolved: T::Mask,
}

/// Follows the path until `end` in the lanes of `near`.
#[inline(always)]
fn first_touch<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    end: T,
    near: T::Mask,
) -> Touches<T> {
    let none = params.splat_mask(false);
    let mut t = params.zero();
    let mut searching = near;
    let mut found = Touches {
        time: end,
        solids: [none; SolidId::COUNT],
        beside_face: none,
        unresolved: none,
    };
    let mut iterations = 0;
    while searching.any() && iterations < MAX_ITERATIONS {
        iterations += 1;
        let state = path.state_after(t);
        let (board, to_board) = board_step(params, path, &state);
        let (ring, to_ring) = ring_step(params, path, &state, end - t);
        let (bracket, to_bracket) = if params.ring.has_bracket {
            bracket_step(params, path, &state)
        } else {
            (none, params.ball.never_s)
        };
        let in_front = params.board.has_edges_mask() | params.board.is_in_frame(&state);
        let hoop = (ring | bracket) & searching;
        let on_board = board & searching & !hoop;
        let touches = hoop | on_board;
        found.time = t.select(touches, found.time);
        let [all_board, all_ring] = found.solids;
        found.solids = [all_board | (on_board & in_front), all_ring | hoop];
        found.beside_face = found.beside_face | (on_board & !in_front);
        let step = Real::min(to_board, Real::min(to_ring, to_bracket));
        t = (t + step).select(searching & !touches, t);
        searching = searching & !touches & t.lt(end);
    }
    found.unresolved = searching;
    found
}

/// Whether a ball with a gap and its rate touches, and a time within which the gap cannot close.
#[inline(always)]
fn gap_step<T: Real>(gap: T, rate: T, acceleration_bound: T) -> (T::Mask, T) {
    let zero = gap.zero();
    let closing = rate.is_negative();
    let open = gap.positive_part();
    let bound = Real::max(acceleration_bound, gap.splat(1e-9));
    let root = (rate.squared() + bound * open * 2.0).sqrt();
    let numerator = (open * 2.0).select(closing, rate + root);
    let denominator = (root - rate).select(closing, bound);
    let least = zero.select(closing, gap.splat(PARTING_STEP_S));
    let touches = closing & gap.le(gap.splat(TOUCH_M));
    (touches, Real::max(numerator / denominator, least))
}

#[inline(always)]
fn board_step<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    state: &BallState<T>,
) -> (T::Mask, T) {
    let board = &params.board;
    let (gap, rate) = board.core.gap(state);
    let (touches, step) = gap_step(gap, rate, path.acceleration_bound);
    // Gravity does not act across the plane of the face.
    let to_plane = state.position_m.x - board.touch_x;
    let (_, plane_step) = gap_step(to_plane, state.velocity_m_s.x, path.air_acceleration_bound);
    let in_front = to_plane.is_positive();
    (touches, Real::max(plane_step.select(in_front, step), step))
}

/// A time within which a ball that is more than `margin` away from the height |z| = `reach` cannot come to it (zero
/// elsewhere).
#[inline(always)]
fn height_step<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    state: &BallState<T>,
    reach: T,
) -> T {
    let (z, vz) = (state.position_m.z, state.velocity_m_s.z);
    let (above, below) = ((reach * NEAR).lt(z), z.lt(-(reach * NEAR)));
    let gap = z.abs() - reach;
    let rate = vz.select(above, -vz);
    let (_, step) = gap_step(gap, rate, path.acceleration_bound);
    step.select(above | below, params.zero())
}

#[inline(always)]
fn bracket_step<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    state: &BallState<T>,
) -> (T::Mask, T) {
    let (gap, rate) = params.ring.bracket.gap(state);
    let (touches, step) = gap_step(gap, rate, path.acceleration_bound);
    let height = height_step(params, path, state, params.ring.reach);
    (touches, Real::max(step, height))
}

#[inline(always)]
fn ring_step<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    state: &BallState<T>,
    time_left: T,
) -> (T::Mask, T) {
    let (zero, one) = (params.zero(), params.one());
    let (radius, reach) = (params.ring.radius, params.ring.reach);
    let (p, v) = (state.position_m, state.velocity_m_s);
    let inner = radius - reach;
    let distance_squared = p.x.squared() + p.y.squared();
    let distance = distance_squared.sqrt();
    let dot = p.x * v.x + p.y * v.y;
    let horizontal_squared = v.x.squared() + v.y.squared();

    // Above, below and outside.
    let height = height_step(params, path, state, reach);
    let beyond = distance - (radius + reach);
    let outside = (reach * (NEAR - 1.0)).lt(beyond);
    let outside_step = (beyond / path.speed_bound).select(outside, zero);

    // Within the circle: D^2 grows at most as fast as with the greatest horizontal speed.
    let within = distance.lt(inner * WITHIN.0);
    let horizontal = horizontal_squared.sqrt();
    let fastest = horizontal + path.air_acceleration_bound * time_left;
    let growth = Real::max(
        fastest.squared() + inner * path.air_acceleration_bound,
        params.splat(1e-9),
    );
    let room = (inner.squared() - distance_squared).positive_part();
    let root = (dot.squared() + growth * room).sqrt();
    let within_step = (root - dot) / growth;
    let within_step = within_step.select(within, zero);

    // Near the rod.
    let inward = radius - distance;
    let value = inward.squared() + p.z.squared() - reach.squared();
    let half_slope = p.z * v.z - inward * dot / Real::max(distance, reach * 1e-3);
    let longest = params.splat(LONGEST_STEP_S);
    let speed = (horizontal_squared + v.z.squared()).sqrt();
    let slowest = (speed - path.acceleration_bound * longest).positive_part();
    let angular = (p.x * v.y - p.y * v.x).abs();
    let lift_torque = if params.ball.has_air {
        path.air_acceleration_bound * longest * (radius + reach)
    } else {
        zero
    };
    let most_angular = angular + lift_torque;
    let closest = (angular - lift_torque).positive_part()
        / Real::max(
            horizontal + path.air_acceleration_bound * longest,
            params.splat(1e-9),
        );
    let nearest = Real::max(inner * WITHIN.1, closest);
    let half_bound = (radius * most_angular.squared() / (nearest.squared() * nearest)
        + reach * (path.acceleration_bound + path.air_acceleration_bound) * NEAR
        - slowest.squared())
    .positive_part();
    let open = value.positive_part();
    let root = (half_slope.squared() + half_bound * open).sqrt();
    let closing = half_slope.is_negative();
    let bounded = half_bound.is_positive();
    let numerator = open.select(
        closing,
        (half_slope + root).select(bounded, params.ball.never_s),
    );
    let denominator = (root - half_slope).select(closing, half_bound.select(bounded, one));
    let least = zero.select(closing, params.splat(PARTING_STEP_S));
    let to_within = (distance - inner * WITHIN.1) / path.speed_bound;
    let near_step = Real::min(
        Real::max(numerator / denominator, least),
        Real::max(Real::min(longest, to_within), least),
    );

    let elsewhere = Real::max(Real::max(height, outside_step), within_step);
    let is_near = elsewhere.le(zero);
    let touches = is_near & closing & value.le(reach * (2.0 * TOUCH_M));
    (touches, near_step.select(is_near, elsewhere))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Physics, Preset};
    use proptest::prelude::*;

    fn gaps(params: &ModelParams, state: &BallState) -> f64 {
        let (board, _) = params.board.gap(&params.ball, state);
        let (ring, _) = params.ring.gap(&params.ball, state);
        board.min(ring)
    }

    fn lively() -> Physics {
        let mut physics = Preset::named("ncaa").unwrap().physics();
        physics.air.lift_slope = 1.0;
        physics
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        /// Authority: the gap at 400 times of the segment.
        #[test]
        fn prop_no_touch_is_missed(
            x in -0.5..1.2_f64, y in -1.3..1.3_f64, z in -0.6..1.8_f64,
            vx in -6.0..3.0_f64, vy in -4.0..4.0_f64, vz in -7.0..4.0_f64,
            w in prop::array::uniform3(-40.0..40.0_f64),
            with_air: bool,
        ) {
            let mut physics = lively();
            if !with_air {
                physics.air.density_kg_m3 = 0.0;
            }
            let params = ModelParams::new(&physics);
            let start = BallState {
                position_m: Vec3::new(x, y, z),
                velocity_m_s: Vec3::new(vx, vy, vz),
                spin_rad_s: w.into(),
            };
            prop_assume!(gaps(&params, &start) > 1e-6);
            let segment = FlightSegment::new(&params, &start);
            prop_assert!(!segment.unresolved);
            let end = segment.path.state_after(segment.dt);
            if segment.touches.contains(&true) {
                prop_assert!(gaps(&params, &end).abs() < 1e-9, "{segment:?}");
            }
            for i in 0..400 {
                let state = segment.path.state_after(segment.dt * f64::from(i) / 400.0);
                let gap = gaps(&params, &state);
                prop_assert!(gap > -1e-9, "{gap} at {i} of {segment:?}");
            }
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
