//! The page of a sweep.

use super::best_shot_table::shot_table;
use super::page::Page;
use super::page_data::Scene;
use super::report_error::ReportError;
use super::shot_in_words::{ReportShot, most_probable};
use crate::dynamics::Simulator;
use crate::plots::shot_with_probability::PlottedShot;
use crate::plots::svg::Plot;
use crate::plots::sweep_results::SweepResults;
use crate::plots::{sweep_bank_direct_map, sweep_best_shot_maps};
use crate::sweep::SweepConfig;
use crate::sweep::columns;
use crate::sweep::job_list::Jobs;
use crate::sweep::result_row::{JobStatus, ResultRow};
use std::collections::BTreeMap;

/// Makes the page of a sweep. `program` and `hash` are those that its results were computed with.
///
/// # Errors
/// No shot was found, or the physics cannot be simulated.
pub fn sweep_page(
    config: &SweepConfig,
    rows: &BTreeMap<u64, ResultRow>,
    (program, hash): (&str, &str),
) -> Result<Page, ReportError> {
    let settings = &config.settings;
    let jobs = Jobs::new(config);
    let shots = list_shots(&jobs, rows);
    let results = SweepResults::new(config, rows);
    let comparison = sweep_bank_direct_map::draw(&results);
    let answer = answer(config, &shots, comparison.as_ref()).ok_or(ReportError::NoShot)?;
    let mut plots: Vec<Plot> = comparison.into_iter().collect();
    plots.extend(sweep_best_shot_maps::draw_all(&results));
    let count = |status: JobStatus| {
        let rows = rows.values();
        rows.filter(|row| row.status() == Some(status)).count()
    };
    Ok(Page {
        title: format!("{}: {}", config.name, settings.shooter.name),
        answer,
        tables: vec![shot_table(&shots, settings.output.units)],
        first_place: spot_near_free_throw_line(config, &shots),
        shots,
        plots,
        other_shooter: None,
        scene: Scene {
            simulator: Simulator::with_integrator(&settings.physics, settings.integrator)?,
            court: config.league.court(),
            height_above_hoop_m: settings.shooter.release_height_m
                - settings.physics.hoop_plane_height_m(),
            units: settings.output.units,
        },
        footer: format!(
            "bankshot {program}, configuration {}; {} of {} jobs: {} found, {} without a best shot, {} failed; simulation error {}.",
            hash.get(..12).unwrap_or(hash),
            rows.len(),
            jobs.count(),
            count(JobStatus::Found),
            count(JobStatus::NoShot),
            count(JobStatus::Failed),
            settings.search.standard_error()
        ),
    })
}

/// All shots that were found. The computed ones come first, so that their mirror images can refer
/// to them.
fn list_shots(jobs: &Jobs, rows: &BTreeMap<u64, ResultRow>) -> Vec<ReportShot> {
    let mut shots: Vec<ReportShot> = Vec::new();
    // The index of the shot of each job.
    let mut shot_of_job: BTreeMap<u64, usize> = BTreeMap::new();
    for mirrored in [false, true] {
        let sources = jobs.sources.iter().enumerate();
        for (place, source) in sources.filter(|(_, source)| source.mirrored == mirrored) {
            for kind in 0..jobs.kinds.len() {
                let job = jobs.number(source.computed, kind);
                let Some(row) = rows.get(&job) else { continue };
                let shot = if mirrored {
                    shot_with_probability(&row.mirrored(), jobs, kind)
                } else {
                    shot_with_probability(row, jobs, kind)
                };
                let Some(shot) = shot else { continue };
                if !mirrored {
                    shot_of_job.entry(job).or_insert(shots.len());
                }
                let computed = shot_of_job.get(&job).copied();
                shots.push(ReportShot {
                    place,
                    location: source.place.location(),
                    shot,
                    mirror_of: computed.filter(|_| mirrored),
                });
            }
        }
    }
    shots
}

/// The shot of a row, if one was found; `kind` is its index in [`Jobs::kinds`].
fn shot_with_probability(row: &ResultRow, jobs: &Jobs, kind: usize) -> Option<PlottedShot> {
    let value = |column| row.real(column).unwrap_or(0.0);
    Some(PlottedShot {
        kind: jobs.kinds[kind],
        nominal: row.nominal()?,
        probability: row.real(columns::PROBABILITY)?,
        standard_error: value(columns::STANDARD_ERROR),
    })
}

/// The best and the worst place, and how bank compares with direct; `None` if there are no shots.
fn answer(config: &SweepConfig, shots: &[ReportShot], comparison: Option<&Plot>) -> Option<String> {
    let units = config.settings.output.units;
    let best = most_probable(shots)?;
    // The best shot of each place.
    let mut best_at: BTreeMap<usize, &ReportShot> = BTreeMap::new();
    for shot in shots {
        let best = best_at.entry(shot.place).or_insert(shot);
        if shot.shot.probability > best.shot.probability {
            *best = shot;
        }
    }
    let worst = best_at
        .into_values()
        .min_by(|a, b| a.shot.probability.total_cmp(&b.shot.probability))?;
    let in_words = |shot: &ReportShot| {
        let is_mirror = |other: &ReportShot| {
            other
                .mirror_of
                .is_some_and(|i| shots[i].place == shot.place)
        };
        if shot.mirror_of.is_some() || shots.iter().any(is_mirror) {
            shot.location.in_words_on_either_side(units)
        } else {
            shot.location.in_words(units)
        }
    };
    let compared = comparison.map_or(String::new(), |plot| {
        format!(
            " {} The profile counts as exact here. For a measured player, `bankshot team` shows where bank or direct is not clear yet.",
            plot.caption
        )
    });
    Some(format!(
        "The best place is {}: {:.1} of 100 go in with the {} shot. The hardest is {}: {:.1} with the {} shot.{compared}",
        in_words(best),
        100.0 * best.shot.probability,
        best.shot.kind.name(),
        in_words(worst),
        100.0 * worst.shot.probability,
        worst.shot.kind.name()
    ))
}

/// The place that is nearest to the middle of the free-throw line.
fn spot_near_free_throw_line(config: &SweepConfig, shots: &[ReportShot]) -> usize {
    let line_x_m = config.league.court().free_throw_x_m;
    let distance_squared = |shot: &ReportShot| {
        let (x_m, y_m) = shot.location.to_xy();
        let x_m = x_m - line_x_m;
        x_m * x_m + y_m * y_m
    };
    shots
        .iter()
        .min_by(|a, b| distance_squared(a).total_cmp(&distance_squared(b)))
        .map_or(0, |shot| shot.place)
}
