//! The board: a rectangle in the plane `x = -a`, or a plate with rounded edges whose front face
//! lies there.

use super::contact_frame_state::{ContactDistances, ContactFrameState, FrameTurn};
use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::material::Material;
use super::rectangle::Rectangle;
use super::solid::{FramedPart, Solid, SolidId};
use crate::math::real::Real;
use crate::math::vector::{Vec2, Vec3};
use crate::model::ball_params::BallParams;
use crate::model::ball_state::BallState;

/// The board.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Board<T = f64> {
    /// x of the centre of a ball that just touches the face, m.
    pub(crate) touch_x: T,
    /// x of the face, m.
    pub(crate) face_x: T,
    /// The flat part of the face.
    pub(crate) half_width: T,
    pub(crate) bottom_z: T,
    pub(crate) top_z: T,
    /// The core of the plate.
    pub(crate) core: Rectangle<T>,
    /// The board acts at its edges too; the paper's does not.
    pub(crate) has_edges: bool,
    pub(crate) material: Material<T>,
}

impl Board {
    #[inline(always)]
    pub(crate) fn map<T: Real>(&self, splat: &impl Fn(f64) -> T) -> Board<T> {
        Board {
            touch_x: splat(self.touch_x),
            face_x: splat(self.face_x),
            half_width: splat(self.half_width),
            bottom_z: splat(self.bottom_z),
            top_z: splat(self.top_z),
            core: self.core.map(splat),
            has_edges: self.has_edges,
            material: self.material.map(splat),
        }
    }
}

/// The unit vectors of the world frame.
#[inline(always)]
fn unit_vectors<T: Real>(ball: &BallParams<T>) -> [Vec3<T>; 3] {
    let (zero, one) = (ball.zero(), ball.one());
    [
        Vec3::new(one, zero, zero),
        Vec3::new(zero, one, zero),
        Vec3::new(zero, zero, one),
    ]
}

impl<T: Real> Board<T> {
    /// Whether the board acts at its edges too, in every lane.
    #[inline(always)]
    pub(crate) fn has_edges_mask(&self) -> T::Mask {
        self.face_x.splat_mask(self.has_edges)
    }
}

impl<T: Real> Solid<T> for Board<T> {
    const ID: SolidId = SolidId::Board;
    const PART: FramedPart = FramedPart::BoardFace;
    const FLAT: bool = true;

    #[inline(always)]
    fn material(&self) -> &Material<T> {
        &self.material
    }

    #[inline(always)]
    fn reach(&self, _ball: &BallParams<T>) -> T {
        self.core.reach
    }

    #[inline(always)]
    fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, [Vec3<T>; 3]) {
        let axes = unit_vectors(ball);
        if self.has_edges {
            return self.core.contact(ball, state, [axes[1], axes[2]]);
        }
        let (x, v, w) = (state.position_m.x, state.velocity_m_s, state.spin_rad_s);
        let zero = ball.zero();
        let a = ball.free_acceleration(v, w);
        let kinematics = ContactKinematics {
            compression: self.touch_x - x,
            lever: x - self.face_x,
            velocity: ContactVector::new(v.x, v.y, v.z),
            spin: ContactVector::new(w.x, w.y, w.z),
            gravity: ContactVector::new(a.x, a.y, a.z),
            curvature_1: zero,
            curvature_2: zero,
        };
        (kinematics, axes)
    }

    #[inline(always)]
    fn to_contact(&self, ball: &BallParams<T>, state: &BallState<T>) -> ContactFrameState<T> {
        let (p, v, w) = (state.position_m, state.velocity_m_s, state.spin_rad_s);
        let zero = ball.zero();
        ContactFrameState {
            compression: self.touch_x - p.x,
            velocity: ContactVector::new(v.x, v.y, v.z),
            spin: ContactVector::new(w.x, w.y, w.z),
            coordinates: [p.y, p.z, zero],
            start: [zero, zero],
        }
    }

    #[inline(always)]
    fn to_world(&self, _ball: &BallParams<T>, motion: &ContactFrameState<T>) -> BallState<T> {
        let [v, w] = [motion.velocity, motion.spin];
        BallState {
            position_m: Vec3::new(
                self.touch_x - motion.compression,
                motion.coordinates[0],
                motion.coordinates[1],
            ),
            velocity_m_s: Vec3::new(v.normal, v.tangent.x, v.tangent.y),
            spin_rad_s: Vec3::new(w.normal, w.tangent.x, w.tangent.y),
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
        ContactDistances {
            lever: ball.radius - compression,
            core: one,
            inverse_core: one,
            axis: one,
            inverse_axis: one,
        }
    }

    #[inline(always)]
    fn frame_turn(
        &self,
        motion: &ContactFrameState<T>,
        _distances: &ContactDistances<T>,
    ) -> FrameTurn<T> {
        let zero = motion.compression.zero();
        FrameTurn {
            turn: Vec2::new(zero, zero),
            torsion: zero,
        }
    }

    #[inline(always)]
    fn free_acceleration(
        &self,
        ball: &BallParams<T>,
        motion: &ContactFrameState<T>,
    ) -> ContactVector<T> {
        let gravity = ContactVector::new(ball.zero(), ball.zero(), -ball.gravity);
        motion.free_acceleration(ball, gravity)
    }

    #[inline(always)]
    fn coordinate_rates(
        &self,
        motion: &ContactFrameState<T>,
        _distances: &ContactDistances<T>,
        turn: &FrameTurn<T>,
    ) -> [T; 3] {
        let v = motion.velocity.tangent;
        [v.x, v.y, turn.torsion]
    }

    #[inline(always)]
    fn gap(&self, _ball: &BallParams<T>, state: &BallState<T>) -> (T, T) {
        if self.has_edges {
            self.core.gap(state)
        } else {
            (state.position_m.x - self.touch_x, state.velocity_m_s.x)
        }
    }

    #[inline(always)]
    fn rebase(&self, _motion: &mut ContactFrameState<T>) {}

    #[inline(always)]
    fn acts(&self, state: &BallState<T>) -> T::Mask {
        if self.has_edges {
            self.face_x.splat_mask(true)
        } else {
            self.is_in_frame(state)
        }
    }

    /// Whether the centre is in front of the flat part.
    #[inline(always)]
    fn is_in_frame(&self, state: &BallState<T>) -> T::Mask {
        let p = state.position_m;
        self.face_x.lt(p.x)
            & p.y.abs().lt(self.half_width)
            & self.bottom_z.lt(p.z)
            & p.z.lt(self.top_z)
    }
}
