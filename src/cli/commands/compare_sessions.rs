//! `bankshot compare-sessions`: what changed between two sessions of a shooter.

use super::fit::{failure, report_rejected};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::{MeasuredFile, MeasuredShotsOptions};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::fitting::{
    DrawProbabilities, MeasuredRelease, Place, Posterior, ProbabilityChange, SessionComparison,
    ShooterFit, SpinSource, VALUE_NAMES, change_of_share, compare_probabilities, compare_sessions,
    probability_change, session_names, values_at_height,
};
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::output::fit_files::fit_json::interval_json;
use crate::output::fit_files::parameters::value_units;
use crate::output::fit_files::session_changes_text::{
    Decision, SessionChange, SessionSummary, session_changes_text,
};
use crate::output::json_object::{number, object};
use crate::probability::Progress;
use crate::shooter::Profile;
use crate::units::UnitSystem;
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Each session is a file, which is fitted first (with the options of `bankshot fit`), or the folder of a fit.

Examples:
  bankshot compare-sessions september.csv march.csv --distance '13.75 ft' \\
    --release-height '7 ft'
  bankshot compare-sessions results/september-fit results/march-fit
  bankshot compare-sessions season.csv
  bankshot compare-sessions season.csv --session September --session March

A file with a column session needs no second one; with several shooters, each is compared. Sessions that are numbers, or dates with \
the year first (2026-11-03), are compared in their order, others in that of the file, or as --session names them.")]
pub(crate) struct CompareSessionsOptions {
    /// The first session, or a file with a column session that has two values.
    pub(crate) before: PathBuf,
    /// The second session.
    pub(crate) after: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Of sessions from several places, the number of the place to compare [default: 1, the first
    /// that both have].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) place: Option<u32>,
    /// The values that the study was planned for, such as 'speed_sd,pitch_sd' (speed, pitch, polar
    /// or backspin with _mean or _sd; corr_speed_pitch ...): these alone are compared beside P, so
    /// that chance has fewer of them to strike at [default: all].
    #[arg(long, value_name = "VALUE,VALUE", value_delimiter = ',')]
    pub(crate) planned: Vec<String>,
    /// Print one JSON object; of a file with several shooters, an array of them.
    #[arg(long)]
    pub(crate) json: bool,
}

/// A fitted session.
struct Session {
    name: String,
    /// Whether the name is from the column of a file.
    is_of_column: bool,
    /// The number of places, and the index of the one that is compared.
    places: usize,
    place: usize,
    /// Its name; empty where the file does not say.
    place_name: String,
    posterior: Posterior,
    /// Made at this place, and all with a result.
    makes: (usize, usize),
    /// P of the usual shot at this place.
    probabilities: DrawProbabilities,
    /// The profile at this place.
    profile: Profile,
    /// Their name, if the file has it.
    shooter: Option<String>,
    /// What the fit warned of.
    warnings: Vec<String>,
    units: Option<UnitSystem>,
}

impl Session {
    /// How a warning names it: a session of a file may be called `1`.
    fn title(&self) -> String {
        if self.is_of_column {
            format!("session {}", self.name)
        } else {
            self.name.clone()
        }
    }

    /// `place_names` are those of the places of the fit.
    fn of(
        name: String,
        (shots, place_names): (&ShooterShots, &[String]),
        mut fit: ShooterFit,
        number: Option<u32>,
    ) -> Result<Self, Failure> {
        let place = fit_folder::index_of_place(number, fit.places.len())?;
        let makes = fit.makes.at_place(place);
        Ok(Self {
            name,
            is_of_column: false,
            places: fit.places.len(),
            place,
            place_name: place_names[place].clone(),
            posterior: fit.posterior,
            makes: (makes.made, makes.labelled),
            probabilities: fit.probabilities.swap_remove(place),
            profile: fit.profiles.swap_remove(place),
            shooter: Some(shots.name.clone()).filter(|name| !name.is_empty()),
            warnings: fit.warnings.iter().map(ToString::to_string).collect(),
            units: None,
        })
    }
}

pub(crate) fn run(options: &CompareSessionsOptions, quiet: bool) -> Result<u8, Failure> {
    let after_is_file = options.after.as_ref().is_some_and(|after| !after.is_dir());
    if options.before.is_dir() && !after_is_file {
        fit_folder::refuse_options_of_files(&options.before, &options.measured)?;
    }
    if options.after.is_some() && !options.measured.session.is_empty() {
        return Err(Failure::usage(
            "--session: names the two sessions of one file; leave the second file out",
        ));
    }
    let bars = ProgressBars::new(quiet);
    let (mut code, mut several_shooters) = (code::DONE, false);
    let mut compared: Vec<[Session; 2]> = match &options.after {
        Some(after) => vec![[read(&options.before, options)?, read(after, options)?]],
        None if options.before.is_dir() => {
            return Err(Failure::usage(format!(
                "{}: the folder of a fit is one session; name the second one too, or the file of the shots if it has a column session",
                options.before.display()
            )));
        }
        None => {
            let file = options.measured.read_sessions(&options.before, &[])?;
            let several = file.shooters.len() > 1;
            let mut compared = Vec::new();
            bars.begin("fitting sessions", 2 * file.shooters.len() as u64);
            for shots in &file.shooters {
                match fit_by_session(&file, shots, options, &bars) {
                    Ok(sessions) => compared.push(sessions),
                    // The others can still be compared.
                    Err(error) if several => {
                        print_remark(&format!("{}: {}", shots.name, error.message));
                        code = code::INCOMPLETE;
                    }
                    Err(error) => return Err(error),
                }
            }
            bars.end();
            if compared.is_empty() {
                return Err(Failure::usage(format!(
                    "{}: the sessions of no shooter could be compared; the reasons are above",
                    options.before.display()
                )));
            }
            several_shooters = several;
            compared
        }
    };
    let units = |session: &Session| options.measured.units_or(session.units.unwrap_or_default());
    for sessions in &mut compared {
        let units = units(&sessions[0]);
        to_one_release_height(sessions, units);
    }
    let mut jsons = Vec::new();
    let mut all = compared.iter().flatten();
    if !options.json
        && let Some(session) = all.find(|session| session.places > 1)
    {
        let units = units(session);
        print_prose(&format!(
            "Shots from {} places: the chance, the makes, the speed and the aim are those of place {}, {}{}{}; the scatter is that of all.\n\n",
            session.places,
            session.place + 1,
            match session.place_name.as_str() {
                "" => String::new(),
                name => format!("{name}, "),
            },
            session.profile.location().in_words(units),
            // Each shooter has a height of their own.
            if compared.len() == 1 {
                let (long, metre) = units.length();
                let height_m = session.profile.shooter().release_height_m;
                format!(", released {:.2} {long} up", height_m / metre)
            } else {
                String::new()
            }
        ))?;
    }
    if !options.planned.is_empty() && !quiet {
        print_remark(
            "--planned: values count as planned only if they were named before the shots were seen",
        );
    }
    for (number, sessions) in compared.iter().enumerate() {
        check_conditions(sessions)?;
        for session in sessions {
            for warning in &session.warnings {
                let title = session.title();
                let title = match &session.shooter {
                    Some(name) if several_shooters => format!("{name}, {title}"),
                    _ => title,
                };
                print_remark(&format!("{title}: warning: {warning}"));
            }
        }
        let changes = planned(changes(sessions, options), &options.planned)?;
        let causes = causes(sessions);
        if options.json {
            jsons.push(json(sessions, &changes, &causes));
            continue;
        }
        if several_shooters {
            let space = if number == 0 { "" } else { "\n" };
            print_prose(&format!("{space}{}\n", sessions[0].profile.shooter().name))?;
        }
        let summaries = sessions.each_ref().map(|session| SessionSummary {
            name: &session.name,
            shots: session.posterior.shots,
            makes: session.makes,
        });
        let tested = changes.len() - 1;
        print_prose(&session_changes_text(summaries, &changes, &causes, tested))?;
    }
    if options.json {
        let all = if several_shooters {
            Value::Array(jsons)
        } else {
            jsons.swap_remove(0)
        };
        print_answer(&format!("{all:#}\n"))?;
    }
    Ok(code)
}

/// A session from a file or from the folder of a fit.
fn read(path: &Path, options: &CompareSessionsOptions) -> Result<Session, Failure> {
    let name = path.display().to_string();
    if path.is_dir() {
        let fit = fit_folder::read(path)?;
        let place = fit.place_numbered(options.place)?;
        return Ok(Session {
            name,
            is_of_column: false,
            places: fit.profiles.len(),
            place,
            place_name: fit.place_names[place].clone(),
            probabilities: fit.usual_probabilities(place),
            posterior: fit.posterior,
            makes: fit.observed[place],
            profile: fit.profiles[place].clone(),
            shooter: fit.shooter,
            warnings: fit.warnings,
            units: Some(fit.units),
        });
    }
    let file = options.measured.read(path)?;
    let shots = file.only_shooter()?;
    report_rejected(&file, shots, true);
    let fit = file
        .fit(shots, &file.physics)
        .map_err(|error| failure(&name, &error))?;
    Session::of(name, (shots, &shots.place_names), fit, options.place)
}

/// Fits of one physics can be compared, and P of one place.
fn check_conditions([before, after]: &[Session; 2]) -> Result<(), Failure> {
    if before.profile.physics() != after.profile.physics() {
        return Err(Failure::usage(format!(
            "{} and {} were fitted with different physics; fit both with the same --physics",
            before.name, after.name
        )));
    }
    if let (Some(first), Some(second)) = (&before.shooter, &after.shooter)
        && first != second
    {
        print_remark(&format!(
            "warning: these are the shots of {first} and of {second}: two shooters differ in more than what changed"
        ));
    }
    let place = |session: &Session| {
        let location = session.profile.location();
        let height_m = session.profile.shooter().release_height_m;
        (location.distance_m, location.angle_rad, height_m)
    };
    let (a, b) = (place(before), place(after));
    let moved_m = libm::fabs(a.0 - b.0)
        .max(a.0 * libm::fabs(a.1 - b.1))
        .max(libm::fabs(a.2 - b.2));
    if moved_m > SAME_PLACE_M {
        print_remark(
            "warning: the sessions are from different places; speed, pitch and P are those of each place",
        );
    }
    Ok(())
}

/// Brings the means of the second session to the release height of the first, along its usual
/// flight, where heights of one place were estimated or given apart. P does not depend on it.
fn to_one_release_height([before, after]: &mut [Session; 2], units: UnitSystem) {
    let place = Place {
        location: after.profile.location(),
        release_height_m: after.profile.shooter().release_height_m,
    };
    let height_m = before.profile.shooter().release_height_m;
    let apart_m = libm::fabs(place.release_height_m - height_m);
    if !(SAME_HEIGHT_M..=SAME_PLACE_M).contains(&apart_m) {
        return;
    }
    let usual = after.posterior.typical().means[after.place];
    let simulator = after.profile.simulator();
    let Some(moved) = values_at_height(simulator, &place, &usual, height_m) else {
        return;
    };
    for draw in &mut after.posterior.draws {
        for (mean, (to, from)) in draw.means[after.place]
            .iter_mut()
            .zip(moved.iter().zip(usual))
        {
            *mean += to - from;
        }
    }
    let (long, metre) = units.length();
    print_remark(&format!(
        "the release heights are {:.2} and {:.2} {long}: speeds and angles of both sessions are those at {:.2} {long}",
        height_m / metre,
        place.release_height_m / metre,
        height_m / metre,
    ));
}

/// Shots that the causes of the change of P are computed with.
const SHOTS: usize = 65_536;
/// Release heights nearer than this are the same, m: 0.004 m/s in speed.
const SAME_HEIGHT_M: f64 = 0.002;
/// Places nearer than this are the same, m.
const SAME_PLACE_M: f64 = 0.15;

/// The two sessions of a shooter: those that are `wanted`, or all.
fn fit_by_session(
    file: &MeasuredFile,
    shots: &ShooterShots,
    options: &CompareSessionsOptions,
    bars: &ProgressBars,
) -> Result<[Session; 2], Failure> {
    let wanted = &options.measured.session[..];
    let place = file.file.display().to_string();
    report_rejected(file, shots, file.shooters.len() == 1);
    let mut names = session_names(&shots.sessions);
    let listed = names
        .iter()
        .map(|name| name.as_str())
        .collect::<Vec<_>>()
        .join(", ");
    if let Some(missing) = wanted.iter().find(|wanted| !names.contains(wanted)) {
        return Err(Failure::usage(format!(
            "{place}: has no session {missing}; it has {listed}"
        )));
    }
    if !wanted.is_empty() {
        names = wanted.iter().collect();
        names.dedup();
    }
    let [first, second] = names[..] else {
        return Err(Failure::usage(match &names[..] {
            [] => format!("{place}: has no shots"),
            [one] if one.is_empty() => format!(
                "{place}: has no session in any row; name its column with --map 'session=COLUMN', or give two files"
            ),
            [one] if !wanted.is_empty() => {
                format!("--session {one}: name two sessions; {place} has {listed}")
            }
            [one] => format!("{place}: has one session, {one}; give a file with two, or two files"),
            more => format!(
                "{place}: has {} sessions ({listed}); choose two with --session NAME --session NAME",
                more.len()
            ),
        }));
    };
    let fit = |session: &String, other: &String| -> Result<Session, Failure> {
        let kept = only_session(shots, session, other);
        let fit = file
            .fit(&kept, &file.physics)
            .map_err(|error| failure(&place, &error))?;
        bars.advance(1);
        Ok(Session {
            is_of_column: true,
            ..Session::of(
                session.clone(),
                (shots, &kept.place_names),
                fit,
                options.place,
            )?
        })
    };
    Ok([fit(first, second)?, fit(second, first)?])
}

/// The shots of one session. Its places are those that it has shots from, those that the other
/// session has too first, so that the same place is compared.
fn only_session(shots: &ShooterShots, session: &str, other: &str) -> ShooterShots {
    let of_session: Vec<_> = shots.shots.iter().zip(&shots.sessions).collect();
    let has = |place: usize, name: &str| {
        let mut all = of_session.iter();
        all.any(|(shot, of)| shot.place == place && *of == name)
    };
    let mut places: Vec<usize> = (0..shots.places.len())
        .filter(|place| has(*place, session))
        .collect();
    places.sort_by_key(|place| !has(*place, other));
    let kept = of_session.iter().filter(|(_, of)| *of == session);
    let kept = kept.map(|(shot, _)| {
        let place = places.iter().position(|place| *place == shot.place);
        MeasuredRelease {
            place: place.unwrap_or(0),
            ..(*shot).clone()
        }
    });
    ShooterShots {
        shots: kept.collect(),
        sessions: Vec::new(),
        places: places.iter().map(|place| shots.places[*place]).collect(),
        place_names: places
            .iter()
            .map(|place| shots.place_names[*place].clone())
            .collect(),
        tracks: Vec::new(),
        chi_squares: Vec::new(),
        ..shots.clone()
    }
}

/// P and the planned ones of all changes; all if none are named.
fn planned(all: Vec<SessionChange>, names: &[String]) -> Result<Vec<SessionChange>, Failure> {
    if names.is_empty() {
        return Ok(all);
    }
    let known = |name: &String| {
        all.iter()
            .any(|change| change.name == *name && *name != "P")
    };
    if let Some(unknown) = names.iter().find(|name| !known(name)) {
        let others = all.iter().filter(|change| change.name != "P");
        let allowed: Vec<&str> = others.map(|change| change.name.as_str()).collect();
        return Err(Failure::usage(format!(
            "--planned: \"{unknown}\" is no value of these sessions; write some of {}",
            allowed.join(", ")
        )));
    }
    let is_kept = |change: &SessionChange| change.name == "P" || names.contains(&change.name);
    Ok(all.into_iter().filter(is_kept).collect())
}

/// P, mean and standard deviation of each value, and the correlations.
fn changes(sessions: &[Session; 2], options: &CompareSessionsOptions) -> Vec<SessionChange> {
    let [before, after] = sessions;
    let posteriors = [&before.posterior, &after.posterior];
    let shots = posteriors.map(|posterior| posterior.shots);
    let mut changes = vec![SessionChange {
        name: "P".to_owned(),
        unit: "%",
        size: 0.01,
        comparison: compare_probabilities([&before.probabilities, &after.probabilities], shots),
    }];
    let is_spin_measured = posteriors
        .iter()
        .all(|posterior| posterior.spin == SpinSource::Measured);
    for (i, (unit, size)) in
        value_units(options.measured.units_or(before.units.unwrap_or_default()))
            .into_iter()
            .enumerate()
    {
        let is_spin = i == VALUE_NAMES.len() - 1;
        // A spin that was not measured in both sessions tells nothing of a change.
        if is_spin && !is_spin_measured {
            continue;
        }
        let mut add = |what: &str, comparison: SessionComparison| {
            changes.push(SessionChange {
                name: format!("{}_{what}", VALUE_NAMES[i]),
                unit,
                size,
                comparison,
            });
        };
        add(
            "mean",
            compare_sessions(posteriors, |draw| draw.means[before.place][i]),
        );
        add("sd", compare_sessions(posteriors, |draw| draw.sds[i]));
    }
    for (a, b) in [(0, 1), (0, 2), (1, 2), (0, 3), (1, 3), (2, 3)] {
        if b == VALUE_NAMES.len() - 1 && !is_spin_measured {
            continue;
        }
        changes.push(SessionChange {
            name: format!("corr_{}_{}", VALUE_NAMES[a], VALUE_NAMES[b]),
            unit: "",
            size: 1.0,
            comparison: compare_sessions(posteriors, |draw| draw.correlation[(a, b)]),
        });
    }
    changes
}

/// What the change of P comes from.
fn causes([before, after]: &[Session; 2]) -> ProbabilityChange {
    probability_change(
        &before.profile,
        [&before.posterior, &after.posterior],
        before.place,
        [&before.probabilities, &after.probabilities],
        SHOTS,
    )
}

fn json(
    [before, after]: &[Session; 2],
    changes: &[SessionChange],
    causes: &ProbabilityChange,
) -> Value {
    let session = |session: &Session| {
        let (made, labelled) = session.makes;
        json!({
            "name": session.name,
            "shots": session.posterior.shots,
            "made": made,
            "with_result": labelled,
        })
    };
    let listed = changes.iter().map(|change| {
        let comparison = &change.comparison;
        let decision = change.decision(changes.len() - 1);
        let interval = |interval: &crate::fitting::Interval| {
            object(interval_json(&interval.scaled(1.0 / change.size)))
        };
        json!({
            "name": change.name,
            "unit": change.unit,
            "before": interval(&comparison.before),
            "after": interval(&comparison.after),
            "change": interval(&comparison.change),
            "probability_of_growth": number(comparison.grew),
            "is_decided": decision == Decision::Made,
            "shots_to_decide": match decision {
                Decision::Needs(shots) => Some(shots.ceil()),
                Decision::Made | Decision::Unknown => None,
            },
        })
    });
    let change_of_makes = (before.makes.1 > 0 && after.makes.1 > 0).then(|| {
        let change = change_of_share(before.makes, after.makes);
        let [change, low, high] = [change.share, change.low, change.high].map(|p| 100.0 * p);
        json!({ "unit": "%", "mean": change, "low": low, "high": high })
    });
    let by_scatter = |order: usize| {
        let by = &causes.by_scatter_first_and_last[order];
        object(interval_json(&by.scaled(100.0)))
    };
    let by_mean = |i: usize| object(interval_json(&causes.by_mean_alone[i].scaled(100.0)));
    json!({
        "shooter": before.profile.shooter().name,
        "before": session(before),
        "after": session(after),
        "change_of_makes": change_of_makes,
        "changes": listed.collect::<Value>(),
        "change_of_P_by_scatter": object(interval_json(&causes.by_scatter.scaled(100.0))),
        "change_of_P_by_usual_release": object(interval_json(&causes.by_means.scaled(100.0))),
        "change_of_P_by_speed_alone": by_mean(0),
        "change_of_P_by_pitch_alone": by_mean(1),
        "change_of_P_by_polar_alone": by_mean(2),
        "change_of_P_by_scatter_first": by_scatter(0),
        "change_of_P_by_scatter_last": by_scatter(1),
    })
}
