//! `check` and `plan`: shipped profiles are valid, and every error of a profile is named.

use super::support::{Answer, FREE_THROW, bankshot, best, file_names, write_file};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn check(path: &Path) -> Answer {
    Answer::of(bankshot().arg("check").arg(path))
}

#[test]
fn contract_check_and_plan_accept_the_shipped_profiles() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs");
    let mut checked = 0;
    for folder in [root.clone(), root.join("paper")] {
        let names = file_names(&folder);
        for name in names.iter().filter(|name| name.ends_with(".toml")) {
            check(&folder.join(name)).exits(0).prints(": valid (");
            checked += 1;
        }
    }
    assert!(checked >= 10);
    let arguments = ["plan", "configs/free_throw.toml", "--wide-sample", "20000"];
    Answer::of(bankshot().args(arguments))
        .exits(0)
        .prints("then 870912 around each best shot")
        .prints("and 0 of those went in");
}

#[test]
fn contract_check_lists_the_physics_and_what_it_rests_on() {
    let list = |arguments: &[&str]| {
        let mut command = bankshot();
        command.args(["check", "configs/free_throw.toml", "--verbose"]);
        Answer::of(command.args(arguments)).exits(0)
    };
    let mut own = list(&[]);
    for words in [
        "physics: ncaa (",
        "drag_coefficient     0.45",
        "measured: ",
        "rule book: ",
        "hoop_restitution     0.6000",
        "assumed",
    ] {
        own = own.prints(words);
    }
    assert_eq!(own.stderr, "");
    list(&["--physics", "paper"]).prints("physics: paper (");
}

/// What is replaced in the profile of the free throw, and words that the message must have.
const ERRORS: [(&str, &str, &[&str]); 30] = [
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
        &["shooter.errors.speed", "missing", "(or c10)"],
    ),
    ("c11 = 0.0", "c11 = nan", &["shooter.errors.c11", "finite"]),
    ("c11 = 0.0", "c11 = -1.0", &["c10 + c11 v"]),
    (
        "c11 = 0.0",
        "c19 = 0.0",
        &["shooter.errors.c19", "unknown key"],
    ),
    ("[location]", "[loction]", &["loction", "unknown key"]),
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
        &["physics.friction", "from 0 to 10"],
    ),
    (
        "preset = \"paper\"",
        "restitution = 1.5",
        &["physics.restitution", "at most 1"],
    ),
    (
        "preset = \"paper\"",
        "preset = \"ncaa\"\nair_density = \"-1 kg/m^3\"",
        &["physics.air_density", "from 0 to 10"],
    ),
    (
        "preset = \"paper\"",
        "preset = \"ncaa\"\nair_density = \"1000 kg/m^3\"",
        &["physics.air_density", "from 0 to 10"],
    ),
    (
        "preset = \"paper\"",
        "preset = \"ncaa\"\nball_mass = \"5 g\"\nair_density = \"1 kg/m^3\"",
        &[
            "physics.air_density",
            "buoyancy is less than half the weight",
        ],
    ),
    (
        "preset = \"paper\"",
        "preset = \"ncaa\"\nring_tube_diameter = \"-1 in\"",
        &["physics.ring_tube_diameter", "from 0 to 1 m"],
    ),
    (
        "preset = \"paper\"",
        "preset = \"ncaa\"\nring_tube_diameter = \"12 in\"",
        &[
            "physics.ring_tube_diameter",
            "less than the ball's diameter",
        ],
    ),
    (
        "preset = \"paper\"",
        "preset = \"ncaa\"\nbracket_width = \"3 ft\"",
        &["physics.bracket_width", "less than the ring's diameter"],
    ),
    (
        "preset = \"paper\"",
        "preset = \"ncaa\"\nboard_edge_radius = \"2 ft\"",
        &["physics.board_edge_radius", "half the board's width"],
    ),
    (
        "preset = \"paper\"",
        "hoop_restitution = 1.5",
        &["physics.hoop_restitution", "at most 1"],
    ),
    (
        "preset = \"paper\"",
        "friction = 0.5\nhoop_friction = 0.5",
        &[
            "physics.hoop_friction",
            "give either friction or hoop_friction",
        ],
    ),
    (
        "preset = \"paper\"",
        "restitution = 0.5\nboard_damping = \"20 kg/s\"",
        &["give either restitution or board_damping"],
    ),
    (
        "preset = \"paper\"",
        "altitude = \"5280 ft\"\nair_density = \"1 kg/m^3\"",
        &["physics.altitude", "give either altitude or air_density"],
    ),
    (
        "preset = \"paper\"",
        "altitude = \"50000 m\"",
        &["physics.altitude", "9000 m"],
    ),
    (
        "preset = \"paper\"",
        "temperature = \"72\"",
        &["physics.temperature", "72 F"],
    ),
    ("preset = \"paper\"", "preset = \"paper", &["not TOML"]),
];

#[test]
fn contract_errors_of_a_profile_name_the_key_the_value_and_what_is_allowed() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("never");
    for (from, to, words) in ERRORS {
        assert!(FREE_THROW.contains(from), "{from}");
        let profile = write_file(&folder, "bad.toml", FREE_THROW.replace(from, to));
        for answer in [check(&profile), Answer::of(&mut best(&profile, &out))] {
            let mut answer = answer.exits(2);
            assert!(answer.stdout.is_empty(), "{answer:?}");
            for word in words {
                answer = answer.says(word);
            }
        }
    }
    assert!(!out.exists(), "nothing is written for a refused profile");
}

#[test]
fn contract_all_errors_of_a_profile_are_reported_at_once_with_their_lines() {
    let folder = TempDir::new().unwrap();
    let text = FREE_THROW
        .replace("\"7 ft\"", "\"7\"")
        .replace("c20 = \"1.2 deg\"", "c20 = \"-1.2 deg\"")
        .replace("c40 = \"0.3 rev/s\"", "c40 = \"0.3 furlong\"")
        .replace("\"13.75 ft\"", "\"x ft\"");
    let line_of = |key: &str| {
        let line = text.lines().position(|line| line.starts_with(key)).unwrap();
        format!("bad.toml:{}:", line + 1)
    };
    let profile = write_file(&folder, "bad.toml", &text);
    let mut answer = check(&profile).exits(2);
    for (name, key) in [
        ("release_height", "release_height"),
        ("c20", "c20"),
        ("c40", "c40"),
        ("location.distance", "distance"),
    ] {
        answer = answer.says(name).says(&line_of(key));
    }
}

#[test]
fn contract_unreadable_profiles_are_refused() {
    let folder = TempDir::new().unwrap();
    let latin = write_file(&folder, "latin.toml", b"[shooter]\nname = \"Jos\xe9\"\n");
    check(&latin).exits(2).says("UTF-8");
    check(folder.path()).exits(2).says("not a file");
    let missing = folder.path().join("none.toml");
    check(&missing).exits(2).says("there is no such file");
    write_file(&folder, "player.toml", "");
    check(&folder.path().join("plyer.toml"))
        .exits(2)
        .says("there is no such file or folder; did you mean \"player.toml\"?");
    let huge = folder.path().join("huge.toml");
    fs::File::create(&huge).unwrap().set_len(20 << 20).unwrap();
    check(&huge).exits(2).says("at most");
    Answer::of(bankshot().arg("best")).exits(2);
    Answer::of(bankshot().arg("nonsense")).exits(2);
}

#[test]
fn contract_grids_that_are_too_large_or_not_whole_are_refused() {
    let folder = TempDir::new().unwrap();
    for grid in [
        "speed = 40\npitch = 65536\npolar = 65536\nbackspin = 65536",
        "speed = 0",
        "pitch = -3",
        "polar = 1e3",
    ] {
        let text = format!("{FREE_THROW}\n[grid]\n{grid}\n");
        let profile = write_file(&folder, "bad.toml", text);
        check(&profile).exits(2).says("grid");
    }
}

#[test]
fn contract_implausible_errors_are_refused() {
    let folder = TempDir::new().unwrap();
    for (from, to) in [
        ("\"0.25 ft/s\"", "\"1e300 ft/s\""),
        ("\"0.3 rev/s\"", "\"1e300 rev/s\""),
        ("c11 = 0.0", "c11 = 9"),
    ] {
        let profile = write_file(&folder, "p.toml", FREE_THROW.replace(from, to));
        check(&profile).exits(2);
    }
}

#[test]
fn contract_impossible_correlations_are_refused_with_their_file() {
    const NINE: &str = include_str!("../../configs/errors_in_all_nine_variables.toml");
    let line = "speed_pitch = -0.25            # from -1 to 1; any pair of the nine";
    assert!(NINE.contains(line));
    let folder = TempDir::new().unwrap();
    for (text, reason) in [
        ("speed_pitch = 1.5", "from -1 to 1"),
        ("pitch_tempo = 0.5", "unknown key"),
        (
            "speed_pitch = 0.9\nspeed_polar = 0.9\npitch_polar = -0.9",
            "not positive semi-definite",
        ),
    ] {
        let profile = write_file(&folder, "p.toml", NINE.replace(line, text));
        check(&profile).exits(2).says(reason).says("p.toml");
    }
}

#[test]
fn contract_thousands_of_errors_are_counted_and_the_first_shown() {
    let folder = TempDir::new().unwrap();
    let keys: String = (0..40_000).map(|i| format!("key_{i} = 1\n")).collect();
    let profile = write_file(&folder, "many.toml", format!("{keys}{FREE_THROW}"));
    let answer = check(&profile).exits(2);
    assert_eq!(answer.stderr.matches("is an unknown key").count(), 50);
    assert!(
        answer.stderr.contains("... and 39950 more errors"),
        "{}",
        &answer.stderr[answer.stderr.len() - 200..]
    );
    let large = write_file(&folder, "large.toml", "#".repeat(2_000_000));
    check(&large).exits(2).says("at most 1048576 are read");
}

#[test]
fn contract_plain_names_of_errors_and_either_order_of_correlations() {
    let folder = TempDir::new().unwrap();
    let load = |text: &str| bankshot::config::parse_profile(text, "p.toml");
    let plain = FREE_THROW
        .replace("c10 =", "speed =")
        .replace("c20 =", "pitch =")
        .replace("c30 =", "polar =")
        .replace("c40 =", "backspin =");
    let with = |text: &str, pair: &str| format!("{text}\n[shooter.correlation]\n{pair}\n");
    let usual = load(&with(FREE_THROW, "speed_pitch = 0.2")).unwrap();
    let other = load(&with(&plain, "pitch_speed = \"20 %\"")).unwrap();
    assert_eq!(usual.shooter().dispersion, other.shooter().dispersion);
    for (text, message) in [
        (
            FREE_THROW.replace("c20 =", "speed = \"1 ft/s\"\nc20 ="),
            "shooter.errors.speed: is given twice: c10 and speed are the same",
        ),
        (
            with(FREE_THROW, "speed_pitch = 0.1\npitch_speed = 0.1"),
            "is given twice: speed_pitch and pitch_speed are the same",
        ),
        (
            FREE_THROW.replace("release_height", "relaese_height"),
            "did you mean \"release_height\"?",
        ),
    ] {
        let profile = write_file(&folder, "p.toml", text);
        check(&profile).exits(2).says(message);
    }
}

#[test]
fn contract_check_names_errors_with_their_lines_as_json() {
    let folder = TempDir::new().unwrap();
    let json = |text: &str, code: i32| {
        let profile = write_file(&folder, "p.toml", text);
        let mut command = bankshot();
        Answer::of(command.arg("check").arg(profile).arg("--json"))
            .exits(code)
            .json()
    };
    let valid = json(FREE_THROW, 0);
    assert_eq!(valid["is_valid"], true);
    assert_eq!(valid["warnings"].as_array().unwrap().len(), 0);
    let high = json(&FREE_THROW.replace("\"7 ft\"", "\"11 ft\""), 0);
    assert!(high["warnings"][0].as_str().unwrap().contains("11.0 ft"));
    let wrong = FREE_THROW.replace("\"1.2 deg\"", "\"1.2 ft\"");
    let line = 1 + wrong.lines().position(|l| l.contains("1.2 ft")).unwrap();
    let refused = json(&wrong, 2);
    assert_eq!(refused["is_valid"], false);
    assert_eq!(refused["errors"][0]["key"], "shooter.errors.c20");
    assert_eq!(refused["errors"][0]["line"], line);
}

#[test]
fn contract_a_table_or_a_folder_in_place_of_a_profile_is_told_apart() {
    let folder = TempDir::new().unwrap();
    let table = write_file(&folder, "shots.csv", "depth_in,made\n11,1\n");
    check(&table).exits(2).says("`bankshot fit ");
    write_file(&folder, "profile.toml", FREE_THROW);
    check(folder.path()).exits(2).says("profile.toml");
    let physics = write_file(&folder, "foam.toml", "[physics]\npreset = \"ncaa\"\n");
    check(&physics)
        .exits(2)
        .says("this is a physics, not a profile: give a profile, and the physics as --physics ");
}

#[test]
fn contract_odd_nominal_angles_and_balls_are_named() {
    let folder = TempDir::new().unwrap();
    let with_pitch = |pitch: &str| {
        let text = format!("{FREE_THROW}\n[nominal]\npitch = \"{pitch}\"\n");
        write_file(&folder, "steep.toml", text)
    };
    check(&with_pitch("85 deg"))
        .exits(0)
        .says("nominal.pitch: 85.0 deg above the horizontal");
    check(&with_pitch("95 deg"))
        .exits(2)
        .says("between -90 and 90 deg");
    let fixed = format!(
        "{FREE_THROW}\n[nominal]\npitch = \"-5 deg\"\n[search]\nchoose = [\"speed\", \"polar\", \"backspin\"]\n"
    );
    let profile = write_file(&folder, "fixed.toml", fixed);
    let refused = check(&profile).exits(2);
    refused
        .says("nominal.pitch: -5.0 deg: must be from 1 to 89 deg (search.choose leaves pitch out");
    let foam = |more: &str| {
        let physics = format!("preset = \"ncaa\"\nball_mass = \"136 g\"\n{more}");
        let text = FREE_THROW.replace("preset = \"paper\"", &physics);
        write_file(&folder, "foam.toml", text)
    };
    check(&foam(""))
        .exits(0)
        .says("a ball of 136 g with the bounce of a basketball");
    let own = check(&foam("board_restitution = 0.5\nhoop_restitution = 0.4\n")).exits(0);
    assert!(!own.stderr.contains("bounce of a basketball"));
}
