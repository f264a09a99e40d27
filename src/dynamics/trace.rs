//! One shot in full: its events and its trajectory.

use super::flight::FlightPath;
use super::observer::{Impulses, Observer};
use super::outcome::Outcome;
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::{BallState, SolidId};

/// A point of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time from the release, s.
    pub time_s: f64,
    /// The nine state variables.
    pub state: BallState,
    /// Whether the ball is in contact with each solid, in the order of [`SolidId::ALL`].
    pub in_contact: [bool; SolidId::COUNT],
}

impl Sample {
    /// Whether the ball is in contact with a solid.
    #[must_use]
    pub fn touches(&self, solid: SolidId) -> bool {
        self.in_contact[solid.index()]
    }
}

/// The kind of an [`Event`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// The release.
    Release,
    /// A contact begins.
    Touch(SolidId),
    /// A contact ends.
    Part {
        /// What the ball touched.
        solid: SolidId,
        /// Total impulse on the ball, N s (zero under the paper's integrator).
        impulse_n_s: Vec3<f64>,
        /// Duration of the contact, s.
        duration_s: f64,
    },
    /// The end of the shot.
    End,
}

/// An event of a shot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Time from the release, s.
    pub time_s: f64,
    /// Its kind.
    pub kind: EventKind,
    /// The nine state variables.
    pub state: BallState,
}

/// The events and the trajectory of one shot.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// The outcome.
    pub outcome: Outcome,
    /// Release, touches, ends of contacts, and the end, in order.
    pub events: Vec<Event>,
    /// The trajectory in order of time: evenly spaced in flight, and at least every millisecond in
    /// contact.
    pub samples: Vec<Sample>,
}

/// Records the events and the trajectory of a shot.
pub(crate) struct Recorder {
    mass_kg: f64,
    interval_s: f64,
    /// When the next sample of a flight is due, s.
    next_sample_s: f64,
    events: Vec<Event>,
    samples: Vec<Sample>,
    /// For each solid, the contact in progress.
    open: [Option<OpenContact>; SolidId::COUNT],
    /// The last known state and its time.
    last: (f64, BallState),
}

/// Longest time between two samples in contact, s.
const CONTACT_INTERVAL_S: f64 = 1e-3;

/// The state at a fraction of a step: the cubic Hermite interpolant between both ends. The spin
/// changes linearly.
fn within_step((from, to): (&BallState, &BallState), dt: f64, fraction: f64) -> BallState {
    let (v_0, v_1) = (from.velocity_m_s, to.velocity_m_s);
    let mean = (to.position_m - from.position_m) / dt.max(f64::MIN_POSITIVE);
    let curve = mean * 3.0 - v_0 * 2.0 - v_1;
    let cubic = v_0 + v_1 - mean * 2.0;
    BallState {
        position_m: from.position_m
            + (v_0 + (curve + cubic * fraction) * fraction) * (fraction * dt),
        velocity_m_s: v_0 + (curve * 2.0 + cubic * (3.0 * fraction)) * fraction,
        spin_rad_s: from.spin_rad_s + (to.spin_rad_s - from.spin_rad_s) * fraction,
    }
}

/// A contact in progress.
#[derive(Clone, Copy)]
struct OpenContact {
    began_s: f64,
    /// Impulse per unit of mass so far, m/s.
    impulse: Vec3<f64>,
}

impl Recorder {
    pub(crate) fn new(mass_kg: f64, interval_s: f64, start: BallState) -> Self {
        let release = Event {
            time_s: 0.0,
            kind: EventKind::Release,
            state: start,
        };
        Self {
            mass_kg,
            interval_s: interval_s.max(1e-5),
            next_sample_s: 0.0,
            events: vec![release],
            samples: Vec::new(),
            open: [None; SolidId::COUNT],
            last: (0.0, start),
        }
    }

    fn sample(&mut self, time_s: f64, state: BallState) {
        self.samples.push(Sample {
            time_s,
            state,
            in_contact: self.open.map(|contact| contact.is_some()),
        });
    }

    fn event(&mut self, time_s: f64, kind: EventKind, state: BallState) {
        self.events.push(Event {
            time_s,
            kind,
            state,
        });
    }

    pub(crate) fn into_trace(mut self, outcome: Outcome) -> Trace {
        let (time_s, state) = self.last;
        self.sample(time_s, state);
        self.event(time_s, EventKind::End, state);
        Trace {
            outcome,
            events: self.events,
            samples: self.samples,
        }
    }
}

impl Observer for Recorder {
    fn flight(&mut self, _params: &ModelParams, t: f64, dt: f64, path: &FlightPath) {
        // A flight in several parts is sampled evenly as a whole.
        let mut done = (self.next_sample_s - t).max(0.0);
        while done < dt {
            self.sample(t + done, path.state_after(done));
            done += self.interval_s;
        }
        self.next_sample_s = t + done;
        self.last = (t + dt, path.state_after(dt));
    }

    fn touch(&mut self, t: f64, solid: SolidId, state: &BallState) {
        self.open[solid.index()] = Some(OpenContact {
            began_s: t,
            impulse: Vec3::zeros(),
        });
        self.event(t, EventKind::Touch(solid), *state);
    }

    fn step(&mut self, t: f64, dt: f64, states: (&BallState, &BallState), impulses: Impulses) {
        let samples = (dt / CONTACT_INTERVAL_S).ceil().max(1.0);
        let mut sample = 0.0;
        while sample < samples {
            let fraction = sample / samples;
            self.sample(t + fraction * dt, within_step(states, dt, fraction));
            sample += 1.0;
        }
        for (contact, impulse) in self.open.iter_mut().zip(impulses) {
            if let Some(contact) = contact {
                contact.impulse = contact.impulse + impulse;
            }
        }
        self.last = (t + dt, *states.1);
        self.next_sample_s = t + dt;
    }

    fn separation(&mut self, t: f64, solid: SolidId, state: &BallState) {
        let unopened = OpenContact {
            began_s: t,
            impulse: Vec3::zeros(),
        };
        let contact = self.open[solid.index()].take().unwrap_or(unopened);
        let kind = EventKind::Part {
            solid,
            impulse_n_s: contact.impulse * self.mass_kg,
            duration_s: t - contact.began_s,
        };
        self.event(t, kind, *state);
    }
}
