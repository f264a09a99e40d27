//! The front face of the board: a rectangle in the plane `x = -a`.

use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::contact_motion::{ContactDistances, ContactMotion, FrameTurn};
use super::material::Material;
use super::solid::{ContactFrame, Solid, SolidId};
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
    pub(crate) half_width: T,
    pub(crate) bottom_z: T,
    pub(crate) top_z: T,
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
            material: self.material.map(splat),
        }
    }
}

/// The board's frame is that of space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BoardFrame;

impl<T: Real> ContactFrame<T> for BoardFrame {
    #[inline(always)]
    fn to_space(self, vector: ContactVector<T>) -> Vec3<T> {
        Vec3::new(vector.normal, vector.tangent.x, vector.tangent.y)
    }
}

impl<T: Real> Solid<T> for Board<T> {
    type Frame = BoardFrame;
    const ID: SolidId = SolidId::Board;
    const FLAT: bool = true;

    #[inline(always)]
    fn material(&self) -> &Material<T> {
        &self.material
    }

    #[inline(always)]
    fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, BoardFrame) {
        let (x, v, w) = (state.position_m.x, state.velocity_m_s, state.spin_rad_s);
        let zero = ball.zero();
        let kinematics = ContactKinematics {
            compression: self.touch_x - x,
            lever: x - self.face_x,
            velocity: ContactVector::new(v.x, v.y, v.z),
            spin: ContactVector::new(w.x, w.y, w.z),
            gravity: ContactVector::new(zero, zero, -ball.gravity),
            curvature_1: zero,
            curvature_2: zero,
        };
        (kinematics, BoardFrame)
    }

    #[inline(always)]
    fn to_contact(&self, ball: &BallParams<T>, state: &BallState<T>) -> ContactMotion<T> {
        let (p, v, w) = (state.position_m, state.velocity_m_s, state.spin_rad_s);
        let zero = ball.zero();
        ContactMotion {
            compression: self.touch_x - p.x,
            velocity: ContactVector::new(v.x, v.y, v.z),
            spin: ContactVector::new(w.x, w.y, w.z),
            place: [p.y, p.z, zero],
            start: [zero, zero],
        }
    }

    #[inline(always)]
    fn to_space(&self, _ball: &BallParams<T>, motion: &ContactMotion<T>) -> BallState<T> {
        let [v, w] = [motion.velocity, motion.spin];
        BallState {
            position_m: Vec3::new(
                self.touch_x - motion.compression,
                motion.place[0],
                motion.place[1],
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
        _place: &[T; 3],
    ) -> ContactDistances<T> {
        let one = ball.one();
        ContactDistances {
            lever: ball.radius - compression,
            inverse_lever: one,
            axis: one,
            inverse_axis: one,
        }
    }

    #[inline(always)]
    fn frame_turn(
        &self,
        motion: &ContactMotion<T>,
        _distances: &ContactDistances<T>,
    ) -> FrameTurn<T> {
        let zero = motion.compression.zero();
        FrameTurn {
            turn: Vec2::new(zero, zero),
            torsion: zero,
        }
    }

    #[inline(always)]
    fn gravity(&self, ball: &BallParams<T>, _motion: &ContactMotion<T>) -> ContactVector<T> {
        ContactVector::new(ball.zero(), ball.zero(), -ball.gravity)
    }

    #[inline(always)]
    fn place_rates(
        &self,
        motion: &ContactMotion<T>,
        _distances: &ContactDistances<T>,
        turn: &FrameTurn<T>,
    ) -> [T; 3] {
        let v = motion.velocity.tangent;
        [v.x, v.y, turn.torsion]
    }

    #[inline(always)]
    fn gap(&self, _ball: &BallParams<T>, state: &BallState<T>) -> (T, T) {
        (state.position_m.x - self.touch_x, state.velocity_m_s.x)
    }

    #[inline(always)]
    fn rebase(&self, _motion: &mut ContactMotion<T>) {}

    /// Whether the centre is in front of the rectangle.
    #[inline(always)]
    fn faces(&self, state: &BallState<T>) -> T::Mask {
        let p = state.position_m;
        self.face_x.lt(p.x)
            & p.y.abs().lt(self.half_width)
            & self.bottom_z.lt(p.z)
            & p.z.lt(self.top_z)
    }
}
