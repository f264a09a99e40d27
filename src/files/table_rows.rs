//! The rows of any table: text with any separator and in any usual encoding, Parquet, JSON, or a
//! workbook. It finds the names of the columns, and says what it found.

use super::csv_records::{CsvRecords, Row};
use super::file_kind::FileKind;
use super::header_row::{ROWS_LOOKED_AT, filled, header_row, is_blank, is_remark};
use super::json_rows::json_rows;
use super::parquet_rows::ParquetRows;
use super::text_encoding::{cell_text, wide_encoding};
use super::workbook_rows::workbook_rows;
use csv::ByteRecord;
use parquet::schema::types::TypePtr;
use std::collections::VecDeque;
use std::fs::File;
use std::io::{Cursor, Read};
use std::path::Path;

/// Bytes that decide what a file is.
const FIRST_BYTES: u64 = 4096;

/// What was found in a file, for those who ask.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Found {
    /// In words, such as `semicolons between cells`.
    pub words: Vec<String>,
}

enum Input {
    Text(CsvRecords<Box<dyn Read>>),
    Parquet(Box<ParquetRows>),
    /// All rows are waiting.
    Read,
}

/// The rows of a table below the names of its columns.
pub struct TableRows {
    input: Input,
    header: ByteRecord,
    /// Rows that were read and not given.
    waiting: VecDeque<Row>,
    found: Found,
    row_name: &'static str,
}

impl TableRows {
    /// Opens a file.
    ///
    /// # Errors
    /// It cannot be read, or is no table.
    pub fn open(path: &Path) -> Result<Self, String> {
        let mut file = File::open(path).map_err(|error| error.to_string())?;
        if file.metadata().map_err(|error| error.to_string())?.is_dir() {
            return Err("is a folder; give a CSV, Parquet or Excel file".to_owned());
        }
        let first = first_bytes(&mut file)?;
        match FileKind::of(path, &first)? {
            FileKind::Parquet => {
                let file = File::open(path).map_err(|error| error.to_string())?;
                let rows = ParquetRows::open(file).map_err(|error| {
                    let words = error.to_string();
                    let words = words.strip_prefix("Parquet error: ").unwrap_or(&words);
                    words.to_owned()
                })?;
                Ok(Self {
                    header: rows.header(),
                    input: Input::Parquet(Box::new(rows)),
                    waiting: VecDeque::new(),
                    found: Found {
                        words: vec!["Parquet".to_owned()],
                    },
                    row_name: "row",
                })
            }
            FileKind::Workbook => {
                let sheet = workbook_rows(all_bytes(first, &mut file)?)?;
                let rows = sheet.rows.into_iter().map(|(number, cells)| Row {
                    number,
                    cells: Ok(cells),
                });
                let words = vec![format!(
                    "a workbook, sheet {}",
                    cell_text(sheet.name.as_bytes())
                )];
                Self::of_rows(rows.collect(), Found { words })
            }
            FileKind::Json => {
                let bytes = all_bytes(first, &mut file)?;
                let rows = json_rows(&String::from_utf8_lossy(&bytes).replace('\u{feff}', ""))?;
                let rows = rows.into_iter().zip(0..).map(|(cells, number)| Row {
                    number,
                    cells: Ok(ByteRecord::from(cells)),
                });
                Self::of_rows(
                    rows.collect(),
                    Found {
                        words: vec!["JSON".to_owned()],
                    },
                )
            }
            FileKind::Text => Self::of_text(first, Box::new(file), ROWS_LOOKED_AT),
        }
    }

    /// The rows of a stream of text, whose first row has the names: nothing waits for more rows
    /// than have come.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn of_stream(mut input: Box<dyn Read>) -> Result<Self, String> {
        let mut first = vec![0; FIRST_BYTES as usize];
        let count = input.read(&mut first).map_err(|error| error.to_string())?;
        first.truncate(count);
        Self::of_text(first, input, 1)
    }

    /// The rows of a whole text.
    ///
    /// # Errors
    /// It has no names.
    pub fn of_bytes(text: Vec<u8>) -> Result<Self, String> {
        Self::of_text(Vec::new(), Box::new(Cursor::new(text)), ROWS_LOOKED_AT)
    }

    /// `looked_at` is the number of rows among which the names are looked for.
    fn of_text(first: Vec<u8>, mut rest: Box<dyn Read>, looked_at: usize) -> Result<Self, String> {
        let mut found = Found::default();
        let input: Box<dyn Read> = match wide_encoding(&first) {
            Some(encoding) => {
                found.words.push(encoding.name().to_owned());
                let bytes = all_bytes(first, &mut rest)?;
                let text = encoding.decode(&bytes).0.into_owned();
                Box::new(Cursor::new(text.into_bytes()))
            }
            None => Box::new(Cursor::new(first).chain(rest)),
        };
        let mut records =
            CsvRecords::with_any_separator(input).map_err(|error| error.to_string())?;
        match records.separator() {
            b';' => found.words.push("semicolons between cells".to_owned()),
            b'\t' => found.words.push("tabs between cells".to_owned()),
            _ => {}
        }
        let mut waiting = VecDeque::new();
        let says_something = |row: &Row| {
            let cells = row.cells.as_ref();
            cells.map_or_else(
                |reason| reason != "is empty",
                |cells| {
                    !is_blank(cells)
                        && !is_remark(cells)
                        && !cells.iter().any(|cell| cell.starts_with(b"sep="))
                },
            )
        };
        while waiting.iter().filter(|row| says_something(row)).count() < looked_at {
            let wanted = looked_at.saturating_sub(waiting.len()).max(1);
            let rows = records
                .next_rows(wanted, 1 << 20)
                .map_err(|error| error.to_string())?;
            if rows.is_empty() {
                break;
            }
            waiting.extend(rows);
        }
        let mut table = Self {
            input: Input::Text(records),
            header: ByteRecord::new(),
            waiting,
            found,
            row_name: "line",
        };
        table.find_header()?;
        Ok(table)
    }

    fn of_rows(rows: VecDeque<Row>, found: Found) -> Result<Self, String> {
        let mut table = Self {
            input: Input::Read,
            header: ByteRecord::new(),
            waiting: rows,
            found,
            row_name: "row",
        };
        table.find_header()?;
        Ok(table)
    }

    /// Takes the row of the names, and drops what stands above it.
    fn find_header(&mut self) -> Result<(), String> {
        // A spreadsheet's note on the separator, above the names.
        let is_note = |row: &Row| {
            let first = row.cells.as_ref().ok().and_then(|cells| cells.get(0));
            first.is_some_and(|cell| cell.starts_with(b"sep="))
        };
        while self.waiting.front().is_some_and(is_note) {
            self.waiting.pop_front();
        }
        let first = self.waiting.iter().take(ROWS_LOOKED_AT);
        let readable: Vec<(usize, &ByteRecord)> = first
            .enumerate()
            .filter_map(|(at, row)| Some((at, row.cells.as_ref().ok()?)))
            .collect();
        let rows: Vec<&ByteRecord> = readable.iter().map(|(_, row)| *row).collect();
        let Some((at, _)) = readable.get(header_row(&rows)).copied() else {
            return match self.waiting.front() {
                Some(Row {
                    number,
                    cells: Err(reason),
                }) if reason != "is empty" => Err(format!("{} {number}: {reason}", self.row_name)),
                _ => Err("is empty".to_owned()),
            };
        };
        // A line that cannot be read is named; titles are passed.
        if let Some(Row {
            number,
            cells: Err(reason),
        }) = self
            .waiting
            .iter()
            .take(at)
            .find(|row| row.cells.as_ref().is_err_and(|reason| reason != "is empty"))
        {
            return Err(format!("{} {number}: {reason}", self.row_name));
        }
        let mut above = self.waiting.drain(..=at);
        if let Some(row) = above.next_back() {
            if row.number > 1 {
                self.found
                    .words
                    .push(format!("names in {} {}", self.row_name, row.number));
            }
            self.header = row.cells.unwrap_or_default();
        }
        drop(above);
        self.header = self
            .header
            .iter()
            .enumerate()
            .map(|(index, cell)| {
                let text = cell_text(cell);
                match text.strip_prefix('#') {
                    Some(rest) if index == 0 && !rest.is_empty() => rest.trim().to_owned(),
                    _ => text,
                }
            })
            .collect::<Vec<_>>()
            .into();
        // A separator at the end of the line names no column.
        let named = self.header.iter().rposition_of_name();
        self.header.truncate(named);
        Ok(())
    }

    /// The names of the columns.
    #[must_use]
    pub fn header(&self) -> &ByteRecord {
        &self.header
    }

    /// What was found.
    #[must_use]
    pub fn found(&self) -> &Found {
        &self.found
    }

    /// What the number of a row counts.
    #[must_use]
    pub fn row_name(&self) -> &'static str {
        self.row_name
    }

    /// Bytes of a text that were read so far; `None` of other files.
    #[must_use]
    pub fn bytes_read(&self) -> Option<u64> {
        match &self.input {
            Input::Text(records) => Some(records.bytes_read()),
            _ => None,
        }
    }

    /// The columns of a Parquet file with their types.
    #[must_use]
    pub fn parquet_columns(&self) -> Option<&[TypePtr]> {
        match &self.input {
            Input::Parquet(rows) => Some(rows.columns()),
            _ => None,
        }
    }

    /// The next rows: at most `most`, and about `bytes` bytes; none at the end. Remarks and rows
    /// without any text are passed, cells beyond the last column that are empty are cut off, and a
    /// decimal comma becomes a point where no comma separates cells.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn next_rows(&mut self, most: usize, bytes: usize) -> Result<Vec<Row>, String> {
        loop {
            let rows: Vec<Row> = match self.waiting.is_empty() {
                false => {
                    let count = most.min(self.waiting.len());
                    self.waiting.drain(..count).collect()
                }
                true => match &mut self.input {
                    Input::Text(records) => records
                        .next_rows(most, bytes)
                        .map_err(|error| error.to_string())?,
                    Input::Parquet(rows) => rows
                        .next_rows(most, bytes)
                        .map_err(|error| error.to_string())?,
                    Input::Read => Vec::new(),
                },
            };
            if rows.is_empty() {
                return Ok(rows);
            }
            let tidy: Vec<Row> = rows.into_iter().filter_map(|row| self.tidy(row)).collect();
            if !tidy.is_empty() {
                return Ok(tidy);
            }
        }
    }

    /// A row as it is given; `None` where it says nothing.
    fn tidy(&self, row: Row) -> Option<Row> {
        let is_text = matches!(self.input, Input::Text(_) | Input::Read);
        let Ok(mut cells) = row.cells else {
            let says_nothing = row.cells.as_ref().is_err_and(|reason| reason == "is empty");
            return (!says_nothing).then_some(row);
        };
        // A whole row is none, though its first cell, the name of a player, begins with `#`.
        let is_short = cells.len() < self.header.len() || filled(&cells).len() < 2;
        if is_text && (is_blank(&cells) || is_remark(&cells) && is_short) {
            return None;
        }
        while cells.len() > self.header.len()
            && cells
                .get(cells.len() - 1)
                .is_some_and(|cell| cell.trim_ascii().is_empty())
        {
            cells.truncate(cells.len() - 1);
        }
        let has_decimal_commas = match &self.input {
            Input::Text(records) => records.separator() != b',',
            _ => false,
        };
        if has_decimal_commas && cells.iter().any(is_number_with_comma) {
            cells = cells
                .iter()
                .map(|cell| match is_number_with_comma(cell) {
                    true => String::from_utf8_lossy(cell).trim().replace(',', "."),
                    false => cell_text(cell),
                })
                .collect::<Vec<_>>()
                .into();
        }
        Some(Row {
            number: row.number,
            cells: Ok(cells),
        })
    }
}

/// The number of cells up to the last one that is not empty.
trait UpToLastName {
    fn rposition_of_name(self) -> usize;
}

impl<'a, I: Iterator<Item = &'a [u8]>> UpToLastName for I {
    fn rposition_of_name(self) -> usize {
        let named = self.zip(1..).filter(|(cell, _)| !cell.is_empty());
        named.last().map_or(0, |(_, count)| count)
    }
}

fn first_bytes(input: &mut impl Read) -> Result<Vec<u8>, String> {
    let mut first = Vec::new();
    input
        .take(FIRST_BYTES)
        .read_to_end(&mut first)
        .map_err(|error| error.to_string())?;
    Ok(first)
}

/// The bytes of a file that is read as a whole.
fn all_bytes(mut first: Vec<u8>, rest: &mut impl Read) -> Result<Vec<u8>, String> {
    const MAX_BYTES: u64 = 256 << 20;
    rest.take(MAX_BYTES)
        .read_to_end(&mut first)
        .map_err(|error| error.to_string())?;
    if first.len() as u64 >= MAX_BYTES {
        return Err("is larger than 256 MiB; save it as CSV of UTF-8, or split it".to_owned());
    }
    Ok(first)
}

/// A cell as text: trimmed, whatever its encoding, without control characters.
#[must_use]
pub fn cell_as_text(cell: &[u8]) -> String {
    cell_text(cell)
}

/// Whether a cell is a number with a decimal comma: `-5,7`.
#[must_use]
pub fn is_number_with_comma(cell: &[u8]) -> bool {
    let cell = cell.trim_ascii();
    let digits = cell
        .strip_prefix(b"-")
        .or_else(|| cell.strip_prefix(b"+"))
        .unwrap_or(cell);
    let Some(comma) = digits.iter().position(|byte| *byte == b',') else {
        return false;
    };
    let (whole, part) = (&digits[..comma], &digits[comma + 1..]);
    let are_digits = |part: &[u8]| part.iter().all(u8::is_ascii_digit);
    are_digits(whole) && are_digits(part) && !part.is_empty()
}
