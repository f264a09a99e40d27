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
pub(crate) struct Board<R = f64> {
    /// x of the centre of a ball that just touches the face, m.
    pub(crate) touch_x: R,
    /// x of the face, m.
    pub(crate) face_x: R,
    pub(crate) half_width: R,
    pub(crate) bottom_z: R,
    pub(crate) top_z: R,
    pub(crate) material: Material<R>,
}

impl Board {
    #[inline(always)]
    pub(crate) fn map<R: Real>(&self, splat: &impl Fn(f64) -> R) -> Board<R> {
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

impl<R: Real> ContactFrame<R> for BoardFrame {
    #[inline(always)]
    fn to_space(self, vector: ContactVector<R>) -> Vec3<R> {
        Vec3::new(vector.normal, vector.tangent.x, vector.tangent.y)
    }

    #[inline(always)]
    fn tangent_to_space(self, tangent: Vec2<R>) -> Vec3<R> {
        Vec3::new(tangent.x.zero(), tangent.x, tangent.y)
    }
}

/// The board as seen by a ball on another solid.
#[derive(Clone, Copy)]
pub(crate) struct BoardApproach<R: Real> {
    /// [`Board::touch_x`].
    touch_x: R,
    arrived: R::Mask,
    longest: R,
}

impl<R: Real> Approach<R> for BoardApproach<R> {
    #[inline(always)]
    fn has_arrived(&self) -> R::Mask {
        self.arrived
    }

    #[inline(always)]
    fn closing_gap(&self, state: &BallState<R>, acceleration: Vec3<R>) -> Option<GapPolynomial<R>> {
        let distance = state.position_m.x - self.touch_x;
        let gap = Real::max(distance, distance.splat(TOUCH_GAP_M));
        let (rate, curve) = (state.velocity_m_s.x, acceleration.x);
        let least = gap + self.longest * (rate - curve.abs() * self.longest * 0.5);
        let relevant = least.le(gap.zero());
        if !relevant.any() {
            return None;
        }
        Some(GapPolynomial {
            relevant,
            gap,
            rate,
            curve,
        })
    }
}

impl<R: Real> Solid<R> for Board<R> {
    type Frame = BoardFrame;
    type Approach = BoardApproach<R>;
    const ID: SolidId = SolidId::Board;

    #[inline(always)]
    fn material(&self) -> &Material<R> {
        &self.material
    }

    #[inline(always)]
    fn contact(
        &self,
        ball: &BallParams<R>,
        state: &BallState<R>,
    ) -> (ContactKinematics<R>, BoardFrame) {
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
    fn faces(&self, state: &BallState<R>) -> R::Mask {
        let p = state.position_m;
        self.face_x.lt(p.x)
            & p.y.abs().lt(self.half_width)
            & self.bottom_z.lt(p.z)
            & p.z.lt(self.top_z)
    }

    #[inline(always)]
    fn approach(
        &self,
        _ball: &BallParams<R>,
        state: &BallState<R>,
        _max_acceleration: R,
        longest: R,
    ) -> BoardApproach<R> {
        let gap = state.position_m.x - self.touch_x;
        BoardApproach {
            touch_x: self.touch_x,
            arrived: gap.le(gap.splat(TOUCH_GAP_M))
                & state.velocity_m_s.x.is_negative()
                & self.faces(state),
            longest,
        }
    }
}
