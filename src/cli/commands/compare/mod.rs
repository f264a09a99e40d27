//! `bankshot compare`: what changed between two sessions of a shooter.

mod changed_values;
mod fitted_sessions;

use crate::answers::json::document;
use crate::answers::sessions::{SessionAnswer, SessionsAnswer};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder;
use crate::cli::measured_shots_flags::MeasuredShotsOptions;
use crate::cli::plot_files::{self, PlotType};
use crate::cli::progress_bars::ProgressBars;
use crate::cli::terminal::{
    print_answer, print_hint, print_next, print_prose, print_remark, print_text,
};
use crate::fitting::ProbabilityChange;
use crate::plots::session_changes;
use crate::present::fit_files::fit_note_text::fit_note_text;
use crate::present::fit_files::session_changes_text::session_changes_text;
use crate::probability::Progress;
use clap::Args;
use serde_json::Value;
use std::path::PathBuf;

use changed_values::{causes, causes_to_draw, changes, planned, values_to_draw};
use fitted_sessions::{
    Session, fit_by_session, read, refuse_other_physics, share_what_no_sensor_sees,
    to_one_release_height, warn_of_differences,
};

#[derive(Args, Debug)]
#[command(after_help = "\
A session is a file, which is fitted first (with the options of `bankshot fit`), or the folder of a fit.

Examples:
  bankshot compare september.csv march.csv --distance '13.75 ft' \\
    --release-height '7 ft'
  bankshot compare results/september-fit results/march-fit
  bankshot compare season.csv --plot season.svg
  bankshot compare season.csv --session September --session March

A file with a column named session needs no second file; with several players, each is compared. Sessions named by numbers or dates are compared in that order, others in the order of the file or of --session.")]
pub(crate) struct CompareOptions {
    /// The first session, or a file whose column "session" has two values.
    pub(crate) before: PathBuf,
    /// The second session.
    pub(crate) after: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// The number of the place to compare, for sessions from several places [default: 1, the first
    /// that both have].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub(crate) place: Option<u32>,
    /// The values that the study was planned for, such as 'speed_sd,pitch_sd' (speed, pitch, polar
    /// or backspin with _mean or _sd; corr_speed_pitch ...). With fewer values, chance
    /// findings are rarer [default: all].
    #[arg(long, value_name = "VALUE,VALUE", value_delimiter = ',')]
    pub(crate) planned: Vec<String>,
    /// Draw the values of both sessions, and what each change adds (.svg or .png).
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// Print one JSON object, or an array for a file with several shooters.
    #[arg(long)]
    pub(crate) json: bool,
}

/// The pairs of sessions to compare.
struct Compared {
    pairs: Vec<[Session; 2]>,
    /// Whether they are of a file with several shooters.
    has_several_shooters: bool,
    exit_code: u8,
}

pub(crate) fn run(options: &CompareOptions) -> Result<u8, Failure> {
    check_options(options)?;
    let mut compared = read_sessions(options)?;
    if options.plot.is_some() && compared.pairs.len() > 1 {
        return Err(Failure::usage(
            "--plot: draws the sessions of one shooter; choose with --shooter NAME",
        ));
    }
    let bars = match compared.pairs.len() {
        // A few seconds.
        1 => ProgressBars::hidden(),
        _ => ProgressBars::new(),
    };
    bars.begin("comparing sessions", compared.pairs.len() as u64);
    let mut causes_of_pairs = Vec::new();
    for sessions in &mut compared.pairs {
        let units = options.measured.units_or(sessions[0].units);
        share_what_no_sensor_sees(sessions)?;
        refuse_other_physics(sessions)?;
        to_one_release_height(sessions, units);
        causes_of_pairs.push(causes(sessions));
        bars.advance(1);
    }
    bars.end();
    if !options.json {
        print_several_places(options, &compared.pairs)?;
    }
    if !options.planned.is_empty() {
        print_hint(
            "--planned: values count as planned only if they were named before the shots were seen",
        );
    }
    let mut jsons = Vec::new();
    let pairs = compared.pairs.iter().zip(&causes_of_pairs);
    for (number, (sessions, causes)) in pairs.enumerate() {
        if compared.has_several_shooters && !options.json {
            let space = if number == 0 { "" } else { "\n" };
            print_prose(&format!("{space}{}\n", sessions[0].profile.shooter().name))?;
        }
        jsons.extend(answer(
            options,
            (sessions, causes),
            compared.has_several_shooters,
        )?);
    }
    if options.json {
        let all = match compared.has_several_shooters {
            true => Value::Array(jsons),
            false => jsons.swap_remove(0),
        };
        print_answer(&format!("{all:#}\n"))?;
    }
    Ok(compared.exit_code)
}

/// Refuses options that do not go together, before anything is computed.
fn check_options(options: &CompareOptions) -> Result<(), Failure> {
    // `compare` drew the maps until version 0.1.
    if options.before.join("configuration.json").exists() {
        return Err(Failure::usage(format!(
            "{}: is a sweep; `bankshot map` draws its maps, `compare` needs two sessions of measured shots",
            options.before.display()
        )));
    }
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
    Ok(())
}

/// Two sessions that are named, or those of each shooter of a file.
fn read_sessions(options: &CompareOptions) -> Result<Compared, Failure> {
    if let Some(after) = &options.after {
        let read = |path| read(path, &options.measured, options.place);
        return Ok(Compared {
            pairs: vec![[read(&options.before)?, read(after)?]],
            has_several_shooters: false,
            exit_code: code::DONE,
        });
    }
    let path = options.before.display();
    if options.before.is_dir() {
        return Err(Failure::usage(format!(
            "{path}: the folder of a fit is one session; name the second one too, or the file of the shots if it has a column session"
        )));
    }
    let file = options.measured.read_sessions(&options.before, &[])?;
    let mut compared = Compared {
        pairs: Vec::new(),
        has_several_shooters: file.shooters.len() > 1,
        exit_code: code::DONE,
    };
    let bars = ProgressBars::new();
    let wanted = (&options.measured.session[..], options.place);
    bars.begin("fitting sessions", 2 * file.shooters.len() as u64);
    for shots in &file.shooters {
        match fit_by_session(&file, shots, wanted, &bars) {
            Ok(sessions) => compared.pairs.push(sessions),
            // The others can still be compared.
            Err(error) if compared.has_several_shooters => {
                print_remark(&format!("{}: {}", shots.name, error.message));
                compared.exit_code = code::INCOMPLETE;
            }
            Err(error) => return Err(error),
        }
    }
    bars.end();
    if compared.pairs.is_empty() {
        return Err(Failure::usage(format!(
            "{path}: the sessions of no shooter could be compared; the reasons are above"
        )));
    }
    Ok(compared)
}

/// Says which place is compared, where a session has several.
fn print_several_places(options: &CompareOptions, pairs: &[[Session; 2]]) -> Result<(), Failure> {
    let mut all = pairs.iter().flatten();
    let Some(session) = all.find(|session| session.places > 1) else {
        return Ok(());
    };
    let units = options.measured.units_or(session.units);
    let name = match session.place_name.as_str() {
        "" => String::new(),
        name => format!("{name}, "),
    };
    // Each shooter has a height of their own.
    let height = match pairs.len() {
        1 => {
            let (long, metre) = units.length();
            let height_m = session.profile.shooter().release_height_m;
            format!(", released {:.2} {long} high", height_m / metre)
        }
        _ => String::new(),
    };
    print_prose(&format!(
        "Shots from {} places: makes, speed and direction are for place {}, {name}{}{height}; the scatter is for all places.\n\n",
        session.places,
        session.place + 1,
        session.profile.location().in_words(units),
    ))?;
    Ok(())
}

/// Compares two sessions: prints the answer, or returns it for programs.
fn answer(
    options: &CompareOptions,
    (sessions, causes): (&[Session; 2], &ProbabilityChange),
    names_shooter: bool,
) -> Result<Option<Value>, Failure> {
    warn_of_differences(sessions);
    for session in sessions {
        for note in &session.notes {
            let title = session.title();
            let title = match &session.shooter {
                Some(name) if names_shooter => format!("{name}, {title}"),
                _ => title,
            };
            print_remark(&format!("{title}: warning: {}", fit_note_text(note)));
        }
    }
    let units = options.measured.units_or(sessions[0].units);
    let changes = planned(changes(sessions, units), &options.planned)?;
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
            &causes_to_draw(causes),
        );
        plot_files::write_one(path, &plot)?;
        print_hint(&format!("plot written to {}", path.display()));
    }
    let summaries = sessions.each_ref().map(|session| SessionAnswer {
        name: session.name.clone(),
        shots: session.posterior.shots,
        made: session.makes.0,
        with_result: session.makes.1,
    });
    if options.json {
        let profile = &sessions[0].profile;
        let answer = SessionsAnswer::new(profile, summaries, &changes, causes);
        return Ok(Some(document(&answer, units)));
    }
    let profile = &sessions[0].profile;
    print_text(&session_changes_text(profile, &summaries, &changes, causes))?;
    print_next(None, "");
    Ok(None)
}
