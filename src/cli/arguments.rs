//! What can be asked of the program.

use super::nominal::NominalOptions;
use bankshot::sweep::jobs::Shard;
use bankshot::sweep::run::Fault;
use bankshot::units::System;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::path::PathBuf;

const EXIT_CODES: &str = "\
Exit codes:
  0   everything asked for is there
  1   ran, but missed the standard error asked for
  2   usage or configuration refused; nothing was written
  3   incomplete: some rows or jobs are missing or failed, the others are done
  4   data damaged, foreign or contradictory
  70  a bug
  74  input or output failed
  75  stopped, or the folder is in use by another run; run again
  130 stopped by Ctrl-C; no file is left half written

Examples:
  bankshot best configs/free_throw.toml
  bankshot probability configs/nine_errors.toml
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
    /// Threads to use [default: all]; the results do not depend on it.
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// No progress bar and no remarks.
    #[arg(long, short, global = true)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Find the best direct and the best bank shot from the profile's place.
    Best(BestOptions),
    /// Draw bank and direct against each other: over the court of a sweep, or in release space at one place.
    Compare(CompareOptions),
    /// Check a profile and say what is wrong with it, all faults at once.
    Check(CheckOptions),
    /// Say what `best` or `sweep` would simulate, how long it takes and how much memory it needs, and show
    /// that the bracket loses nothing.
    Plan(PlanOptions),
    /// Integrate the probability of making one nominal shot, under any of nine errors.
    Probability(ProbabilityOptions),
    /// Simulate the releases of a CSV file.
    Simulate(SimulateOptions),
    /// Find the best shots at every place of a region; run again, it goes on where it stopped.
    Sweep(SweepOptions),
    /// Say how far a sweep has come.
    Status(FolderOptions),
    /// Check every result of a sweep, and compute a part of them again.
    Verify(VerifyOptions),
    /// Print the shards of a sweep with missing jobs, as `sbatch --array` takes them.
    Missing(MissingOptions),
    /// Join the shards of a sweep into its tables.
    Merge(MergeOptions),
    /// Write one HTML page of the folder of a run: the answer, tables, maps, and the shots in a view that turns.
    Report(FolderOptions),
    /// Follow one shot and say what happens.
    Trace(TraceOptions),
    /// Print a completion script for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Draw the paper's Figs. 7 to 15 again.
    Figures {
        /// Folder of the pictures.
        #[arg(long, value_name = "DIR", default_value = "figures")]
        out: PathBuf,
    },
    /// Print the manual page.
    Man,
}

#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  bankshot best configs/free_throw.toml
  bankshot best configs/free_throw.toml --json --quiet | python3 -m json.tool
  bankshot best configs/bank_wing.toml --units metric --out /tmp/runs

Writes OUT/<name>-<hash>/ with best_shots.csv, best_shots.json, curves.csv (P along each part of the
best shots), lessons.csv, profile.toml, plan.json and provenance.json.")]
pub(crate) struct BestOptions {
    /// The shooter's profile.
    pub(crate) profile: PathBuf,
    /// Folder in which the run's folder is made [default: the profile's, else results].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON object instead of the table.
    #[arg(long)]
    pub(crate) json: bool,
    /// Units of the results [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<System>,
}

#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// The shooter's profile, or a sweep.
    pub(crate) profile: PathBuf,
}

#[derive(Args, Debug)]
pub(crate) struct PlanOptions {
    /// The shooter's profile, or a sweep.
    pub(crate) profile: PathBuf,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
    /// Shots drawn to check the bracket; 0 for none.
    #[arg(long, value_name = "N", default_value_t = 200_000)]
    pub(crate) wide_sample: u64,
}

/// The ways to integrate P.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// Scrambled Sobol points drawn from the normal.
    Sobol,
    /// Plain random samples.
    MonteCarlo,
    /// Eq. 25 on four grids shifted from line to line (four errors only).
    Grid,
    /// Eq. 25 to the letter, on one common grid (four errors only).
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

fn standard_error(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if (1e-6..=0.5).contains(&value) => Ok(value),
        _ => Err("must be a number from 0.000001 to 0.5".to_owned()),
    }
}

fn sample(text: &str) -> Result<(u64, u64), String> {
    let parts = text.split_once(':');
    parts
        .and_then(|(seed, index)| Some((seed.parse().ok()?, index.parse().ok()?)))
        .ok_or_else(|| "must be two whole numbers, such as 1:2049".to_owned())
}

#[derive(Args, Debug)]
#[command(after_help = "\
The shot is the profile's [nominal] table, with the flags before it. The errors are those of
[shooter.errors]: c10 to c42, and rifle_spin, side_spin, distance, court_angle, height as standard
deviations; [shooter.correlation] says how they go together.

Examples:
  bankshot probability configs/free_throw.toml --speed '23.6 ft/s' --pitch '53.5 deg' --backspin '3 rev/s'
  bankshot probability configs/nine_errors.toml --target 0.0003 --json
  bankshot probability configs/nine_errors.toml --replay 1:2049")]
pub(crate) struct ProbabilityOptions {
    /// The shooter's profile.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    /// How P is integrated.
    #[arg(long, value_enum, default_value_t = Method::Sobol)]
    pub(crate) method: Method,
    /// Standard error at which to stop [default: the profile's standard_error, else 0.001].
    #[arg(long, value_name = "P", value_parser = standard_error)]
    pub(crate) target: Option<f64>,
    /// Shots at most, 64 or more.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(64..=1_000_000_000_000))]
    pub(crate) budget: Option<u64>,
    /// Values along each axis of a grid [default: 20 shifted, 40 to the letter].
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=400))]
    pub(crate) grid: Option<usize>,
    /// Seed of the samples [default: the profile's].
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// Traces the shot behind sample number INDEX of a seed instead.
    #[arg(long, value_name = "SEED:INDEX", value_parser = sample)]
    pub(crate) replay: Option<(u64, u64)>,
    /// Units of the answer [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<System>,
    /// Print one JSON object instead of words.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
#[command(after_help = "\
The folder holds store/*.sqlite (every result as it comes; query it while it runs) and, once whole,
best_shots.csv, best_shots.parquet and provenance.json. Run again with the same configuration, it
computes only what is missing.

Examples:
  bankshot plan configs/half_court.toml
  bankshot sweep configs/half_court.toml --out half_court
  bankshot sweep configs/half_court.toml --out /shared/half_court --shard 3/64")]
pub(crate) struct SweepOptions {
    /// The sweep: a [sweep] table and a shooter.
    pub(crate) sweep: PathBuf,
    /// Folder of the sweep [default: one named after it, under the configuration's folder or results].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Only part I of N; all parts may share the folder, and run on any machine.
    #[arg(long, value_name = "I/N", value_parser = super::sweep::shard)]
    pub(crate) shard: Option<Shard>,
    /// Compute the jobs that failed again.
    #[arg(long)]
    pub(crate) retry_failed: bool,
    /// Fails on purpose, for tests.
    #[arg(long, hide = true, value_parser = super::sweep::fault)]
    pub(crate) fault: Option<Fault>,
}

#[derive(Args, Debug)]
#[command(after_help = "\
Of a sweep: P of the best direct and bank shots over the court with their difference, and maps of the best
P, kind, pitch angle and spin, of what spin is worth and which error costs most where they were computed.
Of a profile: how shots end and P, over speed and pitch angle about the best direct and bank shots, and their
difference.
Each is written as SVG and PNG.

Examples:
  bankshot compare half_court
  bankshot compare half_court --against half_court_elite
  bankshot compare configs/bank_wing.toml --out pictures")]
pub(crate) struct CompareOptions {
    /// A sweep's folder, its TOML (for its usual folder), or a shooter's profile.
    pub(crate) what: PathBuf,
    /// Another one of the same sort: another shooter, or other settings.
    #[arg(long, value_name = "OTHER")]
    pub(crate) against: Option<PathBuf>,
    /// Folder of the pictures [default: pictures in the folder of the run].
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
    /// Computes this part of the jobs again and compares every bit, such as 1%.
    #[arg(long, value_name = "PART", value_parser = super::sweep::part)]
    pub(crate) recompute: Option<f64>,
}

#[derive(Args, Debug)]
pub(crate) struct MissingOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Into how many shards the sweep is divided.
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1_000_000))]
    pub(crate) shards: usize,
}

#[derive(Args, Debug)]
pub(crate) struct MergeOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Into how many shards it was divided, to say which to submit again.
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1_000_000))]
    pub(crate) shards: Option<usize>,
}

/// The integrators by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum IntegratorName {
    /// Closed-form flight, contacts in steps that end on the events of friction.
    Exact,
    /// The paper's variable-step Runge-Kutta method at the paper's steps.
    Paper,
}

#[derive(Args, Debug)]
#[command(after_help = "\
Columns, by name and in any order: distance_ft, court_angle_deg, release_height_ft, speed_ft_s,
pitch_deg, polar_deg; optional backspin_rev_s, rifle_spin_rev_s, side_spin_rev_s. The suffixes _m,
_m_s, _rad and _rad_s are accepted in their place. Other columns are carried through. Added are
made, kind, contacts, n_board, n_ring, flight_time_s and entry_angle_deg. A row that cannot be
simulated is named, keeps its place with empty results, and makes the exit code 3.

Examples:
  bankshot simulate releases.csv --output outcomes.csv
  bankshot simulate - --output - --integrator paper <releases.csv >outcomes.csv")]
pub(crate) struct SimulateOptions {
    /// The releases, a CSV file; - for standard input.
    pub(crate) releases: PathBuf,
    /// Where the outcomes go; - for standard output.
    #[arg(long, short, value_name = "OUT.csv")]
    pub(crate) output: PathBuf,
    /// The preset `paper`, or a TOML file with a [physics] table.
    #[arg(long, default_value = "paper", value_name = "PRESET|FILE")]
    pub(crate) physics: String,
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
    /// The shooter's profile (for the place, the height and the physics).
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    /// Writes the trajectory as CSV; - for standard output (then nothing else is printed there).
    #[arg(long, short, value_name = "T.csv")]
    pub(crate) output: Option<PathBuf>,
    /// Draws the shot from the side, from above and facing the board.
    #[arg(long, value_name = "T.svg|T.png")]
    pub(crate) plot: Option<PathBuf>,
    /// Draws this many more shots with the shooter's errors, made and missed ones.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "plot", value_parser = clap::value_parser!(u32).range(0..=5000))]
    pub(crate) swarm: u32,
    /// Units of the answer [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<System>,
    /// Print one JSON object instead of words.
    #[arg(long)]
    pub(crate) json: bool,
}
