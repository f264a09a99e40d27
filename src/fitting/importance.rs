//! Adaptive multiple importance sampling of a few unknowns (Cornuet et al., Scand. J. Stat. 39
//! (2012) 798): each stage draws from a distribution that the stages before it suggest, and all
//! points are weighted as draws of the mixture of all stages.

use crate::math::sobol::{ScrambleKey, Sobol};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use serde::Serialize;

/// How many points are drawn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stages {
    /// Points of a stage.
    pub(super) points: u32,
    /// Stages, always.
    pub(super) count: usize,
    /// Stages that are added while the weights are uneven.
    pub(super) more: usize,
}
/// The first stage is so much wider than the prior.
const FIRST_WIDENING: f64 = 1.5;
/// A later one is so much wider than what it goes by.
const WIDENING: f64 = 1.2;
/// The least part of the prior's variance that a later stage has in each direction.
const LEAST_VARIANCE: f64 = 0.01;
/// Weights of which so many points matter are even enough.
const ENOUGH: f64 = 250.0;
/// A stage goes by weights of which at least so many points matter.
const ENOUGH_TO_ADAPT: f64 = 30.0;

/// How evenly unknowns were sampled.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UnseenSample {
    /// Points that matter, by their weights.
    pub effective_sample_size: f64,
    /// The shape of the tail of the weights: above 0.7 a few points decide.
    pub pareto_k: f64,
}

/// A point, in scales of the prior.
pub(super) type Point = Vec<f64>;

/// Weighted points.
#[derive(Clone, Debug)]
pub(super) struct WeightedPoints {
    pub(super) points: Vec<Point>,
    /// They add up to 1.
    pub(super) weights: Vec<f64>,
}

/// The quantile of Student's t with four degrees of freedom (Shaw, J. Comput. Finance 9 (2006) 37).
pub(super) fn student_quantile(p: f64) -> f64 {
    let p = p.clamp(1e-12, 1.0 - 1e-12);
    let root = (4.0 * p * (1.0 - p)).sqrt();
    let q = libm::cos(libm::acos(root.min(1.0)) / 3.0) / root;
    (2.0 * (q - 1.0).max(0.0).sqrt()).copysign(p - 0.5)
}

/// The logarithm of its density, but for a constant.
pub(super) fn student_log_density(t: f64) -> f64 {
    -2.5 * libm::log1p(0.25 * t * t)
}

/// What a stage draws from: independent t values, moved and mixed.
struct Proposal<const D: usize> {
    middle: SVector<f64, D>,
    factor: SMatrix<f64, D, D>,
}

impl<const D: usize> Proposal<D> {
    fn point(&self, uniform: impl Fn(usize) -> f64) -> Point {
        let t = SVector::<f64, D>::from_fn(|i, _| student_quantile(uniform(i)));
        (self.middle + self.factor * t).as_slice().to_vec()
    }

    fn log_density(&self, point: &[f64]) -> f64 {
        let from_middle = SVector::<f64, D>::from_column_slice(point) - self.middle;
        let Some(t) = self.factor.solve_lower_triangular(&from_middle) else {
            return f64::NEG_INFINITY;
        };
        let determinant: f64 = self.factor.diagonal().iter().map(|x| libm::log(*x)).sum();
        t.iter().map(|t| student_log_density(*t)).sum::<f64>() - determinant
    }
}

/// The number of points that matter.
pub(super) fn effective_size(weights: &[f64]) -> f64 {
    let sum: f64 = weights.iter().sum();
    sum * sum / weights.iter().map(|w| w * w).sum::<f64>()
}

/// Points of `D` unknowns weighted by a density, whose logarithm is given but for a constant.
pub(super) fn sample<const D: usize>(
    (stages, seed): (Stages, u64),
    log_density: impl Fn(&[f64]) -> f64 + Sync,
) -> WeightedPoints {
    let sobol = Sobol::new();
    let mut proposals = vec![Proposal::<D> {
        middle: SVector::zeros(),
        factor: SMatrix::identity() * FIRST_WIDENING,
    }];
    let (mut points, mut logarithms): (Vec<Point>, Vec<f64>) = (Vec::new(), Vec::new());
    for stage in 0..stages.count + stages.more {
        let proposal = &proposals[stage];
        let key = ScrambleKey {
            seed,
            replicate: stage as u64,
        };
        let scramble = sobol.scrambled(key);
        let drawn: Vec<Point> = (0..stages.points)
            .map(|index| proposal.point(|i| scramble.point(index, i)))
            .collect();
        logarithms.par_extend(drawn.par_iter().map(|point| log_density(point)));
        points.extend(drawn);
        let weights = weights(&points, &logarithms, &proposals);
        let is_even = effective_size(&weights) >= ENOUGH;
        if stage + 1 >= stages.count && (is_even || stage + 1 == stages.count + stages.more) {
            return WeightedPoints { points, weights };
        }
        proposals.push(adapted(&points, weights));
    }
    unreachable!("the last stage returns")
}

/// The weights of all points as draws of the mixture of the proposals.
fn weights<const D: usize>(
    points: &[Point],
    logarithms: &[f64],
    proposals: &[Proposal<D>],
) -> Vec<f64> {
    let ratios: Vec<f64> = points
        .iter()
        .zip(logarithms)
        .map(|(point, log_density)| {
            let parts: Vec<f64> = proposals
                .iter()
                .map(|proposal| proposal.log_density(point))
                .collect();
            let greatest = parts.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let sum: f64 = parts.iter().map(|part| libm::exp(part - greatest)).sum();
            log_density - greatest - libm::log(sum)
        })
        .collect();
    let greatest = ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = ratios.iter().map(|r| libm::exp(r - greatest)).collect();
    let sum: f64 = weights.iter().sum();
    weights.iter().map(|weight| weight / sum).collect()
}

/// A proposal with the mean and the covariance of weighted points. Where few of them matter, their
/// weights are evened out first.
fn adapted<const D: usize>(points: &[Point], mut weights: Vec<f64>) -> Proposal<D> {
    while effective_size(&weights) < ENOUGH_TO_ADAPT {
        let least = f64::MIN_POSITIVE;
        weights
            .iter_mut()
            .for_each(|weight| *weight = weight.max(least).sqrt());
    }
    let sum: f64 = weights.iter().sum();
    let vectors = || {
        points
            .iter()
            .map(|point| SVector::<f64, D>::from_column_slice(point))
    };
    let middle = vectors()
        .zip(&weights)
        .fold(SVector::zeros(), |mean, (point, weight)| {
            mean + point * (weight / sum)
        });
    let mut covariance = SMatrix::<f64, D, D>::identity() * LEAST_VARIANCE;
    for (point, weight) in vectors().zip(&weights) {
        let from_middle = point - middle;
        covariance += from_middle * from_middle.transpose() * (weight / sum);
    }
    let cholesky = covariance.cholesky();
    let factor = cholesky.map_or_else(SMatrix::identity, |c| c.l());
    Proposal {
        middle,
        // The variance of t with four degrees of freedom is 2.
        factor: factor * (WIDENING / f64::sqrt(2.0)),
    }
}

/// `count` indices, each as often as its weight says but for less than one; `first` is a uniform
/// random number.
pub(super) fn systematic(weights: &[f64], count: usize, first: f64) -> Vec<usize> {
    let sum: f64 = weights.iter().sum();
    let step = sum / count as f64;
    let (mut next, mut reached, mut index) = (first * step, weights[0], 0);
    let mut chosen = Vec::with_capacity(count);
    while chosen.len() < count {
        if next < reached || index + 1 == weights.len() {
            chosen.push(index);
            next += step;
        } else {
            index += 1;
            reached += weights[index];
        }
    }
    chosen
}

/// The greatest weights, as a generalised Pareto distribution above a threshold, by the estimate of
/// Zhang and Stephens (Technometrics 51 (2009) 316).
struct ParetoTail {
    threshold: f64,
    shape: f64,
    scale: f64,
    /// How many weights are above the threshold.
    count: usize,
}

impl ParetoTail {
    /// `None` where the greatest weights are all equal.
    fn of(ascending: &[f64]) -> Option<Self> {
        let all = ascending.len() as f64;
        let count = ((0.2 * all).min(3.0 * all.sqrt()) as usize).max(5);
        let (below, tail) = ascending.split_at(ascending.len() - count);
        let threshold = below.last().copied().unwrap_or_default();
        let excess: Vec<f64> = tail.iter().map(|weight| weight - threshold).collect();
        let (n, most) = (excess.len() as f64, excess[excess.len() - 1]);
        if !(most > 0.0) {
            return None;
        }
        let quarter = excess[((n / 4.0 + 0.5) as usize).max(1) - 1].max(1e-12 * most);
        let grid = 30 + n.sqrt() as usize;
        let shape_of = |theta: f64| excess.iter().map(|x| libm::log1p(-theta * x)).sum::<f64>() / n;
        let candidates: Vec<(f64, f64)> = (1..=grid)
            .map(|j| {
                let theta =
                    1.0 / most + (1.0 - (grid as f64 / (j as f64 - 0.5)).sqrt()) / (3.0 * quarter);
                let shape = shape_of(theta);
                (theta, n * (libm::log(-theta / shape) - shape - 1.0))
            })
            .collect();
        let theta: f64 = candidates
            .iter()
            .map(|(theta, own)| {
                let sum: f64 = candidates
                    .iter()
                    .map(|(_, other)| libm::exp(other - own))
                    .sum();
                theta / sum
            })
            .sum();
        let shape = shape_of(theta);
        Some(Self {
            threshold,
            // Towards 0.5, as if by ten more weights.
            shape: (n * shape + 10.0 * 0.5) / (n + 10.0),
            scale: -shape / theta,
            count,
        })
    }

    fn quantile(&self, p: f64) -> f64 {
        self.threshold + self.scale * libm::expm1(-self.shape * libm::log1p(-p)) / self.shape
    }
}

/// The shape of the tail of weights: above 0.7 a few points decide (Vehtari et al., J. Mach. Learn.
/// Res. 25 (2024) 72). At least six weights.
pub(super) fn pareto_shape(weights: &[f64]) -> f64 {
    let mut sorted = weights.to_vec();
    sorted.sort_by(f64::total_cmp);
    ParetoTail::of(&sorted).map_or(0.0, |tail| tail.shape)
}

/// Weights whose greatest are those that their distribution expects in place of the drawn ones, and
/// the shape of that distribution (Pareto-smoothed importance sampling, as above).
pub(super) fn pareto_smoothed(mut weights: Vec<f64>) -> (Vec<f64>, f64) {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|a, b| weights[*a].total_cmp(&weights[*b]));
    let sorted: Vec<f64> = order.iter().map(|index| weights[*index]).collect();
    let Some(tail) = ParetoTail::of(&sorted) else {
        return (weights, 0.0);
    };
    let (first, most) = (sorted.len() - tail.count, sorted[sorted.len() - 1]);
    for (number, index) in order[first..].iter().enumerate() {
        let p = (number as f64 + 0.5) / tail.count as f64;
        weights[*index] = tail.quantile(p).min(most);
    }
    (weights, tail.shape)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Authority: tables of Student's t with four degrees of freedom (2.776 at 97.5 %, 0.741 at
    /// 75 %).
    #[test]
    fn val_student_quantile() {
        assert!((student_quantile(0.975) - 2.776).abs() < 1e-3);
        assert!((student_quantile(0.25) + 0.7407).abs() < 1e-3);
        assert!(student_quantile(0.5).abs() < 1e-6);
    }

    /// Authority: a normal density whose mean and covariance are known, narrow and far from the
    /// prior's middle. The seed is fixed.
    #[test]
    fn val_mean_and_variance_of_a_normal_density() {
        let (mean, sd) = ([2.0, -1.0, 0.5], [0.3, 0.1, 1.0]);
        let density = |x: &[f64]| -> f64 {
            let square = |i: usize| ((x[i] - mean[i]) / sd[i]) * ((x[i] - mean[i]) / sd[i]);
            -0.5 * (0..3).map(square).sum::<f64>()
        };
        let stages = Stages {
            points: 256,
            count: 3,
            more: 8,
        };
        let WeightedPoints { points, weights } = sample::<3>((stages, 1), density);
        assert!(effective_size(&weights) > 250.0);
        for i in 0..3 {
            let values = || points.iter().zip(&weights);
            let found: f64 = values().map(|(point, weight)| weight * point[i]).sum();
            assert!((found - mean[i]).abs() < 0.1 * sd[i], "{i}: {found}");
            let square = |(point, w): (&Point, &f64)| w * (point[i] - found) * (point[i] - found);
            let variance: f64 = values().map(square).sum();
            assert!(
                (variance.sqrt() / sd[i] - 1.0).abs() < 0.1,
                "{i}: {variance}"
            );
        }
    }

    /// Authority: Pareto's distribution with the survival function `x^(-1/k)` has the shape k; of
    /// 4,000 evenly spaced quantiles the tail alone is used.
    #[test]
    fn val_pareto_shape() {
        for shape in [0.2, 0.5, 0.9] {
            let quantile = |i: i32| {
                let above = 1.0 - (f64::from(i) + 0.5) / 4000.0;
                libm::pow(above, -shape)
            };
            let weights: Vec<f64> = (0..4000).map(quantile).collect();
            let found = pareto_shape(&weights);
            assert!((found - shape).abs() < 0.08, "{shape}: {found}");
        }
    }
}
