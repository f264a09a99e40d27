//! Rows of text cells from and to Parquet files. Columns that are carried through keep their types.

use super::csv_records::Row;
use csv::ByteRecord;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{
    BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int32Type, Int64Type,
};
use parquet::errors::{ParquetError, Result};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};
use std::fs::File;
use std::io::Write;
use std::sync::Arc;

/// Rows of one row group of an output file.
const GROUP_ROWS: usize = 1 << 16;

/// The rows of a Parquet file.
pub struct ParquetRows {
    file: SerializedFileReader<File>,
    columns: Vec<TypePtr>,
    /// The next row group.
    group: usize,
    /// Readers of the columns of the present row group, and its rows that are left.
    readers: Vec<ColumnReader>,
    rows_left: usize,
    row: u64,
}

impl ParquetRows {
    /// Opens a file.
    ///
    /// # Errors
    /// It is no Parquet file, or has a column that is nested or of an unsupported type.
    pub fn open(file: File) -> Result<Self> {
        let file = SerializedFileReader::new(file)?;
        let columns: Vec<TypePtr> = file
            .metadata()
            .file_metadata()
            .schema()
            .get_fields()
            .to_vec();
        for column in &columns {
            let is_supported = column.is_primitive()
                && column.get_basic_info().repetition() != Repetition::REPEATED
                && !matches!(
                    column.get_physical_type(),
                    Physical::INT96 | Physical::FIXED_LEN_BYTE_ARRAY
                );
            if !is_supported {
                return Err(ParquetError::General(format!(
                    "column {} is nested or of a type that is not supported; leave it out",
                    column.name()
                )));
            }
        }
        Ok(Self {
            file,
            columns,
            group: 0,
            readers: Vec::new(),
            rows_left: 0,
            row: 0,
        })
    }

    /// The names of the columns.
    #[must_use]
    pub fn header(&self) -> ByteRecord {
        self.columns.iter().map(|column| column.name()).collect()
    }

    /// The columns with their types.
    #[must_use]
    pub fn columns(&self) -> &[TypePtr] {
        &self.columns
    }

    /// The next rows, at most `most`; none at the end.
    ///
    /// # Errors
    /// The file is damaged, or compressed in a way that is not supported.
    pub fn next_rows(&mut self, most: usize) -> Result<Vec<Row>> {
        while self.rows_left == 0 {
            if self.group == self.file.num_row_groups() {
                return Ok(Vec::new());
            }
            let group = self.file.get_row_group(self.group)?;
            self.group += 1;
            self.rows_left = group.metadata().num_rows() as usize;
            self.readers = (0..self.columns.len())
                .map(|column| group.get_column_reader(column))
                .collect::<Result<_>>()?;
        }
        let count = most.min(self.rows_left);
        let mut rows = vec![ByteRecord::new(); count];
        for reader in &mut self.readers {
            read_cells(reader, &mut rows)?;
        }
        self.rows_left -= count;
        Ok(rows
            .into_iter()
            .map(|cells| {
                self.row += 1;
                Row {
                    number: self.row,
                    cells: Ok(cells),
                }
            })
            .collect())
    }
}

/// Appends the next cell of a column to each row.
fn read_cells(reader: &mut ColumnReader, rows: &mut [ByteRecord]) -> Result<()> {
    match reader {
        ColumnReader::BoolColumnReader(reader) => {
            read_typed(reader, rows, |value| value.to_string().into_bytes())
        }
        ColumnReader::Int32ColumnReader(reader) => {
            read_typed(reader, rows, |value| value.to_string().into_bytes())
        }
        ColumnReader::Int64ColumnReader(reader) => {
            read_typed(reader, rows, |value| value.to_string().into_bytes())
        }
        // The shortest text of the double that the float is: simulated as it stands in the file.
        ColumnReader::FloatColumnReader(reader) => read_typed(reader, rows, |value| {
            f64::from(*value).to_string().into_bytes()
        }),
        ColumnReader::DoubleColumnReader(reader) => {
            read_typed(reader, rows, |value| value.to_string().into_bytes())
        }
        ColumnReader::ByteArrayColumnReader(reader) => {
            read_typed(reader, rows, |value| value.data().to_vec())
        }
        ColumnReader::Int96ColumnReader(_) | ColumnReader::FixedLenByteArrayColumnReader(_) => {
            Err(ParquetError::General("the type is not supported".into()))
        }
    }
}

fn read_typed<T: DataType>(
    reader: &mut ColumnReaderImpl<T>,
    rows: &mut [ByteRecord],
    text: impl Fn(&T::T) -> Vec<u8>,
) -> Result<()> {
    let mut levels = Vec::new();
    let mut values = Vec::new();
    let mut done = 0;
    while done < rows.len() {
        levels.clear();
        values.clear();
        let (count, _, _) =
            reader.read_records(rows.len() - done, Some(&mut levels), None, &mut values)?;
        if count == 0 {
            return Err(ParquetError::General("a column ends too early".into()));
        }
        let has_nulls = values.len() < count;
        let mut values = values.iter();
        for (i, row) in rows[done..done + count].iter_mut().enumerate() {
            let is_null = has_nulls && levels.get(i) == Some(&0);
            match if is_null { None } else { values.next() } {
                Some(value) => row.push_field(&text(value)),
                None => row.push_field(b""),
            }
        }
        done += count;
    }
    Ok(())
}

/// The column of an output file.
///
/// # Errors
/// The name cannot stand in a schema.
pub fn column(name: &str, of: Physical) -> Result<TypePtr> {
    let logical = (of == Physical::BYTE_ARRAY).then_some(LogicalType::String);
    Type::primitive_type_builder(name, of)
        .with_logical_type(logical)
        .with_repetition(Repetition::OPTIONAL)
        .build()
        .map(Arc::new)
}

/// Writes rows of text cells as a Parquet file. An empty cell is null.
pub struct ParquetSink<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    columns: Vec<TypePtr>,
    rows: Vec<ByteRecord>,
}

impl<W: Write + Send> ParquetSink<W> {
    /// Starts a file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn new(out: W, columns: &[TypePtr]) -> Result<Self> {
        let columns = columns
            .iter()
            .map(|given| optional(given))
            .collect::<Result<Vec<_>>>()?;
        let schema = Type::group_type_builder("shots")
            .with_fields(columns.clone())
            .build()?;
        let properties = WriterProperties::builder()
            .set_created_by(format!("bankshot {}", env!("CARGO_PKG_VERSION")))
            .build();
        Ok(Self {
            writer: SerializedFileWriter::new(out, Arc::new(schema), Arc::new(properties))?,
            columns,
            rows: Vec::new(),
        })
    }

    /// Adds a row, with a cell for each column.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(&mut self, row: ByteRecord) -> Result<()> {
        self.rows.push(row);
        if self.rows.len() >= GROUP_ROWS {
            self.write_group()?;
        }
        Ok(())
    }

    fn write_group(&mut self) -> Result<()> {
        let mut group = self.writer.next_row_group()?;
        for (i, column) in self.columns.iter().enumerate() {
            write_cells(&mut group, i, column.get_physical_type(), &self.rows)?;
        }
        group.close()?;
        self.rows.clear();
        Ok(())
    }

    /// Writes what is left and the end of the file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<W> {
        if !self.rows.is_empty() {
            self.write_group()?;
        }
        self.writer.into_inner()
    }
}

/// The same column with nulls allowed; floats become doubles.
fn optional(given: &TypePtr) -> Result<TypePtr> {
    let of = match given.get_physical_type() {
        Physical::FLOAT => Physical::DOUBLE,
        other => other,
    };
    Type::primitive_type_builder(given.name(), of)
        .with_logical_type(given.get_basic_info().logical_type_ref().cloned())
        .with_converted_type(given.get_basic_info().converted_type())
        .with_repetition(Repetition::OPTIONAL)
        .build()
        .map(Arc::new)
}

fn write_cells<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    i: usize,
    of: Physical,
    rows: &[ByteRecord],
) -> Result<()> {
    fn parsed<T: std::str::FromStr>(cell: &[u8]) -> Option<T> {
        std::str::from_utf8(cell).ok()?.trim().parse().ok()
    }
    match of {
        Physical::BOOLEAN => write_typed::<BoolType, _>(group, i, rows, parsed),
        Physical::INT32 => write_typed::<Int32Type, _>(group, i, rows, parsed),
        Physical::INT64 => write_typed::<Int64Type, _>(group, i, rows, parsed),
        Physical::DOUBLE => write_typed::<DoubleType, _>(group, i, rows, parsed),
        _ => write_typed::<ByteArrayType, _>(group, i, rows, |cell| {
            (!cell.is_empty()).then(|| ByteArray::from(cell.to_vec()))
        }),
    }
}

fn write_typed<T: DataType, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    i: usize,
    rows: &[ByteRecord],
    value: impl Fn(&[u8]) -> Option<T::T>,
) -> Result<()> {
    let cells: Vec<Option<T::T>> = rows.iter().map(|row| row.get(i).and_then(&value)).collect();
    let levels: Vec<i16> = cells.iter().map(|cell| i16::from(cell.is_some())).collect();
    let values: Vec<T::T> = cells.into_iter().flatten().collect();
    if let Some(mut writer) = group.next_column()? {
        writer
            .typed::<T>()
            .write_batch(&values, Some(&levels), None)?;
        writer.close()?;
    }
    Ok(())
}
