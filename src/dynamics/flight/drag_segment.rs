//! A segment of a flight without lift, and its first touch.
//!
//! The horizontal path is straight. So the planes of the board and the circles about the hoop's
//! axis are reached at an s of closed form, and the ring is searched as for a parabola
//! ([`super::ring_search`]). Edges and bracket are searched only by balls that come near them:
//! their cores are convex, so the gap G has `G'' >= -A`, with A a bound on `-z''`, and cannot close
//! within `2 G/(sqrt(G'^2 + 2 A G) - G')`.

use super::drag_polynomial::DragPolynomial;
use super::flight_segment::FlightSegment;
use super::height_path::HeightPath;
use super::ring_search::{HorizontalMotion, ring_time};
use super::safe_step::gap_step;
use crate::dynamics::end_rules::has_diverged;
use crate::math::real::{Mask, Real};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::Rectangle;
use crate::model::{BallState, SolidId};

/// Limit on the steps along the gap to an edge.
const MAX_ITERATIONS: u32 = 10_000;
/// A ball that is farther than this behind the plane in which it touches the face may touch an
/// edge, m.
const BEHIND_PLANE_M: f64 = 1e-6;
/// A ball that is nearer than this to the region about ring and board counts as being in it, m. (It
/// is more than the rounding errors of a segment that ends at the region's border.)
const FAR_MARGIN_M: f64 = 1e-9;

/// Where the plane of the board is reached, in s (never elsewhere).
struct BoardEvents<T: Real> {
    /// The flat part of the face is touched.
    face: T,
    /// From here on the ball may touch an edge.
    edges: T,
    /// The centre passes the plane of the core.
    behind: T,
}

/// The segment that starts at `state`.
#[inline(always)]
pub(crate) fn drag_segment<T: Real>(
    params: &ModelParams<T>,
    state: &BallState<T>,
) -> FlightSegment<T> {
    let (one, never) = (params.one(), params.ball.never_s);
    let arc = arc_of(params, state);
    let reach = params.ring.reach;
    let falls_s = arc.falling_s(-reach);
    let fell = fall_s(params, &arc, state, falls_s);
    let inverse_x = inverse_x_of(&arc);
    let board = board_events(params, &arc, state, inverse_x);
    let near = comes_near_s(params, &arc, state, inverse_x);
    let last = Real::min(Real::min(one, near), Real::min(fell, board.behind));
    let motion = HorizontalMotion::new(params, state.position_m, arc.displacement);
    let falls_to_reach = arc.falls_through_after(reach);
    let until = Real::min(last, board.face);
    let (ring, ring_unresolved) = ring_time(params, &motion, &arc, (falls_to_reach, until));
    let mut end = Real::min(until, ring);
    let (mut edge, mut bracket) = (never, never);
    let mut unresolved = ring_unresolved | has_diverged(params, state);
    let passes_plane = board.edges.lt(end);
    if passes_plane.any() {
        let near = passes_plane & !passes_beside(params, &arc, board.edges, end);
        if near.any() {
            let search_failed;
            (edge, search_failed) =
                convex_touch(&params.board.core, &arc, (board.edges, end), near);
            unresolved = unresolved | search_failed;
            end = Real::min(end, edge);
        }
    }
    if params.ring.has_bracket {
        let is_above = params.ring.reach.lt(state.position_m.z);
        let from = falls_to_reach.0.select(is_above, params.zero());
        let near = from.lt(end) & comes_to_bracket(params, &arc, from, end);
        if near.any() {
            let search_failed;
            (bracket, search_failed) = convex_touch(&params.ring.bracket, &arc, (from, end), near);
            unresolved = unresolved | search_failed;
            end = Real::min(end, bracket);
        }
    }
    let state_at_end = arc.state(end, state.spin_rad_s);
    let on_ring = (ring.le(end) | bracket.le(end)) & !unresolved;
    let on_edge = edge.le(end) & !on_ring & !unresolved;
    let on_face = board.face.le(end) & !on_ring & !on_edge & !unresolved;
    let acts = params.board.has_edges_mask();
    let untouched = !(on_ring | on_edge | on_face | unresolved);
    let behind = untouched & board.behind.le(end);
    let (rises, rises_inside) =
        rising_crossing(params, &arc, state, (end, state_at_end.position_m.z));
    FlightSegment {
        dt: arc.time(end),
        end: state_at_end,
        touches: [on_face | (on_edge & acts), on_ring],
        fell: untouched & !behind & fell.le(end),
        behind_board: behind | (on_edge & !acts),
        unresolved,
        rises,
        rises_inside,
    }
}

/// The segments that start at `state`, and the lanes in which nothing can be touched on them. In
/// the others they mean nothing.
#[inline(always)]
pub(crate) fn far_segment<T: Real>(
    params: &ModelParams<T>,
    state: &BallState<T>,
) -> (FlightSegment<T>, T::Mask) {
    let (one, none) = (params.one(), params.splat_mask(false));
    let arc = arc_of(params, state);
    let near = comes_near_s(params, &arc, state, inverse_x_of(&arc));
    let end = Real::min(one, near);
    let state_at_end = arc.state(end, state.spin_rad_s);
    let bottom = -params.ring.reach;
    let (start_z, end_z) = (state.position_m.z, state_at_end.position_m.z);
    let rises = state_at_end.velocity_m_s.z.is_positive();
    let falls = end_z.lt(bottom) & !(start_z.lt(bottom) & rises);
    let passes_behind = state_at_end.position_m.x.lt(params.board.core.low.x);
    let is_far = is_far(params, state) & !passes_behind & !falls & !has_diverged(params, state);
    let (rises, rises_inside) =
        rising_crossing(params, &arc, state, (end, state_at_end.position_m.z));
    let segment = FlightSegment {
        dt: arc.time(end),
        end: state_at_end,
        touches: [none; SolidId::COUNT],
        fell: none,
        behind_board: none,
        unresolved: none,
        rises,
        rises_inside,
    };
    (segment, is_far)
}

/// The region around ring and board: half its width, and its front limit in x, m.
#[inline(always)]
fn near_side_and_front<T: Real>(params: &ModelParams<T>) -> (T, T) {
    let front = params.ring.radius + params.ring.reach;
    let core = &params.board.core;
    (Real::max(core.high.y + core.reach, front), front)
}

/// Whether a ball is in front of ring and board, or to one side of them, so that it can touch
/// nothing.
#[inline(always)]
pub(crate) fn is_far<T: Real>(params: &ModelParams<T>, state: &BallState<T>) -> T::Mask {
    let (side, front) = near_side_and_front(params);
    let p = state.position_m;
    let margin = params.splat(FAR_MARGIN_M);
    let behind = p.x.lt(params.board.core.low.x + margin);
    (front + margin).lt(p.x) | ((side + margin).lt(p.y.abs()) & !behind)
}

/// Where a ball that is far comes near; never for one that is near at the start, or stays far. A
/// segment ends there. So the next one, the first on which ring and board are searched, starts at
/// the border of the region and covers as much of it as one polynomial can. For `inverse_x` see
/// [`inverse_x_of`].
#[inline(always)]
fn comes_near_s<T: Real>(
    params: &ModelParams<T>,
    arc: &DragPolynomial<T>,
    start: &BallState<T>,
    inverse_x: T,
) -> T {
    let (zero, one, never) = (params.zero(), params.one(), params.ball.never_s);
    let (side, front) = near_side_and_front(params);
    let p = start.position_m;
    let (before, beside) = (p.x - front, p.y.abs() - side);
    let is_before = before.is_positive();
    let is_beside = beside.is_positive();
    let comes_back = is_before & arc.displacement.x.is_negative();
    let comes_in = is_beside & (p.y * arc.displacement.y).is_negative();
    let approaches = (comes_back | comes_in) & is_far(params, start);
    if !approaches.any() {
        return never;
    }
    let to_front = (-before * inverse_x).select(comes_back, never.select(is_before, zero));
    let mut to_side = never.select(is_beside, zero);
    if comes_in.any() {
        let rate = arc.displacement.y.abs().select(comes_in, one);
        to_side = (beside / rate).select(comes_in, to_side);
    }
    Real::max(to_front, to_side).select(approaches, never)
}

/// 1/x of the path of a ball that flies towards the board; any number for others.
#[inline(always)]
fn inverse_x_of<T: Real>(arc: &DragPolynomial<T>) -> T {
    let x = arc.displacement.x;
    x.one() / x.select(x.is_negative(), -x.one())
}

#[inline(always)]
fn arc_of<T: Real>(params: &ModelParams<T>, state: &BallState<T>) -> DragPolynomial<T> {
    DragPolynomial::new(&params.ball, state)
}

/// Whether the centre rises through the plane of the hoop before `end`, where its height is
/// `end_z`, and does so inside the ring.
#[inline(always)]
fn rising_crossing<T: Real>(
    params: &ModelParams<T>,
    arc: &DragPolynomial<T>,
    start: &BallState<T>,
    (end, end_z): (T, T),
) -> (T::Mask, T::Mask) {
    let zero = params.zero();
    let may_rise = start.position_m.z.is_negative() & start.velocity_m_s.z.is_positive();
    if !may_rise.any() {
        return (may_rise, may_rise);
    }
    // A ball that stays far from the ring rises outside it: the exact point does not matter.
    let outside = may_rise & is_far(params, start) & end_z.is_positive();
    let may_rise = may_rise & !outside;
    if !may_rise.any() {
        return (outside, may_rise);
    }
    let rise_s = arc.rises_through(zero);
    let rises = may_rise & zero.lt(rise_s) & rise_s.lt(end);
    let p = arc.position(rise_s);
    let distance_squared = p.x.squared() + p.y.squared();
    (
        rises | outside,
        rises & distance_squared.lt(params.ring.radius.squared()),
    )
}

/// Where the centre falls through z = -reach (`falls_s`), or is at its highest point below it.
#[inline(always)]
fn fall_s<T: Real>(
    params: &ModelParams<T>,
    arc: &DragPolynomial<T>,
    start: &BallState<T>,
    falls_s: T,
) -> T {
    let (zero, never) = (params.zero(), params.ball.never_s);
    let bottom = -params.ring.reach;
    let starts_below = start.position_m.z.lt(bottom) & falls_s.lt(never);
    if !starts_below.any() {
        return falls_s;
    }
    let rises = start.velocity_m_s.z.is_positive();
    let (top, top_s) = arc.top();
    let never_rose = starts_below & (!rises | top.lt(bottom));
    top_s.select(rises, zero).select(never_rose, falls_s)
}

#[inline(always)]
fn board_events<T: Real>(
    params: &ModelParams<T>,
    arc: &DragPolynomial<T>,
    start: &BallState<T>,
    inverse_x: T,
) -> BoardEvents<T> {
    let board = &params.board;
    let (zero, one, never) = (params.zero(), params.one(), params.ball.never_s);
    let x = start.position_m.x;
    let approaching = arc.displacement.x.is_negative();
    let plane = Real::max((board.touch_x - x) * inverse_x, zero);
    let behind = Real::max((board.core.low.x - x) * inverse_x, zero);
    let is_past = x.lt(board.touch_x - params.splat(BEHIND_PLANE_M));
    let reaches = approaching & plane.le(one) & !is_past;
    let mut on_face = params.splat_mask(false);
    if reaches.any() {
        let p = arc.position(plane);
        on_face =
            reaches & p.y.abs().lt(board.half_width) & board.bottom_z.lt(p.z) & p.z.lt(board.top_z);
    }
    let is_behind = x.lt(board.core.low.x);
    BoardEvents {
        face: plane.select(on_face, never),
        edges: zero.select(is_past, plane.select(reaches & !on_face, never)),
        behind: zero.select(
            is_behind,
            behind.select(approaching & behind.le(one), never),
        ),
    }
}

/// Whether the part of an arc stays above, below or on one side of everything that the board can
/// touch.
#[inline(always)]
fn passes_beside<T: Real>(
    params: &ModelParams<T>,
    arc: &DragPolynomial<T>,
    from: T,
    to: T,
) -> T::Mask {
    let core = &params.board.core;
    let (first, last) = (
        arc.position(Real::min(from, params.one())),
        arc.position(to),
    );
    let side = core.high.y + core.reach;
    let above = (core.high.z + core.reach).lt(Real::min(first.z, last.z));
    let left = side.lt(Real::min(first.y, last.y));
    let right = Real::max(first.y, last.y).lt(-side);
    above | left | right
}

/// Whether a part of an arc comes where the bracket is nearer than the ring's circle: outside the
/// circle, which is so at one of its ends if anywhere, and near the bracket.
#[inline(always)]
fn comes_to_bracket<T: Real>(
    params: &ModelParams<T>,
    arc: &DragPolynomial<T>,
    from: T,
    to: T,
) -> T::Mask {
    let bracket = &params.ring.bracket;
    let (first, last) = (
        arc.position(Real::min(from, params.one())),
        arc.position(to),
    );
    let radius_squared = params.ring.radius.squared();
    let outside = radius_squared.lt(first.x.squared() + first.y.squared())
        | radius_squared.lt(last.x.squared() + last.y.squared());
    let reach = bracket.reach;
    let side = bracket.high.y + reach;
    let near_x = Real::min(first.x, last.x).lt(bracket.high.x + reach);
    let near_y = Real::min(first.y, last.y).lt(side) & (-side).lt(Real::max(first.y, last.y));
    outside & near_x & near_y
}

/// The s between two values at which the ball first touches a plate with a convex core (else
/// never), and whether the search reached its limit.
#[inline(always)]
fn convex_touch<T: Real>(
    core: &Rectangle<T>,
    arc: &DragPolynomial<T>,
    (from, to): (T, T),
    lanes: T::Mask,
) -> (T, T::Mask) {
    from.outlined(
        #[inline(always)]
        || search_convex(core, arc, (from, to), lanes),
    )
}

#[inline(always)]
fn search_convex<T: Real>(
    core: &Rectangle<T>,
    arc: &DragPolynomial<T>,
    (from, to): (T, T),
    lanes: T::Mask,
) -> (T, T::Mask) {
    let mut found = from.splat(NEVER);
    let mut s = from;
    let mut searching = lanes;
    let bound = arc.acceleration_bound();
    let mut iterations = 0;
    while searching.any() && iterations < MAX_ITERATIONS {
        iterations += 1;
        let (gap, rate) = core.gap(&arc.state_in_s(s));
        let (touches, step) = gap_step(gap, rate, bound);
        let touches = touches & searching;
        found = s.select(touches, found);
        s = (s + step).select(searching & !touches, s);
        searching = searching & !touches & s.lt(to);
    }
    (found, searching)
}

/// An s that is not on the arc.
const NEVER: f64 = 1e9;
