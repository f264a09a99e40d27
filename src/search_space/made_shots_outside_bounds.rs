//! A check of the bracket: shots from outside it that go in nevertheless.

use super::simulated_release_ranges::TablePlan;
use crate::shooter::{Nominal, Profile};
use crate::units::DEGREE_RAD;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde::Serialize;

/// Shots of each random stream.
const BLOCK: u64 = 4096;
/// Polar angles beyond the bracket that are sampled, on each side, rad.
const POLAR_MARGIN_RAD: f64 = 20.0 * DEGREE_RAD;

/// The result of [`sample_wide`].
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WideSample {
    /// Shots drawn uniformly from a box wider than the bracket.
    pub drawn: u64,
    /// Those outside the bracket. All of them were simulated.
    pub outside: u64,
    /// Those of them that were made and are no faster than the search allows: 0 if the bracket
    /// misses no makes.
    pub made_outside: u64,
    /// Those that were made and are faster than the search allows: high lobs from near the hoop.
    pub made_too_fast: u64,
}

/// Draws `shots` uniformly: speeds from half to 1.3 times those of the bracket, all its pitch
/// angles and backspins, and 20 degrees more of polar angle on both sides. Simulates those outside
/// the bracket.
#[must_use]
pub fn sample_wide(profile: &Profile, plan: &TablePlan, shots: u64) -> WideSample {
    let (polar_low, polar_high) = plan.bracket.polar_rad;
    let speeds = (
        0.5 * plan.nominal.speed.low,
        1.3 * plan.bracket.speed_max_m_s,
    );
    let sample_block = |block: u64| {
        let mut random = ChaCha12Rng::seed_from_u64(profile.search().seed);
        random.set_stream(block);
        let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
        let (mut outside, mut made, mut too_fast) = (0, 0, 0);
        for _ in 0..BLOCK.min(shots - block * BLOCK) {
            let nominal = Nominal {
                speed_m_s: between(speeds.0, speeds.1),
                pitch_rad: between(plan.pitch.low, plan.pitch.high),
                polar_rad: between(polar_low - POLAR_MARGIN_RAD, polar_high + POLAR_MARGIN_RAD),
                backspin_rad_s: between(plan.backspin.low, plan.backspin.high),
                ..Nominal::default()
            };
            if !plan.bracket.contains(&nominal) {
                outside += 1;
                let start = profile.release(&nominal).state();
                if profile.simulator().verdict(start).made {
                    if nominal.speed_m_s > plan.bracket.speed_max_m_s {
                        too_fast += 1;
                    } else {
                        made += 1;
                    }
                }
            }
        }
        (outside, made, too_fast)
    };
    let (outside, made_outside, made_too_fast) = (0..shots.div_ceil(BLOCK))
        .into_par_iter()
        .map(sample_block)
        .reduce(|| (0, 0, 0), |a, b| (a.0 + b.0, a.1 + b.1, a.2 + b.2));
    WideSample {
        drawn: shots,
        outside,
        made_outside,
        made_too_fast,
    }
}
