//! What every solid provides.

use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::material::Material;
use crate::math::real::Real;
use crate::math::vector::{Vec2, Vec3};
use crate::model::ball_params::BallParams;
use crate::model::ball_state::BallState;
use serde::Serialize;

/// The solids by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum SolidId {
    /// The backboard.
    Board,
    /// The ring.
    Ring,
}

impl SolidId {
    /// Number of solids.
    pub const COUNT: usize = 2;
    /// Every solid, in the order of their indices.
    pub const ALL: [Self; Self::COUNT] = [Self::Board, Self::Ring];

    /// The name in tables and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Board => "board",
            Self::Ring => "ring",
        }
    }

    /// Position in [`SolidId::ALL`].
    pub(crate) const fn index(self) -> usize {
        self as usize
    }
}

/// Directions of a contact frame in space.
pub(crate) trait ContactFrame<T: Real>: Copy {
    /// x, y, z components of a vector given along (n, 1, 2).
    fn to_space(self, vector: ContactVector<T>) -> Vec3<T>;

    /// x, y, z components of a tangential vector given along (1, 2).
    fn tangent_to_space(self, tangent: Vec2<T>) -> Vec3<T>;
}

/// The approach of a ball to a solid that it does not touch yet, for the next step of a contact.
pub(crate) trait Approach<T: Real> {
    /// Whether the ball has reached the solid.
    fn has_arrived(&self) -> T::Mask;

    /// How the gap closes from `state` under an acceleration of the centre; `None` if it cannot close within
    /// the step in any lane. `state` is that of the approach, but the contact may have removed its slip.
    fn closing_gap(&self, state: &BallState<T>, acceleration: Vec3<T>) -> Option<GapPolynomial<T>>;
}

/// The gap to a solid as `gap + rate t + second_derivative t^2/2`, valid where `relevant` holds.
pub(crate) struct GapPolynomial<T: Real> {
    pub(crate) relevant: T::Mask,
    pub(crate) gap: T,
    pub(crate) rate: T,
    pub(crate) second_derivative: T,
}

/// A rigid body that the ball can touch.
pub(crate) trait Solid<T: Real>: Copy {
    /// Directions of the contact frame in space.
    type Frame: ContactFrame<T>;
    /// The approach of a ball that touches another solid.
    type Approach: Approach<T>;
    /// Its name.
    const ID: SolidId;

    /// The contact law with the ball.
    fn material(&self) -> &Material<T>;

    /// Position and motion of the ball relative to the nearest point of the solid, in the frame of the
    /// contact.
    fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, Self::Frame);

    /// Whether the nearest point lies on the solid: a ball whose centre is beside the board's rectangle
    /// does not touch it.
    fn faces(&self, state: &BallState<T>) -> T::Mask;

    /// The approach of a ball that touches another solid, over a step of at most `longest`, during which
    /// its acceleration is at most `max_acceleration`.
    fn approach(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
        max_acceleration: T,
        longest: T,
    ) -> Self::Approach;
}

/// Gap at which an approached solid counts as touched, m.
pub(crate) const TOUCH_GAP_M: f64 = 1e-7;
