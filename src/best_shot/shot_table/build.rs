//! How a table of best shots is made: the best shot at each node, checks between them, and more
//! nodes where interpolation costs too much.

use super::better_kind::merged;
use super::cells::{Cell, grid};
use super::interpolation_check::{PlacedShot, moved};
use super::lookup::{ShotTable, TableKind, TableShot};
use super::shot_at_place::{ShotTableError, table_shot};
use super::table_search::{TableFinding, TableLog, TableSearch};
use crate::best_shot::search::climb_from_shots;
use crate::probability::{Progress, Sampler, Silent};
use crate::shooter::{
    Location, Nominal, NominalVariable, Profile, ProfileError, SearchChoice, ShotKind,
};
use serde::Serialize;

/// What a table is made of.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShotTableRequest {
    /// Which shots. The better kind needs one angle.
    pub kind: TableKind,
    /// Distances, ascending, m.
    pub distances_m: Vec<f64>,
    /// Court angles, ascending, rad.
    pub angles_rad: Vec<f64>,
    /// Values that the shooter cannot change.
    pub fixed: Vec<(NominalVariable, f64)>,
    /// The most that interpolation may cost in P, and the most by which the interpolated P may err.
    /// Where a check finds more, nodes are added halfway, at most [`MOST_HALVINGS`] times (with one
    /// angle three times more where that did not help) and up to [`MOST_NODES`] nodes; 1 adds none.
    pub max_loss: f64,
    /// Where P is less than this at all nodes around and in the middle, nothing is checked between
    /// the nodes of one kind, and none are added; 0 leaves nothing out.
    pub least_probability: f64,
    /// Nothing is checked between the nodes, and none are added but for the distances at which the
    /// better kind changes.
    pub is_draft: bool,
}

/// Most nodes of a table.
pub const MOST_NODES: usize = 2000;
/// Part of the allowed loss above which nodes are added: between the checked places it can be
/// greater.
const MARGIN: f64 = 0.75;
/// Most times that a step between two nodes is halved.
pub const MOST_HALVINGS: usize = 4;
/// A kind whose P is lower by more than this at both nodes and in the middle is not looked at
/// between them.
const WORSE_KIND: f64 = 0.05;
/// Most times that a cell is split where the best shot may jump. The branches of both sides do not
/// always reach its middle, so one split does not find every jump.
const MOST_SPLITS: usize = 3;

impl ShotTable {
    /// Computes a table, with checks between all nodes. Where interpolation costs or errs by more
    /// than the request allows, nodes are added halfway, and jumps of the best shot at last.
    ///
    /// # Errors
    /// A fixed value or a place is not possible, the search is too large, or the better kind was
    /// asked for at several angles.
    pub fn compute(
        profile: &Profile,
        request: &ShotTableRequest,
        progress: &dyn Progress,
    ) -> Result<Self, ShotTableError> {
        Self::resume((profile, request), &[], &mut |_| {}, progress)
    }

    /// As [`ShotTable::compute`], with what was `known` when the same table was made before and
    /// stopped: what an earlier call gave to `found`. The table is the same as in one go.
    ///
    /// # Errors
    /// As [`ShotTable::compute`].
    pub fn resume(
        (profile, request): (&Profile, &ShotTableRequest),
        known: &[TableFinding],
        found: &mut dyn FnMut(&TableFinding),
        progress: &dyn Progress,
    ) -> Result<Self, ShotTableError> {
        let profile = &with_fixed(profile, &request.fixed)?;
        let mut log = TableLog {
            known,
            found,
            progress,
        };
        let mut table = match request.kind {
            TableKind::One(kind) => {
                Self::of_kind(request, TableSearch::new(profile, kind, &mut log))?
            }
            TableKind::Better if request.angles_rad.len() > 1 => {
                return Err(ShotTableError::SeveralAngles);
            }
            TableKind::Better => {
                let mut of_kind = |kind| -> Result<Self, ShotTableError> {
                    let mut search = TableSearch::new(profile, kind, &mut log);
                    let ends_m = search.ends_m(&request.distances_m, request.angles_rad[0])?;
                    let mut request = request.clone();
                    request.distances_m.extend(ends_m);
                    request.distances_m.sort_by(f64::total_cmp);
                    Self::of_kind(&request, search)
                };
                let tables = [of_kind(ShotKind::Direct)?, of_kind(ShotKind::Bank)?];
                merged(profile, tables, (request.max_loss, request.is_draft))?
            }
        };
        if request.is_draft {
            // Those beside the change of the better kind alone would seem to be of all.
            table.checks.clear();
        }
        let added = |all: &[f64], asked: &[f64]| {
            let is_new = |value: &&f64| !asked.contains(value);
            all.iter().filter(is_new).copied().collect()
        };
        table.added_distances_m = added(&table.distances_m, &request.distances_m);
        table.added_distances_m.dedup();
        table.added_angles_rad = added(&table.angles_rad, &request.angles_rad);
        Ok(table)
    }

    /// The table of the kind that is searched.
    fn of_kind(
        request: &ShotTableRequest,
        mut search: TableSearch<'_>,
    ) -> Result<Self, ShotTableError> {
        let mut table = Self {
            kind: TableKind::One(search.kind),
            distances_m: request.distances_m.clone(),
            angles_rad: request.angles_rad.clone(),
            shots: Vec::new(),
            added_distances_m: Vec::new(),
            added_angles_rad: Vec::new(),
            checks: Vec::new(),
        };
        if request.is_draft {
            table.find_nodes(&mut search, "finding shots")?;
            return Ok(table);
        }
        for halving in 0..=MOST_HALVINGS {
            let [finding, between, checking] = stages_of_round(halving + 1);
            table.find_nodes(&mut search, &finding)?;
            if halving == 0 {
                // Of all: where they are is what the middles of a coarse table tell.
                table.find_middles(&mut search, &table.cells(), &between)?;
            }
            let cells = table.relevant_cells(&search, request);
            table.find_middles(&mut search, &cells, &between)?;
            table.find_checks(&mut search, &cells, &checking)?;
            let [distances_m, angles_rad] = table.finer(&cells, &search, request.max_loss);
            let is_fine = distances_m.len() == table.distances_m.len()
                && angles_rad.len() == table.angles_rad.len();
            let too_many = distances_m.len() * angles_rad.len() > MOST_NODES;
            if is_fine || too_many || halving == MOST_HALVINGS {
                break;
            }
            (table.distances_m, table.angles_rad) = (distances_m, angles_rad);
        }
        if request.max_loss < 1.0 && table.angles_rad.len() == 1 {
            for split in 0..MOST_SPLITS {
                let [_, between, checking] = stages_of_round(MOST_HALVINGS + 2 + split);
                let is_relevant = |cell: &Cell| is_relevant(&search, cell, request);
                let costly: Vec<bool> = table
                    .cells()
                    .iter()
                    .map(|cell| is_costly(&search, cell, request.max_loss) && is_relevant(cell))
                    .collect();
                if !costly.contains(&true) {
                    break;
                }
                table.split_at_jumps(&search, &costly, request.max_loss)?;
                let cells = table.relevant_cells(&search, request);
                table.find_middles(&mut search, &cells, &between)?;
                table.find_checks(&mut search, &cells, &checking)?;
            }
        }
        Ok(table)
    }

    /// Finds the shots of all nodes.
    fn find_nodes(
        &mut self,
        search: &mut TableSearch<'_>,
        stage: &str,
    ) -> Result<(), ShotTableError> {
        let nodes = grid(&self.distances_m, &self.angles_rad);
        let alone = nodes.iter().map(|node| (*node, Vec::new()));
        search.find_shots(alone, stage)?;
        let shots = nodes.iter().map(|node| search.shot_at(node).cloned());
        self.shots = shots.collect();
        Ok(())
    }

    /// Finds the shots in the middles of those cells that can be looked up there, from the optima
    /// of their corners.
    fn find_middles(
        &self,
        search: &mut TableSearch<'_>,
        cells: &[Cell],
        stage: &str,
    ) -> Result<(), ShotTableError> {
        let middles = cells
            .iter()
            .map(|cell| (cell.middle(), cell.corners()))
            .filter(|&(middle, _)| self.interpolated(middle).is_some());
        search.find_shots(middles, stage)
    }

    fn find_checks(
        &mut self,
        search: &mut TableSearch<'_>,
        cells: &[Cell],
        stage: &str,
    ) -> Result<(), ShotTableError> {
        search.find_checks(self, cells, stage)?;
        let checks = cells.iter().flat_map(|cell| search.checks_of(cell));
        self.checks = checks.collect();
        Ok(())
    }

    /// The cells between the nodes. One angle alone makes cells of no width, one distance alone
    /// none, and a jump none.
    fn cells(&self) -> Vec<Cell> {
        let pairs = |values: &[f64]| -> Vec<[f64; 2]> {
            let pairs = values.windows(2).map(|pair| [pair[0], pair[1]]);
            pairs.filter(|[low, high]| low < high).collect()
        };
        let angles = match self.angles_rad[..] {
            [angle] => vec![[angle, angle]],
            _ => pairs(&self.angles_rad),
        };
        let distances = pairs(&self.distances_m);
        let line = |&angle_rad: &[f64; 2]| {
            distances.iter().map(move |&distance_m| Cell {
                distance_m,
                angle_rad,
            })
        };
        angles.iter().flat_map(line).collect()
    }

    /// The cells that matter for the table.
    fn relevant_cells(&self, search: &TableSearch<'_>, request: &ShotTableRequest) -> Vec<Cell> {
        let mut cells = self.cells();
        cells.retain(|cell| is_relevant(search, cell, request));
        cells
    }

    /// Distances and angles, with the middles of those cells where a check found more than
    /// [`MARGIN`] of `max_loss`. A middle without a shot is left out: nothing could be looked up
    /// beside it.
    fn finer(&self, cells: &[Cell], search: &TableSearch<'_>, max_loss: f64) -> [Vec<f64>; 2] {
        let mut distances = self.distances_m.clone();
        let mut angles = self.angles_rad.clone();
        for cell in cells {
            if is_costly(search, cell, max_loss) && search.shot_at(&cell.middle()).is_some() {
                distances.push(cell.middle().distance_m);
                angles.push(cell.middle().angle_rad);
            }
        }
        for values in [&mut distances, &mut angles] {
            values.sort_by(f64::total_cmp);
            values.dedup();
        }
        [distances, angles]
    }

    /// Splits those cells of a table with one angle that halving did not help: between two optima
    /// of the same P lie shots of a lower one. Where the best shots of both sides lead to different
    /// optima, a jump from one to the other is put in the middle; elsewhere one node.
    fn split_at_jumps(
        &mut self,
        search: &TableSearch<'_>,
        costly: &[bool],
        max_loss: f64,
    ) -> Result<(), ShotTableError> {
        let (profile, kind) = (search.profile, search.kind);
        // A jump of an earlier split has two nodes and no cell between them.
        let is_cell = |&node: &usize| self.distances_m[node] < self.distances_m[node + 1];
        let nodes: Vec<usize> = (0..self.distances_m.len() - 1).filter(is_cell).collect();
        let cells = self.cells();
        for ((cell, &is_costly), &index) in cells.iter().zip(costly).zip(&nodes).rev() {
            if !is_costly || self.distances_m.len() + 2 > MOST_NODES {
                continue;
            }
            let middle = cell.middle();
            let Some(best) = search.shot_at(&middle) else {
                continue;
            };
            let mut branches = Vec::new();
            for (node, distance_m) in [(index, cell.distance_m[0]), (index + 1, cell.distance_m[1])]
            {
                let Some(shot) = self.at(0, node) else {
                    continue;
                };
                let location = Location {
                    distance_m,
                    ..middle
                };
                let placed = PlacedShot {
                    location,
                    nominal: shot.nominal,
                };
                let branch = continued(profile, kind, &placed, middle)?;
                branches.extend(branch.map(|shot| TableShot {
                    other_kind: best.other_kind,
                    ..shot
                }));
            }
            let new = match &branches[..] {
                [near, far]
                    if is_jump(&profile.moved_to(middle)?, [near, far], 0.25 * max_loss) =>
                {
                    branches
                }
                _ => vec![best.clone()],
            };
            let at = index + 1;
            for shot in new.into_iter().rev() {
                self.distances_m.insert(at, middle.distance_m);
                self.shots.insert(at, Some(shot));
            }
        }
        Ok(())
    }
}

/// Whether a check of a cell found more than [`MARGIN`] of `max_loss`.
fn is_costly(search: &TableSearch<'_>, cell: &Cell, max_loss: f64) -> bool {
    let mut checks = search.checks_of(cell);
    checks.any(|check| check.worse() > MARGIN * max_loss)
}

/// Whether a cell matters: not where P is less than the least one of the request; in a table of the
/// better kind not where the other kind is better by more
/// than [`WORSE_KIND`] at all corners and in the middle. (Its best shot need not be a clean one.
/// Where it is not, `merged` checks the cell.)
fn is_relevant(search: &TableSearch<'_>, cell: &Cell, request: &ShotTableRequest) -> bool {
    let is_near = |shot: &TableShot| {
        let other = shot.other_kind.unwrap_or(0.0);
        shot.probability > other - WORSE_KIND
    };
    let least = request.least_probability;
    let is_high = |shot: &TableShot| match request.kind {
        TableKind::One(_) => shot.probability >= least,
        TableKind::Better => shot.probability.max(shot.other_kind.unwrap_or(0.0)) >= least,
    };
    let any = |wanted: &dyn Fn(&TableShot) -> bool| {
        let mut places = cell.corners().into_iter().chain([cell.middle()]);
        places.any(|place| search.shot_at(&place).is_some_and(wanted))
    };
    (least <= 0.0 || any(&is_high)) && (request.kind != TableKind::Better || any(&is_near))
}

/// What progress calls the stages of a round.
fn stages_of_round(round: usize) -> [String; 3] {
    let most = MOST_HALVINGS + 1 + MOST_SPLITS;
    ["shots", "shots between them", "checks"]
        .map(|stage| format!("{stage}, round {round} of {most} at most"))
}

/// The profile with values that the search leaves as they are.
pub(crate) fn with_fixed(
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

/// The shot of a neighbour, moved to a place and climbed there; `None` if it leads to nothing that
/// goes in without an error.
fn continued(
    profile: &Profile,
    kind: ShotKind,
    shot: &PlacedShot,
    place: Location,
) -> Result<Option<TableShot>, ShotTableError> {
    let here = profile.moved_to(place)?;
    let start = moved(profile, &here, shot)?;
    let Some((nominal, estimate)) = climb_from_shots(&here, kind, &[start])? else {
        return Ok(None);
    };
    let outcome = here.simulator().outcome(here.release(&nominal).state());
    let shot = outcome
        .verdict
        .made
        .then(|| table_shot((&here, kind), &nominal, &estimate, &outcome));
    Ok(shot)
}

/// Whether P is lower between two shots from one place than their mean, by more than `depth`. About
/// one optimum it is higher: P is concave there.
fn is_jump(here: &Profile, [a, b]: [&TableShot; 2], depth: f64) -> bool {
    let mut between = Nominal::default();
    for variable in NominalVariable::ALL {
        *between.get_mut(variable) = 0.5 * (a.nominal.get(variable) + b.nominal.get(variable));
    }
    let search = here.search();
    let estimate =
        Sampler::new(here).estimate(&between, search.standard_error, search.seed, &Silent);
    estimate.probability < 0.5 * (a.probability + b.probability) - depth
}
