//! `bankshot design`: what a test of some size will tell, before anyone shoots.

mod against;
mod changes;
mod tested_shot;

use self::against::Against;
use self::changes::{
    FirstSession, MOST_SHOTS, changes_json, least_change, shots_for, shots_for_changes,
    size_to_check,
};
use self::tested_shot::TestedShot;
use crate::cli::config_files::read_text;
use crate::cli::failure::{Failure, code};
use crate::cli::measured_shots_flags::tracker_noise;
use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_prose};
use crate::cli::value_parsers::{self, PhysicsArg, UnitsArg};
use crate::fitting::{
    Covariance, DesignRow, FitError, Landing, Place, TWO_SIDED_95, Tracker, TrackerNoise, design,
    landing_of, release_of_landing, tracked_flight_noise, values_of,
};
use crate::measured_shots::source::Source;
use crate::present::fit_files::session_changes_text::two_digits;
use crate::present::json_object::number;
use crate::shooter::{Nominal, Profile, ShotKind};
use crate::units::{DEGREE_RAD, UnitSystem};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Simulates tests of each size with the tracker's errors, fits them, and says how well the scatter and P come out. The usual \
shot comes from the flags, then from the profile's [nominal] table, else it is the best one; of a fit's folder it is the measured one. It takes a minute or two.

It also says how many shots show that the shooter has changed: of a fit's folder, in a second session against the shots that were fitted; of a profile, in each of two equal sessions, and with --first N in a second one against N shots. With --against OTHER, how many shots show that the two differ: in P, and in each scatter.

Examples:
  bankshot design results/gym-sensor-fit --tracker noah --target 3
  bankshot design configs/free_throw.toml --speed '24.2 ft/s' \\
    --pitch '51 deg' --shots 25,50,100,200 --tracker noah
  bankshot design results/rested --against results/tired")]
pub(crate) struct DesignOptions {
    /// A profile like that of the shooter, or the folder of a fit.
    pub(crate) profile: PathBuf,
    #[command(flatten)]
    pub(crate) physics: PhysicsArg,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    /// The sizes of the tests.
    #[arg(long, value_name = "N,N", value_delimiter = ',', default_value = "25,50,100,200", value_parser = clap::value_parser!(u32).range(10..=5000))]
    pub(crate) shots: Vec<u32>,
    /// The tracker: lab, noah, optical_25hz, optical_60hz, or a TOML file with its noise as for
    /// `fit` [default: that of the fit, else lab].
    #[arg(long, value_name = "NAME|FILE")]
    pub(crate) tracker: Option<String>,
    /// Of a fit with several places, the number of the place [default: 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) place: Option<u32>,
    /// Shots of a first session with the same tracker: ask what a second one shows against it
    /// [default: those of the fit, as they were measured; of a profile, none].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(10..=5000))]
    pub(crate) first: Option<u32>,
    /// A second profile, or the folder of a second fit, such as the same shooter when tired: ask
    /// how many shots show how the two differ.
    #[arg(long, value_name = "PROFILE|FIT_DIR")]
    pub(crate) against: Option<PathBuf>,
    /// Changes of P that a second session is to show, in points.
    #[arg(long, value_name = "POINTS", value_delimiter = ',', default_value = "5,10,20", value_parser = value_parsers::points)]
    pub(crate) change: Vec<f64>,
    /// Also ask how many shots make P known to this many points: as one standard deviation, and as
    /// a 95 % interval of so many points to each side.
    #[arg(long, value_name = "POINTS", value_parser = value_parsers::points)]
    pub(crate) target: Option<f64>,
    /// Units of the answer [default: those of the profile or the fit].
    #[arg(long)]
    pub(crate) units: Option<UnitsArg>,
    /// Print one JSON object.
    #[arg(long)]
    pub(crate) json: bool,
    /// Simulated tests of each size.
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = clap::value_parser!(u64).range(4..=10_000))]
    pub(crate) repetitions: u64,
}

/// What a tracker measures.
struct TrackerOfTest {
    /// Its name or its file, and where its noise is from.
    name: (String, String),
    noise: TrackerNoise,
    sees: Source,
}

/// The tracker of a name or of a file. A file with an error of the depth is that of a gym sensor,
/// one with that of a position a camera's, unless it is known what it `sees`.
fn tracker_named(name: &str, sees: Option<Source>) -> Result<TrackerOfTest, Failure> {
    let is_file = Tracker::named(name).is_none();
    let keys: toml::Table = if is_file && Path::new(name).exists() {
        read_text(Path::new(name))?.parse().unwrap_or_default()
    } else {
        toml::Table::new()
    };
    let sees = if let Some(sees) = sees {
        sees
    } else if name == "noah" || keys.contains_key("depth") {
        Source::Landings
    } else if name.starts_with("optical_") || keys.contains_key("position") {
        Source::Trajectories
    } else {
        Source::Releases
    };
    let (noise, name) = tracker_noise(name, sees)?;
    Ok(TrackerOfTest { name, noise, sees })
}

/// Simulated tests of each size: `48`, or `48 (12 of 970 shots)` where large sizes have fewer.
fn repetitions_in_words(rows: &[DesignRow], usual: u64) -> String {
    let fewer = rows.iter().filter(|row| row.repetitions != usual);
    let fewer: Vec<String> = fewer
        .map(|row| format!("{} of {} shots", row.repetitions, row.shots))
        .collect();
    match fewer.is_empty() {
        true => usual.to_string(),
        false => format!("{usual} ({})", fewer.join(", ")),
    }
}

/// Simulated tests of a size that the answer asked for, at least.
const LEAST_REPETITIONS: u64 = 12;

pub(crate) fn run(options: &DesignOptions, quiet: bool) -> Result<u8, Failure> {
    let named = options
        .tracker
        .as_deref()
        .map(|name| tracker_named(name, None))
        .transpose()?;
    let first_shot = TestedShot::read(
        &options.profile,
        &options.physics,
        options.place,
        &options.nominal,
        quiet,
    )?;
    let second_shot = options
        .against
        .as_deref()
        .map(|path| {
            let named = NominalOptions::default();
            TestedShot::read(path, &options.physics, options.place, &named, quiet)
        })
        .transpose()?;
    let (own_tracker, sees) = first_shot.tracker.clone();
    let units = options.units.map_or(first_shot.units, UnitSystem::from);
    let tracker = match named {
        Some(tracker) => tracker,
        None => tracker_named(&own_tracker, sees).map_err(|failure| Failure {
            message: format!(
                "the tracker of the fit: {}{}",
                failure.message,
                match Path::new(&own_tracker).exists() {
                    true => "",
                    false => "; run it in the folder of that file, or give --tracker FILE",
                }
            ),
            ..failure
        })?,
    };
    let (profile, nominal) = (&first_shot.profile, &first_shot.nominal);
    let own_noise = noise(&tracker, profile, nominal)?;
    let bars = ProgressBars::new(quiet);
    let simulate_of = |shot: &TestedShot, noise: &Covariance, sizes: &[usize]| {
        // A large test scatters less from one simulation to the next, and takes longer.
        let asked = options.shots.iter().chain(&options.first);
        let largest = u64::from(asked.copied().max().unwrap_or(0));
        let of_size = |shots: usize| match options.repetitions * largest / shots as u64 {
            fewer if shots as u64 > largest => {
                fewer.max(options.repetitions.min(LEAST_REPETITIONS))
            }
            _ => options.repetitions,
        };
        let sizes: Vec<(usize, u64)> = sizes.iter().map(|n| (*n, of_size(*n))).collect();
        design(&shot.profile, &shot.nominal, noise, &sizes, &bars).map_err(|error| Failure {
            code: match error {
                FitError::NotConverged { .. } => code::IMPRECISE,
                FitError::NoScatter => code::USAGE,
            },
            message: error.to_string(),
        })
    };
    let simulate = |sizes: &[usize]| simulate_of(&first_shot, &own_noise, sizes);
    let mut sizes: Vec<usize> = options.shots.iter().map(|n| *n as usize).collect();
    sizes.extend(options.first.map(|shots| shots as usize));
    sizes.sort_unstable();
    sizes.dedup();
    let mut rows = simulate(&sizes)?;
    let checked = size_to_check(&rows, &options.change);
    if let Some(shots) = checked {
        rows.extend(simulate(&[shots])?);
        sizes.push(shots);
    }
    // Shots that are there already were measured by the tracker of their fit.
    let first = options
        .first
        .map(|shots| FirstSession::designed(&rows, shots as usize))
        .or(first_shot.fitted.clone());
    let mut needed = None;
    let mut added = None;
    if let Some(points) = options.target {
        let shots = shots_for(&rows, points / 100.0);
        if (10..=MOST_SHOTS).contains(&shots) && !sizes.contains(&shots) {
            rows.extend(simulate(&[shots])?);
            rows.sort_by_key(|row| row.shots);
            added = Some(shots);
        }
        needed = Some((points, shots));
    }
    let against = second_shot
        .as_ref()
        .map(|second| {
            let second_noise = noise(&tracker, &second.profile, &second.nominal)?;
            let second_rows = simulate_of(second, &second_noise, &sizes)?;
            let both_rows = [&rows[..], &second_rows];
            let own_name = &second.profile.shooter().name;
            // Two sessions of one shooter have one name.
            let name = match (&options.against, profile.shooter().name == *own_name) {
                (Some(path), true) => path.display().to_string(),
                _ => own_name.clone(),
            };
            Ok::<_, Failure>(Against::new(
                name,
                [&first_shot, second],
                both_rows,
                [&own_noise, &second_noise],
                (first.as_ref(), units),
            ))
        })
        .transpose()?;
    if options.json {
        let name = &profile.shooter().name;
        return print_answer(&format!(
            "{:#}\n",
            json(
                name,
                (&tracker, first_shot.probability),
                (&rows, first.as_ref(), &options.change),
                (needed, against.as_ref())
            )
        ));
    }
    let (long, metre) = units.length();
    let mut text = format!(
        "{}: tests of the {} shot at {:.2} {long}/s and {:.1} deg, {}, which makes {:.1} of 100; with {} ({}), {} simulated tests of each size; all errors are one standard deviation (a 95 % interval reaches twice as far to each side)\n\n{:>6}  {:^29}  {:^24}  {:>14}\n{:>6} {:>9} {:>9} {:>9}  {:>11} {:>12}  {:>14}\n",
        profile.shooter().name,
        ShotKind::of(profile, nominal).name(),
        nominal.speed_m_s / metre,
        nominal.pitch_rad / DEGREE_RAD,
        profile.location().in_words(units),
        100.0 * first_shot.probability,
        tracker.name.0,
        tracker.name.1,
        repetitions_in_words(&rows, options.repetitions),
        "",
        "scatter is known to",
        "P is known to (points)",
        "P changed by",
        "shots",
        "speed",
        "pitch",
        "polar",
        "by the fit",
        "by counting",
        "shows (points)"
    );
    for row in &rows {
        let [speed, pitch, polar] = row.sd_errors.map(|error| 100.0 * error);
        text += &format!(
            "{:>6} {:>7.1} % {:>7.1} % {:>7.1} %  {:>11.1} {:>12.1}  {:>14.1}\n",
            row.shots,
            speed,
            pitch,
            polar,
            100.0 * row.probability_error,
            100.0 * row.counting_error,
            100.0 * least_change(row, first.as_ref())
        );
    }
    if let Some(shots) = checked {
        text += &format!(
            "\nThe row of {shots} shots is there because --change asks about tests as large as that.\n"
        );
    }
    text += &format!(
        "\n{}\n",
        shots_for_changes(&rows, first.as_ref(), &options.change)
    );
    if let Some(against) = &against {
        text += &format!("\n{}", against.text(first.as_ref()));
    }
    if let Some((points, shots)) = needed {
        let in_words = |shots: usize| match shots {
            MOST_SHOTS.. => format!("More than {MOST_SHOTS}"),
            shots => format!("About {}", two_digits(shots as f64)),
        };
        if let Some(shots) = added {
            text += &format!("\nThe row of {shots} shots checks what --target asks.\n");
        }
        // First the interval that `fit` prints.
        text += &format!(
            "\n{} shots in all make the 95 % interval of P reach {points} points to each side; {} make its standard deviation {points} points.\n",
            in_words(shots_for(&rows, points / 100.0 / TWO_SIDED_95)),
            in_words(shots).to_lowercase()
        );
        if let Some(first) = &first {
            let of_interval = shots_for(&rows, points / 100.0 / TWO_SIDED_95);
            if of_interval > first.shots && of_interval < MOST_SHOTS {
                text += &format!(
                    "Together with the {} shots of the first session that is about {} more.\n",
                    first.shots,
                    two_digits((of_interval - first.shots) as f64)
                );
            }
        }
    }
    let of_errors = rows.iter().map(|row| row.simulation_error);
    let of_error = of_errors.fold(0.0, f64::max);
    let sd = |i: usize, size: f64| own_noise[(i, i)].max(0.0).sqrt() / size;
    text += &format!(
        "\nWith {} simulated tests the errors of P are known to {:.0} %, the numbers of shots to {:.0} % (one standard deviation; --repetitions).\nAt this shot the tracker errs by {:.decimals$} {long}/s, {:.2} deg up and {:.2} deg sideways. The physics is taken as known: more shots do not tell it, and `bankshot physics` says what rests on it.\n",
        repetitions_in_words(&rows, options.repetitions),
        100.0 * of_error,
        200.0 * of_error,
        sd(0, metre),
        sd(1, DEGREE_RAD),
        sd(2, DEGREE_RAD),
        decimals = if units == UnitSystem::Metric { 3 } else { 2 }
    );
    print_prose(&text)
}

fn json(
    name: &str,
    (tracker, probability): (&TrackerOfTest, f64),
    (rows, first, changes): (&[DesignRow], Option<&FirstSession>, &[f64]),
    (needed, against): (Option<(f64, usize)>, Option<&Against>),
) -> Value {
    let listed = rows.iter().map(|row| {
        let [speed, pitch, polar] = row.sd_errors.map(number);
        json!({
            "shots": row.shots,
            "repetitions": row.repetitions,
            "speed_sd_relative_error": speed,
            "pitch_sd_relative_error": pitch,
            "polar_sd_relative_error": polar,
            "probability_error": number(row.probability_error),
            "simulation_error": number(row.simulation_error),
            "counting_error": number(row.counting_error),
            "least_change_of_probability": number(least_change(row, first)),
        })
    });
    json!({
        "shooter": name,
        "probability": number(probability),
        "tracker": tracker.name.0,
        "tracker_noise": tracker.name.1,
        "changes": changes_json(rows, first, changes),
        "first_session": first.map(|first| json!({
            "shots": first.shots,
            "probability_error": number(first.p.error()),
            "sd_relative_error": number(first.scatter.error()),
        })),
        "tests": listed.collect::<Value>(),
        "target": needed.map(|(points, shots)| json!({
            "probability_error": number(points / 100.0),
            "shots": shots,
        })),
        "against": against.map(Against::json),
    })
}

/// The tracker's errors as errors of the usual release.
fn noise(
    tracker: &TrackerOfTest,
    profile: &Profile,
    nominal: &Nominal,
) -> Result<Covariance, Failure> {
    let place = Place {
        location: profile.location(),
        release_height_m: profile.shooter().release_height_m,
    };
    let (simulator, values) = (profile.simulator(), values_of(nominal));
    let refuse = || Failure::usage("the usual shot does not fall through the height of the hoop");
    let landing: Landing = landing_of(simulator, &place, &values).ok_or_else(refuse)?;
    match tracker.sees {
        Source::Releases => Ok(tracker.noise.release_covariance()),
        Source::Trajectories => tracked_flight_noise(simulator, &place, &values, &tracker.noise)
            .map_err(|error| Failure::usage(format!("the usual shot, as tracked: {error}"))),
        Source::Landings => {
            let noise = &tracker.noise.landing;
            release_of_landing(simulator, &place, &landing, noise, values[3])
                .map(|(_, covariance)| covariance)
                .map_err(|_| refuse())
        }
    }
}
