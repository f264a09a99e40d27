//! `bankshot angles`: the best shot at each of several pitch angles, from one place or from
//! several distances.

use super::table::KindArg;
use crate::answers::csv::csv;
use crate::answers::json::document;
use crate::answers::table_rows::PitchCurveAnswer;
use crate::best_shot::{MOST_NODES, ShotAtPitch, TableKind, best_by_pitch};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder::{self, OverDraws};
use crate::cli::fixed_value_flags::FixedOptions;
use crate::cli::output_files::{self, Rendered};
use crate::cli::plot_files::{self, PlotType};
use crate::cli::profile_flags::ProfileOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::scatter_flags::ScatterOptions;
use crate::cli::value_lists::ascending_values;
use crate::fitting::{AngleOverDraws, nominal_of};
use crate::plots;
use crate::plots::best_by_pitch::UsualShot;
use crate::plots::svg::Plot;
use crate::present::layout::TextAnswer;
use crate::present::shot_table_files::by_pitch::AngleCurve;
use crate::present::shot_table_files::notes::physics_note;
use crate::present::shot_table_files::pitch_over_distances::{
    DistanceShots, pitch_over_distances_text,
};
use crate::probability::{Progress, Silent};
use crate::shooter::{Location, NominalVariable, Profile, SearchSettings};
use crate::store::fit::{FIT_FILE, Fit};
use crate::units::{DEGREE_RAD, Dimension, UnitSystem};
use clap::Args;
use serde_json::Value;
use std::path::PathBuf;

/// The first and the last pitch angle and the step, if none are given, deg.
const DEFAULT_PITCHES_DEG: (f64, f64, f64) = (40.0, 65.0, 2.5);

#[derive(Args, Debug)]
#[command(after_help = "\
An angle takes a quarter of a second. Near the best angle the makes hardly change, so `bankshot best` can differ by a degree or two. Speed and direction are optimised at each angle; for a fixed speed see `bankshot shot PROFILE --vary 'pitch=..'`.

Examples:
  bankshot angles configs/free_throw.toml
  bankshot angles player.toml --pitches '45 deg to 60 deg by 1 deg' \\
    --plot pitch.svg -o pitch.csv
  bankshot angles player.toml --kind bank --backspin '2 rev/s'
  bankshot angles robot.toml --distances '8 ft to 18 ft by 2 ft'
  bankshot angles results/season-fit --draws results/season-fit")]
pub(crate) struct AnglesOptions {
    #[command(flatten)]
    pub(crate) profile: ProfileOptions,
    #[command(flatten)]
    pub(crate) scatter: ScatterOptions,
    /// Release angles, ascending, within the profile's pitch_min and pitch_max [default: from
    /// pitch_min (40 deg) to pitch_max (65 deg) in steps of 2.5 deg].
    #[arg(long, value_name = "LIST|RANGE")]
    pub(crate) pitches: Option<String>,
    /// Several distances from the hoop's centre, ascending: find the one angle that suits them all.
    #[arg(long, value_name = "LIST|RANGE", conflicts_with_all = ["distance", "draws", "plot"])]
    pub(crate) distances: Option<String>,
    /// The kind of the shots; best: at each angle the better one (takes twice as long).
    #[arg(long, value_enum, default_value_t = KindArg::Direct)]
    pub(crate) kind: KindArg,
    /// Fix the backspin.
    #[arg(long, value_name = "SPIN", allow_hyphen_values = true)]
    pub(crate) backspin: Option<String>,
    /// Folder of a fit: adds its uncertainty to the answer [default: the fit that wrote the
    /// profile].
    #[arg(long, value_name = "FIT_DIR", conflicts_with_all = ["distances", "scatter"])]
    pub(crate) draws: Option<PathBuf>,
    /// Write the shots into a file (.csv, .json or .txt); may be repeated.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Vec<PathBuf>,
    /// Draw the makes and the speed over the release angle (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Print JSON instead of the table: one object, or an array with --distances.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &AnglesOptions) -> Result<u8, Failure> {
    if let Some(path) = &options.plot {
        PlotType::of(path)?;
    }
    output_files::check(&options.output)?;
    let fixed = FixedOptions::of_backspin(options.backspin.clone());
    // The pitch angle is given too.
    let mut given = fixed.variables();
    given.push(NominalVariable::Pitch);
    let loaded = options.profile.load(&given)?;
    let loaded = fixed.changed(options.scatter.changed(loaded)?)?;
    let is_scatter_changed = !options.scatter.scatter.is_empty();
    // A folder that is no fit is refused before the search.
    let draws = options.draws.as_deref();
    let fit = match options.distances {
        Some(_) => None,
        None => fit_folder::draws_for(draws, &loaded, is_scatter_changed)?,
    };
    let profile = loaded.profile;
    let choice = profile.search().choice;
    if choice.iter().all(|variable| given.contains(&variable)) {
        return Err(Failure::usage(
            "search.choose of the profile names nothing that is left to search at a given pitch angle; add the speed or polar, or ask `bankshot shot PROFILE --pitch ANGLE` about one shot",
        ));
    }
    let pitches_rad = pitches_rad(options.pitches.as_deref(), &profile)?;
    if let Some(distances) = &options.distances {
        return run_from_distances(options, (&profile, distances), &pitches_rad);
    }
    let curve = Curve::find(options, &profile, fit, &pitches_rad)?;
    if let Some(path) = &options.plot
        && let Some(plot) = curve.plot()
    {
        plot_files::write_one(path, &plot)?;
    }
    output_files::deliver(&curve, &options.output, options.json)?;
    output_files::print_written(options.output.iter().chain(&options.plot));
    Ok(exit_code(&curve.rows))
}

/// Incomplete where there is no shot at all.
fn exit_code<'a>(rows: impl IntoIterator<Item = &'a ShotAtPitch>) -> u8 {
    match rows.into_iter().any(|row| row.shot.is_some()) {
        true => code::DONE,
        false => code::INCOMPLETE,
    }
}

/// The best shot at each pitch angle from one place.
struct Curve<'a> {
    profile: &'a Profile,
    kind: TableKind,
    rows: Vec<ShotAtPitch>,
    /// P over the draws of a fit.
    over_draws: Option<OverDraws>,
    /// The shot of a fit, as it was measured.
    current: Option<UsualShot>,
    scatter: &'a [String],
}

impl<'a> Curve<'a> {
    fn find(
        options: &'a AnglesOptions,
        profile: &'a Profile,
        fit: Option<Fit>,
        pitches_rad: &[f64],
    ) -> Result<Self, Failure> {
        let path = &options.profile.path;
        let is_of_fit = !options.profile.place.is_given() && path.join(FIT_FILE).is_file();
        let kind = options.kind.into();
        let rows = best_by_pitch(profile, kind, pitches_rad, &ProgressBars::new())?;
        let over_draws = fit
            .as_ref()
            .map(|fit| fit_folder::angles_over_draws(fit, profile, &rows))
            .transpose()?;
        // The angles have their best speed and aim, which those of the shooter need not be.
        let current = fit.as_ref().filter(|_| is_of_fit).map(|fit| UsualShot {
            nominal: nominal_of(&fit.posterior.typical().means[0]),
            probability: fit.usual_probabilities(0).interval(),
        });
        Ok(Self {
            profile,
            kind,
            rows,
            over_draws,
            current,
            scatter: &options.scatter.scatter,
        })
    }

    fn units(&self) -> UnitSystem {
        self.profile.output().units
    }

    /// P over the draws at each angle; none without draws.
    fn angles(&self) -> &[Option<AngleOverDraws>] {
        self.over_draws.as_ref().map_or(&[], |over| &over.angles)
    }

    fn answer(&self) -> PitchCurveAnswer {
        let physics = physics_note(self.profile, self.units());
        PitchCurveAnswer::new(&self.rows, self.angles(), self.kind, self.profile, physics)
    }

    fn plot(&self) -> Option<Plot> {
        let rows = (&self.rows[..], self.angles());
        plots::best_by_pitch::draw(self.profile, self.kind, rows, (self.current, self.units()))
    }
}

impl Rendered for Curve<'_> {
    fn text(&self) -> TextAnswer {
        let curve = AngleCurve {
            profile: self.profile,
            kind: self.kind,
            rows: &self.rows,
            over_draws: self.angles(),
            best_of_draws: self.over_draws.as_ref().and_then(|over| over.best),
            current: self
                .current
                .map(|current| (current.nominal.pitch_rad, current.probability.mean)),
        };
        curve.text(self.scatter)
    }

    fn json(&self) -> Value {
        document(&self.answer(), self.units())
    }

    fn csv(&self) -> String {
        csv(&self.answer().shots, self.units())
    }
}

/// Curves from several distances.
struct Curves<'a> {
    from: Vec<DistanceShots>,
    kind: TableKind,
    units: UnitSystem,
    scatter: &'a [String],
}

impl Curves<'_> {
    fn answers(&self) -> Vec<PitchCurveAnswer> {
        let answer = |from: &DistanceShots| {
            let profile = &from.profile;
            let physics = physics_note(profile, self.units);
            PitchCurveAnswer::new(&from.shots, &[], self.kind, profile, physics)
                .from_distance(profile.location().distance_m)
        };
        self.from.iter().map(answer).collect()
    }
}

impl Rendered for Curves<'_> {
    fn text(&self) -> TextAnswer {
        pitch_over_distances_text(&self.from, self.kind, self.units, self.scatter)
    }

    fn json(&self) -> Value {
        let answers = self.answers();
        let documents = answers.iter().map(|answer| document(answer, self.units));
        documents.collect()
    }

    fn csv(&self) -> String {
        let rows = self.answers().into_iter().flat_map(|answer| answer.shots);
        csv(&rows.collect::<Vec<_>>(), self.units)
    }
}

/// The shots from several distances.
fn run_from_distances(
    options: &AnglesOptions,
    (profile, distances): (&Profile, &str),
    pitches_rad: &[f64],
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
    let bars = ProgressBars::new();
    let searches = profiles.len() * pitches_rad.len();
    bars.begin("pitch angles and distances", searches as u64);
    let mut from = Vec::new();
    for profile in profiles {
        let shots = best_by_pitch(&profile, kind, pitches_rad, &Silent)?;
        bars.advance(pitches_rad.len() as u64);
        from.push(DistanceShots { profile, shots });
    }
    bars.end();
    let scatter = &options.scatter.scatter;
    let curves = Curves {
        from,
        kind,
        units,
        scatter,
    };
    output_files::deliver(&curves, &options.output, options.json)?;
    output_files::print_written(options.output.iter().chain(&options.plot));
    Ok(exit_code(curves.from.iter().flat_map(|shots| &shots.shots)))
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
                "--pitches: pitch_min and pitch_max of the profile allow no angle of the default list; list angles",
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
