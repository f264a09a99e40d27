//! Rows of text cells from and to Parquet files. Columns that are carried through keep their types.

use super::csv_records::{MAX_RECORD_BYTES, Row};
use super::library_panics::without_panic;
use super::parquet_headers::CheckedFile;
use super::parquet_pages::CheckedPages;
use csv::ByteRecord;
use parquet::basic::{Compression, ConvertedType, LogicalType, Repetition, Type as Physical};
use parquet::column::reader::{ColumnReader, ColumnReaderImpl, get_column_reader};
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
/// Bytes of the cells of a row group of an output file, about.
const GROUP_BYTES: usize = 16 << 20;
/// Rows that are read from every column at a time.
const BLOCK_ROWS: usize = 256;

/// Most rows of a file for each of its bytes, and beside that: equal cells take next to nothing.
const MAX_ROWS_PER_BYTE: u64 = 100;
const ROWS_OF_NO_BYTES: u64 = 100_000;

/// The rows of a Parquet file.
pub struct ParquetRows {
    file: SerializedFileReader<CheckedFile>,
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
        checked(|| Self::open_file(file))
    }

    fn open_file(file: File) -> Result<Self> {
        let bytes = file.metadata()?.len();
        let file = SerializedFileReader::new(CheckedFile(file))?;
        check_chunks(&file, bytes)?;
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
            if is_decimal(column) {
                return Err(ParquetError::General(format!(
                    "column {} is a decimal number; store it as a double",
                    column.name()
                )));
            }
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

    /// The next rows: at most `most`, and about `bytes` bytes; none at the end.
    ///
    /// # Errors
    /// The file is damaged, or has a cell of more than [`MAX_RECORD_BYTES`].
    pub fn next_rows(&mut self, most: usize, bytes: usize) -> Result<Vec<Row>> {
        let mut rows = Vec::new();
        let mut read = 0;
        while rows.len() < most && read < bytes {
            let count = BLOCK_ROWS.min(most - rows.len());
            let more = checked(|| self.next_block(count))?;
            if more.is_empty() {
                break;
            }
            let cells = more.iter().filter_map(|row| row.cells.as_ref().ok());
            read += cells.map(|cells| cells.as_slice().len()).sum::<usize>();
            rows.extend(more);
        }
        Ok(rows)
    }

    fn next_block(&mut self, most: usize) -> Result<Vec<Row>> {
        while self.rows_left == 0 {
            if self.group == self.file.num_row_groups() {
                return Ok(Vec::new());
            }
            let group = self.file.get_row_group(self.group)?;
            self.group += 1;
            self.rows_left = group.metadata().num_rows() as usize;
            let schema = group.metadata().schema_descr_ptr();
            self.readers = (0..self.columns.len())
                .map(|index| {
                    let column = schema.column(index);
                    let pages = group.get_column_page_reader(index)?;
                    let pages = CheckedPages::new(pages, column.max_def_level() > 0);
                    Ok(get_column_reader(column, Box::new(pages)))
                })
                .collect::<Result<_>>()?;
        }
        let count = most.min(self.rows_left);
        let mut rows = vec![ByteRecord::new(); count];
        for (reader, column) in self.readers.iter_mut().zip(&self.columns) {
            read_cells(reader, &mut rows, is_unsigned(column))?;
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

/// Runs a part of the Parquet library, which panics at some damaged files.
fn checked<T>(read: impl FnOnce() -> Result<T>) -> Result<T> {
    let damaged = || Err(ParquetError::General("the file is damaged".into()));
    without_panic(read).unwrap_or_else(damaged)
}

/// Refuses a file whose chunks are compressed in a way that is not supported, or do not lie within
/// the file.
fn check_chunks(file: &SerializedFileReader<CheckedFile>, bytes: u64) -> Result<()> {
    let lies_within = |offset: i64, length: i64| {
        let (offset, length) = (u64::try_from(offset).ok(), u64::try_from(length).ok());
        let end = offset.zip(length).and_then(|(a, b)| a.checked_add(b));
        end.is_some_and(|end| end <= bytes)
    };
    let mut rows = 0_u64;
    for group in file.metadata().row_groups() {
        let count = u64::try_from(group.num_rows()).unwrap_or(u64::MAX);
        rows = rows.saturating_add(count);
        if rows > ROWS_OF_NO_BYTES + bytes.saturating_mul(MAX_ROWS_PER_BYTE) {
            return Err(ParquetError::General(format!(
                "the file is damaged: it says that it has {rows} rows"
            )));
        }
        for chunk in group.columns() {
            if !matches!(
                chunk.compression(),
                Compression::UNCOMPRESSED
                    | Compression::SNAPPY
                    | Compression::GZIP(_)
                    | Compression::ZSTD(_)
            ) {
                return Err(ParquetError::General(format!(
                    "compressed with {}; write it uncompressed, or with Snappy, gzip or zstd",
                    chunk.compression()
                )));
            }
            let start = chunk
                .dictionary_page_offset()
                .unwrap_or_else(|| chunk.data_page_offset());
            let is_valid = lies_within(start, chunk.compressed_size())
                && lies_within(chunk.data_page_offset(), 0)
                && chunk.num_values() >= 0;
            if !is_valid {
                return Err(ParquetError::General("the file is damaged".into()));
            }
        }
    }
    Ok(())
}

fn is_decimal(column: &Type) -> bool {
    let about = column.get_basic_info();
    matches!(about.logical_type_ref(), Some(LogicalType::Decimal { .. }))
        || about.converted_type() == ConvertedType::DECIMAL
}

fn is_unsigned(column: &Type) -> bool {
    use ConvertedType::{UINT_8, UINT_16, UINT_32, UINT_64};
    matches!(
        column.get_basic_info().converted_type(),
        UINT_8 | UINT_16 | UINT_32 | UINT_64
    )
}

/// Appends the next cell of a column to each row.
fn read_cells(reader: &mut ColumnReader, rows: &mut [ByteRecord], is_unsigned: bool) -> Result<()> {
    match reader {
        ColumnReader::BoolColumnReader(reader) => {
            read_typed(reader, rows, |value| value.to_string().into_bytes())
        }
        ColumnReader::Int32ColumnReader(reader) => read_typed(reader, rows, |value| {
            let unsigned = is_unsigned.then(|| value.cast_unsigned().to_string());
            unsigned.unwrap_or_else(|| value.to_string()).into_bytes()
        }),
        ColumnReader::Int64ColumnReader(reader) => read_typed(reader, rows, |value| {
            let unsigned = is_unsigned.then(|| value.cast_unsigned().to_string());
            unsigned.unwrap_or_else(|| value.to_string()).into_bytes()
        }),
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
                Some(value) => {
                    let text = text(value);
                    if text.len() > MAX_RECORD_BYTES {
                        return Err(ParquetError::General(format!(
                            "a cell has more than {MAX_RECORD_BYTES} bytes"
                        )));
                    }
                    row.push_field(&text);
                }
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
    /// Bytes of their cells.
    bytes: usize,
}

impl<W: Write + Send> ParquetSink<W> {
    /// Starts a file.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn new(out: W, columns: &[TypePtr]) -> Result<Self> {
        let columns = columns.iter().map(optional).collect::<Result<Vec<_>>>()?;
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
            bytes: 0,
        })
    }

    /// Adds a row, with a cell for each column.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(&mut self, row: ByteRecord) -> Result<()> {
        self.bytes += row.as_slice().len();
        self.rows.push(row);
        if self.rows.len() >= GROUP_ROWS || self.bytes >= GROUP_BYTES {
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
        self.bytes = 0;
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
        Physical::INT32 => write_typed::<Int32Type, _>(group, i, rows, |cell| {
            parsed(cell).or_else(|| parsed::<u32>(cell).map(u32::cast_signed))
        }),
        Physical::INT64 => write_typed::<Int64Type, _>(group, i, rows, |cell| {
            parsed(cell).or_else(|| parsed::<u64>(cell).map(u64::cast_signed))
        }),
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
