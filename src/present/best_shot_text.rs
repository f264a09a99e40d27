//! The best shots as text.

use super::layout::{Side, TextAnswer, TextTable};
use super::words::{
    capitalised, difference_per_100, do_it, likely, list, nominal_name, of_100, per_100,
    scatter_note, simulation_error, subject, taken_as_exact, variable_name, with_commas,
};
use crate::analysis::bank_aim::{closed_form_polar_rad, meeting_behind_board_m};
use crate::analysis::sensitivity::{Difference, ErrorCost, ShotWindow};
use crate::answers::best_shots::bank_minus_direct;
use crate::best_shot::{BestShot, BestShots, Limit, ShotKind};
use crate::dynamics::OutcomeKind;
use crate::fitting::Interval;
use crate::shooter::{NominalVariable, Profile};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// The probability of each best shot over the draws of a fit.
#[derive(Clone, Debug, Default)]
pub struct KindsOverDraws {
    /// The kinds that have a best shot.
    pub probabilities: Vec<(ShotKind, Interval)>,
    /// The probability that bank is better, where both kinds have a best shot.
    pub bank_is_better: Option<f64>,
}

impl KindsOverDraws {
    fn of(&self, kind: ShotKind) -> Option<&Interval> {
        let mut kinds = self.probabilities.iter();
        kinds.find(|(of, _)| *of == kind).map(|(_, p)| p)
    }
}

/// The best shots in text. `scatter` are the changes of the scatter, as they were typed.
#[must_use]
pub fn best_shots_text(
    profile: &Profile,
    best: &BestShots,
    over_draws: Option<&KindsOverDraws>,
    scatter: &[String],
) -> TextAnswer {
    let units = profile.output().units;
    let p = |kind: ShotKind, shot: &BestShot| {
        let over_draws = over_draws.and_then(|draws| draws.of(kind));
        over_draws.map_or(shot.estimate.probability, |p| p.mean)
    };
    let mut found = found(best);
    found.sort_by(|a, b| p(b.0, b.1).total_cmp(&p(a.0, a.1)));
    let reasons = best.by_kind().into_iter();
    let reasons = reasons.filter_map(|(_, shot)| {
        let reason = shot.as_ref().err()?;
        Some(capitalised(&format!("{reason}.")))
    });
    let Some((kind, shot)) = found.first().copied() else {
        return TextAnswer {
            answer: vec!["No shot goes in from there.".to_owned()],
            subject: subject(profile, units),
            notes: reasons.collect(),
            ..TextAnswer::default()
        };
    };
    let other = found.get(1).map_or_else(String::new, |(kind, shot)| {
        let makes = of_100(p(*kind, shot));
        format!(" The best {} shot makes {makes}.", kind.name())
    });
    let mut answer = vec![format!(
        "{}: {} of 100 go in.{other}",
        do_it(kind),
        of_100(p(kind, shot))
    )];
    answer.extend(certainty(kind, over_draws));
    let mut notes: Vec<String> = training(shot).into_iter().collect();
    notes.extend(what_limits(profile, &found));
    notes.extend(reasons);
    notes.extend(
        found
            .iter()
            .filter_map(|(kind, shot)| not_exact(*kind, shot, units)),
    );
    notes.extend(scatter_note(scatter));
    notes.push(what_is_left_out(profile, &found, over_draws.is_some()));
    TextAnswer {
        answer,
        subject: subject(profile, units),
        table: Some(table(profile, &found, over_draws)),
        notes,
        details: details(profile, best, units),
        ..TextAnswer::default()
    }
}

/// The kinds that have a best shot.
fn found(best: &BestShots) -> Vec<(ShotKind, &BestShot)> {
    let kinds = best.by_kind().into_iter();
    kinds
        .filter_map(|(kind, shot)| Some((kind, shot.as_ref().ok()?)))
        .collect()
}

/// How certain the answer is by the measured shots.
fn certainty(kind: ShotKind, over_draws: Option<&KindsOverDraws>) -> Option<String> {
    let p = over_draws?.of(kind)?;
    let better = over_draws?.bank_is_better.map(|bank| match kind {
        ShotKind::Bank => bank,
        ShotKind::Direct => 1.0 - bank,
    });
    let better = better.map_or_else(String::new, |share| {
        let other = kind.other().name();
        format!(
            "; the probability that it beats {other} is {}",
            likely(share)
        )
    });
    Some(format!(
        "95 % interval {:.0} to {:.0}, from the measured shots{better}.",
        100.0 * p.low,
        100.0 * p.high
    ))
}

fn table(
    profile: &Profile,
    found: &[(ShotKind, &BestShot)],
    over_draws: Option<&KindsOverDraws>,
) -> TextTable {
    let units = profile.output().units;
    let (long, metre) = units.length();
    let speed_unit = format!("{long}/s");
    let mut columns = vec![
        ("", "", Side::Left),
        ("speed", speed_unit.as_str(), Side::Right),
        ("angle", "deg", Side::Right),
        ("spin", "rev/s", Side::Right),
        ("aim", "", Side::Left),
        ("makes", "per 100", Side::Right),
    ];
    if over_draws.is_some() {
        columns.push(("95 %", "interval", Side::Left));
    }
    let mut table = TextTable::new(&columns);
    for (kind, shot) in found {
        let nominal = &shot.nominal;
        let of_draws = over_draws.and_then(|draws| draws.of(*kind));
        let makes = of_draws.map_or(shot.estimate.probability, |p| p.mean);
        let mut cells = vec![
            kind.name().to_owned(),
            format!("{:.*}", speed_decimals(units), nominal.speed_m_s / metre),
            format!("{:.1}", nominal.pitch_rad / DEGREE_RAD),
            format!("{:.1}", nominal.backspin_rad_s / REV_RAD + 0.0),
            aim_lines(profile, *kind, shot, units).join("\n"),
            per_100(makes),
        ];
        cells.extend(of_draws.map(|p| format!("{} to {}", per_100(p.low), per_100(p.high))));
        table.add(cells);
    }
    table
}

/// A hundredth of a metre per second is less than any shooter scatters by.
fn speed_decimals(units: UnitSystem) -> usize {
    match units {
        UnitSystem::Imperial => 1,
        UnitSystem::Metric => 2,
    }
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
                format!(
                    "board: {:.0} {short} {side} the ring,",
                    z.abs() / short_metre
                ),
                across_text(y, units),
            ]
        }
        (_, _, Some(past)) if past < profile.physics().board_distance_m => {
            let side = if past < 0.0 { "short of" } else { "past" };
            let distance = past.abs() / short_metre;
            match distance < 0.5 {
                true => vec!["the ring's centre".to_owned()],
                false => vec![format!("{distance:.0} {short} {side} the ring's centre")],
            }
        }
        _ => Vec::new(),
    }
}

fn across_text(across_m: f64, units: UnitSystem) -> String {
    let (unit, size) = units.short_length();
    let across = across_m.abs() / size;
    let side = if across_m > 0.0 { "right" } else { "left" };
    match across < 0.5 {
        true => "on its middle line".to_owned(),
        false => format!("{across:.0} {unit} {side} of its middle"),
    }
}

/// Gains below this are not worth a word.
const LEAST_GAIN: f64 = 0.0005;

/// What less scatter adds, the greatest gain first.
fn training(shot: &BestShot) -> Option<String> {
    /// As many as a player can train.
    const MOST: usize = 3;
    let errors = shot.sensitivity.errors.iter();
    let worth = errors.filter(|cost| cost.a_tenth_less.value >= LEAST_GAIN);
    let gains: Vec<String> = worth
        .take(MOST)
        .map(|cost| {
            let gain = per_100(cost.a_tenth_less.value);
            format!("{} {gain}", variable_name(cost.variable))
        })
        .collect();
    (!gains.is_empty()).then(|| {
        format!(
            "Makes per 100 gained by 10 % less scatter: {}.",
            gains.join(", ")
        )
    })
}

/// What was fixed, and which limits of the profile the best shots lie at.
fn what_limits(profile: &Profile, found: &[(ShotKind, &BestShot)]) -> Vec<String> {
    let mut notes = Vec::new();
    let (_, shot) = found[0];
    let spin = profile.shooter().max_backspin_rad_s / REV_RAD;
    let uses_all = |limit| {
        found
            .iter()
            .all(|(_, shot)| shot.at_limits.contains(&limit))
    };
    let without = shot
        .sensitivity
        .backspin_gain()
        .filter(|gain| gain.value > 0.01);
    if let Some(gain) = without {
        let p = shot.estimate.probability - gain.value;
        notes.push(format!(
            "Backspin matters: without backspin the {} shot makes {}.{}",
            found[0].0.name(),
            of_100(p),
            match shot.at_limits.contains(&Limit::MaxBackspin) {
                true =>
                    format!(" Backspin above your max_backspin, {spin:.1} rev/s, was not tried."),
                false => String::new(),
            }
        ));
    } else if uses_all(Limit::MaxBackspin) {
        notes.push(format!(
            "{} the most backspin of the profile (max_backspin, {spin:.1} rev/s).",
            match found.len() {
                1 => "The shot uses",
                _ => "Both kinds use",
            }
        ));
    }
    for (kind, shot) in found {
        let limits = shot.at_limits.iter().filter_map(|limit| limit_text(*limit));
        notes.extend(limits.map(|words| format!("The {} shot {words}.", kind.name())));
    }
    let fixed: Vec<String> = [
        NominalVariable::Speed,
        NominalVariable::Pitch,
        NominalVariable::Backspin,
    ]
    .into_iter()
    .filter(|variable| !profile.search().choice.includes(*variable))
    .map(|variable| format!("the {}", nominal_name(variable)))
    .collect();
    if !fixed.is_empty() {
        notes.push(format!("Fixed by the profile or a flag: {}.", list(&fixed)));
    }
    notes
}

/// A limit of the profile that can change the decision.
fn limit_text(limit: Limit) -> Option<&'static str> {
    match limit {
        Limit::PitchMin => Some("has the lowest angle allowed (pitch_min)"),
        Limit::PitchMax => Some("has the highest angle allowed (pitch_max)"),
        Limit::SpeedMax => Some("has the highest speed allowed (speed_max)"),
        Limit::MaxSideSpin => Some("has the most side spin allowed (max_side_spin)"),
        Limit::NoBackspin | Limit::MaxBackspin => None,
    }
}

/// A release that goes in more often, though an exact shot with it misses.
fn not_exact(kind: ShotKind, shot: &BestShot, units: UnitSystem) -> Option<String> {
    let other = shot.more_probable.as_ref()?;
    let (long, metre) = units.length();
    Some(format!(
        "The most probable {} release, {:.2} {long}/s at {:.1} deg, makes {} of 100, although an exact shot with it misses.",
        kind.name(),
        other.nominal.speed_m_s / metre,
        other.nominal.pitch_rad / DEGREE_RAD,
        per_100(other.probability)
    ))
}

/// What the numbers leave out.
fn what_is_left_out(profile: &Profile, found: &[(ShotKind, &BestShot)], has_draws: bool) -> String {
    let errors = found.iter().map(|(_, shot)| shot.estimate.standard_error);
    let error = errors.fold(0.0, f64::max);
    let missed = match error > profile.search().standard_error {
        true => " (more than was asked for)",
        false => "",
    };
    format!(
        "{} Simulation error: {} per 100{missed}.",
        taken_as_exact(has_draws),
        simulation_error(error)
    )
}

/// What is known of each kind, for those who ask.
fn details(profile: &Profile, best: &BestShots, units: UnitSystem) -> String {
    let mut text = String::new();
    for (kind, shot) in found(best) {
        let mut line = |label: &str, words: String| {
            text += &format!("  {label:<14} {words}\n");
        };
        let estimate = &shot.estimate;
        line(
            kind.name(),
            format!(
                "{} per 100, simulation error {}, {} shots",
                per_100(estimate.probability),
                simulation_error(estimate.standard_error),
                estimate.shots
            ),
        );
        line(
            "polar angle",
            format!("{:.2} deg", shot.nominal.polar_rad / DEGREE_RAD + 0.0),
        );
        line("error-free", error_free(shot));
        let shares = &estimate.shares;
        line(
            "goes in",
            format!(
                "swish {}, off the ring {}, off the board {} per 100",
                per_100(shares.swish),
                per_100(shares.ring),
                per_100(shares.banked())
            ),
        );
        line(
            "tolerance",
            format!(
                "{} (one value off, the others exact)",
                tolerance(shot, units)
            ),
        );
        for cost in &shot.sensitivity.errors {
            line(variable_name(cost.variable), scatter_gain(cost));
        }
        if let Some(gain) = shot.sensitivity.backspin_gain() {
            line(
                "backspin",
                format!("{} compared with none", gain_text(&gain)),
            );
        }
        let (long, metre) = units.length();
        for height in &shot.sensitivity.heights {
            let by = (height.value - profile.shooter().release_height_m) / metre;
            line(
                "height",
                format!("{by:+.2} {long}: {}", gain_text(&height.gain)),
            );
        }
        if kind == ShotKind::Bank {
            line("reflection", reflection(profile, shot, units));
        }
        if shot.share_of_other_kind(kind) > 0.5 {
            line(
                "kind",
                format!(
                    "{:.0} % of the shots that go in are {} shots",
                    100.0 * shot.share_of_other_kind(kind),
                    kind.other().name()
                ),
            );
        }
        let nominal = &shot.nominal;
        if nominal.side_spin_rad_s != 0.0 || nominal.rifle_spin_rad_s != 0.0 {
            line(
                "other spin",
                format!(
                    "side spin {:.2} rev/s, rifle spin {:.2} rev/s",
                    nominal.side_spin_rad_s / REV_RAD,
                    nominal.rifle_spin_rad_s / REV_RAD
                ),
            );
        }
    }
    if let Some(difference) = bank_minus_direct(best) {
        text += &format!("  {:<14} {}\n", "bank - direct", gain_text(&difference));
    }
    text += &format!(
        "{} shots were simulated.\n",
        with_commas(profile.simulator().simulated_shots())
    );
    text + "  Gains are per 100 shots, with the simulation error in brackets.\n"
}

/// How the shot without errors goes in.
fn error_free(shot: &BestShot) -> String {
    let how = match shot.outcome.kind {
        OutcomeKind::Swish => "swish",
        OutcomeKind::RimIn => "rim, then in",
        OutcomeKind::BankIn => "board, then in",
        OutcomeKind::BankRimIn => "board, rim, in",
        _ => "misses",
    };
    let entry = shot.outcome.entry.map_or_else(String::new, |entry| {
        format!("; entry angle {:.1} deg", entry.angle_rad / DEGREE_RAD)
    });
    format!("{how}{entry}")
}

fn scatter_gain(cost: &ErrorCost) -> String {
    format!(
        "{} with 10 % less scatter, {} with none",
        gain_text(&cost.a_tenth_less),
        gain_text(&cost.without)
    )
}

/// A gain per 100 with its simulation error.
fn gain_text(gain: &Difference) -> String {
    format!(
        "{} ({})",
        difference_per_100(gain.value),
        simulation_error(gain.standard_error)
    )
}

/// The aim beside the closed form of the paper, and the point behind the board that it passes.
fn reflection(profile: &Profile, shot: &BestShot, units: UnitSystem) -> String {
    let (short, metre) = units.short_length();
    let (physics, location) = (profile.physics(), profile.location());
    let closed_deg = closed_form_polar_rad(physics, location) / DEGREE_RAD;
    let behind = meeting_behind_board_m(physics, location, shot.nominal.polar_rad);
    let behind = behind.map_or_else(String::new, |behind_m| {
        format!(
            "; aimed at a point {:.1} {short} behind the board",
            behind_m / metre
        )
    });
    format!("polar angle by the law of reflection (Eq. 27) {closed_deg:.2} deg{behind}")
}

/// How far each value may be off, to both sides.
fn tolerance(shot: &BestShot, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let text = |window: &ShotWindow| {
        let name = nominal_name(window.variable);
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
