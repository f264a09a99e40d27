//! `bankshot best`: load, plan, search, write.

use crate::cli::command_line_flags::BestOptions;
use crate::cli::config_files::load_profile_with_text;
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder;
use crate::cli::terminal::{print_answer, print_remark};
use bankshot::best_shot;
use bankshot::output::best_shot_json::best_shots_json;
use bankshot::output::best_shot_text::{best_shots_table, sensitivity_text};
use bankshot::search_space::TablePlan;

pub(crate) fn run(options: &BestOptions, quiet: bool) -> Result<u8, Failure> {
    let (mut profile, text) = load_profile_with_text(&options.profile, &options.physics, quiet)?;
    if let Some(units) = options.units {
        profile = profile.with(|settings| settings.output.units = units.into())?;
    }
    let units = profile.output().units;
    // A plan that is refused is refused before anything is written.
    TablePlan::for_search(&profile)?;
    let folder = run_folder::of_profile(&profile, options.out.as_deref());
    run_folder::prepare(&folder)?;
    let best = best_shot::find(&profile, &ProgressBars::new(quiet))?;
    run_folder::write_best_shots(&folder, text, &profile, &best)?;
    print_answer(&if options.json {
        format!("{:#}\n", best_shots_json(&profile, &best, units))
    } else {
        best_shots_table(&profile, &best, units) + &sensitivity_text(&profile, &best, units)
    })?;
    if let Some(fit) = &options.draws {
        for (kind, shot) in best.by_kind() {
            if let Ok(shot) = shot {
                let text = fit_folder::text_over_draws(fit, &profile, &shot.nominal)?;
                print_answer(&format!("{}, {text}", kind.name()))?;
            }
        }
    }
    if !quiet {
        print_remark(&format!("written to {}", folder.display()));
    }
    Ok(run_folder::exit_code(&profile, &best))
}
