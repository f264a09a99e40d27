//! The table of the best shots.

use super::html_table::{HtmlTable, format_cell};
use super::shot_in_words::ReportShot;
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// The table of the best shots.
pub(super) fn shot_table(shots: &[ReportShot], units: UnitSystem) -> HtmlTable {
    let (long, unit_m) = units.length();
    let columns = vec![
        "shot".to_owned(),
        format!("distance {long}"),
        "court angle deg".to_owned(),
        "makes per 100".to_owned(),
        "simulation error".to_owned(),
        format!("speed {long}/s"),
        "angle deg".to_owned(),
        "direction deg".to_owned(),
        "backspin rev/s".to_owned(),
    ];
    let rows = shots
        .iter()
        .enumerate()
        .map(|(i, ReportShot { location, shot, .. })| {
            let nominal = &shot.nominal;
            let cells = vec![
                shot.kind.name().to_owned(),
                format_cell(location.distance_m / unit_m, 2),
                format_cell(location.angle_rad / DEGREE_RAD, 1),
                format_cell(100.0 * shot.probability, 2),
                format_cell(100.0 * shot.standard_error, 2),
                format_cell(nominal.speed_m_s / unit_m, 2),
                format_cell(nominal.pitch_rad / DEGREE_RAD, 1),
                format_cell(nominal.polar_rad / DEGREE_RAD, 2),
                format_cell(nominal.backspin_rad_s / REV_RAD, 2),
            ];
            (Some(i), cells)
        })
        .collect();
    HtmlTable {
        caption: "Best shots".to_owned(),
        columns,
        rows,
        note: String::new(),
        is_detail: false,
    }
}
