//! The trace of a shot as text.

use crate::dynamics::{Ending, EventKind, Outcome, OutcomeKind, Trace};
use crate::units::{DEGREE_RAD, UnitSystem};
use std::fmt::Write;

/// The outcome of a shot as text.
pub(crate) fn outcome_text(outcome: &Outcome) -> &'static str {
    if outcome.verdict.ending == Ending::TimeLimit {
        return "misses: still in play at the time limit";
    }
    match outcome.kind {
        OutcomeKind::Swish => "goes in, a swish",
        OutcomeKind::RimIn => "goes in off the ring",
        OutcomeKind::BankIn => "goes in off the board",
        OutcomeKind::BankRimIn => "goes in off board and ring",
        OutcomeKind::InAndOut => "misses: in and out",
        OutcomeKind::Short => "misses: short",
        OutcomeKind::Long => "misses: long",
        OutcomeKind::Wide => "misses: wide",
        OutcomeKind::OverBoard => "misses: behind the board",
        OutcomeKind::Lodged => "misses: lodged between ring and board",
        OutcomeKind::Airball => "misses: touches nothing",
        OutcomeKind::Unresolved => "has no result: the simulation gave up",
    }
}

/// The outcome and the events of a shot as text.
pub(crate) fn trace_text(trace: &Trace, units: UnitSystem) -> String {
    let (long, metre) = units.length();
    let outcome = &trace.outcome;
    let mut text = String::new();
    // Writing to a String does not fail.
    let _ = writeln!(
        text,
        "The shot {}, after {:.3} s. The ball's centre rises to {:.2} {long} above the ring.",
        outcome_text(outcome),
        outcome.verdict.time_s,
        outcome.apex_m / metre
    );
    if let Some(entry) = outcome.entry {
        let (x, y) = entry.offset_m;
        let (short, inch) = units.short_length();
        let _ = writeln!(
            text,
            "The ball last comes down through the ring's plane at {:.1} deg, {:.1} {short} from the centre (x {:+.1}, y {:+.1}).",
            entry.angle_rad / DEGREE_RAD,
            (x * x + y * y).sqrt() / inch,
            x / inch,
            y / inch
        );
    }
    let _ = writeln!(
        text,
        "\nFrom the hoop's centre: x onto the court, y to the shooter's right, z up.\n   time s  event                      x, y, z {long}               speed {long}/s"
    );
    for event in &trace.events {
        let [x, y, z] = event.state.position_m.into();
        let [vx, vy, vz]: [f64; 3] = event.state.velocity_m_s.into();
        let name = match event.kind {
            EventKind::Release => "release".to_owned(),
            EventKind::Touch(solid) => format!("touches the {}", solid.name()),
            EventKind::Part {
                solid, duration_s, ..
            } => format!(
                "leaves the {} ({:.1} ms)",
                solid.name(),
                1000.0 * duration_s
            ),
            EventKind::End => ending_text(outcome.verdict.ending).to_owned(),
        };
        let _ = writeln!(
            text,
            "{:9.4}  {name:26} {:7.3} {:7.3} {:7.3}   {:7.2}",
            event.time_s,
            x / metre,
            y / metre,
            z / metre,
            (vx * vx + vy * vy + vz * vz).sqrt() / metre
        );
    }
    text
}

fn ending_text(ending: Ending) -> &'static str {
    match ending {
        Ending::Fell => "below the ring",
        Ending::NeverRose => "never reached the ring",
        Ending::BehindBoard => "behind the board",
        Ending::Lodged => "at rest on both",
        Ending::TimeLimit => "time limit",
        Ending::Unresolved => "gave up",
    }
}
