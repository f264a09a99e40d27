//! The page of a `best` run.

use super::best_shot_run::BestShotRun;
use super::best_shot_table::shot_table;
use super::page::Page;
use super::page_data::Scene;
use super::report_error::ReportError;
use super::sensitivity_table::sensitivity_table;
use super::shot_in_words::{ReportShot, most_probable};
use crate::dynamics::Trace;
use crate::model::league_courts::League;
use crate::plots::shot_views::{self, ShotPath};
use crate::plots::shot_with_probability::PlottedShot;
use crate::plots::svg::Plot;
use crate::plots::{bank_direct_release_map, probability_curves};
use crate::probability::Progress;
use crate::shooter::ShotKind;
use crate::units::{DEGREE_RAD, REV_RAD};

/// Colours of the paths, as in the moving picture of the page.
const DIRECT_COLOUR: &str = "#0072b2";
const BANK_COLOUR: &str = "#b85c00";
/// Time between points of a path, s.
const SAMPLE_INTERVAL_S: f64 = 0.005;

/// Makes the page of a `best` run.
///
/// # Errors
/// The run has no shot.
pub fn best_shot_page(run: &BestShotRun, progress: &dyn Progress) -> Result<Page, ReportError> {
    let profile = &run.profile;
    let better = most_probable(&run.shots).ok_or(ReportError::NoShot)?;
    let units = profile.output().units;
    let mut tables = vec![shot_table(&run.shots, units)];
    tables.extend(sensitivity_table(&run.sensitivity));
    Ok(Page {
        title: profile.shooter().name.clone(),
        answer: answer(run, better),
        shots: run.shots.clone(),
        first_place: 0,
        other_shooter: None,
        scene: Scene {
            simulator: profile.simulator().clone(),
            court: League::Ncaa.court(),
            height_above_hoop_m: profile.height_above_hoop_m(),
            units,
        },
        tables,
        plots: draw_plots(run, progress),
        footer: format!(
            "bankshot {} ({}), profile {}.",
            env!("CARGO_PKG_VERSION"),
            env!("BANKSHOT_COMMIT"),
            &profile.hash()[..12]
        ),
    })
}

fn draw_plots(run: &BestShotRun, progress: &dyn Progress) -> Vec<Plot> {
    let profile = &run.profile;
    let shots: Vec<PlottedShot> = run.shots.iter().map(|shot| shot.shot).collect();
    progress.begin("drawing", 2);
    let mut plots = Vec::new();
    plots.extend(draw_views(run));
    plots.extend(bank_direct_release_map::draw_probabilities(profile, &shots));
    progress.advance(1);
    plots.extend(bank_direct_release_map::draw_outcomes(profile, &shots));
    plots.extend(probability_curves::draw(profile, &run.curves));
    progress.end();
    plots
}

/// The best shots without an error: where they cross the ring, and where on the board they go.
/// `None` if one cannot be simulated.
fn draw_views(run: &BestShotRun) -> Option<Plot> {
    let profile = &run.profile;
    let traces: Vec<Trace> = run
        .shots
        .iter()
        .map(|shot| {
            let release = profile.release(&shot.shot.nominal);
            profile.simulator().trace(&release, SAMPLE_INTERVAL_S)
        })
        .collect::<Result<_, _>>()
        .ok()?;
    let paths: Vec<ShotPath<'_>> = traces
        .iter()
        .zip(&run.shots)
        .map(|(trace, shot)| ShotPath {
            trace,
            colour: match shot.shot.kind {
                ShotKind::Direct => DIRECT_COLOUR,
                ShotKind::Bank => BANK_COLOUR,
            },
            is_detailed: true,
        })
        .collect();
    let units = profile.output().units;
    let title = "Where to aim: the best shots without an error";
    let note = "Blue: the direct shot, brown: the bank shot.";
    let mut plot = shot_views::draw("views", title, note, profile.physics(), units, &paths);
    plot.caption = "From the side, from above, facing the board, and over the ring.".to_owned();
    Some(plot)
}

fn answer(run: &BestShotRun, better: &ReportShot) -> String {
    let units = run.profile.output().units;
    let (long, unit_m) = units.length();
    let best = &better.shot;
    let other = run.shots.iter().find(|other| other.shot.kind != best.kind);
    let compared = other.map_or(String::new(), |other| {
        let other = &other.shot;
        format!(
            ", {:.1} \u{b1} {:.1} points more than the {} shot",
            100.0 * (best.probability - other.probability),
            100.0 * libm::hypot(best.standard_error, other.standard_error),
            other.kind.name()
        )
    });
    format!(
        "From {}, take the {} shot: P {:.3} \u{b1} {:.3}{compared}. Release at {:.2} {long}/s, {:.1} deg up, with {:.1} rev/s of backspin{}.",
        run.profile.location().in_words(units),
        best.kind.name(),
        best.probability,
        best.standard_error,
        best.nominal.speed_m_s / unit_m,
        best.nominal.pitch_rad / DEGREE_RAD,
        best.nominal.backspin_rad_s / REV_RAD,
        run.aim
    )
}
