//! The command line: the commands, and the flags that all of them have. Each command declares its
//! own in its file.

use super::commands::advise::AdviseOptions;
use super::commands::angles::AnglesOptions;
use super::commands::best::BestOptions;
use super::commands::check::CheckOptions;
use super::commands::coach::CoachOptions;
use super::commands::compare::CompareOptions;
use super::commands::fit::FitOptions;
use super::commands::map::MapOptions;
use super::commands::new::NewOptions;
use super::commands::physics::PhysicsOptions;
use super::commands::plan::PlanOptions;
use super::commands::report::ReportOptions;
use super::commands::sample_size::SampleSizeOptions;
use super::commands::shot::ShotOptions;
use super::commands::simulate::SimulateOptions;
#[cfg(feature = "studio")]
use super::commands::studio::StudioOptions;
use super::commands::sweep::{MergeOptions, SweepOptions};
use super::commands::sweep_status::{MissingOptions, StatusOptions, VerifyOptions};
use super::commands::table::TableOptions;
use super::commands::team::TeamOptions;
use super::commands::trace::TraceOptions;
use super::value_parsers::instruction_set;
use crate::dynamics::InstructionSet;
use clap::{CommandFactory, Parser, Subcommand};
use std::path::PathBuf;

const EXIT_CODES: &str = "\
Exit codes:
  0   everything is done
  1   done, but less precise than wanted
  2   usage or configuration refused; nothing was written
  3   incomplete: some rows or jobs are missing or failed, the others are done;
      or no shot goes in
  4   data damaged, of another sweep, or contradictory
  70  a bug
  74  input or output failed
  75  stopped, or the folder is in use by another run; run again
  130 stopped by Ctrl-C; no file is left incomplete

Examples:
  bankshot best configs/free_throw.toml
  bankshot fit docs/data/gym_sensor.csv
  bankshot advise results/gym-sensor-fit
  bankshot sweep configs/quick_sweep.toml";

/// Find the best basketball shot for a player's own scatter.
#[derive(Debug, Parser)]
#[command(version, after_help = EXIT_CODES, max_term_width = 80)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Number of threads, at most 4 per core [default: one per core]. Does not change results.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Vector instructions [default: the best of this machine]. Does not change results.
    #[arg(long, global = true, value_name = "SET", value_parser = instruction_set, hide = true)]
    pub(crate) simd: Option<InstructionSet>,
    /// Print no progress and no remarks.
    #[arg(long, short, global = true)]
    pub(crate) quiet: bool,
    /// Print everything, not only what matters most.
    #[arg(long, alias = "verbose", global = true)]
    pub(crate) details: bool,
}

/// The commands by what people do with them, as the help of the program lists them.
pub(crate) const GROUPS: [(&str, &[&str]); 7] = [
    ("Start", &["studio", "new", "check"]),
    ("Shots", &["best", "angles", "shot", "trace", "physics"]),
    (
        "Measured players",
        &["coach", "fit", "advise", "compare", "sample-size"],
    ),
    ("Court", &["sweep", "team", "map"]),
    ("Launchers", &["table"]),
    ("Output", &["report"]),
    (
        "Plumbing (`bankshot help --all` lists these)",
        &[
            "simulate",
            "status",
            "verify",
            "merge",
            "missing",
            "schema",
            "completions",
            "man",
            "figures",
        ],
    ),
];

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Find the best direct and the best bank shot from a place.
    Best(BestOptions),
    /// Find the best shot at each of several release angles.
    #[command(alias = "pitch-curve")]
    Angles(AnglesOptions),
    /// Write a commented file to edit: a player, a launcher, a sweep, or a physics.
    New(NewOptions),
    /// Compare players, from one place or over the whole court; posters to print.
    Team(TeamOptions),
    /// Make a table of best shots over distances and angles, for a machine.
    Table(TableOptions),
    /// From an export of measured shots to what a coach takes to the gym.
    Coach(CoachOptions),
    /// Fit a player's profile to measured shots: releases, landings or tracked flights.
    Fit(FitOptions),
    /// Suggest what to change and what to train, with 95 % intervals.
    Advise(AdviseOptions),
    /// Compare two sessions of one player.
    #[command(alias = "compare-sessions")]
    Compare(CompareOptions),
    /// Estimate how many shots a test needs.
    #[command(alias = "design")]
    SampleSize(SampleSizeOptions),
    /// Draw maps of bank and direct shots.
    Map(MapOptions),
    /// Check a profile or a sweep, and list everything that is wrong with it.
    Check(CheckOptions),
    /// Check how much the result depends on ball, hoop and air.
    Physics(PhysicsOptions),
    /// Estimate time, memory and disk of `best` or `sweep`.
    #[command(hide = true)]
    Plan(PlanOptions),
    /// Compute how often one shot goes in.
    #[command(alias = "probability")]
    Shot(ShotOptions),
    /// Simulate the releases of a CSV or Parquet file.
    #[command(hide = true)]
    Simulate(SimulateOptions),
    /// Find the best shots at every place of a region; run it again to continue.
    Sweep(SweepOptions),
    /// Show the progress of a sweep.
    #[command(hide = true)]
    Status(StatusOptions),
    /// Check every result of a sweep, and compute some of them again.
    #[command(hide = true)]
    Verify(VerifyOptions),
    /// Print the shards of a sweep with missing jobs, in the form of `sbatch --array`.
    #[command(hide = true)]
    Missing(MissingOptions),
    /// Join the shards of a sweep into its tables.
    #[command(hide = true)]
    Merge(MergeOptions),
    /// Write one HTML page of a result, with tables, maps and a view of the shots.
    Report(ReportOptions),
    /// Open a page in the browser: shots, players, the court, launchers.
    #[cfg(feature = "studio")]
    Studio(StudioOptions),
    /// Simulate one shot and list its events.
    Trace(TraceOptions),
    /// Print the JSON schema of profiles and sweeps, for editors of TOML.
    #[command(hide = true)]
    Schema,
    /// Print a completion script for a shell.
    #[command(hide = true)]
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Draw the paper's Figs. 7 to 15.
    #[command(hide = true)]
    Figures {
        /// Folder of the figures.
        #[arg(
            long = "output",
            short = 'o',
            alias = "out",
            value_name = "DIR",
            default_value = "figures"
        )]
        out: PathBuf,
    },
    /// Print the manual page of the program or of a command.
    #[command(hide = true)]
    Man {
        /// The command.
        command: Option<String>,
    },
}

/// The command line, with the commands in groups. With `all` the plumbing is listed too.
pub(crate) fn command(all: bool) -> clap::Command {
    let command = Arguments::command();
    let about = |name: &str| {
        let found = command.find_subcommand(name);
        let about = found.and_then(clap::Command::get_about);
        about.map_or_else(String::new, ToString::to_string)
    };
    let mut listed = String::new();
    let count = if all { GROUPS.len() } else { GROUPS.len() - 1 };
    for (title, names) in &GROUPS[..count] {
        listed += &format!("{title}:\n");
        // Without its feature a command is not there.
        for name in names
            .iter()
            .filter(|name| command.find_subcommand(name).is_some())
        {
            listed += &format!("  {name:<12} {}\n", about(name));
        }
        listed += "\n";
    }
    command.help_template(format!(
        "{{about}}\n\n{{usage-heading}} {{usage}}\n\n{listed}Options:\n{{options}}{{after-help}}"
    ))
}
