//! A whole file of any kind as rows of text.

use super::column_texts::{ColumnSummary, ColumnText, tidy_cells, unit_named};
use crate::escape::is_control_or_direction;
use crate::files::csv_records::Row;
use crate::files::table_rows::TableRows;
use std::path::Path;

/// Rows and bytes that are read at a time, and rows of a file at most.
const BLOCK: (usize, usize) = (16_384, 8 << 20);
const MAX_ROWS: usize = 5_000_000;

/// The rows of a file.
#[derive(Debug)]
pub struct Table {
    /// The names of the columns.
    pub header: Vec<String>,
    /// What the cells or a row of units say of each column.
    pub texts: Vec<ColumnText>,
    /// The line or row of each, and its cells.
    pub rows: Vec<(u64, Vec<String>)>,
    /// Rows that cannot be read.
    pub unreadable: Vec<(u64, String)>,
    /// What the numbers count.
    pub row_name: &'static str,
    /// What was found in the file, in words.
    pub found: Vec<String>,
}

impl Table {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, or has no header.
    pub fn read(path: &Path) -> Result<Self, String> {
        let mut source = TableRows::open(path)?;
        let mut table = Self {
            header: source.header().iter().map(text).collect(),
            texts: Vec::new(),
            rows: Vec::new(),
            unreadable: Vec::new(),
            row_name: source.row_name(),
            found: source.found().words.clone(),
        };
        loop {
            let rows = source.next_rows(BLOCK.0, BLOCK.1)?;
            if rows.is_empty() {
                break;
            }
            for Row { number, cells } in rows {
                match cells {
                    Ok(cells) => table.rows.push((number, cells.iter().map(text).collect())),
                    Err(reason) => table.unreadable.push((number, reason)),
                }
            }
            if table.rows.len() > MAX_ROWS {
                return Err(format!(
                    "has more than {MAX_ROWS} rows; split it by shooter"
                ));
            }
        }
        table.check_widths()?;
        table.tidy();
        Ok(table)
    }

    /// Refuses a file whose rows are wider or narrower than the names of its columns.
    fn check_widths(&self) -> Result<(), String> {
        if self.header.is_empty() {
            return Err("is empty".to_owned());
        }
        let names = self.header.len();
        let widths = self.rows.iter().map(|(_, cells)| cells.len());
        let wider = widths.clone().filter(|width| *width > names).count();
        let most = widths.max().unwrap_or(names);
        if 2 * wider > self.rows.len() && wider > 0 {
            return Err(format!(
                "its rows have up to {most} cells and its header {names}: are the commas decimal commas? Save it with semicolons between the cells, or with decimal points"
            ));
        }
        if most < names {
            return Err(format!(
                "its header has {names} names, and no row has more than {most} {}; put a name with a comma in quotes",
                if most == 1 { "value" } else { "values" }
            ));
        }
        Ok(())
    }

    /// Takes a row of units, and makes numbers of cells with units.
    fn tidy(&mut self) {
        self.texts = vec![ColumnText::default(); self.header.len()];
        let is_of_units = |cells: &[String]| {
            let filled = cells
                .iter()
                .filter(|cell| !matches!(cell.as_str(), "" | "-"));
            let units = filled
                .clone()
                .filter(|cell| unit_named(cell).is_some())
                .count();
            units > 0 && 2 * units >= filled.count()
        };
        if self
            .rows
            .first()
            .is_some_and(|(_, cells)| is_of_units(cells))
        {
            let (number, units) = self.rows.remove(0);
            self.found
                .push(format!("units in {} {number}", self.row_name));
            for (text, unit) in self.texts.iter_mut().zip(&units) {
                text.unit = unit_named(unit);
            }
        }
        for index in 0..self.header.len() {
            let mut cells: Vec<&mut String> = self
                .rows
                .iter_mut()
                .filter_map(|(_, cells)| cells.get_mut(index))
                .collect();
            let found = tidy_cells(&mut cells);
            let text = &mut self.texts[index];
            text.unit = found.unit.or(text.unit);
            text.is_positive_to_the_right = found.is_positive_to_the_right;
            let cells = self.rows.iter().filter_map(|(_, cells)| cells.get(index));
            text.summary = Some(ColumnSummary::of(cells.map(String::as_str)));
        }
    }
}

fn text(cell: &[u8]) -> String {
    // Sheets of languages that are written to the left have marks of direction around cells.
    let text = crate::files::table_rows::cell_as_text(cell);
    text.replace(|c: char| is_control_or_direction(c) && !c.is_control(), "")
}
