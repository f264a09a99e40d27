//! The best direct and the best bank shot from one location (Eq. 26).

mod pattern_search;
mod physics_comparison;
mod search;
mod shot_table;

pub use crate::shooter::ShotKind;
pub use physics_comparison::{
    PhysicsComparison, PhysicsRow, PhysicsVariant, SameShot, compare_physics, physics_variants,
};
pub use search::{BestShot, BestShotError, BestShots, Limit, NoShot, find, find_kinds};
pub use shot_table::{
    InterpolationCheck, MOST_HALVINGS, MOST_NODES, ShotTable, ShotTableError, ShotTableRequest,
    TableKind, TableShot,
};
