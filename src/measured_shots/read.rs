//! Measured shots of a file, by shooter.

use super::column_map_proposal::map_proposal;
use super::columns::{Columns, Label, Quantity};
use super::implausible_columns::implausible_column;
use super::rejected_shots::{reject_shots, too_many_absurd};
use super::row_reader::{RowReader, check_release_height};
use super::shooter_shots::{ReadOptions, ShooterShots};
use super::shots_by_place::group_by_place;
use super::source::Source;
use super::table::Table;
use super::tracked_shots::{noise_of_file, tracked_shots};
use crate::dynamics::Simulator;
use crate::fitting::{
    Interval, MeasuredRelease, ReleaseDifference, SpinSource, TrackerNoise, check_speed_unit,
};
use crate::probability::{Progress, Silent};
use crate::units::FOOT_M;
use std::collections::{BTreeMap, HashSet};

/// Places of one shooter, at most: each has its own aim, and its best shot is searched for.
const MOST_PLACES: usize = 1000;

/// Reads the shots of a table.
///
/// # Errors
/// What is missing or wrong with the whole file.
pub fn read(
    table: &Table,
    columns: &Columns,
    options: &ReadOptions,
    simulator: &Simulator,
    progress: &dyn Progress,
) -> Result<Vec<ShooterShots>, String> {
    let source = Source::of(columns)?;
    let reader = RowReader {
        columns,
        options,
        simulator,
        source,
        progress,
    };
    check_options(&reader)?;
    check_place(&reader)?;
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
    // Of all shooters together: a column has one unit and one zero, and a shooter can be far off.
    let all: Vec<(u64, &[String])> = by_shooter.values().flatten().copied().collect();
    if let Some(words) = implausible_column(columns, source.quantities(), &all) {
        return Err(words);
    }
    check_named_heights(&reader, &by_shooter.keys().collect::<Vec<_>>())?;
    progress.begin("reading shots", all.len() as u64);
    let read = by_shooter.into_iter().map(|(name, rows)| {
        let mut shooter = shooter(&reader, name, &rows)?;
        shooter.rejected.append(&mut rejected);
        shooter.rejected.sort();
        Ok(shooter)
    });
    let shooters = read.collect();
    progress.end();
    shooters
}

/// The frame rate and the noise of the tracker of a file of trajectories, from its flights; `None`
/// of other files, and where the flights do not tell it.
#[must_use]
pub fn tracker_by_flights(
    table: &Table,
    columns: &Columns,
    options: &ReadOptions,
    simulator: &Simulator,
) -> Option<TrackerNoise> {
    let source = Source::of(columns).ok()?;
    let reader = RowReader {
        columns,
        options,
        simulator,
        source,
        progress: &Silent,
    };
    let rows = table
        .rows
        .iter()
        .map(|(row, cells)| (*row, cells.as_slice()));
    let rows: Vec<(u64, &[String])> = rows.collect();
    (source == Source::Trajectories).then(|| noise_of_file(&reader, &rows))?
}

/// What is given as an option must not be in the file too.
fn check_options(reader: &RowReader<'_>) -> Result<(), String> {
    let options = reader.options;
    if reader.source == Source::Trajectories {
        let place = [
            (options.distance_m, "--distance"),
            (options.court_angle_rad, "--angle"),
        ];
        if let Some((_, flag)) = place.iter().find(|(given, _)| given.is_some()) {
            return Err(format!(
                "has trajectories, which give the place of each shot; leave {flag} out"
            ));
        }
    }
    for (given, quantity, flag) in [
        (options.distance_m, Quantity::Distance, "--distance"),
        (options.court_angle_rad, Quantity::CourtAngle, "--angle"),
        (
            options
                .release_heights_m
                .first()
                .map(|(_, height_m)| *height_m),
            Quantity::ReleaseHeight,
            "--release-height",
        ),
        (options.backspin_rad_s, Quantity::Backspin, "--backspin"),
    ] {
        if let (Some(_), Some(column)) = (given, reader.columns.quantity(quantity)) {
            return Err(format!(
                "has a column {}; leave {flag} out",
                reader.columns.name(column.index)
            ));
        }
    }
    Ok(())
}

/// Refuses a shooter without a height, where others have one.
fn check_named_heights(reader: &RowReader<'_>, shooters: &[&String]) -> Result<(), String> {
    let lacks = |name: &&&String| reader.options.release_height_m(name).is_none();
    match shooters.iter().find(lacks) {
        Some(name) if !reader.options.release_heights_m.is_empty() => Err(format!(
            "--release-height gives none for {name}: add '{name}=7 ft', or '7 ft' for all others"
        )),
        _ => Ok(()),
    }
}

/// Refuses a file without the place of its shots.
fn check_place(reader: &RowReader<'_>) -> Result<(), String> {
    if reader.source == Source::Trajectories {
        return Ok(());
    }
    let has = |quantity| reader.columns.quantity(quantity).is_some();
    // Name, column, flag.
    let mut missing = Vec::new();
    let is_named = reader.has_places_by_name();
    if !has(Quantity::Distance) && reader.options.distance_m.is_none() && !is_named {
        missing.push([
            "distance",
            "distance_ft",
            "--at 'free throw' (or --distance '13.75 ft')",
        ]);
    }
    let heights = &reader.options.release_heights_m;
    if !has(Quantity::ReleaseHeight) && heights.is_empty() {
        missing.push([
            "release height",
            "release_height_ft",
            "--release-height '7 ft'",
        ]);
    }
    if !missing.is_empty() {
        let joined = |part: usize, between: &str| {
            let parts: Vec<&str> = missing.iter().map(|names| names[part]).collect();
            parts.join(between)
        };
        return Err(format!(
            "has no {}; type {}, or add the column{} {}{}",
            joined(0, " and no "),
            joined(2, " "),
            if missing.len() > 1 { "s" } else { "" },
            joined(1, " and "),
            map_proposal(reader.columns)
        ));
    }
    // What is given once for all rows is refused once.
    if !has(Quantity::Distance) && !has(Quantity::CourtAngle) && !is_named {
        reader.location(&[])?;
    }
    if !has(Quantity::ReleaseHeight) {
        for (_, height_m) in heights {
            check_release_height(*height_m)?;
        }
    }
    Ok(())
}

/// The shots of one shooter.
fn shooter(
    reader: &RowReader<'_>,
    name: String,
    rows: &[(u64, &[String])],
) -> Result<ShooterShots, String> {
    let of_shooter = |words: String| match name.as_str() {
        "" => words,
        name => format!("{name}: {words}"),
    };
    let mut rejected = Vec::new();
    let raw = match reader.source {
        Source::Trajectories => tracked_shots(reader, rows, &mut rejected).map_err(of_shooter)?,
        Source::Makes => {
            let shots = reader.counted_shots(rows, &mut rejected);
            let shots = shots.map_err(of_shooter)?;
            too_many_absurd(rows.len(), &rejected).map_err(of_shooter)?;
            shots
        }
        Source::Releases | Source::Landings => {
            let shots = reader.row_shots(rows, &mut rejected);
            too_many_absurd(rows.len(), &rejected).map_err(of_shooter)?;
            shots
        }
    };
    let spin = if reader.source == Source::Makes {
        SpinSource::NothingMeasured
    } else if reader.has_no_direction() {
        SpinSource::AssumedWithDirection
    } else if reader.columns.quantity(Quantity::Backspin).is_some() {
        SpinSource::Measured
    } else if reader.options.backspin_rad_s.is_some() {
        SpinSource::Given
    } else {
        SpinSource::Assumed
    };
    let unit = reader
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
        name: name.clone(),
        source: reader.source,
        places: Vec::new(),
        place_names: Vec::new(),
        place_scatter: Vec::new(),
        shots: Vec::new(),
        sessions: Vec::new(),
        shot_names: Vec::new(),
        rejected,
        spin,
        speed_unit: unit,
        tracks: Vec::new(),
        chi_squares: Vec::new(),
        differences: Vec::new(),
    };
    group_by_place(reader, raw, &mut shooter);
    let places = shooter.places.len();
    if places > MOST_PLACES {
        return Err(of_shooter(format!(
            "has shots from {places} places; a fit takes at most {MOST_PLACES}. Round distances, angles and release heights more coarsely (to about 3 ft, and half a foot of height), or fit some of the shots"
        )));
    }
    if reader.source == Source::Releases {
        let (physics, places) = (reader.simulator.physics(), &shooter.places);
        check_speed_unit(physics, places, &shooter.shots, unit)
            .map_err(|error| error.to_string())?;
    }
    if reader.source != Source::Makes {
        reject_shots(reader.simulator, &mut shooter);
    }
    shooter.place_names = place_names(reader, rows, &shooter);
    if reader.source == Source::Landings {
        shooter.differences = release_differences(reader, rows, &shooter.shots);
    }
    Ok(shooter)
}

/// The names that the file gives to the places.
fn place_names(
    reader: &RowReader<'_>,
    rows: &[(u64, &[String])],
    shooter: &ShooterShots,
) -> Vec<String> {
    let cells: BTreeMap<u64, &[String]> = rows.iter().copied().collect();
    let mut known = HashSet::new();
    let mut names: Vec<Vec<&str>> = vec![Vec::new(); shooter.places.len()];
    for shot in &shooter.shots {
        let name = reader.label(cells[&shot.row], Label::Place);
        if let Some(name) = name.filter(|name| !name.is_empty())
            && known.insert((shot.place, name))
        {
            names[shot.place].push(name);
        }
    }
    names.iter().map(|names| names.join(" or ")).collect()
}

/// Compares the releases that the file holds beside landings with those that the landings give.
fn release_differences(
    reader: &RowReader<'_>,
    rows: &[(u64, &[String])],
    shots: &[MeasuredRelease],
) -> Vec<ReleaseDifference> {
    /// Fewer shots than this say nothing.
    const LEAST_SHOTS: usize = 5;
    let cells: BTreeMap<u64, &[String]> = rows.iter().copied().collect();
    let compared = [(0, Quantity::Speed), (1, Quantity::Pitch)];
    let columns = compared.into_iter().filter_map(|(value, quantity)| {
        Some((value, quantity, reader.columns.quantity(quantity)?))
    });
    columns
        .filter_map(|(value, quantity, column)| {
            let differences: Vec<f64> = shots
                .iter()
                .filter_map(|shot| {
                    // A cell that holds no number says nothing of the landing.
                    let stated = reader.value(cells[&shot.row], quantity).ok().flatten()?;
                    Some(stated - shot.values[value])
                })
                .collect();
            let shots = differences.len();
            (shots >= LEAST_SHOTS).then(|| {
                let summary = Interval::of(differences);
                ReleaseDifference {
                    column: reader.columns.name(column.index).to_owned(),
                    value,
                    shots,
                    mean: summary.mean,
                    standard_error: summary.sd / (shots as f64).sqrt(),
                }
            })
        })
        .collect()
}
