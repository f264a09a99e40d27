//! `bankshot compare-sessions`: what changed between two sessions of a shooter.

use super::fit::{failure, report_rejected};
use crate::cli::failure::{Failure, code};
use crate::cli::measured_shots_flags::{MeasuredFile, MeasuredShotsOptions};
use crate::cli::terminal::print_prose;
use crate::fitting::{
    SessionComparison, ShooterFit, SpinSource, VALUE_NAMES, compare_probabilities, compare_sessions,
};
use crate::measured_shots::read::ShooterShots;
use crate::output::fit_files::parameters::value_units;
use clap::Args;
use std::path::PathBuf;

#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  bankshot compare-sessions september.csv march.csv --distance '13.75 ft' --release-height '7 ft'
  bankshot compare-sessions season.csv            (two values in its column session)")]
pub(crate) struct CompareSessionsOptions {
    /// The first session, or a file with a column session that has two values.
    pub(crate) before: PathBuf,
    /// The second session.
    pub(crate) after: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
}

pub(crate) fn run(options: &CompareSessionsOptions) -> Result<u8, Failure> {
    let before = options.measured.read(&options.before)?;
    let (names, fits) = match &options.after {
        Some(after) => {
            let after = options.measured.read(after)?;
            let names = [&before, &after].map(|file| file.file.display().to_string());
            let fits = [fit_whole(&before)?, fit_whole(&after)?];
            (names, fits)
        }
        None => fit_by_session(&before)?,
    };
    print_prose(&text(&names, &fits, options))?;
    Ok(code::DONE)
}

fn fit_whole(file: &MeasuredFile) -> Result<ShooterFit, Failure> {
    let place = file.file.display().to_string();
    let shots = file.only_shooter()?;
    report_rejected(file, shots, true);
    file.fit(shots, &file.physics)
        .map_err(|error| failure(&place, &error))
}

fn fit_by_session(file: &MeasuredFile) -> Result<([String; 2], [ShooterFit; 2]), Failure> {
    let place = file.file.display().to_string();
    let shots = file.only_shooter()?;
    report_rejected(file, shots, true);
    let mut names: Vec<&String> = Vec::new();
    for session in &shots.sessions {
        if !names.contains(&session) {
            names.push(session);
        }
    }
    let [first, second] = names[..] else {
        return Err(Failure::usage(format!(
            "{place}: its column session has {} values; two are compared. Or give two files",
            names.len()
        )));
    };
    let fit = |session: &String| -> Result<ShooterFit, Failure> {
        let keep: Vec<bool> = shots.sessions.iter().map(|name| name == session).collect();
        let mut kept = ShooterShots {
            tracks: Vec::new(),
            chi_squares: Vec::new(),
            ..shots.clone()
        };
        let mut index = 0;
        kept.shots.retain(|_| {
            index += 1;
            keep[index - 1]
        });
        file.fit(&kept, &file.physics)
            .map_err(|error| failure(&place, &error))
    };
    Ok(([first.clone(), second.clone()], [fit(first)?, fit(second)?]))
}

/// More shots than this are not advised.
const MOST_SHOTS: f64 = 100_000.0;

fn text(names: &[String; 2], fits: &[ShooterFit; 2], options: &CompareSessionsOptions) -> String {
    let posteriors = [&fits[0].posterior, &fits[1].posterior];
    let shots = posteriors.map(|posterior| posterior.shots);
    let mut text = format!(
        "before  {} ({} shots)\nafter   {} ({} shots)\n\n{:<13} {:>7} {:>7} {:>7} {:>17} {:<5} {:<10} {:>7}\n",
        names[0],
        shots[0],
        names[1],
        shots[1],
        "",
        "before",
        "after",
        "change",
        "95 %",
        "unit",
        "certainty",
        "decide"
    );
    let mut row = |name: &str, unit: &str, size: f64, comparison: &SessionComparison| {
        let change = comparison.change.scaled(1.0 / size);
        let direction = if comparison.grew >= 0.5 {
            "grew"
        } else {
            "fell"
        };
        let certainty = 100.0 * comparison.grew.max(1.0 - comparison.grew);
        let needed = match comparison.shots_to_decide {
            None => String::new(),
            Some(needed) if needed > MOST_SHOTS => "-".to_owned(),
            Some(needed) => format!("{:.0}", needed.ceil()),
        };
        let line = format!(
            "{name:<13} {:>7.3} {:>7.3} {:>+7.3} {:>7.3} to {:>6.3} {unit:<5} {direction} {certainty:>3.0} % {needed:>7}",
            comparison.before.mean / size,
            comparison.after.mean / size,
            change.mean,
            change.low,
            change.high
        );
        text += &format!("{}\n", line.trim_end());
    };
    let probabilities = [&fits[0].probabilities[0], &fits[1].probabilities[0]];
    row("P", "%", 0.01, &compare_probabilities(probabilities, shots));
    for (i, (unit, size)) in value_units(options.measured.unit_system())
        .into_iter()
        .enumerate()
    {
        let name = VALUE_NAMES[i];
        let is_spin = i == VALUE_NAMES.len() - 1;
        if is_spin && posteriors.iter().all(|p| p.spin == SpinSource::Assumed) {
            continue;
        }
        row(
            &format!("{name}_mean"),
            unit,
            size,
            &compare_sessions(posteriors, |draw| draw.means[0][i]),
        );
        row(
            &format!("{name}_sd"),
            unit,
            size,
            &compare_sessions(posteriors, |draw| draw.sds[i]),
        );
    }
    text += &format!(
        "\ndecide: shots a session that would decide such a change (-: over {MOST_SHOTS})\n"
    );
    text
}
