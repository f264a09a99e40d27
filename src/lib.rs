//! bankshot: a parallel batch probability engine for the basketball shot.
//!
//! Data flows one way: a checked [`shooter::Profile`] (from TOML by [`config`]), the releases worth
//! trying ([`search_space`]), the simulation ([`dynamics`]), probabilities ([`probability`]), what
//! they depend on ([`analysis`]), the best shots ([`best_shot`]), and profiles fitted to measured
//! shots ([`fitting`]). No module imports one further down the list below.
//!
//! The model is that of "Numerical Analysis of the Basketball Shot" (J. Dyn. Sys. Meas. Control,
//! DOI 10.1115/1.1636193), with its errata; `docs/model.md` has the equations.
//!
//! With `default-features = false` the crate is this engine alone. The feature `app` (default) adds
//! the command line, tables, sweeps on disk, plots and reports.
//!
//! ```
//! use bankshot::probability::Silent;
//! use bankshot::shooter::{Location, ProfileSettings, ReleaseDispersion, Shooter, TableGrid};
//! use bankshot::units::{DEGREE_RAD, FOOT_M, REV_RAD};
//!
//! let mut settings = ProfileSettings::new(Shooter {
//!     name: "guard".to_owned(),
//!     release_height_m: 7.0 * FOOT_M,
//!     max_backspin_rad_s: 3.0 * REV_RAD,
//!     max_side_spin_rad_s: 0.0,
//!     dispersion: ReleaseDispersion {
//!         c10_m_s: 0.25 * FOOT_M,
//!         c20_rad: 1.2 * DEGREE_RAD,
//!         c30_rad: 1.22 * DEGREE_RAD,
//!         c40_rad_s: 0.3 * REV_RAD,
//!         ..ReleaseDispersion::NONE
//!     },
//! });
//! // Small, so that the example is fast.
//! settings.grid = TableGrid { speed: 16, pitch: 10, polar: 10, backspin: 4 };
//! settings.search.standard_error = Some(0.01);
//! let profile = settings.at(Location {
//!     distance_m: 13.75 * FOOT_M,
//!     angle_rad: 0.0,
//! })?;
//! let best = bankshot::best_shot::find(&profile, &Silent)?;
//! assert!(best.direct?.estimate.probability > 0.6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod escape;

pub mod math;

pub mod units;

pub mod model;

pub mod dynamics;

pub mod shooter;

pub mod config;

pub mod search_space;

pub mod probability;

pub mod analysis;

pub mod best_shot;

pub mod fitting;

#[cfg(feature = "app")]
pub mod files;

#[cfg(feature = "app")]
pub mod measured_shots;

#[cfg(feature = "app")]
pub mod store;

#[cfg(feature = "app")]
pub mod answers;

#[cfg(feature = "app")]
pub mod present;

#[cfg(feature = "app")]
pub mod sweep;

#[cfg(feature = "app")]
pub mod plots;

#[cfg(feature = "app")]
pub mod report;

#[cfg(feature = "studio")]
pub mod studio;

#[cfg(feature = "app")]
pub mod cli;
