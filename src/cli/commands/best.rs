//! `bankshot best`: load, plan, search, write.

use crate::answers::best_shots::BestShotsAnswer;
use crate::answers::json;
use crate::best_shot;
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::fixed_value_flags::FixedOptions;
use crate::cli::profile_flags::ProfileOptions;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder::{self, RunKind};
use crate::cli::scatter_flags::ScatterOptions;
use crate::cli::terminal::{print_answer, print_hint, print_prose};
use crate::present::best_shot_text::{
    PROFILE_IS_EXACT, answer_in_words, best_shots_table, sensitivity_text, vacuum_note,
    what_matters,
};
use crate::search_space::TablePlan;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  bankshot best configs/free_throw.toml
  bankshot best configs/free_throw.toml --json --quiet | python3 -m json.tool
  bankshot best configs/bank_wing.toml --units metric --out wing
  bankshot best configs/free_throw.toml --distance '12 ft' --angle '45 deg'
  bankshot best configs/free_throw.toml --pitch '50 deg'
  bankshot best configs/free_throw.toml --scatter 'speed=-20%'

Writes a folder, results/<name of the shooter>/1 or the next number, with best_shots.csv, best_shots.json, curves.csv (P along each variable of the \
best shots), sensitivity.csv, profile.toml, plan.json, answer.json (for `report`) and provenance.json.")]
pub(crate) struct BestOptions {
    #[command(flatten)]
    pub(crate) profile: ProfileOptions,
    #[command(flatten)]
    pub(crate) fixed: FixedOptions,
    #[command(flatten)]
    pub(crate) scatter: ScatterOptions,
    /// Folder of the results [default: a numbered one in results/<name of the shooter>].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// The folder of a fit: also say how uncertain P is by what its shots do not tell about the
    /// scatter, and how sure it is that bank beats direct.
    #[arg(long, value_name = "FIT_DIR", conflicts_with_all = ["json", "scatter"])]
    pub(crate) draws: Option<PathBuf>,
    /// Also print how each kind of shot goes in, and what every error, backspin and height are
    /// worth.
    #[arg(long)]
    pub(crate) details: bool,
    /// Print one JSON object instead of the table.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &BestOptions) -> Result<u8, Failure> {
    let fixed = options.fixed.variables();
    let loaded = options.profile.load(&fixed)?;
    let loaded = options.fixed.changed(options.scatter.changed(loaded)?)?;
    let (text, profile) = (loaded.text(), loaded.profile);
    let units = profile.output().units;
    // A plan that is refused is refused before anything is written.
    TablePlan::for_search(&profile)?;
    // A folder that is no fit is refused before the search.
    let draws = fit_folder::read_draws_of(options.draws.as_deref(), &profile)?;
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
        print_answer(&json::text(&json::document(&answer, units)))?;
    } else {
        let mut text = answer_in_words(&profile, &best, units);
        text += &best_shots_table(&profile, &best, units);
        text += &what_matters(&profile, &best, units);
        if options.details {
            text += &sensitivity_text(&profile, &best, units);
        }
        text += &options.scatter.in_words();
        text += vacuum_note(&profile);
        if options.draws.is_none() {
            text += PROFILE_IS_EXACT;
        }
        print_prose(&text)?;
    }
    if let Some((folder, fit)) = &draws {
        let found = best.by_kind().map(|(kind, shot)| (kind, shot.as_ref()));
        let nominals: Vec<_> = found
            .into_iter()
            .filter_map(|(kind, shot)| Some((kind, &shot.ok()?.nominal)))
            .collect();
        print_prose(&fit_folder::kinds_over_draws(
            (folder, fit),
            &profile,
            &nominals,
        )?)?;
    }
    print_hint(&format!(
        "written to {0}; next: bankshot report {0}",
        folder.display()
    ));
    Ok(run_folder::exit_code(&profile, &best))
}
