//! The releases that are worth simulating from a location, and what that costs.
//!
//! The [`Bracket`] comes from geometry alone: no shot outside its speeds and polar angles can go
//! in. The ranges of pitch and backspin come from what the shooter can intend, widened by
//! [`MARGIN_SIGMAS`] standard deviations of the errors. [`TablePlan::mass_outside`] bounds the
//! probability beyond them.

mod geometric_bounds;
mod made_shots_outside_bounds;
mod nominal_grid;
mod simulated_release_ranges;

pub use geometric_bounds::Bracket;
pub use made_shots_outside_bounds::{WideSample, sample_wide};
pub use nominal_grid::NominalGrid;
pub use simulated_release_ranges::{MARGIN_SIGMAS, PlanError, TablePlan};
