//! The jobs of a sweep: what is computed, and which result stands for which place.
//!
//! A place right of the middle is the mirror image of one left of it, so only one of the two is computed.

use super::configuration::Configuration;
use super::region::Spot;
use crate::probability::best::ShotKind;

/// One shard of several: every `count`-th place from the `index`-th, from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which, from 0.
    pub index: usize,
    /// Of how many.
    pub count: usize,
}

impl Shard {
    /// Everything.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// Does it compute this place?
    #[must_use]
    pub fn has(self, place: usize) -> bool {
        place % self.count == self.index
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.index + 1, self.count)
    }
}

/// Where a place of the results comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Source {
    /// The place of the results.
    pub spot: Spot,
    /// The computed place, an index of [`Jobs::places`].
    pub place: usize,
    /// As its mirror image?
    pub mirrored: bool,
}

/// All jobs of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Jobs {
    /// The places that are computed.
    pub places: Vec<Spot>,
    /// The kinds that are computed at each.
    pub kinds: Vec<ShotKind>,
    /// The places of the results, in their order.
    pub sources: Vec<Source>,
}

impl Jobs {
    /// Lists the jobs.
    #[must_use]
    pub fn new(configuration: &Configuration) -> Self {
        let mirrors = configuration.is_symmetric();
        let mut places: Vec<Spot> = Vec::new();
        let mut known = std::collections::HashMap::new();
        let sources = configuration
            .spots
            .iter()
            .map(|&spot| {
                let mirrored = mirrors && spot.y_m < 0.0;
                // Adding 0 leaves no negative zero.
                let (x_m, y_m) = (
                    spot.x_m + 0.0,
                    if mirrored { -spot.y_m } else { spot.y_m } + 0.0,
                );
                let place = *known
                    .entry((x_m.to_bits(), y_m.to_bits()))
                    .or_insert_with(|| {
                        places.push(Spot { x_m, y_m });
                        places.len() - 1
                    });
                Source {
                    spot,
                    place,
                    mirrored,
                }
            })
            .collect();
        Self {
            places,
            kinds: configuration.compute.kinds(),
            sources,
        }
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.places.len() * self.kinds.len()
    }

    /// The number of a job.
    #[must_use]
    pub fn number(&self, place: usize, kind: usize) -> u64 {
        (place * self.kinds.len() + kind) as u64
    }

    /// The place and the kind of a job; none where there is no such job.
    #[must_use]
    pub fn of(&self, job: u64) -> Option<(usize, usize)> {
        let job = usize::try_from(job).ok()?;
        (job < self.count()).then(|| (job / self.kinds.len(), job % self.kinds.len()))
    }
}
