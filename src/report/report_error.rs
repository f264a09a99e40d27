//! Why a page cannot be made.

use crate::config::ConfigError;
use crate::dynamics::{SimulatorError, StateError};
use crate::shooter::ProfileError;

/// Why a page cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The run has found no shot.
    #[error("there is no shot to report yet")]
    NoShot,
    /// The profile of the run is not valid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The profile of the run is not valid in the units of the run.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// A file of the run cannot be parsed.
    #[error("{file}: {message}")]
    File {
        /// Name of the file.
        file: &'static str,
        /// What is wrong.
        message: String,
    },
    /// The physics cannot be simulated.
    #[error(transparent)]
    Simulator(#[from] SimulatorError),
    /// A shot has a value that is not finite.
    #[error(transparent)]
    State(#[from] StateError),
}
