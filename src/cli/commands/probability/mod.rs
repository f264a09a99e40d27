//! `bankshot probability`: P of one nominal shot under up to nine errors.

mod along_variable;
mod options;

use super::trace;
use crate::analysis::miss_breakdown::classify_misses;
use crate::answers::json;
use crate::answers::probability::{Computed, ProbabilityAnswer};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::output_files;
use crate::cli::plot_files::PlotType;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{is_quiet, print_answer, print_hint, print_prose, print_remark};
use crate::dynamics::Release;
use crate::present::best_shot_text::PROFILE_IS_EXACT;
use crate::present::probability_text::answer_text;
use crate::probability::{Estimate, MAX_SHOTS, MIN_SHOTS, Sampler, grid_integration, monte_carlo};
use crate::search_space::TablePlan;
use crate::shooter::{Nominal, Profile};

pub(crate) use options::{Method, ProbabilityOptions};

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

pub(crate) fn run(options: &ProbabilityOptions) -> Result<u8, Failure> {
    let loaded = options.profile.load(&[])?;
    let profile = options.scatter.changed(loaded)?.profile;
    output_files::check(&options.output)?;
    if let Some(path) = &options.plot {
        PlotType::of(path)?;
    }
    let draws = fit_folder::read_draws_of(options.draws.as_deref(), &profile)?;
    if let Some(vary) = &options.vary {
        let fit = draws.as_ref().map(|(_, fit)| fit);
        return along_variable::run(options, (&profile, fit), vary);
    }
    let nominal = options.nominal.resolve(&profile)?;
    if let Some((seed, index)) = options.replay {
        let release = replayed(options.method, &profile, &nominal, seed, index)?;
        return trace::show(&profile, &release, options.json);
    }
    if !is_quiet() {
        let of_flags = options.nominal.warnings_of_flags(&profile, &nominal);
        let of_shot = NominalOptions::warnings(&profile, &nominal);
        for warning in of_flags.iter().chain(&of_shot) {
            print_remark(warning);
        }
    }
    let precision = Precision {
        target: options.target.unwrap_or(profile.search().standard_error),
        budget: options.budget.unwrap_or(MAX_SHOTS),
        seed: options.seed.unwrap_or(profile.search().seed),
    };
    let estimate = estimate(options, &profile, &nominal, &precision)?;
    let draws_samples = matches!(options.method, Method::Sobol | Method::MonteCarlo);
    let computed = Computed {
        method: options.method.name(),
        estimate: &estimate,
        has_error: options.method != Method::PaperGrid,
        misses: draws_samples
            .then(|| classify_misses(&profile, &nominal, &estimate, precision.seed)),
        seed: precision.seed,
        target: precision.target,
    };
    let of_draws = draws
        .as_ref()
        .map(|(_, fit)| fit_folder::shot_over_draws(fit, &profile, &nominal))
        .transpose()?;
    let answer = ProbabilityAnswer::new(&profile, &nominal, &computed, of_draws.as_ref());
    let units = profile.output().units;
    if options.json {
        print_answer(&json::text(&json::in_units(&answer, units)))?;
    } else {
        let mut text = answer_text(&answer, units);
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
    print_hint(
        "the wanted standard error was not reached; raise --budget, or choose a larger --target",
    );
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
) -> Result<Estimate, Failure> {
    check_method(options, profile)?;
    let bars = ProgressBars::new();
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
