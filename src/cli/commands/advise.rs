//! `bankshot advise`: what a measured shooter should change, and how sure that is.

use super::fit::{failure, report_rejected};
use crate::answers::advice::AdviceAnswer;
use crate::answers::json;
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{is_quiet, print_answer, print_next, print_remark, print_text};
use crate::fitting::{FitNote, advise};
use crate::present::fit_files::advice_text::PlayerAdvice;
use crate::present::fit_files::fit_note_text::fit_note_text;
use crate::store::fit::Fit;
use crate::store::shooters::fits_within;
use crate::units::UnitSystem;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
SHOTS is a file, which is fitted first with the options of `bankshot fit`, or the folder of a fit. Both may have several players.

Examples:
  bankshot advise docs/data/gym_sensor.csv
  bankshot advise results/season-fit --brief
  bankshot advise results/gym-sensor-fit --json")]
pub(crate) struct AdviseOptions {
    /// Measured shots, or the folder of a fit.
    pub(crate) shots: PathBuf,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Print one JSON object for each player and place instead of text.
    #[arg(long)]
    pub(crate) json: bool,
    /// Print only what to tell the player.
    #[arg(long, conflicts_with = "json")]
    pub(crate) brief: bool,
}

pub(crate) fn run(options: &AdviseOptions) -> Result<u8, Failure> {
    if options.shots.is_dir() {
        fit_folder::refuse_options_of_files(&options.shots, &options.measured)?;
        let folders = match &fits_within(&options.shots)?[..] {
            [] => vec![options.shots.clone()],
            several => several.to_vec(),
        };
        for (number, folder) in folders.iter().enumerate() {
            let fit = fit_folder::read(folder)?;
            answer(options, &fit, (number, folders.len()))?;
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
            .fit(shots, &ProgressBars::new())
            .map_err(|error| failure(&options.shots.display().to_string(), &error))?;
        let fit = Fit::of(fit, shots, &file.tracker.0);
        answer(options, &fit, (number, file.shooters.len()))?;
    }
    Ok(worst)
}

/// Advice for each place of a fit. `shooter_of` is the index of the shooter and the number of all.
fn answer(options: &AdviseOptions, fit: &Fit, shooter_of: (usize, usize)) -> Result<(), Failure> {
    let bars = ProgressBars::new();
    let (shooter, shooters) = shooter_of;
    let places = fit.profiles.len();
    let units = options.measured.units_or(fit.units);
    let name = &fit.profiles[0].shooter().name;
    if shooter > 0 && !options.json {
        print_answer("\n")?;
    }
    // Advice is no better than the fit that it rests on: these come first.
    let is_told = |note: &&FitNote| matches!(note, FitNote::OtherMakes { .. });
    for note in fit.notes.iter().filter(|note| !is_told(note)) {
        print_remark(&format!("{name}: warning: {}", fit_note_text(note)));
    }
    for (place, profile) in fit.profiles.iter().enumerate() {
        if !is_quiet() && shooters * places > 1 {
            print_remark(&format!(
                "{name}: shooter {} of {shooters}, place {} of {places}",
                shooter + 1,
                place + 1,
            ));
        }
        let advice = advise(profile, &fit.posterior, place, &bars)?;
        if options.json {
            let answer = AdviceAnswer::new(fit, place, &advice);
            print_answer(&json::text(&json::document(&answer, units)))?;
            continue;
        }
        if place > 0 {
            print_answer("\n")?;
        }
        let player = PlayerAdvice {
            profile,
            advice: &advice,
            observed: fit.observed[place],
            doubt: fit.contradiction(place, &advice.usual_probability),
            units,
        };
        print_answer(&heading(fit, place, units, shooters > 1))?;
        match options.brief {
            true => print_answer(&player.brief())?,
            false => print_text(&player.text())?,
        };
    }
    if !options.json && !options.brief {
        print_next(None, "");
    }
    Ok(())
}

/// The shooter and the place, where there are several.
fn heading(fit: &Fit, place: usize, units: UnitSystem, has_several_shooters: bool) -> String {
    let profile = &fit.profiles[place];
    let mut words = Vec::new();
    if has_several_shooters {
        words.push(profile.shooter().name.clone());
    }
    if fit.profiles.len() > 1 {
        words.push(match fit.place_names[place].as_str() {
            "" => profile.location().in_words(units),
            name => format!("{name}: {}", profile.location().in_words(units)),
        });
    }
    match words.is_empty() {
        true => String::new(),
        false => format!("{}\n", words.join(", ")),
    }
}
