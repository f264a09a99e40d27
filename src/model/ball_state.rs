//! Position, velocity and spin of the ball.

use super::ball_params::BallParams;
use crate::math::real::Real;
use crate::math::real_record::{RealRecord, RecordReader, RecordWriter};
use crate::math::vector::{RealVector, Vec3};

/// The nine state variables: position of the ball's centre, its velocity and its angular velocity.
///
/// Origin at the centre of the hoop, x from the board towards midcourt, z up, right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BallState<T: Real = f64> {
    /// Position of the centre, m.
    pub position_m: Vec3<T>,
    /// Velocity of the centre, m/s.
    pub velocity_m_s: Vec3<T>,
    /// Angular velocity, rad/s.
    pub spin_rad_s: Vec3<T>,
}

/// The time derivative of a [`BallState`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct StateDerivative<T: Real = f64> {
    pub(crate) velocity_m_s: Vec3<T>,
    pub(crate) acceleration_m_s2: Vec3<T>,
    pub(crate) angular_acceleration_rad_s2: Vec3<T>,
}

impl<T: Real> StateDerivative<T> {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Self {
            velocity_m_s: self.velocity_m_s + other.velocity_m_s,
            acceleration_m_s2: self.acceleration_m_s2 + other.acceleration_m_s2,
            angular_acceleration_rad_s2: self.angular_acceleration_rad_s2
                + other.angular_acceleration_rad_s2,
        }
    }
}

impl<T: Real> RealRecord<T> for BallState<T> {
    #[inline(always)]
    fn read(from: &mut impl RecordReader<T>) -> Self {
        Self {
            position_m: Vec3::new(from.number(), from.number(), from.number()),
            velocity_m_s: Vec3::new(from.number(), from.number(), from.number()),
            spin_rad_s: Vec3::new(from.number(), from.number(), from.number()),
        }
    }

    #[inline(always)]
    fn write(&self, to: &mut impl RecordWriter<T>) {
        for v in [&self.position_m, &self.velocity_m_s, &self.spin_rad_s] {
            to.number(v.x);
            to.number(v.y);
            to.number(v.z);
        }
    }
}

impl<T: Real> BallState<T> {
    /// The state after an Euler step of `dt`.
    #[inline(always)]
    pub(crate) fn euler_step(&self, derivative: &StateDerivative<T>, dt: T) -> Self {
        Self {
            position_m: self.position_m.add_scaled(derivative.velocity_m_s, dt),
            velocity_m_s: self
                .velocity_m_s
                .add_scaled(derivative.acceleration_m_s2, dt),
            spin_rad_s: self
                .spin_rad_s
                .add_scaled(derivative.angular_acceleration_rad_s2, dt),
        }
    }

    /// The state after a classical Runge-Kutta step of `dt` with the derivatives of its four
    /// stages.
    #[inline(always)]
    pub(crate) fn runge_kutta_step(&self, stages: [&StateDerivative<T>; 4], dt: T) -> Self {
        let [k1, k2, k3, k4] = stages;
        let ends = k1.plus(k4);
        let middle = k2.plus(k3);
        self.euler_step(&ends.plus(&middle.plus(&middle)), dt * (1.0 / 6.0))
    }

    /// The state after `dt` of free flight.
    #[inline(always)]
    pub(crate) fn after_flight(&self, ball: &BallParams<T>, dt: T) -> Self {
        let p = self.position_m.add_scaled(self.velocity_m_s, dt);
        let v = self.velocity_m_s;
        Self {
            position_m: Vec3::new(p.x, p.y, p.z - ball.half_gravity * dt * dt),
            velocity_m_s: Vec3::new(v.x, v.y, v.z - ball.gravity * dt),
            spin_rad_s: self.spin_rad_s,
        }
    }

    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, condition: T::Mask, other: Self) -> Self {
        Self {
            position_m: self.position_m.select(condition, other.position_m),
            velocity_m_s: self.velocity_m_s.select(condition, other.velocity_m_s),
            spin_rad_s: self.spin_rad_s.select(condition, other.spin_rad_s),
        }
    }

    /// Square of the distance of the centre from the hoop's axis, the paper's D_theta^2.
    #[inline(always)]
    pub(crate) fn axis_distance_squared(&self) -> T {
        self.position_m.x.squared() + self.position_m.y.squared()
    }
}

impl BallState<f64> {
    /// The state mirrored in the plane of symmetry (y -> -y).
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let (p, v, w) = (self.position_m, self.velocity_m_s, self.spin_rad_s);
        Self {
            position_m: Vec3::new(p.x, -p.y, p.z),
            velocity_m_s: Vec3::new(v.x, -v.y, v.z),
            spin_rad_s: Vec3::new(-w.x, w.y, -w.z),
        }
    }

    /// The nine state variables in order: position, velocity, spin.
    #[must_use]
    pub fn to_array(&self) -> [f64; 9] {
        let (p, v, w) = (self.position_m, self.velocity_m_s, self.spin_rad_s);
        [p.x, p.y, p.z, v.x, v.y, v.z, w.x, w.y, w.z]
    }

    /// Whether all nine state variables are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.to_array().iter().all(|value| value.is_finite())
    }
}
