//! A CSV file of locations on the court.

use crate::escape::is_control_or_direction;
use crate::files::csv_records::Row;
use crate::files::table_rows::{TableRows, cell_as_text};
use crate::units::{DEGREE_RAD, FOOT_M};
use csv::ByteRecord;

/// A column with its name and the size of its unit in SI units.
type Column = (&'static str, f64);

const DISTANCE: [Column; 2] = [("distance_ft", FOOT_M), ("distance_m", 1.0)];
const COURT_ANGLE: [Column; 2] = [("court_angle_deg", DEGREE_RAD), ("court_angle_rad", 1.0)];
const X: [Column; 2] = [("x_ft", FOOT_M), ("x_m", 1.0)];
const Y: [Column; 2] = [("y_ft", FOOT_M), ("y_m", 1.0)];

/// Locations on the court, with their names if they have any.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedLocations {
    /// (x, y), m.
    pub points_m: Vec<(f64, f64)>,
    /// A name for each point, or none at all.
    pub names: Vec<String>,
}

/// Longest name of a location, in characters.
const LONGEST_NAME: usize = 100;

/// Parses the locations of a CSV text with the columns x and y, or distance and court_angle, with
/// their units, and an optional column name. Other columns are ignored.
///
/// # Errors
/// The columns are missing, or a row is wrong; its number is in the message.
pub fn parse_locations(text: &str) -> Result<NamedLocations, String> {
    let mut table = TableRows::of_bytes(text.as_bytes().to_vec())?;
    let cell =
        |record: &ByteRecord, index: usize| cell_as_text(record.get(index).unwrap_or_default());
    let header: Vec<String> = (0..table.header().len())
        .map(|index| cell(table.header(), index))
        .collect();
    let find = |columns: [Column; 2]| {
        columns.into_iter().find_map(|(name, unit)| {
            let index = header.iter().position(|column| column == name)?;
            Some((index, name, unit))
        })
    };
    let [distance, angle, x, y] = [DISTANCE, COURT_ANGLE, X, Y].map(find);
    let (first, second, is_polar) = match (x.zip(y), distance.zip(angle)) {
        (Some((x, y)), None) => (x, y, false),
        (None, Some((distance, angle))) => (distance, angle, true),
        _ => {
            return Err(
                "needs the columns x_ft and y_ft, or distance_ft and court_angle_deg (or x_m, y_m, distance_m, court_angle_rad)"
                    .to_owned(),
            );
        }
    };
    let name = header.iter().position(|column| column == "name");
    let mut locations = NamedLocations::default();
    let mut rows = Vec::new();
    loop {
        let more = table.next_rows(1 << 14, 1 << 22)?;
        if more.is_empty() {
            break;
        }
        rows.extend(more);
    }
    for (row, Row { cells, .. }) in rows.into_iter().enumerate() {
        let record = cells?;
        let number = |(index, name, unit): (usize, &str, f64)| {
            let text = cell(&record, index);
            match text.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(value * unit),
                _ => Err(format!(
                    "row {}: {name} must be a number, not \"{text}\"",
                    row + 1
                )),
            }
        };
        let (first, second) = (number(first)?, number(second)?);
        locations.points_m.push(if is_polar {
            let (sin, cos) = libm::sincos(second);
            (first * cos, first * sin)
        } else {
            (first, second)
        });
        if let Some(index) = name {
            let name = cell(&record, index);
            let is_long = name.chars().count() > LONGEST_NAME;
            if is_long || name.chars().any(is_control_or_direction) {
                return Err(format!(
                    "row {}: name must have at most {LONGEST_NAME} characters, none of which controls the terminal or the direction of text",
                    row + 1
                ));
            }
            locations.names.push(name);
        }
    }
    Ok(locations)
}
