//! A flat rectangle swept by a sphere: the core of the board and of the bracket.
//!
//! The nearest point of the rectangle is the centre of the ball with each coordinate limited to the
//! rectangle's range. Where a coordinate is within its range the solid is flat in that direction;
//! where it is limited the normal turns about the nearest point, with the curvature 1/d (d the
//! distance from it).

use super::contact_kinematics::{ContactKinematics, ContactVector};
use crate::math::real::Real;
use crate::math::vector::{RealVector, Vec3};
use crate::model::ball_params::BallParams;
use crate::model::ball_state::BallState;

/// Least distance from the core that is divided by, m.
const LEAST_DISTANCE_M: f64 = 1e-9;

/// The core of a plate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rectangle<T = f64> {
    /// The corner with the least coordinates, and that with the greatest. One coordinate is the
    /// same in both.
    pub(crate) low: Vec3<T>,
    pub(crate) high: Vec3<T>,
    /// Distance of the centre of a touching ball from the core, m.
    pub(crate) reach: T,
    /// Radius of the sphere that sweeps the core, m.
    pub(crate) radius: T,
}

impl Rectangle {
    #[inline(always)]
    pub(super) fn map<T: Real>(&self, splat: &impl Fn(f64) -> T) -> Rectangle<T> {
        let each = |v: Vec3<f64>| Vec3::new(splat(v.x), splat(v.y), splat(v.z));
        Rectangle {
            low: each(self.low),
            high: each(self.high),
            reach: splat(self.reach),
            radius: splat(self.radius),
        }
    }
}

impl<T: Real> Rectangle<T> {
    /// From the nearest point of the core to `position`.
    #[inline(always)]
    pub(crate) fn offset(&self, position: Vec3<T>) -> Vec3<T> {
        #[inline(always)]
        fn beyond<T: Real>(x: T, low: T, high: T) -> T {
            x - Real::min(Real::max(x, low), high)
        }
        Vec3::new(
            beyond(position.x, self.low.x, self.high.x),
            beyond(position.y, self.low.y, self.high.y),
            beyond(position.z, self.low.z, self.high.z),
        )
    }

    /// The gap to a ball, and its rate.
    #[inline(always)]
    pub(crate) fn gap(&self, state: &BallState<T>) -> (T, T) {
        let offset = self.offset(state.position_m);
        let distance = offset.norm();
        let floor = distance.splat(LEAST_DISTANCE_M);
        let rate = state.velocity_m_s.dot(offset) / Real::max(distance, floor);
        (distance - self.reach, rate)
    }

    /// Position and motion of the ball relative to the nearest point, and the directions (n, 1, 2).
    /// `in_plane` holds the two directions of the rectangle.
    #[inline(always)]
    pub(super) fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
        in_plane: [Vec3<T>; 2],
    ) -> (ContactKinematics<T>, [Vec3<T>; 3]) {
        let (zero, one) = (ball.zero(), ball.one());
        let offset = self.offset(state.position_m);
        let distance = Real::max(offset.norm(), ball.splat(LEAST_DISTANCE_M));
        let inverse = one / distance;
        let n = offset * inverse;
        let [u, v] = in_plane;
        let flat_u = offset.dot(u).abs().le(zero);
        let flat_v = offset.dot(v).abs().le(zero);
        // Direction 2 runs along an edge. At a corner any direction will do.
        let across = cross(u, n);
        let size = across.norm();
        let at_corner = across * (one / size.select(size.is_positive(), one));
        let tangent_2 = v.select(flat_v, u.select(flat_u, at_corner));
        let tangent_1 = cross(tangent_2, n);
        let axes = [n, tangent_1, tangent_2];
        let kinematics = ContactKinematics {
            compression: self.reach - distance,
            lever: distance - self.radius,
            velocity: ContactVector::along(&axes, state.velocity_m_s),
            spin: ContactVector::along(&axes, state.spin_rad_s),
            gravity: ContactVector::along(
                &axes,
                ball.free_acceleration(state.velocity_m_s, state.spin_rad_s),
            ),
            curvature_1: zero.select(flat_u & flat_v, inverse),
            curvature_2: zero.select(flat_u | flat_v, inverse),
        };
        (kinematics, axes)
    }
}

#[inline(always)]
fn cross<T: Real>(a: Vec3<T>, b: Vec3<T>) -> Vec3<T> {
    Vec3::new(
        a.y * b.z - a.z * b.y,
        a.z * b.x - a.x * b.z,
        a.x * b.y - a.y * b.x,
    )
}
