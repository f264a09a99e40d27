//! `fit.json`, with a right checksum, beside the files of a real fit: the first byte says whether
//! the bytes are sealed anew.
#![no_main]

use bankshot::cli::answer_of;
use bankshot::probability::Silent;
use bankshot::store::fit::Fit;
use bankshot::store::sealed::seal;
use libfuzzer_sys::fuzz_target;
use std::sync::{Arc, LazyLock};

/// A real fit, and its files.
static FOLDER: LazyLock<(tempfile::TempDir, [Vec<u8>; 2])> = LazyLock::new(|| {
    let folder = tempfile::tempdir_in("/dev/shm").unwrap();
    let fit = folder.path().join("fit");
    let shots = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/data/gym_sensor.csv");
    let arguments = ["bankshot", "fit", shots, "-o", fit.to_str().unwrap()];
    let answer = answer_of(&arguments.map(str::to_owned), Arc::new(Silent));
    assert_eq!(answer.exit_code, 0, "{}", answer.remarks);
    let files = FILES.map(|name| std::fs::read(fit.join(name)).unwrap());
    (folder, files)
});
const FILES: [&str; 2] = ["draws.parquet", "shots.csv"];

fuzz_target!(|bytes: &[u8]| {
    let Some((which, bytes)) = bytes.split_first() else {
        return;
    };
    let (folder, files) = &*FOLDER;
    let files = [(FILES[0], &files[0][..]), (FILES[1], &files[1][..])];
    let bytes = match which % 8 {
        0 => bytes.to_vec(),
        _ => match serde_json::from_slice(bytes) {
            Ok(value) => seal(value, &files).into_bytes(),
            Err(_) => return,
        },
    };
    let folder = folder.path().join("fit");
    std::fs::write(folder.join("fit.json"), bytes).unwrap();
    if let Ok(fit) = Fit::read(&folder) {
        assert!(!fit.profiles.is_empty());
    }
});
