//! A segment of a flight with lift, and its first touch.
//!
//! The first touch is found with certainty, however short a graze, by conservative advancement:
//! each step is the shortest of the times in which the solids cannot be reached.
//!
//! - Board and bracket: their cores are convex, so the distance d of the centre is a convex
//!   function of its position, and `d'' >= -A`, with A a bound on the acceleration. A gap G with
//!   the rate G' cannot close within `2 G/(sqrt(G'^2 + 2 A G) - G')`.
//! - The ring's circle is not convex. The search distinguishes four regions: above the ring,
//!   outside it, within the circle, and near the tube. In the last one the bound is on
//!   `F = (R_H - D)^2 + z^2 - reach^2`:
//!
//! ```text
//! F''/2 =  v^2 + z a_z + (D - R_H)/D p.a_h - R_H L^2/D^3
//!       >= v^2 - reach (|a_z| + |a_h|) - R_H L^2/D^3
//! ```
//!
//! (p and the index h for the horizontal part, D the distance from the hoop's axis,
//! `L = x v_y - y v_x`.)

use super::flight_path::FlightPath;
use super::flight_segment::FlightSegment;
use super::safe_step::{PARTING_STEP, TOUCH_M, gap_step};
use crate::dynamics::end_rules::has_diverged;
use crate::math::real::{Mask, Real};
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::Solid;
use crate::model::{BallState, SolidId};

/// Height to which the search for a crossing converges where there is one, m.
const CROSSING_TOLERANCE_M: f64 = 1e-9;
/// Within this distance of the plane in which the ball touches the face, the exact gap to the board
/// is used, m.
const PLANE_MARGIN_M: f64 = 1e-9;
/// How long before it falls to the height of the hoop the search begins, s.
const HEIGHT_MARGIN_S: f64 = 1e-9;
/// Limit on the iterations. The search needs five or ten; a ball that parts with hardly any speed
/// more.
const MAX_ITERATIONS: u32 = 10_000;
/// Longest step near the tube, s: the bounds on F'' hold for so long.
const LONGEST_STEP_S: f64 = 0.05;
/// The bounds near the tube apply where `|z|` and `|D - R_H|` are below this multiple of the reach.
const NEAR: f64 = 1.01;
/// Farther than this multiple of the reach outside the bracket's box, the distance to the box
/// stands for the exact gap.
const FAR: f64 = 0.1;
/// A ball counts as inside the circle where D is below this fraction of `R_H - reach`, at which it
/// touches.
const MAX_DISTANCE_FRACTION: f64 = 0.9;
/// The bounds near the tube hold down to this fraction of `R_H - reach`.
const BOUND_DISTANCE_FRACTION: f64 = 0.8;

/// The segment that starts at `state`.
#[inline(always)]
pub(crate) fn lift_segment<T: Real>(
    params: &ModelParams<T>,
    state: &BallState<T>,
) -> FlightSegment<T> {
    let path = FlightPath::new(&params.ball, state);
    let (never, none) = (params.ball.never_s, params.splat_mask(false));
    let (end_p, end_v) = path.position_and_velocity(path.longest_s);
    let fell_s = fall_time(params, &path, state, (end_p.z, end_v.z));
    let core_x = params.board.core.low.x;
    let mut behind_s = never;
    let passes = end_p.x.lt(core_x) | state.position_m.x.lt(core_x);
    if passes.any() {
        let starts_behind = state.position_m.x.lt(core_x);
        let passing = passing_time(&path, state, core_x, (end_p.x, end_v.x));
        behind_s = params
            .zero()
            .select(starts_behind, passing.select(passes, never));
    }
    let end = Real::min(path.longest_s, Real::min(fell_s, behind_s));
    let start = untouched_time(params, &path, state, (end_p.z, end_v.z));
    let near = near_solids(params, &path, state, &end_p) & start.lt(end);
    let mut search = Touches {
        time: end,
        solids: [none; SolidId::COUNT],
        beside_face: none,
        unresolved: none,
    };
    if near.any() {
        search = first_touch(params, &path, (start, end), near);
    }
    let [board, ring] = search.solids;
    let touched = board | ring | search.beside_face;
    let unresolved = search.unresolved | has_diverged(params, state);
    let ended = !touched & !unresolved;
    let behind = ended & behind_s.le(end);
    let (rises, rises_inside) = rising_crossing(params, &path, state, search.time);
    FlightSegment {
        dt: search.time,
        end: path.state_after(search.time),
        touches: search.solids,
        fell: ended & fell_s.le(end) & !behind,
        behind_board: behind | search.beside_face,
        unresolved,
        rises,
        rises_inside,
    }
}

/// Whether the centre rises through the plane of the hoop before `dt`, and does so inside the ring.
#[inline(always)]
fn rising_crossing<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    start: &BallState<T>,
    dt: T,
) -> (T::Mask, T::Mask) {
    let zero = params.zero();
    let may_rise = start.position_m.z.is_negative() & start.velocity_m_s.z.is_positive();
    if !may_rise.any() {
        return (may_rise, may_rise);
    }
    let t = path.rises_through(zero, zero);
    let (position, velocity) = path.position_and_velocity(t);
    let arrived = position.z.abs().lt(params.splat(CROSSING_TOLERANCE_M));
    let rises = may_rise & arrived & velocity.z.is_positive() & zero.lt(t) & t.lt(dt);
    let distance_squared = position.x.squared() + position.y.squared();
    (
        rises,
        rises & distance_squared.lt(params.ring.radius.squared()),
    )
}

/// Time at which the centre falls through z = -reach, or is at its highest point below it; never if
/// neither happens on the path.
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

/// Whether the ball may come near a solid on the path: whether a box about the path meets that
/// about all solids.
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
    (start, end): (T, T),
    near: T::Mask,
) -> Touches<T> {
    let none = params.splat_mask(false);
    let mut t = start;
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
        let (board, to_board) = board_step(params, path, &state, searching);
        let p = state.position_m;
        let distance = (p.x.squared() + p.y.squared()).sqrt();
        let (ring, to_ring) = ring_step(params, path, &state, distance, end - t);
        let (bracket, to_bracket) = bracket_step(params, path, &state, distance, searching);
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

#[inline(always)]
fn board_step<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    state: &BallState<T>,
    searching: T::Mask,
) -> (T::Mask, T) {
    let board = &params.board;
    // Gravity does not act across the plane of the face.
    let to_plane = state.position_m.x - board.touch_x;
    let in_front = params.splat(PLANE_MARGIN_M).lt(to_plane);
    let (_, plane_step) = gap_step(to_plane, state.velocity_m_s.x, path.air_acceleration_bound);
    if !(searching & !in_front).any() {
        return (params.splat_mask(false), plane_step);
    }
    let (gap, rate) = board.core.gap(state);
    let (touches, step) = gap_step(gap, rate, path.acceleration_bound);
    (touches & !in_front, plane_step.select(in_front, step))
}

/// A time before which the ball touches nothing: until it falls to the height of the hoop or
/// reaches the plane in which it touches the board.
#[inline(always)]
fn untouched_time<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    start: &BallState<T>,
    (end_z, end_vz): (T, T),
) -> T {
    let (zero, reach) = (params.zero(), params.ring.reach);
    let to_plane = start.position_m.x - params.board.touch_x;
    let (_, plane) = gap_step(to_plane, start.velocity_m_s.x, path.air_acceleration_bound);
    let plane = plane.select(to_plane.is_positive(), zero);
    let above = reach.lt(start.position_m.z);
    let falls = above & end_z.lt(reach);
    let mut height = path.longest_s;
    if falls.any() {
        let mean = (start.velocity_m_s.z - end_vz) / path.longest_s;
        let below = (reach - end_z).positive_part();
        let root = (end_vz.squared() - mean * below * 2.0)
            .positive_part()
            .sqrt();
        let back = below * 2.0 / Real::max(root - end_vz, params.splat(1e-9));
        let time = path.falls_through(reach, path.longest_s - back) - HEIGHT_MARGIN_S;
        height = Real::max(time, zero).select(falls, height);
    }
    Real::min(plane, height.select(above, zero))
}

/// A time within which a ball that is more than `margin` away from the height |z| = `reach` cannot
/// come to it (zero elsewhere).
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
    distance: T,
    searching: T::Mask,
) -> (T::Mask, T) {
    let never = params.ball.never_s;
    let none = params.splat_mask(false);
    if !params.ring.has_bracket {
        return (none, never);
    }
    let reach = params.ring.reach;
    let (p, bracket) = (state.position_m, &params.ring.bracket);
    // A lower bound on the distance of a ball that is far along one coordinate, or within the
    // ring's circle, where the ring is nearer.
    let beyond_x = p.x - bracket.high.x - reach;
    let beyond_y = p.y.abs() - bracket.high.y - reach;
    let beyond_z = p.z.abs() - reach;
    let far = Real::max(beyond_x, Real::max(beyond_y, beyond_z));
    let far = Real::max(far, params.ring.radius - distance);
    let is_far = (reach * FAR).lt(far);
    let far_step = far * path.inverse_speed_bound;
    if !(searching & !is_far).any() {
        return (none, far_step);
    }
    let (gap, rate) = bracket.gap(state);
    let (touches, step) = gap_step(gap, rate, path.acceleration_bound);
    (touches & !is_far, far_step.select(is_far, step))
}

#[inline(always)]
fn ring_step<T: Real>(
    params: &ModelParams<T>,
    path: &FlightPath<T>,
    state: &BallState<T>,
    distance: T,
    time_left: T,
) -> (T::Mask, T) {
    let (zero, one) = (params.zero(), params.one());
    let (radius, reach) = (params.ring.radius, params.ring.reach);
    let (p, v) = (state.position_m, state.velocity_m_s);
    let inner = radius - reach;
    let dot = p.x * v.x + p.y * v.y;
    let horizontal_squared = v.x.squared() + v.y.squared();

    // Above, below and outside.
    let height = height_step(params, path, state, reach);
    let beyond = distance - (radius + reach);
    let outside = (reach * (NEAR - 1.0)).lt(beyond);
    let outside_step = (beyond * path.inverse_speed_bound).select(outside, zero);

    // Within the circle: D^2 grows at most as fast as with the greatest horizontal speed.
    let within = distance.lt(inner * MAX_DISTANCE_FRACTION);
    let horizontal = horizontal_squared.sqrt();
    let fastest = horizontal + path.air_acceleration_bound * time_left;
    let growth = Real::max(
        fastest.squared() + inner * path.air_acceleration_bound,
        params.splat(1e-9),
    );
    let remaining_squared = (inner.squared() - distance.squared()).positive_part();
    let root = (dot.squared() + growth * remaining_squared).sqrt();
    let within_step = (root - dot) / growth;
    let within_step = within_step.select(within, zero);

    // Near the tube.
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
    let max_angular = angular + lift_torque;
    let closest = (angular - lift_torque).positive_part()
        / Real::max(
            horizontal + path.air_acceleration_bound * longest,
            params.splat(1e-9),
        );
    let nearest = Real::max(inner * BOUND_DISTANCE_FRACTION, closest);
    let half_bound = (radius * max_angular.squared() / (nearest.squared() * nearest)
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
    let min_step = zero.select(closing, params.splat(PARTING_STEP));
    let to_within = (distance - inner * BOUND_DISTANCE_FRACTION) * path.inverse_speed_bound;
    let near_step = Real::min(
        Real::max(numerator / denominator, min_step),
        Real::max(Real::min(longest, to_within), min_step),
    );

    let elsewhere = Real::max(Real::max(height, outside_step), within_step);
    let is_near = elsewhere.le(zero);
    let touches = is_near & closing & value.le(reach * (2.0 * TOUCH_M));
    (touches, near_step.select(is_near, elsewhere))
}
