//! The folder of the fits of several shooters: which they are, and what their shots say together.

use super::StoreError;
use super::fit::{self, AGAIN, FIT_FILE};
use super::free_parameters::{FreeParameter, ring_of};
use super::sealed::{Sealed, seal};
use serde::{Deserialize, Serialize};
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The file that lists the fits of a folder.
const SHOOTERS_FILE: &str = "shooters.json";

/// A place of a shooter in the folder of several, or why the shooter has no fit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ShooterPlace {
    /// The shooter.
    pub shooter: String,
    /// The name of the fit's folder; empty without a fit.
    pub folder: String,
    /// The number of shots from there.
    pub shots: usize,
    /// How many went in, if the file says.
    pub made: Option<usize>,
    /// The name of the place; empty where the file does not say.
    pub place: String,
    /// Where it is, and P of the current shot from there; `None` without a fit.
    pub fitted: Option<FittedPlace>,
    /// Why there is no fit; empty where there is one.
    pub error: String,
}

/// Where a fitted shooter shot from, and P of the current shot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FittedPlace {
    /// Distance from the hoop's centre, m.
    pub distance_m: f64,
    /// Angle on the court, rad.
    pub court_angle_rad: f64,
    /// Height of the release above the floor, m.
    pub release_height_m: f64,
    /// P of the current shot: the mean over the draws.
    pub probability: f64,
    /// 2.5 % of the draws are below.
    pub low: f64,
    /// 2.5 % of the draws are above.
    pub high: f64,
}

/// The fits of several shooters.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Shooters {
    /// The places of each shooter, in the order of the file.
    pub places: Vec<ShooterPlace>,
    /// What `--free` found of all shooters together.
    pub free: Vec<FreeParameter>,
}

impl Shooters {
    /// Those of a folder; `None` if it is not a folder of several.
    ///
    /// # Errors
    /// The file is damaged.
    pub fn read(folder: &Path) -> Result<Option<Self>, StoreError> {
        let file = folder.join(SHOOTERS_FILE);
        let exists = file.exists();
        let sealed = exists.then(|| Sealed::read(&file, AGAIN)).transpose()?;
        Ok(sealed.map(|sealed| sealed.content))
    }

    /// Writes them.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), StoreError> {
        let file = folder.join(SHOOTERS_FILE);
        let object = serde_json::to_value(self).unwrap_or_default();
        crate::files::atomic_file::write(&file, seal(object, &[]).as_bytes())
            .map_err(|error| StoreError::io(&file, error))
    }
}

/// The folders of the fits of several shooters, in the order of their file; none if the folder is
/// not one of several. A fit in it that is not listed was put there by the user.
///
/// # Errors
/// The list is damaged.
pub fn fits_within(folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    if folder.join(FIT_FILE).exists() {
        return Ok(Vec::new());
    }
    let Some(shooters) = Shooters::read(folder)? else {
        return refuse_unlisted(folder);
    };
    let listed = shooters.places;
    let named = listed.iter().map(|place| place.folder.as_str());
    // Each place of a shooter has a line.
    let mut known = HashSet::new();
    let different = named.filter(|name| !name.is_empty() && known.insert(*name));
    Ok(different.map(|name| folder.join(name)).collect())
}

/// Refuses the fits of an earlier version, which are listed in their table alone.
fn refuse_unlisted(folder: &Path) -> Result<Vec<PathBuf>, StoreError> {
    let table = folder.join("shooters.csv");
    let mut entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    if table.exists() && entries.any(|entry| entry.path().join(FIT_FILE).exists()) {
        let what = format!("{SHOOTERS_FILE} is missing beside it; {AGAIN}");
        return Err(StoreError::damaged(&table, what));
    }
    Ok(Vec::new())
}

/// The restitutions of the ring that a fit leaves possible, or those that `--free hoop_restitution`
/// found, in the folder of the fits or in a fit. `paths` are folders or profiles of fits.
///
/// # Errors
/// A file of them is damaged.
pub fn ring_told_by_makes(paths: &[PathBuf]) -> Result<Option<(f64, f64)>, StoreError> {
    for path in paths {
        let folder = match path.is_dir() {
            true => path.as_path(),
            false => path.parent().unwrap_or(Path::new("")),
        };
        for of_all in [folder.to_owned(), folder.join("..")] {
            let shooters = Shooters::read(&of_all)?.unwrap_or_default();
            if let Some(ring) = ring_of(&shooters.free) {
                return Ok(Some(ring));
            }
        }
        if folder.join(FIT_FILE).exists() {
            let fit = fit::read_json(folder)?.content;
            if let Some(ring) = ring_of(&fit.free).or_else(|| fit.ring()) {
                return Ok(Some(ring));
            }
        }
    }
    Ok(None)
}
