//! The files of a fit.

use super::options::FitOptions;
use super::unmeasured_parameters::{UnmeasuredParameter, found_values};
use crate::answers::fit::FitAnswer;
use crate::answers::json::document;
use crate::cli::failure::Failure;
use crate::cli::measured_shots_flags::{MeasuredFile, with_ring};
use crate::cli::plot_files;
use crate::cli::run_folder::{self, RunKind};
use crate::files::atomic_file;
use crate::fitting::ShooterFit;
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::plots::measured_shots;
use crate::present::fit_files::fitted_profile_toml::fitted_profile_toml;
use crate::present::fit_files::shots_table::shots_csv;
use crate::report::fit_page::fit_page;
use crate::store::draws::draws_parquet;
use crate::store::fit::{DRAWS_FILE, FIT_FILE, PAGE_FILE, SHOTS_FILE, profile_file};
use crate::store::sealed::seal;
use std::path::Path;

/// Writes the files of a fit.
pub(super) fn write(
    folder: &Path,
    file: &MeasuredFile,
    (shots, fit, free): (&ShooterShots, &ShooterFit, &[UnmeasuredParameter]),
    options: &FitOptions,
) -> Result<(), Failure> {
    run_folder::prepare(folder, RunKind::Fit)?;
    let units = options.measured.unit_system();
    let source = file.source(shots);
    let labels = shots.sessions.iter().zip(&shots.shot_names);
    let rows = shots.shots.iter().map(|shot| shot.row);
    let labels = rows
        .zip(labels.map(|(session, shot)| [session.as_str(), shot.as_str()]))
        .collect();
    let draws = draws_parquet(&fit.posterior, &fit.probabilities, units).map_err(Failure::bug)?;
    let rows = shots_csv(fit, &labels, &shots.rejected, units);
    let answer = FitAnswer::new(fit, &source, found_values(free));
    let json = document(&answer, units);
    let sealed = seal(json, &[(DRAWS_FILE, &draws), (SHOTS_FILE, &rows)]);
    let mut contents: Vec<(String, Vec<u8>)> = vec![
        (FIT_FILE.to_owned(), sealed.into_bytes()),
        (DRAWS_FILE.to_owned(), draws),
        (SHOTS_FILE.to_owned(), rows),
    ];
    for place in 0..fit.places.len() {
        let physics = match fit.ring_restitution {
            Some(ring) => with_ring(&file.physics_toml, ring),
            None => file.physics_toml.clone(),
        };
        let toml = fitted_profile_toml(fit, place, &source, &physics, units);
        contents.push((profile_file(place), toml.into_bytes()));
    }
    remove_further_places(folder, fit.places.len());
    for (name, bytes) in contents {
        let path = folder.join(name);
        atomic_file::write(&path, &bytes).map_err(|error| Failure::io(path.display(), &error))?;
    }
    let plots = measured_shots::all(fit, &shots.shots, &shots.sessions, units);
    plot_files::write(&folder.join("plots"), &plots)?;
    let page = fit_page(fit, &source, plots, units);
    let html = page.html()?;
    let path = folder.join(PAGE_FILE);
    atomic_file::write(&path, html.as_bytes()).map_err(|error| Failure::io(path.display(), &error))
}

/// Removes everything that [`write`] wrote into a folder, and the folder if nothing else is in it:
/// whoever reads the folder later must not find an older answer.
pub(super) fn remove(folder: &Path) -> Result<(), Failure> {
    let drawn = std::fs::read_dir(folder.join("plots"))
        .into_iter()
        .flatten();
    let drawn = drawn.flatten().map(|entry| entry.path()).filter(|path| {
        let end = path.extension();
        end.is_some_and(|end| end == "svg" || end == "png")
    });
    let fixed = [FIT_FILE, DRAWS_FILE, SHOTS_FILE, PAGE_FILE].map(|name| folder.join(name));
    let profiles = (0..).map(|place| folder.join(profile_file(place)));
    let profiles = profiles.take_while(|path| path.exists());
    for path in fixed.into_iter().chain(profiles).chain(drawn) {
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(Failure::io(path.display(), &error));
            }
            _ => {}
        }
    }
    // A folder with anything else in it stays.
    let _ = std::fs::remove_dir(folder.join("plots"));
    let _ = std::fs::remove_dir(folder);
    Ok(())
}

/// Removes the profiles and plots of places that an earlier fit had beyond these.
fn remove_further_places(folder: &Path, places: usize) {
    for number in places + 1.. {
        let profile = folder.join(profile_file(number - 1));
        if !profile.exists() {
            return;
        }
        let plots = ["releases", "make_zone"].into_iter().flat_map(|plot| {
            ["svg", "png"].map(|end| format!("plots/{plot}_place_{number}.{end}"))
        });
        for path in plots.map(|plot| folder.join(plot)).chain([profile]) {
            // What cannot be removed is old, but harms nothing.
            let _ = std::fs::remove_file(path);
        }
    }
}
