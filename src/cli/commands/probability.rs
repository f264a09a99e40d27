//! `bankshot probability`: P of one nominal shot under up to nine errors.

use super::{probability_along, trace};
use crate::analysis::miss_breakdown::classify_misses;
use crate::cli::config_files::load_profile_with_text;
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::nominal_shot_flags::{NominalOptions, PlaceOptions};
use crate::cli::output_files;
use crate::cli::plot_files::PlotType;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::scatter_flags::ScatterOptions;
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::cli::value_parsers::{PhysicsArg, UnitsArg, sample, standard_error};
use crate::dynamics::Release;
use crate::output::best_shot_text::PROFILE_IS_EXACT;
use crate::output::probability_text_json::{ProbabilityAnswer, answer_json, answer_text};
use crate::probability::{Estimate, MAX_SHOTS, MIN_SHOTS, Sampler, grid_integration, monte_carlo};
use crate::search_space::TablePlan;
use crate::shooter::{Nominal, Profile};
use clap::{Args, ValueEnum};
use std::path::PathBuf;

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
The shot comes from the flags, then from the profile's [nominal] table. The errors are those of \
[shooter.errors]: c10 to c42, and rifle_spin, side_spin, distance, court_angle, height as standard \
deviations; [shooter.correlation] gives their correlations.

Examples:
  bankshot probability configs/free_throw.toml --speed '23.6 ft/s' \\
    --pitch '53.5 deg' --backspin '3 rev/s'
  bankshot probability configs/errors_in_all_nine_variables.toml \\
    --target 0.0003 --json
  bankshot probability configs/errors_in_all_nine_variables.toml --replay 1:2049
  bankshot probability results/season-fit --draws results/season-fit \\
    --vary 'pitch=45 deg to 60 deg by 1 deg' --plot pitch.png")]
pub(crate) struct ProbabilityOptions {
    /// The shooter's profile, or the folder of a fit: its usual shot.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    #[command(flatten)]
    pub(crate) place: PlaceOptions,
    #[command(flatten)]
    pub(crate) scatter: ScatterOptions,
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
    /// The folder of a fit: also say how uncertain P is by what its shots do not tell about the
    /// scatter.
    #[arg(long, value_name = "FIT_DIR", conflicts_with = "scatter")]
    pub(crate) draws: Option<PathBuf>,
    /// Give one variable of the shot several values, the rest as it is: P at each of them. Speed,
    /// pitch, polar, aim, backspin, side_spin or rifle_spin.
    #[arg(long, value_name = "VARIABLE=LIST|RANGE", conflicts_with_all = ["replay", "method", "budget", "grid"])]
    pub(crate) vary: Option<String>,
    /// With --vary: write P at each value into a file (.csv, .json or .txt); may be repeated.
    #[arg(long, short, value_name = "FILE", requires = "vary")]
    pub(crate) output: Vec<PathBuf>,
    /// With --vary: draw P over the variable (.svg or .png).
    #[arg(long, value_name = "FILE", requires = "vary")]
    pub(crate) plot: Option<PathBuf>,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Default values along each axis of the paper's grid.
const PAPER_GRID_VALUES: usize = 40;
/// Default values along each axis of the shifted grids.
const SHIFTED_GRID_VALUES: usize = 20;

/// How precisely P is wanted.
struct Precision {
    target: f64,
    budget: u64,
    seed: u64,
}

pub(crate) fn run(options: &ProbabilityOptions, quiet: bool) -> Result<u8, Failure> {
    let loaded = load_profile_with_text(&options.profile, &options.physics, (&[], quiet))?;
    let (profile, _) = options.scatter.changed(loaded, &options.profile)?;
    let mut profile = options.place.moved(profile)?;
    if let Some(units) = options.units {
        profile = profile.with(|settings| settings.output.units = units.into())?;
    }
    output_files::check(&options.output)?;
    if let Some(path) = &options.plot {
        PlotType::of(path)?;
    }
    let draws = fit_folder::read_draws_of(options.draws.as_deref(), &profile)?;
    if let Some(vary) = &options.vary {
        let fit = draws.as_ref().map(|(_, fit)| fit);
        return probability_along::run(options, (&profile, fit), vary, quiet);
    }
    let nominal = options.nominal.resolve(&profile)?;
    if let Some((seed, index)) = options.replay {
        let release = replayed(options.method, &profile, &nominal, seed, index)?;
        return trace::show(&profile, &release, options.json);
    }
    if !quiet {
        for warning in NominalOptions::warnings(&profile, &nominal) {
            print_remark(&warning);
        }
    }
    let precision = Precision {
        target: options.target.unwrap_or(profile.search().standard_error),
        budget: options.budget.unwrap_or(MAX_SHOTS),
        seed: options.seed.unwrap_or(profile.search().seed),
    };
    let estimate = estimate(options, &profile, &nominal, &precision, quiet)?;
    let draws_samples = matches!(options.method, Method::Sobol | Method::MonteCarlo);
    let answer = ProbabilityAnswer {
        profile: &profile,
        nominal: &nominal,
        method: options.method.name(),
        estimate: &estimate,
        misses: draws_samples
            .then(|| classify_misses(&profile, &nominal, &estimate, precision.seed)),
        seed: precision.seed,
        target: precision.target,
    };
    let of_draws = draws
        .as_ref()
        .map(|(_, fit)| fit_folder::shot_over_draws(fit, &profile, &nominal))
        .transpose()?;
    if options.json {
        let json = answer_json(&answer, of_draws.as_ref());
        print_answer(&format!("{json:#}\n"))?;
    } else {
        let mut text = answer_text(&answer);
        if options.draws.is_none() {
            text += PROFILE_IS_EXACT;
        }
        if let (Some((folder, fit)), Some(p)) = (&draws, &of_draws) {
            text += &fit_folder::text_over_draws((folder, fit), p);
        }
        print_prose(&text)?;
    }
    if estimate.standard_error <= precision.target {
        return Ok(code::DONE);
    }
    if !quiet {
        print_remark(
            "the wanted standard error was not reached; raise --budget, or choose a larger --target",
        );
    }
    Ok(code::IMPRECISE)
}

/// Refuses options that the method does not have.
fn check_method(options: &ProbabilityOptions, profile: &Profile) -> Result<(), Failure> {
    let is_grid = options.method.is_grid();
    if options.grid.is_some() && !is_grid {
        return Err(Failure::usage(
            "--grid: only the methods grid and paper-grid have one",
        ));
    }
    if options.budget.is_some() && is_grid {
        return Err(Failure::usage(
            "--budget: a grid uses all its points; give --grid",
        ));
    }
    if is_grid && !profile.shooter().dispersion.is_of_eq_25() {
        return Err(Failure::usage(format!(
            "--method {}: Eq. 25 has only independent errors of speed, pitch, polar angle and backspin; for others use sobol or monte-carlo",
            options.method.name()
        )));
    }
    Ok(())
}

fn estimate(
    options: &ProbabilityOptions,
    profile: &Profile,
    nominal: &Nominal,
    precision: &Precision,
    quiet: bool,
) -> Result<Estimate, Failure> {
    check_method(options, profile)?;
    let bars = ProgressBars::new(quiet);
    let &Precision {
        target,
        budget,
        seed,
    } = precision;
    Ok(match options.method {
        Method::Sobol => {
            let budget = budget.max(MIN_SHOTS);
            Sampler::new(profile).estimate_within(nominal, target, budget, seed, &bars)
        }
        Method::MonteCarlo => {
            monte_carlo::estimate_within(profile, nominal, target, budget, seed, &bars)
        }
        Method::Grid => {
            let plan = TablePlan::for_search(profile)?;
            let n = options.grid.unwrap_or(SHIFTED_GRID_VALUES);
            grid_integration::shifted_grids(profile, &plan, nominal, n, seed, &bars)
        }
        Method::PaperGrid => {
            let plan = TablePlan::for_search(profile)?;
            let n = options.grid.unwrap_or(PAPER_GRID_VALUES);
            let sum = grid_integration::common_grid(profile, &plan, nominal, n, &bars);
            Estimate {
                probability: sum.probability,
                // The method gives no error.
                standard_error: 0.0,
                shots: sum.shots,
                ..Estimate::default()
            }
        }
    })
}

/// The release of one sample.
fn replayed(
    method: Method,
    profile: &Profile,
    nominal: &Nominal,
    seed: u64,
    index: u64,
) -> Result<Release, Failure> {
    match method {
        Method::Sobol if index >= MAX_SHOTS => Err(Failure::usage(format!(
            "--replay: the index must be below {MAX_SHOTS}"
        ))),
        Method::Sobol => Ok(Sampler::new(profile).sample(nominal, seed, index)),
        Method::MonteCarlo => Ok(monte_carlo::sample(profile, nominal, seed, index)),
        Method::Grid | Method::PaperGrid => Err(Failure::usage(
            "--replay: only sobol and monte-carlo draw samples",
        )),
    }
}
