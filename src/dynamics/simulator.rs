//! The interface to the dynamics: physics, integrator and releases in, outcomes out.

use super::batch::{self, BatchWorkspace, InstructionSet};
use super::contact::oscillator::Oscillator;
use super::end_rules::ShotLimits;
use super::flight::{
    FlightEvents, UndisturbedFlight, falls_through, height_at_length_m, next_segment,
};
use super::integrators::event_driven;
use super::integrators::paper_rk4::{self, StepRange};
use super::observer::Observer;
use super::outcome::{Outcome, Verdict};
use super::outcome_classifier::OutcomeClassifier;
use super::release::Release;
use super::trace::{Recorder, Trace};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::{BallState, Physics, PhysicsError, SolidId};
use rayon::prelude::*;
use serde::Serialize;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// How the equations of motion are integrated.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Integrator {
    /// Closed-form flight, and contacts in steps that end on the events of friction.
    EventDriven {
        /// Steps in half an undamped period of the contact, 1 or more. More is finer; the default
        /// is 4.
        steps_per_contact: u32,
        /// The numbers in contacts with one solid. Flights are always in double precision.
        precision: Precision,
    },
    /// The paper's variable-step RK4 with friction by the sliding law alone.
    PaperRk4 {
        /// Longest step, s (the paper's is 0.015).
        dt_max_s: f64,
        /// Shortest step, used in contact, s (the paper's is 0.0005).
        dt_min_s: f64,
    },
}

impl Integrator {
    /// The default integrator with its default step.
    pub const EVENT_DRIVEN: Self = Self::event_driven(4);
    /// The paper's method with the paper's steps.
    pub const PAPER_RK4: Self = Self::PaperRk4 {
        dt_max_s: 0.015,
        dt_min_s: 0.0005,
    };

    /// The default integrator with another number of steps.
    #[must_use]
    pub const fn event_driven(steps_per_contact: u32) -> Self {
        Self::EventDriven {
            steps_per_contact,
            precision: Precision::Automatic,
        }
    }

    /// Whether contacts are computed in single precision.
    fn is_single_precision(self, physics: &Physics) -> bool {
        match self {
            Self::EventDriven {
                steps_per_contact,
                precision: Precision::Automatic,
            } => steps_per_contact <= MAX_SINGLE_STEPS && suits_single_precision(physics),
            _ => false,
        }
    }

    /// # Errors
    /// Zero steps per contact, a shortest step below 1e-9 s, a longest step below the shortest, or
    /// a step that is not finite: shots would never end.
    pub(crate) fn check(self) -> Result<(), SimulatorError> {
        let refuse = |key, value, allowed| {
            Err(SimulatorError::Integrator {
                key,
                value,
                allowed,
            })
        };
        match self {
            Self::EventDriven {
                steps_per_contact: 0,
                ..
            } => refuse("steps_per_contact", 0.0, "1 or more"),
            Self::EventDriven { .. } => Ok(()),
            Self::PaperRk4 { dt_max_s, dt_min_s } => {
                if !(dt_min_s >= 1e-9 && dt_min_s.is_finite()) {
                    refuse("dt_min", dt_min_s, "1e-9 s or more, and finite")
                } else if !(dt_max_s >= dt_min_s && dt_max_s.is_finite()) {
                    refuse("dt_max", dt_max_s, "finite, and not less than dt_min")
                } else {
                    Ok(())
                }
            }
        }
    }
}

/// The floating-point precision of contacts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Precision {
    /// Single precision where that gives the same shares of made shots: for at most 16 steps per
    /// contact and a ball like one in play. Double precision elsewhere.
    #[serde(rename = "auto")]
    Automatic,
    /// Double precision.
    #[serde(rename = "f64")]
    Double,
}

/// More steps than this are taken for accuracy, so they are in double precision.
const MAX_SINGLE_STEPS: u32 = 16;

/// Whether rounding to single precision stays below the error of the steps: for a ball and a ring
/// of about the size of those in play, bounces of 1 to 100 ms with a restitution of 0.2 to 0.99,
/// and a gravity of 0.1 to 100 m/s^2.
fn suits_single_precision(physics: &Physics) -> bool {
    (0.05..=0.5).contains(&physics.ball_radius_m)
        && (0.1..=1.0).contains(&physics.ring_radius_m)
        && SolidId::ALL.into_iter().all(|solid| {
            (0.001..=0.1).contains(&physics.contact_time_on_s(solid))
                && (0.2..=0.99).contains(&physics.restitution_on(solid))
        })
        && (0.1..=100.0).contains(&physics.gravity_m_s2)
}

/// Ratio of the steps on the face of the board to the steps per contact. (Its frame does not turn:
/// three steps there err less than four on the ring.)
const FACE_STEP_FACTOR: f64 = 0.75;
/// Ratio of the steps with both solids to the steps per contact. (Two solids together are stiffer.)
const BOTH_SOLIDS_STEP_FACTOR: f64 = 1.5;

/// Steps in contact after which a shot is given up. A swirl of three seconds takes about 1,000 at
/// the default steps (four a contact of some 13 ms); constants far from those of any ball can
/// cause endless steps. This limit takes at most 30 ms.
fn max_steps(integrator: Integrator) -> u32 {
    const STEPS: u32 = 10_000;
    const AT_STEPS_PER_CONTACT: u32 = 4;
    match integrator {
        Integrator::EventDriven {
            steps_per_contact, ..
        } => {
            let factor = steps_per_contact.div_ceil(AT_STEPS_PER_CONTACT).max(1);
            STEPS.saturating_mul(factor)
        }
        Integrator::PaperRk4 { .. } => u32::MAX,
    }
}

impl Default for Integrator {
    fn default() -> Self {
        Self::EVENT_DRIVEN
    }
}

/// Why a simulator cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimulatorError {
    /// A physical constant is out of range.
    #[error(transparent)]
    Physics(#[from] PhysicsError),
    /// A setting of the integrator is out of range.
    #[error("physics.{key} is {value}; it must be {allowed}")]
    Integrator {
        /// The key of the setting in the `[physics]` table.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The allowed values.
        allowed: &'static str,
    },
}

/// A release whose state is not finite: it has a NaN or infinite value.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("release {index} has a value that is not finite: {state:?}")]
pub struct StateError {
    /// Position among the releases; 0 for a single shot.
    pub index: usize,
    /// The state at the release.
    pub state: BallState,
}

fn check_finite(index: usize, state: BallState) -> Result<BallState, StateError> {
    if state.is_finite() {
        Ok(state)
    } else {
        Err(StateError { index, state })
    }
}

/// Simulates shots under one physics with one integrator.
///
/// ```
/// use bankshot::dynamics::{OutcomeKind, Release, Simulator};
/// use bankshot::model::Physics;
/// use bankshot::units::FOOT_M;
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
/// let outcome = simulator.simulate(&release)?;
/// assert!(outcome.verdict.made);
/// assert_eq!(outcome.kind, OutcomeKind::Swish);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Simulator {
    physics: Physics,
    integrator: Integrator,
    pub(super) params: ModelParams,
    pub(super) limits: ShotLimits,
    instructions: InstructionSet,
    /// Shots that this simulator and those that count with it have simulated.
    simulated: Arc<AtomicU64>,
}

impl Simulator {
    /// A simulator with the default integrator.
    ///
    /// # Errors
    /// The first constant of `physics` that cannot be simulated.
    pub fn new(physics: &Physics) -> Result<Self, SimulatorError> {
        Self::with_integrator(physics, Integrator::EVENT_DRIVEN)
    }

    /// A simulator with the given integrator.
    ///
    /// # Errors
    /// The first constant of `physics` that cannot be simulated, or steps of the integrator with
    /// which shots would never end.
    pub fn with_integrator(
        physics: &Physics,
        integrator: Integrator,
    ) -> Result<Self, SimulatorError> {
        if let Some(error) = physics.errors().into_iter().next() {
            return Err(error.into());
        }
        integrator.check()?;
        let steps = match integrator {
            Integrator::EventDriven {
                steps_per_contact, ..
            } => f64::from(steps_per_contact),
            Integrator::PaperRk4 { .. } => 1.0,
        };
        let params = ModelParams::new(physics);
        Ok(Self {
            physics: physics.clone(),
            integrator,
            params,
            limits: ShotLimits {
                longest_world_steps_s: [1.0, BOTH_SOLIDS_STEP_FACTOR]
                    .map(|factor| physics.contact_time_s() / (steps * factor)),
                single_precision: integrator.is_single_precision(physics),
                oscillators: [
                    Oscillator::new(&params.board.material, steps * FACE_STEP_FACTOR),
                    Oscillator::new(&params.board.material, steps),
                    Oscillator::new(&params.ring.material, steps),
                ],
                time_limit_s: physics.time_limit_s,
                lodged_after_s: physics.lodged_after_s,
                max_steps: max_steps(integrator),
            },
            instructions: InstructionSet::default(),
            simulated: Arc::default(),
        })
    }

    /// Shots that were simulated so far, with those of copies and of simulators that count with
    /// this one, but without traces.
    #[must_use]
    pub fn simulated_shots(&self) -> u64 {
        self.simulated.load(Ordering::Relaxed)
    }

    /// The same simulator, its shots counted with those of another.
    #[must_use]
    pub fn counting_with(self, other: &Self) -> Self {
        Self {
            simulated: Arc::clone(&other.simulated),
            ..self
        }
    }

    /// The same simulator, its shots counted apart.
    pub(crate) fn counting_apart(self) -> Self {
        Self {
            simulated: Arc::default(),
            ..self
        }
    }

    fn count(&self, shots: usize) {
        self.simulated.fetch_add(shots as u64, Ordering::Relaxed);
    }

    /// The same simulator with other vector instructions for [`Simulator::verdicts`] (by default,
    /// the widest of the machine). No result depends on them.
    #[must_use]
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.instructions = instructions;
        self
    }

    /// The physics.
    #[must_use]
    pub fn physics(&self) -> &Physics {
        &self.physics
    }

    /// The integrator.
    #[must_use]
    pub fn integrator(&self) -> Integrator {
        self.integrator
    }

    /// The state of a ball that flies for `seconds` and touches nothing; negative for the past. The
    /// values must be finite.
    #[must_use]
    pub fn undisturbed_state(&self, start: &BallState, seconds: f64) -> BallState {
        UndisturbedFlight::new(&self.params, start).state_after(seconds)
    }

    /// Undisturbed states at many times, in their order: the flight is computed once.
    pub fn undisturbed_states(
        &self,
        start: &BallState,
        seconds: impl IntoIterator<Item = f64>,
    ) -> impl Iterator<Item = BallState> {
        let mut flight = UndisturbedFlight::new(&self.params, start);
        seconds.into_iter().map(move |t| flight.state_after(t))
    }

    /// The state in which a ball that touches nothing falls through the height of the hoop, and the
    /// time until then, s. `None` if it does not rise so high. The values must be finite.
    #[must_use]
    pub fn undisturbed_fall_to_hoop(&self, start: &BallState) -> Option<(BallState, f64)> {
        falls_through(&self.params, start, 0.0)
    }

    /// The outcome of one shot.
    ///
    /// # Errors
    /// The release has a NaN or infinite value.
    pub fn simulate(&self, release: &Release) -> Result<Outcome, StateError> {
        self.simulate_state(release.state())
    }

    /// The outcome of one shot from its nine state variables.
    ///
    /// # Errors
    /// The state has a NaN or infinite value.
    pub fn simulate_state(&self, start: BallState) -> Result<Outcome, StateError> {
        Ok(self.outcome(check_finite(0, start)?))
    }

    /// The outcomes of many shots, in parallel on the current rayon pool. They are in the order of
    /// the releases, and do not depend on the number of threads.
    ///
    /// # Errors
    /// The first release with a NaN or infinite value.
    pub fn simulate_batch(&self, releases: &[Release]) -> Result<Vec<Outcome>, StateError> {
        releases
            .par_iter()
            .enumerate()
            .map(|(index, release)| {
                let start = check_finite(index, release.state())?;
                Ok(self.outcome(start))
            })
            .collect::<Vec<Result<_, _>>>()
            .into_iter()
            .collect()
    }

    /// The verdicts of many shots from their nine state variables, on the current thread. This is
    /// the fast form, in SIMD lanes; each verdict equals that of [`Simulator::simulate_state`] bit
    /// for bit. Give it many shots at once: twenty thousand run a tenth slower than two hundred
    /// thousand, because the last shots of a call leave lanes empty. The workspace takes a third of
    /// a megabyte, and 48 bytes for each verdict.
    ///
    /// # Errors
    /// The first state with a NaN or infinite value.
    pub fn verdicts<'w>(
        &self,
        starts: &[BallState],
        workspace: &'w mut BatchWorkspace,
    ) -> Result<&'w [Verdict], StateError> {
        for (index, start) in starts.iter().enumerate() {
            check_finite(index, *start)?;
        }
        Ok(self.finite_verdicts(starts, workspace))
    }

    /// One shot with its events and its trajectory: a sample every `interval_s` (at least 1e-5 s)
    /// in flight, and at least every millisecond in contact.
    ///
    /// # Errors
    /// The release has a NaN or infinite value.
    pub fn trace(&self, release: &Release, interval_s: f64) -> Result<Trace, StateError> {
        self.trace_state(release.state(), interval_s)
    }

    /// Traces a shot from the nine state variables.
    ///
    /// # Errors
    /// The state has a NaN or infinite value.
    pub fn trace_state(&self, start: BallState, interval_s: f64) -> Result<Trace, StateError> {
        check_finite(0, start)?;
        let mut observer = (
            OutcomeClassifier::new(self.params.ring.radius, &start),
            Recorder::new(self.physics.ball_mass_kg, interval_s, start),
        );
        let verdict = self.run(start, &mut observer);
        let (classifier, recorder) = observer;
        Ok(recorder.into_trace(classifier.outcome(verdict)))
    }

    /// What the ball touches first in flight; `None` if nothing, or if it comes beside the board
    /// first.
    #[must_use]
    pub fn first_touch(&self, release: &Release) -> Option<SolidId> {
        let mut state = release.state();
        if self.params.has_paper_flight() {
            return FlightEvents::new(&self.params, &state).first_touch();
        }
        loop {
            let segment = next_segment(&self.params, &state);
            if segment.ends() {
                let touches = |solid: &SolidId| segment.touches[solid.index()];
                return SolidId::ALL.into_iter().find(touches);
            }
            state = segment.end;
        }
    }

    /// Where an undisturbed shot falls through the plane of the hoop: its horizontal distance from
    /// the release, m; `None` if it stays below that plane.
    pub(crate) fn length_to_hoop_plane_m(&self, release: &Release) -> Option<f64> {
        let start = release.state();
        let (state, _) = falls_through(&self.params, &start, 0.0)?;
        let moved = state.position_m - start.position_m;
        Some((moved.x * moved.x + moved.y * moved.y).sqrt())
    }

    /// Height of an undisturbed shot above the hoop at the horizontal distance `length_m` from the
    /// release, m; minus infinity if it falls before.
    pub(crate) fn height_at_length_m(&self, release: &Release, length_m: f64) -> f64 {
        height_at_length_m(&self.params, &release.state(), length_m)
    }

    /// Speed of the undisturbed shot that passes the height `z_m` at the horizontal distance
    /// `length_m`, m/s, in the direction and with the spin of `release`; `None` if there is none.
    pub(crate) fn speed_through_m_s(
        &self,
        release: &Release,
        length_m: f64,
        z_m: f64,
    ) -> Option<f64> {
        const MAX_STEPS: u32 = 60;
        const TOLERANCE_M: f64 = 1e-9;
        let (sin, cos) = libm::sincos(release.pitch_rad);
        let over = release.height_above_hoop_m - z_m + length_m * sin / cos;
        if !(over > 0.0 && cos > 1e-6) {
            return None;
        }
        let mut speed = length_m / cos * (0.5 * self.params.ball.gravity / over).sqrt();
        if !self.params.ball.has_air {
            return Some(speed);
        }
        // Secants, after a step of Newton's with the derivative of the parabola.
        let mut before: Option<(f64, f64)> = None;
        for _ in 0..MAX_STEPS {
            let start = Release {
                speed_m_s: speed,
                ..*release
            };
            let height = height_at_length_m(&self.params, &start.state(), length_m);
            if !height.is_finite() {
                (speed, before) = (1.1 * speed, None);
                continue;
            }
            let miss = z_m - height;
            if miss.abs() < TOLERANCE_M {
                return Some(speed);
            }
            let fallen = release.height_above_hoop_m + length_m * sin / cos - height;
            let by_parabola = 0.5 * miss * speed / fallen.max(1e-3);
            let by_secant =
                before.map(|(old_speed, old_miss)| (speed - old_speed) / (old_miss - miss) * miss);
            // A faster shot passes higher: both steps have the sign of the miss, or the secant is
            // worth nothing.
            let step = match by_secant {
                Some(step) if step * miss > 0.0 => step,
                _ => by_parabola,
            };
            before = Some((speed, miss));
            speed += step.clamp(-0.2 * speed, 0.2 * speed);
        }
        None
    }

    /// As [`Simulator::simulate_state`], for a state that is known to be finite.
    pub(crate) fn outcome(&self, start: BallState) -> Outcome {
        self.count(1);
        let mut classifier = OutcomeClassifier::new(self.params.ring.radius, &start);
        let verdict = self.run(start, &mut classifier);
        classifier.outcome(verdict)
    }

    /// The verdict of one shot whose state is known to be finite.
    pub(crate) fn verdict(&self, start: BallState) -> Verdict {
        self.count(1);
        self.run(start, &mut ())
    }

    /// As [`Simulator::verdicts`], for states that are known to be finite.
    pub(crate) fn finite_verdicts<'w>(
        &self,
        starts: &[BallState],
        workspace: &'w mut BatchWorkspace,
    ) -> &'w [Verdict] {
        self.count(starts.len());
        match (self.integrator, self.instructions.level()) {
            (Integrator::EventDriven { .. }, Some(level)) => {
                batch::run(level, &self.params, &self.limits, starts, workspace);
            }
            _ => {
                workspace.verdicts.clear();
                workspace
                    .verdicts
                    .extend(starts.iter().map(|start| self.run(*start, &mut ())));
            }
        }
        &workspace.verdicts
    }

    fn run<O: Observer>(&self, start: BallState, observer: &mut O) -> Verdict {
        match self.integrator {
            Integrator::EventDriven { .. } => {
                event_driven::run(&self.params, &self.limits, start, observer)
            }
            Integrator::PaperRk4 { dt_max_s, dt_min_s } => {
                let steps = StepRange { dt_max_s, dt_min_s };
                paper_rk4::run(&self.params, &self.limits, steps, start, observer)
            }
        }
    }
}
