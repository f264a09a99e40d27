//! Where the climbs of a search start.

use super::followed::Starts;
use super::pattern_search::Start;
use super::search::BestShotSearch;
use super::table_maxima::{maxima_by_pitch, maxima_by_speed, separated};
use crate::search_space::{PlanError, TablePlan};
use crate::shooter::{Nominal, NominalVariable, Profile, ShotKind};

/// The side spins from which the search starts: the fixed one; or none and the limits. One limit is
/// enough if the other is its mirror image.
fn start_side_spins(profile: &Profile, plan: &TablePlan) -> Vec<f64> {
    let most = profile.shooter().max_side_spin_rad_s;
    let is_searched = profile.search().choice.includes(NominalVariable::SideSpin);
    match (is_searched, plan.mirrored) {
        (false, _) => vec![plan.nominal.side_spin_rad_s],
        (true, true) => vec![0.0, most],
        (true, false) => vec![0.0, most, -most],
    }
}

impl BestShotSearch<'_> {
    /// The starts of the climbs of some kinds.
    pub(super) fn starts(&self, kinds: &[ShotKind], from: Starts) -> Result<Vec<Start>, PlanError> {
        let known = match from {
            Starts::Table => Vec::new(),
            Starts::Optima(shots) => self.starts_among(shots),
        };
        let is_known = |kind: &ShotKind| known.iter().any(|start| start.kind == *kind);
        let new: Vec<ShotKind> = kinds
            .iter()
            .copied()
            .filter(|kind| !is_known(kind))
            .collect();
        let mut starts = self.starts_of_table(&new)?;
        starts.extend(
            known
                .into_iter()
                .filter(|start| kinds.contains(&start.kind)),
        );
        Ok(starts)
    }

    /// Starts at those of some shots that are not the same optimum as one before, each of its kind.
    pub(super) fn starts_among(&self, shots: &[Nominal]) -> Vec<Start> {
        let search = self.pattern_search();
        let mut starts: Vec<Start> = Vec::new();
        for shot in shots {
            let nominal = search.within_limits(shot);
            let kind = ShotKind::of(self.profile, &nominal);
            let is_other =
                |start: &Start| start.kind != kind || self.are_apart(&start.nominal, &nominal);
            if starts.iter().all(is_other) {
                starts.push(Start { kind, nominal });
            }
        }
        starts
    }

    /// The best shots of the coarse table, far apart.
    fn starts_of_table(&self, kinds: &[ShotKind]) -> Result<Vec<Start>, PlanError> {
        let mut starts = Vec::new();
        if kinds.is_empty() {
            return Ok(starts);
        }
        for side_spin_rad_s in start_side_spins(self.profile, self.plan) {
            let plan = TablePlan::for_search_with_side_spin(self.profile, side_spin_rad_s)?;
            let table = self.table(&plan);
            let maxima = if table.pitch_rad.len() == 1 {
                maxima_by_speed(self.profile, &table)
            } else {
                maxima_by_pitch(self.profile, &table)
            };
            for &kind in kinds {
                let separated = separated(&maxima[kind.index()]).into_iter();
                starts.extend(separated.map(|(_, nominal)| Start { kind, nominal }));
            }
        }
        Ok(starts)
    }
}
