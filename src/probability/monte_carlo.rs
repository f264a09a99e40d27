//! P of one nominal shot by plain Monte Carlo: slow, and independent of the Sobol points, the
//! inverse normal and the table. It is what the others are checked against.
//!
//! Each block of samples has a random stream of its own, keyed by (seed, block), so the number of
//! threads changes nothing.

use crate::dynamics::{Room, Simulator, State};
use crate::profile::{Nominal, Profile};
use rand::SeedableRng;
use rand::rngs::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;

/// Samples of one stream.
const BLOCK: u64 = 4096;

/// P and its binomial standard error from `samples` shots.
#[must_use]
pub fn estimate(
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    samples: u64,
    seed: u64,
) -> (f64, f64) {
    let made: u64 = (0..samples.div_ceil(BLOCK))
        .into_par_iter()
        .map_init(Room::default, |room, block| {
            let mut random = ChaCha12Rng::seed_from_u64(seed);
            random.set_stream(block);
            let count = BLOCK.min(samples - block * BLOCK);
            let starts: Vec<State> = (0..count)
                .map(|_| {
                    profile
                        .release(&draw(profile, nominal, &mut random))
                        .state()
                })
                .collect();
            simulator
                .verdicts(&starts, room)
                .iter()
                .filter(|verdict| verdict.made)
                .count() as u64
        })
        .sum();
    let p = made as f64 / samples as f64;
    (p, (p * (1.0 - p) / samples as f64).sqrt())
}

fn draw(profile: &Profile, nominal: &Nominal, random: &mut ChaCha12Rng) -> Nominal {
    let errors = &profile.shooter.errors;
    let mut normal = |mean: f64, sigma: f64| {
        let z: f64 = StandardNormal.sample(random);
        mean + sigma * z
    };
    Nominal {
        speed_m_s: normal(nominal.speed_m_s, errors.speed_m_s(nominal.speed_m_s)),
        pitch_rad: normal(nominal.pitch_rad, errors.c20_rad),
        polar_rad: normal(nominal.polar_rad, errors.c30_rad),
        backspin_rad_s: normal(
            nominal.backspin_rad_s,
            errors.backspin_rad_s(nominal.backspin_rad_s),
        ),
    }
}
