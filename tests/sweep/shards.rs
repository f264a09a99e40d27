//! Shards, threads, and several processes in one folder.

use crate::support::{
    SWEEP, TestFolder, assert_code, assert_printed, bankshot, printed, stores, tables,
};
use bankshot::dynamics::InstructionSet;
use std::fs;

#[test]
fn contract_threads_shards_and_vector_instructions_change_no_byte() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let sets = InstructionSet::available();
    for (shards, threads) in [(1, 1), (2, 1), (3, 2), (7, 64)] {
        let out = test.out(&format!("{shards}"));
        for shard in 1..=shards {
            let mut command = test.command(&out);
            command
                .args(["--quiet", "--threads", &threads.to_string()])
                .args(["--shard", &format!("{shard}/{shards}")]);
            let instructions = sets[(shards + shard) % sets.len()].0;
            command.args(["--simd", instructions]);
            assert_code(&command.output().unwrap(), 0);
        }
        let output = bankshot().arg("merge").arg(&out).output().unwrap();
        assert_code(&output, 0);
        assert_eq!(tables(&out), bytes, "{shards} shards, {threads} threads");
    }
}

#[test]
fn contract_a_shard_fails_only_for_its_own_jobs() {
    let test = TestFolder::new();
    let out = test.out("own");
    for (options, code) in [
        (["--shard", "1/2", "--fault", "panic:0"], 3),
        (["--shard", "2/2", "--fault", "panic:99"], 0),
    ] {
        let output = test
            .command(&out)
            .arg("--quiet")
            .args(options)
            .output()
            .unwrap();
        assert_code(&output, code);
    }
}

#[test]
fn contract_missing_shards_are_listed_and_copies_of_stores_are_harmless() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let out = test.out("shards");
    for shard in ["1/6", "3/6", "6/6"] {
        assert_code(&test.run(&out, &["--quiet", "--shard", shard]), 0);
    }
    let run = |command: &str| {
        bankshot()
            .arg(command)
            .arg(&out)
            .args(["--shards", "6"])
            .output()
            .unwrap()
    };
    let output = run("merge");
    assert_code(&output, 3);
    assert_printed(&output, "--array=2,4-5");
    assert!(!out.join("best_shots.csv").exists());
    let output = run("missing");
    assert_code(&output, 3);
    assert_eq!(String::from_utf8(output.stdout).unwrap(), "2,4-5\n");
    // Another number of shards continues with the results that are saved.
    for shard in ["1/2", "2/2"] {
        assert_code(&test.run(&out, &["--quiet", "--shard", shard]), 0);
    }
    assert_code(&run("missing"), 0);
    for path in stores(&out) {
        fs::copy(&path, path.with_extension("copy.sqlite")).unwrap();
    }
    assert_code(&run("merge"), 0);
    assert_eq!(tables(&out), bytes);
}

#[test]
fn contract_a_second_run_in_a_folder_is_refused_and_the_first_is_named() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let out = test.out("twice");
    let first = test.start_and_wait_at(&out, 3);
    let output = test.run(&out, &["--quiet"]);
    assert_code(&output, 75);
    let holder = format!("is in use by process {}", first.child.id());
    assert_printed(&output, &holder);
    // A shard in the same folder is another store, and is allowed.
    let output = test.run(&out, &["--quiet", "--shard", "2/2"]);
    assert_code(&output, 0);
    assert!(printed(&output).starts_with("shard 2/2"), "{output:?}");
    // However the first run ends, the folder is then free.
    first.kill();
    assert_code(&test.run(&out, &["--quiet"]), 0);
    assert_eq!(tables(&out), bytes);
}

#[test]
fn contract_all_shards_are_refused_while_one_is_running() {
    let test = TestFolder::new();
    let out = test.out("shard");
    let (mut command, file) = test.waiting_command(&out, 0);
    command.args(["--shard", "1/2"]);
    let shard = crate::support::WaitingSweep::start(command, file);
    let output = test.run(&out, &["--quiet"]);
    assert_code(&output, 75);
    assert_printed(&output, &format!("process {}", shard.child.id()));
    assert_code(&shard.release(), 0);
    assert_code(&test.run(&out, &["--quiet"]), 0);
}

/// In air, at a ring with a rod, a bracket and edges: killed, continued with other instructions,
/// and computed again.
#[test]
fn contract_a_sweep_under_ncaa_resumes_and_verifies_to_the_same_bytes() {
    let test = TestFolder::with(&format!("{SWEEP}\n[physics]\npreset = \"ncaa\"\n"));
    let (undisturbed, bytes) = test.undisturbed();
    let out = test.out("resumed");
    test.start_and_wait_at(&out, 3).kill();
    assert_code(&test.run(&out, &["--simd", "scalar", "--quiet"]), 0);
    assert_eq!(tables(&out), bytes);
    for folder in [&undisturbed, &out] {
        let mut verify = bankshot();
        verify
            .arg("verify")
            .arg(folder)
            .args(["--recompute", "100%"]);
        assert_code(&verify.output().unwrap(), 0);
    }
    let paper = TestFolder::with(&format!("{SWEEP}\n[physics]\npreset = \"paper\"\n"));
    assert_ne!(paper.undisturbed().1, bytes);
}
