//! Why there is no fit, as a failure of the program.

use crate::cli::failure::{Failure, code};
use crate::fitting::{FitError, ShooterFitError};

pub(crate) fn failure(place: &str, error: &ShooterFitError) -> Failure {
    Failure {
        code: match error {
            ShooterFitError::Fit(FitError::NotConverged { .. }) => code::IMPRECISE,
            _ => code::USAGE,
        },
        message: format!("{place}: {error}"),
    }
}
