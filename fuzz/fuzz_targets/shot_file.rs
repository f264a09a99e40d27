//! Files of measured shots of any kind: text, JSON, workbook, Parquet.
#![no_main]

use bankshot::answers::shot_file::ShotFileRequest;
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FOLDER: LazyLock<tempfile::TempDir> =
    LazyLock::new(|| tempfile::tempdir_in("/dev/shm").unwrap());

fuzz_target!(|bytes: &[u8]| {
    let path = FOLDER.path().join("shots");
    std::fs::write(&path, bytes).unwrap();
    let request: ShotFileRequest = serde_json::from_str("{}").unwrap();
    let answer = request.answer(&path);
    serde_json::to_string(&answer).unwrap();
});
