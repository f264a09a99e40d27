//! Parquet files of rows.
#![no_main]

use bankshot::files::parquet_rows::ParquetRows;
use libfuzzer_sys::fuzz_target;
use std::fs::File;
use std::sync::LazyLock;

static FOLDER: LazyLock<tempfile::TempDir> =
    LazyLock::new(|| tempfile::tempdir_in("/dev/shm").unwrap());

fuzz_target!(|bytes: &[u8]| {
    let path = FOLDER.path().join("rows.parquet");
    std::fs::write(&path, bytes).unwrap();
    if let Ok(mut rows) = ParquetRows::open(File::open(&path).unwrap()) {
        let width = rows.header().len();
        while let Ok(batch) = rows.next_rows(100, 1 << 20) {
            if batch.is_empty() {
                break;
            }
            for cells in batch.into_iter().filter_map(|row| row.cells.ok()) {
                assert_eq!(cells.len(), width);
            }
        }
    }
});
