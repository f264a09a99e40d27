//! The best shots as JSON, and the record of one shot that JSON and CSV share.

use super::json_object::{Record, number, object, provenance};
use crate::analysis::bank_aim::closed_form_polar_rad;
use crate::analysis::sensitivity::{Difference, Variation};
use crate::best_shot::{BestShot, BestShots, Limit, ShotKind};
use crate::shooter::{NominalVariable, Profile};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem, rounded};
use serde_json::Value;

/// The names of the limits that a shot lies at, such as `max_backspin`, with spaces between them.
pub(super) fn limit_names(shot: &BestShot) -> String {
    let names: Vec<&str> = shot
        .at_limits
        .iter()
        .map(|limit| Limit::name(*limit))
        .collect();
    names.join(" ")
}

/// The record of one best shot.
#[must_use]
pub fn shot_record(profile: &Profile, shot: &BestShot, units: UnitSystem) -> Record {
    let (long, metre) = units.length();
    let (short, short_metre) = units.short_length();
    let nominal = &shot.nominal;
    let estimate = &shot.estimate;
    let outcome = &shot.outcome;
    let board_point = outcome.board_point_m;
    let apex_m = outcome.apex_m + profile.physics().hoop_plane_height_m();
    let optional = |value: Option<f64>| value.map_or(Value::Null, number);
    let named = |name: &str, value: Value| (name.to_owned(), value);
    vec![
        (format!("speed_{long}_s"), number(nominal.speed_m_s / metre)),
        named("pitch_deg", number(nominal.pitch_rad / DEGREE_RAD)),
        named("polar_deg", number(nominal.polar_rad / DEGREE_RAD)),
        named("backspin_rev_s", number(nominal.backspin_rad_s / REV_RAD)),
        named("side_spin_rev_s", number(nominal.side_spin_rad_s / REV_RAD)),
        named("probability", number(estimate.probability)),
        named("standard_error", number(estimate.standard_error)),
        named("shots", estimate.shots.into()),
        named("share_swish", number(estimate.shares.swish)),
        named("share_ring", number(estimate.shares.ring)),
        named("share_board", number(estimate.shares.banked())),
        named("unresolved", estimate.unresolved.into()),
        named("error_free_kind", outcome.kind.name().into()),
        named(
            "error_free_contacts",
            outcome.verdict.contacts.to_string().into(),
        ),
        named(
            "entry_angle_deg",
            optional(outcome.entry.map(|entry| entry.angle_rad / DEGREE_RAD)),
        ),
        (
            format!("aim_past_centre_{short}"),
            optional(shot.aim_past_centre_m.map(|m| m / short_metre)),
        ),
        (
            format!("board_aim_across_{short}"),
            optional(board_point.map(|(_, y, _)| y / short_metre)),
        ),
        (
            format!("board_aim_above_hoop_{short}"),
            optional(board_point.map(|(_, _, z)| z / short_metre)),
        ),
        (format!("apex_above_floor_{long}"), number(apex_m / metre)),
        named("flight_time_s", number(outcome.verdict.time_s)),
        named("mass_outside_bracket", number(shot.mass_outside)),
        named("at_limits", limit_names(shot).into()),
        named(
            "more_probable_not_clean",
            shot.more_probable.map_or(Value::Null, |other| {
                object(vec![
                    named("speed_m_s", number(other.nominal.speed_m_s)),
                    named("pitch_rad", number(other.nominal.pitch_rad)),
                    named("polar_rad", number(other.nominal.polar_rad)),
                    named("backspin_rad_s", number(other.nominal.backspin_rad_s)),
                    named("probability", number(other.probability)),
                ])
            }),
        ),
    ]
}

/// The name of a nominal variable with the suffix of its unit, and the size of the unit in SI
/// units.
pub(super) fn name_with_unit(variable: NominalVariable, units: UnitSystem) -> (String, f64) {
    let (long, metre) = units.length();
    let name = variable.name();
    match variable {
        NominalVariable::Speed => (format!("{name}_{long}_s"), metre),
        NominalVariable::Pitch | NominalVariable::Polar => (format!("{name}_deg"), DEGREE_RAD),
        NominalVariable::Backspin | NominalVariable::SideSpin | NominalVariable::RifleSpin => {
            (format!("{name}_rev_s"), REV_RAD)
        }
    }
}

fn difference_record(difference: &Difference) -> Record {
    vec![
        ("gain".to_owned(), number(difference.value)),
        (
            "standard_error".to_owned(),
            number(difference.standard_error),
        ),
    ]
}

/// The sensitivity of a shot, with units in the names.
fn sensitivity_value(shot: &BestShot, units: UnitSystem) -> Value {
    let (long, metre) = units.length();
    let sensitivity = &shot.sensitivity;
    let windows = sensitivity
        .windows
        .iter()
        .map(|window| {
            let (name, unit) = name_with_unit(window.variable, units);
            let ends = window.ends.map_or(Value::Null, |(low, high)| {
                vec![number(low / unit), number(high / unit)].into()
            });
            (name, ends)
        })
        .collect();
    let errors: Vec<Value> = sensitivity
        .errors
        .iter()
        .map(|cost| {
            object(vec![
                ("variable".to_owned(), cost.variable.name().into()),
                (
                    "without".to_owned(),
                    object(difference_record(&cost.without)),
                ),
                (
                    "a_tenth_less".to_owned(),
                    object(difference_record(&cost.a_tenth_less)),
                ),
            ])
        })
        .collect();
    let variations = |name: &str, unit: f64, variations: &[Variation]| -> Value {
        let records = variations.iter().map(|variation| {
            let mut record = vec![(name.to_owned(), number(variation.value / unit))];
            record.extend(difference_record(&variation.gain));
            object(record)
        });
        records.collect::<Vec<_>>().into()
    };
    let height = format!("release_height_{long}");
    object(vec![
        ("windows".to_owned(), object(windows)),
        ("errors".to_owned(), errors.into()),
        (
            "backspins".to_owned(),
            variations("backspin_rev_s", REV_RAD, &sensitivity.backspins),
        ),
        (
            "heights".to_owned(),
            variations(&height, metre, &sensitivity.heights),
        ),
    ])
}

/// P of the bank shot minus that of the direct shot.
pub(super) fn bank_minus_direct(best: &BestShots) -> Option<Difference> {
    let (Ok(direct), Ok(bank)) = (&best.direct, &best.bank) else {
        return None;
    };
    let (direct, bank) = (&direct.estimate, &bank.estimate);
    Some(Difference {
        value: bank.probability - direct.probability,
        standard_error: libm::hypot(bank.standard_error, direct.standard_error),
    })
}

/// The best shots as one JSON object.
#[must_use]
pub fn best_shots_json(profile: &Profile, best: &BestShots, units: UnitSystem) -> Value {
    let (long, metre) = units.length();
    let location = profile.location();
    let shooter = profile.shooter();
    let mut record = vec![
        ("shooter".to_owned(), shooter.name.clone().into()),
        (
            format!("distance_{long}"),
            number(location.distance_m / metre),
        ),
        (
            "court_angle_deg".to_owned(),
            number(location.angle_rad / DEGREE_RAD),
        ),
        (
            format!("release_height_{long}"),
            number(rounded(shooter.release_height_m / metre)),
        ),
    ];
    for (kind, shot) in best.by_kind() {
        add_kind(
            &mut record,
            profile,
            kind,
            shot.as_ref().map_err(ToString::to_string),
            units,
        );
    }
    if let Some(difference) = bank_minus_direct(best) {
        let value = object(difference_record(&difference));
        record.push(("bank_minus_direct".to_owned(), value));
    }
    record.extend(provenance(profile.hash()));
    record.push(("seed".to_owned(), profile.search().seed.into()));
    record.push(("table_shots".to_owned(), best.plan.shots.into()));
    object(record)
}

fn add_kind(
    record: &mut Record,
    profile: &Profile,
    kind: ShotKind,
    shot: Result<&BestShot, String>,
    units: UnitSystem,
) {
    match shot {
        Ok(shot) => {
            let mut value = shot_record(profile, shot, units);
            if kind == ShotKind::Bank {
                let closed_form = closed_form_polar_rad(profile.physics(), profile.location());
                let closed_form = number(closed_form / DEGREE_RAD);
                value.push(("closed_form_polar_deg".to_owned(), closed_form));
            }
            value.push(("sensitivity".to_owned(), sensitivity_value(shot, units)));
            record.push((kind.name().to_owned(), object(value)));
        }
        Err(reason) => {
            record.push((kind.name().to_owned(), Value::Null));
            record.push((format!("{}_reason", kind.name()), reason.into()));
        }
    }
}
