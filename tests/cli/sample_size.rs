//! `design`: how many shots a question takes.

use super::support::{Answer, bankshot, fit, write_file};
use std::fs;
use tempfile::TempDir;

/// Authority: two equal sessions with errors a and b of one shot show a difference d with
/// (1.96 + 0.84)^2 (a^2 + b^2) / d^2 shots each, and a is what the rows of the table give.
#[test]
fn contract_design_says_how_many_shots_show_a_difference() {
    let folder = TempDir::new().unwrap();
    let usual = fs::read_to_string("configs/free_throw.toml").unwrap();
    let nominal =
        "\n[nominal]\nspeed = \"24.2 ft/s\"\npitch = \"51 deg\"\nbackspin = \"3 rev/s\"\n";
    let first = write_file(&folder, "usual.toml", usual.clone() + nominal);
    let tired = usual.replace("c10 = \"0.25 ft/s\"", "c10 = \"0.5 ft/s\"");
    assert_ne!(tired, usual);
    let second = write_file(&folder, "tired.toml", tired + nominal);
    let design = |profile: &std::path::Path, more: &[&str]| {
        let mut command = bankshot();
        command.arg("design").arg(profile);
        command.args(["--shots", "100", "--repetitions", "8", "--json", "--quiet"]);
        Answer::of(command.args(more)).exits(0).json()
    };
    let both = design(&first, &["--against", second.to_str().unwrap()]);
    let of_second = design(&second, &[]);
    let of_one_shot =
        |json: &serde_json::Value, key: &str| 10.0 * json["tests"][0][key].as_f64().unwrap();
    let known = |change: f64, key: &str| {
        let [a, b] = [&both, &of_second].map(|json| of_one_shot(json, key));
        let root = (1.96 + 0.8416) / change;
        root * root * (a * a + b * b)
    };
    let differences = both["against"]["differences"].as_array().unwrap();
    let named = |name: &str| differences.iter().find(|of| of["name"] == name).unwrap();
    let (p, speed) = (named("probability"), named("speed_sd"));
    // The means are equal, so no number of shots shows a difference.
    assert!(named("pitch_mean")["shots_in_each_of_two"].is_null());
    let shots = |of: &serde_json::Value| of["shots_in_each_of_two"].as_f64().unwrap();
    let change = of_second["probability"].as_f64().unwrap() - both["probability"].as_f64().unwrap();
    assert!((p["change"].as_f64().unwrap() - change).abs() < 1e-12 && change < -0.1);
    assert!((shots(p) / known(change, "probability_error") - 1.0).abs() < 1e-9);
    assert!((speed["change"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    let known = known(std::f64::consts::LN_2, "speed_sd_relative_error");
    assert!((shots(speed) / known - 1.0).abs() < 1e-9);
    assert!(both["against"]["differences"][0]["shots_in_second_session"].is_null());
}

#[test]
fn contract_sample_size_is_that_of_simulated_sessions() {
    let flags = [
        "--speed",
        "24.2 ft/s",
        "--pitch",
        "51 deg",
        "--shots",
        "25,100",
        "--repetitions",
        "8",
    ];
    let answer = Answer::of(
        bankshot()
            .args(["design", "configs/free_throw.toml", "--quiet"])
            .args(flags),
    );
    let text = answer.exits(0).stdout().to_owned();
    // Rows of up to 100 shots do not show how many 5 per 100 take: one of that size is simulated.
    let (_, added) = text.split_once("The row of ").unwrap();
    let added: usize = added.split(' ').next().unwrap().parse().unwrap();
    assert!(added > 150, "{added}");
    let row = |shots: &str| -> Vec<f64> {
        let line = text
            .lines()
            .find(|line| line.split_whitespace().next() == Some(shots) && line.starts_with(' '))
            .unwrap();
        line.split_whitespace()
            .filter_map(|word| word.parse().ok())
            .collect()
    };
    // Known: standard errors of 6.7 and 3.3 per 100, 9.2 and 4.6 by counting; within a fifth.
    for (shots, fitted, counted) in [("25", 6.7, 9.2), ("100", 3.3, 4.6)] {
        let found = row(shots);
        let near = |value: f64, known: f64| (value / (1.96 * known) - 1.0).abs() < 0.2;
        assert!(near(found[1], fitted) && near(found[2], counted), "{text}");
    }
    // A target is met by a row of its own.
    let json = Answer::of(
        bankshot()
            .args(["design", "configs/free_throw.toml", "--quiet", "--json"])
            .args(flags)
            .args(["--target", "4"]),
    );
    let answer = json.exits(0).json();
    let tests = answer["tests"].as_array().unwrap();
    let row = tests
        .iter()
        .find(|row| row["shots"] == answer["target"]["shots"])
        .unwrap();
    let error = row["probability_error"].as_f64().unwrap();
    assert!((error / 0.04 - 1.0).abs() < 0.2, "{answer}");
    // Two equal sessions: 1.96 + 0.84 standard deviations of a difference.
    let change = row["least_change_of_probability"].as_f64().unwrap();
    assert!((change / (2.8016 * std::f64::consts::SQRT_2 * error) - 1.0).abs() < 1e-3);
    // A second session against one that is there.
    let second = Answer::of(
        bankshot()
            .args(["design", "configs/free_throw.toml", "--quiet"])
            .args(flags)
            .args(["--first", "50"]),
    );
    let text = second.exits(0).stdout().to_owned();
    assert!(
        text.contains("After the 50 shots of the first session") && text.contains("not possible"),
        "{text}"
    );
    // Of a fit the first session is known as the fit knows it, whatever the new tracker is.
    let folder = TempDir::new().unwrap();
    fit("docs/data/gym_sensor.csv", folder.path(), &[]).exits(0);
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("fit.json")).unwrap()).unwrap();
    let mut command = bankshot();
    command.arg("design").arg(folder.path());
    let of_fit = [
        "--shots",
        "200,25",
        "--repetitions",
        "4",
        "--tracker",
        "lab",
    ];
    let change = ["--change", "3,10", "--json", "--quiet"];
    let answer = Answer::of(command.args(of_fit).args(change))
        .exits(0)
        .json();
    let first = &answer["first_session"];
    assert_eq!(first["shots"], 125);
    let known = |value: &serde_json::Value| value.as_f64().unwrap();
    let of_posterior = known(&json["probability"]["sd"]);
    assert!((known(&first["probability_error"]) / of_posterior - 1.0).abs() < 0.05);
    assert_eq!(answer["tests"][0]["shots"], 25);
    let changes = answer["changes"].as_array().unwrap();
    assert!(changes[0]["shots_in_second_session"].is_null());
    let (second, each) = ("shots_in_second_session", "shots_in_each_of_two");
    // More than in equal sessions, as the first one is smaller than those.
    assert!(
        known(&changes[1][second]) > known(&changes[1][each]),
        "{answer}"
    );
}
