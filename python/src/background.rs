//! Runs work without the interpreter's lock, while Python's signals are handled and progress is
//! shown.

use bankshot::probability::Progress;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use std::any::Any;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// How often signals and progress are looked at.
const INTERVAL: Duration = Duration::from_millis(50);

/// What is shown of running work: stages that overlap as one.
#[derive(Debug)]
struct Stage {
    name: String,
    total: u64,
    /// Stages that have begun and not ended.
    open: u64,
}

/// What is known of running work.
#[derive(Debug, Default)]
pub(crate) struct Monitor {
    is_stopped: AtomicBool,
    done: AtomicU64,
    stage: Mutex<Option<Stage>>,
}

impl Monitor {
    pub(crate) fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }

    fn show(&self, callback: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let Some(callback) = callback else {
            return Ok(());
        };
        let stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        let Some((name, total)) = stage
            .as_ref()
            .map(|stage| (stage.name.clone(), stage.total))
        else {
            return Ok(());
        };
        drop(stage);
        callback.call1((name, self.done.load(Ordering::Relaxed), total))?;
        Ok(())
    }
}

impl Progress for Monitor {
    fn begin(&self, name: &str, total: u64) {
        let mut slot = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        match &mut *slot {
            Some(stage) if stage.open > 0 => {
                name.clone_into(&mut stage.name);
                stage.total += total;
                stage.open += 1;
            }
            _ => {
                self.done.store(0, Ordering::Relaxed);
                *slot = Some(Stage {
                    name: name.to_owned(),
                    total,
                    open: 1,
                });
            }
        }
    }

    fn advance(&self, units: u64) {
        self.done.fetch_add(units, Ordering::Relaxed);
        if self.is_stopped() {
            bankshot::cli::stop();
        }
    }

    fn end(&self) {
        let mut slot = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(stage) = &mut *slot {
            stage.open = stage.open.saturating_sub(1);
        }
    }
}

/// A result, or the payload of a panic.
pub(crate) type Caught<T> = Result<T, Box<dyn Any + Send>>;

/// Waits for the result of work in another thread. Meanwhile signals are handled, and `callback` is
/// called with the stage, the units that are done, and their total. An exception of either stops
/// the work at its next report of progress.
pub(crate) fn wait<T: Send>(
    py: Python<'_>,
    monitor: &Monitor,
    callback: Option<&Bound<'_, PyAny>>,
    results: Receiver<Caught<T>>,
) -> PyResult<T> {
    let results = Mutex::new(results);
    loop {
        let received = py.detach(|| {
            let results = results.lock().unwrap_or_else(PoisonError::into_inner);
            results.recv_timeout(INTERVAL)
        });
        match received {
            Ok(Ok(result)) => {
                monitor.show(callback)?;
                return Ok(result);
            }
            Ok(Err(_)) | Err(RecvTimeoutError::Disconnected) => {
                return Err(PyRuntimeError::new_err(
                    "this is a bug in bankshot; please report it with what you called",
                ));
            }
            Err(RecvTimeoutError::Timeout) => {
                let watched = py.check_signals().and_then(|()| monitor.show(callback));
                if let Err(exception) = watched {
                    monitor.is_stopped.store(true, Ordering::Relaxed);
                    return Err(exception);
                }
            }
        }
    }
}

/// Threads of its own for one call, so that a process that is forked afterwards has all of its own.
pub(crate) fn thread_pool(threads: Option<usize>) -> PyResult<rayon::ThreadPool> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map_err(|error| PyRuntimeError::new_err(format!("threads cannot be started: {error}")))
}
