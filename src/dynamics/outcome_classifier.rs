//! Derives the full [`Outcome`] of a shot from what an observer sees: how it was made or missed,
//! its entry and its apex.

use super::flight::{FlightPath, falls_through, highest_point_m};
use super::observer::{Impulses, Observer};
use super::outcome::{Ending, Entry, Outcome, OutcomeKind, Verdict};
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::{BallState, SolidId};

/// Collects what an [`Outcome`] has beyond the [`Verdict`].
pub(crate) struct OutcomeClassifier {
    ring_radius_m: f64,
    /// Unit vector on the floor from the release to the hoop.
    towards_hoop: (f64, f64),
    first_contact: Option<SolidId>,
    first_touch_s: Option<f64>,
    entry: Option<Entry>,
    apex_m: f64,
    was_inside: bool,
    board_point_m: Option<(f64, f64, f64)>,
    /// Where the undisturbed path (a bank shot: the path off the board) meets the plane of the
    /// hoop.
    undisturbed_crossing_m: Option<(f64, f64)>,
    /// The next flight is the one from the release, or the one off the board after a first contact
    /// there.
    awaits_flight: bool,
}

impl OutcomeClassifier {
    pub(crate) fn new(ring_radius_m: f64, start: &BallState) -> Self {
        let [x, y, z] = start.position_m.into();
        let distance = (x * x + y * y).sqrt();
        let towards_hoop = if distance > 0.0 {
            (-x / distance, -y / distance)
        } else {
            (-1.0, 0.0)
        };
        Self {
            ring_radius_m,
            towards_hoop,
            first_contact: None,
            first_touch_s: None,
            entry: None,
            apex_m: z,
            was_inside: false,
            board_point_m: None,
            undisturbed_crossing_m: None,
            awaits_flight: true,
        }
    }

    fn record_entry(&mut self, (x, y): (f64, f64), velocity: Vec3<f64>) {
        let horizontal = (velocity.x * velocity.x + velocity.y * velocity.y).sqrt();
        self.entry = Some(Entry {
            angle_rad: libm::atan2(-velocity.z, horizontal),
            offset_m: (x, y),
        });
        self.was_inside |= (x * x + y * y).sqrt() < self.ring_radius_m;
    }

    /// The point [`OutcomeClassifier::undisturbed_crossing_m`] relative to the hoop's centre:
    /// beyond it and to its right, facing the hoop (a bank shot: the board), m.
    fn aim_beyond_and_right(&self) -> (f64, f64) {
        let (x, y) = self.undisturbed_crossing_m.unwrap_or((0.0, 0.0));
        let (ahead_x, ahead_y) = self.towards_hoop;
        match self.first_contact {
            Some(SolidId::Board) => (x, y),
            _ => (x * ahead_x + y * ahead_y, x * ahead_y - y * ahead_x),
        }
    }

    fn kind_of_miss(&self, verdict: &Verdict) -> OutcomeKind {
        if verdict.ending == Ending::BehindBoard {
            return OutcomeKind::OverBoard;
        }
        if self.was_inside {
            return OutcomeKind::InAndOut;
        }
        if self.first_contact.is_none() {
            return OutcomeKind::Airball;
        }
        let (beyond, right) = self.aim_beyond_and_right();
        if right.abs() > beyond.abs() {
            OutcomeKind::Wide
        } else if beyond > 0.0 {
            OutcomeKind::Long
        } else {
            OutcomeKind::Short
        }
    }

    pub(crate) fn outcome(&self, verdict: Verdict) -> Outcome {
        let kind = match verdict.ending {
            Ending::Unresolved => OutcomeKind::Unresolved,
            Ending::Lodged | Ending::TimeLimit => OutcomeKind::Lodged,
            _ if verdict.made => OutcomeKind::of_made(&verdict.contacts),
            _ => self.kind_of_miss(&verdict),
        };
        Outcome {
            verdict,
            kind,
            entry: self.entry,
            apex_m: self.apex_m,
            first_touch_s: self.first_touch_s,
            board_point_m: self.board_point_m,
            right_of_centre_m: self.aim_beyond_and_right().1,
        }
    }
}

impl Observer for OutcomeClassifier {
    fn flight(&mut self, params: &ModelParams, _t: f64, dt: f64, path: &FlightPath) {
        self.apex_m = self.apex_m.max(highest_point_m(params, path, dt));
        // Once for each flight, not for each segment: `falls_through` follows the flight to the
        // hoop, and a flight can have many short segments.
        let is_wanted = std::mem::take(&mut self.awaits_flight);
        let (z, vz) = path.height_and_rate(dt);
        let crosses = z <= 0.0 && vz < 0.0;
        if (is_wanted || crosses)
            && let Some((state, t)) = falls_through(params, &path.state_after(0.0), 0.0)
        {
            let crossing = (state.position_m.x, state.position_m.y);
            if is_wanted {
                self.undisturbed_crossing_m = Some(crossing);
            }
            if t > 0.0 && t <= dt {
                self.record_entry(crossing, state.velocity_m_s);
            }
        }
    }

    fn touch(&mut self, t: f64, solid: SolidId, state: &BallState) {
        if solid == SolidId::Board && self.board_point_m.is_none() {
            let [x, y, z] = state.position_m.into();
            self.board_point_m = Some((x, y, z));
        }
        if self.first_contact.is_none() {
            self.first_contact = Some(solid);
            self.first_touch_s = Some(t);
            self.awaits_flight = solid == SolidId::Board;
        }
    }

    fn step(&mut self, _t: f64, _dt: f64, states: (&BallState, &BallState), _impulses: Impulses) {
        let [from, to] = [states.0.position_m, states.1.position_m];
        self.apex_m = self.apex_m.max(to.z);
        if from.z > 0.0 && to.z <= 0.0 {
            // Along the chord: at its end the ball may rise again.
            let chord = to - from;
            let crossing = from + chord * (from.z / (from.z - to.z));
            self.record_entry((crossing.x, crossing.y), chord);
        }
    }
}
