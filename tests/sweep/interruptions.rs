//! Kills, panics and aborts: what was saved stays, and the tables are the same at the end.

use crate::support::{
    JOBS, SPOTS, TestFolder, assert_code, assert_printed, pause, printed, start, store, tables,
};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Half of the kills come while a thread waits at a random spot and another one computes; the other
/// half after a random time, which may be before the first spot. The times only vary the moment: a
/// sweep that ends before its kill is a finished round. `BANKSHOT_KILLS` gives another number.
#[test]
fn contract_a_hundred_kills_change_no_byte() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let mut random = ChaCha12Rng::seed_from_u64(5);
    let out = test.out("killed");
    let (mut kills, mut rounds, mut resumed) = (0, 0, 0);
    let wanted = std::env::var("BANKSHOT_KILLS").map_or(100, |count| count.parse().unwrap());
    while kills < wanted {
        let waits = random.random::<bool>();
        let delay_s = if waits { 0.05 } else { 0.5 } * random.random::<f64>();
        let (mut command, file) = test.waiting_command(&out, random.random_range(0..SPOTS));
        if !waits {
            command = test.command(&out);
        }
        command.args(["--threads", "2"]);
        let mut child = start(command);
        let mut has_ended = || child.try_wait().unwrap().is_some();
        while waits && !file.exists() && !has_ended() {
            pause();
        }
        let until = Instant::now() + Duration::from_secs_f64(delay_s);
        while Instant::now() < until && !has_ended() {
            pause();
        }
        // This does nothing to a sweep that has ended.
        let _ = child.kill();
        let output = child.wait_with_output().unwrap();
        resumed += usize::from(printed(&output).contains("resuming: "));
        match output.status.code() {
            None => kills += 1,
            Some(0) => {
                assert_eq!(tables(&out), bytes);
                rounds += 1;
                fs::remove_dir_all(&out).unwrap();
            }
            Some(_) => panic!("{output:?}"),
        }
    }
    let output = test.run(&out, &["--quiet"]);
    assert_code(&output, 0);
    assert_eq!(tables(&out), bytes);
    // A thread that waits at spot n has seen n - 1 spots saved, so enough runs resume on any
    // machine.
    assert!(resumed > 10, "{rounds} rounds, {resumed} resumed");
}

/// The finished jobs in the store of a folder, with the time of each.
fn times_of_jobs(out: &Path) -> Vec<(i64, f64)> {
    let connection = rusqlite::Connection::open(store(out)).unwrap();
    let mut statement = connection
        .prepare("SELECT job, seconds FROM timing ORDER BY job")
        .unwrap();
    let rows = statement
        .query_map([], |row| Ok((row.get(0)?, row.get(1)?)))
        .unwrap();
    rows.map(Result::unwrap).collect()
}

#[test]
fn contract_a_resumed_sweep_computes_no_finished_job_again() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let out = test.out("resumed");
    test.start_and_wait_at(&out, 4).kill();
    let before = times_of_jobs(&out);
    assert_eq!(before.len(), 8);
    let output = test.run(&out, &[]);
    assert_code(&output, 0);
    assert_printed(&output, &format!("resuming: 8 of {JOBS} done"));
    let after = times_of_jobs(&out);
    assert_eq!(after.len(), JOBS);
    for time in &before {
        // A job that was computed again would have another time.
        assert!(after.contains(time), "{time:?} {after:?}");
    }
    assert_eq!(tables(&out), bytes);
}

#[test]
fn contract_only_the_job_that_panics_fails() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let out = test.out("panic");
    let output = test.run(&out, &["--quiet", "--fault", "panic:2"]);
    assert_code(&output, 3);
    assert_printed(&output, "10 with a best shot");
    assert_printed(&output, "panicked: fault injected at spot 2");
    // It stays failed, and is listed, until the user asks for it again.
    let output = test.run(&out, &["--quiet"]);
    assert_code(&output, 3);
    assert_printed(&output, "panicked: fault injected at spot 2");
    let output = test.run(&out, &["--quiet", "--retry-failed"]);
    assert_code(&output, 0);
    assert_eq!(tables(&out), bytes);
}

#[cfg(unix)]
#[test]
fn contract_a_spot_that_aborts_the_program_twice_is_given_up_and_listed() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let out = test.out("abort");
    let faulty = ["--quiet", "--threads", "2", "--fault", "abort:2"];
    for _ in 0..2 {
        assert_eq!(test.run(&out, &faulty).status.code(), None);
    }
    let output = test.run(&out, &faulty);
    assert_code(&output, 3);
    assert_printed(&output, "10 with a best shot");
    assert_printed(&output, "the program aborted twice");
    let output = test.run(&out, &["--quiet", "--retry-failed"]);
    assert_code(&output, 0);
    assert_eq!(tables(&out), bytes);
}
