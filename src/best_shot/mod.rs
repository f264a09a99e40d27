//! The best direct and the best bank shot from one location (Eq. 26).

mod pattern_search;
mod search;

pub use crate::shooter::ShotKind;
pub use search::{BestShot, BestShotError, BestShots, Limit, NoShot, find, find_kinds};
