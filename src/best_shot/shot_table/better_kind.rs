//! One table of the kind with the higher P, out of a table of each kind.

use super::cells::Cell;
use super::interpolation_check::{BestKnown, PlacedShot, check};
use super::lookup::{ShotTable, TableKind, TableShot};
use super::shot_at_place::{ShotTableError, best};
use crate::best_shot::followed::Starts;
use crate::probability::Silent;
use crate::shooter::{Location, Profile, ShotKind};
use std::ops::RangeInclusive;

/// The other kind must be better by this before the table changes to it, or by half of the allowed
/// loss if that is less. Where both are as good, the table would go from one to the other and back.
const LEAST_GAIN: f64 = 0.005;
/// A change this near to a node, as a share of the step, is at the node.
const NEAR_NODE: f64 = 1e-3;

/// Distances with shots of one kind.
struct Stretch {
    from_m: f64,
    to_m: f64,
    kind: ShotKind,
}

/// Merges two tables with one angle, direct and bank. At each change there are two nodes at one
/// distance.
pub(super) fn merged(
    profile: &Profile,
    tables: [ShotTable; 2],
    (max_loss, is_draft): (f64, bool),
) -> Result<ShotTable, ShotTableError> {
    let angle_rad = tables[0].angles_rad[0];
    let stretches = stretches(&tables, LEAST_GAIN.min(0.5 * max_loss));
    let mut nodes: Vec<(f64, Option<TableShot>)> = Vec::new();
    for stretch in &stretches {
        let table = of_kind(&tables, stretch.kind);
        let all = || table.distances_m.iter().copied().zip(&table.shots);
        let within =
            |(distance_m, _): &(f64, _)| stretch.from_m < *distance_m && *distance_m < stretch.to_m;
        // Of the two nodes of a jump the first ends what is below.
        let first = all().rfind(|node| node.0 == stretch.from_m);
        let last = all().find(|node| node.0 == stretch.to_m);
        let end = |found: Option<(f64, &Option<TableShot>)>, distance_m: f64| match found {
            Some((_, shot)) => Ok((distance_m, shot.clone())),
            None => {
                let here = profile.moved_to(Location {
                    distance_m,
                    angle_rad,
                })?;
                let found = best((&here, Starts::Table), stretch.kind, &Silent)?;
                Ok::<_, ShotTableError>((distance_m, found.shot.ok()))
            }
        };
        nodes.push(end(first, stretch.from_m)?);
        nodes.extend(all().filter(within).map(|(d, shot)| (d, shot.clone())));
        if stretch.to_m > stretch.from_m {
            nodes.push(end(last, stretch.to_m)?);
        }
    }
    let (distances_m, shots) = nodes.into_iter().unzip();
    let mut table = ShotTable {
        kind: TableKind::Better,
        distances_m,
        angles_rad: vec![angle_rad],
        shots,
        added_distances_m: Vec::new(),
        added_angles_rad: Vec::new(),
        checks: Vec::new(),
    };
    for stretch in &stretches {
        table.check_stretch(profile, stretch, &tables, is_draft)?;
    }
    Ok(table)
}

fn of_kind(tables: &[ShotTable; 2], kind: ShotKind) -> &ShotTable {
    &tables[kind.index()]
}

/// P of a table at both ends of a range that has no node inside; `None` beside a node without a
/// shot.
fn ends(table: &ShotTable, range_m: &RangeInclusive<f64>) -> Option<[f64; 2]> {
    let steps = table.distances_m.windows(2);
    let step = steps.into_iter().position(|step| {
        step[0] < step[1] && step[0] <= *range_m.start() && *range_m.end() <= step[1]
    })?;
    let (low, high) = (table.distances_m[step], table.distances_m[step + 1]);
    let [p_low, p_high] =
        [step, step + 1].map(|node| table.at(0, node).map(|shot| shot.probability));
    let (p_low, p_high) = (p_low?, p_high?);
    Some(
        [range_m.start(), range_m.end()]
            .map(|x| p_low + (p_high - p_low) * (x - low) / (high - low)),
    )
}

/// Which kind is better where.
fn stretches(tables: &[ShotTable; 2], least_gain: f64) -> Vec<Stretch> {
    let mut union: Vec<f64> = tables
        .iter()
        .flat_map(|table| table.distances_m.clone())
        .collect();
    union.sort_by(f64::total_cmp);
    union.dedup();
    let mut stretches: Vec<Stretch> = Vec::new();
    let mut push = |from_m: f64, to_m: f64, kind: ShotKind| match stretches.last_mut() {
        Some(last) if last.kind == kind => last.to_m = to_m,
        _ => stretches.push(Stretch { from_m, to_m, kind }),
    };
    if let [only] = union[..] {
        let p = |kind: ShotKind| of_kind(tables, kind).at(0, 0).map(|shot| shot.probability);
        let is_bank = p(ShotKind::Bank) > p(ShotKind::Direct);
        push(
            only,
            only,
            if is_bank {
                ShotKind::Bank
            } else {
                ShotKind::Direct
            },
        );
    }
    let mut kind = None;
    for pair in union.windows(2) {
        let (from_m, to_m) = (pair[0], pair[1]);
        let of = |kind| ends(of_kind(tables, kind), &(from_m..=to_m));
        let (direct, bank) = (of(ShotKind::Direct), of(ShotKind::Bank));
        let (Some(direct), Some(bank)) = (direct, bank) else {
            let has = match (direct, bank) {
                (Some(_), _) => ShotKind::Direct,
                (_, Some(_)) => ShotKind::Bank,
                _ => kind.unwrap_or(ShotKind::Direct),
            };
            kind = Some(has);
            push(from_m, to_m, has);
            continue;
        };
        let gain_of_bank = [bank[0] - direct[0], bank[1] - direct[1]];
        let gain_over = |kind| match kind {
            ShotKind::Direct => gain_of_bank,
            ShotKind::Bank => gain_of_bank.map(|gain| -gain),
        };
        let mut here = kind.unwrap_or(if gain_of_bank[0] > 0.0 {
            ShotKind::Bank
        } else {
            ShotKind::Direct
        });
        if gain_over(here)[0] > least_gain {
            here = here.other();
        }
        let [gain, gain_at_end] = gain_over(here);
        if gain_at_end > least_gain {
            let part = if gain < 0.0 {
                gain / (gain - gain_at_end)
            } else {
                0.0
            };
            let part = if part < NEAR_NODE {
                0.0
            } else if part > 1.0 - NEAR_NODE {
                1.0
            } else {
                part
            };
            let change_m = if part == 1.0 {
                to_m
            } else {
                from_m + part * (to_m - from_m)
            };
            if part > 0.0 {
                push(from_m, change_m, here);
            }
            here = here.other();
            if part < 1.0 {
                push(change_m, to_m, here);
            }
        } else {
            push(from_m, to_m, here);
        }
        kind = Some(here);
    }
    stretches
}

impl ShotTable {
    /// Adds the checks of a stretch: those of its table, and new ones in the cells that a change
    /// cut.
    fn check_stretch(
        &mut self,
        profile: &Profile,
        stretch: &Stretch,
        tables: &[ShotTable; 2],
        is_draft: bool,
    ) -> Result<(), ShotTableError> {
        let (own, other) = (
            of_kind(tables, stretch.kind),
            of_kind(tables, stretch.kind.other()),
        );
        let mut checks = Vec::new();
        for node in 0..self.distances_m.len().saturating_sub(1) {
            let step = [self.distances_m[node], self.distances_m[node + 1]];
            if step[0] >= step[1] || step[0] < stretch.from_m || step[1] > stretch.to_m {
                continue;
            }
            let inside = |distance_m: f64| step[0] < distance_m && distance_m < step[1];
            let of_own = own.checks.iter().copied();
            let of_own: Vec<_> = of_own
                .filter(|check| inside(check.location.distance_m))
                .collect();
            let is_own = own.distances_m.windows(2).any(|pair| pair == step);
            // Of a cell that did not seem to matter the own table has no checks.
            if is_own && (is_draft || !of_own.is_empty()) {
                checks.extend(of_own);
                continue;
            }
            let cell = Cell {
                distance_m: step,
                angle_rad: [self.angles_rad[0]; 2],
            };
            for location in cell.checked_places() {
                let Some((nominal, looked_up)) = self.interpolated(location) else {
                    continue;
                };
                let shot = PlacedShot { location, nominal };
                let here = profile.moved_to(location)?;
                let found = best((&here, Starts::Table), stretch.kind, &Silent)?
                    .shot
                    .ok();
                let known = BestKnown::Searched(found.map(|shot| shot.probability));
                checks.push(check(profile, stretch.kind, (shot, looked_up), known)?);
            }
        }
        for check in &mut checks {
            if let Some((_, p)) = other.interpolated(check.location) {
                check.best = Some(check.best.map_or(p, |best| best.max(p)));
            }
        }
        self.checks.extend(checks);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::OutcomeKind;
    use crate::shooter::Nominal;

    fn table(kind: ShotKind, nodes: &[(f64, Option<f64>)]) -> ShotTable {
        let shot = |p: f64| TableShot {
            kind,
            nominal: Nominal::default(),
            aim_rad: 0.0,
            probability: p,
            standard_error: 0.0,
            banked: 0.0,
            outcome: OutcomeKind::Swish,
            time_s: Some(1.0),
            entry_rad: None,
            tolerances: [[0.0; 2]; 2],
            other_kind: None,
            board_aim_m: None,
        };
        ShotTable {
            kind: TableKind::One(kind),
            distances_m: nodes.iter().map(|node| node.0).collect(),
            angles_rad: vec![0.0],
            shots: nodes.iter().map(|node| node.1.map(shot)).collect(),
            added_distances_m: Vec::new(),
            added_angles_rad: Vec::new(),
            checks: Vec::new(),
        }
    }

    fn found(
        direct: &[(f64, Option<f64>)],
        bank: &[(f64, Option<f64>)],
    ) -> Vec<(f64, f64, ShotKind)> {
        let tables = [table(ShotKind::Direct, direct), table(ShotKind::Bank, bank)];
        stretches(&tables, 0.01)
            .iter()
            .map(|s| (s.from_m, s.to_m, s.kind))
            .collect()
    }

    #[test]
    fn contract_the_better_kind_of_each_stretch() {
        use ShotKind::{Bank, Direct};
        let bank = [(1.0, Some(0.9)), (3.0, Some(0.7))];
        // They cross in the middle of a cell, and a node of one table alone does not matter.
        let direct = [(1.0, Some(0.7)), (2.0, Some(0.8)), (3.0, Some(0.9))];
        assert_eq!(
            found(&direct, &bank),
            [(1.0, 2.0, Bank), (2.0, 3.0, Direct)]
        );
        // A gain that is too small changes nothing.
        let direct = [(1.0, Some(0.85)), (3.0, Some(0.705))];
        assert_eq!(found(&direct, &bank), [(1.0, 3.0, Bank)]);
        // No direct shot at the first node: none to interpolate from.
        let direct = [(1.0, None), (2.0, Some(0.9)), (3.0, Some(0.9))];
        assert_eq!(
            found(&direct, &bank),
            [(1.0, 2.0, Bank), (2.0, 3.0, Direct)]
        );
        // A jump of one table.
        let direct = [
            (1.0, Some(0.5)),
            (2.0, Some(0.5)),
            (2.0, Some(0.9)),
            (3.0, Some(0.9)),
        ];
        assert_eq!(
            found(&direct, &bank),
            [(1.0, 2.0, Bank), (2.0, 3.0, Direct)]
        );
        // One place.
        assert_eq!(
            found(&[(1.0, None)], &[(1.0, Some(0.2))]),
            [(1.0, 1.0, Bank)]
        );
    }
}
