//! `bankshot best`: load, plan, evaluate, reduce, write.

use super::arguments::BestOptions;
use super::failure::{Failure, code};
use super::plan::load;
use super::progress::Bars;
use super::terminal::{answer, tell};
use bankshot::output::{self, files};
use bankshot::plan::Plan;
use bankshot::probability::best::{self, Best};
use bankshot::profile::Profile;
use bankshot::units::System;
use std::path::{Path, PathBuf};

pub(crate) fn run(options: &BestOptions, quiet: bool) -> Result<u8, Failure> {
    let mut profile = load(&options.profile)?;
    profile.output.units = options.units.unwrap_or(profile.output.units);
    let units = profile.output.units;
    // Refused before anything is written.
    Plan::new(&profile)?;
    let parent = options
        .out
        .clone()
        .unwrap_or_else(|| PathBuf::from(&profile.output.folder));
    let folder = parent.join(named_folder(&profile.shooter.name, &profile.hash()));
    prepare(&folder)?;
    let best = best::find(&profile, &Bars::new(quiet))?;
    write(&folder, &options.profile, &profile, &best, units)?;
    let text = if options.json {
        format!("{:#}\n", output::best::json(&profile, &best, units))
    } else {
        output::best::table(&profile, &best, units) + &output::best::lessons(&profile, &best, units)
    };
    answer(&text)?;
    if !quiet {
        tell(&format!("written to {}", folder.display()));
    }
    Ok(exit_code(&profile, &best))
}

pub(crate) fn exit_code(profile: &Profile, best: &Best) -> u8 {
    let target = profile.search.standard_error;
    let missed = [&best.direct, &best.bank]
        .into_iter()
        .flatten()
        .any(|shot| shot.estimate.standard_error > target);
    if missed { code::MISSED } else { code::WHOLE }
}

/// `<name>-<hash>`, the name reduced to letters, digits and dashes: names never become paths.
pub(crate) fn named_folder(name: &str, hash: &str) -> String {
    let mut name: String = name
        .chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() {
                c.to_ascii_lowercase()
            } else {
                '-'
            }
        })
        .take(40)
        .collect();
    while name.contains("--") {
        name = name.replace("--", "-");
    }
    let name = name.trim_matches('-');
    let name = if name.is_empty() { "shooter" } else { name };
    format!("{name}-{}", &hash[..12])
}

/// Makes the folder and finds out, before any computing, whether it can be written to.
fn prepare(folder: &Path) -> Result<(), Failure> {
    let refuse = |error: std::io::Error| Failure::io(folder.display(), &error);
    std::fs::create_dir_all(folder).map_err(refuse)?;
    tempfile::tempfile_in(folder).map_err(refuse)?;
    Ok(())
}

/// Writes the files of a run, the profile's text among them.
pub(crate) fn write(
    folder: &Path,
    source: &Path,
    profile: &Profile,
    best: &Best,
    units: System,
) -> Result<(), Failure> {
    let text = super::plan::read_text(source)?;
    let json = |value: &serde_json::Value| format!("{value:#}\n").into_bytes();
    let plan = serde_json::to_value(&best.plan).unwrap_or_default();
    let configuration = serde_json::to_value(profile).unwrap_or_default();
    let mut provenance = output::provenance(&profile.hash());
    provenance.push(("seed".to_owned(), profile.search.seed.into()));
    provenance.push(("table_shots".to_owned(), best.plan.shots.into()));
    provenance.push(("configuration_si".to_owned(), configuration));
    let contents = [
        ("best_shots.csv", output::best::csv(profile, best, units)),
        (
            "best_shots.json",
            json(&output::best::json(profile, best, units)),
        ),
        ("curves.csv", output::best::curves_csv(best, units)),
        ("lessons.csv", output::best::lessons_csv(best, units)),
        ("profile.toml", text.into_bytes()),
        ("plan.json", json(&plan)),
        ("provenance.json", json(&output::object(provenance))),
    ];
    for (name, bytes) in contents {
        let path = folder.join(name);
        files::write(&path, &bytes).map_err(|error| Failure::io(path.display(), &error))?;
    }
    Ok(())
}
