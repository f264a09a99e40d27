//! A table of best shots as text, CSV and JSON.

use crate::best_shot::{ShotTable, TableShot};
use crate::output::json_object::{number, object, provenance};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};
use serde_json::Value;

/// A column: its name with its unit, its decimals for people, and its value.
type TableColumn = (String, usize, fn(&TableShot) -> f64, f64);

fn columns(units: UnitSystem) -> Vec<TableColumn> {
    let (long, metre) = units.length();
    let in_unit = |name: &str, unit: &str| {
        if unit.is_empty() {
            name.to_owned()
        } else {
            format!("{name}_{unit}")
        }
    };
    let speed = format!("{long}_s");
    vec![
        (in_unit("speed", &speed), 2, |s| s.nominal.speed_m_s, metre),
        (
            in_unit("pitch", "deg"),
            1,
            |s| s.nominal.pitch_rad,
            DEGREE_RAD,
        ),
        (in_unit("aim", "deg"), 2, |s| s.aim_rad, DEGREE_RAD),
        (
            in_unit("backspin", "rev_s"),
            2,
            |s| s.nominal.backspin_rad_s,
            REV_RAD,
        ),
        (in_unit("time", "s"), 2, |s| s.time_s, 1.0),
        (
            in_unit("entry", "deg"),
            1,
            |s| s.entry_rad.unwrap_or(f64::NAN),
            DEGREE_RAD,
        ),
        (in_unit("probability", ""), 3, |s| s.probability, 1.0),
        (in_unit("standard_error", ""), 4, |s| s.standard_error, 1.0),
        (
            in_unit("speed_tolerance", &speed),
            2,
            |s| s.tolerances[0],
            metre,
        ),
        (
            in_unit("pitch_tolerance", "deg"),
            1,
            |s| s.tolerances[1],
            DEGREE_RAD,
        ),
    ]
}

/// The nodes with their distance and court angle in units of the results.
fn nodes(
    table: &ShotTable,
    units: UnitSystem,
) -> impl Iterator<Item = (f64, f64, Option<&TableShot>)> {
    let metre = units.length().1;
    (0..table.angles_rad.len()).flat_map(move |a| {
        (0..table.distances_m.len()).map(move |d| {
            (
                without_rounding(table.distances_m[d] / metre),
                without_rounding(table.angles_rad[a] / DEGREE_RAD),
                table.at(a, d),
            )
        })
    })
}

/// A value that was converted to SI units and back, without what that cost in the last digits.
fn without_rounding(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

/// The table for people, at most 80 columns wide.
#[must_use]
pub fn table_text(table: &ShotTable, units: UnitSystem) -> String {
    let (long, _) = units.length();
    let speed_unit = format!("{long}/s");
    let tolerance_unit = format!("{long}/s, deg");
    let header = [
        [
            "from", "angle", "speed", "pitch", "aim", "spin", "time", "entry", "P", "range",
            "goes in",
        ],
        [
            long,
            "deg",
            &speed_unit,
            "deg",
            "deg",
            "rev/s",
            "s",
            "deg",
            "",
            &tolerance_unit,
            "",
        ],
    ];
    let mut text = format!(
        "Best {} shots. P: the chance of each. range: by how much the speed and the\n\
         pitch of an otherwise exact shot may vary. time, entry: until it falls through.\n",
        table.kind.name()
    );
    for cells in header {
        text += &line(&cells.map(str::to_owned));
    }
    let columns = columns(units);
    let cell = |shot: &TableShot, i: usize| {
        let (_, decimals, value, size) = &columns[i];
        let value = value(shot) / size;
        if value.is_nan() {
            "-".to_owned()
        } else {
            let text = format!("{value:.decimals$}");
            // No negative zero.
            let is_zero =
                text.starts_with('-') && !text.contains(|c: char| ('1'..='9').contains(&c));
            if is_zero { text[1..].to_owned() } else { text }
        }
    };
    for (distance, angle, shot) in nodes(table, units) {
        text += &match shot {
            Some(shot) => line(&[
                format!("{distance:.2}"),
                format!("{angle:.1}"),
                cell(shot, 0),
                cell(shot, 1),
                cell(shot, 2),
                cell(shot, 3),
                cell(shot, 4),
                cell(shot, 5),
                cell(shot, 6),
                format!("{}, {}", cell(shot, 8), cell(shot, 9)),
                shot.outcome.name().to_owned(),
            ]),
            None => format!("{distance:>5.2} {angle:>5.1} no clean shot\n"),
        };
    }
    text + &check_text(table, units)
}

/// A line of the table for people.
fn line(cells: &[String; 11]) -> String {
    const WIDTHS: [usize; 10] = [5, 5, 6, 5, 6, 5, 5, 5, 6, 11];
    let mut line = String::new();
    for (cell, width) in cells.iter().zip(WIDTHS) {
        line += &format!("{cell:>width$} ");
    }
    line += &cells[WIDTHS.len()];
    line.truncate(line.trim_end().len());
    line + "\n"
}

/// What interpolation costs, in words.
#[must_use]
pub fn check_text(table: &ShotTable, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    match table.costliest() {
        Some(check) => format!(
            "Halfway between the places, interpolation costs at most {:.4} in P\n\
             ({} checked; most at {:.2} {long}, {:.1} deg). Elsewhere it may cost more.\n",
            check.loss().max(0.0),
            table.checks.len(),
            check.location.distance_m / metre,
            check.location.angle_rad / DEGREE_RAD,
        ),
        None => "No place between could be checked.\n".to_owned(),
    }
}

/// The table as CSV; empty values where there is no clean shot.
#[must_use]
pub fn table_csv(table: &ShotTable, units: UnitSystem) -> String {
    let (long, _) = units.length();
    let columns = columns(units);
    let names: Vec<&str> = columns.iter().map(|(name, ..)| name.as_str()).collect();
    let mut text = format!(
        "kind,distance_{long},court_angle_deg,outcome,{}\n",
        names.join(",")
    );
    for (distance, angle, shot) in nodes(table, units) {
        let cells: Vec<String> = columns
            .iter()
            .map(|(_, _, value, size)| match shot.map(value) {
                Some(value) if value.is_finite() => (value / size).to_string(),
                _ => String::new(),
            })
            .collect();
        text += &format!(
            "{},{distance},{angle},{},{}\n",
            table.kind.name(),
            shot.map_or("", |shot| shot.outcome.name()),
            cells.join(",")
        );
    }
    text
}

/// The table as one JSON object.
#[must_use]
pub fn table_json(table: &ShotTable, profile: &Profile, units: UnitSystem) -> Value {
    let (long, metre) = units.length();
    let columns = columns(units);
    let named = |name: &str, value: Value| (name.to_owned(), value);
    let shots = nodes(table, units).map(|(distance, angle, shot)| {
        let mut record = vec![
            named(&format!("distance_{long}"), number(distance)),
            named("court_angle_deg", number(angle)),
            named(
                "is_clean_shot",
                shot.is_some_and(|shot| table.is_clean(shot)).into(),
            ),
            named("outcome", shot.map(|shot| shot.outcome.name()).into()),
        ];
        record.extend(columns.iter().map(|(name, _, value, size)| {
            let value = shot
                .map(value)
                .map_or(Value::Null, |value| number(value / size));
            (name.clone(), value)
        }));
        object(record)
    });
    let checks = table.checks.iter().map(|check| {
        object(vec![
            named(
                &format!("distance_{long}"),
                number(check.location.distance_m / metre),
            ),
            named(
                "court_angle_deg",
                number(check.location.angle_rad / DEGREE_RAD),
            ),
            named("interpolated_probability", number(check.interpolated)),
            named("best_probability", number(check.best)),
        ])
    });
    let mut record = provenance(profile.hash());
    record.extend([
        named("kind", table.kind.name().into()),
        named("shots", shots.collect()),
        named("checks", checks.collect()),
        named(
            "greatest_loss",
            table.greatest_loss().map_or(Value::Null, number),
        ),
    ]);
    object(record)
}
