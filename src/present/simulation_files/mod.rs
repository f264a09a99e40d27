//! The files of `simulate`: releases from CSV or Parquet, and the columns that a simulation adds.

pub mod outcome_columns;
pub mod release_columns;
