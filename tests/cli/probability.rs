//! `probability`: P of one shot, and the replay of its samples.

use super::support::{Answer, bankshot};

/// `probability` of the nine errors with the given flags.
fn probability(flags: &[&str]) -> Answer {
    let arguments = ["probability", "configs/nine_errors.toml", "--quiet"];
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
    assert!(short.stdout().starts_with("P = 0.0000"));
}

#[test]
fn contract_probability_with_too_small_a_budget_prints_p_so_far() {
    for method in ["sobol", "monte-carlo"] {
        let flags = ["--method", method, "--budget", "2000", "--target", "0.0001"];
        let answer = probability(&flags).exits(1);
        assert!(answer.stdout().starts_with("P = 0.6"), "{answer:?}");
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
