//! The releases that are worth simulating from a location, and what that costs.
//!
//! The [`Bracket`] comes from geometry alone: no shot outside its speeds and polar angles can go in. The
//! ranges of pitch and backspin come from what the shooter can intend, widened by [`MARGIN_SIGMAS`]
//! standard deviations of the errors. [`TablePlan::mass_outside`] bounds the probability beyond them.

mod geometric_bounds;
mod nominal_grid;
mod outside_bounds_check;
mod simulated_release_ranges;

pub use geometric_bounds::Bracket;
pub use nominal_grid::NominalGrid;
pub use outside_bounds_check::{WideSample, sample_wide};
pub use simulated_release_ranges::{MARGIN_SIGMAS, PlanError, TablePlan};
