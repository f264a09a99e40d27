//! A table of best shots for people, at most 80 columns wide.

use super::notes::{notes, physics_note, shooter_note, speed_limit_in_words, what_shots};
use crate::best_shot::{ShotTable, TableShot};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem, rounded};

/// A column of the text: two lines of header, a width, and what it says of a shot.
struct TextColumn {
    name: &'static str,
    unit: String,
    width: usize,
    cell: Box<dyn Fn(&TableShot) -> String>,
}

/// Whether the table has one angle alone. It then has no column of angles, and room for both sides
/// of the margins.
fn has_one_angle(table: &ShotTable) -> bool {
    table.angles_rad.len() == 1
}

/// The columns that follow the place.
fn shot_columns(table: &ShotTable, units: UnitSystem) -> Vec<TextColumn> {
    let (long, metre) = units.length();
    let speed_unit = format!("{long}/s");
    let column = |name, unit: &str, width, cell| TextColumn {
        name,
        unit: unit.to_owned(),
        width,
        cell,
    };
    let value = |name, unit: &str, width, decimals, value: fn(&TableShot) -> f64, size| {
        let cell = move |shot: &TableShot| decimal(value(shot) / size, decimals);
        column(name, unit, width, Box::new(cell))
    };
    let mut shown = vec![
        value("speed", &speed_unit, 5, 2, |s| s.nominal.speed_m_s, metre),
        value("pitch", "deg", 5, 1, |s| s.nominal.pitch_rad, DEGREE_RAD),
        value("aim", "deg", 6, 2, |s| s.aim_rad, DEGREE_RAD),
        value("spin", "rev/s", 5, 2, |s| s.nominal.backspin_rad_s, REV_RAD),
        value("time", "s", 4, 2, |s| s.time_s.unwrap_or(f64::NAN), 1.0),
        value(
            "entry",
            "deg",
            5,
            1,
            |s| s.entry_rad.unwrap_or(f64::NAN),
            DEGREE_RAD,
        ),
        value("P", "", 5, 3, |s| s.probability, 1.0),
    ];
    let speed_sides = move |shot: &TableShot| shot.tolerances[0].map(|side| side / metre);
    let pitch_sides = |shot: &TableShot| shot.tolerances[1].map(|side| side / DEGREE_RAD);
    if has_one_angle(table) {
        let of_speed = move |shot: &TableShot| both_sides(speed_sides(shot), 2);
        let of_pitch = move |shot: &TableShot| both_sides(pitch_sides(shot), 1);
        shown.push(column("margin", &speed_unit, 10, Box::new(of_speed)));
        shown.push(column("margin", "deg", 8, Box::new(of_pitch)));
    } else {
        let smaller_sides = move |shot: &TableShot| {
            let [speed, pitch] =
                [speed_sides(shot), pitch_sides(shot)].map(|[below, above]| below.min(above));
            format!("{speed:.2}, {pitch:.2}")
        };
        let unit = format!("{speed_unit}, deg");
        shown.push(column("margin", &unit, 10, Box::new(smaller_sides)));
    }
    let outcome = |shot: &TableShot| shot.outcome.name().to_owned();
    shown.push(column("goes in", "", 0, Box::new(outcome)));
    shown
}

/// A node.
struct TableNode<'a> {
    /// In units of the results.
    distance: f64,
    /// Court angle, deg.
    angle: f64,
    is_added: bool,
    shot: Option<&'a TableShot>,
}

/// The nodes, angle by angle.
fn nodes(table: &ShotTable, units: UnitSystem) -> impl Iterator<Item = TableNode<'_>> {
    let metre = units.length().1;
    (0..table.angles_rad.len()).flat_map(move |a| {
        (0..table.distances_m.len()).map(move |d| TableNode {
            distance: rounded(table.distances_m[d] / metre),
            angle: rounded(table.angles_rad[a] / DEGREE_RAD),
            is_added: table.added_distances_m.contains(&table.distances_m[d])
                || table.added_angles_rad.contains(&table.angles_rad[a]),
            shot: table.at(a, d),
        })
    })
}

/// The table for people, at most 80 columns wide.
#[must_use]
pub fn table_text(table: &ShotTable, profile: &Profile, units: UnitSystem) -> String {
    let has_one_angle = has_one_angle(table);
    let mut text = String::new();
    for sentence in [
        shooter_note(table, profile, units),
        physics_note(profile, units),
        format!(
            "{}. from: distance from the hoop's centre. aim: positive to the left. P: \
             the chance of each. margin: by how much speed and pitch can be off, {}, one \
             at a time and with all else exact, until the shot first misses (beyond that more may go \
             in). time, entry: where it \
             first falls to the height of the hoop, as if there were no ring (-: it meets the ring on its way up, or would fall behind the board).{}",
            what_shots(table.kind),
            if has_one_angle {
                "down and up"
            } else {
                "to the side that allows less (CSV and JSON have both)"
            },
            if table.added_distances_m.is_empty() && table.added_angles_rad.is_empty() {
                ""
            } else {
                " +: added for the interpolation."
            }
        ),
    ] {
        text += &wrapped(&sentence);
    }
    let columns = shot_columns(table, units);
    // The columns of the place: name, unit, width.
    let mut of_place = vec![("from", units.length().0, 6)];
    if !has_one_angle {
        of_place.push(("angle", "deg", 5));
    }
    let of_place_widths = of_place.iter().map(|(.., width)| *width);
    let widths: Vec<usize> = of_place_widths
        .chain(columns.iter().map(|column| column.width))
        .collect();
    let names = of_place.iter().map(|(name, ..)| *name);
    let names = names.chain(columns.iter().map(|column| column.name));
    text += &line(names, &widths);
    let unit_names = of_place.iter().map(|(_, unit, _)| *unit);
    let unit_names = unit_names.chain(columns.iter().map(|column| column.unit.as_str()));
    text += &line(unit_names, &widths);
    let limit = speed_limit_in_words(profile, units);
    for TableNode {
        distance,
        angle,
        is_added,
        shot,
    } in nodes(table, units)
    {
        let from = format!("{distance:.2}");
        let from = format!(
            "{}{}",
            if is_added { "+" } else { "" },
            from.trim_end_matches('0').trim_end_matches('.')
        );
        let mut cells = vec![from];
        if !has_one_angle {
            cells.push(format!("{angle:.1}"));
        }
        let Some(shot) = shot else {
            text += &format!(
                "{} no clean shot within the limits{limit}\n",
                line(cells.iter().map(String::as_str), &widths).trim_end_matches('\n')
            );
            continue;
        };
        cells.extend(columns.iter().map(|column| (column.cell)(shot)));
        text += &line(cells.iter().map(String::as_str), &widths);
    }
    let notes = notes(table, profile, units);
    text + &notes.iter().map(|note| wrapped(note)).collect::<String>()
}

/// A number with these decimals; a dash if there is none.
pub(super) fn decimal(value: f64, decimals: usize) -> String {
    if value.is_nan() {
        return "-".to_owned();
    }
    let text = format!("{value:.decimals$}");
    // No negative zero.
    let is_zero = text.starts_with('-') && !text.contains(|c: char| ('1'..='9').contains(&c));
    if is_zero { text[1..].to_owned() } else { text }
}

/// The margins below and above, such as `-0.24+0.31`.
pub(super) fn both_sides(sides: [f64; 2], decimals: usize) -> String {
    let [below, above] = sides.map(|side| {
        let decimals = if side < 9.95 { decimals } else { 0 };
        format!("{side:.decimals$}")
    });
    format!("-{below}+{above}")
}

/// A line of cells, right-aligned; one of width 0, the last, is left-aligned.
pub(super) fn line<'a>(cells: impl Iterator<Item = &'a str>, widths: &[usize]) -> String {
    let mut line = String::new();
    for (cell, width) in cells.zip(widths) {
        line += &format!("{cell:>width$} ");
    }
    line.truncate(line.trim_end().len());
    line + "\n"
}

/// The lines of a text, each of at most 80 columns.
pub(super) fn wrapped(text: &str) -> String {
    textwrap::fill(text, 80) + "\n"
}
