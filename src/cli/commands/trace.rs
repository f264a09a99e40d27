//! `bankshot trace`: one shot with its events, its trajectory and a plot.

use super::trace_text::{outcome_text, trace_text};
use crate::answers::csv::csv;
use crate::answers::json::{self, document};
use crate::answers::requests::INTERVAL_S;
use crate::answers::trace::{TraceAnswer, points};
use crate::cli::failure::{Failure, code};
use crate::cli::nominal_shot_flags::{NominalOptions, print_notes};
use crate::cli::plot_files;
use crate::cli::profile_flags::ProfileOptions;
use crate::cli::terminal::{print_answer, print_bytes, print_hint, print_prose};
use crate::dynamics::{Release, Trace};
use crate::files::atomic_file;
use crate::plots::shot_views::{self, MADE_COLOUR, MISSED_COLOUR, ShotPath};
use crate::plots::svg::shortened;
use crate::probability::Sampler;
use crate::shooter::{Nominal, Profile};
use crate::units::{DEGREE_RAD, REV_RAD};
use clap::Args;
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Every quantity carries its unit.

Examples:
  bankshot trace configs/free_throw.toml --speed '24.3 ft/s' \\
    --pitch '52 deg' --backspin '3 rev/s'
  bankshot trace configs/free_throw.toml --speed '24.4 ft/s' \\
    --pitch '53.5 deg' --backspin '3 rev/s' --plot shot.png --swarm 60
  bankshot trace configs/bank_wing.toml --speed '7.36 m/s' --pitch '54.2 deg' \\
    --polar '53.85 deg' --backspin '3 rev/s' --output shot.csv")]
pub(crate) struct TraceOptions {
    #[command(flatten)]
    pub(crate) profile: ProfileOptions,
    #[command(flatten)]
    pub(crate) nominal: NominalOptions,
    /// Write the trajectory as CSV; - for standard output (then nothing else is printed there).
    #[arg(long, short, value_name = "T.csv")]
    pub(crate) output: Option<PathBuf>,
    /// Draw the shot from the side, from above and facing the board.
    #[arg(long, value_name = "T.svg|T.png")]
    pub(crate) plot: Option<PathBuf>,
    /// Draw this many more shots with the shooter's errors.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "plot", value_parser = clap::value_parser!(u32).range(0..=5000))]
    pub(crate) swarm: u32,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Colour of the error-free shot among others.
const BLACK: &str = "#000000";

pub(crate) fn run(options: &TraceOptions) -> Result<u8, Failure> {
    let profile = options.profile.load(&[])?.profile;
    let units = profile.output().units;
    let nominal = options.nominal.resolve(&profile)?;
    print_notes(options.nominal.request().notes(&profile, &nominal));
    let trace = trace_of(&profile, &profile.release(&nominal))?;
    if let Some(path) = &options.output {
        let bytes = csv(&points(&trace), units).into_bytes();
        if path == Path::new("-") {
            return print_bytes(&bytes);
        }
        atomic_file::write(path, &bytes).map_err(|error| Failure::io(path.display(), &error))?;
    }
    if let Some(path) = &options.plot {
        write_plot(path, options.swarm, &profile, &nominal, &trace)?;
    }
    print(&profile, &trace, options.json)?;
    if let Some(path) = &options.plot {
        print_hint(&format!("plot written to {}", path.display()));
    }
    if let Some(path) = &options.output {
        print_hint(&format!("trajectory written to {}", path.display()));
    }
    Ok(code::DONE)
}

fn trace_of(profile: &Profile, release: &Release) -> Result<Trace, Failure> {
    Ok(profile.simulator().trace(release, INTERVAL_S)?)
}

/// Prints the trace of one release.
pub(crate) fn show(profile: &Profile, release: &Release, as_json: bool) -> Result<u8, Failure> {
    let trace = trace_of(profile, release)?;
    print(profile, &trace, as_json)
}

fn print(profile: &Profile, trace: &Trace, as_json: bool) -> Result<u8, Failure> {
    let units = profile.output().units;
    if as_json {
        let answer = TraceAnswer::new(profile, trace);
        print_answer(&json::text(&document(&answer, units)))
    } else {
        print_prose(&trace_text(trace, units))
    }
}

fn colour_of(trace: &Trace) -> &'static str {
    if trace.outcome.verdict.made {
        MADE_COLOUR
    } else {
        MISSED_COLOUR
    }
}

/// Draws the shot, and `swarm` others with the shooter's errors.
fn write_plot(
    path: &Path,
    swarm: u32,
    profile: &Profile,
    nominal: &Nominal,
    trace: &Trace,
) -> Result<(), Failure> {
    let sampler = Sampler::new(profile);
    let others: Vec<Trace> = (0..u64::from(swarm))
        .map(|index| {
            let release = sampler.sample(nominal, profile.search().seed, index);
            trace_of(profile, &release)
        })
        .collect::<Result<_, _>>()?;
    let mut paths: Vec<ShotPath<'_>> = others
        .iter()
        .map(|trace| ShotPath {
            trace,
            colour: colour_of(trace),
            is_detailed: false,
        })
        .collect();
    paths.push(ShotPath {
        trace,
        colour: if swarm > 0 { BLACK } else { colour_of(trace) },
        is_detailed: true,
    });
    let units = profile.output().units;
    let title = title(profile, nominal, trace);
    let note = note(&others);
    let plot = shot_views::draw("shot", &title, &note, profile.physics(), units, &paths);
    plot_files::write_one(path, &plot)
}

fn title(profile: &Profile, nominal: &Nominal, trace: &Trace) -> String {
    let (long, metre) = profile.output().units.length();
    format!(
        "{}: {:.2} {long}/s, {:.1} deg, backspin {:.1} rev/s: {}",
        shortened(&profile.shooter().name, 40),
        nominal.speed_m_s / metre,
        nominal.pitch_rad / DEGREE_RAD,
        nominal.backspin_rad_s / REV_RAD,
        outcome_text(&trace.outcome)
    )
}

fn note(others: &[Trace]) -> String {
    if others.is_empty() {
        return "Circles: the ball at the release (dashed), at touches of the board (green) and the ring (yellow), and at the end (dashed).".to_owned();
    }
    let made = others
        .iter()
        .filter(|trace| trace.outcome.verdict.made)
        .count();
    format!(
        "Black: the error-free shot; blue: {made} go in, orange: {} miss, with the shooter's scatter. Circles: touches of the board (green) and the ring (yellow).",
        others.len() - made
    )
}
