//! P of one nominal shot by plain Monte Carlo: slow, and independent of the Sobol points, the
//! inverse normal and the table. It is what the others are checked against.
//!
//! Each block of samples has a random stream of its own, keyed by (seed, block), so the number of
//! threads changes nothing.

use super::Progress;
use super::estimate::{About, Counts, Estimate, summarise};
use crate::dynamics::{Release, Room, Simulator, State};
use crate::profile::{Nominal, Profile};
use rand::SeedableRng;
use rand::rngs::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

/// Samples of one stream.
const BLOCK: u64 = 4096;

/// Samples of the pilot from which the number of samples is taken.
const PILOT: u64 = 4 * BLOCK;

/// P to the standard error `target`, with `budget` samples at most. A pilot says how many it takes; it is
/// the beginning of the same streams.
#[must_use]
pub fn estimate_within(
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    target: f64,
    budget: u64,
    seed: u64,
    progress: &dyn Progress,
) -> Estimate {
    let mut samples = PILOT.min(budget);
    loop {
        let found = estimate(profile, simulator, nominal, samples, seed, progress);
        if found.standard_error <= target || samples >= budget {
            return found;
        }
        let times = (found.standard_error / target).powi(2) * 1.02;
        samples = ((samples as f64 * times) as u64).clamp(samples + 1, budget);
    }
}

/// P and its binomial standard error from `samples` shots.
#[must_use]
pub fn estimate(
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    samples: u64,
    seed: u64,
    progress: &dyn Progress,
) -> Estimate {
    let about = About::new(profile, nominal);
    progress.begin("sampling", samples);
    let counts = (0..samples.div_ceil(BLOCK))
        .into_par_iter()
        .map_init(Room::default, |room, block| {
            let mut random = stream(seed, block);
            let count = BLOCK.min(samples - block * BLOCK);
            let starts: Vec<State> = (0..count)
                .map(|_| draw(&about, &mut random).state())
                .collect();
            let counts = Counts::of(simulator.verdicts(&starts, room));
            progress.advance(count);
            counts
        })
        .reduce(Counts::default, Counts::plus);
    progress.end();
    let found = summarise(&[counts], samples);
    let p = found.probability;
    Estimate {
        standard_error: (p * (1.0 - p) / samples as f64).sqrt(),
        certain: about.is_certain(),
        ..found
    }
}

/// Sample number `index` of a seed.
#[must_use]
pub fn sample(profile: &Profile, nominal: &Nominal, seed: u64, index: u64) -> Release {
    let about = About::new(profile, nominal);
    let mut random = stream(seed, index / BLOCK);
    for _ in 0..index % BLOCK {
        let _ = draw(&about, &mut random);
    }
    draw(&about, &mut random)
}

fn stream(seed: u64, block: u64) -> ChaCha12Rng {
    let mut random = ChaCha12Rng::seed_from_u64(seed);
    random.set_stream(block);
    random
}

/// Nine normals for every sample, whether they count or not, so that a sample's errors do not depend on
/// which others there are.
fn draw(about: &About, random: &mut ChaCha12Rng) -> Release {
    about.with_normals(std::array::from_fn(|_| StandardNormal.sample(random)))
}
