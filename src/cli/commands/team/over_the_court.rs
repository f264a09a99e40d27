//! Each player from every place of a sweep.

use super::court_page::team_page;
use super::court_results::{notes, team_text};
use super::player_advice::PlayerAdvice;
use super::player_sweep::{PlayerSweep, best_players};
use super::sureness::{find_hoop_dependence, find_sureness, sureness_s};
use super::team_csv::team_csv;
use super::team_profiles::{load_players, warn_of};
use crate::cli::commands::plan_sweep_time_and_memory::forecast_s;
use crate::cli::commands::sweep::{compute, run_options};
use crate::cli::config_files::{read_sweep_without_shooter, read_text, warnings_of_fit};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::plot_files;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{
    is_quiet, print_answer, print_hint, print_prose, print_remark, time_in_words,
};
use crate::escape::file_name;
use crate::files::atomic_file;
use crate::fitting::{UnseenParameter, shared_sd};
use crate::plots::player_poster::PlayerPoster;
use crate::plots::sweep_results::SweepResults;
use crate::plots::{player_poster, sweep_bank_direct_map, team_maps};
use crate::report::poster_page::{poster_page, posters_page};
use crate::shooter::Profile;
use crate::store::fit::Fit;
use crate::store::shooters::ring_told_by_makes;
use crate::sweep::SweepConfig;
use crate::sweep::job_list::{Jobs, Shard};
use crate::sweep::probability_by_place::PlaceProbabilities;
use crate::sweep::result_row::ResultRow;
use crate::sweep::sweep_toml::{SourceTexts, parse_sweep};
use crate::units::UnitSystem;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A player whose sweep can begin.
struct PlannedPlayer {
    name: String,
    fit: Option<Fit>,
    /// What its fit warned of, a line each.
    warnings: String,
    config: SweepConfig,
    texts: SourceTexts,
    /// The file of the profile, and the profile.
    player: (PathBuf, Profile),
}

/// Reads every profile: nothing is computed before.
fn planned_players(players: &[PathBuf], sweep: &Path) -> Result<Vec<PlannedPlayer>, Failure> {
    let texts = read_sweep_without_shooter(sweep)?;
    let players = load_players(players, None)?.into_iter();
    let planned = players.map(|(path, player)| {
        let name = player.shooter().name.clone();
        let warnings = warnings_of_fit(&path)?.into_iter();
        let texts = SourceTexts {
            shooter: Some(read_text(&path)?),
            ..texts.clone()
        };
        Ok(PlannedPlayer {
            warnings: warnings
                .map(|words| format!("{name}: {words}.\n"))
                .collect(),
            config: parse_sweep(&texts, &sweep.display().to_string())?,
            fit: fit_folder::of_profile(&path)?,
            player: (path, player),
            name,
            texts,
        })
    });
    planned.collect()
}

/// Prints how long it takes.
pub(super) fn plan(players: &[PathBuf], sweep: &Path) -> Result<u8, Failure> {
    let planned = planned_players(players, sweep)?;
    print_answer(&match forecast_in_words(&planned) {
        Some(words) => format!("{words}\n"),
        None => "No shot goes in from any place.\n".to_owned(),
    })
}

/// What all players take, from the first one's sweep and fit.
fn forecast_in_words(players: &[PlannedPlayer]) -> Option<String> {
    let first = &players[0];
    let sweep_s = forecast_s(&first.config)?;
    let fitted = players.iter().filter_map(|player| player.fit.as_ref());
    let fitted: Vec<&Fit> = fitted.collect();
    let places = Jobs::new(&first.config).sources.len();
    let of_fits_s = fitted
        .first()
        .map_or(0.0, |fit| sureness_s(fit) * (places * fitted.len()) as f64);
    let time = time_in_words(sweep_s * players.len() as f64 + of_fits_s);
    let players = match players.len() {
        1 => "1 player".to_owned(),
        more => format!("{more} players"),
    };
    Some(format!("{players}: about {time} in all"))
}

/// The players with their sweeps.
#[derive(Default)]
struct Team {
    players: Vec<PlayerSweep>,
    /// What the maps are drawn of, for each player.
    results: Vec<(SweepConfig, BTreeMap<u64, ResultRow>)>,
    /// Of those that have one.
    posters: Vec<PlayerPoster>,
}

impl PlannedPlayer {
    /// Computes what is not yet computed, and writes the player's pictures.
    fn sweep(self, team: &mut Team, folder: &Path, ring: (f64, f64)) -> Result<(), Failure> {
        let (config, fit) = (self.config, self.fit);
        let (swept, _) = compute(folder, &config, &self.texts, run_options(Shard::WHOLE))?;
        let (rows, _) = swept.union()?;
        let mut places = PlaceProbabilities::of_sweep(&config, &rows);
        let bars = ProgressBars::new();
        let mut advice = None;
        if let Some(fit) = &fit {
            find_sureness(&mut places, &config, fit, &bars)?;
            advice = Some(PlayerAdvice::of_fit(fit, &config.settings.output, &bars)?);
        }
        let (probability_sd, shared_sd) = fit.as_ref().map_or((0.0, 0.0), |fit| {
            let p = fit.usual_probabilities(0);
            let shared = shared_sd(&fit.posterior.draws, &p.of_draws);
            (p.interval().sd, shared)
        });
        find_hoop_dependence(&mut places, &config, ring, &bars)?;
        let own = advice.as_ref().map(|advice| advice.poster.as_str());
        let poster = write_pictures(folder, (&self.name, own), (&config, &rows), &places)?;
        team.posters.extend(poster);
        team.players.push(PlayerSweep {
            name: self.name,
            places,
            probability_sd,
            shared_sd,
            advice,
        });
        team.results.push((config, rows));
        Ok(())
    }
}

/// Computes what is not yet computed, prints the answer and writes the page, the posters, the maps
/// and the table to `out`.
pub(super) fn run(paths: &[PathBuf], sweep: &Path, out: &Path) -> Result<u8, Failure> {
    let planned = planned_players(paths, sweep)?;
    for planned in &planned {
        let (path, player) = &planned.player;
        warn_of(path, player)?;
    }
    let folder_of = |player: &PlannedPlayer| out.join(file_name(&player.name));
    let folders: Vec<PathBuf> = planned.iter().map(folder_of).collect();
    let units = planned[0].config.settings.output.units;
    let told = ring_told_by_makes(paths)?;
    let ring = told.unwrap_or(UnseenParameter::HoopRestitution.usual_range());
    if !is_quiet() && !folders.iter().any(|folder| folder.exists()) {
        forecast_in_words(&planned)
            .iter()
            .for_each(|words| print_remark(words));
    }
    let warnings: String = planned
        .iter()
        .map(|player| player.warnings.as_str())
        .collect();
    let team = sweep_players(planned, &folders, ring)?;
    let page_file = write_team(out, &team, (&warnings, ring), units)?;
    let players = &team.players;
    if !is_quiet() {
        warn_of_other_players(out, &folders, players);
    }
    print_prose(&team_text(players, ring, units))?;
    print_prose(&notes(players))?;
    print_hint(&format!(
        "Saved: {}, and beside it posters.html (a sheet for each player), team.csv and team.svg; each player's folder has bank_and_direct.svg and poster.html",
        page_file.display()
    ));
    if let [first, second, ..] = &folders[..] {
        print_hint(&format!(
            "Next:  bankshot map {} --against {}",
            first.display(),
            second.display()
        ));
    }
    Ok(code::DONE)
}

/// The players with their sweeps, one after the other.
fn sweep_players(
    planned: Vec<PlannedPlayer>,
    folders: &[PathBuf],
    ring: (f64, f64),
) -> Result<Team, Failure> {
    let count = planned.len();
    // The longest of those that are done: others may have been computed before.
    let mut time_s: f64 = 0.0;
    let mut team = Team::default();
    for (number, (player, folder)) in planned.into_iter().zip(folders).enumerate() {
        let left = match time_s * (count - number) as f64 {
            0.0 => String::new(),
            left_s => format!(", about {} left", time_in_words(left_s)),
        };
        print_hint(&format!(
            "player {} of {count}{left}: {}, {}",
            number + 1,
            player.name,
            folder.display()
        ));
        let start = Instant::now();
        player.sweep(&mut team, folder, ring)?;
        time_s = time_s.max(start.elapsed().as_secs_f64());
    }
    Ok(team)
}

/// Writes the maps, the posters, the table and the page, whose file it returns.
fn write_team(
    out: &Path,
    team: &Team,
    (warnings, ring): (&str, (f64, f64)),
    units: UnitSystem,
) -> Result<PathBuf, Failure> {
    let Team {
        players,
        results,
        posters,
    } = team;
    let results: Vec<SweepResults<'_>> = results
        .iter()
        .zip(players)
        .map(|((config, rows), player)| {
            SweepResults::new(config, rows).with_chances(player.places.clone())
        })
        .collect();
    let maps = team_maps::draw(&results, &best_players(players));
    plot_files::write(out, maps.as_slice())?;
    let has_posters = !posters.is_empty();
    if has_posters {
        write(&out.join("posters.html"), posters_page(posters))?;
    }
    write(&out.join("team.csv"), team_csv(players, units))?;
    let file = out.join("team.html");
    let page = team_page(players, maps, has_posters, (warnings, ring), units);
    write(&file, page.html())?;
    Ok(file)
}

fn write(file: &Path, text: impl AsRef<[u8]>) -> Result<(), Failure> {
    atomic_file::write(file, text.as_ref()).map_err(|error| Failure::io(file.display(), &error))
}

/// Says which players have a sweep in the folder of the team, and are not in its files.
fn warn_of_other_players(out: &Path, folders: &[PathBuf], players: &[PlayerSweep]) {
    let others = other_players(out, folders);
    if others.is_empty() {
        return;
    }
    print_remark(&format!(
        "{} also has sweeps of other players ({}): its page, table and posters now show {} only; name all players to show all",
        out.display(),
        others.join(", "),
        match players {
            [one] => one.name.clone(),
            more => format!("these {} players", more.len()),
        }
    ));
}

/// The folders of sweeps in a team's folder that are not those of its players.
fn other_players(out: &Path, folders: &[PathBuf]) -> Vec<String> {
    let entries = std::fs::read_dir(out).into_iter().flatten().flatten();
    let others = entries
        .map(|entry| entry.path())
        .filter(|path| path.join("configuration.json").is_file() && !folders.contains(path));
    let mut names: Vec<String> = others
        .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    names
}

/// Writes a player's map and poster; returns the poster.
fn write_pictures(
    folder: &Path,
    (name, own): (&str, Option<&str>),
    (config, rows): (&SweepConfig, &BTreeMap<u64, ResultRow>),
    places: &[PlaceProbabilities],
) -> Result<Option<PlayerPoster>, Failure> {
    let results = SweepResults::new(config, rows).with_chances(places.to_vec());
    let mut plots = Vec::new();
    plots.extend(sweep_bank_direct_map::draw(&results));
    let poster = player_poster::draw(&results, own);
    if let Some(poster) = &poster {
        write(&folder.join("poster.html"), poster_page(name, poster))?;
        plots.push(poster.plot.clone());
    }
    plot_files::write(folder, &plots)?;
    Ok(poster)
}
