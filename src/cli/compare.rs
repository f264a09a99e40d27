//! `bankshot compare`: bank and direct against each other, on the court or at one place; or two shooters.

use super::arguments::CompareOptions;
use super::best::named_folder;
use super::failure::{Failure, code};
use super::plan::{load, read_text};
use super::progress::Bars;
use super::sweep;
use super::terminal::{answer, tell};
use bankshot::dynamics::Simulator;
use bankshot::output::files;
use bankshot::picture::sweep_maps::{Picture, Sweep, against};
use bankshot::picture::{comparison, report, svg};
use bankshot::probability::best;
use bankshot::profile::Profile;
use bankshot::sweep::Configuration;
use bankshot::sweep::configuration::is_sweep;
use bankshot::sweep::folder::Folder;
use bankshot::sweep::jobs::Jobs;
use bankshot::sweep::row::Row;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Pixels of a PNG for each of its drawing's.
const SCALE: f32 = 1.5;

pub(crate) fn run(options: &CompareOptions, quiet: bool) -> Result<u8, Failure> {
    match swept(&options.what)? {
        Some(one) => {
            let other = options.against.as_deref().map(|path| match swept(path)? {
                Some(other) => Ok(other),
                None => Err(Failure::usage(format!(
                    "{}: is no sweep, but {} is; compare like with like",
                    path.display(),
                    options.what.display()
                ))),
            });
            courts(options, one, other.transpose()?, quiet)
        }
        None => place(options, quiet),
    }
}

/// A sweep's folder with its results.
type Swept = (Folder, Configuration, BTreeMap<u64, Row>);

/// The sweep of a folder, or of a TOML file whose sweep has its usual folder.
fn swept(path: &Path) -> Result<Option<Swept>, Failure> {
    let path = if path.is_dir() {
        path.to_owned()
    } else if is_sweep(&read_text(path)?) {
        sweep::usual_folder(&sweep::load(path)?.0)
    } else {
        return Ok(None);
    };
    let (folder, configuration) = Folder::to_look_at(&path)?;
    let (rows, remarks) = folder.union()?;
    for remark in remarks {
        tell(&format!("remark: {remark}"));
    }
    Ok(Some((folder, configuration, rows)))
}

fn courts(
    options: &CompareOptions,
    (sweep, configuration, rows): Swept,
    other: Option<Swept>,
    quiet: bool,
) -> Result<u8, Failure> {
    let one = Sweep::new(&configuration, &rows);
    let mut pictures = Vec::new();
    if let Some((_, configuration, rows)) = &other {
        let other = Sweep::new(configuration, rows);
        let Some(picture) = against(&one, &other) else {
            return Err(Failure::usage(
                "the two sweeps have no place in common with a result",
            ));
        };
        pictures.push(picture);
    } else {
        pictures.extend(one.bank_and_direct());
        pictures.extend(one.best_maps());
    }
    let folder = options
        .out
        .clone()
        .unwrap_or_else(|| sweep.path().join("pictures"));
    write(&folder, &pictures)?;
    let of = std::fs::canonicalize(sweep.path()).unwrap_or(sweep.path().to_owned());
    let note = format!(
        "{:#}\n",
        serde_json::json!({ "sweep": of.display().to_string() })
    );
    let file = folder.join("of_sweep.json");
    files::write(&file, note.as_bytes()).map_err(|error| Failure::io(file.display(), &error))?;
    let mut exit = sweep::exit_of(&Jobs::new(&configuration), &rows);
    if let Some((_, configuration, rows)) = &other {
        exit = exit.max(sweep::exit_of(&Jobs::new(configuration), rows));
    }
    tell_of(&folder, &pictures, quiet)?;
    if exit != code::WHOLE && !quiet {
        tell("remark: the sweep is not whole; what is missing or failed is grey");
    }
    Ok(exit)
}

fn place(options: &CompareOptions, quiet: bool) -> Result<u8, Failure> {
    let mut profiles = vec![load(&options.what)?];
    if let Some(other) = &options.against {
        profiles.push(load(other)?);
    }
    let mut pictures = Vec::new();
    let mut text = String::new();
    let bars = Bars::new(quiet);
    let mut first = None;
    let mut exit = code::WHOLE;
    for (i, profile) in profiles.iter().enumerate() {
        let simulator = Simulator::with_integrator(&profile.physics, profile.integrator)
            .map_err(Failure::usage)?;
        let best = best::find(profile, &bars)?;
        exit = exit.max(super::best::exit_code(profile, &best));
        for (kind, shot) in [("direct", &best.direct), ("bank", &best.bank)] {
            text.push_str(&match shot {
                Ok(shot) => format!(
                    "{}, {kind}: P {:.4} \u{b1} {:.4}\n",
                    profile.shooter.name, shot.estimate.probability, shot.estimate.standard_error
                ),
                Err(reason) => format!("{}, {kind}: {reason}\n", profile.shooter.name),
            });
        }
        let shots = report::shots_of(profile, &best);
        if i == 0 {
            pictures.extend(comparison::outcomes_about(profile, &simulator, &shots));
        }
        if let Some(mut picture) = comparison::in_release_space(profile, &simulator, &shots) {
            if i > 0 {
                picture.name.push_str("_against");
            }
            pictures.push(picture);
        }
        if i == 0 {
            first = Some((profile, best));
        }
    }
    let folder = options.out.clone().unwrap_or_else(|| usual(&profiles[0]));
    write(&folder, &pictures)?;
    if let Some((profile, best)) = first {
        super::best::write(&folder, &options.what, profile, &best, profile.output.units)?;
    }
    // What a sweep may have left there.
    let _ = std::fs::remove_file(folder.join("of_sweep.json"));
    answer(&text)?;
    tell_of(&folder, &pictures, quiet)?;
    Ok(exit)
}

fn usual(profile: &Profile) -> PathBuf {
    PathBuf::from(&profile.output.folder).join(named_folder(&profile.shooter.name, &profile.hash()))
}

/// Draws the paper's figures.
pub(crate) fn figures(out: &Path, quiet: bool) -> Result<u8, Failure> {
    let pictures = bankshot::picture::figures::all().map_err(Failure::bug)?;
    write(out, &pictures)?;
    tell_of(out, &pictures, quiet)
}

/// Writes each picture as SVG and as PNG.
pub(crate) fn write(folder: &Path, pictures: &[Picture]) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::io(folder.display(), &error))?;
    for picture in pictures {
        let png = svg::to_png(&picture.svg, SCALE).map_err(Failure::bug)?;
        for (ending, bytes) in [("svg", picture.svg.as_bytes()), ("png", &png[..])] {
            let path = folder.join(format!("{}.{ending}", picture.name));
            files::write(&path, bytes).map_err(|error| Failure::io(path.display(), &error))?;
        }
    }
    Ok(())
}

pub(crate) fn tell_of(folder: &Path, pictures: &[Picture], quiet: bool) -> Result<u8, Failure> {
    for picture in pictures {
        answer(&format!("{}: {}\n", picture.name, picture.caption))?;
    }
    if !quiet {
        tell(&format!(
            "pictures written to {} (svg and png)",
            folder.display()
        ));
    }
    Ok(code::WHOLE)
}
