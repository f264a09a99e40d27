//! Parses quantities: a number with its unit, such as `"13.75 ft"`.
//!
//! A unit is never guessed. A bare number is refused if the dimension needs a unit.

use super::constants::{DEGREE_RAD, FOOT_M, INCH_M, POUND_FORCE_N, POUND_KG, REV_RAD, SLUG_KG};

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
            ],
            Self::Angle => &[("deg", DEGREE_RAD), ("rad", 1.0)],
            Self::Spin => &[
                ("rev/s", REV_RAD),
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
    /// The unit does not belong to this dimension.
    #[error("\"{unit}\" is not a unit of this quantity; write one of {allowed}")]
    WrongUnit {
        /// The unit in the input.
        unit: String,
        /// The accepted units.
        allowed: String,
    },
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
            .units()
            .iter()
            .find(|(name, _)| *name == unit)
            .map(|(_, scale)| *scale)
            .ok_or_else(|| QuantityError::WrongUnit {
                unit: unit.chars().take(40).collect(),
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

/// Whether character `i` belongs to the number: a digit, a sign, or an exponent. An `e` belongs to it only
/// before a digit or a sign.
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
