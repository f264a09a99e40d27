//! What interpolation between the nodes of a table of best shots costs.

use crate::best_shot::followed::carried;
use crate::best_shot::found_shots::BestShotError;
use crate::best_shot::search::climb_from_shots;
use crate::probability::{MAX_SHOTS, Sampler, Silent};
use crate::shooter::{Location, Nominal, Profile, ProfileError, ShotKind};
use serde::{Deserialize, Serialize};

/// Parts of a cell's width at which interpolation is checked.
pub(super) const PARTS: [f64; 3] = [0.25, 0.5, 0.75];

/// P of the shot that is interpolated between four nodes (two where there is one angle), against
/// the best shot there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InterpolationCheck {
    /// The place.
    pub location: Location,
    /// P of the interpolated shot.
    pub interpolated: f64,
    /// P that is interpolated itself.
    pub looked_up: f64,
    /// P of the best shot that was found; `None` where there is none of the kind.
    pub best: Option<f64>,
}

impl InterpolationCheck {
    /// What interpolation costs in P.
    #[must_use]
    pub fn loss(&self) -> f64 {
        self.best.map_or(0.0, |best| best - self.interpolated)
    }

    /// By how much the interpolated P errs, positive where it promises too much.
    #[must_use]
    pub fn error(&self) -> f64 {
        self.looked_up - self.interpolated
    }

    /// The greater of the loss and the size of the error.
    #[must_use]
    pub fn worse(&self) -> f64 {
        self.loss().max(self.error().abs())
    }
}

/// A shot at a place of its own.
#[derive(Clone, Copy)]
pub(super) struct PlacedShot {
    pub(super) location: Location,
    pub(super) nominal: Nominal,
}

/// P of the best shot at a check's place: what the full search found, or what climbs reach from the
/// shots of the nodes around and from the interpolated one.
pub(super) enum BestKnown<'a> {
    Searched(Option<f64>),
    Climbed(&'a [PlacedShot]),
}

/// Compares an interpolated shot, with the P that is looked up, with the best one there.
pub(super) fn check(
    profile: &Profile,
    kind: ShotKind,
    (interpolated, looked_up): (PlacedShot, f64),
    best: BestKnown<'_>,
) -> Result<InterpolationCheck, CheckError> {
    let PlacedShot { location, nominal } = interpolated;
    let here = profile.moved_to(location)?;
    let search = here.search();
    let (target, seed) = (search.standard_error, search.seed);
    let estimate = Sampler::new(&here).estimate_within(&nominal, target, MAX_SHOTS, seed, &Silent);
    let best = match best {
        BestKnown::Searched(best) => best,
        BestKnown::Climbed(shots_around) => {
            let mut starts = vec![nominal];
            for shot in shots_around {
                starts.push(moved(profile, &here, shot)?);
            }
            climb_from_shots(&here, kind, &starts)?.map(|(_, estimate)| estimate.probability)
        }
    };
    Ok(InterpolationCheck {
        location,
        interpolated: estimate.probability,
        looked_up,
        best,
    })
}

/// A shot as a start at another place.
pub(super) fn moved(
    profile: &Profile,
    here: &Profile,
    shot: &PlacedShot,
) -> Result<Nominal, ProfileError> {
    let there = profile.moved_to(shot.location)?;
    Ok(carried(&there, here, &shot.nominal))
}

/// Why a place could not be checked.
#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum CheckError {
    #[error(transparent)]
    Profile(#[from] ProfileError),
    #[error(transparent)]
    Search(#[from] BestShotError),
}
