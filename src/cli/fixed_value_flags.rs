//! Values of a nominal shot that a command's flags take out of its search.

use super::failure::Failure;
use super::loaded_profile::{LoadedProfile, set, table_mut};
use crate::shooter::{NominalVariable, Profile};
use crate::units::{self, DEGREE_RAD, REV_RAD};
use clap::Args;
use toml_edit::Array;

/// The flags of what is fixed.
#[derive(Args, Debug)]
pub(crate) struct FixedOptions {
    /// Fix the speed.
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true)]
    speed: Option<String>,
    /// Fix the pitch angle.
    #[arg(long, value_name = "ANGLE", allow_hyphen_values = true)]
    pitch: Option<String>,
    /// Fix the backspin.
    #[arg(long, value_name = "SPIN", allow_hyphen_values = true)]
    backspin: Option<String>,
}

impl FixedOptions {
    /// The backspin alone may be given.
    pub(crate) fn of_backspin(backspin: Option<String>) -> Self {
        Self {
            speed: None,
            pitch: None,
            backspin,
        }
    }

    /// What is fixed, as it was written.
    fn given(&self) -> impl Iterator<Item = (NominalVariable, &str)> {
        [
            (NominalVariable::Speed, &self.speed),
            (NominalVariable::Pitch, &self.pitch),
            (NominalVariable::Backspin, &self.backspin),
        ]
        .into_iter()
        .filter_map(|(variable, text)| Some((variable, text.as_deref()?)))
    }

    /// The variables that are fixed.
    pub(crate) fn variables(&self) -> Vec<NominalVariable> {
        self.given().map(|(variable, _)| variable).collect()
    }

    /// The variables that are fixed, with their checked values in SI.
    pub(crate) fn values(&self, profile: &Profile) -> Result<Vec<(NominalVariable, f64)>, Failure> {
        let checked = |(variable, text): (NominalVariable, &str)| {
            let value = units::parse(text, variable.dimension())
                .map_err(|error| Failure::usage(format!("--{}: {error}", variable.name())))?;
            if variable == NominalVariable::Pitch
                && !(DEGREE_RAD..=89.0 * DEGREE_RAD).contains(&value)
            {
                return Err(Failure::usage(format!(
                    "--pitch: must be from 1 to 89 deg, not '{text}'"
                )));
            }
            let search = &profile.settings().search;
            let beyond = match variable {
                NominalVariable::Speed => search.speed_beyond_limit(value),
                NominalVariable::Pitch => search.pitch_beyond_limits(value),
                _ => None,
            };
            if let Some(words) = beyond {
                let flag = variable.name();
                return Err(Failure::usage(format!("--{flag}: \"{text}\" {words}")));
            }
            let most = profile.shooter().max_backspin_rad_s;
            if variable == NominalVariable::Backspin && value > most {
                return Err(Failure::usage(format!(
                    "--backspin: \"{text}\" is more than shooter.max_backspin ({:.3} rev/s)",
                    most / REV_RAD
                )));
            }
            Ok((variable, value))
        };
        self.given().map(checked).collect()
    }

    /// The profile in which these values are fixed. A value stands as it was written, so that it is
    /// read as the same number.
    pub(crate) fn changed(&self, loaded: LoadedProfile) -> Result<LoadedProfile, Failure> {
        let fixed = self.variables();
        // A message about a value names its flag.
        if self.values(&loaded.profile)?.is_empty() {
            return Ok(loaded);
        }
        let choice = loaded.profile.search().choice.iter();
        let chosen: Array = choice
            .filter(|chosen| !fixed.contains(chosen))
            .map(NominalVariable::name)
            .collect();
        let flags: Vec<String> = self
            .given()
            .map(|(variable, text)| format!("--{} '{text}'", variable.name()))
            .collect();
        loaded.edited(&flags.join(" "), |document| {
            for (variable, text) in self.given() {
                set(table_mut(document, "nominal"), variable.name(), text);
            }
            set(table_mut(document, "search"), "choose", chosen);
            Ok(())
        })
    }
}
