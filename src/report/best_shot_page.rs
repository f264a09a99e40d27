//! The page of a `best` run.

use super::best_shot_table::shot_table;
use super::page::Page;
use super::page_data::Scene;
use super::report_error::ReportError;
use super::sensitivity_table::sensitivity_table;
use super::shot_in_words::ReportShot;
use crate::analysis::rebounds::{REACH_M, find_rebounds};
use crate::answers::rebounds::ReboundsAnswer;
use crate::dynamics::Trace;
use crate::model::league_courts::League;
use crate::plots::shot_views::{self, ShotPath};
use crate::plots::shot_with_probability::PlottedShot;
use crate::plots::svg::Plot;
use crate::plots::{bank_direct_release_map, probability_curves, rebound_map};
use crate::probability::Progress;
use crate::shooter::{Profile, ShotKind};
use crate::store::best_run::{BestRun, FoundShot};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// Colours of the paths, as in the moving picture of the page.
const DIRECT_COLOUR: &str = "#0072b2";
const BANK_COLOUR: &str = "#b85c00";
/// Time between points of a path, s.
const SAMPLE_INTERVAL_S: f64 = 0.005;

/// Makes the page of a `best` run of a profile, which is in the units of the run.
///
/// # Errors
/// The run has no shot.
pub fn best_shot_page(
    profile: &Profile,
    run: &BestRun,
    progress: &dyn Progress,
) -> Result<Page, ReportError> {
    let by_probability = |a: &&FoundShot, b: &&FoundShot| a.probability.total_cmp(&b.probability);
    let better = run.shots.iter().max_by(by_probability);
    let better = better.ok_or(ReportError::NoShot)?;
    let units = profile.output().units;
    let shots: Vec<ReportShot> = run
        .shots
        .iter()
        .map(|shot| ReportShot {
            place: 0,
            location: profile.location(),
            shot: PlottedShot {
                kind: shot.kind,
                nominal: shot.nominal,
                probability: shot.probability,
                standard_error: shot.standard_error,
            },
            mirror_of: None,
        })
        .collect();
    let mut tables = vec![shot_table(&shots, units)];
    tables.extend(sensitivity_table(&run.shots, units));
    Ok(Page {
        title: profile.shooter().name.clone(),
        answer: answer(profile, run, better),
        first_place: 0,
        other_shooter: None,
        scene: Scene {
            simulator: profile.simulator().clone(),
            court: League::Ncaa.court(),
            height_above_hoop_m: profile.height_above_hoop_m(),
            units,
        },
        tables,
        plots: draw_plots(profile, run, &shots, progress),
        footer: format!(
            "bankshot {} ({}), profile {}.",
            env!("CARGO_PKG_VERSION"),
            env!("BANKSHOT_COMMIT"),
            &profile.hash()[..12]
        ),
        shots,
    })
}

fn draw_plots(
    profile: &Profile,
    run: &BestRun,
    shots: &[ReportShot],
    progress: &dyn Progress,
) -> Vec<Plot> {
    let shots: Vec<PlottedShot> = shots.iter().map(|shot| shot.shot).collect();
    progress.begin("drawing", 2);
    let mut plots = Vec::new();
    plots.extend(draw_views(profile, &shots));
    plots.extend(bank_direct_release_map::draw_probabilities(profile, &shots));
    progress.advance(1);
    plots.extend(bank_direct_release_map::draw_outcomes(profile, &shots));
    let curves = run.shots.iter().map(|shot| (shot.kind, &shot.curves[..]));
    plots.extend(probability_curves::draw(
        profile,
        &curves.collect::<Vec<_>>(),
    ));
    plots.extend(draw_rebounds(profile, &shots));
    progress.end();
    plots
}

/// Where the misses of the better shot come down.
fn draw_rebounds(profile: &Profile, shots: &[PlottedShot]) -> Option<Plot> {
    let by_probability =
        |a: &&PlottedShot, b: &&PlottedShot| a.probability.total_cmp(&b.probability);
    let better = shots.iter().max_by(by_probability)?;
    let seed = profile.search().seed;
    let found = find_rebounds(profile, &better.nominal, seed, REACH_M);
    let answer = ReboundsAnswer::new(profile, &found, REACH_M);
    rebound_map::draw(profile, &found, &answer)
}

/// The best shots without an error: where they cross the ring, and where on the board they go.
/// `None` if one cannot be simulated.
fn draw_views(profile: &Profile, shots: &[PlottedShot]) -> Option<Plot> {
    let traces: Vec<Trace> = shots
        .iter()
        .map(|shot| {
            let release = profile.release(&shot.nominal);
            profile.simulator().trace(&release, SAMPLE_INTERVAL_S)
        })
        .collect::<Result<_, _>>()
        .ok()?;
    let paths: Vec<ShotPath<'_>> = traces
        .iter()
        .zip(shots)
        .map(|(trace, shot)| ShotPath {
            trace,
            colour: match shot.kind {
                ShotKind::Direct => DIRECT_COLOUR,
                ShotKind::Bank => BANK_COLOUR,
            },
            is_detailed: true,
        })
        .collect();
    let units = profile.output().units;
    let title = "Where to aim: the best shots without scatter";
    let note = "Blue: the direct shot, brown: the bank shot.";
    let mut plot = shot_views::draw("views", title, note, profile.physics(), units, &paths);
    plot.caption = "From the side, from above, facing the board, and over the ring.".to_owned();
    Some(plot)
}

fn answer(profile: &Profile, run: &BestRun, best: &FoundShot) -> String {
    let units = profile.output().units;
    let (long, unit_m) = units.length();
    let other = run.shots.iter().find(|other| other.kind != best.kind);
    let compared = other.map_or(String::new(), |other| {
        format!(
            ", {:.1} more than with the {} shot",
            100.0 * (best.probability - other.probability),
            other.kind.name()
        )
    });
    format!(
        "From {}, take the {} shot: {:.1} of 100 go in{compared} (simulation error {:.1}). Release at {:.2} {long}/s and {:.1} deg with {:.1} rev/s of backspin{}.",
        profile.location().in_words(units),
        best.kind.name(),
        100.0 * best.probability,
        100.0 * best.standard_error,
        best.nominal.speed_m_s / unit_m,
        best.nominal.pitch_rad / DEGREE_RAD,
        best.nominal.backspin_rad_s / REV_RAD,
        aim(best, units)
    )
}

/// Where a shot is aimed: the end of a sentence, empty if not known.
fn aim(shot: &FoundShot, units: UnitSystem) -> String {
    let (short, size) = units.short_length();
    match (shot.kind, shot.board_point_m, shot.aim_past_centre_m) {
        (ShotKind::Bank, Some((across, above)), _) => {
            let side = if across > 0.0 { "right" } else { "left" };
            format!(
                "; the ball's centre meets the board {:.0} {short} above the ring and {:.0} {short} to the {side} of its middle line, facing the board",
                above / size,
                across.abs() / size
            )
        }
        (_, _, Some(past)) => {
            let side = if past < 0.0 { "short of" } else { "past" };
            format!(
                "; the path passes the ring's plane {:.1} {short} {side} its centre",
                past.abs() / size
            )
        }
        _ => String::new(),
    }
}
