//! The best shots at several pitch angles: for people, as CSV and JSON.

use super::notes::{physics_note, speed_limit_in_words};
use super::table_text::{both_sides, decimal, line, wrapped};
use crate::best_shot::{ShotAtPitch, TableKind, TableShot};
use crate::shooter::{NominalVariable, Profile};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// A loss of P that the sentence about the angles counts as none.
const LEVEL: f64 = 0.01;

/// Name, unit and width of the columns after the pitch angle.
fn titles(speed_unit: &str, kind: TableKind) -> Vec<(&str, &str, usize)> {
    let other_kind = match kind {
        TableKind::One(kind) => kind.other().name(),
        TableKind::Better => "other",
    };
    let mut titles = vec![
        ("speed", speed_unit, 6),
        ("aim", "deg", 6),
        ("spin", "rev/s", 5),
        ("entry", "deg", 5),
        ("P", "", 6),
        ("less", "", 6),
        (other_kind, "P", 6),
        ("margin", speed_unit, 10),
        ("margin", "deg", 8),
    ];
    if kind == TableKind::Better {
        titles.push(("kind", "", 6));
    }
    titles
}

/// The kind in a sentence, with a space after it.
pub(super) fn kind_before_shot(kind: TableKind) -> String {
    match kind {
        TableKind::One(kind) => format!("{} ", kind.name()),
        TableKind::Better => String::new(),
    }
}

/// The shots with their angles, those that exist.
fn found(rows: &[ShotAtPitch]) -> impl Iterator<Item = (f64, &TableShot)> {
    rows.iter()
        .filter_map(|row| Some((row.pitch_rad, row.shot.as_ref()?)))
}

/// The row with the highest P.
fn best_row(rows: &[ShotAtPitch]) -> Option<(usize, &TableShot)> {
    let shots = rows.iter().enumerate();
    shots
        .filter_map(|(i, row)| Some((i, row.shot.as_ref()?)))
        .max_by(|a, b| a.1.probability.total_cmp(&b.1.probability))
}

/// The shots for people, at most 80 columns wide: what the angle is worth, then a line for each.
#[must_use]
pub fn by_pitch_text(
    rows: &[ShotAtPitch],
    kind: TableKind,
    profile: &Profile,
    units: UnitSystem,
) -> String {
    let (long, metre) = units.length();
    let name = &profile.shooter().name;
    let of = if name.is_empty() {
        String::new()
    } else {
        format!("{name}, ")
    };
    let mut text = wrapped(&format!("{of}{}.", profile.location().in_words(units)));
    let Some((best_row, best)) = best_row(rows) else {
        let most = rows.iter().map(ShotAtPitch::probability);
        let most = most.fold(0.0, f64::max);
        let words = if most > 0.0 {
            format!(
                "No clean shot at these pitch angles: the most probable ones, P up to {most:.3}, miss without errors."
            )
        } else {
            "No shot at these pitch angles goes in.".to_owned()
        };
        text += &wrapped(&words);
        for row in rows {
            text += &row_without_shot(row, profile, units);
        }
        return text;
    };
    text += &wrapped(&in_words(rows, (best_row, best), kind, units));
    text += &at_speed_limit_in_words(rows, profile);
    text += &other_kind_in_words(rows, best, kind);
    text += &wrapped(&physics_note(profile, units));
    let spin = if profile.search().choice.includes(NominalVariable::Backspin) {
        "the speed, the aim and the spin are the best ones (--backspin keeps one)"
    } else {
        "the speed and the aim are the best ones, and the spin is the given one"
    };
    text += &wrapped(&format!(
        "At each pitch angle {spin}; the errors are taken to be the same at all angles. aim: positive to the left. entry: \
         -, if it meets the ring on its way up. less: than the highest P. margin: by how much speed \
         and pitch can be off, down and up, one at a time and with all else exact, until the shot \
         first misses.",
    ));
    let speed_unit = format!("{long}/s");
    let titles = titles(&speed_unit, kind);
    let widths: Vec<usize> = std::iter::once(5)
        .chain(titles.iter().map(|(.., width)| *width))
        .collect();
    let names = std::iter::once("pitch").chain(titles.iter().map(|(name, ..)| *name));
    text += &line(names, &widths);
    let unit_names = std::iter::once("deg").chain(titles.iter().map(|(_, unit, _)| *unit));
    text += &line(unit_names, &widths);
    for row in rows {
        let Some(shot) = &row.shot else {
            text += &row_without_shot(row, profile, units);
            continue;
        };
        let pitch = decimal(row.pitch_rad / DEGREE_RAD, 1);
        let [speed_sides, pitch_sides] = shot.tolerances;
        let mut cells = vec![
            pitch,
            decimal(shot.nominal.speed_m_s / metre, 3),
            decimal(shot.aim_rad / DEGREE_RAD, 2),
            decimal(shot.nominal.backspin_rad_s / REV_RAD, 2),
            decimal(shot.entry_rad.map_or(f64::NAN, |rad| rad / DEGREE_RAD), 1),
            decimal(shot.probability, 4),
            decimal(best.probability - shot.probability, 4),
            decimal(shot.other_kind.unwrap_or(f64::NAN), 3),
            both_sides(speed_sides.map(|side| side / metre), 2),
            both_sides(pitch_sides.map(|side| side / DEGREE_RAD), 1),
        ];
        if kind == TableKind::Better {
            cells.push(shot.kind.name().to_owned());
        }
        text += &line(cells.iter().map(String::as_str), &widths);
    }
    let error = found(rows).map(|(_, shot)| shot.standard_error);
    let error = error.fold(0.0, f64::max);
    let other = match kind {
        TableKind::One(kind) => format!("the {} shot", kind.other().name()),
        TableKind::Better => "the other kind (other)".to_owned(),
    };
    text + &wrapped(&format!(
        "P has a numerical standard error of at most {error:.4}; P of {other} at that angle is from a short search.",
    ))
}

/// The line of a pitch angle without a clean shot.
fn row_without_shot(row: &ShotAtPitch, profile: &Profile, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let pitch = decimal(row.pitch_rad / DEGREE_RAD, 1);
    match row.not_clean {
        Some(shot) => format!(
            "{pitch:>5} no clean shot; most probable: {:.2} {long}/s, P {:.3}, a miss without errors\n",
            shot.nominal.speed_m_s / metre,
            shot.probability
        ),
        None => format!(
            "{pitch:>5} no shot within the limits{} goes in\n",
            speed_limit_in_words(profile, units)
        ),
    }
}

/// That the other kind makes more than the best of these, if it does.
fn other_kind_in_words(rows: &[ShotAtPitch], best: &TableShot, kind: TableKind) -> String {
    let TableKind::One(kind) = kind else {
        return String::new();
    };
    let others = found(rows).filter_map(|(_, shot)| shot.other_kind);
    let most = others.fold(0.0, f64::max);
    if most <= best.probability + LEVEL {
        return String::new();
    }
    wrapped(&format!(
        "At some of these angles the {} shot makes up to {:.0} of 100: --kind best takes the better one.",
        kind.other().name(),
        100.0 * most
    ))
}

/// At which angles the speed is the greatest one of the profile; empty where at none.
fn at_speed_limit_in_words(rows: &[ShotAtPitch], profile: &Profile) -> String {
    let Some(most_m_s) = profile.search().speed_max_m_s else {
        return String::new();
    };
    let at_limit = found(rows).filter(|(_, shot)| shot.nominal.speed_m_s > (1.0 - 1e-6) * most_m_s);
    let angles: Vec<String> = at_limit
        .map(|(rad, _)| {
            decimal(rad / DEGREE_RAD, 1)
                .trim_end_matches(".0")
                .to_owned()
        })
        .collect();
    if angles.is_empty() {
        return String::new();
    }
    wrapped(&format!(
        "At {} deg the speed is speed_max of the profile: a faster launcher makes more there.",
        angles.join(", ")
    ))
}

/// How much the angle matters, in two sentences.
fn in_words(
    rows: &[ShotAtPitch],
    (best_row, best): (usize, &TableShot),
    kind: TableKind,
    units: UnitSystem,
) -> String {
    let (long, metre) = units.length();
    let best_rad = rows[best_row].pitch_rad;
    let degrees = |rad: f64| {
        let text = format!("{:.1}", rad / DEGREE_RAD);
        text.trim_end_matches(".0").to_owned()
    };
    let is_level = |row: &ShotAtPitch| {
        row.shot
            .as_ref()
            .is_some_and(|shot| best.probability - shot.probability <= LEVEL)
    };
    // The angles around the best one without a gap.
    let low = (0..best_row)
        .rev()
        .take_while(|&i| is_level(&rows[i]))
        .last();
    let high = (best_row + 1..rows.len())
        .take_while(|&i| is_level(&rows[i]))
        .last();
    let (low, high) = (low.unwrap_or(best_row), high.unwrap_or(best_row));
    let mut text = format!(
        "The best {}shot of these makes {:.1} of 100, at {} deg.",
        kind_before_shot(kind),
        100.0 * best.probability,
        degrees(best_rad)
    );
    let is_at_end = best_row + 1 == rows.len() || best_row == 0;
    if is_at_end && rows.len() > 1 {
        text += " That is the end of the list: angles beyond, where the profile allows them, may be better (--pitches).";
    }
    if low < high {
        text += &format!(
            " From {} to {} deg the best speed of each makes at most one of 100 less.",
            degrees(rows[low].pitch_rad),
            degrees(rows[high].pitch_rad)
        );
    }
    let slowest =
        found(rows).min_by(|a, b| a.1.nominal.speed_m_s.total_cmp(&b.1.nominal.speed_m_s));
    if let Some((slowest_rad, slowest)) = slowest {
        text += &format!(
            " The least speed of these, {:.2} {long}/s, is that of {} deg",
            slowest.nominal.speed_m_s / metre,
            degrees(slowest_rad)
        );
        let steeper = best_rad - slowest_rad;
        text += &match steeper {
            _ if steeper > 1e-9 => format!(": the best is {} deg steeper.", degrees(steeper)),
            _ if steeper < -1e-9 => format!(": the best is {} deg flatter.", degrees(-steeper)),
            _ => ".".to_owned(),
        };
    }
    text
}
