//! `bankshot coach`: from an export to what a coach takes to the gym. Everything that it does is a
//! call of `fit`, `advise` and `team`.

use super::fit::{FitOptions, fit_each, print_sessions, print_unused, report_rejected};
use super::team::over_the_court_of;
use crate::cli::failure::{Failure, code, refuse_file};
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{is_quiet, print_answer, print_hint, print_prose, print_remark};
use crate::files::atomic_file;
use crate::fitting::{Advice, advise};
use crate::model::league_courts::League;
use crate::present::fit_files::advice_text::PlayerAdvice;
use crate::present::fit_files::coach_text::coach_paragraph;
use crate::report::coach_sheet::coach_sheet;
use crate::store::fit::Fit;
use crate::units::UnitSystem;
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Fits every player, prints a paragraph for each, and writes a folder: sheet.html (the paragraphs, to print), players (a fit of each), sweep.toml (the places of the court, to edit) and team (a page of all, posters.html with a sheet for each player, team.csv). The columns are taken as bankshot proposes them; --map changes one. With a place that the file does not say: --at.

Examples:
  bankshot coach docs/data/gym_sensor.csv
  bankshot coach docs/data/gym_sensor.xlsx --at 'free throw' \\
    --release-height '7 ft' --no-court")]
pub(crate) struct CoachOptions {
    /// The exports of measured shots: CSV, Excel, Parquet or JSON.
    #[arg(required = true, num_args = 1.., value_name = "SHOTS")]
    pub(crate) shots: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Folder of the results.
    #[arg(
        long = "output",
        short = 'o',
        value_name = "DIR",
        default_value = "results/coach"
    )]
    pub(crate) out: PathBuf,
    /// The sweep of the team's page [default: all places of the court that have a name].
    #[arg(long, value_name = "SWEEP.toml", conflicts_with = "no_court")]
    pub(crate) sweep: Option<PathBuf>,
    /// Leave out the team's page and the posters.
    #[arg(long)]
    pub(crate) no_court: bool,
}

pub(crate) fn run(options: &CoachOptions) -> Result<u8, Failure> {
    refuse_file(&options.out)?;
    let mut worst = code::DONE;
    let mut folders: Vec<PathBuf> = Vec::new();
    let mut units = UnitSystem::Imperial;
    let mut league = League::Ncaa;
    for (number, path) in options.shots.iter().enumerate() {
        let mut measured = options.measured.clone();
        measured.accept = true;
        let file = measured.read(path)?;
        league = options
            .measured
            .court
            .unwrap_or_else(|| League::of_physics(&file.physics));
        units = measured.unit_system();
        for shots in &file.shooters {
            report_rejected(&file, shots, file.shooters.len() == 1);
            if !shots.rejected.is_empty() {
                worst = code::INCOMPLETE;
            }
        }
        if !is_quiet() {
            print_sessions(&file);
            print_unused(&file);
        }
        let players = match options.shots.len() {
            1 => options.out.join("players"),
            _ => options.out.join(format!("players-{}", number + 1)),
        };
        let fit_options = FitOptions {
            shots: path.clone(),
            measured,
            out: Some(players.clone()),
            free: Vec::new(),
            compare_shapes: false,
            json: false,
        };
        for fitted in fit_each(&file, &players, &fit_options)? {
            match fitted {
                Ok(folder) => folders.push(folder),
                Err(reason) => {
                    print_remark(&reason);
                    worst = code::INCOMPLETE;
                }
            }
        }
    }
    if folders.is_empty() {
        return Err(Failure::usage(
            "no player could be fitted; the reasons are above",
        ));
    }
    let paragraphs = paragraphs(&folders)?;
    for (name, text) in &paragraphs {
        print_prose(&format!("{name}: {text}"))?;
        print_answer("\n")?;
    }
    let sheet = options.out.join("sheet.html");
    write(&sheet, &coach_sheet(&paragraphs, &source(&options.shots)))?;
    if options.no_court {
        print_hint(&format!("Saved: {}", sheet.display()));
        return Ok(worst);
    }
    let sweep = match &options.sweep {
        Some(sweep) => sweep.clone(),
        None => {
            let file = options.out.join("sweep.toml");
            if !file.exists() {
                write(&file, &sweep_toml(league, units))?;
            }
            file
        }
    };
    let of_team = over_the_court_of(&folders, &sweep, &options.out.join("team"))?;
    print_hint(&format!(
        "Saved: {} (the paragraphs above, to print)",
        sheet.display()
    ));
    Ok(worst.max(of_team))
}

/// The paragraph of each player.
fn paragraphs(folders: &[PathBuf]) -> Result<Vec<(String, String)>, Failure> {
    let fits: Vec<Fit> = folders
        .iter()
        .map(|folder| fit_folder::read(folder))
        .collect::<Result<_, _>>()?;
    let bars = ProgressBars::new();
    let mut paragraphs = Vec::new();
    for (number, fit) in fits.iter().enumerate() {
        let name = fit.profiles[0].shooter().name.clone();
        if !is_quiet() && fits.len() > 1 {
            print_remark(&format!("{name}: player {} of {}", number + 1, fits.len()));
        }
        let advice: Vec<Advice> = fit
            .profiles
            .iter()
            .enumerate()
            .map(|(place, profile)| advise(profile, &fit.posterior, place, &bars))
            .collect::<Result<_, _>>()?;
        let at_places: Vec<(String, PlayerAdvice)> = advice
            .iter()
            .enumerate()
            .map(|(place, advice)| {
                let profile = &fit.profiles[place];
                let player = PlayerAdvice {
                    profile,
                    advice,
                    observed: fit.observed[place],
                    doubt: fit.contradiction(place, &advice.usual_probability),
                    units: fit.units,
                };
                let place = match fit.place_names[place].as_str() {
                    "" => format!("place {}", profile.location().in_words(fit.units)),
                    name => name.to_owned(),
                };
                (place, player)
            })
            .collect();
        paragraphs.push((name, coach_paragraph(&at_places)));
    }
    Ok(paragraphs)
}

fn source(shots: &[PathBuf]) -> String {
    let files: Vec<String> = shots
        .iter()
        .map(|path| {
            path.file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    format!(
        "bankshot {}, from {}. The intervals leave out what another board, ball or air would change.",
        env!("CARGO_PKG_VERSION"),
        files.join(", ")
    )
}

/// A sweep of the named places of a court, as coarse as a first look needs.
fn sweep_toml(league: League, units: UnitSystem) -> String {
    let units = match units {
        UnitSystem::Imperial => "imperial",
        UnitSystem::Metric => "metric",
    };
    format!(
        include_str!("new_templates/coach_sweep.toml"),
        court = league.name(),
        units = units
    )
}

fn write(file: &Path, text: &str) -> Result<(), Failure> {
    atomic_file::write(file, text.as_bytes()).map_err(|error| Failure::io(file.display(), &error))
}
