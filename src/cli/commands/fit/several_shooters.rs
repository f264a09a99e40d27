//! The fits of several shooters: a folder for each, and one table over all.

use super::files::{remove, write};
use super::one_shooter::{add_checks, answer_drag};
use super::options::FitOptions;
use super::remarks::print_unused;
use super::shooters_table::{places_of, write_table};
use super::unmeasured_parameters::{UnmeasuredParameter, check_shots, drag, estimate, is_drag};
use crate::cli::failure::{Failure, code};
use crate::cli::measured_shots_flags::MeasuredFile;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{is_quiet, print_next, print_prose, print_remark, print_text};
use crate::escape::file_name;
use crate::fitting::{Contradiction, Place, ShooterFit, ShooterFitError};
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::plots::svg::shortened;
use crate::present::fit_files::fit_checks_text::shapes_text;
use crate::present::fit_files::fit_note_text::fit_note_text;
use crate::present::layout::{Side, TextAnswer, TextTable};
use crate::present::words::list;
use crate::probability::{Progress, Pulse};
use crate::store::fit::FIT_FILE;
use crate::store::shooters::{ShooterPlace, Shooters, fits_within};
use crate::units::{DEGREE_RAD, UnitSystem};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Fits several shooters side by side: one folder for each, and one table.
pub(super) fn fit(file: &MeasuredFile, out: &Path, options: &FitOptions) -> Result<u8, Failure> {
    let folders = folders_of(file, out);
    let rows = fit_rows(file, &folders, options)?;
    if rows.iter().all(|row| row.result.is_err()) {
        return answer_without_fit(file, options);
    }
    remove_older(out, &folders)?;
    for row in &rows {
        if let Err(error) = &row.result {
            print_remark(error);
        }
    }
    let free = estimate_together(file, &rows, options)?;
    let shooters = Shooters {
        places: rows.iter().flat_map(|row| row.places.clone()).collect(),
        free: free.iter().map(|found| found.found.clone()).collect(),
    };
    write_table(out, &shooters, options.measured.unit_system())?;
    print_table(file, &rows)?;
    for found in &free {
        print_prose(&format!("\n{}", found.text))?;
    }
    for warning in rows.iter().flat_map(|row| &row.warnings) {
        print_remark(warning);
    }
    print_hints(file, out);
    match rows.iter().any(|row| row.result.is_err()) {
        true => Ok(code::INCOMPLETE),
        false => Ok(code::DONE),
    }
}

fn fit_rows(
    file: &MeasuredFile,
    folders: &[PathBuf],
    options: &FitOptions,
) -> Result<Vec<ShooterRow>, Failure> {
    let bars = ProgressBars::new();
    let fits = file.fit_all(&file.shooters, &bars);
    bars.begin("writing fits", file.shooters.len() as u64);
    let rows = file.shooters.par_iter().zip(folders).zip(fits);
    let rows = rows
        .map(|((shots, folder), fit)| {
            let row = row_of(file, (shots, fit), (folder, &Pulse(&bars)), options);
            bars.advance(1);
            row
        })
        .collect();
    bars.end();
    rows
}

/// Fits the shooters of a file, a folder for each in `out`, and prints their warnings alone: the
/// folders of those that were fitted, and why others were not.
pub(crate) fn fit_each(
    file: &MeasuredFile,
    out: &Path,
    options: &FitOptions,
) -> Result<Vec<Result<PathBuf, String>>, Failure> {
    let folders = folders_of(file, out);
    let rows = fit_rows(file, &folders, options)?;
    remove_older(out, &folders)?;
    let shooters = Shooters {
        places: rows.iter().flat_map(|row| row.places.clone()).collect(),
        free: Vec::new(),
    };
    write_table(out, &shooters, options.measured.unit_system())?;
    let rows = rows.into_iter().zip(folders);
    Ok(rows
        .map(|(row, folder)| {
            row.warnings.iter().for_each(|words| print_remark(words));
            row.result.map(|_| folder)
        })
        .collect())
}

/// A folder for each shooter. Different names can be the same as folders.
fn folders_of(file: &MeasuredFile, out: &Path) -> Vec<PathBuf> {
    let mut taken: HashSet<String> = HashSet::new();
    let mut numbers: HashMap<String, usize> = HashMap::new();
    let each = file.shooters.iter().map(|shots| {
        let name = file_name(&file.name_of(shots));
        let number = numbers.entry(name.clone()).or_default();
        let folder = loop {
            *number += 1;
            let folder = match number {
                1 => name.clone(),
                _ => format!("{name}-{number}"),
            };
            if taken.insert(folder.clone()) {
                break folder;
            }
        };
        out.join(folder)
    });
    each.collect()
}

/// What the shots tell where no shooter could be fitted: flights still tell the drag.
fn answer_without_fit(file: &MeasuredFile, options: &FitOptions) -> Result<u8, Failure> {
    let tracked = file
        .shooters
        .iter()
        .filter(|shots| !shots.tracks.is_empty());
    let tracked: Vec<&ShooterShots> = tracked.collect();
    if tracked.is_empty() || !options.free.iter().any(|name| is_drag(name)) {
        return Err(Failure::usage(format!(
            "{}: no shooter could be fitted",
            options.shots.display()
        )));
    }
    let why = "each shooter has too few shots from a place";
    answer_drag(file, &tracked, (why, &ProgressBars::new()), options)?;
    Ok(code::INCOMPLETE)
}

/// Removes an older fit of all shots together, and those of shooters who are no longer in the file.
fn remove_older(out: &Path, folders: &[PathBuf]) -> Result<(), Failure> {
    let folders: HashSet<&PathBuf> = folders.iter().collect();
    // A list that cannot be read is replaced now.
    for older in fits_within(out).unwrap_or_default() {
        if !folders.contains(&older) {
            remove(&older)?;
        }
    }
    match out.join(FIT_FILE).exists() {
        true => remove(out),
        false => Ok(()),
    }
}

/// Prints the table of all shooters. Places are only named where there are several.
fn print_table(file: &MeasuredFile, rows: &[ShooterRow]) -> Result<(), Failure> {
    let fitted = || rows.iter().filter_map(|row| row.result.as_ref().ok());
    let names_places = fitted().any(|places| places.len() > 1);
    let mut columns = vec![("player", "", Side::Left)];
    if names_places {
        columns.push(("from", "", Side::Left));
    }
    columns.extend([
        ("shots", "", Side::Right),
        ("went in", "", Side::Right),
        ("predicted", "", Side::Right),
        ("makes", "per 100", Side::Right),
        ("95 %", "interval", Side::Left),
    ]);
    let mut table = TextTable::new(&columns);
    for place in fitted().flatten() {
        let mut cells = vec![place.shooter.clone()];
        cells.extend(names_places.then(|| place.from.clone()));
        cells.extend(place.cells.iter().cloned());
        table.add(cells);
    }
    let source = file.source(&file.shooters[0]);
    let fits = fitted().count();
    let doubted: Vec<String> = rows
        .iter()
        .filter(|row| row.is_doubted)
        .filter_map(|row| Some(row.fit.as_ref()?.name.clone()))
        .collect();
    let mut answer = vec![match fits == rows.len() {
        true => format!("{fits} players fitted."),
        false => format!(
            "{fits} of {} players fitted; the messages say why not all.",
            rows.len()
        ),
    }];
    if !doubted.is_empty() {
        answer.push(format!(
            "Do not use these fits yet, as the count and the measured shots disagree: {}.",
            list(&doubted)
        ));
    }
    let text = TextAnswer {
        answer,
        subject: format!(
            "From {}, tracker {} ({}). Physics: {}.",
            source.kind.name(),
            source.tracker.0,
            source.tracker.1,
            source.physics
        ),
        table: Some(table),
        notes: vec![
            "predicted: from the balls as they were measured. makes per 100: for the fitted player."
                .to_owned(),
        ],
        ..TextAnswer::default()
    };
    print_text(&text)?;
    Ok(())
}

/// Says what was written, and what to do next.
fn print_hints(file: &MeasuredFile, out: &Path) {
    if is_quiet() {
        return;
    }
    print_unused(file);
    print_next(Some(out), &format!("bankshot advise {}", out.display()));
}

/// What the shots of all shooters together say of the parameters of `--free`.
fn estimate_together(
    file: &MeasuredFile,
    rows: &[ShooterRow],
    options: &FitOptions,
) -> Result<Vec<UnmeasuredParameter>, Failure> {
    let fitted = file.shooters.iter().zip(rows);
    let fitted: Vec<_> = fitted
        .filter_map(|(shots, row)| Some((shots, row.fit.as_ref()?)))
        .collect();
    let bars = ProgressBars::new();
    let names = options.free.iter();
    names
        .map(|name| {
            let tracked = file
                .shooters
                .iter()
                .filter(|shots| !shots.tracks.is_empty());
            let tracked: Vec<&ShooterShots> = tracked.collect();
            if is_drag(name) && !tracked.is_empty() {
                return Ok(drag(file, &tracked, &bars));
            }
            let telling = fitted.iter().copied();
            let telling = telling
                .filter(|(shots, fit)| check_shots(std::slice::from_ref(name), shots, fit).is_ok());
            let telling: Vec<_> = telling.collect();
            if telling.is_empty() {
                let (shots, fit) = fitted[0];
                check_shots(std::slice::from_ref(name), shots, fit)?;
            }
            estimate(name, file, &telling, &bars)
        })
        .collect()
}

/// A shooter's row of the tables.
struct ShooterRow {
    /// The fit, if there is one.
    fit: Option<ShooterFit>,
    /// The places of the shooter, for the table of all.
    places: Vec<ShooterPlace>,
    /// A row of the printed table for each place, or why there is no fit.
    result: Result<Vec<PlaceRow>, String>,
    warnings: Vec<String>,
    /// Whether the makes contradict the measured shots.
    is_doubted: bool,
}

/// A place in a cell of the table, such as `13.75 ft, 0 deg, from 7.00 ft up`, with its name above
/// it.
fn place_in_short(name: &str, place: &Place, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    format!(
        "{}{:.2} {long}, {:.0} deg,\n{:.2} {long} high",
        if name.is_empty() {
            String::new()
        } else {
            format!("{}\n", shortened(name, 20))
        },
        place.location.distance_m / metre,
        place.location.angle_rad / DEGREE_RAD,
        place.release_height_m / metre
    )
}

/// A row of the printed table.
struct PlaceRow {
    /// The name, in the first row of a shooter.
    shooter: String,
    from: String,
    /// Shots, made, expected, P.
    cells: [String; 5],
}

fn row_of(
    file: &MeasuredFile,
    (shots, fit): (&ShooterShots, Result<ShooterFit, ShooterFitError>),
    (folder, progress): (&Path, &dyn Progress),
    options: &FitOptions,
) -> Result<ShooterRow, Failure> {
    let name = file.name_of(shots);
    let mut fit = match fit {
        Ok(fit) => fit,
        Err(error) => {
            let place = ShooterPlace {
                shooter: name.clone(),
                shots: shots.shots.len(),
                error: error.to_string(),
                ..ShooterPlace::default()
            };
            return Ok(ShooterRow {
                fit: None,
                places: vec![place],
                result: Err(format!("{name}: {error}")),
                warnings: Vec::new(),
                is_doubted: false,
            });
        }
    };
    add_checks(&mut fit, file, (shots, progress), options);
    write(folder, file, (shots, &fit, &[]), options)?;
    let mut places = Vec::new();
    for (index, place) in fit.places.iter().enumerate() {
        let p = fit.probabilities[index].interval();
        let makes = fit.makes.at_place(index);
        let percent = |p: f64| format!("{:.1}", 100.0 * p);
        let [made, expected] = if makes.labelled > 0 {
            [
                format!("{} of {}", makes.made, makes.labelled),
                format!("{:.0}", makes.expected),
            ]
        } else {
            [String::new(), String::new()]
        };
        places.push(PlaceRow {
            shooter: if index == 0 {
                shortened(&name, 20)
            } else {
                String::new()
            },
            from: place_in_short(
                &shots.place_names[index],
                place,
                options.measured.unit_system(),
            ),
            cells: [
                makes.shots.len().to_string(),
                made,
                expected,
                percent(p.mean),
                format!("{} to {}", percent(p.low), percent(p.high)),
            ],
        });
    }
    Ok(ShooterRow {
        places: places_of(&name, &shots.place_names, &fit, folder),
        result: Ok(places),
        is_doubted: Contradiction::of_fit(&fit.notes, fit.makes.labelled).is_some(),
        warnings: fit
            .notes
            .iter()
            .map(|note| format!("{name}: warning: {}", fit_note_text(note)))
            .chain(shapes_text(&fit).map(|words| format!("{name}: {words}")))
            .collect(),
        fit: Some(fit),
    })
}
