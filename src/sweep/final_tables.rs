//! The final tables of a sweep: every place of the region, mirror images included, in the order of
//! the region.
//!
//! The bytes depend on the results alone: not on threads, shards, restarts or machines.

use super::columns::{self, ColumnType};
use super::job_list::Jobs;
use super::result_row::{Cell, ResultRow};
use super::sweep_toml::SweepConfig;
use crate::answers::json::{self, Provenance};
use crate::files::csv_text::CsvText;
use crate::units::UnitSystem;
use crate::units::rounded;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types;
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::Arc;

/// One line of the tables.
struct Line {
    /// Number of the place.
    place: i64,
    mirrored: bool,
    /// The result in the units of the tables.
    cells: Vec<Cell>,
}

/// What the tables were made from.
#[derive(Clone, Debug, Serialize)]
struct TablesProvenance {
    #[serde(flatten)]
    provenance: Provenance,
    sweep: String,
    shooter: String,
    court: &'static str,
    standard_error_wanted: f64,
    places: usize,
    jobs: usize,
    jobs_done: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    configuration_si: Option<serde_json::Value>,
}

/// The result tables of a sweep.
pub struct ResultTables {
    column_names: Vec<String>,
    /// The names of the places; empty if they have none.
    place_names: Vec<String>,
    lines: Vec<Line>,
    provenance: TablesProvenance,
}

impl ResultTables {
    /// The files of the tables in the folder of a sweep, with their contents.
    ///
    /// # Errors
    /// The Parquet table cannot be encoded.
    pub fn files(
        &self,
        config: &SweepConfig,
    ) -> Result<[(&'static str, Vec<u8>); 3], ParquetError> {
        Ok([
            ("best_shots.csv", self.csv()),
            ("best_shots.parquet", self.parquet()?),
            ("provenance.json", self.provenance(config)),
        ])
    }

    /// From every result, by job.
    #[must_use]
    pub fn new(
        config: &SweepConfig,
        hash: &str,
        jobs: &Jobs,
        rows: &BTreeMap<u64, ResultRow>,
    ) -> Self {
        let units = config.settings.output.units;
        let mut lines = Vec::new();
        for (place, source) in jobs.sources.iter().enumerate() {
            for kind in 0..jobs.kinds.len() {
                let Some(row) = rows.get(&jobs.number(source.computed, kind)) else {
                    continue;
                };
                let cells = if source.mirrored {
                    in_units(row.mirrored().cells(), units)
                } else {
                    in_units(row.cells(), units)
                };
                lines.push(Line {
                    place: place as i64,
                    mirrored: source.mirrored,
                    cells,
                });
            }
        }
        Self {
            column_names: columns::ALL
                .iter()
                .map(|column| column.name_in(units))
                .collect(),
            place_names: config.place_names.clone(),
            lines,
            provenance: provenance_of(config, hash, jobs, rows.len()),
        }
    }

    /// The tables as CSV: a header, and one line for each place and kind.
    #[must_use]
    pub fn csv(&self) -> Vec<u8> {
        let mut table = CsvText::default();
        let names = self.column_names.iter().map(String::as_str);
        let name = (!self.place_names.is_empty()).then_some("name");
        table.row(["place", "mirrored"].into_iter().chain(name).chain(names));
        for line in &self.lines {
            let first = [line.place.to_string(), line.mirrored.to_string()];
            let first = first.into_iter().chain(self.place_name(line));
            let cells = line.cells.iter().map(|cell| match cell {
                Cell::Null => String::new(),
                // Not in ninety zeros.
                Cell::Real(value) if *value != 0.0 && value.abs() < 1e-7 => format!("{value:e}"),
                Cell::Real(value) => value.to_string(),
                Cell::Integer(value) => value.to_string(),
                Cell::Text(text) => text.clone(),
            });
            table.row(first.chain(cells));
        }
        table.into_bytes()
    }

    /// The name of the place of a line, if places have names.
    fn place_name(&self, line: &Line) -> Option<String> {
        self.place_names.get(line.place as usize).cloned()
    }

    /// The tables as Parquet, with the provenance in the metadata of the file.
    ///
    /// # Errors
    /// The rows cannot be encoded.
    pub fn parquet(&self) -> Result<Vec<u8>, ParquetError> {
        let mut bytes = Vec::new();
        let mut writer = SerializedFileWriter::new(
            &mut bytes,
            Arc::new(self.parquet_schema()?),
            Arc::new(self.parquet_properties()),
        )?;
        let mut group = writer.next_row_group()?;
        let places: Vec<i64> = self.lines.iter().map(|line| line.place).collect();
        write_column::<Int64Type>(&mut group, &places, None)?;
        let mirrored: Vec<bool> = self.lines.iter().map(|line| line.mirrored).collect();
        write_column::<BoolType>(&mut group, &mirrored, None)?;
        if !self.place_names.is_empty() {
            let names: Vec<ByteArray> = self
                .lines
                .iter()
                .map(|line| ByteArray::from(self.place_name(line).unwrap_or_default().as_str()))
                .collect();
            write_column::<ByteArrayType>(&mut group, &names, None)?;
        }
        for (i, column) in columns::ALL.iter().enumerate() {
            self.write_cells(&mut group, i, column.column_type)?;
        }
        group.close()?;
        writer.close()?;
        Ok(bytes)
    }

    fn parquet_schema(&self) -> Result<types::Type, ParquetError> {
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
        if !self.place_names.is_empty() {
            let text = Some(LogicalType::String);
            fields.push(field(
                "name",
                Physical::BYTE_ARRAY,
                text,
                Repetition::REQUIRED,
            )?);
        }
        for (name, column) in self.column_names.iter().zip(columns::ALL) {
            let (of, logical) = match column.column_type {
                ColumnType::Real => (Physical::DOUBLE, None),
                ColumnType::Integer => (Physical::INT64, None),
                ColumnType::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
            };
            fields.push(field(name, of, logical, Repetition::OPTIONAL)?);
        }
        types::Type::group_type_builder("best_shots")
            .with_fields(fields)
            .build()
    }

    fn parquet_properties(&self) -> WriterProperties {
        let provenance = json::in_si(&self.provenance);
        let metadata = provenance.as_object().into_iter().flatten();
        let metadata = metadata.map(|(key, value)| {
            let text = value
                .as_str()
                .map_or_else(|| value.to_string(), str::to_owned);
            KeyValue::new(format!("bankshot.{key}"), text)
        });
        WriterProperties::builder()
            .set_created_by(format!("bankshot {}", env!("CARGO_PKG_VERSION")))
            .set_key_value_metadata(Some(metadata.collect()))
            .build()
    }

    /// Writes the cells of column `i`.
    fn write_cells(
        &self,
        group: &mut SerializedRowGroupWriter<'_, &mut Vec<u8>>,
        i: usize,
        column_type: ColumnType,
    ) -> Result<(), ParquetError> {
        let cells = || self.lines.iter().map(|line| &line.cells[i]);
        let levels: Vec<i16> = cells().map(|cell| i16::from(*cell != Cell::Null)).collect();
        let levels = Some(&levels[..]);
        match column_type {
            ColumnType::Real => {
                let values: Vec<f64> = cells()
                    .filter_map(|cell| match cell {
                        Cell::Real(value) => Some(*value),
                        _ => None,
                    })
                    .collect();
                write_column::<DoubleType>(group, &values, levels)
            }
            ColumnType::Integer => {
                let values: Vec<i64> = cells()
                    .filter_map(|cell| match cell {
                        Cell::Integer(value) => Some(*value),
                        _ => None,
                    })
                    .collect();
                write_column::<Int64Type>(group, &values, levels)
            }
            ColumnType::Text => {
                let values: Vec<ByteArray> = cells()
                    .filter_map(|cell| match cell {
                        Cell::Text(text) => Some(ByteArray::from(text.as_str())),
                        _ => None,
                    })
                    .collect();
                write_column::<ByteArrayType>(group, &values, levels)
            }
        }
    }

    /// The provenance of the tables as JSON.
    #[must_use]
    pub fn provenance(&self, config: &SweepConfig) -> Vec<u8> {
        let answer = TablesProvenance {
            configuration_si: serde_json::to_value(config).ok(),
            ..self.provenance.clone()
        };
        json::text(&json::in_si(&answer)).into_bytes()
    }
}

fn provenance_of(
    config: &SweepConfig,
    hash: &str,
    jobs: &Jobs,
    jobs_done: usize,
) -> TablesProvenance {
    let settings = &config.settings;
    TablesProvenance {
        provenance: Provenance::new(hash, &settings.physics, settings.search.seed()),
        sweep: config.name.clone(),
        shooter: settings.shooter.name.clone(),
        court: config.league.name(),
        standard_error_wanted: rounded(settings.search.standard_error()),
        places: jobs.sources.len(),
        jobs: jobs.count(),
        jobs_done,
        configuration_si: None,
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

fn in_units(cells: &[Cell], units: UnitSystem) -> Vec<Cell> {
    columns::ALL
        .iter()
        .zip(cells)
        .map(|(column, cell)| match cell {
            Cell::Real(value) => Cell::Real(rounded(value / column.unit.in_system(units).1)),
            other => other.clone(),
        })
        .collect()
}
