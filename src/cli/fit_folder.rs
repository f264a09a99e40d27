//! The folder of a fit, read again.

use super::config_files::{load_profile, read_text};
use super::failure::{Failure, code, refuse_missing};
use super::measured_shots_flags::MeasuredShotsOptions;
use super::shooter_folders::of_shooters;
use super::terminal::print_remark;
use super::value_parsers::PhysicsArg;
use crate::best_shot::{ShotAtPitch, TableShot};
use crate::fitting::{
    AngleOverDraws, Draw, DrawProbabilities, Interval, KnownRelease, Place, Posterior, SpinSource,
    VALUE_NAMES, Values, WeightedShots, best_angles_of_draws, fitted_profile, usual_probabilities,
    values_of,
};
use crate::measured_shots::source::Source;
use crate::output::fit_files::draws_table::read_draws;
use crate::output::fit_files::fit_text::probability_text;
use crate::output::fit_files::parameters::value_units;
use crate::shooter::{Location, Nominal, NominalVariable, Profile, ProfileError, ShotKind};
use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD, UnitSystem};
use std::fs::File;
use std::path::Path;

/// A fit that was written to a folder.
pub(crate) struct FitFolder {
    /// The fitted profile at each place.
    pub(crate) profiles: Vec<Profile>,
    /// The name of each place; empty where the file of the shots does not say.
    pub(crate) place_names: Vec<String>,
    pub(crate) posterior: Posterior,
    /// At each place: made and all shots with a result.
    pub(crate) observed: Vec<(usize, usize)>,
    /// What the fit warned of.
    pub(crate) warnings: Vec<String>,
    /// What was measured.
    pub(crate) source: Source,
    /// The name of the tracker, or the path of its file.
    pub(crate) tracker: String,
    /// The name of the shooter, if the file of the shots has it.
    pub(crate) shooter: Option<String>,
    /// The units that it was written in.
    pub(crate) units: UnitSystem,
}

fn damaged(path: &Path, message: impl std::fmt::Display) -> Failure {
    Failure {
        code: code::DAMAGED,
        message: format!("{}: {message}", path.display()),
    }
}

impl FitFolder {
    /// P of the usual shot at a place.
    pub(crate) fn usual_probabilities(&self, place: usize) -> DrawProbabilities {
        usual_probabilities(&self.profiles[place], &self.posterior, place, SHOTS)
    }

    /// The index of the place with a number, from 1; without a number the first.
    pub(crate) fn place_numbered(&self, number: Option<u32>) -> Result<usize, Failure> {
        index_of_place(number, self.profiles.len())
    }
}

/// The releases of a fit whose results are known, from its `shots.csv`.
pub(crate) fn read_releases(folder: &Path, fit: &FitFolder) -> Result<Vec<KnownRelease>, Failure> {
    let path = folder.join("shots.csv");
    let text = read_text(&path)?;
    let mut reader = csv::ReaderBuilder::new()
        .flexible(true)
        .from_reader(text.as_bytes());
    let headers = reader.headers().map_err(|error| damaged(&path, error))?;
    let column = |name: &str| {
        let mut names = headers.iter();
        let found = names.position(|header| header == name);
        found.ok_or_else(|| damaged(&path, format!("has no column {name}")))
    };
    let mut of_values = Vec::new();
    for (name, (unit, size)) in VALUE_NAMES.iter().zip(value_units(fit.units)) {
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
        let record = record.map_err(|error| damaged(&path, error))?;
        let number = |column: usize| record.get(column).and_then(|cell| cell.parse::<f64>().ok());
        // Shots that were kept out have no values, those without a result tell nothing.
        let read = || {
            let mut release = KnownRelease {
                place: (number(place)? as usize).checked_sub(1)?,
                release: Values::default(),
                release_sd: Values::default(),
                made: number(made)? > 0.5,
            };
            for (i, ([value, error], size)) in of_values.iter().enumerate() {
                release.release[i] = number(*value)? * size;
                release.release_sd[i] = number(*error)? * size;
            }
            Some(release)
        };
        let is_of_place = |release: &KnownRelease| release.place < fit.profiles.len();
        releases.extend(read().filter(is_of_place));
    }
    Ok(releases)
}

/// The index of the place with a number, from 1, of so many; without a number the first.
pub(crate) fn index_of_place(number: Option<u32>, places: usize) -> Result<usize, Failure> {
    let number = number.unwrap_or(1) as usize;
    if number > places {
        return Err(Failure::usage(format!(
            "--place {number}: there {}",
            match places {
                1 => "is one place".to_owned(),
                more => format!("are {more} places"),
            }
        )));
    }
    Ok(number - 1)
}

/// The file of the profile at a place, by its index.
pub(crate) fn profile_file(place: usize) -> String {
    match place {
        0 => "profile.toml".to_owned(),
        _ => format!("profile_place_{}.toml", place + 1),
    }
}

/// Refuses options that only a file of measured shots has a use for.
pub(crate) fn refuse_options_of_files(
    folder: &Path,
    options: &MeasuredShotsOptions,
) -> Result<(), Failure> {
    match options.first_about_a_file() {
        None => Ok(()),
        Some("--shooter") if !of_shooters(folder).is_empty() => Err(Failure::usage(format!(
            "--shooter: {} has a folder of each shooter; name that folder",
            folder.display()
        ))),
        Some(option) => Err(Failure::usage(format!(
            "{option}: {} is a fit already; fit the shots again with it",
            folder.display()
        ))),
    }
}

/// Reads the folder of a fit.
pub(crate) fn read(folder: &Path) -> Result<FitFolder, Failure> {
    refuse_missing(folder)?;
    let json_path = folder.join("fit.json");
    if !json_path.exists() {
        let place = folder.display();
        let names = of_shooters(folder);
        return Err(Failure::usage(if names.is_empty() {
            format!(
                "{place}: holds no fit (it has no fit.json); name a folder that `bankshot fit` wrote"
            )
        } else {
            let names: Vec<String> = names
                .iter()
                .map(|name| name.display().to_string())
                .collect();
            format!(
                "{place}: holds a fit of each shooter; name one: {}",
                names.join(", ")
            )
        }));
    }
    let json: serde_json::Value = serde_json::from_str(&read_text(&json_path)?)
        .map_err(|error| damaged(&json_path, error))?;
    let spin = json["parameters"]
        .as_array()
        .and_then(|all| all.iter().find(|p| p["name"] == "backspin_mean"))
        .map_or("assumed", |p| p["source"].as_str().unwrap_or("assumed"));
    let spin = match spin {
        "measured" => SpinSource::Measured,
        "given" => SpinSource::Given,
        _ => SpinSource::Assumed,
    };
    let draws_path = folder.join("draws.parquet");
    let file =
        File::open(&draws_path).map_err(|error| Failure::io(draws_path.display(), &error))?;
    let shots = json["shots"].as_u64().unwrap_or(0) as usize;
    let posterior = read_draws(file, spin, shots).map_err(|error| damaged(&draws_path, error))?;
    let written = load_profile(&folder.join("profile.toml"), &PhysicsArg::default(), true)?;
    let places = places(&json).map_err(|error| damaged(&json_path, error))?;
    check_most_backspin(folder, &written, &posterior)?;
    if places.len() != posterior.draws[0].means.len() {
        return Err(damaged(
            &json_path,
            "has other places than draws.parquet; fit again",
        ));
    }
    // The profile has rounded numbers; the draws have all digits.
    let (name, typical) = (&written.shooter().name, posterior.typical());
    let profiles = places
        .iter()
        .enumerate()
        .map(|(i, place)| {
            let fitted = fitted_profile(name, written.physics(), &typical, place)?;
            let profile = with_search_of(&fitted, &written)?;
            let keeps_backspin = !written.search().choice.includes(NominalVariable::Backspin);
            // profile.toml has the usual backspin of the first place.
            if keeps_backspin && i > 0 {
                return profile.with(|settings| {
                    settings.nominal.backspin_rad_s = Some(typical.means[i][3]);
                });
            }
            Ok(profile)
        })
        .collect::<Result<_, _>>()?;
    let name_of = |place: usize| json["places"][place]["name"].as_str().unwrap_or_default();
    let names = 0..places.len();
    Ok(FitFolder {
        profiles,
        place_names: names.map(|place| name_of(place).to_owned()).collect(),
        posterior,
        observed: observed(&json, places.len()),
        source: json["source"]["kind"]
            .as_str()
            .and_then(Source::named)
            .unwrap_or(Source::Releases),
        tracker: json["source"]["tracker"]
            .as_str()
            .unwrap_or_default()
            .to_owned(),
        shooter: json["source"]["names_the_shooter"]
            .as_bool()
            .unwrap_or(false)
            .then(|| name.clone()),
        units: if json["places"][0].get("distance_m").is_some() {
            UnitSystem::Metric
        } else {
            UnitSystem::Imperial
        },
        warnings: json["warnings"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|warning| warning.as_str().map(str::to_owned))
            .collect(),
    })
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

/// The usual shot of a fit cannot have more backspin than the shooter can give.
fn check_most_backspin(
    folder: &Path,
    written: &Profile,
    posterior: &Posterior,
) -> Result<(), Failure> {
    let most = written.shooter().max_backspin_rad_s;
    let means = posterior.typical().means;
    let usual = means.iter().map(|mean| mean[3]).fold(0.0, f64::max);
    if most >= usual - ROUNDING_OF_BACKSPIN_RAD_S {
        return Ok(());
    }
    let spin = most / REV_RAD;
    Err(Failure::usage(format!(
        "{}: shooter.max_backspin is {spin:.2} rev/s, but the shots were fitted with a backspin of {:.2} rev/s ({}); fit them again with --backspin '{spin:.2} rev/s'",
        folder.join("profile.toml").display(),
        usual / REV_RAD,
        match posterior.spin {
            SpinSource::Measured => "measured",
            SpinSource::Given => "given",
            SpinSource::Assumed => "assumed",
        }
    )))
}

/// How far a spin in the file of a fit may be from that of the fit, rad/s: it has three decimals of
/// rev/s.
const ROUNDING_OF_BACKSPIN_RAD_S: f64 = 0.001 * REV_RAD;

/// Made and all shots with a result at each place of `fit.json`. Before a place had its own there
/// was the count of all, which is that of an only place.
fn observed(json: &serde_json::Value, places: usize) -> Vec<(usize, usize)> {
    let count = |of: &serde_json::Value, name: &str| of[name].as_u64().unwrap_or(0) as usize;
    let at = |place: usize| {
        let own = &json["places"][place];
        let of = if own.get("made").is_none() && places == 1 {
            &json["observed"]
        } else {
            own
        };
        (count(of, "made"), count(of, "shots"))
    };
    (0..places).map(at).collect()
}

/// The places of `fit.json`, with lengths in the unit of their names.
fn places(json: &serde_json::Value) -> Result<Vec<Place>, String> {
    let listed = json["places"].as_array().ok_or("has no places")?;
    let value = |place: &serde_json::Value, names: [(&str, f64); 2]| {
        let found = names
            .iter()
            .find_map(|(name, size)| Some(place[*name].as_f64()? * size));
        found.ok_or_else(|| format!("a place has no {}", names[0].0))
    };
    listed
        .iter()
        .map(|place| {
            Ok(Place {
                location: Location {
                    distance_m: value(place, [("distance_ft", FOOT_M), ("distance_m", 1.0)])?,
                    angle_rad: value(place, [("court_angle_deg", DEGREE_RAD); 2])?,
                },
                release_height_m: value(
                    place,
                    [("release_height_ft", FOOT_M), ("release_height_m", 1.0)],
                )?,
            })
        })
        .collect()
}

/// Why a shot has no P over the draws of a fit.
const NO_OTHER_SPIN: &str =
    "--draws: a fit knows backspin alone; this shot has side spin or rifle spin";

/// Shots of the sample that P of the draws is computed with.
const SHOTS: usize = 65_536;

/// P of a nominal shot from the profile's location over draws of the scatter.
pub(crate) fn probability_over_draws(
    draws: &[Draw],
    profile: &Profile,
    nominal: &Nominal,
    shots: usize,
) -> Result<DrawProbabilities, Failure> {
    if nominal.rifle_spin_rad_s != 0.0 || nominal.side_spin_rad_s != 0.0 {
        return Err(Failure::usage(NO_OTHER_SPIN));
    }
    let values = values_of(nominal);
    // The scatter of the speed is that at this speed.
    let here: Vec<Draw> = draws.iter().map(|draw| draw.aimed_at(values)).collect();
    let seed = profile.search().seed;
    let sample = WeightedShots::simulate(profile, (&here, 0), &[values], shots, seed);
    Ok(sample.probabilities(&here, |_| values, |draw| draw.factor_at(0)))
}

/// The fit that a profile was written by: that of its folder. `None` if there is none.
pub(crate) fn of_profile(file: &Path) -> Result<Option<FitFolder>, Failure> {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    let is_of_fit = name == "profile.toml" || name.starts_with("profile_place_");
    let folder = file.parent().filter(|_| is_of_fit);
    match folder.filter(|folder| folder.join("draws.parquet").is_file()) {
        Some(folder) => read(folder).map(Some),
        None => Ok(None),
    }
}

/// By how much a bank shot from the profile's location is better than a direct one, for each draw
/// of a fit.
pub(crate) fn bank_gain_over_draws(
    fit: &FitFolder,
    profile: &Profile,
    [direct, bank]: [&Nominal; 2],
) -> Result<DrawProbabilities, Failure> {
    let p = |shot| probability_over_draws(&fit.posterior.draws, profile, shot, SHOTS);
    Ok(p(bank)?.minus(&p(direct)?))
}

/// Reads the folder of `--draws`, with a warning where its fit is that of another shooter.
pub(crate) fn read_draws_of<'a>(
    folder: Option<&'a Path>,
    profile: &Profile,
) -> Result<Option<(&'a Path, FitFolder)>, Failure> {
    let Some(folder) = folder else {
        return Ok(None);
    };
    let fit = read(folder)?;
    let shooter = &fit.profiles[0].shooter().name;
    if *shooter != profile.shooter().name {
        print_remark(&format!(
            "warning: the draws in {} are those of {shooter}, and the profile is that of {}",
            folder.display(),
            profile.shooter().name
        ));
    }
    Ok(Some((folder, fit)))
}

/// P of a nominal shot over the draws of a fit.
pub(crate) fn shot_over_draws(
    fit: &FitFolder,
    profile: &Profile,
    nominal: &Nominal,
) -> Result<DrawProbabilities, Failure> {
    probability_over_draws(&fit.posterior.draws, profile, nominal, SHOTS)
}

/// P over the draws of a fit of the usual shot at a place with one value given: of each draw the
/// other values are its own means.
pub(crate) fn usual_shot_over_draws(
    (fit, place): (&FitFolder, usize),
    profile: &Profile,
    (variable, value): (NominalVariable, f64),
) -> Result<DrawProbabilities, Failure> {
    let index = match variable {
        NominalVariable::Speed => 0,
        NominalVariable::Pitch => 1,
        NominalVariable::Polar => 2,
        NominalVariable::Backspin => 3,
        NominalVariable::SideSpin | NominalVariable::RifleSpin => {
            return Err(Failure::usage(NO_OTHER_SPIN));
        }
    };
    let with_value = |draw: &Draw| {
        let mut means = draw.means[place];
        means[index] = value;
        means
    };
    let draws = &fit.posterior.draws;
    let means: Vec<Values> = draws.iter().map(with_value).collect();
    // The scatter of the speed is that at this speed.
    let here = draws
        .iter()
        .zip(&means)
        .map(|(draw, means)| draw.aimed_at(*means));
    let here: Vec<Draw> = here.collect();
    let sample = WeightedShots::simulate(profile, (&here, 0), &means, SHOTS, profile.search().seed);
    Ok(sample.probabilities(&here, |draw| draw.means[0], |draw| draw.factor_at(0)))
}

/// P of a nominal shot over the draws of a fit, in words.
pub(crate) fn text_over_draws((folder, fit): (&Path, &FitFolder), p: &DrawProbabilities) -> String {
    format!("{}: {}\n", which_draws(folder, fit), probability_text(p))
}

/// P of the best shot of each kind over the draws of a fit, and of bank less direct, in words.
pub(crate) fn kinds_over_draws(
    (folder, fit): (&Path, &FitFolder),
    profile: &Profile,
    nominals: &[(ShotKind, &Nominal)],
) -> Result<String, Failure> {
    let mut text = format!("{}:\n", which_draws(folder, fit));
    let mut by_kind = Vec::new();
    for (kind, nominal) in nominals {
        let p = probability_over_draws(&fit.posterior.draws, profile, nominal, SHOTS)?;
        text += &format!("{}: {}\n", kind.name(), probability_text(&p));
        by_kind.push((*kind, p));
    }
    if let [(ShotKind::Direct, direct), (ShotKind::Bank, bank)] = &by_kind[..] {
        let difference = bank.minus(direct);
        let points = difference.interval().scaled(100.0);
        let sure = 100.0 * difference.share_positive();
        text += &format!(
            "bank less direct, draw by draw: {:+.1} points (95 %: {:+.1} to {:+.1}); bank is the better one in {sure:.0} of 100 draws\n",
            points.mean, points.low, points.high
        );
    }
    text += "P above uses the typical scatter. P is not linear in it, so the mean over the draws can differ by some tenths of a point.\n";
    Ok(text)
}

/// P of the best shot at each pitch angle over the draws of a fit.
pub(crate) struct OverDraws {
    pub(crate) angles: Vec<Option<AngleOverDraws>>,
    /// The first and the last of the angles between which the best one lies in 95 of 100 draws.
    best: Option<(usize, usize)>,
}

/// P of the best shot at each pitch angle over the draws of a fit.
pub(crate) fn angles_over_draws(
    fit: &FitFolder,
    profile: &Profile,
    rows: &[ShotAtPitch],
) -> Result<OverDraws, Failure> {
    let shots = rows.iter().map(|row| row.shot.as_ref());
    let p = |shot: Option<&TableShot>| {
        shot.map(|shot| probability_over_draws(&fit.posterior.draws, profile, &shot.nominal, SHOTS))
            .transpose()
    };
    let angles: Vec<_> = shots.map(p).collect::<Result<_, Failure>>()?;
    Ok(OverDraws {
        best: best_angles_of_draws(&angles),
        angles: AngleOverDraws::of_angles(&angles),
    })
}

/// The same in words.
pub(crate) fn angles_in_words(
    (folder, fit): (&Path, &FitFolder),
    rows: &[ShotAtPitch],
    over_draws: &OverDraws,
) -> String {
    let angles = rows.iter().zip(&over_draws.angles);
    let angles: Vec<(f64, AngleOverDraws)> = angles
        .filter_map(|(row, angle)| Some((row.pitch_rad / DEGREE_RAD, (*angle)?)))
        .collect();
    let mean = |(_, angle): &(f64, AngleOverDraws)| angle.probability.mean;
    let best = angles.iter().max_by(|a, b| mean(a).total_cmp(&mean(b)));
    let Some((best_deg, _)) = best else {
        return String::new();
    };
    let mut text = format!(
        "{}:\npitch (deg), P (95 %), points less than at {best_deg:.1} deg, draw by draw (95 %). That angle has the greatest mean.\n",
        which_draws(folder, fit)
    );
    for (pitch_deg, angle) in &angles {
        let [mean, low, high] = percents(&angle.probability);
        let [less, least, most] = percents(&angle.less);
        text += &format!(
            "{pitch_deg:>5.1}  {mean:>5.1} ({low:>4.1} to {high:>4.1})  {less:>5.1} ({least:>+5.1} to {most:>+5.1})\n"
        );
    }
    if let Some((low, high)) = over_draws.best {
        let [low, high] = [low, high].map(|i| rows[i].pitch_rad / DEGREE_RAD);
        text += &format!(
            "The best of these angles: {} in 95 of 100 draws.\n",
            match low < high {
                true => format!("from {low:.1} to {high:.1} deg"),
                false => format!("{low:.1} deg"),
            }
        );
    }
    text
}

/// Mean and ends in percent. Rounded first, and 0 added: no negative zero.
fn percents(interval: &Interval) -> [f64; 3] {
    [interval.mean, interval.low, interval.high].map(|p| libm::round(1000.0 * p) / 10.0 + 0.0)
}

/// Which draws an interval is over, and what it leaves out.
fn which_draws(folder: &Path, fit: &FitFolder) -> String {
    format!(
        "over {} draws of the scatter in {}, the intended release being exact (the interval of P that `fit` prints has the uncertain means too; any other one is numerical)",
        fit.posterior.draws.len(),
        folder.display()
    )
}
