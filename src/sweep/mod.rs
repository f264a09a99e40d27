//! Best shots at every place of a region, saved to disk as they are computed.
//!
//! A *spot* is a place that is computed; the result of a mirrored place is that of its spot. A
//! *job* is one kind of shot at one spot. [`SweepConfig`] says what is wanted, [`job_list`] lists
//! it, [`run`] computes what is missing, [`sqlite_results`] saves each result in SQLite with a
//! checksum, [`sweep_folder`] joins the stores of all processes, and [`final_tables`] writes the
//! final tables. The results on disk are the only state: whatever is killed, the same command
//! continues.

pub mod bank_direct_difference;
pub mod columns;
mod court_region;
pub mod final_tables;
pub mod finished_jobs;
mod folder_error;
pub mod job_list;
mod manifest;
pub mod probability_by_place;
mod region_toml;
pub mod result_row;
pub mod run;
mod shard_lock;
pub mod sqlite_results;
pub mod sweep_folder;
pub mod sweep_toml;

pub use court_region::{CourtPlace, MAX_PLACES, Region};
pub use folder_error::SweepFolderError;
pub use shard_lock::{ShardLock, is_locked};
pub use sweep_toml::{Compute, SourceTexts, SweepConfig};
