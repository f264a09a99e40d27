//! One shot in full: its events and its trajectory.

use super::outcome::{Outcome, Touched};
use super::state::{Law, State, Triple};
use super::watch::Watch;

/// A point of a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time from the release, s.
    pub time_s: f64,
    /// The nine state variables.
    pub state: State,
    /// In contact with the board.
    pub on_board: bool,
    /// In contact with the ring.
    pub on_ring: bool,
}

/// What happened at an [`Event`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EventKind {
    /// The release.
    Release,
    /// A contact begins.
    Touch(Touched),
    /// A contact is over; its whole impulse on the ball (x, y, z) in N s and how long it lasted.
    Part {
        /// The surface.
        surface: Touched,
        /// Impulse on the ball, N s (zero where the paper's integrator ran).
        impulse_n_s: Triple<f64>,
        /// Duration of the contact, s.
        lasted_s: f64,
    },
    /// The end of the shot.
    End,
}

/// Something that happened, when, and the state it happened in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// Time from the release, s.
    pub time_s: f64,
    /// What happened.
    pub kind: EventKind,
    /// The nine state variables.
    pub state: State,
}

/// One shot with its events and its trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    /// The outcome.
    pub outcome: Outcome,
    /// Release, touches, partings and the end, in order.
    pub events: Vec<Event>,
    /// The trajectory in order of time: evenly spaced in flight, every step in contact.
    pub samples: Vec<Sample>,
}

pub(crate) struct Recorder {
    mass_kg: f64,
    interval_s: f64,
    events: Vec<Event>,
    samples: Vec<Sample>,
    /// Of the contact under way with board and ring: when it began and its impulse over the mass.
    open: [Option<(f64, Triple<f64>)>; 2],
    last: (f64, State, f64),
}

fn index(surface: Touched) -> usize {
    match surface {
        Touched::Board => 0,
        Touched::Ring => 1,
    }
}

impl Recorder {
    pub(crate) fn new(mass_kg: f64, interval_s: f64, start: State) -> Self {
        let release = Event {
            time_s: 0.0,
            kind: EventKind::Release,
            state: start,
        };
        Self {
            mass_kg,
            interval_s: interval_s.max(1e-5),
            events: vec![release],
            samples: Vec::new(),
            open: [None; 2],
            last: (0.0, start, 0.0),
        }
    }

    fn sample(&mut self, time_s: f64, state: State) {
        let [board, ring] = self.open.map(|contact| contact.is_some());
        self.samples.push(Sample {
            time_s,
            state,
            on_board: board,
            on_ring: ring,
        });
    }

    pub(crate) fn trace(mut self, law: &Law, outcome: Outcome) -> Trace {
        let (time_s, state, flown) = self.last;
        let state = if flown > 0.0 {
            state.flown(law, flown)
        } else {
            state
        };
        let time_s = time_s + flown;
        self.sample(time_s, state);
        self.events.push(Event {
            time_s,
            kind: EventKind::End,
            state,
        });
        Trace {
            outcome,
            events: self.events,
            samples: self.samples,
        }
    }
}

impl Watch for Recorder {
    fn flight(&mut self, law: &Law, t: f64, dt: f64, start: &State) {
        let mut done = 0.0;
        while done < dt {
            self.sample(t + done, start.flown(law, done));
            done += self.interval_s;
        }
        self.last = (t, *start, dt);
    }

    fn touch(&mut self, t: f64, surface: Touched, state: &State) {
        self.open[index(surface)] = Some((t, Triple(0.0, 0.0, 0.0)));
        self.events.push(Event {
            time_s: t,
            kind: EventKind::Touch(surface),
            state: *state,
        });
    }

    fn step(&mut self, t: f64, dt: f64, states: (&State, &State), impulses: [Triple<f64>; 2]) {
        self.sample(t, *states.0);
        for (open, impulse) in self.open.iter_mut().zip(impulses) {
            if let Some((_, sum)) = open {
                *sum = sum.plus(impulse, 1.0);
            }
        }
        self.last = (t + dt, *states.1, 0.0);
    }

    fn part(&mut self, t: f64, surface: Touched, state: &State) {
        let (began, sum) = self.open[index(surface)]
            .take()
            .unwrap_or((t, Triple(0.0, 0.0, 0.0)));
        let Triple(x, y, z) = sum;
        let impulse_n_s = Triple(x * self.mass_kg, y * self.mass_kg, z * self.mass_kg);
        let kind = EventKind::Part {
            surface,
            impulse_n_s,
            lasted_s: t - began,
        };
        self.events.push(Event {
            time_s: t,
            kind,
            state: *state,
        });
    }
}
