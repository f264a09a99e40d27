//! Values of a nominal shot that a command's flags take out of its search.

use super::changed_profile_text::rewritten;
use super::failure::Failure;
use crate::shooter::{NominalVariable, Profile};
use crate::units::{self, DEGREE_RAD, REV_RAD};
use clap::Args;

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

    /// The text of a profile in which these values are fixed. A value stands as it was written, so
    /// that it is read as the same number.
    pub(crate) fn profile_text(&self, profile: &Profile, text: &str) -> Result<String, Failure> {
        let fixed = self.variables();
        let refuse = |error: String| Failure::usage(format!("the profile: {error}"));
        let parsed = text.parse::<toml::Table>();
        let mut root = parsed.map_err(|error| refuse(error.to_string()))?;
        let mut set = |table: &str, key: &str, value: toml::Value| {
            let table = root
                .entry(table)
                .or_insert_with(|| toml::Table::new().into());
            if let Some(table) = table.as_table_mut() {
                table.insert(key.to_owned(), value);
            }
        };
        for (variable, text) in self.given() {
            set("nominal", variable.name(), text.into());
        }
        let chosen: Vec<toml::Value> = profile
            .search()
            .choice
            .iter()
            .filter(|chosen| !fixed.contains(chosen))
            .map(|chosen| chosen.name().into())
            .collect();
        set("search", "choose", chosen.into());
        let flags: String = self
            .given()
            .map(|(variable, text)| format!(" --{} '{text}'", variable.name()))
            .collect();
        rewritten(text, &root, &flags)
    }
}
