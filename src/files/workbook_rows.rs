//! The first sheet of a workbook that has a table, as rows of cells.

use super::header_row::{ROWS_LOOKED_AT, header_row};
use calamine::{Data, Range, Reader, open_workbook_auto_from_rs};
use csv::ByteRecord;
use std::io::Cursor;

/// A sheet: its name, and its rows with their numbers.
#[derive(Debug)]
pub(super) struct Sheet {
    /// Its name.
    pub(super) name: String,
    /// The number of each row and its cells.
    pub(super) rows: Vec<(u64, ByteRecord)>,
}

/// Reads a workbook (xlsx, xls, xlsb or ods).
///
/// # Errors
/// It is none, or no sheet has two columns.
pub(super) fn workbook_rows(bytes: Vec<u8>) -> Result<Sheet, String> {
    let is_zip = bytes.starts_with(b"PK");
    let mut workbook =
        open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(|_| match is_zip {
            true => "is a zip archive without a workbook: unpack it first".to_owned(),
            false => "is an old Office file that cannot be read: save the sheet as CSV".to_owned(),
        })?;
    for name in workbook.sheet_names() {
        let Ok(range) = workbook.worksheet_range(&name) else {
            continue;
        };
        let rows = rows(&range);
        let first: Vec<&ByteRecord> = rows
            .iter()
            .take(ROWS_LOOKED_AT)
            .map(|(_, row)| row)
            .collect();
        let header = first.get(header_row(&first));
        let names = header.map_or(0, |row| row.iter().filter(|cell| !cell.is_empty()).count());
        if names >= 2 {
            return Ok(Sheet { name, rows });
        }
    }
    Err("is a workbook without a sheet of two columns or more".to_owned())
}

fn rows(range: &Range<Data>) -> Vec<(u64, ByteRecord)> {
    let start = range.start().map_or(0, |(row, _)| u64::from(row));
    let rows = range.rows().zip(start + 1..);
    rows.map(|(cells, number)| {
        let cells: Vec<String> = cells.iter().map(cell).collect();
        (number, ByteRecord::from(cells))
    })
    .collect()
}

fn cell(cell: &Data) -> String {
    match cell {
        Data::Empty | Data::Error(_) => String::new(),
        // The number of the day, which is read as a date where one is meant.
        Data::DateTime(moment) => moment.as_f64().to_string(),
        other => other.to_string(),
    }
}
