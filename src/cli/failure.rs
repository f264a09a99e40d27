//! Why a command failed, with its exit code.

use crate::best_shot::{BestShotError, ShotTableError};
use crate::config::ConfigError;
use crate::dynamics::StateError;
use crate::search_space::PlanError;
use crate::shooter::{IdentityError, ProfileError};
use crate::store;
use crate::sweep::SweepFolderError;
use crate::sweep::sqlite_results::ResultsError;
use crate::units::suggestion;
use std::fmt::Display;
use std::io::ErrorKind;
use std::path::Path;

/// Exit codes.
pub(crate) mod code {
    /// Everything is done.
    pub(crate) const DONE: u8 = 0;
    /// Done, but the wanted standard error was not reached.
    pub(crate) const IMPRECISE: u8 = 1;
    /// Usage or configuration refused; nothing was written.
    pub(crate) const USAGE: u8 = 2;
    /// Incomplete, or some rows or jobs failed; the others are done.
    pub(crate) const INCOMPLETE: u8 = 3;
    /// Data damaged, of another sweep, or contradictory.
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

/// A command that failed.
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

    pub(crate) fn io(what: impl Display, error: &std::io::Error) -> Self {
        Self {
            code: code::IO,
            message: format!("{what}: {}", io_in_words(error)),
        }
    }
}

/// Refuses a file in the place of a folder, before anybody waits for results that cannot be kept.
pub(crate) fn refuse_file(folder: &Path) -> Result<(), Failure> {
    match std::fs::metadata(folder) {
        Ok(about) if !about.is_dir() => Err(Failure::io(
            folder.display(),
            &ErrorKind::NotADirectory.into(),
        )),
        _ => Ok(()),
    }
}

/// Refuses a path at which there is nothing, with a name in its folder that may have been meant.
pub(crate) fn refuse_missing(path: &Path) -> Result<(), Failure> {
    // What is there and cannot be read has a message of its own.
    match std::fs::metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        _ => return Ok(()),
    }
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new(".")));
    let mut names: Vec<String> = entries
        .into_iter()
        .flatten()
        .flatten()
        // A link that leads nowhere is no help.
        .filter(|entry| entry.path().exists())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let meant = match suggestion(&name, names.iter().map(String::as_str)) {
        none if none.is_empty() => "; check its name".to_owned(),
        meant => meant,
    };
    Err(Failure::usage(format!(
        "{}: {NO_SUCH_FILE}{meant}",
        path.display()
    )))
}

const NO_SUCH_FILE: &str = "there is no such file or folder";

/// What the system says of a file, without its number where words are enough.
pub(crate) fn io_in_words(error: &std::io::Error) -> String {
    match error.kind() {
        ErrorKind::NotFound => NO_SUCH_FILE.to_owned(),
        ErrorKind::AlreadyExists | ErrorKind::NotADirectory => {
            "is a file where a folder must be; choose another name".to_owned()
        }
        _ => error.to_string(),
    }
}

impl From<SweepFolderError> for Failure {
    fn from(error: SweepFolderError) -> Self {
        let code = match &error {
            // A link or a pipe in the place of a file.
            SweepFolderError::Io { error, .. }
                if matches!(
                    error.kind(),
                    ErrorKind::InvalidData | ErrorKind::InvalidInput
                ) =>
            {
                code::DAMAGED
            }
            SweepFolderError::Io { .. } => code::IO,
            SweepFolderError::Store(error) => return Self::from(error.clone()),
            SweepFolderError::InUse { .. } => code::STOPPED,
            SweepFolderError::NoSweep { .. } => code::USAGE,
            SweepFolderError::OtherSweep { .. }
            | SweepFolderError::Contradiction { .. }
            | SweepFolderError::Config(_) => code::DAMAGED,
            SweepFolderError::Identity(_) => code::BUG,
        };
        Self {
            code,
            message: error.to_string(),
        }
    }
}

impl From<store::StoreError> for Failure {
    fn from(error: store::StoreError) -> Self {
        match error {
            store::StoreError::Damaged { .. } => Self {
                code: code::DAMAGED,
                message: error.to_string(),
            },
            store::StoreError::Io { file, error } => Self::io(file.display(), &error),
            store::StoreError::Refused(message) => Self::usage(message),
            store::StoreError::Config(error) => error.into(),
            store::StoreError::Profile(error) => error.into(),
        }
    }
}

impl From<ResultsError> for Failure {
    fn from(error: ResultsError) -> Self {
        Self {
            code: match &error {
                ResultsError::Damaged { .. } => code::DAMAGED,
                ResultsError::Io { .. } => code::IO,
            },
            message: error.to_string(),
        }
    }
}

impl From<ShotTableError> for Failure {
    fn from(error: ShotTableError) -> Self {
        match error {
            ShotTableError::Profile(error) => error.into(),
            ShotTableError::Search(error) => error.into(),
            ShotTableError::SeveralAngles => Self::usage(format!(
                "--kind best: {error}; give --angles one value, or make a table of each kind"
            )),
        }
    }
}

impl From<IdentityError> for Failure {
    fn from(error: IdentityError) -> Self {
        Self::bug(error)
    }
}

/// Errors in the input: refused.
macro_rules! usage_errors {
    ($($error:ty),+ $(,)?) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::usage(error)
            }
        })+
    };
}

usage_errors!(
    ConfigError,
    ProfileError,
    PlanError,
    BestShotError,
    StateError
);
