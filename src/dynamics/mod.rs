//! The ball in flight and in contact: from a release to made or missed.
//!
//! Two integrators stand behind one interface, [`Simulator`]: the default [`Integrator::Exact`] and
//! the paper's own method, [`Integrator::Paper`]. Both use the same surfaces and the same contact
//! forces (`surface`, Eqs. 2-14 of the paper).

mod batch;
mod contact;
mod exact;
mod flight;
mod lanes;
mod outcome;
mod paper;
mod passage;
mod release;
mod room;
mod seats;
mod simulator;
mod state;
mod surface;
mod trace;
mod watch;
mod wedge;

pub use lanes::Lanes;
pub use outcome::{Contacts, Ending, Entry, Kind, Outcome, Touched, Verdict};
pub use release::{Aim, Release};
pub use room::Room;
pub use simulator::{Integrator, Simulator};
pub use state::{State, Triple};
pub use trace::{Event, EventKind, Sample, Trace};
