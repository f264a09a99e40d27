//! The options of `bankshot design`.

use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::value_parsers::{self, PhysicsArg, UnitsArg};
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
Simulates tests of each size with the tracker's errors, fits them, and says how well the scatter and P come out. The usual \
shot comes from the flags, then from the profile's [nominal] table, else it is the best one; of a fit's folder it is the measured one. It takes a minute or two.

It also says how many shots show that the shooter has changed: of a fit's folder, in a second session against the shots that were fitted; of a profile, in each of two equal sessions, and with --first N in a second one against N shots. With --against OTHER, how many shots show that the two differ: in P, and in each scatter.

Examples:
  bankshot design results/gym-sensor-fit --tracker noah --target 3
  bankshot design configs/free_throw.toml --speed '24.2 ft/s' \\
    --pitch '51 deg' --shots 25,50,100,200 --tracker noah
  bankshot design results/rested --against results/tired")]
pub(crate) struct DesignOptions {
    /// A profile like that of the shooter, or the folder of a fit.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    /// The sizes of the tests.
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_value = "25,50,100,200", value_parser = clap::value_parser!(u32).range(10..=5000))]
    pub(crate) shots: Vec<u32>,
    /// The tracker: lab, noah, optical_25hz, optical_60hz, or a TOML file with its noise as for
    /// `fit` [default: that of the fit, else lab].
    #[arg(long, value_name = "NAME|FILE")]
    pub(crate) tracker: Option<String>,
    /// Of a fit with several places, the number of the place [default: 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) place: Option<u32>,
    /// Shots of a first session with the same tracker: ask what a second one shows against it
    /// [default: those of the fit, as they were measured; of a profile, none].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(10..=5000))]
    pub(crate) first: Option<u32>,
    /// A second profile, or the folder of a second fit, such as the same shooter when tired: ask
    /// how many shots show how the two differ.
    #[arg(long, value_name = "PROFILE|FIT_DIR")]
    pub(crate) against: Option<PathBuf>,
    /// Changes of P that a second session is to show, in points.
    #[arg(long, value_name = "POINTS", value_delimiter = ',', default_value = "5,10,20", value_parser = value_parsers::points)]
    pub(crate) change: Vec<f64>,
    /// Also ask how many shots make P known to this many points: as one standard deviation, and as
    /// a 95 % interval of so many points to each side.
    #[arg(long, value_name = "POINTS", value_parser = value_parsers::points)]
    pub(crate) target: Option<f64>,
    /// Units of the answer [default: those of the profile or the fit].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
    /// Simulated tests of each size.
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = clap::value_parser!(u64).range(4..=10_000))]
    pub(crate) repetitions: u64,
}
