//! `bankshot advise`: what a measured shooter should change, and how sure that is.

use super::fit::{failure, report_rejected};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::shooter_folders;
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::fitting::{Posterior, advise};
use crate::output::fit_files::advice_json::advice_json;
use crate::output::fit_files::advice_text::{advice_text, brief_advice_text};
use crate::shooter::Profile;
use crate::units::UnitSystem;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
The shots can be a file, which is fitted first (with the options of `bankshot fit`), or the folder of a fit, of one \
shooter or of several.

Examples:
  bankshot advise docs/data/gym_sensor.csv
  bankshot advise results/season-fit --brief
  bankshot advise results/gym-sensor-fit --json")]
pub(crate) struct AdviseOptions {
    /// Measured shots, or the folder of a fit.
    pub(crate) shots: PathBuf,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Print one JSON object for each shooter and place instead of text.
    #[arg(long)]
    pub(crate) json: bool,
    /// Print only what to tell the player, of each shooter and place: the first sentences, how the
    /// ball should come down, and bank against direct.
    #[arg(long, conflicts_with = "json")]
    pub(crate) brief: bool,
}

pub(crate) fn run(options: &AdviseOptions, quiet: bool) -> Result<u8, Failure> {
    if options.shots.is_dir() {
        fit_folder::refuse_options_of_files(&options.shots, &options.measured)?;
        let folders = match &shooter_folders::of_shooters(&options.shots)[..] {
            [] => vec![options.shots.clone()],
            several => several.to_vec(),
        };
        for (number, folder) in folders.iter().enumerate() {
            let fit = fit_folder::read(folder)?;
            separate(options, number)?;
            print_warnings(&fit.profiles[0].shooter().name, &fit.warnings);
            let units = options.measured.units_or(fit.units);
            let places: Vec<ShooterPlace<'_>> = (0..fit.profiles.len())
                .map(|place| ShooterPlace {
                    name: &fit.place_names[place],
                    profile: &fit.profiles[place],
                    observed: fit.observed[place],
                })
                .collect();
            let shooter_of = (number, folders.len());
            answer(options, &places, &fit.posterior, units, (shooter_of, quiet))?;
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
        let places: Vec<ShooterPlace<'_>> = (0..fit.places.len())
            .map(|place| {
                let makes = fit.makes.at_place(place);
                ShooterPlace {
                    name: &shots.place_names[place],
                    profile: &fit.profiles[place],
                    observed: (makes.made, makes.labelled),
                }
            })
            .collect();
        separate(options, number)?;
        print_warnings(&file.name_of(shots), &fit.warnings);
        let units = options.measured.unit_system();
        let shooter_of = (number, file.shooters.len());
        answer(options, &places, &fit.posterior, units, (shooter_of, quiet))?;
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

/// A place of a shooter's test.
struct ShooterPlace<'a> {
    /// Its name; empty where the file does not say.
    name: &'a str,
    profile: &'a Profile,
    /// Made, and all with a result.
    observed: (usize, usize),
}

/// Advice for each place. `shooter_of` is the index of the shooter and the number of all.
fn answer(
    options: &AdviseOptions,
    places: &[ShooterPlace<'_>],
    posterior: &Posterior,
    units: UnitSystem,
    (shooter_of, quiet): ((usize, usize), bool),
) -> Result<(), Failure> {
    let bars = ProgressBars::new(quiet);
    let (shooter, shooters) = shooter_of;
    for (number, place) in places.iter().enumerate() {
        if !quiet && shooters * places.len() > 1 {
            print_remark(&format!(
                "{}: shooter {} of {shooters}, place {} of {}",
                place.profile.shooter().name,
                shooter + 1,
                number + 1,
                places.len()
            ));
        }
        let (profile, observed) = (place.profile, Some(place.observed));
        let advice = advise(profile, posterior, number, &bars)?;
        let (name, location) = (&profile.shooter().name, profile.location());
        if options.json {
            let mut json = advice_json(name, &location, &advice, observed, units);
            if let Some(record) = json.as_object_mut() {
                record.insert("place".to_owned(), place.name.into());
            }
            print_answer(&format!("{json:#}\n"))?;
            continue;
        }
        if places.len() > 1 {
            let (unit, size) = units.length();
            print_answer(&format!(
                "{}{}{}, released {:.2} {unit} up\n",
                if number > 0 { "\n" } else { "" },
                match place.name {
                    "" => String::new(),
                    name => format!("{name}: "),
                },
                location.in_words(units),
                profile.shooter().release_height_m / size
            ))?;
        }
        let angle = location.angle_rad;
        let text = match options.brief {
            true => brief_advice_text(name, &advice, observed, angle, units),
            false => advice_text(name, &advice, observed, angle, units),
        };
        print_prose(&text)?;
    }
    Ok(())
}
