//! What is found for a table of one kind: the best shots of places and the checks of cells, each of
//! them once. A table that was stopped goes on with what it found before.

use super::cells::Cell;
use super::interpolation_check::{BestKnown, InterpolationCheck, PlacedShot, check};
use super::lookup::{ShotTable, TableShot};
use super::shot_at_place::{ShotTableError, best};
use crate::best_shot::followed::{Starts, carried};
use crate::probability::Progress;
use crate::shooter::{Location, Nominal, Profile, ShotKind};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// How often a step is halved to find where shots of a kind begin or end.
const END_HALVINGS: usize = 4;

/// Something that was found while a table was made. Its numbers stay exact in JSON.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TableFinding {
    /// The best shot from a place.
    Shot {
        /// Its kind.
        kind: ShotKind,
        /// The place.
        place: Location,
        /// `None` where there is no clean one.
        shot: Option<TableShot>,
        /// Local optima of both kinds, from which the search nearby starts.
        optima: Vec<Nominal>,
    },
    /// The checks between some nodes.
    Checks {
        /// The kind of the shots.
        kind: ShotKind,
        /// The range of distances between the nodes, m.
        distance_m: [f64; 2],
        /// Their range of court angles, rad.
        angle_rad: [f64; 2],
        /// The checks.
        checks: Vec<InterpolationCheck>,
    },
}

/// What was found before, and what takes each new finding.
pub(super) struct TableLog<'a> {
    pub(super) known: &'a [TableFinding],
    pub(super) found: &'a mut dyn FnMut(&TableFinding),
    pub(super) progress: &'a dyn Progress,
}

/// The search for the shots of one kind.
pub(super) struct TableSearch<'a> {
    pub(super) profile: &'a Profile,
    pub(super) kind: ShotKind,
    shots: HashMap<[u64; 2], (Option<TableShot>, Vec<Nominal>)>,
    checks: HashMap<[u64; 4], Vec<InterpolationCheck>>,
    found: &'a mut dyn FnMut(&TableFinding),
    progress: &'a dyn Progress,
}

impl<'a> TableSearch<'a> {
    /// A search that knows what was found of its kind before.
    pub(super) fn new(profile: &'a Profile, wanted: ShotKind, log: &'a mut TableLog<'_>) -> Self {
        let mut shots = HashMap::new();
        let mut checked = HashMap::new();
        for finding in log.known {
            match finding {
                TableFinding::Shot {
                    kind,
                    place,
                    shot,
                    optima,
                } if *kind == wanted => {
                    shots.insert(key(place), (shot.clone(), optima.clone()));
                }
                TableFinding::Checks {
                    kind,
                    distance_m,
                    angle_rad,
                    checks,
                } if *kind == wanted => {
                    let cell = Cell {
                        distance_m: *distance_m,
                        angle_rad: *angle_rad,
                    };
                    checked.insert(cell.key(), checks.clone());
                }
                _ => {}
            }
        }
        Self {
            profile,
            kind: wanted,
            shots,
            checks: checked,
            found: &mut *log.found,
            progress: log.progress,
        }
    }

    /// The best shot at a place; `None` where there is no clean one, or it was not searched.
    pub(super) fn shot_at(&self, place: &Location) -> Option<&TableShot> {
        self.shots.get(&key(place))?.0.as_ref()
    }

    /// The local optima of some places as starts from `here`.
    fn optima_around(
        &self,
        places: &[Location],
        here: &Profile,
    ) -> Result<Vec<Nominal>, ShotTableError> {
        let mut starts = Vec::new();
        for place in places {
            if let Some((_, optima)) = self.shots.get(&key(place)) {
                let there = self.profile.moved_to(*place)?;
                starts.extend(optima.iter().map(|shot| carried(&there, here, shot)));
            }
        }
        Ok(starts)
    }

    /// The checks of a cell.
    pub(super) fn checks_of(&self, cell: &Cell) -> impl Iterator<Item = InterpolationCheck> + '_ {
        self.checks.get(&cell.key()).into_iter().flatten().copied()
    }

    fn begin(&self, stage: &str, total: usize) {
        let stage = format!("{}: {stage}", self.kind.name());
        self.progress.begin(&stage, total as u64);
    }

    /// Finds the shots of those places that have none yet: from the optima of the places around
    /// each, or from scratch where there are none.
    pub(super) fn find_shots(
        &mut self,
        places: impl Iterator<Item = (Location, Vec<Location>)>,
        stage: &str,
    ) -> Result<(), ShotTableError> {
        let is_new = |(place, _): &(Location, _)| !self.shots.contains_key(&key(place));
        let new: Vec<(Location, Vec<Location>)> = places.filter(is_new).collect();
        if new.is_empty() {
            return Ok(());
        }
        self.begin(stage, new.len());
        for (place, around) in &new {
            let here = self.profile.moved_to(*place)?;
            let starts = self.optima_around(around, &here)?;
            let found = best((&here, Starts::of(&starts)), self.kind, self.progress)?;
            let (shot, optima) = (found.shot.ok(), found.optima);
            (self.found)(&TableFinding::Shot {
                kind: self.kind,
                place: *place,
                shot: shot.clone(),
                optima: optima.clone(),
            });
            self.shots.insert(key(place), (shot, optima));
            self.progress.advance(1);
        }
        self.progress.end();
        Ok(())
    }

    /// Checks those cells of a table that have no checks yet.
    pub(super) fn find_checks(
        &mut self,
        table: &ShotTable,
        cells: &[Cell],
        stage: &str,
    ) -> Result<(), ShotTableError> {
        let is_new = |cell: &&Cell| !self.checks.contains_key(&cell.key());
        let new: Vec<&Cell> = cells.iter().filter(is_new).collect();
        let places: usize = new.iter().map(|cell| cell.checked_places().len()).sum();
        self.begin(stage, places);
        for cell in new {
            let mut known = cell.corners();
            known.push(cell.middle());
            let around: Vec<PlacedShot> = known
                .iter()
                .filter_map(|&location| {
                    let nominal = self.shot_at(&location)?.nominal;
                    Some(PlacedShot { location, nominal })
                })
                .collect();
            let mut checks = Vec::new();
            for location in cell.checked_places() {
                if let Some((nominal, looked_up)) = table.interpolated(location) {
                    // Climbs from the best shots alone can miss an optimum. Between rows of several
                    // angles there are too many places to follow all optima to each.
                    let best = if location == cell.middle() {
                        let shot = self.shot_at(&location);
                        BestKnown::Searched(shot.map(|shot| shot.probability))
                    } else if table.angles_rad.len() == 1 {
                        let here = self.profile.moved_to(location)?;
                        let mut starts = self.optima_around(&known, &here)?;
                        starts.push(nominal);
                        let found = best((&here, Starts::of(&starts)), self.kind, self.progress)?;
                        BestKnown::Searched(found.shot.ok().map(|shot| shot.probability))
                    } else {
                        BestKnown::Climbed(&around)
                    };
                    let shot = PlacedShot { location, nominal };
                    checks.push(check(self.profile, self.kind, (shot, looked_up), best)?);
                }
                self.progress.advance(1);
            }
            (self.found)(&TableFinding::Checks {
                kind: self.kind,
                distance_m: cell.distance_m,
                angle_rad: cell.angle_rad,
                checks: checks.clone(),
            });
            self.checks.insert(cell.key(), checks);
        }
        self.progress.end();
        Ok(())
    }

    /// From where on there are shots, or up to where, between places from one angle of which one
    /// has such a shot and the next has none: distances near these ends that have one, m.
    pub(super) fn ends_m(
        &mut self,
        distances_m: &[f64],
        angle_rad: f64,
    ) -> Result<Vec<f64>, ShotTableError> {
        const STAGE: &str = "how near and far shots go in";
        let at = |distance_m| Location {
            distance_m,
            angle_rad,
        };
        let places: Vec<Location> = distances_m.iter().copied().map(at).collect();
        let alone = |place: &Location| (*place, Vec::new());
        self.find_shots(places.iter().map(alone), STAGE)?;
        let mut ends = Vec::new();
        for pair in places.windows(2) {
            let has_shot = [0, 1].map(|i: usize| self.shot_at(&pair[i]).is_some());
            if has_shot[0] == has_shot[1] {
                continue;
            }
            let [mut with_m, mut without_m] =
                [has_shot[0], !has_shot[0]].map(|first| pair[usize::from(!first)].distance_m);
            for _ in 0..END_HALVINGS {
                let middle = at(0.5 * (with_m + without_m));
                self.find_shots(std::iter::once(alone(&middle)), STAGE)?;
                if self.shot_at(&middle).is_some() {
                    with_m = middle.distance_m;
                    ends.push(with_m);
                } else {
                    without_m = middle.distance_m;
                }
            }
        }
        Ok(ends)
    }
}

fn key(place: &Location) -> [u64; 2] {
    [place.distance_m.to_bits(), place.angle_rad.to_bits()]
}
