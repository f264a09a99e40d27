//! The description of the server's interface, from its types.

use super::folder::Content;
use super::jobs::{Job, JobRequest};
use super::questions::ProfileText;
use super::refusal::Refusal;
use super::results::SweepState;
use crate::answers::requests::Request;
use crate::answers::shot_file::{ShotFileAnswer, ShotFileRequest};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json};

/// A request and its answer: the method, the path, what it is for, and the types of both.
struct Operation {
    method: &'static str,
    path: &'static str,
    summary: &'static str,
    body: Option<Value>,
    answer: Value,
}

fn json_of(schema: Value) -> Value {
    json!({ "application/json": { "schema": schema } })
}

fn document() -> Value {
    let mut generator: SchemaGenerator = SchemaSettings::openapi3().into_generator();
    fn of<T: JsonSchema>(generator: &mut SchemaGenerator) -> Value {
        generator.subschema_for::<T>().to_value()
    }
    let anything = json!({ "type": "object" });
    let jobs = json!({ "type": "array", "items": of::<Job>(&mut generator) });
    let lines = "One JSON object a line: {\"draft\": answer} as soon as something is known, then \
        {\"answer\": answer, \"notes\": [text]}, or {\"stopped\": true} where a newer question of the \
        same x-page ended this one. The answers are those of `--json`: \
        answers.imperial.schema.json and answers.metric.schema.json.";
    let ndjson =
        json!({ "application/x-ndjson": { "schema": { "type": "string", "description": lines } } });
    let operations = [
        Operation {
            method: "get",
            path: "/api/start",
            summary: "The courts, the hoops and the places with a name",
            body: None,
            answer: json_of(anything.clone()),
        },
        Operation {
            method: "post",
            path: "/api/answer",
            summary: "A question about a profile; with the header x-page a newer question ends the older one",
            body: Some(of::<Request>(&mut generator)),
            answer: ndjson,
        },
        Operation {
            method: "post",
            path: "/api/profile",
            summary: "The text of a profile with other values",
            body: Some(of::<ProfileText>(&mut generator)),
            answer: json_of(
                json!({ "type": "object", "properties": { "toml": { "type": "string" } } }),
            ),
        },
        Operation {
            method: "get",
            path: "/api/folder",
            summary: "What is in the folder of the results",
            body: None,
            answer: json_of(of::<Content>(&mut generator)),
        },
        Operation {
            method: "get",
            path: "/api/fits/{name}",
            summary: "A fit (fit.json), the profile of each of its places, and its advice",
            body: None,
            answer: json_of(anything.clone()),
        },
        Operation {
            method: "get",
            path: "/api/sweeps/{name}",
            summary: "A sweep with the results so far",
            body: None,
            answer: json_of(of::<SweepState>(&mut generator)),
        },
        Operation {
            method: "put",
            path: "/api/uploads/{name}",
            summary: "Keep a file of measured shots, at most 64 MiB",
            body: Some(json!({ "type": "string", "format": "binary" })),
            answer: json_of(anything),
        },
        Operation {
            method: "post",
            path: "/api/uploads/{name}",
            summary: "What a file of measured shots holds",
            body: Some(of::<ShotFileRequest>(&mut generator)),
            answer: json_of(of::<ShotFileAnswer>(&mut generator)),
        },
        Operation {
            method: "get",
            path: "/api/jobs",
            summary: "The jobs of this start",
            body: None,
            answer: json_of(jobs.clone()),
        },
        Operation {
            method: "post",
            path: "/api/jobs",
            summary: "Add a job behind the others",
            body: Some(of::<JobRequest>(&mut generator)),
            answer: json_of(of::<Job>(&mut generator)),
        },
        Operation {
            method: "delete",
            path: "/api/jobs/{id}",
            summary: "Stop a job; what it has finished stays",
            body: None,
            answer: Value::Null,
        },
        Operation {
            method: "get",
            path: "/api/events",
            summary: "The jobs, again with each change, as server-sent events",
            body: None,
            answer: json!({ "text/event-stream": { "schema": jobs } }),
        },
        Operation {
            method: "get",
            path: "/files/{name}",
            summary: "A file of the folder",
            body: None,
            answer: json!({ "*/*": { "schema": { "type": "string", "format": "binary" } } }),
        },
    ];
    let refusal = of::<Refusal>(&mut generator);
    let mut paths = Map::new();
    for operation in operations {
        let mut entry = json!({
            "summary": operation.summary,
            "responses": {
                "400": { "description": "what is wrong, and at which field", "content": json_of(refusal.clone()) },
                "403": { "description": "without the token, or from another page" },
            },
        });
        match operation.answer {
            Value::Null => entry["responses"]["204"] = json!({ "description": "done" }),
            content => {
                entry["responses"]["200"] =
                    json!({ "description": operation.summary, "content": content });
            }
        }
        if let Some(schema) = operation.body {
            let kind = if operation.method == "put" {
                "application/octet-stream"
            } else {
                "application/json"
            };
            entry["requestBody"] =
                json!({ "required": true, "content": { kind: { "schema": schema } } });
        }
        if let Some((_, rest)) = operation.path.split_once('{') {
            let name = rest.trim_end_matches('}');
            entry["parameters"] = json!([{ "name": name, "in": "path", "required": true, "schema": { "type": "string" } }]);
        }
        paths.entry(operation.path).or_insert_with(|| json!({}))[operation.method] = entry;
    }
    json!({
        "openapi": "3.1.0",
        "info": {
            "title": "bankshot studio",
            "version": env!("CARGO_PKG_VERSION"),
            "description": "The interface that the page of `bankshot studio` uses. Each request needs the token of the start: \
                in the cookie of the page, or as `Authorization: Bearer TOKEN`.",
        },
        "paths": paths,
        "components": {
            "schemas": generator.take_definitions(true),
            "securitySchemes": { "token": { "type": "http", "scheme": "bearer" } },
        },
        "security": [{ "token": [] }],
    })
}

/// The committed description is that of the types. `BANKSHOT_SCHEMAS=1` writes it.
#[test]
fn contract_the_committed_description_is_that_of_the_interface() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/studio.openapi.json");
    let text = format!("{:#}\n", document());
    if std::env::var_os("BANKSHOT_SCHEMAS").is_some() {
        std::fs::write(file, &text).unwrap();
    }
    let committed = std::fs::read_to_string(file).unwrap();
    assert!(
        committed == text,
        "{file} is old: run this test with BANKSHOT_SCHEMAS=1"
    );
}
