//! The fit of one shooter and its answer.

use super::failure::failure;
use super::files::write;
use super::options::FitOptions;
use super::remarks::{print_place_scatter, print_unused};
use super::shooters_table::{TABLE_FILE, renew_table};
use super::unmeasured_parameters::{
    UnmeasuredParameter, check_shots, drag, estimate, found_values, is_drag,
};
use crate::answers::fit::FitAnswer;
use crate::answers::json::{self, document};
use crate::cli::failure::{Failure, code};
use crate::cli::measured_shots_flags::MeasuredFile;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder::{self, RunKind};
use crate::cli::terminal::{
    is_quiet, print_answer, print_next, print_prose, print_remark, print_text,
};
use crate::escape::file_name;
use crate::fitting::{ShooterFit, compare_shapes, predictive_check};
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::present::fit_files::fit_text::fit_text;
use crate::probability::Progress;
use crate::shooter::implausible_values;
use crate::store;
use serde_json::json;
use std::path::Path;

/// Fits the only shooter of a file into a folder.
pub(super) fn fit(
    file: &MeasuredFile,
    shots: &ShooterShots,
    folder: &Path,
    options: &FitOptions,
) -> Result<u8, Failure> {
    run_folder::refuse_other_results(folder, RunKind::Fit)?;
    if folder.join(TABLE_FILE).exists() {
        return Err(Failure::usage(format!(
            "{0}: has the fits of several shooters; name a folder in it: --output {1}",
            folder.display(),
            folder.join(file_name(&file.name_of(shots))).display()
        )));
    }
    if options.out.is_none() && options.measured.shooter.is_some() {
        refuse_other_shooter(folder, &shots.name)?;
    }
    let bars = ProgressBars::new();
    let mut fit = match file.fit(shots, &bars) {
        Ok(fit) => fit,
        // The drag needs no profile, and flights from many places make none.
        Err(error) if options.free.iter().any(|name| is_drag(name)) && !shots.tracks.is_empty() => {
            answer_drag(file, &[shots], (&error.to_string(), &bars), options)?;
            return Ok(code::INCOMPLETE);
        }
        Err(error) => return Err(failure(&options.shots.display().to_string(), &error)),
    };
    check_shots(&options.free, shots, &fit)?;
    add_checks(&mut fit, file, (shots, &bars), options);
    let free = options
        .free
        .iter()
        .map(|name| estimate(name, file, &[(shots, &fit)], &bars))
        .collect::<Result<Vec<_>, _>>()?;
    write(folder, file, (shots, &fit, &free), options)?;
    renew_table(file, (shots, &fit), folder, options)?;
    answer(file, (shots, &fit, &free), options, folder)?;
    Ok(code::DONE)
}

/// Adds the checks that only a whole answer has.
pub(super) fn add_checks(
    fit: &mut ShooterFit,
    file: &MeasuredFile,
    (shots, progress): (&ShooterShots, &dyn Progress),
    options: &FitOptions,
) {
    fit.predictive = predictive_check(fit, &shots.shots, progress);
    if !options.compare_shapes {
        return;
    }
    let places = shots.places.len();
    let name = file.name_of(shots);
    match compare_shapes(&shots.shots, places, &file.fit_options(shots), progress) {
        Ok(found) if found.is_empty() => print_remark(&format!(
            "{name}: --compare-shapes: no release was measured"
        )),
        Ok(found) => fit.shapes = found,
        // The fit itself is good.
        Err(_) => print_remark(&format!(
            "{name}: --compare-shapes: one of the shapes cannot be fitted to these shots, so they were not compared"
        )),
    }
}

/// Prints the drag by flights that make no profile, and why they make none.
pub(super) fn answer_drag(
    file: &MeasuredFile,
    shooters: &[&ShooterShots],
    (why, progress): (&str, &dyn Progress),
    options: &FitOptions,
) -> Result<(), Failure> {
    let found = drag(file, shooters, progress);
    if options.json {
        print_answer(&format!("{:#}\n", json!({ "free": [found.found] })))?;
    } else {
        print_prose(&found.text)?;
    }
    print_remark(&format!("no profile was fitted: {why}"));
    Ok(())
}

/// Refuses the folder of another shooter, whose name is the same as that of a folder.
fn refuse_other_shooter(folder: &Path, name: &str) -> Result<(), Failure> {
    // One that cannot be read is replaced now.
    match store::fit::shooter(folder) {
        Ok(other) if other != name => Err(Failure::usage(format!(
            "{}: has the fit of {other}; name another folder with --output",
            folder.display()
        ))),
        _ => Ok(()),
    }
}

fn answer(
    file: &MeasuredFile,
    (shots, fit, free): (&ShooterShots, &ShooterFit, &[UnmeasuredParameter]),
    options: &FitOptions,
    folder: &Path,
) -> Result<(), Failure> {
    let units = options.measured.unit_system();
    let source = file.source(shots);
    if options.json {
        let answer = FitAnswer::new(fit, &source, found_values(free));
        print_answer(&json::text(&document(&answer, units)))?;
    } else {
        print_text(&fit_text(fit, &source, units))?;
        for parameter in free {
            print_prose(&parameter.text)?;
        }
    }
    if !is_quiet() {
        let warnings = fit.profiles.iter().flat_map(implausible_values);
        for warning in warnings.filter(|warning| warning.key == "location") {
            print_remark(&format!("warning: {warning}"));
        }
        print_place_scatter(shots, units);
        if fit.places.len() > 1 {
            print_remark(
                "profile.toml is for place 1; the other places have profile_place_2.toml and so on",
            );
        }
        print_unused(file);
    }
    print_next(
        Some(folder),
        &format!("bankshot advise {}", folder.display()),
    );
    Ok(())
}
