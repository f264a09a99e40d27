//! Releases from the columns of a file.

use super::outcome_columns::OUTCOME_COLUMNS;
use crate::dynamics::Release;
use crate::model::Physics;
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

/// The place of the backspin among the parameters.
const BACKSPIN: usize = 6;

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
    /// All columns that are missing, given twice, unknown quantities that are not in `carried`, or
    /// have the name of an added column; and all of `carried` that do not exist.
    pub fn new(header: &ByteRecord, carried: &[String]) -> Result<Self, HeaderError> {
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
        check_other_columns(header, carried, &mut errors);
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

    /// Whether this is the column of a parameter.
    #[must_use]
    pub fn is_parameter(name: &str) -> bool {
        is_parameter(name)
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
        release_of_values(values, physics).map_err(|(parameter, reason)| RowError {
            column: self.columns[parameter]
                .map_or("", |(_, name, _)| name)
                .to_owned(),
            reason: reason.to_owned(),
        })
    }

    /// Whether there is a column of the backspin.
    #[must_use]
    pub fn has_backspin(&self) -> bool {
        self.columns[BACKSPIN].is_some()
    }

    /// The index, the name and the unit (in SI units) of the column of each parameter, in the order
    /// of [`release_of_values`]; `None` where it is not given.
    #[must_use]
    pub fn of_parameters(&self) -> [Option<(usize, &'static str, f64)>; 9] {
        self.columns
    }
}

/// The release of nine parameters in SI units: distance, court angle, height above the floor,
/// speed, pitch, polar angle, backspin, rifle spin, side spin.
///
/// # Errors
/// The index of the first parameter that is out of range, and what is allowed.
pub fn release_of_values(
    values: [f64; 9],
    physics: &Physics,
) -> Result<Release, (usize, &'static str)> {
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
    let reach = physics.ring_radius_m + physics.ball_radius_m;
    if !(distance_m > reach && distance_m < 100.0) {
        return Err((0, "the place is inside the ring's reach or over 100 m away"));
    }
    let least_x_m = physics.ball_radius_m - physics.board_distance_m;
    // In front of the hoop no cosine is needed.
    let is_in_front = court.abs() < std::f64::consts::FRAC_PI_2 && least_x_m < 0.0;
    if !is_in_front && !(distance_m * libm::cos(court) > least_x_m) {
        return Err((1, "the place is behind the board"));
    }
    if !(height.abs() < 100.0) {
        return Err((2, "the height must be within 100 m"));
    }
    if !((0.0..=1000.0).contains(&speed)) {
        return Err((3, "the speed must be from 0 to 1000 m/s"));
    }
    for (i, spin) in [(6, back), (7, rifle), (8, side)] {
        if !(spin.abs() <= 10_000.0) {
            return Err((i, "the spin must be within 10000 rad/s"));
        }
    }
    Ok(Release {
        distance_m,
        court_angle_rad: court,
        height_above_hoop_m: height - physics.hoop_plane_height_m(),
        speed_m_s: speed,
        pitch_rad,
        polar_rad,
        backspin_rad_s: back,
        rifle_spin_rad_s: rifle,
        side_spin_rad_s: side,
    })
}

/// Adds an error for each unknown quantity that is not carried, and for each carried column that
/// cannot be.
fn check_other_columns(header: &ByteRecord, carried: &[String], errors: &mut Vec<String>) {
    for cell in header {
        let name = String::from_utf8_lossy(cell.trim_ascii());
        let is_carried = carried.iter().any(|carried| *carried == name);
        let is_outcome = OUTCOME_COLUMNS.contains(&&*name);
        if !is_carried && !is_outcome && is_unknown_quantity(&name) {
            let meant = if name.starts_with("aim_") {
                "polar_deg is the court angle plus the aim; straight in front of the hoop they are the same".to_owned()
            } else {
                format!("is it {}?", nearest_column(&name))
            };
            errors.push(format!(
                "column {name} looks like a quantity, but no such column is known ({meant}); rename it, or keep it as it is with --carry {name}"
            ));
        }
    }
    for name in carried {
        if !header
            .iter()
            .any(|cell| cell.trim_ascii() == name.as_bytes())
        {
            errors.push(format!("--carry {name}: there is no such column"));
        } else if is_parameter(name) {
            errors.push(format!(
                "--carry {name}: this column is used, not only carried"
            ));
        }
    }
}

/// Whether this is the column of a parameter.
fn is_parameter(name: &str) -> bool {
    parameter_columns().any(|column| column == name)
}

fn parameter_columns() -> impl Iterator<Item = &'static str> {
    PARAMETERS
        .iter()
        .flat_map(|parameter| parameter.columns)
        .map(|(name, _)| name)
}

/// Whether a column that is not known is named like a quantity: it has a unit, or the word of a
/// parameter.
fn is_unknown_quantity(name: &str) -> bool {
    const UNITS: [&str; 22] = [
        "ft", "feet", "in", "inch", "inches", "m", "cm", "mm", "deg", "degrees", "rad", "mph",
        "fps", "mps", "kmh", "rpm", "rps", "hz", "s", "ms", "h", "rev",
    ];
    const WORDS: [&str; 9] = [
        "distance", "angle", "height", "speed", "velocity", "pitch", "polar", "spin", "azimuth",
    ];
    let lower = name.to_ascii_lowercase();
    let unit = lower
        .rsplit(['_', ' ', '(', '['])
        .next()
        .unwrap_or_default();
    let has_unit = lower.len() > unit.len() && UNITS.contains(&unit.trim_end_matches([')', ']']));
    !is_parameter(name) && (has_unit || WORDS.iter().any(|word| lower.contains(word)))
}

/// The column of a parameter whose name is most like this one.
fn nearest_column(name: &str) -> &'static str {
    let lower = name.to_ascii_lowercase();
    let likeness = |column: &str| strsim::jaro_winkler(&lower, column);
    parameter_columns()
        .reduce(|best, next| {
            if likeness(next) > likeness(best) {
                next
            } else {
                best
            }
        })
        .unwrap_or_default()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_unknown_quantities_have_a_nearest_column() {
        for (name, nearest) in [
            ("spin_rev_s", "backspin_"),
            ("backspin_rps", "backspin_"),
            ("backspin", "backspin_"),
            ("Speed_ft_s", "speed_ft_s"),
            ("pitch_degrees", "pitch_"),
            ("release height (ft)", "release_height_"),
        ] {
            assert!(is_unknown_quantity(name), "{name}");
            let found = nearest_column(name);
            assert!(found.starts_with(nearest), "{name}: {found}");
        }
        for name in [
            "spin_rpm",
            "ReleaseSpeed",
            "velocity",
            "arc_ft",
            "hang_time_s",
        ] {
            assert!(is_unknown_quantity(name), "{name}");
        }
        for name in [
            "note",
            "player",
            "id",
            "session",
            "speed_ft_s",
            "s",
            "points",
            "team_s_name",
        ] {
            assert!(!is_unknown_quantity(name), "{name}");
        }
    }
}
