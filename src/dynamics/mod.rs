//! The ball in flight and in contact: from a release to made or missed.
//!
//! [`Simulator`] is the interface. Behind it are two integrators: the default
//! [`Integrator::EventDriven`], and the paper's own method, [`Integrator::PaperRk4`]. Both use the same
//! solids and contact forces (Eqs. 2-14 of the paper).
//!
//! # Terms
//!
//! | term | meaning |
//! |---|---|
//! | `R`, `R_H` | radius of the ball; radius of the ring's circle |
//! | `u`, `N`, `mu` | compression of the ball, normal force (per unit of mass), coefficient of friction |
//! | slip | velocity of the contact point along the surface |
//! | sliding, rolling | the slip is not zero; the slip is zero and stays zero |
//! | stuck | the slip is zero, whether or not it stays so |
//! | single, double contact | with one solid, with board and ring at once |
//! | segment | one flight, or one single or double contact, of a shot |
//! | step | one time step within a contact |
//! | batch | the shots of one call of [`Simulator::verdicts`] |
//! | lane | one element of a SIMD number; it holds one shot |
//! | slot | the memory of one shot in progress within a batch |
//!
//! The type parameter `T` is the number type: `f64` for one shot, a SIMD number for one shot a lane.

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
