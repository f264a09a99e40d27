//! The probability of making a shot for each draw of the posterior, from one sample of simulated
//! shots.
//!
//! The shots are drawn once, about one aim and with a wider scatter than that of the draws. For
//! each draw, a shot counts with the ratio of the densities (self-normalised importance sampling;
//! Owen, *Monte Carlo theory, methods and examples*, 2013, chapter 9). All draws share the shots,
//! so their differences hardly have a numerical error.
//!
//! Where draws have rings of their own, each shot is simulated under three of them, and P of a draw
//! is the parabola through its P under these.
//!
//! Where draws have heavier tails than normal ones, the shots are a mixture of three normal
//! distributions, two of them wider, so that no far shot has a great weight.

use super::interval::Interval;
use super::measured_release::{Values, nominal_of};
use super::posterior::Draw;
use crate::dynamics::{BatchWorkspace, ReleaseWithoutSpeed, Simulator};
use crate::math::exponential::exponential;
use crate::math::normal_distribution::quantile;
use crate::math::real::{Real, SimdReal};
use crate::math::simd::F64x8;
use crate::math::sobol::{ScrambleKey, Sobol};
use crate::model::SolidId;
use crate::shooter::Profile;
use fearless_simd::{Level, Simd};
use nalgebra::SMatrix;
use rayon::prelude::*;
use std::ops::Range;

/// Scrambles of the sample. Their spread is the numerical error.
const REPLICATES: usize = 8;
/// How much wider the scatter of the sample is than that of a draw with a wide one.
const WIDENING: f64 = 1.1;
/// For heavy tails: how much wider still the parts of the sample are, and the shares of the shots,
/// each a run of Sobol points of a power of two.
const TAIL_WIDENINGS: [f64; 3] = [1.0, 2.0, 4.5];
const TAIL_SHARES: [f64; 3] = [0.5, 0.25, 0.25];

/// Simulated shots that are weighted for the draws.
pub struct WeightedShots {
    centre: Values,
    scales: Values,
    /// Deviations of each shot from the centre in units of the scales, of each of the four values.
    /// The shots stand replicate by replicate.
    deviations: [Vec<f64>; 4],
    /// Twice the logarithm of the density of each shot's deviations; a common constant is left out.
    log_densities: Vec<f64>,
    /// The restitutions of the ring; a single one where no draw has its own.
    rings: Vec<f64>,
    /// For each ring, 1 for a made shot, else 0.
    made: Vec<Vec<f64>>,
    level: Level,
}

/// Rings of a sample, at most; and how far they lie apart, in standard deviations of the draws'.
const RINGS: usize = 3;
const RING_STEP: f64 = 1.5;
/// Rings that differ by less are one.
const SAME_RING: f64 = 1e-4;
/// What the ring of a gym may have.
pub(super) const RING_RANGE: (f64, f64) = (0.2, 0.98);

/// The simulator of a profile under a ring of this restitution, or under its own.
pub(super) fn under_ring(profile: &Profile, restitution: Option<f64>) -> Simulator {
    let mut physics = profile.physics().clone();
    if let Some(restitution) = restitution {
        let (low, high) = RING_RANGE;
        let set = physics.set_restitution_on(SolidId::Ring, restitution.clamp(low, high));
        debug_assert!(set.is_ok(), "the range is that of restitutions");
    }
    Simulator::new(&physics)
        .unwrap_or_else(|_| profile.simulator().clone())
        .counting_with(profile.simulator())
}

/// The rings under which shots are simulated for draws.
fn rings_of(profile: &Profile, draws: &[Draw]) -> Vec<f64> {
    let of_draws: Vec<f64> = draws
        .iter()
        .filter_map(|draw| draw.ring_restitution)
        .collect();
    if of_draws.is_empty() {
        return vec![profile.physics().restitution_on(SolidId::Ring)];
    }
    let Interval { mean, sd, .. } = Interval::of(of_draws);
    let step = RING_STEP * sd;
    let (low, high) = RING_RANGE;
    if step < SAME_RING {
        return vec![mean];
    }
    let middle = mean.clamp(low + step, (high - step).max(low + step));
    vec![middle - step, middle, middle + step]
}

/// The weights of the values at `nodes` in that at `x` of the polynomial through them.
pub(super) fn lagrange<const N: usize>(nodes: &[f64], x: f64) -> [f64; N] {
    std::array::from_fn(|k| match nodes.get(k) {
        None => 0.0,
        Some(node) => {
            let others = nodes.iter().enumerate().filter(|(other, _)| *other != k);
            others
                .map(|(_, other)| (x - other) / (node - other))
                .product()
        }
    })
}

/// Twice the logarithm of the density that deviations are drawn from, without a constant.
fn twice_log_density(z: &Values, is_heavy: bool) -> f64 {
    let square: f64 = z.iter().map(|z| z * z).sum();
    if !is_heavy {
        return -square;
    }
    let parts = TAIL_WIDENINGS.iter().zip(TAIL_SHARES);
    let density: f64 = parts
        .map(|(wide, share)| {
            let volume = wide * wide * wide * wide;
            share / volume * libm::exp(-0.5 * square / (wide * wide))
        })
        .sum();
    2.0 * libm::log(density)
}

/// How much wider than usual the part of the sample is that a point belongs to.
fn tail_widening(index: u32, points: u32) -> f64 {
    let share = f64::from(index) / f64::from(points);
    let part = TAIL_SHARES.iter().scan(0.0, |sum, part| {
        *sum += part;
        Some(*sum)
    });
    let number = part.take_while(|end| share >= *end).count();
    TAIL_WIDENINGS[number.min(TAIL_WIDENINGS.len() - 1)]
}

/// P of each draw.
#[derive(Clone, Debug)]
pub struct DrawProbabilities {
    /// P of each draw.
    pub of_draws: Vec<f64>,
    /// The mean over the draws of each replicate.
    replicate_means: Vec<f64>,
}

impl DrawProbabilities {
    /// Of known values, without numerical error.
    #[cfg(test)]
    pub(crate) fn of_values(of_draws: Vec<f64>) -> Self {
        let mean = of_draws.iter().sum::<f64>() / of_draws.len() as f64;
        Self {
            of_draws,
            replicate_means: vec![mean; 2],
        }
    }

    /// P over the draws.
    #[must_use]
    pub fn interval(&self) -> Interval {
        Interval::of(self.of_draws.clone())
    }

    /// The numerical standard error of the mean: that of the simulation, and that of a finite
    /// number of draws (which are nearly independent).
    #[must_use]
    pub fn numerical_standard_error(&self) -> f64 {
        let variance_of_mean = |values: &[f64]| {
            let spread = Interval::of(values.to_vec());
            spread.sd * spread.sd / values.len() as f64
        };
        (variance_of_mean(&self.replicate_means) + variance_of_mean(&self.of_draws)).sqrt()
    }

    /// The standard error of the mean that the simulated shots give.
    #[must_use]
    pub fn simulation_standard_error(&self) -> f64 {
        let spread = Interval::of(self.replicate_means.clone());
        spread.sd / (self.replicate_means.len() as f64).sqrt()
    }

    /// The share of the draws in which this, a difference, is positive.
    #[must_use]
    pub fn share_positive(&self) -> f64 {
        self.share_above(0.0)
    }

    /// The share of the draws in which this is above a limit.
    #[must_use]
    pub fn share_above(&self, limit: f64) -> f64 {
        let above = self.of_draws.iter().filter(|p| **p > limit).count();
        above as f64 / self.of_draws.len() as f64
    }

    /// Draw by draw, this less `other`.
    #[must_use]
    pub fn minus(&self, other: &Self) -> Self {
        let subtract = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect();
        Self {
            of_draws: subtract(&self.of_draws, &other.of_draws),
            replicate_means: subtract(&self.replicate_means, &other.replicate_means),
        }
    }
}

impl WeightedShots {
    /// Simulates about `shots` shots from the profile's location about the aims `means`, with the
    /// scatter of the widest draws at a place and that of the aims together.
    #[must_use]
    pub fn simulate(
        profile: &Profile,
        (draws, place): (&[Draw], usize),
        means: &[Values],
        shots: usize,
        seed: u64,
    ) -> Self {
        let sds: Vec<Values> = draws.iter().map(|draw| draw.sds_at(place)).collect();
        let mut centre = [0.0; 4];
        let mut scales = [0.0; 4];
        for i in 0..4 {
            let of_means = Interval::of(means.iter().map(|mean| mean[i]).collect());
            centre[i] = of_means.mean;
            // A sample narrower than a draw has few shots, with great weights, where that draw has
            // many.
            let wide = Interval::of(sds.iter().map(|sds| sds[i]).collect()).high;
            scales[i] = WIDENING * (wide * wide + of_means.sd * of_means.sd).sqrt();
        }
        let points = (shots / REPLICATES).max(LANES).next_power_of_two() as u32;
        let sobol = Sobol::new();
        let release = profile.release(&nominal_of(&centre));
        let position_m = release.position_m();
        let is_heavy = draws.iter().any(|draw| draw.tail_weight > 0.0);
        let rings = rings_of(profile, draws);
        let under: Vec<Simulator> = rings
            .iter()
            .map(|&ring| under_ring(profile, Some(ring)))
            .collect();
        let parts: Vec<(Vec<Values>, Vec<Vec<f64>>)> = (0..REPLICATES as u64)
            .into_par_iter()
            .map_init(BatchWorkspace::default, |workspace, replicate| {
                let scramble = sobol.scrambled(ScrambleKey { seed, replicate });
                let deviations: Vec<Values> = (0..points)
                    .map(|index| {
                        let wide = if is_heavy {
                            tail_widening(index, points)
                        } else {
                            1.0
                        };
                        std::array::from_fn(|k| wide * quantile(scramble.point(index, k)))
                    })
                    .collect();
                let starts: Vec<_> = deviations
                    .iter()
                    .map(|deviations| {
                        let value = |i: usize| centre[i] + scales[i] * deviations[i];
                        let shot = profile.release(&nominal_of(&std::array::from_fn(value)));
                        ReleaseWithoutSpeed::at(position_m, &shot)
                            .state(shot.speed_m_s, shot.backspin_rad_s)
                    })
                    .collect();
                let mut made_under = |simulator: &Simulator| {
                    let verdicts = simulator.finite_verdicts(&starts, workspace);
                    let made = verdicts.iter().map(|verdict| verdict.made);
                    made.map(|made| f64::from(u8::from(made)))
                        .collect::<Vec<f64>>()
                };
                let made = under.iter().map(&mut made_under).collect();
                (deviations, made)
            })
            .collect();
        let (deviations, made): (Vec<_>, Vec<Vec<Vec<f64>>>) = parts.into_iter().unzip();
        let deviations = deviations.concat();
        let made_under = |ring: usize| {
            let of_ring = made.iter().flat_map(|replicate| &replicate[ring]);
            of_ring.copied().collect()
        };
        let density = |z: &Values| twice_log_density(z, is_heavy);
        Self {
            centre,
            scales,
            log_densities: deviations.par_iter().map(density).collect(),
            deviations: std::array::from_fn(|i| deviations.iter().map(|z| z[i]).collect()),
            made: (0..rings.len()).map(made_under).collect(),
            rings,
            level: Level::new(),
        }
    }

    /// P of each draw, with the aim `mean` and the Cholesky factor `factor` that the functions give
    /// for it.
    pub fn probabilities(
        &self,
        draws: &[Draw],
        mean: impl Fn(&Draw) -> Values + Sync,
        factor: impl Fn(&Draw) -> SMatrix<f64, 4, 4> + Sync,
    ) -> DrawProbabilities {
        let all: Vec<[(f64, f64); REPLICATES]> = draws
            .par_iter()
            .map(|draw| self.weighted_counts(draw, &mean(draw), &factor(draw)))
            .collect();
        let share = |counts: &mut dyn Iterator<Item = (f64, f64)>| {
            let (mut made, mut total) = (0.0, 0.0);
            for (m, t) in counts {
                made += m;
                total += t;
            }
            // A parabola may leave the range.
            if total > 0.0 {
                (made / total).clamp(0.0, 1.0)
            } else {
                0.0
            }
        };
        DrawProbabilities {
            of_draws: all
                .iter()
                .map(|counts| share(&mut counts.iter().copied()))
                .collect(),
            replicate_means: (0..REPLICATES)
                .map(|replicate| {
                    let shares = all
                        .iter()
                        .map(|counts| share(&mut [counts[replicate]].into_iter()));
                    shares.sum::<f64>() / all.len() as f64
                })
                .collect(),
        }
    }

    /// The weight of the made shots and of all shots of each replicate.
    fn weighted_counts(
        &self,
        draw: &Draw,
        mean: &Values,
        factor: &SMatrix<f64, 4, 4>,
    ) -> [(f64, f64); REPLICATES] {
        // u = L^-1 (x - mean), with x = centre + scales z, is lower triangular in z.
        let Some(inverse) = factor.solve_lower_triangular(&SMatrix::<f64, 4, 4>::identity()) else {
            return [(0.0, 0.0); REPLICATES];
        };
        let mut offset = [0.0; 4];
        let mut slopes = [[0.0; 4]; 4];
        for i in 0..4 {
            for j in 0..=i {
                offset[i] += inverse[(i, j)] * (self.centre[j] - mean[j]);
                slopes[i][j] = inverse[(i, j)] * self.scales[j];
            }
        }
        let density = TargetDensity {
            offset,
            slopes,
            tail_weight: draw.tail_weight,
        };
        let parts: [f64; RINGS] = match draw.ring_restitution {
            Some(ring) if self.rings.len() > 1 => lagrange(&self.rings, ring),
            // Of a sample for draws with rings, that in the middle.
            _ => std::array::from_fn(|k| f64::from(u8::from(k == self.rings.len() / 2))),
        };
        let points = self.log_densities.len() / REPLICATES;
        std::array::from_fn(|replicate| {
            let range = replicate * points..(replicate + 1) * points;
            let (made, total) = fearless_simd::dispatch!(
                self.level,
                simd => self.weight_sums(simd, &density, range)
            );
            let made = made.iter().zip(parts).map(|(made, part)| part * made);
            (made.sum(), total)
        })
    }

    /// The weight of the shots that are made under each ring, and of all shots of a range, whose
    /// length is a multiple of the lanes.
    #[inline(always)]
    fn weight_sums<S: Simd>(
        &self,
        simd: S,
        density: &TargetDensity,
        range: Range<usize>,
    ) -> ([f64; RINGS], f64) {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut made = [F64x8::broadcast(simd, 0.0); RINGS];
                let mut total = F64x8::broadcast(simd, 0.0);
                for first in range.step_by(LANES) {
                    let at = |values: &[f64]| F64x8::load(simd, &values[first..]);
                    // Not by `map`: its closure is not inlined, which takes twice the time.
                    let [a, b, c, d] = &self.deviations;
                    let z = [at(a), at(b), at(c), at(d)];
                    let weight = exponential(
                        (density.twice_logarithm(simd, z) - at(&self.log_densities)) * 0.5,
                    );
                    for (made, of_ring) in made.iter_mut().zip(&self.made) {
                        *made += weight * at(of_ring);
                    }
                    total += weight;
                }
                let sum = |lanes: F64x8<S>| {
                    let mut each = [0.0; LANES];
                    lanes.store(&mut each);
                    each.iter().sum::<f64>()
                };
                (made.map(sum), sum(total))
            },
        )
    }
}

/// Shots that are weighted at a time.
const LANES: usize = 8;

/// The density of a draw's releases over the deviations of a sample.
struct TargetDensity {
    /// `u = offset + slopes z` has independent values of unit variance.
    offset: [f64; 4],
    slopes: [[f64; 4]; 4],
    /// One over the degrees of freedom.
    tail_weight: f64,
}

impl TargetDensity {
    /// Twice the logarithm, without a constant.
    #[inline(always)]
    fn twice_logarithm<S: Simd>(&self, simd: S, z: [F64x8<S>; 4]) -> F64x8<S> {
        let mut square = F64x8::broadcast(simd, 0.0);
        for i in 0..4 {
            let mut u = F64x8::broadcast(simd, self.offset[i]);
            for (z, slope) in z.iter().zip(&self.slopes[i][..=i]) {
                u += *z * *slope;
            }
            square += u.squared();
        }
        if self.tail_weight == 0.0 {
            return -square;
        }
        // The t density of four values whose covariance is that of the factor.
        let ratio = self.tail_weight / (1.0 - 2.0 * self.tail_weight);
        let mut each = [0.0; LANES];
        square.store(&mut each);
        for square in &mut each {
            *square = -(1.0 / self.tail_weight + 4.0) * libm::log1p(ratio * *square);
        }
        F64x8::load(simd, &each)
    }
}
