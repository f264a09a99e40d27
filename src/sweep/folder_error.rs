//! Why a sweep's folder could not be used.

use super::sqlite_results::ResultsError;
use crate::config::ConfigError;
use crate::shooter::IdentityError;
use std::io;
use std::path::{Path, PathBuf};

/// Why a sweep's folder could not be used.
#[derive(Debug, thiserror::Error)]
pub enum SweepFolderError {
    /// A file could not be read or written.
    #[error("{}: {error}", .path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// The error.
        error: io::Error,
    },
    /// A store failed.
    #[error(transparent)]
    Store(#[from] ResultsError),
    /// The folder holds another sweep.
    #[error("{}: has the results of another sweep; name another folder, or change back:\n{}", .path.display(), .differences.join("\n"))]
    OtherSweep {
        /// The folder.
        path: PathBuf,
        /// What differs.
        differences: Vec<String>,
    },
    /// The folder holds no sweep, or one that cannot be read.
    #[error("{}: {reason}", .path.display())]
    NoSweep {
        /// The folder.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// Another process works in the folder.
    #[error("{}: is in use by {by}; wait for it, or stop it", .path.display())]
    InUse {
        /// The lock.
        path: PathBuf,
        /// Process and host.
        by: String,
    },
    /// Two stores have different results of a job.
    #[error("job {job} has two different results, in {} and in {}; one of the two machines computes wrongly: set one file aside and run the sweep's command again", .first.display(), .second.display())]
    Contradiction {
        /// The job.
        job: u64,
        /// One store.
        first: PathBuf,
        /// The other store.
        second: PathBuf,
    },
    /// The texts in the manifest no longer make a sweep.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The sweep cannot be serialised.
    #[error(transparent)]
    Identity(#[from] IdentityError),
}

/// An input or output error at a path.
pub(super) fn io_error_at(path: &Path) -> impl Fn(io::Error) -> SweepFolderError {
    let path = path.to_owned();
    move |error| SweepFolderError::Io {
        path: path.clone(),
        error,
    }
}
