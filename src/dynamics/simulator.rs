//! The interface to the dynamics: physics and integrator in, outcomes out.

use super::batch;
use super::exact::{self, Rules};
use super::flight::Arc;
use super::lanes::Lanes;
use super::outcome::{Outcome, Touched, Verdict};
use super::paper::{self, Steps};
use super::release::Release;
use super::room::Room;
use super::state::{Law, State};
use super::trace::{Recorder, Trace};
use super::watch::{Summary, Watch};
use crate::physics::{Physics, PhysicsError};
use serde::Serialize;

/// How the equations of motion are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Closed-form flight, contacts in RK4 steps that end on the events of friction.
    Exact {
        /// RK4 steps per head-on contact time; more is finer. The default is 8.
        steps_per_contact: u32,
    },
    /// The paper's variable-step RK4 with friction by the sliding law alone.
    Paper {
        /// Longest step, s (the paper's is 0.015).
        dt_max_s: f64,
        /// Shortest step, used in contact, s (the paper's is 0.0005).
        dt_min_s: f64,
    },
}

impl Integrator {
    /// The default integrator at its default step.
    pub const EXACT: Self = Self::Exact {
        steps_per_contact: 8,
    };
    /// The paper's method at the paper's steps.
    pub const PAPER: Self = Self::Paper {
        dt_max_s: 0.015,
        dt_min_s: 0.0005,
    };
}

impl Default for Integrator {
    fn default() -> Self {
        Self::EXACT
    }
}

/// Simulates shots under one physics with one integrator.
///
/// ```
/// use bankshot::dynamics::{Kind, Release, Simulator};
/// use bankshot::physics::{FOOT_M, Physics};
///
/// let simulator = Simulator::new(&Physics::paper())?;
/// let release = Release {
///     distance_m: 13.75 * FOOT_M,
///     court_angle_rad: 0.0,
///     height_above_hoop_m: -3.0 * FOOT_M,
///     speed_m_s: 23.55 * FOOT_M,
///     pitch_rad: 52.0_f64.to_radians(),
///     polar_rad: 0.0,
///     backspin_rad_s: 0.0,
///     rifle_spin_rad_s: 0.0,
///     side_spin_rad_s: 0.0,
/// };
/// let outcome = simulator.shoot(&release);
/// assert!(outcome.verdict.made);
/// assert_eq!(outcome.kind, Kind::Swish);
/// # Ok::<(), bankshot::physics::PhysicsError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Simulator {
    law: Law,
    rules: Rules,
    integrator: Integrator,
    ball_mass_kg: f64,
    lanes: Lanes,
}

impl Simulator {
    /// The same simulator with its batches on other vector instructions (by default the best the
    /// machine has); no result depends on it.
    #[must_use]
    pub fn with_lanes(mut self, lanes: Lanes) -> Self {
        self.lanes = lanes;
        self
    }

    /// The verdicts of many shots, from their states at the release: the fast form of
    /// [`Simulator::verdict_from`], equal to it bit for bit. The more shots a call, the better
    /// the lanes are filled to its end: twenty thousand lose a tenth of the speed of two hundred thousand. The
    /// room takes a third of a megabyte, and 32 bytes for each verdict.
    pub fn verdicts<'r>(&self, starts: &[State], room: &'r mut Room) -> &'r [Verdict] {
        match (self.integrator, self.lanes.0) {
            (Integrator::Exact { .. }, Some(level)) => {
                fearless_simd::dispatch!(level, simd => {
                    batch::run(simd, &self.law, &self.rules, starts, room)
                });
            }
            _ => {
                room.verdicts.clear();
                room.verdicts
                    .extend(starts.iter().map(|start| self.verdict_from(*start)));
            }
        }
        &room.verdicts
    }

    /// A simulator with the default integrator.
    ///
    /// # Errors
    /// The first fault of `physics`.
    pub fn new(physics: &Physics) -> Result<Self, PhysicsError> {
        Self::with_integrator(physics, Integrator::EXACT)
    }

    /// A simulator with the given integrator.
    ///
    /// # Errors
    /// The first fault of `physics`.
    pub fn with_integrator(
        physics: &Physics,
        integrator: Integrator,
    ) -> Result<Self, PhysicsError> {
        if let Some(fault) = physics.faults().into_iter().next() {
            return Err(fault);
        }
        let steps = match integrator {
            Integrator::Exact { steps_per_contact } => f64::from(steps_per_contact.max(1)),
            Integrator::Paper { .. } => 1.0,
        };
        Ok(Self {
            law: Law::new(physics),
            rules: Rules {
                longest_step_s: physics.contact_time_s() / steps,
                time_limit_s: physics.time_limit_s,
                lodged_after_s: physics.lodged_after_s,
            },
            integrator,
            ball_mass_kg: physics.ball_mass_kg,
            lanes: Lanes::best(),
        })
    }

    /// Made or missed, how it ended and what was touched: the fast answer.
    #[must_use]
    pub fn verdict(&self, release: &Release) -> Verdict {
        self.run(release.state(), &mut ())
    }

    /// As [`Simulator::verdict`], from the nine state variables.
    #[must_use]
    pub fn verdict_from(&self, start: State) -> Verdict {
        self.run(start, &mut ())
    }

    /// The whole outcome: with the kind, the entry and the apex.
    #[must_use]
    pub fn shoot(&self, release: &Release) -> Outcome {
        let start = release.state();
        let mut summary = Summary::new(self.law.ring_radius, &start);
        let verdict = self.run(start, &mut summary);
        summary.outcome(verdict)
    }

    /// The whole outcome with its events and the trajectory, `interval_s` apart in flight and every
    /// step in contact.
    #[must_use]
    pub fn trace(&self, release: &Release, interval_s: f64) -> Trace {
        self.trace_from(release.state(), interval_s)
    }

    /// As [`Simulator::trace`], from the nine state variables.
    #[must_use]
    pub fn trace_from(&self, start: State, interval_s: f64) -> Trace {
        let mut watch = (
            Summary::new(self.law.ring_radius, &start),
            Recorder::new(self.ball_mass_kg, interval_s, start),
        );
        let verdict = self.run(start, &mut watch);
        watch.1.trace(&self.law, watch.0.outcome(verdict))
    }

    /// What an error-free flight touches first, if anything.
    #[must_use]
    pub fn first_touch(&self, release: &Release) -> Option<Touched> {
        let arc = Arc::from(&self.law, &release.state());
        let until = arc.end.min(arc.beside_board);
        if arc.ring <= until && arc.ring < arc.board {
            Some(Touched::Ring)
        } else if arc.board < until {
            Some(Touched::Board)
        } else {
            None
        }
    }

    fn run<W: Watch>(&self, start: State, watch: &mut W) -> Verdict {
        match self.integrator {
            Integrator::Exact { .. } => exact::run(&self.law, &self.rules, start, watch),
            Integrator::Paper { dt_max_s, dt_min_s } => {
                let steps = Steps { dt_max_s, dt_min_s };
                paper::run(&self.law, &self.rules, steps, start, watch)
            }
        }
    }
}
