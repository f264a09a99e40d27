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

/// Independent scrambles.
pub const REPLICATES: u64 = 32;
/// Least number of shots of an estimate.
pub const MIN_SHOTS: u64 = 2 * REPLICATES;
/// Greatest number of shots of an estimate. Then the wanted standard error is given up.
pub const MAX_SHOTS: u64 = REPLICATES << 21;
/// Points of the first round of each replicate.
const FIRST_POINTS: u32 = 512;
/// Least and greatest number of points of one parallel block: small enough to keep every thread
/// busy, large enough for the lanes.
const MIN_BLOCK: u32 = 256;
/// See [`MIN_BLOCK`].
const MAX_BLOCK: u32 = 16_384;

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

    /// Counts for the points `from..to` of one scramble, on this thread.
    fn block(
        &self,
        nominal: &Nominal,
        scramble: &Scramble,
        (from, to): (u32, u32),
        workspace: &mut BatchWorkspace,
    ) -> Counts {
        let distribution = ReleaseDistribution::new(self.profile, nominal);
        let mut starts: Vec<BallState> = Vec::with_capacity((to - from) as usize);
        distribution.for_each_state(scramble, (from, to), |state| starts.push(state));
        let simulator = self.profile.simulator();
        Counts::of(simulator.finite_verdicts(&starts, workspace))
    }

    /// Counts for the points `from..to` of one scramble, on the current rayon pool.
    pub(crate) fn count(
        &self,
        nominal: &Nominal,
        scramble: &Scramble,
        (from, to): (u32, u32),
    ) -> Counts {
        let threads = rayon::current_num_threads() as u32;
        let block = ((to - from) / threads).clamp(MIN_BLOCK, MAX_BLOCK);
        (from..to)
            .into_par_iter()
            .step_by(block as usize)
            .map_init(BatchWorkspace::default, |workspace, start| {
                self.block(
                    nominal,
                    scramble,
                    (start, (start + block).min(to)),
                    workspace,
                )
            })
            .reduce(Counts::default, Counts::plus)
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
        let mut counts = vec![Counts::default(); scrambles.len()];
        let mut points = 0;
        let mut last_error = 0.0;
        let certain = ReleaseDistribution::new(self.profile, nominal).is_certain();
        loop {
            let more = if points == 0 { first_points } else { points };
            progress.begin("integrating", u64::from(more) * REPLICATES);
            let new: Vec<Counts> = scrambles
                .par_iter()
                .map(|scramble| {
                    let counts = self.count(nominal, scramble, (points, points + more));
                    progress.advance(u64::from(more));
                    counts
                })
                .collect();
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
