//! The probability of one nominal shot, by scrambled Sobol points drawn from the normal.
//!
//! [`REPLICATES`] independent scrambles of the same number of points each give one mean; their mean
//! is P and their scatter its standard error (Owen 1997). Points are doubled until the error is met.
//! An error that more than halves with that is a lucky scatter: no rule for a made or missed shot
//! gains that much, so half the last error is stated instead. Made shots are counted as whole
//! numbers, so the order in which blocks finish changes nothing.

use super::sobol::{Key, Scramble, Sobol};
use super::{Progress, normal};
use crate::dynamics::{Ending, Kind, Release, Room, Simulator, State, Verdict};
use crate::profile::{Correlation, ERRORS, Nominal, Profile};
use rayon::prelude::*;
use serde::Serialize;

/// Independent scrambles.
pub const REPLICATES: u64 = 32;
/// Points of the first round of each replicate.
const FIRST_POINTS: u32 = 512;
/// Least and most points of one parallel block: small enough to keep every thread busy, large enough for
/// the lanes.
const BLOCK: (u32, u32) = (256, 16_384);
/// Shots at least and at most; at the most the target is given up.
pub const LEAST_SHOTS: u64 = 2 * REPLICATES;
/// See [`LEAST_SHOTS`].
pub const MOST_SHOTS: u64 = REPLICATES << 21;

/// P of one nominal shot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
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
    /// No error counts, so that all shots are one.
    pub certain: bool,
}

impl Estimate {
    /// The interval that holds P in 95 of 100 cases: from the scatter of the replicates, and never
    /// narrower than what shots without a single exception leave open.
    #[must_use]
    pub fn interval_95(&self) -> (f64, f64) {
        // Of Student's distribution with 31 degrees of freedom.
        let half = 2.04 * self.standard_error;
        // The rule of three: nothing seen in n shots happens in less than 3 of n.
        let unseen = if self.certain {
            0.0
        } else {
            3.0 / self.shots.max(1) as f64
        };
        let all = self.probability >= 1.0;
        let none = self.probability <= 0.0;
        (
            (self.probability - half.max(if all { unseen } else { 0.0 })).max(0.0),
            (self.probability + half.max(if none { unseen } else { 0.0 })).min(1.0),
        )
    }
}

/// Parts of all shots, by the way they were made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Shares {
    /// Nothing touched.
    pub swish: f64,
    /// Off the ring, the board not first.
    pub ring: f64,
    /// The board, the ring never.
    pub board: f64,
    /// The board first, then the ring.
    pub board_and_ring: f64,
}

impl Shares {
    /// The board first.
    #[must_use]
    pub fn banked(&self) -> f64 {
        self.board + self.board_and_ring
    }
}

/// Whole-number counts of a block of shots.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    swish: u64,
    ring: u64,
    board: u64,
    board_and_ring: u64,
    unresolved: u64,
}

impl Counts {
    pub(super) fn made(&self) -> u64 {
        self.swish + self.ring + self.board + self.board_and_ring
    }

    pub(super) fn of(verdicts: &[Verdict]) -> Self {
        let mut counts = Self::default();
        for verdict in verdicts {
            if verdict.ending == Ending::Unresolved {
                counts.unresolved += 1;
            } else if verdict.made {
                match Kind::of_made(&verdict.contacts) {
                    Kind::Swish => counts.swish += 1,
                    Kind::RimIn => counts.ring += 1,
                    Kind::BankIn => counts.board += 1,
                    _ => counts.board_and_ring += 1,
                }
            }
        }
        counts
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            swish: self.swish + other.swish,
            ring: self.ring + other.ring,
            board: self.board + other.board,
            board_and_ring: self.board_and_ring + other.board_and_ring,
            unresolved: self.unresolved + other.unresolved,
        }
    }
}

/// The distribution of the releases about one nominal shot.
#[derive(Clone, Debug)]
pub struct About {
    release: Release,
    sigmas: [f64; ERRORS],
    needed: [bool; ERRORS],
    correlation: Correlation,
}

impl About {
    /// The releases of a profile's errors about a nominal shot.
    #[must_use]
    pub fn new(profile: &Profile, nominal: &Nominal) -> Self {
        let errors = &profile.shooter.errors;
        let sigmas = errors.sigmas(nominal);
        Self {
            release: profile.release(nominal),
            sigmas,
            needed: errors.correlation.needed(&sigmas),
            correlation: errors.correlation,
        }
    }

    /// Is there no error at all?
    #[must_use]
    pub fn is_certain(&self) -> bool {
        self.sigmas.iter().all(|&sigma| sigma == 0.0)
    }

    /// The release with errors from uniform numbers, 0 to 1 exclusive, one for each error that counts.
    pub fn release(&self, mut uniform: impl FnMut(usize) -> f64) -> Release {
        self.with_normals(std::array::from_fn(|k| {
            if self.needed[k] {
                normal::quantile(uniform(k))
            } else {
                0.0
            }
        }))
    }

    /// The release with errors from independent standard normals.
    #[must_use]
    pub fn with_normals(&self, independent: [f64; ERRORS]) -> Release {
        let normals = self.correlation.apply(independent);
        let e: [f64; ERRORS] = std::array::from_fn(|k| self.sigmas[k] * normals[k]);
        Release {
            speed_m_s: self.release.speed_m_s + e[0],
            pitch_rad: self.release.pitch_rad + e[1],
            polar_rad: self.release.polar_rad + e[2],
            backspin_rad_s: self.release.backspin_rad_s + e[3],
            rifle_spin_rad_s: self.release.rifle_spin_rad_s + e[4],
            side_spin_rad_s: self.release.side_spin_rad_s + e[5],
            distance_m: self.release.distance_m + e[6],
            court_angle_rad: self.release.court_angle_rad + e[7],
            height_above_hoop_m: self.release.height_above_hoop_m + e[8],
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
        let about = About::new(self.profile, nominal);
        about.release(|dimension| scramble.point(index, dimension))
    }

    /// Sample number `index` of all those that [`Sampler::estimate`] draws with a seed: point
    /// `index / REPLICATES` of replicate `index % REPLICATES`.
    #[must_use]
    pub fn sample(&self, nominal: &Nominal, seed: u64, index: u64) -> Release {
        let scramble = self.scramble(Key {
            seed,
            replicate: index % REPLICATES,
        });
        self.release(nominal, (index / REPLICATES) as u32, &scramble)
    }

    /// Counts of the points `from..to` of one scramble.
    fn block(
        &self,
        nominal: &Nominal,
        scramble: &Scramble,
        (from, to): (u32, u32),
        room: &mut Room,
    ) -> Counts {
        let about = About::new(self.profile, nominal);
        let starts: Vec<State> = (from..to)
            .map(|index| {
                let release = about.release(|dimension| scramble.point(index, dimension));
                release.state()
            })
            .collect();
        Counts::of(self.simulator.verdicts(&starts, room))
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
        self.estimate_within(nominal, target, MOST_SHOTS, seed, progress)
    }

    /// As [`Sampler::estimate`], with `budget` shots at most (and [`LEAST_SHOTS`] at least).
    #[must_use]
    pub fn estimate_within(
        &self,
        nominal: &Nominal,
        target: f64,
        budget: u64,
        seed: u64,
        progress: &dyn Progress,
    ) -> Estimate {
        let most_points = (budget.clamp(LEAST_SHOTS, MOST_SHOTS) / REPLICATES) as u32;
        let first_points = FIRST_POINTS.min(1 << most_points.ilog2());
        let scrambles: Vec<Scramble> = (0..REPLICATES)
            .map(|replicate| self.scramble(Key { seed, replicate }))
            .collect();
        let mut counts = vec![Counts::default(); scrambles.len()];
        let mut points = 0;
        let mut last_error = 0.0;
        let certain = About::new(self.profile, nominal).is_certain();
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
            let mut estimate = summarise(&counts, u64::from(points));
            estimate.certain = certain;
            estimate.standard_error = estimate.standard_error.max(0.5 * last_error);
            last_error = estimate.standard_error;
            if estimate.standard_error <= target || points > most_points / 2 {
                return estimate;
            }
        }
    }
}

pub(super) fn summarise(counts: &[Counts], points: u64) -> Estimate {
    let n = counts.len() as f64;
    let per = points as f64;
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
        shots: points * counts.len() as u64,
        shares: Shares {
            swish: share(all.swish),
            ring: share(all.ring),
            board: share(all.board),
            board_and_ring: share(all.board_and_ring),
        },
        unresolved: all.unresolved,
        certain: false,
    }
}
