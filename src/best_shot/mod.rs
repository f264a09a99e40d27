//! The best direct and the best bank shot from one location (Eq. 26).

mod climb;
mod search;
mod shot_kind;

pub use search::{BestShot, BestShotError, BestShots, Limit, NoShot, find, find_kinds};
pub use shot_kind::ShotKind;
