//! `bankshot map`: maps of bank and direct shots, over the court or at one location; or of two
//! shooters.

use super::sweep_summary;
use crate::best_shot::{self, BestShots};
use crate::cli::config_files::{load_sweep, read_text};
use crate::cli::failure::{Failure, code};
use crate::cli::loaded_profile::LoadedProfile;
use crate::cli::plot_files;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder::{self, AGAINST_FOLDER, RunKind};
use crate::cli::terminal::{is_quiet, print_prose, print_remark};
use crate::cli::value_parsers::PhysicsArg;
use crate::plots::shot_with_probability::PlottedShot;
use crate::plots::svg::Plot;
use crate::plots::sweep_results::SweepResults;
use crate::plots::{
    bank_direct_release_map, sweep_bank_direct_map, sweep_best_shot_maps, sweep_difference_map,
};
use crate::shooter::Profile;
use crate::store::sweep_link::SweepLink;
use crate::sweep::SweepConfig;
use crate::sweep::job_list::Jobs;
use crate::sweep::result_row::ResultRow;
use crate::sweep::sweep_folder::SweepFolder;
use crate::sweep::sweep_toml::is_sweep;
use clap::Args;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
For a sweep: the best direct and bank shots over the court and their difference; the better kind, angle and spin; and, if they \
were computed, the worth of spin and the costliest scatter.
For a profile: outcomes and probabilities over speed and angle about the best direct and bank shots, and their difference.
Each map is written as SVG and PNG.

Examples:
  bankshot map half_court
  bankshot map half_court --against half_court_elite
  bankshot map configs/bank_wing.toml --output plots")]
pub(crate) struct MapOptions {
    /// A sweep's folder, its TOML (for its default folder), a shooter's profile, or the folder of a
    /// fit.
    pub(crate) what: PathBuf,
    /// Another one of the same type, with another shooter or other settings.
    #[arg(long, value_name = "OTHER")]
    pub(crate) against: Option<PathBuf>,
    /// Folder of the plots [default: plots in the folder of the run].
    #[arg(long = "output", short = 'o', alias = "out", value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

pub(crate) fn run(options: &MapOptions) -> Result<u8, Failure> {
    let Some(sweep) = open_sweep(&options.what)? else {
        return compare_at_location(options);
    };
    let other = match &options.against {
        None => None,
        Some(path) => Some(open_sweep(path)?.ok_or_else(|| {
            Failure::usage(format!(
                "{}: is not a sweep, but {} is; compare two of the same type",
                path.display(),
                options.what.display()
            ))
        })?),
    };
    compare_on_court(options, &sweep, other.as_ref())
}

/// A sweep's folder with its results.
struct OpenSweep {
    folder: SweepFolder,
    config: SweepConfig,
    rows: BTreeMap<u64, ResultRow>,
}

impl OpenSweep {
    fn exit_code(&self) -> u8 {
        sweep_summary::exit_code(&Jobs::new(&self.config), &self.rows)
    }
}

/// The sweep of a folder, or of a TOML file whose sweep has its default folder; `None` for a
/// profile, or the folder of a fit.
fn open_sweep(path: &Path) -> Result<Option<OpenSweep>, Failure> {
    let path = if path.join("fit.json").is_file() {
        return Ok(None);
    } else if path.is_dir() {
        path.to_owned()
    } else if is_sweep(&read_text(path)?) {
        run_folder::of_sweep(&load_sweep(path)?.0)?
    } else {
        return Ok(None);
    };
    let (folder, config) = SweepFolder::open_read_only(&path)?;
    let (rows, remarks) = folder.union()?;
    for remark in remarks {
        print_remark(&format!("remark: {remark}"));
    }
    Ok(Some(OpenSweep {
        folder,
        config,
        rows,
    }))
}

fn compare_on_court(
    options: &MapOptions,
    sweep: &OpenSweep,
    other: Option<&OpenSweep>,
) -> Result<u8, Failure> {
    let results = SweepResults::new(&sweep.config, &sweep.rows);
    let mut plots = Vec::new();
    match other {
        Some(other) => {
            let other = SweepResults::new(&other.config, &other.rows);
            let plot = sweep_difference_map::draw(&results, &other);
            plots.push(plot.ok_or_else(|| {
                Failure::usage("the two sweeps have no place in common with a result")
            })?);
        }
        None => {
            plots.extend(sweep_bank_direct_map::draw(&results));
            plots.extend(sweep_best_shot_maps::draw_all(&results));
        }
    }
    let sweep_path = sweep.folder.path();
    let folder = match &options.out {
        Some(folder) => folder.clone(),
        None => sweep_path.join("plots"),
    };
    plot_files::write(&folder, &plots)?;
    let absolute = |path: &Path| std::fs::canonicalize(path).unwrap_or(path.to_owned());
    let link = SweepLink {
        sweep: absolute(sweep_path),
        against: other.map(|other| absolute(other.folder.path())),
    };
    link.write(&folder)?;
    plot_files::print_captions(&folder, &plots)?;
    let exit = sweep
        .exit_code()
        .max(other.map_or(code::DONE, OpenSweep::exit_code));
    if exit != code::DONE && !is_quiet() {
        print_remark("remark: the sweep is incomplete; what is missing or failed is grey");
    }
    Ok(exit)
}

fn compare_at_location(options: &MapOptions) -> Result<u8, Failure> {
    let own_physics = PhysicsArg::default();
    let load = |path: &PathBuf| {
        let loaded = LoadedProfile::read(path, &own_physics)?;
        Ok::<_, Failure>((loaded.text(), loaded.profile))
    };
    let (profile_text, profile) = load(&options.what)?;
    let other = options.against.as_ref().map(load).transpose()?;
    let bars = ProgressBars::new();
    let best = best_shot::find(&profile, &bars)?;
    let shots = PlottedShot::of_best(&best);
    let mut plots: Vec<Plot> = Vec::new();
    plots.extend(bank_direct_release_map::draw_outcomes(&profile, &shots));
    plots.extend(bank_direct_release_map::draw_probabilities(
        &profile, &shots,
    ));
    let name = &profile.shooter().name;
    // Two profiles of one name are told apart by their files.
    let have_one_name = other
        .as_ref()
        .is_some_and(|(_, other)| other.shooter().name == *name);
    let name_of = |profile: &Profile, path: &Path| match have_one_name {
        true => format!("{} ({})", profile.shooter().name, path.display()),
        false => profile.shooter().name.clone(),
    };
    let mut text = probabilities_text(&name_of(&profile, &options.what), &best);
    let mut exit = run_folder::exit_code(&profile, &best);
    let mut against = None;
    if let (Some((other_text, other)), Some(path)) = (other, &options.against) {
        let other_best = best_shot::find(&other, &bars)?;
        let shots = PlottedShot::of_best(&other_best);
        if let Some(mut plot) = bank_direct_release_map::draw_probabilities(&other, &shots) {
            plot.name.push_str("_against");
            plots.push(plot);
        }
        text.push_str(&probabilities_text(&name_of(&other, path), &other_best));
        text.push_str(&differences_text(&best, &other_best));
        text.push_str(&conditions_text([&profile, &other]));
        exit = exit.max(run_folder::exit_code(&other, &other_best));
        against = Some((other_text, other, other_best));
    }
    let folder = match &options.out {
        Some(folder) => folder.clone(),
        None => run_folder::of_profile(&profile)?,
    };
    plot_files::write(&folder, &plots)?;
    run_folder::write_best_shots(&folder, profile_text, &profile, &best)?;
    // The folder may have had another comparison.
    SweepLink::remove(&folder);
    let against_folder = folder.join(AGAINST_FOLDER);
    run_folder::remove_best_shots(&against_folder);
    if let Some((other_text, other, best)) = against {
        run_folder::prepare(&against_folder, RunKind::Best)?;
        run_folder::write_best_shots(&against_folder, other_text, &other, &best)?;
    }
    print_prose(&text)?;
    plot_files::print_captions(&folder, &plots)?;
    Ok(exit)
}

/// By how much P of the best shots of the second profile is greater, with its numerical error.
fn differences_text(first: &BestShots, second: &BestShots) -> String {
    let pairs = first.by_kind().into_iter().zip(second.by_kind());
    pairs
        .filter_map(|((kind, first), (_, second))| {
            let (first, second) = (
                &first.as_ref().ok()?.estimate,
                &second.as_ref().ok()?.estimate,
            );
            let error = libm::hypot(first.standard_error, second.standard_error);
            Some(format!(
                "{}: {:+.1} per 100 for the second profile (simulation error {:.1})\n",
                kind.name(),
                100.0 * (second.probability - first.probability),
                100.0 * error
            ))
        })
        .collect()
}

/// Where, and under which physics, if that is not the same for both profiles.
fn conditions_text(profiles: [&Profile; 2]) -> String {
    let [first, second] = profiles;
    let is_same_place = first.location() == second.location()
        && first.shooter().release_height_m == second.shooter().release_height_m;
    let is_same_physics = first.physics() == second.physics();
    let mut text = String::new();
    if !is_same_place {
        let [a, b] = profiles.map(|profile| {
            let units = profile.output().units;
            let (long, metre) = units.length();
            format!(
                "{}, {:.2} {long} up",
                profile.location().in_words(units),
                profile.shooter().release_height_m / metre
            )
        });
        text += &format!("The places are not the same: {a}; {b}.\n");
    }
    if !is_same_physics {
        text += "The physics are not the same (`bankshot check PROFILE --details` lists them), so the difference is not due to the shooters alone.\n";
    }
    text
}

/// P of the best shots of a profile, or why there is none.
fn probabilities_text(name: &str, best: &BestShots) -> String {
    best.by_kind()
        .into_iter()
        .map(|(kind, shot)| {
            let kind = kind.name();
            match shot {
                Ok(shot) => format!(
                    "{name}, {kind}: {:.1} of 100 go in (simulation error {:.1})\n",
                    100.0 * shot.estimate.probability,
                    100.0 * shot.estimate.standard_error
                ),
                Err(reason) => format!("{name}, {kind}: {reason}\n"),
            }
        })
        .collect()
}
