//! One arc of free flight and how it ends.

use super::board_touch::{board_times, entry_from_beside};
use super::height_crossing::falling_time;
use super::height_path::{HeightPath, Parabola};
use super::ring_search::{HorizontalMotion, ring_time};
use crate::dynamics::end_rules::has_diverged;
use crate::math::real::Real;
use crate::math::vector::Vec2;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::{BallState, SolidId};

/// The possible ends of an arc of free flight, as times from its start, s. The earliest one
/// happens; `beside_board` is no end, but a time from which the board must be looked at again.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlightEvents<T: Real> {
    /// The centre falls through `z = -reach`.
    pub(crate) below_ring: T,
    /// The ball touches a solid; by [`SolidId::index`].
    pub(crate) touch: [T; SolidId::COUNT],
    /// The ball overlaps the plane of the board beside the rectangle:
    /// [`FlightEvents::resolve_beside_board`] says when the shot is over.
    pub(crate) beside_board: T,
    /// The ball has diverged, or the search for the ring reached its iteration limit. (The latter
    /// was never seen.)
    pub(crate) unresolved: T::Mask,
}

impl<T: Real> FlightEvents<T> {
    /// The ends of the arc that starts at `state`.
    #[inline(always)]
    pub(crate) fn new(params: &ModelParams<T>, state: &BallState<T>) -> Self {
        let (z, vz) = (state.position_m.z, state.velocity_m_s.z);
        let below_ring = falling_time(params, z, vz, -params.ring.reach).positive_part();
        let (board, beside_board) = board_times(params, state, below_ring);
        let search_end = Real::min(Real::min(below_ring, board), beside_board);
        let (ring, unresolved) = first_ring_touch(params, state, search_end);
        Self {
            below_ring,
            touch: [board, ring],
            beside_board,
            unresolved: unresolved | has_diverged(params, state),
        }
    }

    /// Time at which the ball touches a solid.
    #[inline(always)]
    pub(crate) fn touch_of(&self, solid: SolidId) -> T {
        self.touch[solid.index()]
    }

    /// Time of the first touch of any solid, or of the fall below the ring if that is earlier.
    #[inline(always)]
    pub(crate) fn first_end(&self) -> T {
        let mut first = self.below_ring;
        for touch in self.touch {
            first = Real::min(first, touch);
        }
        first
    }
}

/// [`ring_time`] of a parabola.
#[inline(always)]
fn first_ring_touch<T: Real>(
    params: &ModelParams<T>,
    state: &BallState<T>,
    search_end: T,
) -> (T, T::Mask) {
    let (p, v) = (state.position_m, state.velocity_m_s);
    let motion = HorizontalMotion::new(params, p, Vec2::new(v.x, v.y));
    let heights = Parabola {
        params,
        z: p.z,
        vz: v.z,
    };
    let falls_to_reach = heights.falls_through_after(params.ring.reach);
    ring_time(params, &motion, &heights, (falls_to_reach, search_end))
}

impl FlightEvents<f64> {
    /// What the ball touches first, if anything.
    pub(crate) fn first_touch(&self) -> Option<SolidId> {
        let until = self.below_ring.min(self.beside_board);
        let [board, ring] = self.touch;
        if ring <= until && ring < board {
            Some(SolidId::Ring)
        } else if board < until {
            Some(SolidId::Board)
        } else {
            None
        }
    }

    /// Follows a ball that comes beside the board before anything else: updates the touch of the
    /// ring, and returns the time at which the shot is over (never, if the ball does not come
    /// beside the board first). That is when the centre passes behind the face, or comes in front
    /// of it: the ball would then be compressed at once and gain the energy of the spring from
    /// nothing.
    pub(crate) fn resolve_beside_board(&mut self, params: &ModelParams, state: &BallState) -> f64 {
        if self.beside_board >= self.first_end() {
            return params.ball.never_s;
        }
        let (enters, behind) = entry_from_beside(params, state, self.beside_board);
        let behind = behind.min(enters);
        self.touch[SolidId::Board.index()] = params.ball.never_s;
        let search_end = self.below_ring.min(behind);
        let (ring, unresolved) = first_ring_touch(params, state, search_end);
        self.touch[SolidId::Ring.index()] = ring;
        self.unresolved |= unresolved;
        behind
    }
}
