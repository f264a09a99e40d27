//! The best shots of one kind for a grid of distances and court angles, for a program to
//! interpolate in.

mod better_kind;
mod build;
mod cells;
mod interpolation_check;
mod lookup;
mod shot_at_place;
mod table_search;

pub(super) use build::with_fixed;
pub use build::{MOST_HALVINGS, MOST_NODES, ShotTableRequest};
pub use interpolation_check::InterpolationCheck;
pub use lookup::{ShotTable, TableKind, TableShot};
pub use shot_at_place::ShotTableError;
pub(super) use shot_at_place::{FoundAtPlace, best};
pub use table_search::TableFinding;
