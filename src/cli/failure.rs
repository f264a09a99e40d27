//! Why a command failed, and the exit code that says so.

use bankshot::plan::PlanError;
use bankshot::probability::best::BestError;
use bankshot::profile::ProfileError;
use bankshot::sweep::folder::FolderError;
use bankshot::sweep::store::StoreError;
use std::fmt::Display;

/// Exit codes.
pub(crate) mod code {
    /// Everything asked for is there.
    pub(crate) const WHOLE: u8 = 0;
    /// Ran, but missed the standard error asked for.
    pub(crate) const MISSED: u8 = 1;
    /// Usage or configuration refused; nothing was written.
    pub(crate) const USAGE: u8 = 2;
    /// Incomplete, or some rows or jobs failed; the others are done.
    pub(crate) const INCOMPLETE: u8 = 3;
    /// Data damaged, foreign or contradictory.
    pub(crate) const DAMAGED: u8 = 4;
    /// A bug.
    pub(crate) const BUG: u8 = 70;
    /// Input or output failed.
    pub(crate) const IO: u8 = 74;
    /// Stopped, or the folder is in use: run again.
    pub(crate) const STOPPED: u8 = 75;
    /// Stopped by Ctrl-C.
    pub(crate) const INTERRUPTED: u8 = 130;
}

/// A command that could not do what was asked.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) code: u8,
    pub(crate) message: String,
}

impl Failure {
    pub(crate) fn usage(message: impl Display) -> Self {
        Self {
            code: code::USAGE,
            message: message.to_string(),
        }
    }

    pub(crate) fn bug(message: impl Display) -> Self {
        Self {
            code: code::BUG,
            message: message.to_string(),
        }
    }

    pub(crate) fn io(place: impl Display, error: &std::io::Error) -> Self {
        Self {
            code: code::IO,
            message: format!("{place}: {error}"),
        }
    }
}

impl From<FolderError> for Failure {
    fn from(error: FolderError) -> Self {
        let code = match &error {
            FolderError::Io { .. } => code::IO,
            FolderError::Store(error) => return Self::from(error.clone()),
            FolderError::InUse { .. } => code::STOPPED,
            FolderError::NoSweep { .. } => code::USAGE,
            FolderError::Changed { .. }
            | FolderError::Contradiction { .. }
            | FolderError::Profile(_) => code::DAMAGED,
        };
        Self {
            code,
            message: error.to_string(),
        }
    }
}

impl From<StoreError> for Failure {
    fn from(error: StoreError) -> Self {
        Self {
            code: match &error {
                StoreError::Damaged { .. } => code::DAMAGED,
                StoreError::Io { .. } => code::IO,
            },
            message: error.to_string(),
        }
    }
}

impl From<ProfileError> for Failure {
    fn from(error: ProfileError) -> Self {
        Self::usage(error)
    }
}

impl From<PlanError> for Failure {
    fn from(error: PlanError) -> Self {
        Self::usage(error)
    }
}

impl From<BestError> for Failure {
    fn from(error: BestError) -> Self {
        Self::usage(error)
    }
}
