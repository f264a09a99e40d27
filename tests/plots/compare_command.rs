//! `compare`: maps of a sweep, and of two sweeps.

use super::support::{SMALL_SWEEP, SweepRun, bankshot, be_refused, printed, succeed, write_report};
use std::fs;
use std::path::Path;
use std::process::Command;

/// `bankshot compare` of a sweep, perhaps with another, into a folder.
fn compare(sweep: &SweepRun, other: Option<&Path>, plots: &Path) -> Command {
    let mut command = bankshot();
    command.arg("map").arg(sweep.results());
    command.arg("--out").arg(plots);
    if let Some(other) = other {
        command.arg("--against").arg(other);
    }
    command
}

#[test]
fn contract_compare_draws_the_maps_of_a_sweep_with_the_same_bytes_every_time() {
    let sweep = SweepRun::new(SMALL_SWEEP);
    let plots = sweep.path("plots");
    succeed(&mut compare(&sweep, None, &plots));
    for name in [
        "bank_and_direct",
        "best_p",
        "best_kind",
        "best_pitch",
        "best_spin",
    ] {
        for extension in ["svg", "png"] {
            let file = plots.join(format!("{name}.{extension}"));
            assert!(file.exists(), "{}", file.display());
        }
    }
    let png = || fs::read(plots.join("bank_and_direct.png")).unwrap();
    let first = png();
    succeed(&mut compare(&sweep, None, &plots));
    assert_eq!(png(), first);
    assert!(write_report(&plots).exists());
}

#[test]
fn contract_compare_writes_to_the_folder_of_the_sweep_by_default() {
    let sweep = SweepRun::new(SMALL_SWEEP);
    succeed(bankshot().arg("map").arg(sweep.results()));
    assert!(sweep.results().join("plots/bank_and_direct.svg").exists());
}

#[test]
fn contract_compare_draws_the_difference_of_two_sweeps() {
    let sweep = SweepRun::new(SMALL_SWEEP);
    let plots = sweep.path("plots");
    // A steadier shooter from the same places.
    let steadier = SweepRun::new(&SMALL_SWEEP.replace("0.25 ft/s", "0.15 ft/s"));
    let output = succeed(&mut compare(&sweep, Some(&steadier.results()), &plots));
    let text = printed(&output);
    let words: Vec<&str> = text.split_whitespace().collect();
    assert!(
        words.join(" ").contains("than for shooter (small)"),
        "{text}"
    );
    assert!(plots.join("against.png").exists());
    assert!(write_report(&plots).exists());
}

#[test]
fn contract_a_sweep_is_not_compared_with_a_profile_and_other_folders_have_no_report() {
    let sweep = SweepRun::new(SMALL_SWEEP);
    let profile = Path::new("configs/elite.toml");
    be_refused(&mut compare(&sweep, Some(profile), &sweep.path("plots")));
    be_refused(bankshot().arg("report").arg(sweep.folder()));
    be_refused(
        bankshot()
            .args(["report", "--with-physics"])
            .arg(sweep.results()),
    );
}

#[test]
fn contract_the_report_of_a_comparison_has_both() {
    let sweep = SweepRun::new(SMALL_SWEEP);
    let plots = sweep.path("plots");
    let steadier = SMALL_SWEEP.replace("0.25 ft/s", "0.15 ft/s");
    let steadier = SweepRun::new(&steadier.replace("[shooter]", "[shooter]\nname = \"steadier\""));
    succeed(&mut compare(&sweep, Some(&steadier.results()), &plots));
    let page = fs::read_to_string(write_report(&plots)).unwrap();
    for words in [
        "small: shooter against small: steadier",
        "than for shooter (small)",
    ] {
        assert!(page.contains(words), "{words}");
    }
    // Two shooters at one location.
    let (_, shooter) = SMALL_SWEEP.split_once("[shooter]").unwrap();
    let location = "[location]\ndistance = \"12 ft\"\nangle = \"50 deg\"\n";
    let profile = |name: &str| {
        let path = sweep.path(&format!("{name}.toml"));
        let text = format!("{location}[shooter]\nname = \"{name}\"{shooter}");
        fs::write(&path, text).unwrap();
        path
    };
    let (first, second) = (profile("Ann"), profile("Bartholomew"));
    let out = sweep.path("pair");
    let mut command = bankshot();
    command.arg("map").arg(&first).arg("--against").arg(&second);
    succeed(command.arg("--out").arg(&out));
    let page = fs::read_to_string(write_report(&out)).unwrap();
    for words in [
        "Ann against Bartholomew",
        "Ann: From 12 ft",
        "Bartholomew: From 12 ft",
        "Bartholomew: Best shots",
    ] {
        assert!(page.contains(words), "{words}");
    }
    // A comparison without another shooter forgets the one before.
    let mut command = bankshot();
    succeed(command.arg("map").arg(&first).arg("--out").arg(&out));
    let page = fs::read_to_string(write_report(&out)).unwrap();
    // (A short name could be in the encoded pictures by chance.)
    assert!(!page.contains("Bartholomew"));
    // An edited file is refused.
    let file = out.join("answer.json");
    let text = fs::read_to_string(&file).unwrap();
    fs::write(
        &file,
        text.replace("\"probability\": 0.", "\"probability\": 0.1"),
    )
    .unwrap();
    let output = bankshot().arg("report").arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(4), "{output:?}");
    assert!(
        printed(&output).contains("was changed after it was written"),
        "{output:?}"
    );
}
