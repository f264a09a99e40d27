//! What decides between made and missed, apart from the contacts.
//!
//! A ball is made when it falls through `z = -R` within the ring, has been above the plane of the
//! hoop, and its centre never rose through the hoop from below. The last condition is taken by the
//! letter: a ball that dips below the plane inside the ring and is thrown up through it again is
//! missed even where it then falls in (6 of a thousand made shots of the sample *foul*;
//! `docs/model.md` gives the measured effect).

use super::state::{Law, State, Triple};
use crate::lane::Lane;

/// Has the ball been above the plane of the hoop, and has it risen through the hoop from below?
#[derive(Clone, Copy, Debug)]
pub(crate) struct Passage<L: Lane = f64> {
    pub(crate) above: L::Mask,
    pub(crate) rose_through: L::Mask,
}

impl<L: Lane> Passage<L> {
    /// At the release.
    #[inline(always)]
    pub(crate) fn at_release(law: &Law<L>, state: &State<L>) -> Self {
        Self {
            above: law.zero.le(state.position_m.2),
            rose_through: law.zero.mask(false),
        }
    }

    /// After flight for `dt` from `start`.
    #[inline(always)]
    pub(crate) fn flight(&mut self, law: &Law<L>, start: &State<L>, dt: L) {
        let Triple(x, y, z) = start.position_m;
        let Triple(vx, vy, vz) = start.velocity_m_s;
        let square = vz.squared() + law.gravity * z * 2.0;
        let t = (vz - square.most(law.zero).sqrt()) * law.per_gravity;
        let rises = z.lt(law.zero) & law.zero.le(square) & law.zero.lt(vz) & t.lt(dt);
        let distance_square = (x + vx * t).squared() + (y + vy * t).squared();
        let inside = distance_square.lt(law.ring_radius.squared());
        self.rose_through = self.rose_through | (rises & inside);
        self.above = self.above | rises;
    }

    /// After a step in contact, where one was made.
    #[inline(always)]
    pub(crate) fn step(
        &mut self,
        law: &Law<L>,
        before: &State<L>,
        after: &State<L>,
        stepped: L::Mask,
    ) {
        let rises = before.position_m.2.lt(law.zero) & law.zero.le(after.position_m.2) & stepped;
        let inside = after.axis_square().lt(law.ring_radius.squared());
        self.rose_through = self.rose_through | (rises & inside);
        self.above = self.above | rises;
    }

    /// Is a ball that has fallen through `z = -R` at `state` made?
    #[inline(always)]
    pub(crate) fn made(&self, law: &Law<L>, state: &State<L>) -> L::Mask {
        self.above & !self.rose_through & state.axis_square().lt(law.ring_radius.squared())
    }
}
