//! `bankshot advise`: what a measured shooter should change, and how sure that is.

use super::fit::{failure, report_rejected};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::print_answer;
use bankshot::fitting::{Posterior, advise};
use bankshot::output::fit_files::advice_text::{advice_json, advice_text};
use bankshot::shooter::Profile;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
The shots can be a file, which is fitted first (with the options of `bankshot fit`), or the folder of a fit.

Examples:
  bankshot advise docs/data/gym_sensor.csv
  bankshot advise results/gym-sensor-fit --json")]
pub(crate) struct AdviseOptions {
    /// Measured shots, or the folder of a fit.
    pub(crate) shots: PathBuf,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Print one JSON object for each shooter instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &AdviseOptions, quiet: bool) -> Result<u8, Failure> {
    if options.shots.is_dir() {
        let fit = fit_folder::read(&options.shots)?;
        answer(options, &fit.profile, &fit.posterior, fit.observed, quiet)?;
        return Ok(code::DONE);
    }
    let file = options.measured.read(&options.shots)?;
    let mut worst = code::DONE;
    for shots in &file.shooters {
        report_rejected(&file, shots, true);
        if !shots.rejected.is_empty() {
            worst = code::INCOMPLETE;
        }
        let fit = file
            .fit(shots, &file.physics)
            .map_err(|error| failure(&options.shots.display().to_string(), &error))?;
        let observed = (fit.makes.made, fit.makes.labelled);
        answer(options, &fit.profiles[0], &fit.posterior, observed, quiet)?;
    }
    Ok(worst)
}

/// Advice for the first place.
fn answer(
    options: &AdviseOptions,
    profile: &Profile,
    posterior: &Posterior,
    observed: (usize, usize),
    quiet: bool,
) -> Result<(), Failure> {
    let bars = ProgressBars::new(quiet);
    let advice = advise(profile, posterior, 0, &bars)?;
    let (name, units) = (&profile.shooter().name, options.measured.unit_system());
    print_answer(&if options.json {
        format!("{:#}\n", advice_json(name, &advice, Some(observed), units))
    } else {
        let angle = profile.location().angle_rad;
        advice_text(name, &advice, Some(observed), angle, units)
    })?;
    Ok(())
}
