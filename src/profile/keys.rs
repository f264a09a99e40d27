//! Walks a TOML table key by key, collecting faults instead of stopping at the first.

use super::fault::Fault;
use crate::units::{Dimension, parse};
use std::ops::Range;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A table being read. Every key must be asked for; what was not is unknown.
#[derive(Clone)]
pub(crate) struct Keys<'t, 'i> {
    path: String,
    table: Option<&'t DeTable<'i>>,
    span: Range<usize>,
    asked: Vec<&'static str>,
}

impl<'t, 'i> Keys<'t, 'i> {
    pub(crate) fn root(table: &'t Spanned<DeTable<'i>>) -> Self {
        Self {
            path: String::new(),
            table: Some(table.get_ref()),
            span: 0..0,
            asked: Vec::new(),
        }
    }

    pub(crate) fn name(&self, key: &str) -> String {
        if self.path.is_empty() {
            key.to_owned()
        } else {
            format!("{}.{key}", self.path)
        }
    }

    pub(crate) fn has(&self, key: &str) -> bool {
        self.table.is_some_and(|table| table.contains_key(key))
    }

    fn get(&mut self, key: &'static str) -> Option<&'t Spanned<DeValue<'i>>> {
        self.asked.push(key);
        self.table.and_then(|table| table.get(key))
    }

    pub(crate) fn fault(&self, key: &str, message: impl Into<String>) -> Fault {
        let span = self
            .table
            .and_then(|table| table.get(key))
            .map_or_else(|| self.span.clone(), Spanned::span);
        Fault {
            span,
            key: self.name(key),
            message: message.into(),
        }
    }

    /// A fault of the whole table.
    pub(crate) fn here(&self, message: impl Into<String>) -> Fault {
        Fault {
            span: self.span.clone(),
            key: self.path.clone(),
            message: message.into(),
        }
    }

    /// The table under `key`; an empty one where it is absent.
    pub(crate) fn table(&mut self, key: &'static str, faults: &mut Vec<Fault>) -> Keys<'t, 'i> {
        let found = self.get(key);
        let path = self.name(key);
        let nothing = |span| Keys {
            path: path.clone(),
            table: None,
            span,
            asked: Vec::new(),
        };
        match found.map(|value| (value.get_ref(), value.span())) {
            Some((DeValue::Table(table), span)) => Keys {
                path,
                table: Some(table),
                span,
                asked: Vec::new(),
            },
            Some((_, span)) => {
                faults.push(self.fault(key, "must be a table, such as [shooter]"));
                nothing(span)
            }
            None => nothing(self.span.clone()),
        }
    }

    /// A quantity in SI units, if it is there.
    pub(crate) fn quantity(
        &mut self,
        key: &'static str,
        dimension: Dimension,
        faults: &mut Vec<Fault>,
    ) -> Option<f64> {
        let value = self.get(key)?;
        let number = match value.get_ref() {
            DeValue::String(text) => match parse(text, dimension) {
                Ok(value) => return Some(value),
                Err(error) => {
                    faults.push(self.fault(key, error.to_string()));
                    return None;
                }
            },
            DeValue::Integer(number) => number.as_str().replace('_', "").parse::<f64>().ok(),
            DeValue::Float(number) => number.as_str().replace('_', "").parse::<f64>().ok(),
            _ => None,
        };
        match number {
            Some(number) if dimension == Dimension::Number && number.is_finite() => Some(number),
            Some(_) if dimension == Dimension::Number => {
                faults.push(self.fault(key, "must be a finite number"));
                None
            }
            Some(number) => {
                let units = dimension.unit_names();
                let example = dimension.units().first().map_or("", |(name, _)| name);
                faults.push(self.fault(
                    key,
                    format!("has no unit; write it as text with one of {units}, such as \"{number} {example}\""),
                ));
                None
            }
            None => {
                faults
                    .push(self.fault(key, "must be a number, or a text with a number and a unit"));
                None
            }
        }
    }

    /// As [`Keys::quantity`], a fault where it is missing.
    pub(crate) fn required(
        &mut self,
        key: &'static str,
        dimension: Dimension,
        faults: &mut Vec<Fault>,
    ) -> Option<f64> {
        if !self.has(key) {
            self.asked.push(key);
            let example = dimension.units().first().map_or("", |(name, _)| name);
            faults.push(self.fault(key, format!("is missing; write {key} = \"... {example}\"")));
            return None;
        }
        self.quantity(key, dimension, faults)
    }

    pub(crate) fn text(&mut self, key: &'static str, faults: &mut Vec<Fault>) -> Option<String> {
        match self.get(key)?.get_ref() {
            DeValue::String(text) => Some(text.to_string()),
            _ => {
                faults.push(self.fault(key, "must be a text in quotes"));
                None
            }
        }
    }

    /// A list of quantities in SI units, if it is there.
    pub(crate) fn quantities(
        &mut self,
        key: &'static str,
        dimension: Dimension,
        faults: &mut Vec<Fault>,
    ) -> Option<Vec<f64>> {
        if !self.has(key) {
            self.asked.push(key);
            return None;
        }
        let mut values = Vec::new();
        for text in self.texts(key, faults)? {
            match parse(&text, dimension) {
                Ok(value) => values.push(value),
                Err(error) => faults.push(self.fault(key, error.to_string())),
            }
        }
        if values.is_empty() {
            faults.push(self.fault(key, "must not be empty"));
        }
        Some(values)
    }

    /// A list of texts, if it is there.
    pub(crate) fn texts(
        &mut self,
        key: &'static str,
        faults: &mut Vec<Fault>,
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
            faults.push(self.fault(key, "must be a list of texts, such as [\"...\", \"...\"]"));
        }
        texts
    }

    /// A whole number within `range`.
    pub(crate) fn count(
        &mut self,
        key: &'static str,
        range: std::ops::RangeInclusive<u64>,
        faults: &mut Vec<Fault>,
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
                faults
                    .push(self.fault(key, format!("must be a whole number from {low} to {high}")));
                None
            }
        }
    }

    /// Reports the keys nobody asked for, with the nearest that exists.
    pub(crate) fn finish(self, faults: &mut Vec<Fault>) {
        let Some(table) = self.table else { return };
        for (key, _) in table.iter() {
            let name: &str = key.get_ref();
            if self.asked.contains(&name) {
                continue;
            }
            let mut known = self.asked.clone();
            known.sort_unstable();
            let message = format!("is not a key here; known are {}", known.join(", "));
            let shown: String = name.chars().take(60).collect();
            faults.push(Fault {
                span: key.span(),
                key: self.name(&shown),
                message,
            });
        }
    }
}
