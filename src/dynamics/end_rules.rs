//! The rules that end a shot, written once for every integrator and for the lanes.

use super::outcome::Ending;
use crate::math::real::Real;
use crate::model::BallState;
use crate::model::model_params::ModelParams;
use crate::model::solids::TOUCH_GAP_M;

/// Limits that belong to a run and not to the equations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RunLimits {
    /// Longest step in contact, s.
    pub(crate) longest_step_s: f64,
    /// A shot that takes longer ends, s.
    pub(crate) time_limit_s: f64,
    /// A ball that rolls on two solids for this long is lodged, s; 0 for never.
    pub(crate) lodged_after_s: f64,
}

/// Whether a step in contact ends the shot, and how; lane by lane.
#[derive(Clone, Copy)]
pub(crate) struct ContactEnd<R: Real> {
    behind_board: R::Mask,
    fell: R::Mask,
    late: R::Mask,
}

impl<R: Real> ContactEnd<R> {
    /// After a step in contact to `state` at `time_s` after the release.
    #[inline(always)]
    pub(crate) fn new(
        params: &ModelParams<R>,
        state: &BallState<R>,
        time_s: R,
        time_limit_s: f64,
    ) -> Self {
        Self {
            behind_board: state.position_m.x.lt(params.board.face_x),
            fell: fell_below_ring(params, state),
            late: params.splat(time_limit_s).lt(time_s),
        }
    }

    /// Whether the shot has ended.
    #[inline(always)]
    pub(crate) fn any(&self) -> R::Mask {
        self.behind_board | self.fell | self.late
    }

    /// One number for each mask, in the order of [`ContactEnd::ending`].
    #[inline(always)]
    pub(crate) fn map<T>(&self, number: impl Fn(R::Mask) -> T) -> [T; 3] {
        [
            number(self.behind_board),
            number(self.fell),
            number(self.late),
        ]
    }
}

impl ContactEnd<f64> {
    /// How the shot ended, if it did. If several rules apply, the first one counts.
    #[inline(always)]
    pub(crate) fn ending([behind_board, fell, late]: [bool; 3]) -> Option<Ending> {
        if behind_board {
            Some(Ending::BehindBoard)
        } else if fell {
            Some(Ending::Fell)
        } else if late {
            Some(Ending::TimeLimit)
        } else {
            None
        }
    }

    /// The same for the scalar form.
    pub(crate) fn resolve(self) -> Option<Ending> {
        Self::ending(self.map(|rule| rule))
    }
}

/// Whether the centre is below `z = -R` and falls: nothing can touch the ball any more.
#[inline(always)]
pub(crate) fn fell_below_ring<R: Real>(params: &ModelParams<R>, state: &BallState<R>) -> R::Mask {
    state.position_m.z.lt(-params.ball.radius) & state.velocity_m_s.z.is_negative()
}

/// Whether a flight that ended at `z = -R` had risen above it: `state` is its end. A flight that never
/// rises so high ends at its highest point.
#[inline(always)]
pub(crate) fn rose_to_ring<R: Real>(params: &ModelParams<R>, state: &BallState<R>) -> R::Mask {
    let level = params.splat(-1.0) * params.ball.radius - TOUCH_GAP_M;
    level.lt(state.position_m.z)
}

/// How a flight ended that reached neither a solid nor the time limit.
pub(crate) fn flight_ending(rose: bool) -> Ending {
    if rose {
        Ending::Fell
    } else {
        Ending::NeverRose
    }
}

/// Whether a ball that has rolled on two solids for `rolling_time_s` is lodged.
#[inline(always)]
pub(crate) fn is_lodged<R: Real>(rolling_time_s: R, lodged_after_s: f64) -> R::Mask {
    if lodged_after_s > 0.0 {
        rolling_time_s.splat(lodged_after_s).le(rolling_time_s)
    } else {
        rolling_time_s.splat_mask(false)
    }
}
