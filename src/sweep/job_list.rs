//! The jobs of a sweep: what is computed, and which result belongs to which place.
//!
//! A place on the right is the mirror image of one on the left, so only one of the two is computed:
//! the spot.

use super::court_region::CourtPlace;
use super::sweep_toml::SweepConfig;
use crate::best_shot::ShotKind;

/// One shard of several: every `count`-th spot, starting at the `index`-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of the shard, from 0.
    pub index: usize,
    /// Number of shards.
    pub count: usize,
}

impl Shard {
    /// The only shard.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Whether the shard computes a spot.
    #[must_use]
    pub fn contains(self, spot: usize) -> bool {
        spot % self.count == self.index
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index + 1, self.count)
    }
}

/// Where the result of a place comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JobSource {
    /// The place.
    pub place: CourtPlace,
    /// The computed spot, an index of [`Jobs::spots`].
    pub computed: usize,
    /// Whether the result is the mirror image of the computed one.
    pub mirrored: bool,
}

/// All jobs of a sweep. A job is one kind of shot at one computed spot.
#[derive(Clone, Debug, PartialEq)]
pub struct Jobs {
    /// The computed spots.
    pub spots: Vec<CourtPlace>,
    /// The kinds of shots that are computed at each.
    pub kinds: Vec<ShotKind>,
    /// For each place of the region, in order, where its result comes from.
    pub sources: Vec<JobSource>,
}

impl Jobs {
    /// Lists the jobs.
    #[must_use]
    pub fn new(config: &SweepConfig) -> Self {
        let uses_mirror = config.is_mirror_symmetric();
        let mut spots: Vec<CourtPlace> = Vec::new();
        let mut known = std::collections::HashMap::new();
        let sources = config
            .places
            .iter()
            .map(|&place| {
                let mirrored = uses_mirror && place.y_m < 0.0;
                // Adding 0 turns a negative zero into zero.
                let (x_m, y_m) = (
                    place.x_m + 0.0,
                    if mirrored { -place.y_m } else { place.y_m } + 0.0,
                );
                let computed = *known
                    .entry((x_m.to_bits(), y_m.to_bits()))
                    .or_insert_with(|| {
                        spots.push(CourtPlace { x_m, y_m });
                        spots.len() - 1
                    });
                JobSource {
                    place,
                    computed,
                    mirrored,
                }
            })
            .collect();
        Self {
            spots,
            kinds: config.compute.kinds(),
            sources,
        }
    }

    /// Number of jobs.
    #[must_use]
    pub fn count(&self) -> usize {
        self.spots.len() * self.kinds.len()
    }

    /// The number of the job of a computed spot and a kind.
    #[must_use]
    pub fn number(&self, spot: usize, kind: usize) -> u64 {
        (spot * self.kinds.len() + kind) as u64
    }

    /// The computed spot and the kind of a job; `None` if there is no such job.
    #[must_use]
    pub fn spot_and_kind(&self, job: u64) -> Option<(usize, usize)> {
        let job = usize::try_from(job).ok()?;
        (job < self.count()).then(|| (job / self.kinds.len(), job % self.kinds.len()))
    }
}
