//! The place of a shot on the court, from TOML.

use super::Place;
use super::fault::Fault;
use super::keys::Keys;
use super::read::check;
use crate::physics::Physics;
use crate::units::Dimension;
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
    let place = Place {
        distance_m: (x * x + y * y).sqrt(),
        angle_rad: libm::atan2(y, x),
    };
    check_place(place, physics, &at, faults)
}

fn check_place(
    place: Place,
    physics: &Physics,
    at: &Fault,
    faults: &mut Vec<Fault>,
) -> Option<Place> {
    let foot = crate::physics::FOOT_M;
    let reach = physics.ring_radius_m + physics.ball_radius_m;
    let fault = |message: String| Fault {
        message,
        ..at.clone()
    };
    let x = place.distance_m * libm::cos(place.angle_rad);
    let in_front = physics.ball_radius_m - physics.board_distance_m;
    if !(place.distance_m > reach) {
        faults.push(fault(format!(
            "the place is inside the ring's reach; the distance must be more than {:.2} ft ({reach:.3} m)",
            reach / foot
        )));
        return None;
    }
    if !(x > in_front) {
        faults.push(fault(format!(
            "the place is behind the board (x = {:.2} ft); x = distance cos(angle) must be more than {:.2} ft ({in_front:.3} m)",
            x / foot,
            in_front / foot
        )));
        return None;
    }
    if !(place.distance_m < 40.0) {
        faults.push(fault("the distance must be below 40 m (131 ft)".to_owned()));
        return None;
    }
    Some(place)
}
