//! Output files: unwritable targets, links, devices and interrupted runs.

use super::support::{Answer, RELEASES, bankshot, best, small_profile, write_file};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// `bankshot simulate` from a file to a file.
fn simulate(releases: &Path, output: &Path) -> Answer {
    let mut command = bankshot();
    command.arg("simulate").arg(releases);
    Answer::of(command.arg("--output").arg(output))
}

#[test]
fn contract_unwritable_outputs_exit_74() {
    let folder = TempDir::new().unwrap();
    let blocker = write_file(&folder, "file", "x");
    let profile = write_file(&folder, "p.toml", small_profile());
    Answer::of(&mut best(&profile, &blocker)).exits(74);
    let releases = write_file(&folder, "r.csv", RELEASES);
    for target in [folder.path().to_owned(), folder.path().join("none/out.csv")] {
        simulate(&releases, &target).exits(74);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn contract_a_full_output_exits_74() {
    let folder = TempDir::new().unwrap();
    let releases = write_file(&folder, "r.csv", RELEASES);
    let full = fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let mut command = bankshot();
    command.arg("simulate").arg(&releases);
    let status = command.args(["--output", "-"]).stdout(full).status();
    assert_eq!(status.unwrap().code(), Some(74));
}

#[cfg(unix)]
#[test]
fn contract_outputs_follow_links_and_write_through_devices() {
    let folder = TempDir::new().unwrap();
    let releases = write_file(&folder, "r.csv", RELEASES);
    let real = write_file(&folder, "real.csv", "old");
    let link = folder.path().join("link.csv");
    std::os::unix::fs::symlink(&real, &link).unwrap();
    simulate(&releases, &link).exits(0);
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&real).unwrap().lines().count(), 4);
    simulate(&releases, Path::new("/dev/null")).exits(0);
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[cfg(unix)]
#[test]
fn contract_ctrl_c_leaves_no_file() {
    use super::support::file_names;
    use std::io::Write;
    use std::process::{Command, Stdio};

    let folder = TempDir::new().unwrap();
    let mut child = bankshot()
        .args(["simulate", "-", "--output", "out.csv"])
        .current_dir(folder.path())
        .stdin(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(RELEASES.as_bytes()).unwrap();
    input.flush().unwrap();
    // The temporary file appears once the program has read the header.
    while file_names(folder.path()).is_empty() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert_eq!(file_names(folder.path()).len(), 1);
    let id = child.id().to_string();
    let status = Command::new("kill").args(["-INT", &id]).status();
    assert!(status.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(file_names(folder.path()).is_empty());
    drop(input);
}
