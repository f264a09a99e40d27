//! `bankshot shot`: P of one nominal shot under up to nine errors.

mod along_variable;
mod options;

use super::trace;
use crate::analysis::rebounds::{REACH_M, find_rebounds};
use crate::answers::json;
use crate::answers::nominal_shot::notes_of_shot;
use crate::answers::probability::Method;
use crate::answers::rebounds::ReboundsAnswer;
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::nominal_shot_flags::{of_flags, print_notes};
use crate::cli::output_files;
use crate::cli::plot_files::{self, PlotType};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{has_details, print_answer, print_hint, print_next, print_text};
use crate::dynamics::Release;
use crate::plots::rebound_map;
use crate::present::probability_text::probability_text;
use crate::probability::{MAX_SHOTS, Sampler, monte_carlo};
use crate::shooter::{Nominal, Profile};
use crate::store::fit::Fit;

pub(crate) use options::ShotOptions;

pub(crate) fn run(options: &ShotOptions) -> Result<u8, Failure> {
    let loaded = options.scatter.changed(options.profile.load(&[])?)?;
    let scatter = &options.scatter.scatter;
    let draws = options.draws.as_deref();
    let fit = fit_folder::draws_for(draws, &loaded, !scatter.is_empty())?;
    let profile = loaded.profile;
    output_files::check(&options.output)?;
    for path in options.plot.iter().chain(&options.rebounds) {
        PlotType::of(path)?;
    }
    if let Some(vary) = &options.vary {
        return along_variable::run(options, (&profile, fit.as_ref()), vary);
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
    let of_draws = fit
        .as_ref()
        .filter(|_| !options.method.is_grid())
        .map(|fit| match current_place(options, fit, &profile) {
            Some(place) => Ok(fit.usual_probabilities(place)),
            None => fit_folder::shot_over_draws(fit, &profile, &nominal),
        })
        .transpose()?;
    let over_draws = of_draws.as_ref();
    let bars = ProgressBars::new();
    let (mut answer, estimate) = effort.probability(&profile, &nominal, over_draws, &bars)?;
    let units = profile.output().units;
    if (options.json || has_details() || options.rebounds.is_some()) && !options.method.is_grid() {
        answer.rebounds = Some(rebounds(options, &profile, &nominal)?);
    }
    if options.json {
        print_answer(&json::text(&json::document(&answer, units)))?;
    } else {
        print_text(&probability_text(&profile, &answer, scatter))?;
        print_next(None, "");
    }
    if estimate.standard_error <= effort.target(&profile) {
        return Ok(code::DONE);
    }
    print_hint("the simulation error is larger than wanted; raise --budget or --standard-error");
    Ok(code::IMPRECISE)
}

/// Where the misses come down, with the map that was asked for.
fn rebounds(
    options: &ShotOptions,
    profile: &Profile,
    nominal: &Nominal,
) -> Result<ReboundsAnswer, Failure> {
    let seed = options.seed.unwrap_or(profile.search().seed);
    let reach_m = options.reach.unwrap_or(REACH_M);
    let found = find_rebounds(profile, nominal, seed, reach_m);
    let answer = ReboundsAnswer::new(profile, &found, reach_m);
    if let Some(path) = &options.rebounds {
        match rebound_map::draw(profile, &found, &answer) {
            Some(plot) => plot_files::write_one(path, &plot)?,
            None => print_hint("no shot misses: no map of the rebounds was drawn"),
        }
    }
    Ok(answer)
}

/// The place of a fit whose current shot is asked about: the profile as the fit wrote it, and no
/// other shot.
fn current_place(options: &ShotOptions, fit: &Fit, profile: &Profile) -> Option<usize> {
    if options.nominal.request().is_given() {
        return None;
    }
    let mut places = fit.profiles.iter();
    places.position(|own| {
        own.location() == profile.location()
            && own.nominal_overrides() == profile.nominal_overrides()
            && own.physics() == profile.physics()
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
