//! The hoop: a rod around a circle of radius R_H about the origin, and the bracket between it and
//! the board.

use super::contact_frame_state::{ContactDistances, ContactFrameState, FrameTurn, unit_scale};
use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::material::Material;
use super::rectangle::Rectangle;
use super::solid::{FramedPart, Solid, SolidId};
use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::ball_params::BallParams;
use crate::model::ball_state::BallState;

/// The ring.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ring<T = f64> {
    /// Radius R_H of the circle, m.
    pub(crate) radius: T,
    /// Radius of the rod of ring and bracket, m.
    pub(crate) tube_radius: T,
    /// Distance of the centre of a touching ball from the core, m.
    pub(crate) reach: T,
    /// The core of the bracket.
    pub(crate) bracket: Rectangle<T>,
    pub(crate) has_bracket: bool,
    pub(crate) material: Material<T>,
}

/// Change of theta that is moved into the start of a contact, rad.
const LARGEST_TURN_RAD: f64 = 0.5;

impl Ring {
    #[inline(always)]
    pub(crate) fn map<T: Real>(&self, splat: &impl Fn(f64) -> T) -> Ring<T> {
        Ring {
            radius: splat(self.radius),
            tube_radius: splat(self.tube_radius),
            reach: splat(self.reach),
            bracket: self.bracket.map(splat),
            has_bracket: self.has_bracket,
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
    /// Components along (u_n, u_phi, u_theta) of a vector in the world frame.
    #[inline(always)]
    fn to_frame(self, v: Vec3<T>) -> ContactVector<T> {
        let outward = v.x * self.cos_theta + v.y * self.sin_theta;
        ContactVector::new(
            v.z * self.sin_phi - outward * self.cos_phi,
            v.z * self.cos_phi + outward * self.sin_phi,
            v.y * self.cos_theta - v.x * self.sin_theta,
        )
    }

    /// x, y, z components of a vector given along (u_n, u_phi, u_theta).
    #[inline(always)]
    fn to_world(self, vector: ContactVector<T>) -> Vec3<T> {
        let (along_phi, along_theta) = (vector.tangent.x, vector.tangent.y);
        let outward = along_phi * self.sin_phi - vector.normal * self.cos_phi;
        Vec3::new(
            outward * self.cos_theta - along_theta * self.sin_theta,
            outward * self.sin_theta + along_theta * self.cos_theta,
            vector.normal * self.sin_phi + along_phi * self.cos_phi,
        )
    }
}

/// Cosine and sine of an angle of at most [`LARGEST_TURN_RAD`] and one step: Taylor polynomials of
/// degree 12 and 13, with an error below 1e-13.
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

/// Cosine and sine of theta.
#[inline(always)]
fn theta<T: Real>(motion: &ContactFrameState<T>) -> [T; 2] {
    let (cos_turned, sin_turned) = cos_sin(motion.coordinates[2]);
    let [cos_start, sin_start] = motion.start;
    [
        cos_start * cos_turned - sin_start * sin_turned,
        sin_start * cos_turned + cos_start * sin_turned,
    ]
}

impl<T: Real> Ring<T> {
    /// The frame of a ball whose centre is at `position`, its distance from the circle, and the
    /// inverses of its distances from the hoop's axis and from the circle.
    #[inline(always)]
    fn frame_at(&self, ball: &BallParams<T>, position: Vec3<T>) -> (RingFrame<T>, T, [T; 2]) {
        let [x, y, z] = position.into();
        let axis = (x.squared() + y.squared()).sqrt();
        let inward = self.radius - axis;
        let core = (inward.squared() + z.squared()).sqrt();
        // 1/axis and 1/core with a single division.
        let per_both = ball.one() / (axis * core);
        let (per_axis, per_core) = (per_both * core, per_both * axis);
        let frame = RingFrame {
            cos_theta: x * per_axis,
            sin_theta: y * per_axis,
            cos_phi: inward * per_core,
            sin_phi: z * per_core,
        };
        (frame, core, [per_axis, per_core])
    }

    /// Position and motion of the ball relative to the circle.
    #[inline(always)]
    fn contact_with_circle(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, [Vec3<T>; 3]) {
        let (zero, one) = (ball.zero(), ball.one());
        let (frame, core, [per_axis, per_core]) = self.frame_at(ball, state.position_m);
        let gravity = ContactVector::new(
            -ball.gravity * frame.sin_phi,
            -ball.gravity * frame.cos_phi,
            zero,
        );
        let kinematics = ContactKinematics {
            compression: self.reach - core,
            lever: core - self.tube_radius,
            velocity: frame.to_frame(state.velocity_m_s),
            spin: frame.to_frame(state.spin_rad_s),
            gravity: if ball.has_air {
                let air = ball.air_acceleration(state.velocity_m_s, state.spin_rad_s);
                gravity + frame.to_frame(air)
            } else {
                gravity
            },
            curvature_1: per_core,
            curvature_2: -frame.cos_phi * per_axis,
        };
        let axes = [
            frame.to_world(ContactVector::new(one, zero, zero)),
            frame.to_world(ContactVector::new(zero, one, zero)),
            frame.to_world(ContactVector::new(zero, zero, one)),
        ];
        (kinematics, axes)
    }

    /// The gap between ball and circle, and its rate.
    #[inline(always)]
    fn gap_to_circle(&self, ball: &BallParams<T>, state: &BallState<T>) -> (T, T) {
        let (frame, core, _) = self.frame_at(ball, state.position_m);
        let velocity = frame.to_frame(state.velocity_m_s);
        (core - self.reach, velocity.normal)
    }

    /// Whether the circle is nearer than the bracket.
    #[inline(always)]
    fn circle_is_nearer(&self, position: Vec3<T>) -> T::Mask {
        let axis = (position.x.squared() + position.y.squared()).sqrt();
        let circle = (self.radius - axis).squared() + position.z.squared();
        circle.le(self.bracket.offset(position).norm_squared())
    }
}

impl<T: Real> Solid<T> for Ring<T> {
    const ID: SolidId = SolidId::Ring;
    const PART: FramedPart = FramedPart::RingCircle;
    const FLAT: bool = false;

    #[inline(always)]
    fn material(&self) -> &Material<T> {
        &self.material
    }

    #[inline(always)]
    fn reach(&self, _ball: &BallParams<T>) -> T {
        self.reach
    }

    #[inline(always)]
    fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, [Vec3<T>; 3]) {
        let (circle, axes) = self.contact_with_circle(ball, state);
        if !self.has_bracket {
            return (circle, axes);
        }
        let on_circle = self.circle_is_nearer(state.position_m);
        if on_circle.all() {
            return (circle, axes);
        }
        let (zero, one) = (ball.zero(), ball.one());
        let in_plane = [Vec3::new(one, zero, zero), Vec3::new(zero, one, zero)];
        let (bracket, bracket_axes) = self.bracket.contact(ball, state, in_plane);
        let [n, tangent_1, tangent_2] = axes;
        let axes = [
            n.select(on_circle, bracket_axes[0]),
            tangent_1.select(on_circle, bracket_axes[1]),
            tangent_2.select(on_circle, bracket_axes[2]),
        ];
        (circle.select(on_circle, bracket), axes)
    }

    #[inline(always)]
    fn to_contact(&self, ball: &BallParams<T>, state: &BallState<T>) -> ContactFrameState<T> {
        let (frame, core, _) = self.frame_at(ball, state.position_m);
        ContactFrameState {
            compression: self.reach - core,
            velocity: frame.to_frame(state.velocity_m_s),
            spin: frame.to_frame(state.spin_rad_s),
            coordinates: [frame.cos_phi, frame.sin_phi, ball.zero()],
            start: [frame.cos_theta, frame.sin_theta],
        }
    }

    #[inline(always)]
    fn to_world(&self, _ball: &BallParams<T>, motion: &ContactFrameState<T>) -> BallState<T> {
        let [cos_phi, sin_phi, _] = motion.coordinates;
        let scale = unit_scale(cos_phi, sin_phi);
        let (cos_phi, sin_phi) = (cos_phi * scale, sin_phi * scale);
        let [cos_theta, sin_theta] = theta(motion);
        let frame = RingFrame {
            cos_theta,
            sin_theta,
            cos_phi,
            sin_phi,
        };
        let core = self.reach - motion.compression;
        let axis = self.radius - core * cos_phi;
        BallState {
            position_m: Vec3::new(
                axis * frame.cos_theta,
                axis * frame.sin_theta,
                core * sin_phi,
            ),
            velocity_m_s: frame.to_world(motion.velocity),
            spin_rad_s: frame.to_world(motion.spin),
        }
    }

    #[inline(always)]
    fn distances(
        &self,
        ball: &BallParams<T>,
        compression: T,
        coordinates: &[T; 3],
    ) -> ContactDistances<T> {
        let core = self.reach - compression;
        let axis = self.radius - core * coordinates[0];
        let per_both = ball.one() / (core * axis);
        ContactDistances {
            lever: core - self.tube_radius,
            core,
            inverse_core: per_both * axis,
            axis,
            inverse_axis: per_both * core,
        }
    }

    #[inline(always)]
    fn frame_turn(
        &self,
        motion: &ContactFrameState<T>,
        distances: &ContactDistances<T>,
    ) -> FrameTurn<T> {
        let [cos_phi, sin_phi, _] = motion.coordinates;
        let v = motion.velocity.tangent;
        let about_axis = v.y * distances.inverse_axis;
        FrameTurn {
            turn: Vec2::new(v.x * distances.inverse_core, -(cos_phi * about_axis)),
            torsion: sin_phi * about_axis,
        }
    }

    #[inline(always)]
    fn free_acceleration(
        &self,
        ball: &BallParams<T>,
        motion: &ContactFrameState<T>,
    ) -> ContactVector<T> {
        let [cos_phi, sin_phi, _] = motion.coordinates;
        let gravity = ContactVector::new(
            -(ball.gravity * sin_phi),
            -(ball.gravity * cos_phi),
            ball.zero(),
        );
        motion.free_acceleration(ball, gravity)
    }

    #[inline(always)]
    fn coordinate_rates(
        &self,
        motion: &ContactFrameState<T>,
        distances: &ContactDistances<T>,
        turn: &FrameTurn<T>,
    ) -> [T; 3] {
        let [cos_phi, sin_phi, _] = motion.coordinates;
        [
            -(sin_phi * turn.turn.x),
            cos_phi * turn.turn.x,
            motion.velocity.tangent.y * distances.inverse_axis,
        ]
    }

    #[inline(always)]
    fn gap(&self, ball: &BallParams<T>, state: &BallState<T>) -> (T, T) {
        let (gap, rate) = self.gap_to_circle(ball, state);
        if !self.has_bracket {
            return (gap, rate);
        }
        let (to_bracket, bracket_rate) = self.bracket.gap(state);
        let on_circle = gap.le(to_bracket);
        (
            gap.select(on_circle, to_bracket),
            rate.select(on_circle, bracket_rate),
        )
    }

    #[inline(always)]
    fn rebase(&self, motion: &mut ContactFrameState<T>) {
        let [cos_phi, sin_phi, turned] = motion.coordinates;
        let far = turned.splat(LARGEST_TURN_RAD).lt(turned.abs());
        if !far.any() {
            return;
        }
        let (scale, [cos_theta, sin_theta]) = (unit_scale(cos_phi, sin_phi), theta(motion));
        let theta_scale = unit_scale(cos_theta, sin_theta);
        motion.coordinates = [
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

    #[inline(always)]
    fn acts(&self, _state: &BallState<T>) -> T::Mask {
        self.radius.splat_mask(true)
    }

    #[inline(always)]
    fn is_in_frame(&self, state: &BallState<T>) -> T::Mask {
        if self.has_bracket {
            self.circle_is_nearer(state.position_m)
        } else {
            self.radius.splat_mask(true)
        }
    }
}
