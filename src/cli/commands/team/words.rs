//! Words and tables that all answers of `team` share.

use comfy_table::{Table, presets};

/// Longest name of a player in the tables, in characters.
pub(super) const LONGEST_NAME: usize = 24;
/// A chance in 100.
pub(super) fn in_hundred(p: f64) -> String {
    format!("{:.1}", 100.0 * p)
}

/// A share in percent, rounded down: 90 is at least 90 %, which counts as sure.
pub(super) fn whole_percent(share: f64) -> u32 {
    (100.0 * share + 1e-9) as u32
}

pub(super) fn table_of(header: Vec<String>) -> Table {
    let mut table = Table::new();
    table.load_style(presets::UTF8_HORIZONTAL_ONLY);
    table.set_header(header);
    table
}
