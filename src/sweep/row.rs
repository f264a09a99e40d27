//! The result of one job as a row of named values, SI units; the one definition behind the store, the
//! CSV and the Parquet tables.

use super::region::Spot;
use crate::probability::best::{BestShot, NoShot, ShotKind};
use crate::probability::lessons::Difference;
use crate::profile::Profile;
use crate::units::{DEGREE_RAD, REV_RAD, System};

/// What a column holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// A number.
    Real,
    /// A whole number.
    Integer,
    /// Text.
    Text,
}

/// In what a column is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// A bare value.
    None,
    /// Along the court: m, ft.
    Length,
    /// About the ring and the board: m in the store, cm or in.
    Short,
    /// m/s, ft/s.
    Speed,
    /// rad in the store, deg.
    Angle,
    /// rad/s in the store, rev/s.
    Spin,
    /// s.
    Time,
}

impl Unit {
    /// The ending of a column's name in the store.
    #[must_use]
    pub fn si(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Length | Self::Short => "_m",
            Self::Speed => "_m_s",
            Self::Angle => "_rad",
            Self::Spin => "_rad_s",
            Self::Time => "_s",
        }
    }

    /// The ending of a column's name in the tables, and the unit's size in SI.
    #[must_use]
    pub fn shown(self, system: System) -> (String, f64) {
        let (long, foot) = system.length();
        let (short, inch) = system.short_length();
        match self {
            Self::None => (String::new(), 1.0),
            Self::Length => (format!("_{long}"), foot),
            Self::Short => (format!("_{short}"), inch),
            Self::Speed => (format!("_{long}_s"), foot),
            Self::Angle => ("_deg".to_owned(), DEGREE_RAD),
            Self::Spin => ("_rev_s".to_owned(), REV_RAD),
            Self::Time => ("_s".to_owned(), 1.0),
        }
    }
}

/// One column of a result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// Its name without the unit.
    pub name: &'static str,
    /// What it holds.
    pub of: Type,
    /// In what it is measured.
    pub unit: Unit,
    /// Does its sign change in the mirror?
    pub sided: bool,
}

impl Column {
    /// Its name in the store.
    #[must_use]
    pub fn si_name(&self) -> String {
        format!("{}{}", self.name, self.unit.si())
    }
}

const fn column(name: &'static str, of: Type, unit: Unit) -> Column {
    Column {
        name,
        of,
        unit,
        sided: false,
    }
}

const fn real(name: &'static str, unit: Unit) -> Column {
    column(name, Type::Real, unit)
}

const fn sided(name: &'static str, unit: Unit) -> Column {
    Column {
        name,
        of: Type::Real,
        unit,
        sided: true,
    }
}

/// The columns of a result.
pub const COLUMNS: [Column; 54] = [
    column("kind", Type::Text, Unit::None),
    real("x", Unit::Length),
    sided("y", Unit::Length),
    real("distance", Unit::Length),
    sided("court_angle", Unit::Angle),
    column("status", Type::Text, Unit::None),
    column("reason", Type::Text, Unit::None),
    real("speed", Unit::Speed),
    real("pitch", Unit::Angle),
    sided("polar", Unit::Angle),
    real("backspin", Unit::Spin),
    sided("rifle_spin", Unit::Spin),
    sided("side_spin", Unit::Spin),
    real("probability", Unit::None),
    real("standard_error", Unit::None),
    column("shots", Type::Integer, Unit::None),
    real("share_swish", Unit::None),
    real("share_ring", Unit::None),
    real("share_board", Unit::None),
    real("share_board_and_ring", Unit::None),
    column("unresolved", Type::Integer, Unit::None),
    real("table_probability", Unit::None),
    column("error_free_kind", Type::Text, Unit::None),
    real("entry_angle", Unit::Angle),
    real("aim_past_centre", Unit::Short),
    sided("board_aim_across", Unit::Short),
    real("board_aim_above_hoop", Unit::Short),
    real("apex_above_floor", Unit::Length),
    real("flight_time", Unit::Time),
    real("mass_outside_bracket", Unit::None),
    column("at_limits", Type::Text, Unit::None),
    real("best_backspin_over_none", Unit::None),
    real("best_backspin_over_none_error", Unit::None),
    column("costliest_error", Type::Text, Unit::None),
    real("gain_without_costliest", Unit::None),
    real("gain_without_costliest_error", Unit::None),
    real("gain_without_speed", Unit::None),
    real("gain_without_speed_error", Unit::None),
    real("gain_without_pitch", Unit::None),
    real("gain_without_pitch_error", Unit::None),
    real("gain_without_polar", Unit::None),
    real("gain_without_polar_error", Unit::None),
    real("gain_without_backspin", Unit::None),
    real("gain_without_backspin_error", Unit::None),
    real("gain_without_rifle_spin", Unit::None),
    real("gain_without_rifle_spin_error", Unit::None),
    real("gain_without_side_spin", Unit::None),
    real("gain_without_side_spin_error", Unit::None),
    real("gain_without_distance", Unit::None),
    real("gain_without_distance_error", Unit::None),
    real("gain_without_court_angle", Unit::None),
    real("gain_without_court_angle_error", Unit::None),
    real("gain_without_height", Unit::None),
    real("gain_without_height_error", Unit::None),
];

/// One value.
#[derive(Clone, Debug, PartialEq)]
pub enum Cell {
    /// Nothing.
    Null,
    /// A number.
    Real(f64),
    /// A whole number.
    Integer(i64),
    /// Text.
    Text(String),
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        if value.is_finite() {
            // Adding 0 leaves no negative zero.
            Self::Real(value + 0.0)
        } else {
            Self::Null
        }
    }
}

impl From<Option<f64>> for Cell {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::Null, Self::from)
    }
}

impl From<u64> for Cell {
    fn from(value: u64) -> Self {
        i64::try_from(value).map_or(Self::Null, Self::Integer)
    }
}

impl From<&str> for Cell {
    fn from(value: &str) -> Self {
        Self::Text(value.to_owned())
    }
}

/// How a job ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// A best shot was found.
    Found,
    /// No shot of this kind can go in.
    None,
    /// The job failed, for the reason that stands beside.
    Failed,
}

impl Status {
    /// As it is stored.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::None => "none",
            Self::Failed => "failed",
        }
    }
}

/// The result of one job.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The job's number.
    pub job: u64,
    /// One cell for each of [`COLUMNS`].
    pub cells: Vec<Cell>,
}

/// The place of a column, which must be there.
#[must_use]
pub fn place_of(name: &str) -> usize {
    COLUMNS
        .iter()
        .position(|column| column.name == name)
        .unwrap_or(COLUMNS.len())
}

impl Row {
    fn new(job: u64, kind: ShotKind, spot: &Spot, status: Status, reason: &str) -> Self {
        let mut row = Self {
            job,
            cells: vec![Cell::Null; COLUMNS.len()],
        };
        let place = spot.place();
        row.set("kind", kind.name());
        row.set("x", spot.x_m);
        row.set("y", spot.y_m);
        row.set("distance", place.distance_m);
        row.set("court_angle", place.angle_rad);
        row.set("status", status.name());
        if !reason.is_empty() {
            row.set("reason", reason);
        }
        row
    }

    /// A job that failed.
    #[must_use]
    pub fn failed(job: u64, kind: ShotKind, spot: &Spot, reason: &str) -> Self {
        let short: String = reason.chars().take(500).collect();
        Self::new(job, kind, spot, Status::Failed, &short)
    }

    /// A job that found a best shot, or that there is none.
    #[must_use]
    pub fn found(
        job: u64,
        kind: ShotKind,
        spot: &Spot,
        profile: &Profile,
        shot: &Result<BestShot, NoShot>,
    ) -> Self {
        let shot = match shot {
            Ok(shot) => shot,
            Err(reason) => {
                return Self::new(job, kind, spot, Status::None, &reason.to_string());
            }
        };
        let mut row = Self::new(job, kind, spot, Status::Found, "");
        let (nominal, estimate) = (&shot.nominal, &shot.estimate);
        row.set("speed", nominal.speed_m_s);
        row.set("pitch", nominal.pitch_rad);
        row.set("polar", nominal.polar_rad);
        row.set("backspin", nominal.backspin_rad_s);
        row.set("rifle_spin", nominal.rifle_spin_rad_s);
        row.set("side_spin", nominal.side_spin_rad_s);
        row.set("probability", estimate.probability);
        row.set("standard_error", estimate.standard_error);
        row.set("shots", estimate.shots);
        row.set("share_swish", estimate.shares.swish);
        row.set("share_ring", estimate.shares.ring);
        row.set("share_board", estimate.shares.board);
        row.set("share_board_and_ring", estimate.shares.board_and_ring);
        row.set("unresolved", estimate.unresolved);
        row.set("table_probability", shot.table_probability);
        let outcome = &shot.outcome;
        row.set("error_free_kind", outcome.kind.name());
        row.set("entry_angle", outcome.entry.map(|entry| entry.angle_rad));
        row.set("aim_past_centre", shot.aim_past_centre_m);
        row.set(
            "board_aim_across",
            outcome.board_point_m.map(|point| point.1),
        );
        row.set(
            "board_aim_above_hoop",
            outcome.board_point_m.map(|point| point.2),
        );
        row.set(
            "apex_above_floor",
            outcome.apex_m + profile.physics.hoop_height_m,
        );
        row.set("flight_time", outcome.verdict.time_s);
        row.set("mass_outside_bracket", shot.mass_outside);
        if !shot.at_limits.is_empty() {
            row.set("at_limits", shot.at_limits.join(" ").as_str());
        }
        if let Some(worth) = shot.lessons.spin_is_worth() {
            row.set_gain("best_backspin_over_none", &worth);
        }
        if let Some(costliest) = shot.lessons.costs.first() {
            row.set("costliest_error", costliest.error);
            row.set_gain("gain_without_costliest", &costliest.without);
        }
        for cost in &shot.lessons.costs {
            row.set_gain(&format!("gain_without_{}", cost.error), &cost.without);
        }
        row
    }

    fn set(&mut self, name: &str, value: impl Into<Cell>) {
        if let Some(cell) = self.cells.get_mut(place_of(name)) {
            *cell = value.into();
        }
    }

    fn set_gain(&mut self, name: &str, gain: &Difference) {
        self.set(name, gain.by);
        self.set(&format!("{name}_error"), gain.standard_error);
    }

    /// A cell by its column's name.
    #[must_use]
    pub fn get(&self, name: &str) -> &Cell {
        self.cells.get(place_of(name)).unwrap_or(&Cell::Null)
    }

    /// How the job ended; none where the cell makes no sense.
    #[must_use]
    pub fn status(&self) -> Option<Status> {
        let Cell::Text(name) = self.get("status") else {
            return None;
        };
        [Status::Found, Status::None, Status::Failed]
            .into_iter()
            .find(|status| status.name() == name)
    }

    /// The result at the mirror image of its place.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let cells = COLUMNS
            .iter()
            .zip(&self.cells)
            .map(|(column, cell)| match cell {
                Cell::Real(value) if column.sided => Cell::from(-value),
                other => other.clone(),
            });
        Self {
            job: self.job,
            cells: cells.collect(),
        }
    }

    /// BLAKE3 of the row under its configuration, shortened to 16 bytes.
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
    use crate::physics::FOOT_M;
    use crate::profile::ERROR_NAMES;

    #[test]
    fn contract_every_error_has_its_columns() {
        for name in ERROR_NAMES {
            assert!(place_of(&format!("gain_without_{name}")) < COLUMNS.len());
            assert!(place_of(&format!("gain_without_{name}_error")) < COLUMNS.len());
        }
        let mut names: Vec<_> = COLUMNS.iter().map(|column| column.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), COLUMNS.len());
    }

    #[test]
    fn prop_twice_mirrored_is_the_same_and_nothing_else_changes() {
        let spot = Spot {
            x_m: 10.0 * FOOT_M,
            y_m: 4.0 * FOOT_M,
        };
        let row = Row::failed(7, ShotKind::Bank, &spot, "a reason");
        let mirrored = row.mirrored();
        assert_eq!(mirrored.get("y"), &Cell::from(-spot.y_m));
        assert_eq!(mirrored.get("x"), row.get("x"));
        assert_eq!(mirrored.mirrored(), row);
        assert_ne!(mirrored.checksum("a"), row.checksum("a"));
        assert_ne!(row.checksum("b"), row.checksum("a"));
    }
}
