//! Reads the folder of a fit; `answers/fit.rs` has what is written.

use super::StoreError;
use super::free_parameters::FreeParameter;
use super::sealed::Sealed;
use crate::config::parse_profile;
use crate::fitting::{
    Contradiction, Draw, DrawProbabilities, FitNote, Interval, KnownRelease, Place, Posterior,
    ShooterFit, SpinSource, VALUE_NAMES, Values, WeightedShots, fitted_profile,
    usual_probabilities, values_of,
};
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::measured_shots::source::Source;
use crate::shooter::{Location, Nominal, NominalVariable, Profile, ProfileError};
use crate::store::draws::read_draws;
use crate::store::parameters::value_units;
use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD, UnitSystem};
use serde::Deserialize;
use std::fs::File;
use std::path::Path;

/// The file that says what was fitted, and seals the others.
pub const FIT_FILE: &str = "fit.json";
/// The draws of the posterior.
pub const DRAWS_FILE: &str = "draws.parquet";
/// The shots that were fitted.
pub const SHOTS_FILE: &str = "shots.csv";
/// The page.
pub const PAGE_FILE: &str = "report.html";

/// Shots of the sample that P of the draws is computed with.
pub const SHOTS: usize = 65_536;

/// How far a spin in the profile of a fit may be from that of the fit, rad/s: it has three decimals
/// of rev/s.
const ROUNDING_OF_BACKSPIN_RAD_S: f64 = 0.001 * REV_RAD;

/// The file of the profile at a place, by its index.
#[must_use]
pub fn profile_file(place: usize) -> String {
    match place {
        0 => "profile.toml".to_owned(),
        _ => format!("profile_place_{}.toml", place + 1),
    }
}

/// The folder of the fit that a file of a profile belongs to, if its name is that of one.
#[must_use]
pub fn folder_of_profile(file: &Path) -> Option<&Path> {
    let name = file.file_name()?.to_string_lossy();
    let is_of_fit = name == "profile.toml" || name.starts_with("profile_place_");
    let folder = file.parent().filter(|_| is_of_fit)?;
    folder.join(FIT_FILE).is_file().then_some(folder)
}

/// P of a nominal shot with backspin alone, from the profile's location, over draws of the scatter.
#[must_use]
pub fn shot_over_draws(
    draws: &[Draw],
    profile: &Profile,
    nominal: &Nominal,
    shots: usize,
) -> DrawProbabilities {
    let values = values_of(nominal);
    // The scatter of the speed is that at this speed.
    let here: Vec<Draw> = draws.iter().map(|draw| draw.aimed_at(values)).collect();
    let seed = profile.search().seed;
    let sample = WeightedShots::simulate(profile, (&here, 0), &[values], shots, seed);
    sample.probabilities(&here, |_| values, |draw| draw.factor_at(0))
}

/// A fitted shooter.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The fitted profile at each place.
    pub profiles: Vec<Profile>,
    /// The name of each place; empty where the file of the shots does not say.
    pub place_names: Vec<String>,
    /// The draws.
    pub posterior: Posterior,
    /// At each place: made and all shots with a result.
    pub observed: Vec<(usize, usize)>,
    /// What should be said of the fit.
    pub notes: Vec<FitNote>,
    /// What was measured.
    pub source: Source,
    /// The name of the tracker, or the path of its file.
    pub tracker: String,
    /// The name of the shooter, if the file of the shots has it.
    pub shooter: Option<String>,
    /// The units that it was written in.
    pub units: UnitSystem,
    /// P of the current shot at each place; empty where it was not computed yet.
    probabilities: Vec<DrawProbabilities>,
}

/// What is read of `fit.json`.
#[derive(Debug, Deserialize)]
pub(super) struct FitJson {
    shooter: String,
    parameters: Vec<Parameter>,
    places: Vec<StoredPlace>,
    shots: usize,
    notes: Vec<FitNote>,
    source: StoredSource,
    #[serde(default)]
    pub(super) free: Vec<FreeParameter>,
}

#[derive(Debug, Deserialize)]
struct Parameter {
    name: String,
    source: String,
    low: f64,
    high: f64,
}

#[derive(Debug, Deserialize)]
struct StoredPlace {
    name: String,
    shots: usize,
    made: usize,
    court_angle_deg: f64,
    #[serde(flatten)]
    lengths: Lengths,
}

#[derive(Debug, Deserialize)]
#[serde(untagged)]
enum Lengths {
    Imperial {
        distance_ft: f64,
        release_height_ft: f64,
    },
    Metric {
        distance_m: f64,
        release_height_m: f64,
    },
}

#[derive(Debug, Deserialize)]
struct StoredSource {
    kind: Source,
    tracker: String,
    names_the_shooter: bool,
}

impl StoredPlace {
    fn place(&self) -> Place {
        let (distance_m, release_height_m) = match self.lengths {
            Lengths::Imperial {
                distance_ft,
                release_height_ft,
            } => (distance_ft * FOOT_M, release_height_ft * FOOT_M),
            Lengths::Metric {
                distance_m,
                release_height_m,
            } => (distance_m, release_height_m),
        };
        Place {
            location: Location {
                distance_m,
                angle_rad: self.court_angle_deg * DEGREE_RAD,
            },
            release_height_m,
        }
    }
}

pub(super) const AGAIN: &str = "fit the shots again";

pub(super) fn read_json(folder: &Path) -> Result<Sealed<FitJson>, StoreError> {
    Sealed::read(&folder.join(FIT_FILE), AGAIN)
}

/// What should be said of the fit of a folder.
///
/// # Errors
/// Its `fit.json` is damaged.
pub fn notes(folder: &Path) -> Result<Vec<FitNote>, StoreError> {
    Ok(read_json(folder)?.content.notes)
}

/// The name of the shooter whose fit is in a folder.
///
/// # Errors
/// Its `fit.json` is damaged.
pub fn shooter(folder: &Path) -> Result<String, StoreError> {
    Ok(read_json(folder)?.content.shooter)
}

impl Fit {
    /// How the makes contradict the measured shots, of the whole fit or of a place, where P of the
    /// current shot is `p`.
    #[must_use]
    pub fn contradiction(&self, place: usize, p: &Interval) -> Option<Contradiction> {
        let shots = self.observed.iter().map(|(_, shots)| shots).sum();
        Contradiction::of_fit(&self.notes, shots)
            .or_else(|| Contradiction::of_place(self.observed[place], p))
    }

    /// The fit of shots that no folder holds.
    #[must_use]
    pub fn of(fit: ShooterFit, shots: &ShooterShots, tracker: &str) -> Self {
        let made = |place| {
            let makes = fit.makes.at_place(place);
            (makes.made, makes.labelled)
        };
        Self {
            place_names: shots.place_names.clone(),
            observed: (0..fit.places.len()).map(made).collect(),
            notes: fit.notes,
            source: shots.source,
            tracker: tracker.to_owned(),
            shooter: Some(shots.name.clone()).filter(|name| !name.is_empty()),
            units: UnitSystem::default(),
            probabilities: fit.probabilities,
            posterior: fit.posterior,
            profiles: fit.profiles,
        }
    }

    /// Reads the folder of a fit.
    ///
    /// # Errors
    /// A file of it is missing or damaged.
    pub fn read(folder: &Path) -> Result<Self, StoreError> {
        let path = folder.join(FIT_FILE);
        let sealed = read_json(folder)?;
        let json = &sealed.content;
        let draws_path = folder.join(DRAWS_FILE);
        let spin = json.spin().ok_or_else(|| {
            StoreError::damaged(&path, format!("parameters: no backspin_mean; {AGAIN}"))
        })?;
        sealed.file(folder, DRAWS_FILE)?;
        let draws = File::open(&draws_path).map_err(|error| StoreError::io(&draws_path, error))?;
        let posterior = read_draws(draws, spin, json.shots)
            .map_err(|error| StoreError::damaged(&draws_path, error))?;
        if json.places.is_empty() || json.places.len() != posterior.draws[0].means.len() {
            let what = format!("places: other places than {DRAWS_FILE} has; {AGAIN}");
            return Err(StoreError::damaged(&path, what));
        }
        let written = read_profile(&folder.join(profile_file(0)))?;
        check_most_backspin(folder, &written, &posterior)?;
        let units = match json.places[0].lengths {
            Lengths::Imperial { .. } => UnitSystem::Imperial,
            Lengths::Metric { .. } => UnitSystem::Metric,
        };
        Ok(Self {
            profiles: profiles(json, &written, &posterior)?,
            place_names: json.places.iter().map(|place| place.name.clone()).collect(),
            observed: json.places.iter().map(|at| (at.made, at.shots)).collect(),
            source: json.source.kind,
            tracker: json.source.tracker.clone(),
            shooter: json.source.names_the_shooter.then(|| json.shooter.clone()),
            units,
            probabilities: Vec::new(),
            notes: sealed.content.notes,
            posterior,
        })
    }

    /// P of the current shot at a place.
    #[must_use]
    pub fn usual_probabilities(&self, place: usize) -> DrawProbabilities {
        let known = self.probabilities.get(place).cloned();
        let (profile, posterior) = (&self.profiles[place], &self.posterior);
        known.unwrap_or_else(|| usual_probabilities(profile, posterior, place, SHOTS))
    }

    /// The releases whose results are known, from the shots of its folder.
    ///
    /// # Errors
    /// The file of the shots is damaged.
    pub fn known_releases(&self, folder: &Path) -> Result<Vec<KnownRelease>, StoreError> {
        let bytes = read_json(folder)?.file(folder, SHOTS_FILE)?;
        let damaged = |what: String| StoreError::damaged(&folder.join(SHOTS_FILE), what);
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .from_reader(&bytes[..]);
        let headers = reader
            .headers()
            .map_err(|error| damaged(error.to_string()))?;
        let column = |name: &str| {
            let found = headers.iter().position(|header| header == name);
            found.ok_or_else(|| damaged(format!("has no column {name}")))
        };
        let mut of_values = Vec::new();
        for (name, (unit, size)) in VALUE_NAMES.iter().zip(value_units(self.units)) {
            let unit = unit.replace('/', "_");
            let columns = [
                column(&format!("{name}_{unit}"))?,
                column(&format!("{name}_error_{unit}"))?,
            ];
            of_values.push((columns, size));
        }
        let [place, made] = [column("place")?, column("made")?];
        let mut releases = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|error| damaged(error.to_string()))?;
            let number = |column: usize| record.get(column).and_then(|cell| cell.parse().ok());
            // Shots that were kept out have no values, those without a result tell nothing.
            let read = || {
                let made: f64 = number(made)?;
                let mut release = KnownRelease {
                    place: (number(place)? as usize).checked_sub(1)?,
                    release: Values::default(),
                    release_sd: Values::default(),
                    made: made > 0.5,
                };
                for (i, ([value, error], size)) in of_values.iter().enumerate() {
                    release.release[i] = number(*value)? * size;
                    release.release_sd[i] = number(*error)? * size;
                }
                Some(release)
            };
            releases.extend(read().filter(|release| release.place < self.profiles.len()));
        }
        Ok(releases)
    }
}

impl FitJson {
    /// The restitutions of the ring that the fit leaves possible; `None` where it was given.
    pub(super) fn ring(&self) -> Option<(f64, f64)> {
        let mut parameters = self.parameters.iter();
        let ring = parameters.find(|parameter| parameter.name == "hoop_restitution")?;
        Some((ring.low, ring.high))
    }

    fn spin(&self) -> Option<SpinSource> {
        let mut parameters = self.parameters.iter();
        let spin = parameters.find(|parameter| parameter.name == "backspin_mean")?;
        let mut parameters = self.parameters.iter();
        let has_no_direction = parameters
            .any(|parameter| parameter.name == "polar_mean" && parameter.source == "assumed");
        match (self.source.kind, has_no_direction) {
            (Source::Makes, _) => Some(SpinSource::NothingMeasured),
            (_, true) => Some(SpinSource::AssumedWithDirection),
            (_, false) => SpinSource::named(&spin.source),
        }
    }
}

fn read_profile(path: &Path) -> Result<Profile, StoreError> {
    let text = std::fs::read_to_string(path).map_err(|error| StoreError::io(path, error))?;
    Ok(parse_profile(&text, &path.display().to_string())?)
}

/// The profile at each place: with the draws' own digits, since a written profile is rounded, and
/// with what the user may have changed of the search.
fn profiles(
    json: &FitJson,
    written: &Profile,
    posterior: &Posterior,
) -> Result<Vec<Profile>, ProfileError> {
    let (name, typical) = (&written.shooter().name, posterior.typical());
    let keeps_backspin = !written.search().choice.includes(NominalVariable::Backspin);
    let at_place = |(i, place): (usize, &StoredPlace)| {
        let fitted = fitted_profile(name, written.physics(), &typical, &place.place())?;
        let profile = with_search_of(&fitted, written)?;
        // profile.toml has the usual backspin of the first place.
        if keeps_backspin && i > 0 {
            return profile.with(|settings| {
                settings.nominal.backspin_rad_s = Some(typical.means[i][3]);
            });
        }
        Ok(profile)
    };
    json.places.iter().enumerate().map(at_place).collect()
}

/// A profile with what a user may have changed of the search in the file of the fit.
fn with_search_of(fitted: &Profile, written: &Profile) -> Result<Profile, ProfileError> {
    let own = written.settings();
    let most = own.shooter.max_backspin_rad_s;
    let fitted_most = fitted.shooter().max_backspin_rad_s;
    let is_changed = libm::fabs(most - fitted_most) > ROUNDING_OF_BACKSPIN_RAD_S;
    fitted.with(|settings| {
        settings.search = own.search;
        settings.nominal = own.nominal;
        settings.grid = own.grid;
        if is_changed {
            settings.shooter.max_backspin_rad_s = most;
        }
    })
}

/// The current shot of a fit cannot have more backspin than the shooter can give.
fn check_most_backspin(
    folder: &Path,
    written: &Profile,
    posterior: &Posterior,
) -> Result<(), StoreError> {
    let most = written.shooter().max_backspin_rad_s;
    let means = posterior.typical().means;
    let usual = means.iter().map(|mean| mean[3]).fold(0.0, f64::max);
    if most >= usual - ROUNDING_OF_BACKSPIN_RAD_S {
        return Ok(());
    }
    let spin = most / REV_RAD;
    Err(StoreError::Refused(format!(
        "{}: shooter.max_backspin is {spin:.2} rev/s, but the shots were fitted with a backspin of {:.2} rev/s ({}); fit them again with --backspin '{spin:.2} rev/s'",
        folder.join(profile_file(0)).display(),
        usual / REV_RAD,
        posterior.spin.name()
    )))
}
