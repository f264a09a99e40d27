//! The files and the answer of the fit of one shooter.

use super::remarks::{print_merged_heights, print_sessions, print_unused};
use super::unmeasured_parameters::{UnmeasuredParameter, check_shots, estimate, with_free};
use super::{FitOptions, failure, several_shooters};
use crate::cli::failure::Failure;
use crate::cli::measured_shots_flags::MeasuredFile;
use crate::cli::plot_files;
use crate::cli::run_folder::{self, RunKind};
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::fitting::ShooterFit;
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::output::atomic_file;
use crate::output::fit_files::draws_table::draws_parquet;
use crate::output::fit_files::fit_json::fit_json;
use crate::output::fit_files::fit_text::fit_text;
use crate::output::fit_files::fitted_profile_toml::fitted_profile_toml;
use crate::output::fit_files::shots_table::shots_csv;
use crate::plots::measured_shots;
use crate::report::fit_page::fit_page;
use crate::shooter::implausible_values;
use serde_json::Value;
use std::path::Path;

/// Fits the only shooter of a file into a folder.
pub(super) fn fit(
    file: &MeasuredFile,
    shots: &ShooterShots,
    folder: &Path,
    options: &FitOptions,
    quiet: bool,
) -> Result<(), Failure> {
    run_folder::refuse_other_results(folder, RunKind::Fit)?;
    if folder.join(several_shooters::TABLE_FILE).exists() {
        return Err(Failure::usage(format!(
            "{0}: holds the fits of several shooters; name a folder in it: --out {1}",
            folder.display(),
            folder
                .join(run_folder::safe_name(&file.name_of(shots)))
                .display()
        )));
    }
    if options.out.is_none() && options.measured.shooter.is_some() {
        refuse_other_shooter(folder, &shots.name)?;
    }
    let fit = file
        .fit(shots, &file.physics)
        .map_err(|error| failure(&options.shots.display().to_string(), &error))?;
    check_shots(&options.free, shots, &fit)?;
    let free = options
        .free
        .iter()
        .map(|name| estimate(name, file, shots, &fit))
        .collect::<Result<Vec<_>, _>>()?;
    write(folder, file, (shots, &fit, &free), options)?;
    several_shooters::renew_table(file, (shots, &fit), folder, options)?;
    answer(file, (shots, &fit, &free), options, folder, quiet)
}

/// Refuses the folder of another shooter, whose name is the same as that of a folder.
fn refuse_other_shooter(folder: &Path, name: &str) -> Result<(), Failure> {
    let text = std::fs::read_to_string(folder.join("fit.json")).unwrap_or_default();
    let fit: Value = serde_json::from_str(&text).unwrap_or_default();
    match fit["shooter"].as_str() {
        Some(other) if other != name => Err(Failure::usage(format!(
            "{}: holds the fit of {other}; name another folder with --out",
            folder.display()
        ))),
        _ => Ok(()),
    }
}

/// Writes the files of a fit.
pub(super) fn write(
    folder: &Path,
    file: &MeasuredFile,
    (shots, fit, free): (&ShooterShots, &ShooterFit, &[UnmeasuredParameter]),
    options: &FitOptions,
) -> Result<(), Failure> {
    run_folder::prepare(folder, RunKind::Fit)?;
    let units = options.measured.unit_system();
    let source = file.source(shots);
    let rows = shots.shots.iter().map(|shot| shot.row);
    let sessions = rows
        .zip(shots.sessions.iter().map(String::as_str))
        .collect();
    let mut contents: Vec<(String, Vec<u8>)> = vec![
        (
            "fit.json".to_owned(),
            format!("{:#}\n", with_free(fit_json(fit, &source, units), free)).into_bytes(),
        ),
        (
            "draws.parquet".to_owned(),
            draws_parquet(&fit.posterior, &fit.probabilities, units).map_err(Failure::bug)?,
        ),
        (
            "shots.csv".to_owned(),
            shots_csv(fit, &sessions, &shots.rejected, units),
        ),
    ];
    for place in 0..fit.places.len() {
        let name = match place {
            0 => "profile.toml".to_owned(),
            _ => format!("profile_place_{}.toml", place + 1),
        };
        let toml = fitted_profile_toml(fit, place, &source, &file.physics_toml, units);
        contents.push((name, toml.into_bytes()));
    }
    remove_further_places(folder, fit.places.len());
    for (name, bytes) in contents {
        let path = folder.join(name);
        atomic_file::write(&path, &bytes).map_err(|error| Failure::io(path.display(), &error))?;
    }
    let plots = measured_shots::all(fit, &shots.shots, &shots.sessions, units);
    plot_files::write(&folder.join("plots"), &plots)?;
    let page = fit_page(fit, &source, plots, units);
    let html = page.html()?;
    let path = folder.join("report.html");
    atomic_file::write(&path, html.as_bytes()).map_err(|error| Failure::io(path.display(), &error))
}

/// Removes the profiles and plots of places that an earlier fit had beyond these.
fn remove_further_places(folder: &Path, places: usize) {
    for number in places + 1.. {
        let profile = folder.join(format!("profile_place_{number}.toml"));
        if !profile.exists() {
            return;
        }
        let plots = ["releases", "make_zone"].into_iter().flat_map(|plot| {
            ["svg", "png"].map(|end| format!("plots/{plot}_place_{number}.{end}"))
        });
        for path in plots.map(|plot| folder.join(plot)).chain([profile]) {
            // What cannot be removed is old, but harms nothing.
            let _ = std::fs::remove_file(path);
        }
    }
}

fn answer(
    file: &MeasuredFile,
    (shots, fit, free): (&ShooterShots, &ShooterFit, &[UnmeasuredParameter]),
    options: &FitOptions,
    folder: &Path,
    quiet: bool,
) -> Result<(), Failure> {
    let units = options.measured.unit_system();
    let source = file.source(shots);
    if options.json {
        let json = with_free(fit_json(fit, &source, units), free);
        print_answer(&format!("{json:#}\n"))?;
    } else {
        print_prose(&fit_text(fit, &source, units))?;
        for parameter in free {
            print_prose(&parameter.text)?;
        }
    }
    if !quiet {
        let warnings = fit.profiles.iter().flat_map(implausible_values);
        for words in warnings.filter(|words| words.starts_with("location")) {
            print_remark(&format!("warning: {words}"));
        }
        print_merged_heights(shots, units);
        print_sessions(std::slice::from_ref(shots));
        if fit.places.len() > 1 {
            print_remark(&format!(
                "profile.toml is that of place 1, profile_place_N.toml that of place N (2 to {})",
                fit.places.len()
            ));
        }
        print_unused(file);
        print_remark(&format!(
            "written to {}; next: bankshot advise {}",
            folder.display(),
            folder.display()
        ));
    }
    Ok(())
}
