//! Runs the program, and a sweep that takes about a second.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// Six computed spots of nine, both kinds.
pub(crate) const SMALL_SWEEP: &str = include_str!("../small_sweep.toml");

/// The program, in the root of the repository and without input.
pub(crate) fn bankshot() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bankshot"));
    command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::null());
    command
}

/// Runs a command that must succeed.
#[track_caller]
pub(crate) fn succeed(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    output
}

/// Runs a command that must refuse its arguments.
#[track_caller]
pub(crate) fn be_refused(command: &mut Command) -> Output {
    let output = command.output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    output
}

/// Everything that a command printed.
pub(crate) fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// A temporary folder with the results of a small sweep.
pub(crate) struct SweepRun {
    folder: TempDir,
}

impl SweepRun {
    /// Runs a sweep with the given configuration.
    pub(crate) fn new(config: &str) -> Self {
        let run = Self {
            folder: TempDir::new().unwrap(),
        };
        let path = run.path("sweep.toml");
        fs::write(&path, config).unwrap();
        let mut command = bankshot();
        command.arg("sweep").arg(&path).arg("--out");
        succeed(command.arg(run.results()).arg("--quiet"));
        run
    }

    /// The folder of the results.
    pub(crate) fn results(&self) -> PathBuf {
        self.path("results")
    }

    /// A path beside the results.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The folder that contains the results.
    pub(crate) fn folder(&self) -> &Path {
        self.folder.path()
    }
}

/// Writes the report page of a run, and returns its path.
#[track_caller]
pub(crate) fn write_report(folder: &Path) -> PathBuf {
    succeed(bankshot().arg("report").arg(folder));
    folder.join("report.html")
}
