//! Rows of an answer as CSV: their keys are its columns.

use super::json::in_units;
use crate::files::csv_text::CsvText;
use crate::units::UnitSystem;
use serde::Serialize;
use serde_json::Value;

/// Rows in the units of results. The name of a value within a value has both names, such as
/// `over_draws_low`; what is null or absent is an empty cell.
#[must_use]
pub fn csv<T: Serialize>(rows: &[T], units: UnitSystem) -> String {
    let cells = rows.iter().map(|row| {
        let mut cells = Vec::new();
        add("", &in_units(row, units), &mut cells);
        cells
    });
    let rows: Vec<Vec<(String, String)>> = cells.collect();
    // A row whose inner values are null has fewer cells.
    let header = rows.iter().rev().max_by_key(|cells| cells.len());
    let header: Vec<&str> = header
        .into_iter()
        .flatten()
        .map(|(name, _)| name.as_str())
        .collect();
    let mut table = CsvText::default();
    table.row(&header);
    for cells in &rows {
        table.row(header.iter().map(|name| {
            let cell = cells.iter().find(|(of, _)| of == name);
            cell.map_or("", |(_, text)| text.as_str())
        }));
    }
    String::from_utf8(table.into_bytes()).unwrap_or_default()
}

/// Adds the cells of a value.
fn add(name: &str, value: &Value, cells: &mut Vec<(String, String)>) {
    let text = match value {
        Value::Object(object) => {
            for (inner, value) in object {
                let name = match name {
                    "" => inner.clone(),
                    outer => format!("{outer}_{inner}"),
                };
                add(&name, value, cells);
            }
            return;
        }
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    };
    cells.push((name.to_owned(), text));
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn contract_keys_are_columns_and_null_is_empty() {
        let rows = [
            json!({ "place": "left, far", "speed_m_s": 3.048, "over": null, "ok": true }),
            json!({ "place": "", "speed_m_s": null, "over": { "low": 0.25, "high": 1 }, "ok": false }),
        ];
        assert_eq!(
            csv(&rows, UnitSystem::Imperial),
            "place,speed_ft_s,over_low,over_high,ok\n\"left, far\",10.0,,,true\n,,0.25,1,false\n"
        );
    }
}
