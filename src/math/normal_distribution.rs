//! The standard normal distribution: cumulative probability and its inverse.
//!
//! [`cdf`] is `erfc(-x/sqrt 2)/2`. [`quantile`] is algorithm AS 241 (PPND16) of M. J. Wichura,
//! Applied Statistics 37 (1988) 477-484, DOI 10.2307/2347330: relative accuracy about 1e-16.

use std::f64::consts::{PI, SQRT_2};

/// Probability that a standard normal variable is at most `x`.
#[must_use]
pub fn cdf(x: f64) -> f64 {
    0.5 * libm::erfc(-x / SQRT_2)
}

/// Density of the normal distribution about `mean` with standard deviation `sigma`.
#[must_use]
pub fn density(x: f64, mean: f64, sigma: f64) -> f64 {
    let z = (x - mean) / sigma;
    libm::exp(-0.5 * z * z) / (sigma * (2.0 * PI).sqrt())
}

const CENTRAL: ([f64; 8], [f64; 7]) = (
    [
        3.387_132_872_796_366_6,
        1.331_416_678_917_843_8e2,
        1.971_590_950_306_551_4e3,
        1.373_169_376_550_946e4,
        4.592_195_393_154_987e4,
        6.726_577_092_700_87e4,
        3.343_057_558_358_813e4,
        2.509_080_928_730_122_7e3,
    ],
    [
        4.231_333_070_160_091e1,
        6.871_870_074_920_579e2,
        5.394_196_021_424_751e3,
        2.121_379_430_158_659_7e4,
        3.930_789_580_009_271e4,
        2.872_908_573_572_194_3e4,
        5.226_495_278_852_854e3,
    ],
);
const NEAR: ([f64; 8], [f64; 7]) = (
    [
        1.423_437_110_749_683_5,
        4.630_337_846_156_545,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        2.417_807_251_774_506e-1,
        2.272_384_498_926_918_4e-2,
        7.745_450_142_783_414e-4,
    ],
    [
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        6.897_673_349_851e-1,
        1.481_039_764_274_800_8e-1,
        1.519_866_656_361_645_7e-2,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ],
);
const FAR: ([f64; 8], [f64; 7]) = (
    [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        2.965_605_718_285_048_7e-1,
        2.653_218_952_657_612_4e-2,
        1.242_660_947_388_078_4e-3,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ],
    [
        5.998_322_065_558_88e-1,
        1.369_298_809_227_358e-1,
        1.487_536_129_085_061_5e-2,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_7e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ],
);

fn ratio((above, below): &([f64; 8], [f64; 7]), r: f64) -> f64 {
    let above = above.iter().rev().fold(0.0, |sum, c| sum * r + c);
    let below = below.iter().rev().fold(0.0, |sum, c| sum * r + c) * r + 1.0;
    above / below
}

/// Distance from 1/2 up to which a probability is in the centre of AS 241.
const CENTRE: f64 = 0.425;

fn central_quantile(q: f64) -> f64 {
    q * ratio(&CENTRAL, 0.180_625 - q * q)
}

fn tail_quantile(p: f64, q: f64) -> f64 {
    let tail = if q < 0.0 { p } else { 1.0 - p };
    let r = (-libm::log(tail)).sqrt();
    let size = if r <= 5.0 {
        ratio(&NEAR, r - 1.6)
    } else {
        ratio(&FAR, r - 5.0)
    };
    if q < 0.0 { -size } else { size }
}

/// The value below which a standard normal variable falls with probability `p`, 0 < p < 1.
#[must_use]
pub fn quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= CENTRE {
        central_quantile(q)
    } else {
        tail_quantile(p, q)
    }
}

/// Replaces probabilities by their quantiles; the same as [`quantile`] for each. The loop over the
/// centre has no branch, so the compiler makes vectors of it; one value in seven is in the tails.
pub(crate) fn quantiles(values: &mut [f64]) {
    const CHUNK: usize = 64;
    for chunk in values.chunks_mut(CHUNK) {
        let mut central = [0.0; CHUNK];
        for (central, p) in central.iter_mut().zip(&*chunk) {
            *central = central_quantile(p - 0.5);
        }
        for (value, central) in chunk.iter_mut().zip(central) {
            let q = *value - 0.5;
            *value = if q.abs() <= CENTRE {
                central
            } else {
                tail_quantile(*value, q)
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn val_as241_published_check_values() {
        // Wichura's own: z(0.25), z(0.001) and z(1e-20).
        for (p, z) in [
            (0.25, -0.674_489_750_196_081_7),
            (0.001, -3.090_232_306_167_813_5),
            (1e-20, -9.262_340_089_798_408),
        ] {
            assert!(
                (quantile(p) / z - 1.0).abs() < 1e-14,
                "{p}: {}",
                quantile(p)
            );
        }
    }

    #[test]
    fn prop_many_quantiles_are_those_one_by_one() {
        let p = |i: u32| (f64::from(i) + 0.5) / 777.0;
        let mut values: Vec<f64> = (0..777).map(p).collect();
        quantiles(&mut values);
        for (i, value) in (0..).zip(values) {
            assert_eq!(value.to_bits(), quantile(p(i)).to_bits());
        }
    }

    #[test]
    fn prop_quantile_inverts_the_cumulative_probability() {
        for i in 1..2000 {
            let p = f64::from(i) / 2000.0;
            assert!((cdf(quantile(p)) - p).abs() < 1e-14, "{p}");
        }
    }
}
