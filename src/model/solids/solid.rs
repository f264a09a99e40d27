//! What every solid provides.

use super::contact_kinematics::{ContactKinematics, ContactVector};
use super::contact_motion::{ContactDistances, ContactMotion, FrameTurn};
use super::material::Material;
use crate::math::real::Real;
use crate::math::vector::Vec3;
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
}

/// A rigid body that the ball can touch.
pub(crate) trait Solid<T: Real>: Copy {
    /// Directions of the contact frame in space.
    type Frame: ContactFrame<T>;
    /// Its name.
    const ID: SolidId;
    /// Whether the frame of the contact never turns.
    const FLAT: bool;

    /// The contact law with the ball.
    fn material(&self) -> &Material<T>;

    /// Position and motion of the ball relative to the nearest point of the solid, in the frame of the
    /// contact.
    fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, Self::Frame);

    /// The ball in the frame of the contact.
    fn to_contact(&self, ball: &BallParams<T>, state: &BallState<T>) -> ContactMotion<T>;

    /// The state in space of a ball in the frame of the contact.
    fn to_space(&self, ball: &BallParams<T>, motion: &ContactMotion<T>) -> BallState<T>;

    /// Distances at a contact with the given compression and place.
    fn distances(
        &self,
        ball: &BallParams<T>,
        compression: T,
        place: &[T; 3],
    ) -> ContactDistances<T>;

    /// How the frame turns. Not called for a flat solid.
    fn frame_turn(
        &self,
        motion: &ContactMotion<T>,
        distances: &ContactDistances<T>,
    ) -> FrameTurn<T>;

    /// Gravity in the frame.
    fn gravity(&self, ball: &BallParams<T>, motion: &ContactMotion<T>) -> ContactVector<T>;

    /// Rates of [`ContactMotion::place`].
    fn place_rates(
        &self,
        motion: &ContactMotion<T>,
        distances: &ContactDistances<T>,
        turn: &FrameTurn<T>,
    ) -> [T; 3];

    /// The gap between the ball and the solid (negative in contact), and its rate.
    fn gap(&self, ball: &BallParams<T>, state: &BallState<T>) -> (T, T);

    /// Keeps the values of a long contact within the range of their formulas.
    fn rebase(&self, motion: &mut ContactMotion<T>);

    /// Whether the nearest point lies on the solid: a ball whose centre is beside the board's rectangle
    /// does not touch it.
    fn faces(&self, state: &BallState<T>) -> T::Mask;
}

/// Gap at which a ball counts as touching at its release, and heights as equal, m.
pub(crate) const TOUCH_GAP_M: f64 = 1e-7;
