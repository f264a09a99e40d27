//! Where the parabola of a nominal shot passes the plane of the hoop.

use crate::shooter::{Nominal, Profile};

/// Horizontal length of the parabola from a release to its fall through the plane of the hoop, m; `None` if it
/// does not rise above that plane.
fn length_to_hoop_plane_m(profile: &Profile, nominal: &Nominal) -> Option<f64> {
    let (sin, cos) = libm::sincos(nominal.pitch_rad);
    let g = profile.physics().gravity_m_s2;
    let up = nominal.speed_m_s * sin;
    let square = up * up + 2.0 * g * profile.height_above_hoop_m();
    let length = nominal.speed_m_s * cos * (up + square.max(0.0).sqrt()) / g;
    (square > 0.0).then_some(length)
}

/// Speed of the parabola that falls through the plane of the hoop after the horizontal length, m/s; `None` if
/// the pitch angle is too low.
fn speed_for_length_m_s(profile: &Profile, pitch_rad: f64, length_m: f64) -> Option<f64> {
    let (sin, cos) = libm::sincos(pitch_rad);
    let over = profile.height_above_hoop_m() + length_m * sin / cos;
    let g = profile.physics().gravity_m_s2;
    (over > 0.0 && cos > 1e-6).then(|| length_m / cos * (0.5 * g / over).sqrt())
}

/// Speed of the parabola through the hoop's centre, m/s; `None` if the pitch angle is too low.
#[must_use]
pub fn centre_speed_m_s(profile: &Profile, pitch_rad: f64) -> Option<f64> {
    speed_for_length_m_s(profile, pitch_rad, profile.location().distance_m)
}

/// How far past the hoop's centre the undisturbed path falls through the plane of the hoop, along its own
/// horizontal direction, m. Positive is long; `None` if the path stays below that plane.
#[must_use]
pub fn aim_past_centre_m(profile: &Profile, nominal: &Nominal) -> Option<f64> {
    let location = profile.location();
    let turn = libm::cos(nominal.polar_rad - location.angle_rad);
    Some(length_to_hoop_plane_m(profile, nominal)? - location.distance_m * turn)
}

/// The shot of the profile `other`, released at another height, that passes the plane of the hoop at the same
/// point. If there is none, the same shot.
#[must_use]
pub fn with_same_aim(profile: &Profile, other: &Profile, nominal: &Nominal) -> Nominal {
    let speed = length_to_hoop_plane_m(profile, nominal)
        .and_then(|length_m| speed_for_length_m_s(other, nominal.pitch_rad, length_m));
    Nominal {
        speed_m_s: speed.unwrap_or(nominal.speed_m_s),
        ..*nominal
    }
}
