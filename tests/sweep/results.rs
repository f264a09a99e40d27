//! The results: nothing that happens to the outputs loses one, and a mirrored one is right.

use crate::support::{SWEEP, TestFolder, assert_code, bankshot, tables};
use bankshot::best_shot;
use bankshot::config::parse_profile;
use bankshot::probability::Silent;
use std::fs;

#[cfg(unix)]
#[test]
fn contract_closed_and_full_outputs_lose_no_result() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    for (name, shell, code) in [
        ("full", "\"$@\" >/dev/full", 74),
        ("closed", "\"$@\" >&- 2>&-", 0),
        ("head", "\"$@\" | true", 0),
        ("no-home", "env -u HOME -u TERM \"$@\"", 0),
    ] {
        let out = test.out(name);
        let command = test.command(&out);
        let output = std::process::Command::new("sh")
            .args(["-c", shell, "sh"])
            .arg(command.get_program())
            .args(command.get_args())
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(code), "{name}: {output:?}");
        assert_eq!(tables(&out), bytes, "{name}");
    }
}

#[test]
fn contract_unusable_folders_are_found_before_computing() {
    let test = TestFolder::new();
    let file = test.out("file");
    fs::write(&file, "x").unwrap();
    for out in [file.clone(), file.join("below")] {
        assert_code(&test.run(&out, &["--quiet"]), 74);
    }
    let missing = test.out("nothing");
    let output = bankshot().arg("status").arg(missing).output().unwrap();
    assert_code(&output, 2);
    // Foreign files are ignored.
    let out = test.out("foreign");
    fs::create_dir_all(out.join("store")).unwrap();
    fs::write(out.join("store/notes.txt"), "hello").unwrap();
    fs::create_dir(out.join("store/folder.sqlite")).unwrap();
    fs::write(out.join("best.docx"), [0; 100]).unwrap();
    assert_code(&test.run(&out, &["--quiet"]), 0);
}

#[test]
fn prop_a_mirrored_result_agrees_with_a_search_at_its_place() {
    // Tolerance: 4.5 standard errors of the difference, and what so coarse a table may lose.
    let test = TestFolder::new();
    let (out, _) = test.undisturbed();
    let profile = format!(
        "{}\n[location]\ndistance = \"12 ft\"\nangle = \"-40 deg\"\n",
        &SWEEP[SWEEP.find("[shooter]").unwrap()..]
    );
    let profile = parse_profile(&profile, "test").unwrap();
    let best = best_shot::find(&profile, &Silent).unwrap();
    let mut reader = csv::Reader::from_path(out.join("best_shots.csv")).unwrap();
    let header = reader.headers().unwrap().clone();
    let at = |name: &str| header.iter().position(|column| column == name).unwrap();
    let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
    for (kind, shot) in [
        ("direct", best.direct.unwrap()),
        ("bank", best.bank.unwrap()),
    ] {
        let number = |row: &csv::StringRecord, name: &str| row[at(name)].parse::<f64>().unwrap();
        let row = rows
            .iter()
            .find(|row| {
                &row[at("kind")] == kind
                    && (number(row, "distance_ft") - 12.0).abs() < 1e-9
                    && (number(row, "court_angle_deg") + 40.0).abs() < 1e-9
            })
            .unwrap();
        assert_eq!(&row[at("mirrored")], "true");
        assert!((number(row, "polar_deg") + 40.0).abs() < 10.0);
        let error = libm::hypot(number(row, "standard_error"), shot.estimate.standard_error);
        let difference = number(row, "probability") - shot.estimate.probability;
        assert!(
            difference.abs() < 4.5 * error + 0.02,
            "{kind}: {difference} +- {error}"
        );
    }
}
