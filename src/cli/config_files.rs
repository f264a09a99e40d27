//! Reads configuration files.

use super::failure::{Failure, io_in_words, refuse_missing};
use crate::config::{MAX_FILE_BYTES, MAX_TOML_BYTES, parse_physics};
use crate::dynamics::Integrator;
use crate::model::{PRESETS, Physics, Preset};
use crate::present::fit_files::fit_note_text::fit_note_text;
use crate::shooter::Profile;
use crate::store::fit;
use crate::store::shooters::fits_within;
use crate::sweep::sweep_toml::{SourceTexts, SweepConfig, named_files, parse_sweep};
use crate::units::suggestion;
use std::io::Read;
use std::path::Path;

/// Reads a text file of at most [`MAX_FILE_BYTES`], a TOML file of at most [`MAX_TOML_BYTES`].
pub(crate) fn read_text(path: &Path) -> Result<String, Failure> {
    let is_toml = path
        .extension()
        .is_some_and(|extension| extension == "toml");
    let most = if is_toml {
        MAX_TOML_BYTES
    } else {
        MAX_FILE_BYTES
    };
    refuse_missing(path)?;
    let shown = path.display();
    let refuse =
        |error: std::io::Error| Failure::usage(format!("{shown}: {}", io_in_words(&error)));
    let metadata = std::fs::metadata(path).map_err(refuse)?;
    if !metadata.is_file() {
        let profile = path.join("profile.toml");
        let folders = fits_within(path)?;
        let give = if profile.is_file() {
            profile.display().to_string()
        } else if folders.is_empty() {
            "a TOML file".to_owned()
        } else {
            let names = folders.iter().map(|folder| folder.display().to_string());
            format!(
                "the folder of one shooter: {}",
                names.collect::<Vec<_>>().join(", ")
            )
        };
        return Err(Failure::usage(format!(
            "{shown}: is not a file; give {give}"
        )));
    }
    if metadata.len() > most {
        return Err(Failure::usage(format!(
            "{shown}: has {} bytes; at most {most} are read",
            metadata.len()
        )));
    }
    let mut bytes = Vec::new();
    std::fs::File::open(path)
        .and_then(|file| file.take(most).read_to_end(&mut bytes))
        .map_err(refuse)?;
    String::from_utf8(bytes).map_err(|error| {
        let position = error.utf8_error().valid_up_to();
        Failure::usage(format!(
            "{shown}: is not UTF-8 text (byte {position}); save it as UTF-8"
        ))
    })
}

/// What should be said of the fit that wrote a profile, in words: its `fit.json` lies beside it.
pub(crate) fn warnings_of_fit(profile: &Path) -> Result<Vec<String>, Failure> {
    let folder = fit::folder_of_profile(profile);
    let notes = folder.map(fit::notes).transpose()?.unwrap_or_default();
    Ok(notes.iter().map(fit_note_text).collect())
}

/// What another physics changes.
pub(crate) fn other_physics_warning(
    own: &Profile,
    profile: &Profile,
    name: &str,
) -> Option<String> {
    let units = own.output().units;
    let [before, after] = [own, profile].map(|profile| profile.physics().values(units));
    let changes: Vec<_> = before
        .iter()
        .zip(&after)
        .filter(|(a, b)| a.value != b.value)
        .map(|(a, b)| format!("  {:<20} {} -> {}\n", a.key, a.value, b.value))
        .collect();
    (!changes.is_empty()).then(|| {
        let changes = changes.concat();
        format!(
            "warning: the profile was written for another physics than --physics {name}. Speeds and errors that were \
             measured or chosen for one do not hold for the other. What changes:\n{}",
            changes.trim_end()
        )
    })
}

/// The physics of a preset or of a file, and the integrator.
pub(crate) fn load_physics(name: &str) -> Result<(Physics, Integrator), Failure> {
    Ok(parse_physics(&physics_text(name)?, name)?)
}

/// The text of a file with a `[physics]` table, or such a table for a preset.
pub(crate) fn physics_text(name: &str) -> Result<String, Failure> {
    if Preset::named(name).is_some() {
        return Ok(format!("[physics]\npreset = \"{name}\"\n"));
    }
    let path = Path::new(name);
    if !path.exists() {
        let presets: Vec<_> = PRESETS.iter().map(|preset| preset.name).collect();
        return Err(Failure::usage(format!(
            "--physics {name}: is neither a preset ({}) nor a file{}",
            presets.join(", "),
            suggestion(name, presets.iter().copied())
        )));
    }
    read_text(path)
}

/// Reads and checks a sweep and the files that it names, which are in its folder.
pub(crate) fn load_sweep(path: &Path) -> Result<(SweepConfig, SourceTexts), Failure> {
    let texts = read_sweep(path)?;
    let config = parse_sweep(&texts, &path.display().to_string())?;
    Ok((config, texts))
}

/// Reads a sweep whose shooter gives way to another one: what belongs to the shooter is left out,
/// and the file that it names is not read.
pub(crate) fn read_sweep_without_shooter(path: &Path) -> Result<SourceTexts, Failure> {
    let sweep = without_shooter(&read_text(path)?);
    read_files_of_sweep(path, sweep, false)
}

fn read_sweep(path: &Path) -> Result<SourceTexts, Failure> {
    read_files_of_sweep(path, read_text(path)?, true)
}

/// The text of a sweep without its shooter; a file is named in its place.
fn without_shooter(text: &str) -> String {
    let Ok(mut root) = text.parse::<toml::Table>() else {
        return text.to_owned();
    };
    for table in ["shooter", "physics", "nominal"] {
        root.remove(table);
    }
    if let Some(toml::Value::Table(sweep)) = root.get_mut("sweep") {
        sweep.insert("shooter".to_owned(), "player.toml".into());
    }
    root.to_string()
}

/// The texts of the files that the text of a sweep names.
fn read_files_of_sweep(
    path: &Path,
    sweep: String,
    reads_shooter: bool,
) -> Result<SourceTexts, Failure> {
    let mut files = named_files(&sweep);
    if !reads_shooter {
        files.shooter = None;
    }
    let folder = path.parent().unwrap_or(Path::new("."));
    // A faulty line is quoted in a message, so only files of the right type are read.
    let read = |name: Option<String>, key: &str, extension: &str| {
        let Some(name) = name else { return Ok(None) };
        let file = folder.join(&name);
        if !file
            .extension()
            .is_some_and(|given| given.eq_ignore_ascii_case(extension))
        {
            return Err(Failure::usage(format!(
                "{}: sweep.{key} must name a .{extension} file, not \"{name}\"",
                path.display()
            )));
        }
        if key == "shooter" && !file.exists() {
            return Err(Failure::usage(format!(
                "{}: its shooter is \"{name}\", and there is no such file; write one: bankshot new player {}",
                path.display(),
                file.display()
            )));
        }
        read_text(&file).map(Some)
    };
    Ok(SourceTexts {
        shooter: read(files.shooter, "shooter", "toml")?,
        places: read(files.places, "places", "csv")?,
        sweep,
    })
}
