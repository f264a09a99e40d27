//! The ball in contact with one solid, in the frame `(n, 1, 2)` of the contact.

use super::material::Material;
use crate::math::real::Real;
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::ball_params::BallParams;

/// A vector along the normal and the two tangents of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ContactVector<T> {
    /// Along n.
    pub(crate) normal: T,
    /// Along 1 and 2.
    pub(crate) tangent: Vec2<T>,
}

impl<T> ContactVector<T> {
    #[inline(always)]
    pub(crate) const fn new(normal: T, tangent_1: T, tangent_2: T) -> Self {
        Self {
            normal,
            tangent: Vec2::new(tangent_1, tangent_2),
        }
    }
}

impl<T: Real> ContactVector<T> {
    /// The components of a vector along the directions (n, 1, 2).
    #[inline(always)]
    pub(crate) fn along([n, tangent_1, tangent_2]: &[Vec3<T>; 3], v: Vec3<T>) -> Self {
        Self::new(n.dot(v), tangent_1.dot(v), tangent_2.dot(v))
    }

    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, condition: T::Mask, other: Self) -> Self {
        Self {
            normal: self.normal.select(condition, other.normal),
            tangent: self.tangent.select(condition, other.tangent),
        }
    }
}

impl<T: Real> std::ops::Add for ContactVector<T> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self {
            normal: self.normal + other.normal,
            tangent: self.tangent + other.tangent,
        }
    }
}

/// Position and motion of the ball relative to the nearest point of a solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactKinematics<T = f64> {
    /// Compression u of the ball, m; negative for a gap.
    pub(crate) compression: T,
    /// Distance R - u from the centre to the contact point, m.
    pub(crate) lever: T,
    /// Velocity of the centre, m/s.
    pub(crate) velocity: ContactVector<T>,
    /// Angular velocity, rad/s.
    pub(crate) spin: ContactVector<T>,
    /// The acceleration by gravity and air, m/s^2.
    pub(crate) gravity: ContactVector<T>,
    /// Curvature kappa_1 of the path of the normal along 1, 1/m.
    pub(crate) curvature_1: T,
    /// Curvature kappa_2 of the path of the normal along 2, 1/m.
    pub(crate) curvature_2: T,
}

impl<T: Real> ContactKinematics<T> {
    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    pub(super) fn select(self, condition: T::Mask, other: Self) -> Self {
        Self {
            compression: self.compression.select(condition, other.compression),
            lever: self.lever.select(condition, other.lever),
            velocity: self.velocity.select(condition, other.velocity),
            spin: self.spin.select(condition, other.spin),
            gravity: self.gravity.select(condition, other.gravity),
            curvature_1: self.curvature_1.select(condition, other.curvature_1),
            curvature_2: self.curvature_2.select(condition, other.curvature_2),
        }
    }

    /// Velocity of the contact point along the surface (Eqs. 4 and 14).
    #[inline(always)]
    pub(crate) fn slip(&self) -> Vec2<T> {
        let (v, w) = (self.velocity.tangent, self.spin.tangent);
        Vec2::new(v.x - self.lever * w.y, v.y + self.lever * w.x)
    }

    /// Normal force per unit of mass, (k u + c u')/m (Eqs. 2 and 12); negative just before the ball
    /// separates.
    #[inline(always)]
    pub(crate) fn normal_force(&self, material: &Material<T>) -> T {
        material.stiffness * self.compression - material.damping * self.velocity.normal
    }

    /// The normal acceleration from the turning of the frame alone, without forces.
    #[inline(always)]
    pub(crate) fn frame_acceleration(&self) -> T {
        let v = self.velocity.tangent;
        self.curvature_1 * v.x.squared() + self.curvature_2 * v.y.squared()
    }

    /// The part of the slip's rate that is proportional to the normal velocity, for a unit of it:
    /// `-(n' + w x n)`.
    #[inline(always)]
    pub(crate) fn slip_rate_per_vn(&self) -> Vec2<T> {
        let (v, w) = (self.velocity.tangent, self.spin.tangent);
        Vec2::new(
            -(self.curvature_1 * v.x + w.y),
            w.x - self.curvature_2 * v.y,
        )
    }

    /// Rate of the slip from motion alone, without forces: `-(v_n (n' + w x n) + (R-u) w_n (n x
    /// n'))`.
    #[inline(always)]
    fn slip_rate_of_motion(&self) -> Vec2<T> {
        let v = self.velocity;
        let swing = self.slip_rate_per_vn();
        let twist = self.lever * self.spin.normal;
        Vec2::new(
            swing.x * v.normal + twist * (self.curvature_2 * v.tangent.y),
            swing.y * v.normal - twist * (self.curvature_1 * v.tangent.x),
        )
    }

    /// Rate of the slip without friction: from motion and gravity.
    #[inline(always)]
    pub(crate) fn frictionless_slip_rate(&self) -> Vec2<T> {
        self.gravity.tangent + self.slip_rate_of_motion()
    }

    /// Rate of the slip for a unit of friction per unit of mass: 1 + lever^2 m/I.
    #[inline(always)]
    pub(crate) fn inverse_effective_mass(&self, ball: &BallParams<T>) -> T {
        self.lever.squared() * ball.mass_over_inertia + 1.0
    }
}
