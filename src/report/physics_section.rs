//! The table of a page that says how much of the answer rests on the physics.

use super::html_table::{HtmlTable, format_cell};
use crate::best_shot::{PhysicsComparison, PhysicsRow};
use crate::present::physics_text::{
    comparison_in_words, physics_name, same_shot_in_words, what_stays,
};
use crate::units::{DEGREE_RAD, UnitSystem};

/// The best shots under each physics, and one shot under all of them.
#[must_use]
pub fn physics_table(comparison: &PhysicsComparison, units: UnitSystem) -> HtmlTable {
    let (long, metre) = units.length();
    let (short, short_m) = units.short_length();
    let columns = [
        "physics".to_owned(),
        "direct: makes per 100".to_owned(),
        format!("speed {long}/s"),
        "angle deg".to_owned(),
        format!("{short} past centre"),
        "bank: makes per 100".to_owned(),
        "same shot: makes per 100".to_owned(),
    ];
    let cells = |row: &PhysicsRow| {
        let number = |value: Option<f64>, decimals: usize| {
            value.map_or(String::new(), |value| format_cell(value, decimals))
        };
        let direct = row.direct.as_ref().ok();
        let bank = row.bank.as_ref().ok();
        vec![
            physics_name(row.of, units),
            number(direct.map(|shot| 100.0 * shot.estimate.probability), 1),
            number(direct.map(|shot| shot.nominal.speed_m_s / metre), 2),
            number(direct.map(|shot| shot.nominal.pitch_rad / DEGREE_RAD), 1),
            number(row.aim_past_centre_m.map(|aim_m| aim_m / short_m), 1),
            number(bank.map(|shot| 100.0 * shot.estimate.probability), 1),
            number(row.same_shot.map(|p| 100.0 * p.probability), 1),
        ]
    };
    HtmlTable {
        caption: "How much rests on the physics".to_owned(),
        note: format!(
            "{}Same shot: {}, {}.",
            comparison_in_words(comparison, units).map_or_else(String::new, |words| words + " "),
            same_shot_in_words(comparison.same_shot),
            what_stays(comparison.same_shot)
        ),
        columns: columns.to_vec(),
        rows: comparison
            .rows
            .iter()
            .map(|row| (None, cells(row)))
            .collect(),
        is_detail: false,
    }
}
