//! Where the undisturbed path of a nominal shot passes the plane of the hoop.

use crate::shooter::{Nominal, Profile};

/// Horizontal length of the undisturbed path from a release to its fall through the plane of the
/// hoop, m; `None` if it does not rise above that plane.
fn length_to_hoop_plane_m(profile: &Profile, nominal: &Nominal) -> Option<f64> {
    profile
        .simulator()
        .length_to_hoop_plane_m(&profile.release(nominal))
}

/// Speed of the path in the direction of `nominal` that falls through the plane of the hoop after
/// the horizontal length, m/s; `None` if the pitch angle is too low.
fn speed_for_length_m_s(profile: &Profile, nominal: &Nominal, length_m: f64) -> Option<f64> {
    profile
        .simulator()
        .speed_through_m_s(&profile.release(nominal), length_m, 0.0)
}

/// Speed of the undisturbed path without spin through the hoop's centre, m/s; `None` if the pitch
/// angle is too low.
#[must_use]
pub fn centre_speed_m_s(profile: &Profile, pitch_rad: f64) -> Option<f64> {
    let location = profile.location();
    let nominal = Nominal {
        speed_m_s: 0.0,
        pitch_rad,
        polar_rad: location.angle_rad,
        backspin_rad_s: 0.0,
        rifle_spin_rad_s: 0.0,
        side_spin_rad_s: 0.0,
    };
    speed_for_length_m_s(profile, &nominal, location.distance_m)
}

/// How far past the hoop's centre the undisturbed path falls through the plane of the hoop, along
/// its own horizontal direction, m. Positive is long; `None` if the path stays below that plane.
#[must_use]
pub fn aim_past_centre_m(profile: &Profile, nominal: &Nominal) -> Option<f64> {
    let location = profile.location();
    let turn = libm::cos(nominal.polar_rad - location.angle_rad);
    Some(length_to_hoop_plane_m(profile, nominal)? - location.distance_m * turn)
}

/// The shot of the profile `other`, released at another height, that passes the plane of the hoop
/// at the same point. If there is none, the same shot.
#[must_use]
pub fn with_same_aim(profile: &Profile, other: &Profile, nominal: &Nominal) -> Nominal {
    let speed = length_to_hoop_plane_m(profile, nominal)
        .and_then(|length_m| speed_for_length_m_s(other, nominal, length_m));
    Nominal {
        speed_m_s: speed.unwrap_or(nominal.speed_m_s),
        ..*nominal
    }
}
