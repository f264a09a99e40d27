//! The store of a sweep. (`tests/fuzz` checks that damage gives no row that was not saved; a fuzzer that
//! sees comparisons can forge a checksum.)
#![no_main]

use bankshot::sweep::sqlite_results::{self, ResultStore};
use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

static FOLDER: LazyLock<tempfile::TempDir> =
    LazyLock::new(|| tempfile::tempdir_in("/dev/shm").unwrap());

fuzz_target!(|bytes: &[u8]| {
    let path = FOLDER.path().join("store.sqlite");
    std::fs::write(&path, bytes).unwrap();
    let _ = sqlite_results::read_rows(&path, "hash", 10, |row| assert!(row.job < 10));
    let _ = ResultStore::open(&path, "hash");
    let _ = std::fs::remove_file(FOLDER.path().join("store.sqlite-journal"));
});
