//! What the makes of fitted shots tell of the ring.

use crate::fitting::UnseenParameter;
use std::path::{Path, PathBuf};

/// The restitutions of the ring that the makes tell, where the folder of the fits or a fit has what
/// `--free hoop_restitution` found. `paths` are folders or profiles of fits.
pub(crate) fn ring_told_by_makes(paths: &[PathBuf]) -> Option<(f64, f64)> {
    let parameter = UnseenParameter::HoopRestitution;
    let told = paths.iter().flat_map(|path| {
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
    told.filter_map(range).find(|(low, high)| low < high)
}
