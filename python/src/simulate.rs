//! Many shots at once, from columns of releases to columns of outcomes.

use crate::background::{Monitor, thread_pool, wait};
use crate::columns::{Rows, Source};
use crate::errors::InputError;
use bankshot::config::parse_physics;
use bankshot::dynamics::{
    BatchWorkspace, Integrator, OutcomeKind, Release, ReleaseStates, Simulator,
};
use bankshot::model::{BallState, Physics, Preset, SolidId};
use bankshot::present::simulation_files::release_columns::{ReleaseColumns, release_of_values};
use bankshot::probability::Progress;
use bankshot::units::DEGREE_RAD;
use numpy::{PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pyo3_arrow::PyTable;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, PoisonError, mpsc};

/// Shots that one thread takes at a time: enough to keep the lanes full.
const SHOTS_AT_A_TIME: usize = 65_536;
/// The same with all that is known of each shot, which are computed one by one.
const DETAILED_AT_A_TIME: usize = 4096;
/// Rows that a message names.
const MOST_NAMED: usize = 5;

/// The names of the kinds of outcomes, by their codes.
pub(crate) fn outcome_kinds() -> Vec<&'static str> {
    OutcomeKind::ALL.iter().map(|kind| kind.name()).collect()
}

fn simulator(physics: &str, integrator: Option<&str>) -> PyResult<Simulator> {
    let preset = Preset::named(physics);
    let (physics, own): (Physics, Integrator) = match preset {
        Some(preset) => (preset.physics(), Integrator::default()),
        None => parse_physics(physics, "physics").map_err(|error| {
            let message = error.to_string();
            let message = message.strip_prefix("error: ").unwrap_or(&message);
            InputError::new_err(message.to_owned())
        })?,
    };
    let integrator = match integrator {
        None => own,
        Some("exact") => Integrator::EVENT_DRIVEN,
        Some("paper") => Integrator::PAPER_RK4,
        Some(other) => {
            return Err(InputError::new_err(format!(
                "integrator: \"{other}\" must be \"exact\" or \"paper\""
            )));
        }
    };
    Simulator::with_integrator(&physics, integrator)
        .map_err(|error| InputError::new_err(error.to_string()))
}

/// Where the releases are: nine arrays, or a table.
#[derive(FromPyObject)]
pub(crate) enum Given<'py> {
    Arrays(Vec<Option<PyReadonlyArray1<'py, f64>>>),
    Table(PyTable),
}

/// Simulates releases. `names` are those of all columns, `carry` those that are no parameters
/// though they are named so; `releases` are the arrays of the parameters, in the order that
/// `parameters` returns, or an Arrow table.
#[pyfunction]
#[pyo3(signature = (names, carry, releases, physics, integrator, details, threads, progress))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    names: Vec<String>,
    carry: Vec<String>,
    releases: Option<Given<'py>>,
    physics: &str,
    integrator: Option<&str>,
    details: bool,
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let header = names.iter().map(String::as_str).collect::<Vec<_>>().into();
    let columns = ReleaseColumns::new(&header, &carry)
        .map_err(|error| InputError::new_err(error.to_string()))?;
    let parameters = columns.of_parameters();
    let indices: Vec<Option<usize>> = parameters
        .iter()
        .map(|parameter| parameter.map(|(index, ..)| index))
        .collect();
    // The caller asks first which columns are needed.
    let source = match releases {
        None => return Ok(indices.into_pyobject(py)?.into_any()),
        Some(Given::Arrays(arrays)) => Source::Arrays(arrays),
        Some(Given::Table(table)) => Source::Batches(table.into_inner().0, indices),
    };
    let simulator = simulator(physics, integrator)?;
    let rows = source.rows()?;
    let count = rows.iter().map(|rows| rows.count).sum();
    let outcomes = Outcomes::new(py, count, details);
    let pool = thread_pool(threads)?;
    let monitor = Monitor::default();
    let work = Work {
        simulator: &simulator,
        parameters: &parameters,
        monitor: &monitor,
        faults: Mutex::default(),
    };
    let mut slices = outcomes.slices()?;
    let at_a_time = if details {
        DETAILED_AT_A_TIME
    } else {
        SHOTS_AT_A_TIME
    };
    // A few pieces for each thread, or one thread has the last of them alone.
    let fair = count.div_ceil(4 * pool.current_num_threads()).max(1024);
    let blocks = slices.blocks(&rows, at_a_time.min(fair));
    monitor.begin("simulating", count as u64);
    let (sender, results) = mpsc::channel();
    std::thread::scope(|scope| {
        let (work, pool) = (&work, &pool);
        scope.spawn(move || {
            let done = catch_unwind(AssertUnwindSafe(|| {
                pool.install(|| work.run(blocks));
            }));
            let _ = sender.send(done);
        });
        wait(py, &monitor, progress.as_ref(), results)
    })?;
    work.refuse_faults()?;
    drop(slices);
    Ok(outcomes.into_dict(py)?.into_any())
}

/// The arrays of the outcomes.
struct Outcomes<'py> {
    made: Bound<'py, PyArray1<bool>>,
    n_board: Bound<'py, PyArray1<i32>>,
    n_ring: Bound<'py, PyArray1<i32>>,
    flight_time_s: Bound<'py, PyArray1<f64>>,
    details: Option<Details<'py>>,
}

struct Details<'py> {
    kind: Bound<'py, PyArray1<i8>>,
    entry_angle_deg: Bound<'py, PyArray1<f64>>,
    first_touch_s: Bound<'py, PyArray1<f64>>,
}

/// Their memory.
struct Slices<'a> {
    made: numpy::PyReadwriteArray1<'a, bool>,
    n_board: numpy::PyReadwriteArray1<'a, i32>,
    n_ring: numpy::PyReadwriteArray1<'a, i32>,
    flight_time_s: numpy::PyReadwriteArray1<'a, f64>,
    details: Option<(
        numpy::PyReadwriteArray1<'a, i8>,
        numpy::PyReadwriteArray1<'a, f64>,
        numpy::PyReadwriteArray1<'a, f64>,
    )>,
}

/// Rows that one thread simulates, and where their outcomes go.
struct Block<'a> {
    rows: &'a Rows<'a>,
    /// Index of the first in `rows`.
    first: usize,
    made: &'a mut [bool],
    n_board: &'a mut [i32],
    n_ring: &'a mut [i32],
    flight_time_s: &'a mut [f64],
    details: Option<(&'a mut [i8], &'a mut [f64], &'a mut [f64])>,
}

impl<'py> Outcomes<'py> {
    fn new(py: Python<'py>, count: usize, details: bool) -> Self {
        Self {
            made: PyArray1::zeros(py, count, false),
            n_board: PyArray1::zeros(py, count, false),
            n_ring: PyArray1::zeros(py, count, false),
            flight_time_s: PyArray1::zeros(py, count, false),
            details: details.then(|| Details {
                kind: PyArray1::zeros(py, count, false),
                entry_angle_deg: PyArray1::zeros(py, count, false),
                first_touch_s: PyArray1::zeros(py, count, false),
            }),
        }
    }

    fn slices(&self) -> PyResult<Slices<'py>> {
        Ok(Slices {
            made: self.made.try_readwrite()?,
            n_board: self.n_board.try_readwrite()?,
            n_ring: self.n_ring.try_readwrite()?,
            flight_time_s: self.flight_time_s.try_readwrite()?,
            details: match &self.details {
                Some(details) => Some((
                    details.kind.try_readwrite()?,
                    details.entry_angle_deg.try_readwrite()?,
                    details.first_touch_s.try_readwrite()?,
                )),
                None => None,
            },
        })
    }

    fn into_dict(self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("made", self.made)?;
        if let Some(details) = &self.details {
            dict.set_item("kind", &details.kind)?;
        }
        dict.set_item("n_board", self.n_board)?;
        dict.set_item("n_ring", self.n_ring)?;
        dict.set_item("flight_time_s", self.flight_time_s)?;
        if let Some(details) = self.details {
            dict.set_item("entry_angle_deg", details.entry_angle_deg)?;
            dict.set_item("first_touch_s", details.first_touch_s)?;
        }
        Ok(dict)
    }
}

/// Cuts the first `n` elements off a slice.
fn cut<'a, T>(slice: &mut &'a mut [T], n: usize) -> &'a mut [T] {
    let (head, tail) = std::mem::take(slice).split_at_mut(n);
    *slice = tail;
    head
}

impl<'py> Slices<'py> {
    fn blocks<'a>(&'a mut self, rows: &'a [Rows<'a>], at_a_time: usize) -> Vec<Block<'a>> {
        // New arrays are contiguous.
        let mut made = self.made.as_slice_mut().unwrap_or_default();
        let mut n_board = self.n_board.as_slice_mut().unwrap_or_default();
        let mut n_ring = self.n_ring.as_slice_mut().unwrap_or_default();
        let mut time = self.flight_time_s.as_slice_mut().unwrap_or_default();
        let mut details = self.details.as_mut().map(|(kind, entry, touch)| {
            (
                kind.as_slice_mut().unwrap_or_default(),
                entry.as_slice_mut().unwrap_or_default(),
                touch.as_slice_mut().unwrap_or_default(),
            )
        });
        let mut blocks = Vec::new();
        for rows in rows {
            for first in (0..rows.count).step_by(at_a_time) {
                let n = at_a_time.min(rows.count - first);
                blocks.push(Block {
                    rows,
                    first,
                    made: cut(&mut made, n),
                    n_board: cut(&mut n_board, n),
                    n_ring: cut(&mut n_ring, n),
                    flight_time_s: cut(&mut time, n),
                    details: details
                        .as_mut()
                        .map(|(kind, entry, touch)| (cut(kind, n), cut(entry, n), cut(touch, n))),
                });
            }
        }
        blocks
    }
}

/// What all threads share.
struct Work<'a> {
    simulator: &'a Simulator,
    parameters: &'a [Option<(usize, &'static str, f64)>; 9],
    monitor: &'a Monitor,
    /// The first faulty rows, and the number of all of them.
    faults: Mutex<(BTreeMap<usize, String>, usize)>,
}

impl Work<'_> {
    fn run(&self, blocks: Vec<Block<'_>>) {
        blocks.into_par_iter().for_each_init(
            || (Vec::new(), BatchWorkspace::default()),
            |(states, workspace), mut block| {
                // The caller throws the outcomes away.
                if self.monitor.is_stopped() {
                    return;
                }
                match block.details {
                    None => self.verdicts(&mut block, states, workspace),
                    Some(_) => self.outcomes(&mut block),
                }
                self.monitor.advance(block.made.len() as u64);
            },
        );
    }

    /// The release of a row; `None` if it is faulty, which is noted.
    fn release(&self, rows: &Rows<'_>, row: usize) -> Option<Release> {
        let mut values = [0.0; 9];
        for (i, (value, parameter)) in values.iter_mut().zip(self.parameters).enumerate() {
            let Some((_, name, unit)) = *parameter else {
                continue;
            };
            let given = rows.value(i, row);
            if !(given.abs() < 1e9) {
                self.note(
                    rows.start + row,
                    name,
                    &format!("{given} is not a finite number"),
                );
                return None;
            }
            *value = given * unit;
        }
        match release_of_values(values, self.simulator.physics()) {
            Ok(release) => Some(release),
            Err((i, reason)) => {
                let name = self.parameters[i].map_or("", |(_, name, _)| name);
                self.note(rows.start + row, name, reason);
                None
            }
        }
    }

    fn note(&self, row: usize, column: &str, reason: &str) {
        let mut faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
        faults.1 += 1;
        faults
            .0
            .insert(row, format!("row {row}: column {column}: {reason}"));
        if faults.0.len() > MOST_NAMED {
            faults.0.pop_last();
        }
    }

    fn verdicts(
        &self,
        block: &mut Block<'_>,
        states: &mut Vec<BallState>,
        workspace: &mut BatchWorkspace,
    ) {
        states.clear();
        let mut in_turn = ReleaseStates::default();
        for row in 0..block.made.len() {
            // The other rows are still checked, to name them.
            if let Some(release) = self.release(block.rows, block.first + row) {
                states.push(in_turn.next_state(&release));
            }
        }
        if states.len() < block.made.len() {
            return;
        }
        let Ok(verdicts) = self.simulator.verdicts(states, workspace) else {
            return;
        };
        for (row, verdict) in verdicts.iter().enumerate() {
            block.made[row] = verdict.made;
            block.n_board[row] = verdict.contacts.count_of(SolidId::Board) as i32;
            block.n_ring[row] = verdict.contacts.count_of(SolidId::Ring) as i32;
            block.flight_time_s[row] = verdict.time_s;
        }
    }

    fn outcomes(&self, block: &mut Block<'_>) {
        for row in 0..block.made.len() {
            let Some(release) = self.release(block.rows, block.first + row) else {
                continue;
            };
            let Ok(outcome) = self.simulator.simulate(&release) else {
                return;
            };
            let verdict = &outcome.verdict;
            block.made[row] = verdict.made;
            block.n_board[row] = verdict.contacts.count_of(SolidId::Board) as i32;
            block.n_ring[row] = verdict.contacts.count_of(SolidId::Ring) as i32;
            block.flight_time_s[row] = verdict.time_s;
            if let Some((kind, entry, touch)) = &mut block.details {
                let code = OutcomeKind::ALL.iter().position(|k| *k == outcome.kind);
                kind[row] = code.map_or(-1, |code| code as i8);
                entry[row] = outcome
                    .entry
                    .map_or(f64::NAN, |entry| entry.angle_rad / DEGREE_RAD);
                touch[row] = outcome.first_touch_s.unwrap_or(f64::NAN);
            }
        }
    }

    fn refuse_faults(&self) -> PyResult<()> {
        let faults = self.faults.lock().unwrap_or_else(PoisonError::into_inner);
        let (first, count) = &*faults;
        if *count == 0 {
            return Ok(());
        }
        let mut message = first.values().cloned().collect::<Vec<_>>().join("\n");
        if *count > first.len() {
            message += &format!("\n... and {} more", count - first.len());
        }
        Err(InputError::new_err(message))
    }
}
