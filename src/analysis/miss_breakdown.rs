//! How the shots about a nominal shot are missed.
//!
//! The kind of a miss needs the full outcome of a shot, which costs several times its verdict. So a
//! part of the Sobol points is classified, and the shares are scaled to the share of misses of all
//! points.

use crate::dynamics::{BatchWorkspace, OutcomeKind};
use crate::math::sobol::ScrambleKey;
use crate::model::BallState;
use crate::probability::{Estimate, Sampler};
use crate::shooter::{Nominal, Profile, ReleaseDistribution};
use rayon::prelude::*;
use serde::Serialize;

/// Classified shots.
pub(super) const CLASSIFIED: u32 = 16384;
/// Estimates of fewer shots are rough: a part of so many of them is classified.
const FULL: u64 = 32_768;
const PART_OF_ROUGH: u64 = 4;
/// Shots that are simulated together.
pub(super) const BATCH: usize = 2048;

/// Shares of all shots by the way they were missed. With the shares of the made shots they sum to
/// 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MissBreakdown {
    /// On the shooter's side of the hoop (a bank shot: between hoop and board).
    pub short: f64,
    /// Beyond the hoop (a bank shot: too far off the board).
    pub long: f64,
    /// To the left by more than short or long.
    pub left: f64,
    /// To the right by more than short or long.
    pub right: f64,
    /// Below the plane of the hoop inside the ring, and out again.
    pub in_and_out: f64,
    /// Behind the board.
    pub over: f64,
    /// At rest on ring and board, or still in play at the time limit.
    pub lodged: f64,
    /// Without touching anything.
    pub airball: f64,
    /// Not missed, but unresolved: the numerics gave up.
    pub unresolved: f64,
}

/// The first states of the Sobol points about a nominal shot.
pub(super) fn first_states(
    profile: &Profile,
    nominal: &Nominal,
    seed: u64,
    count: u32,
) -> Vec<BallState> {
    let sampler = Sampler::new(profile);
    let scramble = sampler.scramble(ScrambleKey { seed, replicate: 0 });
    let distribution = ReleaseDistribution::new(profile, nominal);
    let mut starts = Vec::with_capacity(count as usize);
    distribution.for_each_state(&scramble, (0, count), |state| starts.push(state));
    starts
}

/// Classifies the misses about a nominal shot whose P is `estimate`.
#[must_use]
pub fn classify_misses(
    profile: &Profile,
    nominal: &Nominal,
    estimate: &Estimate,
    seed: u64,
) -> MissBreakdown {
    // Of a rough estimate a part as well, so that they take no longer than it does.
    let part = estimate.shots / PART_OF_ROUGH;
    let count = if estimate.shots < FULL {
        part.max(64) as u32
    } else {
        CLASSIFIED
    };
    let starts = first_states(profile, nominal, seed, count);
    let simulator = profile.simulator();
    // In lanes first: only misses need their path.
    let kinds: Vec<(OutcomeKind, f64)> = starts
        .par_chunks(BATCH)
        .flat_map_iter(|starts| {
            let mut workspace = BatchWorkspace::default();
            let verdicts = simulator.finite_verdicts(starts, &mut workspace).iter();
            let misses = verdicts.zip(starts).filter(|(verdict, _)| !verdict.made);
            misses
                .map(|(_, start)| {
                    let outcome = simulator.outcome(*start);
                    (outcome.kind, outcome.right_of_centre_m)
                })
                .collect::<Vec<_>>()
        })
        .collect();
    let mut counts = MissBreakdown::default();
    for (kind, right_of_centre_m) in kinds {
        if let Some(count) = counts.share_of(kind, right_of_centre_m) {
            *count += 1.0;
        }
    }
    counts.scaled_to(1.0 - estimate.probability)
}

impl MissBreakdown {
    /// The shares with their names.
    #[must_use]
    pub fn named(&self) -> [(&'static str, f64); 9] {
        [
            ("short", self.short),
            ("long", self.long),
            ("left", self.left),
            ("right", self.right),
            ("in_and_out", self.in_and_out),
            ("over", self.over),
            ("lodged", self.lodged),
            ("airball", self.airball),
            ("unresolved", self.unresolved),
        ]
    }

    /// The share of a kind of outcome; `None` if the shot was made.
    fn share_of(&mut self, kind: OutcomeKind, right_of_centre_m: f64) -> Option<&mut f64> {
        Some(match kind {
            OutcomeKind::Swish
            | OutcomeKind::RimIn
            | OutcomeKind::BankIn
            | OutcomeKind::BankRimIn => return None,
            OutcomeKind::Short => &mut self.short,
            OutcomeKind::Long => &mut self.long,
            OutcomeKind::Wide if right_of_centre_m < 0.0 => &mut self.left,
            OutcomeKind::Wide => &mut self.right,
            OutcomeKind::InAndOut => &mut self.in_and_out,
            OutcomeKind::OverBoard => &mut self.over,
            OutcomeKind::Lodged => &mut self.lodged,
            OutcomeKind::Airball => &mut self.airball,
            OutcomeKind::Unresolved => &mut self.unresolved,
        })
    }

    fn scaled_to(self, total: f64) -> Self {
        let sum: f64 = self.named().iter().map(|(_, count)| count).sum();
        let scale = if sum > 0.0 { total / sum } else { 0.0 };
        Self {
            short: scale * self.short,
            long: scale * self.long,
            left: scale * self.left,
            right: scale * self.right,
            in_and_out: scale * self.in_and_out,
            over: scale * self.over,
            lodged: scale * self.lodged,
            airball: scale * self.airball,
            unresolved: scale * self.unresolved,
        }
    }
}
