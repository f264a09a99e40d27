//! `shooters.csv`, the table over the fits of several shooters.

use super::options::FitOptions;
use crate::cli::failure::Failure;
use crate::cli::measured_shots_flags::MeasuredFile;
use crate::cli::terminal::print_remark;
use crate::files::atomic_file;
use crate::files::csv_text::CsvText;
use crate::fitting::ShooterFit;
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::store::shooters::{FittedPlace, ShooterPlace, Shooters};
use crate::units::{DEGREE_RAD, UnitSystem};
use std::path::Path;

/// The table over the shooters of a file, in the folder of their fits.
pub(super) const TABLE_FILE: &str = "shooters.csv";

/// The places of a fit.
pub(super) fn places_of(
    name: &str,
    place_names: &[String],
    fit: &ShooterFit,
    folder: &Path,
) -> Vec<ShooterPlace> {
    let folder = folder.file_name().unwrap_or_default().to_string_lossy();
    let places = fit.places.iter().enumerate();
    let place = |(index, place): (usize, &crate::fitting::Place)| {
        let p = fit.probabilities[index].interval();
        let makes = fit.makes.at_place(index);
        ShooterPlace {
            shooter: name.to_owned(),
            folder: folder.clone().into_owned(),
            shots: makes.shots.len(),
            made: (makes.labelled > 0).then_some(makes.made),
            place: place_names[index].clone(),
            fitted: Some(FittedPlace {
                distance_m: place.location.distance_m,
                court_angle_rad: place.location.angle_rad,
                release_height_m: place.release_height_m,
                probability: p.mean,
                low: p.low,
                high: p.high,
            }),
            error: String::new(),
        }
    };
    places.map(place).collect()
}

/// Writes the table and the list of a folder.
pub(super) fn write_table(
    folder: &Path,
    shooters: &Shooters,
    units: UnitSystem,
) -> Result<(), Failure> {
    let (long, metre) = units.length();
    let mut table = CsvText::default();
    let header = [
        "shooter",
        "shots",
        "made",
        "place",
        &format!("distance_{long}"),
        "court_angle_deg",
        &format!("release_height_{long}"),
        "probability",
        "low",
        "high",
        "folder",
        "error",
    ];
    table.row(header);
    for place in &shooters.places {
        let cell = |decimals: usize, value: &dyn Fn(&FittedPlace) -> f64| {
            let cell = |fitted| format!("{:.decimals$}", value(fitted));
            place.fitted.as_ref().map_or_else(String::new, cell)
        };
        let path = match &place.folder[..] {
            "" => String::new(),
            name => folder.join(name).display().to_string(),
        };
        let record = [
            place.shooter.clone(),
            place.shots.to_string(),
            place.made.map_or_else(String::new, |made| made.to_string()),
            place.place.clone(),
            cell(3, &|fitted| fitted.distance_m / metre),
            cell(2, &|fitted| fitted.court_angle_rad / DEGREE_RAD),
            cell(3, &|fitted| fitted.release_height_m / metre),
            cell(4, &|fitted| fitted.probability),
            cell(4, &|fitted| fitted.low),
            cell(4, &|fitted| fitted.high),
            path,
            place.error.clone(),
        ];
        table.row(record);
    }
    let path = folder.join(TABLE_FILE);
    atomic_file::write(&path, &table.into_bytes())
        .map_err(|error| Failure::io(path.display(), &error))?;
    Ok(shooters.write(folder)?)
}

/// Puts a fit that was made alone into the table of the folder above, in place of that shooter's
/// rows.
pub(super) fn renew_table(
    file: &MeasuredFile,
    (shots, fit): (&ShooterShots, &ShooterFit),
    folder: &Path,
    options: &FitOptions,
) -> Result<(), Failure> {
    let Some(above) = folder.parent() else {
        return Ok(());
    };
    let Some(mut shooters) = Shooters::read(above)? else {
        return Ok(());
    };
    let name = file.name_of(shots);
    let is_own = |place: &ShooterPlace| place.shooter == name;
    let Some(first) = shooters.places.iter().position(is_own) else {
        print_remark(&format!(
            "{}: is not renewed: it has no row of {name}",
            above.join(TABLE_FILE).display()
        ));
        return Ok(());
    };
    shooters.places.retain(|place| !is_own(place));
    let own = places_of(&name, &shots.place_names, fit, folder);
    shooters.places.splice(first..first, own);
    write_table(above, &shooters, options.measured.unit_system())
}
