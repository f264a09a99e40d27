//! Whether a profile or a sweep is valid, and what it would take to compute.

use super::json::{Answer, Provenance};
use crate::search_space::{TablePlan, WideSample};
use crate::shooter::{Profile, implausible_values};
use serde::Serialize;

/// What is wrong in a file.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Fault {
    /// The key, if it is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub key: Option<String>,
    /// What is wrong, in words.
    pub message: String,
    /// Where, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// See `line`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<usize>,
}

/// What a valid file is of.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Checked {
    /// A sweep.
    Sweep {
        /// Its name.
        sweep: String,
        /// The number of its places.
        places: usize,
    },
    /// A profile.
    Profile {
        /// Who shoots.
        shooter: String,
        /// From how far.
        distance_m: f64,
        /// From the court's long axis.
        court_angle_rad: f64,
        /// Height of the ball's centre at the release.
        release_height_m: f64,
        /// Values that no shooter has, in words.
        warnings: Vec<String>,
    },
}

impl Checked {
    /// What a valid profile is of.
    #[must_use]
    pub fn profile(profile: &Profile) -> Self {
        let (shooter, location) = (profile.shooter(), profile.location());
        let warnings = implausible_values(profile);
        Self::Profile {
            shooter: shooter.name.clone(),
            distance_m: location.distance_m,
            court_angle_rad: location.angle_rad,
            release_height_m: shooter.release_height_m,
            warnings: warnings.iter().map(ToString::to_string).collect(),
        }
    }
}

/// Whether a file is valid.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckAnswer {
    /// The file.
    pub file: String,
    /// Whether it is.
    pub is_valid: bool,
    /// Why not.
    pub errors: Vec<Fault>,
    /// What it is of.
    #[serde(flatten)]
    pub checked: Option<Checked>,
    /// What made the answer, where it is valid.
    #[serde(flatten)]
    pub provenance: Option<Provenance>,
}

/// What a search would take.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, Serialize)]
pub struct PlanAnswer {
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What is searched, in SI units.
    #[cfg_attr(test, schemars(with = "serde_json::Value"))]
    pub plan: TablePlan,
    /// The time.
    pub forecast_s: f64,
    /// The memory.
    pub memory_bytes: f64,
    /// Shots of a wider range, if they were asked for.
    pub wide_sample: Option<WideSample>,
    /// Upper bound of the probability beyond the table, in the middle of it.
    pub mass_outside_middle: f64,
    /// Probability beyond the table for a shot at its lower edge.
    pub mass_outside_edge: f64,
}

/// What a sweep would take.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepPlanAnswer {
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// The places.
    pub places: usize,
    /// Those that are computed; the others are mirror images.
    pub computed_places: usize,
    /// The jobs.
    pub jobs: usize,
    /// The time on all threads; null if nothing could be computed.
    pub forecast_s: Option<f64>,
    /// The threads.
    pub threads: usize,
    /// The memory.
    pub memory_bytes: f64,
    /// The room on disk.
    pub disk_bytes: f64,
}

impl Answer for CheckAnswer {
    const NAME: &'static str = "check";
    const IS_SI: bool = true;
}

impl Answer for PlanAnswer {
    const NAME: &'static str = "plan";
    const IS_SI: bool = true;
}

impl Answer for SweepPlanAnswer {
    const NAME: &'static str = "sweep_plan";
    const IS_SI: bool = true;
}
