//! Position and motion of the ball in the frame of one contact, from its first touch on.

use super::contact_kinematics::ContactVector;
use crate::math::real::Real;
use crate::math::real_record::{RealRecord, RecordReader, RecordWriter};
use crate::math::vector::{Vec2, Vec3};
use crate::model::ball_params::BallParams;

/// Position and motion of the ball in the frame `(n, 1, 2)` of a contact.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactFrameState<T = f64> {
    /// Compression u of the ball, m.
    pub(crate) compression: T,
    /// Velocity of the centre, m/s.
    pub(crate) velocity: ContactVector<T>,
    /// Angular velocity, rad/s.
    pub(crate) spin: ContactVector<T>,
    /// Where the contact is on the solid. On the ring: cos phi, sin phi and the angle by which
    /// theta has changed since the start. On the face of the board: y, z and zero. At an edge of
    /// it: cos phi, sin phi and the position along the edge.
    pub(crate) coordinates: [T; 3],
    /// On the ring: cos theta and sin theta at the start. At an edge of the board: y and z of the
    /// direction away from the board.
    pub(crate) start: [T; 2],
}

/// Number of values of a [`ContactFrameState`].
pub(crate) const CONTACT_NUMBERS: usize = 12;

impl ContactFrameState {
    pub(crate) const ZERO: Self = Self {
        compression: 0.0,
        velocity: ContactVector::new(0.0, 0.0, 0.0),
        spin: ContactVector::new(0.0, 0.0, 0.0),
        coordinates: [0.0; 3],
        start: [0.0; 2],
    };
}

impl<T: Real> RealRecord<T> for ContactFrameState<T> {
    #[inline(always)]
    fn read(from: &mut impl RecordReader<T>) -> Self {
        Self {
            compression: from.number(),
            velocity: ContactVector::new(from.number(), from.number(), from.number()),
            spin: ContactVector::new(from.number(), from.number(), from.number()),
            coordinates: [from.number(), from.number(), from.number()],
            start: [from.number(), from.number()],
        }
    }

    #[inline(always)]
    fn write(&self, to: &mut impl RecordWriter<T>) {
        to.number(self.compression);
        for v in [&self.velocity, &self.spin] {
            to.number(v.normal);
            to.number(v.tangent.x);
            to.number(v.tangent.y);
        }
        let ([p_0, p_1, p_2], [s_0, s_1]) = (self.coordinates, self.start);
        to.number(p_0);
        to.number(p_1);
        to.number(p_2);
        to.number(s_0);
        to.number(s_1);
    }
}

impl<T: Real> ContactFrameState<T> {
    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, condition: T::Mask, other: Self) -> Self {
        Self {
            compression: self.compression.select(condition, other.compression),
            velocity: self.velocity.select(condition, other.velocity),
            spin: self.spin.select(condition, other.spin),
            coordinates: [
                self.coordinates[0].select(condition, other.coordinates[0]),
                self.coordinates[1].select(condition, other.coordinates[1]),
                self.coordinates[2].select(condition, other.coordinates[2]),
            ],
            start: [
                self.start[0].select(condition, other.start[0]),
                self.start[1].select(condition, other.start[1]),
            ],
        }
    }

    /// The state in another number type.
    #[inline(always)]
    pub(crate) fn map<U: Real>(&self, convert: impl Fn(T) -> U) -> ContactFrameState<U> {
        let along = |v: &ContactVector<T>| {
            let (normal, t) = (convert(v.normal), v.tangent);
            ContactVector::new(normal, convert(t.x), convert(t.y))
        };
        ContactFrameState {
            compression: convert(self.compression),
            velocity: along(&self.velocity),
            spin: along(&self.spin),
            coordinates: self.coordinates.map(&convert),
            start: self.start.map(&convert),
        }
    }

    /// A bound of the speed of the centre.
    #[inline(always)]
    pub(crate) fn speed_bound(&self) -> T {
        let v = self.velocity;
        v.normal.abs() + v.tangent.x.abs() + v.tangent.y.abs()
    }

    /// The acceleration by gravity and air, in the frame in which gravity has these components.
    #[inline(always)]
    pub(super) fn free_acceleration(
        &self,
        ball: &BallParams<T>,
        gravity: ContactVector<T>,
    ) -> ContactVector<T> {
        if !ball.has_air {
            return gravity;
        }
        let in_frame = |v: &ContactVector<T>| Vec3::new(v.normal, v.tangent.x, v.tangent.y);
        let a = ball.air_acceleration(in_frame(&self.velocity), in_frame(&self.spin));
        gravity + ContactVector::new(a.x, a.y, a.z)
    }

    /// Velocity of the contact point along the surface (Eqs. 4 and 14), for the lever `lever`.
    #[inline(always)]
    pub(crate) fn slip(&self, lever: T) -> Vec2<T> {
        let (v, w) = (self.velocity.tangent, self.spin.tangent);
        Vec2::new(v.x - lever * w.y, v.y + lever * w.x)
    }
}

/// Distances at a contact, and their inverses.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactDistances<T> {
    /// Distance R - u from the centre to the contact point, m.
    pub(crate) lever: T,
    /// Distance from the core, m, and its inverse; on a flat solid not used.
    pub(crate) core: T,
    pub(crate) inverse_core: T,
    /// Distance from the axis of the solid, 1 at a straight edge; on a flat solid not used.
    pub(crate) axis: T,
    pub(crate) inverse_axis: T,
}

/// How the frame of a contact turns, and what turns it: zeros on a flat solid.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameTurn<T> {
    /// Curvature along 1 and 2 times the velocity, 1/s.
    pub(crate) turn: Vec2<T>,
    /// Turning about the normal, 1/s.
    pub(crate) torsion: T,
}

/// The factor that makes the length of (cosine, sine) 1 again: one Newton step.
#[inline(always)]
pub(super) fn unit_scale<T: Real>(cosine: T, sine: T) -> T {
    (cosine.squared() + sine.squared()) * -0.5 + 1.5
}
