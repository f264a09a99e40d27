//! Computes the missing jobs of a sweep.
//!
//! As many spots as there are threads are in work at a time, in the order of the list, and all of
//! them share the threads. So the memory is that of one spot for each thread, the last spots of a
//! sweep have all threads, and no result depends on their number. A panic is the failure of its
//! job. A spot that was being computed when the program aborted is computed alone at the next
//! start, and given up if the program aborts there again.

use super::finished_jobs::Inventory;
use super::folder_error::SweepFolderError;
use super::job_list::{Jobs, Shard};
use super::result_row::{JobStatus, ResultRow};
use super::shard_lock::ShardLock;
use super::sqlite_results::{ResultStore, ResultsError};
use super::sweep_folder::SweepFolder;
use super::sweep_toml::SweepConfig;
use crate::best_shot::{self, BestShotError, NoShot};
use crate::probability::{Progress, Pulse};
use crate::search_space::PlanError;
use rayon::ThreadPool;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Aborts of the program after which a spot is given up.
const MAX_ABORTS: u32 = 2;

/// A fault to inject at a spot, for tests.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum FaultInjection {
    /// Panic at this spot.
    Panic(usize),
    /// Abort the program at this spot.
    Abort(usize),
    /// Wait at this spot while the file exists. (The program writes its process number to it when
    /// it waits.)
    Wait(usize, PathBuf),
}

/// The options of a run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// The shard.
    pub shard: Shard,
    /// Number of threads, at least one.
    pub threads: usize,
    /// Whether to compute failed jobs again.
    pub retry_failed: bool,
    /// A fault to inject, for tests.
    pub(crate) fault: Option<FaultInjection>,
}

/// The result of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RunSummary {
    /// Jobs that were done before.
    pub resumed: usize,
    /// Jobs that were computed.
    pub computed: usize,
    /// Jobs of the shard that failed, now or before.
    pub failed: usize,
}

/// Keeps the rows of a spot, which took so many seconds.
type Save<'a> = dyn Fn(usize, &[ResultRow], f64) -> Result<(), ResultsError> + Sync + 'a;

/// A run of a sweep's jobs.
#[derive(Debug)]
pub struct SweepRun<'a> {
    config: &'a SweepConfig,
    jobs: &'a Jobs,
    options: RunOptions,
    store: Mutex<ResultStore>,
    inventory: Inventory,
    /// Spots to compute alone, because the program aborted there.
    alone: Vec<usize>,
    given_up: Vec<usize>,
    /// Counts the jobs that are saved on disk.
    saved: &'a AtomicUsize,
}

impl<'a> SweepRun<'a> {
    /// Takes the inventory of the folder, and finds the spots at which the last run aborted.
    /// `saved` counts the jobs that are saved on disk.
    ///
    /// # Errors
    /// The folder cannot be read or written.
    pub fn new(
        folder: &SweepFolder,
        lock: &ShardLock,
        config: &'a SweepConfig,
        jobs: &'a Jobs,
        options: RunOptions,
        saved: &'a AtomicUsize,
    ) -> Result<Self, SweepFolderError> {
        let (inventory, mut store) = Inventory::take(folder, lock)?;
        let has_aborted = std::fs::metadata(&lock.aborted).is_ok_and(|file| file.len() > 0);
        let aborts = store.count_aborts(has_aborted)?;
        if has_aborted {
            // It is counted; the next abort is another one.
            let _ = std::fs::write(&lock.aborted, []);
        }
        let (given_up, alone): (Vec<_>, Vec<_>) = aborts
            .into_iter()
            .partition(|&(_, aborts)| aborts >= MAX_ABORTS && !options.retry_failed);
        let spots = |aborts: Vec<(usize, u32)>| aborts.into_iter().map(|(spot, _)| spot).collect();
        let run = Self {
            config,
            jobs,
            options,
            store: Mutex::new(store),
            inventory,
            alone: spots(alone),
            given_up: spots(given_up),
            saved,
        };
        saved.store(run.progress().1, Ordering::Relaxed);
        Ok(run)
    }

    /// The damaged files, and what was done with them.
    #[must_use]
    pub fn damaged(&self) -> &[String] {
        &self.inventory.damaged
    }

    /// The kinds that are missing at a spot.
    fn missing_kinds(&self, spot: usize) -> Vec<usize> {
        (0..self.jobs.kinds.len())
            .filter(|&kind| {
                let status = self.inventory.jobs.get(&self.jobs.number(spot, kind));
                let is_retried = self.options.retry_failed && status == Some(&JobStatus::Failed);
                status.is_none() || is_retried
            })
            .collect()
    }

    /// The spots of the shard.
    fn shard_spots(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.jobs.spots.len()).filter(|&spot| self.options.shard.contains(spot))
    }

    /// Jobs of the shard that had failed before.
    fn failed_before(&self) -> usize {
        let failed = self.inventory.jobs.iter().filter(|(job, status)| {
            let spot = self.jobs.spot_and_kind(**job).map(|(spot, _)| spot);
            let is_in_shard = spot.is_some_and(|spot| self.options.shard.contains(spot));
            **status == JobStatus::Failed && is_in_shard
        });
        failed.count()
    }

    /// The number of jobs of the shard, and of those that are done.
    #[must_use]
    pub fn progress(&self) -> (usize, usize) {
        let kinds = self.jobs.kinds.len();
        self.shard_spots().fold((0, 0), |(total, done), spot| {
            let missing = self.missing_kinds(spot).len();
            (total + kinds, done + kinds - missing)
        })
    }

    /// Computes what is missing.
    ///
    /// # Errors
    /// A result cannot be saved; what was saved before is safe.
    pub fn run(&self, progress: &dyn Progress) -> Result<RunSummary, ResultsError> {
        let (total, resumed) = self.progress();
        let spots = self
            .shard_spots()
            .filter(|&spot| !self.missing_kinds(spot).is_empty());
        progress.begin("sweeping", (total - resumed) as u64);
        let computed = AtomicUsize::new(0);
        let failed = AtomicUsize::new(0);
        let save = |spot: usize, rows: &[ResultRow], seconds: f64| {
            self.lock_store().finish_spot(spot, rows, seconds)?;
            let failures = rows
                .iter()
                .filter(|row| row.status() == Some(JobStatus::Failed));
            failed.fetch_add(failures.count(), Ordering::Relaxed);
            computed.fetch_add(rows.len(), Ordering::Relaxed);
            self.saved.fetch_add(rows.len(), Ordering::Relaxed);
            progress.advance(rows.len() as u64);
            Ok(())
        };
        let (given_up, others): (Vec<usize>, Vec<usize>) =
            spots.partition(|spot| self.given_up.contains(spot));
        for spot in given_up {
            let rows = self.failures(spot, "the program aborted twice while it was computed");
            save(spot, &rows, 0.0)?;
        }
        let (alone, others): (Vec<usize>, Vec<usize>) = others
            .into_iter()
            .partition(|spot| self.alone.contains(spot));
        let threads = self.options.threads.max(1);
        let pool = &shared_pool(threads)?;
        self.compute_spots(&alone, 1, pool, (&save, progress))?;
        self.compute_spots(&others, threads, pool, (&save, progress))?;
        progress.end();
        let failed_before = if self.options.retry_failed {
            0
        } else {
            self.failed_before()
        };
        Ok(RunSummary {
            resumed,
            computed: computed.into_inner(),
            failed: failed.into_inner() + failed_before,
        })
    }

    fn lock_store(&self) -> std::sync::MutexGuard<'_, ResultStore> {
        self.store
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    /// Computes several spots at once and saves each as it is finished. All of them share the
    /// threads of `pool`: at the end of a sweep the last spot has them all.
    fn compute_spots(
        &self,
        spots: &[usize],
        at_once: usize,
        pool: &ThreadPool,
        (save, progress): (&Save<'_>, &dyn Progress),
    ) -> Result<(), ResultsError> {
        let next = AtomicUsize::new(0);
        let stopped = AtomicBool::new(false);
        let first_error = Mutex::new(None);
        let fail = |error: ResultsError| {
            stopped.store(true, Ordering::Relaxed);
            if let Ok(mut first_error) = first_error.lock() {
                first_error.get_or_insert(error);
            }
        };
        let work = || {
            while !stopped.load(Ordering::Relaxed) {
                let Some(&spot) = spots.get(next.fetch_add(1, Ordering::Relaxed)) else {
                    break;
                };
                let began = Instant::now();
                let begun = self.lock_store().begin_spot(spot);
                let saved = begun.and_then(|()| {
                    let rows = pool.install(|| self.compute_spot(spot, progress));
                    save(spot, &rows, began.elapsed().as_secs_f64())
                });
                if let Err(error) = saved {
                    fail(error);
                }
            }
        };
        let ended = std::thread::scope(|scope| {
            let mut workers = Vec::new();
            for _ in 0..at_once.min(spots.len()) {
                match std::thread::Builder::new().spawn_scoped(scope, work) {
                    Ok(worker) => workers.push(worker),
                    Err(error) => fail(no_threads(&error)),
                }
            }
            // All of them, so that the payload of the first is kept.
            let ends: Vec<_> = workers.into_iter().map(|worker| worker.join()).collect();
            ends.into_iter().find_map(Result::err)
        });
        if let Some(payload) = ended {
            resume_unwind(payload);
        }
        let first_error = first_error.into_inner().unwrap_or_default();
        first_error.map_or(Ok(()), Err)
    }

    /// The rows of a spot's missing kinds.
    fn compute_spot(&self, spot: usize, progress: &dyn Progress) -> Vec<ResultRow> {
        let kinds = self.missing_kinds(spot);
        let result = catch_unwind(AssertUnwindSafe(|| {
            self.inject_fault(spot);
            compute_jobs(self.config, self.jobs, spot, &kinds, progress)
        }));
        match result {
            Ok(Ok(rows)) => rows,
            Ok(Err(reason)) => self.failures(spot, &reason),
            Err(panic) => {
                let text = panic
                    .downcast_ref::<String>()
                    .map(String::as_str)
                    .or_else(|| panic.downcast_ref::<&str>().copied());
                match text {
                    Some(text) => self.failures(spot, &format!("panicked: {text}")),
                    // No fault: the receiver of the progress ends the run.
                    None => resume_unwind(panic),
                }
            }
        }
    }

    fn inject_fault(&self, spot: usize) {
        match &self.options.fault {
            Some(FaultInjection::Panic(at)) if *at == spot => {
                panic!("fault injected at spot {at}")
            }
            Some(FaultInjection::Abort(at)) if *at == spot => std::process::abort(),
            Some(FaultInjection::Wait(at, file)) if *at == spot => {
                let _ = std::fs::write(file, std::process::id().to_string());
                while file.exists() {
                    std::thread::sleep(Duration::from_millis(5));
                }
            }
            _ => {}
        }
    }

    fn failures(&self, spot: usize, reason: &str) -> Vec<ResultRow> {
        self.missing_kinds(spot)
            .into_iter()
            .map(|kind| {
                let job = self.jobs.number(spot, kind);
                ResultRow::failed(job, self.jobs.kinds[kind], &self.jobs.spots[spot], reason)
            })
            .collect()
    }
}

/// The threads that all spots of a run share.
fn shared_pool(threads: usize) -> Result<ThreadPool, ResultsError> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| no_threads(&error))
}

fn no_threads(error: &dyn std::fmt::Display) -> ResultsError {
    ResultsError::Io {
        path: "threads".into(),
        reason: format!("cannot be started: {error}"),
    }
}

/// Computes all kinds at some of the spots, as a run would, until `budget` is spent; returns the
/// mean time in which all threads together compute a spot, s, and the number of computed spots.
/// `None` if there is none.
#[must_use]
pub fn mean_spot_time_s(
    config: &SweepConfig,
    jobs: &Jobs,
    spots: &[usize],
    threads: usize,
    budget: Duration,
    progress: &dyn Progress,
) -> Option<(f64, usize)> {
    let kinds: Vec<usize> = (0..jobs.kinds.len()).collect();
    let pool = shared_pool(threads).ok()?;
    let (next, computed) = (AtomicUsize::new(0), AtomicUsize::new(0));
    progress.begin("calibrating", spots.len() as u64);
    let began = Instant::now();
    std::thread::scope(|scope| {
        for _ in 0..threads.min(spots.len()) {
            scope.spawn(|| {
                while let Some(&spot) = spots.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let rows = pool.install(|| compute_jobs(config, jobs, spot, &kinds, progress));
                    computed.fetch_add(usize::from(rows.is_ok()), Ordering::Relaxed);
                    progress.advance(1);
                    if began.elapsed() > budget {
                        break;
                    }
                }
            });
        }
    });
    progress.end();
    let computed = computed.into_inner();
    let mean_s = began.elapsed().as_secs_f64() / computed as f64;
    (computed > 0).then_some((mean_s, computed))
}

/// Computes some of the kinds at a spot, given by their indices in [`Jobs::kinds`].
///
/// # Errors
/// Why the spot cannot be computed.
pub fn compute_jobs(
    config: &SweepConfig,
    jobs: &Jobs,
    spot: usize,
    kinds: &[usize],
    progress: &dyn Progress,
) -> Result<Vec<ResultRow>, String> {
    let court_spot = &jobs.spots[spot];
    let profile = config
        .settings
        .at(court_spot.location())
        .map_err(|error| error.to_string())?;
    let wanted: Vec<_> = kinds.iter().map(|&kind| jobs.kinds[kind]).collect();
    let topics = config.compute.topics();
    let shots = match best_shot::find_kinds(&profile, &wanted, topics, &Pulse(progress)) {
        Ok((_, shots)) => shots,
        // Nothing can go in from there, which is a result.
        Err(BestShotError::Plan(PlanError::OutOfReach { .. })) => wanted
            .iter()
            .map(|&kind| Err(NoShot::Impossible(kind)))
            .collect(),
        Err(error) => return Err(error.to_string()),
    };
    Ok(kinds
        .iter()
        .zip(&shots)
        .map(|(&kind, shot)| {
            let job = jobs.number(spot, kind);
            ResultRow::of_result(job, jobs.kinds[kind], court_spot, &profile, shot)
        })
        .collect())
}
