//! A table of best shots: its nodes, and the shot between them.

use super::interpolation_check::InterpolationCheck;
use crate::dynamics::OutcomeKind;
use crate::shooter::{Location, Nominal, NominalVariable, ShotKind};
use serde::{Deserialize, Serialize};

/// Which shots a table has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum TableKind {
    /// Those of one kind.
    One(ShotKind),
    /// Those of the kind with the higher P.
    Better,
}

impl TableKind {
    /// `direct`, `bank` or `best`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::One(kind) => kind.name(),
            Self::Better => "best",
        }
    }
}

/// The best shot at one node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TableShot {
    /// Its kind.
    pub kind: ShotKind,
    /// The nominal shot.
    pub nominal: Nominal,
    /// Its direction from the line to the hoop's centre, rad, positive to the shooter's left.
    pub aim_rad: f64,
    /// P.
    pub probability: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// The share of its makes that touch the board first.
    pub banked: f64,
    /// How the error-free shot goes in.
    pub outcome: OutcomeKind,
    /// Time from the release until the error-free shot first falls to the height of the hoop, as if
    /// there were no ring, s: a bank shot after it leaves the board. `None` for a shot that meets
    /// the ring on its way up, and would fall behind the board without it.
    pub time_s: Option<f64>,
    /// Its angle below the horizontal then, rad; `None` if it is not defined.
    pub entry_rad: Option<f64>,
    /// How far speed (m/s) and pitch angle (rad) can be below and above their values until an
    /// otherwise exact shot misses.
    pub tolerances: [[f64; 2]; 2],
    /// P of the other kind's optimum that climbs alone find; `None` where no shot of it is made.
    pub other_kind: Option<f64>,
    /// Where the ball's centre is when an error-free bank shot touches the board: to the right of
    /// its middle and above the hoop, m. `None` for a direct shot.
    pub board_aim_m: Option<(f64, f64)>,
}

/// A table of best shots.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotTable {
    /// Which shots it has.
    pub kind: TableKind,
    /// Distances, ascending, m. One that stands twice is a jump: its first shot ends the cell
    /// below, its second one begins the cell above.
    pub distances_m: Vec<f64>,
    /// Court angles, ascending, rad.
    pub angles_rad: Vec<f64>,
    /// The shots, angle by angle; `None` where there is no clean one.
    pub shots: Vec<Option<TableShot>>,
    /// The distances and angles among them that were not asked for.
    pub added_distances_m: Vec<f64>,
    /// As `added_distances_m`, rad.
    pub added_angles_rad: Vec<f64>,
    /// The checks between the nodes, cell by cell.
    pub checks: Vec<InterpolationCheck>,
}

impl ShotTable {
    /// The shot at a node.
    #[must_use]
    pub fn at(&self, angle: usize, distance: usize) -> Option<&TableShot> {
        self.shots[angle * self.distances_m.len() + distance].as_ref()
    }

    /// The shot at a place inside the table and its P, linear in distance and court angle; `None`
    /// where a node has no shot.
    #[must_use]
    pub fn interpolated(&self, location: Location) -> Option<(Nominal, f64)> {
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
        let mut probability = 0.0;
        for (a, d, weight) in corners {
            if weight == 0.0 {
                continue;
            }
            let shot = self.at(a, d)?;
            aim += weight * shot.aim_rad;
            probability += weight * shot.probability;
            for variable in NominalVariable::ALL {
                *nominal.get_mut(variable) += weight * shot.nominal.get(variable);
            }
        }
        nominal.polar_rad = location.angle_rad + aim;
        Some((nominal, probability))
    }

    /// The check where interpolation costs most; `None` without a check.
    #[must_use]
    pub fn costliest(&self) -> Option<&InterpolationCheck> {
        let checks = self.checks.iter();
        checks.max_by(|a, b| a.loss().total_cmp(&b.loss()))
    }

    /// The check where the interpolated P errs most; `None` without a check.
    #[must_use]
    pub fn most_wrong(&self) -> Option<&InterpolationCheck> {
        let checks = self.checks.iter();
        checks.max_by(|a, b| a.error().abs().total_cmp(&b.error().abs()))
    }

    /// The greatest that any check found, of loss and of error; `None` without a check.
    #[must_use]
    pub fn worst(&self) -> Option<f64> {
        let checks = self.checks.iter().map(InterpolationCheck::worse);
        checks.max_by(f64::total_cmp)
    }

    /// The distances at which the best shot jumps, m.
    pub fn jumps_m(&self) -> impl Iterator<Item = f64> + '_ {
        let pairs = self.distances_m.windows(2);
        pairs.filter(|pair| pair[0] == pair[1]).map(|pair| pair[0])
    }

    /// Whether a shot without an error touches nothing but, in a bank shot, the board.
    #[must_use]
    pub fn is_clean(&self, shot: &TableShot) -> bool {
        let clean = match shot.kind {
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
