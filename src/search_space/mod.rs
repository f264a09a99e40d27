//! The releases that are worth simulating from a location, and what that costs.
//!
//! The [`Bracket`] comes from geometry alone: no shot outside its speeds and polar angles can go in. The
//! ranges of pitch and backspin come from what the shooter can intend, widened by [`MARGIN_SIGMAS`]
//! standard deviations of the errors. [`TablePlan::mass_outside`] bounds the probability beyond them.

mod nominal_grid;
mod release_bracket;
mod shot_table_plan;
mod wide_sample;

pub use nominal_grid::NominalGrid;
pub use release_bracket::Bracket;
pub use shot_table_plan::{MARGIN_SIGMAS, PlanError, TablePlan};
pub use wide_sample::{WideSample, sample_wide};
