//! The rounded edges of the board: cylinders about the sides of its core.
//!
//! At an edge, `o` is the direction in the plane of the board that points away from it, `phi` the
//! angle from the normal of the face to that of the contact, and the frame is
//! `n = i cos(phi) + o sin(phi)`, `u_1 = o cos(phi) - i sin(phi)`, `u_2 = i x o` along the edge. As
//! the ball moves along `u_1` the frame turns with the curvature `1/d`; along the edge it does not.

use super::board::Board;
use super::contact_frame_state::{ContactDistances, ContactFrameState, FrameTurn, unit_scale};
use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::material::Material;
use super::solid::{FramedPart, Solid, SolidId};
use crate::math::real::Real;
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::ball_params::BallParams;
use crate::model::ball_state::BallState;

/// The edges of a board that has rounded ones.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoardEdges<'a, T>(pub(crate) &'a Board<T>);

/// The frame of a contact at an edge.
struct EdgeFrame<T> {
    cos_phi: T,
    sin_phi: T,
    /// y and z of the direction away from the board.
    outward: [T; 2],
}

impl<T: Real> EdgeFrame<T> {
    #[inline(always)]
    fn to_frame(&self, v: Vec3<T>) -> ContactVector<T> {
        let [o_y, o_z] = self.outward;
        let outward = v.y * o_y + v.z * o_z;
        ContactVector::new(
            v.x * self.cos_phi + outward * self.sin_phi,
            outward * self.cos_phi - v.x * self.sin_phi,
            v.z * o_y - v.y * o_z,
        )
    }

    #[inline(always)]
    fn to_world(&self, vector: ContactVector<T>) -> Vec3<T> {
        let (across, along) = (vector.tangent.x, vector.tangent.y);
        let outward = vector.normal * self.sin_phi + across * self.cos_phi;
        self.place(
            vector.normal * self.cos_phi - across * self.sin_phi,
            outward,
            along,
        )
    }

    /// The vector with the component x, one away from the board and one along the edge.
    #[inline(always)]
    fn place(&self, x: T, outward: T, along: T) -> Vec3<T> {
        let [o_y, o_z] = self.outward;
        Vec3::new(x, outward * o_y - along * o_z, outward * o_z + along * o_y)
    }
}

impl<T: Real> BoardEdges<'_, T> {
    /// Distance of the side of the core from the origin, in the direction away from the board, m.
    #[inline(always)]
    fn side(&self, [_, o_z]: [T; 2]) -> T {
        let core = &self.0.core;
        let upper = core.high.z.select(o_z.is_positive(), -core.low.z);
        upper.select(o_z.abs().is_positive(), core.high.y)
    }

    #[inline(always)]
    fn frame(motion: &ContactFrameState<T>) -> EdgeFrame<T> {
        let [cos_phi, sin_phi, _] = motion.coordinates;
        let scale = unit_scale(cos_phi, sin_phi);
        EdgeFrame {
            cos_phi: cos_phi * scale,
            sin_phi: sin_phi * scale,
            outward: motion.start,
        }
    }

    #[inline(always)]
    fn position(&self, frame: &EdgeFrame<T>, motion: &ContactFrameState<T>) -> Vec3<T> {
        let core = &self.0.core;
        let distance = core.reach - motion.compression;
        frame.place(
            core.low.x + distance * frame.cos_phi,
            self.side(frame.outward) + distance * frame.sin_phi,
            motion.coordinates[2],
        )
    }
}

impl<T: Real> Solid<T> for BoardEdges<'_, T> {
    const ID: SolidId = SolidId::Board;
    const PART: FramedPart = FramedPart::BoardEdges;
    const FLAT: bool = false;

    #[inline(always)]
    fn material(&self) -> &Material<T> {
        self.0.material()
    }

    #[inline(always)]
    fn reach(&self, ball: &BallParams<T>) -> T {
        self.0.reach(ball)
    }

    #[inline(always)]
    fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, [Vec3<T>; 3]) {
        self.0.contact(ball, state)
    }

    #[inline(always)]
    fn to_contact(&self, ball: &BallParams<T>, state: &BallState<T>) -> ContactFrameState<T> {
        let (zero, one) = (ball.zero(), ball.one());
        let offset = self.0.core.offset(state.position_m);
        let distance = offset.norm();
        let inverse = one / distance.select(distance.is_positive(), one);
        let sign = |x: T| {
            one.select(x.is_positive(), -one)
                .select(x.abs().is_positive(), zero)
        };
        let outward = [sign(offset.y), sign(offset.z)];
        let frame = EdgeFrame {
            cos_phi: offset.x * inverse,
            sin_phi: (offset.y.abs() + offset.z.abs()) * inverse,
            outward,
        };
        let p = state.position_m;
        ContactFrameState {
            compression: self.0.core.reach - distance,
            velocity: frame.to_frame(state.velocity_m_s),
            spin: frame.to_frame(state.spin_rad_s),
            coordinates: [
                frame.cos_phi,
                frame.sin_phi,
                p.z * outward[0] - p.y * outward[1],
            ],
            start: outward,
        }
    }

    #[inline(always)]
    fn to_world(&self, _ball: &BallParams<T>, motion: &ContactFrameState<T>) -> BallState<T> {
        let frame = Self::frame(motion);
        BallState {
            position_m: self.position(&frame, motion),
            velocity_m_s: frame.to_world(motion.velocity),
            spin_rad_s: frame.to_world(motion.spin),
        }
    }

    #[inline(always)]
    fn distances(
        &self,
        ball: &BallParams<T>,
        compression: T,
        _coordinates: &[T; 3],
    ) -> ContactDistances<T> {
        let one = ball.one();
        let core = self.0.core.reach - compression;
        ContactDistances {
            lever: core - self.0.core.radius,
            core,
            inverse_core: one / core,
            axis: one,
            inverse_axis: one,
        }
    }

    #[inline(always)]
    fn frame_turn(
        &self,
        motion: &ContactFrameState<T>,
        distances: &ContactDistances<T>,
    ) -> FrameTurn<T> {
        let zero = motion.compression.zero();
        FrameTurn {
            turn: Vec2::new(motion.velocity.tangent.x * distances.inverse_core, zero),
            torsion: zero,
        }
    }

    #[inline(always)]
    fn free_acceleration(
        &self,
        ball: &BallParams<T>,
        motion: &ContactFrameState<T>,
    ) -> ContactVector<T> {
        let [cos_phi, sin_phi, _] = motion.coordinates;
        let [o_y, o_z] = motion.start;
        let outward = -(ball.gravity * o_z);
        let gravity =
            ContactVector::new(outward * sin_phi, outward * cos_phi, -(ball.gravity * o_y));
        motion.free_acceleration(ball, gravity)
    }

    #[inline(always)]
    fn coordinate_rates(
        &self,
        motion: &ContactFrameState<T>,
        _distances: &ContactDistances<T>,
        turn: &FrameTurn<T>,
    ) -> [T; 3] {
        let [cos_phi, sin_phi, _] = motion.coordinates;
        [
            -(sin_phi * turn.turn.x),
            cos_phi * turn.turn.x,
            motion.velocity.tangent.y,
        ]
    }

    #[inline(always)]
    fn gap(&self, ball: &BallParams<T>, state: &BallState<T>) -> (T, T) {
        self.0.gap(ball, state)
    }

    #[inline(always)]
    fn rebase(&self, motion: &mut ContactFrameState<T>) {
        let [cos_phi, sin_phi, along] = motion.coordinates;
        let scale = unit_scale(cos_phi, sin_phi);
        motion.coordinates = [cos_phi * scale, sin_phi * scale, along];
    }

    #[inline(always)]
    fn is_below_hoop(&self, motion: &ContactFrameState<T>) -> T::Mask {
        let frame = Self::frame(motion);
        self.position(&frame, motion).z.is_negative()
    }

    #[inline(always)]
    fn acts(&self, state: &BallState<T>) -> T::Mask {
        self.0.acts(state)
    }

    /// Whether the centre is beside one side of the core, and not at a corner.
    #[inline(always)]
    fn is_in_frame(&self, state: &BallState<T>) -> T::Mask {
        let offset = self.0.core.offset(state.position_m);
        let (beside, above) = (offset.y.abs().is_positive(), offset.z.abs().is_positive());
        self.0.has_edges_mask() & (beside | above) & !(beside & above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Preset;
    use crate::model::constants_per_ball_mass::ModelParams;
    use proptest::prelude::*;

    proptest! {
        /// Authority: the nearest point of the core, in the world frame.
        #[test]
        fn prop_the_frame_of_an_edge_is_that_of_the_nearest_point(
            side in 0..4_usize, along in -0.5..0.5_f64, angle in -1.2..1.2_f64,
            gap in -0.01..0.0_f64,
            v in prop::array::uniform3(-9.0..9.0_f64), w in prop::array::uniform3(-40.0..40.0_f64),
        ) {
            let params = ModelParams::new(&Preset::named("ncaa").unwrap().physics());
            let (board, ball) = (&params.board, &params.ball);
            let (core, edges) = (&board.core, BoardEdges(board));
            let distance = core.reach + gap;
            let (sin, cos) = libm::sincos(angle.abs());
            let (x, out) = (distance * cos, distance * (0.1 + sin));
            let middle = 0.5 * (core.low.z + core.high.z);
            let (y, z) = match side {
                0 => (core.high.y + out, middle + along),
                1 => (core.low.y - out, middle + along),
                2 => (along, core.high.z + out),
                _ => (along, core.low.z - out),
            };
            let state = BallState {
                position_m: Vec3::new(core.low.x + x, y, z),
                velocity_m_s: v.into(),
                spin_rad_s: w.into(),
            };
            prop_assert!(edges.is_in_frame(&state) && !board.is_in_frame(&state));
            let motion = edges.to_contact(ball, &state);
            let back = edges.to_world(ball, &motion);
            for (a, b) in back.to_array().into_iter().zip(state.to_array()) {
                prop_assert!((a - b).abs() < 1e-13 * (1.0 + b.abs()), "{back:?}");
            }
            prop_assert_eq!(edges.is_below_hoop(&motion), z < 0.0);
            let (there, _) = board.contact(ball, &state);
            let distances = edges.distances(ball, motion.compression, &motion.coordinates);
            prop_assert!((motion.compression - there.compression).abs() < 1e-14);
            prop_assert!((distances.lever - there.lever).abs() < 1e-14);
            prop_assert!((distances.inverse_core - there.curvature_1).abs() < 1e-11);
            prop_assert_eq!(there.curvature_2, 0.0);
            let free = edges.free_acceleration(ball, &motion);
            prop_assert!((free.normal - there.gravity.normal).abs() < 1e-12);
            prop_assert!((motion.velocity.normal - there.velocity.normal).abs() < 1e-13);
            // The other two directions may point the other way.
            let sizes = |v: ContactVector<f64>| [v.tangent.x.abs(), v.tangent.y.abs()];
            for (a, b) in [(free, there.gravity), (motion.spin, there.spin)] {
                for (a, b) in sizes(a).into_iter().zip(sizes(b)) {
                    prop_assert!((a - b).abs() < 1e-12);
                }
            }
        }
    }
}
