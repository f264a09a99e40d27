//! Reads TOML tables key by key. It collects the errors instead of stopping at the first.

use super::diagnostics::{ConfigError, Diagnostic, Problem};
use crate::units::{Dimension, PERCENT, meant_by, parse};
use std::collections::HashSet;
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Known keys are listed up to this number.
const MOST_KNOWN_NAMES: usize = 40;

/// Two names of one key: the paper's and the plain one, which messages use.
const PLAIN_NAMES: [(&str, &str); 4] = [
    ("c10", "speed"),
    ("c20", "pitch"),
    ("c30", "polar"),
    ("c40", "backspin"),
];

/// What a plain name gives too, where it is written in percent.
const GROWTHS: [(&str, &str); 2] = [("c11", "speed"), ("c41", "backspin")];

/// Words that others use for a key.
const OTHER_WORDS: [(&str, &str); 17] = [
    ("left_right", "polar"),
    ("leftright", "polar"),
    ("aim", "polar"),
    ("yaw", "polar"),
    ("direction", "polar"),
    ("azimuth", "polar"),
    ("angle", "pitch"),
    ("launch_angle", "pitch"),
    ("elevation", "pitch"),
    ("max_pitch", "pitch_max"),
    ("min_pitch", "pitch_min"),
    ("max_speed", "speed_max"),
    ("top_speed", "speed_max"),
    ("backspin_max", "max_backspin"),
    ("spin", "backspin"),
    ("height", "release_height"),
    ("drag", "drag_coefficient"),
];

/// A table that is being read. A key that is never asked for is reported as unknown.
#[derive(Clone)]
pub(crate) struct TableReader<'t, 'i> {
    path: String,
    table: Option<&'t DeTable<'i>>,
    span: Range<usize>,
    asked: Vec<&'static str>,
}

/// Parses a TOML text, then reads it with `read`, which adds what is wrong to the diagnostics.
///
/// # Errors
/// All diagnostics at once. If the syntax is wrong, only those of the syntax.
pub(crate) fn parse_toml<T>(
    text: &str,
    origin: &str,
    read: impl FnOnce(TableReader<'_, '_>, &mut Vec<Diagnostic>) -> Option<T>,
) -> Result<T, ConfigError> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut diagnostics: Vec<Diagnostic> = errors
        .into_iter()
        .map(|error| Diagnostic {
            span: error.span().unwrap_or(0..0),
            key: String::new(),
            message: format!("not TOML: {}", error.message()),
            problem: Problem::Other,
        })
        .collect();
    let syntax_is_valid = diagnostics.is_empty();
    let value = read(TableReader::root(&table), &mut diagnostics);
    match value {
        Some(value) if diagnostics.is_empty() => Ok(value),
        _ => {
            if !syntax_is_valid {
                // Errors that follow from a wrong syntax would only confuse.
                diagnostics.retain(|diagnostic| diagnostic.key.is_empty());
            }
            diagnostics.sort_by_key(|diagnostic| diagnostic.span.start);
            Err(ConfigError {
                origin: origin.to_owned(),
                text: text.to_owned(),
                diagnostics,
            })
        }
    }
}

impl<'t, 'i> TableReader<'t, 'i> {
    pub(crate) fn root(table: &'t Spanned<DeTable<'i>>) -> Self {
        Self {
            path: String::new(),
            table: Some(table.get_ref()),
            span: 0..0,
            asked: Vec::new(),
        }
    }

    /// The full name of a key of this table, such as `shooter.errors.c10`.
    fn full_name(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    /// Whether the key is given.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.table.is_some_and(|table| table.contains_key(key))
    }

    fn get(&mut self, key: &'static str) -> Option<&'t Spanned<DeValue<'i>>> {
        self.asked.push(key);
        self.table.and_then(|table| table.get(key))
    }

    /// A diagnostic of one key, or of the whole table if the key is not given.
    pub(crate) fn diagnostic(&self, key: &str, message: impl Into<String>) -> Diagnostic {
        let span = self
            .table
            .and_then(|table| table.get(key))
            .map_or_else(|| self.span.clone(), Spanned::span);
        Diagnostic {
            span,
            key: self.full_name(key),
            message: message.into(),
            problem: Problem::Other,
        }
    }

    /// A diagnostic of the whole table.
    pub(crate) fn table_diagnostic(&self, message: impl Into<String>) -> Diagnostic {
        Diagnostic {
            span: self.span.clone(),
            key: self.path.clone(),
            message: message.into(),
            problem: Problem::Other,
        }
    }

    /// A dotted key below this table with the names that the file uses, and its place: that of the
    /// deepest part of it that is given.
    pub(crate) fn as_written(&self, dotted_key: &str) -> (String, Range<usize>) {
        let mut span = self.span.clone();
        let mut table = self.table;
        let mut names: Vec<&str> = dotted_key.split('.').collect();
        for name in &mut names {
            let plain = PLAIN_NAMES.iter().chain(&GROWTHS);
            let plain = plain.clone().find(|(other, _)| other == name);
            let found = table.and_then(|table| {
                let value = table.get(*name).map(|value| (*name, value));
                value.or_else(|| Some((plain?.1, table.get(plain?.1)?)))
            });
            let Some((written, value)) = found else {
                break;
            };
            *name = written;
            span = value.span();
            table = match value.get_ref() {
                DeValue::Table(inner) => Some(inner),
                _ => None,
            };
        }
        (names.join("."), span)
    }

    /// The table under `key`; an empty one if it is not given.
    pub(crate) fn table(
        &mut self,
        key: &'static str,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> TableReader<'t, 'i> {
        let found = self.get(key);
        let path = self.full_name(key);
        let reader = |table, span| TableReader {
            path,
            table,
            span,
            asked: Vec::new(),
        };
        match found.map(|value| (value.get_ref(), value.span())) {
            Some((DeValue::Table(table), span)) => reader(Some(table), span),
            Some((_, span)) => {
                diagnostics.push(self.diagnostic(key, "must be a table, such as [shooter]"));
                reader(None, span)
            }
            None => reader(None, self.span.clone()),
        }
    }

    /// A quantity in SI units, if it is given.
    pub(crate) fn quantity(
        &mut self,
        key: &'static str,
        dimension: Dimension,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<f64> {
        let value = self.get(key)?;
        let number = match value.get_ref() {
            DeValue::String(text) => match parse(text, dimension) {
                Ok(value) => return Some(value),
                Err(error) => {
                    let problem = match error.is_of_writing() {
                        true => Problem::Writing,
                        false => Problem::Other,
                    };
                    diagnostics.push(self.diagnostic(key, error.to_string()).of(problem));
                    return None;
                }
            },
            DeValue::Integer(number) => number.as_str().replace('_', "").parse::<f64>().ok(),
            DeValue::Float(number) => number.as_str().replace('_', "").parse::<f64>().ok(),
            _ => None,
        };
        let (problem, message) = match number {
            Some(number) if dimension == Dimension::Number && number.is_finite() => {
                return Some(number);
            }
            Some(_) if dimension == Dimension::Number => {
                (Problem::Other, "must be a finite number".to_owned())
            }
            Some(number) => {
                let units = dimension.unit_names();
                let example = dimension.units().first().map_or("", |(name, _)| name);
                // Of a length in metres feet are no example, and a number is not guessed to be one.
                let example = match dimension {
                    Dimension::Length => "\"7 ft\" or \"2.1 m\"".to_owned(),
                    Dimension::Speed => "\"24 ft/s\" or \"7.3 m/s\"".to_owned(),
                    _ => format!("\"{number} {example}\""),
                };
                let message =
                    format!("has no unit; write it as text with one of {units}, such as {example}");
                (Problem::Writing, message)
            }
            None => {
                let message = "must be a number, or a text with a number and a unit";
                (Problem::Other, message.to_owned())
            }
        };
        diagnostics.push(self.diagnostic(key, message).of(problem));
        None
    }

    /// A quantity that must be given.
    pub(crate) fn required(
        &mut self,
        key: &'static str,
        dimension: Dimension,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<f64> {
        if !self.has(key) {
            self.asked.push(key);
            let example = dimension.units().first().map_or("", |(name, _)| name);
            let message = format!("is missing; write {key} = \"... {example}\"");
            diagnostics.push(self.diagnostic(key, message).of(Problem::Missing));
            return None;
        }
        self.quantity(key, dimension, diagnostics)
    }

    /// A quantity that must be given under one of two names.
    pub(crate) fn required_as(
        &mut self,
        [key, other]: [&'static str; 2],
        dimension: Dimension,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<f64> {
        self.asked.extend([key, other]);
        match (self.has(key), self.has(other)) {
            (true, true) => {
                let message = format!("is given twice: {key} and {other} are the same");
                diagnostics.push(self.diagnostic(other, message));
                None
            }
            (false, true) => self.quantity(other, dimension, diagnostics),
            (true, false) => self.quantity(key, dimension, diagnostics),
            (false, false) => {
                let example = dimension.units().first().map_or("", |(name, _)| name);
                let message = format!("is missing; write {other} (or {key}) = \"... {example}\"");
                diagnostics.push(self.diagnostic(other, message).of(Problem::Missing));
                None
            }
        }
    }

    /// A share that is written as a text in percent under one of two names, if it is so.
    pub(crate) fn percentage_as(&mut self, names: [&'static str; 2]) -> Option<f64> {
        if names.into_iter().all(|name| self.has(name)) {
            // Given twice, which is reported when the value itself is read.
            return None;
        }
        let name = names.into_iter().find(|name| self.has(name))?;
        let is_percentage = |text: &str| PERCENT.iter().any(|unit| text.ends_with(unit));
        let text = match self.table?.get(name)?.get_ref() {
            DeValue::String(text) if is_percentage(text.trim_end()) => text.to_string(),
            _ => return None,
        };
        let share = parse(&text, Dimension::Number).ok()?;
        self.asked.extend(names);
        Some(share)
    }

    /// A text, if it is given.
    pub(crate) fn text(
        &mut self,
        key: &'static str,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<String> {
        match self.get(key)?.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            _ => {
                diagnostics.push(self.diagnostic(key, "must be a text in quotes"));
                None
            }
        }
    }

    #[cfg(feature = "app")]
    /// A list of quantities in SI units, if it is given.
    pub(crate) fn quantities(
        &mut self,
        key: &'static str,
        dimension: Dimension,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Vec<f64>> {
        if !self.has(key) {
            self.asked.push(key);
            return None;
        }
        let mut values = Vec::new();
        for text in self.texts(key, diagnostics)? {
            match parse(&text, dimension) {
                Ok(value) => values.push(value),
                Err(error) => diagnostics.push(self.diagnostic(key, error.to_string())),
            }
        }
        if values.is_empty() {
            diagnostics.push(self.diagnostic(key, "must not be empty"));
        }
        Some(values)
    }

    /// A list of texts, if it is given.
    pub(crate) fn texts(
        &mut self,
        key: &'static str,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<Vec<String>> {
        let texts = match self.get(key)?.get_ref() {
            DeValue::Array(items) => items
                .iter()
                .map(|item| match item.get_ref() {
                    DeValue::String(text) => Some(text.to_string()),
                    _ => None,
                })
                .collect(),
            _ => None,
        };
        if texts.is_none() {
            let message = "must be a list of texts, such as [\"...\", \"...\"]";
            diagnostics.push(self.diagnostic(key, message));
        }
        texts
    }

    /// A whole number within `range`, if it is given.
    pub(crate) fn count(
        &mut self,
        key: &'static str,
        range: std::ops::RangeInclusive<u64>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> Option<u64> {
        let value = self.get(key)?;
        let number = match value.get_ref() {
            DeValue::Integer(number) if number.radix() == 10 => {
                number.as_str().replace('_', "").parse::<u64>().ok()
            }
            _ => None,
        };
        match number {
            Some(number) if range.contains(&number) => Some(number),
            _ => {
                let (low, high) = (range.start(), range.end());
                let message = format!("must be a whole number from {low} to {high}");
                diagnostics.push(self.diagnostic(key, message));
                None
            }
        }
    }

    /// Reports the keys that were never asked for, with those that are known.
    pub(crate) fn report_unknown_keys(self, diagnostics: &mut Vec<Diagnostic>) {
        let Some(table) = self.table else { return };
        let mut known = self.asked.clone();
        known.sort_unstable();
        known.dedup();
        let known_names = if known.len() > MOST_KNOWN_NAMES {
            format!("{}, ...", known[..3].join(", "))
        } else {
            known.join(", ")
        };
        // What is said of a key already says more than that it is unknown.
        let refused: HashSet<&str> = diagnostics.iter().map(|other| &*other.key).collect();
        let unknown: Vec<_> = (table.iter().map(|(key, _)| (&**key.get_ref(), key.span())))
            .filter(|(name, _)| {
                known.binary_search(name).is_err() && !refused.contains(&*self.full_name(name))
            })
            .collect();
        let mut all_meant: HashSet<&str> = HashSet::new();
        for (name, span) in unknown {
            let radius = name.replace("diameter", "radius");
            let is_known = |name: &str| known.binary_search(&name).is_ok();
            let other_word = OTHER_WORDS
                .iter()
                .find(|(word, meant)| *word == name.to_lowercase() && is_known(meant));
            let meant = match other_word {
                Some((_, meant)) => Some(*meant),
                None => meant_by(name, known.iter().copied()),
            };
            let hint = match meant {
                _ if is_known(&radius) => format!("; did you mean \"{radius}\", half of it?"),
                Some(meant) => {
                    all_meant.insert(meant);
                    format!("; did you mean \"{meant}\"?")
                }
                None => format!("; known are {known_names}"),
            };
            let message = format!("is an unknown key{hint}");
            let shown: String = name.chars().take(60).collect();
            diagnostics.push(Diagnostic {
                span,
                key: self.full_name(&shown),
                message,
                problem: Problem::Other,
            });
        }
        // The keys that were meant, and those below them, are then not missing.
        for meant in all_meant {
            let meant = self.full_name(meant);
            let below = format!("{meant}.");
            diagnostics.retain(|diagnostic| {
                let is_meant = diagnostic.key == meant || diagnostic.key.starts_with(&below);
                !(is_meant && diagnostic.problem == Problem::Missing)
            });
        }
    }
}
