//! Parses quantities: a number with its unit, such as `"13.75 ft"`.
//!
//! A unit is never guessed. A bare number is refused if the dimension needs a unit.

use super::constants::{DEGREE_RAD, FOOT_M, INCH_M, POUND_FORCE_N, POUND_KG, REV_RAD, SLUG_KG};

/// The ways to write a percentage after its number.
pub(crate) const PERCENT: [&str; 3] = ["%", "percent", "pct"];

/// The physical dimension of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// A bare number.
    Number,
    /// m.
    Length,
    /// m/s.
    Speed,
    /// rad.
    Angle,
    /// rad/s.
    Spin,
    /// s.
    Time,
    /// s/m, of c12.
    PerSpeed,
    /// s/rad, of c42.
    PerSpin,
    /// kg.
    Mass,
    /// N/m.
    Stiffness,
    /// N s/m.
    Damping,
    /// m/s^2.
    Acceleration,
    /// kg/m^3.
    Density,
}

impl Dimension {
    /// The accepted units, each with its size in SI units.
    #[must_use]
    pub fn units(self) -> &'static [(&'static str, f64)] {
        match self {
            Self::Number => &[],
            Self::Length => &[
                ("ft", FOOT_M),
                ("in", INCH_M),
                ("m", 1.0),
                ("cm", 0.01),
                ("mm", 0.001),
            ],
            Self::Speed => &[
                ("ft/s", FOOT_M),
                ("m/s", 1.0),
                ("km/h", 1.0 / 3.6),
                ("mph", 5280.0 * FOOT_M / 3600.0),
                ("cm/s", 0.01),
            ],
            Self::Angle => &[("deg", DEGREE_RAD), ("rad", 1.0)],
            Self::Spin => &[
                ("rev/s", REV_RAD),
                ("rpm", REV_RAD / 60.0),
                ("Hz", REV_RAD),
                ("rad/s", 1.0),
                ("deg/s", DEGREE_RAD),
            ],
            Self::Time => &[("s", 1.0), ("ms", 0.001)],
            Self::PerSpeed => &[("s/ft", 1.0 / FOOT_M), ("s/m", 1.0)],
            Self::PerSpin => &[("s/rev", 1.0 / REV_RAD), ("s/rad", 1.0)],
            Self::Mass => &[
                ("kg", 1.0),
                ("g", 0.001),
                ("lb", POUND_KG),
                ("oz", POUND_KG / 16.0),
                ("slug", SLUG_KG),
            ],
            Self::Stiffness => &[("lb/ft", POUND_FORCE_N / FOOT_M), ("N/m", 1.0)],
            Self::Damping => &[
                ("lb s/ft", POUND_FORCE_N / FOOT_M),
                ("N s/m", 1.0),
                ("kg/s", 1.0),
            ],
            Self::Acceleration => &[("ft/s^2", FOOT_M), ("m/s^2", 1.0)],
            Self::Density => &[
                ("kg/m^3", 1.0),
                ("lb/ft^3", POUND_KG / (FOOT_M * FOOT_M * FOOT_M)),
            ],
        }
    }

    /// Other spellings of the units.
    fn spellings(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Length => &[
                ("feet", "ft"),
                ("foot", "ft"),
                ("'", "ft"),
                ("\u{2032}", "ft"),
                ("\u{2019}", "ft"),
                ("inches", "in"),
                ("inch", "in"),
                ("\"", "in"),
                ("''", "in"),
                ("\u{2033}", "in"),
                ("\u{201d}", "in"),
            ],
            Self::Speed => &[("fps", "ft/s"), ("kph", "km/h")],
            Self::Angle => &[("degrees", "deg"), ("degree", "deg"), ("\u{b0}", "deg")],
            Self::Spin => &[
                ("Hertz", "Hz"),
                ("1/s", "Hz"),
                ("rev/min", "rpm"),
                ("rps", "rev/s"),
                ("\u{b0}/s", "deg/s"),
            ],
            _ => &[],
        }
    }

    /// The size of a unit, by any of its spellings.
    fn size_of(self, unit: &str) -> Option<f64> {
        let other = self.spellings().iter().find(|(name, _)| *name == unit);
        let unit = other.map_or(unit, |(_, name)| name);
        let found = self.units().iter().find(|(name, _)| *name == unit);
        found.map(|(_, size)| *size)
    }

    /// The accepted units as text: `ft, in, m, cm or mm`.
    #[must_use]
    pub fn unit_names(self) -> String {
        let names: Vec<_> = self.units().iter().map(|(name, _)| *name).collect();
        match names.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            Some((last, _)) => (*last).to_owned(),
            None => "no unit".to_owned(),
        }
    }
}

/// Why a text is not a valid quantity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum QuantityError {
    /// It does not start with a number.
    #[error("\"{text}\" does not start with a number")]
    NotANumber {
        /// The input.
        text: String,
    },
    /// NaN, infinite, or too large.
    #[error("\"{text}\" is not a finite number")]
    NotFinite {
        /// The input.
        text: String,
    },
    /// The unit is missing.
    #[error("\"{text}\" has no unit; write one of {allowed}")]
    NoUnit {
        /// The input.
        text: String,
        /// The accepted units.
        allowed: String,
    },
    /// It has a unit, but the dimension has none.
    #[error("\"{text}\" has a unit; write a bare number")]
    UnitOfNumber {
        /// The input.
        text: String,
    },
    /// It has a decimal comma.
    #[error("\"{text}\" has a decimal comma; write {point}")]
    DecimalComma {
        /// The input.
        text: String,
        /// The number with a point.
        point: String,
    },
    /// The unit does not belong to this dimension.
    #[error("\"{unit}\" is not a unit of this quantity; write one of {allowed}{suggestion}")]
    WrongUnit {
        /// The unit in the input.
        unit: String,
        /// What may have been meant, as the end of a sentence; empty if nothing is like it.
        suggestion: String,
        /// The accepted units.
        allowed: String,
    },
}

impl QuantityError {
    /// Whether it is written in a way that has a better one: with a unit, without, with a point.
    #[must_use]
    pub fn is_of_writing(&self) -> bool {
        !matches!(self, Self::NotANumber { .. } | Self::NotFinite { .. })
    }
}

/// Parses a quantity and returns its value in SI units.
///
/// ```
/// use bankshot::units::{Dimension, parse};
/// assert_eq!(parse("2 ft", Dimension::Length).unwrap(), 0.6096);
/// assert!(parse("2", Dimension::Length).is_err());
/// assert!(parse("2 s", Dimension::Length).is_err());
/// ```
///
/// # Errors
/// The number is missing or not finite, or the unit is missing or unknown.
pub fn parse(text: &str, dimension: Dimension) -> Result<f64, QuantityError> {
    let shown = || text.chars().take(60).collect::<String>();
    let text = text.trim();
    let ends = text
        .char_indices()
        .take_while(|&(i, c)| is_number_part(text, i, c))
        .last()
        .map_or(0, |(i, c)| i + c.len_utf8());
    let (number, unit) = text.split_at(ends);
    let word = text.to_ascii_lowercase();
    let word = word.trim_start_matches(['+', '-']);
    if word.starts_with("nan") || word.starts_with("inf") {
        return Err(QuantityError::NotFinite { text: shown() });
    }
    let value: f64 = number
        .parse()
        .map_err(|_| QuantityError::NotANumber { text: shown() })?;
    let unit = unit.split_whitespace().collect::<Vec<_>>().join(" ");
    if unit
        .strip_prefix(',')
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    {
        return Err(QuantityError::DecimalComma {
            point: shown().replacen(',', ".", 1),
            text: shown(),
        });
    }
    if dimension == Dimension::Number && PERCENT.contains(&unit.as_str()) {
        return Ok(value / 100.0);
    }
    if let Some(inches) = feet_and_inches(value, &unit, dimension) {
        return inches;
    }
    if unit.is_empty() && dimension != Dimension::Number {
        return Err(QuantityError::NoUnit {
            text: shown(),
            allowed: dimension.unit_names(),
        });
    }
    let scale = if dimension == Dimension::Number {
        if !unit.is_empty() {
            return Err(QuantityError::UnitOfNumber { text: shown() });
        }
        1.0
    } else {
        dimension
            .size_of(&unit)
            .ok_or_else(|| QuantityError::WrongUnit {
                unit: unit.chars().take(40).collect(),
                suggestion: match unit.strip_prefix("ft ") {
                    Some(inches) if inches.parse::<f64>().is_ok() => {
                        format!("; did you mean \"{number} ft {inches} in\"?")
                    }
                    _ => suggestion(&unit, dimension.units().iter().map(|(name, _)| *name)),
                },
                allowed: dimension.unit_names(),
            })?
    };
    let value = value * scale;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(QuantityError::NotFinite { text: shown() })
    }
}

/// `6'11"`, `6 ft 11 in` and the like: the rest of a length after its feet. `None` if it is none.
fn feet_and_inches(
    feet: f64,
    rest: &str,
    dimension: Dimension,
) -> Option<Result<f64, QuantityError>> {
    if dimension != Dimension::Length {
        return None;
    }
    let names = ["feet", "foot", "ft", "'", "\u{2032}", "\u{2019}"];
    let after = names.into_iter().find_map(|name| rest.strip_prefix(name))?;
    let is_mark = !rest.starts_with('f');
    let after = if is_mark {
        after
    } else {
        // `6 ft. 11 in.`
        after.strip_prefix('.').unwrap_or(after)
    };
    let after = after.trim_start();
    let unit_at = after.find(|c: char| !c.is_ascii_digit() && c != '.');
    let (number, unit) = after.split_at(unit_at.unwrap_or(after.len()));
    let unit = unit.trim_start();
    let unit = unit.strip_suffix("in.").map_or(unit, |_| "in");
    // `6'11` can only be inches; after `ft` they need their unit.
    let is_inches = match unit {
        "" => is_mark,
        unit => dimension.size_of(unit) == Some(INCH_M),
    };
    let inches: f64 = number.parse().ok().filter(|inches| *inches < 12.0)?;
    // A sign before the feet is that of the whole.
    is_inches.then(|| Ok(feet * FOOT_M + (inches * INCH_M).copysign(feet)))
}

/// What may have been meant by a name that is not known, as the end of a sentence; empty if nothing
/// is like it.
#[must_use]
pub fn suggestion<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    meant_by(name, known).map_or_else(String::new, |known| format!("; did you mean \"{known}\"?"))
}

/// The known name that is most like a name that is not known, if any is like it.
pub(crate) fn meant_by<'a>(
    name: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Option<&'a str> {
    /// Names less alike than this, from 0 to 1, have nothing in common.
    const LEAST_LIKENESS: f64 = 0.75;
    let name: String = name.chars().take(60).collect::<String>().to_lowercase();
    // The distance is at least the difference of the lengths.
    let may_be_alike = |known: &&str| {
        let (a, b) = (name.chars().count(), known.chars().count());
        a.min(b) as f64 >= LEAST_LIKENESS * a.max(b) as f64
    };
    known
        .into_iter()
        .filter(may_be_alike)
        .map(|known| {
            let likeness = strsim::normalized_damerau_levenshtein(&name, &known.to_lowercase());
            (likeness, known)
        })
        .filter(|(likeness, _)| *likeness >= LEAST_LIKENESS)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, known)| known)
}

/// Whether character `i` belongs to the number: a digit, a sign, or an exponent. An `e` belongs to
/// it only before a digit or a sign.
fn is_number_part(text: &str, i: usize, c: char) -> bool {
    match c {
        '0'..='9' | '.' => true,
        '+' | '-' => i == 0 || text[..i].ends_with(['e', 'E']),
        'e' | 'E' => {
            i > 0
                && text[i + 1..]
                    .starts_with(|next: char| next.is_ascii_digit() || "+-".contains(next))
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn val_definitions_of_the_units() {
        assert_eq!(parse("1 mph", Dimension::Speed).unwrap(), 0.44704);
        assert_eq!(parse("36 km/h", Dimension::Speed).unwrap(), 10.0);
        assert_eq!(parse("3rev/s", Dimension::Spin).unwrap(), 6.0 * PI);
        assert_eq!(parse("-1.5e1 cm", Dimension::Length).unwrap(), -0.15);
        assert_eq!(
            parse("1.53 lb  s/ft", Dimension::Damping).unwrap(),
            1.53 * POUND_FORCE_N / FOOT_M
        );
        assert_eq!(parse("180 deg", Dimension::Angle).unwrap(), PI);
    }

    #[test]
    fn contract_units_as_people_write_them() {
        let near = |text: &str, dimension: Dimension, expected: f64| {
            let value = parse(text, dimension).unwrap();
            assert!((value - expected).abs() < 1e-12, "{text}: {value}");
        };
        let length = Dimension::Length;
        for text in [
            "6'11\"",
            "6 ft 11 in",
            "6ft 11in",
            "6 feet 11 inches",
            "6\u{2032}11\u{2033}",
            "6\u{2019}11\u{201d}",
            "6'11''",
            "6' 11\"",
            "6'11",
            "6ft. 11in.",
        ] {
            near(text, length, 83.0 * INCH_M);
        }
        near("-1'6\"", length, -18.0 * INCH_M);
        near("7'", length, 7.0 * FOOT_M);
        near("180 rpm", Dimension::Spin, 6.0 * PI);
        near("20 fps", Dimension::Speed, 20.0 * FOOT_M);
        near("700 cm/s", Dimension::Speed, 7.0);
        near("52\u{b0}", Dimension::Angle, 52.0 * DEGREE_RAD);
        near("52 degrees", Dimension::Angle, 52.0 * DEGREE_RAD);
        near("70 %", Dimension::Number, 0.7);
        near("6'0.5\"", length, 72.5 * INCH_M);
        for text in [
            "6 ft, 8 ft",
            "6 ft 8",
            "6' 11'",
            "6 ft 2 m",
            "20 ft 45 in",
            "6'.\"",
        ] {
            assert!(parse(text, length).is_err(), "{text}");
        }
        let message = |text: &str| parse(text, length).unwrap_err().to_string();
        assert_eq!(
            message("13,75 ft"),
            "\"13,75 ft\" has a decimal comma; write 13.75 ft"
        );
        assert!(message("1 FT").ends_with("did you mean \"ft\"?"));
        assert!(message("1 parsec").ends_with("cm or mm"));
        assert!(message("6 ft 8").ends_with("did you mean \"6 ft 8 in\"?"));
    }

    #[test]
    fn contract_bad_quantities_are_refused_with_their_reason() {
        let length = Dimension::Length;
        assert!(matches!(
            parse("", length),
            Err(QuantityError::NotANumber { .. })
        ));
        assert!(matches!(
            parse("ft", length),
            Err(QuantityError::NotANumber { .. })
        ));
        assert!(matches!(
            parse("1", length),
            Err(QuantityError::NoUnit { .. })
        ));
        assert!(matches!(
            parse("1 deg", length),
            Err(QuantityError::WrongUnit { .. })
        ));
        assert!(matches!(
            parse("1 FT", length),
            Err(QuantityError::WrongUnit { .. })
        ));
        assert!(matches!(
            parse("nan ft", length),
            Err(QuantityError::NotFinite { .. })
        ));
        assert!(matches!(
            parse("-inf m", length),
            Err(QuantityError::NotFinite { .. })
        ));
        assert!(matches!(
            parse("1e999 m", length),
            Err(QuantityError::NotFinite { .. })
        ));
        assert!(matches!(
            parse("1 2 m", length),
            Err(QuantityError::WrongUnit { .. })
        ));
    }
}
