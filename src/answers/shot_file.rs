//! What a file of measured shots holds: its first rows, what each column is taken as, its players,
//! and what is wrong in which row.

use super::json::{Answer, in_si};
use crate::dynamics::Simulator;
use crate::fitting::Tracker;
use crate::measured_shots::column_map_proposal::Proposal;
use crate::measured_shots::columns::{Columns, LABELS, Quantity};
use crate::measured_shots::court_frame::CourtFrame;
use crate::measured_shots::decisions::{Decisions, decide};
use crate::measured_shots::read::read;
use crate::measured_shots::session_days::DateOrder;
use crate::measured_shots::shooter_shots::{ReadOptions, ShooterShots};
use crate::measured_shots::source::Source;
use crate::measured_shots::table::Table;
use crate::model::league_courts::League;
use crate::model::named_places::{place_named, place_names_in_words};
use crate::model::{DEFAULT_PRESET, Preset};
use crate::probability::Silent;
use crate::shooter::Location;
use crate::units::{self, Dimension};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::Path;

/// Rows that are shown.
const SHOWN_ROWS: usize = 12;
/// Wrong rows that are listed.
const LISTED_FAULTS: usize = 200;

/// What a file does not say by itself.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct ShotFileRequest {
    /// What columns hold, as `--map` takes it: `depth=PastCentre:in+9`.
    pub maps: Vec<String>,
    /// The place of all shots by its name, such as `free throw`.
    pub at: Option<String>,
    /// The distance of the place, such as `13.75 ft`.
    pub distance: Option<String>,
    /// The height of the release of all players, such as `7 ft`.
    pub release_height: Option<String>,
    /// The text of a make.
    pub made: Option<String>,
    /// The order of dates: `dmy` or `mdy`.
    pub dates: Option<String>,
}

/// What a column is taken as.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ColumnAnswer {
    /// Its name in the file.
    pub name: String,
    /// The quantity or label; `None` where the column is not used.
    pub target: Option<&'static str>,
    /// The unit of a quantity; `None` where nothing says it.
    pub unit: Option<&'static str>,
    /// Whether the file says so by the name of the column, or the user by a map; otherwise it is
    /// proposed.
    pub is_stated: bool,
    /// What is changed about its numbers, in words.
    pub zero: String,
}

/// What a column can be taken as.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TargetAnswer {
    /// The quantity or label.
    pub name: &'static str,
    /// The units of a quantity; none for a label.
    pub units: Vec<&'static str>,
}

/// A row of the file.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RowAnswer {
    /// Its number.
    pub row: u64,
    /// Its cells.
    pub cells: Vec<String>,
}

/// A row that is kept out.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct RowFault {
    /// Its number.
    pub row: u64,
    /// Why.
    pub message: String,
}

/// A player of the file.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PlayerAnswer {
    /// The name; empty where the file does not say it.
    pub name: String,
    /// The shots that can be used.
    pub shots: usize,
    /// Those that went in.
    pub made: usize,
    /// The number of places.
    pub places: usize,
    /// The sessions, in their order.
    pub sessions: Vec<String>,
}

/// What a file of measured shots holds.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ShotFileAnswer {
    /// The number of rows.
    pub rows: usize,
    /// What a row is called: `line` or `row`.
    pub row_name: &'static str,
    /// The columns.
    pub columns: Vec<ColumnAnswer>,
    /// What a column can be taken as.
    pub targets: Vec<TargetAnswer>,
    /// The first rows, and those that are wrong.
    pub shown: Vec<RowAnswer>,
    /// The players; none while something must be said first.
    pub players: Vec<PlayerAnswer>,
    /// The wrong rows, the first of them.
    pub faults: Vec<RowFault>,
    /// The number of wrong rows.
    pub fault_count: usize,
    /// What must be said before the file can be used.
    pub problem: Option<String>,
    /// What was found in the file, in words.
    pub found: Vec<String>,
}

impl Answer for ShotFileAnswer {
    const NAME: &'static str = "shot_file";
    const IS_SI: bool = true;
}

impl ShotFileRequest {
    /// What the file holds.
    #[must_use]
    pub fn answer(&self, path: &Path) -> ShotFileAnswer {
        let mut table = match Table::read(path) {
            Ok(table) => table,
            Err(problem) => {
                return ShotFileAnswer {
                    problem: Some(problem),
                    ..ShotFileAnswer::default()
                };
            }
        };
        let shown = |(row, cells): &(u64, Vec<String>)| RowAnswer {
            row: *row,
            cells: cells.clone(),
        };
        let first: Vec<RowAnswer> = table.rows.iter().take(SHOWN_ROWS).map(shown).collect();
        let mut answer = ShotFileAnswer {
            rows: table.rows.len() + table.unreadable.len(),
            row_name: table.row_name,
            targets: targets(),
            found: table.found.clone(),
            ..ShotFileAnswer::default()
        };
        let (columns, open) = match self.columns(&table, &mut answer) {
            Ok(columns) => columns,
            Err(problem) => {
                answer.shown = first;
                answer.problem = Some(problem);
                return answer;
            }
        };
        let shooters = match open {
            Some(problem) => Err(problem),
            None => self.shooters(&mut table, &columns),
        };
        match shooters {
            Ok(shooters) => {
                answer.players = shooters.iter().map(player).collect();
                let all = shooters.iter().flat_map(|shooter| &shooter.rejected);
                let mut faults: Vec<RowFault> = all
                    .map(|(row, message)| RowFault {
                        row: *row,
                        message: message.clone(),
                    })
                    .collect();
                faults.sort_by_key(|fault| fault.row);
                answer.fault_count = faults.len();
                faults.truncate(LISTED_FAULTS);
                answer.faults = faults;
            }
            Err(problem) => answer.problem = Some(problem),
        }
        let wrong: BTreeSet<u64> = answer.faults.iter().map(|fault| fault.row).collect();
        let of_first = |row: u64| first.iter().any(|one| one.row == row);
        let others = table.rows.iter();
        let others = others.filter(|(row, _)| wrong.contains(row) && !of_first(*row));
        answer.shown = others.map(shown).collect();
        answer.shown.splice(0..0, first);
        answer
    }

    /// The columns with what is proposed for them, and what is still open about them.
    fn columns(
        &self,
        table: &Table,
        answer: &mut ShotFileAnswer,
    ) -> Result<(Columns, Option<String>), String> {
        let stated = Columns::of_table(table, &self.maps).map_err(|errors| errors.join("\n"))?;
        let proposal = Proposal::of(&stated);
        let (accepted, open) = match proposal.accepted() {
            Ok(accepted) => (accepted, None),
            Err(open) => (Vec::new(), Some(open)),
        };
        let maps: Vec<String> = self.maps.iter().cloned().chain(accepted).collect();
        let columns = Columns::of_table(table, &maps).map_err(|errors| errors.join("\n"))?;
        answer.columns = (table.header.iter())
            .map(|name| ColumnAnswer {
                name: name.clone(),
                target: None,
                unit: None,
                is_stated: false,
                zero: String::new(),
            })
            .collect();
        for map in &proposal.maps {
            answer.columns[map.column].target = Some(map.target);
        }
        for quantity in Quantity::ALL {
            if let Some(column) = columns.quantity(quantity) {
                answer.columns[column.index] = ColumnAnswer {
                    name: table.header[column.index].clone(),
                    target: Some(quantity.name()),
                    unit: Some(column.unit.0),
                    is_stated: stated.quantity(quantity).is_some(),
                    zero: column.zero_in_words(),
                };
            }
        }
        for (name, label) in LABELS {
            if let Some(index) = columns.label(label) {
                answer.columns[index].target = Some(name);
                answer.columns[index].is_stated = stated.label(label).is_some();
            }
        }
        Ok((columns, open))
    }

    fn shooters(&self, table: &mut Table, columns: &Columns) -> Result<Vec<ShooterShots>, String> {
        let source = Source::of(columns)?;
        let decisions = Decisions {
            dates: match self.dates.as_deref() {
                None => None,
                Some("dmy") => Some(DateOrder::DayFirst),
                Some("mdy") => Some(DateOrder::MonthFirst),
                Some(other) => return Err(format!("dates: must be dmy or mdy, not '{other}'")),
            },
            made: self.made.clone(),
            has_one_distance: self.distance.is_some() || self.at.is_some(),
        };
        decide(table, columns, source, &decisions)?;
        let preset = Preset::named(DEFAULT_PRESET).ok_or("the default physics is missing")?;
        let physics = preset.physics();
        let simulator = Simulator::new(&physics).map_err(|error| error.to_string())?;
        let length = |name: &str, text: &Option<String>| {
            let parsed = text.as_deref().map(|t| units::parse(t, Dimension::Length));
            (parsed.transpose()).map_err(|error| format!("{name}: {error}"))
        };
        let named = match &self.at {
            None => None,
            Some(name) => {
                let place = place_named(name, League::of_physics(&physics));
                let place = place.ok_or_else(|| {
                    let known = place_names_in_words();
                    format!("at: '{name}' is no place; the places are {known}")
                })?;
                Some(Location::from_xy(place.x_m, place.y_m))
            }
        };
        let height = length("release_height", &self.release_height)?;
        let tracker = Tracker::named(source.usual_tracker()).ok_or("the tracker is missing")?;
        let options = ReadOptions {
            frame: CourtFrame::named("hoop").ok_or("the frame is missing")?,
            court: League::of_physics(&physics),
            distance_m: (named.map(|place| place.distance_m))
                .or(length("distance", &self.distance)?),
            court_angle_rad: named.map(|place| place.angle_rad),
            release_heights_m: height
                .map(|height_m| (None, height_m))
                .into_iter()
                .collect(),
            backspin_rad_s: None,
            noise: tracker.noise,
        };
        read(table, columns, &options, &simulator, &Silent)
    }
}

fn targets() -> Vec<TargetAnswer> {
    let quantities = Quantity::ALL.into_iter().map(|quantity| TargetAnswer {
        name: quantity.name(),
        units: quantity.unit_names(),
    });
    let labels = LABELS.into_iter().map(|(name, _)| TargetAnswer {
        name,
        units: Vec::new(),
    });
    labels.chain(quantities).collect()
}

fn player(shots: &ShooterShots) -> PlayerAnswer {
    let mut sessions: Vec<String> = Vec::new();
    for session in shots.sessions.iter().filter(|session| !session.is_empty()) {
        if !sessions.contains(session) {
            sessions.push(session.clone());
        }
    }
    let made = shots.shots.iter().filter(|shot| shot.made == Some(true));
    PlayerAnswer {
        name: shots.name.clone(),
        shots: shots.shots.len(),
        made: made.count(),
        places: shots.places.len(),
        sessions,
    }
}

/// The answer as a document.
#[must_use]
pub fn document(answer: &ShotFileAnswer) -> Value {
    let mut document = in_si(answer);
    document["answer"] = ShotFileAnswer::NAME.into();
    document
}
