//! The program from outside: answers, files, bad input and exit codes.

use assert_cmd::Command;
use predicates::prelude::*;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn bankshot() -> Command {
    let mut command = Command::cargo_bin("bankshot").unwrap();
    command.current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

const FREE_THROW: &str = include_str!("../configs/free_throw.toml");

/// A profile small enough to run in a moment.
fn small() -> String {
    format!(
        "{FREE_THROW}\n[grid]\nspeed = 16\npitch = 12\npolar = 12\nbackspin = 4\n[search]\nstandard_error = 0.01\n"
    )
}

fn file(folder: &TempDir, name: &str, text: impl AsRef<[u8]>) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, text).unwrap();
    path
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn contract_best_prints_json_alone_and_writes_its_folder() {
    let folder = TempDir::new().unwrap();
    let profile = file(&folder, "p.toml", small());
    let output = bankshot()
        .args(["best", "--json", "--quiet"])
        .arg(&profile)
        .arg("--out")
        .arg(folder.path().join("runs"))
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(output.stderr.is_empty());
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for kind in ["direct", "bank"] {
        for key in [
            "speed_ft_s",
            "pitch_deg",
            "polar_deg",
            "backspin_rev_s",
            "probability",
            "standard_error",
        ] {
            assert!(answer[kind][key].is_f64(), "{kind} {key}");
        }
        assert!(answer[kind]["standard_error"].as_f64().unwrap() <= 0.01);
    }
    let run = folder
        .path()
        .join("runs")
        .join(&names(&folder.path().join("runs"))[0]);
    assert_eq!(
        names(&run),
        [
            "best_shots.csv",
            "best_shots.json",
            "curves.csv",
            "lessons.csv",
            "plan.json",
            "profile.toml",
            "provenance.json"
        ]
    );
    let stored = fs::read(run.join("best_shots.json")).unwrap();
    assert_eq!(stored, output.stdout);
    let table = fs::read_to_string(run.join("best_shots.csv")).unwrap();
    assert!(table.starts_with(
        "kind,speed_ft_s,pitch_deg,polar_deg,backspin_rev_s,side_spin_rev_s,probability"
    ));
    assert_eq!(table.lines().count(), 3);
    // The same command again, with other threads and in metric units.
    let again = bankshot()
        .args(["best", "--json", "--quiet", "--threads", "1", "--out"])
        .arg(folder.path().join("again"))
        .arg(&profile)
        .output()
        .unwrap();
    assert_eq!(again.stdout, output.stdout);
    bankshot()
        .args(["best", "--json", "--quiet", "--units", "metric", "--out"])
        .arg(folder.path().join("metric"))
        .arg(&profile)
        .assert()
        .success()
        .stdout(
            predicate::str::contains("\"speed_m_s\"").and(predicate::str::contains("_ft").not()),
        );
}

#[test]
fn contract_metres_and_feet_mean_the_same() {
    let folder = TempDir::new().unwrap();
    let metres = small()
        .replace("\"13.75 ft\"", "\"4.191 m\"")
        .replace("\"7 ft\"", "\"213.36 cm\"")
        .replace("\"0.25 ft/s\"", "\"0.0762 m/s\"");
    let mut answers = Vec::new();
    for (name, text) in [("a.toml", small()), ("b.toml", metres)] {
        let profile = file(&folder, name, text);
        let output = bankshot()
            .args(["best", "--quiet", "--out"])
            .arg(folder.path())
            .arg(profile)
            .output()
            .unwrap();
        assert!(output.status.success());
        answers.push(output.stdout);
    }
    assert_eq!(answers[0], answers[1]);
}

#[test]
fn contract_check_and_plan_of_every_shipped_profile() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs");
    let mut seen = 0;
    for folder in [root.clone(), root.join("paper")] {
        for name in names(&folder).iter().filter(|name| name.ends_with(".toml")) {
            bankshot()
                .arg("check")
                .arg(folder.join(name))
                .assert()
                .success();
            seen += 1;
        }
    }
    assert!(seen >= 10);
    bankshot()
        .args(["plan", "configs/free_throw.toml", "--wide-sample", "20000"])
        .assert()
        .success()
        .stdout(
            predicate::str::contains("870912 in each window")
                .and(predicate::str::contains("; 0 of those were made")),
        );
}

/// Each fault: what is replaced in the free throw's profile, and words the message must have.
const FAULTS: [(&str, &str, &[&str]); 17] = [
    (
        "c10 = \"0.25 ft/s\"",
        "c10 = \"0.25\"",
        &["shooter.errors.c10", "no unit", "ft/s"],
    ),
    (
        "c10 = \"0.25 ft/s\"",
        "c10 = 0.25",
        &["shooter.errors.c10", "no unit"],
    ),
    (
        "c10 = \"0.25 ft/s\"",
        "c10 = \"0.25 deg\"",
        &["shooter.errors.c10", "deg", "ft/s"],
    ),
    (
        "c10 = \"0.25 ft/s\"",
        "c10 = \"nan ft/s\"",
        &["shooter.errors.c10", "finite"],
    ),
    (
        "c10 = \"0.25 ft/s\"",
        "c10 = \"inf ft/s\"",
        &["shooter.errors.c10", "finite"],
    ),
    (
        "c10 = \"0.25 ft/s\"",
        "c10 = \"-0.25 ft/s\"",
        &["shooter.errors.c10", "0 or more"],
    ),
    (
        "c10 = \"0.25 ft/s\"",
        "",
        &["shooter.errors.c10", "missing"],
    ),
    ("c11 = 0.0", "c11 = nan", &["shooter.errors.c11", "finite"]),
    ("c11 = 0.0", "c11 = -1.0", &["c10 + c11 v"]),
    (
        "c11 = 0.0",
        "c19 = 0.0",
        &["shooter.errors.c19", "not a key"],
    ),
    ("[location]", "[loction]", &["loction", "not a key"]),
    (
        "distance = \"13.75 ft\"",
        "distance = \"1.1 ft\"",
        &["inside the ring's reach"],
    ),
    (
        "angle = \"0 deg\"",
        "angle = \"150 deg\"",
        &["behind the board"],
    ),
    (
        "preset = \"paper\"",
        "preset = \"moon\"",
        &["physics.preset", "paper"],
    ),
    (
        "preset = \"paper\"",
        "friction = -1.0",
        &["physics.friction", "0 or more"],
    ),
    (
        "preset = \"paper\"",
        "restitution = 1.5",
        &["physics.restitution", "at most 1"],
    ),
    ("preset = \"paper\"", "preset = \"paper", &["not TOML"]),
];

#[test]
fn contract_faults_of_a_profile_name_place_value_and_what_is_allowed() {
    let folder = TempDir::new().unwrap();
    for (from, to, words) in FAULTS {
        assert!(FREE_THROW.contains(from), "{from}");
        let profile = file(&folder, "bad.toml", FREE_THROW.replace(from, to));
        for command in ["check", "best"] {
            let mut run = bankshot();
            run.arg(command).arg(&profile);
            if command == "best" {
                run.arg("--out").arg(folder.path().join("never"));
            }
            let mut assert = run.assert().code(2).stdout("");
            for word in words {
                assert = assert.stderr(predicate::str::contains(*word));
            }
        }
    }
    assert!(
        !folder.path().join("never").exists(),
        "nothing is written for a refused profile"
    );
}

#[test]
fn contract_all_faults_are_told_at_once_with_their_lines() {
    let folder = TempDir::new().unwrap();
    let text = FREE_THROW
        .replace("\"7 ft\"", "\"7\"")
        .replace("c20 = \"1.2 deg\"", "c20 = \"-1.2 deg\"")
        .replace("c40 = \"0.3 rev/s\"", "c40 = \"0.3 furlong\"")
        .replace("\"13.75 ft\"", "\"x ft\"");
    let profile = file(&folder, "bad.toml", text);
    let output = bankshot().arg("check").arg(&profile).output().unwrap();
    let message = String::from_utf8(output.stderr).unwrap();
    for word in [
        "release_height",
        "c20",
        "c40",
        "location.distance",
        "bad.toml:8:",
        "bad.toml:22:",
    ] {
        assert!(message.contains(word), "{word} in {message}");
    }
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn contract_unreadable_profiles_are_refused() {
    let folder = TempDir::new().unwrap();
    let latin = file(&folder, "latin.toml", b"[shooter]\nname = \"Jos\xe9\"\n");
    let code = |path: &Path, word: &str| {
        bankshot()
            .arg("check")
            .arg(path)
            .assert()
            .code(2)
            .stderr(predicate::str::contains(word));
    };
    code(&latin, "UTF-8");
    code(folder.path(), "not a file");
    code(&folder.path().join("none.toml"), "No such file");
    let huge = folder.path().join("huge.toml");
    fs::File::create(&huge).unwrap().set_len(20 << 20).unwrap();
    code(&huge, "at most");
    bankshot().args(["best"]).assert().code(2);
    bankshot().args(["nonsense"]).assert().code(2);
}

#[test]
fn contract_grids_too_large_for_memory_are_refused() {
    let folder = TempDir::new().unwrap();
    for grid in [
        "speed = 40\npitch = 65536\npolar = 65536\nbackspin = 65536",
        "speed = 0",
        "pitch = -3",
        "polar = 1e3",
    ] {
        let profile = file(
            &folder,
            "bad.toml",
            format!("{FREE_THROW}\n[grid]\n{grid}\n"),
        );
        bankshot()
            .arg("check")
            .arg(&profile)
            .assert()
            .code(2)
            .stderr(predicate::str::contains("grid"));
    }
}

#[test]
fn contract_names_never_become_paths() {
    let folder = TempDir::new().unwrap();
    let profile = file(
        &folder,
        "p.toml",
        small().replace("college guard", "../../<script> é"),
    );
    let out = folder.path().join("runs");
    bankshot()
        .args(["best", "--quiet", "--out"])
        .arg(&out)
        .arg(&profile)
        .assert()
        .success();
    let made = names(&out);
    assert_eq!(made.len(), 1);
    assert!(made[0].starts_with("script-"), "{made:?}");
}

#[test]
fn contract_unwritable_outputs_exit_74() {
    let folder = TempDir::new().unwrap();
    let blocker = file(&folder, "file", "x");
    let profile = file(&folder, "p.toml", small());
    bankshot()
        .args(["best", "--out"])
        .arg(&blocker)
        .arg(&profile)
        .assert()
        .code(74);
    let releases = file(&folder, "r.csv", ROWS);
    for target in [folder.path().to_owned(), folder.path().join("none/out.csv")] {
        bankshot()
            .arg("simulate")
            .arg(&releases)
            .arg("--output")
            .arg(target)
            .assert()
            .code(74);
    }
    #[cfg(target_os = "linux")]
    {
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin("bankshot"));
        let status = command
            .arg("simulate")
            .arg(&releases)
            .args(["--output", "-"])
            .stdout(full)
            .status()
            .unwrap();
        assert_eq!(status.code(), Some(74));
    }
}

const ROWS: &str = "\
note,pitch_deg,speed_ft_s,distance_ft,court_angle_deg,release_height_ft,polar_deg,backspin_rev_s
swish,52,23.5,13.75,0,7,0,0
bank,52,24.7,13.75,0,7,0,3
short,52,22.0,13.75,0,7,0,3
";

fn simulate(
    folder: &TempDir,
    rows: impl AsRef<[u8]>,
    options: &[&str],
) -> (Option<i32>, String, String) {
    let releases = file(folder, "in.csv", rows);
    let out = folder.path().join("out.csv");
    let _ = fs::remove_file(&out);
    let output = bankshot()
        .arg("simulate")
        .arg(&releases)
        .arg("--output")
        .arg(&out)
        .args(options)
        .output()
        .unwrap();
    let text = fs::read(&out).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    (
        output.status.code(),
        text.unwrap_or_default(),
        String::from_utf8(output.stderr).unwrap(),
    )
}

#[test]
fn contract_simulate_carries_columns_and_adds_outcomes() {
    let folder = TempDir::new().unwrap();
    for options in [&["--integrator", "exact"], &["--integrator", "paper"]] {
        let (code, text, _) = simulate(&folder, ROWS, options);
        assert_eq!(code, Some(0));
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].ends_with(
            "polar_deg,backspin_rev_s,made,kind,contacts,n_board,n_ring,flight_time_s,entry_angle_deg"
        ));
        assert!(
            lines[1].starts_with("swish,52,23.5,13.75,0,7,0,0,1,swish,,0,0,"),
            "{}",
            lines[1]
        );
        assert!(
            lines[2].starts_with("bank,52,24.7,13.75,0,7,0,3,1,bank-in,board,1,0,"),
            "{}",
            lines[2]
        );
        assert!(lines[3].contains(",0,airball,,0,0,"), "{}", lines[3]);
    }
}

#[test]
fn contract_simulate_reads_metres_and_radians() {
    let folder = TempDir::new().unwrap();
    let metric = "\
speed_m_s,distance_m,court_angle_rad,release_height_m,polar_rad,pitch_rad,backspin_rad_s
7.1628,4.191,0,2.1336,0,0.9075712110370514,0
";
    let (_, feet, _) = simulate(&folder, ROWS, &[]);
    let (code, metres, _) = simulate(&folder, metric, &[]);
    assert_eq!(code, Some(0));
    let result = |text: &str| {
        let row = text
            .lines()
            .nth(1)
            .unwrap()
            .rsplit(',')
            .take(7)
            .map(str::to_owned);
        row.collect::<Vec<_>>()
    };
    let (a, b) = (result(&feet), result(&metres));
    assert_eq!(a[2..], b[2..]);
    let number = |text: &String| text.parse::<f64>().unwrap();
    assert!((number(&a[0]) - number(&b[0])).abs() < 1e-9);
}

#[test]
fn contract_bad_rows_are_named_and_the_others_done() {
    let folder = TempDir::new().unwrap();
    let mut rows = ROWS.as_bytes().to_vec();
    rows.extend_from_slice(
        b"a,52,fast,13.75,0,7,0,0\nb,nan,23,13.75,0,7,0,0\nc,52,23.5,1,0,7,0,0\nd,52\n",
    );
    rows.extend_from_slice(
        b"e\xff,52,23.5,13.75,0,7,0,0\nf,5\xff,23.5,13.75,0,7,0,0\ng,52,23.5,13.75,170,7,0,0\nh,52,23.5,13.75,0,7,0,0,more\n",
    );
    let (code, text, message) = simulate(&folder, rows, &[]);
    assert_eq!(code, Some(3), "{message}");
    for words in [
        "row 4: column speed_ft_s: \"fast\" is not a number",
        "row 5: column pitch_deg",
        "row 6: column distance_ft: the place is inside the ring's reach",
        "row 7: column",
        "row 9: column pitch_deg: is not UTF-8",
        "row 10: column court_angle_deg: the place is behind the board",
        "row 11: column 9: the row has 9 fields",
        "7 of 11 rows",
    ] {
        assert!(message.contains(words), "{words} in {message}");
    }
    assert_eq!(text.lines().count(), 12);
    let columns = |line: &str| line.split(',').count();
    assert!(text.lines().all(|line| columns(line) == 15), "{text}");
    assert!(text.lines().nth(8).unwrap().contains(",1,swish,"), "{text}");
}

#[test]
fn contract_bad_headers_and_physics_are_refused() {
    let folder = TempDir::new().unwrap();
    let (code, _, message) = simulate(&folder, "speed_ft_s,speed_m_s,made\n1,1,1\n", &[]);
    assert_eq!(code, Some(2));
    for words in [
        "distance_ft (or distance_m) is missing",
        "speed_ft_s and speed_m_s",
        "made",
    ] {
        assert!(message.contains(words), "{words} in {message}");
    }
    let (code, _, message) = simulate(&folder, ROWS, &["--physics", "moon"]);
    assert_eq!(code, Some(2));
    assert!(message.contains("neither the preset"));
    let physics = file(
        &folder,
        "physics.toml",
        "[physics]\nrestitution = 0.8457\nball_mass = \"21 ft\"\n",
    );
    let (code, _, message) = simulate(&folder, ROWS, &["--physics", physics.to_str().unwrap()]);
    assert_eq!(code, Some(2));
    assert!(message.contains("physics.ball_mass"), "{message}");
    let physics = file(&folder, "physics.toml", "[physics]\nrestitution = 0.8457\n");
    let (code, _, message) = simulate(&folder, ROWS, &["--physics", physics.to_str().unwrap()]);
    assert_eq!(code, Some(0), "{message}");
}

#[test]
fn contract_simulate_streams_standard_input_and_output() {
    let rows = ROWS.lines().nth(1).unwrap();
    let mut input = String::from(ROWS.lines().next().unwrap());
    for _ in 0..40_000 {
        input.push('\n');
        input.push_str(rows);
    }
    let output = bankshot()
        .args(["simulate", "-", "--output", "-", "--quiet"])
        .write_stdin(input)
        .output()
        .unwrap();
    assert!(output.status.success());
    assert_eq!(
        output.stdout.iter().filter(|&&byte| byte == b'\n').count(),
        40_001
    );
}

#[test]
fn contract_trace_says_what_happened() {
    let folder = TempDir::new().unwrap();
    let csv = folder.path().join("t.csv");
    bankshot()
        .args([
            "trace",
            "configs/free_throw.toml",
            "--speed",
            "24.7 ft/s",
            "--pitch",
            "52 deg",
        ])
        .args(["--backspin", "3 rev/s", "--output"])
        .arg(&csv)
        .assert()
        .success()
        .stdout(
            predicate::str::contains("made off the board")
                .and(predicate::str::contains("touches the board")),
        );
    let text = fs::read_to_string(csv).unwrap();
    assert!(text.starts_with("time_s,x_ft,y_ft,z_above_ring_ft,"));
    assert!(
        text.lines().filter(|line| line.ends_with(",1,0")).count() >= 8,
        "dense in contact"
    );
    bankshot()
        .args([
            "trace",
            "configs/free_throw.toml",
            "--speed",
            "24.7",
            "--pitch",
            "52 ft",
        ])
        .assert()
        .code(2)
        .stderr(predicate::str::contains("--speed").and(predicate::str::contains("--pitch")));
}

#[test]
fn contract_a_place_without_a_shot_says_why() {
    let folder = TempDir::new().unwrap();
    let text = small().replace("[search]", "[search]\nspeed_max = \"5 m/s\"");
    let profile = file(&folder, "p.toml", text);
    bankshot()
        .args(["best", "--json", "--out"])
        .arg(folder.path())
        .arg(&profile)
        .assert()
        .code(2)
        .stderr(predicate::str::contains(
            "no release within the limits reaches the hoop",
        ));
}

#[test]
fn contract_completions_and_man_page() {
    bankshot()
        .args(["completions", "bash"])
        .assert()
        .success()
        .stdout(predicate::str::contains("bankshot"));
    bankshot()
        .arg("man")
        .assert()
        .success()
        .stdout(predicate::str::contains(".TH bankshot"));
    for command in ["best", "check", "plan", "simulate", "trace"] {
        bankshot().args([command, "--help"]).assert().success();
    }
}

#[test]
fn contract_a_shooter_without_spin_or_error_of_spin_gets_an_answer() {
    let folder = TempDir::new().unwrap();
    let text = small()
        .replace("\"3 rev/s\"", "\"0 rev/s\"")
        .replace("\"0.3 rev/s\"", "\"0 rev/s\"");
    let profile = file(&folder, "p.toml", text);
    let output = bankshot()
        .args(["best", "--json", "--quiet", "--out"])
        .arg(folder.path())
        .arg(&profile)
        .output()
        .unwrap();
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(answer["direct"]["probability"].as_f64().unwrap() > 0.5);
    assert_eq!(answer["direct"]["backspin_rev_s"], 0.0);
}

#[test]
fn contract_errors_out_of_this_world_are_refused() {
    let folder = TempDir::new().unwrap();
    for (from, to) in [
        ("\"0.25 ft/s\"", "\"1e300 ft/s\""),
        ("\"0.3 rev/s\"", "\"1e300 rev/s\""),
        ("c11 = 0.0", "c11 = 9"),
    ] {
        let profile = file(&folder, "p.toml", FREE_THROW.replace(from, to));
        bankshot().arg("check").arg(&profile).assert().code(2);
    }
}

#[test]
fn contract_refusals_write_nothing() {
    let folder = TempDir::new().unwrap();
    let profile = file(
        &folder,
        "p.toml",
        small().replace("[search]", "[search]\nspeed_max = \"5 m/s\""),
    );
    let out = folder.path().join("out");
    bankshot()
        .args(["best", "--out"])
        .arg(&out)
        .arg(&profile)
        .assert()
        .code(2);
    assert!(!out.exists());
}

#[cfg(unix)]
#[test]
fn contract_outputs_follow_links_and_write_through_devices() {
    let folder = TempDir::new().unwrap();
    let releases = file(&folder, "r.csv", ROWS);
    let real = file(&folder, "real.csv", "old");
    let link = folder.path().join("link.csv");
    std::os::unix::fs::symlink(&real, &link).unwrap();
    bankshot()
        .arg("simulate")
        .arg(&releases)
        .arg("--output")
        .arg(&link)
        .assert()
        .success();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(&real).unwrap().lines().count(), 4);
    bankshot()
        .arg("simulate")
        .arg(&releases)
        .args(["--output", "/dev/null"])
        .assert()
        .success();
    assert!(!fs::metadata("/dev/null").unwrap().is_file());
}

#[cfg(unix)]
#[test]
fn contract_ctrl_c_leaves_no_file() {
    let folder = TempDir::new().unwrap();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("bankshot"))
        .args(["simulate", "-", "--output", "out.csv"])
        .current_dir(folder.path())
        .stdin(std::process::Stdio::piped())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    use std::io::Write;
    let mut input = child.stdin.take().unwrap();
    input.write_all(ROWS.as_bytes()).unwrap();
    input.flush().unwrap();
    // The temporary file appears once the header has been read.
    for _ in 0..200 {
        if !names(folder.path()).is_empty() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    assert_eq!(names(folder.path()).len(), 1);
    let status = std::process::Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status();
    assert!(status.unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert!(names(folder.path()).is_empty());
    drop(input);
}

/// `probability` of the nine errors with the given flags.
fn probability(flags: &[&str]) -> std::process::Output {
    bankshot()
        .args(["probability", "configs/nine_errors.toml", "--quiet"])
        .args(flags)
        .output()
        .unwrap()
}

#[test]
fn contract_probability_gives_p_with_its_error_and_shares() {
    let output = probability(&["--target", "0.004", "--json"]);
    assert!(output.status.success(), "{output:?}");
    let answer: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let p = answer["probability"].as_f64().unwrap();
    assert!((0.6..0.66).contains(&p), "{p}");
    assert!(answer["standard_error"].as_f64().unwrap() <= 0.004);
    assert!(answer["shots"].as_u64().unwrap() >= 16384);
    let shares = answer["shares"].as_object().unwrap();
    let sum: f64 = shares.values().map(|share| share.as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{shares:?}");
    // A flag goes before the profile's [nominal].
    let short = probability(&["--speed", "20 ft/s", "--target", "0.01"]);
    assert!(String::from_utf8_lossy(&short.stdout).starts_with("P = 0.0000"));
}

#[test]
fn contract_probability_with_too_small_a_budget_gives_p_so_far() {
    for method in ["sobol", "monte-carlo"] {
        let flags = ["--method", method, "--budget", "2000", "--target", "0.0001"];
        let output = probability(&flags);
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        assert!(String::from_utf8_lossy(&output.stdout).starts_with("P = 0.6"));
    }
}

#[test]
fn contract_probability_refuses_what_cannot_be() {
    for (flags, says) in [
        (&["--budget", "0"][..], "64"),
        (&["--method", "guess"], "possible values"),
        (&["--target", "0"], "0.000001 to 0.5"),
        (&["--target", "nan"], "0.000001 to 0.5"),
        (&["--method", "grid"], "Eq. 25"),
        (&["--grid", "20"], "only the methods"),
        (&["--replay", "1"], "such as 1:2049"),
        (&["--speed", "23"], "--speed"),
        (&["--side-spin", "3 ft"], "--side-spin"),
    ] {
        let output = probability(flags);
        assert_eq!(output.status.code(), Some(2), "{flags:?} {output:?}");
        assert!(output.stdout.is_empty());
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(error.contains(says), "{flags:?}: {error}");
    }
}

#[test]
fn contract_impossible_correlations_are_refused_with_their_place() {
    const NINE: &str = include_str!("../configs/nine_errors.toml");
    let line = "speed_pitch = -0.25            # from -1 to 1; any pair of the nine";
    assert!(NINE.contains(line));
    let folder = TempDir::new().unwrap();
    for (text, says) in [
        ("speed_pitch = 1.5", "from -1 to 1"),
        ("pitch_speed = 0.5", "not a key here"),
        (
            "speed_pitch = 0.9\nspeed_polar = 0.9\npitch_polar = -0.9",
            "not positive semi-definite",
        ),
    ] {
        let profile = file(&folder, "p.toml", NINE.replace(line, text));
        bankshot()
            .arg("check")
            .arg(&profile)
            .assert()
            .code(2)
            .stderr(predicate::str::contains(says).and(predicate::str::contains("p.toml")));
    }
}

#[test]
fn contract_replay_traces_the_sample() {
    let traced = probability(&["--replay", "1:2049", "--json"]);
    assert!(traced.status.success());
    let answer: serde_json::Value = serde_json::from_slice(&traced.stdout).unwrap();
    assert_eq!(answer["events"][0]["event"], "release");
    assert_eq!(
        probability(&["--replay", "1:2049", "--json"]).stdout,
        traced.stdout
    );
    assert_ne!(
        probability(&["--replay", "1:2050", "--json"]).stdout,
        traced.stdout
    );
}
