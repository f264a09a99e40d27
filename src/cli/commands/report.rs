//! `bankshot report`: one HTML page of the folder of a run.

use super::sweep_summary;
use crate::cli::args::FolderOptions;
use crate::cli::config_files::read_text;
use crate::cli::failure::{Failure, code};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_remark};
use bankshot::output::atomic_file;
use bankshot::report::ReportError;
use bankshot::report::best_shot_page::best_shot_page;
use bankshot::report::best_shot_run::{
    BEST_SHOTS_FILE, BestShotRun, CURVES_FILE, PROFILE_FILE, RunTexts, SENSITIVITY_FILE,
};
use bankshot::report::page::Page;
use bankshot::report::sweep_page::sweep_page;
use bankshot::sweep::jobs::Jobs;
use bankshot::sweep::sweep_folder::SweepFolder;
use std::path::{Path, PathBuf};

/// The file of a sweep's folder that `sweep` writes first.
const SWEEP_MANIFEST: &str = "configuration.json";
/// The file beside the plots of a sweep that names the sweep's folder; `compare` writes it.
const SWEEP_LINK: &str = "of_sweep.json";

pub(crate) fn run(options: &FolderOptions, quiet: bool) -> Result<u8, Failure> {
    let folder = &options.folder;
    match sweep_of(folder) {
        Some(sweep) => report_sweep(folder, &sweep, quiet),
        None => report_best_shots(folder, quiet),
    }
}

/// The sweep in a folder, or the sweep whose plots are in it.
fn sweep_of(folder: &Path) -> Option<PathBuf> {
    if folder.join(SWEEP_MANIFEST).exists() {
        return Some(folder.to_owned());
    }
    let text = std::fs::read_to_string(folder.join(SWEEP_LINK)).ok()?;
    let link: serde_json::Value = serde_json::from_str(&text).ok()?;
    Some(PathBuf::from(link.get("sweep")?.as_str()?))
}

fn report_sweep(folder: &Path, sweep: &Path, quiet: bool) -> Result<u8, Failure> {
    let (sweep, config) = SweepFolder::open_read_only(sweep)?;
    let (rows, remarks) = sweep.union()?;
    for remark in remarks {
        print_remark(&format!("remark: {remark}"));
    }
    let source = (sweep.program(), sweep.hash());
    let page = sweep_page(&config, &rows, source).map_err(|error| failure(folder, &error))?;
    write(folder, &page, quiet)?;
    Ok(sweep_summary::exit_code(&Jobs::new(&config), &rows))
}

fn report_best_shots(folder: &Path, quiet: bool) -> Result<u8, Failure> {
    let profile = folder.join(PROFILE_FILE);
    if !profile.exists() {
        return Err(Failure::usage(format!(
            "{}: is not the folder of a `best`, `compare` or `sweep` run (there is no {PROFILE_FILE} and no {SWEEP_MANIFEST})",
            folder.display()
        )));
    }
    let read_if_exists = |name: &str| {
        let path = folder.join(name);
        path.exists().then(|| read_text(&path)).transpose()
    };
    let texts = RunTexts {
        profile: read_text(&profile)?,
        best_shots: read_text(&folder.join(BEST_SHOTS_FILE))?,
        curves: read_if_exists(CURVES_FILE)?,
        sensitivity: read_if_exists(SENSITIVITY_FILE)?,
    };
    let page = BestShotRun::parse(&texts, &profile.display().to_string())
        .and_then(|run| best_shot_page(&run, &ProgressBars::new(quiet)))
        .map_err(|error| failure(folder, &error))?;
    write(folder, &page, quiet)
}

fn failure(folder: &Path, error: &ReportError) -> Failure {
    match error {
        ReportError::NoShot => Failure {
            code: code::INCOMPLETE,
            message: format!("{}: {error}", folder.display()),
        },
        ReportError::File { .. } => Failure::usage(format!("{}: {error}", folder.display())),
        _ => Failure::usage(error),
    }
}

/// Writes the page into the folder and prints its answer.
fn write(folder: &Path, page: &Page, quiet: bool) -> Result<u8, Failure> {
    let target = folder.join("report.html");
    let html = page.html()?;
    atomic_file::write(&target, html.as_bytes())
        .map_err(|error| Failure::io(target.display(), &error))?;
    print_answer(&format!("{}\n", page.answer))?;
    if !quiet {
        print_remark(&format!(
            "written to {} ({:.2} MB)",
            target.display(),
            html.len() as f64 / 1e6
        ));
    }
    Ok(code::DONE)
}
