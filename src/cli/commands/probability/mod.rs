//! `bankshot probability`: P of one nominal shot under up to nine errors.

mod along_variable;
mod options;

use super::trace;
use crate::answers::json;
use crate::answers::nominal_shot::notes_of_shot;
use crate::answers::probability::Method;
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::nominal_shot_flags::{of_flags, print_notes};
use crate::cli::output_files;
use crate::cli::plot_files::PlotType;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_hint, print_prose};
use crate::dynamics::Release;
use crate::present::best_shot_text::PROFILE_IS_EXACT;
use crate::present::probability_text::answer_text;
use crate::probability::{MAX_SHOTS, Sampler, monte_carlo};
use crate::shooter::{Nominal, Profile};

pub(crate) use options::ProbabilityOptions;

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
    let mut notes = options.nominal.request().notes(&profile, &nominal);
    notes.extend(notes_of_shot(&profile, &nominal));
    print_notes(notes);
    let effort = options.effort();
    effort.check(&profile).map_err(|error| of_flags(&[error]))?;
    let of_draws = draws
        .as_ref()
        .map(|(_, fit)| fit_folder::shot_over_draws(fit, &profile, &nominal))
        .transpose()?;
    let over_draws = of_draws.as_ref();
    let bars = ProgressBars::new();
    let (answer, estimate) = effort.probability(&profile, &nominal, over_draws, &bars)?;
    let units = profile.output().units;
    if options.json {
        print_answer(&json::text(&json::document(&answer, units)))?;
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
    if estimate.standard_error <= effort.target(&profile) {
        return Ok(code::DONE);
    }
    print_hint(
        "the wanted standard error was not reached; raise --budget, or choose a larger --target",
    );
    Ok(code::IMPRECISE)
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
