//! The probability of one nominal shot by plain Monte Carlo. It is slow, and independent of the
//! Sobol points, the inverse normal distribution and the table: the other methods are checked
//! against it.
//!
//! Each block of samples has a random stream of its own, keyed by (seed, block), so no result
//! depends on the number of threads.

use super::made_shot_counts::Counts;
use super::probability_and_error::{Estimate, standard_error};
use super::progress::Progress;
use crate::dynamics::{BatchWorkspace, Release};
use crate::model::BallState;
use crate::shooter::{Nominal, Profile, ReleaseDistribution};
use rand::SeedableRng;
use rand::rngs::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

/// Samples of one stream.
const BLOCK: u64 = 4096;
/// Samples of the pilot run that predicts the number of samples.
const PILOT: u64 = 4 * BLOCK;

/// P with at most the standard error `target`, from at most `budget` samples. A pilot run, the
/// beginning of the same streams, predicts how many it takes.
#[must_use]
pub fn estimate_within(
    profile: &Profile,
    nominal: &Nominal,
    target: f64,
    budget: u64,
    seed: u64,
    progress: &dyn Progress,
) -> Estimate {
    let mut samples = PILOT.min(budget);
    loop {
        let found = estimate(profile, nominal, samples, seed, progress);
        if found.standard_error <= target || samples >= budget {
            return found;
        }
        let ratio = found.standard_error / target;
        let times = ratio * ratio * 1.02;
        samples = ((samples as f64 * times) as u64).clamp(samples + 1, budget);
    }
}

/// P and its binomial standard error from `samples` shots.
#[must_use]
pub fn estimate(
    profile: &Profile,
    nominal: &Nominal,
    samples: u64,
    seed: u64,
    progress: &dyn Progress,
) -> Estimate {
    let distribution = ReleaseDistribution::new(profile, nominal);
    progress.begin("sampling", samples);
    let counts = (0..samples.div_ceil(BLOCK))
        .into_par_iter()
        .map_init(BatchWorkspace::default, |workspace, block| {
            let mut random = stream(seed, block);
            let count = BLOCK.min(samples - block * BLOCK);
            let starts: Vec<BallState> = (0..count)
                .map(|_| draw(&distribution, &mut random).state())
                .collect();
            let counts = Counts::of(profile.simulator().finite_verdicts(&starts, workspace));
            progress.advance(count);
            counts
        })
        .reduce(Counts::default, Counts::plus);
    progress.end();
    let found = Estimate::from_replicates(&[counts], samples);
    let (p, n) = (found.probability, samples as f64);
    let certain = distribution.is_certain();
    let binomial = standard_error((p * (1.0 - p) / n).sqrt(), p, n);
    Estimate {
        standard_error: if certain { 0.0 } else { binomial },
        certain,
        ..found
    }
}

/// The first `count` samples of a seed, in order.
#[must_use]
pub fn first_samples(
    profile: &Profile,
    nominal: &Nominal,
    seed: u64,
    count: usize,
) -> Vec<Release> {
    let distribution = ReleaseDistribution::new(profile, nominal);
    let count = count as u64;
    (0..count.div_ceil(BLOCK))
        .into_par_iter()
        .flat_map_iter(|block| {
            let mut random = stream(seed, block);
            let length = BLOCK.min(count - block * BLOCK);
            (0..length)
                .map(|_| draw(&distribution, &mut random))
                .collect::<Vec<_>>()
        })
        .collect()
}

/// Sample number `index` of a seed. For many samples [`first_samples`] is faster: this one draws
/// those before it in their stream.
#[must_use]
pub fn sample(profile: &Profile, nominal: &Nominal, seed: u64, index: u64) -> Release {
    let distribution = ReleaseDistribution::new(profile, nominal);
    let mut random = stream(seed, index / BLOCK);
    for _ in 0..index % BLOCK {
        let _ = draw(&distribution, &mut random);
    }
    draw(&distribution, &mut random)
}

fn stream(seed: u64, block: u64) -> ChaCha12Rng {
    let mut random = ChaCha12Rng::seed_from_u64(seed);
    random.set_stream(block);
    random
}

/// Draws nine normals for every sample, needed or not, so that an error of a sample does not depend
/// on which other errors there are.
fn draw(distribution: &ReleaseDistribution, random: &mut ChaCha12Rng) -> Release {
    distribution.from_normal(std::array::from_fn(|_| StandardNormal.sample(random)))
}
