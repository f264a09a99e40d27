//! The sweep behind `docs/pictures/bank_and_direct.svg`. `examples/draw_half_court.rs` uses this
//! file too.

use bankshot::sweep::columns::{self, ColumnType};
use bankshot::sweep::result_row::{Cell, ResultRow};
use bankshot::sweep::sweep_toml::{SourceTexts, SweepConfig, parse_sweep};
use std::collections::BTreeMap;
use std::fs;

const RESULTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/data/half_court.csv");

/// The results of `bankshot sweep configs/half_court.toml`, in SI units.
pub(crate) struct HalfCourt {
    /// The sweep.
    pub(crate) config: SweepConfig,
    /// The results by the number of their job.
    pub(crate) rows: BTreeMap<u64, ResultRow>,
}

impl HalfCourt {
    /// Reads the configuration from `configs/`, and the results from `docs/data/half_court.csv`.
    /// The store of the sweep gives these by `SELECT job, kind, status, probability,
    /// standard_error, pitch_rad, backspin_rad_s FROM results ORDER BY job`.
    pub(crate) fn load() -> Self {
        let columns = result_columns();
        let mut reader = csv::Reader::from_path(RESULTS).unwrap();
        let rows = reader.records().map(|record| {
            let record = record.unwrap();
            let row = result_row(&record, &columns);
            (row.job, row)
        });
        Self {
            config: half_court_config(),
            rows: rows.collect(),
        }
    }
}

/// The columns of the results, as indices of [`columns::ALL`].
pub(crate) fn result_columns() -> Vec<usize> {
    let mut reader = csv::Reader::from_path(RESULTS).unwrap();
    let header = reader.headers().unwrap();
    assert_eq!(&header[0], "job");
    header.iter().skip(1).map(column_of).collect()
}

fn half_court_config() -> SweepConfig {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/configs");
    let read = |name: &str| fs::read_to_string(format!("{folder}/{name}")).unwrap();
    let texts = SourceTexts {
        sweep: read("half_court.toml"),
        shooter: Some(read("free_throw.toml")),
        places: None,
    };
    parse_sweep(&texts, "half_court.toml").unwrap()
}

/// The index of a column with the given name in the store.
fn column_of(name: &str) -> usize {
    let mut all = columns::ALL.iter();
    all.position(|column| column.si_name() == name).unwrap()
}

fn result_row(record: &csv::StringRecord, columns: &[usize]) -> ResultRow {
    let mut cells = vec![Cell::Null; columns::ALL.len()];
    for (&column, text) in columns.iter().zip(record.iter().skip(1)) {
        cells[column] = match columns::ALL[column].column_type {
            _ if text.is_empty() => Cell::Null,
            ColumnType::Real => Cell::Real(text.parse().unwrap()),
            ColumnType::Integer => Cell::Integer(text.parse().unwrap()),
            ColumnType::Text => Cell::Text(text.to_owned()),
        };
    }
    ResultRow::from_cells(record[0].parse().unwrap(), cells).unwrap()
}
