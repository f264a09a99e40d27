//! System calls that fail during a sweep: full disks, defective disks, death at any call. These
//! tests need strace. Without it they are skipped, unless `BANKSHOT_NO_SKIP` is set.
#![cfg(target_os = "linux")]

use crate::support::{Tables, TestFolder, printed, store, tables};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Whether strace can trace here. If not, says that the test is skipped.
fn can_trace() -> bool {
    let trial = Command::new("strace")
        .args(["-f", "-o", "/dev/null", "true"])
        .output();
    let reason = match trial {
        Ok(output) if output.status.success() => return true,
        Ok(output) => format!("strace cannot trace: {}", printed(&output)),
        Err(_) => "strace is not installed".to_owned(),
    };
    assert!(std::env::var_os("BANKSHOT_NO_SKIP").is_none(), "{reason}");
    eprintln!("skipped: {reason}");
    false
}

/// Runs a sweep with faults injected into its system calls.
fn run_with_faults(test: &TestFolder, out: &Path, faults: &[&str]) -> Output {
    run_with_faults_at(test, out, faults, None)
}

/// The same, but only into the calls about one file.
fn run_with_faults_at(
    test: &TestFolder,
    out: &Path,
    faults: &[&str],
    file: Option<&Path>,
) -> Output {
    let sweep = test.command(out);
    let mut command = Command::new("strace");
    command.args(["-f", "-qq", "-o", "/dev/null"]);
    for fault in faults {
        command.args(["-e", &format!("inject={fault}")]);
    }
    if let Some(file) = file {
        command.arg("-P").arg(file);
    }
    command
        .arg(sweep.get_program())
        .args(sweep.get_args())
        .args(["--quiet", "--threads", "2"])
        .output()
        .unwrap()
}

/// Once the faults have ended, the same command must give the undisturbed bytes.
fn assert_recovery(test: &TestFolder, out: &Path, bytes: &Tables, what: &str) {
    let output = test.run(out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{what}: {output:?}");
    assert_eq!(tables(out), *bytes, "{what}");
}

#[test]
fn contract_a_full_disk_stops_the_sweep_and_loses_no_saved_result() {
    if !can_trace() {
        return;
    }
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    // Every write from the given one on fails, as when a disk fills.
    for (call, error, from) in [
        ("pwrite64", "ENOSPC", 3),
        ("pwrite64", "ENOSPC", 30),
        ("pwrite64", "ENOSPC", 60),
        ("pwrite64", "EIO", 40),
        ("pwrite64", "EDQUOT", 50),
    ] {
        let what = format!("{call} {error} from {from}");
        let out = test.out(&what.replace(' ', "-"));
        let fault = format!("{call}:error={error}:when={from}+");
        let output = run_with_faults(&test, &out, &[&fault]);
        assert_eq!(output.status.code(), Some(74), "{what}: {output:?}");
        assert!(!printed(&output).contains("panicked"), "{what}: {output:?}");
        assert_recovery(&test, &out, &bytes, &what);
    }
}

#[test]
fn contract_a_failed_sync_stops_the_sweep() {
    if !can_trace() {
        return;
    }
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    for when in [2, 6, 12] {
        let what = format!("sync {when}");
        let out = test.out(&what.replace(' ', "-"));
        let faults = ["fsync", "fdatasync"].map(|call| format!("{call}:error=EIO:when={when}"));
        let output = run_with_faults(&test, &out, &[&faults[0], &faults[1]]);
        assert_eq!(output.status.code(), Some(74), "{what}: {output:?}");
        assert_recovery(&test, &out, &bytes, &what);
    }
}

#[test]
fn contract_a_disk_that_cannot_be_read_is_not_reported_as_a_damaged_file() {
    if !can_trace() {
        return;
    }
    let test = TestFolder::new();
    let (out, bytes) = test.undisturbed();
    for when in [1, 2, 4] {
        let fault = format!("pread64:error=EIO:when={when}+");
        let output = run_with_faults_at(&test, &out, &[&fault], Some(&store(&out)));
        assert_eq!(output.status.code(), Some(74), "{when}: {output:?}");
        let set_aside = fs::read_dir(out.join("store"))
            .unwrap()
            .filter(|entry| {
                let name = entry.as_ref().unwrap().file_name();
                name.to_string_lossy().contains("damaged")
            })
            .count();
        assert_eq!(set_aside, 0, "{when}");
        assert_recovery(&test, &out, &bytes, "reading");
    }
}

#[test]
fn contract_death_at_any_write_loses_nothing_that_was_saved() {
    if !can_trace() {
        return;
    }
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    for (call, step) in [
        ("pwrite64", 9),
        ("fdatasync", 5),
        ("fsync", 3),
        ("unlink", 4),
        ("rename", 1),
    ] {
        for round in 0..3 {
            let when = 1 + round * step;
            let what = format!("{call} {when}");
            let out = test.out(&what.replace(' ', "-"));
            let fault = format!("{call}:signal=KILL:when={when}");
            // Without such a call the sweep ends normally.
            run_with_faults(&test, &out, &[&fault]);
            assert_recovery(&test, &out, &bytes, &what);
        }
    }
}
