//! `shooters.csv`, the table over the fits of several shooters.

use super::options::FitOptions;
use crate::cli::failure::Failure;
use crate::cli::measured_shots_flags::MeasuredFile;
use crate::cli::terminal::print_remark;
use crate::fitting::ShooterFit;
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::output::atomic_file;
use crate::units::{DEGREE_RAD, UnitSystem};
use std::path::Path;

/// The table over the shooters of a file, in the folder of their fits.
pub(super) const TABLE_FILE: &str = "shooters.csv";

/// A row of [`TABLE_FILE`].
pub(super) type Record = [String; 12];

pub(super) fn table_header(units: UnitSystem) -> Record {
    let (long, _) = units.length();
    [
        "shooter".to_owned(),
        "shots".to_owned(),
        "made".to_owned(),
        "place".to_owned(),
        format!("distance_{long}"),
        "court_angle_deg".to_owned(),
        format!("release_height_{long}"),
        "probability".to_owned(),
        "low".to_owned(),
        "high".to_owned(),
        "folder".to_owned(),
        "error".to_owned(),
    ]
}

/// The rows of a fit, one for each place.
pub(super) fn records(
    (name, place_names): (&str, &[String]),
    fit: &ShooterFit,
    folder: &Path,
    units: UnitSystem,
) -> Vec<Record> {
    let (_, metre) = units.length();
    let places = fit.places.iter().enumerate();
    places
        .map(|(index, place)| {
            let p = fit.probabilities[index].interval();
            let makes = fit.makes.at_place(index);
            let made = (makes.labelled > 0).then(|| makes.made.to_string());
            [
                name.to_owned(),
                makes.shots.len().to_string(),
                made.unwrap_or_default(),
                place_names[index].clone(),
                format!("{:.3}", place.location.distance_m / metre),
                format!("{:.2}", place.location.angle_rad / DEGREE_RAD),
                format!("{:.3}", place.release_height_m / metre),
                format!("{:.4}", p.mean),
                format!("{:.4}", p.low),
                format!("{:.4}", p.high),
                folder.display().to_string(),
                String::new(),
            ]
        })
        .collect()
}

pub(super) fn write_table(path: &Path, header: &Record, records: &[Record]) -> Result<(), Failure> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for record in std::iter::once(header).chain(records) {
        writer.write_record(record).map_err(Failure::bug)?;
    }
    let bytes = writer.into_inner().map_err(Failure::bug)?;
    atomic_file::write(path, &bytes).map_err(|error| Failure::io(path.display(), &error))
}

/// Puts a fit that was made alone into the table of the folder above, in place of that shooter's
/// rows.
pub(super) fn renew_table(
    file: &MeasuredFile,
    (shots, fit): (&ShooterShots, &ShooterFit),
    folder: &Path,
    options: &FitOptions,
) -> Result<(), Failure> {
    let Some(path) = folder.parent().map(|above| above.join(TABLE_FILE)) else {
        return Ok(());
    };
    let header = table_header(options.measured.unit_system());
    let Ok(mut reader) = csv::Reader::from_path(&path) else {
        return Ok(());
    };
    let rows: Vec<Record> = reader.deserialize().filter_map(Result::ok).collect();
    let is_same_table = reader.headers().is_ok_and(|own| own.iter().eq(&header));
    let name = file.name_of(shots);
    let is_own = |row: &Record| row[0] == name;
    let Some(first) = rows.iter().position(is_own).filter(|_| is_same_table) else {
        print_remark(&format!(
            "{}: is not renewed: it has no row of {name}, or is in other units",
            path.display()
        ));
        return Ok(());
    };
    let units = options.measured.unit_system();
    let mut renewed: Vec<Record> = rows[..first].to_vec();
    renewed.extend(records((&name, &shots.place_names), fit, folder, units));
    renewed.extend(rows[first..].iter().filter(|row| !is_own(row)).cloned());
    write_table(&path, &header, &renewed)
}
