//! JSON as rows of cells: lists of objects, one object a line, and trials with tracked points.

use serde_json::{Map, Value};

/// The cells of a file, the names of the columns first.
type Cells = Vec<Vec<String>>;

/// The rows of a JSON text.
///
/// # Errors
/// It is no JSON, or has no list of objects.
pub(super) fn json_rows(text: &str) -> Result<Cells, String> {
    let objects = objects(&without_nan(text))?;
    if objects.iter().any(|object| object.contains_key("moments")) {
        return Ok(moments(&objects));
    }
    let mut names: Vec<String> = Vec::new();
    let mut rows: Vec<Vec<(usize, String)>> = Vec::new();
    for object in &objects {
        let mut cells = Vec::new();
        flatten("", object, &mut cells);
        let row = cells.into_iter().map(|(name, value)| {
            let known = names.iter().position(|known| *known == name);
            let index = known.unwrap_or_else(|| {
                names.push(name);
                names.len() - 1
            });
            (index, value)
        });
        rows.push(row.collect());
    }
    let width = names.len();
    let filled = rows.into_iter().map(|row| {
        let mut cells = vec![String::new(); width];
        for (index, value) in row {
            cells[index] = value;
        }
        cells
    });
    let filled: Cells = filled.collect();
    Ok(std::iter::once(names).chain(filled).collect())
}

/// NaN and infinities, which some programs write and JSON does not have, as null.
fn without_nan(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut is_in_text = false;
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        if !is_in_text {
            let word = ["NaN", "-Infinity", "Infinity"]
                .into_iter()
                .find(|word| rest.starts_with(word));
            if let Some(word) = word {
                out.push_str("null");
                rest = &rest[word.len()..];
                continue;
            }
        }
        if is_in_text && c == '\\' {
            let end = rest.char_indices().nth(2).map_or(rest.len(), |(at, _)| at);
            out.push_str(&rest[..end]);
            rest = &rest[end..];
            continue;
        }
        is_in_text ^= c == '"';
        out.push(c);
        rest = &rest[c.len_utf8()..];
    }
    out
}

/// The objects of a text: of a list, of a list within an object, or one a line.
fn objects(text: &str) -> Result<Vec<Map<String, Value>>, String> {
    let values: Result<Vec<Value>, _> = serde_json::Deserializer::from_str(text)
        .into_iter()
        .collect();
    let values = values.map_err(|error| format!("is no JSON: {error}"))?;
    let list = match values.len() {
        1 => values.into_iter().next().unwrap_or_default(),
        _ => Value::Array(values),
    };
    let of_list = |list: Vec<Value>| -> Vec<Map<String, Value>> {
        let objects = list.into_iter().filter_map(|value| match value {
            Value::Object(object) => Some(object),
            _ => None,
        });
        objects.collect()
    };
    let found = match list {
        Value::Array(list) => of_list(list),
        Value::Object(mut object) if object.contains_key("tracking") => {
            object.remove("tracking");
            vec![object]
        }
        Value::Object(mut object) => {
            let key = object.iter().find_map(|(key, value)| {
                let is_list = value
                    .as_array()
                    .is_some_and(|list| list.first().is_some_and(Value::is_object));
                is_list.then(|| key.clone())
            });
            match key.and_then(|key| object.remove(&key)) {
                Some(Value::Array(list)) => of_list(list),
                _ => vec![object],
            }
        }
        _ => Vec::new(),
    };
    let found: Vec<_> = found
        .into_iter()
        .map(|mut object| {
            object.remove("tracking");
            object
        })
        .collect();
    match found.is_empty() {
        true => Err("is JSON without a list of objects; one object a shot is read".to_owned()),
        false => Ok(found),
    }
}

/// The values of an object; those within it have its name before theirs.
fn flatten(before: &str, object: &Map<String, Value>, cells: &mut Vec<(String, String)>) {
    for (key, value) in object {
        let name = match before {
            "" => key.clone(),
            before => format!("{before}_{key}"),
        };
        match value {
            Value::Object(inner) => flatten(&name, inner, cells),
            Value::Array(_) => {}
            value => cells.push((name, cell(value))),
        }
    }
}

fn cell(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Null => String::new(),
        value => value.to_string(),
    }
}

/// The team and the player of the ball in the moments of arena cameras.
const BALL: f64 = -1.0;

/// The ball in the moments of arena cameras (SportVU): an event is a shot, its clock in ms.
fn moments(events: &[Map<String, Value>]) -> Cells {
    let mut rows = vec![
        ["shot", "time_ms", "x_ft", "y_ft", "z_ft"]
            .map(str::to_owned)
            .to_vec(),
    ];
    for (number, event) in events.iter().enumerate() {
        let id = event
            .get("eventId")
            .map_or_else(|| (number + 1).to_string(), cell);
        let mut last = String::new();
        let moments = event.get("moments").and_then(Value::as_array);
        for moment in moments.into_iter().flatten() {
            let time = moment.get(1).map_or(String::new(), cell);
            let objects = moment.get(5).and_then(Value::as_array);
            let ball = objects
                .into_iter()
                .flatten()
                .find(|object| object.get(0).and_then(Value::as_f64) == Some(BALL));
            let Some(ball) = ball.filter(|_| time != last) else {
                continue;
            };
            let at = |index: usize| ball.get(index).map_or(String::new(), cell);
            rows.push(vec![id.clone(), time.clone(), at(2), at(3), at(4)]);
            last = time;
        }
    }
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_objects_become_rows() {
        let expected: Cells = [["a", "b_c"], ["1", "x"], ["2.5", ""]]
            .map(|row| row.map(str::to_owned).to_vec())
            .to_vec();
        for text in [
            r#"[{"a": 1, "b": {"c": "x"}}, {"a": 2.5, "b": {"c": NaN}}]"#,
            r#"{"team": "W", "shots": [{"a": 1, "b": {"c": "x"}}, {"a": 2.5}]}"#,
            "{\"a\": 1, \"b\": {\"c\": \"x\"}}\n{\"a\": 2.5}\n",
        ] {
            assert_eq!(json_rows(text).unwrap(), expected, "{text}");
        }
        let kept = json_rows(r#"[{"a": "NaN \" Infinity"}]"#).unwrap();
        assert_eq!(kept[1][0], "NaN \" Infinity");
        assert!(json_rows("[1, 2]").is_err());
        assert!(json_rows("{\"a\": ").unwrap_err().contains("is no JSON"));
    }

    #[test]
    fn contract_moments_have_the_ball_once_a_frame() {
        let text = r#"{"gameid": "1", "events": [{"eventId": "7", "moments": [
            [1, 1451350000000, 700.0, 12.0, null, [[-1, -1, 20.0, 25.5, 8.0], [5, 9, 1, 2, 0]]],
            [1, 1451350000000, 700.0, 12.0, null, [[-1, -1, 20.0, 25.5, 8.0]]],
            [1, 1451350000040, 699.9, 12.0, null, [[-1, -1, 20.6, 25.5, 8.9]]]]}]}"#;
        let rows = json_rows(text).unwrap();
        assert_eq!(rows.len(), 3);
        assert_eq!(rows[2], ["7", "1451350000040", "20.6", "25.5", "8.9"]);
    }
}
