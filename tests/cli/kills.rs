//! `kill -9` at random moments: what is there is whole, and the same command ends with the same
//! bytes. Sweeps are killed in `tests/sweep/interruptions.rs`, the studio in
//! `studio/campaigns/kills.mjs`.

use crate::support::*;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The number of kills: a few, or `BANKSHOT_KILLS` of the campaign.
fn kills(usual: usize) -> usize {
    std::env::var("BANKSHOT_KILLS").map_or(usual, |count| count.parse().unwrap())
}

/// Starts a command again and again, and kills it after a random time; how often it was killed and
/// how often it came to its end.
fn kill_often(
    arguments: &[&str],
    (kills, longest): (usize, Duration),
    after_each: &mut dyn FnMut(bool),
) -> (usize, usize) {
    let mut rng = ChaCha12Rng::seed_from_u64(kills as u64);
    let (mut killed, mut ended) = (0, 0);
    while killed < kills {
        let mut command = bankshot();
        let command = command.args(arguments).stdout(Stdio::null());
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        std::thread::sleep(longest.mul_f64(rng.random()));
        let _ = child.kill();
        let output = child.wait_with_output().unwrap();
        match output.status.code() {
            None => killed += 1,
            Some(0) => ended += 1,
            Some(_) => panic!("{output:?}"),
        }
        after_each(output.status.code().is_some());
    }
    (killed, ended)
}

/// The time of an undisturbed run.
fn time_of(arguments: &[&str]) -> Duration {
    let start = Instant::now();
    Answer::of(bankshot().args(arguments)).exits(0);
    start.elapsed()
}

#[test]
fn contract_a_killed_table_goes_on_to_the_same_bytes() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", small_profile());
    let profile = profile.to_str().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (whole, killed) = (path("whole.csv"), path("killed.csv"));
    let table = |out: &str| -> Vec<String> {
        let words = [
            "table",
            profile,
            "--distances",
            "8 ft to 12 ft by 1 ft",
            "--quiet",
            "-o",
            out,
        ];
        words.map(str::to_owned).to_vec()
    };
    let whole_words = table(&whole);
    let longest = time_of(&whole_words.iter().map(String::as_str).collect::<Vec<_>>());
    let bytes = fs::read(&whole).unwrap();
    let killed_words = table(&killed);
    let arguments: Vec<&str> = killed_words.iter().map(String::as_str).collect();
    let mut rounds = 0;
    let counts = kill_often(&arguments, (kills(5), longest), &mut |has_ended| {
        // The table is there whole, or not at all.
        if Path::new(&killed).exists() {
            assert_eq!(fs::read(&killed).unwrap(), bytes);
            fs::remove_file(&killed).unwrap();
            rounds += 1;
        }
        assert!(!has_ended || rounds > 0);
    });
    Answer::of(bankshot().args(&arguments)).exits(0);
    assert_eq!(fs::read(&killed).unwrap(), bytes);
    println!("table: {} kills, {rounds} tables", counts.0);
}

#[test]
fn contract_a_killed_fit_leaves_whole_files() {
    let folder = TempDir::new().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (whole, killed) = (path("whole"), path("killed"));
    let fit =
        |out: &str| ["fit", "docs/data/gym_sensor.csv", "--quiet", "-o", out].map(str::to_owned);
    let whole_words = fit(&whole);
    let longest = time_of(&whole_words.each_ref().map(String::as_str));
    let files = |folder: &str| -> BTreeMap<String, Vec<u8>> {
        let names = file_names(Path::new(folder)).into_iter();
        let files = names.filter(|name| name != "plots").map(|name| {
            let bytes = fs::read(Path::new(folder).join(&name)).unwrap();
            (name, bytes)
        });
        files.collect()
    };
    let wanted = files(&whole);
    let killed_words = fit(&killed);
    let arguments = killed_words.each_ref().map(String::as_str);
    let counts = kill_often(&arguments, (kills(5), longest), &mut |_| {
        if !Path::new(&killed).exists() {
            return;
        }
        // Whatever is there is as it should be, but for files that are not in their place yet.
        for (name, bytes) in files(&killed) {
            match wanted.get(&name) {
                Some(right) => assert!(*right == bytes, "{name}"),
                None => assert!(name.starts_with('.') || name.contains("tmp"), "{name}"),
            }
        }
    });
    Answer::of(bankshot().args(arguments)).exits(0);
    for (name, bytes) in &wanted {
        assert!(files(&killed)[name] == *bytes, "{name}");
    }
    println!("fit: {} kills, {} ends", counts.0, counts.1);
}
