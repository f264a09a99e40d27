//! The results: nothing that happens to the outputs loses one, and a mirrored one is right.

use crate::support::{SWEEP, TestFolder, assert_code, assert_printed, bankshot, printed, tables};
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

#[test]
fn contract_sweep_report_and_compare_count_with_one_rule() {
    let test = TestFolder::new();
    let out = test.out("counted");
    let sweep = test.run(&out, &["--quiet"]);
    let sentence = printed(&sweep)
        .lines()
        .find(|line| line.starts_with("Bank is better at"))
        .unwrap()
        .to_owned();
    assert!(sentence.ends_with("by at least 1 per 100."), "{sentence}");
    for command in ["map", "report"] {
        let output = bankshot().arg(command).arg(&out).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        // A paragraph may break the sentence over two lines.
        let words: Vec<String> = printed(&output)
            .split_whitespace()
            .map(String::from)
            .collect();
        assert!(
            words.join(" ").contains(&sentence),
            "{sentence}: {output:?}"
        );
    }
    // The rule, again from the table: independent estimates, two standard errors and one shot in
    // 100, every place.
    let table = fs::read_to_string(out.join("best_shots.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|column| column == name).unwrap();
    let (place, p, error) = (
        column("place"),
        column("probability"),
        column("standard_error"),
    );
    let mut values: std::collections::BTreeMap<String, Vec<(f64, f64)>> = Default::default();
    for row in reader.records().map(Result::unwrap) {
        let number = |i: usize| row[i].parse::<f64>().unwrap();
        values
            .entry(row[place].to_owned())
            .or_default()
            .push((number(p), number(error)));
    }
    let better = values.values().filter(|pair| {
        let [(direct, a), (bank, b)] = pair[..] else {
            panic!("{pair:?}")
        };
        bank - direct > (2.0 * (a * a + b * b).sqrt()).max(0.01)
    });
    let expected = format!("better at {} of {} places", better.count(), values.len());
    assert!(sentence.contains(&expected), "{sentence}: {expected}");
}

#[test]
fn contract_names_of_places_reach_the_tables() {
    let shooter = crate::support::SWEEP.split_once("[shooter]").unwrap().1;
    let sweep = format!(
        "[sweep]\nname = \"named\"\nregion = \"places\"\nplaces = \"places.csv\"\n[shooter]{shooter}"
    );
    let test = TestFolder::with(&sweep);
    let places = "name,x_ft,y_ft\nleft elbow,11,8\n\"the, line\",13.75,0\nright elbow,11,-8\n";
    fs::write(test.folder.path().join("places.csv"), places).unwrap();
    let out = test.out("named");
    assert_code(&test.run(&out, &["--quiet"]), 0);
    let table = fs::read_to_string(out.join("best_shots.csv")).unwrap();
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    assert_eq!(&reader.headers().unwrap()[2], "name");
    let names: Vec<String> = reader
        .records()
        .map(|row| row.unwrap()[2].to_owned())
        .collect();
    let expected = ["left elbow", "the, line", "right elbow"];
    assert_eq!(
        names,
        expected
            .into_iter()
            .flat_map(|name| [name; 2])
            .collect::<Vec<_>>()
    );
    let parquet = fs::read(out.join("best_shots.parquet")).unwrap();
    assert!(parquet.windows(11).any(|window| window == b"right elbow"));
    // A length is 11 and not 11.000000000000002.
    let digits = |cell: &str| {
        let digits = cell.split('e').next().unwrap().replace(['.', '-'], "");
        digits.trim_start_matches('0').len()
    };
    let numbers = table
        .split([',', '\n'])
        .filter(|cell| cell.parse::<f64>().is_ok());
    assert!(numbers.clone().count() > 50 && numbers.clone().all(|cell| digits(cell) <= 12));
    fs::write(
        test.folder.path().join("places.csv"),
        "name,x_ft,y_ft\na\u{202e}b,11,8\n",
    )
    .unwrap();
    let output = test.run(&test.out("refused"), &[]);
    assert_code(&output, 2);
    assert_printed(&output, "row 1: name");
}

#[test]
fn contract_a_clean_run_leaves_no_note_of_an_abort() {
    let test = TestFolder::new();
    let (out, _) = test.undisturbed();
    let notes = fs::read_dir(out.join("store")).unwrap().filter(|entry| {
        let path = entry.as_ref().unwrap().path();
        path.extension().is_some_and(|end| end == "aborted")
    });
    assert_eq!(notes.count(), 0);
}

#[test]
fn contract_a_sweep_reads_files_of_the_right_type_only() {
    let sweep = "[sweep]\nregion = \"arcs\"\nshooter = \"secret.txt\"\n";
    let test = TestFolder::with(sweep);
    fs::write(
        test.folder.path().join("secret.txt"),
        "password = hunter2\n",
    )
    .unwrap();
    let output = test.run(&test.out("out"), &[]);
    assert_code(&output, 2);
    assert_printed(&output, "sweep.shooter must name a .toml file");
    assert!(!printed(&output).contains("hunter2"), "{output:?}");
}
