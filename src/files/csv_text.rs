//! CSV in memory. Every table of the program that is not streamed is written here.

use crate::escape::csv_cell;

/// Rows as CSV, with quotes where a cell needs them; no cell is a formula.
pub struct CsvText(csv::Writer<Vec<u8>>);

impl Default for CsvText {
    fn default() -> Self {
        let mut builder = csv::WriterBuilder::new();
        Self(builder.flexible(true).from_writer(Vec::new()))
    }
}

impl CsvText {
    /// Adds a row.
    pub fn row<T: AsRef<[u8]>>(&mut self, cells: impl IntoIterator<Item = T>) {
        for cell in cells {
            // Writing to memory does not fail.
            let _ = self.0.write_field(csv_cell(cell.as_ref()));
        }
        let _ = self.0.write_record(None::<&[u8]>);
    }

    /// The bytes of the rows so far.
    #[must_use]
    pub fn into_bytes(self) -> Vec<u8> {
        self.0.into_inner().unwrap_or_default()
    }
}
