//! A location on the court.

use crate::model::Physics;
use crate::units::{DEGREE_RAD, FOOT_M, UnitSystem};
use serde::{Deserialize, Serialize};

/// Greatest distance of a location from the hoop, m.
const FARTHEST_M: f64 = 40.0;

/// A location on the court, seen from the hoop's axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Location {
    /// Horizontal distance from the hoop's centre, m.
    pub distance_m: f64,
    /// Court angle theta0 from the court's long axis, rad; -pi/2 to pi/2 is in front of the hoop's
    /// centre.
    pub angle_rad: f64,
}

/// Why nobody can shoot from a location.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LocationError {
    /// Under or in the ring.
    #[error("the place is inside the ring's reach; the distance must be more than {:.2} ft ({reach_m:.3} m)", .reach_m / FOOT_M)]
    InsideRing {
        /// Radius of the ring plus that of the ball, m.
        reach_m: f64,
    },
    /// Behind the face of the board.
    #[error("the place is behind the board (x = {:.2} ft); x = distance cos(angle) must be more than {:.2} ft ({least_m:.3} m)", .x_m / FOOT_M, .least_m / FOOT_M)]
    BehindBoard {
        /// x of the location, m.
        x_m: f64,
        /// x must be more than this, m.
        least_m: f64,
    },
    /// Farther than any court is long.
    #[error("the distance must be below 40 m (131 ft)")]
    TooFar,
}

impl LocationError {
    /// The coordinate that is out of range.
    #[must_use]
    pub fn key(&self) -> &'static str {
        match self {
            Self::InsideRing { .. } | Self::TooFar => "distance",
            Self::BehindBoard { .. } => "angle",
        }
    }
}

impl Location {
    /// The place in words, such as `12 ft from the hoop, 45 deg to the right` (facing the board, 0
    /// deg being straight in front).
    #[must_use]
    pub fn in_words(&self, units: UnitSystem) -> String {
        let (long, metre) = units.length();
        let angle_deg = self.angle_rad / DEGREE_RAD;
        let side = match angle_deg {
            angle if angle.abs() < 0.5 => "straight in front".to_owned(),
            angle if (angle.abs() - 90.0).abs() < 0.5 => {
                let side = if angle > 0.0 { "right" } else { "left" };
                format!("level with the hoop on the {side}")
            }
            angle if angle > 0.0 => format!("{angle:.0} deg to the right"),
            angle => format!("{:.0} deg to the left", -angle),
        };
        // Two decimals at most, and no more than are needed.
        let distance = format!("{:.2}", self.distance_m / metre);
        let distance = distance.trim_end_matches('0').trim_end_matches('.');
        format!("{distance} {long} from the hoop, {side}")
    }

    /// Words for a place and its mirror image together.
    #[must_use]
    pub fn in_words_on_either_side(&self, units: UnitSystem) -> String {
        self.in_words(units)
            .replace("to the left", "to either side")
            .replace("to the right", "to either side")
            .replace("on the left", "on either side")
            .replace("on the right", "on either side")
    }

    /// The place as players name it, such as `the left wing, 11 ft from the hoop`: the part of the
    /// court, and the distance to half a foot or a tenth of a metre.
    #[must_use]
    pub fn in_players_words(&self, units: UnitSystem) -> String {
        let side = if self.angle_rad > 0.0 {
            "right"
        } else {
            "left"
        };
        self.in_players_words_of(&format!("the {side}"), units)
    }

    /// Players' words for a place and its mirror image together:
    /// `either wing, 11 ft from the hoop`.
    #[must_use]
    pub fn in_players_words_on_either_side(&self, units: UnitSystem) -> String {
        self.in_players_words_of("either", units)
    }

    /// With the side of the court, such as `the left`.
    fn in_players_words_of(&self, side: &str, units: UnitSystem) -> String {
        let (long, metre) = units.length();
        let step = match units {
            UnitSystem::Imperial => 0.5,
            UnitSystem::Metric => 0.1,
        };
        // f64 prints no more digits than it needs: 11, 11.5 and 3.4.
        let steps = (self.distance_m / metre / step + 1e-9).round();
        let distance = (steps * step * 10.0).round() / 10.0;
        let part = match (self.angle_rad / DEGREE_RAD).abs() {
            angle if angle < 10.0 => "straight in front".to_owned(),
            angle if angle < 30.0 => format!("between the middle and {side} wing"),
            angle if angle < 65.0 => format!("{side} wing"),
            angle if angle < 80.0 => format!("{side} side near the baseline"),
            angle if angle <= 90.5 => format!("{side} side along the baseline"),
            _ => format!("{side} side behind the hoop"),
        };
        format!("{part}, {distance} {long} from the hoop")
    }

    /// From the coordinates x (from the board towards midcourt) and y, m.
    #[must_use]
    pub fn from_xy(x_m: f64, y_m: f64) -> Self {
        Self {
            distance_m: (x_m * x_m + y_m * y_m).sqrt(),
            angle_rad: libm::atan2(y_m, x_m),
        }
    }

    /// The coordinates x (from the board towards midcourt) and y, m.
    #[must_use]
    pub fn to_xy(&self) -> (f64, f64) {
        let (sin, cos) = libm::sincos(self.angle_rad);
        (self.distance_m * cos, self.distance_m * sin)
    }

    /// Checks that somebody can shoot from here.
    ///
    /// # Errors
    /// Why not.
    pub fn check(&self, physics: &Physics) -> Result<(), LocationError> {
        let reach_m = physics.ring_radius_m + physics.ball_radius_m;
        let x_m = self.distance_m * libm::cos(self.angle_rad);
        let least_m = physics.ball_radius_m - physics.board_distance_m;
        if !(self.distance_m > reach_m) {
            return Err(LocationError::InsideRing { reach_m });
        }
        if !(x_m > least_m) {
            return Err(LocationError::BehindBoard { x_m, least_m });
        }
        if !(self.distance_m < FARTHEST_M) {
            return Err(LocationError::TooFar);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The parts of the court are those that players name, the same on both sides.
    #[test]
    fn contract_places_in_players_words() {
        let place = |distance_ft: f64, angle_deg: f64| Location {
            distance_m: distance_ft * FOOT_M,
            angle_rad: angle_deg * DEGREE_RAD,
        };
        for (distance_ft, angle_deg, words) in [
            (13.75, 0.0, "straight in front, 14 ft from the hoop"),
            (
                11.18,
                -27.0,
                "between the middle and the left wing, 11 ft from the hoop",
            ),
            (11.3, 63.0, "the right wing, 11.5 ft from the hoop"),
            (
                20.6,
                -76.0,
                "the left side near the baseline, 20.5 ft from the hoop",
            ),
            (
                5.0,
                90.0,
                "the right side along the baseline, 5 ft from the hoop",
            ),
            (
                7.0,
                -100.0,
                "the left side behind the hoop, 7 ft from the hoop",
            ),
        ] {
            let place = place(distance_ft, angle_deg);
            assert_eq!(place.in_players_words(UnitSystem::Imperial), words);
            let mirror = Location {
                angle_rad: -place.angle_rad,
                ..place
            };
            let of_both =
                |place: &Location| place.in_players_words_on_either_side(UnitSystem::Imperial);
            assert_eq!(of_both(&place), of_both(&mirror));
        }
        let metric = place(11.3, 63.0).in_players_words(UnitSystem::Metric);
        assert_eq!(metric, "the right wing, 3.4 m from the hoop");
    }
}
