//! `trace`, completions and the manual page.

use super::support::{Answer, bankshot};
use std::fs;
use std::process::Command;
use tempfile::TempDir;

/// `bankshot trace` of the free throw, with the paper's physics and some options.
fn trace(options: &[&str]) -> Command {
    let mut command = bankshot();
    command
        .args(["trace", "configs/free_throw.toml", "--physics", "paper"])
        .args(options);
    command
}

#[test]
fn contract_trace_says_what_happened() {
    let folder = TempDir::new().unwrap();
    let csv = folder.path().join("t.csv");
    let shot = [
        "--speed",
        "24.7 ft/s",
        "--pitch",
        "52 deg",
        "--backspin",
        "3 rev/s",
    ];
    Answer::of(trace(&shot).arg("--output").arg(&csv))
        .exits(0)
        .prints("goes in off the board")
        .prints("touches the board");
    let text = fs::read_to_string(csv).unwrap();
    assert!(text.starts_with("time_s,x_ft,y_ft,z_above_ring_ft,"));
    let on_board = text.lines().filter(|line| line.ends_with(",1,0")).count();
    assert!(on_board >= 8, "dense in contact");
}

#[test]
fn contract_trace_names_each_bad_flag() {
    Answer::of(&mut trace(&["--speed", "24.7", "--pitch", "52 ft"]))
        .exits(2)
        .says("--speed")
        .says("--pitch");
}

#[test]
fn contract_completions_manual_page_and_help_are_printed() {
    Answer::of(bankshot().args(["completions", "bash"]))
        .exits(0)
        .prints("bankshot");
    Answer::of(bankshot().arg("man"))
        .exits(0)
        .prints(".TH bankshot");
    for command in ["best", "check", "plan", "simulate", "trace"] {
        Answer::of(bankshot().args([command, "--help"])).exits(0);
    }
}
