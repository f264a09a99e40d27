//! The best direct and the best bank shot from one location (Eq. 26).

mod best_by_pitch;
mod followed;
mod found_shots;
mod pattern_search;
mod physics_comparison;
mod search;
mod search_starts;
mod shot_table;
mod table_maxima;

pub use crate::shooter::ShotKind;
pub use best_by_pitch::{ShotAtPitch, best_by_pitch};
pub use found_shots::{BestShot, BestShotError, BestShots, Limit, NoShot, NotCleanShot};
pub use physics_comparison::{
    ChangeOfP, PhysicsChange, PhysicsComparison, PhysicsOf, PhysicsRow, PhysicsVariant, SameShot,
    SameShotProbability, compare_physics, likely_board_restitutions, physics_variants, together,
};
pub use search::{DraftShot, find, find_kinds, find_with_draft};
pub use shot_table::{
    InterpolationCheck, MOST_HALVINGS, MOST_NODES, ShotTable, ShotTableError, ShotTableRequest,
    TableFinding, TableKind, TableShot,
};
