//! `table`: shots for a machine, and source that looks them up.

use super::support::{Answer, bankshot, write_file};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

const ROBOT: &str = r#"
[shooter]
name = "a \\u000a launcher"
release_height = "3 ft"
max_backspin = "4 rev/s"
[shooter.errors]
speed = "0 ft/s"
c11 = "1 %"
pitch = "0.5 deg"
polar = "0.5 deg"
backspin = "0 rev/s"
[location]
distance = "12 ft"
angle = "0 deg"
[physics]
preset = "ncaa"
[grid]
speed = 24
pitch = 12
polar = 12
backspin = 4
[search]
standard_error = 0.005
climb_samples = 256
"#;

fn table(folder: &TempDir, more: &[&str]) -> Answer {
    let profile = write_file(folder, "robot.toml", ROBOT);
    let mut command = bankshot();
    command
        .current_dir(folder.path())
        .arg("table")
        .arg(profile)
        .args(["--pitch", "66 deg", "--backspin", "2 rev/s", "--quiet"])
        .args(more);
    Answer::of(&mut command)
}

/// Where P is lower than asked for, nothing is checked and no nodes are added.
#[test]
fn contract_no_nodes_are_added_where_p_is_low() {
    let folder = TempDir::new().unwrap();
    let range = ["--distances", "8 ft, 14 ft", "--format", "json"];
    let nodes = |more: &[&str]| {
        let json = table(&folder, &[&range[..], more].concat()).exits(0).json();
        json["shots"].as_array().unwrap().len()
    };
    let all = nodes(&["--max-loss", "0.005"]);
    assert!(all > 2, "{all}");
    let low = ["--max-loss", "0.005", "--least-probability", "0.999"];
    assert_eq!(nodes(&low), 2);
}

/// Half of the error of the speed: more shots go in.
#[test]
fn contract_a_table_of_a_steadier_launcher() {
    let folder = TempDir::new().unwrap();
    let p = |more: &[&str]| {
        let range = ["--distances", "12 ft", "--draft", "--format", "json"];
        let table = table(&folder, &[&range[..], more].concat());
        table.exits(0).json()["shots"][0]["probability"]
            .as_f64()
            .unwrap()
    };
    assert!(p(&["--scatter", "speed=-50%"]) > p(&[]) + 0.05);
    table(
        &folder,
        &["--distances", "12 ft", "--scatter", "speed=half"],
    )
    .exits(2);
}

/// A table that is stopped goes on where it was, and is the one that is made in one go.
#[cfg(unix)]
#[test]
fn contract_a_stopped_table_goes_on() {
    let folder = TempDir::new().unwrap();
    let range = ["--distances", "10 ft to 14 ft by 2 ft", "--max-loss", "1"];
    table(&folder, &[&range[..], &["-o", "whole.csv"]].concat()).exits(0);
    let whole = fs::read_to_string(folder.path().join("whole.csv")).unwrap();
    assert!(!folder.path().join("whole.csv.unfinished").exists());

    let unfinished = folder.path().join("parts.csv.unfinished");
    let lines = || fs::read_to_string(&unfinished).map_or(0, |text| text.lines().count());
    let mut child = bankshot()
        .current_dir(folder.path())
        .args(["table", "robot.toml", "--pitch", "66 deg", "--backspin"])
        .args(["2 rev/s", "-o", "parts.csv"])
        .args(range)
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    while lines() < 4 {
        assert!(child.try_wait().unwrap().is_none(), "it was not stopped");
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    Command::new("kill")
        .arg(child.id().to_string())
        .status()
        .unwrap();
    let stopped = child.wait_with_output().unwrap();
    assert_eq!(stopped.status.code(), Some(75));
    let said = String::from_utf8(stopped.stderr).unwrap();
    assert!(said.contains("the same command goes on with it"), "{said}");
    assert!(!folder.path().join("parts.csv").exists());
    let kept = fs::read_to_string(&unfinished).unwrap();
    assert!(kept.lines().count() >= 4);

    table(&folder, &[&range[..], &["-o", "parts.csv"]].concat()).exits(0);
    let parts = fs::read_to_string(folder.path().join("parts.csv")).unwrap();
    assert_eq!(parts, whole);
    assert!(!unfinished.exists());

    // What is kept is used: a shot that was changed there comes out changed.
    let shot = |line: &&str| line.starts_with("{\"shot\"");
    let first = kept.lines().find(shot).unwrap();
    let mut changed: Value = serde_json::from_str(first).unwrap();
    changed["shot"]["shot"]["probability"] = 0.125.into();
    fs::write(&unfinished, kept.replace(first, &changed.to_string())).unwrap();
    table(&folder, &[&range[..], &["-o", "parts.csv"]].concat()).exits(0);
    let parts = fs::read_to_string(folder.path().join("parts.csv")).unwrap();
    assert!(parts.contains("0.125"), "{parts}");
}

#[test]
fn contract_a_table_has_a_shot_for_each_distance_and_a_check_between() {
    let folder = TempDir::new().unwrap();
    let range = ["--distances", "10 ft to 14 ft by 2 ft"];
    let more = ["--format", "json", "--max-loss", "1"];
    let json = table(&folder, &[&range[..], &more].concat())
        .exits(0)
        .json();
    let shots = json["shots"].as_array().unwrap();
    assert_eq!(shots.len(), 3);
    for (shot, distance) in shots.iter().zip([10.0, 12.0, 14.0]) {
        assert!((shot["distance_ft"].as_f64().unwrap() - distance).abs() < 1e-9);
        assert!((shot["pitch_deg"].as_f64().unwrap() - 66.0).abs() < 1e-9);
        assert!((shot["backspin_rev_s"].as_f64().unwrap() - 2.0).abs() < 1e-9);
        assert!(shot["probability"].as_f64().unwrap() > 0.5);
    }
    let checks = json["checks"].as_array().unwrap();
    let places: Vec<f64> = checks
        .iter()
        .map(|check| check["distance_ft"].as_f64().unwrap())
        .collect();
    for (place, expected) in places.iter().zip([10.5, 11.0, 11.5, 12.5, 13.0, 13.5]) {
        assert!((place - expected).abs() < 1e-9, "{places:?}");
    }
    assert_eq!(places.len(), 6);
    assert!(json["greatest_loss"].as_f64().unwrap() < 0.02);
    let greatest_error = checks
        .iter()
        .map(|check| {
            let value = |name: &str| check[name].as_f64().unwrap();
            (value("looked_up_probability") - value("interpolated_probability")).abs()
        })
        .fold(0.0, f64::max);
    assert!((json["greatest_error"].as_f64().unwrap() - greatest_error).abs() < 1e-12);
    // A longer shot needs more speed.
    let speed = |i: usize| shots[i]["speed_ft_s"].as_f64().unwrap();
    assert!(speed(0) < speed(1) && speed(1) < speed(2));
}

/// The best direct speed has a kink where the ball begins to touch the board first. Halfway between
/// these nodes nothing is lost; at a quarter, `probability` gives 0.930 for the interpolated shot
/// and 0.963 for the best one.
#[test]
fn regress_a_loss_beside_the_middle_is_found() {
    let folder = TempDir::new().unwrap();
    let text = ROBOT
        .replace("\"3 ft\"", "\"4 ft\"")
        .replace("polar = \"0.5 deg\"", "polar = \"0.4 deg\"");
    let profile = write_file(&folder, "launcher.toml", &text);
    let mut command = bankshot();
    command
        .arg("table")
        .arg(profile)
        .args(["--distances", "6 ft, 6.5 ft", "--format", "json"])
        .args(["--pitch", "65 deg", "--backspin", "2 rev/s", "--quiet"])
        .args(["--max-loss", "1"]);
    let json = Answer::of(&mut command).exits(0).json();
    let loss = json["greatest_loss"].as_f64().unwrap();
    assert!(loss > 0.02, "{loss}");
    // The P that is looked up errs there, too: it is not linear.
    assert!(json["greatest_error"].as_f64().unwrap() > 0.02);
    // At 6 ft a bank shot is better by 0.2.
    let near = &json["shots"][0];
    let [direct, bank] =
        ["probability", "other_kind_probability"].map(|name| near[name].as_f64().unwrap());
    assert!(bank > direct + 0.1, "{bank} {direct}");
    let notes = json["notes"].to_string();
    assert!(notes.contains("ank shot"), "{notes}");
    assert!(
        notes.contains("In 2 of 2 rows even an exact shot"),
        "{notes}"
    );
}

#[test]
fn contract_nodes_are_added_where_interpolation_costs_too_much() {
    let folder = TempDir::new().unwrap();
    let range = ["--distances", "8 ft, 16 ft", "--format", "json"];
    let losses_and_shots = |max_loss: &str| {
        let json = table(&folder, &[&range[..], &["--max-loss", max_loss]].concat())
            .exits(0)
            .json();
        let shots = json["shots"].as_array().unwrap().clone();
        (json["greatest_loss"].as_f64().unwrap(), shots)
    };
    let (loss, shots) = losses_and_shots("1");
    assert!(loss > 0.03 && shots.len() == 2, "{loss} {}", shots.len());
    let (loss, shots) = losses_and_shots("0.03");
    assert!(loss <= 0.03 && shots.len() > 2, "{loss} {}", shots.len());
    let distances: Vec<f64> = shots
        .iter()
        .map(|shot| shot["distance_ft"].as_f64().unwrap())
        .collect();
    assert!(distances.iter().any(|d| (d - 12.0).abs() < 1e-9));
    assert!(distances.windows(2).all(|pair| pair[1] > pair[0]));
    for (shot, distance) in shots.iter().zip(&distances) {
        let was_asked = [8.0, 16.0].iter().any(|d| (d - distance).abs() < 1e-9);
        assert_eq!(
            shot["is_added"].as_bool().unwrap(),
            !was_asked,
            "{distance}"
        );
    }
    // A draft has the shots of these places alone.
    let draft = [&range[..], &["--draft"]].concat();
    let json = table(&folder, &draft).exits(0).json();
    assert_eq!(json["shots"].as_array().unwrap().len(), 2);
    assert!(json["greatest_loss"].is_null());
    for (shot, checked) in [(0, 0), (1, shots.len() - 1)] {
        assert_eq!(json["shots"][shot], shots[checked]);
    }
    assert!(json["notes"].to_string().contains("Not checked between"));
    table(&folder, &["--distances", "8 ft, 16 ft", "--max-loss", "2"])
        .exits(2)
        .says("give a number from 0 to 1");
}

const CPP_MAIN: &str = r#"
#include "t.hpp"
#include "bank-2.hpp"
#include <cstdio>
int main() {
    for (double distance : {11.5, 9.0}) {
        for (double value : t::look_up(distance)) std::printf("%.9g ", value);
        std::printf("\n");
    }
    // The bank table in this file and in the other one.
    double other(double distance);
    std::printf("%.9g %.9g\n", bank_2::look_up(11.5)[bank_2::IS_BANK], other(11.5));
}
"#;

/// Another file of the program, whose header has the name of the first.
const CPP_OTHER: &str = r#"
#include "other/t.hpp"
double other(double distance) { return t::look_up(distance)[t::IS_BANK]; }
"#;

/// A place of a table has no shot: nothing is known beside it, whichever place comes first.
const PYTHON_WITHOUT_FIRST_SHOT: &str = r#"
import math, t
for place in (0, 1):
    shots = t.SHOTS
    t.SHOTS = list(shots)
    t.SHOTS[place] = [math.nan] * len(shots[place])
    for distance in (10.5, 11.5):
        assert all(math.isnan(value) for value in t.look_up(distance)), t.look_up(distance)
    t.SHOTS = shots
print(*t.look_up(11.5, 0.0)); print(*t.look_up(9.0))
"#;

const JAVA_MAIN: &str = r#"
public class Main {
    public static void main(String[] arguments) {
        for (double distance : new double[] {11.5, 9.0}) {
            double[] shot = Launcher.lookUp(distance);
            if (!(shot[Launcher.SPEED_FT_S] == shot[0]) && distance > 10) throw new Error();
            for (double value : shot) System.out.print(value + " ");
            System.out.println();
        }
    }
}
"#;

#[test]
fn contract_the_source_of_a_table_interpolates_as_the_table_does() {
    let folder = TempDir::new().unwrap();
    let range = ["--distances", "10 ft, 12 ft", "--draft"];
    // The end of the name says the form.
    for file in ["t.csv", "t.py", "Launcher.java", "t.hpp"] {
        table(&folder, &[&range[..], &["--output", file]].concat()).exits(0);
    }
    table(
        &folder,
        &[&range[..], &["--output", "my shots.java"]].concat(),
    )
    .exits(2)
    .says("the name of no Java class");
    write_file(&folder, "t.cpp", CPP_MAIN);
    write_file(&folder, "other.cpp", CPP_OTHER);
    fs::create_dir(folder.path().join("other")).unwrap();
    for file in ["bank-2.hpp", "other/t.hpp"] {
        table(
            &folder,
            &[&range[..], &["--kind", "bank", "--output", file]].concat(),
        )
        .exits(0);
    }
    for file in ["t.py", "Launcher.java", "t.hpp"] {
        let source = fs::read_to_string(folder.path().join(file)).unwrap();
        let words = source.replace("\n// ", " ").replace("\n# ", " ");
        assert!(
            words.contains("time_s is for a launcher that stands still"),
            "{file}"
        );
    }
    write_file(&folder, "Main.java", JAVA_MAIN);
    let csv = fs::read_to_string(folder.path().join("t.csv")).unwrap();
    let speeds: Vec<f64> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(6).unwrap().parse().unwrap())
        .collect();
    let middle = 0.25 * speeds[0] + 0.75 * speeds[1];
    let how = csv.lines().nth(1).unwrap().split(',').nth(4).unwrap();
    assert!(how == "swish" || how == "rim-in", "{how}");
    let java = fs::read_to_string(folder.path().join("Launcher.java")).unwrap();
    assert!(java.contains("public final class Launcher {"));
    assert!(!java.contains("\\u000a"), "a name must not end a comment");
    for (tool, arguments, missing) in [
        (
            "python3",
            vec![
                "-c",
                "import t; print(*t.look_up(11.5, 0.0)); print(*t.look_up(9.0))",
            ],
            "python3",
        ),
        ("python3", vec!["-c", PYTHON_WITHOUT_FIRST_SHOT], "python3"),
        (
            "sh",
            vec![
                "-c",
                "c++ -std=c++11 -Wall -Werror -o t t.cpp other.cpp && ./t",
            ],
            "c++",
        ),
        (
            "sh",
            vec!["-c", "javac Main.java Launcher.java && java Main"],
            "javac",
        ),
    ] {
        if !is_installed(missing) {
            println!("skipped: {missing} is not installed");
            continue;
        }
        let output = Command::new(tool)
            .current_dir(folder.path())
            .args(&arguments)
            .output()
            .unwrap();
        let printed = String::from_utf8_lossy(&output.stdout).into_owned();
        let mut lines = printed.lines();
        let first: Vec<f64> = numbers(lines.next().unwrap_or_else(|| panic!("{output:?}")));
        assert!((first[0] - middle).abs() < 1e-5, "{first:?} {middle}");
        assert!((first[1] - 66.0).abs() < 1e-5);
        assert_eq!((first.len(), first[9]), (10, 0.0), "a direct shot");
        assert!(numbers(lines.next().unwrap()).iter().all(|v| v.is_nan()));
        if missing == "c++" {
            assert_eq!(lines.next(), Some("1 1"), "each look-up has its own table");
        }
    }
}

fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace()
        .map(|v| v.parse().unwrap())
        .collect()
}

fn is_installed(program: &str) -> bool {
    std::env::var_os("PATH").is_some_and(|paths| {
        std::env::split_paths(&paths).any(|folder| Path::new(&folder).join(program).exists())
    })
}

/// One table of the better kind against one of each kind.
#[test]
fn contract_a_table_of_the_better_kind() {
    let folder = TempDir::new().unwrap();
    let range = ["--distances", "6 ft, 7 ft, 14 ft", "--max-loss", "1"];
    let json = |kind: &str| {
        table(
            &folder,
            &[&range[..], &["--kind", kind, "--format", "json"]].concat(),
        )
        .exits(0)
        .json()
    };
    let [direct, bank, best] = ["direct", "bank", "best"].map(json);
    let shots = |json: &Value| json["shots"].as_array().unwrap().clone();
    let p = |shot: &Value| shot["probability"].as_f64().unwrap();
    let distance = |shot: &Value| shot["distance_ft"].as_f64().unwrap();
    for (direct, bank) in shots(&direct).iter().zip(shots(&bank)) {
        let here: Vec<Value> = shots(&best)
            .into_iter()
            .filter(|shot| (distance(shot) - distance(direct)).abs() < 1e-9)
            .collect();
        let most = here.iter().map(p).fold(0.0, f64::max);
        let least_gain = 0.005;
        assert!(most >= p(direct).max(p(&bank)) - least_gain);
        for shot in here {
            let of_kind = if shot["kind"] == "bank" {
                &bank
            } else {
                direct
            };
            assert_eq!(p(&shot), p(of_kind));
        }
    }
    // The kinds change at one distance, where both are nearly level.
    let changes: Vec<[Value; 2]> = shots(&best)
        .windows(2)
        .filter(|pair| pair[0]["kind"] != pair[1]["kind"])
        .map(|pair| [pair[0].clone(), pair[1].clone()])
        .collect();
    assert!(!changes.is_empty());
    for [before, after] in &changes {
        assert_eq!(distance(before), distance(after));
    }
    let notes = best["notes"].to_string();
    assert!(notes.contains("Better kind, about: "), "{notes}");
    table(
        &folder,
        &[
            "--distances",
            "6 ft",
            "--angles",
            "0 deg, 30 deg",
            "--kind",
            "best",
        ],
    )
    .exits(2)
    .says("--kind best: a table of the better kind needs one court angle");
    // What is refused leaves nothing behind.
    let left = fs::read_dir(folder.path()).unwrap().flatten();
    let mut left = left.map(|entry| entry.file_name().to_string_lossy().into_owned());
    assert!(!left.any(|name| name.ends_with(".unfinished")));
}

#[test]
fn contract_wrong_ranges_are_refused() {
    let folder = TempDir::new().unwrap();
    for (distances, message) in [
        ("10 ft to 14 ft", "has no step; write '2 m, 3 m' or"),
        ("14 ft to 10 ft by 1 ft", "must ascend, with a step above 0"),
        ("10 ft to 14 ft by 0 ft", "must ascend, with a step above 0"),
        ("10 ft to 14 ft by 1e-9 ft", "has more than 2000 values"),
        ("12 ft, 10 ft", "does not ascend"),
        ("12", "has no unit"),
    ] {
        table(&folder, &["--distances", distances])
            .exits(2)
            .says(message);
    }
    let profile = write_file(&folder, "robot.toml", ROBOT);
    let mut command = bankshot();
    command
        .arg("table")
        .arg(profile)
        .args(["--distances", "10 ft", "--backspin", "9 rev/s"]);
    let answer = Answer::of(&mut command).exits(2);
    assert_eq!(
        answer.stderr,
        "error: --backspin: \"9 rev/s\" is more than shooter.max_backspin (4.000 rev/s)\n"
    );
}

/// `cargo test --test cli campaign_interpolation -- --ignored --nocapture`
///
/// Looks at the eighths between the nodes, none of which the program checks itself, and finds P
/// with `probability`, and the best P with a table of that place alone.
#[test]
#[ignore = "four minutes: five launchers with the full search, every foot from 6 to 20 ft"]
fn campaign_interpolation_of_launchers() {
    let folder = TempDir::new().unwrap();
    let full = ROBOT.split("[grid]").next().unwrap();
    for (name, height, errors, polar, pitch, backspin) in [
        ("low", "2 ft", "1 %", "0.5 deg", "70 deg", "2 rev/s"),
        ("middle", "4 ft", "2 %", "0.5 deg", "65 deg", "1 rev/s"),
        ("tall", "6.5 ft", "0.5 %", "0.5 deg", "60 deg", "3 rev/s"),
        ("kinked", "4 ft", "1 %", "0.4 deg", "65 deg", "2 rev/s"),
        // The pitch is searched too.
        ("free hood", "3.6 ft", "1 %", "0.5 deg", "", "2 rev/s"),
    ] {
        let text = full
            .replace("\"3 ft\"", &format!("\"{height}\""))
            .replace("\"1 %\"", &format!("\"{errors}\""))
            .replace("polar = \"0.5 deg\"", &format!("polar = \"{polar}\""));
        let profile = write_file(&folder, "launcher.toml", &text);
        let table = |distances: &str| {
            let mut command = bankshot();
            command
                .arg("table")
                .arg(&profile)
                .args(["--distances", distances, "--format", "json"])
                .args(["--backspin", backspin, "--quiet"]);
            if !pitch.is_empty() {
                command.args(["--pitch", pitch]);
            }
            Answer::of(&mut command).json()
        };
        let json = table("6 ft to 20 ft by 1 ft");
        let shots = json["shots"].as_array().unwrap();
        let (mut greatest_loss, mut greatest_error) = ((0.0, 0.0), (0.0, 0.0));
        let distance = |shot: &Value| shot["distance_ft"].as_f64().unwrap();
        // A jump has no inside.
        let is_step = |pair: &&[Value]| distance(&pair[0]) < distance(&pair[1]);
        for pair in shots.windows(2).filter(is_step) {
            for part in [0.125, 0.375, 0.625, 0.875] {
                let between = |name: &str| {
                    let [from, to] = [&pair[0], &pair[1]].map(|shot| shot[name].as_f64().unwrap());
                    from + part * (to - from)
                };
                let distance = between("distance_ft");
                let nominal = format!(
                    "[nominal]\nspeed = \"{} ft/s\"\npitch = \"{} deg\"\npolar = \"{} deg\"\nbackspin = \"{backspin}\"\n",
                    between("speed_ft_s"),
                    between("pitch_deg"),
                    between("aim_deg"),
                );
                let here = text.replace("\"12 ft\"", &format!("\"{distance} ft\""));
                let here = write_file(&folder, "here.toml", &(here + &nominal));
                let mut command = bankshot();
                command
                    .arg("probability")
                    .arg(here)
                    .args(["--json", "--quiet"]);
                let p = Answer::of(&mut command).json()["probability"]
                    .as_f64()
                    .unwrap();
                let best = table(&format!("{distance} ft"));
                let best = best["shots"][0]["probability"].as_f64().unwrap();
                let error = (between("probability") - p).abs();
                if best - p > greatest_loss.0 {
                    greatest_loss = (best - p, distance);
                }
                if error > greatest_error.0 {
                    greatest_error = (error, distance);
                }
            }
        }
        let printed = |name: &str| json[name].as_f64().unwrap();
        println!(
            "{name}: {} nodes; printed loss {:.4}, error {:.4}; at the eighths {:.4} (at {:.3} ft), {:.4} (at {:.3} ft)",
            shots.len(),
            printed("greatest_loss"),
            printed("greatest_error"),
            greatest_loss.0,
            greatest_loss.1,
            greatest_error.0,
            greatest_error.1,
        );
        let all = [
            printed("greatest_loss"),
            printed("greatest_error"),
            greatest_loss.0,
            greatest_error.0,
        ];
        assert!(all.iter().all(|value| *value < 0.01), "{name}: {all:?}");
    }
}

const THREE_PITCHES: [&str; 2] = ["--pitches", "20 deg, 60 deg, 66 deg"];

/// `pitch-curve` of the launcher in a folder.
fn pitch_curve(folder: &TempDir, more: &[&str]) -> Answer {
    let profile = write_file(folder, "robot.toml", ROBOT);
    let mut command = bankshot();
    command
        .current_dir(folder.path())
        .arg("pitch-curve")
        .arg(profile)
        .args(["--backspin", "2 rev/s", "--quiet"])
        .args(more);
    Answer::of(&mut command)
}

/// The best shot at each pitch angle is that of a table with the pitch angle fixed.
#[test]
fn contract_a_pitch_curve_has_the_best_shot_at_each_angle() {
    let folder = TempDir::new().unwrap();
    let curve = |more: &[&str]| pitch_curve(&folder, more);
    let pitches = THREE_PITCHES;
    let files = ["-o", "curve.csv", "--plot", "curve.svg", "--json"];
    let json = curve(&[&pitches[..], &files].concat()).exits(0).json();
    let shots = json["shots"].as_array().unwrap();
    assert_eq!(shots.len(), 3);
    // From 7 ft below the ring nothing falls in at 20 deg up.
    assert_eq!(shots[0]["has_shot"], false);
    let fixed = ["--distances", "12 ft", "--format", "json", "--draft"];
    let table = table(&folder, &fixed).exits(0).json();
    let of_table = &table["shots"][0];
    for name in [
        "speed_ft_s",
        "probability",
        "aim_deg",
        "other_kind_probability",
    ] {
        assert_eq!(shots[2][name], of_table[name], "{name}");
    }
    assert!((shots[1]["pitch_deg"].as_f64().unwrap() - 60.0).abs() < 1e-9);
    let csv = fs::read_to_string(folder.path().join("curve.csv")).unwrap();
    assert_eq!(csv.lines().count(), 4);
    let svg = fs::read_to_string(folder.path().join("curve.svg")).unwrap();
    assert!(svg.contains("release angle (deg)"));
    let answer = curve(&pitches).exits(0);
    let text = answer.stdout();
    assert!(text.lines().all(|line| line.chars().count() <= 80));
    assert!(text.starts_with("Release at about 66 deg: "), "{text}");
    let out_of_range = ["--pitches", "60 deg, 95 deg"];
    curve(&out_of_range).exits(2).says("95 deg is not allowed");
    curve(&["-o", "absent/curve.csv"])
        .exits(74)
        .says("there is no folder absent");
}

/// At the greatest speed a lower release cannot be made good by a faster shot.
#[test]
fn contract_another_height_keeps_to_the_greatest_speed() {
    let folder = TempDir::new().unwrap();
    let slow = format!("{ROBOT}speed_max = \"8.2 m/s\"\n");
    let profile = write_file(&folder, "robot.toml", slow);
    let mut command = bankshot();
    command.current_dir(folder.path()).arg("best").arg(profile);
    command.args(["--pitch", "64 deg", "--details", "--quiet"]);
    let answer = Answer::of(&mut command).exits(0);
    let lower = answer.stdout().split("-0.50 ft:").nth(1).unwrap();
    assert!(lower.trim_start().starts_with('-'), "{lower}");
}

/// What the launcher cannot do is not proposed.
#[test]
fn contract_the_pitch_limits_of_a_profile_hold() {
    let folder = TempDir::new().unwrap();
    let limits = "pitch_min = \"58 deg\"\npitch_max = \"61 deg\"\n";
    let profile = write_file(&folder, "robot.toml", format!("{ROBOT}{limits}"));
    let run = |words: &[&str]| {
        let mut command = bankshot();
        let command = command.arg(words[0]).arg(&profile).args(&words[1..]);
        Answer::of(command.arg("--quiet"))
    };
    // Of the default angles, every 2.5 deg, one lies within; and both limits.
    let shots = run(&["pitch-curve", "--json"]).exits(0).json();
    let shots = shots["shots"].as_array().unwrap();
    let angles: Vec<f64> = shots
        .iter()
        .map(|shot| shot["pitch_deg"].as_f64().unwrap())
        .collect();
    assert_eq!(angles.len(), 3, "{angles:?}");
    for (angle, known) in angles.iter().zip([58.0, 60.0, 61.0]) {
        assert!((angle - known).abs() < 1e-9, "{angles:?}");
    }
    let lowest = ["pitch-curve", "--pitches", "57 deg, 58 deg"];
    run(&lowest)
        .exits(2)
        .says("--pitches: 57 deg is less than search.pitch_min (58 deg)");
    let too_much = "--pitch: \"62 deg\" is more than search.pitch_max (61 deg)";
    let table = ["table", "--distances", "12 ft", "--pitch", "62 deg"];
    run(&table).exits(2).says(too_much);
    run(&["best", "--pitch", "62 deg"]).exits(2).says(too_much);
    let fast = format!("{ROBOT}speed_max = \"9 m/s\"\n");
    write_file(&folder, "robot.toml", &fast);
    run(&["best", "--speed", "9.1 m/s"])
        .exits(2)
        .says("is more than search.speed_max (29.5276 ft/s, 9 m/s)");
    // P of such a shot is told, with a warning.
    let too_fast = Answer::of(
        bankshot()
            .arg("probability")
            .arg(&profile)
            .args(["--speed", "9.1 m/s", "--pitch", "60 deg"]),
    );
    too_fast.exits(0).says(
        "the speed is more than search.speed_max (29.5276 ft/s, 9 m/s): no search would give this shot",
    );
    let fixed = format!("{ROBOT}{limits}choose = [\"speed\"]\n[nominal]\npitch = \"62 deg\"\n");
    write_file(&folder, "robot.toml", &fixed);
    run(&["check"])
        .exits(2)
        .says("is more than search.pitch_max (61 deg)");
}

/// At each angle the kind with the higher P; and a shot that goes in with its errors alone is no
/// clean one, but counts with its P.
#[test]
fn contract_the_better_kind_at_each_angle_and_shots_that_are_not_clean() {
    let folder = TempDir::new().unwrap();
    // The unit of the last value is that of all.
    let pitches = ["--pitches", "60, 70 deg"];
    let curve = |more: &[&str]| pitch_curve(&folder, &[&pitches[..], more].concat());
    let of_kind = |kind: &str, distance: &str| {
        let json = curve(&["--kind", kind, "--distance", distance, "--json"]);
        let json = json.exits(0).json();
        [0, 1].map(|row| json["shots"][row].clone())
    };
    let [direct, bank, best] = ["direct", "bank", "best"].map(|kind| of_kind(kind, "7 ft"));
    for row in 0..2 {
        let p = |shots: &[serde_json::Value; 2]| shots[row]["probability"].as_f64().unwrap();
        let is_clean = |shots: &[serde_json::Value; 2]| shots[row]["has_shot"] == true;
        let rank = |shots| (is_clean(shots), p(shots));
        let expected = if rank(&bank) > rank(&direct) {
            &bank
        } else {
            &direct
        };
        assert_eq!(best[row]["kind"], expected[row]["kind"]);
        assert_eq!(best[row]["probability"], expected[row]["probability"]);
    }
    // From 7 ft the flatter bank shot is one of them.
    assert_eq!(bank[0]["has_shot"], false);
    assert_eq!(bank[0]["error_free_kind"], "misses");
    let p = bank[0]["probability"].as_f64().unwrap();
    assert!(p > 0.01 && p < 0.5, "{p}");
    let both = ["--kind", "bank", "--distances", "7 ft, 9 ft"];
    let text = curve(&both).exits(0);
    let text = text.stdout();
    assert!(text.contains(&format!("{:.1}*", 100.0 * p)), "{text}");
    assert!(text.contains("*: "), "{text}");
    let one = curve(&["--kind", "bank", "--distance", "7 ft"]).exits(0);
    let speed = bank[0]["speed_ft_s"].as_f64().unwrap();
    assert!(
        one.stdout().contains(&format!("{speed:.2}")),
        "{}",
        one.stdout()
    );
    let best = curve(&["--kind", "best"]).exits(0);
    let lines = best.stdout().lines();
    assert!(lines.clone().all(|line| line.chars().count() <= 80));
    assert!(best.stdout().starts_with("Release at about "));
}

/// P from several distances is that of single curves, and the greatest mean is named.
#[test]
fn contract_one_pitch_angle_for_several_distances_has_the_greatest_mean() {
    let folder = TempDir::new().unwrap();
    let curve = |more: &[&str]| pitch_curve(&folder, &[&THREE_PITCHES[..], more].concat());
    let files = ["--distances", "9 ft, 12 ft", "-o", "curves.csv", "--json"];
    let json = curve(&files).exits(0).json();
    let all = json.as_array().unwrap();
    let alone = curve(&["--distance", "12 ft", "--json"]).exits(0).json();
    let mut shots = all[1]["shots"].clone();
    for shot in shots.as_array_mut().unwrap() {
        assert_eq!(
            shot.as_object_mut().unwrap().shift_remove("distance_ft"),
            Some(12.0.into())
        );
    }
    assert_eq!(shots, alone["shots"]);
    assert_eq!(all[0]["distance_ft"], 9.0);
    let p = |distance: usize, row: usize| {
        all[distance]["shots"][row]["probability"]
            .as_f64()
            .unwrap_or(0.0)
    };
    let mean = |row: usize| (p(0, row) + p(1, row)) / 2.0;
    let best = if mean(1) > mean(2) { "60" } else { "66" };
    let text = curve(&["--distances", "9 ft, 12 ft"]).exits(0);
    let text = text.stdout();
    assert!(text.lines().all(|line| line.chars().count() <= 80));
    let words = format!("Fix the angle at {best} deg: ");
    assert!(text.contains(&words), "{text}");
    // Against the best of these angles at each distance.
    let costs = [0, 1].map(|distance| {
        let most = p(distance, 0).max(p(distance, 1)).max(p(distance, 2));
        100.0 * (most - p(distance, if best == "60" { 1 } else { 2 }))
    });
    let words = format!(
        "{best} deg costs {:.1} per 100 on average",
        (costs[0] + costs[1]) / 2.0
    );
    assert!(text.replace('\n', " ").contains(&words), "{words}: {text}");
    let csv = fs::read_to_string(folder.path().join("curves.csv")).unwrap();
    assert_eq!(csv.lines().count(), 7);
    assert!(csv.starts_with("distance_ft,kind,has_shot,"), "{csv}");
    curve(&["--distances", "900 ft"]).exits(2);
}
