//! The ball in flight and in contact: from a release to made or missed.
//!
//! [`Simulator`] is the interface. Behind it are two integrators: the default
//! [`Integrator::EventDriven`], and the paper's own method, [`Integrator::PaperRk4`]. Both use the
//! same solids, normal force and sliding friction (Eqs. 2-14 of the paper); the default adds
//! rolling.
//!
//! # Terms
//!
//! | term | meaning |
//! |---|---|
//! | `R`, `R_H` | radius of the ball; radius of the ring's circle |
//! | `u`, `N`, `mu` | compression of the ball, normal force (per unit of mass), coefficient of friction |
//! | slip, slip rate | velocity of the contact point along the surface, and its derivative |
//! | sliding | friction is `mu N`, against the slip or the slip that is about to start |
//! | rolling | friction below `mu N` keeps the slip at zero |
//! | at zero slip | rolling, or about to roll or slide |
//! | solid | the board, or the hoop (ring and bracket) |
//! | core, reach | a solid is what lies within a radius of its core (a rectangle, a circle); the reach is that radius and the ball's |
//! | a solid acts | it can exert a force on a ball at this position (the paper's board only in front of its face) |
//! | frame | coordinates along the normal of one contact and across it |
//! | contact on a solid | with the face of the board or the ring alone, in the frame of the contact |
//! | contact in the world frame | with the bracket, an edge of the board, or both solids at once |
//! | phase | one flight or one contact of a shot; a shot waits for its next phase |
//! | segment | a part of a flight for which one polynomial holds |
//! | step | one time step |
//! | batch | the shots of one call of [`Simulator::verdicts`], simulated in SIMD lanes |
//! | lane | one element of a SIMD number; it holds one shot |
//! | slot | the index of the memory of one shot in progress within a batch |
//! | block | the shots in the lanes of one step |
//!
//! The type parameter `T` is the number type: `f64` for one shot, a SIMD number for one shot a
//! lane. A constant in all lanes needs a token of the vector instructions, which every SIMD number
//! holds: so `x.zero()` is zero in the lanes of `x`. `a.select(mask, b)` is `a` where `mask` holds
//! and `b` elsewhere.

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
pub use release::{Release, ReleaseStates, ReleaseWithoutSpeed};
pub use simulator::{Integrator, Precision, Simulator, SimulatorError, StateError};
pub use trace::{Event, EventKind, Sample, Trace};
