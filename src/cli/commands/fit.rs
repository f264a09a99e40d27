//! `bankshot fit`: a profile from measured shots.

use crate::cli::failure::{Failure, code};
use crate::cli::measured_shots_flags::{MeasuredFile, MeasuredShotsOptions};
use crate::cli::plot_files;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder::{self, RunKind};
use crate::cli::terminal::{print_answer, print_prose, print_remark};
use crate::fitting::{
    Place, ShooterFit, ShooterFitError, SpinSource, UnseenParameter, fit_drag_coefficient,
    likelihood_curve,
};
use crate::measured_shots::shooter_shots::ShooterShots;
use crate::model::{Preset, SolidId};
use crate::output::atomic_file;
use crate::output::fit_files::draws_table::draws_parquet;
use crate::output::fit_files::fit_json::fit_json;
use crate::output::fit_files::fit_text::fit_text;
use crate::output::fit_files::fitted_profile_toml::fitted_profile_toml;
use crate::output::fit_files::shots_table::shots_csv;
use crate::plots::measured_shots;
use crate::plots::svg::shortened;
use crate::probability::Progress;
use crate::report::fit_page::fit_page;
use crate::shooter::implausible_values;
use crate::units::UnitSystem;
use crate::units::{DEGREE_RAD, REV_RAD, rounded};
use clap::Args;
use comfy_table::{Table, presets};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
The file holds releases (speed, pitch, polar or aim), landings (entry_angle, depth, left_right) or trajectories (shot, \
time, x, y, z); each column has its unit in its name, as in speed_ft_s, depth_in, time_s. It can have made, shooter, \
session, and the place (distance, court_angle, release_height). Angles of release are positive to the shooter's left: \
aim from the line to the hoop's centre, polar from the court's long axis. left_right is positive to the right. Units: \
ft_s m_s mph km_h, deg rad, rev_s rpm rad_s, ft in m cm mm, s ms.

Writes OUT/: fit.json, profile.toml (for best and probability), draws.parquet, shots.csv, report.html and plots; with several \
shooters, one folder for each and shooters.csv. draws.parquet has a row for each draw: the parameters of fit.json with \
their units (speed_mean_ft_s, speed_sd_ft_s, corr_speed_pitch ...) and probability, P of the usual shot. \
docs/formats.md explains every column.

Examples:
  bankshot fit docs/data/gym_sensor.csv
  bankshot fit shots.csv --map 'speed=ReleaseSpeed:mph' \\
    --map 'shooter=Player' --map 'session=Day' \\
    --distance '13.75 ft' --release-height '7 ft'
  bankshot fit tracking.csv --tracker optical_25hz --frame court_94x50 \\
    --free drag_coefficient")]
pub(crate) struct FitOptions {
    /// The measured shots: CSV or Parquet.
    pub(crate) shots: PathBuf,
    #[command(flatten)]
    pub(crate) measured: MeasuredShotsOptions,
    /// Folder of the results [default: results/<name of the file>-fit, with --shooter a folder in
    /// it].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Also ask the shots for what no sensor sees: backspin or hoop_restitution (from made and
    /// missed), or drag_coefficient (from trajectories); may be repeated.
    #[arg(long, value_name = "PARAMETER")]
    pub(crate) free: Vec<String>,
    /// Print fit.json instead of the text.
    #[arg(long)]
    pub(crate) json: bool,
}

/// Rejected rows that are named.
const MOST_NAMED: usize = 20;

pub(crate) fn run(options: &FitOptions, quiet: bool) -> Result<u8, Failure> {
    check_free(&options.free)?;
    let file = options.measured.read(&options.shots)?;
    let out = options.out.clone().unwrap_or_else(|| {
        let folder = default_folder(&options.shots);
        // Where a fit of all shooters puts this one.
        match &options.measured.shooter {
            Some(name) => folder.join(run_folder::safe_name(name)),
            None => folder,
        }
    });
    for shots in &file.shooters {
        report_rejected(&file, shots, file.shooters.len() == 1);
    }
    let is_complete = file.shooters.iter().all(|shots| shots.rejected.is_empty());
    let code = if is_complete {
        code::DONE
    } else {
        code::INCOMPLETE
    };
    if let [shots] = &file.shooters[..] {
        run_folder::refuse_other_results(&out, RunKind::Fit)?;
        if out.join("shooters.csv").exists() {
            return Err(Failure::usage(format!(
                "{0}: holds the fits of several shooters; name a folder in it: --out {1}",
                out.display(),
                out.join(run_folder::safe_name(&file.name_of(shots)))
                    .display()
            )));
        }
        if options.out.is_none() && options.measured.shooter.is_some() {
            refuse_other_shooter(&out, &shots.name)?;
        }
        let fit = file
            .fit(shots, &file.physics)
            .map_err(|error| failure(&options.shots.display().to_string(), &error))?;
        check_free_of_shots(&options.free, shots, &fit)?;
        let free = options.free.iter();
        let free = free
            .map(|name| free_parameter(name, &file, shots, &fit))
            .collect::<Result<Vec<_>, _>>()?;
        write(&out, &file, (shots, &fit, &free), options)?;
        answer(&file, (shots, &fit, &free), options, &out, quiet)?;
        return Ok(code);
    }
    if !options.free.is_empty() {
        file.only_shooter()?;
    }
    let worst = fit_all(&file, &out, options, quiet)?;
    Ok(worst.max(code))
}

/// Fits several shooters side by side: one folder for each, and one table.
fn fit_all(
    file: &MeasuredFile,
    out: &Path,
    options: &FitOptions,
    quiet: bool,
) -> Result<u8, Failure> {
    let bars = ProgressBars::new(quiet);
    let mut folders: Vec<PathBuf> = Vec::new();
    for shots in &file.shooters {
        let name = run_folder::safe_name(&file.name_of(shots));
        let mut folder = out.join(&name);
        let mut number = 1;
        // Different names can be the same as folders.
        while folders.contains(&folder) {
            number += 1;
            folder = out.join(format!("{name}-{number}"));
        }
        folders.push(folder);
    }
    bars.begin("fitting shooters", file.shooters.len() as u64);
    let rows = file
        .shooters
        .par_iter()
        .zip(&folders)
        .map(|(shots, folder)| {
            let row = fit_one(file, shots, folder, options);
            bars.advance(1);
            row
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    bars.end();
    if rows.iter().all(|row| row.result.is_err()) {
        return Err(Failure::usage(format!(
            "{}: no shooter could be fitted",
            options.shots.display()
        )));
    }
    let (long, _) = options.measured.unit_system().length();
    let mut csv = format!(
        "shooter,shots,made,distance_{long},court_angle_deg,release_height_{long},probability,low,high,folder,error\n"
    );
    // Places are only named where there are several.
    let names_places = rows
        .iter()
        .any(|row| row.result.as_ref().is_ok_and(|places| places.len() > 1));
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    let place = names_places.then_some("from");
    let header = ["shooter"].into_iter().chain(place);
    table.set_header(header.chain(["shots", "made", "expected", "P of the usual\nshot (95 %)"]));
    let mut worst = code::DONE;
    for row in &rows {
        csv += &row.csv;
        match &row.result {
            Ok(places) => {
                for place in places {
                    let from = names_places.then_some(&place.from);
                    let cells = std::iter::once(&place.shooter).chain(from);
                    table.add_row(cells.chain(&place.cells));
                }
            }
            Err(error) => {
                print_remark(error);
                worst = code::INCOMPLETE;
            }
        }
    }
    let path = out.join("shooters.csv");
    atomic_file::write(&path, csv.as_bytes())
        .map_err(|error| Failure::io(path.display(), &error))?;
    let assumptions = match &file.shooters[..] {
        [first, ..] => {
            let source = file.source(first);
            format!(
                "{} shooters: {}, tracker {} ({}), physics {}\n",
                file.shooters.len(),
                source.kind,
                source.tracker.0,
                source.tracker.1,
                source.physics
            )
        }
        [] => String::new(),
    };
    print_answer(&format!("{assumptions}{}\n", table.trim_fmt()))?;
    for warning in rows.iter().flat_map(|row| &row.warnings) {
        print_remark(warning);
    }
    if !quiet {
        print_sessions(&file.shooters);
        print_unused(file);
        print_remark(&format!(
            "written: {}, and a folder for each shooter; next: bankshot advise {}",
            path.display(),
            out.display()
        ));
    }
    Ok(worst)
}

/// A shooter's row of the tables.
struct ShooterRow {
    csv: String,
    /// A row of the printed table for each place, or why there is no fit.
    result: Result<Vec<PlaceRow>, String>,
    warnings: Vec<String>,
}

/// A place in a cell of the table, such as `13.75 ft, 0 deg, from 7.00 ft up`.
fn place_in_short(place: &Place, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    format!(
        "{:.2} {long}, {:.0} deg,\n{:.2} {long} up",
        place.location.distance_m / metre,
        place.location.angle_rad / DEGREE_RAD,
        place.release_height_m / metre
    )
}

/// A row of the printed table.
struct PlaceRow {
    /// The name, in the first row of a shooter.
    shooter: String,
    from: String,
    /// Shots, made, expected, P.
    cells: [String; 4],
}

fn fit_one(
    file: &MeasuredFile,
    shots: &ShooterShots,
    folder: &Path,
    options: &FitOptions,
) -> Result<ShooterRow, Failure> {
    let name = file.name_of(shots);
    let fit = match file.fit(shots, &file.physics) {
        Ok(fit) => fit,
        Err(error) => {
            let (shooter, count) = (cell(&name), shots.shots.len());
            return Ok(ShooterRow {
                csv: format!("{shooter},{count},,,,,,,,,{}\n", cell(&error.to_string())),
                result: Err(format!("{name}: {error}")),
                warnings: Vec::new(),
            });
        }
    };
    write(folder, file, (shots, &fit, &[]), options)?;
    let (_, metre) = options.measured.unit_system().length();
    let (mut csv, mut places) = (String::new(), Vec::new());
    for (index, place) in fit.places.iter().enumerate() {
        let p = fit.probabilities[index].interval();
        let makes = fit.makes.at_place(index);
        let (count, has_results) = (makes.shots.len(), makes.labelled > 0);
        let made = if has_results {
            makes.made.to_string()
        } else {
            String::new()
        };
        csv += &format!(
            "{},{count},{made},{:.3},{:.2},{:.3},{:.4},{:.4},{:.4},{},\n",
            cell(&name),
            place.location.distance_m / metre,
            place.location.angle_rad / DEGREE_RAD,
            place.release_height_m / metre,
            p.mean,
            p.low,
            p.high,
            cell(&folder.display().to_string())
        );
        let percent = |p: f64| format!("{:.1}", 100.0 * p);
        // A place takes two lines, so the interval does too.
        let is_one = fit.places.len() == 1;
        let [made, expected] = if has_results {
            [
                format!("{} of {}", makes.made, makes.labelled),
                format!("{:.1} \u{b1} {:.1}", makes.expected, makes.expected_sd),
            ]
        } else {
            [String::new(), String::new()]
        };
        places.push(PlaceRow {
            shooter: if index == 0 {
                shortened(&name, 20)
            } else {
                String::new()
            },
            from: place_in_short(place, options.measured.unit_system()),
            cells: [
                count.to_string(),
                made,
                expected,
                format!(
                    "{} %{}{} to {}{}",
                    percent(p.mean),
                    if is_one { " (" } else { "\n" },
                    percent(p.low),
                    percent(p.high),
                    if is_one { ")" } else { "" }
                ),
            ],
        });
    }
    Ok(ShooterRow {
        csv,
        result: Ok(places),
        warnings: fit
            .warnings
            .iter()
            .map(|warning| format!("{name}: warning: {warning}"))
            .collect(),
    })
}

/// Says that sessions were fitted as one.
fn print_sessions(shooters: &[ShooterShots]) {
    let mut names: Vec<&str> = Vec::new();
    for name in shooters.iter().flat_map(|shots| &shots.sessions) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    if names.len() > 1 {
        print_remark(&format!(
            "{} sessions are fitted as one; `bankshot compare-sessions` compares two of them",
            names.len()
        ));
    }
}

/// Names the columns that nothing was taken from.
fn print_unused(file: &MeasuredFile) {
    if !file.unused.is_empty() {
        print_remark(&format!(
            "columns that were not used: {}",
            file.unused.join(", ")
        ));
    }
}

/// A cell of a CSV table.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

pub(crate) fn failure(place: &str, error: &ShooterFitError) -> Failure {
    Failure {
        code: match error {
            ShooterFitError::Fit(crate::fitting::FitError::NotConverged { .. }) => code::IMPRECISE,
            _ => code::USAGE,
        },
        message: format!("{place}: {error}"),
    }
}

/// Refuses the folder of another shooter, whose name is the same as that of a folder.
fn refuse_other_shooter(folder: &Path, name: &str) -> Result<(), Failure> {
    let text = std::fs::read_to_string(folder.join("fit.json")).unwrap_or_default();
    let fit: Value = serde_json::from_str(&text).unwrap_or_default();
    match fit["shooter"].as_str() {
        Some(other) if other != name => Err(Failure::usage(format!(
            "{}: holds the fit of {other}; name another folder with --out",
            folder.display()
        ))),
        _ => Ok(()),
    }
}

fn check_free(free: &[String]) -> Result<(), Failure> {
    for name in free {
        if name != "drag_coefficient" && UnseenParameter::named(name).is_none() {
            return Err(Failure::usage(format!(
                "--free {name}: must be backspin, hoop_restitution or drag_coefficient"
            )));
        }
    }
    Ok(())
}

/// Refuses to ask shots for what they cannot tell, before anything is written.
fn check_free_of_shots(
    free: &[String],
    shots: &ShooterShots,
    fit: &ShooterFit,
) -> Result<(), Failure> {
    let (made, labelled) = (fit.makes.made, fit.makes.labelled);
    for name in free {
        if name == "drag_coefficient" {
            if shots.tracks.is_empty() {
                return Err(Failure::usage(
                    "--free drag_coefficient: only trajectories tell it",
                ));
            }
        } else if labelled == 0 || made == 0 || made == labelled {
            return Err(Failure::usage(format!(
                "--free {name}: needs shots that were made and shots that were missed; {made} of {labelled} with a result were made"
            )));
        }
    }
    Ok(())
}

fn default_folder(shots: &Path) -> PathBuf {
    let stem = shots
        .file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    Path::new("results").join(format!("{}-fit", run_folder::safe_name(&stem)))
}

pub(crate) fn report_rejected(file: &MeasuredFile, shots: &ShooterShots, is_only: bool) {
    if shots.rejected.is_empty() {
        return;
    }
    let of = if shots.name.is_empty() {
        String::new()
    } else {
        format!("{}: ", shots.name)
    };
    // Of several shooters, fewer of each.
    let most_named = if is_only { MOST_NAMED } else { 3 };
    for (row, reason) in shots.rejected.iter().take(most_named) {
        print_remark(&format!(
            "{}: {} {row}: {reason}",
            file.file.display(),
            file.row_name
        ));
    }
    if shots.rejected.len() > most_named {
        print_remark(&format!(
            "... and {} more; `fit` lists all in its shots.csv",
            shots.rejected.len() - most_named
        ));
    }
    print_remark(&format!(
        "{of}{} shots are used, {} were kept out",
        shots.shots.len(),
        shots.rejected.len()
    ));
}

fn write(
    folder: &Path,
    file: &MeasuredFile,
    (shots, fit, free): (&ShooterShots, &ShooterFit, &[FreeParameter]),
    options: &FitOptions,
) -> Result<(), Failure> {
    run_folder::prepare(folder, RunKind::Fit)?;
    let units = options.measured.unit_system();
    let source = file.source(shots);
    let rows = shots.shots.iter().map(|shot| shot.row);
    let sessions = rows
        .zip(shots.sessions.iter().map(String::as_str))
        .collect();
    let contents: [(&str, Vec<u8>); 4] = [
        (
            "fit.json",
            format!("{:#}\n", with_free(fit_json(fit, &source, units), free)).into_bytes(),
        ),
        (
            "profile.toml",
            fitted_profile_toml(fit, &source, &file.physics_toml).into_bytes(),
        ),
        (
            "draws.parquet",
            draws_parquet(&fit.posterior, &fit.probabilities, units).map_err(Failure::bug)?,
        ),
        (
            "shots.csv",
            shots_csv(fit, &sessions, &shots.rejected, units),
        ),
    ];
    for (name, bytes) in contents {
        let path = folder.join(name);
        atomic_file::write(&path, &bytes).map_err(|error| Failure::io(path.display(), &error))?;
    }
    let plots = measured_shots::all(fit, &shots.shots, &shots.sessions, units);
    plot_files::write(&folder.join("plots"), &plots)?;
    let page = fit_page(fit, &source, plots, units);
    let html = page.html()?;
    let path = folder.join("report.html");
    atomic_file::write(&path, html.as_bytes()).map_err(|error| Failure::io(path.display(), &error))
}

/// Says that the heights of the releases differ, and what is taken for P.
fn print_merged_heights(shots: &ShooterShots, units: UnitSystem) {
    if let Some([least, greatest]) = shots.merged_heights_m {
        let (long, metre) = units.length();
        print_remark(&format!(
            "the releases are {:.2} to {:.2} {long} high; P is that of their mean height",
            least / metre,
            greatest / metre
        ));
    }
}

fn answer(
    file: &MeasuredFile,
    (shots, fit, free): (&ShooterShots, &ShooterFit, &[FreeParameter]),
    options: &FitOptions,
    folder: &Path,
    quiet: bool,
) -> Result<(), Failure> {
    let units = options.measured.unit_system();
    let source = file.source(shots);
    if options.json {
        let json = with_free(fit_json(fit, &source, units), free);
        print_answer(&format!("{json:#}\n"))?;
    } else {
        print_prose(&fit_text(fit, &source, units))?;
        for parameter in free {
            print_prose(&parameter.text)?;
        }
    }
    if !quiet {
        let warnings = fit.profiles.iter().flat_map(implausible_values);
        for words in warnings.filter(|words| words.starts_with("location")) {
            print_remark(&format!("warning: {words}"));
        }
        print_merged_heights(shots, units);
        print_sessions(std::slice::from_ref(shots));
        print_unused(file);
        print_remark(&format!(
            "written to {}; next: bankshot advise {}",
            folder.display(),
            folder.display()
        ));
    }
    Ok(())
}

/// What the shots say of a parameter that was not measured.
struct FreeParameter {
    text: String,
    json: Value,
}

/// The fit for programs, with the parameters that `--free` asked for.
fn with_free(mut fit: Value, free: &[FreeParameter]) -> Value {
    if !free.is_empty() {
        fit["free"] = free
            .iter()
            .map(|parameter| parameter.json.clone())
            .collect();
    }
    fit
}

/// What the shots say of a parameter that was not measured, and how to use it.
fn free_parameter(
    name: &str,
    file: &MeasuredFile,
    shots: &ShooterShots,
    fit: &ShooterFit,
) -> Result<FreeParameter, Failure> {
    let Some(parameter) = UnseenParameter::named(name) else {
        let tracks: Vec<_> = shots.tracks.iter().map(Vec::as_slice).collect();
        let backspin = file.backspin_rad_s.unwrap_or(0.0);
        let found = fit_drag_coefficient(&file.physics, &tracks, &file.noise, backspin);
        return Ok(match found {
            Some((best, [low, high])) => FreeParameter {
                text: format!(
                    "drag_coefficient  {best:.3} (95 %: {low:.3} to {high:.3}) from {} flights; the physics {} has {:.3}\n{}",
                    tracks.len(),
                    file.physics_name,
                    file.physics.air.drag_coefficient,
                    physics_with(file, &format!("drag_coefficient = {best:.3}"))
                ),
                json: json!({ "name": name, "unit": "", "best": best, "low": low, "high": high, "is_decided": true }),
            },
            None => FreeParameter {
                text: "drag_coefficient  these flights cannot tell\n".to_owned(),
                json: json!({ "name": name, "unit": "", "is_decided": false }),
            },
        });
    };
    let labelled = fit.makes.labelled;
    let is_measured = shots.spin == SpinSource::Measured;
    let curve = likelihood_curve(
        parameter,
        &fit.profiles,
        &shots.shots,
        &fit.typical,
        is_measured,
    )?;
    let (unit, size) = match parameter {
        UnseenParameter::Backspin => (" rev/s", REV_RAD),
        UnseenParameter::HoopRestitution => ("", 1.0),
    };
    let best = curve.best / size;
    let (fitted_with, use_it) = match parameter {
        UnseenParameter::Backspin => (
            format!(
                "the fit's mean is {:.2} rev/s",
                fit.typical.means[0][3] / REV_RAD
            ),
            format!(
                "This fit did not use it. To use it, fit again with --backspin '{best:.2} rev/s'; \
                 that takes the value as exact.\n"
            ),
        ),
        UnseenParameter::HoopRestitution => (
            format!(
                "the physics {} has {:.2}",
                file.physics_name,
                file.physics.restitution_on(SolidId::Ring)
            ),
            physics_with(file, &format!("hoop_restitution = {best:.2}")),
        ),
    };
    let [low, high] = curve.interval.map(|end| end / size);
    let ends = [curve.points.first(), curve.points.last()];
    let is_at_end = ends.iter().flatten().any(|(end, _)| *end == curve.best);
    let mut text = format!(
        "{name}  {best:.2}{unit} (95 %: {low:.2} to {high:.2}) by made and missed of {labelled} shots{}; {fitted_with}\n",
        if curve.is_decided {
            ""
        } else if is_at_end {
            "; the likeliest value is at an end of the range, so more than this value is wrong: look at distance, release height, air, tracker, and how a make was recorded"
        } else {
            "; the interval reaches the end of the range: these shots cannot tell"
        }
    );
    let usual = parameter.usual_range();
    let is_usual = (usual.0..=usual.1).contains(&curve.best);
    if curve.is_decided && !is_usual {
        text += &format!(
            "That is not what sources give ({:.2} to {:.2}{unit}). Makes and misses answer for all that is wrong here: look first at distance, release height, air, tracker, and how a make was recorded.\n",
            usual.0 / size,
            usual.1 / size
        );
    }
    for (value, logarithm) in &curve.points {
        text += &format!(
            "  {:>7.3}{unit}  log-likelihood {logarithm:>8.2}\n",
            value / size
        );
    }
    if curve.is_decided && is_usual && !(parameter == UnseenParameter::Backspin && is_measured) {
        text += &use_it;
    }
    let curve_json = curve.points.iter().map(|(value, logarithm)| {
        json!({ "value": rounded(value / size), "log_likelihood": rounded(*logarithm) })
    });
    let json = json!({
        "name": name,
        "unit": unit.trim(),
        "best": rounded(best),
        "low": rounded(low),
        "high": rounded(high),
        "is_decided": curve.is_decided,
        "is_usual": is_usual,
        "curve": curve_json.collect::<Value>(),
    });
    Ok(FreeParameter { text, json })
}

/// How the fit is made with another constant of the physics.
fn physics_with(file: &MeasuredFile, line: &str) -> String {
    if Preset::named(&file.physics_name).is_some() {
        format!(
            "This fit did not use it. To use it, write a file with these lines, and fit again with --physics FILE:\n  [physics]\n  preset = \"{}\"\n  {line}\n",
            file.physics_name
        )
    } else {
        format!(
            "This fit did not use it. To use it, write {line} into [physics] of {}, and fit again.\n",
            file.physics_name
        )
    }
}
