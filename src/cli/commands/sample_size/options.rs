//! The options of `bankshot sample-size`.

use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::value_parsers::{self, PhysicsArg, UnitsArg};
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
Simulates sessions of each size with the tracker's noise, fits them, and prints how precise the results are. The flags set the shot. Without them it is the one in the profile's [nominal] table, or else the best shot; for a fit's folder it is the measured shot. This takes a minute or two.

The answer also says how many shots are needed to show a change: in a second session after the fitted shots (for a fit's folder), or in each of two equal sessions (for a profile). --first N compares with a first session of N shots, --against OTHER with another player or day.

Examples:
  bankshot sample-size results/gym-sensor-fit --tracker noah --target 3
  bankshot sample-size configs/free_throw.toml --speed '24.2 ft/s' \\
    --pitch '51 deg' --shots 25,50,100,200 --tracker noah
  bankshot sample-size results/rested --against results/tired")]
pub(crate) struct SampleSizeOptions {
    /// The player's profile, or the folder of a fit.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    /// Sizes of the simulated sessions, in shots.
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_value = "25,50,100,200", value_parser = clap::value_parser!(u32).range(10..=5000))]
    pub(crate) shots: Vec<u32>,
    /// The tracker: lab, noah, optical_25hz, optical_60hz, or a TOML file with its noise as for
    /// `fit` [default: that of the fit, else lab].
    #[arg(long, value_name = "NAME|FILE")]
    pub(crate) tracker: Option<String>,
    /// The number of the place, for a fit with several places [default: 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) place: Option<u32>,
    /// Shots already measured with the same tracker in a first session, which a second one is
    /// compared with [default: those of the fit; none for a profile].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(10..=5000))]
    pub(crate) first: Option<u32>,
    /// A second profile or the folder of a second fit (such as the same player when tired): also
    /// print how many shots are needed to show the difference.
    #[arg(long, value_name = "PROFILE|FIT_DIR")]
    pub(crate) against: Option<PathBuf>,
    /// Changes in makes per 100 that a second session should show.
    #[arg(long, value_name = "PER_100", value_delimiter = ',', default_value = "5,10,20", value_parser = value_parsers::points)]
    pub(crate) change: Vec<f64>,
    /// Also print how many shots are needed to know the makes per 100 to within this (95 %
    /// interval, plus or minus).
    #[arg(long, value_name = "PER_100", value_parser = value_parsers::points)]
    pub(crate) target: Option<f64>,
    /// Units of the answer [default: those of the profile or the fit].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
    /// Simulated tests of each size, best a multiple of 12; of fewer than 20 shots four times
    /// as many.
    #[arg(long, value_name = "N", default_value_t = 12, value_parser = clap::value_parser!(u64).range(4..=10_000))]
    pub(crate) repetitions: u64,
}
