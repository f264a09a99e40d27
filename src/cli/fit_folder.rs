//! The folder of a fit, read again.

use super::config_files::{load_profile, read_text};
use super::failure::{Failure, code};
use super::value_parsers::PhysicsArg;
use bankshot::fitting::{Place, Posterior, SpinSource, WeightedShots, fitted_profile, values_of};
use bankshot::output::fit_files::draws_table::read_draws;
use bankshot::output::fit_files::fit_text::probability_text;
use bankshot::shooter::{Nominal, Profile};
use std::fs::File;
use std::path::Path;

/// A fit that was written to a folder.
pub(crate) struct FitFolder {
    pub(crate) profile: Profile,
    pub(crate) posterior: Posterior,
    /// Made and all shots with a result.
    pub(crate) observed: (usize, usize),
}

fn damaged(path: &Path, message: impl std::fmt::Display) -> Failure {
    Failure {
        code: code::DAMAGED,
        message: format!("{}: {message}", path.display()),
    }
}

/// Reads the folder of a fit.
pub(crate) fn read(folder: &Path) -> Result<FitFolder, Failure> {
    let json_path = folder.join("fit.json");
    if !json_path.exists() {
        return Err(Failure::usage(format!(
            "{}: is no folder of `bankshot fit` (it has no fit.json; of several shooters, name the folder of one)",
            folder.display()
        )));
    }
    let json: serde_json::Value = serde_json::from_str(&read_text(&json_path)?)
        .map_err(|error| damaged(&json_path, error))?;
    let count = |name: &str| json["observed"][name].as_u64().unwrap_or(0) as usize;
    let spin = json["parameters"]
        .as_array()
        .and_then(|all| all.iter().find(|p| p["name"] == "backspin_mean"))
        .map_or("assumed", |p| p["source"].as_str().unwrap_or("assumed"));
    let spin = match spin {
        "measured" => SpinSource::Measured,
        "given" => SpinSource::Given,
        _ => SpinSource::Assumed,
    };
    let draws_path = folder.join("draws.parquet");
    let file =
        File::open(&draws_path).map_err(|error| Failure::io(draws_path.display(), &error))?;
    let shots = json["shots"].as_u64().unwrap_or(0) as usize;
    let posterior = read_draws(file, spin, shots).map_err(|error| damaged(&draws_path, error))?;
    let written = load_profile(&folder.join("profile.toml"), &PhysicsArg::default(), true)?;
    let place = Place {
        location: written.location(),
        release_height_m: written.shooter().release_height_m,
    };
    // The file has rounded numbers; the draws have all digits.
    let name = &written.shooter().name;
    let profile = fitted_profile(name, written.physics(), &posterior.typical(), &place)?;
    Ok(FitFolder {
        profile,
        posterior,
        observed: (count("made"), count("shots")),
    })
}

/// Shots of the sample that P of the draws is computed with.
const SHOTS: usize = 65_536;

/// P of a nominal shot over the draws of a fit, in words.
pub(crate) fn text_over_draws(
    folder: &Path,
    profile: &Profile,
    nominal: &Nominal,
) -> Result<String, Failure> {
    let fit = read(folder)?;
    let (draws, values) = (&fit.posterior.draws, values_of(nominal));
    let seed = profile.search().seed;
    let p = WeightedShots::simulate(profile, (draws, 0), &[values], SHOTS, seed).probabilities(
        draws,
        |_| values,
        |draw| draw.factor_at(0),
    );
    Ok(format!(
        "over {} draws of the scatter in {}: {}\n",
        draws.len(),
        folder.display(),
        probability_text(&p)
    ))
}
