//! What commands leave for other commands: the folders of fits and of runs of `best`. (The store of
//! a sweep is in [`crate::sweep`].)
//!
//! What is read here was written here. Anything else, from a missing key to a changed digit, is
//! [`StoreError::Damaged`], never a default.

pub mod best_run;
pub mod draws;
pub mod fit;
pub mod free_parameters;
pub mod parameters;
pub mod sealed;
pub mod shooters;
pub mod sweep_link;

use crate::config::ConfigError;
use crate::shooter::ProfileError;
use std::path::{Path, PathBuf};

/// Why a stored fit or run cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file is not as it was written, or is of another version.
    #[error("{}: {message}", .file.display())]
    Damaged {
        /// The file.
        file: PathBuf,
        /// The key, what was expected, and what to do.
        message: String,
    },
    /// The folder is not of this kind, or a value in it that a user may change is refused.
    #[error("{0}")]
    Refused(String),
    /// A file cannot be read.
    #[error("{}: {error}", .file.display())]
    Io {
        /// The file.
        file: PathBuf,
        /// What the system says.
        error: std::io::Error,
    },
    /// The profile is not valid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The stored values make no profile.
    #[error(transparent)]
    Profile(#[from] ProfileError),
}

impl StoreError {
    /// A file that cannot be read.
    #[must_use]
    pub fn io(file: &Path, error: std::io::Error) -> Self {
        Self::Io {
            file: file.to_owned(),
            error,
        }
    }

    /// A file that is not as it was written.
    pub fn damaged(file: &Path, message: impl std::fmt::Display) -> Self {
        Self::Damaged {
            file: file.to_owned(),
            message: message.to_string(),
        }
    }
}
