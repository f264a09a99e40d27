//! `bankshot report`: one HTML page of the folder of a run.

use super::arguments::FolderOptions;
use super::failure::{Failure, code};
use super::plan::{load, read_text};
use super::progress::Bars;
use super::terminal::{answer, tell};
use bankshot::dynamics::Simulator;
use bankshot::output::files;
use bankshot::picture::report::{Page, Shot, Table, of_place, of_sweep};
use bankshot::picture::{comparison, curves};
use bankshot::probability::Progress;
use bankshot::profile::{Nominal, Profile};
use bankshot::sweep::folder::Folder;
use bankshot::sweep::jobs::Jobs;
use bankshot::units::{DEGREE_RAD, REV_RAD, System};
use serde_json::Value;
use std::path::{Path, PathBuf};

pub(crate) fn run(options: &FolderOptions, quiet: bool) -> Result<u8, Failure> {
    let folder = &options.folder;
    let target = folder.join("report.html");
    if let Some(sweep) = sweep_of(folder) {
        let (sweep, configuration) = Folder::to_look_at(&sweep)?;
        let (rows, remarks) = sweep.union()?;
        for remark in remarks {
            tell(&format!("remark: {remark}"));
        }
        let page = of_sweep(&configuration, &rows, (sweep.program(), sweep.hash()));
        let template = &configuration.template;
        let simulator = Simulator::with_integrator(&template.physics, template.integrator)
            .map_err(Failure::usage)?;
        write(&target, page, &simulator, quiet)?;
        return Ok(super::sweep::exit_of(&Jobs::new(&configuration), &rows));
    }
    let file = folder.join("profile.toml");
    if !file.exists() {
        return Err(Failure::usage(format!(
            "{}: is not the folder of a `best`, `compare` or `sweep` run (there is no profile.toml and no configuration.json)",
            folder.display()
        )));
    }
    let mut profile = load(&file)?;
    let text = read_text(&folder.join("best_shots.json"))?;
    let best: Value = serde_json::from_str(&text).map_err(|error| {
        Failure::usage(format!("{}: best_shots.json: {error}", folder.display()))
    })?;
    profile.output.units = if best.get("distance_m").is_some() {
        System::Metric
    } else {
        System::Imperial
    };
    let simulator =
        Simulator::with_integrator(&profile.physics, profile.integrator).map_err(Failure::usage)?;
    let shots = shots(&profile, &best);
    let bars = Bars::new(quiet);
    bars.begin("drawing", 2);
    let mut pictures: Vec<_> = comparison::in_release_space(&profile, &simulator, &shots)
        .into_iter()
        .collect();
    pictures.extend(comparison::outcomes_about(&profile, &simulator, &shots));
    bars.advance(1);
    let curve_rows = csv_rows(&folder.join("curves.csv"))?;
    pictures.extend(curves::picture(&profile, &curve_rows));
    bars.end();
    let lessons = csv_rows(&folder.join("lessons.csv"))?;
    let tables = lessons_table(&lessons).into_iter().collect();
    let aim = aim(&profile, &best, &shots);
    let page = of_place(&profile, shots, &aim, tables, pictures);
    write(&target, page, &simulator, quiet)
}

/// The sweep that a folder is, or whose pictures it holds.
fn sweep_of(folder: &Path) -> Option<PathBuf> {
    if folder.join("configuration.json").exists() {
        return Some(folder.to_owned());
    }
    let text = std::fs::read_to_string(folder.join("of_sweep.json")).ok()?;
    let note: Value = serde_json::from_str(&text).ok()?;
    Some(PathBuf::from(note.get("sweep")?.as_str()?))
}

fn write(
    target: &Path,
    page: Option<Page<'_>>,
    simulator: &Simulator,
    quiet: bool,
) -> Result<u8, Failure> {
    let Some(page) = page else {
        return Err(Failure {
            code: code::INCOMPLETE,
            message: format!("{}: there is no shot to report yet", target.display()),
        });
    };
    let html = page.html(simulator).map_err(Failure::usage)?;
    files::write(target, html.as_bytes()).map_err(|error| Failure::io(target.display(), &error))?;
    answer(&format!("{}\n", page.answer))?;
    if !quiet {
        tell(&format!(
            "written to {} ({:.2} MB)",
            target.display(),
            html.len() as f64 / 1e6
        ));
    }
    Ok(code::WHOLE)
}

fn shots(profile: &Profile, best: &Value) -> Vec<Shot> {
    let (long, foot) = profile.output.units.length();
    ["direct", "bank"]
        .into_iter()
        .filter_map(|kind| {
            let shot = best.get(kind)?;
            let value = |name: &str| shot.get(name).and_then(Value::as_f64);
            Some(Shot {
                place: 0,
                kind: kind.to_owned(),
                from: profile.place,
                nominal: Nominal {
                    speed_m_s: value(&format!("speed_{long}_s"))? * foot,
                    pitch_rad: value("pitch_deg")? * DEGREE_RAD,
                    polar_rad: value("polar_deg")? * DEGREE_RAD,
                    backspin_rad_s: value("backspin_rev_s")? * REV_RAD,
                    side_spin_rad_s: value("side_spin_rev_s").unwrap_or(0.0) * REV_RAD,
                    rifle_spin_rad_s: profile.held().rifle_spin_rad_s,
                },
                p: (value("probability")?, value("standard_error")?),
                mirror_of: None,
            })
        })
        .collect()
}

/// Where the better shot is aimed, in words that end a sentence.
fn aim(profile: &Profile, best: &Value, shots: &[Shot]) -> String {
    let (short, _) = profile.output.units.short_length();
    let Some(better) = shots.iter().max_by(|a, b| a.p.0.total_cmp(&b.p.0)) else {
        return String::new();
    };
    let value = |name: &str| best[better.kind.as_str()].get(name).and_then(Value::as_f64);
    let above = value(&format!("board_aim_above_hoop_{short}"));
    let across = value(&format!("board_aim_across_{short}"));
    let past = value(&format!("aim_past_centre_{short}"));
    match (better.kind.as_str(), above.zip(across), past) {
        ("bank", Some((above, across)), _) => {
            let side = if across > 0.0 { "right" } else { "left" };
            format!(
                "; the ball's centre meets the board {above:.0} {short} above the ring and {:.0} {short} to the {side} of its middle line, facing the board",
                across.abs()
            )
        }
        (_, _, Some(past)) => {
            let side = if past < 0.0 { "short of" } else { "past" };
            format!(
                "; the path passes the ring's plane {:.1} {short} {side} its centre",
                past.abs()
            )
        }
        _ => String::new(),
    }
}

/// The rows of a CSV file of the run, the header first; nothing where there is no such file.
fn csv_rows(path: &Path) -> Result<Vec<Vec<String>>, Failure> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = read_text(path)?;
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(text.as_bytes());
    reader
        .records()
        .map(|record| Ok(record?.iter().map(str::to_owned).collect()))
        .collect::<Result<_, csv::Error>>()
        .map_err(|error| Failure::usage(format!("{}: {error}", path.display())))
}

/// What the shooter learns, gains in points of P.
fn lessons_table(rows: &[Vec<String>]) -> Option<Table> {
    let names = |lesson: &str, of: &str| match lesson {
        "window_low" => format!("window, lowest {of}"),
        "window_high" => format!("window, highest {of}"),
        "without" => format!("without the error in {}", of.replace('_', " ")),
        "a_tenth_less" => format!("with a tenth less error in {}", of.replace('_', " ")),
        "backspin" => "another backspin".to_owned(),
        "release_height" => "another height of release".to_owned(),
        other => other.to_owned(),
    };
    let points = |text: &str| {
        text.parse::<f64>().map_or(String::new(), |value| {
            let text = format!("{:.1}", 100.0 * value);
            // Nothing is not negative.
            if text == "-0.0" {
                "0.0".to_owned()
            } else {
                text
            }
        })
    };
    let rows: Vec<_> = rows
        .iter()
        .skip(1)
        .filter(|row| row.len() == 7)
        .map(|row| {
            let value = row[4]
                .parse::<f64>()
                .map_or(String::new(), |value| format!("{value:.2} {}", row[3]));
            let cells = vec![
                row[0].clone(),
                names(&row[1], &row[2]),
                value,
                points(&row[5]),
                points(&row[6]),
            ];
            (None, cells)
        })
        .collect();
    (!rows.is_empty()).then(|| Table {
        caption: "What the shooter learns".to_owned(),
        columns: ["shot", "lesson", "value", "gain, points of P", "\u{b1}"]
            .map(str::to_owned)
            .to_vec(),
        rows,
    })
}
