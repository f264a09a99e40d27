//! The posterior density where the releases have heavier tails than normal ones: a multivariate t
//! distribution.
//!
//! A release is `mu + sqrt((1 - 2 t)/w) L z` with standard normals `z` and one `w` a shot, gamma
//! distributed with shape and rate `1/(2 t)`. `t`, the tail weight, is one over the degrees of
//! freedom; `L L^T` is the covariance whatever `t` is. The tracker's error is normal, so given `w`
//! a measurement is normal, and `w` is integrated out by the trapezoidal rule in its logarithm. The
//! means have no closed form here: they are parameters.

use super::dispersion_posterior::{
    Dispersion, DispersionPosterior, ReleaseModel, normal_log_density,
};
use super::grouped_measurements::{GroupedMeasurements, measured};
use super::measured_release::MeasuredRelease;
use super::prior::{PopulationPrior, Spread};
use crate::math::exponential::exponential;
use crate::math::normal_distribution::cdf;
use crate::math::real::{Real, SimdReal};
use crate::math::simd::F64x8;
use fearless_simd::{Level, Simd};
use hammer_and_sample::Model;
use nalgebra::{Cholesky, SVector};

/// The heaviest tails, three degrees of freedom; the prior of the tail weight is uniform up to it.
pub(super) const MAX_TAIL_WEIGHT: f64 = 1.0 / 3.0;

/// Nodes of the integral over `w`: in standard deviations of its logarithm for light tails.
const NODES: usize = 16;
const FIRST_NODE: f64 = -6.3;
const NODE_STEP: f64 = 0.7;

/// The posterior density of dispersion, tail weight and means.
pub(super) struct StudentPosterior<const D: usize> {
    normal: DispersionPosterior<D>,
    measurements: GroupedMeasurements<D>,
    level: Level,
}

/// `1/w` and the logarithm of its probability for each node.
fn scale_nodes(tail_weight: f64) -> [(f64, f64); NODES] {
    let shape = 0.5 / tail_weight.max(1e-9);
    let step = NODE_STEP / shape.sqrt();
    let mut nodes = std::array::from_fn(|k| {
        let logarithm = step * (FIRST_NODE / NODE_STEP + k as f64);
        // Relative to the density at 1, so that great shapes keep their digits.
        let density = shape * (logarithm - libm::expm1(logarithm));
        (libm::exp(-logarithm), density)
    });
    let total: f64 = nodes.iter().map(|(_, density)| libm::exp(*density)).sum();
    for (_, density) in &mut nodes {
        *density -= libm::log(total);
    }
    nodes
}

/// The normal densities of measurements of one group, at each node.
struct DensitiesAtNodes<const D: usize> {
    /// The logarithms of the probability of the node and of the density at the mean, together.
    constants: [f64; NODES],
    /// The inverse covariances, entry by entry.
    inverses: [[[f64; NODES]; D]; D],
}

/// Factors of a product whose logarithm is taken.
const MOST_FACTORS: usize = 64;
/// Nodes that are summed at a time.
const LANES: usize = 8;

impl<const D: usize> DensitiesAtNodes<D> {
    /// The sum of the logarithms of the densities of measurements, each summed over the nodes.
    #[inline(always)]
    fn log_likelihood<S: Simd>(
        &self,
        simd: S,
        values: &[SVector<f64, D>],
        mean: &SVector<f64, D>,
    ) -> f64 {
        const { assert!(NODES == 2 * LANES) };
        simd.vectorize(
            #[inline(always)]
            || {
                let mut sum = 0.0;
                // Sums from 1 to NODES: their product is below 1e78, with one logarithm.
                let mut product = 1.0;
                for (number, y) in values.iter().enumerate() {
                    let deviation = y - mean;
                    let first = self.log_densities(simd, &deviation, 0);
                    let second = self.log_densities(simd, &deviation, LANES);
                    let mut lanes = [0.0; LANES];
                    Real::max(first, second).store(&mut lanes);
                    let greatest = lanes.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                    let all = exponential(first - greatest) + exponential(second - greatest);
                    all.store(&mut lanes);
                    sum += greatest;
                    product *= lanes.iter().sum::<f64>();
                    if number % MOST_FACTORS == 0 {
                        sum += libm::log(product);
                        product = 1.0;
                    }
                }
                sum + libm::log(product)
            },
        )
    }

    /// The logarithm of the density of a deviation from the mean, at the nodes from `node` on.
    #[inline(always)]
    fn log_densities<S: Simd>(
        &self,
        simd: S,
        deviation: &SVector<f64, D>,
        node: usize,
    ) -> F64x8<S> {
        let mut square = F64x8::broadcast(simd, 0.0);
        for i in 0..D {
            let mut row = F64x8::broadcast(simd, 0.0);
            for j in 0..D {
                row += F64x8::load(simd, &self.inverses[i][j][node..]) * deviation[j];
            }
            square += row * deviation[i];
        }
        F64x8::load(simd, &self.constants[node..]) - square * 0.5
    }
}

impl<const D: usize> StudentPosterior<D> {
    pub(super) fn new(shots: &[MeasuredRelease], places: usize, prior: PopulationPrior) -> Self {
        Self {
            normal: DispersionPosterior::new(shots, places, prior),
            measurements: GroupedMeasurements::new(shots, places),
            level: Level::new(),
        }
    }

    fn tail(&self, point: &[f64]) -> f64 {
        MAX_TAIL_WEIGHT * cdf(point[self.normal.dimension()])
    }

    /// The place of the first mean in a point.
    fn first_mean(&self) -> usize {
        self.normal.dimension() + 1
    }

    fn log_likelihood(&self, point: &[f64], dispersion: &Dispersion<D>) -> Option<f64> {
        let tail_weight = self.tail(point);
        let nodes = scale_nodes(tail_weight);
        let mut sum = 0.0;
        for group in &self.measurements.groups {
            let factor = self.normal.release_factor(dispersion, group.place);
            let scale = factor * factor.transpose() * (1.0 - 2.0 * tail_weight);
            let mut at_nodes = DensitiesAtNodes::<D> {
                constants: [0.0; NODES],
                inverses: [[[0.0; NODES]; D]; D],
            };
            for (k, (inverse_w, log_probability)) in nodes.iter().enumerate() {
                let cholesky = Cholesky::new(scale * *inverse_w + group.noise)?;
                let diagonal = cholesky.l_dirty().diagonal();
                let half: f64 = diagonal.iter().map(|entry| libm::log(*entry)).sum();
                at_nodes.constants[k] = log_probability - half;
                let inverse = cholesky.inverse();
                for i in 0..D {
                    for j in 0..D {
                        at_nodes.inverses[i][j][k] = inverse[(i, j)];
                    }
                }
            }
            let mean = self
                .measurements
                .mean(point, self.first_mean(), group.place);
            sum += fearless_simd::dispatch!(
                self.level,
                simd => at_nodes.log_likelihood(simd, &group.values, &mean)
            );
        }
        Some(sum)
    }
}

impl<const D: usize> Model for StudentPosterior<D> {
    type Params = Vec<f64>;

    fn log_prob(&self, point: &Vec<f64>) -> f64 {
        let Some((log_prior, dispersion)) = self.normal.log_prior(point, &self.priors()) else {
            return f64::NEG_INFINITY;
        };
        match self.log_likelihood(point, &dispersion) {
            Some(log_likelihood) if log_likelihood.is_finite() => log_prior + log_likelihood,
            _ => f64::NEG_INFINITY,
        }
    }
}

impl<const D: usize> ReleaseModel<D> for StudentPosterior<D> {
    fn normal(&self) -> &DispersionPosterior<D> {
        &self.normal
    }

    /// Those of the dispersion, of the tail weight's normal quantile, and flat ones of the means.
    fn priors(&self) -> Vec<Spread> {
        let mut priors = self.normal.priors();
        priors.push(Spread { mean: 0.0, sd: 1.0 });
        self.measurements.add_priors(&mut priors);
        priors
    }

    fn tail_weight(&self, point: &[f64]) -> f64 {
        self.tail(point)
    }

    fn means(
        &self,
        point: &[f64],
        _normal: &mut dyn FnMut() -> f64,
    ) -> Option<Vec<SVector<f64, D>>> {
        Some(self.measurements.all_means(point, self.first_mean()))
    }

    fn shot_log_densities(
        &self,
        point: &[f64],
        means: &[SVector<f64, D>],
        shots: &[MeasuredRelease],
    ) -> Option<Vec<f64>> {
        let (dispersion, tail_weight) = (self.normal.dispersion(point), self.tail(point));
        let nodes = scale_nodes(tail_weight);
        let of_shot = |shot: &MeasuredRelease| {
            let (values, noise) = measured(shot);
            let factor = self.normal.release_factor(&dispersion, shot.place);
            let scale = factor * factor.transpose() * (1.0 - 2.0 * tail_weight);
            let deviation = values - means[shot.place];
            let of_nodes = nodes.map(|(inverse_w, log_probability)| {
                let density = normal_log_density(&deviation, scale * inverse_w + noise)?;
                Some(log_probability + density)
            });
            let greatest = of_nodes.iter().flatten().copied();
            let greatest = greatest.fold(f64::NEG_INFINITY, f64::max);
            let sum = of_nodes
                .iter()
                .try_fold(0.0, |sum, log| Some(sum + libm::exp((*log)? - greatest)))?;
            Some(greatest + libm::log(sum))
        };
        shots.iter().map(of_shot).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Authority: the closed form of the one-dimensional t density, by its ratio to that at 0:
    /// `(1 + x^2/n)^(-(n + 1)/2)`. Without a tracker's error the integral over `w` is it.
    #[test]
    fn val_mixture_is_the_t_distribution() {
        for freedom in [3.0, 5.0, 12.0, 60.0, 1000.0] {
            let nodes = scale_nodes(1.0 / freedom);
            let at_nodes = DensitiesAtNodes::<1> {
                constants: nodes.map(|(inverse_w, log_probability)| {
                    log_probability - 0.5 * libm::log(inverse_w)
                }),
                inverses: [[nodes.map(|(inverse_w, _)| 1.0 / inverse_w)]],
            };
            let log_density = |x: f64| {
                let (values, mean) = ([SVector::from([x])], SVector::zeros());
                fearless_simd::dispatch!(
                    Level::new(),
                    simd => at_nodes.log_likelihood(simd, &values, &mean)
                )
            };
            for x in [0.5, 1.0, 2.0, 4.0, 8.0] {
                let seen = log_density(x) - log_density(0.0);
                let expected = -0.5 * (freedom + 1.0) * libm::log1p(x * x / freedom);
                // Far out the mixture has normal tails; no shot is there.
                let tolerance = if x < 5.0 { 2e-3 } else { 0.05 } * expected.abs();
                assert!(
                    (seen - expected).abs() < tolerance,
                    "{freedom} {x}: {seen} {expected}"
                );
            }
        }
    }
}
