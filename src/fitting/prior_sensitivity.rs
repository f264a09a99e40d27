//! How much P rests on what was known before the shots: each prior as if it were half as strong,
//! and twice as strong (power scaling; Kallioinen et al., Stat. Comput. 34 (2024) 57).
//!
//! A prior of density `p` is taken to the power of a half or of two, and the draws are weighted by
//! the ratio: nothing is sampled again.

use super::importance::{pareto_smoothed, student_log_density};
use super::posterior::Draw;
use super::prior::{PopulationPrior, PriorOf, PriorOfDraws};
use serde::Serialize;

/// P of the current shot if a prior were weaker or stronger.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PriorSensitivity {
    /// The prior.
    pub prior: PriorOf,
    /// P if it were half as strong.
    pub probability_if_half_as_strong: f64,
    /// P if it were twice as strong.
    pub probability_if_twice_as_strong: f64,
    /// The greater shape of the tails of the two sets of weights: above 0.7 the two values are no
    /// more than a hint.
    pub pareto_k: f64,
}

impl PriorSensitivity {
    /// Of each prior; `probabilities` are those of the draws.
    #[must_use]
    pub fn of(priors: &[PriorOfDraws], probabilities: &[f64]) -> Vec<Self> {
        let of_prior = |prior: &PriorOfDraws| {
            let with_power = |power: f64| {
                let logarithms = prior.log_densities.iter().map(|log| (power - 1.0) * log);
                let greatest = logarithms.clone().fold(f64::NEG_INFINITY, f64::max);
                let weights = logarithms.map(|log| libm::exp(log - greatest)).collect();
                let (weights, shape) = pareto_smoothed(weights);
                let sum: f64 = weights.iter().sum();
                let weighted = weights.iter().zip(probabilities).map(|(w, p)| w * p);
                (weighted.sum::<f64>() / sum, shape)
            };
            let ((half, of_half), (twice, of_twice)) = (with_power(0.5), with_power(2.0));
            Self {
                prior: prior.of,
                probability_if_half_as_strong: half,
                probability_if_twice_as_strong: twice,
                pareto_k: of_half.max(of_twice),
            }
        };
        priors.iter().map(of_prior).collect()
    }

    /// The greater change of P, up or down.
    #[must_use]
    pub fn greatest_change(&self, probability: f64) -> f64 {
        let changes = [
            self.probability_if_half_as_strong - probability,
            self.probability_if_twice_as_strong - probability,
        ];
        changes.map(f64::abs).into_iter().fold(0.0, f64::max)
    }
}

/// The logarithm of the prior of a draw's scatter.
pub(super) fn log_prior_of_scatter(draw: &Draw, prior: &PopulationPrior) -> f64 {
    let of_sd = |i: usize| {
        let z = libm::log(draw.sds[i] / prior.median_sd[i]) / prior.log_sd[i];
        -0.5 * z * z
    };
    let correlation = draw.correlation[(0, 1)].clamp(-0.999_999, 0.999_999);
    let z = (libm::atanh(correlation) - prior.speed_pitch.mean) / prior.speed_pitch.sd;
    (0..draw.sds.len()).map(of_sd).sum::<f64>() - 0.5 * z * z
}

/// The logarithm of the prior of values in its scales, independent and t distributed.
pub(super) fn log_student(values: &[f64]) -> f64 {
    values.iter().map(|t| student_log_density(*t)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal_distribution::quantile;

    /// Authority: a normal posterior from a normal prior and a normal likelihood. With the prior to
    /// the power `a`, its precision is multiplied by `a`. The draws are evenly spaced quantiles.
    #[test]
    fn val_power_scaling_of_a_normal_prior() {
        let (prior_mean, prior_sd, data_mean, data_sd) = (0.3_f64, 0.2_f64, 0.6_f64, 0.15_f64);
        let posterior = |power: f64| {
            let (prior, data) = (power / (prior_sd * prior_sd), 1.0 / (data_sd * data_sd));
            let mean = (prior * prior_mean + data * data_mean) / (prior + data);
            (mean, 1.0 / (prior + data).sqrt())
        };
        let (mean, sd) = posterior(1.0);
        let draws: Vec<f64> = (0..4000)
            .map(|k| mean + sd * quantile((f64::from(k) + 0.5) / 4000.0))
            .collect();
        let log_densities = draws
            .iter()
            .map(|x| -0.5 * ((x - prior_mean) / prior_sd) * ((x - prior_mean) / prior_sd))
            .collect();
        let prior = PriorOfDraws {
            of: PriorOf::Ring,
            log_densities,
        };
        let found = PriorSensitivity::of(&[prior], &draws)[0];
        let half = found.probability_if_half_as_strong;
        assert!((half - posterior(0.5).0).abs() < 0.002, "{found:?}");
        let twice = found.probability_if_twice_as_strong;
        assert!((twice - posterior(2.0).0).abs() < 0.002, "{found:?}");
        assert!(found.pareto_k < 0.7, "{found:?}");
        let change = found.greatest_change(mean);
        assert!((change - (posterior(2.0).0 - mean).abs()).abs() < 0.003);
    }
}
