//! The profile of a command and its place: from the flags, then from the profile's table
//! `[location]`.

use super::failure::Failure;
use super::loaded_profile::{LoadedProfile, set, table_mut};
use super::value_parsers::{PhysicsArg, UnitsArg};
use crate::model::Physics;
use crate::model::league_courts::League;
use crate::model::named_places::{place_named, place_names_in_words};
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

/// The court of a flag.
pub(crate) fn court(text: &str) -> Result<League, String> {
    let names: Vec<&str> = League::ALL.iter().map(|league| league.name()).collect();
    League::from_name(text).ok_or_else(|| format!("must be one of {}", names.join(", ")))
}

/// The place with a name, on a court or on that of the physics.
pub(crate) fn location_named(
    name: &str,
    court: Option<League>,
    physics: &Physics,
) -> Result<Location, Failure> {
    let league = court.unwrap_or_else(|| League::of_physics(physics));
    let place = place_named(name, league).ok_or_else(|| {
        Failure::usage(format!(
            "--at '{name}': is no place; the places are {}",
            place_names_in_words()
        ))
    })?;
    let location = Location::from_xy(place.x_m, place.y_m);
    location
        .check(physics)
        .map_err(|error| Failure::usage(format!("--at '{name}': {error}")))?;
    Ok(location)
}

/// The flags of a place. Each overrides the profile's `[location]` table.
#[derive(Args, Debug)]
pub(crate) struct PlaceOptions {
    /// A place by its name, such as 'left elbow', 'free throw' or 'right corner three'
    /// (docs/places.md has all).
    #[arg(long, value_name = "PLACE", conflicts_with_all = ["distance", "angle"])]
    at: Option<String>,
    /// The court of --at: ncaa, nba, fiba or high_school [default: that of the physics, else ncaa].
    #[arg(long, value_name = "COURT", requires = "at", value_parser = court)]
    court: Option<League>,
    /// Distance from the hoop's centre, such as '12 ft' [default: the profile's].
    #[arg(long, allow_hyphen_values = true)]
    distance: Option<String>,
    /// Court angle: 0 deg is straight in front, '30 deg' to the right [default: the profile's].
    #[arg(long, allow_hyphen_values = true)]
    angle: Option<String>,
}

impl PlaceOptions {
    pub(crate) fn is_given(&self) -> bool {
        self.distance.is_some() || self.angle.is_some() || self.at.is_some()
    }

    /// The profile at this place.
    pub(crate) fn moved(&self, profile: Profile) -> Result<Profile, Failure> {
        if !self.is_given() {
            return Ok(profile);
        }
        if let Some(name) = &self.at {
            return Ok(profile.moved_to(location_named(name, self.court, profile.physics())?)?);
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
        if let Some(name) = &self.at {
            let flags = format!("--at '{name}'");
            return loaded.edited(&flags, |document| {
                document.remove("location");
                let location = table_mut(document, "location");
                set(location, "place", name.as_str());
                if let Some(court) = self.court {
                    set(location, "court", court.name());
                }
                Ok(())
            });
        }
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
