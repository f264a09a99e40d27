//! Reads configuration files.

use super::failure::Failure;
use bankshot::config::{MAX_FILE_BYTES, parse_profile};
use bankshot::shooter::Profile;
use bankshot::sweep::sweep_toml::{SourceTexts, SweepConfig, named_files, parse_sweep};
use std::io::Read;
use std::path::Path;

/// Reads a text file of at most [`MAX_FILE_BYTES`].
pub(crate) fn read_text(path: &Path) -> Result<String, Failure> {
    let shown = path.display();
    let refuse = |error: std::io::Error| Failure::usage(format!("{shown}: {error}"));
    let metadata = std::fs::metadata(path).map_err(refuse)?;
    if !metadata.is_file() {
        return Err(Failure::usage(format!(
            "{shown}: is not a file; give a TOML file"
        )));
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(Failure::usage(format!(
            "{shown}: has {} bytes; at most {MAX_FILE_BYTES} are read",
            metadata.len()
        )));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES).read_to_end(&mut bytes))
        .map_err(refuse)?;
    String::from_utf8(bytes).map_err(|error| {
        let position = error.utf8_error().valid_up_to();
        Failure::usage(format!(
            "{shown}: is not UTF-8 text (byte {position}); save it as UTF-8"
        ))
    })
}

/// Reads and checks a profile.
pub(crate) fn load_profile(path: &Path) -> Result<Profile, Failure> {
    let text = read_text(path)?;
    Ok(parse_profile(&text, &path.display().to_string())?)
}

/// Reads and checks a sweep and the files that it names, which are in its folder.
pub(crate) fn load_sweep(path: &Path) -> Result<(SweepConfig, SourceTexts), Failure> {
    let sweep = read_text(path)?;
    let files = named_files(&sweep);
    let folder = path.parent().unwrap_or(Path::new("."));
    let read = |name: Option<String>| name.map(|name| read_text(&folder.join(name))).transpose();
    let texts = SourceTexts {
        shooter: read(files.shooter)?,
        places: read(files.places)?,
        sweep,
    };
    let config = parse_sweep(&texts, &path.display().to_string())?;
    Ok((config, texts))
}
