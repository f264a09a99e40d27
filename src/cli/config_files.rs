//! Reads configuration files.

use super::failure::{Failure, io_in_words, refuse_missing};
use super::fixed_value_flags::FixedOptions;
use super::nominal_shot_flags::PlaceOptions;
use super::shooter_folders;
use super::terminal::print_remark;
use super::value_parsers::PhysicsArg;
use crate::config::{
    MAX_FILE_BYTES, MAX_TOML_BYTES, has_physics_table, is_physics_alone, parse_physics,
    parse_profile,
};
use crate::dynamics::Integrator;
use crate::model::{PRESETS, Physics, Preset};
use crate::shooter::{NominalVariable, Profile, implausible_values, nominal_values_not_fixed};
use crate::sweep::sweep_toml::{SourceTexts, SweepConfig, is_sweep, named_files, parse_sweep};
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
        let folders = shooter_folders::of_shooters(path);
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

/// Reads and checks a profile.
pub(crate) fn load_profile(
    path: &Path,
    physics: &PhysicsArg,
    quiet: bool,
) -> Result<Profile, Failure> {
    Ok(load(path, physics, &[], quiet)?.0)
}

/// A profile with its text, to which the other physics is added; for a command that fixes some
/// nominal values itself.
pub(crate) fn load_profile_with_text(
    path: &Path,
    physics: &PhysicsArg,
    (fixed, quiet): (&[NominalVariable], bool),
) -> Result<(Profile, String), Failure> {
    load(path, physics, fixed, quiet)
}

fn load(
    path: &Path,
    physics: &PhysicsArg,
    fixed: &[NominalVariable],
    quiet: bool,
) -> Result<(Profile, String), Failure> {
    // The folder of a fit or of a run holds its profile.
    let in_folder = path.join("profile.toml");
    let path = if in_folder.is_file() {
        &in_folder
    } else {
        path
    };
    let is_table = |end: &std::ffi::OsStr| end == "csv" || end == "parquet";
    if path.extension().is_some_and(is_table) {
        return Err(Failure::usage(format!(
            "{0}: this is a table, not a profile: `bankshot fit {0}` makes a profile of measured shots",
            path.display()
        )));
    }
    let mut text = read_text(path)?;
    if is_sweep(&text) {
        return Err(Failure::usage(format!(
            "{}: this is a sweep, not a profile: use `bankshot sweep`",
            path.display()
        )));
    }
    let origin = path.display().to_string();
    if is_physics_alone(&text) {
        return Err(Failure::usage(format!(
            "{origin}: this is a physics, not a profile: give a profile, and the physics as --physics {origin}"
        )));
    }
    // The profile itself must be valid, with its own physics.
    let own = parse_profile(&text, &origin)?;
    if !quiet {
        let not_fixed = nominal_values_not_fixed(&own, fixed);
        for words in implausible_values(&own).into_iter().chain(not_fixed) {
            print_remark(&format!("warning: {words}"));
        }
        let is_first_place = path.file_name().is_some_and(|name| name == "profile.toml");
        if is_first_place && path.with_file_name("profile_place_2.toml").is_file() {
            print_remark(&format!(
                "{origin}: is that of the first place of its fit; the others are beside it, profile_place_2.toml and so on"
            ));
        }
        for words in warnings_of_fit(path) {
            print_remark(&format!("warning: {origin}: its fit warned: {words}"));
        }
    }
    let Some(name) = &physics.physics else {
        return Ok((own, text));
    };
    text = without_table(&text, "[physics]");
    if has_physics_table(&text) {
        return Err(Failure::usage(format!(
            "--physics {name}: write the physics of {origin} as a table [physics], which this option replaces"
        )));
    }
    let table = physics_text(name)?;
    // By itself first, so that a message names the file and its own line.
    parse_physics(&table, name)?;
    text.push_str(&format!("\n\n# --physics {name}\n{}\n", table.trim_end()));
    let profile = parse_profile(&text, &format!("{origin} with --physics {name}"))?;
    if !quiet && let Some(warning) = other_physics_warning(&own, &profile, name) {
        print_remark(&warning);
    }
    Ok((profile, text))
}

/// A profile moved to the place that the flags give, and its text with that place.
pub(crate) fn moved(
    (profile, text): (Profile, String),
    place: &PlaceOptions,
) -> Result<(Profile, String), Failure> {
    let Some(table) = place.table(&profile.location()) else {
        return Ok((profile, text));
    };
    let text = without_table(&text, "[location]");
    if text
        .parse::<toml::Table>()
        .is_ok_and(|all| all.contains_key("location"))
    {
        return Err(Failure::usage(
            "--distance, --angle: write the location of the profile as a table [location], which these options replace",
        ));
    }
    let text = format!("{}\n\n# --distance, --angle\n{table}", text.trim_end());
    Ok((place.moved(profile)?, text))
}

/// A profile in which the flags' values are fixed, and its text with them.
pub(crate) fn with_fixed(
    (profile, text): (Profile, String),
    fixed: &FixedOptions,
    origin: &Path,
) -> Result<(Profile, String), Failure> {
    // A message about a value names its flag.
    if fixed.values(&profile)?.is_empty() {
        return Ok((profile, text));
    }
    let text = fixed.profile_text(&profile, &text)?;
    let profile = parse_profile(&text, &format!("{} as changed", origin.display()))?;
    Ok((profile, text))
}

/// What the fit that wrote a profile warned of: its `fit.json` lies beside it.
pub(crate) fn warnings_of_fit(profile: &Path) -> Vec<String> {
    let is_of_fit = profile.file_name().is_some_and(|name| {
        let name = name.to_string_lossy();
        name == "profile.toml" || name.starts_with("profile_place_")
    });
    let fit = profile.with_file_name("fit.json");
    if !is_of_fit || !fit.is_file() {
        return Vec::new();
    }
    let text = read_text(&fit).unwrap_or_default();
    let fit: serde_json::Value = serde_json::from_str(&text).unwrap_or_default();
    let warnings = fit["warnings"].as_array().into_iter().flatten();
    warnings
        .filter_map(|warning| warning.as_str().map(str::to_owned))
        .collect()
}

/// What another physics changes.
fn other_physics_warning(own: &Profile, profile: &Profile, name: &str) -> Option<String> {
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

/// A text without the table of a header such as `[physics]`: from the line of that to the next
/// header.
fn without_table(text: &str, header: &str) -> String {
    let mut kept = String::new();
    let mut inside = false;
    for line in text.split_inclusive('\n') {
        let start = line.trim_start();
        if start.starts_with('[') {
            inside = start.starts_with(header);
        }
        if !inside {
            kept.push_str(line);
        }
    }
    kept
}

/// The physics of a preset or of a file, and the integrator.
pub(crate) fn load_physics(name: &str) -> Result<(Physics, Integrator), Failure> {
    Ok(parse_physics(&physics_text(name)?, name)?)
}

/// The text of a file with a `[physics]` table, or such a table for a preset.
fn physics_text(name: &str) -> Result<String, Failure> {
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
