//! Errors of a profile that a flag makes smaller or greater.

use super::failure::Failure;
use super::loaded_profile::{LoadedProfile, set, table_mut};
use crate::units::{self, Dimension, rounded};
use clap::Args;
use toml_edit::{Item, Value};

/// The flag of changed errors.
#[derive(Args, Debug)]
pub(crate) struct ScatterOptions {
    /// Change the scatter of the profile, such as 'speed=-20%' (20 % less): speed, pitch, polar
    /// or backspin; may be repeated.
    #[arg(long, value_name = "ERROR=PERCENT")]
    pub(crate) scatter: Vec<String>,
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
    /// The profile with changed errors, each in the unit that it is written in.
    pub(crate) fn changed(&self, loaded: LoadedProfile) -> Result<LoadedProfile, Failure> {
        let mut factors: Vec<(usize, f64)> = Vec::new();
        for text in &self.scatter {
            let (number, factor) = error_and_factor(text)?;
            if factors.iter().any(|(other, _)| *other == number) {
                let name = ERRORS[number].0;
                return Err(Failure::usage(format!("--scatter: {name} is given twice")));
            }
            factors.push((number, factor));
        }
        if factors.is_empty() {
            return Ok(loaded);
        }
        let flags = self.scatter.iter();
        let flags: Vec<String> = flags.map(|text| format!("--scatter '{text}'")).collect();
        loaded.edited(&flags.join(" "), |document| {
            let errors = table_mut(document, "shooter").get_mut("errors");
            let errors = errors
                .and_then(Item::as_table_like_mut)
                .ok_or_else(|| Failure::usage("the profile: has no table [shooter.errors]"))?;
            for (number, factor) in factors {
                for key in ERRORS[number].1 {
                    if let Some(value) = errors.get(key).and_then(|item| scaled(item, factor)) {
                        set(errors, key, value);
                    }
                }
            }
            Ok(())
        })
    }
}

/// A value such as `0.25 ft/s` or `0.03`, scaled in its unit.
fn scaled(item: &Item, factor: f64) -> Option<Value> {
    let scaled = |value: f64| rounded(factor * value);
    Some(match item.as_value()? {
        Value::String(text) => {
            let text = text.value().trim();
            let ends = (0..=text.len()).filter(|end| text.is_char_boundary(*end));
            let mut number = ends.filter_map(|end| Some((text[..end].parse().ok()?, &text[end..])));
            let (number, unit): (f64, &str) = number.next_back()?;
            format!("{}{unit}", scaled(number)).into()
        }
        Value::Integer(number) => scaled(*number.value() as f64).into(),
        Value::Float(number) => scaled(*number.value()).into(),
        _ => return None,
    })
}

/// The place in [`ERRORS`] and the factor of `speed=-20%`.
fn error_and_factor(text: &str) -> Result<(usize, f64), Failure> {
    let refuse = |what: &str| {
        Failure::usage(format!(
            "--scatter: '{text}' {what}; write one of speed, pitch, polar and backspin with a change from -100 % to {MOST_PERCENT} %, such as 'speed=-20%' for 20 % less"
        ))
    };
    let (name, percent) = text.split_once('=').ok_or_else(|| refuse("has no ="))?;
    let number = ERRORS.iter().position(|(error, _)| *error == name.trim());
    let number = number.ok_or_else(|| refuse("is none of the four"))?;
    let percent = percent.trim();
    if !units::PERCENT.iter().any(|unit| percent.ends_with(unit)) {
        return Err(refuse("has no % sign"));
    }
    let share = units::parse(percent.trim_start_matches('+'), Dimension::Number)
        .map_err(|_| refuse("has no number of percent"))?;
    if !(-1.0..=MOST_PERCENT / 100.0).contains(&share) {
        return Err(refuse("is out of range"));
    }
    Ok((number, 1.0 + share))
}
