//! `bankshot probability`: P of one nominal shot under any of the nine errors.

use super::arguments::{Method, ProbabilityOptions};
use super::failure::{Failure, code};
use super::plan::load;
use super::progress::Bars;
use super::terminal::{answer, tell};
use super::trace;
use bankshot::dynamics::{Release, Simulator};
use bankshot::output::probability::{self, Answer};
use bankshot::plan::Plan;
use bankshot::probability::estimate::{Estimate, LEAST_SHOTS, MOST_SHOTS, Sampler};
use bankshot::probability::{grid, misses, monte_carlo};
use bankshot::profile::{Nominal, Profile};

/// Values along each axis of the paper's grid, and of the shifted grids.
const LETTER: usize = 40;
const SHIFTED: usize = 20;

pub(crate) fn run(options: &ProbabilityOptions, quiet: bool) -> Result<u8, Failure> {
    let mut profile = load(&options.profile)?;
    profile.output.units = options.units.unwrap_or(profile.output.units);
    let nominal = options.nominal.resolve(&profile)?;
    let simulator =
        Simulator::with_integrator(&profile.physics, profile.integrator).map_err(Failure::usage)?;
    if let Some((seed, index)) = options.replay {
        let release = replayed(options.method, &profile, &simulator, &nominal, seed, index)?;
        return trace::show(&simulator, &release, profile.output.units, options.json);
    }
    let seed = options.seed.unwrap_or(profile.search.seed);
    let target = options.target.unwrap_or(profile.search.standard_error);
    let budget = options.budget.unwrap_or(MOST_SHOTS);
    let estimate = integrate(
        options,
        &profile,
        &simulator,
        &nominal,
        (target, budget, seed),
        quiet,
    )?;
    let sorts = matches!(options.method, Method::Sobol | Method::MonteCarlo);
    let answered = Answer {
        profile: &profile,
        nominal: &nominal,
        method: options.method.name(),
        estimate: &estimate,
        misses: sorts.then(|| misses::sort(&profile, &simulator, &nominal, &estimate, seed)),
        seed,
        target,
    };
    answer(&if options.json {
        format!("{:#}\n", probability::json(&answered))
    } else {
        probability::words(&answered)
    })?;
    let missed = estimate.standard_error > target;
    if missed && !quiet {
        tell("the standard error asked for was not reached; raise --budget, or ask for less");
    }
    Ok(if missed { code::MISSED } else { code::WHOLE })
}

fn integrate(
    options: &ProbabilityOptions,
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    (target, budget, seed): (f64, u64, u64),
    quiet: bool,
) -> Result<Estimate, Failure> {
    let bars = Bars::new(quiet);
    if options.grid.is_some() && !options.method.is_grid() {
        return Err(Failure::usage(
            "--grid: only the methods grid and paper-grid have one",
        ));
    }
    if options.budget.is_some() && options.method.is_grid() {
        return Err(Failure::usage(
            "--budget: the grids take all their points; give --grid",
        ));
    }
    if options.method.is_grid() && !profile.shooter.errors.are_of_eq_25() {
        return Err(Failure::usage(format!(
            "--method {}: Eq. 25 has independent errors of speed, pitch, polar angle and backspin alone; for the others take sobol or monte-carlo",
            options.method.name()
        )));
    }
    Ok(match options.method {
        Method::Sobol => Sampler::new(profile, simulator).estimate_within(
            nominal,
            target,
            budget.max(LEAST_SHOTS),
            seed,
            &bars,
        ),
        Method::MonteCarlo => {
            monte_carlo::estimate_within(profile, simulator, nominal, target, budget, seed, &bars)
        }
        Method::Grid => {
            let plan = Plan::new(profile)?;
            let n = options.grid.unwrap_or(SHIFTED);
            grid::shifted(profile, &plan, simulator, nominal, n, seed, &bars)
        }
        Method::PaperGrid => {
            let plan = Plan::new(profile)?;
            let n = options.grid.unwrap_or(LETTER);
            let sum = grid::to_the_letter(profile, &plan, simulator, nominal, n, &bars);
            Estimate {
                probability: sum.probability,
                // It has no error of its own to state.
                standard_error: 0.0,
                shots: sum.shots,
                ..Estimate::default()
            }
        }
    })
}

fn replayed(
    method: Method,
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    seed: u64,
    index: u64,
) -> Result<Release, Failure> {
    match method {
        Method::Sobol if index >= MOST_SHOTS => Err(Failure::usage(format!(
            "--replay: the index must be below {MOST_SHOTS}"
        ))),
        Method::Sobol => Ok(Sampler::new(profile, simulator).sample(nominal, seed, index)),
        Method::MonteCarlo => Ok(monte_carlo::sample(profile, nominal, seed, index)),
        Method::Grid | Method::PaperGrid => Err(Failure::usage(
            "--replay: samples are drawn by sobol and monte-carlo only",
        )),
    }
}
