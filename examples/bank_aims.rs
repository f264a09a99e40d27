//! Where the best bank shots of a sweep are aimed, by distance and court angle: the point behind
//! the board that their lines of aim pass, and their difference from the paper's closed form (Eq.
//! 27). `cargo run --release --example bank_aims SWEEP.toml FOLDER`, after `bankshot sweep
//! SWEEP.toml --out FOLDER`.

use bankshot::analysis::bank_aim::{
    closed_form_meeting_m, closed_form_polar_rad, meeting_behind_board_m,
};
use bankshot::shooter::Location;
use bankshot::sweep::sweep_toml::{SourceTexts, named_files, parse_sweep};
use bankshot::units::{DEGREE_RAD, FOOT_M, INCH_M};
use std::error::Error;
use std::path::Path;

/// Limits of the rows, ft, and of the columns, deg.
const DISTANCES_FT: [f64; 4] = [0.0, 8.0, 14.0, 100.0];
const ANGLES_DEG: [f64; 5] = [10.0, 30.0, 50.0, 70.0, 90.0];

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [sweep, folder] = &arguments[..] else {
        return Err("give a sweep and its folder".into());
    };
    let text = std::fs::read_to_string(sweep)?;
    let parent = Path::new(sweep).parent().unwrap_or(Path::new("."));
    let read = |name: Option<String>| name.map(|name| std::fs::read_to_string(parent.join(name)));
    let files = named_files(&text);
    let texts = SourceTexts {
        shooter: read(files.shooter).transpose()?,
        places: read(files.places).transpose()?,
        sweep: text,
    };
    let config = parse_sweep(&texts, sweep)?;
    let physics = &config.settings.physics;
    let mut shots: Vec<(Location, f64)> = Vec::new();
    let mut reader = csv::Reader::from_path(Path::new(folder).join("best_shots.csv"))?;
    let header = reader.headers()?.clone();
    let column = |name: &str| {
        header
            .iter()
            .position(|one| one == name)
            .ok_or(name.to_owned())
    };
    let (kind, distance) = (column("kind")?, column("distance_ft")?);
    let (angle, polar) = (column("court_angle_deg")?, column("polar_deg")?);
    for record in reader.records() {
        let record = record?;
        // The other side is the mirror image.
        if &record[kind] != "bank" || record[polar].is_empty() || record[angle].starts_with('-') {
            continue;
        }
        let location = Location {
            distance_m: record[distance].parse::<f64>()? * FOOT_M,
            angle_rad: record[angle].parse::<f64>()? * DEGREE_RAD,
        };
        shots.push((location, record[polar].parse::<f64>()? * DEGREE_RAD));
    }
    println!(
        "closed form: {:.2} in behind the board",
        closed_form_meeting_m(physics) / INCH_M
    );
    println!(
        "| distance, ft | angle, deg | places | in behind the board | deg from the closed form |"
    );
    println!("|---|---|---|---|---|");
    for rows in DISTANCES_FT.windows(2) {
        for columns in ANGLES_DEG.windows(2) {
            let is_here = |location: &Location| {
                (rows[0]..rows[1]).contains(&(location.distance_m / FOOT_M))
                    && (columns[0]..columns[1]).contains(&(location.angle_rad / DEGREE_RAD))
            };
            let here: Vec<_> = shots
                .iter()
                .filter(|(location, _)| is_here(location))
                .collect();
            let meetings = here
                .iter()
                .filter_map(|(location, polar)| meeting_behind_board_m(physics, *location, *polar))
                .map(|meeting_m| meeting_m / INCH_M);
            let differences = here.iter().map(|(location, polar)| {
                (polar - closed_form_polar_rad(physics, *location)) / DEGREE_RAD
            });
            if !here.is_empty() {
                println!(
                    "| {} to {} | {} to {} | {} | {} | {} |",
                    rows[0],
                    rows[1],
                    columns[0],
                    columns[1],
                    here.len(),
                    range(meetings.collect(), 1),
                    range(differences.collect(), 2)
                );
            }
        }
    }
    Ok(())
}

/// The median, and the least and the greatest value.
fn range(mut values: Vec<f64>, decimals: usize) -> String {
    values.sort_by(f64::total_cmp);
    let (Some(least), Some(greatest)) = (values.first(), values.last()) else {
        return "-".to_owned();
    };
    let median = values[values.len() / 2];
    format!("{median:.decimals$} ({least:.decimals$} to {greatest:.decimals$})")
}
