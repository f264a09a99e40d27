//! The folder of a sweep: its manifest, the stores of all processes, and their locks.
//!
//! ```text
//! configuration.json                           the sweep, with the texts of its files
//! store/1-of-1.HOST.sqlite                     results of one process (.lock: it runs)
//! best_shots.csv, .parquet, provenance.json    once all jobs are done
//! ```

use super::folder_error::{SweepFolderError, io_error_at};
use super::job_list::{Jobs, Shard};
use super::manifest::{self, Manifest, ManifestFile};
use super::result_row::{JobStatus, ResultRow};
use super::shard_lock::{ShardLock, lock_file, open_lock};
use super::sqlite_results;
use super::sweep_toml::{SourceTexts, SweepConfig, parse_sweep};
use crate::files::atomic_file;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// A sweep's folder.
#[derive(Clone, Debug)]
pub struct SweepFolder {
    path: PathBuf,
    hash: String,
    program: String,
    job_count: u64,
}

/// Which versions of the program may have computed a sweep that is opened.
#[derive(Clone, Copy, PartialEq, Eq)]
enum ProgramVersion {
    /// Only this one.
    This,
    /// Any: the results are only read.
    Any,
}

impl SweepFolder {
    /// The folder for a sweep; created if it does not exist.
    ///
    /// # Errors
    /// It cannot be written, or holds another sweep.
    pub fn open(
        path: &Path,
        config: &SweepConfig,
        texts: &SourceTexts,
    ) -> Result<Self, SweepFolderError> {
        let store = path.join("store");
        atomic_file::refuse_linked_folder(&store).map_err(io_error_at(&store))?;
        fs::create_dir_all(&store).map_err(io_error_at(&store))?;
        tempfile::tempfile_in(&store).map_err(io_error_at(&store))?;
        let file = path.join(manifest::FILE_NAME);
        let new = Manifest::new(config, texts)?;
        let text = serde_json::to_string_pretty(&new).unwrap_or_default() + "\n";
        // Other processes may open the folder at the same time: the first one writes, and all read
        // the result.
        loop {
            match Manifest::read(&file).map_err(io_error_at(&file))? {
                ManifestFile::Valid(old) if old.hash == new.hash => {
                    if old.texts != new.texts {
                        // Names of places, or another format of the same sweep: `merge` reads them
                        // here.
                        let written = atomic_file::write(&file, text.as_bytes());
                        written.map_err(io_error_at(&file))?;
                    }
                    break;
                }
                ManifestFile::Valid(old) => {
                    return Err(SweepFolderError::OtherSweep {
                        path: path.to_owned(),
                        differences: old.differences(&new),
                    });
                }
                ManifestFile::Missing => {
                    let is_written = atomic_file::write_new(&file, text.as_bytes());
                    if is_written.map_err(io_error_at(&file))? {
                        break;
                    }
                }
                ManifestFile::Damaged => {
                    set_aside(&file).map_err(io_error_at(&file))?;
                }
            }
        }
        Ok(Self {
            path: path.to_owned(),
            program: new.program(),
            hash: new.hash,
            job_count: Jobs::new(config).count() as u64,
        })
    }

    /// The sweep in a folder.
    ///
    /// # Errors
    /// There is none, or it is of another version of the program.
    pub fn existing(path: &Path) -> Result<(Self, SweepConfig), SweepFolderError> {
        Self::read(path, ProgramVersion::This)
    }

    /// The sweep in a folder, to read its results; also of another version of the program.
    ///
    /// # Errors
    /// There is none, or this version reads it differently.
    pub fn open_read_only(path: &Path) -> Result<(Self, SweepConfig), SweepFolderError> {
        Self::read(path, ProgramVersion::Any)
    }

    fn read(path: &Path, version: ProgramVersion) -> Result<(Self, SweepConfig), SweepFolderError> {
        let no_sweep = |reason: &str| SweepFolderError::NoSweep {
            path: path.to_owned(),
            reason: reason.to_owned(),
        };
        let file = path.join(manifest::FILE_NAME);
        let manifest = match Manifest::read(&file).map_err(io_error_at(&file))? {
            ManifestFile::Valid(manifest) => manifest,
            ManifestFile::Damaged => {
                return Err(no_sweep(
                    "configuration.json is damaged; run the sweep's command again to write a new one",
                ));
            }
            ManifestFile::Missing => {
                let within = sweeps_within(path);
                return Err(no_sweep(&if within.is_empty() {
                    "is not the folder of a sweep (it has no configuration.json)".to_owned()
                } else {
                    format!(
                        "has a sweep in each of its folders; name one: {}",
                        within.join(", ")
                    )
                }));
            }
        };
        let config = parse_sweep(&manifest.texts, &file.display().to_string())?;
        let is_usable = config.hash()? == manifest.hash
            || version == ProgramVersion::Any && manifest.has_configuration_of(&config);
        if !is_usable {
            let new = Manifest::new(&config, &manifest.texts)?;
            return Err(SweepFolderError::OtherSweep {
                path: path.to_owned(),
                differences: manifest.differences(&new),
            });
        }
        let folder = Self {
            path: path.to_owned(),
            program: manifest.program(),
            hash: manifest.hash,
            job_count: Jobs::new(&config).count() as u64,
        };
        Ok((folder, config))
    }

    /// Its path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Version and commit of the program that computes it.
    #[must_use]
    pub fn program(&self) -> &str {
        &self.program
    }

    /// The hash of its configuration.
    #[must_use]
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Number of jobs.
    #[must_use]
    pub fn job_count(&self) -> u64 {
        self.job_count
    }

    /// Takes the lock of a shard's store on this host.
    ///
    /// # Errors
    /// Another process has it, or works in the folder while all shards are wanted.
    pub fn lock(&self, shard: Shard) -> Result<ShardLock, SweepFolderError> {
        let store = self.path.join("store");
        let host: String = gethostname::gethostname()
            .to_string_lossy()
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
            .take(60)
            .collect();
        let name = format!("{}-of-{}.{host}", shard.index + 1, shard.count);
        let named = |ending: &str| store.join(format!("{name}.{ending}"));
        let path = named("lock");
        for ending in ["lock", "sqlite", "sqlite-journal", "aborted"] {
            let file = named(ending);
            atomic_file::refuse_special(&file).map_err(io_error_at(&file))?;
        }
        let mut file = File::options()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .open(&path)
            .map_err(io_error_at(&path))?;
        lock_file(&path, &file)?;
        if shard == Shard::WHOLE {
            for other in files_with_extension(&store, "lock")? {
                if other != path {
                    lock_file(&other, &open_lock(&other)?)?;
                }
            }
        }
        // Only for people to read.
        let _ = file.set_len(0);
        let _ = write!(file, "process {} on {host}", std::process::id());
        Ok(ShardLock {
            _file: file,
            store: named("sqlite"),
            aborted: named("aborted"),
        })
    }

    /// The stores in the order of their names.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub fn stores(&self) -> Result<Vec<PathBuf>, SweepFolderError> {
        let stores = files_with_extension(&self.path.join("store"), "sqlite")?;
        for store in &stores {
            // SQLite would wait for a pipe in the place of the journal.
            let mut journal = store.clone().into_os_string();
            journal.push("-journal");
            let journal = PathBuf::from(journal);
            atomic_file::refuse_special(&journal).map_err(io_error_at(&journal))?;
        }
        Ok(stores)
    }

    /// Gives every valid result of this sweep to `receive`, store by store; returns the damaged
    /// files with the reasons.
    ///
    /// # Errors
    /// A store cannot be read.
    pub fn read_results(
        &self,
        mut receive: impl FnMut(&Path, ResultRow),
    ) -> Result<Vec<(PathBuf, String)>, SweepFolderError> {
        let mut damaged = Vec::new();
        for path in self.stores()? {
            let reading = sqlite_results::read_rows(&path, &self.hash, self.job_count, |row| {
                receive(&path, row);
            })?;
            damaged.extend(reading.damage.map(|reason| (path, reason)));
        }
        Ok(damaged)
    }

    /// The union of all stores, with remarks on damaged files. If a job failed in one store and not
    /// in another, the result that did not fail counts.
    ///
    /// # Errors
    /// A store cannot be read, or two contradict each other.
    pub fn union(&self) -> Result<(BTreeMap<u64, ResultRow>, Vec<String>), SweepFolderError> {
        let mut union: BTreeMap<u64, (ResultRow, PathBuf)> = BTreeMap::new();
        let mut contradiction = None;
        let has_failed = |row: &ResultRow| row.status() == Some(JobStatus::Failed);
        let damaged = self.read_results(|path, row| {
            let known = union.get(&row.job);
            let replaces = match known {
                None => true,
                Some((old, _)) => has_failed(old) && !has_failed(&row),
            };
            if let Some((old, from)) = known
                && !has_failed(old)
                && !has_failed(&row)
                && *old != row
            {
                contradiction = Some(SweepFolderError::Contradiction {
                    job: row.job,
                    first: from.clone(),
                    second: path.to_owned(),
                });
            }
            if replaces {
                union.insert(row.job, (row, path.to_owned()));
            }
        })?;
        if let Some(contradiction) = contradiction {
            return Err(contradiction);
        }
        let rows = union.into_iter().map(|(job, (row, _))| (job, row));
        let remarks = damaged
            .iter()
            .map(|(path, reason)| {
                format!(
                    "{} is damaged ({reason}); only its valid rows count",
                    path.display()
                )
            })
            .collect();
        Ok((rows.collect(), remarks))
    }
}

/// Renames a file to the first free `NAME.damaged-N`, and its journal too.
pub(super) fn set_aside(path: &Path) -> io::Result<PathBuf> {
    let with_suffix = |path: &Path, suffix: &str| {
        let mut name = path.as_os_str().to_owned();
        name.push(suffix);
        PathBuf::from(name)
    };
    let named = |n: u32| with_suffix(path, &format!(".damaged-{n}"));
    let aside = (1..u32::MAX)
        .map(named)
        .find(|aside| !aside.exists())
        .unwrap_or_else(|| named(0));
    fs::rename(path, &aside)?;
    match fs::rename(
        with_suffix(path, "-journal"),
        with_suffix(&aside, "-journal"),
    ) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(aside),
    }
}

fn files_with_extension(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, SweepFolderError> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(io_error_at(folder))? {
        let path = entry.map_err(io_error_at(folder))?.path();
        if path.extension().is_some_and(|end| end == extension) && path.is_file() {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// The folders in a folder that hold a sweep, as `bankshot team` makes them.
fn sweeps_within(path: &Path) -> Vec<String> {
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    let folders = entries.map(|entry| entry.path());
    let sweeps = folders.filter(|folder| folder.join(manifest::FILE_NAME).exists());
    let mut names: Vec<String> = sweeps.map(|folder| folder.display().to_string()).collect();
    names.sort();
    names
}
