//! The locks of a sweep's folder: one process writes each store.

use super::folder_error::{SweepFolderError, io_error_at};
use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// How long to retry a lock that is held: a process that only reads takes it for a moment.
const RETRY_TIME: Duration = Duration::from_millis(300);

/// The right to write the store of a shard, until it is dropped or the process ends for any reason.
#[derive(Debug)]
pub struct ShardLock {
    /// Held while this lives.
    pub(super) _file: File,
    /// Path of the store.
    pub store: PathBuf,
    /// Where an abort of the program is noted.
    pub aborted: PathBuf,
}

impl ShardLock {
    /// Removes the note of an abort if it is empty, after a run without one.
    pub fn remove_empty_note(&self) {
        if fs::metadata(&self.aborted).is_ok_and(|note| note.len() == 0) {
            // What stays is harmless.
            let _ = fs::remove_file(&self.aborted);
        }
    }
}

/// Whether another process holds this lock.
#[must_use]
pub fn is_locked(path: &Path) -> bool {
    open_lock(path).is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

/// Opens an existing lock. It is opened for writing, because a network file system gives no
/// exclusive lock otherwise.
pub(super) fn open_lock(path: &Path) -> Result<File, SweepFolderError> {
    File::options()
        .read(true)
        .write(true)
        .open(path)
        .map_err(io_error_at(path))
}

/// Locks a file, or says who holds it.
pub(super) fn lock_file(path: &Path, file: &File) -> Result<(), SweepFolderError> {
    let until = Instant::now() + RETRY_TIME;
    let mut lock = file.try_lock();
    while matches!(lock, Err(TryLockError::WouldBlock)) && Instant::now() < until {
        std::thread::sleep(RETRY_TIME / 10);
        lock = file.try_lock();
    }
    match lock {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => {
            let holder = fs::read_to_string(path).unwrap_or_default();
            Err(SweepFolderError::InUse {
                path: path.to_owned(),
                by: if holder.is_empty() {
                    "another process".to_owned()
                } else {
                    holder
                },
            })
        }
        // A file system without locks. They are a courtesy: no result depends on them.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(error)) => Err(io_error_at(path)(error)),
    }
}
