//! Why a page cannot be made.

use crate::dynamics::{SimulatorError, StateError};

/// Why a page cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// The run has found no shot.
    #[error("there is no shot to report yet")]
    NoShot,
    /// The physics cannot be simulated.
    #[error(transparent)]
    Simulator(#[from] SimulatorError),
    /// A shot has a value that is not finite.
    #[error(transparent)]
    State(#[from] StateError),
}
