//! The folder of a sweep: its configuration, the stores of all processes, and who works in it.
//!
//! ```text
//! configuration.json      what the sweep is, with the texts it was read from
//! store/1-of-1.HOST.sqlite    results of one process; .lock beside it while it runs
//! best_shots.csv, .parquet, provenance.json    once all jobs are there
//! ```

use super::configuration::{Configuration, Texts, parse_sweep};
use super::jobs::{Jobs, Shard};
use super::row::{Row, Status};
use super::store::{self, Store, StoreError};
use crate::output::files;
use crate::profile::ProfileError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read as _, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Differences of two configurations that are told at most.
const MOST_DIFFERENCES: usize = 20;
/// How long a lock that is held is tried again: those who only look take it for a moment.
const LOCK_PATIENCE: Duration = Duration::from_millis(300);
/// Largest configuration.json that is read, in bytes.
const LARGEST_CONFIGURATION: u64 = 256 << 20;

/// Why a sweep's folder could not be used.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// The system failed.
    #[error("{}: {error}", .path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What failed.
        error: io::Error,
    },
    /// A store failed.
    #[error(transparent)]
    Store(#[from] StoreError),
    /// It holds another sweep.
    #[error("{}: holds the results of another sweep; take another folder, or change back:\n{}", .path.display(), .differences.join("\n"))]
    Changed {
        /// The folder.
        path: PathBuf,
        /// What differs.
        differences: Vec<String>,
    },
    /// It holds no sweep, or one that cannot be read.
    #[error("{}: {reason}", .path.display())]
    NoSweep {
        /// The folder.
        path: PathBuf,
        /// Why.
        reason: String,
    },
    /// Somebody works in it.
    #[error("{}: is in use by {by}; wait for it, or stop it", .path.display())]
    InUse {
        /// The lock.
        path: PathBuf,
        /// Process and host.
        by: String,
    },
    /// Two stores hold different results of a job.
    #[error("job {job} has two different results, in {} and in {}; one of the two machines computes wrongly: set one file aside and run the sweep's command again", .first.display(), .second.display())]
    Contradiction {
        /// The job.
        job: u64,
        /// One store.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
    /// The texts in it no longer make a sweep.
    #[error(transparent)]
    Profile(#[from] ProfileError),
}

fn io_at(path: &Path) -> impl Fn(io::Error) -> FolderError {
    let path = path.to_owned();
    move |error| FolderError::Io {
        path: path.clone(),
        error,
    }
}

/// What `configuration.json` holds.
#[derive(Debug, Serialize, Deserialize)]
struct Kept {
    program: String,
    version: String,
    commit: String,
    hash: String,
    /// BLAKE3 of the hash and the texts.
    checksum: String,
    texts: Texts,
    configuration: serde_json::Value,
}

impl Kept {
    fn new(configuration: &Configuration, texts: &Texts) -> Self {
        let hash = configuration.hash();
        Self {
            program: "bankshot".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            commit: env!("BANKSHOT_COMMIT").to_owned(),
            checksum: checksum(&hash, texts),
            hash,
            texts: texts.clone(),
            configuration: serde_json::to_value(configuration).unwrap_or_default(),
        }
    }

    fn program(&self) -> String {
        format!("{} ({})", self.version, self.commit)
    }

    fn read(path: &Path) -> io::Result<Read> {
        let mut text = String::new();
        let file = match File::open(path) {
            Ok(file) => file,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Read::Nothing),
            Err(error) => return Err(error),
        };
        if let Err(error) = file.take(LARGEST_CONFIGURATION).read_to_string(&mut text)
            && error.kind() != io::ErrorKind::InvalidData
        {
            return Err(error);
        }
        let kept = serde_json::from_str::<Self>(&text).ok();
        Ok(match kept {
            Some(kept) if kept.checksum == checksum(&kept.hash, &kept.texts) => {
                Read::Sound(Box::new(kept))
            }
            _ => Read::Damaged,
        })
    }
}

/// What was found in the place of `configuration.json`.
enum Read {
    Nothing,
    Damaged,
    Sound(Box<Kept>),
}

fn checksum(hash: &str, texts: &Texts) -> String {
    let text = serde_json::to_string(&(hash, texts)).unwrap_or_default();
    blake3::hash(text.as_bytes()).to_hex().to_string()
}

/// A sweep's folder.
#[derive(Clone, Debug)]
pub struct Folder {
    path: PathBuf,
    hash: String,
    program: String,
    jobs: u64,
}

/// The right to write the store of a shard, until it is dropped or the process ends, however that is.
#[derive(Debug)]
pub struct Claim {
    /// Held while this lives.
    _lock: File,
    /// The store's path.
    pub store: PathBuf,
    /// Where an abort of the program is noted.
    pub aborted: PathBuf,
}

/// What is there of a sweep.
#[derive(Clone, Debug, Default)]
pub struct There {
    /// Jobs by number, with how they ended.
    pub jobs: BTreeMap<u64, Status>,
    /// Files that were found damaged, and what was done.
    pub damaged: Vec<String>,
}

impl There {
    /// How many jobs ended so.
    #[must_use]
    pub fn count(&self, status: Status) -> usize {
        self.jobs.values().filter(|&&found| found == status).count()
    }
}

impl Folder {
    /// The folder for a sweep, made where it is not there.
    ///
    /// # Errors
    /// When it cannot be written, or holds another sweep.
    pub fn open(
        path: &Path,
        configuration: &Configuration,
        texts: &Texts,
    ) -> Result<Self, FolderError> {
        let store = path.join("store");
        fs::create_dir_all(&store).map_err(io_at(&store))?;
        tempfile::tempfile_in(&store).map_err(io_at(&store))?;
        let file = path.join("configuration.json");
        let new = Kept::new(configuration, texts);
        let text = serde_json::to_string_pretty(&new).unwrap_or_default() + "\n";
        // Others may open the same folder at this moment: whoever comes first writes, and all read what is there.
        loop {
            match Kept::read(&file).map_err(io_at(&file))? {
                Read::Sound(old) if old.hash == new.hash => break,
                Read::Sound(old) => {
                    return Err(FolderError::Changed {
                        path: path.to_owned(),
                        differences: differences(&old, &new),
                    });
                }
                Read::Nothing => {
                    if files::write_new(&file, text.as_bytes()).map_err(io_at(&file))? {
                        break;
                    }
                }
                Read::Damaged => {
                    set_aside(&file).map_err(io_at(&file))?;
                }
            }
        }
        Ok(Self {
            path: path.to_owned(),
            program: new.program(),
            hash: new.hash,
            jobs: Jobs::new(configuration).count() as u64,
        })
    }

    /// The sweep that a folder holds.
    ///
    /// # Errors
    /// When it holds none, or one of another version of the program.
    pub fn existing(path: &Path) -> Result<(Self, Configuration), FolderError> {
        Self::read(path, false)
    }

    /// As [`Folder::existing`], for those who only look: also of another version of the program.
    ///
    /// # Errors
    /// When it holds none, or one that this version understands otherwise.
    pub fn to_look_at(path: &Path) -> Result<(Self, Configuration), FolderError> {
        Self::read(path, true)
    }

    fn read(path: &Path, any_program: bool) -> Result<(Self, Configuration), FolderError> {
        let no_sweep = |reason: &str| FolderError::NoSweep {
            path: path.to_owned(),
            reason: reason.to_owned(),
        };
        let file = path.join("configuration.json");
        let kept = match Kept::read(&file).map_err(io_at(&file))? {
            Read::Sound(kept) => kept,
            Read::Damaged => {
                return Err(no_sweep(
                    "configuration.json is damaged; run the sweep's command again, which writes it anew",
                ));
            }
            Read::Nothing => {
                return Err(no_sweep("holds no sweep (there is no configuration.json)"));
            }
        };
        let configuration = parse_sweep(&kept.texts, &file.display().to_string());
        let new = match configuration {
            Ok(configuration)
                if configuration.hash() == kept.hash
                    || any_program && means_the_same(&kept.configuration, &configuration) =>
            {
                configuration
            }
            Ok(configuration) => {
                return Err(FolderError::Changed {
                    path: path.to_owned(),
                    differences: differences(&kept, &Kept::new(&configuration, &kept.texts)),
                });
            }
            Err(error) => return Err(error.into()),
        };
        let folder = Self {
            path: path.to_owned(),
            program: kept.program(),
            hash: kept.hash,
            jobs: Jobs::new(&new).count() as u64,
        };
        Ok((folder, new))
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The program that computes it: its version and commit.
    #[must_use]
    pub fn program(&self) -> &str {
        &self.program
    }

    /// The hash of its configuration.
    #[must_use]
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// Takes the right to write a shard's store on this host.
    ///
    /// # Errors
    /// When another process has it, or works in the folder where all shards are asked for.
    pub fn claim(&self, shard: Shard) -> Result<Claim, FolderError> {
        let store = self.path.join("store");
        let host: String = gethostname::gethostname()
            .to_string_lossy()
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' })
            .take(60)
            .collect();
        let name = format!("{}-of-{}.{host}", shard.index + 1, shard.count);
        let path = store.join(format!("{name}.lock"));
        let mut file = File::options()
            .create(true)
            .truncate(false)
            .read(true)
            .write(true)
            .open(&path)
            .map_err(io_at(&path))?;
        locked(&path, &file)?;
        if shard == Shard::WHOLE {
            for other in with_ending(&store, "lock")? {
                if other != path {
                    locked(&other, &open_lock(&other)?)?;
                }
            }
        }
        // Only for people to read.
        let _ = file.set_len(0);
        let _ = write!(file, "process {} on {host}", std::process::id());
        Ok(Claim {
            _lock: file,
            store: store.join(format!("{name}.sqlite")),
            aborted: store.join(format!("{name}.aborted")),
        })
    }

    /// The stores, in the order of their names.
    ///
    /// # Errors
    /// When the folder cannot be read.
    pub fn stores(&self) -> Result<Vec<PathBuf>, FolderError> {
        with_ending(&self.path.join("store"), "sqlite")
    }

    /// Every sound result of this sweep, as it lies in the stores; the damaged files.
    ///
    /// # Errors
    /// When a store cannot be read.
    pub fn results(
        &self,
        mut give: impl FnMut(&Path, Row),
    ) -> Result<Vec<(PathBuf, String)>, FolderError> {
        let mut damaged = Vec::new();
        for path in self.stores()? {
            let reading = store::read(&path, &self.hash, self.jobs, |row| give(&path, row))?;
            damaged.extend(reading.damage.map(|reason| (path, reason)));
        }
        Ok(damaged)
    }

    /// The union of all stores: each job once, one that did not fail before one that did.
    ///
    /// # Errors
    /// When a store cannot be read, or two contradict each other.
    pub fn union(&self) -> Result<(BTreeMap<u64, Row>, Vec<String>), FolderError> {
        let mut union: BTreeMap<u64, (Row, PathBuf)> = BTreeMap::new();
        let mut contradiction = None;
        let damaged = self.results(|path, row| {
            let failed = |row: &Row| row.status() == Some(Status::Failed);
            match union.get(&row.job) {
                Some((old, _)) if failed(&row) && !failed(old) => {}
                Some((old, from)) if !failed(old) && *old != row => {
                    contradiction = Some(FolderError::Contradiction {
                        job: row.job,
                        first: from.clone(),
                        second: path.to_owned(),
                    });
                }
                Some((old, _)) if failed(old) && failed(&row) => {}
                _ => {
                    union.insert(row.job, (row, path.to_owned()));
                }
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
                    "{} is damaged ({reason}); only its sound rows count",
                    path.display()
                )
            })
            .collect();
        Ok((rows.collect(), remarks))
    }

    /// What is there, for a process with a claim: damaged stores that nobody writes are set aside, their sound
    /// rows kept in a store of their own.
    ///
    /// # Errors
    /// When a store cannot be read or written.
    pub fn take_stock(&self, claim: &Claim) -> Result<(There, Store), FolderError> {
        let mut there = There::default();
        for (path, reason) in self.results(|_, _| {})? {
            there.damaged.push(self.rescue(&path, &reason, claim)?);
        }
        let store = match Store::open(&claim.store, &self.hash) {
            Err(StoreError::Damaged { path, reason }) => {
                there.damaged.push(self.rescue(&path, &reason, claim)?);
                Store::open(&claim.store, &self.hash)?
            }
            store => store?,
        };
        self.results(|_, row| {
            if let Some(status) = row.status() {
                let found = there.jobs.entry(row.job).or_insert(status);
                if *found == Status::Failed {
                    *found = status;
                }
            }
        })?;
        Ok((there, store))
    }

    /// Sets a damaged store aside and keeps its sound rows; says what was done.
    fn rescue(&self, path: &Path, reason: &str, claim: &Claim) -> Result<String, FolderError> {
        let shown = path.display();
        // Held until the end, so that its owner cannot come back meanwhile.
        let lock = path.with_extension("lock");
        let held = if path == claim.store || !lock.exists() {
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
        store::read(path, &self.hash, self.jobs, |row| rows.push(row))?;
        if !rows.is_empty() {
            // Whole under another name before the damaged one goes: at no moment is a sound row nowhere.
            let stem = path.file_stem().unwrap_or_default().display().to_string();
            let named =
                |n: u32, ending: &str| path.with_file_name(format!("{stem}.salvaged-{n}.{ending}"));
            let free = (1..u32::MAX).find(|&n| !named(n, "sqlite").exists());
            let number = free.unwrap_or_default();
            let unfinished = named(number, "unfinished");
            let _ = fs::remove_file(&unfinished);
            let mut store = Store::open(&unfinished, &self.hash)?;
            store.keep(&rows)?;
            drop(store);
            let whole = named(number, "sqlite");
            fs::rename(&unfinished, &whole).map_err(io_at(&whole))?;
        }
        let aside = set_aside(path).map_err(io_at(path))?;
        drop(held);
        Ok(format!(
            "{shown} was damaged ({reason}) and is set aside as {}; {} sound results of it are kept, its other jobs are computed again",
            aside.display(),
            rows.len()
        ))
    }
}

/// Does another process hold this lock?
#[must_use]
pub fn is_held(lock: &Path) -> bool {
    open_lock(lock).is_ok_and(|file| matches!(file.try_lock(), Err(TryLockError::WouldBlock)))
}

/// Opens a lock for writing too: a network file system gives no exclusive lock otherwise.
fn open_lock(path: &Path) -> Result<File, FolderError> {
    File::options()
        .read(true)
        .write(true)
        .open(path)
        .map_err(io_at(path))
}

/// Locks a file, or tells who holds it.
fn locked(path: &Path, file: &File) -> Result<(), FolderError> {
    let until = Instant::now() + LOCK_PATIENCE;
    let mut lock = file.try_lock();
    while matches!(lock, Err(TryLockError::WouldBlock)) && Instant::now() < until {
        std::thread::sleep(LOCK_PATIENCE / 10);
        lock = file.try_lock();
    }
    match lock {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => {
            let by = fs::read_to_string(path).unwrap_or_default();
            let by = if by.is_empty() {
                "another process".to_owned()
            } else {
                by
            };
            Err(FolderError::InUse {
                path: path.to_owned(),
                by,
            })
        }
        // A file system without locks: they are a courtesy, the results do not depend on them.
        Err(TryLockError::Error(error)) if error.kind() == io::ErrorKind::Unsupported => Ok(()),
        Err(TryLockError::Error(error)) => Err(io_at(path)(error)),
    }
}

/// Renames a file to the first free `NAME.damaged-N`, its journal too.
fn set_aside(path: &Path) -> io::Result<PathBuf> {
    let named = |n: u32| {
        let mut name = path.as_os_str().to_owned();
        name.push(format!(".damaged-{n}"));
        PathBuf::from(name)
    };
    let aside = (1..u32::MAX)
        .map(named)
        .find(|aside| !aside.exists())
        .unwrap_or_else(|| named(0));
    fs::rename(path, &aside)?;
    let journal = |path: &Path| {
        let mut name = path.as_os_str().to_owned();
        name.push("-journal");
        PathBuf::from(name)
    };
    match fs::rename(journal(path), journal(&aside)) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(aside),
    }
}

fn with_ending(folder: &Path, ending: &str) -> Result<Vec<PathBuf>, FolderError> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(io_at(folder))? {
        let path = entry.map_err(io_at(folder))?.path();
        if path.extension().is_some_and(|end| end == ending) && path.is_file() {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Is this the same configuration, whatever program computes it?
fn means_the_same(kept: &serde_json::Value, configuration: &Configuration) -> bool {
    let mut found = Vec::new();
    let new = serde_json::to_value(configuration).unwrap_or_default();
    compare("", kept, &new, &mut found);
    found.is_empty()
}

/// The values that differ, each with its path.
fn differences(old: &Kept, new: &Kept) -> Vec<String> {
    let program = |kept: &Kept| serde_json::json!({"version": kept.version, "commit": kept.commit});
    let mut found = Vec::new();
    compare("program", &program(old), &program(new), &mut found);
    compare("", &old.configuration, &new.configuration, &mut found);
    if found.len() > MOST_DIFFERENCES {
        let more = found.len() - MOST_DIFFERENCES;
        found.truncate(MOST_DIFFERENCES);
        found.push(format!("  and {more} more"));
    }
    found
}

fn compare(path: &str, old: &serde_json::Value, new: &serde_json::Value, found: &mut Vec<String>) {
    use serde_json::Value::{Array, Object};
    let join = |key: &str| {
        if path.is_empty() {
            key.to_owned()
        } else {
            format!("{path}.{key}")
        }
    };
    match (old, new) {
        (Object(a), Object(b)) => {
            let mut keys: Vec<&String> = a.keys().chain(b.keys()).collect();
            keys.sort();
            keys.dedup();
            for key in keys {
                let nothing = serde_json::Value::Null;
                let (a, b) = (
                    a.get(key).unwrap_or(&nothing),
                    b.get(key).unwrap_or(&nothing),
                );
                compare(&join(key), a, b, found);
            }
        }
        (Array(a), Array(b)) if a.len() == b.len() => {
            for (i, (a, b)) in a.iter().zip(b).enumerate() {
                compare(&join(&i.to_string()), a, b, found);
            }
        }
        (a, b) if a != b => {
            let short = |value: &serde_json::Value| -> String {
                value.to_string().chars().take(60).collect()
            };
            found.push(format!(
                "  {path}: there {}, asked for {} (SI units)",
                short(a),
                short(b)
            ));
        }
        _ => {}
    }
}
