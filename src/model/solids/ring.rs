//! The ring: a circle of radius R_H about the origin, without thickness.

use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::contact_motion::{ContactDistances, ContactMotion, FrameTurn};
use super::material::Material;
use super::solid::{ContactFrame, Solid, SolidId};
use crate::math::real::{Mask, Real};
use crate::math::vector::{Vec2, Vec3};
use crate::model::ball_params::BallParams;
use crate::model::ball_state::BallState;

/// The ring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring<T = f64> {
    /// Radius R_H of the circle, m.
    pub(crate) radius: T,
    pub(crate) material: Material<T>,
}

/// Change of theta that is moved into the start of a contact, rad.
const LARGEST_TURN_RAD: f64 = 0.5;

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
}

/// Cosine and sine of an angle of at most [`LARGEST_TURN_RAD`] and one step: Taylor polynomials of degree 12 and
/// 13, with an error below 1e-13.
#[inline(always)]
fn cos_sin<T: Real>(angle: T) -> (T, T) {
    const TERMS: i32 = 6;
    let square = -angle.squared();
    let (mut cos, mut sin) = (angle.one(), angle.one());
    for n in (1..=TERMS).rev() {
        let n = 2.0 * f64::from(n);
        cos = cos * square * (1.0 / (n * (n - 1.0))) + 1.0;
        sin = sin * square * (1.0 / (n * (n + 1.0))) + 1.0;
    }
    (cos, sin * angle)
}

/// The factor that makes the length of (cosine, sine) 1 again: one Newton step.
#[inline(always)]
fn unit_scale<T: Real>(cosine: T, sine: T) -> T {
    (cosine.squared() + sine.squared()) * -0.5 + 1.5
}

/// Cosine and sine of theta.
#[inline(always)]
fn theta<T: Real>(motion: &ContactMotion<T>) -> [T; 2] {
    let (cos_turned, sin_turned) = cos_sin(motion.place[2]);
    let [cos_start, sin_start] = motion.start;
    [
        cos_start * cos_turned - sin_start * sin_turned,
        sin_start * cos_turned + cos_start * sin_turned,
    ]
}

impl<T: Real> Ring<T> {
    /// The frame of a ball whose centre is at `position`, its distance from the ring, and the inverses of its
    /// distances from the hoop's axis and from the ring.
    #[inline(always)]
    fn frame_at(&self, ball: &BallParams<T>, position: Vec3<T>) -> (RingFrame<T>, T, [T; 2]) {
        let [x, y, z] = position.into();
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
        (frame, lever, [per_axis, per_lever])
    }
}

impl<T: Real> Solid<T> for Ring<T> {
    type Frame = RingFrame<T>;
    const ID: SolidId = SolidId::Ring;
    const FLAT: bool = false;

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
        let (frame, lever, [per_axis, per_lever]) = self.frame_at(ball, state.position_m);
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

    #[inline(always)]
    fn to_contact(&self, ball: &BallParams<T>, state: &BallState<T>) -> ContactMotion<T> {
        let (frame, lever, _) = self.frame_at(ball, state.position_m);
        ContactMotion {
            compression: ball.radius - lever,
            velocity: frame.to_frame(state.velocity_m_s),
            spin: frame.to_frame(state.spin_rad_s),
            place: [frame.cos_phi, frame.sin_phi, ball.zero()],
            start: [frame.cos_theta, frame.sin_theta],
        }
    }

    #[inline(always)]
    fn to_space(&self, ball: &BallParams<T>, motion: &ContactMotion<T>) -> BallState<T> {
        let [cos_phi, sin_phi, _] = motion.place;
        let scale = unit_scale(cos_phi, sin_phi);
        let (cos_phi, sin_phi) = (cos_phi * scale, sin_phi * scale);
        let [cos_theta, sin_theta] = theta(motion);
        let frame = RingFrame {
            cos_theta,
            sin_theta,
            cos_phi,
            sin_phi,
        };
        let lever = ball.radius - motion.compression;
        let axis = self.radius - lever * cos_phi;
        BallState {
            position_m: Vec3::new(
                axis * frame.cos_theta,
                axis * frame.sin_theta,
                lever * sin_phi,
            ),
            velocity_m_s: frame.to_space(motion.velocity),
            spin_rad_s: frame.to_space(motion.spin),
        }
    }

    #[inline(always)]
    fn distances(
        &self,
        ball: &BallParams<T>,
        compression: T,
        place: &[T; 3],
    ) -> ContactDistances<T> {
        let lever = ball.radius - compression;
        let axis = self.radius - lever * place[0];
        let per_both = ball.one() / (lever * axis);
        ContactDistances {
            lever,
            inverse_lever: per_both * axis,
            axis,
            inverse_axis: per_both * lever,
        }
    }

    #[inline(always)]
    fn frame_turn(
        &self,
        motion: &ContactMotion<T>,
        distances: &ContactDistances<T>,
    ) -> FrameTurn<T> {
        let [cos_phi, sin_phi, _] = motion.place;
        let v = motion.velocity.tangent;
        let about_axis = v.y * distances.inverse_axis;
        FrameTurn {
            turn: Vec2::new(v.x * distances.inverse_lever, -(cos_phi * about_axis)),
            torsion: sin_phi * about_axis,
        }
    }

    #[inline(always)]
    fn gravity(&self, ball: &BallParams<T>, motion: &ContactMotion<T>) -> ContactVector<T> {
        let [cos_phi, sin_phi, _] = motion.place;
        ContactVector::new(
            -(ball.gravity * sin_phi),
            -(ball.gravity * cos_phi),
            ball.zero(),
        )
    }

    #[inline(always)]
    fn place_rates(
        &self,
        motion: &ContactMotion<T>,
        distances: &ContactDistances<T>,
        turn: &FrameTurn<T>,
    ) -> [T; 3] {
        let [cos_phi, sin_phi, _] = motion.place;
        [
            -(sin_phi * turn.turn.x),
            cos_phi * turn.turn.x,
            motion.velocity.tangent.y * distances.inverse_axis,
        ]
    }

    #[inline(always)]
    fn gap(&self, ball: &BallParams<T>, state: &BallState<T>) -> (T, T) {
        let (frame, lever, _) = self.frame_at(ball, state.position_m);
        let velocity = frame.to_frame(state.velocity_m_s);
        (lever - ball.radius, velocity.normal)
    }

    #[inline(always)]
    fn rebase(&self, motion: &mut ContactMotion<T>) {
        let [cos_phi, sin_phi, turned] = motion.place;
        let far = turned.splat(LARGEST_TURN_RAD).lt(turned.abs());
        if !far.any() {
            return;
        }
        let (scale, [cos_theta, sin_theta]) = (unit_scale(cos_phi, sin_phi), theta(motion));
        let theta_scale = unit_scale(cos_theta, sin_theta);
        motion.place = [
            (cos_phi * scale).select(far, cos_phi),
            (sin_phi * scale).select(far, sin_phi),
            turned.zero().select(far, turned),
        ];
        let [cos_start, sin_start] = motion.start;
        motion.start = [
            (cos_theta * theta_scale).select(far, cos_start),
            (sin_theta * theta_scale).select(far, sin_start),
        ];
    }

    /// The ring is closed: every ball has a nearest point on it.
    #[inline(always)]
    fn faces(&self, _state: &BallState<T>) -> T::Mask {
        self.radius.splat_mask(true)
    }
}
