//! `bankshot best`: load, plan, search, write.

use super::plan::{WIDE_SAMPLE, print_plan_of_search};
use crate::analysis::rebounds::{REACH_M, find_rebounds};
use crate::answers::best_shots::BestShotsAnswer;
use crate::answers::json;
use crate::answers::rebounds::ReboundsAnswer;
use crate::best_shot::{self, BestShots};
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::fixed_value_flags::FixedOptions;
use crate::cli::profile_flags::ProfileOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder::{self, RunKind};
use crate::cli::scatter_flags::ScatterOptions;
use crate::cli::terminal::{has_details, print_answer, print_next, print_text};
use crate::present::best_shot_text::best_shots_text;
use crate::present::rebounds_text::rebounds_text;
use crate::search_space::TablePlan;
use crate::shooter::Profile;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  bankshot best configs/free_throw.toml
  bankshot best configs/free_throw.toml --json --quiet | python3 -m json.tool
  bankshot best configs/bank_wing.toml --units metric --output wing
  bankshot best configs/free_throw.toml --distance '12 ft' --angle '45 deg'
  bankshot best configs/free_throw.toml --pitch '50 deg'
  bankshot best configs/free_throw.toml --scatter 'speed=-20%'

Writes a folder, results/<name of the shooter>/1 or the next number, with best_shots.csv, best_shots.json, curves.csv (how the makes depend on each value, the others fixed), sensitivity.csv, profile.toml, plan.json, answer.json (for `report`) and provenance.json.")]
pub(crate) struct BestOptions {
    #[command(flatten)]
    pub(crate) profile: ProfileOptions,
    #[command(flatten)]
    pub(crate) fixed: FixedOptions,
    #[command(flatten)]
    pub(crate) scatter: ScatterOptions,
    /// Print how much time and memory the search needs, and stop.
    #[arg(long)]
    pub(crate) plan: bool,
    /// Folder of the results [default: a numbered one in results/<name of the shooter>].
    #[arg(long = "output", short = 'o', alias = "out", value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Folder of a fit: adds its uncertainty to the answer [default: the fit that wrote the
    /// profile].
    #[arg(long, value_name = "FIT_DIR", conflicts_with_all = ["json", "scatter"])]
    pub(crate) draws: Option<PathBuf>,
    /// Print one JSON object instead of the table.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &BestOptions) -> Result<u8, Failure> {
    let fixed = options.fixed.variables();
    let loaded = options.profile.load(&fixed)?;
    let loaded = options.fixed.changed(options.scatter.changed(loaded)?)?;
    if options.plan {
        return print_plan_of_search(&loaded.profile, WIDE_SAMPLE, options.json);
    }
    let is_scatter_changed = !options.scatter.scatter.is_empty();
    // A folder that is no fit is refused before the search.
    let draws = fit_folder::draws_for(options.draws.as_deref(), &loaded, is_scatter_changed)?;
    let (text, profile) = (loaded.text(), loaded.profile);
    // A plan that is refused is refused before anything is written.
    TablePlan::for_search(&profile)?;
    let folder = match &options.out {
        Some(folder) => folder.clone(),
        None => run_folder::of_profile(&profile)?,
    };
    run_folder::prepare(&folder, RunKind::Best)?;
    let best = best_shot::find(&profile, &ProgressBars::new())?;
    run_folder::write_best_shots(&folder, text, &profile, &best)?;
    if options.out.is_none() {
        run_folder::link_latest(&folder);
    }
    if options.json {
        let answer = BestShotsAnswer::new(&profile, &best);
        print_answer(&json::text(&json::document(
            &answer,
            profile.output().units,
        )))?;
    } else {
        let over_draws = draws
            .as_ref()
            .map(|fit| fit_folder::kinds_over_draws(fit, &profile, &best))
            .transpose()?;
        let scatter = &options.scatter.scatter;
        let mut answer = best_shots_text(&profile, &best, over_draws.as_ref(), scatter);
        if has_details() {
            answer.details += &rebounds_of(&profile, &best);
        }
        print_text(&answer)?;
    }
    print_next(
        Some(&folder),
        &format!("bankshot report {}", folder.display()),
    );
    Ok(run_folder::exit_code(&profile, &best))
}

/// Where the misses of the best shots come down.
fn rebounds_of(profile: &Profile, best: &BestShots) -> String {
    let mut text = String::new();
    for (kind, shot) in best.by_kind() {
        let Ok(shot) = shot else { continue };
        let found = find_rebounds(profile, &shot.nominal, profile.search().seed, REACH_M);
        let answer = ReboundsAnswer::new(profile, &found, REACH_M);
        let misses = format!("misses of the {} shot", kind.name());
        text += &rebounds_text(&answer, &misses, profile.output().units);
    }
    text
}
