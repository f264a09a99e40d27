//! What every solid provides.

use super::contact_frame_state::{ContactDistances, ContactFrameState, FrameTurn};
use super::contact_kinematics::{ContactKinematics, ContactVector};
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
    /// The ring, with the bracket that holds it.
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

/// The parts of the solids at which a contact is followed in its own frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FramedPart {
    /// The flat part of the board's face.
    BoardFace,
    /// The four edges of the board, without its corners.
    BoardEdges,
    /// The ring's circle.
    RingCircle,
}

impl FramedPart {
    /// Number of parts.
    pub(crate) const COUNT: usize = 3;

    /// The solid that it belongs to.
    pub(crate) const fn solid(self) -> SolidId {
        match self {
            Self::BoardFace | Self::BoardEdges => SolidId::Board,
            Self::RingCircle => SolidId::Ring,
        }
    }
}

/// A rigid body that the ball can touch.
pub(crate) trait Solid<T: Real>: Copy {
    /// Its name.
    const ID: SolidId;
    /// The part of it that the frame of a contact describes.
    const PART: FramedPart;
    /// Whether the frame of the contact never turns.
    const FLAT: bool;

    /// The contact law with the ball.
    fn material(&self) -> &Material<T>;

    /// Distance of the centre of a touching ball from the core, m.
    fn reach(&self, ball: &BallParams<T>) -> T;

    /// Position and motion of the ball relative to the nearest point of the solid, in the frame of
    /// the contact, and the directions (n, 1, 2) of that frame in the world frame.
    fn contact(
        &self,
        ball: &BallParams<T>,
        state: &BallState<T>,
    ) -> (ContactKinematics<T>, [Vec3<T>; 3]);

    /// The ball in the frame of the contact.
    fn to_contact(&self, ball: &BallParams<T>, state: &BallState<T>) -> ContactFrameState<T>;

    /// The state in the world frame of a ball in the frame of the contact.
    fn to_world(&self, ball: &BallParams<T>, motion: &ContactFrameState<T>) -> BallState<T>;

    /// Distances at a contact with the given compression and coordinates.
    fn distances(
        &self,
        ball: &BallParams<T>,
        compression: T,
        coordinates: &[T; 3],
    ) -> ContactDistances<T>;

    /// How the frame turns. Not called for a flat solid.
    fn frame_turn(
        &self,
        motion: &ContactFrameState<T>,
        distances: &ContactDistances<T>,
    ) -> FrameTurn<T>;

    /// The acceleration by gravity and air, in the frame.
    fn free_acceleration(
        &self,
        ball: &BallParams<T>,
        motion: &ContactFrameState<T>,
    ) -> ContactVector<T>;

    /// Rates of [`ContactFrameState::coordinates`].
    fn coordinate_rates(
        &self,
        motion: &ContactFrameState<T>,
        distances: &ContactDistances<T>,
        turn: &FrameTurn<T>,
    ) -> [T; 3];

    /// The gap between the ball and the solid (negative in contact), and its rate.
    fn gap(&self, ball: &BallParams<T>, state: &BallState<T>) -> (T, T);

    /// Keeps the values of a long contact within the range of their formulas.
    fn rebase(&self, motion: &mut ContactFrameState<T>);

    /// Whether the solid acts on a ball there: the paper's board does so only in front of its
    /// rectangle.
    fn acts(&self, state: &BallState<T>) -> T::Mask;

    /// Whether a ball in the frame of the contact has its centre below the plane of the hoop. (The
    /// second coordinate has the sign of z on the face and on the ring.)
    #[inline(always)]
    fn is_below_hoop(&self, motion: &ContactFrameState<T>) -> T::Mask {
        motion.coordinates[1].is_negative()
    }

    /// Whether the nearest point lies on [`Solid::PART`].
    fn is_in_frame(&self, state: &BallState<T>) -> T::Mask;
}

/// Gap at which a ball counts as touching at its release, and heights as equal, m.
pub(crate) const TOUCH_GAP_M: f64 = 1e-7;
