//! `bankshot design`: what a test of some size will tell, before anyone shoots.

use crate::analysis::sensitivity::SensitivityTopics;
use crate::best_shot::find_kinds;
use crate::cli::config_files::{load_profile, read_text};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder::{self, FitFolder};
use crate::cli::measured_shots_flags::tracker_noise;
use crate::cli::nominal_shot_flags::NominalOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::cli::value_parsers::{self, PhysicsArg, UnitsArg};
use crate::fitting::{
    Covariance, DesignRow, FitError, Landing, POWER, Place, SessionError, TWO_SIDED_95, Tracker,
    TrackerNoise, design, landing_of, nominal_of, release_of_landing, tracked_flight_noise,
    values_of,
};
use crate::measured_shots::source::Source;
use crate::output::fit_files::session_changes_text::two_digits;
use crate::output::json_object::number;
use crate::probability::{Sampler, Silent};
use crate::shooter::{Nominal, Profile, ShotKind};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Simulates tests of each size with the tracker's errors, fits them, and says how well the scatter and P come out. The usual \
shot comes from the flags, then from the profile's [nominal] table, else it is the best one; of a fit's folder it is the measured one. It takes a minute or two.

It also says how many shots show that the shooter has changed: of a fit's folder, in a second session against the shots that were fitted; of a profile, in each of two equal sessions, and with --first N in a second one against N shots.

Examples:
  bankshot design results/gym-sensor-fit --tracker noah --target 3
  bankshot design configs/free_throw.toml --speed '24.2 ft/s' \\
    --pitch '51 deg' --shots 25,50,100,200 --tracker noah")]
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

pub(crate) fn run(options: &DesignOptions, quiet: bool) -> Result<u8, Failure> {
    let named = options
        .tracker
        .as_deref()
        .map(|name| tracker_named(name, None))
        .transpose()?;
    let mut fitted = None;
    let (profile, nominal, (own_tracker, sees), own_units) = if options.profile.is_dir() {
        let fit = fit_folder::read(&options.profile)?;
        let place = fit.place_numbered(options.place)?;
        let usual = nominal_of(&fit.posterior.typical().means[place]);
        if fit.profiles.len() > 1 && !quiet {
            print_remark(&format!(
                "the fit has {} places: tests from place {}, {}",
                fit.profiles.len(),
                place + 1,
                fit.profiles[place].location().in_words(fit.units)
            ));
        }
        fitted = Some(FirstSession::of_fit(&fit, place));
        let tracker = (fit.tracker, Some(fit.source));
        (fit.profiles[place].clone(), usual, tracker, fit.units)
    } else if options.place.is_some() {
        return Err(Failure::usage(
            "--place: only the folder of a fit has places",
        ));
    } else {
        let profile = load_profile(&options.profile, &options.physics, quiet)?;
        let nominal = if options.nominal.is_given(&profile) {
            options.nominal.resolve(&profile)?
        } else {
            best_nominal(&profile, quiet)?
        };
        let units = profile.output().units;
        (profile, nominal, ("lab".to_owned(), None), units)
    };
    let units = options.units.map_or(own_units, UnitSystem::from);
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
    let noise = noise(&tracker, &profile, &nominal)?;
    let bars = ProgressBars::new(quiet);
    let search = profile.search();
    let sampler = Sampler::new(&profile);
    let usual = sampler.estimate(&nominal, search.standard_error, search.seed, &Silent);
    let simulate = |sizes: &[usize]| {
        design(
            &profile,
            &nominal,
            &noise,
            sizes,
            options.repetitions,
            &bars,
        )
        .map_err(|error| Failure {
            code: match error {
                FitError::NotConverged { .. } => code::IMPRECISE,
                FitError::NoScatter => code::USAGE,
            },
            message: error.to_string(),
        })
    };
    let mut sizes: Vec<usize> = options.shots.iter().map(|n| *n as usize).collect();
    sizes.extend(options.first.map(|shots| shots as usize));
    sizes.sort_unstable();
    sizes.dedup();
    let mut rows = simulate(&sizes)?;
    // Shots that are there already were measured by the tracker of their fit.
    let first = options
        .first
        .map(|shots| FirstSession::designed(&rows, shots as usize))
        .or(fitted);
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
    if options.json {
        let name = &profile.shooter().name;
        return print_answer(&format!(
            "{:#}\n",
            json(
                name,
                (&tracker, usual.probability),
                (&rows, first.as_ref(), &options.change),
                needed
            )
        ));
    }
    let (long, metre) = units.length();
    let mut text = format!(
        "{}: tests of the {} shot at {:.2} {long}/s and {:.1} deg, {}, which makes {:.1} of 100; with {} ({}), {} simulated tests of each size; all errors are one standard deviation (a 95 % interval reaches twice as far to each side)\n\n{:>6}  {:^29}  {:^24}  {:>14}\n{:>6} {:>9} {:>9} {:>9}  {:>11} {:>12}  {:>14}\n",
        profile.shooter().name,
        ShotKind::of(&profile, &nominal).name(),
        nominal.speed_m_s / metre,
        nominal.pitch_rad / DEGREE_RAD,
        profile.location().in_words(units),
        100.0 * usual.probability,
        tracker.name.0,
        tracker.name.1,
        options.repetitions,
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
    text += &format!(
        "\n{}\n",
        shots_for_changes(&rows, first.as_ref(), &options.change)
    );
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
    let sd = |i: usize, size: f64| noise[(i, i)].max(0.0).sqrt() / size;
    text += &format!(
        "\nWith {} simulated tests the errors of P are known to {:.0} %, the numbers of shots to {:.0} % (one standard deviation; --repetitions).\nAt this shot the tracker errs by {:.decimals$} {long}/s, {:.2} deg up and {:.2} deg sideways. The physics is taken as known: more shots do not tell it, and `bankshot physics` says what rests on it.\n",
        options.repetitions,
        100.0 * of_error,
        200.0 * of_error,
        sd(0, metre),
        sd(1, DEGREE_RAD),
        sd(2, DEGREE_RAD),
        decimals = if units == UnitSystem::Metric { 3 } else { 2 }
    );
    print_prose(&text)
}

/// The best shot, where no shot is named.
fn best_nominal(profile: &Profile, quiet: bool) -> Result<Nominal, Failure> {
    let topics = SensitivityTopics::NONE;
    let bars = ProgressBars::new(quiet);
    let (_, shots) = find_kinds(profile, &ShotKind::ALL, topics, &bars)?;
    let best = shots
        .into_iter()
        .flatten()
        .max_by(|a, b| a.estimate.probability.total_cmp(&b.estimate.probability))
        .ok_or_else(|| {
            Failure::usage("no clean shot from there; name one with --speed and --pitch")
        })?;
    if !quiet {
        let (long, metre) = profile.output().units.length();
        print_remark(&format!(
            "no shot is named: tests of the best one, {} at {:.2} {long}/s and {:.1} deg, {:.1} rev/s",
            ShotKind::of(profile, &best.nominal).name(),
            best.nominal.speed_m_s / metre,
            best.nominal.pitch_rad / DEGREE_RAD,
            best.nominal.backspin_rad_s / REV_RAD
        ));
    }
    Ok(best.nominal)
}

/// The smallest and the largest test.
const LEAST_SHOTS: f64 = 10.0;
const MOST_SHOTS: usize = 5000;

/// A session that is there already.
struct FirstSession {
    shots: usize,
    /// How far it knows P, and the scatter (relative).
    p: SessionError,
    scatter: SessionError,
}

impl FirstSession {
    /// The shots of a fit at a place: as the fit knows them.
    fn of_fit(fit: &FitFolder, place: usize) -> Self {
        // Those of other places tell the scatter, not this P.
        let shots = match fit.profiles.len() {
            1 => fit.posterior.shots,
            _ => fit.observed[place].1.max(1),
        };
        let known_to = |error: f64| SessionError {
            of_one_shot: error * (shots as f64).sqrt(),
            shots: shots as f64,
        };
        let sds = (0..3).map(|i| {
            let sd = fit.posterior.summary(|draw| draw.sds[i]);
            sd.sd / sd.mean
        });
        Self {
            shots,
            p: known_to(fit.usual_probabilities(place).interval().sd),
            scatter: known_to(sds.sum::<f64>() / 3.0),
        }
    }

    /// So many shots with the tracker of the designed tests.
    fn designed(rows: &[DesignRow], shots: usize) -> Self {
        Self {
            shots,
            p: known_after(rows, shots, |row| row.probability_error),
            scatter: known_after(rows, shots, DesignRow::sd_error),
        }
    }
}

/// The least change of P that shows between the first session (without one, another of the row's
/// size) and one of the row's size: at the level of 95 %, with a power of 80 %.
fn least_change(row: &DesignRow, first: Option<&FirstSession>) -> f64 {
    let before = first.map_or(row.probability_error, |first| first.p.error());
    POWER * libm::hypot(before, row.probability_error)
}

/// How far a session of so many shots knows something, from the row of the nearest size.
fn known_after(
    rows: &[DesignRow],
    shots: usize,
    error: impl Fn(&DesignRow) -> f64,
) -> SessionError {
    let nearest = rows.iter().min_by_key(|row| row.shots.abs_diff(shots));
    SessionError {
        of_one_shot: nearest.map_or(0.0, |row| error(row) * (row.shots as f64).sqrt()),
        shots: shots as f64,
    }
}

/// How many shots show that P or a scatter has changed, in two equal sessions and against a first
/// one.
fn shots_for_changes(rows: &[DesignRow], first: Option<&FirstSession>, changes: &[f64]) -> String {
    let falls = [0.1, 0.2, 0.3];
    let most = rows.last().map_or(0, |row| row.shots);
    let scatter = known_after(rows, most, DesignRow::sd_error).of_one_shot;
    let in_words = |shots: Option<f64>| match shots {
        None => "never".to_owned(),
        Some(shots) if !shots.is_finite() => "-".to_owned(),
        Some(shots) if shots < LEAST_SHOTS => format!("fewer than {LEAST_SHOTS}"),
        Some(shots) if shots > MOST_SHOTS as f64 => format!("more than {MOST_SHOTS}"),
        Some(shots) => format!("about {}", two_digits(shots)),
    };
    let columns = |words: &[String]| words.join(", ");
    let of_each: Vec<String> = changes
        .iter()
        .map(|points| in_words(Some(shots_in_each(rows, points / 100.0))))
        .collect();
    let falls_each =
        falls.map(|fall| in_words(Some(SessionError::each_session(scatter, fall, 1.0 - fall))));
    let listed: Vec<String> = changes.iter().map(|points| format!("{points}")).collect();
    let listed = in_a_row(&listed);
    let lines = |of_p: &str, of_falls: &str| {
        format!(
            "  P changed by {listed} points: {of_p}\n  one scatter lower by 10, 20 or 30 %: {of_falls}\n"
        )
    };
    let mut text = String::new();
    if let Some(first) = first {
        let of_p: Vec<String> = changes
            .iter()
            .map(|points| in_words(further_shots(rows, first, points / 100.0)))
            .collect();
        let of_falls =
            falls.map(|fall| in_words(first.scatter.second_session(fall, (1.0 - fall) * scatter)));
        let hidden = |error: &SessionError| 100.0 * POWER * error.error();
        let never = changes.iter().copied();
        let never = never.filter(|points| further_shots(rows, first, points / 100.0).is_none());
        let larger: String = never
            .map(|points| {
                let root = POWER * first.p.of_one_shot / (points / 100.0);
                format!(
                    " For {points} points the first session would need about {} shots or more.",
                    two_digits(root * root)
                )
            })
            .collect();
        text += &format!(
            "How many further shots show a change since the {} shots of the first session (95 % level, power 80 %; \"P changed by\" in the table is against them too):\n{}The second session is taken to have about the same P and scatter. Never: the first shots alone leave P and the scatter too unsure. No number of further shots shows a change of P below {:.1} points, or of a scatter below {:.0} %.{larger}\n\n",
            first.shots,
            lines(&columns(&of_p), &columns(&of_falls)),
            hidden(&first.p),
            hidden(&first.scatter)
        );
    }
    text + &format!(
        "How many shots in each of two equal sessions show a change{}:\n{}A player also differs from day to day: that is not in these numbers.",
        match first {
            Some(_) => "",
            None =>
                " (95 % level, power 80 %; \"P changed by\" in the table is the least change that they show)",
        },
        lines(&columns(&of_each), &columns(&falls_each))
    )
}

/// Shots in each of two equal sessions that show a change of P.
fn shots_in_each(rows: &[DesignRow], change: f64) -> f64 {
    shots_for(rows, change / (POWER * std::f64::consts::SQRT_2)) as f64
}

/// Shots of a second session that show a change of P since the first one; `None` if no number does.
fn further_shots(rows: &[DesignRow], first: &FirstSession, change: f64) -> Option<f64> {
    let of_one_shot =
        |shots: f64| known_after(rows, shots as usize, |row| row.probability_error).of_one_shot;
    // The row that is nearest in size is known once the size is.
    let rough = first.p.second_session(change, of_one_shot(100.0))?;
    first.p.second_session(change, of_one_shot(rough))
}

/// The shots that show changes of P.
fn changes_json(rows: &[DesignRow], first: Option<&FirstSession>, changes: &[f64]) -> Value {
    let listed = changes.iter().map(|points| {
        let change = points / 100.0;
        let second = first.and_then(|first| further_shots(rows, first, change));
        json!({
            "change_of_probability": number(change),
            "shots_in_second_session": second.map(|shots| number(shots.ceil())),
            "shots_in_each_of_two": number(shots_in_each(rows, change)),
        })
    });
    listed.collect()
}

/// "5, 10 or 20".
fn in_a_row(words: &[String]) -> String {
    match words.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
        None => String::new(),
    }
}

/// Shots that make P known to a standard deviation, which falls with the square root of the shots:
/// from the row that is nearest to it.
fn shots_for(rows: &[DesignRow], probability_error: f64) -> usize {
    let distance =
        |row: &&DesignRow| libm::fabs(libm::log(row.probability_error / probability_error));
    let nearest = rows
        .iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map_or(0, |row| {
        let ratio = row.probability_error / probability_error;
        (row.shots as f64 * ratio * ratio).ceil() as usize
    })
}

fn json(
    name: &str,
    (tracker, probability): (&TrackerOfTest, f64),
    (rows, first, changes): (&[DesignRow], Option<&FirstSession>, &[f64]),
    needed: Option<(f64, usize)>,
) -> Value {
    let listed = rows.iter().map(|row| {
        let [speed, pitch, polar] = row.sd_errors.map(number);
        json!({
            "shots": row.shots,
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
