//! The ball and gravity, as the equations of motion use them.

use crate::math::real::Real;

/// The parameters of a ball in free motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BallParams<R = f64> {
    /// Radius R of the ball, m.
    pub(crate) radius: R,
    /// m/I, 1/m^2.
    pub(crate) mass_over_inertia: R,
    /// g, m/s^2.
    pub(crate) gravity: R,
    pub(crate) half_gravity: R,
    /// 1/g, s^2/m.
    pub(crate) per_gravity: R,
    /// Time of an event that will not happen, s.
    pub(crate) never: R,
}

impl BallParams {
    #[inline(always)]
    pub(super) fn map<R: Real>(&self, splat: &impl Fn(f64) -> R) -> BallParams<R> {
        BallParams {
            radius: splat(self.radius),
            mass_over_inertia: splat(self.mass_over_inertia),
            gravity: splat(self.gravity),
            half_gravity: splat(self.half_gravity),
            per_gravity: splat(self.per_gravity),
            never: splat(self.never),
        }
    }
}

impl<R: Real> BallParams<R> {
    /// `value` in every lane.
    #[inline(always)]
    pub(crate) fn splat(&self, value: f64) -> R {
        self.gravity.splat(value)
    }
    #[inline(always)]
    pub(crate) fn zero(&self) -> R {
        self.gravity.zero()
    }
    #[inline(always)]
    pub(crate) fn one(&self) -> R {
        self.gravity.one()
    }
    /// `value` in every lane of a mask.
    #[inline(always)]
    pub(crate) fn splat_mask(&self, value: bool) -> R::Mask {
        self.gravity.splat_mask(value)
    }
}
