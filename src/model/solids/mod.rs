//! The solids that the ball can touch: the board, and the hoop with its bracket.
//!
//! Each solid is a flat core swept by a sphere, and a type that implements [`Solid`]: nearest
//! point, normal, curvature and material. The core of the ring is a circle, that of board and
//! bracket a rectangle. The ball touches where the distance d of its centre from the core is less
//! than the sum of both radii, the *reach*; the compression is u = reach - d. The ball gives and
//! the solid does not, so the contact point is the *lever* R - u from the centre. For a core of
//! radius 0, as all of the paper's, the lever is d.
//!
//! The equations of contact are written once, in the frame of the contact. The unit normal `n`
//! points from the solid to the ball's centre; `(n, 1, 2)` is right-handed: `(i, j, k)` at the face
//! of the board, `(u_n, u_phi, u_theta)` at the ring (Eq. 6), and at an edge as `board_edges` says.
//! The solids differ in how the frame turns as the ball moves along the surface,
//! `n' = (kappa_1 v_1, kappa_2 v_2)`: not at all at a face, with the curvatures `1/d` and
//! `-cos(phi)/D_theta` at the ring (Eq. 7), with `1/d` across an edge and around a corner.
//!
//! A ball on the ring's circle, on the board's face or on one of its edges is followed in that
//! frame ([`ContactFrameState`]); on the bracket, at a corner, and on two solids at once, in the
//! world frame.

mod board;
mod board_edges;
mod contact_frame_state;
mod contact_kinematics;
mod material;
mod rectangle;
mod ring;
mod solid;

pub(crate) use board::Board;
pub(crate) use board_edges::BoardEdges;
pub(crate) use contact_frame_state::{
    CONTACT_NUMBERS, ContactDistances, ContactFrameState, FrameTurn,
};
pub(crate) use contact_kinematics::{ContactKinematics, ContactVector};
pub(crate) use material::Material;
pub(crate) use rectangle::Rectangle;
pub(crate) use ring::Ring;
pub use solid::SolidId;
pub(crate) use solid::{FramedPart, Solid, TOUCH_GAP_M};
