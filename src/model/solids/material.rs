//! The contact law between the ball and a solid.

use crate::math::real::Real;

/// The contact law between the ball and a solid, per unit of ball mass.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Material<T> {
    /// k/m, 1/s^2.
    pub(crate) stiffness: T,
    /// c/m, 1/s.
    pub(crate) damping: T,
    /// c/k, s: about the time from zero force to zero compression of an outgoing ball.
    pub(crate) relaxation_time: T,
    /// Coefficient of kinetic friction mu.
    pub(crate) friction_coefficient: T,
}

impl Material<f64> {
    #[inline(always)]
    pub(super) fn map<T: Real>(&self, splat: &impl Fn(f64) -> T) -> Material<T> {
        Material {
            stiffness: splat(self.stiffness),
            damping: splat(self.damping),
            relaxation_time: splat(self.relaxation_time),
            friction_coefficient: splat(self.friction_coefficient),
        }
    }
}

impl<T: Real> Material<T> {
    /// The material where the ball touches the solid; elsewhere one without force.
    #[inline(always)]
    pub(crate) fn where_touching(&self, touching: T::Mask) -> Self {
        let zero = self.stiffness.zero();
        Self {
            stiffness: self.stiffness.select(touching, zero),
            damping: self.damping.select(touching, zero),
            relaxation_time: self.relaxation_time,
            friction_coefficient: self.friction_coefficient.select(touching, zero),
        }
    }
}
