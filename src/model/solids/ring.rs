//! The ring: a circle of radius R_H about the origin, without thickness.

use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::material::Material;
use super::solid::{Approach, ContactFrame, GapPolynomial, Solid, SolidId, TOUCH_GAP_M};
use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::ball_params::BallParams;
use crate::model::ball_state::BallState;

/// The ring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring<T = f64> {
    /// Radius R_H of the circle, m.
    pub(crate) radius: T,
    pub(crate) material: Material<T>,
}

impl Ring {
    #[inline(always)]
    pub(crate) fn map<T: Real>(&self, splat: &impl Fn(f64) -> T) -> Ring<T> {
        Ring {
            radius: splat(self.radius),
            material: self.material.map(splat),
        }
    }
}

/// The angles of the hoop coordinates (Eq. 6).
#[derive(Clone, Copy, Debug)]
pub(crate) struct RingFrame<T> {
    cos_theta: T,
    sin_theta: T,
    cos_phi: T,
    sin_phi: T,
}

impl<T: Real> RingFrame<T> {
    /// Components along (u_n, u_phi, u_theta) of a vector in space.
    #[inline(always)]
    fn to_frame(self, v: Vec3<T>) -> ContactVector<T> {
        let outward = v.x * self.cos_theta + v.y * self.sin_theta;
        ContactVector::new(
            v.z * self.sin_phi - outward * self.cos_phi,
            v.z * self.cos_phi + outward * self.sin_phi,
            v.y * self.cos_theta - v.x * self.sin_theta,
        )
    }
}

impl<T: Real> ContactFrame<T> for RingFrame<T> {
    #[inline(always)]
    fn to_space(self, vector: ContactVector<T>) -> Vec3<T> {
        let (along_phi, along_theta) = (vector.tangent.x, vector.tangent.y);
        let outward = along_phi * self.sin_phi - vector.normal * self.cos_phi;
        Vec3::new(
            outward * self.cos_theta - along_theta * self.sin_theta,
            outward * self.sin_theta + along_theta * self.cos_theta,
            vector.normal * self.sin_phi + along_phi * self.cos_phi,
        )
    }

    #[inline(always)]
    fn tangent_to_space(self, tangent: Vec2<T>) -> Vec3<T> {
        let outward = tangent.x * self.sin_phi;
        Vec3::new(
            outward * self.cos_theta - tangent.y * self.sin_theta,
            outward * self.sin_theta + tangent.y * self.cos_theta,
            tangent.x * self.cos_phi,
        )
    }
}

/// The ring as seen by a ball on another solid.
#[derive(Clone, Copy)]
pub(crate) struct RingApproach<T: Real> {
    /// The ball may reach the ring within a step; the other fields are valid only then.
    near: T::Mask,
    gap: T,
    rate: T,
    frame_acceleration: T,
    normal: Vec3<T>,
}

impl<T: Real> Approach<T> for RingApproach<T> {
    #[inline(always)]
    fn has_arrived(&self) -> T::Mask {
        self.near & self.gap.le(self.gap.splat(TOUCH_GAP_M)) & self.rate.is_negative()
    }

    #[inline(always)]
    fn closing_gap(
        &self,
        _state: &BallState<T>,
        acceleration: Vec3<T>,
    ) -> Option<GapPolynomial<T>> {
        if !self.near.any() {
            return None;
        }
        Some(GapPolynomial {
            relevant: self.near,
            gap: Real::max(self.gap, self.gap.splat(TOUCH_GAP_M)),
            rate: self.rate,
            second_derivative: self.normal.dot(acceleration) + self.frame_acceleration,
        })
    }
}

impl<T: Real> Solid<T> for Ring<T> {
    type Frame = RingFrame<T>;
    type Approach = RingApproach<T>;
    const ID: SolidId = SolidId::Ring;

    #[inline(always)]
    fn material(&self) -> &Material<T> {
        &self.material
    }

    #[inline(always)]
    fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, RingFrame<T>) {
        let [x, y, z] = state.position_m.into();
        let axis = (x.squared() + y.squared()).sqrt();
        let inward = self.radius - axis;
        let lever = (inward.squared() + z.squared()).sqrt();
        // 1/axis and 1/lever with a single division.
        let per_both = ball.one() / (axis * lever);
        let (per_axis, per_lever) = (per_both * lever, per_both * axis);
        let frame = RingFrame {
            cos_theta: x * per_axis,
            sin_theta: y * per_axis,
            cos_phi: inward * per_lever,
            sin_phi: z * per_lever,
        };
        let kinematics = ContactKinematics {
            compression: ball.radius - lever,
            lever,
            velocity: frame.to_frame(state.velocity_m_s),
            spin: frame.to_frame(state.spin_rad_s),
            gravity: ContactVector::new(
                -ball.gravity * frame.sin_phi,
                -ball.gravity * frame.cos_phi,
                ball.zero(),
            ),
            curvature_1: per_lever,
            curvature_2: -frame.cos_phi * per_axis,
        };
        (kinematics, frame)
    }

    /// The ring is closed: every ball has a nearest point on it.
    #[inline(always)]
    fn faces(&self, _state: &BallState<T>) -> T::Mask {
        self.radius.splat_mask(true)
    }

    #[inline(always)]
    fn approach(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
        max_acceleration: T,
        longest: T,
    ) -> RingApproach<T> {
        let v = state.velocity_m_s;
        let max_speed = v.x.abs() + v.y.abs() + v.z.abs();
        let max_path = (max_speed + max_acceleration * longest * 0.5) * longest;
        let inward = self.radius - state.axis_distance_squared().sqrt();
        let distance_squared = inward.squared() + state.position_m.z.squared();
        let near = distance_squared.le((ball.radius + max_path).squared());
        let zero = ball.zero();
        if !near.any() {
            return RingApproach {
                near,
                gap: zero,
                rate: zero,
                frame_acceleration: zero,
                normal: Vec3::splat(zero),
            };
        }
        let (kinematics, frame) = self.contact(ball, state);
        RingApproach {
            near,
            gap: -kinematics.compression,
            rate: kinematics.velocity.normal,
            frame_acceleration: kinematics.frame_acceleration(),
            normal: frame.to_space(ContactVector::new(ball.one(), zero, zero)),
        }
    }
}
