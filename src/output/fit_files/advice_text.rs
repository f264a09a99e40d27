//! The answer of `advise`, for people and for programs.

use super::fit_json::interval_json;
use super::fit_text::percent;
use super::parameters::value_units;
use crate::fitting::{Advice, Cause, CauseOfGap, Interval, values_of};
use crate::output::json_object::{number, object};
use crate::shooter::{Location, ShotKind};
use crate::units::{DEGREE_RAD, UnitSystem};
use serde_json::Value;

/// Points of P with their interval: `2.1 points (95 %: 0.4 to 3.9)`.
fn points(interval: &Interval) -> String {
    format!(
        "{:+.1} points (95 %: {:+.1} to {:+.1})",
        100.0 * interval.mean,
        100.0 * interval.low,
        100.0 * interval.high
    )
}

/// A change in a coach's words.
fn change_in_words(
    cause: Cause,
    (from, to): (f64, f64),
    units: UnitSystem,
    court_angle_rad: f64,
) -> String {
    let (unit, size) = value_units(units)[cause.0];
    let (from, to) = if cause.name() == "aim" {
        (from - court_angle_rad, to - court_angle_rad)
    } else {
        (from, to)
    };
    let difference = ((to - from) / size).abs();
    let decimals = if cause.0 == 0 || cause.0 == 3 { 2 } else { 1 };
    let amount = format!("{difference:.decimals$} {unit}");
    match (cause.name(), to > from) {
        ("speed", true) => format!("throw {amount} harder"),
        ("speed", false) => format!("throw {amount} softer"),
        ("pitch", true) => format!("release {amount} steeper"),
        ("pitch", false) => format!("release {amount} flatter"),
        // The polar angle is that of the way back: a greater one points to the shooter's left.
        ("aim", true) => format!("aim {amount} more to the left"),
        ("aim", false) => format!("aim {amount} more to the right"),
        (_, true) => format!("give {amount} more backspin"),
        (_, false) => format!("give {amount} less backspin"),
    }
}

/// What a shooter changes.
fn cause_in_words(cause: Cause) -> &'static str {
    ["the speed", "the release angle", "the aim", "the backspin"][cause.0]
}

/// What a shooter scatters in.
fn scatter_in_words(cause: Cause) -> &'static str {
    ["speed", "release angle", "left and right", "backspin"][cause.0]
}

/// What makes were observed: made and shots.
pub type Observed = Option<(usize, usize)>;

/// The answer for people: three sentences, then the figures.
#[must_use]
pub fn advice_text(
    name: &str,
    advice: &Advice,
    observed: Observed,
    court_angle_rad: f64,
    units: UnitSystem,
) -> String {
    let name = if name.is_empty() { "You" } else { name };
    let p = &advice.usual_probability;
    let seen = observed
        .filter(|(_, shots)| *shots > 0)
        .map_or_else(String::new, |(made, shots)| {
            format!("; {made} of {shots} went in")
        });
    let mut text = format!(
        "{name}: now {:.0} % of such shots go in (95 %: {:.0} to {:.0} %{seen}).\n",
        100.0 * p.mean,
        100.0 * p.low,
        100.0 * p.high
    );
    match &advice.gain {
        Some(gain) if gain.low > 0.0 && gain.mean > 0.005 => {
            // A change of what was not measured is no advice.
            let is_advice = |cause: &&CauseOfGap| {
                cause.gain.low > 0.0
                    && !(cause.cause.name() == "backspin" && advice.backspin_is_assumed)
            };
            let changes: Vec<String> = advice
                .causes
                .iter()
                .map(|cause| change_in_words(cause.cause, cause.values, units, court_angle_rad))
                .collect();
            text += &format!(
                "With the same scatter you can make {:.0} %: {}. {}\n",
                100.0 * (p.mean + gain.mean),
                changes.join(", "),
                match advice.causes.iter().find(is_advice) {
                    Some(first) => format!("Most of it is {}.", cause_in_words(first.cause)),
                    None => "No single one of these is sure to help.".to_owned(),
                }
            );
        }
        Some(gain) if gain.mean > 0.005 => {
            text += &format!(
                "Another release may gain {:.1} points, but these shots cannot tell it from luck: measure more before you change anything.\n",
                100.0 * gain.mean
            );
        }
        Some(_) => text += "Keep your release: no other one is worth a change.\n",
        None => text += "No clean shot of this kind was found from here.\n",
    }
    if let Some(first) = advice.training.first() {
        text += &format!(
            "What to train: {}. 10 % less scatter there gains {:.1} points.\n",
            scatter_in_words(first.cause),
            100.0 * first.gain.mean
        );
    }
    text += &format!(
        "\nP of the usual shot  {} (95 %: {:.1} to {:.1} %, numerics ± {:.2})\n",
        percent(p.mean),
        100.0 * p.low,
        100.0 * p.high,
        100.0 * advice.numerical_standard_error
    );
    if let (Some(best), Some(probability), Some(gain)) =
        (&advice.best, &advice.best_probability, &advice.gain)
    {
        text += &format!(
            "P of the best {} shot  {} (95 %: {:.1} to {:.1} %)\n",
            advice.kind.name(),
            percent(probability.mean),
            100.0 * probability.low,
            100.0 * probability.high
        );
        text += &format!(
            "gain  {}; better in {:.0} % of the draws\n",
            points(gain),
            100.0 * advice.gain_is_positive
        );
        let units_of = value_units(units);
        let row = |title: &str, values: [f64; 4]| {
            let aim = (values[2] - court_angle_rad) / units_of[2].1;
            format!(
                "{title:<11} speed {:.2} {}, pitch {:.1} deg, aim {:+.1} deg, backspin {:.2} rev/s\n",
                values[0] / units_of[0].1,
                units_of[0].0,
                values[1] / units_of[1].1,
                aim,
                values[3] / units_of[3].1
            )
        };
        text += &row("usual shot", advice.usual);
        text += &row("best shot", values_of(&best.nominal));
        text += "\nthe gap by cause (all changes together make the gain)\n";
        for cause in &advice.causes {
            text += &format!(
                "  {:<38} {}\n",
                change_in_words(cause.cause, cause.values, units, court_angle_rad),
                points(&cause.gain)
            );
        }
    }
    if advice.backspin_is_assumed {
        text += &format!(
            "  The backspin was not measured: {:.1} rev/s is assumed.\n",
            advice.usual[3] / value_units(units)[3].1
        );
    }
    text += "\n10 % less scatter\n";
    for training in &advice.training {
        text += &format!(
            "  {:<38} {}\n",
            scatter_in_words(training.cause),
            points(&training.gain)
        );
    }
    if let Some(kinds) = &advice.kinds {
        let [direct, bank] = kinds.probabilities;
        text += &format!(
            "\nbank against direct: {} against {}, {}; bank is better in {:.0} % of the draws\n",
            percent(bank.mean),
            percent(direct.mean),
            points(&kinds.difference),
            100.0 * kinds.bank_is_better
        );
    }
    text
}

/// The answer for programs.
#[must_use]
pub fn advice_json(
    name: &str,
    location: &Location,
    advice: &Advice,
    observed: Observed,
    units: UnitSystem,
) -> Value {
    let units_of = value_units(units);
    let values = |values: [f64; 4]| {
        let named = ["speed", "pitch", "polar", "backspin"]
            .iter()
            .zip(units_of)
            .zip(values);
        object(
            named
                .map(|((name, (unit, size)), value)| {
                    (
                        format!("{name}_{}", unit.replace('/', "_")),
                        number(value / size),
                    )
                })
                .collect(),
        )
    };
    let interval = |value: &Interval| object(interval_json(value));
    let optional = |value: &Option<Interval>| value.as_ref().map_or(Value::Null, interval);
    let named = |name: &str, value: Value| (name.to_owned(), value);
    let kinds = advice.kinds.as_ref().map_or(Value::Null, |kinds| {
        let of = |kind: ShotKind| interval(&kinds.probabilities[kind as usize]);
        object(vec![
            named("direct", of(ShotKind::Direct)),
            named("bank", of(ShotKind::Bank)),
            named("bank_less_direct", interval(&kinds.difference)),
            named("bank_is_better", number(kinds.bank_is_better)),
        ])
    });
    let causes = advice.causes.iter().map(|cause| {
        let mut record = vec![named("cause", cause.cause.name().into())];
        record.extend(interval_json(&cause.gain));
        object(record)
    });
    let training = advice.training.iter().map(|training| {
        let mut record = vec![named("less_scatter_of", training.cause.name().into())];
        record.extend(interval_json(&training.gain));
        object(record)
    });
    let observed = observed.map_or(Value::Null, |(made, shots)| {
        object(vec![
            named("shots", shots.into()),
            named("made", made.into()),
        ])
    });
    let (long, metre) = units.length();
    object(vec![
        named("shooter", name.into()),
        named(
            &format!("distance_{long}"),
            // Converted to SI units and back: without what that cost in the last digits.
            number((location.distance_m / metre * 1e9).round() / 1e9),
        ),
        named("court_angle_deg", number(location.angle_rad / DEGREE_RAD)),
        named("kind", advice.kind.name().into()),
        named("usual", values(advice.usual)),
        named("usual_probability", interval(&advice.usual_probability)),
        named(
            "numerical_standard_error",
            number(advice.numerical_standard_error),
        ),
        named("observed", observed),
        named(
            "best",
            advice
                .best
                .as_ref()
                .map_or(Value::Null, |best| values(values_of(&best.nominal))),
        ),
        named("best_probability", optional(&advice.best_probability)),
        named("gain", optional(&advice.gain)),
        named("gain_is_positive", number(advice.gain_is_positive)),
        named("causes", causes.collect()),
        named("training", training.collect()),
        named("bank_or_direct", kinds),
    ])
}
