//! Files, limits and environments that attack: one message, a documented exit code, and nothing
//! half written. `docs/reliability.md` has the table.

use crate::support::*;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};
use tempfile::TempDir;

const GYM: &str = "docs/data/gym_sensor.csv";

/// A fit of a file, which must be refused at once, with one message.
fn refused(file: &Path, words: &str) {
    let start = Instant::now();
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let mut command = bankshot();
    command.args(["fit", "--at", "free throw", "--release-height", "7 ft"]);
    let answer = Answer::of(command.arg(file).arg("--output").arg(&out));
    assert_eq!(answer.code, Some(2), "{}: {answer:?}", file.display());
    assert!(
        answer.stderr.contains(words),
        "{}: {answer:?}",
        file.display()
    );
    assert_eq!(answer.stderr.matches("error: ").count(), 1, "{answer:?}");
    assert!(!out.exists() && start.elapsed() < Duration::from_secs(10));
}

#[cfg(unix)]
#[test]
fn contract_endless_and_hollow_files_are_refused_at_once() {
    let folder = TempDir::new().unwrap();
    refused(Path::new("/dev/zero"), "is no text");
    for name in ["hollow.csv", "hollow.parquet", "hollow.xlsx", "hollow.json"] {
        let file = fs::File::create(folder.path().join(name)).unwrap();
        // Ten gigabytes without a byte on disk.
        file.set_len(10 << 30).unwrap();
        refused(&folder.path().join(name), "is no text");
    }
    let wide: String = (0..300_000).map(|k| format!("c{k},")).collect();
    refused(&write_file(&folder, "wide.csv", wide), "is longer than");
    let long = format!("a,b\n{},1\n", "x".repeat(20 << 20));
    refused(&write_file(&folder, "long.csv", long), "needs the columns");
}

/// Each place has an aim and a best shot of its own, and each attempt is a shot in memory.
#[test]
fn contract_more_places_or_attempts_than_a_player_has_are_refused() {
    let folder = TempDir::new().unwrap();
    let refused = |name: &str, rows: String, words: &str| {
        let text = format!("distance_ft,court_angle_deg,attempts,makes\n{rows}");
        let mut command = bankshot();
        command.args(["fit", "--release-height", "7 ft", "--output", "fit"]);
        let command = command.arg(write_file(&folder, name, text));
        let answer = Answer::of(command.current_dir(folder.path())).exits(2);
        assert!(answer.stderr.contains(words), "{answer:?}");
        assert!(!folder.path().join("fit").exists());
    };
    let places = (0..1200).map(|k| format!("{}.{},{},9,5\n", 10 + k / 100, k % 10, k / 10 % 10));
    let words = "has shots from 1200 places; a fit takes at most 1000";
    refused("places.csv", places.collect(), words);
    let attempts = "15,0,10000,5000\n".repeat(51);
    refused("attempts.csv", attempts, "has more than 500000 attempts");
}

/// A sheet with a cell in its last corner would have room for 17 billion cells.
#[test]
fn contract_a_sheet_with_a_far_cell_is_read_or_refused() {
    let far = include_bytes!("far_cell.xlsx");
    let folder = TempDir::new().unwrap();
    refused(&write_file(&folder, "far.xlsx", far), "up to 16384 cells");
    // Its directory says that it unpacks to three gigabytes.
    let mut bomb = far.to_vec();
    let entry = bomb
        .windows(4)
        .position(|bytes| bytes == b"PK\x01\x02")
        .unwrap();
    bomb[entry + 24..entry + 28].copy_from_slice(&3_000_000_000_u32.to_le_bytes());
    refused(
        &write_file(&folder, "bomb.xlsx", bomb),
        "too large a workbook",
    );
}

/// A row is not lost because its first cell begins with `#`; a remark is none.
#[test]
fn contract_rows_that_begin_like_a_remark_are_kept() {
    let folder = TempDir::new().unwrap();
    let text = "note,pitch_deg,speed_ft_s,distance_ft,court_angle_deg,release_height_ft,polar_deg,backspin_rev_s\n\
                # a remark, with a comma\n# another,,,,,,,\n#one,52,23.5,13.75,0,7,0,3\n#2,52,23.5,13.75,0,7,0,3\n";
    let input = write_file(&folder, "in.csv", text);
    let output = folder.path().join("out.csv");
    let mut command = bankshot();
    let run = command
        .arg("simulate")
        .arg(&input)
        .args(["--physics", "paper", "-o"]);
    Answer::of(run.arg(&output)).exits(0);
    assert_eq!(fs::read_to_string(output).unwrap().lines().count(), 3);
}

#[test]
fn contract_a_file_in_the_place_of_a_folder_is_named_before_the_work() {
    let folder = TempDir::new().unwrap();
    let file = write_file(&folder, "file", "kept");
    for (command, flag) in [("fit", "-o"), ("coach", "-o")] {
        let start = Instant::now();
        let mut run = bankshot();
        let answer = Answer::of(run.args([command, GYM, flag]).arg(&file));
        answer.exits(74).says("is a file where a folder must be");
        assert!(start.elapsed() < Duration::from_secs(10));
    }
    let mut run = bankshot();
    let answer = Answer::of(run.arg("studio").arg(&file).arg("--no-browser"));
    answer.exits(74).says("is a file where a folder must be");
    assert_eq!(fs::read_to_string(file).unwrap(), "kept");
}

/// The same shot under odd environments has the same bytes.
#[test]
fn contract_the_environment_changes_no_byte() {
    let shot = || {
        let mut command = bankshot();
        command.args([
            "shot",
            "configs/free_throw.toml",
            "--speed",
            "23.5 ft/s",
            "--pitch",
            "52 deg",
        ]);
        command
    };
    let usual = Answer::of(&mut shot()).exits(0);
    for (name, value) in [
        ("RAYON_NUM_THREADS", "0"),
        ("RAYON_NUM_THREADS", "-1"),
        ("RAYON_NUM_THREADS", "100000"),
        ("COLUMNS", "1"),
        ("COLUMNS", "99999999999"),
        ("TERM", "dumb"),
        ("LANG", "tr_TR.UTF-8"),
        ("LC_ALL", "C"),
        ("TZ", "Asia/Kathmandu"),
        ("HOME", "/nowhere"),
    ] {
        let answer = Answer::of(shot().env(name, value)).exits(0);
        assert_eq!(answer.stdout, usual.stdout, "{name}={value}");
    }
    assert_eq!(Answer::of(shot().env_clear()).exits(0).stdout, usual.stdout);
}

/// Under the limits of a shell: a documented exit code, and no file that is half written.
#[cfg(target_os = "linux")]
#[test]
fn contract_limits_of_the_shell_end_with_a_message() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", small_profile());
    let under = |limit: &str, arguments: &str| {
        let program = env!("CARGO_BIN_EXE_bankshot");
        let mut shell = Command::new("bash");
        shell
            .arg("-c")
            .arg(format!("ulimit {limit}; exec {program} {arguments}"));
        Answer::of(shell.current_dir(folder.path()))
    };
    let best = format!("best {} --out best", profile.display());
    for limit in ["-f 0", "-f 1"] {
        let answer = under(limit, &best);
        assert_eq!(answer.code, Some(74), "{limit} {answer:?}");
        assert!(answer.stderr.contains("File too large"), "{answer:?}");
        let left = file_names(&folder.path().join("best"));
        assert!(left.iter().all(|name| !name.contains("tmp")), "{left:?}");
    }
    under("-n 4", "studio s --no-browser --port 0")
        .exits(74)
        .says("Too many open files");
    under("-n 12", &best).exits(0);
}

/// Waits until a process catches a signal: on a busy machine that takes a while.
#[cfg(unix)]
fn wait_for_handler(id: &str, signal: &str) {
    let bit = match signal {
        "HUP" => 0,
        "INT" => 1,
        _ => 14,
    };
    let end = Instant::now() + Duration::from_secs(20);
    while Instant::now() < end {
        // Elsewhere than on Linux there is no such file, and no wait.
        let Ok(status) = fs::read_to_string(format!("/proc/{id}/status")) else {
            return;
        };
        let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
        let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
        if caught.is_some_and(|mask| mask & (1 << bit) != 0) {
            return;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Whether this process ignores SIGHUP, as under `nohup`: then its children do, too.
#[cfg(unix)]
fn ignores_hup() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask & 1 != 0)
}

/// Signals end every long command within a moment, with the exit code of the table.
#[cfg(unix)]
#[test]
fn contract_signals_end_every_long_command() {
    let folder = TempDir::new().unwrap();
    let root = env!("CARGO_MANIFEST_DIR");
    let out = folder.path().join("out");
    let profile = format!("{root}/configs/free_throw.toml");
    let long: [&[&str]; 8] = [
        &["sweep", "configs/half_court_3ft.toml", "-o", "OUT"],
        &["fit", GYM, "-o", "OUT"],
        &["coach", GYM, "-o", "OUT"],
        &["best", &profile, "--out", "OUT"],
        &[
            "table",
            &profile,
            "--distances",
            "10 ft to 20 ft by 1 ft",
            "-o",
            "OUT.csv",
        ],
        &["sample-size", &profile],
        &["physics", &profile],
        &["studio", "OUT", "--no-browser", "--port", "0"],
    ];
    for (number, arguments) in long.iter().enumerate() {
        let (signal, code) = match number % 3 {
            0 => ("INT", 130),
            2 if !ignores_hup() => ("HUP", 75),
            _ => ("TERM", 75),
        };
        let arguments = arguments
            .iter()
            .map(|word| word.replace("OUT", &out.display().to_string()));
        let mut command = bankshot();
        let child = command.args(arguments).stdout(std::process::Stdio::piped());
        let child = child.stderr(std::process::Stdio::piped()).spawn().unwrap();
        let id = child.id().to_string();
        wait_for_handler(&id, signal);
        std::thread::sleep(Duration::from_millis(200));
        let start = Instant::now();
        Command::new("kill")
            .args(["-s", signal, &id])
            .status()
            .unwrap();
        let answer = Answer::from(child.wait_with_output().unwrap());
        assert_eq!(answer.code, Some(code), "{number} {signal} {answer:?}");
        // A second on a quiet machine; this one may do other work.
        assert!(start.elapsed() < Duration::from_secs(10));
        assert!(!answer.stderr.contains("panicked"), "{answer:?}");
        let _ = fs::remove_dir_all(&out);
    }
}
