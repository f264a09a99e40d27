//! Which row of a table has the names of its columns, and which says their units.

use csv::ByteRecord;

/// Rows at the beginning that are looked at: titles and remarks of an export take fewer.
pub(super) const ROWS_LOOKED_AT: usize = 40;
/// The names take at least this fraction of the columns that the rows below have.
const LEAST_SHARE: f64 = 0.6;

/// The texts of the cells that are not empty.
pub(super) fn filled(row: &ByteRecord) -> Vec<&[u8]> {
    let cells = row.iter().map(<[u8]>::trim_ascii);
    cells.filter(|cell| !cell.is_empty()).collect()
}

/// Whether a cell is a number, with a decimal point or a decimal comma.
fn is_number(cell: &[u8]) -> bool {
    let text = String::from_utf8_lossy(cell).replacen(',', ".", 1);
    text.parse::<f64>().is_ok()
}

/// Whether a row is a remark: its first cell begins with `#` and a word.
#[must_use]
pub(super) fn is_remark(row: &ByteRecord) -> bool {
    let first = row.get(0).unwrap_or_default().trim_ascii();
    let rest = first.strip_prefix(b"#").unwrap_or_default();
    rest.trim_ascii()
        .first()
        .is_some_and(|byte| !byte.is_ascii_digit())
}

/// Whether a row has no cell with a text.
#[must_use]
pub(super) fn is_blank(row: &ByteRecord) -> bool {
    filled(row).is_empty()
}

/// The index of the row of the names among the first rows of a table: the first one that is about
/// as wide as the rows below it and has few numbers; 0 if none is.
#[must_use]
pub(super) fn header_row(rows: &[&ByteRecord]) -> usize {
    let widths: Vec<usize> = rows.iter().map(|row| filled(row).len()).collect();
    let is_header = |index: usize| {
        let row = rows[index];
        if is_remark(row) || is_blank(row) {
            return false;
        }
        let mut below = widths[index + 1..].to_vec();
        below.retain(|width| *width > 0);
        below.sort_unstable();
        let usual = below.get(below.len() / 2).copied().unwrap_or(1);
        let names = filled(row);
        let numbers = names.iter().filter(|cell| is_number(cell)).count();
        names.len() as f64 >= LEAST_SHARE * usual as f64 && 4 * numbers <= names.len()
    };
    let first_of_all =
        || (0..rows.len()).find(|&index| !is_remark(rows[index]) && !is_blank(rows[index]));
    match (0..rows.len()).find(|&index| is_header(index)) {
        Some(index) => index,
        // Names behind a `#`, as some programs write them.
        None => match (0..rows.len()).rev().find(|&index| is_remark(rows[index])) {
            Some(index)
                if rows
                    .get(index + 1)
                    .is_some_and(|next| next.len() == rows[index].len()) =>
            {
                index
            }
            _ => first_of_all().unwrap_or(0),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(lines: &[&str]) -> usize {
        let rows: Vec<ByteRecord> = lines
            .iter()
            .map(|line| line.split(',').collect::<Vec<_>>().into())
            .collect();
        header_row(&rows.iter().collect::<Vec<_>>())
    }

    #[test]
    fn contract_titles_and_remarks_above_the_names_are_passed() {
        let table = ["Arc,Depth,Made", "42,9,1", "41,8,0"];
        assert_eq!(found(&table), 0);
        let below = |titles: &[&str]| found(&[titles, &table[..]].concat());
        assert_eq!(below(&["Report of a session,,"]), 1);
        assert_eq!(below(&["# written by a sensor", "Team: Wildcats", ""]), 3);
        assert_eq!(found(&["# shot,speed,angle", "1,7.2,51", "2,7.1,50"]), 0);
        assert_eq!(found(&["#,Arc,Depth", "1,42,9"]), 0);
        // A table of numbers alone keeps its first row.
        assert_eq!(found(&["1,2,3", "4,5,6"]), 0);
    }
}
