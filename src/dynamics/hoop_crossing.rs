//! How the ball crosses the plane of the hoop: with the contacts, this decides between made and missed.
//!
//! A shot is made if it falls through `z = -R` inside the ring, has been above the plane of the hoop, and
//! its centre never rose through the hoop from below. The last condition is taken literally: a ball that
//! dips below the plane inside the ring and bounces up through it again is missed, even if it then falls
//! in (this turns 6 of a thousand shots that would otherwise be made into misses; `docs/model.md` gives the
//! measured effect).

use crate::math::real::Real;
use crate::model::BallState;
use crate::model::model_params::ModelParams;

/// The crossings of the plane of the hoop so far.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HoopCrossing<R: Real = f64> {
    /// The centre has been above the plane of the hoop.
    pub(crate) above: R::Mask,
    /// The centre has risen through the hoop from below.
    pub(crate) rose_through: R::Mask,
}

impl<R: Real> HoopCrossing<R> {
    /// At the release.
    #[inline(always)]
    pub(crate) fn at_release(params: &ModelParams<R>, state: &BallState<R>) -> Self {
        Self {
            above: params.zero().le(state.position_m.z),
            rose_through: params.splat_mask(false),
        }
    }

    /// Updates the crossings after flight for `dt` from `start`.
    #[inline(always)]
    pub(crate) fn after_flight(&mut self, params: &ModelParams<R>, start: &BallState<R>, dt: R) {
        let (p, v) = (start.position_m, start.velocity_m_s);
        let square = v.z.squared() + params.ball.gravity * p.z * 2.0;
        let t = (v.z - square.positive_part().sqrt()) * params.ball.per_gravity;
        let rises = p.z.is_negative() & params.zero().le(square) & v.z.is_positive() & t.lt(dt);
        let distance_squared = (p.x + v.x * t).squared() + (p.y + v.y * t).squared();
        let inside = distance_squared.lt(params.ring.radius.squared());
        self.rose_through = self.rose_through | (rises & inside);
        self.above = self.above | rises;
    }

    /// Updates the crossings after a step in contact, in the lanes that made one.
    #[inline(always)]
    pub(crate) fn after_step(
        &mut self,
        params: &ModelParams<R>,
        before: &BallState<R>,
        after: &BallState<R>,
        stepped: R::Mask,
    ) {
        let rises =
            before.position_m.z.is_negative() & params.zero().le(after.position_m.z) & stepped;
        let inside = after
            .axis_distance_squared()
            .lt(params.ring.radius.squared());
        self.rose_through = self.rose_through | (rises & inside);
        self.above = self.above | rises;
    }

    /// Whether a ball that has fallen through `z = -R` at `state` is made.
    #[inline(always)]
    pub(crate) fn is_made(&self, params: &ModelParams<R>, state: &BallState<R>) -> R::Mask {
        self.above
            & !self.rose_through
            & state
                .axis_distance_squared()
                .lt(params.ring.radius.squared())
    }
}
