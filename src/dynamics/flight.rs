//! Free flight: parabolas, and their first touch found for certain.
//!
//! Board: the centre reaches the plane `x = R - a`, linear in time. Ring: the first root of
//! `F(t) = (R_H - D)^2 + z^2 - R^2`, where `D` is the distance from the hoop's axis. Stretches with
//! `|z| > R` or `|D - R_H| > R` are jumped. Elsewhere
//!
//! ```text
//! F'' = 2 (v_h^2 + v_z^2 - g z - R_H L^2/D^3),    L = x v_y - y v_x (constant in flight)
//! ```
//!
//! is bounded from below by some `-M`, so the step `2 F/(sqrt(F'^2 + 2 M F) - F')` never passes a
//! root: grazes are found, however short. Where M = 0 (most shots) the step is Newton's.

use super::state::{Law, State, Triple};
use crate::lane::{Lane, Mask};

/// F at which an approaching ball has touched the ring, as a part of R^2.
const TOUCHED: f64 = 1e-10;
/// Jumps shorter than this are left to the safe step, s.
const NO_JUMP_S: f64 = 1e-9;
/// Bound on the search's passes; the search needs one or two, seldom more than ten.
const MOST_PASSES: u32 = 200;

/// How an arc of free flight ends, as times from its start; the smallest is what happens.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arc<L: Lane> {
    /// The centre falls through `z = -R`.
    pub(crate) end: L,
    /// The ball touches the board's rectangle.
    pub(crate) board: L,
    /// The ball overlaps the board's plane beside the rectangle and might come on to it, or pass
    /// behind the face: needs the side path.
    pub(crate) beside_board: L,
    /// The ball touches the ring.
    pub(crate) ring: L,
    /// The search for the ring stopped at its bound (never seen; such a shot is not a miss).
    pub(crate) unresolved: L::Mask,
}

impl<L: Lane> Arc<L> {
    /// Times of what may end the arc that starts at `state`.
    #[inline(always)]
    pub(crate) fn from(law: &Law<L>, state: &State<L>) -> Self {
        let Triple(_, _, vz) = state.velocity_m_s;
        let z = state.position_m.2;
        let end = falling_time(law, z, vz, -law.radius).most(law.zero);
        let (board, beside_board) = board_times(law, state, end);
        let horizon = end.least(board).least(beside_board);
        let (ring, unresolved) = ring_time(law, state, horizon);
        Self {
            end,
            board,
            beside_board,
            ring,
            unresolved,
        }
    }
}

/// Time at which the centre falls through the height `level`; for a ball that never gets there,
/// that of its highest point.
#[inline(always)]
pub(crate) fn falling_time<L: Lane>(law: &Law<L>, z: L, vz: L, level: L) -> L {
    let square = vz.squared() + law.gravity * (z - level) * 2.0;
    (vz + square.most(law.zero).sqrt()) * law.per_gravity
}

/// Time at which the centre rises through `level`; meaningful only if it starts below and gets there.
#[inline(always)]
pub(crate) fn rising_time<L: Lane>(law: &Law<L>, z: L, vz: L, level: L) -> L {
    let square = vz.squared() + law.gravity * (z - level) * 2.0;
    (vz - square.most(law.zero).sqrt()) * law.per_gravity
}

/// Times at which the ball touches the board, and at which it reaches its plane beside it.
#[inline(always)]
fn board_times<L: Lane>(law: &Law<L>, state: &State<L>, end: L) -> (L, L) {
    let Triple(x, y, z) = state.position_m;
    let Triple(vx, vy, vz) = state.velocity_m_s;
    let approaching = vx.lt(law.zero);
    let speed = (-vx).when(approaching, law.one);
    let reach = (x - law.board_touch_x) / speed;
    let overlapping = reach.lt(law.zero.lit(-NO_JUMP_S));
    let t = reach.most(law.zero);
    let y_there = y + vy * t;
    let z_there = z + vz * t - law.half_gravity * t * t;
    let on = y_there.abs().lt(law.board_half_width)
        & law.board_bottom_z.lt(z_there)
        & z_there.lt(law.board_top_z)
        & !overlapping;
    let comes = approaching & t.lt(end);
    (
        t.when(comes & on, law.never),
        t.when(comes & !on, law.never),
    )
}

/// Time of the first touch of the ring before `horizon`.
#[inline(always)]
fn ring_time<L: Lane>(law: &Law<L>, state: &State<L>, horizon: L) -> (L, L::Mask) {
    let Triple(x, y, z) = state.position_m;
    let Triple(vx, vy, vz) = state.velocity_m_s;
    let outer = law.ring_radius + law.radius;
    let inner = law.ring_radius - law.radius;

    // Horizontal motion: D^2 = |p|^2 + 2 (p.v) t + |v|^2 t^2.
    let level_square = vx.squared() + vy.squared();
    let still = level_square.le(law.zero.lit(1e-12));
    let per_square = law.one / law.one.when(still, level_square);
    let along = x * vx + y * vy;
    let moment = x * vy - y * vx;
    let distance_square = x.squared() + y.squared();
    let closest_square = law.zero.when(still, moment.squared() * per_square);
    let closest_time = -(along * per_square);
    let outer_square = (outer.squared() - closest_square) * per_square;
    let half_chord = outer_square.most(law.zero).sqrt();
    let enters = closest_time - half_chord;
    let leaves = (closest_time + half_chord).when(!still, law.never);
    let out_of_reach =
        !still & outer_square.lt(law.zero) | still & outer.squared().lt(distance_square);
    let stop = horizon.least(leaves);
    let sinks = falling_time(law, z, vz, law.radius);
    let mut t = enters.when(!still, law.zero).most(law.zero);
    // Start where the descent through z = R and the approach have both happened, unless the ball
    // is then still below the slab's top on its way up (a release from beneath).
    let z_then = z + vz * t - law.half_gravity * t * t;
    t = sinks.most(t).when(law.radius.lt(z_then), t);

    let mut searching = t.lt(stop) & !out_of_reach;
    let mut found = law.never;
    let mut passes = 0;
    if searching.any() {
        let inner_chord = ((inner.squared() - closest_square) * per_square)
            .most(law.zero)
            .sqrt();
        let inner_leave = (closest_time + inner_chord).when(!still, law.never);
        let inner_enter = (closest_time - inner_chord).when(!still, -law.never);
        let rises = rising_time(law, z, vz, -law.radius);
        let rises_over = rising_time(law, z, vz, law.radius);
        let nearest = inner.squared().most(closest_square);
        let turning = law.ring_radius * moment.squared() / (nearest * nearest.sqrt());
        let touched = law.radius.squared() * TOUCHED;
        while searching.any() && passes < MOST_PASSES {
            passes += 1;
            let zt = z + vz * t - law.half_gravity * t * t;
            let vzt = vz - law.gravity * t;
            let dist = ((level_square * t + along * 2.0) * t + distance_square).sqrt();
            let off = law.ring_radius - dist;
            let value = off.squared() + zt.squared() - law.radius.squared();
            let half_slope =
                zt * vzt - off * (level_square * t + along) / dist.most(law.radius * 1e-3);
            let fall_square = law.zero.when(law.zero.lt(vzt), vzt.squared());
            let bend =
                (turning + law.gravity * law.radius - level_square - fall_square).most(law.zero);
            // value + 2 half_slope s - bend s^2 >= 0 up to s. What little overlap a parting leaves
            // counts as none.
            let root = (half_slope.squared() + bend * value.most(law.zero)).sqrt();
            let closing = half_slope.le(law.zero);
            let away = law.zero.lt(bend);
            let over = value.when(closing, (half_slope + root).when(away, law.never));
            let under = (root - half_slope).when(closing, bend.when(away, law.one));
            let s = over / under;
            let touch = closing & value.le(touched) & searching;
            found = t.when(touch, found);
            // Jumps over stretches where no touch is possible.
            let below = zt.lt(-law.radius) & law.zero.lt(vzt);
            let within = dist.lt(inner);
            let over = law.radius.lt(zt);
            let jump = sinks
                .when(over, law.zero)
                .most(rises.when(below, law.zero))
                .most(inner_leave.when(within, law.zero));
            let jumps = (t + NO_JUMP_S).lt(jump);
            // The bound holds up to the inner circle and, rising, up to the slab's top; beyond them
            // comes a stretch to jump.
            let safe = t + s;
            let to_inner = t.lt(inner_enter) & inner_enter.lt(safe);
            let to_over = t.lt(rises_over) & rises_over.lt(safe) & !to_inner;
            let step = inner_leave.when(to_inner, sinks.when(to_over, safe));
            let next = jump.when(jumps, step);
            t = next.when(searching, t);
            searching = searching & !touch & t.lt(stop);
        }
    }
    (found, searching)
}

impl Arc<f64> {
    /// Looks for the ring again, up to another horizon.
    pub(crate) fn seek_ring(&mut self, law: &Law, state: &State, horizon: f64) {
        (self.ring, self.unresolved) = ring_time(law, state, horizon);
    }
}

/// Is the centre level with the board and in front of its face?
#[inline(always)]
pub(crate) fn on_board<L: Lane>(law: &Law<L>, state: &State<L>) -> L::Mask {
    let Triple(x, y, z) = state.position_m;
    law.board_face_x.lt(x)
        & y.abs().lt(law.board_half_width)
        & law.board_bottom_z.lt(z)
        & z.lt(law.board_top_z)
}

/// For a ball whose centre is beside the board's rectangle at time `from` of its arc, nearer to the
/// plane than its radius: the times at which it comes on to the rectangle and at which its centre
/// passes the face.
pub(crate) fn beside_board(law: &Law, state: &State, from: f64) -> (f64, f64) {
    /// Looks, and enters, just past a crossing: on the edge itself the ball is still beside.
    const PAST_S: f64 = 1e-9;
    let Triple(x, y, z) = state.position_m;
    let Triple(vx, vy, vz) = state.velocity_m_s;
    let face = ((law.board_face_x - x) / vx).max(0.0);
    let enters = [
        from,
        (law.board_half_width - y) / vy,
        (-law.board_half_width - y) / vy,
        falling_time(law, z, vz, law.board_top_z),
        rising_time(law, z, vz, law.board_bottom_z),
    ]
    .into_iter()
    .map(|t| t + PAST_S)
    .filter(|&t| t > from && t < face && on_board(law, &state.flown(law, t)))
    .fold(law.never, f64::min);
    (enters, face)
}
