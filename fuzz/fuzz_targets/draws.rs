//! `draws.parquet`.
#![no_main]

use bankshot::fitting::SpinSource;
use bankshot::store::draws::read_draws;
use libfuzzer_sys::fuzz_target;
use std::fs::File;
use std::sync::LazyLock;

static FOLDER: LazyLock<tempfile::TempDir> =
    LazyLock::new(|| tempfile::tempdir_in("/dev/shm").unwrap());

fuzz_target!(|bytes: &[u8]| {
    let path = FOLDER.path().join("draws.parquet");
    std::fs::write(&path, bytes).unwrap();
    if let Ok(posterior) = read_draws(File::open(&path).unwrap(), SpinSource::Assumed, 10) {
        assert!(!posterior.draws.is_empty());
    }
});
