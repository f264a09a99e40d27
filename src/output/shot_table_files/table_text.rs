//! A table of best shots as text, CSV and JSON.

use crate::best_shot::{InterpolationCheck, ShotKind, ShotTable, TableKind, TableShot};
use crate::model::SolidId;
use crate::output::json_object::{number, object, provenance};
use crate::shooter::{Location, Profile, ReleaseVariable};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};
use serde_json::Value;

/// A column: its name with its unit, its decimals for people, and its value.
type TableColumn = (String, usize, fn(&TableShot) -> f64, f64);

fn columns(kind: TableKind, units: UnitSystem) -> Vec<TableColumn> {
    let (long, metre) = units.length();
    let in_unit = |name: &str, unit: &str| {
        if unit.is_empty() {
            name.to_owned()
        } else {
            format!("{name}_{unit}")
        }
    };
    let speed = format!("{long}_s");
    let other_kind = match kind {
        TableKind::One(kind) => kind.other().name(),
        TableKind::Better => "other_kind",
    };
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
            in_unit("speed_tolerance_below", &speed),
            2,
            |s| s.tolerances[0][0],
            metre,
        ),
        (
            in_unit("speed_tolerance_above", &speed),
            2,
            |s| s.tolerances[0][1],
            metre,
        ),
        (
            in_unit("pitch_tolerance_below", "deg"),
            1,
            |s| s.tolerances[1][0],
            DEGREE_RAD,
        ),
        (
            in_unit("pitch_tolerance_above", "deg"),
            1,
            |s| s.tolerances[1][1],
            DEGREE_RAD,
        ),
        (
            in_unit(&format!("{other_kind}_probability"), ""),
            3,
            |s| s.other_kind.unwrap_or(f64::NAN),
            1.0,
        ),
        (in_unit("makes_off_board_first", ""), 2, |s| s.banked, 1.0),
    ]
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
            distance: without_rounding(table.distances_m[d] / metre),
            angle: without_rounding(table.angles_rad[a] / DEGREE_RAD),
            is_added: table.added_distances_m.contains(&table.distances_m[d])
                || table.added_angles_rad.contains(&table.angles_rad[a]),
            shot: table.at(a, d),
        })
    })
}

/// A value that was converted to SI units and back, without what that cost in the last digits.
fn without_rounding(value: f64) -> f64 {
    (value * 1e9).round() / 1e9
}

/// The table for people, at most 80 columns wide.
#[must_use]
pub fn table_text(table: &ShotTable, profile: &Profile, units: UnitSystem) -> String {
    let (long, _) = units.length();
    let speed_unit = format!("{long}/s");
    let tolerance_unit = format!("{long}/s, deg");
    // One angle needs no column of its own: there is room for both sides of the margins.
    let is_one_angle = table.angles_rad.len() == 1;
    let header: [Vec<&str>; 2] = if is_one_angle {
        [
            vec![
                "from", "speed", "pitch", "aim", "spin", "time", "entry", "P", "margin", "margin",
                "goes in",
            ],
            vec![
                long,
                &speed_unit,
                "deg",
                "deg",
                "rev/s",
                "s",
                "deg",
                "",
                &speed_unit,
                "deg",
                "",
            ],
        ]
    } else {
        [
            vec![
                "from", "angle", "speed", "pitch", "aim", "spin", "time", "entry", "P", "margin",
                "goes in",
            ],
            vec![
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
        ]
    };
    let widths: &[usize] = if is_one_angle {
        &[6, 5, 5, 6, 5, 4, 5, 5, 10, 8]
    } else {
        &[6, 5, 6, 5, 6, 5, 4, 5, 5, 10]
    };
    let mut text = String::new();
    for sentence in [
        shooter_note(table, profile, units),
        physics_note(profile, units),
        format!(
            "{}. from: distance from the hoop's centre. aim: positive to the left. P: \
             the chance of each. margin: by how much speed and pitch can be off, {}, one \
             at a time and with all else exact, until the shot first misses (beyond that more may go \
             in). time, entry: where it \
             first falls to the height of the hoop, as if there were no ring (-: it hits the ring from below first; time is then that of the \
             make).{}",
            what_shots(table.kind),
            if is_one_angle {
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
    for cells in header {
        text += &line(
            &cells.into_iter().map(str::to_owned).collect::<Vec<_>>(),
            widths,
        );
    }
    let columns = columns(table.kind, units);
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
    // The smaller side.
    let margin = |shot: &TableShot, i: usize| {
        let [below, above] = shot.tolerances[i];
        let (decimals, size) = [(2, units.length().1), (2, DEGREE_RAD)][i];
        format!("{:.decimals$}", below.min(above) / size)
    };
    let both_sides = |shot: &TableShot, i: usize| {
        let (decimals, size) = [(2, units.length().1), (1, DEGREE_RAD)][i];
        let [below, above] = shot.tolerances[i].map(|side| {
            let value = side / size;
            let decimals = if value < 9.95 { decimals } else { 0 };
            format!("{value:.decimals$}")
        });
        format!("-{below}+{above}")
    };
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
        if !is_one_angle {
            cells.push(format!("{angle:.1}"));
        }
        let Some(shot) = shot else {
            text += &format!(
                "{} no shot within the limits goes in\n",
                line(&cells, widths).trim_end_matches('\n')
            );
            continue;
        };
        cells.extend((0..7).map(|i| cell(shot, i)));
        if is_one_angle {
            cells.extend([both_sides(shot, 0), both_sides(shot, 1)]);
        } else {
            cells.push(format!("{}, {}", margin(shot, 0), margin(shot, 1)));
        }
        cells.push(shot.outcome.name().to_owned());
        text += &line(&cells, widths);
    }
    let notes = notes(table, units);
    text + &notes.iter().map(|note| wrapped(note)).collect::<String>()
}

/// Which shots a table has.
#[must_use]
pub fn what_shots(kind: TableKind) -> String {
    match kind {
        TableKind::One(kind) => format!("Best {} shots", kind.name()),
        TableKind::Better => "Best shots, direct or bank, the kind with the higher P".to_owned(),
    }
}

/// A line of the table for people.
fn line(cells: &[String], widths: &[usize]) -> String {
    let mut line = String::new();
    for (cell, width) in cells.iter().zip(widths) {
        line += &format!("{cell:>width$} ");
    }
    if let Some(last) = cells.get(widths.len()) {
        line += last;
    }
    line.truncate(line.trim_end().len());
    line + "\n"
}

/// What a reader of the table must know: what interpolation costs, which nodes were added, where
/// shots are not clean, and where the other kind is better.
#[must_use]
pub fn notes(table: &ShotTable, units: UnitSystem) -> Vec<String> {
    let notes = [
        kinds_note(table, units),
        Some(check_note(table, units)),
        added_note(table, units),
        jump_note(table, units),
        bounce_note(table),
        nearly_other_kind_note(table, units),
        unlikely_note(table, units),
        other_kind_note(table, units),
    ];
    notes.into_iter().flatten().collect()
}

/// The lines of a text, each of at most 80 columns.
fn wrapped(text: &str) -> String {
    textwrap::fill(text, 80) + "\n"
}

/// Whose shots these are: name, release height and the standard deviations at the first place.
#[must_use]
pub fn shooter_note(table: &ShotTable, profile: &Profile, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let shooter = profile.shooter();
    let is_allowed = |c: char| !c.is_control() && c != '\\';
    let name: String = shooter.name.chars().filter(|c| is_allowed(*c)).collect();
    let mut note = format!(
        "Shooter: {name}, released at {} {long}",
        short(shooter.release_height_m / metre)
    );
    let first = table.shots.iter().position(Option::is_some);
    if let Some((index, shot)) = first.and_then(|i| Some((i, table.shots[i].as_ref()?))) {
        let sd = |variable| shooter.dispersion.sigma(variable, &shot.nominal);
        let distance_m = table.distances_m[index % table.distances_m.len()];
        let of_speed = shooter.dispersion.c11;
        let percent = if of_speed > 0.0 {
            format!(
                " ({} % of the speed)",
                short(100.0 * sd(ReleaseVariable::Speed) / shot.nominal.speed_m_s)
            )
        } else {
            String::new()
        };
        note += &format!(
            ", with standard deviations (at {} {long}) of {} {long}/s{percent}, {} deg up, {} deg sideways, {} rev/s",
            short(distance_m / metre),
            short(sd(ReleaseVariable::Speed) / metre),
            short(sd(ReleaseVariable::Pitch) / DEGREE_RAD),
            short(sd(ReleaseVariable::Polar) / DEGREE_RAD),
            short(sd(ReleaseVariable::Backspin) / REV_RAD),
        );
    }
    note + "."
}

/// Ball, hoop and air, so that tables for two balls can be told apart.
#[must_use]
pub fn physics_note(profile: &Profile, units: UnitSystem) -> String {
    let physics = profile.physics();
    let (unit, size) = units.short_length();
    let air = if physics.air.density_kg_m3 > 0.0 {
        format!(
            "drag coefficient {} in air of {} kg/m3",
            short(physics.air.drag_coefficient),
            short(physics.air.density_kg_m3)
        )
    } else {
        "no air".to_owned()
    };
    format!(
        "Physics: a ball of {} kg and {:.2} {unit}, restitution {:.2} on the hoop and {:.2} on the board, {air}.",
        short(physics.ball_mass_kg),
        2.0 * physics.ball_radius_m / size,
        physics.restitution_on(SolidId::Ring),
        physics.restitution_on(SolidId::Board)
    )
}

/// What interpolation costs, and by how much the interpolated P errs.
fn check_note(table: &ShotTable, units: UnitSystem) -> String {
    let (Some(costliest), Some(most_wrong)) = (table.costliest(), table.most_wrong()) else {
        return "No place between could be checked.".to_owned();
    };
    format!(
        "Checked at {} places, the quarters between the table's: interpolated shots lose at most \
         {:.4} in P (at {}), and their interpolated P errs by at most {:.4} (at {}).",
        table.checks.len(),
        costliest.loss().max(0.0),
        place_text(table, &costliest.location, units),
        most_wrong.error().abs(),
        place_text(table, &most_wrong.location, units),
    )
}

/// A place; without its angle where the table has one alone.
fn place_text(table: &ShotTable, place: &Location, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let distance = short(place.distance_m / metre);
    if table.angles_rad.len() == 1 {
        format!("{distance} {long}")
    } else {
        format!(
            "{distance} {long}, {} deg",
            short(place.angle_rad / DEGREE_RAD)
        )
    }
}

/// At most four decimals, without zeros at the end.
fn short(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// Which distances and angles were added to those that were asked for.
fn added_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let (long, metre) = units.length();
    let list = |values: &[f64], unit: f64, name: &str| {
        let texts: Vec<String> = values.iter().map(|value| short(value / unit)).collect();
        (!texts.is_empty()).then(|| format!("{} {name}", texts.join(", ")))
    };
    let parts = [
        list(&table.added_distances_m, metre, long),
        list(&table.added_angles_rad, DEGREE_RAD, "deg"),
    ];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    (!parts.is_empty()).then(|| format!("Added for the interpolation: {}.", parts.join(" and ")))
}

/// Where the best shot jumps.
fn jump_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let (long, metre) = units.length();
    let jumps: Vec<String> = table
        .jumps_m()
        .map(|jump_m| short(jump_m / metre))
        .collect();
    let what = match table.kind {
        TableKind::One(_) => "the best shot jumps",
        TableKind::Better => "the better kind changes or the best shot jumps",
    };
    (!jumps.is_empty()).then(|| {
        format!(
            "At {} {long} {what}: of two rows the first holds below, the second from \
             there on.",
            jumps.join(", ")
        )
    })
}

/// From where to where each kind is the better one.
fn kinds_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    if table.kind != TableKind::Better {
        return None;
    }
    let (long, metre) = units.length();
    let mut stretches: Vec<(ShotKind, f64, f64)> = Vec::new();
    for (distance_m, shot) in table.distances_m.iter().zip(&table.shots) {
        let Some(shot) = shot else { continue };
        match stretches.last_mut() {
            Some((kind, _, to_m)) if *kind == shot.kind => *to_m = *distance_m,
            _ => stretches.push((shot.kind, *distance_m, *distance_m)),
        }
    }
    let texts: Vec<String> = stretches
        .iter()
        .map(|(kind, from_m, to_m)| {
            let [from, to] = [from_m, to_m].map(|m| short(m / metre));
            if from == to {
                format!("{} at {from} {long}", kind.name())
            } else {
                format!("{} from {from} to {to} {long}", kind.name())
            }
        })
        .collect();
    (!texts.is_empty()).then(|| format!("The better kind: {}.", texts.join(", ")))
}

/// How many shots touch more than they should.
fn bounce_note(table: &ShotTable) -> Option<String> {
    let shots = table.shots.iter().flatten();
    let bouncing = shots.filter(|shot| !table.is_clean(shot)).count();
    let off = match table.kind {
        TableKind::One(ShotKind::Direct) => "off the ring or the board",
        TableKind::One(ShotKind::Bank) => "off the ring too",
        TableKind::Better => "off the ring too (a direct one off the ring or the board)",
    };
    (bouncing > 0).then(|| {
        format!(
            "In {bouncing} of {} rows the best shot goes in {off} even without an error.",
            table.shots.len()
        )
    })
}

/// Share of the makes above which a shot is also one of the other kind.
const MANY_OF_OTHER_KIND: f64 = 0.25;

/// Where many of the makes are those of the other kind.
fn nearly_other_kind_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let mut places = Vec::new();
    let mut most = 0.0_f64;
    for (a, angle_rad) in table.angles_rad.iter().enumerate() {
        for (d, distance_m) in table.distances_m.iter().enumerate() {
            let Some(shot) = table.at(a, d) else { continue };
            let share = match shot.kind {
                ShotKind::Direct => shot.banked,
                ShotKind::Bank => 1.0 - shot.banked,
            };
            if share > MANY_OF_OTHER_KIND {
                most = most.max(share);
                let place = Location {
                    distance_m: *distance_m,
                    angle_rad: *angle_rad,
                };
                places.push(place_text(table, &place, units));
            }
        }
    }
    // A jump has two rows.
    places.dedup();
    let touch = match table.kind {
        TableKind::One(ShotKind::Direct) => "direct shot touch the board first",
        TableKind::One(ShotKind::Bank) => "bank shot do not touch the board first",
        TableKind::Better => "shot are of the other kind",
    };
    (!places.is_empty()).then(|| {
        format!(
            "Nearly the other kind: more than a quarter, up to {:.0} %, of the makes of the {touch} at {}.",
            100.0 * most,
            places.join("; ")
        )
    })
}

/// Where even the best shot seldom goes in.
fn unlikely_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let mut places = Vec::new();
    for (a, angle_rad) in table.angles_rad.iter().enumerate() {
        for (d, distance_m) in table.distances_m.iter().enumerate() {
            let place = Location {
                distance_m: *distance_m,
                angle_rad: *angle_rad,
            };
            let is_unlikely = |shot: &TableShot| shot.probability < UNLIKELY;
            if table.at(a, d).is_some_and(is_unlikely) {
                places.push(place_text(table, &place, units));
            }
        }
    }
    // A jump has two rows.
    places.dedup();
    (!places.is_empty()).then(|| {
        format!(
            "At {} {} even the best shot goes in by luck, with P below {UNLIKELY}: {}.",
            places.len(),
            if places.len() == 1 { "place" } else { "places" },
            places.join("; ")
        )
    })
}

/// P below which a shot is luck.
const UNLIKELY: f64 = 0.1;

/// Where the best shot of the other kind has the higher P.
fn other_kind_note(table: &ShotTable, units: UnitSystem) -> Option<String> {
    let TableKind::One(kind) = table.kind else {
        return None;
    };
    let other = kind.other().name();
    let mut places = Vec::new();
    let mut most: Option<(f64, String)> = None;
    for (a, angle_rad) in table.angles_rad.iter().enumerate() {
        for (d, distance_m) in table.distances_m.iter().enumerate() {
            let place = Location {
                distance_m: *distance_m,
                angle_rad: *angle_rad,
            };
            let Some(shot) = table.at(a, d) else { continue };
            let Some(gain) = shot.other_kind.map(|p| p - shot.probability) else {
                continue;
            };
            if gain <= LEAST_GAIN {
                continue;
            }
            let place = place_text(table, &place, units);
            if most.as_ref().is_none_or(|(greatest, _)| gain > *greatest) {
                most = Some((gain, place.clone()));
            }
            places.push(place);
        }
    }
    let (gain, place) = most?;
    let most = format!("most at {place} (P {gain:.3} higher)");
    if places.len() == table.shots.len() {
        return Some(format!("A {other} shot is better at every place, {most}."));
    }
    // The two rows of a jump are one place.
    places.dedup();
    Some(format!(
        "A {other} shot is better at {} place{}, {most}: {}.",
        places.len(),
        if places.len() == 1 { "" } else { "s" },
        places.join("; "),
    ))
}

/// Least gain in P for which the other kind is named.
const LEAST_GAIN: f64 = 0.005;

/// The table as CSV; empty values where no shot goes in.
#[must_use]
pub fn table_csv(table: &ShotTable, units: UnitSystem) -> String {
    let (long, _) = units.length();
    let columns = columns(table.kind, units);
    let names: Vec<&str> = columns.iter().map(|(name, ..)| name.as_str()).collect();
    let mut text = format!(
        "kind,distance_{long},court_angle_deg,outcome,{}\n",
        names.join(",")
    );
    for TableNode {
        distance,
        angle,
        shot,
        ..
    } in nodes(table, units)
    {
        let cells: Vec<String> = columns
            .iter()
            .map(|(_, _, value, size)| match shot.map(value) {
                Some(value) if value.is_finite() => (value / size).to_string(),
                _ => String::new(),
            })
            .collect();
        text += &format!(
            "{},{distance},{angle},{},{}\n",
            shot.map_or(table.kind.name(), |shot| shot.kind.name()),
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
    let columns = columns(table.kind, units);
    let named = |name: &str, value: Value| (name.to_owned(), value);
    let shots = nodes(table, units).map(|node| {
        let TableNode {
            distance,
            angle,
            is_added,
            shot,
        } = node;
        let mut record = vec![
            named(&format!("distance_{long}"), number(distance)),
            named("court_angle_deg", number(angle)),
            named("kind", shot.map(|shot| shot.kind.name()).into()),
            named("has_shot", shot.is_some().into()),
            named(
                "is_clean_shot",
                shot.is_some_and(|shot| table.is_clean(shot)).into(),
            ),
            named("outcome", shot.map(|shot| shot.outcome.name()).into()),
            named("is_added", is_added.into()),
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
            named("looked_up_probability", number(check.looked_up)),
            named("best_probability", check.best.map_or(Value::Null, number)),
        ])
    });
    let greatest = |value: Option<f64>| value.map_or(Value::Null, number);
    let mut record = provenance(profile.hash());
    record.extend([
        named("shooter", shooter_note(table, profile, units).into()),
        named("physics", physics_note(profile, units).into()),
        named("kind", table.kind.name().into()),
        named("shots", shots.collect()),
        named("checks", checks.collect()),
        named(
            "greatest_loss",
            greatest(table.costliest().map(InterpolationCheck::loss)),
        ),
        named(
            "greatest_error",
            greatest(table.most_wrong().map(|check| check.error().abs())),
        ),
        named("notes", notes(table, units).into()),
    ]);
    object(record)
}
