//! The command line: the commands, and the flags that all of them have. Each command declares its
//! own in its file.

use super::commands::advise::AdviseOptions;
use super::commands::best::BestOptions;
use super::commands::check::CheckOptions;
use super::commands::compare::CompareOptions;
use super::commands::compare_sessions::CompareSessionsOptions;
use super::commands::design::DesignOptions;
use super::commands::fit::FitOptions;
use super::commands::new::NewOptions;
use super::commands::physics::PhysicsOptions;
use super::commands::pitch_curve::PitchCurveOptions;
use super::commands::plan::PlanOptions;
use super::commands::probability::ProbabilityOptions;
use super::commands::report::ReportOptions;
use super::commands::simulate::SimulateOptions;
use super::commands::sweep::{MergeOptions, SweepOptions};
use super::commands::sweep_status::{MissingOptions, StatusOptions, VerifyOptions};
use super::commands::table::TableOptions;
use super::commands::team::TeamOptions;
use super::commands::trace::TraceOptions;
use super::value_parsers::instruction_set;
use crate::dynamics::InstructionSet;
use clap::{Parser, Subcommand};
use std::path::PathBuf;

const EXIT_CODES: &str = "\
Exit codes:
  0   everything is done
  1   done, but the wanted standard error was not reached
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
  bankshot probability configs/errors_in_all_nine_variables.toml
  bankshot plan configs/three_pointer.toml
  bankshot sweep configs/quick_sweep.toml
  bankshot trace configs/free_throw.toml --speed '24.3 ft/s' --pitch '52 deg' \
    --backspin '3 rev/s'
  bankshot simulate releases.csv --output outcomes.csv";

/// How to shoot a basketball, given your own errors: a parallel batch probability engine.
#[derive(Debug, Parser)]
#[command(version, after_help = EXIT_CODES, max_term_width = 80)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
    /// Number of threads, at most 4 for each core [default: one for each]; no result depends on it.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Vector instructions [default: the best of this machine]; no result depends on them.
    #[arg(long, global = true, value_name = "SET", value_parser = instruction_set, hide = true)]
    pub(crate) simd: Option<InstructionSet>,
    /// No progress bar and no remarks on standard error.
    #[arg(long, short, global = true)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Find the best direct and the best bank shot from the profile's location.
    Best(BestOptions),
    /// Find the best shot at each of several pitch angles: how much the angle matters.
    PitchCurve(PitchCurveOptions),
    /// Write a commented file to edit: a player, a launcher, a sweep, or a physics.
    New(NewOptions),
    /// Say who of a team should bank from where, and who is best from where; posters to print.
    Team(TeamOptions),
    /// Make a table of best shots over distances and angles, for a machine.
    Table(TableOptions),
    /// Fit a profile to measured shots: releases, landings of a gym sensor, or tracked
    /// trajectories.
    Fit(FitOptions),
    /// Say what a measured shooter should change and train, and how sure that is.
    Advise(AdviseOptions),
    /// Say what changed between two sessions of a shooter.
    CompareSessions(CompareSessionsOptions),
    /// Say what a shooting test of some size will tell.
    Design(DesignOptions),
    /// Draw maps of bank and direct shots: over the court of a sweep, or over speed and pitch at
    /// one location.
    Compare(CompareOptions),
    /// Check a profile or a sweep and list everything that is wrong with it.
    Check(CheckOptions),
    /// Compare the best shots under the presets of physics and under single changes of it.
    Physics(PhysicsOptions),
    /// Say what `best` or `sweep` would simulate, how long it takes and how much memory it needs.
    /// For a profile, also check that the search range misses no makes.
    Plan(PlanOptions),
    /// Compute the probability of making one nominal shot, under up to nine errors.
    Probability(ProbabilityOptions),
    /// Simulate the releases of a CSV or Parquet file.
    Simulate(SimulateOptions),
    /// Find the best shots at every place of a region; run the same command again to continue.
    Sweep(SweepOptions),
    /// Show the progress of a sweep.
    Status(StatusOptions),
    /// Check every result of a sweep, and compute some of them again.
    Verify(VerifyOptions),
    /// Print the shards of a sweep with missing jobs, in the form of `sbatch --array`.
    Missing(MissingOptions),
    /// Join the shards of a sweep into its tables.
    Merge(MergeOptions),
    /// Write one HTML page of a run: the answer, tables, maps, and the shots in a view that you can
    /// turn.
    Report(ReportOptions),
    /// Simulate one shot and list its events.
    Trace(TraceOptions),
    /// Print the JSON schema of profiles and sweeps, for editors of TOML.
    Schema,
    /// Print a completion script for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Draw the paper's Figs. 7 to 15.
    Figures {
        /// Folder of the figures.
        #[arg(long, value_name = "DIR", default_value = "figures")]
        out: PathBuf,
    },
    /// Print the manual page of the program or of a command.
    Man {
        /// The command.
        command: Option<String>,
    },
}
