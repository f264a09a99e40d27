//! `bankshot sweep` and `bankshot merge`: compute the jobs, and write the tables.

use super::plan_sweep_time_and_memory;
use super::sweep_summary::{highlights, job_summary, missing_shards};
use crate::cli::config_files::load_sweep;
use crate::cli::failure::{Failure, code, refuse_missing};
use crate::cli::fit_folder;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder::{self, RunKind};
use crate::cli::signals;
use crate::cli::terminal::{is_quiet, print_answer, print_hint, print_prose, print_remark};
use crate::cli::value_parsers::{fault_injection, shard};
use crate::files::atomic_file;
use crate::fitting::{Draw, DrawProbabilities, Interval};
use crate::probability::Progress;
use crate::sweep::final_tables::ResultTables;
use crate::sweep::job_list::{Jobs, Shard};
use crate::sweep::result_row::{JobStatus, ResultRow};
use crate::sweep::run::{FaultInjection, RunOptions, RunSummary, SweepRun};
use crate::sweep::sweep_folder::SweepFolder;
use crate::sweep::sweep_toml::SourceTexts;
use crate::sweep::{SweepConfig, columns};
use clap::Args;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

#[derive(Args, Debug)]
#[command(after_help = "\
The folder has store/*.sqlite (every result as it is computed; query it while the sweep runs) and, at the \
end, best_shots.csv, best_shots.parquet and provenance.json. The same command again computes only what is \
missing.

Examples:
  bankshot sweep configs/half_court.toml --plan
  bankshot sweep configs/half_court.toml --output half_court
  bankshot sweep configs/half_court.toml --output /shared/half_court \\
    --shard 3/64")]
pub(crate) struct SweepOptions {
    /// The sweep: a [sweep] table and a shooter.
    pub(crate) sweep: PathBuf,
    /// Folder of the sweep [default: a numbered one in results/<its name>].
    #[arg(long = "output", short = 'o', alias = "out", value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print how much time, memory and disk the sweep needs, and stop.
    #[arg(long)]
    pub(crate) plan: bool,
    /// Only shard I of N; all shards can share the folder and run on any machine.
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub(crate) shard: Option<Shard>,
    /// Compute failed jobs again.
    #[arg(long)]
    pub(crate) retry_failed: bool,
    /// The folder of a fit: when the sweep is complete, also write probability_over_draws.csv with
    /// the 95 % interval of each best shot.
    #[arg(long, value_name = "FIT_DIR", conflicts_with = "shard")]
    pub(crate) draws: Option<PathBuf>,
    /// Inject a fault, for tests: panic:SPOT, abort:SPOT or wait:SPOT:FILE.
    #[arg(long, hide = true, value_parser = fault_injection)]
    pub(crate) fault: Option<FaultInjection>,
}

#[derive(Args, Debug)]
pub(crate) struct MergeOptions {
    /// The sweep's folder.
    pub(crate) folder: PathBuf,
    /// Number of shards of the sweep, to print which to submit again.
    #[arg(long, value_name = "N", value_parser = clap::builder::RangedU64ValueParser::<usize>::new().range(1..=1_000_000))]
    pub(crate) shards: Option<usize>,
}

/// The jobs that are saved on disk, for the remark when a signal stops the program.
static SAVED_JOBS: AtomicUsize = AtomicUsize::new(0);

pub(crate) fn run(options: &SweepOptions) -> Result<u8, Failure> {
    if options.plan {
        return plan_sweep_time_and_memory::run(&options.sweep, false);
    }
    let (config, texts) = load_sweep(&options.sweep)?;
    let draws = options.draws.as_deref().map(fit_folder::read).transpose()?;
    let jobs = Jobs::new(&config);
    let shard = options.shard.unwrap_or(Shard::WHOLE);
    let path = match &options.out {
        Some(path) => path.clone(),
        None => run_folder::of_sweep(&config)?,
    };
    let run_options = RunOptions {
        retry_failed: options.retry_failed,
        fault: options.fault.clone(),
        ..run_options(shard)
    };
    let (folder, summary) = compute(&path, &config, &texts, run_options)?;
    if options.out.is_none() {
        run_folder::link_latest(&path);
    }
    if shard == Shard::WHOLE {
        let exit = write_tables(&folder, &config, &jobs, None)?;
        if let Some(fit) = draws {
            write_over_draws(&folder, &config, &jobs, &fit.posterior.draws)?;
        }
        return Ok(exit);
    }
    let spots = (0..jobs.spots.len())
        .filter(|&spot| shard.contains(spot))
        .count();
    print_answer(&format!(
        "shard {shard}: {} jobs, {} done before, {} computed, {} failed; `bankshot merge {}` joins the shards\n",
        spots * jobs.kinds.len(),
        summary.resumed,
        summary.computed,
        summary.failed,
        path.display()
    ))?;
    Ok(if summary.failed > 0 {
        code::INCOMPLETE
    } else {
        code::DONE
    })
}

/// A run of a shard on all threads.
pub(super) fn run_options(shard: Shard) -> RunOptions {
    RunOptions {
        shard,
        threads: rayon::current_num_threads(),
        retry_failed: false,
        fault: None,
    }
}

/// Computes what is missing of a sweep in a folder.
pub(super) fn compute(
    path: &Path,
    config: &SweepConfig,
    texts: &SourceTexts,
    options: RunOptions,
) -> Result<(SweepFolder, RunSummary), Failure> {
    run_folder::refuse_other_results(path, RunKind::Sweep)?;
    let jobs = Jobs::new(config);
    let folder = SweepFolder::open(path, config, texts)?;
    let lock = folder.lock(options.shard)?;
    signals::note_aborts(&lock.aborted);
    let run = SweepRun::new(&folder, &lock, config, &jobs, options, &SAVED_JOBS)?;
    for damage in run.damaged() {
        print_remark(&format!("remark: {damage}"));
    }
    let (total, done) = run.progress();
    if done > 0 && !is_quiet() {
        print_remark(&format!("resuming: {done} of {total} done"));
    }
    let saved = move || {
        let saved = SAVED_JOBS.load(Ordering::Relaxed);
        format!("{saved} of {total} jobs are saved; run the same command again to continue")
    };
    signals::set_exit_remark(move || format!("stopped: {}", saved()));
    let summary = run.run(&ProgressBars::new()).map_err(|error| {
        let mut failure = Failure::from(error);
        failure.message += &format!("\n{}", saved());
        failure
    })?;
    drop(run);
    lock.remove_empty_note();
    drop(lock);
    Ok((folder, summary))
}

pub(crate) fn merge(options: &MergeOptions) -> Result<u8, Failure> {
    refuse_missing(&options.folder)?;
    let (folder, config) = SweepFolder::existing(&options.folder)?;
    let jobs = Jobs::new(&config);
    write_tables(&folder, &config, &jobs, options.shards)
}

/// Writes the tables if all jobs are done, and prints a summary.
fn write_tables(
    folder: &SweepFolder,
    config: &SweepConfig,
    jobs: &Jobs,
    shards: Option<usize>,
) -> Result<u8, Failure> {
    let (rows, remarks) = folder.union()?;
    for remark in remarks {
        print_remark(&format!("remark: {remark}"));
    }
    if rows.len() < jobs.count() {
        let next = match shards {
            Some(shards) => format!(
                "incomplete; submit these of the {shards} shards again: --array={}\n",
                missing_shards(jobs, &rows, shards)
            ),
            None => "incomplete; run the command of the sweep again (or give --shards to see which shards to submit again)\n".to_owned(),
        };
        print_prose(&(job_summary(jobs, &rows) + &next))?;
        return Ok(code::INCOMPLETE);
    }
    let tables = ResultTables::new(config, folder.hash(), jobs, &rows);
    let files = tables
        .files(config)
        .map_err(|error| Failure::bug(format!("the Parquet table: {error}")))?;
    for (name, bytes) in files {
        let path = folder.path().join(name);
        atomic_file::write_unlinked(&path, &bytes)
            .map_err(|error| Failure::io(path.display(), &error))?;
    }
    print_answer(&(job_summary(jobs, &rows) + &highlights(config, jobs, &rows)))?;
    print_hint(&format!(
        "written to {}: best_shots.csv, best_shots.parquet, provenance.json",
        folder.path().display()
    ));
    Ok(exit_code_of_tables(config, &rows))
}

/// Draws that P of each shot of a sweep is computed for, and shots for each.
const DRAWS: usize = 400;
const SHOTS_OVER_DRAWS: usize = 16_384;

/// Writes P of the best shots over the draws of a fit.
fn write_over_draws(
    folder: &SweepFolder,
    config: &SweepConfig,
    jobs: &Jobs,
    draws: &[Draw],
) -> Result<(), Failure> {
    let draws: Vec<Draw> = draws
        .iter()
        .step_by(draws.len().div_ceil(DRAWS))
        .cloned()
        .collect();
    let (rows, _) = folder.union()?;
    let (unit, metre) = config.settings.output.units.length();
    let bars = ProgressBars::new();
    bars.begin("over the draws", rows.len() as u64);
    let found = rows
        .par_iter()
        .map(|(job, row)| {
            let p = row_over_draws(config, jobs, row, &draws)?;
            bars.advance(1);
            Ok((*job, p))
        })
        .collect::<Result<BTreeMap<u64, Option<DrawProbabilities>>, Failure>>()?;
    bars.end();
    let mut text =
        format!("place,kind,x_{unit},y_{unit},mean,sd,low,high,numerical_standard_error\n");
    for (number, source) in jobs.sources.iter().enumerate() {
        for (kind, name) in jobs.kinds.iter().map(|kind| kind.name()).enumerate() {
            let Some(Some(p)) = found.get(&jobs.number(source.computed, kind)) else {
                continue;
            };
            let Interval {
                mean,
                sd,
                low,
                high,
            } = p.interval();
            text += &format!(
                "{number},{name},{},{},{mean:.5},{sd:.5},{low:.5},{high:.5},{:.5}\n",
                source.place.x_m / metre,
                source.place.y_m / metre,
                p.numerical_standard_error()
            );
        }
    }
    let path = folder.path().join("probability_over_draws.csv");
    atomic_file::write_unlinked(&path, text.as_bytes())
        .map_err(|error| Failure::io(path.display(), &error))?;
    print_hint(&format!("written: {}", path.display()));
    Ok(())
}

/// P of the shot of a row; `None` where there is none.
fn row_over_draws(
    config: &SweepConfig,
    jobs: &Jobs,
    row: &ResultRow,
    draws: &[Draw],
) -> Result<Option<DrawProbabilities>, Failure> {
    let (Some((spot, _)), Some(nominal)) = (jobs.spot_and_kind(row.job), row.nominal()) else {
        return Ok(None);
    };
    let profile = config.settings.at(jobs.spots[spot].location())?;
    fit_folder::probability_over_draws(draws, &profile, &nominal, SHOTS_OVER_DRAWS).map(Some)
}

fn exit_code_of_tables(config: &SweepConfig, rows: &BTreeMap<u64, ResultRow>) -> u8 {
    let target = config.settings.search.standard_error();
    let has_failed = |row: &ResultRow| row.status() == Some(JobStatus::Failed);
    let is_imprecise = |row: &ResultRow| {
        row.real(columns::STANDARD_ERROR)
            .is_some_and(|error| error > target)
    };
    if rows.values().any(has_failed) {
        code::INCOMPLETE
    } else if rows.values().any(is_imprecise) {
        code::IMPRECISE
    } else {
        code::DONE
    }
}
