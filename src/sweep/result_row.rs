//! The result of one job: a row of typed cells in SI units.

use super::columns::{self, IntegerColumn, RealColumn, TextColumn};
use super::court_region::CourtPlace;
use crate::analysis::sensitivity::Difference;
use crate::best_shot::{BestShot, Limit, NoShot, ShotKind};
use crate::shooter::{Nominal, Profile};

/// One value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Empty.
    Null,
    /// A floating-point number.
    Real(f64),
    /// A whole number.
    Integer(i64),
    /// Text.
    Text(String),
}

impl Cell {
    fn real(value: f64) -> Self {
        if value.is_finite() {
            // Adding 0 turns a negative zero into zero.
            Self::Real(value + 0.0)
        } else {
            Self::Null
        }
    }
}

/// How a job ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JobStatus {
    /// A best shot was found.
    Found,
    /// No shot of this kind can go in.
    NoShot,
    /// The job failed.
    Failed,
}

impl JobStatus {
    const ALL: [Self; 3] = [Self::Found, Self::NoShot, Self::Failed];

    /// The name in the store and in the tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::NoShot => "none",
            Self::Failed => "failed",
        }
    }
}

/// The result of one job.
#[derive(Clone, Debug, PartialEq)]
pub struct ResultRow {
    /// The number of the job.
    pub job: u64,
    /// One cell for each of [`columns::ALL`].
    cells: Vec<Cell>,
}

impl ResultRow {
    /// From its cells, one for each of [`columns::ALL`]; `None` if their number is wrong.
    #[must_use]
    pub fn from_cells(job: u64, cells: Vec<Cell>) -> Option<Self> {
        (cells.len() == columns::ALL.len()).then_some(Self { job, cells })
    }

    fn new(job: u64, kind: ShotKind, spot: &CourtPlace, status: JobStatus) -> Self {
        let mut row = Self {
            job,
            cells: vec![Cell::Null; columns::ALL.len()],
        };
        let location = spot.location();
        row.set_text(columns::KIND, kind.name());
        row.set_real(columns::X, spot.x_m);
        row.set_real(columns::Y, spot.y_m);
        row.set_real(columns::DISTANCE, location.distance_m);
        row.set_real(columns::COURT_ANGLE, location.angle_rad);
        row.set_text(columns::STATUS, status.name());
        row
    }

    /// A job that failed.
    #[must_use]
    pub fn failed(job: u64, kind: ShotKind, spot: &CourtPlace, reason: &str) -> Self {
        let mut row = Self::new(job, kind, spot, JobStatus::Failed);
        let short: String = reason.chars().take(500).collect();
        row.set_text(columns::REASON, &short);
        row
    }

    /// A job that found a best shot, or that there is none.
    #[must_use]
    pub fn of_result(
        job: u64,
        kind: ShotKind,
        spot: &CourtPlace,
        profile: &Profile,
        shot: &Result<BestShot, NoShot>,
    ) -> Self {
        match shot {
            Ok(shot) => {
                let mut row = Self::new(job, kind, spot, JobStatus::Found);
                row.set_shot(shot);
                row.set_error_free_shot(profile, shot);
                row.set_sensitivity(shot);
                row
            }
            Err(reason) => {
                let mut row = Self::new(job, kind, spot, JobStatus::NoShot);
                row.set_text(columns::REASON, &reason.to_string());
                row
            }
        }
    }

    fn set_shot(&mut self, shot: &BestShot) {
        let (nominal, estimate) = (&shot.nominal, &shot.estimate);
        for (column, value) in [
            (columns::SPEED, nominal.speed_m_s),
            (columns::PITCH, nominal.pitch_rad),
            (columns::POLAR, nominal.polar_rad),
            (columns::BACKSPIN, nominal.backspin_rad_s),
            (columns::RIFLE_SPIN, nominal.rifle_spin_rad_s),
            (columns::SIDE_SPIN, nominal.side_spin_rad_s),
            (columns::PROBABILITY, estimate.probability),
            (columns::STANDARD_ERROR, estimate.standard_error),
            (columns::SHARE_SWISH, estimate.shares.swish),
            (columns::SHARE_RING, estimate.shares.ring),
            (columns::SHARE_BOARD, estimate.shares.board),
            (
                columns::SHARE_BOARD_AND_RING,
                estimate.shares.board_and_ring,
            ),
            (columns::MASS_OUTSIDE_BRACKET, shot.mass_outside),
        ] {
            self.set_real(column, value);
        }
        if let Some(p) = shot.search_probability {
            self.set_real(columns::SEARCH_PROBABILITY, p);
        }
        self.set_integer(columns::SHOTS, estimate.shots);
        self.set_integer(columns::UNRESOLVED, estimate.unresolved);
        if !shot.at_limits.is_empty() {
            let names: Vec<&str> = shot
                .at_limits
                .iter()
                .map(|limit| Limit::name(*limit))
                .collect();
            self.set_text(columns::AT_LIMITS, &names.join(" "));
        }
    }

    fn set_error_free_shot(&mut self, profile: &Profile, shot: &BestShot) {
        let outcome = &shot.outcome;
        self.set_text(columns::ERROR_FREE_KIND, outcome.kind.name());
        let board_point = outcome.board_point_m;
        for (column, value) in [
            (
                columns::ENTRY_ANGLE,
                outcome.entry.map(|entry| entry.angle_rad),
            ),
            (columns::AIM_PAST_CENTRE, shot.aim_past_centre_m),
            (columns::BOARD_AIM_ACROSS, board_point.map(|point| point.1)),
            (
                columns::BOARD_AIM_ABOVE_HOOP,
                board_point.map(|point| point.2),
            ),
        ] {
            if let Some(value) = value {
                self.set_real(column, value);
            }
        }
        let apex_m = outcome.apex_m + profile.physics().hoop_plane_height_m();
        self.set_real(columns::APEX_ABOVE_FLOOR, apex_m);
        self.set_real(columns::FLIGHT_TIME, outcome.verdict.time_s);
    }

    fn set_sensitivity(&mut self, shot: &BestShot) {
        let sensitivity = &shot.sensitivity;
        if let Some(gain) = sensitivity.backspin_gain() {
            let columns = [
                columns::BEST_BACKSPIN_OVER_NONE,
                columns::BEST_BACKSPIN_OVER_NONE_ERROR,
            ];
            self.set_gain(columns, &gain);
        }
        if let Some(costliest) = sensitivity.errors.first() {
            self.set_text(columns::COSTLIEST_ERROR, costliest.variable.name());
            let columns = [
                columns::GAIN_WITHOUT_COSTLIEST,
                columns::GAIN_WITHOUT_COSTLIEST_ERROR,
            ];
            self.set_gain(columns, &costliest.without);
        }
        for cost in &sensitivity.errors {
            self.set_gain(columns::gain_without(cost.variable), &cost.without);
        }
    }

    /// Sets a floating-point number; one that is not finite leaves the cell empty.
    pub fn set_real(&mut self, column: RealColumn, value: f64) {
        self.cells[column.index()] = Cell::real(value);
    }

    fn set_integer(&mut self, column: IntegerColumn, value: u64) {
        self.cells[column.index()] = i64::try_from(value).map_or(Cell::Null, Cell::Integer);
    }

    fn set_text(&mut self, column: TextColumn, value: &str) {
        self.cells[column.index()] = Cell::Text(value.to_owned());
    }

    fn set_gain(&mut self, [gain, error]: [RealColumn; 2], difference: &Difference) {
        self.set_real(gain, difference.value);
        self.set_real(error, difference.standard_error);
    }

    /// The cells, one for each of [`columns::ALL`].
    #[must_use]
    pub fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// A floating-point number, SI units; `None` if the cell is empty.
    #[must_use]
    pub fn real(&self, column: RealColumn) -> Option<f64> {
        match self.cells[column.index()] {
            Cell::Real(value) => Some(value),
            _ => None,
        }
    }

    /// A text; `None` if the cell is empty.
    #[must_use]
    pub fn text(&self, column: TextColumn) -> Option<&str> {
        match &self.cells[column.index()] {
            Cell::Text(text) => Some(text),
            _ => None,
        }
    }

    /// P and its standard error, if a shot was found.
    #[must_use]
    pub fn probability(&self) -> Option<Difference> {
        Some(Difference {
            value: self.real(columns::PROBABILITY)?,
            standard_error: self.real(columns::STANDARD_ERROR)?,
        })
    }

    /// The nominal shot, if one was found.
    #[must_use]
    pub fn nominal(&self) -> Option<Nominal> {
        Some(Nominal {
            speed_m_s: self.real(columns::SPEED)?,
            pitch_rad: self.real(columns::PITCH)?,
            polar_rad: self.real(columns::POLAR)?,
            backspin_rad_s: self.real(columns::BACKSPIN)?,
            rifle_spin_rad_s: self.real(columns::RIFLE_SPIN)?,
            side_spin_rad_s: self.real(columns::SIDE_SPIN)?,
        })
    }

    /// How the job ended; `None` if the cell has no valid status.
    #[must_use]
    pub fn status(&self) -> Option<JobStatus> {
        let name = self.text(columns::STATUS)?;
        JobStatus::ALL
            .into_iter()
            .find(|status| status.name() == name)
    }

    /// The result at the mirror image of its spot.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let cells = columns::ALL
            .iter()
            .zip(&self.cells)
            .map(|(column, cell)| match cell {
                Cell::Real(value) if column.is_odd_in_mirror => Cell::real(-value),
                other => other.clone(),
            });
        Self {
            job: self.job,
            cells: cells.collect(),
        }
    }

    /// BLAKE3 of the row and its configuration, shortened to 16 bytes.
    #[must_use]
    pub fn checksum(&self, configuration: &str) -> Vec<u8> {
        let mut hasher = blake3::Hasher::new();
        hasher.update(configuration.as_bytes());
        hasher.update(&self.job.to_le_bytes());
        for cell in &self.cells {
            match cell {
                Cell::Null => hasher.update(&[0]),
                Cell::Real(value) => hasher.update(&[1]).update(&value.to_bits().to_le_bytes()),
                Cell::Integer(value) => hasher.update(&[2]).update(&value.to_le_bytes()),
                Cell::Text(text) => hasher
                    .update(&[3])
                    .update(&(text.len() as u64).to_le_bytes())
                    .update(text.as_bytes()),
            };
        }
        hasher.finalize().as_bytes()[..16].to_vec()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::FOOT_M;

    #[test]
    fn prop_twice_mirrored_is_the_same_and_nothing_else_changes() {
        let spot = CourtPlace {
            x_m: 10.0 * FOOT_M,
            y_m: 4.0 * FOOT_M,
        };
        let row = ResultRow::failed(7, ShotKind::Bank, &spot, "a reason");
        let mirrored = row.mirrored();
        assert_eq!(mirrored.real(columns::Y), Some(-spot.y_m));
        assert_eq!(mirrored.real(columns::X), row.real(columns::X));
        assert_eq!(mirrored.mirrored(), row);
        assert_ne!(mirrored.checksum("a"), row.checksum("a"));
        assert_ne!(row.checksum("b"), row.checksum("a"));
    }
}
