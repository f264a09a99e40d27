//! The solids that the ball can touch: board and ring.
//!
//! Each solid is a type that implements [`Solid`]: nearest point, normal, curvature, material, and the
//! approach of a ball that does not touch it yet. The equations of contact are written once, in the frame
//! of the contact.
//!
//! The unit normal `n` points from the solid to the ball's centre; `(n, 1, 2)` is right-handed:
//! `(i, j, k)` at the board, `(u_n, u_phi, u_theta)` at the ring (Eq. 6). The solids differ in how the
//! frame turns as the ball moves along the surface, `n' = (kappa_1 v_1, kappa_2 v_2)`: not at all at the
//! board, and with the curvatures `1/(R-u)` and `-cos(phi)/D_theta` at the ring (Eq. 7).

mod board;
mod contact_kinematics;
mod contact_motion;
mod material;
mod ring;
mod solid;

pub(crate) use board::Board;
pub(crate) use contact_kinematics::{ContactKinematics, ContactVector};
pub(crate) use contact_motion::{CONTACT_VALUES, ContactDistances, ContactMotion, FrameTurn};
pub(crate) use material::Material;
pub(crate) use ring::Ring;
pub use solid::SolidId;
pub(crate) use solid::{ContactFrame, Solid, TOUCH_GAP_M};
