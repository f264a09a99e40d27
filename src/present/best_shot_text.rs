//! The best shots as text: a table, and their sensitivity in points of P.

use crate::analysis::bank_aim::{closed_form_polar_rad, meeting_behind_board_m};
use crate::analysis::sensitivity::{Difference, ErrorCost, Sensitivity, ShotWindow};
use crate::answers::best_shots::bank_minus_direct;
use crate::best_shot::{BestShot, BestShots, Limit, ShotKind};
use crate::dynamics::OutcomeKind;
use crate::shooter::{NominalVariable, Profile, ReleaseVariable};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};
use comfy_table::{CellAlignment, Table, presets};
use std::fmt::Write;

/// Angles below this are printed as zero, deg.
const ZERO_DEG: f64 = 0.005;

/// The answer in two or three sentences, for a player.
#[must_use]
pub fn answer_in_words(profile: &Profile, best: &BestShots, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let name = &profile.shooter().name;
    let place = format!(
        "{}{}",
        if name.is_empty() {
            String::new()
        } else {
            format!("{name}, ")
        },
        profile.location().in_words(units)
    );
    let mut found: Vec<(ShotKind, &BestShot)> = best
        .by_kind()
        .into_iter()
        .filter_map(|(kind, shot)| Some((kind, shot.as_ref().ok()?)))
        .collect();
    found.sort_by(|a, b| {
        b.1.estimate
            .probability
            .total_cmp(&a.1.estimate.probability)
    });
    // Nobody makes all shots.
    let in_hundred = |shot: &BestShot| match shot.estimate.probability {
        p if p >= 0.995 => "more than 99".to_owned(),
        p => format!("{:.0}", 100.0 * p),
    };
    let Some((kind, shot)) = found.first() else {
        return format!("{place}.\nNo shot from there can be advised:\n");
    };
    let how = match kind {
        ShotKind::Direct => "Shoot it direct",
        ShotKind::Bank => "Bank it",
    };
    let nominal = &shot.nominal;
    let backspin = nominal.backspin_rad_s / REV_RAD;
    let spin = if backspin.abs() < 0.05 {
        "without spin".to_owned()
    } else {
        format!("with {backspin:.1} rev/s of backspin")
    };
    let others: String = found[1..]
        .iter()
        .map(|(kind, shot)| format!(" The best {} shot makes {}.", kind.name(), in_hundred(shot)))
        .collect();
    // A tenth of a metre per second is more than most shooters scatter by.
    let digits = match units {
        UnitSystem::Imperial => 1,
        UnitSystem::Metric => 2,
    };
    let mut text = format!(
        "{place}.\n{how}: {} in 100.{others}\nRelease it at {:.digits$} {long}/s, {:.0} deg up, {spin}.\n",
        in_hundred(shot),
        nominal.speed_m_s / metre,
        nominal.pitch_rad / DEGREE_RAD
    );
    let aim = aim_lines(profile, *kind, shot, units).join(" ");
    match kind {
        _ if aim.is_empty() => {}
        ShotKind::Direct => text += &format!("Aim {aim}.\n"),
        ShotKind::Bank => {
            let across = shot.outcome.board_point_m.map(|(_, across, _)| across);
            let is_aside = across.is_some_and(|m| !is_on_middle_line(m, units));
            let of = if is_aside { " of its middle" } else { "" };
            text += &format!("Aim at {aim}{of}.\n");
        }
    }
    let held: Vec<String> = [
        NominalVariable::Speed,
        NominalVariable::Pitch,
        NominalVariable::Backspin,
    ]
    .into_iter()
    .filter(|variable| !profile.search().choice.includes(*variable))
    .map(|variable| {
        let is_given = variable != NominalVariable::Backspin
            || profile.settings().nominal.backspin_rad_s.is_some();
        let note = if is_given {
            ""
        } else {
            " (0 rev/s, as [nominal] has none)"
        };
        format!("{}{note}", variable.name())
    })
    .collect();
    if !held.is_empty() {
        text += &format!("Given, not searched for: {}.\n", held.join(" and "));
    }
    text
}

/// The table that `best` prints, at most 80 columns wide, with notes below it.
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
        "spin\nrev/s".to_owned(),
        "probability".to_owned(),
        "aim".to_owned(),
    ]);
    let mut notes = Vec::new();
    for (kind, shot) in best.by_kind() {
        match shot {
            Ok(shot) => {
                table.add_row(table_row(profile, kind, shot, units));
                notes.extend(notes_of(profile, kind, shot));
            }
            Err(reason) => notes.push(format!("{}: {reason}.", kind.name())),
        }
    }
    for column in table.column_iter_mut().skip(1).take(5) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut text = String::new();
    if table.row_count() > 0 {
        text += &table.trim_fmt();
        text.push('\n');
    }
    for note in notes {
        text.push_str(&note);
        text.push('\n');
    }
    text
}

fn table_row(profile: &Profile, kind: ShotKind, shot: &BestShot, units: UnitSystem) -> Vec<String> {
    let (_, metre) = units.length();
    let nominal = &shot.nominal;
    let estimate = &shot.estimate;
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
        aim_lines(profile, kind, shot, units).join("\n"),
    ]
}

/// Where a shot is aimed, in short lines: on the board for a bank shot, else relative to the hoop's
/// centre. Nothing for a direct shot whose undisturbed path leads through the board: it goes in off
/// the ring.
fn aim_lines(profile: &Profile, kind: ShotKind, shot: &BestShot, units: UnitSystem) -> Vec<String> {
    let (short, short_metre) = units.short_length();
    match (kind, shot.outcome.board_point_m, shot.aim_past_centre_m) {
        (ShotKind::Bank, Some((_, y, z)), _) => {
            let side = if z < 0.0 { "below" } else { "above" };
            vec![
                format!("the board, {:.1} {short}", z.abs() / short_metre),
                format!("{side} the ring,"),
                across_text(y, units),
            ]
        }
        (_, _, Some(past)) if past < profile.physics().board_distance_m => {
            let side = if past < 0.0 { "short of" } else { "past" };
            vec![
                format!("{:.1} {short} {side}", past.abs() / short_metre),
                "the ring's centre".to_owned(),
            ]
        }
        _ => Vec::new(),
    }
}

/// Whether a point of the board is on its middle line, to the decimal that is printed.
fn is_on_middle_line(across_m: f64, units: UnitSystem) -> bool {
    across_m.abs() / units.short_length().1 < 0.05
}

fn across_text(across_m: f64, units: UnitSystem) -> String {
    if is_on_middle_line(across_m, units) {
        return "on its middle line".to_owned();
    }
    let (unit, size) = units.short_length();
    let side = if across_m > 0.0 { "right" } else { "left" };
    format!("{:.1} {unit} {side}", across_m.abs() / size)
}

/// What matters most for the better kind of shot, in at most ten lines.
#[must_use]
pub fn what_matters(profile: &Profile, best: &BestShots, units: UnitSystem) -> String {
    let found = best.by_kind().into_iter();
    let found = found.filter_map(|(kind, shot)| Some((kind, shot.as_ref().ok()?)));
    let Some((kind, shot)) = found.reduce(|a, b| {
        if b.1.estimate.probability > a.1.estimate.probability {
            b
        } else {
            a
        }
    }) else {
        return String::new();
    };
    let sensitivity = &shot.sensitivity;
    let mut text = format!(
        "what matters for the {} shot (points: makes in 100 shots; ± is numerical)\n",
        kind.name()
    );
    let mut line = |label: &str, words: String| {
        // Writing to a String does not fail.
        let _ = writeln!(text, "  {label:<14} {words}");
    };
    let matters = |(place, cost): &(usize, &ErrorCost)| {
        *place < ALWAYS_TOLD || cost.without.value > LEAST_GAIN_TOLD
    };
    let told = sensitivity.errors.iter().take(MOST_ERRORS).enumerate();
    for (_, cost) in told.filter(matters) {
        let name = ReleaseVariable::name(cost.variable).replace('_', " ");
        line(
            &name,
            format!(
                "perfect {}; 10 % steadier {}",
                points(&cost.without),
                points(&cost.a_tenth_less)
            ),
        );
    }
    if let Some(gain) = sensitivity.backspin_gain() {
        line("backspin", format!("{} over no backspin", points(&gain)));
    }
    let own_m = profile.shooter().release_height_m;
    let mut heights = sensitivity.heights.iter();
    if let Some(height) = heights.rfind(|height| height.value > own_m) {
        let (long, metre) = units.length();
        let by = (height.value - own_m) / metre;
        line(
            "height",
            format!("{} if released {by:.2} {long} higher", points(&height.gain)),
        );
    }
    line(
        "range made",
        format!("{}, one at a time", windows_text(shot, units)),
    );
    if let Some(difference) = bank_minus_direct(best) {
        line("compared", comparison_text(&difference));
    }
    text
}

/// Errors that are worth a line: the first ones, and one more that costs something, in P.
const MOST_ERRORS: usize = 3;
const ALWAYS_TOLD: usize = 2;
const LEAST_GAIN_TOLD: f64 = 0.005;

/// Says that there is no air; empty where there is.
#[must_use]
pub fn vacuum_note(profile: &Profile) -> &'static str {
    if profile.physics().air.density_kg_m3 > 0.0 {
        ""
    } else {
        "The ball flies without air. For a ball in play: --physics ncaa, or preset = \"ncaa\" in [physics].\n"
    }
}

/// What P leaves out.
pub const PROFILE_IS_EXACT: &str =
    "P assumes an exact profile; `bankshot fit` says how sure a measured one is.\n";

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
    if let Some(other) = &shot.more_probable {
        notes.push(format!(
            "{kind}: a release that misses without errors makes more: {:.1} in 100 with {}.",
            100.0 * other.probability,
            other.in_words()
        ));
    }
    let of_other_kind = shot.share_of_other_kind(kind_of_shot);
    if of_other_kind > 0.5 {
        let touch = match kind_of_shot {
            ShotKind::Direct => "touch the board first",
            ShotKind::Bank => "do not touch the board first",
        };
        notes.push(format!(
            "{kind}: nearly a {} shot; {:.0} % of its makes {touch}.",
            kind_of_shot.other().name(),
            100.0 * of_other_kind
        ));
    }
    let off = match shot.outcome.kind {
        OutcomeKind::RimIn => Some("off the ring"),
        OutcomeKind::BankRimIn => Some("off the board and the ring"),
        _ => None,
    };
    if let Some(off) = off {
        notes.push(format!("{kind}: goes in {off} even without an error."));
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
    let error = 100.0 * gain.standard_error;
    // Enough digits that the error is not zero.
    let decimals = if error < 0.05 { 2 } else { 1 };
    let least = if error < 0.05 { 0.005 } else { 0.05 };
    let value = if value.abs() < least { 0.0 } else { value };
    format!("{value:+.decimals$} ± {error:.decimals$}")
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
        let _ = writeln!(text, "  made over a range of {}", windows_text(shot, units));
        let shares = &shot.estimate.shares;
        let entry = shot.outcome.entry.map_or_else(String::new, |entry| {
            format!("; enters at {:.1} deg", entry.angle_rad / DEGREE_RAD)
        });
        let _ = writeln!(
            text,
            "  goes in      swish {:.2}, ring {:.2}, board {:.2}{entry}",
            shares.swish,
            shares.ring,
            shares.banked()
        );
        if kind == ShotKind::Bank {
            add_bank_aim(&mut text, profile, shot, units);
        }
        add_errors(&mut text, &sensitivity.errors);
        if let Some(gain) = sensitivity.backspin_gain() {
            let verdict = if gain.is_surely_positive() {
                ""
            } else {
                " (not a sure gain)"
            };
            let _ = writeln!(text, "  backspin     {} over none{verdict}", points(&gain));
        }
        add_heights(&mut text, profile, sensitivity, units);
    }
    text
}

/// The aim beside the closed form of the paper, and the point behind the board that it passes.
fn add_bank_aim(text: &mut String, profile: &Profile, shot: &BestShot, units: UnitSystem) {
    let (short, metre) = units.short_length();
    let (physics, location) = (profile.physics(), profile.location());
    let _ = writeln!(
        text,
        "  aim          polar {:.2} deg; the closed form (Eq. 27) {:.2} deg",
        shot.nominal.polar_rad / DEGREE_RAD,
        closed_form_polar_rad(physics, location) / DEGREE_RAD
    );
    if let Some(behind_m) = meeting_behind_board_m(physics, location, shot.nominal.polar_rad) {
        let _ = writeln!(
            text,
            "               at a point {:.1} {short} behind the board, on its middle line",
            behind_m / metre
        );
    }
}

/// How far each value may be off, to both sides.
fn windows_text(shot: &BestShot, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let text = |window: &ShotWindow| {
        let name = window.variable.name();
        let (unit, size, decimals) = match window.variable {
            NominalVariable::Speed => (format!("{long}/s"), metre, 2),
            _ => ("deg".to_owned(), DEGREE_RAD, 1),
        };
        let own = shot.nominal.get(window.variable);
        match window.ends {
            None => format!("{name} none"),
            Some((low, high)) => format!(
                "{name} {:+.decimals$} to {:+.decimals$} {unit}",
                (low - own) / size,
                (high - own) / size
            ),
        }
    };
    let windows: Vec<String> = shot.sensitivity.windows.iter().map(text).collect();
    windows.join(", ")
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

/// What other release heights are worth, with the same pitch angle and the speed found anew.
fn add_heights(text: &mut String, profile: &Profile, sensitivity: &Sensitivity, units: UnitSystem) {
    let (long, metre) = units.length();
    for (i, height) in sensitivity.heights.iter().enumerate() {
        let by = height.value - profile.shooter().release_height_m;
        let label = if i == 0 { "height" } else { "" };
        let _ = writeln!(
            text,
            "  {label:12} {:+.2} {long}    {}",
            by / metre,
            points(&height.gain)
        );
    }
}

fn comparison_text(bank_minus_direct: &Difference) -> String {
    let (better, worse) = if bank_minus_direct.value >= 0.0 {
        ("bank", "direct")
    } else {
        ("direct", "bank")
    };
    format!(
        "{better} beats {worse} by {}",
        points(&Difference {
            value: bank_minus_direct.value.abs(),
            ..*bank_minus_direct
        })
        .trim_start_matches('+')
    )
}
