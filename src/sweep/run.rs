//! Computes the jobs of a sweep that are not yet there.
//!
//! Each thread takes place after place, in the order of the list, and works on it alone: so memory is that of one
//! place for each thread, and a result cannot depend on how many there are. A panic is the failure of its
//! job. A place that was being computed when the program aborted is computed alone at the next start, and
//! given up when the program aborts there again.

use super::configuration::Configuration;
use super::folder::{Claim, Folder, FolderError, There};
use super::jobs::{Jobs, Shard};
use super::row::{Row, Status};
use super::store::{Store, StoreError};
use crate::probability::best;
use crate::probability::{Progress, Silent};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// Aborts of the program after which a place is given up.
const MOST_ABORTS: u32 = 2;

/// What to do to certain places, for tests of what is promised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Panic at this place.
    Panic(usize),
    /// Abort the program at this place.
    Abort(usize),
}

/// A run of a sweep's jobs.
#[derive(Debug)]
pub struct Run<'a> {
    configuration: &'a Configuration,
    jobs: &'a Jobs,
    shard: Shard,
    threads: usize,
    fault: Option<Fault>,
    retry: bool,
    store: Mutex<Store>,
    there: There,
    alone: Vec<usize>,
    given_up: Vec<usize>,
    done: &'a AtomicUsize,
}

/// How a run went on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Went {
    /// Jobs that were already there.
    pub resumed: usize,
    /// Jobs that were computed.
    pub computed: usize,
    /// Jobs of the shard that failed, now or before.
    pub failed: usize,
}

/// How a run is done.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Which part.
    pub shard: Shard,
    /// Threads, at least one.
    pub threads: usize,
    /// Compute the failed jobs again?
    pub retry: bool,
    /// A fault, for tests.
    pub fault: Option<Fault>,
}

impl<'a> Run<'a> {
    /// Finds out what is there, and what the last run died of. `done` counts the jobs that are safe on disk.
    ///
    /// # Errors
    /// When the folder cannot be read or written.
    pub fn new(
        folder: &Folder,
        claim: &Claim,
        configuration: &'a Configuration,
        jobs: &'a Jobs,
        options: Options,
        done: &'a AtomicUsize,
    ) -> Result<Self, FolderError> {
        let (there, mut store) = folder.take_stock(claim)?;
        let aborted = std::fs::metadata(&claim.aborted).is_ok_and(|about| about.len() > 0);
        let suspects = store.suspects(aborted)?;
        if aborted {
            // Counted; the next abort is another one.
            let _ = std::fs::write(&claim.aborted, []);
        }
        let (given_up, alone): (Vec<_>, Vec<_>) = suspects
            .into_iter()
            .partition(|&(_, aborts)| aborts >= MOST_ABORTS && !options.retry);
        let places = |suspects: Vec<(usize, u32)>| suspects.into_iter().map(|(place, _)| place);
        let run = Self {
            configuration,
            jobs,
            shard: options.shard,
            threads: options.threads.max(1),
            fault: options.fault,
            retry: options.retry,
            store: Mutex::new(store),
            there,
            alone: places(alone).collect(),
            given_up: places(given_up).collect(),
            done,
        };
        done.store(run.of_shard(|kinds| kinds.is_empty()).1, Ordering::Relaxed);
        Ok(run)
    }

    /// Damaged files that were found.
    #[must_use]
    pub fn damaged(&self) -> &[String] {
        &self.there.damaged
    }

    /// The kinds that are missing at a place.
    fn missing(&self, place: usize) -> Vec<usize> {
        (0..self.jobs.kinds.len())
            .filter(|&kind| {
                let status = self.there.jobs.get(&self.jobs.number(place, kind));
                status.is_none() || (self.retry && status == Some(&Status::Failed))
            })
            .collect()
    }

    /// The shard's places whose missing kinds are so, and how many of their jobs are there.
    fn of_shard(&self, holds: impl Fn(&[usize]) -> bool) -> (Vec<usize>, usize) {
        let mut places = Vec::new();
        let mut there = 0;
        for place in (0..self.jobs.places.len()).filter(|&place| self.shard.has(place)) {
            let missing = self.missing(place);
            there += self.jobs.kinds.len() - missing.len();
            if holds(&missing) {
                places.push(place);
            }
        }
        (places, there)
    }

    /// Jobs of the shard that were there and had failed.
    fn failed_before(&self) -> usize {
        let failed = self.there.jobs.iter().filter(|(job, status)| {
            let place = self.jobs.of(**job).map(|(place, _)| place);
            **status == Status::Failed && place.is_some_and(|place| self.shard.has(place))
        });
        failed.count()
    }

    /// Jobs of the shard in all, and those that are there.
    #[must_use]
    pub fn extent(&self) -> (usize, usize) {
        let (places, there) = self.of_shard(|_| true);
        (places.len() * self.jobs.kinds.len(), there)
    }

    /// Computes what is missing.
    ///
    /// # Errors
    /// When a result cannot be kept; what was kept before is safe.
    pub fn go(&self, progress: &dyn Progress) -> Result<Went, StoreError> {
        let (total, resumed) = self.extent();
        let (places, _) = self.of_shard(|missing| !missing.is_empty());
        progress.begin("sweeping", (total - resumed) as u64);
        let computed = AtomicUsize::new(0);
        let failed = AtomicUsize::new(0);
        let keep = |place: usize, rows: &[Row], seconds: f64| {
            let kept = self.lock().finish(place, rows, seconds);
            if kept.is_ok() {
                let bad = rows
                    .iter()
                    .filter(|row| row.status() == Some(Status::Failed));
                failed.fetch_add(bad.count(), Ordering::Relaxed);
                computed.fetch_add(rows.len(), Ordering::Relaxed);
                self.done.fetch_add(rows.len(), Ordering::Relaxed);
                progress.advance(rows.len() as u64);
            }
            kept
        };
        let (given_up, rest): (Vec<usize>, Vec<usize>) = places
            .into_iter()
            .partition(|place| self.given_up.contains(place));
        for place in given_up {
            let rows = self.failures(place, "the program aborted twice while it was computed");
            keep(place, &rows, 0.0)?;
        }
        let (alone, rest): (Vec<usize>, Vec<usize>) = rest
            .into_iter()
            .partition(|place| self.alone.contains(place));
        self.work(&alone, 1, &keep)?;
        self.work(&rest, self.threads, &keep)?;
        progress.end();
        let before = self.failed_before();
        Ok(Went {
            resumed,
            computed: computed.into_inner(),
            failed: failed.into_inner() + if self.retry { 0 } else { before },
        })
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Store> {
        self.store
            .lock()
            .unwrap_or_else(|poisoned| poisoned.into_inner())
    }

    fn work(
        &self,
        places: &[usize],
        threads: usize,
        keep: &(dyn Fn(usize, &[Row], f64) -> Result<(), StoreError> + Sync),
    ) -> Result<(), StoreError> {
        let next = AtomicUsize::new(0);
        let stopped = AtomicBool::new(false);
        let error = Mutex::new(None);
        let fail = |problem: StoreError| {
            stopped.store(true, Ordering::Relaxed);
            if let Ok(mut error) = error.lock() {
                error.get_or_insert(problem);
            }
        };
        let no_threads = |problem: &dyn std::fmt::Display| StoreError::Io {
            path: "threads".into(),
            reason: format!("cannot be started: {problem}"),
        };
        std::thread::scope(|scope| {
            for _ in 0..threads.min(places.len()) {
                let work = || {
                    // The place is computed on this thread alone.
                    let pool = match rayon::ThreadPoolBuilder::new().num_threads(1).build() {
                        Ok(pool) => pool,
                        Err(problem) => return fail(no_threads(&problem)),
                    };
                    while !stopped.load(Ordering::Relaxed) {
                        let Some(&place) = places.get(next.fetch_add(1, Ordering::Relaxed)) else {
                            break;
                        };
                        let began = Instant::now();
                        let started = self.lock().start(place);
                        let kept = started.and_then(|()| {
                            let rows = pool.install(|| self.compute(place));
                            keep(place, &rows, began.elapsed().as_secs_f64())
                        });
                        if let Err(problem) = kept {
                            fail(problem);
                        }
                    }
                };
                if let Err(problem) = std::thread::Builder::new().spawn_scoped(scope, work) {
                    fail(no_threads(&problem));
                }
            }
        });
        let error = error.into_inner().unwrap_or_default();
        error.map_or(Ok(()), Err)
    }

    /// The rows of a place's missing kinds.
    fn compute(&self, place: usize) -> Vec<Row> {
        let kinds = self.missing(place);
        let result = catch_unwind(AssertUnwindSafe(|| {
            match self.fault {
                Some(Fault::Panic(at)) if at == place => panic!("as asked for, at place {at}"),
                Some(Fault::Abort(at)) if at == place => std::process::abort(),
                _ => {}
            }
            evaluate(self.configuration, self.jobs, place, &kinds)
        }));
        match result {
            Ok(Ok(rows)) => rows,
            Ok(Err(reason)) => self.failures(place, &reason),
            Err(panic) => {
                let text = panic
                    .downcast_ref::<String>()
                    .map(String::as_str)
                    .or_else(|| panic.downcast_ref::<&str>().copied())
                    .unwrap_or("without a message");
                self.failures(place, &format!("panicked: {text}"))
            }
        }
    }

    fn failures(&self, place: usize, reason: &str) -> Vec<Row> {
        let spot = &self.jobs.places[place];
        self.missing(place)
            .into_iter()
            .map(|kind| {
                let job = self.jobs.number(place, kind);
                Row::failed(job, self.jobs.kinds[kind], spot, reason)
            })
            .collect()
    }
}

/// Computes all kinds at some places, as a run would, and gives the mean time of a place on its thread, s;
/// none where nothing could be computed.
#[must_use]
pub fn calibrate(
    configuration: &Configuration,
    jobs: &Jobs,
    places: &[usize],
    threads: usize,
    progress: &dyn Progress,
) -> Option<f64> {
    let kinds: Vec<usize> = (0..jobs.kinds.len()).collect();
    let next = AtomicUsize::new(0);
    let seconds = Mutex::new(Vec::new());
    progress.begin("calibrating", places.len() as u64);
    std::thread::scope(|scope| {
        for _ in 0..threads.min(places.len()) {
            scope.spawn(|| {
                let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(1).build() else {
                    return;
                };
                while let Some(&place) = places.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let began = Instant::now();
                    let rows = pool.install(|| evaluate(configuration, jobs, place, &kinds));
                    if rows.is_ok()
                        && let Ok(mut seconds) = seconds.lock()
                    {
                        seconds.push(began.elapsed().as_secs_f64());
                    }
                    progress.advance(1);
                }
            });
        }
    });
    progress.end();
    let seconds = seconds.into_inner().unwrap_or_default();
    let mean = seconds.iter().sum::<f64>() / seconds.len() as f64;
    (!seconds.is_empty()).then_some(mean)
}

/// Computes some of the kinds (by their places in the list of jobs) at a place.
///
/// # Errors
/// Why the place cannot be computed.
pub fn evaluate(
    configuration: &Configuration,
    jobs: &Jobs,
    place: usize,
    kinds: &[usize],
) -> Result<Vec<Row>, String> {
    let spot = &jobs.places[place];
    let profile = configuration
        .template
        .at(spot.place())
        .map_err(|error| error.to_string())?;
    let wanted: Vec<_> = kinds.iter().map(|&kind| jobs.kinds[kind]).collect();
    let topics = configuration.compute.topics();
    let found = match best::find_kinds(&profile, &wanted, topics, &Silent) {
        Ok((_, found)) => found,
        // From there nothing goes in, which is an answer.
        Err(best::BestError::Plan(crate::plan::PlanError::OutOfReach)) => wanted
            .iter()
            .map(|&kind| Err(best::NoShot { kind }))
            .collect(),
        Err(error) => return Err(error.to_string()),
    };
    Ok(kinds
        .iter()
        .zip(&found)
        .map(|(&kind, shot)| {
            let job = jobs.number(place, kind);
            Row::found(job, jobs.kinds[kind], spot, &profile, shot)
        })
        .collect())
}
