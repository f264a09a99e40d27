//! The inventory of a sweep's folder: which jobs are done, and which files are damaged.

use super::folder_error::{SweepFolderError, io_error_at};
use super::result_row::JobStatus;
use super::shard_lock::{ShardLock, open_lock};
use super::sqlite_results::{self, ResultStore, ResultsError};
use super::sweep_folder::{SweepFolder, set_aside};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The results in a sweep's folder.
#[derive(Clone, Debug, Default)]
pub struct Inventory {
    /// The finished jobs by number.
    pub jobs: BTreeMap<u64, JobStatus>,
    /// The damaged files, and what was done with them.
    pub damaged: Vec<String>,
}

impl Inventory {
    /// Takes the inventory for a process that holds a lock, and opens its store. Damaged stores
    /// that nobody writes are set aside, and their valid rows are kept in a new store.
    ///
    /// # Errors
    /// A store cannot be read or written.
    pub fn take(
        folder: &SweepFolder,
        lock: &ShardLock,
    ) -> Result<(Self, ResultStore), SweepFolderError> {
        let mut inventory = Self::default();
        for (path, reason) in folder.read_results(|_, _| {})? {
            inventory
                .damaged
                .push(rescue(folder, &path, &reason, lock)?);
        }
        let store = match ResultStore::open(&lock.store, folder.hash()) {
            Err(ResultsError::Damaged { path, reason }) => {
                inventory
                    .damaged
                    .push(rescue(folder, &path, &reason, lock)?);
                ResultStore::open(&lock.store, folder.hash())?
            }
            store => store?,
        };
        folder.read_results(|_, row| {
            if let Some(status) = row.status() {
                let known = inventory.jobs.entry(row.job).or_insert(status);
                if *known == JobStatus::Failed {
                    *known = status;
                }
            }
        })?;
        Ok((inventory, store))
    }
}

/// Sets a damaged store aside and keeps its valid rows; returns what was done.
fn rescue(
    folder: &SweepFolder,
    path: &Path,
    reason: &str,
    own_lock: &ShardLock,
) -> Result<String, SweepFolderError> {
    let shown = path.display();
    // Held until the end, so that its owner cannot come back meanwhile.
    let lock = path.with_extension("lock");
    let held = if path == own_lock.store || !lock.exists() {
        None
    } else {
        let file = open_lock(&lock)?;
        if file.try_lock().is_err() {
            return Ok(format!("{shown} is damaged ({reason}), but in use"));
        }
        Some(file)
    };
    if !path.exists() {
        return Ok(format!(
            "{shown} was damaged ({reason}); another process has set it aside"
        ));
    }
    let mut rows = Vec::new();
    sqlite_results::read_rows(path, folder.hash(), folder.job_count(), |row| {
        rows.push(row)
    })?;
    if !rows.is_empty() {
        // The new store is complete under another name before the damaged one is renamed: no valid
        // row is ever missing.
        let stem = path.file_stem().unwrap_or_default().display().to_string();
        let named =
            |n: u32, ending: &str| path.with_file_name(format!("{stem}.salvaged-{n}.{ending}"));
        let free = (1..u32::MAX).find(|&n| !named(n, "sqlite").exists());
        let number = free.unwrap_or_default();
        let unfinished = named(number, "unfinished");
        let _ = fs::remove_file(&unfinished);
        let mut store = ResultStore::open(&unfinished, folder.hash())?;
        store.save_copies(&rows)?;
        drop(store);
        let whole = named(number, "sqlite");
        fs::rename(&unfinished, &whole).map_err(io_error_at(&whole))?;
    }
    let aside = set_aside(path).map_err(io_error_at(path))?;
    drop(held);
    Ok(format!(
        "{shown} was damaged ({reason}) and is set aside as {}; {} valid results of it are kept, its other jobs are computed again",
        aside.display(),
        rows.len()
    ))
}
