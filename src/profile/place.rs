//! The place of a shot on the court, from TOML.

use super::Place;
use super::fault::Fault;
use super::keys::Keys;
use super::read::check;
use crate::physics::{FOOT_M, Physics};
use crate::units::{DEGREE_RAD, Dimension};
use std::f64::consts::PI;

pub(super) fn read_place(
    mut keys: Keys<'_, '_>,
    physics: &Physics,
    faults: &mut Vec<Fault>,
) -> Option<Place> {
    let cartesian = keys.has("x") || keys.has("y");
    let polar = keys.has("distance") || keys.has("angle");
    let (x, y, at) = if cartesian {
        if polar {
            faults.push(keys.fault("x", "give either distance and angle, or x and y"));
        }
        let _ = (
            keys.quantity("distance", Dimension::Length, faults),
            keys.quantity("angle", Dimension::Angle, faults),
        );
        let x = keys.required("x", Dimension::Length, faults);
        let y = keys.required("y", Dimension::Length, faults);
        let at = keys.fault("x", "");
        keys.finish(faults);
        (x?, y?, at)
    } else {
        let distance = keys.required("distance", Dimension::Length, faults);
        let distance = check(&keys, "distance", distance, |d| d > 0.0, "above 0", faults);
        let angle = keys.required("angle", Dimension::Angle, faults);
        let angle = check(
            &keys,
            "angle",
            angle,
            |a| a.abs() <= PI,
            "between -180 and 180 deg",
            faults,
        );
        let place = distance.zip(angle);
        let span_of = keys.fault("distance", "");
        // Known here, though not given.
        let _ = (
            keys.quantity("x", Dimension::Length, faults),
            keys.quantity("y", Dimension::Length, faults),
        );
        keys.finish(faults);
        let (distance_m, angle_rad) = place?;
        let place = Place {
            distance_m,
            angle_rad,
        };
        return check_place(place, physics, &span_of, faults);
    };
    check_place(Place::from_xy(x, y), physics, &at, faults)
}

fn check_place(
    place: Place,
    physics: &Physics,
    at: &Fault,
    faults: &mut Vec<Fault>,
) -> Option<Place> {
    match place.check(physics) {
        Ok(()) => Some(place),
        Err(error) => {
            faults.push(Fault {
                message: error.to_string(),
                ..at.clone()
            });
            None
        }
    }
}

/// Why nobody can shoot from a place.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlaceError {
    /// Under or in the ring.
    #[error("the place is inside the ring's reach; the distance must be more than {:.2} ft ({reach_m:.3} m)", .reach_m / FOOT_M)]
    InsideRing {
        /// Radius of the ring and the ball, m.
        reach_m: f64,
    },
    /// Behind the face of the board.
    #[error("the place is behind the board (x = {:.2} ft); x = distance cos(angle) must be more than {:.2} ft ({least_m:.3} m)", .x_m / FOOT_M, .least_m / FOOT_M)]
    BehindBoard {
        /// How far in front of the hoop's centre, m.
        x_m: f64,
        /// Least that is allowed, m.
        least_m: f64,
    },
    /// Farther than any court is long.
    #[error("the distance must be below 40 m (131 ft)")]
    TooFar,
    /// The search's pitch angles, some given and some usual for the place, leave none.
    #[error("from this place no pitch angle is left to search: pitch_min ({:.1} deg) must be less than pitch_max ({:.1} deg)", .low_rad / DEGREE_RAD, .high_rad / DEGREE_RAD)]
    NoPitch {
        /// Smallest pitch angle, rad.
        low_rad: f64,
        /// Largest pitch angle, rad.
        high_rad: f64,
    },
}

impl Place {
    /// From the coordinates x (from the board to the court) and y, m.
    #[must_use]
    pub fn from_xy(x_m: f64, y_m: f64) -> Self {
        Self {
            distance_m: (x_m * x_m + y_m * y_m).sqrt(),
            angle_rad: libm::atan2(y_m, x_m),
        }
    }

    /// Can somebody shoot from there?
    ///
    /// # Errors
    /// Why not.
    pub fn check(&self, physics: &Physics) -> Result<(), PlaceError> {
        let reach_m = physics.ring_radius_m + physics.ball_radius_m;
        let x_m = self.distance_m * libm::cos(self.angle_rad);
        let least_m = physics.ball_radius_m - physics.board_distance_m;
        if !(self.distance_m > reach_m) {
            return Err(PlaceError::InsideRing { reach_m });
        }
        if !(x_m > least_m) {
            return Err(PlaceError::BehindBoard { x_m, least_m });
        }
        if !(self.distance_m < 40.0) {
            return Err(PlaceError::TooFar);
        }
        Ok(())
    }
}
