//! Signals and kills. All of them reach a sweep that waits at a spot, so the speed of the machine
//! is irrelevant.
#![cfg(unix)]

use crate::support::{JOBS, TestFolder, WaitingSweep, assert_code, assert_printed, tables};
use std::process::{Command, Stdio};

/// Sends a signal to a process. The process may have ended already.
fn send(signal: &str, process: u32) {
    let _ = Command::new("kill")
        .args([&format!("-{signal}"), &process.to_string()])
        .stderr(Stdio::null())
        .status()
        .unwrap();
}

/// Whether a process ignores SIGHUP.
#[cfg(target_os = "linux")]
fn ignores_hangup(process: u32) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let mask = status
        .lines()
        .find_map(|line| line.strip_prefix("SigIgn:"))
        .unwrap();
    u64::from_str_radix(mask.trim(), 16).unwrap() & 1 == 1
}

/// The same command, with SIGHUP not ignored even if the tests themselves run under `nohup`.
fn with_default_hangup(command: Command) -> Command {
    #[cfg(target_os = "linux")]
    if ignores_hangup(std::process::id()) {
        let mut env = Command::new("env");
        env.arg("--default-signal=HUP")
            .arg(command.get_program())
            .args(command.get_args())
            .stdin(Stdio::null());
        return env;
    }
    command
}

#[test]
fn contract_a_signal_ends_a_sweep_and_the_same_command_continues() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let out = test.out("signals");
    for (spot, signal, is_sent_twice, code) in [
        (1, "TERM", false, 75),
        (2, "INT", true, 130),
        (4, "HUP", false, 75),
    ] {
        let (mut command, file) = test.waiting_command(&out, spot);
        command.args(["--threads", "1"]);
        let sweep = WaitingSweep::start(with_default_hangup(command), file);
        let process = sweep.child.id();
        send(signal, process);
        if is_sent_twice {
            send(signal, process);
        }
        // Nobody deletes the file: only the signal can end the wait.
        let output = sweep.interrupted();
        assert_code(&output, code);
        let saved = 2 * spot;
        assert_printed(
            &output,
            &format!(
                "stopped: {saved} of {JOBS} jobs are saved; run the same command again to continue"
            ),
        );
        assert!(!out.join("best_shots.csv").exists());
    }
    let output = test.run(&out, &[]);
    assert_code(&output, 0);
    assert_printed(&output, &format!("resuming: 8 of {JOBS} done"));
    assert_eq!(tables(&out), bytes);
}

#[cfg(target_os = "linux")]
#[test]
fn contract_a_hangup_that_the_shell_ignores_stays_ignored() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let out = test.out("nohup");
    let (sweep, file) = test.waiting_command(&out, 0);
    let mut command = Command::new("sh");
    command
        .args(["-c", "trap '' HUP; exec \"$@\"", "sh"])
        .arg(sweep.get_program())
        .args(sweep.get_args());
    let sweep = WaitingSweep::start(command, file);
    let process = sweep.child.id();
    assert!(ignores_hangup(process));
    send("HUP", process);
    let output = sweep.release();
    assert_code(&output, 0);
    assert_eq!(tables(&out), bytes);
}
