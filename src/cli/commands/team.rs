//! `bankshot team`: who should bank from where, and who is best from where.

use super::sweep::{compute, run_options};
use crate::cli::config_files::{load_profile, load_sweep, read_text};
use crate::cli::failure::{Failure, code};
use crate::cli::plot_files;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder;
use crate::cli::terminal::{print_answer, print_remark};
use crate::cli::value_parsers::PhysicsArg;
use bankshot::analysis::sensitivity::SensitivityTopics;
use bankshot::best_shot::{ShotKind, find_kinds};
use bankshot::output::atomic_file;
use bankshot::plots::sweep_results::SweepResults;
use bankshot::plots::{player_poster, sweep_bank_direct_map};
use bankshot::report::poster_page::poster_page;
use bankshot::sweep::bank_direct_difference::BankAdvantage;
use bankshot::sweep::job_list::{Jobs, Shard};
use bankshot::sweep::result_row::ResultRow;
use bankshot::sweep::sweep_toml::parse_sweep;
use bankshot::sweep::{SweepConfig, columns};
use bankshot::units::DEGREE_RAD;
use clap::Args;
use comfy_table::{Table, presets};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Without --sweep each player shoots from the location of their profile. With it, from every place of the sweep: its shooter is
replaced by each player in turn. Stop it whenever you like; the same command continues.

Writes OUT/team.csv, and for each player a folder with the sweep, its map, and a poster to print.

Examples:
  bankshot team ann.toml bo.toml cy.toml
  bankshot team ann.toml bo.toml cy.toml --sweep configs/half_court_3ft.toml --out team")]
pub(crate) struct TeamOptions {
    /// The players' profiles.
    #[arg(required = true, num_args = 1..)]
    pub(crate) players: Vec<PathBuf>,
    /// A sweep: its places, its search; its shooter does not matter.
    #[arg(long, value_name = "SWEEP.toml")]
    pub(crate) sweep: Option<PathBuf>,
    /// Folder of the results of --sweep.
    #[arg(long, value_name = "DIR", default_value = "results/team")]
    pub(crate) out: PathBuf,
}

pub(crate) fn run(options: &TeamOptions, quiet: bool) -> Result<u8, Failure> {
    match &options.sweep {
        None => from_their_places(options, quiet),
        Some(sweep) => over_the_court(options, sweep, quiet),
    }
}

/// A chance in 100.
fn in_hundred(p: f64) -> String {
    format!("{:.1}", 100.0 * p)
}

fn table_of(header: Vec<String>) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(header);
    table
}

fn from_their_places(options: &TeamOptions, quiet: bool) -> Result<u8, Failure> {
    let profiles = options
        .players
        .iter()
        .map(|path| load_profile(path, &PhysicsArg::default(), quiet))
        .collect::<Result<Vec<_>, _>>()?;
    let header = ["player", "place", "direct", "bank", "shoot it"];
    let mut table = table_of(header.map(str::to_owned).to_vec());
    let bars = ProgressBars::new(quiet);
    for profile in &profiles {
        let (_, shots) = find_kinds(profile, &ShotKind::ALL, SensitivityTopics::NONE, &bars)?;
        let p: Vec<Option<f64>> = shots
            .iter()
            .map(|shot| Some(shot.as_ref().ok()?.estimate.probability))
            .collect();
        let text = |p: Option<f64>| p.map_or_else(|| "-".to_owned(), in_hundred);
        let advice = match (p[0], p[1]) {
            (Some(direct), Some(bank)) if bank > direct => "off the board",
            (Some(_), _) => "direct",
            (None, Some(_)) => "off the board",
            (None, None) => "no clean shot",
        };
        let (long, metre) = profile.output().units.length();
        let location = profile.location();
        table.add_row(vec![
            profile.shooter().name.clone(),
            format!(
                "{:.2} {long}, {:.0} deg",
                location.distance_m / metre,
                location.angle_rad / DEGREE_RAD
            ),
            text(p[0]),
            text(p[1]),
            advice.to_owned(),
        ]);
    }
    print_answer(&format!("makes in 100 shots\n{}\n", table.trim_fmt()))
}

/// A player's finished sweep.
struct PlayerSweep {
    name: String,
    config: SweepConfig,
    rows: BTreeMap<u64, ResultRow>,
}

fn over_the_court(options: &TeamOptions, sweep: &Path, quiet: bool) -> Result<u8, Failure> {
    let (_, texts) = load_sweep(sweep)?;
    if texts.shooter.is_none() {
        return Err(Failure::usage(format!(
            "{}: name any profile with sweep.shooter in place of its table [shooter]; each player replaces it",
            sweep.display()
        )));
    }
    // Every profile is read before anything is computed.
    let mut sweeps = Vec::new();
    let mut folders: Vec<PathBuf> = Vec::new();
    for path in &options.players {
        let player = load_profile(path, &PhysicsArg::default(), quiet)?;
        let mut texts = texts.clone();
        texts.shooter = Some(read_text(path)?);
        let config = parse_sweep(&texts, &sweep.display().to_string())?;
        let name = player.shooter().name.clone();
        let folder = options.out.join(run_folder::safe_name(&name));
        if folders.contains(&folder) {
            return Err(Failure::usage(format!(
                "{}: two players have the name \"{name}\"; give each their own",
                path.display()
            )));
        }
        folders.push(folder);
        sweeps.push((name, config, texts));
    }
    let mut players = Vec::new();
    for ((name, config, texts), folder) in sweeps.into_iter().zip(&folders) {
        if !quiet {
            print_remark(&format!("{name}: {}", folder.display()));
        }
        let (swept, _) = compute(folder, &config, &texts, run_options(Shard::WHOLE), quiet)?;
        let (rows, _) = swept.union()?;
        write_pictures(folder, &name, &config, &rows)?;
        players.push(PlayerSweep { name, config, rows });
    }
    let csv = team_csv(&players);
    let file = options.out.join("team.csv");
    atomic_file::write(&file, csv.as_bytes())
        .map_err(|error| Failure::io(file.display(), &error))?;
    print_answer(&team_text(&players))?;
    if !quiet {
        print_remark(&format!(
            "written: {}, and in each player's folder bank_and_direct.svg and poster.html",
            file.display()
        ));
    }
    Ok(code::DONE)
}

/// A player's map and poster.
fn write_pictures(
    folder: &Path,
    name: &str,
    config: &SweepConfig,
    rows: &BTreeMap<u64, ResultRow>,
) -> Result<(), Failure> {
    let results = SweepResults::new(config, rows);
    let mut plots = Vec::new();
    plots.extend(sweep_bank_direct_map::draw(&results));
    if let Some((poster, sentences)) = player_poster::draw(&results) {
        let file = folder.join("poster.html");
        atomic_file::write(&file, poster_page(name, &poster, &sentences).as_bytes())
            .map_err(|error| Failure::io(file.display(), &error))?;
        plots.push(poster);
    }
    plot_files::write(folder, &plots)
}

/// Of each place, in the order of the sweep, the greater P of both kinds and that kind, for one player.
fn best_at_places(player: &PlayerSweep) -> Vec<Option<(f64, ShotKind)>> {
    let jobs = Jobs::new(&player.config);
    jobs.sources
        .iter()
        .map(|source| {
            let shots = jobs.kinds.iter().enumerate().filter_map(|(kind, name)| {
                let row = player.rows.get(&jobs.number(source.computed, kind))?;
                Some((row.real(columns::PROBABILITY)?, *name))
            });
            shots.reduce(|a, b| if b.0 > a.0 { b } else { a })
        })
        .collect()
}

/// The player with the greatest P at each place.
fn best_players(players: &[PlayerSweep]) -> Vec<Option<usize>> {
    let all: Vec<_> = players.iter().map(best_at_places).collect();
    (0..all[0].len())
        .map(|place| {
            let found = all
                .iter()
                .enumerate()
                .filter_map(|(i, of_player)| Some((i, of_player[place]?.0)));
            let best = found.reduce(|a, b| if b.1 > a.1 { b } else { a })?;
            Some(best.0)
        })
        .collect()
}

fn team_csv(players: &[PlayerSweep]) -> String {
    let (unit, metre) = players[0].config.settings.output.units.length();
    let quoted = |name: &str| format!("\"{}\"", name.replace('"', "\"\""));
    let mut text = format!("place,x_{unit},y_{unit},best_player");
    for player in players {
        text += &format!(
            ",{},{}",
            quoted(&format!("{} probability", player.name)),
            quoted(&format!("{} kind", player.name))
        );
    }
    text.push('\n');
    let all: Vec<_> = players.iter().map(best_at_places).collect();
    let best = best_players(players);
    for (place, source) in Jobs::new(&players[0].config).sources.iter().enumerate() {
        let name = best[place].map_or(String::new(), |i| quoted(&players[i].name));
        text += &format!(
            "{place},{},{},{name}",
            source.place.x_m / metre,
            source.place.y_m / metre
        );
        for of_player in &all {
            text += &match of_player[place] {
                Some((p, kind)) => format!(",{p:.5},{}", kind.name()),
                None => ",,".to_owned(),
            };
        }
        text.push('\n');
    }
    text
}

fn team_text(players: &[PlayerSweep]) -> String {
    let best = best_players(players);
    let header = [
        "player",
        "mean of\nall places",
        "banks at",
        "best of the\nteam at",
    ];
    let mut table = table_of(header.map(str::to_owned).to_vec());
    for (number, player) in players.iter().enumerate() {
        let found: Vec<f64> = best_at_places(player)
            .into_iter()
            .flatten()
            .map(|(p, _)| p)
            .collect();
        let mean = found.iter().sum::<f64>() / found.len().max(1) as f64;
        let jobs = Jobs::new(&player.config);
        let bank = BankAdvantage::of(&jobs, &player.rows).map_or_else(
            || "-".to_owned(),
            |bank| format!("{} of {} places", bank.better, bank.compared),
        );
        let own = best.iter().filter(|of| **of == Some(number)).count();
        table.add_row(vec![
            player.name.clone(),
            in_hundred(mean),
            bank,
            format!("{own} of {} places", best.len()),
        ]);
    }
    format!("makes in 100 shots\n{}\n", table.trim_fmt())
}
