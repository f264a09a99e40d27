//! Best shots at every place of a region, written to disk as they come.
//!
//! A *job* is one kind of shot at one place. [`Configuration`] says what is asked for, [`jobs`] lists it,
//! [`run`] computes what is not yet there, [`store`] keeps each result in SQLite with a checksum,
//! [`folder`] joins the stores of all processes, and [`tables`] writes the final tables. The files are the
//! truth: whatever is killed, the same command goes on.

pub mod configuration;
pub mod folder;
pub mod jobs;
mod region;
pub mod row;
pub mod run;
pub mod store;
pub mod tables;

pub use configuration::{Compute, Configuration, Texts};
pub use region::{MOST_PLACES, Region, Spot};
