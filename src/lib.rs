//! bankshot: a parallel batch probability engine for the basketball shot.
//!
//! Data flows one way: a [`profile`] is checked, a [`plan`] says which releases are worth trying,
//! [`dynamics`] simulates them, [`probability`] reduces them to probabilities and best shots, and
//! [`output`] writes those down; a [`sweep`] does so for every place of a [`court`]. No module imports one further down that line.
//!
//! The model is that of "Numerical Analysis of the Basketball Shot" (J. Dyn. Sys. Meas. Control,
//! DOI 10.1115/1.1636193), with its errata; `docs/model.md` has the equations.
//!
//! ```
//! use bankshot::probability::{Silent, best};
//! use bankshot::profile;
//!
//! let mut profile = profile::parse(
//!     r#"
//!     [shooter]
//!     release_height = "7 ft"
//!     max_backspin = "3 rev/s"
//!     [shooter.errors]
//!     c10 = "0.25 ft/s"
//!     c20 = "1.2 deg"
//!     c30 = "1.22 deg"
//!     c40 = "0.3 rev/s"
//!     [location]
//!     distance = "13.75 ft"
//!     angle = "0 deg"
//!     [grid]
//!     speed = 16
//!     pitch = 10
//!     polar = 10
//!     backspin = 4
//!     [search]
//!     standard_error = 0.01
//!     "#,
//!     "example",
//! )?;
//! profile.shooter.name = "guard".to_owned();
//! let best = best::find(&profile, &Silent)?;
//! let direct = best.direct?;
//! assert!(direct.estimate.probability > 0.6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Constants of ball, ring and board, in SI units.
pub mod physics;

// Quantities with their units, at the border of the program.
pub mod units;

// The lines of a court.
pub mod court;

mod lane;

// The ball in flight and in contact: from a release to made or missed.
pub mod dynamics;

// A shooter's profile, checked.
pub mod profile;

// Which releases are worth simulating, and the cost.
pub mod plan;

// Probabilities and best shots.
pub mod probability;

// Records, tables and files.
pub mod output;

// Best shots at many places, on disk as they come.
pub mod sweep;

// Results to look at.
pub mod picture;
