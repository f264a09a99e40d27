//! `schema`: the JSON schema of profiles and sweeps.

use super::support::{Answer, bankshot};
use serde_json::Value;
use std::fs;

fn shipped_file(path: &str) -> String {
    format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn contract_the_stored_schema_is_that_of_the_program() {
    let stored = fs::read_to_string(shipped_file("docs/bankshot.schema.json")).unwrap();
    let printed = Answer::of(bankshot().arg("schema")).exits(0).stdout;
    let printed = String::from_utf8(printed).unwrap();
    assert!(
        stored == printed,
        "run: bankshot schema > docs/bankshot.schema.json"
    );
}

/// The shipped files have no key that the schema does not know, and no value of another type.
#[test]
fn contract_the_shipped_files_follow_the_schema() {
    let schema: Value = serde_json::from_str(
        &fs::read_to_string(shipped_file("docs/bankshot.schema.json")).unwrap(),
    )
    .unwrap();
    let mut seen = 0;
    for entry in fs::read_dir(shipped_file("configs")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "toml") {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let table: toml::Table = text.parse().unwrap();
        let value = serde_json::to_value(table).unwrap();
        follows(&value, &schema, &path.display().to_string());
        seen += 1;
    }
    assert!(seen > 10);
}

/// Whether a value follows a schema of the sort that the program writes.
fn follows(value: &Value, schema: &Value, place: &str) {
    if let Some(words) = schema.get("enum") {
        assert!(
            words.as_array().unwrap().contains(value),
            "{place}: {value}"
        );
        return;
    }
    let of = match value {
        Value::Object(_) => "object",
        Value::Array(_) => "array",
        Value::String(_) => "string",
        Value::Bool(_) => "boolean",
        Value::Number(number) if number.is_f64() => "number",
        _ => "integer",
    };
    let allowed = match &schema["type"] {
        Value::String(one) => vec![one.as_str()],
        several => {
            let several = several.as_array().unwrap();
            several.iter().map(|name| name.as_str().unwrap()).collect()
        }
    };
    let is_allowed = allowed.contains(&of) || of == "integer" && allowed.contains(&"number");
    assert!(is_allowed, "{place}: {value} is no {allowed:?}");
    match value {
        Value::Object(table) => {
            for (key, value) in table {
                let place = format!("{place}: {key}");
                let known = schema["properties"].get(key);
                let known = known.or_else(|| {
                    schema["additionalProperties"]
                        .as_object()
                        .map(|_| &schema["additionalProperties"])
                });
                follows(
                    value,
                    known.unwrap_or_else(|| panic!("{place}: not in the schema")),
                    &place,
                );
            }
        }
        Value::Array(values) => {
            for value in values {
                follows(value, &schema["items"], place);
            }
        }
        _ => {}
    }
}
