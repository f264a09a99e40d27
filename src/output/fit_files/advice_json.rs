//! The answer of `advise` for programs.

use super::advice_text::Observed;
use super::fit_json::interval_json;
use super::parameters::value_units;
use crate::fitting::{Advice, AdviceSteps, Interval, Landing, values_of};
use crate::output::json_object::{number, object};
use crate::shooter::{Location, ShotKind};
use crate::units::{DEGREE_RAD, UnitSystem};
use serde_json::Value;

/// The answer of `advise`.
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
    let causes = advice.steps.iter().flat_map(|steps| &steps.steps);
    let causes = causes.map(|step| {
        let mut record = vec![named("cause", step.cause.name().into())];
        record.extend(interval_json(&step.gain));
        record.push(named("support", step.support.name().into()));
        record.push(named("release", values(step.release)));
        object(record)
    });
    let of_steps =
        |get: &dyn Fn(&AdviceSteps) -> Value| advice.steps.as_ref().map_or(Value::Null, get);
    let alone = of_steps(&|steps| {
        steps.alone.as_ref().map_or(Value::Null, |alone| {
            object(vec![
                named("speed", interval(&alone.speed)),
                named("pitch", interval(&alone.pitch)),
                named("speed_is_better", number(alone.speed_is_better)),
            ])
        })
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
    let (short, inch) = units.short_length();
    let landing = |landing: &Landing| {
        object(vec![
            named(
                "entry_angle_deg",
                number(landing.entry_angle_rad / DEGREE_RAD),
            ),
            named(&format!("depth_{short}"), number(landing.depth_m / inch)),
            named(
                &format!("left_right_{short}"),
                number(landing.right_m / inch),
            ),
        ])
    };
    let landings = advice
        .landings
        .as_ref()
        .map_or(Value::Null, |[usual, advised]| {
            object(vec![
                named("usual", landing(usual)),
                named("advised", landing(advised)),
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
        named(
            "advised_probability",
            optional(&Some(advice.advised_probability)),
        ),
        named("gain", optional(&advice.gain)),
        named("gain_is_positive", number(advice.gain_is_positive)),
        named("causes", causes.collect()),
        named("advised", of_steps(&|steps| values(steps.advised))),
        named("advised_gain", of_steps(&|steps| interval(&steps.gain))),
        named("advised_alone", alone),
        named("training", training.collect()),
        named("landings", landings),
        named("bank_or_direct", kinds),
    ])
}
