//! Questions to the library, without a command line in between.

use crate::background::{Monitor, thread_pool, wait};
use crate::errors::InputError;
use bankshot::answers::requests::{Answered, Request};
use bankshot::present::shot_note_text::note_text;
use pyo3::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, mpsc};

/// The answer to a question, and what should be said beside it. An exception (Ctrl-C, or one of
/// `progress`) returns at once; the work itself ends at its next report of progress.
#[pyfunction]
#[pyo3(signature = (request, threads=None, progress=None))]
pub(crate) fn ask(
    py: Python<'_>,
    request: &Bound<'_, PyAny>,
    threads: Option<usize>,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<(Py<PyAny>, Vec<String>)> {
    let request: Request =
        pythonize::depythonize(request).map_err(|error| InputError::new_err(error.to_string()))?;
    let pool = thread_pool(threads)?;
    let monitor = Arc::new(Monitor::default());
    let (watched, (sender, results)) = (Arc::clone(&monitor), mpsc::channel());
    std::thread::Builder::new().spawn(move || {
        let work = || pool.install(|| request.answer(&*watched));
        // Nobody may wait any more.
        let _ = sender.send(catch_unwind(AssertUnwindSafe(work)));
    })?;
    let answered = wait(py, &monitor, progress.as_ref(), results)?;
    let Answered { document, notes } =
        answered.map_err(|error| InputError::new_err(error.to_string()))?;
    let answer = pythonize::pythonize(py, &document)?;
    Ok((answer.unbind(), notes.iter().map(note_text).collect()))
}
