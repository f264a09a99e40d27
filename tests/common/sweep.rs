//! A sweep small enough for tests: 6 computed places of 9, both kinds, about a second.
#![allow(dead_code, unreachable_pub)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use tempfile::TempDir;

/// Jobs of the small sweep.
pub const JOBS: usize = 12;

pub const SWEEP: &str = include_str!("../small_sweep.toml");

/// A folder for tests with the small sweep in it.
pub struct Place {
    pub folder: TempDir,
    pub sweep: PathBuf,
}

impl Place {
    pub fn new() -> Self {
        Self::with(SWEEP)
    }

    pub fn with(text: &str) -> Self {
        let folder = TempDir::new().unwrap();
        let sweep = folder.path().join("sweep.toml");
        fs::write(&sweep, text).unwrap();
        Self { folder, sweep }
    }

    pub fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `bankshot sweep` into a folder.
    pub fn command(&self, out: &Path) -> Command {
        let mut command = bankshot();
        command.arg("sweep").arg(&self.sweep).arg("--out").arg(out);
        command
    }

    pub fn run(&self, out: &Path, more: &[&str]) -> Output {
        self.command(out).args(more).output().unwrap()
    }

    /// An undisturbed run, and its tables.
    pub fn undisturbed(&self) -> (PathBuf, Bytes) {
        let out = self.out("undisturbed");
        let output = self.run(&out, &["--threads", "2", "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let bytes = tables(&out);
        (out, bytes)
    }
}

pub fn bankshot() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bankshot"));
    command.stdin(Stdio::null());
    command
}

pub fn start(mut command: Command) -> Child {
    command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The bytes of the tables of a folder.
#[derive(Debug, PartialEq, Eq)]
pub struct Bytes(Vec<Vec<u8>>);

pub fn tables(out: &Path) -> Bytes {
    Bytes(
        ["best_shots.csv", "best_shots.parquet", "provenance.json"]
            .map(|name| fs::read(out.join(name)).unwrap())
            .into(),
    )
}

/// The store of a folder that one process wrote.
pub fn store(out: &Path) -> PathBuf {
    stores(out).pop().unwrap()
}

pub fn stores(out: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = fs::read_dir(out.join("store"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "sqlite"))
        .collect();
    found.sort();
    found
}

/// Copies the configuration and the stores, not the tables.
pub fn copy_unfinished(from: &Path, to: &Path) {
    fs::create_dir_all(to.join("store")).unwrap();
    fs::copy(
        from.join("configuration.json"),
        to.join("configuration.json"),
    )
    .unwrap();
    for path in stores(from) {
        fs::copy(&path, to.join("store").join(path.file_name().unwrap())).unwrap();
    }
}

pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}
