//! How the shots of a nominal shot's distribution are missed.
//!
//! Sorting misses needs the whole outcome of a shot, which costs several times its verdict, so a part
//! of the Sobol points serves; the shares are scaled to the share of misses that all of them gave.

use super::estimate::{About, Estimate, Sampler};
use super::sobol::Key;
use crate::dynamics::{Kind, Simulator};
use crate::profile::{Nominal, Profile};
use rayon::prelude::*;
use serde::Serialize;

/// Shots that are sorted.
pub const SORTED: u32 = 16384;

/// Parts of all shots, by the way they were missed; with those made they sum to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Misses {
    /// On the shooter's side of the hoop (of a bank shot: between hoop and board).
    pub short: f64,
    /// Beyond the hoop (of a bank shot: too far off the board).
    pub long: f64,
    /// To the left by more than short or long.
    pub left: f64,
    /// To the right by more than short or long.
    pub right: f64,
    /// Was below the plane of the hoop inside the ring, and came out.
    pub in_and_out: f64,
    /// Behind the board.
    pub over: f64,
    /// At rest on ring and board, or not over at the time limit.
    pub lodged: f64,
    /// Touched nothing.
    pub airball: f64,
    /// The numerics gave up.
    pub unresolved: f64,
}

/// Sorts the misses about a nominal shot whose P is `estimate`.
#[must_use]
pub fn sort(
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    estimate: &Estimate,
    seed: u64,
) -> Misses {
    let sampler = Sampler::new(profile, simulator);
    let scramble = sampler.scramble(Key { seed, replicate: 0 });
    let about = About::new(profile, nominal);
    let kinds: Vec<(Kind, f64)> = (0..SORTED)
        .into_par_iter()
        .map(|index| {
            let release = about.release(|dimension| scramble.point(index, dimension));
            let outcome = simulator.shoot(&release);
            (outcome.kind, outcome.aside_m)
        })
        .collect();
    let mut counts = Misses::default();
    for (kind, aside) in kinds {
        let count = match kind {
            Kind::Swish | Kind::RimIn | Kind::BankIn | Kind::BankRimIn => continue,
            Kind::Short => &mut counts.short,
            Kind::Long => &mut counts.long,
            Kind::Wide if aside < 0.0 => &mut counts.left,
            Kind::Wide => &mut counts.right,
            Kind::InAndOut => &mut counts.in_and_out,
            Kind::OverBoard => &mut counts.over,
            Kind::Lodged => &mut counts.lodged,
            Kind::Airball => &mut counts.airball,
            Kind::Unresolved => &mut counts.unresolved,
        };
        *count += 1.0;
    }
    counts.scaled_to(1.0 - estimate.probability)
}

impl Misses {
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
