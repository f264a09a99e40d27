//! Measured shots of a file, by shooter.

use super::column_map_proposal::map_proposal;
use super::columns::{Columns, Label, Quantity, parse_made};
use super::court_frame::CourtFrame;
use super::implausible_columns::implausible_column;
use super::table::Table;
use crate::dynamics::Simulator;
use crate::fitting::{
    CENTRE_DEPTH_M, Covariance, FlightFit, Interval, Landing, MeasuredRelease, Place,
    ReleaseDifference, SpinSource, TrackedPoint, TrackerNoise, Values, check_speed_unit, far_shots,
    fit_flight, landing_of, release_of_landing,
};
use crate::shooter::Location;
use crate::units::{DEGREE_RAD, FOOT_M, INCH_M, REV_RAD, parse};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// What a file holds of a shot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Its release.
    Releases,
    /// Where it fell through the height of the hoop.
    Landings,
    /// Where the ball was, frame by frame.
    Trajectories,
}

impl Source {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Releases => "releases",
            Self::Landings => "landings",
            Self::Trajectories => "trajectories",
        }
    }

    /// The tracker that is taken where none is named.
    #[must_use]
    pub fn usual_tracker(self) -> &'static str {
        match self {
            Self::Releases => "lab",
            Self::Landings => "noah",
            Self::Trajectories => "optical_25hz",
        }
    }

    /// The quantities of each row that a fit uses; those of trajectories are looked at point by
    /// point.
    fn quantities(self) -> &'static [Quantity] {
        match self {
            Self::Releases => &[Quantity::Speed, Quantity::Pitch, Quantity::Aim],
            Self::Landings => &[Quantity::EntryAngle, Quantity::Depth, Quantity::LeftRight],
            Self::Trajectories => &[],
        }
    }

    /// What the columns of a file hold.
    ///
    /// # Errors
    /// What is missing.
    pub fn of(columns: &Columns) -> Result<Self, String> {
        let has = |quantity| columns.quantity(quantity).is_some();
        if has(Quantity::Time) && has(Quantity::X) && has(Quantity::Y) && has(Quantity::Z) {
            return if columns.label(Label::Shot).is_some() {
                Ok(Self::Trajectories)
            } else {
                Err("column shot is missing: it says which points belong together".to_owned())
            };
        }
        if has(Quantity::EntryAngle) && has(Quantity::Depth) && has(Quantity::LeftRight) {
            return Ok(Self::Landings);
        }
        if has(Quantity::Speed)
            && has(Quantity::Pitch)
            && (has(Quantity::Polar) || has(Quantity::Aim))
        {
            return Ok(Self::Releases);
        }
        if let Some(missing) = one_missing(columns) {
            return Err(format!("{missing}{}", map_proposal(columns)));
        }
        Err(format!(
            "needs the columns of releases (speed, pitch and polar or aim), of landings (entry_angle, depth, left_right) or of \
             trajectories (shot, time, x, y, z), each with its unit, as in speed_ft_s, pitch_deg, depth_in, time_s{}{}",
            some_missing(columns).unwrap_or_default(),
            map_proposal(columns)
        ))
    }
}

/// What is missing where a file has all columns but one of a source.
fn one_missing(columns: &Columns) -> Option<String> {
    let landings = [Quantity::EntryAngle, Quantity::Depth, Quantity::LeftRight];
    let trajectories = [Quantity::Time, Quantity::X, Quantity::Y, Quantity::Z];
    let releases = [Quantity::Speed, Quantity::Pitch, Quantity::Aim];
    let sources: [(&str, &[Quantity]); 3] = [
        ("landings", &landings),
        ("trajectories", &trajectories),
        ("releases", &releases),
    ];
    sources.into_iter().find_map(|(source, needed)| {
        let is_missing = |quantity: &&Quantity| !has_or_polar(columns, **quantity);
        let missing: Vec<&Quantity> = needed.iter().filter(is_missing).collect();
        let [missing] = missing[..] else { return None };
        Some(format!(
            "has the columns of {source} but for {}; name its column with --map '{}=COLUMN:UNIT'",
            missing.name(),
            missing.name()
        ))
    })
}

/// Whether a file has a quantity; the polar angle stands for the aim.
fn has_or_polar(columns: &Columns, quantity: Quantity) -> bool {
    let has = |quantity| columns.quantity(quantity).is_some();
    has(quantity) || quantity == Quantity::Aim && has(Quantity::Polar)
}

/// What is missing where a file has some columns of a source.
fn some_missing(columns: &Columns) -> Option<String> {
    let has = |quantity: &&Quantity| has_or_polar(columns, **quantity);
    let sources = [Source::Releases, Source::Landings];
    let begun = sources.into_iter().max_by_key(|source| {
        let present = source.quantities().iter().filter(has);
        present.count()
    })?;
    let names = |quantities: Vec<&Quantity>| {
        let names: Vec<&str> = quantities.iter().map(|quantity| quantity.name()).collect();
        names.join(" and ")
    };
    let (present, missing): (Vec<&Quantity>, Vec<&Quantity>) =
        begun.quantities().iter().partition(has);
    (!present.is_empty()).then(|| {
        format!(
            "; of {} it has {}, but not {}",
            begun.name(),
            names(present),
            names(missing)
        )
    })
}

/// What the file does not say.
#[derive(Clone, Copy, Debug)]
pub struct ReadOptions {
    /// The coordinates of trajectories.
    pub frame: CourtFrame,
    /// Distance of the place, m.
    pub distance_m: Option<f64>,
    /// Its angle on the court, rad.
    pub court_angle_rad: Option<f64>,
    /// Height of the release above the floor, m.
    pub release_height_m: Option<f64>,
    /// Backspin, rad/s.
    pub backspin_rad_s: Option<f64>,
    /// The tracker's errors.
    pub noise: TrackerNoise,
}

/// The measured shots of one shooter.
#[derive(Clone, Debug)]
pub struct ShooterShots {
    /// Their name; empty if the file does not say.
    pub name: String,
    /// What was measured.
    pub source: Source,
    /// Where they shot from.
    pub places: Vec<Place>,
    /// The least and the greatest height of the releases of one place, m, where they differ: the
    /// place has their mean.
    pub merged_heights_m: Option<[f64; 2]>,
    /// The shots, in the order of the file.
    pub shots: Vec<MeasuredRelease>,
    /// The session of each; empty if the file does not say.
    pub sessions: Vec<String>,
    /// Rows that are kept out, and why.
    pub rejected: Vec<(u64, String)>,
    /// Where the backspin comes from.
    pub spin: SpinSource,
    /// Unit of the speeds in the file, and its size in m/s.
    pub speed_unit: (&'static str, f64),
    /// The tracked points in free flight of each shot.
    pub tracks: Vec<Vec<TrackedPoint>>,
    /// Squared residuals of each trajectory, and what is expected of them.
    pub chi_squares: Vec<(f64, f64)>,
    /// Releases that were measured beside the landings.
    pub differences: Vec<ReleaseDifference>,
}

/// A shot before its place is known.
struct RawShot {
    row: u64,
    session: String,
    made: Option<bool>,
    place: Place,
    measured: Raw,
}

enum Raw {
    Release(Values),
    Landing(Landing, f64),
    Flight(Box<FlightFit>, Vec<TrackedPoint>),
}

/// A shot that is farther than this from the hoop's centre where it falls through its height is not
/// aimed at it, m.
const FARTHEST_LANDING_M: f64 = 1.5;
/// Depths that a sensor can report: half a foot before and behind the ring, m.
const DEPTHS_M: (f64, f64) = (-9.0 * INCH_M, 27.0 * INCH_M);
/// A shot farther than this from the others, in robust standard deviations, is doubtful.
const DOUBTFUL: f64 = 6.0;
/// A height that every shot rises through, m.
const LOW_RELEASE_M: f64 = 1.5;
/// Tracked releases nearer than this are from one place, m.
const SAME_PLACE_M: f64 = 0.75;
/// Releases whose heights differ by no more than this from the first belong to one place, m.
const SAME_HEIGHT_M: f64 = 0.15;

/// Reads the shots of a table.
///
/// # Errors
/// What is missing or wrong with the whole file.
pub fn read(
    table: &Table,
    columns: &Columns,
    options: &ReadOptions,
    simulator: &Simulator,
) -> Result<Vec<ShooterShots>, String> {
    let source = Source::of(columns)?;
    let reader = Reader {
        columns,
        options,
        simulator,
        source,
    };
    reader.check_options()?;
    reader.check_place()?;
    let mut by_shooter: BTreeMap<String, Vec<(u64, &[String])>> = BTreeMap::new();
    let mut rejected = table.unreadable.clone();
    for (row, cells) in &table.rows {
        if cells.len() > table.header.len() {
            rejected.push((
                *row,
                format!(
                    "has {} cells where the header has {}",
                    cells.len(),
                    table.header.len()
                ),
            ));
            continue;
        }
        let name = reader.label(cells, Label::Shooter).unwrap_or_default();
        by_shooter
            .entry(name.to_owned())
            .or_default()
            .push((*row, cells));
    }
    if by_shooter.is_empty() {
        return Err("has no rows".to_owned());
    }
    let mut shooters = Vec::new();
    for (name, rows) in by_shooter {
        let mut shooter = reader.shooter(name, &rows)?;
        shooter.rejected.append(&mut rejected);
        shooter.rejected.sort();
        shooters.push(shooter);
    }
    Ok(shooters)
}

/// Refuses what is no height of a player's release.
fn check_release_height(height_m: f64) -> Result<(), String> {
    if (0.5..3.5).contains(&height_m) {
        return Ok(());
    }
    Err(format!(
        "release height: {height_m:.2} m ({:.2} ft) is not that of a player; 0.5 to 3.5 m are",
        height_m / FOOT_M
    ))
}

/// The end of the reason of a row without a value.
const IS_MISSING: &str = "is missing";

/// Refuses a file in which so many rows hold absurd values that the columns are probably others. An
/// empty cell is not absurd.
fn too_many_absurd(rows: usize, rejected: &[(u64, String)]) -> Result<(), String> {
    /// Fewer than this can be mistakes of single rows, whatever their fraction.
    const MANY: usize = 10;
    /// One in so many.
    const FRACTION: usize = 4;
    let absurd: Vec<_> = rejected
        .iter()
        .filter(|(_, reason)| !reason.ends_with(IS_MISSING))
        .collect();
    match absurd[..] {
        [(row, reason), ..] if absurd.len() >= MANY && FRACTION * absurd.len() > rows => {
            Err(format!(
                "{} of {rows} rows hold absurd values; do the columns hold what their names say, in these units? The first is that of row {row}: {reason}",
                absurd.len()
            ))
        }
        _ => Ok(()),
    }
}

struct Reader<'a> {
    columns: &'a Columns,
    options: &'a ReadOptions,
    simulator: &'a Simulator,
    source: Source,
}

impl Reader<'_> {
    fn label<'c>(&self, cells: &'c [String], label: Label) -> Option<&'c str> {
        let index = self.columns.label(label)?;
        cells.get(index).map(String::as_str)
    }

    /// The name that a quantity has in the file.
    fn column_name(&self, quantity: Quantity) -> &str {
        self.columns
            .quantity(quantity)
            .map_or(quantity.name(), |column| self.columns.name(column.index))
    }

    /// What is given as an option must not be in the file too.
    fn check_options(&self) -> Result<(), String> {
        let options = self.options;
        for (given, quantity, flag) in [
            (options.distance_m, Quantity::Distance, "--distance"),
            (options.court_angle_rad, Quantity::CourtAngle, "--angle"),
            (
                options.release_height_m,
                Quantity::ReleaseHeight,
                "--release-height",
            ),
            (options.backspin_rad_s, Quantity::Backspin, "--backspin"),
        ] {
            if let (Some(_), Some(column)) = (given, self.columns.quantity(quantity)) {
                return Err(format!(
                    "has a column {}; leave {flag} out",
                    self.columns.name(column.index)
                ));
            }
        }
        Ok(())
    }

    fn check_place(&self) -> Result<(), String> {
        if self.source == Source::Trajectories {
            return Ok(());
        }
        let has = |quantity| self.columns.quantity(quantity).is_some();
        let mut missing = Vec::new();
        if !has(Quantity::Distance) && self.options.distance_m.is_none() {
            missing.push("column distance_ft, or --distance '13.75 ft'");
        }
        if !has(Quantity::ReleaseHeight) && self.options.release_height_m.is_none() {
            missing.push("column release_height_ft, or --release-height '7 ft'");
        }
        if !missing.is_empty() {
            return Err(format!(
                "does not say where the shots are from: give {}{}",
                missing.join("; and "),
                map_proposal(self.columns)
            ));
        }
        // What is given once for all rows is refused once.
        if !has(Quantity::Distance) && !has(Quantity::CourtAngle) {
            self.location(&[])?;
        }
        if !has(Quantity::ReleaseHeight) {
            check_release_height(self.options.release_height_m.unwrap_or(0.0))?;
        }
        Ok(())
    }

    /// A quantity of a row in SI units; `None` where there is no column.
    fn value(&self, cells: &[String], quantity: Quantity) -> Result<Option<f64>, String> {
        let Some(column) = self.columns.quantity(quantity) else {
            return Ok(None);
        };
        let name = self.columns.name(column.index);
        let cell = cells.get(column.index).map_or("", String::as_str);
        if cell.is_empty() {
            return Err(format!("{name}: {IS_MISSING}"));
        }
        let shown: String = cell.chars().take(30).collect();
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() && value.abs() < 1e9 => Ok(Some(column.value(value))),
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

    fn location(&self, cells: &[String]) -> Result<Location, String> {
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

    fn place(&self, cells: &[String]) -> Result<Place, String> {
        let location = self.location(cells)?;
        let release_height_m = self
            .value(cells, Quantity::ReleaseHeight)?
            .or(self.options.release_height_m)
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
                    "{}: {:.1} in is outside the ring by more than it can be (0 in is its front, 18 in its back; -9 to 27 are read)",
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
            if !(0.26..1.4).contains(&landing.entry_angle_rad) {
                return Err(format!(
                    "{}: {:.1} deg; must be from 15 to 80 deg",
                    self.column_name(Quantity::EntryAngle),
                    landing.entry_angle_rad / DEGREE_RAD
                ));
            }
            return Ok((place, Raw::Landing(landing, backspin)));
        }
        let polar = match self.value(cells, Quantity::Aim)? {
            Some(aim) => place.location.angle_rad + aim,
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

    fn shooter(&self, name: String, rows: &[(u64, &[String])]) -> Result<ShooterShots, String> {
        let of_shooter = |words: String| match name.as_str() {
            "" => words,
            name => format!("{name}: {words}"),
        };
        if let Some(words) = implausible_column(self.columns, self.source.quantities(), rows) {
            return Err(of_shooter(words));
        }
        let mut rejected = Vec::new();
        let raw = match self.source {
            Source::Trajectories => self.tracked_shots(rows, &mut rejected),
            Source::Releases | Source::Landings => {
                let shots = self.row_shots(rows, &mut rejected);
                too_many_absurd(rows.len(), &rejected).map_err(of_shooter)?;
                shots
            }
        };
        let spin = if self.columns.quantity(Quantity::Backspin).is_some() {
            SpinSource::Measured
        } else if self.options.backspin_rad_s.is_some() {
            SpinSource::Given
        } else {
            SpinSource::Assumed
        };
        let unit = self
            .columns
            .quantity(Quantity::Speed)
            .map_or(("ft/s", FOOT_M), |column| {
                let shown = match column.unit.0 {
                    "ft_s" => "ft/s",
                    "m_s" => "m/s",
                    "km_h" => "km/h",
                    other => other,
                };
                (shown, column.unit.1)
            });
        let mut shooter = ShooterShots {
            name,
            source: self.source,
            places: Vec::new(),
            merged_heights_m: None,
            shots: Vec::new(),
            sessions: Vec::new(),
            rejected,
            spin,
            speed_unit: unit,
            tracks: Vec::new(),
            chi_squares: Vec::new(),
            differences: Vec::new(),
        };
        self.group_by_place(raw, &mut shooter);
        if self.source == Source::Releases {
            let (physics, places) = (self.simulator.physics(), &shooter.places);
            check_speed_unit(physics, places, &shooter.shots, unit)
                .map_err(|error| error.to_string())?;
        }
        self.reject_shots(&mut shooter);
        if self.source == Source::Landings {
            shooter.differences = self.release_differences(rows, &shooter.shots);
        }
        Ok(shooter)
    }

    fn row_shots(
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
                    session: self
                        .label(cells, Label::Session)
                        .unwrap_or_default()
                        .to_owned(),
                    made,
                    place,
                    measured,
                }),
                (Err(reason), _) | (_, Err(reason)) => rejected.push((row, reason)),
            }
        }
        raw
    }

    /// Compares the releases that the file holds beside landings with those that the landings give.
    fn release_differences(
        &self,
        rows: &[(u64, &[String])],
        shots: &[MeasuredRelease],
    ) -> Vec<ReleaseDifference> {
        /// Fewer shots than this say nothing.
        const LEAST_SHOTS: usize = 5;
        let cells: BTreeMap<u64, &[String]> = rows.iter().copied().collect();
        let compared = [(0, Quantity::Speed), (1, Quantity::Pitch)];
        let columns = compared.into_iter().filter_map(|(value, quantity)| {
            Some((value, quantity, self.columns.quantity(quantity)?))
        });
        columns
            .filter_map(|(value, quantity, column)| {
                let differences: Vec<f64> = shots
                    .iter()
                    .filter_map(|shot| {
                        // A cell that holds no number says nothing of the landing.
                        let stated = self.value(cells[&shot.row], quantity).ok().flatten()?;
                        Some(stated - shot.values[value])
                    })
                    .collect();
                let count = differences.len() as f64;
                let summary = Interval::of(differences);
                (count >= LEAST_SHOTS as f64).then(|| ReleaseDifference {
                    column: self.columns.name(column.index).to_owned(),
                    value,
                    shots: count as usize,
                    mean: summary.mean,
                    standard_error: summary.sd / count.sqrt(),
                })
            })
            .collect()
    }

    /// The flights of the tracked shots, each at its own place.
    fn tracked_shots(
        &self,
        rows: &[(u64, &[String])],
        rejected: &mut Vec<(u64, String)>,
    ) -> Vec<RawShot> {
        let mut by_shot: Vec<(String, Vec<(u64, &[String])>)> = Vec::new();
        let mut index = BTreeMap::new();
        for &(row, cells) in rows {
            let session = self.label(cells, Label::Session).unwrap_or_default();
            let shot = format!(
                "{session}\n{}",
                self.label(cells, Label::Shot).unwrap_or_default()
            );
            let at = *index.entry(shot.clone()).or_insert_with(|| {
                by_shot.push((shot, Vec::new()));
                by_shot.len() - 1
            });
            by_shot[at].1.push((row, cells));
        }
        let z0 = self.simulator.physics().hoop_plane_height_m();
        let tracks: Vec<(
            u64,
            String,
            Result<(Vec<TrackedPoint>, Option<bool>), String>,
        )> = by_shot
            .iter()
            .map(|(_, rows)| {
                let (first, cells) = rows[0];
                let session = self
                    .label(cells, Label::Session)
                    .unwrap_or_default()
                    .to_owned();
                (first, session, self.track(rows, z0))
            })
            .collect();
        let noise = &self.options.noise;
        let backspin = self.options.backspin_rad_s.unwrap_or(0.0);
        let height = self.options.release_height_m.unwrap_or_else(|| {
            let begins = tracks.par_iter().filter_map(|(_, _, track)| {
                let (points, _) = track.as_ref().ok()?;
                let fit =
                    fit_flight(self.simulator, points, noise, LOW_RELEASE_M, backspin).ok()?;
                Some(fit.begins_at_m)
            });
            let mut begins: Vec<f64> = begins.collect();
            begins.sort_by(f64::total_cmp);
            begins
                .get(begins.len() / 2)
                .map_or(LOW_RELEASE_M, |height| height.max(LOW_RELEASE_M))
        });
        let fits: Vec<Result<RawShot, (u64, String)>> = tracks
            .into_par_iter()
            .map(|(row, session, track)| {
                let (points, made) = track.map_err(|reason| (row, reason))?;
                let fit = fit_flight(self.simulator, &points, noise, height, backspin)
                    .map_err(|error| (row, format!("trajectory: {error}")))?;
                let used = points[fit.points.clone()].to_vec();
                Ok(RawShot {
                    row,
                    session,
                    made,
                    place: fit.place,
                    measured: Raw::Flight(Box::new(fit), used),
                })
            })
            .collect();
        let mut raw = Vec::new();
        for fit in fits {
            match fit {
                Ok(shot) => raw.push(shot),
                Err(reason) => rejected.push(reason),
            }
        }
        raw
    }

    fn track(
        &self,
        rows: &[(u64, &[String])],
        z0: f64,
    ) -> Result<(Vec<TrackedPoint>, Option<bool>), String> {
        let mut points = Vec::with_capacity(rows.len());
        let mut made = None;
        for &(row, cells) in rows {
            let need = |quantity: Quantity| {
                let value = self
                    .value(cells, quantity)
                    .map_err(|error| format!("row {row}: {error}"))?;
                value.ok_or_else(|| format!("column {} is missing", quantity.name()))
            };
            made = made.or(parse_made(
                self.label(cells, Label::Made).unwrap_or_default(),
            )?);
            points.push(TrackedPoint {
                time_s: need(Quantity::Time)?,
                position_m: [
                    need(Quantity::X)?,
                    need(Quantity::Y)?,
                    need(Quantity::Z)? - z0,
                ],
            });
        }
        let floor: Vec<(f64, f64)> = points
            .iter()
            .map(|p| (p.position_m[0], p.position_m[1]))
            .collect();
        for (point, (x, y)) in points.iter_mut().zip(self.options.frame.from_hoop(&floor)) {
            (point.position_m[0], point.position_m[1]) = (x, y);
        }
        let nearest = points
            .iter()
            .map(|p| libm::hypot(p.position_m[0], p.position_m[1]))
            .fold(f64::INFINITY, f64::min);
        if nearest > 2.0 * FARTHEST_LANDING_M {
            return Err(format!(
                "the ball comes no nearer than {:.1} ft to the hoop: is it another hoop, or another --frame?",
                nearest / FOOT_M
            ));
        }
        Ok((points, made))
    }

    /// Sorts shots by place, and turns them into releases from these places.
    fn group_by_place(&self, raw: Vec<RawShot>, shooter: &mut ShooterShots) {
        let tolerance = if self.source == Source::Trajectories {
            SAME_PLACE_M
        } else {
            0.005
        };
        let point = |place: &Place| {
            let (sin, cos) = libm::sincos(place.location.angle_rad);
            (
                place.location.distance_m * cos,
                place.location.distance_m * sin,
                place.release_height_m,
            )
        };
        let mut firsts: Vec<(f64, f64, f64)> = Vec::new();
        let mut members: Vec<Vec<usize>> = Vec::new();
        let mut of_shot = Vec::with_capacity(raw.len());
        for (i, shot) in raw.iter().enumerate() {
            let (x, y, z) = point(&shot.place);
            let near = |first: &(f64, f64, f64)| {
                libm::hypot(first.0 - x, first.1 - y) <= tolerance
                    && (first.2 - z).abs() <= SAME_HEIGHT_M
            };
            let place = firsts.iter().position(near).unwrap_or_else(|| {
                firsts.push((x, y, z));
                members.push(Vec::new());
                firsts.len() - 1
            });
            members[place].push(i);
            of_shot.push(place);
        }
        shooter.places = members
            .iter()
            .map(|members| {
                let count = members.len() as f64;
                let mean = |axis: &dyn Fn((f64, f64, f64)) -> f64| {
                    members
                        .iter()
                        .map(|&i| axis(point(&raw[i].place)))
                        .sum::<f64>()
                        / count
                };
                let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
                let heights = || members.iter().map(|&i| raw[i].place.release_height_m);
                let least = heights().fold(f64::INFINITY, f64::min);
                let greatest = heights().fold(f64::NEG_INFINITY, f64::max);
                if greatest > least {
                    let merged = shooter.merged_heights_m.get_or_insert([least, greatest]);
                    *merged = [merged[0].min(least), merged[1].max(greatest)];
                }
                // Of rows that state their place, exactly that.
                if self.source == Source::Trajectories {
                    Place {
                        location: Location {
                            distance_m: libm::hypot(x, y),
                            angle_rad: libm::atan2(y, x),
                        },
                        release_height_m: mean(&|p| p.2),
                    }
                } else if greatest > least {
                    Place {
                        release_height_m: mean(&|p| p.2),
                        ..raw[members[0]].place
                    }
                } else {
                    raw[members[0]].place
                }
            })
            .collect();
        let noise = self.noise_of_landings(&raw, &of_shot, shooter);
        for (shot, place) in raw.into_iter().zip(of_shot) {
            let own = &shooter.places[place];
            let (values, noise) = match shot.measured {
                Raw::Release(values) => (values, self.options.noise.release_covariance()),
                Raw::Landing(landing, backspin) => {
                    let zero = [0.0; 3];
                    // The ball left from its own height.
                    match release_of_landing(self.simulator, &shot.place, &landing, &zero, backspin)
                    {
                        Ok((values, _)) => (values, noise[place]),
                        Err(error) => {
                            shooter.rejected.push((shot.row, error.to_string()));
                            continue;
                        }
                    }
                }
                Raw::Flight(fit, points) => {
                    // The aim counts, not the direction on the floor: shots are not from one point.
                    let aim = fit.values[2] - fit.place.location.angle_rad;
                    let mut values = fit.values;
                    values[2] = own.location.angle_rad + aim;
                    shooter.tracks.push(points);
                    shooter.chi_squares.push(fit.chi_square);
                    (values, fit.aim_covariance)
                }
            };
            shooter.sessions.push(shot.session);
            shooter.shots.push(MeasuredRelease {
                row: shot.row,
                place,
                values,
                noise,
                made: shot.made,
            });
        }
    }

    /// The covariance of releases from landings at each place: that of its mean landing, so that it
    /// is the same for all.
    fn noise_of_landings(
        &self,
        raw: &[RawShot],
        of_shot: &[usize],
        shooter: &ShooterShots,
    ) -> Vec<Covariance> {
        (0..shooter.places.len())
            .map(|place| {
                let landings: Vec<(&Landing, f64)> = raw
                    .iter()
                    .zip(of_shot)
                    .filter(|(_, of)| **of == place)
                    .filter_map(|(shot, _)| match &shot.measured {
                        Raw::Landing(landing, spin) => Some((landing, *spin)),
                        _ => None,
                    })
                    .collect();
                let count = landings.len().max(1) as f64;
                let mean = |value: &dyn Fn(&Landing) -> f64| {
                    landings
                        .iter()
                        .map(|(landing, _)| value(landing))
                        .sum::<f64>()
                        / count
                };
                let middle = Landing {
                    depth_m: mean(&|l| l.depth_m),
                    right_m: mean(&|l| l.right_m),
                    entry_angle_rad: mean(&|l| l.entry_angle_rad),
                };
                let spin = landings.iter().map(|(_, spin)| spin).sum::<f64>() / count;
                let noise = &self.options.noise;
                release_of_landing(
                    self.simulator,
                    &shooter.places[place],
                    &middle,
                    &noise.landing,
                    spin,
                )
                .map(|(_, mut covariance)| {
                    covariance[(3, 3)] = noise.release[3] * noise.release[3];
                    covariance
                })
                .unwrap_or_else(|_| noise.release_covariance())
            })
            .collect()
    }

    /// Keeps out shots that are none, and those far from all others.
    fn reject_shots(&self, shooter: &mut ShooterShots) {
        let mut keep: Vec<Result<(), String>> = shooter
            .shots
            .iter()
            .map(|shot| self.is_shot(&shooter.places[shot.place], &shot.values))
            .collect();
        let good: Vec<usize> = (0..keep.len()).filter(|&i| keep[i].is_ok()).collect();
        let kept: Vec<MeasuredRelease> = good.iter().map(|&i| shooter.shots[i].clone()).collect();
        let values = if shooter.spin == SpinSource::Measured {
            4
        } else {
            3
        };
        let far = far_shots(&kept, shooter.places.len(), values, DOUBTFUL);
        for (&i, far) in good.iter().zip(far) {
            if far {
                keep[i] = Err(format!(
                    "is more than {DOUBTFUL:.0} robust standard deviations from the other shots: doubtful"
                ));
            }
        }
        let mut index = 0;
        let mut filter = |rejected: &mut Vec<(u64, String)>, row: Option<u64>| {
            let verdict = &keep[index];
            index += 1;
            if let (Err(reason), Some(row)) = (verdict, row) {
                rejected.push((row, reason.clone()));
            }
            verdict.is_ok()
        };
        let mut rejected = std::mem::take(&mut shooter.rejected);
        shooter
            .shots
            .retain(|shot| filter(&mut rejected, Some(shot.row)));
        shooter.rejected = rejected;
        retain_by(&mut shooter.sessions, &keep);
        retain_by(&mut shooter.tracks, &keep);
        retain_by(&mut shooter.chi_squares, &keep);
        // A place that lost all its shots is none.
        let used: Vec<usize> = (0..shooter.places.len())
            .filter(|place| shooter.shots.iter().any(|shot| shot.place == *place))
            .collect();
        for shot in &mut shooter.shots {
            shot.place = used
                .iter()
                .position(|place| *place == shot.place)
                .unwrap_or(0);
        }
        shooter.places = used.iter().map(|&place| shooter.places[place]).collect();
    }

    fn is_shot(&self, place: &Place, values: &Values) -> Result<(), String> {
        let Some(landing) = landing_of(self.simulator, place, values) else {
            return Err("does not rise to the hoop: no shot".to_owned());
        };
        let beyond = landing.depth_m - CENTRE_DEPTH_M;
        let off = libm::hypot(beyond, landing.right_m);
        if off > FARTHEST_LANDING_M {
            return Err(format!(
                "falls through the height of the hoop {:.1} ft from its centre: no shot at it",
                off / FOOT_M
            ));
        }
        Ok(())
    }
}

/// Keeps the elements of a list, if it has one for each verdict.
fn retain_by<T>(list: &mut Vec<T>, keep: &[Result<(), String>]) {
    if list.len() == keep.len() {
        let mut index = 0;
        list.retain(|_| {
            index += 1;
            keep[index - 1].is_ok()
        });
    }
}
