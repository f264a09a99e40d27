//! Failing system calls under a sweep: full disks, broken disks, death at any call. Needs strace; without it the
//! tests say so and pass over.
#![cfg(target_os = "linux")]

#[path = "common/sweep.rs"]
mod support;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use support::{Bytes, Place, said, store, tables};

fn strace_works() -> bool {
    let works = Command::new("strace")
        .args(["-f", "-o", "/dev/null", "true"])
        .status()
        .is_ok_and(|status| status.success());
    if !works {
        eprintln!("passed over: strace is not there, or may not trace");
    }
    works
}

/// A sweep with faults injected into its system calls.
fn injected(place: &Place, out: &Path, faults: &[&str]) -> Output {
    traced(place, out, faults, None)
}

/// As there, only in the calls about one file.
fn traced(place: &Place, out: &Path, faults: &[&str], file: Option<&Path>) -> Output {
    let sweep = place.command(out);
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

/// After the faults are gone, the same command must give the undisturbed bytes.
fn recovers(place: &Place, out: &Path, bytes: &Bytes, what: &str) {
    let output = place.run(out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{what}: {output:?}");
    assert_eq!(tables(out), *bytes, "{what}");
}

#[test]
fn contract_a_full_disk_stops_it_with_what_is_safe() {
    if !strace_works() {
        return;
    }
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    // From the n-th write on, as a disk fills.
    for (call, error, from) in [
        ("pwrite64", "ENOSPC", 3),
        ("pwrite64", "ENOSPC", 30),
        ("pwrite64", "ENOSPC", 60),
        ("pwrite64", "EIO", 40),
        ("pwrite64", "EDQUOT", 50),
    ] {
        let what = format!("{call} {error} from {from}");
        let out = place.out(&what.replace(' ', "-"));
        let fault = format!("{call}:error={error}:when={from}+");
        let output = injected(&place, &out, &[&fault]);
        assert_eq!(output.status.code(), Some(74), "{what}: {output:?}");
        assert!(!said(&output).contains("panicked"), "{what}: {output:?}");
        recovers(&place, &out, &bytes, &what);
    }
}

#[test]
fn contract_a_failed_sync_is_not_believed() {
    if !strace_works() {
        return;
    }
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    for when in [2, 6, 12] {
        let what = format!("sync {when}");
        let out = place.out(&what.replace(' ', "-"));
        let faults = ["fsync", "fdatasync"].map(|call| format!("{call}:error=EIO:when={when}"));
        let output = injected(&place, &out, &[&faults[0], &faults[1]]);
        assert_eq!(output.status.code(), Some(74), "{what}: {output:?}");
        recovers(&place, &out, &bytes, &what);
    }
}

#[test]
fn contract_a_disk_that_cannot_be_read_is_not_taken_for_a_damaged_file() {
    if !strace_works() {
        return;
    }
    let place = Place::new();
    let (out, bytes) = place.undisturbed();
    for when in [1, 2, 4] {
        let fault = format!("pread64:error=EIO:when={when}+");
        let output = traced(&place, &out, &[&fault], Some(&store(&out)));
        assert_eq!(output.status.code(), Some(74), "{when}: {output:?}");
        let aside = fs::read_dir(out.join("store"))
            .unwrap()
            .filter(|entry| {
                let name = entry.as_ref().unwrap().file_name();
                name.to_string_lossy().contains("damaged")
            })
            .count();
        assert_eq!(aside, 0, "{when}");
        recovers(&place, &out, &bytes, "reading");
    }
}

#[test]
fn contract_death_at_any_write_loses_nothing_that_was_done() {
    if !strace_works() {
        return;
    }
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
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
            let out = place.out(&what.replace(' ', "-"));
            let fault = format!("{call}:signal=KILL:when={when}");
            // Where there is no such call it ends whole.
            injected(&place, &out, &[&fault]);
            recovers(&place, &out, &bytes, &what);
        }
    }
}
