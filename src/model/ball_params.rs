//! The ball and gravity, as the equations of motion use them.

use crate::math::real::Real;

/// The parameters of a ball in free motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BallParams<T = f64> {
    /// Radius R of the ball, m.
    pub(crate) radius: T,
    /// m/I, 1/m^2.
    pub(crate) mass_over_inertia: T,
    /// g, m/s^2.
    pub(crate) gravity: T,
    pub(crate) half_gravity: T,
    /// 1/g, s^2/m.
    pub(crate) inverse_gravity: T,
    /// Time of an event that will not happen, s.
    pub(crate) never_s: T,
}

impl BallParams {
    #[inline(always)]
    pub(super) fn map<T: Real>(&self, splat: &impl Fn(f64) -> T) -> BallParams<T> {
        BallParams {
            radius: splat(self.radius),
            mass_over_inertia: splat(self.mass_over_inertia),
            gravity: splat(self.gravity),
            half_gravity: splat(self.half_gravity),
            inverse_gravity: splat(self.inverse_gravity),
            never_s: splat(self.never_s),
        }
    }
}

impl<T: Real> BallParams<T> {
    /// `value` in every lane.
    #[inline(always)]
    pub(crate) fn splat(&self, value: f64) -> T {
        self.gravity.splat(value)
    }
    #[inline(always)]
    pub(crate) fn zero(&self) -> T {
        self.gravity.zero()
    }
    #[inline(always)]
    pub(crate) fn one(&self) -> T {
        self.gravity.one()
    }
    /// `value` in every lane of a mask.
    #[inline(always)]
    pub(crate) fn splat_mask(&self, value: bool) -> T::Mask {
        self.gravity.splat_mask(value)
    }
}
