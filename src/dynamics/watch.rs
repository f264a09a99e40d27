//! Observers of a running shot.
//!
//! The integrators tell a [`Watch`] what happens; the silent one `()` costs nothing, so the loop
//! that feeds the probability and the one that draws a trajectory are the same code.

use super::outcome::{Ending, Entry, Kind, Outcome, Touched, Verdict};
use super::state::{Law, State, Triple};

/// Told of each stretch of a shot, in order.
pub(crate) trait Watch {
    /// Free flight for `dt` from `start` at time `t`.
    fn flight(&mut self, _law: &Law, _t: f64, _dt: f64, _start: &State) {}
    /// A contact begins.
    fn touch(&mut self, _t: f64, _surface: Touched, _state: &State) {}
    /// A step in contact; impulses of board and ring are per unit of mass.
    fn step(&mut self, _t: f64, _dt: f64, _states: (&State, &State), _impulses: [Triple<f64>; 2]) {}
    /// A contact is over.
    fn part(&mut self, _t: f64, _surface: Touched, _state: &State) {}
}

impl Watch for () {}

impl<A: Watch, B: Watch> Watch for (A, B) {
    fn flight(&mut self, law: &Law, t: f64, dt: f64, start: &State) {
        self.0.flight(law, t, dt, start);
        self.1.flight(law, t, dt, start);
    }
    fn touch(&mut self, t: f64, surface: Touched, state: &State) {
        self.0.touch(t, surface, state);
        self.1.touch(t, surface, state);
    }
    fn step(&mut self, t: f64, dt: f64, states: (&State, &State), impulses: [Triple<f64>; 2]) {
        self.0.step(t, dt, states, impulses);
        self.1.step(t, dt, states, impulses);
    }
    fn part(&mut self, t: f64, surface: Touched, state: &State) {
        self.0.part(t, surface, state);
        self.1.part(t, surface, state);
    }
}

/// Gathers what an [`Outcome`] has beyond the [`Verdict`].
pub(crate) struct Summary {
    ring_radius_m: f64,
    /// Unit vector of the court from the place to the hoop.
    ahead: (f64, f64),
    first: Option<Touched>,
    entry: Option<Entry>,
    apex_m: f64,
    was_inside: bool,
    board_point_m: Option<(f64, f64, f64)>,
    /// Where the undisturbed path (after the board, for a bank shot) meets the plane of the hoop.
    aim_m: Option<(f64, f64)>,
    after_board: bool,
}

impl Summary {
    pub(crate) fn new(ring_radius_m: f64, start: &State) -> Self {
        let Triple(x, y, z) = start.position_m;
        let distance = (x * x + y * y).sqrt();
        let ahead = if distance > 0.0 {
            (-x / distance, -y / distance)
        } else {
            (-1.0, 0.0)
        };
        Self {
            ring_radius_m,
            ahead,
            first: None,
            entry: None,
            apex_m: z,
            was_inside: false,
            board_point_m: None,
            aim_m: None,
            after_board: false,
        }
    }

    fn falls_through_hoop(&mut self, place: (f64, f64), velocity: Triple<f64>) {
        let level = (velocity.0 * velocity.0 + velocity.1 * velocity.1).sqrt();
        self.entry = Some(Entry {
            angle_rad: libm::atan2(-velocity.2, level),
            offset_m: place,
        });
        self.was_inside |= (place.0 * place.0 + place.1 * place.1).sqrt() < self.ring_radius_m;
    }

    /// Where the undisturbed path, or a bank shot's path off the board, meets the plane of the hoop:
    /// beyond its centre, and aside of it to the right, facing the hoop or the board.
    fn beyond_and_aside(&self) -> (f64, f64) {
        let (x, y) = self.aim_m.unwrap_or((0.0, 0.0));
        match self.first {
            Some(Touched::Board) => (x, y),
            _ => (
                x * self.ahead.0 + y * self.ahead.1,
                x * self.ahead.1 - y * self.ahead.0,
            ),
        }
    }

    fn miss(&self, verdict: &Verdict) -> Kind {
        if verdict.ending == Ending::BehindBoard {
            return Kind::OverBoard;
        }
        if self.was_inside {
            return Kind::InAndOut;
        }
        if self.first.is_none() {
            return Kind::Airball;
        }
        let (beyond, aside) = self.beyond_and_aside();
        if aside.abs() > beyond.abs() {
            Kind::Wide
        } else if beyond > 0.0 {
            Kind::Long
        } else {
            Kind::Short
        }
    }

    pub(crate) fn outcome(&self, verdict: Verdict) -> Outcome {
        let kind = match verdict.ending {
            Ending::Unresolved => Kind::Unresolved,
            Ending::Wedged | Ending::TimeLimit => Kind::Lodged,
            _ if verdict.made => Kind::of_made(&verdict.contacts),
            _ => self.miss(&verdict),
        };
        Outcome {
            verdict,
            kind,
            entry: self.entry,
            apex_m: self.apex_m,
            board_point_m: self.board_point_m,
            aside_m: self.beyond_and_aside().1,
        }
    }
}

impl Watch for Summary {
    fn flight(&mut self, law: &Law, _t: f64, dt: f64, start: &State) {
        let Triple(x, y, z) = start.position_m;
        let Triple(vx, vy, vz) = start.velocity_m_s;
        let top = vz / law.gravity;
        if top > 0.0 && top < dt {
            self.apex_m = self.apex_m.max(z + 0.5 * vz * top);
        }
        let end = start.flown(law, dt);
        self.apex_m = self.apex_m.max(end.position_m.2);
        let square = vz * vz + 2.0 * law.gravity * z;
        if square >= 0.0 {
            let t = (vz + square.sqrt()) / law.gravity;
            let place = (x + vx * t, y + vy * t);
            let starts = self.aim_m.is_none() && self.first.is_none();
            if starts || self.after_board {
                self.aim_m = Some(place);
            }
            if t > 0.0 && t <= dt {
                self.falls_through_hoop(place, Triple(vx, vy, vz - law.gravity * t));
            }
        }
        self.after_board = false;
    }

    fn touch(&mut self, _t: f64, surface: Touched, state: &State) {
        if surface == Touched::Board && self.board_point_m.is_none() {
            let Triple(x, y, z) = state.position_m;
            self.board_point_m = Some((x, y, z));
        }
        if self.first.is_none() {
            self.first = Some(surface);
            self.after_board = surface == Touched::Board;
        }
    }

    fn step(&mut self, _t: f64, _dt: f64, states: (&State, &State), _impulses: [Triple<f64>; 2]) {
        let (before, after) = states;
        self.apex_m = self.apex_m.max(after.position_m.2);
        if before.position_m.2 > 0.0 && after.position_m.2 <= 0.0 {
            let Triple(x, y, _) = after.position_m;
            self.falls_through_hoop((x, y), after.velocity_m_s);
        }
    }
}
