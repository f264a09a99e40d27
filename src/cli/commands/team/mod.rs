//! `bankshot team`: who should bank from where, and who is best from where.

mod court_page;
mod court_results;
mod one_place;
mod over_the_court;
mod player_advice;
mod player_sweep;
mod ranking;
mod sureness;
mod team_csv;
mod team_profiles;
mod words;

use crate::cli::failure::Failure;
use crate::cli::profile_flags::PlaceOptions;
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Without --sweep the players are compared at the places of their profiles, or all at --distance and --angle.

With --sweep they are compared at every place of the sweep (its own shooter is ignored). The folder then has team.html to look at, posters.html with a sheet to print for each player, team.csv, team.svg, and a folder for each player. You can stop at any time; the same command continues.

Examples:
  bankshot team ann.toml bo.toml cy.toml
  bankshot team results/season-fit
  bankshot team results/season-fit --place 2
  bankshot team results/season-fit --distance '10 ft' --angle '45 deg'
  bankshot team ann.toml bo.toml cy.toml \\
    --sweep configs/half_court_3ft.toml --plan
  bankshot team ann.toml bo.toml cy.toml \\
    --sweep configs/half_court_3ft.toml --output team")]
pub(crate) struct TeamOptions {
    /// The players' profiles, the folders of their fits, or the folder of a fit of several
    /// shooters.
    #[arg(required = true, num_args = 1..)]
    pub(crate) players: Vec<PathBuf>,
    /// A sweep file: its places and its search, with each player in turn as the shooter.
    #[arg(long, value_name = "SWEEP.toml")]
    pub(crate) sweep: Option<PathBuf>,
    /// Folder of the results of --sweep.
    #[arg(
        long = "output",
        short = 'o',
        alias = "out",
        value_name = "DIR",
        default_value = "results/team"
    )]
    pub(crate) out: PathBuf,
    /// The number of the place that each player shoots from, for fits with several places; 1 for
    /// the first.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "sweep")]
    pub(crate) place: Option<u32>,
    #[command(flatten)]
    pub(crate) from: PlaceOptions,
    /// With --sweep: print how long it takes, and stop.
    #[arg(long, requires = "sweep")]
    pub(crate) plan: bool,
}

/// Fitted players over a sweep: its page, posters and table in `out`.
pub(crate) fn over_the_court_of(
    players: &[PathBuf],
    sweep: &Path,
    out: &Path,
) -> Result<u8, Failure> {
    over_the_court::run(players, sweep, out)
}

pub(crate) fn run(options: &TeamOptions) -> Result<u8, Failure> {
    let players = &options.players;
    match &options.sweep {
        None => one_place::run(players, options.place, &options.from),
        Some(_) if options.from.is_given() => Err(Failure::usage(
            "--distance and --angle: one place for all players; with --sweep they shoot from its places",
        )),
        Some(sweep) if options.plan => over_the_court::plan(players, sweep),
        Some(sweep) => over_the_court::run(players, sweep, &options.out),
    }
}
