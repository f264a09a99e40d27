//! Commands of the command line, run inside the interpreter.

use crate::background::{Monitor, wait};
use bankshot::cli::{answer_of, stop};
use bankshot::probability::Progress;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::sync::{Arc, mpsc};

/// Runs the program with the arguments of the process, and returns its exit code.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, arguments: Vec<String>) -> u8 {
    py.detach(|| bankshot::cli::main_with(arguments))
}

/// What a command said.
#[pyclass(frozen, get_all)]
pub(crate) struct Command {
    /// The exit code.
    exit_code: u8,
    /// The answer.
    answer: Py<PyBytes>,
    /// Remarks, warnings, and the error if there is one.
    remarks: String,
}

/// The progress of a command that is waited for. A command that is not is stopped.
struct Watched(Arc<Monitor>);

impl Progress for Watched {
    fn begin(&self, stage: &str, total: u64) {
        if self.0.is_stopped() {
            stop();
        }
        self.0.begin(stage, total);
    }

    fn advance(&self, units: u64) {
        self.0.advance(units);
    }

    fn end(&self) {
        self.0.end();
    }
}

#[pymethods]
impl Command {
    /// Runs a command. An exception (Ctrl-C, or one of `progress`) returns at once; the command
    /// itself ends at its next report of progress.
    #[staticmethod]
    #[pyo3(signature = (arguments, progress=None))]
    fn run(
        py: Python<'_>,
        arguments: Vec<String>,
        progress: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let monitor = Arc::new(Monitor::default());
        let watched = Arc::new(Watched(Arc::clone(&monitor)));
        let (sender, results) = mpsc::channel();
        std::thread::Builder::new().spawn(move || {
            // Nobody may wait any more.
            let _ = sender.send(Ok(answer_of(&arguments, watched)));
        })?;
        let said = wait(py, &monitor, progress.as_ref(), results)?;
        Ok(Self {
            exit_code: said.exit_code,
            answer: PyBytes::new(py, &said.answer).unbind(),
            remarks: said.remarks,
        })
    }
}

/// A TOML text with other values. A key is that of a table and one in it, such as
/// `location.distance`; `None` removes it.
#[pyfunction]
pub(crate) fn text_with(text: &str, values: Vec<(String, Option<Value>)>) -> PyResult<String> {
    let mut root: toml::Table = text
        .parse()
        .map_err(|error: toml::de::Error| PyValueError::new_err(error.to_string()))?;
    for (key, value) in values {
        let mut table = &mut root;
        let mut keys: Vec<&str> = key.split('.').collect();
        let last = keys.pop().unwrap_or_default();
        for name in keys {
            let slot = table
                .entry(name)
                .or_insert_with(|| toml::Value::Table(toml::Table::new()));
            table = slot.as_table_mut().ok_or_else(|| {
                PyValueError::new_err(format!("{key}: {name} is a value, not a table"))
            })?;
        }
        match value {
            Some(value) => table.insert(last.to_owned(), value.into()),
            None => table.remove(last),
        };
    }
    Ok(root.to_string())
}

/// A value of a key.
#[derive(FromPyObject)]
pub(crate) enum Value {
    Bool(bool),
    Integer(i64),
    Real(f64),
    Text(String),
    List(Vec<String>),
}

impl From<Value> for toml::Value {
    fn from(value: Value) -> Self {
        match value {
            Value::Bool(value) => value.into(),
            Value::Integer(value) => value.into(),
            Value::Real(value) => value.into(),
            Value::Text(value) => value.into(),
            Value::List(values) => values.into(),
        }
    }
}
