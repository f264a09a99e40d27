//! The cells of a row as quantities, and rows as shots.

use super::columns::{Columns, Label, Quantity};
use super::made_or_missed::parse_made;
use super::shooter_shots::{Raw, RawShot, ReadOptions};
use super::source::Source;
use crate::dynamics::Simulator;
use crate::fitting::{Landing, Place};
use crate::model::named_places::{place_named, place_names_in_words};
use crate::probability::Progress;
use crate::shooter::Location;
use crate::units::{DEGREE_RAD, FOOT_M, INCH_M, REV_RAD, parse};

/// Attempts in a row, at most.
const MOST_ATTEMPTS: f64 = 10_000.0;
/// Attempts of one shooter, at most: each is a shot in memory.
const MOST_COUNTED: usize = 500_000;
/// A shot that is farther than this from the hoop's centre where it falls through its height is not
/// aimed at it, m.
pub(super) const FARTHEST_LANDING_M: f64 = 1.5;
/// Depths of a shot at the hoop: up to four feet before and behind the ring, m. Were short and long
/// shots kept out, a shooter who misses by far would look better than they are.
const DEPTHS_M: (f64, f64) = (-48.0 * INCH_M, 66.0 * INCH_M);
/// Entry angles of a shot at the hoop, deg: those of shots that fall far short are flat.
const ENTRY_ANGLES_DEG: (f64, f64) = (5.0, 85.0);
/// The end of the reason of a row without a value.
pub(super) const IS_MISSING: &str = "is missing";

/// Refuses what is no height of a player's release.
pub(super) fn check_release_height(height_m: f64) -> Result<(), String> {
    if (0.5..3.5).contains(&height_m) {
        return Ok(());
    }
    Err(format!(
        "release height: {height_m:.2} m ({:.2} ft) is not that of a player; 0.5 to 3.5 m are",
        height_m / FOOT_M
    ))
}

/// Whether a cell says that nothing was measured.
fn is_no_value(cell: &str) -> bool {
    const NO_VALUES: [&str; 8] = ["", "na", "n/a", "nan", "null", "none", "-", "--"];
    NO_VALUES.contains(&cell.to_ascii_lowercase().as_str())
}

/// Reads the cells of rows as quantities in SI units.
pub(super) struct RowReader<'a> {
    pub(super) columns: &'a Columns,
    pub(super) options: &'a ReadOptions,
    pub(super) simulator: &'a Simulator,
    pub(super) source: Source,
    /// Of the rows.
    pub(super) progress: &'a dyn Progress,
}

impl RowReader<'_> {
    /// A cell of a column without a unit.
    pub(super) fn label<'c>(&self, cells: &'c [String], label: Label) -> Option<&'c str> {
        let index = self.columns.label(label)?;
        cells.get(index).map(String::as_str)
    }

    /// The name that a quantity has in the file.
    fn column_name(&self, quantity: Quantity) -> &str {
        self.columns
            .quantity(quantity)
            .map_or(quantity.name(), |column| self.columns.name(column.index))
    }

    /// A quantity of a row in SI units; `None` where there is no column.
    pub(super) fn value(
        &self,
        cells: &[String],
        quantity: Quantity,
    ) -> Result<Option<f64>, String> {
        let Some(column) = self.columns.quantity(quantity) else {
            return Ok(None);
        };
        let name = self.columns.name(column.index);
        let cell = cells.get(column.index).map_or("", String::as_str);
        if is_no_value(cell) {
            return Err(format!("{name}: {IS_MISSING}"));
        }
        let shown: String = cell.chars().take(30).collect();
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() && (value.abs() < 1e9 || quantity == Quantity::Time) => {
                Ok(Some(column.value(value)))
            }
            Ok(_) => Err(format!("{name}: \"{shown}\" is not a finite number")),
            // `6 ft 11 in` in a column of heights.
            Err(_) => match quantity
                .dimension_of_texts()
                .map(|dimension| parse(cell, dimension))
            {
                Some(Ok(si)) => Ok(Some(column.value(si / column.unit.1))),
                _ => Err(format!("{name}: \"{shown}\" is not a number")),
            },
        }
    }

    /// The place on the court.
    pub(super) fn location(&self, cells: &[String]) -> Result<Location, String> {
        if let Some(location) = self.location_by_name(cells)? {
            return Ok(location);
        }
        let or =
            |quantity, given: Option<f64>| Ok::<_, String>(self.value(cells, quantity)?.or(given));
        let location = Location {
            distance_m: or(Quantity::Distance, self.options.distance_m)?.unwrap_or(0.0),
            angle_rad: or(Quantity::CourtAngle, self.options.court_angle_rad)?.unwrap_or(0.0),
        };
        location
            .check(self.simulator.physics())
            .map_err(|error| format!("place: {error}"))?;
        Ok(location)
    }

    /// The place that a row names, where the file has no distance.
    fn location_by_name(&self, cells: &[String]) -> Result<Option<Location>, String> {
        if !self.has_places_by_name() {
            return Ok(None);
        }
        let name = self.label(cells, Label::Place).unwrap_or_default();
        match place_named(name, self.options.court) {
            Some(place) => Ok(Some(Location::from_xy(place.x_m, place.y_m))),
            None if name.is_empty() => Err(format!("place: {IS_MISSING}")),
            None => Err(format!(
                "place \"{}\" is not known; known are {}",
                name.chars().take(30).collect::<String>(),
                place_names_in_words()
            )),
        }
    }

    /// Whether the places are those that a column names.
    pub(super) fn has_places_by_name(&self) -> bool {
        self.columns.label(Label::Place).is_some()
            && self.columns.quantity(Quantity::Distance).is_none()
            && self.options.distance_m.is_none()
    }

    /// Whether the releases have no direction, as a camera from the side sees none.
    pub(super) fn has_no_direction(&self) -> bool {
        let has = |quantity| self.columns.quantity(quantity).is_some();
        self.source == Source::Releases && !has(Quantity::Aim) && !has(Quantity::Polar)
    }

    fn place(&self, cells: &[String]) -> Result<Place, String> {
        let location = self.location(cells)?;
        let release_height_m = self
            .value(cells, Quantity::ReleaseHeight)?
            .or_else(|| {
                let shooter = self.label(cells, Label::Shooter).unwrap_or_default();
                self.options.release_height_m(shooter)
            })
            .unwrap_or(0.0);
        check_release_height(release_height_m)?;
        Ok(Place {
            location,
            release_height_m,
        })
    }

    fn backspin(&self, cells: &[String]) -> Result<f64, String> {
        let spin = self.value(cells, Quantity::Backspin)?;
        let spin = spin.or(self.options.backspin_rad_s).unwrap_or(0.0);
        if spin.abs() > 20.0 * REV_RAD {
            return Err(format!(
                "backspin: {:.1} rev/s is beyond 20 rev/s",
                spin / REV_RAD
            ));
        }
        Ok(spin)
    }

    fn measured_row(&self, cells: &[String]) -> Result<(Place, Raw), String> {
        let place = self.place(cells)?;
        let need = |quantity: Quantity| {
            self.value(cells, quantity)?
                .ok_or_else(|| format!("column {} is missing", quantity.name()))
        };
        let backspin = self.backspin(cells)?;
        if self.source == Source::Landings {
            let landing = Landing {
                depth_m: need(Quantity::Depth)?,
                right_m: need(Quantity::LeftRight)?,
                entry_angle_rad: need(Quantity::EntryAngle)?,
            };
            if !(DEPTHS_M.0..=DEPTHS_M.1).contains(&landing.depth_m) {
                return Err(format!(
                    "{}: {:.1} in is no shot at this hoop (0 in is the front of the ring, 18 in its back; -48 to 66 are read)",
                    self.column_name(Quantity::Depth),
                    landing.depth_m / INCH_M
                ));
            }
            if landing.right_m.abs() > FARTHEST_LANDING_M {
                return Err(format!(
                    "{}: {:.1} in is no shot at this hoop",
                    self.column_name(Quantity::LeftRight),
                    landing.right_m / INCH_M
                ));
            }
            let entry_deg = landing.entry_angle_rad / DEGREE_RAD;
            let (least, most) = ENTRY_ANGLES_DEG;
            if !(least..=most).contains(&entry_deg) {
                return Err(format!(
                    "{}: {entry_deg:.1} deg; must be from {least:.0} to {most:.0} deg",
                    self.column_name(Quantity::EntryAngle)
                ));
            }
            return Ok((place, Raw::Landing(landing, backspin)));
        }
        let polar = match self.value(cells, Quantity::Aim)? {
            Some(aim) => place.location.angle_rad + aim,
            None if self.has_no_direction() => place.location.angle_rad,
            None => need(Quantity::Polar)?,
        };
        let values = [
            need(Quantity::Speed)?,
            need(Quantity::Pitch)?,
            polar,
            backspin,
        ];
        if !(values[0] > 0.0) {
            let name = self.column_name(Quantity::Speed);
            return Err(format!("{name}: must be above 0"));
        }
        if !(values[1].abs() < 1.5) {
            return Err(format!(
                "{}: {:.1} deg; must be within 86 deg",
                self.column_name(Quantity::Pitch),
                values[1] / DEGREE_RAD
            ));
        }
        if (polar - place.location.angle_rad).abs() > 0.6 {
            return Err(
                "the polar angle points away from this hoop: is it another hoop, or is the angle from the line to the hoop's centre (column aim_deg)?"
                    .to_owned(),
            );
        }
        Ok((place, Raw::Release(values)))
    }

    /// The shots that rows count, or that they are, of which no more than the result is known.
    pub(super) fn counted_shots(
        &self,
        rows: &[(u64, &[String])],
        rejected: &mut Vec<(u64, String)>,
    ) -> Result<Vec<RawShot>, String> {
        let mut raw = Vec::new();
        for &(row, cells) in rows {
            self.progress.advance(1);
            match (self.place(cells), self.counted(cells)) {
                (Ok(place), Ok((made, attempts))) => {
                    if raw.len() + attempts as usize > MOST_COUNTED {
                        return Err(format!(
                            "has more than {MOST_COUNTED} attempts; fit some sessions at a time with --session NAME, or split the file"
                        ));
                    }
                    raw.extend((0..attempts).map(|number| {
                        RawShot {
                            row,
                            name: String::new(),
                            session: self
                                .label(cells, Label::Session)
                                .unwrap_or_default()
                                .to_owned(),
                            made: Some(number < made),
                            place,
                            measured: Raw::Nothing,
                        }
                    }));
                }
                (Err(reason), _) | (_, Err(reason)) => rejected.push((row, reason)),
            }
        }
        Ok(raw)
    }

    /// The makes and the attempts of a row.
    fn counted(&self, cells: &[String]) -> Result<(u32, u32), String> {
        if self.columns.label(Label::Attempts).is_none() {
            let made = parse_made(self.label(cells, Label::Made).unwrap_or_default())?;
            return Ok((u32::from(made == Some(true)), u32::from(made.is_some())));
        }
        let count = |name: &str, label| -> Result<u32, String> {
            let cell = self.label(cells, label).unwrap_or_default();
            let number = cell.parse::<f64>().ok();
            let number = number.filter(|n| n.fract() == 0.0 && (0.0..=MOST_ATTEMPTS).contains(n));
            number.map(|number| number as u32).ok_or_else(|| {
                let shown: String = cell.chars().take(20).collect();
                format!("{name}: \"{shown}\" is no whole number from 0 to {MOST_ATTEMPTS}")
            })
        };
        let makes = match self.columns.label(Label::Makes) {
            Some(_) => count("makes", Label::Makes)?,
            None => count("made", Label::Made)?,
        };
        let attempts = count("attempts", Label::Attempts)?;
        match makes <= attempts {
            true => Ok((makes, attempts)),
            false => Err(format!("has {makes} makes of {attempts} attempts")),
        }
    }

    /// The shots of a file with a row for each.
    pub(super) fn row_shots(
        &self,
        rows: &[(u64, &[String])],
        rejected: &mut Vec<(u64, String)>,
    ) -> Vec<RawShot> {
        let mut raw = Vec::new();
        for &(row, cells) in rows {
            let made = parse_made(self.label(cells, Label::Made).unwrap_or_default());
            match (self.measured_row(cells), made) {
                (Ok((place, measured)), Ok(made)) => raw.push(RawShot {
                    row,
                    name: self
                        .label(cells, Label::Shot)
                        .unwrap_or_default()
                        .to_owned(),
                    session: self
                        .label(cells, Label::Session)
                        .unwrap_or_default()
                        .to_owned(),
                    made,
                    place,
                    measured,
                }),
                (Err(reason), Ok(Some(made))) if !reason.ends_with(IS_MISSING) => {
                    let result = if made { "a make" } else { "a miss" };
                    rejected.push((row, format!("{reason} ({result})")));
                }
                (Err(reason), _) | (_, Err(reason)) => rejected.push((row, reason)),
            }
        }
        raw
    }
}
