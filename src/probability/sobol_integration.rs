//! The probability of one nominal shot by scrambled Sobol points, transformed to normal errors.
//!
//! [`REPLICATES`] independent scrambles with the same number of points each give one mean. The mean
//! of these is P, and their scatter gives its standard error (Owen 1997). Points are doubled until
//! the error is small enough. If a doubling reduces the error to less than half, the scatter was
//! small by chance: no rule for made and missed shots gains that much. Then half of the last error
//! is reported.

use super::made_shot_counts::Counts;
use super::probability_and_error::Estimate;
use super::progress::Progress;
use crate::dynamics::{BatchWorkspace, Release};
use crate::math::sobol::{Scramble, ScrambleKey, Sobol};
use crate::model::BallState;
use crate::shooter::{Nominal, Profile, ReleaseDistribution};
use rayon::prelude::*;
use std::ops::Range;

/// Independent scrambles.
pub const REPLICATES: u64 = 32;
/// Least number of shots of an estimate.
pub const MIN_SHOTS: u64 = 2 * REPLICATES;
/// Greatest number of shots of an estimate. Then the wanted standard error is given up.
pub const MAX_SHOTS: u64 = REPLICATES << 21;
/// Points of the first round of each replicate.
const FIRST_POINTS: u32 = 512;
/// Least and greatest number of points of one parallel block.
const MIN_BLOCK: usize = 256;
/// See [`MIN_BLOCK`].
const MAX_BLOCK: usize = 16_384;
/// A block of so many points fills the lanes well: blocks are not made smaller only to have several
/// of them for each thread.
const FULL_BLOCK: usize = 4096;
/// Blocks for each thread, where there are points enough, so that all threads end at about the same
/// time.
const BLOCKS_PER_THREAD: usize = 4;

/// The number of points of a block, of `total` that are simulated. No result depends on it.
fn block_size(total: usize) -> usize {
    let of_thread = total / rayon::current_num_threads();
    (of_thread / BLOCKS_PER_THREAD)
        .max(of_thread.min(FULL_BLOCK))
        .clamp(MIN_BLOCK, MAX_BLOCK)
}

/// The parts of a range of points, where each shot has `points` of them: the index of a shot, and
/// its points.
fn parts(range: Range<usize>, points: usize) -> impl Iterator<Item = (usize, Range<usize>)> {
    (range.start / points..range.end.div_ceil(points)).map(move |shot| {
        let first = shot * points;
        let begin = range.start.max(first) - first;
        let end = range.end.min(first + points) - first;
        (shot, begin..end)
    })
}

/// Memory that a thread reuses for its blocks.
#[derive(Default)]
struct BlockMemory {
    starts: Vec<BallState>,
    workspace: BatchWorkspace,
}

/// Draws releases about nominal shots of one profile.
#[derive(Debug)]
pub struct Sampler<'a> {
    profile: &'a Profile,
    sobol: Sobol,
}

impl<'a> Sampler<'a> {
    /// A sampler for the errors and the location of a profile.
    #[must_use]
    pub fn new(profile: &'a Profile) -> Self {
        Self {
            profile,
            sobol: Sobol::new(),
        }
    }

    /// A scramble of the points that releases are drawn with.
    #[must_use]
    pub fn scramble(&self, key: ScrambleKey) -> Scramble {
        self.sobol.scrambled(key)
    }

    /// Release number `index` of a scramble about a nominal shot.
    #[must_use]
    pub fn release(&self, nominal: &Nominal, index: u32, scramble: &Scramble) -> Release {
        let distribution = ReleaseDistribution::new(self.profile, nominal);
        distribution.from_uniform(|dimension| scramble.point(index, dimension))
    }

    /// Sample number `index` of those that [`Sampler::estimate`] draws with a seed: point
    /// `index / REPLICATES` of replicate `index % REPLICATES`.
    #[must_use]
    pub fn sample(&self, nominal: &Nominal, seed: u64, index: u64) -> Release {
        let scramble = self.scramble(ScrambleKey {
            seed,
            replicate: index % REPLICATES,
        });
        self.release(nominal, (index / REPLICATES) as u32, &scramble)
    }

    /// Counts for the points `from..to` of each nominal shot with its scramble, on the current
    /// rayon pool. The points of all shots go into common blocks.
    pub(crate) fn counts(
        &self,
        shots: &[(&Nominal, &Scramble)],
        (from, to): (u32, u32),
        progress: &dyn Progress,
    ) -> Vec<Counts> {
        let points = (to - from) as usize;
        let total = points * shots.len();
        let block = block_size(total);
        let counts_of_blocks: Vec<Vec<(usize, Counts)>> = (0..total.div_ceil(block))
            .into_par_iter()
            .map_init(BlockMemory::default, |memory, number| {
                let begin = number * block;
                let end = (begin + block).min(total);
                let parts = parts(begin..end, points).map(|(shot, part)| {
                    let range = (from + part.start as u32, from + part.end as u32);
                    (shot, range)
                });
                let counts = self.count_block(shots, parts, memory);
                progress.advance((end - begin) as u64);
                counts
            })
            .collect();
        let mut counts = vec![Counts::default(); shots.len()];
        for (shot, of_part) in counts_of_blocks.into_iter().flatten() {
            counts[shot] = counts[shot].plus(of_part);
        }
        counts
    }

    /// Counts for some points of some shots, on this thread: each part is the index of a shot and
    /// a range of points.
    fn count_block(
        &self,
        shots: &[(&Nominal, &Scramble)],
        parts: impl Iterator<Item = (usize, (u32, u32))>,
        memory: &mut BlockMemory,
    ) -> Vec<(usize, Counts)> {
        let BlockMemory { starts, workspace } = memory;
        starts.clear();
        let drawn: Vec<(usize, Range<usize>)> = parts
            .map(|(shot, points)| {
                let before = starts.len();
                let (nominal, scramble) = shots[shot];
                let distribution = ReleaseDistribution::new(self.profile, nominal);
                distribution.for_each_state(scramble, points, |state| starts.push(state));
                (shot, before..starts.len())
            })
            .collect();
        let verdicts = self.profile.simulator().finite_verdicts(starts, workspace);
        drawn
            .into_iter()
            .map(|(shot, range)| (shot, Counts::of(&verdicts[range])))
            .collect()
    }

    /// P of a nominal shot with at most the standard error `target`. The points are doubled until
    /// it is met, or until [`MAX_SHOTS`] are reached: look at the standard error.
    #[must_use]
    pub fn estimate(
        &self,
        nominal: &Nominal,
        target: f64,
        seed: u64,
        progress: &dyn Progress,
    ) -> Estimate {
        self.estimate_within(nominal, target, MAX_SHOTS, seed, progress)
    }

    /// As [`Sampler::estimate`], with at most `budget` shots (and at least [`MIN_SHOTS`]).
    #[must_use]
    pub fn estimate_within(
        &self,
        nominal: &Nominal,
        target: f64,
        budget: u64,
        seed: u64,
        progress: &dyn Progress,
    ) -> Estimate {
        let max_points = (budget.clamp(MIN_SHOTS, MAX_SHOTS) / REPLICATES) as u32;
        let first_points = FIRST_POINTS.min(1 << max_points.ilog2());
        let scrambles: Vec<Scramble> = (0..REPLICATES)
            .map(|replicate| self.scramble(ScrambleKey { seed, replicate }))
            .collect();
        let shots: Vec<(&Nominal, &Scramble)> = scrambles.iter().map(|s| (nominal, s)).collect();
        let mut counts = vec![Counts::default(); scrambles.len()];
        let mut points = 0;
        let mut last_error = 0.0;
        let certain = ReleaseDistribution::new(self.profile, nominal).is_certain();
        loop {
            let more = if points == 0 { first_points } else { points };
            progress.begin("integrating", u64::from(more) * REPLICATES);
            let new = self.counts(&shots, (points, points + more), progress);
            progress.end();
            for (sum, new) in counts.iter_mut().zip(new) {
                *sum = sum.plus(new);
            }
            points += more;
            let mut estimate = Estimate::from_replicates(&counts, u64::from(points));
            estimate.certain = certain;
            estimate.standard_error = if certain {
                0.0
            } else {
                estimate.standard_error.max(0.5 * last_error)
            };
            last_error = estimate.standard_error;
            if estimate.standard_error <= target || points > max_points / 2 {
                return estimate;
            }
        }
    }
}
