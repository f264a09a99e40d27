//! A shooter's profile: what the user wrote, checked, in SI units.
//!
//! `read` turns TOML into a [`Profile`] or into every fault it has, each with its line. The rest of
//! the crate accepts only the checked form.

mod errors;
pub(crate) mod fault;
pub(crate) mod keys;
mod place;
pub(crate) mod read;
mod search;
mod template;
mod world;

pub use errors::{Correlation, ERROR_NAMES, ERRORS, Errors};
pub use fault::{Fault, ProfileError};
pub use place::PlaceError;
pub use read::{LARGEST_PROFILE_BYTES, parse, parse_physics};
pub use template::{GivenSearch, Template};

use crate::dynamics::{Integrator, Release};
use crate::physics::Physics;
use crate::units::System;
use serde::Serialize;

/// A checked profile.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Profile {
    /// Who shoots.
    pub shooter: Shooter,
    /// From where.
    pub place: Place,
    /// The nominal shot, or parts of it.
    pub nominal: Intent,
    /// The world.
    pub physics: Physics,
    /// How the equations are integrated.
    pub integrator: Integrator,
    /// Sizes of the table.
    pub grid: Grid,
    /// Bounds and precision of the search.
    pub search: Search,
    /// Where and in which units results are written.
    pub output: Output,
}

/// The shooter: limits and release errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shooter {
    /// Name, for tables and the results' folder.
    pub name: String,
    /// Height of the ball's centre above the floor at the release, m.
    pub release_height_m: f64,
    /// Largest nominal backspin, rad/s.
    pub max_backspin_rad_s: f64,
    /// Largest nominal side spin either way, rad/s.
    pub max_side_spin_rad_s: f64,
    /// Release errors.
    pub errors: Errors,
}

/// A place on the court, seen from the hoop's axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Horizontal distance from the hoop's centre, m.
    pub distance_m: f64,
    /// Angle theta0 from the court's long axis, rad; -pi/2 to pi/2 is in front of the hoop's centre.
    pub angle_rad: f64,
}

/// Points along each axis of the table about a best shot; the table of the search, which only has to
/// find where to look, has two thirds of them along speed, pitch and polar angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Grid {
    /// Speeds on each line.
    pub speed: usize,
    /// Pitch angles.
    pub pitch: usize,
    /// Polar angles.
    pub polar: usize,
    /// Backspins.
    pub backspin: usize,
}

impl Grid {
    /// Points in all.
    #[must_use]
    pub fn points(self) -> u64 {
        self.speed as u64 * self.pitch as u64 * self.polar as u64 * self.backspin as u64
    }

    /// Points of the search's table.
    #[must_use]
    pub fn of_search(self) -> Self {
        let fewer = |points: usize| (2 * points).div_ceil(3).max(1);
        Self {
            speed: fewer(self.speed),
            pitch: fewer(self.pitch),
            polar: fewer(self.polar),
            backspin: self.backspin,
        }
    }
}

impl Default for Grid {
    fn default() -> Self {
        Self {
            speed: 56,
            pitch: 36,
            polar: 36,
            backspin: 12,
        }
    }
}

/// The parts of a nominal shot that a search can choose.
pub const CHOICES: [&str; 5] = ["speed", "pitch", "polar", "backspin", "side_spin"];

/// Which parts of a nominal shot the search chooses; the others are held at the profile's `[nominal]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Choice {
    /// Speed.
    pub speed: bool,
    /// Pitch angle.
    pub pitch: bool,
    /// Polar angle.
    pub polar: bool,
    /// Backspin.
    pub backspin: bool,
    /// Spin about the vertical.
    pub side_spin: bool,
}

impl Default for Choice {
    /// All but side spin.
    fn default() -> Self {
        Self {
            speed: true,
            pitch: true,
            polar: true,
            backspin: true,
            side_spin: false,
        }
    }
}

impl Choice {
    /// By the order of [`CHOICES`].
    #[must_use]
    pub fn flags(&self) -> [bool; CHOICES.len()] {
        [
            self.speed,
            self.pitch,
            self.polar,
            self.backspin,
            self.side_spin,
        ]
    }

    /// Only those of [`CHOICES`] that are named.
    #[must_use]
    pub fn only(names: &[&str]) -> Self {
        let [speed, pitch, polar, backspin, side_spin] =
            CHOICES.map(|choice| names.contains(&choice));
        Self {
            speed,
            pitch,
            polar,
            backspin,
            side_spin,
        }
    }
}

/// Bounds and precision of the search for the best shot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Search {
    /// What is searched.
    pub choose: Choice,
    /// Smallest nominal pitch angle, rad; with the pitch held, that.
    pub pitch_min_rad: f64,
    /// Largest nominal pitch angle, rad.
    pub pitch_max_rad: f64,
    /// Largest speed of a release, m/s; by default 2 times the least speed to the hoop.
    pub speed_max_m_s: Option<f64>,
    /// Standard error wanted for each printed probability.
    pub standard_error: f64,
    /// Sobol points by which the search climbs; more make the choice of the hill surer.
    pub climb_samples: u32,
    /// Seed of the Sobol scrambles.
    pub seed: u64,
}

impl Search {
    /// The default search from a place: nominal pitch angles from 8 deg below to 14 deg above that of
    /// the least speed to the hoop, 45 deg and half the angle at which the hoop is seen (Brancazio
    /// 1981).
    #[must_use]
    pub fn around(distance_m: f64, height_above_hoop_m: f64) -> Self {
        let deg = crate::units::DEGREE_RAD;
        let least = 45.0 * deg + 0.5 * libm::atan2(-height_above_hoop_m, distance_m);
        Self {
            choose: Choice::default(),
            pitch_min_rad: (least - 8.0 * deg).clamp(deg, 80.0 * deg),
            pitch_max_rad: (least + 14.0 * deg).clamp(9.0 * deg, 85.0 * deg),
            speed_max_m_s: None,
            standard_error: 0.001,
            climb_samples: 2048,
            seed: 1,
        }
    }
}

/// Where and how results are written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Output {
    /// Folder under which a folder for the run is made.
    #[serde(skip)]
    pub folder: String,
    /// Units of tables and files.
    pub units: System,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            folder: "results".to_owned(),
            units: System::Imperial,
        }
    }
}

/// A nominal shot: what the shooter means to do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Nominal {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Pitch angle, rad.
    pub pitch_rad: f64,
    /// Polar angle, rad.
    pub polar_rad: f64,
    /// Backspin, rad/s.
    pub backspin_rad_s: f64,
    /// Spin about the level direction of the shot, rad/s.
    pub rifle_spin_rad_s: f64,
    /// Spin about the vertical, rad/s.
    pub side_spin_rad_s: f64,
}

/// What a profile's `[nominal]` table gives of a nominal shot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Intent {
    /// Speed, m/s.
    pub speed_m_s: Option<f64>,
    /// Pitch angle, rad.
    pub pitch_rad: Option<f64>,
    /// Polar angle, rad.
    pub polar_rad: Option<f64>,
    /// Backspin, rad/s.
    pub backspin_rad_s: Option<f64>,
    /// Spin about the level direction of the shot, rad/s.
    pub rifle_spin_rad_s: Option<f64>,
    /// Spin about the vertical, rad/s.
    pub side_spin_rad_s: Option<f64>,
}

impl Profile {
    /// Height of the release above the plane of the hoop (negative below), m.
    #[must_use]
    pub fn height_above_hoop_m(&self) -> f64 {
        self.shooter.release_height_m - self.physics.hoop_height_m
    }

    /// Least and largest nominal backspin, rad/s.
    #[must_use]
    pub fn backspins_rad_s(&self) -> (f64, f64) {
        if self.search.choose.backspin {
            (0.0, self.shooter.max_backspin_rad_s)
        } else {
            let held = self.held().backspin_rad_s;
            (held, held)
        }
    }

    /// The `[nominal]` shot, as far as it is given: towards the hoop and without spin where it is not.
    #[must_use]
    pub fn held(&self) -> Nominal {
        let intent = &self.nominal;
        Nominal {
            speed_m_s: intent.speed_m_s.unwrap_or(0.0),
            pitch_rad: intent.pitch_rad.unwrap_or(0.0),
            polar_rad: intent.polar_rad.unwrap_or(self.place.angle_rad),
            backspin_rad_s: intent.backspin_rad_s.unwrap_or(0.0),
            rifle_spin_rad_s: intent.rifle_spin_rad_s.unwrap_or(0.0),
            side_spin_rad_s: intent.side_spin_rad_s.unwrap_or(0.0),
        }
    }

    /// The release of a nominal shot from this place, without errors.
    #[must_use]
    pub fn release(&self, nominal: &Nominal) -> Release {
        Release {
            distance_m: self.place.distance_m,
            court_angle_rad: self.place.angle_rad,
            height_above_hoop_m: self.height_above_hoop_m(),
            speed_m_s: nominal.speed_m_s,
            pitch_rad: nominal.pitch_rad,
            polar_rad: nominal.polar_rad,
            backspin_rad_s: nominal.backspin_rad_s,
            rifle_spin_rad_s: nominal.rifle_spin_rad_s,
            side_spin_rad_s: nominal.side_spin_rad_s,
        }
    }

    /// BLAKE3 of the checked profile in SI units: two files that mean the same have the same.
    #[must_use]
    pub fn hash(&self) -> String {
        let text = serde_json::to_string(self).unwrap_or_default();
        blake3::hash(text.as_bytes()).to_hex().to_string()
    }
}
