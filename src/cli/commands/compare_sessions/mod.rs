//! `bankshot compare-sessions`: what changed between two sessions of a shooter.

mod changed_values;
mod fitted_sessions;

use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use crate::cli::plot_files::{self, PlotType};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::plots::session_changes;
use crate::present::fit_files::session_changes_text::{SessionSummary, session_changes_text};
use crate::probability::Progress;
use clap::Args;
use serde_json::Value;
use std::path::PathBuf;

use changed_values::{causes, causes_to_draw, changes, json, planned, values_to_draw};
use fitted_sessions::{Session, check_conditions, fit_by_session, read, to_one_release_height};

#[derive(Args, Debug)]
#[command(after_help = "\
Each session is a file, which is fitted first (with the options of `bankshot fit`), or the folder of a fit.

Examples:
  bankshot compare-sessions september.csv march.csv --distance '13.75 ft' \\
    --release-height '7 ft'
  bankshot compare-sessions results/september-fit results/march-fit
  bankshot compare-sessions season.csv --plot season.svg
  bankshot compare-sessions season.csv --session September --session March

A file with a column session needs no second one; with several shooters, each is compared. Sessions that are numbers or \
dates are compared in their order, others in that of the file, or as --session names them.")]
pub(crate) struct CompareSessionsOptions {
    /// The first session, or a file with a column session that has two values.
    pub(crate) before: PathBuf,
    /// The second session.
    pub(crate) after: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Of sessions from several places, the number of the place to compare [default: 1, the first
    /// that both have].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) place: Option<u32>,
    /// The values that the study was planned for, such as 'speed_sd,pitch_sd' (speed, pitch, polar
    /// or backspin with _mean or _sd; corr_speed_pitch ...): these alone are compared beside P, so
    /// that chance has fewer of them to strike at [default: all].
    #[arg(long, value_name = "VALUE,VALUE", value_delimiter = ',')]
    pub(crate) planned: Vec<String>,
    /// Draw the values of both sessions and what the change of P comes from (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Print one JSON object; of a file with several shooters, an array of them.
    #[arg(long)]
    pub(crate) json: bool,
}

pub(crate) fn run(options: &CompareSessionsOptions, quiet: bool) -> Result<u8, Failure> {
    let after_is_file = options.after.as_ref().is_some_and(|after| !after.is_dir());
    if options.before.is_dir() && !after_is_file {
        fit_folder::refuse_options_of_files(&options.before, &options.measured)?;
    }
    if options.after.is_some() && !options.measured.session.is_empty() {
        return Err(Failure::usage(
            "--session: names the two sessions of one file; leave the second file out",
        ));
    }
    if let Some(path) = &options.plot {
        PlotType::of(path)?;
    }
    let bars = ProgressBars::new(quiet);
    let (mut code, mut several_shooters) = (code::DONE, false);
    let mut compared: Vec<[Session; 2]> = match &options.after {
        Some(after) => {
            let read = |path| read(path, &options.measured, options.place);
            vec![[read(&options.before)?, read(after)?]]
        }
        None if options.before.is_dir() => {
            return Err(Failure::usage(format!(
                "{}: the folder of a fit is one session; name the second one too, or the file of the shots if it has a column session",
                options.before.display()
            )));
        }
        None => {
            let file = options.measured.read_sessions(&options.before, &[])?;
            let several = file.shooters.len() > 1;
            let wanted = (&options.measured.session[..], options.place);
            let mut compared = Vec::new();
            bars.begin("fitting sessions", 2 * file.shooters.len() as u64);
            for shots in &file.shooters {
                match fit_by_session(&file, shots, wanted, &bars) {
                    Ok(sessions) => compared.push(sessions),
                    // The others can still be compared.
                    Err(error) if several => {
                        print_remark(&format!("{}: {}", shots.name, error.message));
                        code = code::INCOMPLETE;
                    }
                    Err(error) => return Err(error),
                }
            }
            bars.end();
            if compared.is_empty() {
                return Err(Failure::usage(format!(
                    "{}: the sessions of no shooter could be compared; the reasons are above",
                    options.before.display()
                )));
            }
            several_shooters = several;
            compared
        }
    };
    let units = |session: &Session| options.measured.units_or(session.units);
    for sessions in &mut compared {
        let units = units(&sessions[0]);
        to_one_release_height(sessions, units);
    }
    if options.plot.is_some() && compared.len() > 1 {
        return Err(Failure::usage(
            "--plot: draws the sessions of one shooter; choose with --shooter NAME",
        ));
    }
    let mut jsons = Vec::new();
    let mut all = compared.iter().flatten();
    if !options.json
        && let Some(session) = all.find(|session| session.places > 1)
    {
        let units = units(session);
        print_prose(&format!(
            "Shots from {} places: the chance, the makes, the speed and the aim are those of place {}, {}{}{}; the scatter is that of all.\n\n",
            session.places,
            session.place + 1,
            match session.place_name.as_str() {
                "" => String::new(),
                name => format!("{name}, "),
            },
            session.profile.location().in_words(units),
            // Each shooter has a height of their own.
            if compared.len() == 1 {
                let (long, metre) = units.length();
                let height_m = session.profile.shooter().release_height_m;
                format!(", released {:.2} {long} up", height_m / metre)
            } else {
                String::new()
            }
        ))?;
    }
    if !options.planned.is_empty() && !quiet {
        print_remark(
            "--planned: values count as planned only if they were named before the shots were seen",
        );
    }
    for (number, sessions) in compared.iter().enumerate() {
        check_conditions(sessions)?;
        for session in sessions {
            for warning in &session.warnings {
                let title = session.title();
                let title = match &session.shooter {
                    Some(name) if several_shooters => format!("{name}, {title}"),
                    _ => title,
                };
                print_remark(&format!("{title}: warning: {warning}"));
            }
        }
        let changes = planned(changes(sessions, units(&sessions[0])), &options.planned)?;
        let causes = causes(sessions);
        if let Some(path) = &options.plot {
            let [first, second] = sessions.each_ref().map(|session| &session.profile);
            // The names of two fits may have their sessions.
            let shooter = match first.shooter().name == second.shooter().name {
                true => first.shooter().name.as_str(),
                false => "",
            };
            let plot = session_changes::draw(
                shooter,
                sessions.each_ref().map(|session| session.name.as_str()),
                &values_to_draw(&changes),
                &causes_to_draw(&causes),
            );
            plot_files::write_one(path, &plot)?;
            if !quiet {
                print_remark(&format!("plot written to {}", path.display()));
            }
        }
        if options.json {
            jsons.push(json(sessions, &changes, &causes));
            continue;
        }
        if several_shooters {
            let space = if number == 0 { "" } else { "\n" };
            print_prose(&format!("{space}{}\n", sessions[0].profile.shooter().name))?;
        }
        let summaries = sessions.each_ref().map(|session| SessionSummary {
            name: &session.name,
            shots: session.posterior.shots,
            makes: session.makes,
        });
        let tested = changes.len() - 1;
        print_prose(&session_changes_text(summaries, &changes, &causes, tested))?;
    }
    if options.json {
        let all = if several_shooters {
            Value::Array(jsons)
        } else {
            jsons.swap_remove(0)
        };
        print_answer(&format!("{all:#}\n"))?;
    }
    Ok(code)
}
