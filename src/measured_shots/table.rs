//! A whole CSV or Parquet file as rows of text.

use crate::files::csv_records::CsvRecords;
use crate::files::parquet_rows::ParquetRows;
use std::fs::File;
use std::path::Path;

/// Rows and bytes that are read at a time, and rows of a file at most.
const BLOCK: (usize, usize) = (16_384, 8 << 20);
const MAX_ROWS: usize = 5_000_000;

/// The rows of a file.
#[derive(Debug)]
pub struct Table {
    /// The names of the columns.
    pub header: Vec<String>,
    /// The line or row of each, and its cells.
    pub rows: Vec<(u64, Vec<String>)>,
    /// Rows that cannot be read.
    pub unreadable: Vec<(u64, String)>,
    /// What the numbers count.
    pub row_name: &'static str,
}

impl Table {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, or has no header.
    pub fn read(path: &Path) -> Result<Self, String> {
        let file = File::open(path).map_err(|error| error.to_string())?;
        if file.metadata().map_err(|error| error.to_string())?.is_dir() {
            return Err("is a folder; give a CSV or Parquet file".to_owned());
        }
        let is_parquet = path
            .extension()
            .is_some_and(|extension| extension.eq_ignore_ascii_case("parquet"));
        let mut table = Self {
            header: Vec::new(),
            rows: Vec::new(),
            unreadable: Vec::new(),
            row_name: if is_parquet { "row" } else { "line" },
        };
        let mut separator = b',';
        let mut next: Box<dyn FnMut() -> Result<Vec<_>, String>> = if is_parquet {
            let mut rows = ParquetRows::open(file).map_err(|error| error.to_string())?;
            table.header = text(&rows.header(), b',');
            Box::new(move || rows.next_rows(BLOCK.0, BLOCK.1).map_err(|e| e.to_string()))
        } else {
            let mut records =
                CsvRecords::with_any_separator(file).map_err(|error| error.to_string())?;
            separator = records.separator();
            Box::new(move || {
                records
                    .next_rows(BLOCK.0, BLOCK.1)
                    .map_err(|e| e.to_string())
            })
        };
        loop {
            let rows = next()?;
            if rows.is_empty() {
                break;
            }
            for row in rows {
                match row.cells {
                    // A spreadsheet's note on the separator, above the names.
                    Ok(cells) if table.header.is_empty() && cells.get(0) == Some(b"sep=") => {}
                    Ok(cells) if table.header.is_empty() => table.header = text(&cells, separator),
                    Ok(cells) => table.rows.push((row.number, text(&cells, separator))),
                    Err(reason) if reason == "is empty" => {}
                    Err(reason) => table.unreadable.push((row.number, reason)),
                }
            }
            if table.rows.len() > MAX_ROWS {
                return Err(format!(
                    "has more than {MAX_ROWS} rows; split it by shooter"
                ));
            }
        }
        if table.header.is_empty() {
            return Err("is empty".to_owned());
        }
        // A comma at the end of the first line names no column.
        while table.header.last().is_some_and(String::is_empty) {
            table.header.pop();
        }
        let most_cells = table.rows.iter().map(|(_, cells)| cells.len()).max();
        if let Some(most) = most_cells
            && most < table.header.len()
        {
            return Err(format!(
                "its first line has {} names, and no other line has more than {most} {}; put a name with a comma in quotes",
                table.header.len(),
                if most == 1 { "value" } else { "values" }
            ));
        }
        Ok(table)
    }
}

/// The cells of a record. Where no comma separates them, one in a number is its decimal point.
fn text(record: &csv::ByteRecord, separator: u8) -> Vec<String> {
    let cells = record.iter().map(|cell| {
        let cell = String::from_utf8_lossy(cell).trim().to_owned();
        if separator != b',' && is_number_with_comma(&cell) {
            cell.replace(',', ".")
        } else {
            cell
        }
    });
    cells.collect()
}

/// Whether a cell is a number with a decimal comma: `-5,7`.
fn is_number_with_comma(cell: &str) -> bool {
    let digits = cell.strip_prefix(['-', '+']).unwrap_or(cell);
    let are_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    digits
        .split_once(',')
        .is_some_and(|(whole, part)| are_digits(whole) && are_digits(part) && !part.is_empty())
}
