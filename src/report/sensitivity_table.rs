//! The table of the sensitivity, from the rows of `sensitivity.csv`.

use super::html_table::{HtmlTable, format_cell};

/// The table of `sensitivity.csv` (kind, topic, variable, unit, value, gain, standard_error; the
/// header first), the gains in points of P; `None` if the file has no rows.
pub(super) fn sensitivity_table(rows: &[Vec<String>]) -> Option<HtmlTable> {
    let rows: Vec<_> = rows
        .iter()
        .skip(1)
        .filter_map(|row| Some((None, cells(row)?)))
        .collect();
    (!rows.is_empty()).then(|| HtmlTable {
        caption: "Sensitivity".to_owned(),
        columns: [
            "shot",
            "what changes",
            "value",
            "gain, points of P",
            "\u{b1}",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
        note: String::new(),
        is_detail: true,
    })
}

fn cells(row: &[String]) -> Option<Vec<String>> {
    let [kind, topic, variable, unit, value, gain, standard_error] = row else {
        return None;
    };
    let value = value
        .parse::<f64>()
        .map_or(String::new(), |value| format!("{value:.2} {unit}"));
    Some(vec![
        kind.clone(),
        what_changes(topic, variable),
        value,
        points(gain),
        points(standard_error),
    ])
}

fn what_changes(topic: &str, variable: &str) -> String {
    let variable = variable.replace('_', " ");
    match topic {
        "window_low" => format!("window, lowest {variable}"),
        "window_high" => format!("window, highest {variable}"),
        "without" => format!("no error in {variable}"),
        "a_tenth_less" => format!("10 % less error in {variable}"),
        "release_height" => "release height".to_owned(),
        other => other.to_owned(),
    }
}

/// A probability in points; empty if the cell is.
fn points(text: &str) -> String {
    text.parse::<f64>()
        .map_or(String::new(), |value| format_cell(100.0 * value, 1))
}
