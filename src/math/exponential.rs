//! The exponential function in lanes.

use super::real::Real;

/// Arguments beyond this size are taken as this size.
const LARGEST: f64 = 600.0;
/// The argument is halved this often, so that few terms of the power series are enough.
const HALVINGS: u32 = 12;
/// One over the factorials of 10 to 0.
const COEFFICIENTS: [f64; 11] = [
    1.0 / 3_628_800.0,
    1.0 / 362_880.0,
    1.0 / 40_320.0,
    1.0 / 5_040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    1.0 / 2.0,
    1.0,
    1.0,
];

/// `e` to the power of `x`, within a relative error of 1e-12 for -600 to 600. The power series of a
/// small part of `x` is squared as often as `x` was halved.
#[inline(always)]
pub(crate) fn exponential<T: Real>(x: T) -> T {
    let x = Real::max(Real::min(x, x.splat(LARGEST)), x.splat(-LARGEST));
    let small = x * (1.0 / f64::from(1_u32 << HALVINGS));
    let mut power = x.splat(COEFFICIENTS[0]);
    for coefficient in &COEFFICIENTS[1..] {
        power = power * small + *coefficient;
    }
    for _ in 0..HALVINGS {
        power = power.squared();
    }
    power
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Authority: the mathematics library.
    #[test]
    fn val_exponential_within_its_error() {
        for k in -60_000..=60_000 {
            let x = f64::from(k) * 0.01;
            let relative = exponential(x) / libm::exp(x) - 1.0;
            assert!(relative.abs() < 1e-12, "{x}: {relative:e}");
        }
        assert_eq!(exponential(-1e9), exponential(-600.0));
    }
}
