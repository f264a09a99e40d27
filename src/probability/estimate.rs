//! The probability of one nominal shot, by scrambled Sobol points drawn from the normal.
//!
//! [`REPLICATES`] independent scrambles of the same number of points each give one mean; their mean
//! is P and their scatter its standard error (Owen 1997). Points are doubled until the error is met.
//! An error that more than halves with that is a lucky scatter: no rule for a made or missed shot
//! gains that much, so half the last error is stated instead. Made shots are counted as whole
//! numbers, so the order in which blocks finish changes nothing.

use super::sobol::{Key, Scramble, Sobol};
use super::{Progress, normal};
use crate::dynamics::{Ending, Kind, Release, Room, Simulator, State};
use crate::profile::{Nominal, Profile};
use rayon::prelude::*;
use serde::Serialize;

/// Independent scrambles.
pub const REPLICATES: u64 = 32;
/// Points of the first round of each replicate.
const FIRST_POINTS: u32 = 512;
/// Least and most points of one parallel block: small enough to keep every thread busy, large enough for
/// the lanes.
const BLOCK: (u32, u32) = (256, 2048);
/// Points of one replicate at most: the target is given up there.
const MOST_POINTS: u32 = 1 << 21;

/// P of one nominal shot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Estimate {
    /// Probability of making the shot.
    pub probability: f64,
    /// Its standard error, from the scatter of the replicates.
    pub standard_error: f64,
    /// Shots simulated.
    pub shots: u64,
    /// Parts of all shots by the way they were made; they sum to `probability`.
    pub shares: Shares,
    /// Shots that the numerics gave up; counted neither as made nor hidden.
    pub unresolved: u64,
}

/// Parts of all shots, by the way they were made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Shares {
    /// Nothing touched.
    pub swish: f64,
    /// Off the ring, the board not first.
    pub ring: f64,
    /// The board first.
    pub board: f64,
}

/// Whole-number counts of a block of shots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    swish: u64,
    ring: u64,
    board: u64,
    unresolved: u64,
}

impl Counts {
    pub(super) fn made(&self) -> u64 {
        self.swish + self.ring + self.board
    }

    fn plus(self, other: Self) -> Self {
        Self {
            swish: self.swish + other.swish,
            ring: self.ring + other.ring,
            board: self.board + other.board,
            unresolved: self.unresolved + other.unresolved,
        }
    }
}

/// Draws releases about nominal shots of one profile.
#[derive(Debug)]
pub struct Sampler<'a> {
    profile: &'a Profile,
    simulator: &'a Simulator,
    sobol: Sobol,
}

impl<'a> Sampler<'a> {
    /// A sampler for a profile's errors and place.
    #[must_use]
    pub fn new(profile: &'a Profile, simulator: &'a Simulator) -> Self {
        Self {
            profile,
            simulator,
            sobol: Sobol::new(),
        }
    }

    /// A scramble of the points that releases are drawn by.
    #[must_use]
    pub fn scramble(&self, key: Key) -> Scramble {
        self.sobol.scrambled(key)
    }

    /// Release number `index` of a scramble about a nominal shot.
    #[must_use]
    pub fn release(&self, nominal: &Nominal, index: u32, scramble: &Scramble) -> Release {
        let errors = &self.profile.shooter.errors;
        let draw = |dimension, sigma: f64| {
            if sigma > 0.0 {
                sigma * normal::quantile(scramble.point(index, dimension))
            } else {
                0.0
            }
        };
        let spin_sigma = errors.backspin_rad_s(nominal.backspin_rad_s);
        self.profile.release(&Nominal {
            speed_m_s: nominal.speed_m_s + draw(0, errors.speed_m_s(nominal.speed_m_s)),
            pitch_rad: nominal.pitch_rad + draw(1, errors.c20_rad),
            polar_rad: nominal.polar_rad + draw(2, errors.c30_rad),
            backspin_rad_s: nominal.backspin_rad_s + draw(3, spin_sigma),
        })
    }

    /// Counts of the points `from..to` of one scramble.
    fn block(
        &self,
        nominal: &Nominal,
        scramble: &Scramble,
        (from, to): (u32, u32),
        room: &mut Room,
    ) -> Counts {
        let starts: Vec<State> = (from..to)
            .map(|index| self.release(nominal, index, scramble).state())
            .collect();
        let mut counts = Counts::default();
        for verdict in self.simulator.verdicts(&starts, room) {
            if verdict.ending == Ending::Unresolved {
                counts.unresolved += 1;
            } else if verdict.made {
                match Kind::of_made(&verdict.contacts) {
                    Kind::Swish => counts.swish += 1,
                    Kind::RimIn => counts.ring += 1,
                    _ => counts.board += 1,
                }
            }
        }
        counts
    }

    /// Counts of the points `from..to` of one scramble, on the current rayon pool.
    pub(super) fn count(
        &self,
        nominal: &Nominal,
        scramble: &Scramble,
        (from, to): (u32, u32),
    ) -> Counts {
        let block = ((to - from) / 8).clamp(BLOCK.0, BLOCK.1);
        (from..to)
            .into_par_iter()
            .step_by(block as usize)
            .map_init(Room::default, |room, start| {
                self.block(nominal, scramble, (start, (start + block).min(to)), room)
            })
            .reduce(Counts::default, Counts::plus)
    }

    /// P of a nominal shot to the standard error `target`, doubling the points until it is met (or
    /// the bound of 67 million shots is reached: look at the standard error).
    #[must_use]
    pub fn estimate(
        &self,
        nominal: &Nominal,
        target: f64,
        seed: u64,
        progress: &dyn Progress,
    ) -> Estimate {
        let scrambles: Vec<Scramble> = (0..REPLICATES)
            .map(|replicate| self.scramble(Key { seed, replicate }))
            .collect();
        let mut counts = vec![Counts::default(); scrambles.len()];
        let mut points = 0;
        let mut last_error = 0.0;
        loop {
            let more = if points == 0 { FIRST_POINTS } else { points };
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
            let mut estimate = summarise(&counts, points);
            estimate.standard_error = estimate.standard_error.max(0.5 * last_error);
            last_error = estimate.standard_error;
            if estimate.standard_error <= target || points >= MOST_POINTS {
                return estimate;
            }
        }
    }
}

fn summarise(counts: &[Counts], points: u32) -> Estimate {
    let n = counts.len() as f64;
    let per = f64::from(points);
    let means: Vec<f64> = counts
        .iter()
        .map(|count| count.made() as f64 / per)
        .collect();
    let probability = means.iter().sum::<f64>() / n;
    let square: f64 = means.iter().map(|mean| (mean - probability).powi(2)).sum();
    let all = counts
        .iter()
        .fold(Counts::default(), |sum, &count| sum.plus(count));
    let share = |count: u64| count as f64 / (n * per);
    Estimate {
        probability,
        standard_error: (square / (n * (n - 1.0))).sqrt(),
        shots: u64::from(points) * counts.len() as u64,
        shares: Shares {
            swish: share(all.swish),
            ring: share(all.ring),
            board: share(all.board),
        },
        unresolved: all.unresolved,
    }
}
