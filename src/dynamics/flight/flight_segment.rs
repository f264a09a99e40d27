//! A flight under drag and lift, or at solids with edges and bracket, in segments: each is the time
//! for which one polynomial holds, or less if the flight ends in it.

use crate::math::real::Real;
use crate::model::{BallState, SolidId};

/// A segment of a flight. At most one of the endings holds in a lane; where none does, the flight
/// goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlightSegment<T: Real = f64> {
    /// Its length, s.
    pub(crate) dt: T,
    /// The state at its end.
    pub(crate) end: BallState<T>,
    /// The ball touches a solid; by [`SolidId::index`].
    pub(crate) touches: [T::Mask; SolidId::COUNT],
    /// The centre falls below the reach of the ring, or is at its highest point below it.
    pub(crate) fell: T::Mask,
    /// The centre passes the plane of the board's core. (On the paper's board also: the ball
    /// touches it beside its face, where it does not act.)
    pub(crate) behind_board: T::Mask,
    /// The ball has diverged, or the search reached its iteration limit.
    pub(crate) unresolved: T::Mask,
    /// The centre rises through the plane of the hoop, and does so inside the ring.
    pub(crate) rises: T::Mask,
    pub(crate) rises_inside: T::Mask,
}

impl<T: Real> FlightSegment<T> {
    /// Whether the flight ends with this segment.
    #[inline(always)]
    pub(crate) fn ends(&self) -> T::Mask {
        let [board, ring] = self.touches;
        board | ring | self.fell | self.behind_board | self.unresolved
    }
}
