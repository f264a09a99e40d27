//! `best`: its JSON, its folder, and shots that cannot be found.

use super::support::{
    Answer, bankshot, best, file_names, small_profile, too_slow_profile, write_file,
};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use tempfile::TempDir;

#[test]
fn contract_best_prints_only_json_and_writes_its_folder() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", small_profile());
    let runs = folder.path().join("runs");
    let output = Answer::of(best(&profile, &runs).args(["--json", "--quiet"])).exits(0);
    assert!(output.stderr.is_empty());
    let answer = output.json();
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
    let run = &runs;
    assert_eq!(
        file_names(run),
        [
            "answer.json",
            "best_shots.csv",
            "best_shots.json",
            "curves.csv",
            "plan.json",
            "profile.toml",
            "provenance.json",
            "sensitivity.csv"
        ]
    );
    let stored = fs::read(run.join("best_shots.json")).unwrap();
    assert_eq!(stored, output.stdout);
    let table = fs::read_to_string(run.join("best_shots.csv")).unwrap();
    assert!(table.starts_with(
        "kind,speed_ft_s,pitch_deg,polar_deg,backspin_rev_s,side_spin_rev_s,probability"
    ));
    assert_eq!(table.lines().count(), 3);
}

#[test]
fn contract_best_prints_the_same_with_one_thread_and_has_metric_units() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", small_profile());
    let run = |name: &str, options: &[&str]| {
        let mut command = best(&profile, &folder.path().join(name));
        Answer::of(command.args(["--json", "--quiet"]).args(options)).exits(0)
    };
    let all_threads = run("all", &[]);
    let one_thread = run("one", &["--threads", "1"]);
    assert_eq!(one_thread.stdout, all_threads.stdout);
    let metric = run("metric", &["--units", "metric"]).prints("\"speed_m_s\"");
    assert!(!metric.stdout().contains("_ft"));
}

#[test]
fn contract_metres_and_feet_give_the_same_answer() {
    let folder = TempDir::new().unwrap();
    let metres = small_profile()
        .replace("\"13.75 ft\"", "\"4.191 m\"")
        .replace("\"7 ft\"", "\"213.36 cm\"")
        .replace("\"0.25 ft/s\"", "\"0.0762 m/s\"");
    let mut answers = Vec::new();
    for (name, text) in [("a.toml", small_profile()), ("b.toml", metres)] {
        let profile = write_file(&folder, name, text);
        let mut command = best(&profile, folder.path());
        let answer = Answer::of(command.args(["--details", "--quiet"])).exits(0);
        let text = answer.stdout();
        let line = text.lines().find(|line| line.contains("  tolerance  "));
        let line = line.expect("the details have the tolerance of each value");
        assert!(line.contains(" ft/s, angle "), "{line}");
        answers.push(answer.stdout);
    }
    assert_eq!(answers[0], answers[1]);
}

/// A place that the flags give is that of a profile with the same place, and the folder holds it.
#[test]
fn contract_best_from_another_place_is_that_of_a_profile_there() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", small_profile());
    let moved = small_profile().replace("\"13.75 ft\"", "\"8'6\\\"\"");
    assert_ne!(moved, small_profile());
    let there = write_file(&folder, "there.toml", moved);
    let run = |profile: &Path, name: &str, options: &[&str]| {
        let mut command = best(profile, &folder.path().join(name));
        Answer::of(command.args(["--json", "--quiet"]).args(options)).exits(0)
    };
    let by_flag = run(&profile, "flag", &["--distance", "8'6\""]);
    let by_file = run(&there, "file", &[]);
    assert_eq!(by_flag.stdout, by_file.stdout);
    let again = run(&folder.path().join("flag/profile.toml"), "again", &[]);
    assert_eq!(again.stdout, by_file.stdout);
}

/// A pitch angle that the flag gives is that of a profile which fixes it, and the folder holds it.
#[test]
fn contract_best_with_a_given_pitch_is_that_of_a_profile_that_fixes_it() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", small_profile());
    let run = |profile: &Path, name: &str, options: &[&str]| {
        let mut command = best(profile, &folder.path().join(name));
        Answer::of(command.arg("--quiet").args(options))
    };
    let by_flag = run(&profile, "flag", &["--pitch", "50 deg", "--json"]).exits(0);
    for kind in ["direct", "bank"] {
        let pitch_deg = by_flag.json()[kind]["pitch_deg"].as_f64().unwrap();
        assert!((pitch_deg - 50.0).abs() < 1e-9, "{pitch_deg}");
    }
    let own = folder.path().join("flag/profile.toml");
    let again = run(&own, "again", &["--json"]).exits(0);
    assert_eq!(again.stdout, by_flag.stdout);
    run(&own, "words", &[])
        .exits(0)
        .prints("Fixed by the profile or a flag: the angle.");
    run(&profile, "refused", &["--pitch", "95 deg"])
        .exits(2)
        .says("--pitch: must be from 1 to 89 deg");
}

#[test]
fn contract_best_says_why_a_location_has_no_shot_and_writes_nothing() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", too_slow_profile());
    let out = folder.path().join("out");
    for options in [&["--json"][..], &[]] {
        Answer::of(best(&profile, &out).args(options))
            .exits(2)
            .says("no release within the limits reaches the hoop");
        assert!(!out.exists());
    }
}

#[test]
fn contract_a_shooter_without_spin_or_error_of_spin_gets_an_answer() {
    let folder = TempDir::new().unwrap();
    let text = small_profile()
        .replace("\"3 rev/s\"", "\"0 rev/s\"")
        .replace("\"0.3 rev/s\"", "\"0 rev/s\"");
    let profile = write_file(&folder, "p.toml", text);
    let answer = Answer::of(best(&profile, folder.path()).args(["--json", "--quiet"])).json();
    assert!(answer["direct"]["probability"].as_f64().unwrap() > 0.5);
    assert_eq!(answer["direct"]["backspin_rev_s"], 0.0);
}

#[test]
fn contract_names_of_shooters_never_become_paths() {
    let folder = TempDir::new().unwrap();
    let text = small_profile().replace("college guard", "../../<script> é");
    let profile = write_file(&folder, "p.toml", &text);
    let run = || {
        let mut command = bankshot();
        command.current_dir(folder.path()).arg("best").arg(&profile);
        Answer::of(command.arg("--quiet")).exits(0)
    };
    run();
    let of_name = folder.path().join("results/script");
    assert_eq!(file_names(&folder.path().join("results")), ["script"]);
    // The same configuration finds its folder again; another one of the name gets the next number.
    run();
    assert_eq!(file_names(&of_name), ["1", "latest"]);
    write_file(&folder, "p.toml", text.replace("1.22 deg", "1.3 deg"));
    run();
    assert_eq!(file_names(&of_name), ["1", "2", "latest"]);
    assert_eq!(
        fs::read_link(of_name.join("latest")).unwrap(),
        Path::new("2")
    );
}

#[test]
fn contract_two_runs_of_one_name_at_once_take_two_folders() {
    let folder = TempDir::new().unwrap();
    let profiles = [
        write_file(&folder, "a.toml", small_profile()),
        write_file(
            &folder,
            "b.toml",
            small_profile().replace("1.22 deg", "1.3 deg"),
        ),
    ];
    let runs = profiles.map(|profile| {
        let mut command = bankshot();
        command.current_dir(folder.path()).arg("best").arg(profile);
        command
            .arg("--quiet")
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    });
    for mut run in runs {
        assert!(run.wait().unwrap().success());
    }
    let of_name = folder.path().join("results/college-guard");
    let texts = ["1", "2"].map(|number| {
        let run = of_name.join(number);
        assert!(run.join("best_shots.json").exists(), "{number}");
        fs::read_to_string(run.join("profile.toml")).unwrap()
    });
    assert_ne!(texts[0], texts[1]);
}

/// A shooter near the ring whose best direct shot is nearly a bank shot.
const LOW_RELEASE: &str = r#"
[shooter]
release_height = "3 ft"
max_backspin = "2 rev/s"
[shooter.errors]
c10 = "0.3 ft/s"
c20 = "0.5 deg"
c30 = "0.7 deg"
c40 = "0 rev/s"
[nominal]
pitch = "55 deg"
backspin = "2 rev/s"
[search]
choose = ["speed"]
[location]
distance = "12 ft"
angle = "0 deg"
[physics]
preset = "paper"
"#;

#[test]
fn contract_the_sensitivity_of_a_shot_keeps_its_kind() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", LOW_RELEASE);
    let text = Answer::of(best(&profile, folder.path()).args(["--details", "--quiet"])).exits(0);
    assert!(
        text.stdout()
            .contains("of the shots that go in are bank shots"),
        "{text:?}"
    );
    let answer = Answer::of(best(&profile, folder.path()).args(["--json", "--quiet"])).json();
    let direct = &answer["direct"];
    // The bank shot is better by 7 per 100: a direct shot that turned into one would gain them.
    let gain =
        answer["bank"]["probability"].as_f64().unwrap() - direct["probability"].as_f64().unwrap();
    assert!(gain > 0.05, "{gain}");
    let variations = |name: &str| direct["sensitivity"][name].as_array().unwrap().clone();
    let own = variations("backspins").into_iter().next_back().unwrap();
    assert!(own["gain"].as_f64().unwrap().abs() < 0.02, "{own}");
    let heights = variations("heights");
    assert!(
        heights
            .iter()
            .any(|height| height["gain"].as_f64().unwrap() < 0.01),
        "{heights:?}"
    );
}

#[test]
fn contract_a_fixed_backspin_above_the_greatest_is_refused_at_both_places() {
    let folder = TempDir::new().unwrap();
    let text = LOW_RELEASE.replace(
        "backspin = \"2 rev/s\"\n[search]",
        "backspin = \"5 rev/s\"\n[search]",
    );
    let profile = write_file(&folder, "p.toml", text);
    let answer = Answer::of(best(&profile, folder.path()).arg("--quiet")).exits(2);
    for words in [
        "nominal.backspin: is 5.000 rev/s, more than shooter.max_backspin",
        "shooter.max_backspin: is 2.000 rev/s, less than nominal.backspin",
        "p.toml:4:16",
        "p.toml:12:12",
    ] {
        assert!(
            answer.stderr.contains(words),
            "{words} in {}",
            answer.stderr
        );
    }
}

#[test]
fn contract_a_sweep_is_no_profile() {
    let folder = TempDir::new().unwrap();
    Answer::of(&mut best(
        Path::new("configs/quick_sweep.toml"),
        folder.path(),
    ))
    .exits(2)
    .says("this is a sweep, not a profile: use `bankshot sweep`");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn contract_a_shot_that_misses_without_errors_is_no_best_shot() {
    let folder = TempDir::new().unwrap();
    let text = small_profile().replace("\"13.75 ft\"", "\"NEAR ft\"");
    assert!(text.contains("NEAR"));
    // From under the ring, made shots are accidents.
    let profile = write_file(&folder, "p.toml", text.replace("NEAR", "1.3"));
    let answer = Answer::of(best(&profile, folder.path()).arg("--quiet"));
    assert!(
        answer
            .stdout()
            .contains("No exact direct shot goes in from this place"),
        "{answer:?}"
    );
}

/// An accurate launcher near the hoop, whose best shot lies between the shots of the coarse table.
/// The search found a bank shot of 70 deg and P 0.984; that of 62 deg has 0.992 (`probability`).
#[test]
fn regress_an_accurate_launcher_gets_the_higher_of_two_optima() {
    let folder = TempDir::new().unwrap();
    let launcher = r#"
[shooter]
name = "launcher"
release_height = "1.35 m"
max_backspin = "1.5 rev/s"
[shooter.errors]
speed = "1.2 %"
pitch = "0.4 deg"
polar = "0.5 deg"
backspin = "10 %"
[location]
distance = "2 m"
angle = "0 deg"
[nominal]
backspin = "1.5 rev/s"
[search]
choose = ["speed", "pitch", "polar"]
[physics]
preset = "ncaa"
"#;
    let profile = write_file(&folder, "launcher.toml", launcher);
    let runs = folder.path().join("runs");
    let json = Answer::of(best(&profile, &runs).args(["--json", "--quiet"]))
        .exits(0)
        .json();
    let p = json["bank"]["probability"].as_f64().unwrap();
    assert!(p > 0.99, "{p}");
}
