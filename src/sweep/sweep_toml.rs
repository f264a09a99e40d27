//! A sweep as a TOML file: from its text to a checked [`SweepConfig`].

use super::court_region::{CourtPlace, MAX_PLACES, Region};
use super::region_toml::read_region;
use crate::analysis::sensitivity::SensitivityTopics;
use crate::answers::json::Provenance;
use crate::best_shot::ShotKind;
use crate::config::toml_reader::TableReader;
use crate::config::{
    ConfigError, Diagnostic, ReadSettings, parse_locations, parse_profile, parse_toml,
    read_settings, read_settings_of,
};
use crate::escape::is_control_or_direction;
use crate::model::league_courts::League;
use crate::model::named_places::{named_places, place_named, place_names_in_words};
use crate::shooter::{IdentityError, NominalVariable, Profile, ProfileSettings, identity_hash};
use serde::{Deserialize, Serialize};

/// Longest name of a sweep, in characters.
const LONGEST_NAME: usize = 500;

/// A checked sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepConfig {
    /// Name, for titles and the results' folder.
    pub name: String,
    /// The rule book of the court.
    pub league: League,
    /// The region of the court.
    pub region: Region,
    /// What is computed at each spot.
    pub compute: Compute,
    /// The shooter and the rest of a profile.
    pub settings: ProfileSettings,
    /// The places in the order of the results.
    #[serde(skip)]
    pub places: Vec<CourtPlace>,
    /// Their names, if the file of places has any; else none. No result depends on them.
    #[serde(skip)]
    pub place_names: Vec<String>,
}

/// What is computed at each spot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Compute {
    /// The best direct shot.
    pub direct: bool,
    /// The best bank shot.
    pub bank: bool,
    /// Their gain from backspin.
    pub spin: bool,
    /// The cost of each error.
    pub errors: bool,
}

/// The values of the key `compute`.
const COMPUTE: [&str; 4] = ["direct", "bank", "spin", "errors"];

impl Compute {
    /// The kinds of shots.
    #[must_use]
    pub fn kinds(self) -> Vec<ShotKind> {
        [(ShotKind::Direct, self.direct), (ShotKind::Bank, self.bank)]
            .into_iter()
            .filter_map(|(kind, is_wanted)| is_wanted.then_some(kind))
            .collect()
    }

    /// The topics of the sensitivity.
    #[must_use]
    pub fn topics(self) -> SensitivityTopics {
        SensitivityTopics {
            errors: self.errors,
            backspin: self.spin,
            ..SensitivityTopics::NONE
        }
    }
}

/// The texts of the files of a sweep.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceTexts {
    /// The sweep.
    pub sweep: String,
    /// The shooter's profile, if the sweep names one.
    pub shooter: Option<String>,
    /// The file of locations, if the sweep names one.
    pub places: Option<String>,
}

/// The other files that a sweep names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NamedFiles {
    /// The shooter's profile.
    pub shooter: Option<String>,
    /// The locations.
    pub places: Option<String>,
}

/// Whether a text is meant as a sweep: it has a `[sweep]` table.
#[must_use]
pub fn is_sweep(text: &str) -> bool {
    let (table, _) = toml::de::DeTable::parse_recoverable(text);
    table.get_ref().contains_key("sweep")
}

/// The files that a sweep names. Errors in the text are left to [`parse_sweep`].
#[must_use]
pub fn named_files(text: &str) -> NamedFiles {
    let (table, _) = toml::de::DeTable::parse_recoverable(text);
    let mut diagnostics = Vec::new();
    let mut sweep = TableReader::root(&table).table("sweep", &mut diagnostics);
    NamedFiles {
        shooter: sweep.text("shooter", &mut diagnostics),
        places: sweep.text("places", &mut diagnostics),
    }
}

/// Parses a sweep. `origin` names the file in messages.
///
/// # Errors
/// Everything that is wrong; errors of the shooter's profile come first.
pub fn parse_sweep(texts: &SourceTexts, origin: &str) -> Result<SweepConfig, ConfigError> {
    let files = named_files(&texts.sweep);
    let profile = match (&files.shooter, &texts.shooter) {
        (Some(name), Some(text)) => Some(parse_profile(text, name)?),
        _ => None,
    };
    let mut locations = match (&files.places, &texts.places) {
        (Some(_), Some(text)) => Some(parse_locations(text)),
        _ => None,
    };
    let place_names = match &mut locations {
        Some(Ok(locations)) => std::mem::take(&mut locations.names),
        _ => Vec::new(),
    };
    let locations = locations.map(|read| read.map(|locations| locations.points_m));
    parse_toml(&texts.sweep, origin, |mut root, diagnostics| {
        let mut table = root.table("sweep", diagnostics);
        if !root.has("sweep") {
            let message = "is missing, so this is no sweep; for a profile use `bankshot best`";
            diagnostics.push(table.table_diagnostic(message));
            // A profile is not a sweep with errors.
            if root.has("location") {
                return None;
            }
        }
        let name = read_name(&mut table, diagnostics);
        // Read with the file that it names.
        let _ = table.text("shooter", diagnostics);
        let league = read_league(&mut table, diagnostics);
        let compute = read_compute(&mut table, diagnostics);
        let named = table.texts("names", diagnostics);
        let (locations, place_names) = match named {
            None => (locations, place_names),
            Some(names) => match points_of_names(&names, league) {
                Ok((points, names)) => (Some(Ok(points)), names),
                Err(message) => {
                    diagnostics.push(table.diagnostic("names", message));
                    (None, Vec::new())
                }
            },
        };
        let region = read_region(&mut table, locations, diagnostics);
        let sweep_table = table.clone();
        table.report_unknown_keys(diagnostics);
        let read = if files.shooter.is_some() {
            read_with_profile(&mut root, profile, diagnostics)?
        } else {
            read_settings(&mut root, diagnostics)
        };
        root.report_unknown_keys(diagnostics);
        let region = region.filter(|_| read.is_valid)?;
        let places = list_places(&region, league, &read.settings, &sweep_table, diagnostics)?;
        Some(SweepConfig {
            name,
            league,
            region,
            compute,
            settings: read.settings,
            places,
            place_names,
        })
    })
}

/// The shooter, the physics and the nominal values of a profile; the rest of the settings from the
/// sweep.
fn read_with_profile(
    root: &mut TableReader<'_, '_>,
    profile: Option<Profile>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<ReadSettings> {
    for table in ["shooter", "physics", "nominal"] {
        if root.has(table) {
            let message = "comes from the file that sweep.shooter names; leave it out";
            diagnostics.push(root.diagnostic(table, message));
        }
    }
    let Some(profile) = profile else {
        diagnostics.push(root.diagnostic("sweep", "the file of the shooter was not read"));
        return None;
    };
    let before = diagnostics.len();
    let settings = profile.settings().clone();
    Some(read_settings_of(root, settings, before, diagnostics))
}

fn read_name(table: &mut TableReader<'_, '_>, diagnostics: &mut Vec<Diagnostic>) -> String {
    let name = table
        .text("name", diagnostics)
        .unwrap_or_else(|| "sweep".into());
    let is_too_long = name.chars().count() > LONGEST_NAME;
    if name.is_empty() || is_too_long || name.chars().any(is_control_or_direction) {
        let message = "must have 1 to 500 characters, none of which controls the terminal or the direction of text";
        diagnostics.push(table.diagnostic("name", message));
    }
    name
}

/// The places that a sweep names, with their names; all of the court for `["all"]`.
fn points_of_names(
    names: &[String],
    league: League,
) -> Result<(Vec<(f64, f64)>, Vec<String>), String> {
    let all = named_places(league);
    let mut found = Vec::new();
    for name in names {
        if name == "all" {
            found.extend(
                all.iter()
                    .map(|place| ((place.x_m, place.y_m), place.name.clone())),
            );
            continue;
        }
        let place = place_named(name, league).ok_or_else(|| {
            format!(
                "\"{name}\" is no place; the places are {}, or \"all\"",
                place_names_in_words()
            )
        })?;
        found.push(((place.x_m, place.y_m), name.clone()));
    }
    Ok(found.into_iter().unzip())
}

fn read_league(table: &mut TableReader<'_, '_>, diagnostics: &mut Vec<Diagnostic>) -> League {
    let Some(name) = table.text("court", diagnostics) else {
        return League::Ncaa;
    };
    League::from_name(&name).unwrap_or_else(|| {
        let message = "must be \"ncaa\", \"nba\", \"fiba\" or \"high_school\"";
        diagnostics.push(table.diagnostic("court", message));
        League::Ncaa
    })
}

fn read_compute(table: &mut TableReader<'_, '_>, diagnostics: &mut Vec<Diagnostic>) -> Compute {
    let names = table
        .texts("compute", diagnostics)
        .unwrap_or_else(|| vec!["direct".to_owned(), "bank".to_owned()]);
    let has = |what: &str| names.iter().any(|name| name == what);
    let all_known = names.iter().all(|name| COMPUTE.contains(&name.as_str()));
    if !all_known || !(has("direct") || has("bank")) {
        let message = format!(
            "must name direct or bank or both, and may name the rest of {}",
            COMPUTE.join(", ")
        );
        diagnostics.push(table.diagnostic("compute", message));
    }
    Compute {
        direct: has("direct"),
        bank: has("bank"),
        spin: has("spin"),
        errors: has("errors"),
    }
}

fn list_places(
    region: &Region,
    league: League,
    settings: &ProfileSettings,
    table: &TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<Vec<CourtPlace>> {
    let problem = if region.size(league) > MAX_PLACES as f64 {
        let message = format!("has more than {MAX_PLACES} places; take a larger step");
        table.diagnostic("region", message)
    } else {
        match region.places(league, &settings.physics) {
            Ok(places) if !places.is_empty() => return Some(places),
            Ok(_) => table.diagnostic("region", "has no place that one can shoot from"),
            Err((row, error)) => table.diagnostic("places", format!("row {}: {error}", row + 1)),
        }
    };
    diagnostics.push(problem);
    None
}

impl SweepConfig {
    /// Whether the mirror image of a shot has the same probability on the other side.
    #[must_use]
    pub fn is_mirror_symmetric(&self) -> bool {
        let nominal = &self.settings.nominal;
        let choice = self.settings.search.choice;
        let is_zero = |spin: Option<f64>| spin.unwrap_or(0.0) == 0.0;
        (choice.includes(NominalVariable::Polar) || nominal.polar_rad.is_none())
            && is_zero(nominal.rifle_spin_rad_s)
            && (choice.includes(NominalVariable::SideSpin) || is_zero(nominal.side_spin_rad_s))
            && self.settings.shooter.dispersion.is_mirror_symmetric()
    }

    /// What results of this sweep are made from.
    ///
    /// # Errors
    /// The sweep cannot be serialised.
    pub fn provenance(&self) -> Result<Provenance, IdentityError> {
        let settings = &self.settings;
        let seed = settings.search.seed();
        Ok(Provenance::new(&self.hash()?, &settings.physics, seed))
    }

    /// BLAKE3 of everything that a result depends on: the checked sweep in SI units, and the
    /// program that computes it. Two files with the same meaning have the same hash.
    ///
    /// # Errors
    /// The sweep cannot be serialised.
    pub fn hash(&self) -> Result<String, IdentityError> {
        let program = (env!("CARGO_PKG_VERSION"), env!("BANKSHOT_COMMIT"));
        identity_hash(&(program, self))
    }
}
