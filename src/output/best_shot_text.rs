//! The best shots as text: a table, and their sensitivity in points of P.

use super::best_shot_json::bank_minus_direct;
use crate::analysis::sensitivity::{Difference, ErrorCost, Sensitivity, ShotWindow};
use crate::best_shot::{BestShot, BestShots, Limit, ShotKind};
use crate::shooter::{NominalVariable, Profile, ReleaseVariable};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};
use comfy_table::{CellAlignment, Table, presets};
use std::fmt::Write;

/// Angles below this are printed as zero, deg.
const ZERO_DEG: f64 = 0.005;

/// The table that `best` prints, with notes below it.
#[must_use]
pub fn best_shots_table(profile: &Profile, best: &BestShots, units: UnitSystem) -> String {
    let (long, _) = units.length();
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(vec![
        "shot".to_owned(),
        format!("speed\n{long}/s"),
        "pitch\ndeg".to_owned(),
        "polar\ndeg".to_owned(),
        "backspin\nrev/s".to_owned(),
        "probability".to_owned(),
        "swish / ring\n/ board".to_owned(),
        "entry\ndeg".to_owned(),
        "aim".to_owned(),
    ]);
    let mut notes = Vec::new();
    for (kind, shot) in best.by_kind() {
        match shot {
            Ok(shot) => {
                table.add_row(table_row(kind, shot, units));
                notes.extend(notes_of(profile, kind, shot));
            }
            Err(reason) => notes.push(format!("{}: {reason}.", kind.name())),
        }
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut text = table.trim_fmt();
    text.push('\n');
    for note in notes {
        text.push_str(&note);
        text.push('\n');
    }
    text
}

fn table_row(kind: ShotKind, shot: &BestShot, units: UnitSystem) -> Vec<String> {
    let (_, metre) = units.length();
    let nominal = &shot.nominal;
    let estimate = &shot.estimate;
    let shares = &estimate.shares;
    let polar_deg = nominal.polar_rad / DEGREE_RAD;
    let polar_deg = if polar_deg.abs() < ZERO_DEG {
        0.0
    } else {
        polar_deg
    };
    vec![
        kind.name().to_owned(),
        format!("{:.2}", nominal.speed_m_s / metre),
        format!("{:.1}", nominal.pitch_rad / DEGREE_RAD),
        format!("{polar_deg:.2}"),
        format!("{:.1}", nominal.backspin_rad_s / REV_RAD),
        format!(
            "{:.4} ± {:.4}",
            estimate.probability, estimate.standard_error
        ),
        format!(
            "{:.2} / {:.2} / {:.2}",
            shares.swish,
            shares.ring,
            shares.banked()
        ),
        shot.outcome.entry.map_or_else(String::new, |entry| {
            format!("{:.1}", entry.angle_rad / DEGREE_RAD)
        }),
        aim_text(kind, shot, units),
    ]
}

/// Where a shot is aimed: on the board for a bank shot, else relative to the hoop's centre.
fn aim_text(kind: ShotKind, shot: &BestShot, units: UnitSystem) -> String {
    let (short, short_metre) = units.short_length();
    match (kind, shot.outcome.board_point_m, shot.aim_past_centre_m) {
        (ShotKind::Bank, Some((_, y, z)), _) => {
            let side = if z < 0.0 { "below" } else { "above" };
            format!(
                "board, {:.1} {short} {side} ring,\n{}",
                z.abs() / short_metre,
                across_text(y / short_metre, short)
            )
        }
        (_, _, Some(past)) => {
            let side = if past < 0.0 { "short of" } else { "past" };
            format!("{:.1} {short} {side} centre", past.abs() / short_metre)
        }
        _ => String::new(),
    }
}

fn across_text(across: f64, unit: &str) -> String {
    if across.abs() < 0.05 {
        return "on its middle line".to_owned();
    }
    let side = if across > 0.0 { "right" } else { "left" };
    format!("{:.1} {unit} to the {side}, facing the board", across.abs())
}

/// What the table does not show of a shot.
fn notes_of(profile: &Profile, kind_of_shot: ShotKind, shot: &BestShot) -> Vec<String> {
    let mut notes = Vec::new();
    let kind = kind_of_shot.name();
    let nominal = &shot.nominal;
    if nominal.side_spin_rad_s != 0.0 || nominal.rifle_spin_rad_s != 0.0 {
        notes.push(format!(
            "{kind}: with a side spin of {:.2} rev/s and a rifle spin of {:.2} rev/s.",
            nominal.side_spin_rad_s / REV_RAD,
            nominal.rifle_spin_rad_s / REV_RAD
        ));
    }
    for limit in &shot.at_limits {
        notes.push(format!("{kind}: {}.", limit_text(*limit)));
    }
    let probability = shot.estimate.probability;
    let banked = shot.estimate.shares.banked() / probability.max(f64::MIN_POSITIVE);
    let of_other_kind = match kind_of_shot {
        ShotKind::Direct => banked,
        ShotKind::Bank => 1.0 - banked,
    };
    if of_other_kind > 0.5 {
        let touch = match kind_of_shot {
            ShotKind::Direct => "touch the board first",
            ShotKind::Bank => "do not touch the board first",
        };
        notes.push(format!(
            "{kind}: at the limit of its kind; {:.0} % of its makes {touch}.",
            100.0 * of_other_kind
        ));
    }
    if shot.estimate.standard_error > profile.search().standard_error {
        notes.push(format!(
            "{kind}: the wanted standard error was not reached."
        ));
    }
    notes
}

/// A limit that a shot lies at, with its key.
fn limit_text(limit: Limit) -> &'static str {
    match limit {
        Limit::PitchMin => "uses the lowest pitch angle allowed (pitch_min)",
        Limit::PitchMax => "uses the highest pitch angle allowed (pitch_max)",
        Limit::NoBackspin => "uses no backspin",
        Limit::MaxBackspin => "uses all the backspin allowed (max_backspin)",
        Limit::MaxSideSpin => "uses all the side spin allowed (max_side_spin)",
        Limit::SpeedMax => "uses all the speed allowed (speed_max)",
    }
}

/// A gain in points of P with its standard error.
fn points(gain: &Difference) -> String {
    let value = 100.0 * gain.value;
    // Do not print a negative zero.
    let value = if value.abs() < 0.05 { 0.0 } else { value };
    format!("{value:+.1} ± {:.1}", 100.0 * gain.standard_error)
}

/// The sensitivity of the best shots as text.
#[must_use]
pub fn sensitivity_text(profile: &Profile, best: &BestShots, units: UnitSystem) -> String {
    let mut text = String::new();
    for (kind, shot) in best.by_kind() {
        let Ok(shot) = shot else { continue };
        let sensitivity = &shot.sensitivity;
        // Writing to a String does not fail, here and below.
        let _ = writeln!(text, "{}, gains in points of P (0.01):", kind.name());
        let _ = writeln!(
            text,
            "  made over a range of {}",
            windows_text(sensitivity, units)
        );
        add_errors(&mut text, &sensitivity.errors);
        if let Some(gain) = sensitivity.backspin_gain() {
            let verdict = if gain.is_surely_positive() {
                ""
            } else {
                " (not a sure gain)"
            };
            let _ = writeln!(text, "  backspin     {} over none{verdict}", points(&gain));
        }
        let _ = writeln!(
            text,
            "  height       {} (same pitch, speed re-optimised)",
            heights_text(profile, sensitivity, units)
        );
    }
    if let Some(difference) = bank_minus_direct(best) {
        let _ = writeln!(text, "{}", comparison_text(&difference));
    }
    text
}

fn windows_text(sensitivity: &Sensitivity, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let width = |window: &ShotWindow| match window.variable {
        NominalVariable::Speed => format!("speed {:.2} {long}/s", window.width() / metre),
        variable => format!("{} {:.1} deg", variable.name(), window.width() / DEGREE_RAD),
    };
    let widths: Vec<String> = sensitivity.windows.iter().map(width).collect();
    format!("{}, one at a time", widths.join(", "))
}

fn add_errors(text: &mut String, errors: &[ErrorCost]) {
    for (i, cost) in errors.iter().enumerate() {
        let label = if i == 0 { "perfect" } else { "" };
        let name = ReleaseVariable::name(cost.variable).replace('_', " ");
        let _ = writeln!(
            text,
            "  {label:12} {name:11} {}; 10 % steadier: {}",
            points(&cost.without),
            points(&cost.a_tenth_less)
        );
    }
}

fn heights_text(profile: &Profile, sensitivity: &Sensitivity, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let heights: Vec<String> = sensitivity
        .heights
        .iter()
        .map(|height| {
            let by = height.value - profile.shooter().release_height_m;
            format!("{:+.2} {long} {}", by / metre, points(&height.gain))
        })
        .collect();
    heights.join(", ")
}

fn comparison_text(bank_minus_direct: &Difference) -> String {
    let (better, worse) = if bank_minus_direct.value >= 0.0 {
        ("bank", "direct")
    } else {
        ("direct", "bank")
    };
    format!(
        "{better} beats {worse} by {:.1} ± {:.1} points",
        100.0 * bank_minus_direct.value.abs(),
        100.0 * bank_minus_direct.standard_error
    )
}
