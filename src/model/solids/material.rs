//! The contact law between the ball and a solid.

use crate::math::real::Real;

/// The contact law between the ball and a solid, per unit of ball mass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Material<R> {
    /// k/m, 1/s^2.
    pub(crate) stiffness: R,
    /// c/m, 1/s.
    pub(crate) damping: R,
    /// c/k, s: about the time from zero force (N = 0) to zero compression (u = 0) of an outgoing ball.
    pub(crate) relaxation_time: R,
    /// Coefficient of kinetic friction mu.
    pub(crate) friction: R,
}

impl Material<f64> {
    #[inline(always)]
    pub(super) fn map<R: Real>(&self, splat: &impl Fn(f64) -> R) -> Material<R> {
        Material {
            stiffness: splat(self.stiffness),
            damping: splat(self.damping),
            relaxation_time: splat(self.relaxation_time),
            friction: splat(self.friction),
        }
    }
}
