//! How sure it is that a bank shot is better: over the draws of a fit, and over the rings that a
//! gym may have.

use crate::analysis::sensitivity::Difference;
use crate::cli::failure::Failure;
use crate::cli::fit_folder::{self, FitFolder};
use crate::fitting::{UnseenParameter, nominal_of};
use crate::model::SolidId;
use crate::probability::{Progress, Sampler, Silent};
use crate::sweep::SweepConfig;
use crate::sweep::probability_by_place::{PlaceProbabilities, Preference};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Kinds that differ by more than this in P are compared by no draws: the better one is.
const FAR_APART: f64 = 0.1;

/// Finds in how many draws of a player's fit the bank shot is the better one, at each place where
/// one kind is preferred to the other.
pub(super) fn find_sureness(
    places: &mut [PlaceProbabilities],
    config: &SweepConfig,
    fit: &FitFolder,
    progress: &dyn Progress,
) -> Result<(), Failure> {
    let is_open = |place: &&mut PlaceProbabilities| {
        let is_near = |gain: Difference| gain.value.abs() <= FAR_APART;
        place.preference() != Some(Preference::Either) && place.bank_gain().is_some_and(is_near)
    };
    let open: Vec<&mut PlaceProbabilities> = places.iter_mut().filter(is_open).collect();
    progress.begin("bank or direct, over the draws", open.len() as u64);
    for place in open {
        place.fitted_shots = Some(fit.posterior.shots);
        if let [Some(direct), Some(bank)] = &place.nominals {
            let profile = config.settings.at(place.place.location())?;
            let share = fit_folder::bank_is_better(fit, &profile, [direct, bank])?;
            place.bank_is_better = Some(share);
        }
        progress.advance(1);
    }
    progress.end();
    Ok(())
}

/// Seconds that [`find_sureness`] takes at one place, measured with a shot of the fit.
pub(super) fn sureness_s(fit: &FitFolder) -> f64 {
    let nominal = nominal_of(&fit.posterior.typical().means[0]);
    let start = Instant::now();
    match fit_folder::bank_is_better(fit, &fit.profiles[0], [&nominal; 2]) {
        Ok(_) => start.elapsed().as_secs_f64(),
        Err(_) => 0.0,
    }
}

/// Standard error of P under another ring: the differences share their samples.
const RING_ERROR: f64 = 0.002;

/// Finds by how much the bank shot, where it is preferred, is better on the rings that sources
/// give: nobody measured that of the gym. The shots stay as they are.
pub(super) fn find_ring_dependence(
    places: &mut [PlaceProbabilities],
    config: &SweepConfig,
    (low, high): (f64, f64),
    progress: &dyn Progress,
) -> Result<(), Failure> {
    let is_bank = |place: &&mut PlaceProbabilities| place.preference() == Some(Preference::Bank);
    let places: Vec<&mut PlaceProbabilities> = places.iter_mut().filter(is_bank).collect();
    progress.begin("bank or direct on other rings", places.len() as u64);
    for place in places {
        if let [Some(direct), Some(bank)] = place.nominals {
            let profile = config.settings.at(place.place.location())?;
            let mut least: Option<(f64, f64)> = None;
            for restitution in [low, high] {
                let other = profile.with(|settings| {
                    let set = settings
                        .physics
                        .set_restitution_on(SolidId::Ring, restitution);
                    debug_assert!(set.is_ok(), "sources give restitutions");
                })?;
                let sampler = Sampler::new(&other);
                let [direct, bank] = [&direct, &bank].map(|shot| {
                    let seed = other.search().seed;
                    sampler
                        .estimate(shot, RING_ERROR, seed, &Silent)
                        .probability
                });
                let gain = bank - direct;
                if least.is_none_or(|(least, _)| gain < least) {
                    least = Some((gain, restitution));
                }
            }
            place.least_gain_over_rings = least;
        }
        progress.advance(1);
    }
    progress.end();
    Ok(())
}

/// The restitutions that the ring may have: those that the makes tell, where the folder of the fits
/// or a fit has what `--free hoop_restitution` found, else those that sources give.
pub(super) fn ring_range(players: &[PathBuf]) -> (f64, f64) {
    let parameter = UnseenParameter::HoopRestitution;
    let (low, high) = parameter.usual_range();
    let told = players.iter().flat_map(|path| {
        let folder = if path.is_dir() {
            path.as_path()
        } else {
            path.parent().unwrap_or(Path::new(""))
        };
        let of_all = [folder.join("free.json"), folder.join("../free.json")];
        let read = |file: &PathBuf| -> Option<serde_json::Value> {
            serde_json::from_str(&std::fs::read_to_string(file).ok()?).ok()
        };
        let mut found: Vec<serde_json::Value> = of_all.iter().filter_map(read).collect();
        found.extend(read(&folder.join("fit.json")).map(|fit| fit["free"].clone()));
        found
    });
    let range = |list: serde_json::Value| {
        let found = list
            .as_array()?
            .iter()
            .find(|of| of["name"] == parameter.name())?;
        let is_decided = found["is_decided"].as_bool()?;
        let ends = (found["low"].as_f64()?, found["high"].as_f64()?);
        is_decided.then_some(ends)
    };
    let found = told.filter_map(range).find(|(low, high)| low < high);
    found.unwrap_or((low, high))
}
