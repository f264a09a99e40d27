//! The ball, gravity and the air, as the equations of motion use them.

use crate::math::real::Real;
use crate::math::vector::{RealVector, Vec3};

/// The parameters of a ball in free motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BallParams<T = f64> {
    /// Radius R of the ball, m.
    pub(crate) radius: T,
    /// m/I, 1/m^2.
    pub(crate) mass_over_inertia: T,
    /// g less buoyancy, m/s^2.
    pub(crate) gravity: T,
    pub(crate) half_gravity: T,
    /// 1/g, s^2/m.
    pub(crate) inverse_gravity: T,
    /// Deceleration by drag over the square of the speed, 1/m.
    pub(crate) drag: T,
    /// `k^(1/4)/g^(1/2)` with k the drag: its fourth power times that of a speed is the deviation
    /// of a path by drag while gravity changes the velocity by that speed, m.
    pub(crate) drag_strength: T,
    /// Acceleration by lift over the product of spin and speed.
    pub(crate) lift: T,
    /// Drag or lift act; lift acts.
    pub(crate) has_air: bool,
    pub(crate) has_lift: bool,
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
            drag: splat(self.drag),
            drag_strength: splat(self.drag_strength),
            lift: splat(self.lift),
            has_air: self.has_air,
            has_lift: self.has_lift,
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

    /// The acceleration by drag and lift of a ball with the given velocity and spin, in any
    /// right-handed frame. It is zero without air.
    #[inline(always)]
    pub(crate) fn air_acceleration(&self, velocity: Vec3<T>, spin: Vec3<T>) -> Vec3<T> {
        let (v, w) = (velocity, spin);
        let drag = -(self.drag * v.norm());
        Vec3::new(
            drag * v.x + self.lift * (w.y * v.z - w.z * v.y),
            drag * v.y + self.lift * (w.z * v.x - w.x * v.z),
            drag * v.z + self.lift * (w.x * v.y - w.y * v.x),
        )
    }

    /// The acceleration by gravity, drag and lift.
    #[inline(always)]
    pub(crate) fn free_acceleration(&self, velocity: Vec3<T>, spin: Vec3<T>) -> Vec3<T> {
        let gravity = Vec3::new(self.zero(), self.zero(), -self.gravity);
        if self.has_air {
            gravity + self.air_acceleration(velocity, spin)
        } else {
            gravity
        }
    }
}
