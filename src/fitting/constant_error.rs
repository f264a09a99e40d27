//! What a constant error of the tracker would do: it is in no interval.

use super::expected_makes::made_z_of_releases;
use super::measured_release::nominal_of;
use super::shooter_fit::ShooterFit;
use crate::probability::{Sampler, Silent};

/// Standard error of P: the answer is told in whole percent.
const ROUGHLY: f64 = 0.002;

/// What follows if the tracker reads one value of all shots too high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantError {
    /// Index of the value.
    pub value: usize,
    /// By how much it reads it too high, SI units; negative for too low.
    pub by: f64,
    /// P of the current shot at the first place.
    pub probability: f64,
    /// By how many of its standard deviations the number of makes is greater than expected.
    pub made_z: Option<f64>,
}

/// Errors of one standard deviation of the noise of speed, pitch and polar angle, to both sides,
/// where releases were measured; those without noise are left out.
#[must_use]
pub fn constant_errors(fit: &ShooterFit, noise_sds: [f64; 3]) -> Vec<ConstantError> {
    let shots = fit.makes.known_releases();
    let profile = &fit.profiles[0];
    let usual = fit.typical.means[0];
    let sampler = Sampler::new(profile);
    let of = |value: usize, by: f64| {
        let mut shift = [0.0; 4];
        shift[value] = -by;
        let shot = std::array::from_fn(|i| usual[i] + shift[i]);
        let seed = profile.search().seed;
        let estimate = sampler.estimate(&nominal_of(&shot), ROUGHLY, seed, &Silent);
        ConstantError {
            value,
            by,
            probability: estimate.probability,
            made_z: made_z_of_releases(&fit.profiles, &shots, &shift),
        }
    };
    let values = (0..noise_sds.len()).filter(|&i| noise_sds[i] > 0.0);
    values
        .flat_map(|i| [noise_sds[i], -noise_sds[i]].map(|by| of(i, by)))
        .collect()
}
