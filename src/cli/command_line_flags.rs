//! The command line: commands and their options.

use super::commands::advise::AdviseOptions;
use super::commands::compare_sessions::CompareSessionsOptions;
use super::commands::design::DesignOptions;
use super::commands::fit::FitOptions;
use super::nominal_shot_flags::NominalOptions;
use super::value_parsers::{
    PhysicsArg, UnitsArg, fault_injection, fraction, instruction_set, sample, shard, standard_error,
};
use bankshot::dynamics::InstructionSet;
use bankshot::sweep::job_list::Shard;
use bankshot::sweep::run::FaultInjection;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

const EXIT_CODES: &str = "\
Exit codes:
  0   everything is done
  1   done, but the wanted standard error was not reached
  2   usage or configuration refused; nothing was written
  3   incomplete: some rows or jobs are missing or failed, the others are done
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
  bankshot trace configs/free_throw.toml --speed '23.5 ft/s' --pitch '52 deg'
  bankshot simulate releases.csv --output outcomes.csv";

/// How to shoot a basketball, given your own errors: a parallel batch probability engine.
#[derive(Debug, Parser)]
#[command(version, about, after_help = EXIT_CODES)]
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
    /// Fit a profile to measured shots: releases, landings of a gym sensor, or tracked trajectories.
    Fit(FitOptions),
    /// Say what a measured shooter should change and train, and how sure that is.
    Advise(AdviseOptions),
    /// Say what changed between two sessions of a shooter.
    CompareSessions(CompareSessionsOptions),
    /// Say what a shooting test of some size will tell.
    Design(DesignOptions),
    /// Draw maps of bank and direct shots: over the court of a sweep, or over speed and pitch at one location.
    Compare(CompareOptions),
    /// Check a profile or a sweep and list everything that is wrong with it.
    Check(CheckOptions),
    /// Compare the best shots under the presets of physics and under single changes of it.
    Physics(PhysicsOptions),
    /// Say what `best` or `sweep` would simulate, how long it takes and how much memory it needs. For a profile,
    /// also check that the search range misses no makes.
    Plan(PlanOptions),
    /// Compute the probability of making one nominal shot, under up to nine errors.
    Probability(ProbabilityOptions),
    /// Simulate the releases of a CSV or Parquet file.
    Simulate(SimulateOptions),
    /// Find the best shots at every place of a region; run the same command again to continue.
    Sweep(SweepOptions),
    /// Show the progress of a sweep.
    Status(FolderOptions),
    /// Check every result of a sweep, and compute some of them again.
    Verify(VerifyOptions),
    /// Print the shards of a sweep with missing jobs, in the form of `sbatch --array`.
    Missing(MissingOptions),
    /// Join the shards of a sweep into its tables.
    Merge(MergeOptions),
    /// Write one HTML page of a run: the answer, tables, maps, and the shots in a view that you can turn.
    Report(FolderOptions),
    /// Simulate one shot and list its events.
    Trace(TraceOptions),
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

#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  bankshot best configs/free_throw.toml
  bankshot best configs/free_throw.toml --json --quiet | python3 -m json.tool
  bankshot best configs/bank_wing.toml --units metric --out /tmp/runs

Writes OUT/<name>-<hash>/ with best_shots.csv, best_shots.json, curves.csv (P along each variable of the
best shots), sensitivity.csv, profile.toml, plan.json and provenance.json.")]
pub(crate) struct BestOptions {
    /// The shooter's profile.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// Folder in which the folder of the run is made [default: the profile's, else results].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// The folder of a fit: also say how uncertain P is by what its shots do not tell about the scatter.
    #[arg(long, value_name = "FIT_DIR", conflicts_with = "json")]
    pub(crate) draws: Option<PathBuf>,
    /// Print one JSON object instead of the table.
    #[arg(long)]
    pub(crate) json: bool,
    /// Units of the results [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
}

#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// The shooter's profile, or a sweep.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// List every value of the physics, and whether it is measured, from a rule book or assumed.
    #[arg(long)]
    pub(crate) verbose: bool,
}

#[derive(Args, Debug)]
pub(crate) struct PhysicsOptions {
    /// The shooter's profile.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// Draw P under each physics (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Print one JSON array (SI units).
    #[arg(long)]
    pub(crate) json: bool,
    /// Units of the output [default: the profile's].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
}

#[derive(Args, Debug)]
pub(crate) struct PlanOptions {
    /// The shooter's profile, or a sweep.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
    /// Shots that check the search range; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 200_000)]
    pub(crate) wide_sample: u64,
}

/// The methods of computing P.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// Scrambled Sobol points.
    Sobol,
    /// Plain random samples.
    MonteCarlo,
    /// Eq. 25 on four grids shifted from line to line (four errors only).
    Grid,
    /// Eq. 25 as printed in the paper, on one common grid (four errors only).
    PaperGrid,
}

impl Method {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Sobol => "sobol",
            Self::MonteCarlo => "monte-carlo",
            Self::Grid => "grid",
            Self::PaperGrid => "paper-grid",
        }
    }

    pub(crate) fn is_grid(self) -> bool {
        matches!(self, Self::Grid | Self::PaperGrid)
    }
}

#[derive(Args, Debug)]
#[command(after_help = "\
The shot comes from the flags, then from the profile's [nominal] table. The errors are those of
[shooter.errors]: c10 to c42, and rifle_spin, side_spin, distance, court_angle, height as standard
deviations; [shooter.correlation] gives their correlations.

Examples:
  bankshot probability configs/free_throw.toml --speed '23.6 ft/s' --pitch '53.5 deg' --backspin '3 rev/s'
  bankshot probability configs/errors_in_all_nine_variables.toml --target 0.0003 --json
  bankshot probability configs/errors_in_all_nine_variables.toml --replay 1:2049")]
pub(crate) struct ProbabilityOptions {
    /// The shooter's profile.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    /// The method of computing P.
    #[arg(long, value_enum, default_value_t = Method::Sobol)]
    pub(crate) method: Method,
    /// Standard error at which to stop [default: the profile's standard_error, else 0.001].
    #[arg(long, value_name = "P", value_parser = standard_error)]
    pub(crate) target: Option<f64>,
    /// Greatest number of shots, 64 or more.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(64..=1_000_000_000_000))]
    pub(crate) budget: Option<u64>,
    /// Values along each axis of a grid [default: 20 for grid, 40 for paper-grid].
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=400))]
    pub(crate) grid: Option<usize>,
    /// Seed of the samples [default: the profile's].
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// Trace sample number INDEX of a seed instead.
    #[arg(long, value_name = "SEED:INDEX", value_parser = sample)]
    pub(crate) replay: Option<(u64, u64)>,
    /// Units of the answer [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
    /// The folder of a fit: also say how uncertain P is by what its shots do not tell about the scatter.
    #[arg(long, value_name = "FIT_DIR", conflicts_with = "json")]
    pub(crate) draws: Option<PathBuf>,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
#[command(after_help = "\
The folder has store/*.sqlite (every result as it is computed; query it while the sweep runs) and, at the
end, best_shots.csv, best_shots.parquet and provenance.json. The same command again computes only what is
missing.

Examples:
  bankshot plan configs/half_court.toml
  bankshot sweep configs/half_court.toml --out half_court
  bankshot sweep configs/half_court.toml --out /shared/half_court --shard 3/64")]
pub(crate) struct SweepOptions {
    /// The sweep: a [sweep] table and a shooter.
    pub(crate) sweep: PathBuf,
    /// Folder of the sweep [default: one named after it, in its output folder, else in results].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Only shard I of N; all shards can share the folder and run on any machine.
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(crate) shard: Option<Shard>,
    /// Compute failed jobs again.
    #[arg(long)]
    pub(crate) retry_failed: bool,
    /// Inject a fault, for tests: panic:SPOT, abort:SPOT or wait:SPOT:FILE.
    #[arg(long, hide = true, value_parser = fault_injection)]
    pub(crate) fault: Option<FaultInjection>,
}

#[derive(Args, Debug)]
#[command(after_help = "\
For a sweep: P of the best direct and bank shots over the court and their difference; maps of the best P, kind,
pitch angle and spin; and, if they were computed, the gain from spin and the costliest error.
For a profile: outcomes and P over speed and pitch angle about the best direct and bank shots, and their
difference.
Each map is written as SVG and PNG.

Examples:
  bankshot compare half_court
  bankshot compare half_court --against half_court_elite
  bankshot compare configs/bank_wing.toml --out plots")]
pub(crate) struct CompareOptions {
    /// A sweep's folder, its TOML (for its usual folder), or a shooter's profile.
    pub(crate) what: PathBuf,
    /// Another one of the same type, with another shooter or other settings.
    #[arg(long, value_name = "OTHER")]
    pub(crate) against: Option<PathBuf>,
    /// Folder of the plots [default: plots in the folder of the run].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Args, Debug)]
pub(crate) struct FolderOptions {
    /// The folder.
    pub(crate) folder: PathBuf,
}

#[derive(Args, Debug)]
pub(crate) struct VerifyOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Compute this fraction of the jobs again, such as 1%, and compare every bit.
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub(crate) recompute: Option<f64>,
}

#[derive(Args, Debug)]
pub(crate) struct MissingOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Number of shards of the sweep.
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1_000_000))]
    pub(crate) shards: usize,
}

#[derive(Args, Debug)]
pub(crate) struct MergeOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Number of shards of the sweep, to print which to submit again.
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1_000_000))]
    pub(crate) shards: Option<usize>,
}

/// The integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntegratorName {
    /// Closed-form flight, and contacts in steps that end on the events of friction.
    Exact,
    /// The paper's variable-step Runge-Kutta method at the paper's steps.
    Paper,
}

#[derive(Args, Debug)]
#[command(after_help = "\
Columns, by name and in any order: distance_ft, court_angle_deg, release_height_ft, speed_ft_s,
pitch_deg, polar_deg; optional backspin_rev_s, rifle_spin_rev_s, side_spin_rev_s. The suffixes _m,
_m_s, _rad and _rad_s are accepted instead. Other columns are copied. One that is named like a
quantity needs --carry, so that no misspelt column is overlooked. The columns made, kind, contacts,
n_board, n_ring, flight_time_s (to the end of the shot, bounces included), entry_angle_deg and
first_touch_s are added. A row that cannot be simulated is reported with its line and has empty
results; the exit code is then 3. Files named *.parquet are Parquet, others CSV.

Examples:
  bankshot simulate releases.csv --output outcomes.csv
  bankshot simulate - --output - --integrator paper <releases.csv >outcomes.csv")]
pub(crate) struct SimulateOptions {
    /// The releases, a CSV or Parquet file; - for CSV from standard input.
    pub(crate) releases: PathBuf,
    /// The file of outcomes, CSV or Parquet; - for CSV to standard output.
    #[arg(long, short, value_name = "OUT.csv|OUT.parquet")]
    pub(crate) output: PathBuf,
    /// Copy columns that are named like a quantity but are none of the release.
    #[arg(long, value_name = "COLUMN,...", value_delimiter = ',')]
    pub(crate) carry: Vec<String>,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// The integrator [default: exact, or the file's].
    #[arg(long)]
    pub(crate) integrator: Option<IntegratorName>,
}

#[derive(Args, Debug)]
#[command(after_help = "\
Every quantity carries its unit.

Examples:
  bankshot trace configs/free_throw.toml --speed '23.5 ft/s' --pitch '52 deg' --backspin '3 rev/s'
  bankshot trace configs/free_throw.toml --speed '23.6 ft/s' --pitch '53.5 deg' --backspin '3 rev/s' --plot shot.png --swarm 60
  bankshot trace configs/bank_wing.toml --speed '7.4 m/s' --pitch '52 deg' --polar '40 deg' --output shot.csv")]
pub(crate) struct TraceOptions {
    /// The shooter's profile (for location, height and physics).
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    /// Write the trajectory as CSV; - for standard output (then nothing else is printed there).
    #[arg(long, short, value_name = "T.csv")]
    pub(crate) output: Option<PathBuf>,
    /// Draw the shot from the side, from above and facing the board.
    #[arg(long, value_name = "T.svg|T.png")]
    pub(crate) plot: Option<PathBuf>,
    /// Draw this many more shots with the shooter's errors.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "plot", value_parser = clap::value_parser!(u32).range(0..=5000))]
    pub(crate) swarm: u32,
    /// Units of the answer [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}
