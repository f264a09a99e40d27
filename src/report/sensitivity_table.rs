//! The table of what the best shots depend on.

use super::html_table::{HtmlTable, format_cell};
use crate::present::sensitivity_rows::{SensitivityRow, Topic, sensitivity_rows};
use crate::store::best_run::FoundShot;
use crate::units::UnitSystem;

/// The table, the gains in points of P; `None` if no shot has any.
pub(super) fn sensitivity_table(shots: &[FoundShot], units: UnitSystem) -> Option<HtmlTable> {
    let rows: Vec<_> = shots
        .iter()
        .flat_map(|shot| {
            let rows = sensitivity_rows(&shot.sensitivity, units).into_iter();
            rows.map(|row| (None, cells(shot.kind.name(), &row)))
        })
        .collect();
    (!rows.is_empty()).then(|| HtmlTable {
        caption: "What matters most".to_owned(),
        columns: [
            "shot",
            "what changes",
            "value",
            "adds, per 100",
            "simulation error",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows,
        note: String::new(),
        is_detail: true,
    })
}

fn cells(kind: &str, row: &SensitivityRow) -> Vec<String> {
    let points = |p: f64| format_cell(100.0 * p, 1);
    let value = |value| format!("{value:.2} {}", row.unit);
    vec![
        kind.to_owned(),
        what_changes(row.topic, row.variable),
        row.value.map_or_else(String::new, value),
        row.gain.map_or_else(String::new, |gain| points(gain.value)),
        row.gain
            .map_or_else(String::new, |gain| points(gain.standard_error)),
    ]
}

fn what_changes(topic: Topic, variable: &str) -> String {
    let variable = variable.replace('_', " ");
    match topic {
        Topic::WindowLow => format!("tolerance, lowest {variable}"),
        Topic::WindowHigh => format!("tolerance, highest {variable}"),
        Topic::Without => format!("no scatter in {variable}"),
        Topic::ATenthLess => format!("10 % less scatter in {variable}"),
        Topic::Backspin => "backspin".to_owned(),
        Topic::ReleaseHeight => "release height".to_owned(),
    }
}
