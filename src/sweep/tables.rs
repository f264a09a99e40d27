//! The final tables of a sweep: every place of the region, mirror images included, in the order of the region.
//!
//! The bytes depend on the results alone: not on threads, shards, restarts or machines.

use super::configuration::Configuration;
use super::jobs::Jobs;
use super::row::{COLUMNS, Cell, Column, Row, Type};
use crate::output::{Record, number, object, provenance};
use crate::units::System;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types;
use std::collections::BTreeMap;
use std::sync::Arc;

/// One line of the tables: the number of its place, whether it is a mirror image, its result in the units of the
/// tables.
struct Line {
    place: i64,
    mirrored: bool,
    cells: Vec<Cell>,
}

/// The result tables of a sweep.
pub struct Tables {
    columns: Vec<(String, Column)>,
    lines: Vec<Line>,
    provenance: Record,
}

impl Tables {
    /// From every result that is there, by job.
    #[must_use]
    pub fn new(configuration: &Configuration, jobs: &Jobs, rows: &BTreeMap<u64, Row>) -> Self {
        let units = configuration.template.output.units;
        let columns = COLUMNS
            .iter()
            .map(|column| (shown(column, units), *column))
            .collect();
        let mut lines = Vec::new();
        for (place, source) in jobs.sources.iter().enumerate() {
            for kind in 0..jobs.kinds.len() {
                let Some(row) = rows.get(&jobs.number(source.place, kind)) else {
                    continue;
                };
                let cells = if source.mirrored {
                    row.mirrored().cells
                } else {
                    row.cells.clone()
                };
                lines.push(Line {
                    place: place as i64,
                    mirrored: source.mirrored,
                    cells: in_units(cells, units),
                });
            }
        }
        let mut record = provenance(&configuration.hash());
        record.push(("sweep".to_owned(), configuration.name.clone().into()));
        record.push((
            "shooter".to_owned(),
            configuration.template.shooter.name.clone().into(),
        ));
        record.push(("court".to_owned(), configuration.league.name().into()));
        record.push(("seed".to_owned(), configuration.template.seed().into()));
        record.push((
            "standard_error_asked_for".to_owned(),
            number(configuration.template.standard_error()),
        ));
        record.push(("places".to_owned(), jobs.sources.len().into()));
        record.push(("jobs".to_owned(), jobs.count().into()));
        record.push(("jobs_there".to_owned(), rows.len().into()));
        Self {
            columns,
            lines,
            provenance: record,
        }
    }

    /// The rows as CSV: a header, one line for each place and kind, empty cells where there is nothing.
    #[must_use]
    pub fn csv(&self) -> Vec<u8> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let names = self.columns.iter().map(|(name, _)| name.as_str());
        // Writing to memory does not fail.
        let _ = writer.write_record(["place", "mirrored"].into_iter().chain(names));
        for line in &self.lines {
            let first = [line.place.to_string(), line.mirrored.to_string()];
            let cells = line.cells.iter().map(|cell| match cell {
                Cell::Null => String::new(),
                Cell::Real(value) => value.to_string(),
                Cell::Integer(value) => value.to_string(),
                Cell::Text(text) => text.clone(),
            });
            let _ = writer.write_record(first.into_iter().chain(cells));
        }
        writer.into_inner().unwrap_or_default()
    }

    /// The same rows as Parquet, with the provenance in the file's own metadata.
    ///
    /// # Errors
    /// When the rows cannot be encoded.
    pub fn parquet(&self) -> Result<Vec<u8>, ParquetError> {
        let field = |name: &str, of: Physical, logical: Option<LogicalType>, repetition| {
            types::Type::primitive_type_builder(name, of)
                .with_logical_type(logical)
                .with_repetition(repetition)
                .build()
                .map(Arc::new)
        };
        let mut fields = vec![
            field("place", Physical::INT64, None, Repetition::REQUIRED)?,
            field("mirrored", Physical::BOOLEAN, None, Repetition::REQUIRED)?,
        ];
        for (name, column) in &self.columns {
            let (of, logical) = match column.of {
                Type::Real => (Physical::DOUBLE, None),
                Type::Integer => (Physical::INT64, None),
                Type::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            };
            fields.push(field(name, of, logical, Repetition::OPTIONAL)?);
        }
        let schema = types::Type::group_type_builder("best_shots")
            .with_fields(fields)
            .build()?;
        let metadata = self.provenance.iter().map(|(key, value)| {
            let text = value
                .as_str()
                .map_or_else(|| value.to_string(), str::to_owned);
            KeyValue::new(format!("bankshot.{key}"), text)
        });
        let properties = WriterProperties::builder()
            .set_created_by(format!("bankshot {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(metadata.collect()))
            .build();
        let mut bytes = Vec::new();
        let mut writer =
            SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties))?;
        let mut group = writer.next_row_group()?;
        let places: Vec<i64> = self.lines.iter().map(|line| line.place).collect();
        write_column::<Int64Type>(&mut group, &places, None)?;
        let mirrored: Vec<bool> = self.lines.iter().map(|line| line.mirrored).collect();
        write_column::<BoolType>(&mut group, &mirrored, None)?;
        for (i, (_, column)) in self.columns.iter().enumerate() {
            let cells = || self.lines.iter().map(|line| &line.cells[i]);
            let levels: Vec<i16> = cells().map(|cell| i16::from(*cell != Cell::Null)).collect();
            let levels = Some(&levels[..]);
            match column.of {
                Type::Real => {
                    let values: Vec<f64> = cells()
                        .filter_map(|cell| match cell {
                            Cell::Real(value) => Some(*value),
                            _ => None,
                        })
                        .collect();
                    write_column::<DoubleType>(&mut group, &values, levels)?;
                }
                Type::Integer => {
                    let values: Vec<i64> = cells()
                        .filter_map(|cell| match cell {
                            Cell::Integer(value) => Some(*value),
                            _ => None,
                        })
                        .collect();
                    write_column::<Int64Type>(&mut group, &values, levels)?;
                }
                Type::Text => {
                    let values: Vec<ByteArray> = cells()
                        .filter_map(|cell| match cell {
                            Cell::Text(text) => Some(ByteArray::from(text.as_str())),
                            _ => None,
                        })
                        .collect();
                    write_column::<ByteArrayType>(&mut group, &values, levels)?;
                }
            }
        }
        group.close()?;
        writer.close()?;
        Ok(bytes)
    }

    /// Where the tables come from, as JSON.
    #[must_use]
    pub fn provenance(&self, configuration: &Configuration) -> Vec<u8> {
        let mut record = self.provenance.clone();
        let checked = serde_json::to_value(configuration).unwrap_or_default();
        record.push(("configuration_si".to_owned(), checked));
        format!("{:#}\n", object(record)).into_bytes()
    }
}

fn write_column<T: parquet::data_type::DataType>(
    group: &mut SerializedRowGroupWriter<'_, &mut Vec<u8>>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    if let Some(mut writer) = group.next_column()? {
        writer.typed::<T>().write_batch(values, levels, None)?;
        writer.close()?;
    }
    Ok(())
}

/// A column's name in the tables.
fn shown(column: &Column, units: System) -> String {
    format!("{}{}", column.name, column.unit.shown(units).0)
}

fn in_units(cells: Vec<Cell>, units: System) -> Vec<Cell> {
    COLUMNS
        .iter()
        .zip(cells)
        .map(|(column, cell)| match cell {
            Cell::Real(value) => Cell::Real(value / column.unit.shown(units).1),
            other => other,
        })
        .collect()
}
