//! Files: complete or absent, and rows of text cells from and to CSV, Parquet, JSON and workbooks.
//! Knows nothing of basketball.

pub mod atomic_file;
pub mod csv_records;
pub mod csv_text;
pub mod file_kind;
mod header_row;
mod json_rows;
mod library_panics;
mod parquet_headers;
mod parquet_pages;
pub mod parquet_rows;
pub mod table_rows;
mod text_encoding;
mod workbook_rows;
