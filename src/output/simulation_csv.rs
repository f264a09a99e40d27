//! Releases from CSV columns, and the columns that a simulation adds.

use crate::dynamics::{Outcome, Release};
use crate::model::{Physics, SolidId};
use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD};
use csv::ByteRecord;

/// One parameter of a release.
struct Parameter {
    /// Its possible columns, with the sizes of their units in SI units.
    columns: [(&'static str, f64); 2],
    is_required: bool,
}

const PARAMETERS: [Parameter; 9] = [
    Parameter {
        columns: [("distance_ft", FOOT_M), ("distance_m", 1.0)],
        is_required: true,
    },
    Parameter {
        columns: [("court_angle_deg", DEGREE_RAD), ("court_angle_rad", 1.0)],
        is_required: true,
    },
    Parameter {
        columns: [("release_height_ft", FOOT_M), ("release_height_m", 1.0)],
        is_required: true,
    },
    Parameter {
        columns: [("speed_ft_s", FOOT_M), ("speed_m_s", 1.0)],
        is_required: true,
    },
    Parameter {
        columns: [("pitch_deg", DEGREE_RAD), ("pitch_rad", 1.0)],
        is_required: true,
    },
    Parameter {
        columns: [("polar_deg", DEGREE_RAD), ("polar_rad", 1.0)],
        is_required: true,
    },
    Parameter {
        columns: [("backspin_rev_s", REV_RAD), ("backspin_rad_s", 1.0)],
        is_required: false,
    },
    Parameter {
        columns: [("rifle_spin_rev_s", REV_RAD), ("rifle_spin_rad_s", 1.0)],
        is_required: false,
    },
    Parameter {
        columns: [("side_spin_rev_s", REV_RAD), ("side_spin_rad_s", 1.0)],
        is_required: false,
    },
];

/// The columns that a simulation adds.
pub const OUTCOME_COLUMNS: [&str; 7] = [
    "made",
    "kind",
    "contacts",
    "n_board",
    "n_ring",
    "flight_time_s",
    "entry_angle_deg",
];

/// The columns of the parameters in one file.
#[derive(Clone, Debug)]
pub struct ReleaseColumns {
    /// Index, name and unit of the column of each parameter.
    columns: [Option<(usize, &'static str, f64)>; 9],
}

/// Everything that is wrong with a header.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0.join("\n"))]
pub struct HeaderError(pub Vec<String>);

/// Why a row cannot be simulated.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("column {column}: {reason}")]
pub struct RowError {
    /// The name of the column.
    pub column: String,
    /// What is wrong and what is allowed.
    pub reason: String,
}

impl RowError {
    /// A row with more fields than the header.
    #[must_use]
    pub fn too_many_fields(fields: usize, columns: usize) -> Self {
        Self {
            column: format!("{}", columns + 1),
            reason: format!("the row has {fields} fields where the header has {columns}"),
        }
    }
}

impl ReleaseColumns {
    /// Finds the columns of the parameters in a header.
    ///
    /// # Errors
    /// All columns that are missing, given twice, misspelt, or have the name of an added column.
    pub fn new(header: &ByteRecord) -> Result<Self, HeaderError> {
        let mut errors = Vec::new();
        let mut columns = [None; 9];
        for (column, parameter) in columns.iter_mut().zip(&PARAMETERS) {
            let names = parameter.columns.map(|(name, _)| name);
            let found: Vec<_> = header
                .iter()
                .enumerate()
                .filter_map(|(i, cell)| {
                    parameter
                        .columns
                        .iter()
                        .find(|(name, _)| cell.trim_ascii() == name.as_bytes())
                        .map(|&(name, unit)| (i, name, unit))
                })
                .collect();
            match found.as_slice() {
                [one] => *column = Some(*one),
                [] if parameter.is_required => {
                    errors.push(format!("column {} (or {}) is missing", names[0], names[1]));
                }
                [] => {}
                _ => errors.push(format!(
                    "{} and {} both give the same parameter, or one is given twice; keep one",
                    names[0], names[1]
                )),
            }
        }
        for cell in header.iter().filter(|cell| is_misspelt(cell)) {
            errors.push(format!(
                "column {} looks like a parameter but is not one; see `bankshot simulate --help` for their names and units",
                String::from_utf8_lossy(cell)
            ));
        }
        for added in OUTCOME_COLUMNS {
            if header
                .iter()
                .any(|cell| cell.trim_ascii() == added.as_bytes())
            {
                errors.push(format!(
                    "column {added} is written by the simulation; rename that of the input"
                ));
            }
        }
        if errors.is_empty() {
            Ok(Self { columns })
        } else {
            Err(HeaderError(errors))
        }
    }

    /// The release of one row.
    ///
    /// # Errors
    /// The first column that is not a number or out of range.
    pub fn release(&self, row: &ByteRecord, physics: &Physics) -> Result<Release, RowError> {
        let mut values = [0.0; 9];
        for (value, column) in values.iter_mut().zip(&self.columns) {
            if let Some((index, name, unit)) = *column {
                *value = cell(row, index, name)? * unit;
            }
        }
        let [
            distance_m,
            court,
            height,
            speed,
            pitch_rad,
            polar_rad,
            back,
            rifle,
            side,
        ] = values;
        let name = |i: usize| self.columns[i].map_or("", |(_, name, _)| name);
        let refuse = |i: usize, reason: &str| {
            Err(RowError {
                column: name(i).to_owned(),
                reason: reason.to_owned(),
            })
        };
        let reach = physics.ring_radius_m + physics.ball_radius_m;
        if !(distance_m > reach && distance_m < 100.0) {
            return refuse(0, "the place is inside the ring's reach or over 100 m away");
        }
        if !(distance_m * libm::cos(court) > physics.ball_radius_m - physics.board_distance_m) {
            return refuse(1, "the place is behind the board");
        }
        if !(height.abs() < 100.0) {
            return refuse(2, "the height must be within 100 m");
        }
        if !((0.0..=1000.0).contains(&speed)) {
            return refuse(3, "the speed must be from 0 to 1000 m/s");
        }
        for (i, spin) in [(6, back), (7, rifle), (8, side)] {
            if !(spin.abs() <= 10_000.0) {
                return refuse(i, "the spin must be within 10000 rad/s");
            }
        }
        Ok(Release {
            distance_m,
            court_angle_rad: court,
            height_above_hoop_m: height - physics.hoop_height_m,
            speed_m_s: speed,
            pitch_rad,
            polar_rad,
            backspin_rad_s: back,
            rifle_spin_rad_s: rifle,
            side_spin_rad_s: side,
        })
    }
}

/// Whether a column is named like a parameter, but with other case or another unit.
fn is_misspelt(cell: &[u8]) -> bool {
    const UNITS: [&str; 14] = [
        "", "_ft", "_in", "_m", "_cm", "_deg", "_rad", "_ft_s", "_m_s", "_mph", "_km_h", "_rpm",
        "_hz", "_deg_s",
    ];
    const STEMS: [&str; 9] = [
        "distance",
        "court_angle",
        "release_height",
        "speed",
        "pitch",
        "polar",
        "backspin",
        "rifle_spin",
        "side_spin",
    ];
    let Ok(name) = std::str::from_utf8(cell.trim_ascii()) else {
        return false;
    };
    let known = PARAMETERS
        .iter()
        .flat_map(|p| p.columns)
        .any(|(column, _)| column == name);
    let lower = name.to_ascii_lowercase();
    let alike = PARAMETERS
        .iter()
        .flat_map(|p| p.columns)
        .any(|(column, _)| column == lower);
    let other_unit = STEMS.iter().any(|stem| {
        lower
            .strip_prefix(stem)
            .is_some_and(|unit| UNITS.contains(&unit))
    });
    !known && (alike || other_unit)
}

fn cell(row: &ByteRecord, column: usize, name: &str) -> Result<f64, RowError> {
    let refuse = |reason: String| RowError {
        column: name.to_owned(),
        reason,
    };
    let bytes = row
        .get(column)
        .ok_or_else(|| refuse("is missing in this row".to_owned()))?;
    let text = std::str::from_utf8(bytes).map_err(|_| refuse("is not UTF-8".to_owned()))?;
    let shown: String = text.chars().take(40).collect();
    let value: f64 = text
        .trim()
        .parse()
        .map_err(|_| refuse(format!("\"{shown}\" is not a number")))?;
    if value.is_finite() && value.abs() < 1e9 {
        Ok(value)
    } else {
        Err(refuse(format!("\"{shown}\" is not a finite number")))
    }
}

/// The added cells of a simulated row, in the order of [`OUTCOME_COLUMNS`].
#[must_use]
pub fn outcome_cells(outcome: &Outcome) -> [String; 7] {
    let contacts = &outcome.verdict.contacts;
    [
        u8::from(outcome.verdict.made).to_string(),
        outcome.kind.name().to_owned(),
        contacts.to_string(),
        contacts.count_of(SolidId::Board).to_string(),
        contacts.count_of(SolidId::Ring).to_string(),
        outcome.verdict.time_s.to_string(),
        outcome.entry.map_or_else(String::new, |entry| {
            (entry.angle_rad / DEGREE_RAD).to_string()
        }),
    ]
}
