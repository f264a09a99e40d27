//! The checked profile: shooter, location, physics, search and output.

use super::identity_hash::{IdentityError, identity_hash};
use super::invalid_setting::{SettingChecks, SettingError};
use super::location::{Location, LocationError};
use super::nominal::{Nominal, NominalOverrides};
use super::release_errors::{MAX_SPEED_M_S, MAX_SPIN_RAD_S, ReleaseDispersion};
use super::release_variable::NominalVariable;
use super::search_settings::{Search, SearchSettings, TableGrid};
use crate::dynamics::{InstructionSet, Integrator, Release, Simulator, SimulatorError};
use crate::escape::is_control_or_direction;
use crate::model::Physics;
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};
use serde::{Serialize, Serializer};
use std::f64::consts::{FRAC_PI_2, PI};

/// Longest name of a shooter, in characters.
const LONGEST_NAME: usize = 500;

/// The shooter: limits and release errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shooter {
    /// Name, for tables and the results' folder.
    pub name: String,
    /// Height of the ball's centre above the floor at the release, m.
    pub release_height_m: f64,
    /// Largest nominal backspin, rad/s.
    pub max_backspin_rad_s: f64,
    /// Largest nominal side spin in either direction, rad/s.
    pub max_side_spin_rad_s: f64,
    /// Release errors.
    pub dispersion: ReleaseDispersion,
}

/// Where and how results are written.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputSettings {
    /// Folder in which the folder of a run is made.
    #[serde(skip)]
    pub folder: String,
    /// Units of tables and files.
    pub units: UnitSystem,
}

impl Default for OutputSettings {
    fn default() -> Self {
        Self {
            folder: "results".to_owned(),
            units: UnitSystem::Imperial,
        }
    }
}

/// Everything in a profile except the location. Build one, then call [`ProfileSettings::at`] to
/// check it and get a [`Profile`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProfileSettings {
    /// The shooter.
    pub shooter: Shooter,
    /// The nominal values that are fixed.
    pub nominal: NominalOverrides,
    /// The physics.
    pub physics: Physics,
    /// How the equations are integrated.
    pub integrator: Integrator,
    /// Size of the tables.
    pub grid: TableGrid,
    /// The search.
    pub search: SearchSettings,
    /// Where and in which units results are written.
    pub output: OutputSettings,
}

/// Why settings do not make a profile.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ProfileError {
    /// Settings are out of range: all of them.
    #[error("{}", .0.iter().map(SettingError::to_string).collect::<Vec<_>>().join("\n"))]
    Settings(Vec<SettingError>),
    /// Nobody can shoot from the location.
    #[error(transparent)]
    Location(#[from] LocationError),
    /// The pitch angles of the search, some given and some defaults of the location, leave none.
    #[error("from this place no pitch angle is left to search: pitch_min ({:.1} deg) must be less than pitch_max ({:.1} deg)", .low_rad / DEGREE_RAD, .high_rad / DEGREE_RAD)]
    NoPitch {
        /// Smallest pitch angle, rad.
        low_rad: f64,
        /// Largest pitch angle, rad.
        high_rad: f64,
    },
    /// The ball is pressed in by more than its radius at the speed of the shots.
    #[error(
        "board and ring cannot stop this ball: at {speed_m_s:.1} m/s, the speed of the shots from here, they press it in by more than its radius, and it passes through (at most {most_m_s:.1} m/s); give a larger, lighter or stiffer ball in [physics]"
    )]
    PassesThrough {
        /// The speed of the shots, m/s.
        speed_m_s: f64,
        /// The greatest speed that the ball bears, m/s.
        most_m_s: f64,
    },
    /// The physics or the integrator cannot be simulated.
    #[error(transparent)]
    Simulator(#[from] SimulatorError),
    /// The settings cannot be serialised.
    #[error(transparent)]
    Identity(#[from] IdentityError),
}

impl ProfileSettings {
    /// The settings of a shooter with defaults for the rest.
    #[must_use]
    pub fn new(shooter: Shooter) -> Self {
        Self {
            shooter,
            nominal: NominalOverrides::default(),
            physics: Physics::default(),
            integrator: Integrator::default(),
            grid: TableGrid::default(),
            search: SearchSettings::default(),
            output: OutputSettings::default(),
        }
    }

    /// All settings that are out of range; empty if they are valid.
    #[must_use]
    pub fn errors(&self) -> Vec<SettingError> {
        let mut checks = SettingChecks::default();
        let shooter = &self.shooter;
        shooter.check(&mut checks);
        shooter
            .dispersion
            .check(&mut checks, shooter.max_backspin_rad_s);
        check_nominal(&self.nominal, &mut checks);
        if let Some(backspin) = self.nominal.backspin_rad_s
            && checks.is_valid("shooter.max_backspin")
            && backspin > shooter.max_backspin_rad_s
        {
            let (fixed, most) = (backspin / REV_RAD, shooter.max_backspin_rad_s / REV_RAD);
            checks.refuse(
                "nominal.backspin",
                format!("is {fixed:.3} rev/s, more than shooter.max_backspin ({most:.3} rev/s)"),
            );
            checks.refuse(
                "shooter.max_backspin",
                format!("is {most:.3} rev/s, less than nominal.backspin ({fixed:.3} rev/s)"),
            );
        }
        for error in self.physics.errors() {
            checks.refuse(
                &format!("physics.{}", error.key),
                format!("must be {}", error.allowed),
            );
        }
        if let Err(SimulatorError::Integrator { key, allowed, .. }) = self.integrator.check() {
            checks.refuse(&format!("physics.{key}"), format!("must be {allowed}"));
        }
        self.grid.check(&mut checks);
        self.search
            .check(&mut checks, &self.nominal, shooter.max_side_spin_rad_s);
        let folder = &self.output.folder;
        checks.require(
            "output.folder",
            !folder.is_empty() && !folder.contains('\0'),
            "the name of a folder",
        );
        checks.errors
    }

    /// The profile at a location.
    ///
    /// # Errors
    /// Settings are out of range, nobody can shoot from there, or no pitch angle is left to search.
    pub fn at(&self, location: Location) -> Result<Profile, ProfileError> {
        let errors = self.errors();
        if !errors.is_empty() {
            return Err(ProfileError::Settings(errors));
        }
        location.check(&self.physics)?;
        self.check_contact_speed(&location)?;
        let height_m = self.shooter.release_height_m - self.physics.hoop_plane_height_m();
        let search = Search::new(&self.search, &self.nominal, location.distance_m, height_m);
        let (low_rad, high_rad) = (search.pitch_min_rad, search.pitch_max_rad);
        if search.choice.includes(NominalVariable::Pitch) && !(low_rad < high_rad) {
            return Err(ProfileError::NoPitch { low_rad, high_rad });
        }
        let mut profile = Profile {
            simulator: Simulator::with_integrator(&self.physics, self.integrator)?,
            settings: self.clone(),
            location,
            search,
            hash: String::new(),
        };
        profile.hash = identity_hash(&profile)?;
        Ok(profile)
    }
}

impl ProfileSettings {
    /// Refuses a ball that the board cannot stop at the speed of the shots from a place.
    fn check_contact_speed(&self, location: &Location) -> Result<(), ProfileError> {
        let physics = &self.physics;
        let least =
            physics.least_speed_to_hoop_m_s(location.distance_m, self.shooter.release_height_m);
        let speed = self.nominal.speed_m_s.unwrap_or(least);
        let most = physics.max_contact_speed_m_s();
        if speed <= most {
            return Ok(());
        }
        Err(ProfileError::PassesThrough {
            speed_m_s: speed,
            most_m_s: most,
        })
    }
}

impl Shooter {
    fn check(&self, checks: &mut SettingChecks) {
        if self.name.chars().count() > LONGEST_NAME {
            let message = format!("must have at most {LONGEST_NAME} characters");
            checks.refuse("shooter.name", message);
        }
        if self.name.chars().any(is_control_or_direction) {
            checks.refuse("shooter.name", "must not contain control characters, or characters that turn the direction of text");
        }
        checks.require(
            "shooter.release_height",
            (0.05..10.0).contains(&self.release_height_m),
            "0.05 m or more and below 10 m, of the ball's centre above the floor",
        );
        for (key, spin) in [
            ("shooter.max_backspin", self.max_backspin_rad_s),
            ("shooter.max_side_spin", self.max_side_spin_rad_s),
        ] {
            let holds = (0.0..=MAX_SPIN_RAD_S).contains(&spin);
            checks.require(key, holds, "0 to 200 rad/s (31.8 rev/s)");
        }
    }
}

fn check_nominal(nominal: &NominalOverrides, checks: &mut SettingChecks) {
    for variable in NominalVariable::ALL {
        let Some(value) = nominal.get(variable) else {
            continue;
        };
        let (holds, allowed) = match variable {
            NominalVariable::Speed => (
                value > 0.0 && value <= MAX_SPEED_M_S,
                "above 0 and at most 40 m/s",
            ),
            NominalVariable::Pitch => (value.abs() <= FRAC_PI_2, "between -90 and 90 deg"),
            NominalVariable::Polar => (value.abs() <= PI, "between -180 and 180 deg"),
            NominalVariable::Backspin | NominalVariable::SideSpin | NominalVariable::RifleSpin => (
                value.abs() <= MAX_SPIN_RAD_S,
                "within 200 rad/s (31.8 rev/s)",
            ),
        };
        checks.require(&format!("nominal.{}", variable.name()), holds, allowed);
    }
}

/// A checked profile: [`ProfileSettings`] at a [`Location`]. It cannot be changed, so it stays
/// valid, and its simulator always has its physics. To change it, change a copy of
/// [`Profile::settings`].
#[derive(Clone, Debug)]
pub struct Profile {
    settings: ProfileSettings,
    location: Location,
    search: Search,
    simulator: Simulator,
    hash: String,
}

impl Serialize for Profile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Fields<'a> {
            shooter: &'a Shooter,
            location: &'a Location,
            nominal: &'a NominalOverrides,
            physics: &'a Physics,
            integrator: Integrator,
            grid: TableGrid,
            search: &'a Search,
            output: &'a OutputSettings,
        }
        Fields {
            shooter: &self.settings.shooter,
            location: &self.location,
            nominal: &self.settings.nominal,
            physics: &self.settings.physics,
            integrator: self.settings.integrator,
            grid: self.settings.grid,
            search: &self.search,
            output: &self.settings.output,
        }
        .serialize(serializer)
    }
}

impl Profile {
    /// The settings of the profile, without the location.
    #[must_use]
    pub fn settings(&self) -> &ProfileSettings {
        &self.settings
    }

    /// The shooter.
    #[must_use]
    pub fn shooter(&self) -> &Shooter {
        &self.settings.shooter
    }

    /// The location on the court.
    #[must_use]
    pub fn location(&self) -> Location {
        self.location
    }

    /// The nominal values that are fixed.
    #[must_use]
    pub fn nominal_overrides(&self) -> &NominalOverrides {
        &self.settings.nominal
    }

    /// The physics.
    #[must_use]
    pub fn physics(&self) -> &Physics {
        &self.settings.physics
    }

    /// The simulator of its physics and integrator.
    #[must_use]
    pub fn simulator(&self) -> &Simulator {
        &self.simulator
    }

    /// Size of the tables.
    #[must_use]
    pub fn grid(&self) -> TableGrid {
        self.settings.grid
    }

    /// The search.
    #[must_use]
    pub fn search(&self) -> &Search {
        &self.search
    }

    /// Where and in which units results are written.
    #[must_use]
    pub fn output(&self) -> &OutputSettings {
        &self.settings.output
    }

    /// BLAKE3 of the checked profile in SI units. Two files with the same meaning have the same
    /// hash.
    #[must_use]
    pub fn hash(&self) -> &str {
        &self.hash
    }

    /// The same profile with changed settings.
    ///
    /// # Errors
    /// As [`ProfileSettings::at`].
    pub fn with(&self, change: impl FnOnce(&mut ProfileSettings)) -> Result<Self, ProfileError> {
        let mut settings = self.settings.clone();
        change(&mut settings);
        Ok(settings.at(self.location)?.counting_with(self))
    }

    /// The same settings at another location.
    ///
    /// # Errors
    /// As [`ProfileSettings::at`].
    pub fn moved_to(&self, location: Location) -> Result<Self, ProfileError> {
        Ok(self.settings.at(location)?.counting_with(self))
    }

    /// The same profile, its shots counted with those of another.
    fn counting_with(self, other: &Self) -> Self {
        Self {
            simulator: self.simulator.counting_with(&other.simulator),
            ..self
        }
    }

    /// The same profile, its shots counted apart.
    pub(crate) fn counting_apart(&self) -> Self {
        Self {
            simulator: self.simulator.clone().counting_apart(),
            ..self.clone()
        }
    }

    /// The same profile with its batches on other vector instructions. No result depends on them.
    #[must_use]
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.simulator = self.simulator.with_instructions(instructions);
        self
    }

    /// Height of the release above the plane of the hoop (negative below), m.
    #[must_use]
    pub fn height_above_hoop_m(&self) -> f64 {
        self.settings.shooter.release_height_m - self.settings.physics.hoop_plane_height_m()
    }

    /// Least and largest nominal backspin, rad/s.
    #[must_use]
    pub fn backspin_range_rad_s(&self) -> (f64, f64) {
        if self.search.choice.includes(NominalVariable::Backspin) {
            (0.0, self.settings.shooter.max_backspin_rad_s)
        } else {
            let fixed = self.fixed_nominal().backspin_rad_s;
            (fixed, fixed)
        }
    }

    /// The shot of the `[nominal]` table. A value that it does not give is 0, and the polar angle
    /// is that towards the hoop.
    #[must_use]
    pub fn fixed_nominal(&self) -> Nominal {
        let given = &self.settings.nominal;
        Nominal {
            speed_m_s: given.speed_m_s.unwrap_or(0.0),
            pitch_rad: given.pitch_rad.unwrap_or(0.0),
            polar_rad: given.polar_rad.unwrap_or(self.location.angle_rad),
            backspin_rad_s: given.backspin_rad_s.unwrap_or(0.0),
            rifle_spin_rad_s: given.rifle_spin_rad_s.unwrap_or(0.0),
            side_spin_rad_s: given.side_spin_rad_s.unwrap_or(0.0),
        }
    }

    /// The release of a nominal shot from the location, without errors.
    #[must_use]
    pub fn release(&self, nominal: &Nominal) -> Release {
        Release {
            distance_m: self.location.distance_m,
            court_angle_rad: self.location.angle_rad,
            height_above_hoop_m: self.height_above_hoop_m(),
            speed_m_s: nominal.speed_m_s,
            pitch_rad: nominal.pitch_rad,
            polar_rad: nominal.polar_rad,
            backspin_rad_s: nominal.backspin_rad_s,
            rifle_spin_rad_s: nominal.rifle_spin_rad_s,
            side_spin_rad_s: nominal.side_spin_rad_s,
        }
    }
}
