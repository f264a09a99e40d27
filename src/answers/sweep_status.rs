//! How far a sweep is, and whether its results are sound.

use super::json::{Answer, Provenance};
use serde::Serialize;

/// How many jobs there are, and how many ended how.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct JobCounts {
    /// All.
    pub jobs: usize,
    /// Those that are done.
    pub done: usize,
    /// Those that found a shot.
    pub found: usize,
    /// Those that found that there is none.
    pub without_shot: usize,
    /// Those that failed.
    pub failed: usize,
}

/// A store of results.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StoreStatus {
    /// Its file.
    pub file: String,
    /// Jobs in it.
    pub computed: u64,
    /// What they took.
    pub thread_seconds: f64,
    /// Whether a process writes into it.
    pub is_running: bool,
}

/// How far a sweep is.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StatusAnswer {
    /// The jobs.
    #[serde(flatten)]
    pub jobs: JobCounts,
    /// The name of the sweep.
    pub sweep: String,
    /// The stores.
    pub stores: Vec<StoreStatus>,
    /// What is damaged, in words.
    pub remarks: Vec<String>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

/// Whether the results of a sweep are sound.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct VerifyAnswer {
    /// The jobs.
    #[serde(flatten)]
    pub jobs: JobCounts,
    /// What is damaged, in words.
    pub damaged: Vec<String>,
    /// Tables that are not what the results give, in words.
    pub damaged_tables: Vec<String>,
    /// Jobs that were computed again.
    pub recomputed: usize,
    /// Those whose result differs.
    pub differing_jobs: Vec<u64>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl Answer for StatusAnswer {
    const NAME: &'static str = "sweep_status";
}

impl Answer for VerifyAnswer {
    const NAME: &'static str = "sweep_check";
}
