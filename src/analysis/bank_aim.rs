//! Where bank shots are aimed: the paper's closed form, and the point behind the board that the
//! lines of aim pass.

use crate::model::{Physics, SolidId};
use crate::shooter::Location;

/// The polar angle of Eq. 27, rad: towards the hoop's centre as the board reflects it, for a ball
/// without spin that rolls as it leaves the board. It does not depend on the speed.
#[must_use]
pub fn closed_form_polar_rad(physics: &Physics, location: Location) -> f64 {
    let behind_m = physics.board_distance_m + closed_form_meeting_m(physics);
    libm::atan2(
        location.distance_m * libm::sin(location.angle_rad),
        behind_m + location.distance_m * libm::cos(location.angle_rad),
    )
}

/// The point that all lines of aim of Eq. 27 pass: its distance behind the board's face, in the
/// board's plane of symmetry, m.
#[must_use]
pub fn closed_form_meeting_m(physics: &Physics) -> f64 {
    let restitution = physics.restitution_on(SolidId::Board);
    let from_centre_m =
        (physics.board_distance_m - physics.ball_radius_m) * (1.0 + 3.0 / (5.0 * restitution));
    from_centre_m - physics.board_distance_m
}

/// Where the line of aim from a location passes the board's plane of symmetry: the distance behind
/// the board's face, m (negative in front). `None` for a line along that plane.
#[must_use]
pub fn meeting_behind_board_m(
    physics: &Physics,
    location: Location,
    polar_rad: f64,
) -> Option<f64> {
    let (sin, cos) = libm::sincos(polar_rad);
    let y_m = location.distance_m * libm::sin(location.angle_rad);
    // Nearer than a degree to the plane the point is not determined.
    if sin.abs() < 0.0175 {
        return None;
    }
    let x_m = location.distance_m * libm::cos(location.angle_rad) - y_m * cos / sin;
    Some(-x_m - physics.board_distance_m)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Preset;
    use crate::units::{DEGREE_RAD, FOOT_M, INCH_M};

    /// Authority: Fig. 15 of the paper (13.75 ft, 67.5 deg, restitution 0.8457) aims at 62.107 deg;
    /// and the point of Silverberg, Tran and Adams 2011 is 3.33 in behind the board.
    #[test]
    fn val_closed_form_of_the_paper() {
        let mut physics = Preset::named("paper").unwrap().physics();
        let location = Location {
            distance_m: 13.75 * FOOT_M,
            angle_rad: 67.5 * DEGREE_RAD,
        };
        assert!((closed_form_meeting_m(&physics) / INCH_M - 3.33).abs() < 0.05);
        let polar = closed_form_polar_rad(&physics, location);
        let meeting = meeting_behind_board_m(&physics, location, polar).unwrap();
        assert!((meeting - closed_form_meeting_m(&physics)).abs() < 1e-12);
        physics.set_restitution_on(SolidId::Board, 0.8457).unwrap();
        let polar = closed_form_polar_rad(&physics, location);
        assert!((polar / DEGREE_RAD - 62.107).abs() < 0.001, "{polar}");
        assert_eq!(
            meeting_behind_board_m(
                &physics,
                Location {
                    angle_rad: 0.0,
                    ..location
                },
                0.0
            ),
            None
        );
    }
}
