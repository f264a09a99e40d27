//! The folder of a fit, read again.

use super::config_files::{load_profile, read_text};
use super::failure::{Failure, code};
use super::value_parsers::PhysicsArg;
use bankshot::fitting::{Posterior, SpinSource};
use bankshot::output::fit_files::draws_table::read_draws;
use bankshot::shooter::Profile;
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
    let profile = load_profile(&folder.join("profile.toml"), &PhysicsArg::default(), true)?;
    Ok(FitFolder {
        profile,
        posterior,
        observed: (count("made"), count("shots")),
    })
}
