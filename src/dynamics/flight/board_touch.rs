//! The first touch of the board: the centre reaches the *touch plane*, the ball's radius in front
//! of the *face plane*. In free flight x is linear in time.

use super::height_crossing::{falling_time, rising_time};
use crate::math::real::Real;
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::Solid;

/// A ball that passed the touch plane earlier than this overlaps the board, s.
const OVERLAP_TOLERANCE_S: f64 = 1e-9;

/// Times at which the ball touches the board, and at which it reaches the touch plane outside the
/// rectangle.
#[inline(always)]
pub(super) fn board_times<T: Real>(
    params: &ModelParams<T>,
    state: &BallState<T>,
    end: T,
) -> (T, T) {
    let board = &params.board;
    let (p, v) = (state.position_m, state.velocity_m_s);
    let approaching = v.x.is_negative();
    let speed = (-v.x).select(approaching, params.one());
    let touch_time = (p.x - board.touch_x) / speed;
    let overlapping = touch_time.lt(params.splat(-OVERLAP_TOLERANCE_S));
    let t = touch_time.positive_part();
    let y = p.y + v.y * t;
    let z = p.z + v.z * t - params.ball.half_gravity * t * t;
    let on_rectangle =
        y.abs().lt(board.half_width) & board.bottom_z.lt(z) & z.lt(board.top_z) & !overlapping;
    let arrives = approaching & t.lt(end);
    (
        t.select(arrives & on_rectangle, params.ball.never_s),
        t.select(arrives & !on_rectangle, params.ball.never_s),
    )
}

/// For a ball whose centre is beside the rectangle at the time `from` of its flight, between the
/// touch plane and the face plane: the times at which the centre comes in front of the rectangle,
/// and at which it passes the face plane.
pub(super) fn entry_from_beside(params: &ModelParams, state: &BallState, from: f64) -> (f64, f64) {
    /// Time after a crossing at which to look: on the edge itself the ball is still beside the
    /// rectangle.
    const PAST_S: f64 = 1e-9;
    let board = &params.board;
    let [x, y, z] = state.position_m.into();
    let v = state.velocity_m_s;
    let face = ((board.face_x - x) / v.x).max(0.0);
    let enters = [
        from,
        (board.half_width - y) / v.y,
        (-board.half_width - y) / v.y,
        falling_time(params, z, v.z, board.top_z),
        rising_time(params, z, v.z, board.bottom_z),
    ]
    .into_iter()
    .map(|t| t + PAST_S)
    .filter(|&t| t > from && t < face && board.is_in_frame(&state.after_flight(&params.ball, t)))
    .fold(params.ball.never_s, f64::min);
    (enters, face)
}
