//! Lists of values of a flag: `6 ft, 8 ft`, or a range with a step.

use super::failure::Failure;
use crate::best_shot::MOST_NODES as MOST_VALUES;
use crate::units::{self, Dimension};

/// Ascending values: `6 ft, 8 ft`, `6, 8 ft` or `6 ft to 20 ft by 1 ft`.
pub(crate) fn ascending_values(
    flag: &str,
    text: &str,
    dimension: Dimension,
) -> Result<Vec<f64>, Failure> {
    let example = match dimension {
        Dimension::Angle => "'0 deg, 30 deg' or '0 deg to 60 deg by 15 deg'",
        Dimension::Speed => "'7 m/s, 8 m/s' or '22 ft/s to 26 ft/s by 0.5 ft/s'",
        Dimension::Spin => "'1 rev/s, 2 rev/s' or '0 rev/s to 3 rev/s by 0.5 rev/s'",
        _ => "'2 m, 3 m' or '6 ft to 20 ft by 1 ft'",
    };
    let refuse = |message: String| {
        Failure::usage(format!("--{flag}: \"{text}\" {message}; write {example}"))
    };
    let parse = |text: &str| {
        units::parse(text.trim(), dimension)
            .map_err(|error| Failure::usage(format!("--{flag}: {error}; write {example}")))
    };
    let values: Vec<f64> = match text.split_once(" to ") {
        Some((from, rest)) => {
            let (to, step) = rest
                .split_once(" by ")
                .ok_or_else(|| refuse("has no step".to_owned()))?;
            let (from, to, step) = (parse(from)?, parse(to)?, parse(step)?);
            if !(step > 0.0) || !(to >= from) {
                return Err(refuse("must ascend, with a step above 0".to_owned()));
            }
            // The end belongs to the range, also where the steps do not add up exactly.
            let steps = ((to - from) / step + 1e-9).floor();
            if steps >= MOST_VALUES as f64 {
                return Err(refuse(format!("has more than {MOST_VALUES} values")));
            }
            (0..=steps as usize)
                .map(|k| from + step * k as f64)
                .collect()
        }
        None => {
            let values: Vec<&str> = text.split(',').map(str::trim).collect();
            // `48, 50, 52 deg`: the unit of the last value is that of all. Feet and inches are two.
            let last = values.last().copied().unwrap_or_default();
            let ends = (0..=last.len()).filter(|end| last.is_char_boundary(*end));
            let number_end = ends.filter(|end| last[..*end].parse::<f64>().is_ok()).max();
            let rest = number_end.map_or("", |end| last[end..].trim());
            let is_one = |c: char| c.is_alphabetic() || matches!(c, '_' | '/' | '\u{b0}');
            let unit = if rest.chars().all(is_one) { rest } else { "" };
            let has_no_unit = |value: &&str| value.parse::<f64>().is_ok();
            let parse_in_unit = |value: &&str| {
                if has_no_unit(value) && !unit.is_empty() {
                    parse(&format!("{value} {unit}"))
                } else {
                    parse(value)
                }
            };
            values.iter().map(parse_in_unit).collect::<Result<_, _>>()?
        }
    };
    if values.len() > MOST_VALUES {
        return Err(refuse(format!("has more than {MOST_VALUES} values")));
    }
    if values.windows(2).any(|pair| !(pair[1] > pair[0])) {
        return Err(refuse("does not ascend".to_owned()));
    }
    Ok(values)
}
