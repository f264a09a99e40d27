//! Words and tables that all answers of `team` share.

use crate::present::layout::{Side, TextTable};

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

/// A table whose first column is text. A name can have two lines.
pub(super) fn table_of(header: &[String]) -> TextTable {
    let columns = header.iter().enumerate().map(|(i, name)| {
        let (first, second) = name.split_once('\n').unwrap_or((name, ""));
        let side = if i == 0 { Side::Left } else { Side::Right };
        (first, second, side)
    });
    TextTable::new(&columns.collect::<Vec<_>>())
}
