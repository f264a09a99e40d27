//! Files: complete or absent, and rows of text cells from and to CSV and Parquet. Knows nothing of
//! basketball.

pub mod atomic_file;
pub mod csv_records;
pub mod parquet_rows;
