//! The JSON schemas of all answers, one file for each system of units.

use super::json::{Answer, in_results};
use super::{
    advice, along_variable, best_shots, checks, fit, physics, probability, sample_size, sessions,
    shot_file, swarm, sweep_status, table_rows, trace,
};
use crate::store::sealed::FORMAT_VERSION;
use crate::units::UnitSystem;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value, json};

/// Adds the schema of an answer.
fn add<A: Answer + JsonSchema>(
    all: &mut Vec<Value>,
    defs: &mut Map<String, Value>,
    units: UnitSystem,
) {
    let settings = SchemaSettings::draft2020_12().for_serialize();
    let mut generator = settings.into_generator();
    let mut schema = A::json_schema(&mut generator).to_value();
    let mut inner: Map<String, Value> = generator.take_definitions(true);
    if !A::IS_SI {
        rename(&mut schema, units);
        inner.values_mut().for_each(|value| rename(value, units));
    }
    let name = json!({ "const": A::NAME });
    let version = json!({ "const": FORMAT_VERSION });
    if let Some(properties) = schema["properties"].as_object_mut() {
        properties.insert("answer".to_owned(), name);
        properties.insert("format_version".to_owned(), version);
    }
    if let Some(required) = schema["required"].as_array_mut() {
        required.extend(["answer", "format_version"].map(Value::from));
    }
    schema["title"] = A::NAME.into();
    // An answer in SI units has the names of no other.
    defs.extend(inner);
    defs.insert(A::NAME.to_owned(), schema);
    all.push(json!({ "$ref": format!("#/$defs/{}", A::NAME) }));
}

/// Gives the keys of a schema the units of results.
fn rename(schema: &mut Value, units: UnitSystem) {
    let renamed = |name: &str| in_results(name, units).map_or(name.to_owned(), |(name, _)| name);
    match schema {
        Value::Array(list) => list.iter_mut().for_each(|value| rename(value, units)),
        Value::Object(object) => {
            for (key, value) in object.iter_mut() {
                match (key.as_str(), &mut *value) {
                    ("properties", Value::Object(properties)) => {
                        let all = std::mem::take(properties).into_iter();
                        *properties = all.map(|(name, value)| (renamed(&name), value)).collect();
                    }
                    ("required", Value::Array(names)) => {
                        for name in names {
                            *name = renamed(name.as_str().unwrap_or_default()).into();
                        }
                    }
                    _ => {}
                }
                rename(value, units);
            }
        }
        _ => {}
    }
}

/// The schema of what `--json` prints: one of the answers.
fn schema(units: UnitSystem) -> Value {
    let (mut all, mut defs) = (Vec::new(), Map::new());
    add::<best_shots::BestShotsAnswer>(&mut all, &mut defs, units);
    add::<best_shots::BestShotsDraft>(&mut all, &mut defs, units);
    add::<swarm::SwarmAnswer>(&mut all, &mut defs, units);
    add::<shot_file::ShotFileAnswer>(&mut all, &mut defs, units);
    add::<probability::ProbabilityAnswer>(&mut all, &mut defs, units);
    add::<along_variable::AlongAnswer>(&mut all, &mut defs, units);
    add::<table_rows::PitchCurveAnswer>(&mut all, &mut defs, units);
    add::<table_rows::TableAnswer>(&mut all, &mut defs, units);
    add::<physics::PhysicsRows>(&mut all, &mut defs, units);
    add::<trace::TraceAnswer>(&mut all, &mut defs, units);
    add::<fit::FitAnswer>(&mut all, &mut defs, units);
    add::<advice::AdviceAnswer>(&mut all, &mut defs, units);
    add::<sessions::SessionsAnswer>(&mut all, &mut defs, units);
    add::<sample_size::SampleSizeAnswer>(&mut all, &mut defs, units);
    add::<checks::CheckAnswer>(&mut all, &mut defs, units);
    add::<checks::PlanAnswer>(&mut all, &mut defs, units);
    add::<checks::SweepPlanAnswer>(&mut all, &mut defs, units);
    add::<sweep_status::StatusAnswer>(&mut all, &mut defs, units);
    add::<sweep_status::VerifyAnswer>(&mut all, &mut defs, units);
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Answers of bankshot",
        "oneOf": all,
        "$defs": defs,
    })
}

/// The committed schemas are those of the types. `BANKSHOT_SCHEMAS=1` writes them.
#[test]
fn contract_the_committed_schemas_are_those_of_the_answers() {
    for (units, name) in [
        (UnitSystem::Imperial, "imperial"),
        (UnitSystem::Metric, "metric"),
    ] {
        let file = format!(
            "{}/docs/answers.{name}.schema.json",
            env!("CARGO_MANIFEST_DIR")
        );
        let text = format!("{:#}\n", schema(units));
        if std::env::var_os("BANKSHOT_SCHEMAS").is_some() {
            std::fs::write(&file, &text).unwrap();
        }
        let committed = std::fs::read_to_string(&file).unwrap();
        assert!(
            committed == text,
            "{file} is old: run this test with BANKSHOT_SCHEMAS=1"
        );
    }
}
