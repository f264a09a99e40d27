//! A sweep that is small enough for tests, and helpers to run, interrupt and compare it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Jobs of the small sweep: two kinds at each of 6 computed spots.
pub(crate) const JOBS: usize = 12;

/// Computed spots of the small sweep.
pub(crate) const SPOTS: usize = 6;

pub(crate) const SWEEP: &str = include_str!("../small_sweep.toml");

/// Ends a test that hangs. No test expects anything to happen sooner.
const HANG_LIMIT: Duration = Duration::from_secs(120);

/// A temporary folder with the TOML of a sweep.
pub(crate) struct TestFolder {
    pub(crate) folder: TempDir,
    pub(crate) sweep: PathBuf,
}

impl TestFolder {
    pub(crate) fn new() -> Self {
        Self::with(SWEEP)
    }

    pub(crate) fn with(text: &str) -> Self {
        let folder = TempDir::new().unwrap();
        let sweep = folder.path().join("sweep.toml");
        fs::write(&sweep, text).unwrap();
        Self { folder, sweep }
    }

    pub(crate) fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `bankshot sweep` into a folder.
    pub(crate) fn command(&self, out: &Path) -> Command {
        let mut command = bankshot();
        command.arg("sweep").arg(&self.sweep).arg("--out").arg(out);
        command
    }

    /// `bankshot sweep` into a folder, with a wait at a spot; and the file that the program creates
    /// there.
    pub(crate) fn waiting_command(&self, out: &Path, spot: usize) -> (Command, PathBuf) {
        let file = self.out("waiting");
        let _ = fs::remove_file(&file);
        let mut command = self.command(out);
        let fault = format!("wait:{spot}:{}", file.display());
        command.args(["--fault", &fault]);
        (command, file)
    }

    /// Starts a sweep on one thread and returns once it waits at a spot. All spots before it are
    /// then saved.
    pub(crate) fn start_and_wait_at(&self, out: &Path, spot: usize) -> WaitingSweep {
        let (mut command, file) = self.waiting_command(out, spot);
        command.args(["--threads", "1"]);
        WaitingSweep::start(command, file)
    }

    pub(crate) fn run(&self, out: &Path, options: &[&str]) -> Output {
        self.command(out).args(options).output().unwrap()
    }

    /// Runs the sweep without a disturbance; returns its folder and its tables.
    pub(crate) fn undisturbed(&self) -> (PathBuf, Tables) {
        let out = self.out("undisturbed");
        let output = self.run(&out, &["--threads", "2", "--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let bytes = tables(&out);
        (out, bytes)
    }
}

/// A sweep that waits at a spot while a file exists.
pub(crate) struct WaitingSweep {
    pub(crate) child: Child,
    file: PathBuf,
}

impl WaitingSweep {
    /// Starts a command of [`TestFolder::waiting_command`] and returns once the program has created
    /// the file.
    pub(crate) fn start(command: Command, file: PathBuf) -> Self {
        let mut child = start(command);
        // The program writes its process number right after it has created the file.
        let is_waiting = || fs::read_to_string(&file).is_ok_and(|text| !text.is_empty());
        let began = Instant::now();
        while !is_waiting() {
            let has_ended = child.try_wait().unwrap().is_some();
            if has_ended || began.elapsed() > HANG_LIMIT {
                let _ = child.kill();
                panic!("it never waits: {:?}", child.wait_with_output().unwrap());
            }
            pause();
        }
        let process = fs::read_to_string(&file).unwrap();
        assert_eq!(process, child.id().to_string());
        Self { child, file }
    }

    /// Lets it continue to its end.
    pub(crate) fn release(self) -> Output {
        fs::remove_file(&self.file).unwrap();
        output_at_end(self.child)
    }

    /// Its output after it has ended during the wait. A sweep that still waits fails the test.
    pub(crate) fn interrupted(self) -> Output {
        let output = output_at_end(self.child);
        assert!(self.file.exists(), "{output:?}");
        output
    }

    /// Kills it, as `kill -9` does.
    pub(crate) fn kill(mut self) {
        self.child.kill().unwrap();
        let output = self.interrupted();
        assert_eq!(output.status.code(), None, "{output:?}");
    }
}

pub(crate) fn bankshot() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bankshot"));
    command.stdin(Stdio::null());
    command
}

pub(crate) fn start(mut command: Command) -> Child {
    command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The pause between two looks at a state.
pub(crate) fn pause() {
    std::thread::sleep(Duration::from_millis(2));
}

/// Waits for the end of a program, and fails the test if it hangs.
fn output_at_end(mut child: Child) -> Output {
    let began = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if began.elapsed() > HANG_LIMIT {
            let _ = child.kill();
            panic!("it does not end: {:?}", child.wait_with_output().unwrap());
        }
        pause();
    }
    child.wait_with_output().unwrap()
}

/// The bytes of the tables of a folder.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Tables(Vec<Vec<u8>>);

pub(crate) fn tables(out: &Path) -> Tables {
    Tables(
        ["best_shots.csv", "best_shots.parquet", "provenance.json"]
            .map(|name| fs::read(out.join(name)).unwrap())
            .into(),
    )
}

/// The store of a folder that one process wrote.
pub(crate) fn store(out: &Path) -> PathBuf {
    let mut found = stores(out);
    assert_eq!(found.len(), 1, "{found:?}");
    found.remove(0)
}

pub(crate) fn stores(out: &Path) -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> = fs::read_dir(out.join("store"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "sqlite"))
        .collect();
    found.sort();
    found
}

/// Copies the manifest and the stores, but not the tables.
pub(crate) fn copy_unfinished(from: &Path, to: &Path) {
    fs::create_dir_all(to.join("store")).unwrap();
    let name = "configuration.json";
    fs::copy(from.join(name), to.join(name)).unwrap();
    for path in stores(from) {
        fs::copy(&path, to.join("store").join(path.file_name().unwrap())).unwrap();
    }
}

/// Everything that a program printed.
pub(crate) fn printed(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

/// Asserts that a program ended with an exit code.
#[track_caller]
pub(crate) fn assert_code(output: &Output, code: i32) {
    assert_eq!(output.status.code(), Some(code), "{output:?}");
}

/// Asserts that a program printed a text.
#[track_caller]
pub(crate) fn assert_printed(output: &Output, text: &str) {
    assert!(printed(output).contains(text), "{text}: {output:?}");
}
