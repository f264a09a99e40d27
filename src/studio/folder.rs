//! The folder of the results: what is in it, by name. No path of a request is opened; a name must
//! be one of those that are found here.

use super::refusal::Refusal;
use super::site::Site;
use crate::answers::shot_file::ShotFileRequest;
use crate::escape::is_device;
use axum::Json;
use axum::body::Body;
use axum::extract::{Path as UrlPath, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use serde::Serialize;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::UNIX_EPOCH;

/// Folders within each other that are looked at.
const MAX_DEPTH: usize = 6;
/// Files that are listed.
const MAX_FILES: usize = 20_000;
/// The folder of the files of measured shots.
pub(super) const UPLOADS: &str = "uploads";
/// The longest name.
const MAX_NAME: usize = 60;

/// Kinds of files that are shown, and what they are sent as.
const KINDS: [(&str, &str); 14] = [
    ("html", "text/html; charset=utf-8"),
    ("svg", "image/svg+xml"),
    ("png", "image/png"),
    ("csv", "text/csv; charset=utf-8"),
    ("json", "application/json"),
    ("toml", "text/plain; charset=utf-8"),
    ("txt", "text/plain; charset=utf-8"),
    ("java", "text/plain; charset=utf-8"),
    ("hpp", "text/plain; charset=utf-8"),
    ("h", "text/plain; charset=utf-8"),
    ("py", "text/plain; charset=utf-8"),
    ("parquet", "application/octet-stream"),
    ("xlsx", "application/octet-stream"),
    ("sqlite", "application/octet-stream"),
];

/// A file below the folder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct FileEntry {
    /// Its path from the folder, with `/` between its parts.
    pub(super) name: String,
    /// Its size.
    pub(super) bytes: u64,
    /// When it was written last: seconds since 1970.
    pub(super) written_s: u64,
}

/// What is in the folder.
#[derive(Clone, Debug, Default, Serialize)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
pub(super) struct Content {
    /// Its name, as it was given.
    folder: String,
    /// The folders of fits.
    pub(super) fits: Vec<String>,
    /// The folders of sweeps.
    pub(super) sweeps: Vec<String>,
    /// Files of measured shots.
    uploads: Vec<String>,
    /// All files that can be shown.
    files: Vec<FileEntry>,
}

/// Every file below a folder, not through links.
fn visit(folder: &Path, start: &str, depth: usize, found: &mut Vec<FileEntry>) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    for entry in entries.flatten() {
        // A name that is no text cannot be asked for.
        let Ok(name) = entry.file_name().into_string() else {
            continue;
        };
        let Ok(metadata) = entry.metadata() else {
            continue;
        };
        if name.starts_with('.') || found.len() >= MAX_FILES {
            continue;
        }
        let name = format!("{start}{name}");
        if metadata.is_dir() && depth < MAX_DEPTH {
            visit(&entry.path(), &format!("{name}/"), depth + 1, found);
        } else if metadata.is_file() {
            let written = metadata.modified().ok();
            let written = written.and_then(|time| time.duration_since(UNIX_EPOCH).ok());
            found.push(FileEntry {
                name,
                bytes: metadata.len(),
                written_s: written.map_or(0, |time| time.as_secs()),
            });
        }
    }
}

/// All files of the folder, in the order of their names.
fn files(folder: &Path) -> Vec<FileEntry> {
    let mut found = Vec::new();
    visit(folder, "", 0, &mut found);
    found.sort_by(|a, b| a.name.cmp(&b.name));
    found
}

/// The folders that have a file of this name.
fn folders_with(files: &[FileEntry], file: &str) -> Vec<String> {
    let names = files.iter().map(|entry| entry.name.as_str());
    let end = format!("/{file}");
    names
        .filter_map(|name| Some(name.strip_suffix(&end)?.to_owned()))
        .collect()
}

impl Content {
    pub(super) fn of(folder: &Path) -> Self {
        let all = files(folder);
        let uploads = all.iter().filter_map(|entry| {
            let name = entry.name.strip_prefix(UPLOADS)?.strip_prefix('/')?;
            Some(name.to_owned())
        });
        Self {
            folder: folder.display().to_string(),
            fits: folders_with(&all, "fit.json"),
            sweeps: folders_with(&all, "configuration.json"),
            uploads: uploads.collect(),
            files: all
                .iter()
                .filter(|e| kind(&e.name).is_some())
                .cloned()
                .collect(),
        }
    }
}

fn kind(name: &str) -> Option<&'static str> {
    let (_, end) = name.rsplit_once('.')?;
    let found = KINDS
        .iter()
        .find(|(known, _)| end.eq_ignore_ascii_case(known));
    found.map(|(_, kind)| *kind)
}

pub(super) async fn content(State(site): State<Arc<Site>>) -> Json<Content> {
    Json(Content::of(&site.folder))
}

/// The folder of a fit.
pub(super) fn fit_folder(site: &Site, name: &str) -> Result<PathBuf, Refusal> {
    let is_known = Content::of(&site.folder)
        .fits
        .iter()
        .any(|known| known == name);
    let found = is_known.then(|| site.folder.join(name));
    found.ok_or_else(|| Refusal::not_found(name))
}

/// The folder of a sweep.
pub(super) fn sweep_folder(site: &Site, name: &str) -> Result<PathBuf, Refusal> {
    let is_known = Content::of(&site.folder)
        .sweeps
        .iter()
        .any(|known| known == name);
    let found = is_known.then(|| site.folder.join(name));
    found.ok_or_else(|| Refusal::not_found(name))
}

/// A file of measured shots.
pub(super) fn upload(folder: &Path, name: &str) -> Result<PathBuf, Refusal> {
    let is_known = Content::of(folder)
        .uploads
        .iter()
        .any(|known| known == name);
    let found = is_known.then(|| folder.join(UPLOADS).join(name));
    found.ok_or_else(|| Refusal::not_found(name))
}

/// Refuses a name that should become that of a folder or file and cannot be one everywhere.
pub(super) fn check_new_name(field: &str, name: &str) -> Result<(), Refusal> {
    let is_allowed = |c: char| c.is_alphanumeric() || " -_.()+".contains(c);
    let ends_well = name.starts_with(char::is_alphanumeric) && !name.ends_with(['.', ' ']);
    let is_short = (1..=MAX_NAME).contains(&name.chars().count());
    if ends_well && is_short && !is_device(name) && name.chars().all(is_allowed) {
        return Ok(());
    }
    Err(Refusal::field(
        field,
        format!(
            "must be a name of up to {MAX_NAME} letters, digits, spaces, dashes and dots that begins with a letter or a digit"
        ),
    ))
}

/// One file of the folder.
pub(super) async fn file(
    State(site): State<Arc<Site>>,
    UrlPath(name): UrlPath<String>,
) -> Result<Response, Refusal> {
    /// Larger files are not shown.
    const MAX_BYTES: u64 = 64 << 20;
    let known = files(&site.folder);
    let entry = known.iter().find(|entry| entry.name == name);
    let (Some(entry), Some(kind)) = (entry, kind(&name)) else {
        return Err(Refusal::not_found(&name));
    };
    if entry.bytes > MAX_BYTES {
        let words = format!("{name}: is larger than 64 MiB; open it in the folder itself");
        return Err(Refusal::new(StatusCode::PAYLOAD_TOO_LARGE, words));
    }
    let opened = fs::File::open(site.folder.join(&name));
    let mut bytes = Vec::new();
    opened
        .and_then(|file| file.take(MAX_BYTES).read_to_end(&mut bytes))
        .map_err(|error| Refusal::io(&name, &error))?;
    Ok(([(header::CONTENT_TYPE, kind)], Body::from(bytes)).into_response())
}

/// The flags of commands that read measured shots. Each value stands behind its own flag, so none
/// can be taken for another flag; those that could name a file are refused.
pub(super) fn shot_flags(request: &ShotFileRequest) -> Result<Vec<String>, Refusal> {
    if let Some(map) = request
        .maps
        .iter()
        .find(|map| map.trim_start().starts_with('@'))
    {
        return Err(Refusal::field(
            "maps",
            format!("'{map}': a map begins with a quantity"),
        ));
    }
    let mut flags: Vec<String> = request
        .maps
        .iter()
        .map(|map| format!("--map={map}"))
        .collect();
    let values = [
        ("at", &request.at),
        ("distance", &request.distance),
        ("release-height", &request.release_height),
        ("made", &request.made),
        ("dates", &request.dates),
    ];
    for (flag, value) in values {
        flags.extend(value.iter().map(|value| format!("--{flag}={value}")));
    }
    Ok(flags)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_names_that_could_be_paths_are_refused() {
        for good in ["team", "Müller 2026-11", "a.b", "U-14 (girls)", "console"] {
            assert!(check_new_name("name", good).is_ok(), "{good}");
        }
        let long = "a".repeat(61);
        for bad in [
            "", "..", "../x", "/etc", "a/b", "a\\b", ".hidden", "a.", "a ", "-flag", "con",
            "CON.txt", "lpt1", "nul\0", "a\nb", "<b>", "c:d", &long,
        ] {
            assert!(check_new_name("name", bad).is_err(), "{bad:?}");
        }
    }

    #[test]
    fn contract_a_map_cannot_name_a_file() {
        let maps = |map: &str| ShotFileRequest {
            maps: vec![map.to_owned()],
            ..ShotFileRequest::default()
        };
        assert!(shot_flags(&maps("@/etc/passwd")).is_err());
        assert!(shot_flags(&maps(" @x")).is_err());
        let flags = shot_flags(&maps("made=Result")).unwrap();
        assert_eq!(flags, ["--map=made=Result"]);
    }

    #[cfg(unix)]
    #[test]
    fn contract_links_and_hidden_files_are_not_in_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("a.csv"), "x").unwrap();
        fs::write(folder.path().join(".secret.csv"), "x").unwrap();
        std::os::unix::fs::symlink("/etc", folder.path().join("etc")).unwrap();
        std::os::unix::fs::symlink("/etc/passwd", folder.path().join("p.txt")).unwrap();
        let names: Vec<String> = files(folder.path()).into_iter().map(|e| e.name).collect();
        assert_eq!(names, ["a.csv"]);
    }
}
