//! The data of a page's script: the shots with their paths, and the court.

use super::shot_in_words::ReportShot;
use crate::answers::json::in_si;
use crate::answers::swarm::path;
use crate::dynamics::{Release, Simulator, StateError};
use crate::model::Physics;
use crate::model::league_courts::Court;
use crate::units::{UnitSystem, rounded};
use serde_json::{Value, json};

/// Spacing of the points of a path, s.
const INTERVAL_S: f64 = 0.04;

/// Where the shots of a page are taken.
#[derive(Clone, Debug)]
pub struct Scene {
    /// Simulates the paths.
    pub simulator: Simulator,
    /// The lines of the court.
    pub court: Court,
    /// Height of the releases above the hoop, m.
    pub height_above_hoop_m: f64,
    /// Units of the texts.
    pub units: UnitSystem,
}

impl Scene {
    /// The data as JSON. `first_place` is the place that the page shows first.
    ///
    /// # Errors
    /// A shot has a value that is not finite.
    pub(super) fn page_data(
        &self,
        shots: &[ReportShot],
        first_place: usize,
    ) -> Result<Value, StateError> {
        let records = shots
            .iter()
            .map(|shot| self.shot_record(shot))
            .collect::<Result<Vec<Value>, StateError>>()?;
        let far_x_m = shots
            .iter()
            .map(|shot| shot.location.to_xy().0)
            .fold(0.0, f64::max);
        Ok(json!({
            "shots": records,
            "court": court_record(&self.court, self.simulator.physics()),
            "far_x_m": to_centimetre(far_x_m),
            "first_place": first_place,
        }))
    }

    fn shot_record(&self, shot: &ReportShot) -> Result<Value, StateError> {
        let (x_m, y_m) = shot.location.to_xy();
        let mut record = json!({
            "place": shot.place,
            "kind": shot.shot.kind.name(),
            "x_m": to_centimetre(x_m),
            "y_m": to_centimetre(y_m),
            "where": shot.location.in_words(self.units),
            "words": shot.description(self.units),
        });
        // The script mirrors the path of the other shot, which keeps the page small.
        match shot.mirror_of {
            Some(other) => record["mirror_of"] = other.into(),
            None => record["path"] = self.path(shot)?,
        }
        Ok(record)
    }

    /// The path of the error-free shot: `[t, x, y, z]`, about every [`INTERVAL_S`] and at each
    /// event.
    fn path(&self, shot: &ReportShot) -> Result<Value, StateError> {
        let trace = self.simulator.trace(&self.release(shot), INTERVAL_S)?;
        Ok(json!(path(&trace, INTERVAL_S)))
    }

    fn release(&self, shot: &ReportShot) -> Release {
        let nominal = &shot.shot.nominal;
        Release {
            distance_m: shot.location.distance_m,
            court_angle_rad: shot.location.angle_rad,
            height_above_hoop_m: self.height_above_hoop_m,
            speed_m_s: nominal.speed_m_s,
            pitch_rad: nominal.pitch_rad,
            polar_rad: nominal.polar_rad,
            backspin_rad_s: nominal.backspin_rad_s,
            rifle_spin_rad_s: nominal.rifle_spin_rad_s,
            side_spin_rad_s: nominal.side_spin_rad_s,
        }
    }
}

/// A length rounded to the centimetre, m. Adding 0 turns a negative zero into zero.
fn to_centimetre(length_m: f64) -> f64 {
    (100.0 * length_m).round() / 100.0 + 0.0
}

/// The lines of a court, and the hoop with its board and the ball, in metres.
#[must_use]
pub fn court_record(court: &Court, physics: &Physics) -> Value {
    let mut record = serde_json::to_value(court).unwrap_or_default();
    for (name, value) in [
        ("three_break_x_m", court.three_break_x_m()),
        ("hoop_height_m", physics.hoop_plane_height_m()),
        ("board_distance_m", physics.board_distance_m),
        ("board_width_m", physics.board_width_m),
        ("board_height_m", physics.board_height_m),
        ("board_centre_height_m", physics.board_centre_z_m()),
        ("board_edge_radius_m", physics.board_edge.radius_m()),
        ("ring_radius_m", physics.ring_radius_m),
        ("bracket_width_m", physics.bracket_width_m),
        ("ball_radius_m", physics.ball_radius_m),
    ] {
        record[name] = in_si(&rounded(value));
    }
    record
}
