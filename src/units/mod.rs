//! Units of measurement. Inside the crate everything is SI; other units exist only where input is
//! read and results are printed.

mod constants;
mod measure;
mod quantity;
mod unit_system;

pub use constants::{DEGREE_RAD, FOOT_M, INCH_M, POUND_FORCE_N, POUND_KG, REV_RAD, SLUG_KG};
pub use measure::{Measure, UnitName};
pub use quantity::{Dimension, QuantityError, parse, suggestion};
pub(crate) use quantity::{PERCENT, meant_by};
pub use unit_system::{Unit, UnitSystem};

/// The value with 12 significant digits. A table shows 6 and not 6.000000000000001, the last digits
/// of a change of units.
#[must_use]
pub fn rounded(value: f64) -> f64 {
    // Both conversions are exact to the last bit on every machine.
    format!("{value:.11e}").parse().unwrap_or(value)
}

/// The value with so many decimals, for people: never a negative zero.
#[must_use]
pub fn with_decimals(value: f64, decimals: i32) -> f64 {
    let scale = libm::pow(10.0, f64::from(decimals));
    libm::round(scale * value) / scale + 0.0
}

/// A length for people: one decimal, or two where the second is not zero.
#[must_use]
pub fn at_most_two_decimals(value: f64) -> String {
    let text = format!("{value:.2}");
    text.strip_suffix('0').map_or(text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_tables_have_twelve_digits() {
        let six_feet_m = 6.0 * FOOT_M;
        assert_eq!(rounded(six_feet_m * 1.000_000_000_000_000_2 / FOOT_M), 6.0);
        assert_eq!(rounded(-0.123_456_789_012_345_6), -0.123_456_789_012);
        assert_eq!(rounded(1.0 / 3.0).to_string(), "0.333333333333");
        assert_eq!(rounded(0.0), 0.0);
        assert!(rounded(f64::NAN).is_nan());
    }

    #[test]
    fn contract_lengths_keep_the_second_decimal() {
        for (value, text) in [(13.75, "13.75"), (6.0, "6.0"), (13.7, "13.7")] {
            assert_eq!(at_most_two_decimals(value), text);
        }
    }
}
