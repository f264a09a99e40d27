//! The rules that end a shot, written once for every integrator and for the lanes.

use super::contact::oscillator::Oscillator;
use super::outcome::Ending;
use crate::math::real::Real;
use crate::math::vector::RealVector;
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{FramedPart, TOUCH_GAP_M};

/// Settings of a simulation that are not part of the equations: limits, steps and precision.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShotLimits {
    /// Longest step of a contact in the world frame with one solid, and with both, s.
    pub(crate) longest_world_steps_s: [f64; 2],
    /// Contacts with one solid are computed in single precision.
    pub(crate) single_precision: bool,
    /// The normal motion and the longest step in contact with each part, in the order of
    /// [`FramedPart`].
    pub(crate) oscillators: [Oscillator; FramedPart::COUNT],
    /// A shot that takes longer ends, s.
    pub(crate) time_limit_s: f64,
    /// A ball that rolls on two solids for this long is lodged, s; 0 for never.
    pub(crate) lodged_after_s: f64,
    /// A shot that takes this many steps in contact is given up as unresolved.
    pub(crate) max_steps: u32,
}

/// Whether a step in contact ends the shot, and how; lane by lane.
#[derive(Clone, Copy)]
pub(crate) struct ShotEndFlags<T: Real> {
    behind_board: T::Mask,
    fell: T::Mask,
    too_late: T::Mask,
}

impl<T: Real> ShotEndFlags<T> {
    /// After a step in contact to `state`.
    #[inline(always)]
    pub(crate) fn new(params: &ModelParams<T>, state: &BallState<T>, too_late: T::Mask) -> Self {
        Self {
            behind_board: state.position_m.x.lt(params.board.core.low.x),
            fell: fell_below_ring(params, state),
            too_late,
        }
    }

    /// The masks in the order of [`first_ending`].
    #[inline(always)]
    pub(crate) fn masks(&self) -> [T::Mask; 3] {
        [self.behind_board, self.fell, self.too_late]
    }
}

impl<T: Real<Mask = bool>> ShotEndFlags<T> {
    /// How the shot ended, if it did.
    pub(crate) fn ending(self) -> Option<Ending> {
        first_ending(self.masks())
    }
}

/// How a shot ended, if it did, from the values of [`ShotEndFlags::masks`]. If several rules apply,
/// the first one counts.
#[inline(always)]
pub(crate) fn first_ending([behind_board, fell, too_late]: [bool; 3]) -> Option<Ending> {
    if behind_board {
        Some(Ending::BehindBoard)
    } else if fell {
        Some(Ending::Fell)
    } else if too_late {
        Some(Ending::TimeLimit)
    } else {
        None
    }
}

/// Whether the centre is below `z = -(R + r)` (r the radius of the rod) and falls. The ring can no
/// longer touch the ball, and the shot ends.
#[inline(always)]
pub(crate) fn fell_below_ring<T: Real>(params: &ModelParams<T>, state: &BallState<T>) -> T::Mask {
    state.position_m.z.lt(-params.ring.reach) & state.velocity_m_s.z.is_negative()
}

/// Whether a flight that ended at `state`, without a touch, ended by falling through `z = -reach`.
/// One that never rises so high ends at its highest point.
#[inline(always)]
pub(crate) fn rose_to_ring<T: Real>(params: &ModelParams<T>, state: &BallState<T>) -> T::Mask {
    let height = params.splat(-1.0) * params.ring.reach - TOUCH_GAP_M;
    height.lt(state.position_m.z)
}

/// The speed above which a shot has diverged, m/s. No ball that comes to a hoop is so fast.
const LARGEST_SPEED_M_S: f64 = 1000.0;

/// Whether the numerics have lost a ball: its speed is above the limit, or not a number. (Seen
/// where gravity is a hundred times that of the earth, and a step of a contact crosses the whole
/// hoop.) Such a shot is unresolved.
#[inline(always)]
pub(crate) fn has_diverged<T: Real>(params: &ModelParams<T>, state: &BallState<T>) -> T::Mask {
    let largest = params.splat(LARGEST_SPEED_M_S * LARGEST_SPEED_M_S);
    !state.velocity_m_s.norm_squared().le(largest)
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
pub(crate) fn is_lodged<T: Real>(rolling_time_s: T, lodged_after_s: f64) -> T::Mask {
    if lodged_after_s > 0.0 {
        rolling_time_s.splat(lodged_after_s).le(rolling_time_s)
    } else {
        rolling_time_s.splat_mask(false)
    }
}
