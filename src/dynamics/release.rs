//! From a release to the state that starts the flight (Eq. 18 of the paper).

use crate::math::vector::Vec3;
use crate::model::BallState;
use serde::Serialize;

/// How and where the ball leaves the hand: the nine parameters of Eq. 18, in SI units. All must be
/// finite.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Release {
    /// Horizontal distance r0 of the ball's centre from the hoop's axis, m.
    pub distance_m: f64,
    /// Court angle theta0: 0 straight in front of the board, positive towards +y, rad.
    pub court_angle_rad: f64,
    /// Height z0 of the ball's centre above the plane of the hoop (negative below), m.
    pub height_above_hoop_m: f64,
    /// Speed v0, m/s.
    pub speed_m_s: f64,
    /// Pitch angle alpha0 above the horizontal, rad.
    pub pitch_rad: f64,
    /// Polar angle beta0 of the vertical plane of flight, rad. It equals the court angle when the
    /// shot is aimed at the hoop's axis.
    pub polar_rad: f64,
    /// Backspin omega_beta0, about the horizontal axis across the flight, rad/s; positive is
    /// backwards.
    pub backspin_rad_s: f64,
    /// Rifle spin omega_r0, about the horizontal direction of flight, rad/s; positive is clockwise
    /// as seen from the hoop (the axis points from the hoop to the shooter).
    pub rifle_spin_rad_s: f64,
    /// Side spin omega_z0, about the vertical, rad/s; positive is counter-clockwise from above.
    pub side_spin_rad_s: f64,
}

impl Release {
    /// The nine state variables at the release (Eq. 18).
    #[must_use]
    pub fn state(&self) -> BallState {
        ReleaseWithoutSpeed::new(self).state(self.speed_m_s, self.backspin_rad_s)
    }

    /// Position of the ball's centre relative to that of the hoop, m.
    pub(crate) fn position_m(&self) -> Vec3<f64> {
        let (sin_court, cos_court) = libm::sincos(self.court_angle_rad);
        Vec3::new(
            self.distance_m * cos_court,
            self.distance_m * sin_court,
            self.height_above_hoop_m,
        )
    }

    /// The same release mirrored in the plane of symmetry (y -> -y).
    #[must_use]
    pub fn mirrored(&self) -> Self {
        Self {
            court_angle_rad: -self.court_angle_rad,
            polar_rad: -self.polar_rad,
            rifle_spin_rad_s: -self.rifle_spin_rad_s,
            side_spin_rad_s: -self.side_spin_rad_s,
            ..*self
        }
    }
}

/// A release without its speed and backspin. Its sines and cosines are computed once for many
/// shots.
#[derive(Clone, Copy, Debug)]
pub struct ReleaseWithoutSpeed {
    position_m: Vec3<f64>,
    sin_pitch: f64,
    cos_pitch: f64,
    sin_polar: f64,
    cos_polar: f64,
    rifle_spin_rad_s: f64,
    side_spin_rad_s: f64,
}

impl ReleaseWithoutSpeed {
    /// `release` without its speed and backspin.
    #[must_use]
    pub fn new(release: &Release) -> Self {
        Self::at(release.position_m(), release)
    }

    /// State of a release whose position is known.
    pub(crate) fn at(position_m: Vec3<f64>, release: &Release) -> Self {
        let pitch = libm::sincos(release.pitch_rad);
        Self::of(position_m, pitch, libm::sincos(release.polar_rad), release)
    }

    /// State of a release with known sines and cosines of both angles.
    fn of(
        position_m: Vec3<f64>,
        (sin_pitch, cos_pitch): (f64, f64),
        (sin_polar, cos_polar): (f64, f64),
        release: &Release,
    ) -> Self {
        Self {
            position_m,
            sin_pitch,
            cos_pitch,
            sin_polar,
            cos_polar,
            rifle_spin_rad_s: release.rifle_spin_rad_s,
            side_spin_rad_s: release.side_spin_rad_s,
        }
    }

    /// The nine state variables at the release with this speed and backspin (Eq. 18).
    #[must_use]
    pub fn state(&self, speed_m_s: f64, backspin_rad_s: f64) -> BallState {
        let horizontal_speed = speed_m_s * self.cos_pitch;
        let (sin, cos) = (self.sin_polar, self.cos_polar);
        BallState {
            position_m: self.position_m,
            velocity_m_s: Vec3::new(
                -horizontal_speed * cos,
                -horizontal_speed * sin,
                speed_m_s * self.sin_pitch,
            ),
            spin_rad_s: Vec3::new(
                self.rifle_spin_rad_s * cos - backspin_rad_s * sin,
                self.rifle_spin_rad_s * sin + backspin_rad_s * cos,
                self.side_spin_rad_s,
            ),
        }
    }
}

/// The states of many releases, one after the other. The sine and cosine of an angle
/// that has not changed are used again; the bits are those of [`Release::state`].
#[derive(Clone, Copy, Debug)]
pub struct ReleaseStates {
    court: CachedSinCos,
    pitch: CachedSinCos,
    polar: CachedSinCos,
}

impl Default for ReleaseStates {
    fn default() -> Self {
        let known = CachedSinCos::of(0.0);
        Self {
            court: known,
            pitch: known,
            polar: known,
        }
    }
}

impl ReleaseStates {
    /// The state of the next release.
    #[must_use]
    pub fn next_state(&mut self, release: &Release) -> BallState {
        let (sin_court, cos_court) = self.court.sin_cos(release.court_angle_rad);
        let pitch = self.pitch.sin_cos(release.pitch_rad);
        let polar = self.polar.sin_cos(release.polar_rad);
        let position_m = Vec3::new(
            release.distance_m * cos_court,
            release.distance_m * sin_court,
            release.height_above_hoop_m,
        );
        ReleaseWithoutSpeed::of(position_m, pitch, polar, release)
            .state(release.speed_m_s, release.backspin_rad_s)
    }
}

/// The sine and cosine of the last angle.
#[derive(Clone, Copy, Debug)]
struct CachedSinCos {
    angle_rad: f64,
    sin_cos: (f64, f64),
}

impl CachedSinCos {
    fn of(angle_rad: f64) -> Self {
        Self {
            angle_rad,
            sin_cos: libm::sincos(angle_rad),
        }
    }

    fn sin_cos(&mut self, angle_rad: f64) -> (f64, f64) {
        // By the bits: -0.0 is another angle than 0.0.
        if angle_rad.to_bits() != self.angle_rad.to_bits() {
            *self = Self::of(angle_rad);
        }
        self.sin_cos
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_states_in_turn_have_the_bits_of_each_alone() {
        let mut release = Release {
            distance_m: 4.0,
            court_angle_rad: 0.3,
            height_above_hoop_m: -1.0,
            speed_m_s: 7.5,
            pitch_rad: 0.9,
            polar_rad: 0.31,
            backspin_rad_s: 12.0,
            rifle_spin_rad_s: 1.0,
            side_spin_rad_s: -2.0,
        };
        let mut states = ReleaseStates::default();
        for step in 0..12 {
            let next = states.next_state(&release);
            let alone = release.state();
            let bits = |state: &BallState| format!("{state:?}");
            assert_eq!(bits(&next), bits(&alone), "{step}");
            match step % 4 {
                0 => release.court_angle_rad = -release.court_angle_rad,
                1 => release.pitch_rad += 0.1,
                2 => release.polar_rad = -0.0 * release.polar_rad,
                _ => release.speed_m_s += 1.0,
            }
        }
    }
}
