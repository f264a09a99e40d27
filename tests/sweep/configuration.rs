//! The files of a sweep: what is refused and how, and when a folder holds another sweep.

use crate::support::{SWEEP, TestFolder, assert_code, assert_printed, bankshot, printed, tables};
use bankshot::sweep::{SourceTexts, sweep_toml::parse_sweep};
use bankshot::units::UnitSystem;
use std::fs;

#[test]
fn contract_another_configuration_is_refused_and_a_reformatted_one_is_not() {
    let test = TestFolder::new();
    let (out, bytes) = test.undisturbed();
    let reformatted = SWEEP
        .replace("\"8 ft\", \"12 ft\"", "  \"8.0 ft\" ,\n \"12 ft\"")
        .replace("standard_error = 0.02", "standard_error = 2e-2 # the same");
    assert_ne!(reformatted, SWEEP);
    fs::write(&test.sweep, reformatted).unwrap();
    let output = test.run(&out, &["--quiet"]);
    assert_code(&output, 0);
    fs::write(&test.sweep, SWEEP.replace("0.25 ft/s", "0.26 ft/s")).unwrap();
    let output = test.run(&out, &["--quiet"]);
    assert_code(&output, 4);
    assert_printed(
        &output,
        "settings.shooter.dispersion.c10_m_s: the folder has 0.0762, you asked for 0.07924",
    );
    assert_eq!(tables(&out), bytes);
}

#[test]
fn contract_another_version_of_the_program_is_refused_and_named() {
    let test = TestFolder::new();
    let (out, bytes) = test.undisturbed();
    // Another version gives another hash.
    let file = out.join("configuration.json");
    let text = fs::read_to_string(&file).unwrap();
    let mut manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
    manifest["version"] = "9.9.9".into();
    manifest["hash"] = "0".repeat(64).into();
    let sealed = serde_json::to_string(&(&manifest["hash"], &manifest["texts"])).unwrap();
    manifest["checksum"] = blake3::hash(sealed.as_bytes()).to_hex().to_string().into();
    fs::write(&file, manifest.to_string()).unwrap();
    let output = bankshot()
        .args(["status", "--json"])
        .arg(&out)
        .output()
        .unwrap();
    let status: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(status["jobs"].as_u64().unwrap() > 0);
    assert_eq!(status["remarks"].as_array().unwrap().len(), 0);
    let output = bankshot().arg("status").arg(&out).output().unwrap();
    assert_code(&output, 3);
    for output in [
        test.run(&out, &["--quiet"]),
        bankshot().arg("merge").arg(&out).output().unwrap(),
    ] {
        assert_code(&output, 4);
        assert_printed(&output, "program.version: the folder has \"9.9.9\"");
    }
    assert_eq!(tables(&out), bytes);
}

/// A launcher's limits and units are in its file. The sweep's own keys go first.
#[test]
fn contract_the_limits_of_the_shooters_file_hold_in_a_sweep() {
    let (sweep, rest) = SWEEP.split_at(SWEEP.find("[shooter]").unwrap());
    let (shooter, settings) = rest.split_at(rest.find("[grid]").unwrap());
    let limits = "[search]\nchoose = [\"speed\", \"pitch\"]\npitch_min = \"50 deg\"\n\
                  pitch_max = \"60 deg\"\nspeed_max = \"30 ft/s\"\nstandard_error = 0.05\n\
                  [location]\ndistance = \"10 ft\"\nangle = \"0 deg\"\n[output]\nunits = \"metric\"\n";
    let own = settings.replace("[search]", "[search]\npitch_max = \"58 deg\"");
    assert_ne!(own, settings);
    let texts = SourceTexts {
        sweep: format!("{sweep}shooter = \"launcher.toml\"\n{own}"),
        shooter: Some(format!("{shooter}{limits}")),
        places: None,
    };
    let settings = parse_sweep(&texts, "sweep.toml").unwrap().settings;
    let search = &settings.search;
    let degrees = |rad: Option<f64>| (rad.unwrap().to_degrees() * 1e6).round() / 1e6;
    assert_eq!(degrees(search.pitch_min_rad), 50.0);
    assert_eq!(degrees(search.pitch_max_rad), 58.0);
    assert!((search.speed_max_m_s.unwrap() - 9.144).abs() < 1e-9);
    assert_eq!(search.choice.iter().count(), 2);
    assert_eq!(search.standard_error, Some(0.02));
    assert_eq!(settings.output.units, UnitSystem::Metric);
}

/// A table that belongs to the shooter's file is refused once, not also as unknown.
#[test]
fn contract_physics_beside_a_named_shooter_is_refused_once() {
    let test = TestFolder::new();
    let (sweep, rest) = SWEEP.split_at(SWEEP.find("[shooter]").unwrap());
    let (shooter, settings) = rest.split_at(rest.find("[grid]").unwrap());
    let sweep = format!("{sweep}shooter = \"other.toml\"\n{settings}");
    let shooter = format!("{shooter}[location]\ndistance = \"12 ft\"\nangle = \"0 deg\"\n");
    fs::write(test.sweep.with_file_name("other.toml"), shooter).unwrap();
    fs::write(
        &test.sweep,
        format!("{sweep}\n[physics]\npreset = \"ncaa\"\n"),
    )
    .unwrap();
    let output = bankshot().arg("check").arg(&test.sweep).output().unwrap();
    assert_code(&output, 2);
    let printed = printed(&output);
    assert!(
        printed.contains("comes from the file that sweep.shooter names"),
        "{printed}"
    );
    assert_eq!(printed.matches("error:").count(), 1, "{printed}");
}

#[test]
fn contract_invalid_sweeps_are_refused_with_each_error_at_its_line() {
    for (from, to, message) in [
        ("\"8 ft\", \"12 ft\"", "\"8\", \"12 ft\"", "unit"),
        ("\"8 ft\"", "\"nan ft\"", "finite"),
        ("\"40 deg\"]", "\"inf deg\"]", "finite"),
        (
            "angle_step = \"40 deg\"",
            "angle_step = \"0 deg\"",
            "0.00001 rad or more",
        ),
        (
            "angle_step = \"40 deg\"",
            "angle_step = \"0.001 deg\"",
            "places; take a larger step",
        ),
        ("\"arcs\"", "\"moon\"", "must be \"half_court\""),
        ("\"arcs\"", "\"rectangle\"", "is missing"),
        ("name = \"small\"", "name = \"\"", "1 to 500"),
        ("name = \"small\"", "court = \"wnba\"", "must be \"ncaa\""),
        (
            "name = \"small\"",
            "compute = [\"spin\"]",
            "must name direct or bank",
        ),
        ("name = \"small\"", "shooter = \"none.toml\"", "none.toml"),
        ("name = \"small\"", "colour = \"red\"", "is an unknown key"),
        (
            "[grid]",
            "[location]\ndistance = \"10 ft\"\n[grid]",
            "is an unknown key",
        ),
        ("speed = 12", "speed = 65536000", "from 2 to 100000"),
        ("[sweep]", "[sweeps]", "so this is no sweep"),
        ("[sweep]", "[sweep]\nname = \"twice\"", "duplicate key"),
    ] {
        let text = SWEEP.replace(from, to);
        assert_ne!(text, SWEEP);
        let test = TestFolder::with(&text);
        let out = test.out("out");
        let output = test.run(&out, &["--quiet"]);
        assert_eq!(output.status.code(), Some(2), "{to}: {output:?}");
        assert!(printed(&output).contains(message), "{to}: {output:?}");
        assert!(!out.exists(), "{to}");
    }
}

#[test]
fn contract_a_negative_distance_behind_the_board_is_left_out() {
    let text = SWEEP.replace("\"8 ft\"", "\"-8 ft\"");
    assert_ne!(text, SWEEP);
    let test = TestFolder::with(&text);
    let output = test.run(&test.out("out"), &["--quiet"]);
    assert_code(&output, 0);
    assert!(
        printed(&output).starts_with("8 of 8 jobs done"),
        "{output:?}"
    );
}

#[test]
fn contract_a_file_of_locations_is_read_by_column_name_and_refused_by_row() {
    let head = SWEEP.split("region").next().unwrap();
    let tail = &SWEEP[SWEEP.find("[shooter]").unwrap()..];
    let text = format!("{head}region = \"places\"\nplaces = \"places.csv\"\n{tail}");
    let test = TestFolder::with(&text);
    let file = test.out("places.csv");
    for (places, message) in [
        (
            "x_ft,y_ft\n10,2\n1,0\n",
            "row 2: the place is inside the ring",
        ),
        ("x_ft,y_ft\n10,two\n", "row 1: y_ft must be a number"),
        ("x,y\n10,2\n", "needs the columns"),
        ("x_ft,y_ft\n", "has no place"),
    ] {
        fs::write(&file, places).unwrap();
        let output = test.run(&test.out("out"), &["--quiet"]);
        assert_code(&output, 2);
        assert_printed(&output, message);
    }
    // A location, its mirror image and the first one again: one is computed, all three are in the
    // table.
    fs::write(
        &file,
        "name,distance_ft,court_angle_deg\na,10,30\nb,10,-30\nc,10,30\n",
    )
    .unwrap();
    let out = test.out("out");
    let output = test.run(&out, &["--quiet"]);
    assert_code(&output, 0);
    assert!(printed(&output).starts_with("2 of 2 jobs"), "{output:?}");
    let csv = fs::read_to_string(out.join("best_shots.csv")).unwrap();
    assert_eq!(csv.lines().count(), 7);
}

#[test]
fn contract_names_never_become_paths() {
    for name in ["../../escape", "a/b", &"long ".repeat(90)] {
        let text = SWEEP.replace("\"small\"", &format!("\"{name}\""));
        let test = TestFolder::with(&text);
        let output = bankshot()
            .current_dir(test.folder.path())
            .args(["sweep", "sweep.toml", "--quiet"])
            .output()
            .unwrap();
        assert_code(&output, 0);
        let made: Vec<_> = fs::read_dir(test.out("results")).unwrap().collect();
        assert_eq!(made.len(), 1);
    }
}
