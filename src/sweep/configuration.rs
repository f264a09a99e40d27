//! What a sweep is asked for: from TOML to a checked [`Configuration`].

use super::region::{MOST_PLACES, Region, Spot};
use crate::court::League;
use crate::output::releases;
use crate::probability::best::ShotKind;
use crate::probability::lessons::Topics;
use crate::profile::fault::{Fault, ProfileError};
use crate::profile::keys::Keys;
use crate::profile::read::{check, parse, read_template, with_table};
use crate::profile::{Intent, Template};
use crate::units::Dimension;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// A checked sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Configuration {
    /// For titles and the results' folder.
    pub name: String,
    /// Whose court.
    pub league: League,
    /// Which places.
    pub region: Region,
    /// What is computed at each.
    pub compute: Compute,
    /// The shooter and the rest of a profile.
    pub template: Template,
    /// The places in the order of the results.
    #[serde(skip)]
    pub spots: Vec<Spot>,
}

/// What is computed at each place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Compute {
    /// The best direct shot.
    pub direct: bool,
    /// The best bank shot.
    pub bank: bool,
    /// What spin is worth to them.
    pub spin: bool,
    /// What each error costs them.
    pub errors: bool,
}

const COMPUTE: [&str; 4] = ["direct", "bank", "spin", "errors"];

impl Compute {
    /// The kinds of shots.
    #[must_use]
    pub fn kinds(self) -> Vec<ShotKind> {
        [(ShotKind::Direct, self.direct), (ShotKind::Bank, self.bank)]
            .into_iter()
            .filter_map(|(kind, wanted)| wanted.then_some(kind))
            .collect()
    }

    /// The lessons that are drawn.
    #[must_use]
    pub fn topics(self) -> Topics {
        Topics {
            costs: self.errors,
            spins: self.spin,
            ..Topics::NONE
        }
    }
}

/// The texts that a configuration was read from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Texts {
    /// The sweep's own.
    pub sweep: String,
    /// The shooter's profile, where the sweep names one.
    pub shooter: Option<String>,
    /// The file of places, where the sweep names one.
    pub places: Option<String>,
}

/// Other files that a sweep names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// The shooter's profile.
    pub shooter: Option<String>,
    /// The places.
    pub places: Option<String>,
}

/// Is this text meant as a sweep?
#[must_use]
pub fn is_sweep(text: &str) -> bool {
    let (table, _) = toml::de::DeTable::parse_recoverable(text);
    table.get_ref().contains_key("sweep")
}

/// The files that a sweep names; none where the text is not sound, which [`parse_sweep`] tells.
#[must_use]
pub fn names(text: &str) -> Names {
    let (table, _) = toml::de::DeTable::parse_recoverable(text);
    let mut faults = Vec::new();
    let mut sweep = Keys::root(&table).table("sweep", &mut faults);
    Names {
        shooter: sweep.text("shooter", &mut faults),
        places: sweep.text("places", &mut faults),
    }
}

/// Checks a sweep; `origin` names it in messages.
///
/// # Errors
/// Every fault at once; those of a shooter's profile first.
pub fn parse_sweep(texts: &Texts, origin: &str) -> Result<Configuration, ProfileError> {
    let named = names(&texts.sweep);
    let file = match (&named.shooter, &texts.shooter) {
        (Some(name), Some(text)) => Some(parse(text, name)?),
        _ => None,
    };
    let places = match (&named.places, &texts.places) {
        (Some(_), Some(text)) => Some(releases::places(text)),
        _ => None,
    };
    with_table(&texts.sweep, origin, |mut root, faults| {
        let mut keys = root.table("sweep", faults);
        if !root.has("sweep") {
            faults.push(keys.here("there is no [sweep] table in this file"));
        }
        let name = keys.text("name", faults).unwrap_or_else(|| "sweep".into());
        if name.is_empty() || name.chars().count() > 500 || name.chars().any(char::is_control) {
            let message = "must have 1 to 500 characters, none of them a control character";
            faults.push(keys.fault("name", message));
        }
        let _ = keys.text("shooter", faults);
        let league = read_league(&mut keys, faults);
        let compute = read_compute(&mut keys, faults);
        let region = read_region(&mut keys, places, faults);
        let place = keys.clone();
        keys.finish(faults);
        let template = if named.shooter.is_some() {
            for table in ["shooter", "physics", "nominal"] {
                if root.has(table) {
                    faults.push(root.fault(
                        table,
                        "is that of the file that sweep.shooter names; leave it out",
                    ));
                }
            }
            from_file(&mut root, file, faults)
        } else {
            read_template(&mut root, faults)
        };
        root.finish(faults);
        let (template, region) = (template?, region?);
        let spots = read_spots(&region, league, &template, &place, faults)?;
        Some(Configuration {
            name,
            league,
            region,
            compute,
            template,
            spots,
        })
    })
}

/// The shooter, the physics and the nominal values of a profile, the rest from the sweep.
fn from_file(
    root: &mut Keys<'_, '_>,
    file: Option<crate::profile::Profile>,
    faults: &mut Vec<Fault>,
) -> Option<Template> {
    let Some(file) = file else {
        faults.push(root.fault("sweep", "the file of the shooter was not read"));
        return None;
    };
    crate::profile::read::read_rest(
        root,
        file.shooter,
        file.nominal,
        (file.physics, file.integrator),
        faults,
    )
}

fn read_league(keys: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> League {
    let Some(name) = keys.text("court", faults) else {
        return League::Ncaa;
    };
    League::named(&name).unwrap_or_else(|| {
        faults.push(keys.fault("court", "must be \"ncaa\", \"nba\" or \"fiba\""));
        League::Ncaa
    })
}

fn read_compute(keys: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> Compute {
    let names = keys
        .texts("compute", faults)
        .unwrap_or_else(|| vec!["direct".to_owned(), "bank".to_owned()]);
    let has = |what: &str| names.iter().any(|name| name == what);
    let known = names.iter().all(|name| COMPUTE.contains(&name.as_str()));
    if !known || !(has("direct") || has("bank")) {
        let all = COMPUTE.join(", ");
        faults.push(keys.fault(
            "compute",
            format!("must name direct or bank or both, and may name the rest of {all}"),
        ));
    }
    Compute {
        direct: has("direct"),
        bank: has("bank"),
        spin: has("spin"),
        errors: has("errors"),
    }
}

fn read_region(
    keys: &mut Keys<'_, '_>,
    places: Option<Result<Vec<(f64, f64)>, String>>,
    faults: &mut Vec<Fault>,
) -> Option<Region> {
    let before = faults.len();
    let kind = keys.text("region", faults);
    let mut length = |key, faults: &mut Vec<Fault>| {
        let value = keys.quantity(key, Dimension::Length, faults);
        check(keys, key, value, |l| l >= 0.001, "0.001 m or more", faults)
    };
    let step = length("step", faults);
    let within = keys.text("within", faults);
    let x = range(keys, "x", Dimension::Length, faults);
    let y = range(keys, "y", Dimension::Length, faults);
    let distances = keys.quantities("distances", Dimension::Length, faults);
    let angles = range(keys, "angles", Dimension::Angle, faults);
    let angle_step = keys.quantity("angle_step", Dimension::Angle, faults);
    let angle_step = check(
        keys,
        "angle_step",
        angle_step,
        |a| a >= 1e-5,
        "0.00001 rad or more",
        faults,
    );
    let file = keys.text("places", faults);
    let needs: &[&str] = match kind.as_deref() {
        Some("half_court" | "three_point_line") => &["step"],
        Some("rectangle") => &["step", "x", "y"],
        Some("arcs") => &["distances", "angle_step"],
        Some("places") => &["places"],
        _ => {
            let message = "must be \"half_court\", \"rectangle\", \"arcs\", \"three_point_line\" or \"places\"";
            faults.push(keys.fault("region", message));
            &[]
        }
    };
    for key in needs {
        if !keys.has(key) {
            let region = kind.as_deref().unwrap_or_default();
            faults.push(keys.fault(key, format!("is missing; the region \"{region}\" needs it")));
        }
    }
    let may: &[&str] = match kind.as_deref() {
        Some("half_court") => &["within"],
        Some("arcs") => &["angles"],
        _ => &[],
    };
    for key in [
        "step",
        "within",
        "x",
        "y",
        "distances",
        "angles",
        "angle_step",
        "places",
    ] {
        if keys.has(key) && !needs.contains(&key) && !may.contains(&key) && !needs.is_empty() {
            let region = kind.as_deref().unwrap_or_default();
            faults.push(keys.fault(key, format!("does not belong to the region \"{region}\"")));
        }
    }
    let inside_three = match within.as_deref() {
        None | Some("court") => false,
        Some("three_point_line") => true,
        Some(_) => {
            faults.push(keys.fault("within", "must be \"court\" or \"three_point_line\""));
            false
        }
    };
    let places = match places {
        Some(Ok(places)) => Some(places),
        Some(Err(message)) => {
            faults.push(keys.fault("places", message));
            None
        }
        None => None,
    };
    if faults.len() > before {
        return None;
    }
    Some(match kind.as_deref()? {
        "half_court" => Region::HalfCourt {
            step_m: step?,
            inside_three,
        },
        "rectangle" => Region::Rectangle {
            step_m: step?,
            x_m: x?,
            y_m: y?,
        },
        "arcs" => Region::Arcs {
            distances_m: distances?,
            angles_rad: angles.unwrap_or((-FRAC_PI_2, FRAC_PI_2)),
            step_rad: angle_step?,
        },
        "three_point_line" => Region::ThreePointLine { step_m: step? },
        _ => {
            file?;
            Region::Places(places?)
        }
    })
}

/// Two quantities, the lower first.
fn range(
    keys: &mut Keys<'_, '_>,
    key: &'static str,
    dimension: Dimension,
    faults: &mut Vec<Fault>,
) -> Option<(f64, f64)> {
    let values = keys.quantities(key, dimension, faults)?;
    match values[..] {
        [low, high] if low < high && high - low < 1000.0 => Some((low, high)),
        _ => {
            faults.push(keys.fault(key, "must be two quantities, the lower first"));
            None
        }
    }
}

fn read_spots(
    region: &Region,
    league: League,
    template: &Template,
    keys: &Keys<'_, '_>,
    faults: &mut Vec<Fault>,
) -> Option<Vec<Spot>> {
    if region.size(league) > MOST_PLACES as f64 {
        let message = format!("has more than {MOST_PLACES} places; take a larger step");
        faults.push(keys.fault("region", message));
        return None;
    }
    match region.spots(league, &template.physics) {
        Ok(spots) if spots.is_empty() => {
            faults.push(keys.fault("region", "holds no place that one can shoot from"));
            None
        }
        Ok(spots) => Some(spots),
        Err((row, error)) => {
            faults.push(keys.fault("places", format!("row {}: {error}", row + 1)));
            None
        }
    }
}

impl Configuration {
    /// Does a shot from one side have its mirror image on the other?
    #[must_use]
    pub fn is_symmetric(&self) -> bool {
        let Intent {
            polar_rad,
            rifle_spin_rad_s,
            side_spin_rad_s,
            ..
        } = self.template.nominal;
        let choose = self.template.search.choose;
        let none = |spin: Option<f64>| spin.unwrap_or(0.0) == 0.0;
        (choose.polar || polar_rad.is_none())
            && none(rifle_spin_rad_s)
            && (choose.side_spin || none(side_spin_rad_s))
            && self.template.shooter.errors.mirror_alike()
    }

    /// BLAKE3 of everything that a result depends on: the checked configuration in SI units, and which
    /// program computes it. Two files that mean the same have the same.
    #[must_use]
    pub fn hash(&self) -> String {
        let program = (env!("CARGO_PKG_VERSION"), env!("BANKSHOT_COMMIT"));
        let text = serde_json::to_string(&(program, self)).unwrap_or_default();
        blake3::hash(text.as_bytes()).to_hex().to_string()
    }
}
