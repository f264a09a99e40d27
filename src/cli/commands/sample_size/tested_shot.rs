//! The shot that the simulated tests repeat.

use super::changes::FirstSession;
use crate::analysis::sensitivity::SensitivityTopics;
use crate::best_shot::find_kinds;
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::loaded_profile::load_profile;
use crate::cli::nominal_shot_flags::{NominalOptions, print_notes};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{is_quiet, print_remark};
use crate::cli::value_parsers::PhysicsArg;
use crate::fitting::nominal_of;
use crate::measured_shots::source::Source;
use crate::probability::{Sampler, Silent};
use crate::shooter::{Nominal, Profile, ShotKind};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};
use std::path::Path;

/// The shot that a session repeats.
pub(super) struct TestedShot {
    pub(super) profile: Profile,
    pub(super) nominal: Nominal,
    pub(super) probability: f64,
    /// The tracker of a fit and what it sees; lab without one.
    pub(super) tracker: (String, Option<Source>),
    pub(super) units: UnitSystem,
    /// The session that was fitted.
    pub(super) fitted: Option<FirstSession>,
}

impl TestedShot {
    /// Of the folder of a fit the usual shot at the place; of a profile the named shot, else the
    /// best one.
    pub(super) fn read(
        path: &Path,
        physics: &PhysicsArg,
        place: Option<u32>,
        named: &NominalOptions,
    ) -> Result<Self, Failure> {
        if !path.is_dir() {
            if place.is_some() {
                return Err(Failure::usage(
                    "--place: only the folder of a fit has places",
                ));
            }
            let profile = load_profile(path, physics)?;
            let nominal = if named.is_given(&profile) {
                let nominal = named.resolve(&profile)?;
                print_notes(named.request().notes(&profile, &nominal));
                nominal
            } else {
                best_nominal(&profile)?
            };
            return Ok(Self {
                probability: probability(&profile, &nominal),
                units: profile.output().units,
                profile,
                nominal,
                tracker: ("lab".to_owned(), None),
                fitted: None,
            });
        }
        let fit = fit_folder::read(path)?;
        let place = fit_folder::index_of_place(place, fit.profiles.len())?;
        let nominal = nominal_of(&fit.posterior.typical().means[place]);
        if fit.profiles.len() > 1 && !is_quiet() {
            print_remark(&format!(
                "The fit has {} places; using place {}, {}.",
                fit.profiles.len(),
                place + 1,
                fit.profiles[place].location().in_words(fit.units)
            ));
        }
        Ok(Self {
            probability: probability(&fit.profiles[place], &nominal),
            nominal,
            fitted: Some(FirstSession::of_fit(&fit, place)),
            units: fit.units,
            profile: fit.profiles[place].clone(),
            tracker: (fit.tracker, Some(fit.source)),
        })
    }
}

/// P of a shot, to the profile's standard error.
fn probability(profile: &Profile, nominal: &Nominal) -> f64 {
    let search = profile.search();
    let sampler = Sampler::new(profile);
    let estimate = sampler.estimate(nominal, search.standard_error, search.seed, &Silent);
    estimate.probability
}

/// The best shot, where no shot is named.
fn best_nominal(profile: &Profile) -> Result<Nominal, Failure> {
    let topics = SensitivityTopics::NONE;
    let bars = ProgressBars::new();
    let (_, shots) = find_kinds(profile, &ShotKind::ALL, topics, &bars)?;
    let best = shots
        .into_iter()
        .flatten()
        .max_by(|a, b| a.estimate.probability.total_cmp(&b.estimate.probability))
        .ok_or_else(|| {
            Failure::usage("no exact shot goes in from there; give one with --speed and --pitch")
        })?;
    if !is_quiet() {
        let (long, metre) = profile.output().units.length();
        print_remark(&format!(
            "No shot given; using the best one ({}, {:.2} {long}/s, {:.1} deg, {:.1} rev/s).",
            ShotKind::of(profile, &best.nominal).name(),
            best.nominal.speed_m_s / metre,
            best.nominal.pitch_rad / DEGREE_RAD,
            best.nominal.backspin_rad_s / REV_RAD
        ));
    }
    Ok(best.nominal)
}
