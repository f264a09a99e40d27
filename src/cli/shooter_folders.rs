//! The folder of a fit of several shooters: which folders of shooters are in it.

use std::path::{Path, PathBuf};

/// The folders of the shooters in a folder that a fit of several wrote, by name.
pub(crate) fn of_shooters(folder: &Path) -> Vec<PathBuf> {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let is_of_fits = folder.join("shooters.csv").exists() || name.ends_with("-fit");
    if !is_of_fits || folder.join("fit.json").exists() {
        return Vec::new();
    }
    let listed = listed_folders(folder);
    if !listed.is_empty() {
        return listed;
    }
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let mut fits: Vec<PathBuf> = paths
        .filter(|path| path.join("fit.json").exists())
        .collect();
    fits.sort();
    fits
}

/// The folders of the fits that `shooters.csv` lists. (One that is not in it is of an older fit.)
fn listed_folders(folder: &Path) -> Vec<PathBuf> {
    let Ok(mut reader) = csv::Reader::from_path(folder.join("shooters.csv")) else {
        return Vec::new();
    };
    let column = reader
        .headers()
        .ok()
        .and_then(|names| names.iter().position(|name| name == "folder"));
    let Some(column) = column else {
        return Vec::new();
    };
    let mut folders: Vec<PathBuf> = Vec::new();
    for row in reader.records().flatten() {
        let name = row.get(column).map(Path::new).and_then(Path::file_name);
        let Some(path) = name.map(|name| folder.join(name)) else {
            continue;
        };
        if path.join("fit.json").exists() && !folders.contains(&path) {
            folders.push(path);
        }
    }
    folders
}
