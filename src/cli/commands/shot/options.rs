//! The options of `bankshot shot`.

use crate::answers::probability::{Effort, Method};
use crate::answers::rebounds::reach;
use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::profile_flags::ProfileOptions;
use crate::cli::scatter_flags::ScatterOptions;
use crate::cli::value_parsers::{sample, standard_error};
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
The shot comes from the flags, then from the profile's [nominal] table. The scatter comes from [shooter.errors] and [shooter.correlation].

Examples:
  bankshot shot configs/free_throw.toml --speed '24.4 ft/s' \\
    --pitch '53.5 deg' --backspin '3 rev/s'
  bankshot shot configs/errors_in_all_nine_variables.toml \\
    --standard-error 0.0003 --json
  bankshot shot configs/errors_in_all_nine_variables.toml --replay 1:2049
  bankshot shot results/season-fit --draws results/season-fit \\
    --vary 'pitch=45 deg to 60 deg by 1 deg' --plot pitch.png")]
pub(crate) struct ShotOptions {
    #[command(flatten)]
    pub(crate) profile: ProfileOptions,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    #[command(flatten)]
    pub(crate) scatter: ScatterOptions,
    /// The method of integration.
    #[arg(long, value_enum, default_value_t = Method::Sobol)]
    pub(crate) method: Method,
    /// Standard error at which to stop [default: the profile's standard_error, else 0.001].
    #[arg(long, alias = "target", value_name = "PROBABILITY", value_parser = standard_error)]
    pub(crate) standard_error: Option<f64>,
    /// Stop after this many shots (at least 64).
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(64..=1_000_000_000_000))]
    pub(crate) budget: Option<u64>,
    /// Values along each axis of a grid [default: 20 for grid, 40 for paper-grid].
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(2..=400))]
    pub(crate) grid: Option<usize>,
    /// The height at which a rebound is within reach, for --details, --json and --rebounds
    /// [default: 8 ft].
    #[arg(long, value_name = "LENGTH", value_parser = reach)]
    pub(crate) reach: Option<f64>,
    /// Draw where the misses come down (.svg or .png).
    #[arg(long, value_name = "FILE", conflicts_with_all = ["vary", "replay"])]
    pub(crate) rebounds: Option<PathBuf>,
    /// Seed of the samples [default: the profile's].
    #[arg(long)]
    pub(crate) seed: Option<u64>,
    /// Trace one simulated shot, by its seed and number, instead of counting makes.
    #[arg(long, value_name = "SEED:INDEX", value_parser = sample)]
    pub(crate) replay: Option<(u64, u64)>,
    /// Folder of a fit: adds its uncertainty to the answer [default: the fit that wrote the
    /// profile].
    #[arg(long, value_name = "FIT_DIR", conflicts_with = "scatter")]
    pub(crate) draws: Option<PathBuf>,
    /// Try several settings of one quantity: speed, pitch, polar, aim, backspin,
    /// side_spin or rifle_spin.
    #[arg(long, value_name = "VARIABLE=LIST|RANGE", conflicts_with_all = ["replay", "method", "budget", "grid"])]
    pub(crate) vary: Option<String>,
    /// With --vary: write the results into a file (.csv, .json or .txt); may be repeated.
    #[arg(long, short, value_name = "FILE", requires = "vary")]
    pub(crate) output: Vec<PathBuf>,
    /// With --vary: draw the results (.svg or .png).
    #[arg(long, value_name = "FILE", requires = "vary")]
    pub(crate) plot: Option<PathBuf>,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}

impl ShotOptions {
    pub(super) fn effort(&self) -> Effort {
        Effort {
            method: self.method,
            target: self.standard_error,
            budget: self.budget,
            seed: self.seed,
            grid: self.grid,
        }
    }
}
