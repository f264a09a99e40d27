//! `bankshot status`, `missing` and `verify`: the state of a sweep's folder.

use super::sweep_summary::{exit_code, job_summary, missing_shards};
use crate::answers::json;
use crate::answers::sweep_status::{JobCounts, StatusAnswer, StoreStatus, VerifyAnswer};
use crate::cli::failure::{Failure, code, refuse_missing};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_prose};
use crate::cli::value_parsers::fraction;
use crate::probability::Progress;
use crate::sweep::final_tables::ResultTables;
use crate::sweep::job_list::Jobs;
use crate::sweep::result_row::{JobStatus, ResultRow};
use crate::sweep::run::compute_jobs;
use crate::sweep::sweep_folder::SweepFolder;
use crate::sweep::{SweepConfig, is_locked, sqlite_results};
use clap::Args;
use std::collections::BTreeMap;
use std::path::PathBuf;

#[derive(Args, Debug)]
pub(crate) struct StatusOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct VerifyOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Compute this fraction of the jobs again, such as 1%, and compare every bit.
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub(crate) recompute: Option<f64>,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Args, Debug)]
pub(crate) struct MissingOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Number of shards of the sweep.
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1_000_000))]
    pub(crate) shards: usize,
}

pub(crate) fn status(options: &StatusOptions) -> Result<u8, Failure> {
    refuse_missing(&options.folder)?;
    let (folder, config) = SweepFolder::open_read_only(&options.folder)?;
    let jobs = Jobs::new(&config);
    let (rows, remarks) = folder.union()?;
    let mut text = format!("{}\n", config.name) + &job_summary(&jobs, &rows);
    let mut stores = Vec::new();
    for store in folder.stores()? {
        let (computed, seconds) = sqlite_results::job_times(&store);
        let is_running = is_locked(&store.with_extension("lock"));
        let running = if is_running { ", running" } else { "" };
        let file = store.file_name().unwrap_or_default().to_string_lossy();
        stores.push(StoreStatus {
            file: file.into_owned(),
            computed,
            thread_seconds: seconds,
            is_running,
        });
        text.push_str(&format!(
            "{}: {computed} jobs, {:.2} s each{running}\n",
            store.file_name().unwrap_or_default().display(),
            seconds / computed.max(1) as f64
        ));
    }
    for remark in &remarks {
        text.push_str(&format!("remark: {}\n", one_line(remark)));
    }
    if options.json {
        let answer = StatusAnswer {
            jobs: job_counts(&jobs, &rows),
            sweep: config.name.clone(),
            stores,
            remarks: remarks.iter().map(ToString::to_string).collect(),
            provenance: config.provenance()?,
        };
        print_answer(&json::text(&json::document(
            &answer,
            config.settings.output.units,
        )))?;
    } else {
        print_prose(&text)?;
    }
    Ok(exit_code(&jobs, &rows))
}

/// A message of the database, which may have several lines, as one.
fn one_line(message: &impl std::fmt::Display) -> String {
    message.to_string().replace('\n', " ")
}

pub(crate) fn missing(options: &MissingOptions) -> Result<u8, Failure> {
    refuse_missing(&options.folder)?;
    let (folder, config) = SweepFolder::open_read_only(&options.folder)?;
    let jobs = Jobs::new(&config);
    let (rows, _) = folder.union()?;
    let array = missing_shards(&jobs, &rows, options.shards);
    if array.is_empty() {
        return Ok(code::DONE);
    }
    print_answer(&format!("{array}\n"))?;
    Ok(code::INCOMPLETE)
}

pub(crate) fn verify(options: &VerifyOptions) -> Result<u8, Failure> {
    refuse_missing(&options.folder)?;
    let (folder, config) = SweepFolder::existing(&options.folder)?;
    let jobs = Jobs::new(&config);
    let (rows, remarks) = folder.union()?;
    let mut text = job_summary(&jobs, &rows);
    for remark in &remarks {
        text.push_str(&format!("damaged: {}\n", one_line(remark)));
    }
    let wrong_tables = match rows.len() == jobs.count() {
        true => wrong_tables(&folder, &config, &jobs, &rows)?,
        false => Vec::new(),
    };
    for words in &wrong_tables {
        text.push_str(&format!("damaged: {words}\n"));
    }
    let mut differing = Vec::new();
    let mut recomputed = 0;
    if let Some(fraction) = options.recompute {
        let every = (1.0 / fraction).round().max(1.0) as usize;
        let chosen: Vec<&ResultRow> = rows
            .values()
            .filter(|row| row.status() != Some(JobStatus::Failed))
            .step_by(every)
            .collect();
        differing = recompute(&config, &jobs, &chosen);
        recomputed = chosen.len();
        text.push_str(&format!(
            "recomputed {} jobs: {} differ\n",
            chosen.len(),
            differing.len()
        ));
        for job in &differing {
            text.push_str(&format!("differs: job {job}\n"));
        }
    }
    if rows.len() < jobs.count() {
        text.push_str("incomplete; run the sweep's command again to compute the rest\n");
    }
    if options.json {
        let answer = VerifyAnswer {
            jobs: job_counts(&jobs, &rows),
            damaged: remarks.iter().map(ToString::to_string).collect(),
            damaged_tables: wrong_tables.clone(),
            recomputed,
            differing_jobs: differing.clone(),
            provenance: config.provenance()?,
        };
        print_answer(&json::text(&json::document(
            &answer,
            config.settings.output.units,
        )))?;
    } else {
        print_prose(&text)?;
    }
    let is_damaged = !remarks.is_empty() || !wrong_tables.is_empty() || !differing.is_empty();
    Ok(if is_damaged {
        code::DAMAGED
    } else {
        exit_code(&jobs, &rows)
    })
}

/// The tables of a finished sweep that are not what its results give.
fn wrong_tables(
    folder: &SweepFolder,
    config: &SweepConfig,
    jobs: &Jobs,
    rows: &BTreeMap<u64, ResultRow>,
) -> Result<Vec<String>, Failure> {
    let tables = ResultTables::new(config, folder.hash(), jobs, rows);
    let files = tables.files(config).map_err(Failure::bug)?;
    let wrong = files.iter().filter_map(|(name, bytes)| {
        let what = match std::fs::read(folder.path().join(name)) {
            Ok(own) if own == *bytes => return None,
            Ok(_) => "is not what the results of the sweep give",
            Err(_) => "cannot be read",
        };
        Some(format!(
            "{name} {what}; the sweep's command writes it again"
        ))
    });
    Ok(wrong.collect())
}

/// How many jobs there are, and how many ended how.
fn job_counts(jobs: &Jobs, rows: &BTreeMap<u64, ResultRow>) -> JobCounts {
    let count = |status| {
        let with = rows.values().filter(|row| row.status() == Some(status));
        with.count()
    };
    JobCounts {
        jobs: jobs.count(),
        done: rows.len(),
        found: count(JobStatus::Found),
        without_shot: count(JobStatus::NoShot),
        failed: count(JobStatus::Failed),
    }
}

/// Computes some jobs again; returns those whose result differs.
fn recompute(config: &SweepConfig, jobs: &Jobs, rows: &[&ResultRow]) -> Vec<u64> {
    let bars = ProgressBars::new();
    bars.begin("recomputing", rows.len() as u64);
    let mut differing = Vec::new();
    for row in rows {
        if let Some((spot, kind)) = jobs.spot_and_kind(row.job) {
            let again = compute_jobs(config, jobs, spot, &[kind], &bars);
            if again.ok().as_deref() != Some(std::slice::from_ref(*row)) {
                differing.push(row.job);
            }
        }
        bars.advance(1);
    }
    bars.end();
    differing
}
