//! `bankshot check`: whether a profile or a sweep is valid.

use crate::cli::config_files::{load_sweep, read_text};
use crate::cli::failure::{Failure, code};
use crate::cli::loaded_profile::LoadedProfile;
use crate::cli::terminal::{print_answer, print_prose, wrapped_line};
use crate::cli::value_parsers::{PhysicsArg, UnitsArg};
use crate::config::parse_profile;
use crate::model::{PRESETS, Physics, PhysicsValue};
use crate::search_space::TablePlan;
use crate::shooter::implausible_values;
use crate::sweep::sweep_toml::is_sweep;
use crate::units::{DEGREE_RAD, UnitSystem};
use clap::Args;
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// The shooter's profile, or a sweep.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    /// List every value of the physics, and whether it is measured, from a rule book or assumed.
    #[arg(long)]
    pub(crate) verbose: bool,
    /// Units of the answer [default: the profile's, else imperial].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
    /// Print one JSON object: whether the file is valid, and each error with its line.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &CheckOptions) -> Result<u8, Failure> {
    if options.json {
        return print_json(options);
    }
    let path = options.profile.display();
    if is_sweep(&read_text(&options.profile)?) {
        let (config, _) = load_sweep(&options.profile)?;
        let (name, places) = (&config.name, config.places.len());
        return print_answer(&format!("{path}: valid ({name}, {places} places)\n"));
    }
    let loaded = LoadedProfile::read_and_warn(&options.profile, &options.physics, &[])?;
    let (text, profile) = (loaded.text(), loaded.profile);
    TablePlan::for_search(&profile)?;
    let own = profile.output().units;
    let units = options.units.map_or(own, UnitSystem::from);
    let (long, metre) = units.length();
    let location = profile.location();
    let mut answer = format!(
        "{path}: valid ({}, {:.2} {long} from the hoop at {:.1} deg)\n",
        profile.shooter().name,
        location.distance_m / metre,
        location.angle_rad / DEGREE_RAD
    );
    if options.verbose {
        answer.push_str(&physics_text(
            profile.physics(),
            preset_named_in(&text).as_deref(),
            units,
        ));
    }
    print_prose(&answer)
}

/// The answer for programs. The exit code is that of the answer for people.
fn print_json(options: &CheckOptions) -> Result<u8, Failure> {
    let text = read_text(&options.profile)?;
    let origin = options.profile.display().to_string();
    let of_file = |errors: Vec<Value>, more: Value| {
        let mut answer = json!({ "file": origin, "is_valid": errors.is_empty(), "errors": errors });
        if let (Some(answer), Value::Object(more)) = (answer.as_object_mut(), more) {
            answer.extend(more);
        }
        format!("{answer:#}\n")
    };
    let refused = |message: &str| vec![json!({ "message": message })];
    if is_sweep(&text) {
        return match load_sweep(&options.profile) {
            Ok((config, _)) => print_answer(&of_file(
                Vec::new(),
                json!({ "sweep": config.name, "places": config.places.len() }),
            )),
            Err(failure) => {
                print_answer(&of_file(refused(&failure.message), Value::Null))?;
                Ok(failure.code)
            }
        };
    }
    if let Err(error) = parse_profile(&text, &origin) {
        let errors = error.diagnostics.iter().map(|diagnostic| {
            let (line, column) = error.line_and_column(diagnostic);
            json!({
                "key": diagnostic.key,
                "message": diagnostic.message,
                "line": line,
                "column": column,
            })
        });
        print_answer(&of_file(errors.collect(), Value::Null))?;
        return Ok(code::USAGE);
    }
    let loaded = LoadedProfile::read(&options.profile, &options.physics).and_then(|loaded| {
        let profile = loaded.profile;
        TablePlan::for_search(&profile)
            .map(|_| profile)
            .map_err(Failure::from)
    });
    match loaded {
        Ok(profile) => {
            let location = profile.location();
            print_answer(&of_file(
                Vec::new(),
                json!({
                    "shooter": profile.shooter().name,
                    "distance_m": location.distance_m,
                    "court_angle_rad": location.angle_rad,
                    "release_height_m": profile.shooter().release_height_m,
                    "warnings": implausible_values(&profile).iter().map(ToString::to_string).collect::<Vec<_>>(),
                }),
            ))
        }
        Err(failure) => {
            print_answer(&of_file(refused(&failure.message), Value::Null))?;
            Ok(failure.code)
        }
    }
}

/// The preset that a profile's text names.
fn preset_named_in(text: &str) -> Option<String> {
    let table: toml::Table = text.parse().ok()?;
    let preset = table.get("physics")?.get("preset")?.as_str()?;
    PRESETS
        .iter()
        .any(|known| known.name == preset)
        .then(|| preset.to_owned())
}

/// The column of the source of a value.
const SOURCE_COLUMN: usize = 52;

/// Every value of the physics, and whether it is measured, from a rule book or assumed.
/// It is compared with the preset that the profile names, else with the nearest one.
fn physics_text(physics: &Physics, named: Option<&str>, units: UnitSystem) -> String {
    let values = physics.values(units);
    let presets = PRESETS
        .iter()
        .filter(|preset| named.is_none_or(|name| name == preset.name))
        .map(|preset| (preset, preset.physics().values(units)));
    // The preset that it is, or differs from least.
    let differing = |other: &[PhysicsValue]| {
        let pairs = values.iter().zip(other);
        pairs.filter(|(a, b)| a.value != b.value).count()
    };
    let (preset, of_preset) = presets
        .min_by_key(|(_, other)| differing(other))
        .expect("there are presets");
    let changed = if differing(&of_preset) > 0 {
        ", changed"
    } else {
        ""
    };
    let mut text = format!(
        "physics: {} ({}){changed}\n",
        preset.name, preset.description
    );
    for (own, usual) in values.iter().zip(&of_preset) {
        let source = if own.value != usual.value {
            format!("as given ({}: {})", preset.name, usual.value)
        } else if preset.name == "paper" {
            "the paper's".to_owned()
        } else {
            own.source.to_owned()
        };
        let line = format!("  {:<20} {:<28} {source}", own.key, own.value);
        let _ = writeln!(text, "{}", wrapped_line(&line, SOURCE_COLUMN));
    }
    text
}
