//! Summaries of a sweep's results as text.

use crate::cli::failure::code;
use crate::present::words::per_100;
use crate::shooter::Location;
use crate::sweep::bank_direct_difference::BankAdvantage;
use crate::sweep::job_list::Jobs;
use crate::sweep::result_row::{JobStatus, ResultRow};
use crate::sweep::{SweepConfig, columns};
use std::collections::BTreeMap;

/// Greatest number of listed failures.
const MAX_FAILURES: usize = 10;

/// How many jobs ended how, and which failed.
pub(crate) fn job_summary(jobs: &Jobs, rows: &BTreeMap<u64, ResultRow>) -> String {
    let with_status = |status| {
        rows.values()
            .filter(move |row| row.status() == Some(status))
    };
    let mut text = format!(
        "{} of {} jobs done: {} with a best shot, {} without, {} failed\n",
        rows.len(),
        jobs.count(),
        with_status(JobStatus::Found).count(),
        with_status(JobStatus::NoShot).count(),
        with_status(JobStatus::Failed).count()
    );
    for row in with_status(JobStatus::Failed).take(MAX_FAILURES) {
        if let (Some(kind), Some(x), Some(y), Some(reason)) = (
            row.text(columns::KIND),
            row.real(columns::X),
            row.real(columns::Y),
            row.text(columns::REASON),
        ) {
            text.push_str(&format!(
                "failed: job {}, {kind} from x {x:.3} m, y {y:.3} m: {reason}\n",
                row.job
            ));
        }
    }
    text
}

/// The best and the worst place, and at how many places the bank shot is better.
pub(crate) fn highlights(
    config: &SweepConfig,
    jobs: &Jobs,
    rows: &BTreeMap<u64, ResultRow>,
) -> String {
    let mut best_by_place: Vec<(f64, &ResultRow)> = Vec::new();
    for source in &jobs.sources {
        let found: Vec<(f64, &ResultRow)> = (0..jobs.kinds.len())
            .filter_map(|kind| rows.get(&jobs.number(source.computed, kind)))
            .filter_map(|row| Some((row.real(columns::PROBABILITY)?, row)))
            .collect();
        best_by_place.extend(found.into_iter().reduce(larger));
    }
    let best = best_by_place.iter().copied().reduce(larger);
    let worst = best_by_place.iter().copied().reduce(smaller);
    let mut text = String::new();
    for (label, place) in [("Easiest place", best), ("Hardest", worst)] {
        text.extend(place.and_then(|(p, row)| place_text(config, label, p, row)));
    }
    if let Some(advantage) = BankAdvantage::of(jobs, rows) {
        text.push_str(&format!("{advantage}\n"));
    }
    text
}

/// The one with the larger P; the first if they are equal.
fn larger<'a>(a: (f64, &'a ResultRow), b: (f64, &'a ResultRow)) -> (f64, &'a ResultRow) {
    if b.0 > a.0 { b } else { a }
}

/// The one with the smaller P; the first if they are equal.
fn smaller<'a>(a: (f64, &'a ResultRow), b: (f64, &'a ResultRow)) -> (f64, &'a ResultRow) {
    if b.0 < a.0 { b } else { a }
}

fn place_text(config: &SweepConfig, label: &str, p: f64, row: &ResultRow) -> Option<String> {
    let kind = row.text(columns::KIND)?;
    let place = Location {
        distance_m: row.real(columns::DISTANCE)?,
        angle_rad: row.real(columns::COURT_ANGLE)?,
    };
    Some(format!(
        "{label}: {}: {kind}, {} of 100.\n",
        place.in_words(config.settings.output.units),
        per_100(p)
    ))
}

/// The shards with missing jobs, in the form of `sbatch --array`, such as `2,4-5`.
pub(crate) fn missing_shards(
    jobs: &Jobs,
    rows: &BTreeMap<u64, ResultRow>,
    shards: usize,
) -> String {
    let mut is_missing = vec![false; shards];
    for job in 0..jobs.count() as u64 {
        if !rows.contains_key(&job)
            && let Some((spot, _)) = jobs.spot_and_kind(job)
        {
            is_missing[spot % shards] = true;
        }
    }
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for shard in (1..=shards).filter(|shard| is_missing[shard - 1]) {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == shard => *last = shard,
            _ => ranges.push((shard, shard)),
        }
    }
    let ranges: Vec<String> = ranges
        .into_iter()
        .map(|(first, last)| {
            if first == last {
                first.to_string()
            } else {
                format!("{first}-{last}")
            }
        })
        .collect();
    ranges.join(",")
}

/// The exit code of a sweep's results: done or incomplete.
pub(crate) fn exit_code(jobs: &Jobs, rows: &BTreeMap<u64, ResultRow>) -> u8 {
    let has_failed = |row: &ResultRow| row.status() == Some(JobStatus::Failed);
    if rows.len() < jobs.count() || rows.values().any(has_failed) {
        code::INCOMPLETE
    } else {
        code::DONE
    }
}
