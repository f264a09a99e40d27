//! `table`: shots for a machine, and source that looks them up.

use super::support::{Answer, bankshot, write_file};
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
    assert_eq!(json["checks"].as_array().unwrap().len(), 2);
    assert!(json["greatest_loss"].as_f64().unwrap() < 0.02);
    // A longer shot needs more speed.
    let speed = |i: usize| shots[i]["speed_ft_s"].as_f64().unwrap();
    assert!(speed(0) < speed(1) && speed(1) < speed(2));
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
    table(&folder, &["--distances", "8 ft, 16 ft", "--max-loss", "2"])
        .exits(2)
        .says("give a number from 0 to 1");
}

const CPP_MAIN: &str = r#"
#include "t.hpp"
#include <cstdio>
int main() {
    for (double distance : {11.5, 9.0}) {
        for (double value : shot_table::look_up(distance, 0.0)) std::printf("%.9g ", value);
        std::printf("\n");
    }
}
"#;

#[test]
fn contract_the_source_of_a_table_interpolates_as_the_table_does() {
    let folder = TempDir::new().unwrap();
    let range = ["--distances", "10 ft, 12 ft", "--max-loss", "1"];
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
    let csv = fs::read_to_string(folder.path().join("t.csv")).unwrap();
    let speeds: Vec<f64> = csv
        .lines()
        .skip(1)
        .map(|line| line.split(',').nth(4).unwrap().parse().unwrap())
        .collect();
    let middle = 0.25 * speeds[0] + 0.75 * speeds[1];
    let how = csv.lines().nth(1).unwrap().split(',').nth(3).unwrap();
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
        ("sh", vec!["-c", "c++ -std=c++11 -o t t.cpp && ./t"], "c++"),
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
        assert!(numbers(lines.next().unwrap()).iter().all(|v| v.is_nan()));
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

#[test]
fn contract_wrong_ranges_are_refused() {
    let folder = TempDir::new().unwrap();
    for (distances, message) in [
        ("10 ft to 14 ft", "has no step; write '6 ft, 8 ft' or"),
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
}

/// `cargo test --release --test cli campaign_interpolation -- --ignored --nocapture`
#[test]
#[ignore = "five minutes: three launchers with the full search, every foot from 6 to 20 ft"]
fn campaign_interpolation_of_three_launchers() {
    let folder = TempDir::new().unwrap();
    let full = ROBOT.split("[grid]").next().unwrap();
    for (name, height, errors, pitch, backspin) in [
        ("low", "2 ft", "1 %", "70 deg", "2 rev/s"),
        ("middle", "4 ft", "2 %", "65 deg", "1 rev/s"),
        ("tall", "6.5 ft", "0.5 %", "60 deg", "3 rev/s"),
    ] {
        let text = full
            .replace("\"3 ft\"", &format!("\"{height}\""))
            .replace("\"1 %\"", &format!("\"{errors}\""));
        let profile = write_file(&folder, "launcher.toml", text);
        let mut command = bankshot();
        command
            .arg("table")
            .arg(profile)
            .args(["--distances", "6 ft to 20 ft by 1 ft", "--format", "json"])
            .args(["--pitch", pitch, "--backspin", backspin, "--quiet"]);
        let json = Answer::of(&mut command).json();
        let loss = json["greatest_loss"].as_f64().unwrap();
        let checks = json["checks"].as_array().unwrap().len();
        println!("{name}: interpolation costs at most {loss:.4} in P over {checks} places");
        assert!(loss < 0.01 && checks >= 14, "{name}: {loss} {checks}");
    }
}
