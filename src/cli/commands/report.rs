//! `bankshot report`: one HTML page of the folder of a run.

use super::sweep_summary;
use crate::best_shot::{PhysicsOf, compare_physics, physics_variants};
use crate::cli::config_files::read_text;
use crate::cli::failure::{Failure, code, refuse_missing};
use crate::cli::fit_folder;
use crate::cli::loaded_profile::LoadedProfile;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder::AGAINST_FOLDER;
use crate::cli::terminal::{print_answer, print_hint, print_prose, print_remark};
use crate::cli::value_parsers::PhysicsArg;
use crate::escape::html;
use crate::files::atomic_file;
use crate::fitting::advise;
use crate::plots::sweep_results::SweepResults;
use crate::plots::{physics_probabilities, sweep_difference_map};
use crate::present::fit_files::advice_text::PlayerAdvice;
use crate::report::ReportError;
use crate::report::best_shot_page::best_shot_page;
use crate::report::page::Page;
use crate::report::physics_section::physics_table;
use crate::report::sweep_page::sweep_page;
use crate::store::best_run::{ANSWER_FILE, BestRun, PROFILE_FILE};
use crate::store::fit::{FIT_FILE, PAGE_FILE};
use crate::store::shooters::fits_within;
use crate::store::sweep_link::SweepLink;
use crate::sweep::SweepConfig;
use crate::sweep::job_list::Jobs;
use crate::sweep::result_row::ResultRow;
use crate::sweep::sweep_folder::SweepFolder;
use clap::Args;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
pub(crate) struct ReportOptions {
    /// The folder of a `best`, `map`, `sweep` or `fit` run. The page of a fit gets the advice.
    pub(crate) folder: PathBuf,
    /// Of a `best` run: add what the answer rests on, as `bankshot physics` does (a minute or two).
    #[arg(long)]
    pub(crate) with_physics: bool,
}

/// The file of a sweep's folder that `sweep` writes first.
const SWEEP_MANIFEST: &str = "configuration.json";

pub(crate) fn run(options: &ReportOptions) -> Result<u8, Failure> {
    let folder = &options.folder;
    refuse_missing(folder)?;
    let is_best_run = !folder.join(FIT_FILE).exists() && sweep_of(folder)?.is_none();
    if options.with_physics && !is_best_run {
        return Err(Failure::usage(format!(
            "--with-physics: {} is not the folder of a `best` run; leave the option out",
            folder.display()
        )));
    }
    if folder.join(FIT_FILE).exists() {
        return page_of_fit(folder);
    }
    match sweep_of(folder)? {
        Some(sweep) => report_sweep(folder, &sweep),
        None => report_best_shots(folder, options.with_physics),
    }
}

/// A fit has its page already, with plots of shots that its folder does not hold. The advice is
/// added to it.
fn page_of_fit(folder: &Path) -> Result<u8, Failure> {
    let page = folder.join(PAGE_FILE);
    if !page.exists() {
        return Err(Failure::usage(format!(
            "{}: `bankshot fit` writes the page of a fit; run it again",
            page.display()
        )));
    }
    let written = read_text(&page)?;
    let parts = written
        .split_once(ADVICE_BEGINS)
        .and_then(|(before, rest)| {
            let (_, after) = rest.split_once(SECTION_ENDS)?;
            Some((before, after))
        });
    let Some((before, after)) = parts else {
        return Err(Failure::usage(format!(
            "{}: has no place for the advice; it was written by another version: run `bankshot fit` again",
            page.display()
        )));
    };
    let fit = fit_folder::read(folder)?;
    let bars = ProgressBars::new();
    let mut advice = String::from("<h2>What to change</h2>\n");
    for (place, profile) in fit.profiles.iter().enumerate() {
        let of_place = advise(profile, &fit.posterior, place, &bars)?;
        let player = PlayerAdvice {
            profile,
            advice: &of_place,
            observed: fit.observed[place],
            doubt: fit.contradiction(place, &of_place.usual_probability),
            units: fit.units,
        };
        let text = player.brief();
        if fit.profiles.len() > 1 {
            let words = profile.location().in_words(fit.units);
            advice += &format!("<h3>{}</h3>\n", html(&words));
        }
        let lines: Vec<String> = text.lines().map(html).collect();
        advice += &format!("<p class=\"answer\">{}</p>\n", lines.join("\n"));
    }
    let renewed = format!("{before}{ADVICE_BEGINS}\n{advice}{SECTION_ENDS}{after}");
    atomic_file::write_unlinked(&page, renewed.as_bytes())
        .map_err(|error| Failure::io(page.display(), &error))?;
    print_answer(&format!("{}\n", page.display()))?;
    Ok(code::DONE)
}

/// The section of a page that the advice of a fit is written into.
const ADVICE_BEGINS: &str = "<section id=\"advice\">";
/// See [`ADVICE_BEGINS`].
const SECTION_ENDS: &str = "</section>";

fn sweep_of(folder: &Path) -> Result<Option<SweepLink>, Failure> {
    // Also a link that leads nowhere: it is refused with its path later.
    if folder.join(SWEEP_MANIFEST).symlink_metadata().is_ok() {
        return Ok(Some(SweepLink {
            sweep: folder.to_owned(),
            against: None,
        }));
    }
    Ok(SweepLink::read(folder)?)
}

fn report_sweep(folder: &Path, paths: &SweepLink) -> Result<u8, Failure> {
    let (sweep, config, rows) = open_sweep(&paths.sweep)?;
    let refuse = |error: ReportError| failure(folder, &error);
    let mut page = sweep_page(&config, &rows, (sweep.program(), sweep.hash())).map_err(refuse)?;
    let mut exit = sweep_summary::exit_code(&Jobs::new(&config), &rows);
    if let Some(path) = &paths.against {
        let (other_sweep, other, other_rows) = open_sweep(path)?;
        let source = (other_sweep.program(), other_sweep.hash());
        let other_page = sweep_page(&other, &other_rows, source).map_err(refuse)?;
        let results = SweepResults::new(&config, &rows);
        let difference =
            sweep_difference_map::draw(&results, &SweepResults::new(&other, &other_rows));
        page.add_comparison(other_page, difference);
        exit = exit.max(sweep_summary::exit_code(&Jobs::new(&other), &other_rows));
    }
    write(folder, &page)?;
    Ok(exit)
}

fn open_sweep(
    path: &Path,
) -> Result<(SweepFolder, SweepConfig, BTreeMap<u64, ResultRow>), Failure> {
    let (sweep, config) = SweepFolder::open_read_only(path)?;
    let (rows, remarks) = sweep.union()?;
    for remark in remarks {
        print_remark(&format!("remark: {remark}"));
    }
    Ok((sweep, config, rows))
}

fn report_best_shots(folder: &Path, with_physics: bool) -> Result<u8, Failure> {
    let mut page = best_shots_page_of(folder)?;
    if with_physics {
        let path = folder.join(PROFILE_FILE);
        let profile = LoadedProfile::read(&path, &PhysicsArg::default())?.profile;
        let units = profile.output().units;
        let variants = physics_variants(profile.physics(), PhysicsOf::Profile);
        let comparison = compare_physics(&profile, &variants, &ProgressBars::new())?;
        page.tables.push(physics_table(&comparison, units));
        let name = &profile.shooter().name;
        page.plots
            .push(physics_probabilities::draw(name, &comparison, units));
    }
    let against = folder.join(AGAINST_FOLDER);
    if against.join(ANSWER_FILE).exists() {
        page.add_comparison(best_shots_page_of(&against)?, None);
    }
    write(folder, &page)
}

fn best_shots_page_of(folder: &Path) -> Result<Page, Failure> {
    let profile = folder.join(PROFILE_FILE);
    if !profile.exists() {
        return Err(Failure::usage(format!(
            "{}: is not the folder of a `best`, `map`, `sweep` or `fit` run (there is no {PROFILE_FILE} and no {SWEEP_MANIFEST}){}",
            folder.display(),
            match fits_within(folder)?.is_empty() {
                true => runs_within(folder),
                false => format!(
                    "; it has the fits of several shooters: `bankshot advise {} --brief` has what to tell each, `bankshot team` a page of all",
                    folder.display()
                ),
            }
        )));
    }
    let (profile, run) = BestRun::read(folder)?;
    best_shot_page(&profile, &run, &ProgressBars::new()).map_err(|error| failure(folder, &error))
}

/// What to name in place of a folder that only holds folders of runs, or a page already.
fn runs_within(folder: &Path) -> String {
    const PAGE_OF_TEAM: &str = "team.html";
    if folder.join(PAGE_OF_TEAM).is_file() {
        return format!("; the page of a team is {PAGE_OF_TEAM} in it");
    }
    let is_run = |path: &Path| {
        let mut files = [PROFILE_FILE, SWEEP_MANIFEST, FIT_FILE].iter();
        files.any(|file| path.join(file).is_file())
    };
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let runs = entries.map(|entry| entry.path());
    let mut runs: Vec<String> = runs
        .filter(|path| is_run(path))
        .map(|path| path.display().to_string())
        .collect();
    runs.sort();
    match &runs[..] {
        [] => String::new(),
        runs => format!("; name a run in it: {}", runs.join(", ")),
    }
}

fn failure(folder: &Path, error: &ReportError) -> Failure {
    match error {
        ReportError::NoShot => Failure {
            code: code::INCOMPLETE,
            message: format!("{}: {error}", folder.display()),
        },
        _ => Failure::usage(error),
    }
}

/// Writes the page into the folder and prints its answer.
fn write(folder: &Path, page: &Page) -> Result<u8, Failure> {
    let target = folder.join(PAGE_FILE);
    let html = page.html()?;
    atomic_file::write_unlinked(&target, html.as_bytes())
        .map_err(|error| Failure::io(target.display(), &error))?;
    print_prose(&format!("{}\n", page.answer))?;
    print_hint(&format!(
        "written to {} ({:.2} MB)",
        target.display(),
        html.len() as f64 / 1e6
    ));
    Ok(code::DONE)
}
