//! `bankshot advise`: what a measured shooter should change, and how sure that is.

use super::fit::{failure, report_rejected};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::fitting::{Posterior, advise};
use crate::output::fit_files::advice_text::{advice_json, advice_text};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, UnitSystem};
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
The shots can be a file, which is fitted first (with the options of `bankshot fit`), or the folder of a fit, of one \
shooter or of several.

Examples:
  bankshot advise docs/data/gym_sensor.csv
  bankshot advise results/gym-sensor-fit --json")]
pub(crate) struct AdviseOptions {
    /// Measured shots, or the folder of a fit.
    pub(crate) shots: PathBuf,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Print one JSON object for each shooter and place instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &AdviseOptions, quiet: bool) -> Result<u8, Failure> {
    if options.shots.is_dir() {
        fit_folder::refuse_options_of_files(&options.shots, &options.measured)?;
        let folders = match &fit_folder::of_shooters(&options.shots)[..] {
            [] => vec![options.shots.clone()],
            several => several.to_vec(),
        };
        for (number, folder) in folders.iter().enumerate() {
            let fit = fit_folder::read(folder)?;
            separate(options, number)?;
            print_warnings(&fit.profiles[0].shooter().name, &fit.warnings);
            let units = options.measured.units_or(fit.units);
            answer(
                options,
                (&fit.profiles, &fit.posterior, &fit.observed),
                units,
                quiet,
            )?;
        }
        return Ok(code::DONE);
    }
    let file = options.measured.read(&options.shots)?;
    let mut worst = code::DONE;
    for (number, shots) in file.shooters.iter().enumerate() {
        report_rejected(&file, shots, true);
        if !shots.rejected.is_empty() {
            worst = code::INCOMPLETE;
        }
        let fit = file
            .fit(shots, &file.physics)
            .map_err(|error| failure(&options.shots.display().to_string(), &error))?;
        let observed: Vec<(usize, usize)> = (0..fit.places.len())
            .map(|place| fit.makes.at_place(place))
            .map(|makes| (makes.made, makes.labelled))
            .collect();
        separate(options, number)?;
        print_warnings(&file.name_of(shots), &fit.warnings);
        let units = options.measured.unit_system();
        answer(
            options,
            (&fit.profiles, &fit.posterior, &observed),
            units,
            quiet,
        )?;
    }
    Ok(worst)
}

/// An empty line between the answers for two shooters.
fn separate(options: &AdviseOptions, number: usize) -> Result<(), Failure> {
    if number > 0 && !options.json {
        print_answer("\n")?;
    }
    Ok(())
}

/// Advice is no better than the fit that it rests on: these come first.
fn print_warnings<W: std::fmt::Display>(name: &str, warnings: &[W]) {
    for warning in warnings {
        print_remark(&format!("{name}: warning: {warning}"));
    }
}

/// Advice for each place; `profiles` and `observed` (made, and all with a result) are those of the
/// places.
fn answer(
    options: &AdviseOptions,
    (profiles, posterior, observed): (&[Profile], &Posterior, &[(usize, usize)]),
    units: UnitSystem,
    quiet: bool,
) -> Result<(), Failure> {
    let bars = ProgressBars::new(quiet);
    for (place, (profile, observed)) in profiles.iter().zip(observed).enumerate() {
        let observed = Some(*observed);
        let advice = advise(profile, posterior, place, &bars)?;
        let (name, location) = (&profile.shooter().name, profile.location());
        if options.json {
            let json = advice_json(name, &location, &advice, observed, units);
            print_answer(&format!("{json:#}\n"))?;
            continue;
        }
        if profiles.len() > 1 {
            let (unit, size) = units.length();
            print_answer(&format!(
                "{}from {:.2} {unit}, at {:.1} deg on the court, released {:.2} {unit} up\n",
                if place > 0 { "\n" } else { "" },
                location.distance_m / size,
                // No negative zero.
                libm::round(10.0 * location.angle_rad / DEGREE_RAD) / 10.0 + 0.0,
                profile.shooter().release_height_m / size
            ))?;
        }
        let angle = location.angle_rad;
        print_prose(&advice_text(name, &advice, observed, angle, units))?;
    }
    Ok(())
}
