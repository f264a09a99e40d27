//! Answers as JSON: in the units of results, with the unit in each name.
//!
//! An answer is in SI units and its fields say so: `speed_m_s`, `pitch_rad`, `backspin_rad_s`. What
//! is written has `speed_ft_s`, `pitch_deg`, `backspin_rev_s`: name and value are changed together,
//! here and nowhere else. A length that people measure in inches or centimetres ends in `_short_m`.
//! An object with a `unit` has its numbers in that unit, and is changed as a whole.

use crate::model::{Physics, Preset};
use crate::shooter::Profile;
use crate::store::sealed::FORMAT_VERSION;
use crate::units::{Dimension, UnitName, UnitSystem, rounded};
use serde::{Deserialize, Serialize, Serializer};
use serde_json::{Map, Number, Value};

/// The answer to a question.
pub trait Answer: Serialize {
    /// The name of the question, such as `best_shots`.
    const NAME: &'static str;
    /// Whether it is printed in SI units.
    const IS_SI: bool = false;
}

/// The program, its version and commit, and what was computed: every answer carries them.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Provenance {
    /// `bankshot`.
    pub program: &'static str,
    /// Its version.
    pub version: &'static str,
    /// Its commit.
    pub commit: &'static str,
    /// BLAKE3 of the profile in SI units.
    pub configuration_blake3: String,
    /// The preset of the physics; `changed` where a value is another.
    pub physics_preset: &'static str,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Provenance {
    /// That of a profile.
    #[must_use]
    pub fn of(profile: &Profile) -> Self {
        let seed = profile.search().seed;
        Self::new(profile.hash(), profile.physics(), seed)
    }

    /// That of a configuration with this hash.
    #[must_use]
    pub fn new(hash: &str, physics: &Physics, seed: u64) -> Self {
        Self {
            program: "bankshot",
            version: env!("CARGO_PKG_VERSION"),
            commit: env!("BANKSHOT_COMMIT"),
            configuration_blake3: hash.to_owned(),
            physics_preset: Preset::of(physics).map_or("changed", |preset| preset.name),
            seed,
        }
    }
}

/// Values with names that are not known before, in order: a JSON object.
#[derive(Clone, Debug, PartialEq)]
pub struct Named<T>(pub Vec<(String, T)>);

impl<T: Serialize> Serialize for Named<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

/// What a name ends in, in SI units.
const SUFFIXES: [(&str, Option<Dimension>); 6] = [
    ("_m_s", Some(Dimension::Speed)),
    ("_rad_s", Some(Dimension::Spin)),
    ("_s_m", Some(Dimension::PerSpeed)),
    ("_short_m", None),
    ("_rad", Some(Dimension::Angle)),
    ("_m", Some(Dimension::Length)),
];

/// The name of a quantity with its SI unit, such as `speed_m_s`.
#[must_use]
pub fn si_name(name: &str, dimension: Dimension) -> String {
    let mut suffixes = SUFFIXES.iter();
    let found = suffixes.find(|(_, of)| *of == Some(dimension));
    format!("{name}{}", found.map_or("", |(suffix, _)| suffix))
}

#[cfg(test)]
impl<T: schemars::JsonSchema> schemars::JsonSchema for Named<T> {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("Named_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        std::collections::BTreeMap::<String, T>::json_schema(generator)
    }
}

/// A name in the units of results, and the size of its unit in SI units; `None` for a name without
/// a unit that changes.
pub(super) fn in_results(name: &str, units: UnitSystem) -> Option<(String, f64)> {
    let mut suffixes = SUFFIXES.iter();
    suffixes.find_map(|(suffix, dimension)| {
        let words = name.strip_suffix(suffix)?;
        let (unit, size) = match dimension {
            Some(dimension) => {
                let unit = units.unit(*dimension);
                (unit.suffix, unit.size)
            }
            None => units.short_length(),
        };
        Some((format!("{words}_{unit}"), size))
    })
}

/// An answer in SI units, as it is.
#[must_use]
pub fn in_si(answer: &impl Serialize) -> Value {
    serde_json::to_value(answer).unwrap_or_default()
}

/// An answer in the units of results, its numbers with 12 significant digits.
#[must_use]
pub fn in_units(answer: &impl Serialize, units: UnitSystem) -> Value {
    convert(serde_json::to_value(answer).unwrap_or_default(), units, 1.0)
}

fn convert(value: Value, units: UnitSystem, size: f64) -> Value {
    match value {
        Value::Number(number) if number.is_f64() => {
            let value = rounded(number.as_f64().unwrap_or(f64::NAN) / size);
            Number::from_f64(value).map_or(Value::Null, Value::Number)
        }
        Value::Array(list) => list
            .into_iter()
            .map(|value| convert(value, units, size))
            .collect(),
        Value::Object(mut object) => {
            let own: Option<UnitName> = object
                .get("unit")
                .and_then(|unit| UnitName::deserialize(unit).ok());
            let size = own.map_or(size, |own| {
                let unit = own.in_results(units);
                object.insert("unit".to_owned(), in_si(&unit));
                unit.size() / own.size()
            });
            let named = object.into_iter().map(|(name, value)| {
                let (name, size) = in_results(&name, units).unwrap_or((name, size));
                (name, convert(value, units, size))
            });
            Value::Object(named.collect::<Map<_, _>>())
        }
        other => other,
    }
}

/// An answer with its name and the version of its format, in the units of results (or in SI
/// units, where it says so).
#[must_use]
pub fn document<A: Answer>(answer: &A, units: UnitSystem) -> Value {
    let answer = match A::IS_SI {
        true => in_si(answer),
        false => in_units(answer, units),
    };
    let mut document = Map::new();
    document.insert("answer".to_owned(), A::NAME.into());
    document.insert("format_version".to_owned(), FORMAT_VERSION.into());
    if let Value::Object(fields) = answer {
        document.extend(fields);
    }
    document.into()
}

/// The text of a JSON answer.
#[must_use]
pub fn text(value: &Value) -> String {
    format!("{value:#}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn contract_name_and_value_change_their_unit_together() {
        let answer = json!({
            "speed_m_s": 3.048, "usual": { "pitch_rad": std::f64::consts::PI, "shots": 60 },
            "depth_short_m": 0.0254, "window": { "polar_rad": [0.0, null] },
            "spread_m": { "mean": 0.3048, "sd": 0.0 }, "flight_time_s": 1.5, "name": "x_m",
            "drift": { "unit": "cm", "value": 2.54, "shots": 3 },
        });
        let imperial = json!({
            "speed_ft_s": 10.0, "usual": { "pitch_deg": 180.0, "shots": 60 },
            "depth_in": 1.0, "window": { "polar_deg": [0.0, null] },
            "spread_ft": { "mean": 1.0, "sd": 0.0 }, "flight_time_s": 1.5, "name": "x_m",
            "drift": { "unit": "in", "value": 1.0, "shots": 3 },
        });
        assert_eq!(in_units(&answer, UnitSystem::Imperial), imperial);
        let metric = in_units(&answer, UnitSystem::Metric);
        assert_eq!(metric["speed_m_s"], 3.048);
        assert_eq!(metric["depth_cm"], 2.54);
    }
}
