//! `bankshot pitch-curve`: the best shot at each of several pitch angles, from one place or from
//! several distances.

use super::table::KindArg;
use crate::best_shot::{MOST_NODES, best_by_pitch};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::fixed_value_flags::FixedOptions;
use crate::cli::output_files::{self, OutputForm};
use crate::cli::plot_files::{self, PlotType};
use crate::cli::profile_flags::ProfileOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::scatter_flags::ScatterOptions;
use crate::cli::terminal::{print_answer, wrapped};
use crate::cli::value_lists::ascending_values;
use crate::fitting::nominal_of;
use crate::plots;
use crate::plots::best_by_pitch::UsualShot;
use crate::present::shot_table_files::by_pitch::{by_pitch_csv, by_pitch_json, by_pitch_text};
use crate::present::shot_table_files::pitch_over_distances::{
    DistanceShots, pitch_over_distances_csv, pitch_over_distances_json, pitch_over_distances_text,
};
use crate::probability::{Progress, Silent};
use crate::shooter::{Location, NominalVariable, Profile, SearchSettings};
use crate::units::{DEGREE_RAD, Dimension, REV_RAD};
use clap::Args;
use std::path::PathBuf;

/// The first and the last pitch angle and the step, if none are given, deg.
const DEFAULT_PITCHES_DEG: (f64, f64, f64) = (40.0, 65.0, 2.5);

#[derive(Args, Debug)]
#[command(after_help = "\
Each angle, from each distance, is a search of its own: one or two seconds on two cores. Near the best angle P is flat: the best of these and the angle of `bankshot best` can differ by a degree or two, and P hardly. The speed and the aim follow the angle; for one shot whose speed stays, see `bankshot probability PROFILE --vary 'pitch=..'`.

Examples:
  bankshot pitch-curve configs/free_throw.toml
  bankshot pitch-curve player.toml --pitches '45 deg to 60 deg by 1 deg' \\
    --plot pitch.svg -o pitch.csv
  bankshot pitch-curve player.toml --kind bank --backspin '2 rev/s'
  bankshot pitch-curve robot.toml --distances '8 ft to 18 ft by 2 ft'
  bankshot pitch-curve results/season-fit --draws results/season-fit")]
pub(crate) struct PitchCurveOptions {
    #[command(flatten)]
    pub(crate) profile: ProfileOptions,
    #[command(flatten)]
    pub(crate) scatter: ScatterOptions,
    /// The pitch angles, ascending, within the profile's pitch_min and pitch_max [default: from
    /// pitch_min (40 deg) to pitch_max (65 deg) in steps of 2.5 deg].
    #[arg(long, value_name = "LIST|RANGE")]
    pub(crate) pitches: Option<String>,
    /// Several distances from the hoop's centre, ascending: P at each of them, and which one pitch
    /// angle suits them all.
    #[arg(long, value_name = "LIST|RANGE", conflicts_with_all = ["distance", "draws", "plot"])]
    pub(crate) distances: Option<String>,
    /// The kind of the shots; best: at each angle the one with the higher P, but a clean shot
    /// before one that misses without errors (twice the time).
    #[arg(long, value_enum, default_value_t = KindArg::Direct)]
    pub(crate) kind: KindArg,
    /// Fix the backspin.
    #[arg(long, value_name = "SPIN", allow_hyphen_values = true)]
    pub(crate) backspin: Option<String>,
    /// The folder of a fit: also say how uncertain P at each angle is, and its difference from the
    /// best angle, by what the shots do not tell about the scatter.
    #[arg(long, value_name = "FIT_DIR", conflicts_with_all = ["distances", "scatter"])]
    pub(crate) draws: Option<PathBuf>,
    /// Write the shots into a file (.csv, .json or .txt); may be repeated.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Vec<PathBuf>,
    /// Draw P and the speed over the pitch angle (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Print JSON instead of the table: an object, with --distances an array.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &PitchCurveOptions, quiet: bool) -> Result<u8, Failure> {
    if let Some(path) = &options.plot {
        PlotType::of(path)?;
    }
    output_files::check(&options.output)?;
    let fixed = FixedOptions::of_backspin(options.backspin.clone());
    // The pitch angle is given too.
    let mut given = fixed.variables();
    given.push(NominalVariable::Pitch);
    let loaded = options.profile.load(&given, quiet)?;
    let profile = fixed.changed(options.scatter.changed(loaded)?)?.profile;
    let choice = profile.search().choice;
    if choice.iter().all(|variable| given.contains(&variable)) {
        return Err(Failure::usage(
            "search.choose of the profile names nothing that is left to search at a given pitch angle; add the speed or polar, or ask `bankshot probability PROFILE --pitch ANGLE` about one shot",
        ));
    }
    let pitches_rad = pitches_rad(options.pitches.as_deref(), &profile)?;
    let units = profile.output().units;
    if let Some(distances) = &options.distances {
        return run_from_distances(options, (&profile, distances), &pitches_rad, quiet);
    }
    // A folder that is no fit is refused before the search.
    let draws = fit_folder::read_draws_of(options.draws.as_deref(), &profile)?;
    let is_own_place = !options.profile.place.is_given();
    let fit = match is_own_place && options.profile.path.join("fit.json").is_file() {
        true => Some(fit_folder::read(&options.profile.path)?),
        false => None,
    };
    let kind = options.kind.into();
    let rows = best_by_pitch(&profile, kind, &pitches_rad, &ProgressBars::new(quiet))?;
    let over_draws = match &draws {
        Some((_, fit)) => Some(fit_folder::angles_over_draws(fit, &profile, &rows)?),
        None => None,
    };
    let angles = over_draws.as_ref().map_or(&[][..], |over| &over.angles);
    // The angles have their best speed and aim, which those of the shooter need not be.
    let usual = fit.as_ref().map(|fit| UsualShot {
        nominal: nominal_of(&fit.posterior.typical().means[0]),
        probability: fit.usual_probabilities(0).interval(),
    });
    let of_fit = usual.as_ref().map_or_else(String::new, |usual| {
        let p = usual.probability;
        let spin = usual.nominal.backspin_rad_s / REV_RAD;
        let is_searched = profile.search().choice.includes(NominalVariable::Backspin);
        let of_spin = match is_searched {
            true => format!(" The spin was {spin:.2} rev/s; --backspin '{spin:.2} rev/s' keeps it."),
            false => String::new(),
        };
        wrapped(&format!(
            "As it was measured, the usual shot (at {:.1} deg) makes {:.1} of 100 (95 %: {:.1} to {:.1}); its speed and aim need not be the best ones.{of_spin}",
            usual.nominal.pitch_rad / DEGREE_RAD,
            100.0 * p.mean,
            100.0 * p.low,
            100.0 * p.high
        ))
    });
    let text = || {
        let text = by_pitch_text(&rows, kind, &profile, units) + &of_fit;
        let words = draws.as_ref().zip(over_draws.as_ref());
        let words = words
            .map(|((folder, fit), over)| fit_folder::angles_in_words((folder, fit), &rows, over));
        match words {
            Some(words) => format!("{text}\n{}", wrapped(&words)),
            None => text,
        }
    };
    let json = || {
        let json = by_pitch_json(&rows, angles, kind, &profile, units);
        format!("{json:#}\n")
    };
    output_files::write(&options.output, |form| match form {
        OutputForm::Csv => by_pitch_csv(&rows, angles, kind, &profile, units),
        OutputForm::Json => json(),
        OutputForm::Text => text(),
    })?;
    if let Some(path) = &options.plot
        && let Some(plot) =
            plots::best_by_pitch::draw(&profile, kind, (&rows, angles), (usual, units))
    {
        plot_files::write_one(path, &plot)?;
    }
    print_answer(&if options.json { json() } else { text() })?;
    output_files::print_written(options.output.iter().chain(&options.plot), quiet);
    Ok(if rows.iter().any(|row| row.shot.is_some()) {
        code::DONE
    } else {
        code::INCOMPLETE
    })
}

/// The shots from several distances.
fn run_from_distances(
    options: &PitchCurveOptions,
    (profile, distances): (&Profile, &str),
    pitches_rad: &[f64],
    quiet: bool,
) -> Result<u8, Failure> {
    let (kind, units) = (options.kind.into(), profile.output().units);
    let mut profiles = Vec::new();
    let distances_m = ascending_values("distances", distances, Dimension::Length)?;
    if distances_m.len() * pitches_rad.len() > MOST_NODES {
        return Err(Failure::usage(format!(
            "--distances: {} distances at {} pitch angles are more than {MOST_NODES} searches",
            distances_m.len(),
            pitches_rad.len()
        )));
    }
    for distance_m in distances_m {
        let place = Location {
            distance_m,
            ..profile.location()
        };
        place
            .check(profile.physics())
            .map_err(|error| Failure::usage(format!("--distances: {error}")))?;
        profiles.push(profile.moved_to(place)?);
    }
    let bars = ProgressBars::new(quiet);
    let searches = profiles.len() * pitches_rad.len();
    bars.begin("pitch angles and distances", searches as u64);
    let mut from = Vec::new();
    for profile in profiles {
        let mut shots = Vec::new();
        for pitch_rad in pitches_rad {
            let pitch_rad = std::slice::from_ref(pitch_rad);
            shots.extend(best_by_pitch(&profile, kind, pitch_rad, &Silent)?);
            bars.advance(1);
        }
        from.push(DistanceShots { profile, shots });
    }
    bars.end();
    let text = || pitch_over_distances_text(&from, kind, units);
    let json = || format!("{:#}\n", pitch_over_distances_json(&from, kind, units));
    output_files::write(&options.output, |form| match form {
        OutputForm::Csv => pitch_over_distances_csv(&from, kind, units),
        OutputForm::Json => json(),
        OutputForm::Text => text(),
    })?;
    print_answer(&if options.json { json() } else { text() })?;
    output_files::print_written(options.output.iter().chain(&options.plot), quiet);
    let mut rows = from.iter().flat_map(|shots| &shots.shots);
    Ok(if rows.any(|row| row.shot.is_some()) {
        code::DONE
    } else {
        code::INCOMPLETE
    })
}

/// The pitch angles, if none are given: multiples of the step as far as the limits of the profile
/// reach, and these limits.
fn default_pitches_rad(search: &SearchSettings) -> Vec<f64> {
    let (first, last, step) = DEFAULT_PITCHES_DEG;
    let limits = [search.pitch_min_rad, search.pitch_max_rad];
    let [low, high] = limits.map(|limit| limit.map(|limit| limit / DEGREE_RAD));
    let (low, high) = (low.unwrap_or(first), high.unwrap_or(last));
    // Nearer than this to a limit an angle is that limit.
    const NEAR_DEG: f64 = 0.01;
    let multiples = ((low / step).ceil() as i64..=(high / step).floor() as i64)
        .map(|k| step * k as f64)
        .filter(|angle| {
            let is_beside = |limit: Option<f64>| {
                limit.is_some_and(|limit| (angle - limit / DEGREE_RAD).abs() < NEAR_DEG)
            };
            !limits.into_iter().any(is_beside)
        })
        .map(|angle| angle * DEGREE_RAD);
    let mut angles: Vec<f64> = limits[0].into_iter().collect();
    angles.extend(multiples);
    angles.extend(limits[1]);
    angles.dedup();
    angles
}

/// The pitch angles, rad, between 1 and 89 deg.
fn pitches_rad(given: Option<&str>, profile: &Profile) -> Result<Vec<f64>, Failure> {
    let search = &profile.settings().search;
    let pitches_rad = match given {
        Some(given) => ascending_values("pitches", given, Dimension::Angle)?,
        None => default_pitches_rad(search),
    };
    let refuse = |pitch_rad: f64, words: &str| {
        let pitch_deg = (pitch_rad / DEGREE_RAD * 1e6).round() / 1e6;
        Failure::usage(format!("--pitches: {pitch_deg} deg {words}"))
    };
    if given.is_none() {
        let is_allowed = |pitch_rad: &f64| search.pitch_beyond_limits(*pitch_rad).is_none();
        let allowed: Vec<f64> = pitches_rad.into_iter().filter(is_allowed).collect();
        if allowed.is_empty() {
            return Err(Failure::usage(
                "--pitches: pitch_min and pitch_max of the profile allow none of the usual angles; give the angles",
            ));
        }
        return Ok(allowed);
    }
    let range = DEGREE_RAD..=89.0 * DEGREE_RAD;
    for pitch_rad in &pitches_rad {
        if !range.contains(pitch_rad) {
            let words = "is not allowed; give angles from 1 to 89 deg";
            return Err(refuse(*pitch_rad, words));
        }
        if let Some(words) = search.pitch_beyond_limits(*pitch_rad) {
            return Err(refuse(*pitch_rad, &words));
        }
    }
    Ok(pitches_rad)
}
