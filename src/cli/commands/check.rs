//! `bankshot check`: whether a profile or a sweep is valid.

use crate::answers::checks::{CheckAnswer, Checked, Fault};
use crate::answers::json::{self, Provenance};
use crate::cli::config_files::{load_sweep, read_text};
use crate::cli::failure::{Failure, code};
use crate::cli::loaded_profile::LoadedProfile;
use crate::cli::terminal::{has_details, print_answer, print_prose, wrapped_line};
use crate::cli::value_parsers::{PhysicsArg, UnitsArg};
use crate::config::parse_profile;
use crate::model::{PRESETS, Physics, PhysicsValue};
use crate::search_space::TablePlan;
use crate::sweep::sweep_toml::is_sweep;
use crate::units::{DEGREE_RAD, UnitSystem};
use clap::Args;
use std::fmt::Write as _;
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct CheckOptions {
    /// The shooter's profile, or a sweep.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
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
    if has_details() {
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
    let (errors, checked, code) = checked(options)?;
    let (checked, provenance) = checked.unzip();
    let answer = CheckAnswer {
        file: options.profile.display().to_string(),
        is_valid: errors.is_empty(),
        errors,
        checked,
        provenance,
    };
    print_answer(&json::text(&json::document(&answer, UnitSystem::default())))?;
    Ok(code)
}

/// The faults of a file, what it is of where it has none, and the exit code.
fn checked(
    options: &CheckOptions,
) -> Result<(Vec<Fault>, Option<(Checked, Provenance)>, u8), Failure> {
    let text = read_text(&options.profile)?;
    let origin = options.profile.display().to_string();
    let refused = |failure: Failure| {
        let fault = Fault {
            key: None,
            message: failure.message,
            line: None,
            column: None,
        };
        (vec![fault], None, failure.code)
    };
    if is_sweep(&text) {
        return Ok(match load_sweep(&options.profile) {
            Ok((config, _)) => {
                let provenance = config.provenance()?;
                let sweep = Checked::Sweep {
                    places: config.places.len(),
                    sweep: config.name,
                };
                (Vec::new(), Some((sweep, provenance)), code::DONE)
            }
            Err(failure) => refused(failure),
        });
    }
    if let Err(error) = parse_profile(&text, &origin) {
        let places = error.lines_and_columns();
        let each = error.diagnostics.into_iter().zip(places);
        let faults = each.map(|(diagnostic, (line, column))| Fault {
            key: Some(diagnostic.key),
            message: diagnostic.message,
            line: Some(line),
            column: Some(column),
        });
        return Ok((faults.collect(), None, code::USAGE));
    }
    let loaded = LoadedProfile::read(&options.profile, &options.physics).and_then(|loaded| {
        TablePlan::for_search(&loaded.profile)?;
        Ok(loaded.profile)
    });
    Ok(match loaded {
        Ok(profile) => {
            let provenance = Provenance::of(&profile);
            (
                Vec::new(),
                Some((Checked::profile(&profile), provenance)),
                code::DONE,
            )
        }
        Err(failure) => refused(failure),
    })
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
