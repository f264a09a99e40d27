//! Runs the program and checks what it prints.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

pub(crate) const FREE_THROW: &str = include_str!("paper_free_throw.toml");

/// Three releases: a swish, a bank shot and an airball.
pub(crate) const RELEASES: &str = "\
note,pitch_deg,speed_ft_s,distance_ft,court_angle_deg,release_height_ft,polar_deg,backspin_rev_s
swish,52,23.5,13.75,0,7,0,0
bank,52,24.7,13.75,0,7,0,3
short,52,22.0,13.75,0,7,0,3
";

/// The program, in the root of the repository and without input.
pub(crate) fn bankshot() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_bankshot"));
    command
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdin(Stdio::null());
    command
}

/// What a command printed, and its exit code.
pub(crate) struct Answer {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: Vec<u8>,
    pub(crate) stderr: String,
}

impl std::fmt::Debug for Answer {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let printed = String::from_utf8_lossy(&self.stdout);
        write!(out, "exit code {:?}\n{printed}\n{}", self.code, self.stderr)
    }
}

impl From<Output> for Answer {
    fn from(output: Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: output.stdout,
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }
}

impl Answer {
    /// Runs a command to its end.
    pub(crate) fn of(command: &mut Command) -> Self {
        command.output().unwrap().into()
    }

    /// Runs a command with a text as its input.
    pub(crate) fn with_input(command: &mut Command, input: String) -> Self {
        let mut child = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut stdin = child.stdin.take().unwrap();
        let writer = std::thread::spawn(move || stdin.write_all(input.as_bytes()));
        let output = child.wait_with_output().unwrap();
        writer.join().unwrap().unwrap();
        output.into()
    }

    pub(crate) fn stdout(&self) -> &str {
        std::str::from_utf8(&self.stdout).unwrap()
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_slice(&self.stdout).unwrap()
    }

    /// Checks the exit code.
    #[track_caller]
    pub(crate) fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:?}");
        self
    }

    /// Checks that standard output contains a text.
    #[track_caller]
    pub(crate) fn prints(self, text: &str) -> Self {
        assert!(self.stdout().contains(text), "{text} in {}", self.stdout());
        self
    }

    /// Checks that standard error contains a text.
    #[track_caller]
    pub(crate) fn says(self, text: &str) -> Self {
        assert!(self.stderr.contains(text), "{text} in {}", self.stderr);
        self
    }
}

/// A profile that is small enough to run in a moment.
pub(crate) fn small_profile() -> String {
    format!(
        "{FREE_THROW}\n[grid]\nspeed = 16\npitch = 12\npolar = 12\nbackspin = 4\n[search]\nstandard_error = 0.01\nclimb_samples = 128\n"
    )
}

/// Makes the searches from the profiles of a fit small enough to run in a moment.
pub(crate) fn make_search_small(fit: &Path) {
    let small = small_profile().split_off(FREE_THROW.len());
    let mut profiles = 0;
    for entry in fs::read_dir(fit).unwrap() {
        let path = entry.unwrap().path();
        if path
            .extension()
            .is_some_and(|extension| extension == "toml")
        {
            let profile = fs::read_to_string(&path).unwrap();
            // What the fit says of the search stays.
            let own = "choose = [\"speed\", \"pitch\", \"polar\"]\n";
            let small = match profile.split_once(own) {
                Some((before, after)) => {
                    let settings = small.replace("[search]\n", &format!("[search]\n{own}"));
                    let before = before.replace("[search]\n", "");
                    before + after + &settings
                }
                None => profile + &small,
            };
            fs::write(path, small).unwrap();
            profiles += 1;
        }
    }
    assert!(profiles > 0);
}

/// A small profile whose greatest speed is too low to reach the hoop.
pub(crate) fn too_slow_profile() -> String {
    small_profile().replace("[search]", "[search]\nspeed_max = \"5 m/s\"")
}

/// `bankshot best` on a profile, with the folder of its results.
pub(crate) fn best(profile: &Path, out: &Path) -> Command {
    let mut command = bankshot();
    command.arg("best").arg(profile).arg("--out").arg(out);
    command
}

/// Writes a file into a folder.
pub(crate) fn write_file(folder: &TempDir, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path
}

/// The names of the files in a folder, sorted.
pub(crate) fn file_names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Fits the shots of a file into a folder.
pub(crate) fn fit(file: &str, folder: &Path, flags: &[&str]) -> Answer {
    let mut command = bankshot();
    command
        .args(["fit", file, "--quiet", "--out"])
        .arg(folder)
        .args(flags);
    Answer::of(&mut command)
}
