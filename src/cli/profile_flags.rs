//! The profile of a command and its place: from the flags, then from the profile's table
//! `[location]`.

use super::failure::Failure;
use super::loaded_profile::{LoadedProfile, set, table_mut};
use super::value_parsers::{PhysicsArg, UnitsArg};
use crate::shooter::{Location, NominalVariable, Profile};
use crate::units::{self, Dimension};
use clap::Args;
use std::path::PathBuf;

/// The profile of a command, and where and under what it is taken.
#[derive(Args, Debug)]
pub(crate) struct ProfileOptions {
    /// The shooter's profile, or the folder of a fit.
    #[arg(value_name = "PROFILE")]
    pub(crate) path: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    #[command(flatten)]
    pub(crate) place: PlaceOptions,
    /// Units of the answer [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
}

impl ProfileOptions {
    /// Reads the profile, at its place. `fixed` are nominal values that the command itself fixes.
    pub(crate) fn load(&self, fixed: &[NominalVariable]) -> Result<LoadedProfile, Failure> {
        let loaded = LoadedProfile::read_and_warn(&self.path, &self.physics, fixed)?;
        self.place.changed(loaded)?.in_units(self.units)
    }
}

/// The flags of a place. Each overrides the profile's `[location]` table.
#[derive(Args, Debug)]
pub(crate) struct PlaceOptions {
    /// Distance from the hoop's centre, such as '12 ft' [default: the profile's].
    #[arg(long, allow_hyphen_values = true)]
    distance: Option<String>,
    /// Court angle: 0 deg is straight in front, '30 deg' to the right [default: the profile's].
    #[arg(long, allow_hyphen_values = true)]
    angle: Option<String>,
}

impl PlaceOptions {
    pub(crate) fn is_given(&self) -> bool {
        self.distance.is_some() || self.angle.is_some()
    }

    /// The profile at this place.
    pub(crate) fn moved(&self, profile: Profile) -> Result<Profile, Failure> {
        if !self.is_given() {
            return Ok(profile);
        }
        let value = |flag: &str, text: &Option<String>, dimension, own: f64| match text {
            None => Ok(own),
            Some(text) => units::parse(text, dimension)
                .map_err(|error| Failure::usage(format!("--{flag}: {error}"))),
        };
        let own = profile.location();
        let place = Location {
            distance_m: value(
                "distance",
                &self.distance,
                Dimension::Length,
                own.distance_m,
            )?,
            angle_rad: value("angle", &self.angle, Dimension::Angle, own.angle_rad)?,
        };
        place.check(profile.physics()).map_err(|error| {
            let given = if self.distance.is_some() {
                "distance"
            } else {
                "angle"
            };
            Failure::usage(format!("--{given}: {error}"))
        })?;
        Ok(profile.moved_to(place)?)
    }

    /// The profile at this place, and its text with it. What a flag gives stands as it was written,
    /// so that it is read as the same number.
    pub(crate) fn changed(&self, loaded: LoadedProfile) -> Result<LoadedProfile, Failure> {
        if !self.is_given() {
            return Ok(loaded);
        }
        // A message about a value names its flag.
        self.moved(loaded.profile.clone())?;
        let given = [("distance", &self.distance), ("angle", &self.angle)];
        let given = given.map(|(name, text)| Some((name, text.as_deref()?)));
        let flags: Vec<String> = given
            .iter()
            .flatten()
            .map(|(name, text)| format!("--{name} '{text}'"))
            .collect();
        loaded.edited(&flags.join(" "), |document| {
            for (name, text) in given.into_iter().flatten() {
                set(table_mut(document, "location"), name, text);
            }
            Ok(())
        })
    }
}
