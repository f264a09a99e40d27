//! A table of best shots as CSV and JSON.

use super::columns::{TableNode, columns, nodes};
use super::notes::{notes, physics_note, shooter_note};
use crate::best_shot::{InterpolationCheck, ShotTable};
use crate::present::json_object::{number, object, provenance};
use crate::shooter::Profile;
use crate::units::{DEGREE_RAD, UnitSystem, rounded};
use serde_json::Value;

/// The table as CSV; empty values where no shot goes in.
#[must_use]
pub fn table_csv(table: &ShotTable, units: UnitSystem) -> String {
    let (long, _) = units.length();
    let columns = columns(table.kind, units);
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
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
            .map(|column| match shot.map(|shot| column.of(shot)) {
                Some(value) if value.is_finite() => rounded(value).to_string(),
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
        record.extend(columns.iter().map(|column| {
            let value = shot.map_or(Value::Null, |shot| number(column.of(shot)));
            (column.name.clone(), value)
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
        named("notes", notes(table, profile, units).into()),
    ]);
    object(record)
}
