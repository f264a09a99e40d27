//! Errors of a profile that a flag makes smaller or greater.

use super::changed_profile_text::rewritten;
use super::failure::Failure;
use crate::config::parse_profile;
use crate::shooter::{Profile, ReleaseDispersion};
use crate::units::{self, Dimension};
use clap::Args;
use std::path::Path;

/// The flag of changed errors.
#[derive(Args, Debug)]
pub(crate) struct ScatterOptions {
    /// Make an error of the profile smaller or greater, such as 'speed=-20%': speed, pitch, polar
    /// or backspin; may be repeated.
    #[arg(long, value_name = "ERROR=PERCENT")]
    scatter: Vec<String>,
}

/// The errors that can be changed, with their keys in a profile.
const ERRORS: [(&str, &[&str]); 4] = [
    ("speed", &["speed", "c10", "c11", "c12"]),
    ("pitch", &["pitch", "c20"]),
    ("polar", &["polar", "c30"]),
    ("backspin", &["backspin", "c40", "c41", "c42"]),
];
/// The greatest change, in percent.
const MOST_PERCENT: f64 = 900.0;

impl ScatterOptions {
    /// That errors are not those of the profile, a line; empty where they are.
    pub(crate) fn in_words(&self) -> String {
        match &self.scatter[..] {
            [] => String::new(),
            changed => format!(
                "The scatter is not that of the profile: --scatter {}.\n",
                changed.join(" --scatter ")
            ),
        }
    }

    /// A profile with changed errors, and its text with them.
    pub(crate) fn changed(
        &self,
        (profile, text): (Profile, String),
        origin: &Path,
    ) -> Result<(Profile, String), Failure> {
        if self.scatter.is_empty() {
            return Ok((profile, text));
        }
        let refuse = |error: String| Failure::usage(format!("the profile: {error}"));
        let parsed = text.parse::<toml::Table>();
        let mut root = parsed.map_err(|error| refuse(error.to_string()))?;
        let errors = root
            .get_mut("shooter")
            .and_then(|shooter| shooter.get_mut("errors"))
            .and_then(toml::Value::as_table_mut)
            .ok_or_else(|| refuse("has no table [shooter.errors]".to_owned()))?;
        let mut named: Vec<usize> = Vec::new();
        for text in &self.scatter {
            let (number, factor) = error_and_factor(text)?;
            if named.contains(&number) {
                let name = ERRORS[number].0;
                return Err(Failure::usage(format!("--scatter: {name} is given twice")));
            }
            named.push(number);
            for key in ERRORS[number].1 {
                errors.remove(*key);
            }
            for (key, value) in scaled(number, factor, &profile.shooter().dispersion) {
                errors.insert(key.to_owned(), value);
            }
        }
        let flags: String = self
            .scatter
            .iter()
            .map(|text| format!(" --scatter '{text}'"))
            .collect();
        let text = rewritten(&text, &root, &flags)?;
        let profile = parse_profile(&text, &format!("{} as changed", origin.display()))?;
        Ok((profile, text))
    }
}

/// The place in [`ERRORS`] and the factor of `speed=-20%`.
fn error_and_factor(text: &str) -> Result<(usize, f64), Failure> {
    let refuse = |what: &str| {
        Failure::usage(format!(
            "--scatter: '{text}' {what}; write speed, pitch, polar or backspin, = and a change from -100 to {MOST_PERCENT} %, as in 'speed=-20%'"
        ))
    };
    let (name, percent) = text.split_once('=').ok_or_else(|| refuse("has no ="))?;
    let number = ERRORS.iter().position(|(error, _)| *error == name.trim());
    let number = number.ok_or_else(|| refuse("is none of the four"))?;
    let percent = percent.trim();
    if !units::PERCENT.iter().any(|unit| percent.ends_with(unit)) {
        return Err(refuse("is not in percent"));
    }
    let share = units::parse(percent.trim_start_matches('+'), Dimension::Number)
        .map_err(|_| refuse("has no number of percent"))?;
    if !(-1.0..=MOST_PERCENT / 100.0).contains(&share) {
        return Err(refuse("is out of range"));
    }
    Ok((number, 1.0 + share))
}

/// The keys of an error, scaled.
fn scaled(
    number: usize,
    factor: f64,
    dispersion: &ReleaseDispersion,
) -> Vec<(&'static str, toml::Value)> {
    let with = |value: f64, unit: &str| toml::Value::from(format!("{} {unit}", factor * value));
    let bare = |value: f64| toml::Value::from(factor * value);
    match number {
        0 => vec![
            ("c10", with(dispersion.c10_m_s, "m/s")),
            ("c11", bare(dispersion.c11)),
            ("c12", with(dispersion.c12_s_m, "s/m")),
        ],
        1 => vec![("c20", with(dispersion.c20_rad, "rad"))],
        2 => vec![("c30", with(dispersion.c30_rad, "rad"))],
        _ => vec![
            ("c40", with(dispersion.c40_rad_s, "rad/s")),
            ("c41", bare(dispersion.c41)),
            ("c42", with(dispersion.c42_s_rad, "s/rad")),
        ],
    }
}
