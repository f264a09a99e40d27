//! `probability`: P of one shot, and the replay of its samples.

use super::support::{Answer, bankshot, write_file};
use bankshot::dynamics::InstructionSet;
use std::path::Path;
use tempfile::TempDir;

/// `probability` of the nine errors with the given flags.
fn probability(flags: &[&str]) -> Answer {
    let arguments = [
        "probability",
        "configs/errors_in_all_nine_variables.toml",
        "--quiet",
    ];
    Answer::of(bankshot().args(arguments).args(flags))
}

#[test]
fn contract_probability_prints_p_with_its_error_and_shares() {
    let answer = probability(&["--target", "0.004", "--json"])
        .exits(0)
        .json();
    let p = answer["probability"].as_f64().unwrap();
    assert!((0.6..0.66).contains(&p), "{p}");
    assert!(answer["standard_error"].as_f64().unwrap() <= 0.004);
    assert!(answer["shots"].as_u64().unwrap() >= 16384);
    let shares = answer["shares"].as_object().unwrap();
    let sum: f64 = shares.values().map(|share| share.as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-9, "{shares:?}");
    // A flag overrides the profile's [nominal].
    let short = probability(&["--speed", "20 ft/s", "--target", "0.01"]);
    assert!(
        short.stdout().starts_with("0 of 100 go in (0.0"),
        "{short:?}"
    );
}

/// The place of a flag is that of a profile which has it.
#[test]
fn contract_a_place_can_be_given_for_one_run() {
    let at = |profile: &str, flags: &[&str]| {
        let mut command = bankshot();
        command.args([
            "probability",
            profile,
            "--quiet",
            "--json",
            "--speed",
            "24 ft/s",
        ]);
        command.args([
            "--pitch",
            "53 deg",
            "--backspin",
            "2 rev/s",
            "--target",
            "0.01",
        ]);
        Answer::of(command.args(flags))
    };
    // bank_wing.toml is 12 ft away at 60 deg.
    let own = at("configs/bank_wing.toml", &[]).exits(0).json();
    let same = at(
        "configs/bank_wing.toml",
        &["--distance", "12 ft", "--angle", "60 deg"],
    );
    assert_eq!(same.exits(0).json()["probability"], own["probability"]);
    let nearer = at("configs/bank_wing.toml", &["--distance", "11 ft"])
        .exits(0)
        .json();
    assert!(nearer["probability"] != own["probability"]);
    at("configs/bank_wing.toml", &["--distance", "11 parsec"])
        .exits(2)
        .says("--distance: ");
    at("configs/bank_wing.toml", &["--angle", "178 deg"])
        .exits(2)
        .says("--angle: ");
}

#[test]
fn contract_probability_with_too_small_a_budget_prints_p_so_far() {
    for method in ["sobol", "monte-carlo"] {
        let flags = ["--method", method, "--budget", "2000", "--target", "0.0001"];
        let answer = probability(&flags).exits(1);
        assert!(answer.stdout().starts_with("62 of 100 go in"), "{answer:?}");
    }
}

#[test]
fn contract_probability_refuses_invalid_flags() {
    for (flags, reason) in [
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
        let answer = probability(flags).exits(2).says(reason);
        assert!(answer.stdout.is_empty(), "{flags:?} {answer:?}");
    }
}

#[test]
fn contract_replay_traces_the_sample() {
    let replay = |sample| probability(&["--replay", sample, "--json"]);
    let traced = replay("1:2049").exits(0);
    assert_eq!(traced.json()["events"][0]["event"], "release");
    assert_eq!(replay("1:2049").stdout, traced.stdout);
    assert_ne!(replay("1:2050").stdout, traced.stdout);
}

#[test]
fn contract_aim_is_measured_from_the_line_to_the_hoop() {
    let p = |flags: &[&str]| {
        let mut command = bankshot();
        command.args([
            "probability",
            "configs/bank_wing.toml",
            "--speed",
            "25 ft/s",
            "--pitch",
            "52 deg",
        ]);
        command.args(["--target", "0.004", "--json", "--quiet"]);
        Answer::of(command.args(flags)).exits(0).json()
    };
    let location = p(&[]);
    let towards = location["nominal"]["polar_deg"].as_f64().unwrap();
    assert!(
        towards.abs() > 10.0,
        "the wing is not straight on: {towards}"
    );
    assert_eq!(
        p(&["--aim", "0 deg"])["nominal"]["polar_deg"],
        location["nominal"]["polar_deg"]
    );
    let aside = p(&["--aim", "0.3 deg"]);
    assert!((aside["nominal"]["polar_deg"].as_f64().unwrap() - towards - 0.3).abs() < 1e-9);
    let polar = format!("{} deg", towards + 0.3);
    let same = p(&["--polar", &polar])["probability"].as_f64().unwrap();
    assert!((aside["probability"].as_f64().unwrap() - same).abs() < 1e-3);
    probability(&["--aim", "1 deg", "--polar", "1 deg"])
        .exits(2)
        .says("cannot be used with");
}

#[test]
fn contract_a_shot_that_touches_nothing_is_warned_about() {
    let flags = |polar| {
        [
            "--speed",
            "23.6 ft/s",
            "--pitch",
            "53.5 deg",
            "--polar",
            polar,
        ]
    };
    let probability = |flags: &[&str]| {
        let mut command = bankshot();
        Answer::of(
            command
                .args(["probability", "configs/free_throw.toml"])
                .args(flags),
        )
    };
    let aside = probability(&flags("20 deg"));
    assert!(
        aside.stderr.contains("touches nothing and misses"),
        "{aside:?}"
    );
    assert!(
        aside.stderr.contains("hoop's centre is 0.00 deg"),
        "{aside:?}"
    );
    // Aimed along the court's axis from the wing, the ball goes behind the board.
    let mut command = bankshot();
    command.args([
        "probability",
        "configs/bank_wing.toml",
        "--speed",
        "25 ft/s",
    ]);
    let behind = Answer::of(command.args(["--pitch", "55.1 deg", "--polar", "0 deg"]));
    assert!(
        behind.stderr.contains("touches nothing and misses"),
        "{behind:?}"
    );
    let straight = probability(&flags("0 deg"));
    assert!(!straight.stderr.contains("touches nothing"), "{straight:?}");
}

#[test]
fn contract_a_small_probability_is_printed_with_its_digits() {
    let flags = [
        "--speed",
        "22.32 ft/s",
        "--pitch",
        "53.5 deg",
        "--backspin",
        "3 rev/s",
    ];
    let mut flags = flags.to_vec();
    flags.extend(["--target", "1e-6", "--budget", "262144", "--seed", "2001"]);
    let mut command = bankshot();
    let answer = Answer::of(
        command
            .args(["probability", "configs/free_throw.toml"])
            .args(["--physics", "paper"])
            .args(&flags),
    );
    let answer = answer.exits(1);
    let line = answer.stdout().lines().next().unwrap();
    assert!(
        line.starts_with("Fewer than 1 of 100 go in (0.01"),
        "{line}"
    );
    assert!(
        line.contains("simulation error 0.001") || line.contains("simulation error 0.002"),
        "{line}"
    );
}

#[test]
fn contract_vector_instructions_and_threads_change_no_byte() {
    let answers: Vec<_> = [
        &["--simd", "scalar"][..],
        &["--simd", "baseline"],
        &["--threads", "1000"],
        &[],
    ]
    .into_iter()
    .chain(
        InstructionSet::available()
            .iter()
            .map(|(name, _)| match *name {
                "avx2" => &["--simd", "avx2"][..],
                "avx512" => &["--simd", "avx512"],
                _ => &["--simd", "scalar"],
            }),
    )
    .map(|options| {
        let mut command = bankshot();
        command.args([
            "probability",
            "configs/errors_in_all_nine_variables.toml",
            "--json",
            "--quiet",
        ]);
        let answer = Answer::of(command.args(options).args(["--target", "0.003"]));
        answer.exits(0).stdout
    })
    .collect();
    assert!(answers.windows(2).all(|pair| pair[0] == pair[1]));
    probability(&["--simd", "mmx"])
        .exits(2)
        .says("must be one of scalar, baseline");
}

#[test]
fn contract_physics_replaces_the_table_of_the_profile() {
    let p = |flags: &[&str]| {
        probability(&[&["--target", "0.003", "--json"], flags].concat())
            .exits(0)
            .json()["probability"]
            .as_f64()
            .unwrap()
    };
    let (own, paper) = (p(&[]), p(&["--physics", "paper"]));
    assert_eq!(own, paper);
    let ncaa = p(&["--physics", "ncaa", "--speed", "24.3 ft/s"]);
    assert!(
        (0.65..0.80).contains(&ncaa) && ncaa > own + 0.03,
        "{ncaa} {own}"
    );
    // In air the paper's best speed is too slow.
    assert!(p(&["--physics", "ncaa"]) < own - 0.1);
    let mut command = bankshot();
    command.args([
        "probability",
        "configs/free_throw.toml",
        "--speed",
        "24 ft/s",
    ]);
    command.args([
        "--pitch",
        "53 deg",
        "--physics",
        "paper",
        "--target",
        "0.01",
    ]);
    Answer::of(&mut command)
        .exits(0)
        .says("written for another physics")
        .says("1.1900 kg/m^3 -> 0.0000 kg/m^3");
    let answer = probability(&["--physics", "ncaaa"]).exits(2);
    answer.says("is neither a preset (paper, ncaa, ");
}

/// An error that a flag changes is that of a file with the changed error, also for an error in
/// percent, in an inline table and with correlations.
#[test]
fn contract_scatter_changes_an_error_as_an_edit_would() {
    let folder = TempDir::new().unwrap();
    let text = |errors: &str| {
        format!(
            "[shooter]\nname = \"S\"\nrelease_height = \"7 ft\"\nmax_backspin = \"3 rev/s\"\n{errors}\n[shooter.correlation]\nspeed_pitch = 0.3\n\n[location]\ndistance = \"13.75 ft\"\nangle = \"0 deg\"\n\n[physics]\npreset = \"ncaa\"\n"
        )
    };
    let inline = |speed: &str, pitch: &str| {
        text(&format!(
            "errors = {{ speed = \"{speed}\", pitch = \"{pitch}\", polar = \"0.8 deg\", backspin = \"0.3 rev/s\" }}\n"
        ))
    };
    let own = write_file(&folder, "own.toml", inline("1.5 %", "1 deg"));
    let edited = write_file(&folder, "edited.toml", inline("1.2 %", "1.1 deg"));
    let run = |profile: &Path, more: &[&str]| {
        let mut command = bankshot();
        command
            .arg("probability")
            .arg(profile)
            .args(["--speed", "24.3 ft/s", "--pitch", "52 deg", "--quiet"])
            .args(["--target", "0.005"])
            .args(more);
        Answer::of(&mut command)
    };
    let scatter = ["--scatter", "speed=-20%", "--scatter", "pitch=+10 %"];
    let p = |answer: Answer| answer.exits(0).json()["probability"].as_f64().unwrap();
    let changed = p(run(&own, &[&scatter[..], &["--json"]].concat()));
    let by_hand = p(run(&edited, &["--json"]));
    // The last digits of an error may differ, and with them a shot at the edge.
    assert!((changed - by_hand).abs() < 2e-4, "{changed} {by_hand}");
    assert!((changed - p(run(&own, &["--json"]))).abs() > 0.005);
    for (given, says) in [
        ("speed=20", "has no %"),
        ("speed=-101%", "is out of range"),
        ("side_spin=-20%", "is none of the four"),
        ("speed", "has no ="),
    ] {
        run(&own, &["--scatter", given]).exits(2).says(says);
    }
    let twice = ["--scatter", "speed=-20%", "--scatter", "speed=-10%"];
    run(&own, &twice).exits(2).says("speed is given twice");
}

/// P along a variable is that of the single shots, and the shot of a flag needs no value of it.
#[test]
fn contract_vary_gives_the_p_of_each_shot() {
    let folder = TempDir::new().unwrap();
    let csv = folder.path().join("p.csv");
    let plot = folder.path().join("p.svg");
    let vary = |flags: &[&str]| probability(&[&["--target", "0.004"], flags].concat());
    let answer = vary(&[
        "--vary",
        "aim=-1, 0, 1 deg",
        "--json",
        "-o",
        csv.to_str().unwrap(),
        "--plot",
        plot.to_str().unwrap(),
    ]);
    let json = answer.exits(0).json();
    let points = json["points"].as_array().unwrap().clone();
    assert_eq!(points.len(), 3);
    for (point, aim) in points.iter().zip(["-1 deg", "0 deg", "1 deg"]) {
        let alone = vary(&["--aim", aim, "--json"]).exits(0).json();
        for key in ["probability", "standard_error", "shots"] {
            assert_eq!(point[key], alone[key], "{aim} {key}");
        }
        assert_eq!(point["misses"]["left"], alone["shares"]["left"], "{aim}");
    }
    let text = std::fs::read_to_string(&csv).unwrap();
    assert_eq!(text.lines().count(), 4);
    assert!(text.starts_with("aim_deg,probability,standard_error,shots,misses_short,"));
    assert!(
        std::fs::read_to_string(&plot)
            .unwrap()
            .contains("aim (deg)")
    );
    // A list of spins or speeds may have its unit once.
    vary(&["--vary", "backspin=1, 2 rev/s"])
        .exits(0)
        .prints("Best backspin tried: 2 rev/s");
    vary(&["--vary", "pich=50 deg"])
        .exits(2)
        .says("--vary: \"pich\" is no variable of a shot; write one of speed, pitch, polar");
    vary(&["--vary", "pitch"]).exits(2).says("has no =");
    vary(&["--vary", "pitch=100 deg"])
        .exits(2)
        .says("--pitch: must be from -90 to 90 deg");
    vary(&["--vary", "pitch=50 deg", "-o", "p.java"])
        .exits(2)
        .says("the name must end in .csv, .json or .txt");
}
