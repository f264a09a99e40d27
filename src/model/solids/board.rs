//! The front face of the board: a rectangle in the plane `x = -a`.

use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::material::Material;
use super::solid::{Approach, ContactFrame, GapPolynomial, Solid, SolidId, TOUCH_GAP_M};
use crate::math::real::{Mask, Real};
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

    #[inline(always)]
    fn tangent_to_space(self, tangent: Vec2<T>) -> Vec3<T> {
        Vec3::new(tangent.x.zero(), tangent.x, tangent.y)
    }
}

/// The board as seen by a ball on another solid.
#[derive(Clone, Copy)]
pub(crate) struct BoardApproach<T: Real> {
    /// [`Board::touch_x`].
    touch_x: T,
    arrived: T::Mask,
    /// The ball overlaps the plane of the board, but its centre is not in front of the rectangle: it cannot touch
    /// the board before it comes in front of it.
    beside: T::Mask,
    longest: T,
}

impl<T: Real> Approach<T> for BoardApproach<T> {
    #[inline(always)]
    fn has_arrived(&self) -> T::Mask {
        self.arrived
    }

    #[inline(always)]
    fn closing_gap(&self, state: &BallState<T>, acceleration: Vec3<T>) -> Option<GapPolynomial<T>> {
        let distance = state.position_m.x - self.touch_x;
        let gap = Real::max(distance, distance.splat(TOUCH_GAP_M));
        let (rate, second_derivative) = (state.velocity_m_s.x, acceleration.x);
        let least = gap + self.longest * (rate - second_derivative.abs() * self.longest * 0.5);
        let relevant = least.le(gap.zero()) & !self.beside;
        if !relevant.any() {
            return None;
        }
        Some(GapPolynomial {
            relevant,
            gap,
            rate,
            second_derivative,
        })
    }
}

impl<T: Real> Solid<T> for Board<T> {
    type Frame = BoardFrame;
    type Approach = BoardApproach<T>;
    const ID: SolidId = SolidId::Board;

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

    /// Whether the centre is in front of the rectangle.
    #[inline(always)]
    fn faces(&self, state: &BallState<T>) -> T::Mask {
        let p = state.position_m;
        self.face_x.lt(p.x)
            & p.y.abs().lt(self.half_width)
            & self.bottom_z.lt(p.z)
            & p.z.lt(self.top_z)
    }

    #[inline(always)]
    fn approach(
        &self,
        _ball: &BallParams<T>,
        state: &BallState<T>,
        _max_acceleration: T,
        longest: T,
    ) -> BoardApproach<T> {
        let gap = state.position_m.x - self.touch_x;
        let overlaps = gap.le(gap.splat(TOUCH_GAP_M));
        let faces = self.faces(state);
        BoardApproach {
            touch_x: self.touch_x,
            arrived: overlaps & state.velocity_m_s.x.is_negative() & faces,
            beside: overlaps & !faces,
            longest,
        }
    }
}
