//! The first sheet of a workbook that has a table, as rows of cells.

use super::header_row::{ROWS_LOOKED_AT, header_row};
use super::library_panics::without_panic;
use calamine::{Cell, Data, DataRef, Range, Reader, Sheets, open_workbook_auto_from_rs};
use csv::ByteRecord;
use std::collections::BTreeMap;
use std::io::Cursor;

/// Most cells of a sheet, with the empty ones between others.
const MAX_CELLS: usize = 1 << 24;
/// Most bytes of the parts of a workbook, unpacked.
const MAX_UNPACKED: u64 = 1 << 29;

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
    let damaged = || Err("is a damaged workbook: save the sheet as CSV".to_owned());
    without_panic(|| first_sheet(bytes)).unwrap_or_else(damaged)
}

fn first_sheet(bytes: Vec<u8>) -> Result<Sheet, String> {
    let is_zip = bytes.starts_with(b"PK");
    if is_zip && unpacked_bytes(&bytes).is_some_and(|unpacked| unpacked > MAX_UNPACKED) {
        return Err("is too large a workbook: save the sheet as CSV".to_owned());
    }
    let mut workbook =
        open_workbook_auto_from_rs(Cursor::new(bytes)).map_err(|_| match is_zip {
            true => "is a zip archive without a workbook: unpack it first".to_owned(),
            false => "is an old Office file that cannot be read: save the sheet as CSV".to_owned(),
        })?;
    for name in workbook.sheet_names() {
        let Some(rows) = rows_of_sheet(&mut workbook, &name)? else {
            continue;
        };
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

/// The bytes of the parts of a zip archive, unpacked, by its directory at its end.
fn unpacked_bytes(archive: &[u8]) -> Option<u64> {
    let number = |at: usize, bytes: usize| {
        let digits = archive.get(at..at.checked_add(bytes)?)?.iter().rev();
        Some(digits.fold(0_u64, |number, byte| number << 8 | u64::from(*byte)))
    };
    let end = memchr::memmem::rfind(archive, b"PK\x05\x06")?;
    let mut at = number(end + 16, 4)? as usize;
    let mut unpacked = 0_u64;
    for _ in 0..number(end + 10, 2)? {
        unpacked += number(at + 24, 4)?;
        // Behind its fixed part: the name, more about the part, a remark.
        let lengths = [28, 30, 32].map(|of| number(at + of, 2).unwrap_or(0) as usize);
        at += 46 + lengths.iter().sum::<usize>();
    }
    Some(unpacked)
}

/// The rows of a sheet; `None` where it cannot be read. The cells of the usual formats come one by
/// one: a range of all of them would have room for the empty ones too.
fn rows_of_sheet(
    workbook: &mut Sheets<Cursor<Vec<u8>>>,
    name: &str,
) -> Result<Option<Vec<(u64, ByteRecord)>>, String> {
    let mut cells = Cells::default();
    match workbook {
        Sheets::Xlsx(book) => {
            let Ok(mut reader) = book.worksheet_cells_reader(name) else {
                return Ok(None);
            };
            loop {
                match reader.next_cell() {
                    Ok(Some(cell)) => cells.add(&cell),
                    Ok(None) => break,
                    Err(_) => return Ok(None),
                }
            }
        }
        Sheets::Xlsb(book) => {
            let Ok(mut reader) = book.worksheet_cells_reader(name) else {
                return Ok(None);
            };
            loop {
                match reader.next_cell() {
                    Ok(Some(cell)) => cells.add(&cell),
                    Ok(None) => break,
                    Err(_) => return Ok(None),
                }
            }
        }
        other => return Ok(other.worksheet_range(name).ok().map(|range| rows(&range))),
    }
    cells.rows().map(Some)
}

/// The cells of a sheet that have something, by row and column.
#[derive(Default)]
struct Cells(BTreeMap<u32, BTreeMap<u32, String>>);

impl Cells {
    fn add(&mut self, one: &Cell<DataRef<'_>>) {
        let text = cell(&Data::from(one.get_value().clone()));
        let (row, column) = one.get_position();
        if !text.is_empty() {
            self.0.entry(row).or_default().insert(column, text);
        }
    }

    /// All rows from the first to the last column that has something.
    fn rows(self) -> Result<Vec<(u64, ByteRecord)>, String> {
        let columns = || self.0.values().flat_map(BTreeMap::keys).copied();
        let (first, last) = (columns().min().unwrap_or(0), columns().max().unwrap_or(0));
        let width = (last - first) as usize + 1;
        if self.0.len().saturating_mul(width) > MAX_CELLS {
            return Err(format!(
                "has a sheet of {} rows and {width} columns: save it as CSV",
                self.0.len()
            ));
        }
        let rows = self.0.into_iter().map(|(row, mut cells)| {
            let cells = (first..=last).map(|column| cells.remove(&column).unwrap_or_default());
            (u64::from(row) + 1, cells.collect::<Vec<_>>().into())
        });
        Ok(rows.collect())
    }
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
