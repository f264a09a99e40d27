//! The files of `simulate`: releases from CSV or Parquet, and the columns that a simulation adds.

pub mod csv_records;
pub mod outcome_columns;
pub mod parquet_rows;
pub mod release_columns;
