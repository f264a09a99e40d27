//! The ball in flight and in contact: from a release to made or missed.
//!
//! [`Simulator`] is the interface. Behind it are two integrators: the default
//! [`Integrator::EventDriven`], and the paper's own method, [`Integrator::PaperRk4`]. Both use the same
//! solids and contact forces (Eqs. 2-14 of the paper).

mod batch;
mod contact;
mod end_rules;
mod flight;
mod hoop_crossing;
mod integrators;
mod observer;
mod outcome;
mod outcome_classifier;
mod release;
mod simulator;
mod trace;

pub use batch::{BatchWorkspace, InstructionSet};
pub use outcome::{ContactSequence, Ending, Entry, Outcome, OutcomeKind, Verdict};
pub use release::{Release, ReleaseDirection};
pub use simulator::{Integrator, Simulator, SimulatorError, StateError};
pub use trace::{Event, EventKind, Sample, Trace};
