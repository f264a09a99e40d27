//! The best shots of one kind for a grid of distances and court angles, for a program to
//! interpolate in.

use super::search::{BestShot, BestShotError, find_kinds};
use crate::analysis::sensitivity::SensitivityTopics;
use crate::dynamics::OutcomeKind;
use crate::probability::{MAX_SHOTS, Progress, Sampler, Silent};
use crate::search_space::PlanError;
use crate::shooter::{
    Location, Nominal, NominalVariable, Profile, ProfileError, SearchChoice, ShotKind,
};
use std::collections::HashMap;

/// The best shot at one node.
#[derive(Clone, Debug, PartialEq)]
pub struct TableShot {
    /// The nominal shot.
    pub nominal: Nominal,
    /// Its direction from the line to the hoop's centre, rad, positive to the shooter's left.
    pub aim_rad: f64,
    /// P.
    pub probability: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// How the error-free shot goes in.
    pub outcome: OutcomeKind,
    /// Time from the release until the error-free shot is made, s. It includes all bounces.
    pub time_s: f64,
    /// Angle at which the error-free shot falls through the hoop at last, rad.
    pub entry_rad: Option<f64>,
    /// Widths of the ranges of speed (m/s) and pitch angle (rad) in which an otherwise exact shot
    /// is made.
    pub tolerances: [f64; 2],
}

/// P of the shot that is interpolated between four nodes (two where there is one angle), against
/// the best shot there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InterpolationCheck {
    /// The place.
    pub location: Location,
    /// P of the interpolated shot.
    pub interpolated: f64,
    /// P of the best shot.
    pub best: f64,
}

impl InterpolationCheck {
    /// What interpolation costs in P.
    #[must_use]
    pub fn loss(&self) -> f64 {
        self.best - self.interpolated
    }
}

/// A table of best shots.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotTable {
    /// The kind of all shots.
    pub kind: ShotKind,
    /// Distances, ascending, m.
    pub distances_m: Vec<f64>,
    /// Court angles, ascending, rad.
    pub angles_rad: Vec<f64>,
    /// The shots, angle by angle; `None` where there is no clean one.
    pub shots: Vec<Option<TableShot>>,
    /// The checks between the nodes.
    pub checks: Vec<InterpolationCheck>,
}

/// What a table is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotTableRequest {
    /// The kind of all shots.
    pub kind: ShotKind,
    /// Distances, ascending, m.
    pub distances_m: Vec<f64>,
    /// Court angles, ascending, rad.
    pub angles_rad: Vec<f64>,
    /// Values that the shooter cannot change.
    pub fixed: Vec<(NominalVariable, f64)>,
    /// The most that interpolation may cost in P. Where it costs more, nodes are added halfway, at
    /// most [`MOST_HALVINGS`] times and up to [`MOST_NODES`] nodes; 1 adds none.
    pub max_loss: f64,
}

/// Most nodes of a table.
pub const MOST_NODES: usize = 2000;
/// Most times that a step between two nodes is halved.
pub const MOST_HALVINGS: usize = 4;

/// The best shots of places; `None` where there is no clean one.
#[derive(Default)]
struct ShotsOfPlaces(HashMap<[u64; 2], Option<TableShot>>);

impl ShotsOfPlaces {
    fn key(place: &Location) -> [u64; 2] {
        [place.distance_m.to_bits(), place.angle_rad.to_bits()]
    }

    fn at(&self, place: &Location) -> Option<&TableShot> {
        self.0.get(&Self::key(place))?.as_ref()
    }

    /// Finds the shots of those places that have none yet.
    fn find<'a>(
        &mut self,
        (profile, kind): (&Profile, ShotKind),
        places: impl Iterator<Item = &'a Location>,
        progress: &dyn Progress,
    ) -> Result<(), ShotTableError> {
        let is_new = |place: &&Location| !self.0.contains_key(&Self::key(place));
        let new: Vec<&Location> = places.filter(is_new).collect();
        progress.begin("finding shots", new.len() as u64);
        for place in new {
            let shot = best(&profile.moved_to(*place)?, kind)?;
            let shot = shot.map(|shot| TableShot {
                nominal: shot.nominal,
                aim_rad: shot.nominal.polar_rad - place.angle_rad,
                probability: shot.estimate.probability,
                standard_error: shot.estimate.standard_error,
                outcome: shot.outcome.kind,
                time_s: shot.outcome.verdict.time_s,
                entry_rad: shot.outcome.entry.map(|entry| entry.angle_rad),
                tolerances: [0, 1].map(|i| shot.sensitivity.windows[i].width()),
            });
            self.0.insert(Self::key(place), shot);
            progress.advance(1);
        }
        progress.end();
        Ok(())
    }
}

/// Why there is no table.
#[derive(Clone, Debug, thiserror::Error)]
pub enum ShotTableError {
    /// A value or a place is not possible.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The search is too large.
    #[error(transparent)]
    Search(#[from] BestShotError),
}

impl ShotTable {
    /// Computes a table, with a check between all nodes. Where interpolation costs more than the
    /// request allows, nodes are added halfway.
    ///
    /// # Errors
    /// A fixed value or a place is not possible, or the search is too large.
    pub fn compute(
        profile: &Profile,
        request: &ShotTableRequest,
        progress: &dyn Progress,
    ) -> Result<Self, ShotTableError> {
        let profile = with_fixed(profile, &request.fixed)?;
        let mut shots = ShotsOfPlaces::default();
        let mut table = Self {
            kind: request.kind,
            distances_m: request.distances_m.clone(),
            angles_rad: request.angles_rad.clone(),
            shots: Vec::new(),
            checks: Vec::new(),
        };
        for halving in 0..=MOST_HALVINGS {
            let nodes = grid(&table.distances_m, &table.angles_rad);
            let between = table.places_between();
            shots.find(
                (&profile, request.kind),
                nodes.iter().chain(&between),
                progress,
            )?;
            table.shots = nodes.iter().map(|node| shots.at(node).cloned()).collect();
            table.checks.clear();
            for &location in &between {
                table.check(&profile, location, &shots)?;
            }
            let Some(finer) = table.finer(request.max_loss) else {
                break;
            };
            if halving == MOST_HALVINGS || finer.0.len() * finer.1.len() > MOST_NODES {
                break;
            }
            (table.distances_m, table.angles_rad) = finer;
        }
        Ok(table)
    }

    /// The places halfway between the nodes. One angle alone is kept.
    fn places_between(&self) -> Vec<Location> {
        let distances = midpoints(&self.distances_m);
        if self.angles_rad.len() > 1 {
            grid(&distances, &midpoints(&self.angles_rad))
        } else {
            grid(&distances, &self.angles_rad)
        }
    }

    /// Compares the interpolated shot at a place with the best one, where there are both.
    fn check(
        &mut self,
        profile: &Profile,
        location: Location,
        shots: &ShotsOfPlaces,
    ) -> Result<(), ShotTableError> {
        let (Some(nominal), Some(best)) = (self.interpolated(location), shots.at(&location)) else {
            return Ok(());
        };
        let here = profile.moved_to(location)?;
        let search = here.search();
        let (target, seed) = (search.standard_error, search.seed);
        let estimate =
            Sampler::new(&here).estimate_within(&nominal, target, MAX_SHOTS, seed, &Silent);
        self.checks.push(InterpolationCheck {
            location,
            interpolated: estimate.probability,
            best: best.probability,
        });
        Ok(())
    }

    /// Distances and angles with others halfway, where a check lost more than `max_loss`; `None`
    /// where none did.
    fn finer(&self, max_loss: f64) -> Option<(Vec<f64>, Vec<f64>)> {
        let mut distances = self.distances_m.clone();
        let mut angles = self.angles_rad.clone();
        let costly = |check: &&InterpolationCheck| check.loss() > max_loss;
        for check in self.checks.iter().filter(costly) {
            distances.push(check.location.distance_m);
            angles.push(check.location.angle_rad);
        }
        for values in [&mut distances, &mut angles] {
            values.sort_by(f64::total_cmp);
            values.dedup();
        }
        (distances.len() > self.distances_m.len()).then_some((distances, angles))
    }

    /// The shot at a node.
    #[must_use]
    pub fn at(&self, angle: usize, distance: usize) -> Option<&TableShot> {
        self.shots[angle * self.distances_m.len() + distance].as_ref()
    }

    /// The shot at a place inside the table, linear in distance and court angle; `None` where a
    /// node has no shot.
    #[must_use]
    pub fn interpolated(&self, location: Location) -> Option<Nominal> {
        let (d, along) = cell(&self.distances_m, location.distance_m)?;
        let (a, across) = cell(&self.angles_rad, location.angle_rad)?;
        let corners = [
            (a, d, (1.0 - across) * (1.0 - along)),
            (a, d + 1, (1.0 - across) * along),
            (a + 1, d, across * (1.0 - along)),
            (a + 1, d + 1, across * along),
        ];
        let mut nominal = Nominal::default();
        let mut aim = 0.0;
        for (a, d, weight) in corners {
            if weight == 0.0 {
                continue;
            }
            let shot = self.at(a, d)?;
            aim += weight * shot.aim_rad;
            for variable in NominalVariable::ALL {
                *nominal.get_mut(variable) += weight * shot.nominal.get(variable);
            }
        }
        nominal.polar_rad = location.angle_rad + aim;
        Some(nominal)
    }

    /// The check where interpolation costs most; `None` without a check.
    #[must_use]
    pub fn costliest(&self) -> Option<&InterpolationCheck> {
        let checks = self.checks.iter();
        checks.max_by(|a, b| a.loss().total_cmp(&b.loss()))
    }

    /// The greatest P that interpolation costs, over all checks; `None` without a check.
    #[must_use]
    pub fn greatest_loss(&self) -> Option<f64> {
        self.costliest().map(InterpolationCheck::loss)
    }

    /// Whether a shot without an error touches nothing but, in a bank shot, the board.
    #[must_use]
    pub fn is_clean(&self, shot: &TableShot) -> bool {
        let clean = match self.kind {
            ShotKind::Direct => OutcomeKind::Swish,
            ShotKind::Bank => OutcomeKind::BankIn,
        };
        shot.outcome == clean
    }
}

/// The cell of ascending values that a value is in, and how far into it, 0 to 1. One value alone is
/// a cell of no width.
fn cell(values: &[f64], value: f64) -> Option<(usize, f64)> {
    let (first, last) = (*values.first()?, *values.last()?);
    if !(first..=last).contains(&value) {
        return None;
    }
    let next = values.partition_point(|v| *v <= value);
    if next == values.len() {
        return Some((values.len() - 1, 0.0));
    }
    let (low, high) = (values[next - 1], values[next]);
    Some((next - 1, (value - low) / (high - low)))
}

/// All pairs, angle by angle.
fn grid(distances_m: &[f64], angles_rad: &[f64]) -> Vec<Location> {
    let line = |&angle_rad: &f64| {
        distances_m.iter().map(move |&distance_m| Location {
            distance_m,
            angle_rad,
        })
    };
    angles_rad.iter().flat_map(line).collect()
}

fn midpoints(values: &[f64]) -> Vec<f64> {
    values
        .windows(2)
        .map(|pair| 0.5 * (pair[0] + pair[1]))
        .collect()
}

/// The profile with values that the search leaves as they are.
fn with_fixed(
    profile: &Profile,
    fixed: &[(NominalVariable, f64)],
) -> Result<Profile, ProfileError> {
    profile.with(|settings| {
        let chosen: Vec<NominalVariable> = settings
            .search
            .choice
            .iter()
            .filter(|chosen| fixed.iter().all(|(variable, _)| variable != chosen))
            .collect();
        settings.search.choice = SearchChoice::only(&chosen);
        for &(variable, value) in fixed {
            settings.nominal.set(variable, value);
        }
    })
}

/// The best shot of a kind, if there is a clean one.
fn best(profile: &Profile, kind: ShotKind) -> Result<Option<BestShot>, BestShotError> {
    let topics = SensitivityTopics {
        windows: true,
        ..SensitivityTopics::NONE
    };
    match find_kinds(profile, &[kind], topics, &Silent) {
        Ok((_, mut shots)) => Ok(shots.pop().and_then(Result::ok)),
        Err(BestShotError::Plan(PlanError::OutOfReach)) => Ok(None),
        Err(error) => Err(error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_cells_of_a_table() {
        let values = [1.0, 2.0, 4.0];
        assert_eq!(cell(&values, 1.0), Some((0, 0.0)));
        assert_eq!(cell(&values, 3.0), Some((1, 0.5)));
        assert_eq!(cell(&values, 4.0), Some((2, 0.0)));
        assert_eq!(cell(&values, 4.1), None);
        assert_eq!(cell(&[0.3], 0.3), Some((0, 0.0)));
    }
}
