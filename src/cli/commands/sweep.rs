//! `bankshot sweep` and `bankshot merge`: compute the jobs, and write the tables.

use super::sweep_summary::{highlights, job_summary, missing_shards};
use crate::cli::command_line_flags::{MergeOptions, SweepOptions};
use crate::cli::config_files::load_sweep;
use crate::cli::failure::{Failure, code};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder;
use crate::cli::signals;
use crate::cli::terminal::{print_answer, print_remark};
use bankshot::output::atomic_file;
use bankshot::sweep::final_tables::ResultTables;
use bankshot::sweep::job_list::{Jobs, Shard};
use bankshot::sweep::result_row::{JobStatus, ResultRow};
use bankshot::sweep::run::{RunOptions, SweepRun};
use bankshot::sweep::sweep_folder::SweepFolder;
use bankshot::sweep::{SweepConfig, columns};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The jobs that are saved on disk, for the remark when a signal stops the program.
static SAVED_JOBS: AtomicUsize = AtomicUsize::new(0);

pub(crate) fn run(options: &SweepOptions, quiet: bool) -> Result<u8, Failure> {
    let (config, texts) = load_sweep(&options.sweep)?;
    let jobs = Jobs::new(&config);
    let shard = options.shard.unwrap_or(Shard::WHOLE);
    let path = match &options.out {
        Some(path) => path.clone(),
        None => run_folder::of_sweep(&config)?,
    };
    let folder = SweepFolder::open(&path, &config, &texts)?;
    let lock = folder.lock(shard)?;
    signals::note_aborts(&lock.aborted);
    let run_options = RunOptions {
        shard,
        threads: rayon::current_num_threads(),
        retry_failed: options.retry_failed,
        fault: options.fault.clone(),
    };
    let run = SweepRun::new(&folder, &lock, &config, &jobs, run_options, &SAVED_JOBS)?;
    for damage in run.damaged() {
        print_remark(&format!("remark: {damage}"));
    }
    let (total, done) = run.progress();
    if done > 0 && !quiet {
        print_remark(&format!("resuming: {done} of {total} done"));
    }
    let saved = move || {
        let saved = SAVED_JOBS.load(Ordering::Relaxed);
        format!("{saved} of {total} jobs are saved; run the same command again to continue")
    };
    signals::set_exit_remark(move || format!("stopped: {}", saved()));
    let summary = run.run(&ProgressBars::new(quiet)).map_err(|error| {
        let mut failure = Failure::from(error);
        failure.message += &format!("\n{}", saved());
        failure
    })?;
    drop(run);
    lock.remove_empty_note();
    if shard == Shard::WHOLE {
        return write_tables(&folder, &config, &jobs, None, quiet);
    }
    print_answer(&format!(
        "shard {shard}: {total} jobs, {} done before, {} computed, {} failed; `bankshot merge {}` joins the shards\n",
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

pub(crate) fn merge(options: &MergeOptions, quiet: bool) -> Result<u8, Failure> {
    let (folder, config) = SweepFolder::existing(&options.folder)?;
    let jobs = Jobs::new(&config);
    write_tables(&folder, &config, &jobs, options.shards, quiet)
}

/// Writes the tables if all jobs are done, and prints a summary.
fn write_tables(
    folder: &SweepFolder,
    config: &SweepConfig,
    jobs: &Jobs,
    shards: Option<usize>,
    quiet: bool,
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
        print_answer(&(job_summary(jobs, &rows) + &next))?;
        return Ok(code::INCOMPLETE);
    }
    let tables = ResultTables::new(config, folder.hash(), jobs, &rows);
    let parquet = tables
        .parquet()
        .map_err(|error| Failure::bug(format!("the Parquet table: {error}")))?;
    for (name, bytes) in [
        ("best_shots.csv", tables.csv()),
        ("best_shots.parquet", parquet),
        ("provenance.json", tables.provenance(config)),
    ] {
        let path = folder.path().join(name);
        atomic_file::write_unlinked(&path, &bytes)
            .map_err(|error| Failure::io(path.display(), &error))?;
    }
    print_answer(&(job_summary(jobs, &rows) + &highlights(config, jobs, &rows)))?;
    if !quiet {
        print_remark(&format!(
            "written to {}: best_shots.csv, best_shots.parquet, provenance.json",
            folder.path().display()
        ));
    }
    Ok(exit_code_of_tables(config, &rows))
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
