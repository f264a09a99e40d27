//! Stored fits and runs: what is read is what was written, or the command refuses it with exit
//! code 4.

use crate::support::{Answer, bankshot, best, file_names, fit, small_profile, write_file};
use bankshot::store::StoreError;
use bankshot::store::best_run::BestRun;
use bankshot::store::fit::Fit;
use bankshot::store::shooters::Shooters;
use rand::rngs::ChaCha12Rng;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The places of all values of a JSON value, as pointers.
fn pointers(value: &Value, at: &str, found: &mut Vec<String>) {
    found.push(at.to_owned());
    match value {
        Value::Object(object) => {
            for (key, inner) in object {
                let key = key.replace('~', "~0").replace('/', "~1");
                pointers(inner, &format!("{at}/{key}"), found);
            }
        }
        Value::Array(list) => {
            for (number, inner) in list.iter().enumerate() {
                pointers(inner, &format!("{at}/{number}"), found);
            }
        }
        _ => {}
    }
}

/// A JSON text with one value of another type or size, one key less, or not a number.
fn mutated_json(text: &str, random: &mut ChaCha12Rng) -> String {
    let mut json: Value = serde_json::from_str(text).unwrap();
    let mut all = Vec::new();
    pointers(&json, "", &mut all);
    let at = all[1..].choose(random).unwrap();
    let (above, key) = at.rsplit_once('/').unwrap();
    let kind = random.random_range(0..6);
    match (kind, json.pointer_mut(above).unwrap()) {
        (0, Value::Object(object)) => {
            object.shift_remove(key);
        }
        (0, Value::Array(list)) => {
            list.remove(key.parse().unwrap());
        }
        _ => {
            let value = json.pointer_mut(at).unwrap();
            *value = match (kind, &*value) {
                (1, Value::String(_)) => 50.into(),
                (1, other) => other.to_string().into(),
                (2, _) => Value::Null,
                (3, Value::Number(number)) => (number.as_f64().unwrap() + 1e-9).into(),
                (3, Value::String(text)) => format!("{text} ").into(),
                (4, _) => Value::Bool(true),
                _ => Value::Array(Vec::new()),
            };
        }
    }
    let mutated = format!("{json:#}\n");
    match kind {
        5 => mutated.replacen(": 0.", ": NaN0.", 1),
        _ => mutated,
    }
}

/// A file that is cut, or has another byte.
fn mutated_bytes(bytes: &[u8], random: &mut ChaCha12Rng) -> Vec<u8> {
    let mut mutated = bytes.to_vec();
    let at = random.random_range(0..bytes.len());
    match random.random_range(0..3) {
        0 => mutated.truncate(at),
        1 => mutated[at] ^= 1 << random.random_range(0..8),
        _ => mutated.insert(at, b'7'),
    }
    mutated
}

/// Every mutation of the files is refused as damage, or changes nothing that is read.
fn check(
    folder: &Path,
    files: &[&str],
    tries: usize,
    read: impl Fn() -> Result<String, StoreError>,
) {
    let mut random = ChaCha12Rng::seed_from_u64(11);
    let right = read().unwrap();
    let mut refused = 0;
    for number in 0..tries {
        let name = files[number % files.len()];
        let path = folder.join(name);
        let bytes = fs::read(&path).unwrap();
        let mutated = match (name.ends_with(".json"), number % 4) {
            (true, 0..3) => {
                mutated_json(std::str::from_utf8(&bytes).unwrap(), &mut random).into_bytes()
            }
            _ => mutated_bytes(&bytes, &mut random),
        };
        fs::write(&path, &mutated).unwrap();
        match read() {
            Err(StoreError::Damaged { file, message }) => {
                assert_eq!(file.file_name().unwrap(), name, "{message}");
                refused += 1;
            }
            Err(other) => panic!("{name}: {other}"),
            Ok(answer) => assert!(answer == right, "mutation {number} of {name} was read"),
        }
        fs::write(&path, &bytes).unwrap();
    }
    assert!(refused > tries * 9 / 10, "{refused} of {tries}");
    assert_eq!(read().unwrap(), right);
}

#[test]
fn contract_a_changed_fit_is_refused_or_read_as_it_was() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("fit");
    fit("docs/data/lab.csv", &out, &["--free", "hoop_restitution"]).exits(0);
    let read = || {
        let fit = Fit::read(&out)?;
        let releases = fit.known_releases(&out)?;
        Ok(format!("{fit:?} {releases:?}"))
    };
    check(
        &out,
        &["fit.json", "draws.parquet", "fit.json", "shots.csv"],
        120,
        read,
    );
    // The fit of the review: a number as a text, and no parameter of the backspin.
    let path = out.join("fit.json");
    let right = fs::read_to_string(&path).unwrap();
    let mut json: Value = serde_json::from_str(&right).unwrap();
    json["places"][0]["made"] = json["places"][0]["made"].to_string().into();
    fs::write(&path, json.to_string()).unwrap();
    let advise = |folder: &Path| Answer::of(bankshot().arg("advise").arg(folder));
    advise(&out)
        .exits(4)
        .says("fit.json: places[0].made: invalid type: string")
        .says("fit the shots again");
    // Also where the profile is named, which the warnings of its fit belong to.
    let profile = out.join("profile.toml");
    Answer::of(bankshot().arg("best").arg(&profile)).exits(4);
    let mut json: Value = serde_json::from_str(&right).unwrap();
    let parameters = json["parameters"].as_array_mut().unwrap();
    parameters.retain(|parameter| parameter["name"] != "backspin_mean");
    fs::write(&path, json.to_string()).unwrap();
    advise(&out)
        .exits(4)
        .says("was changed after it was written");
    // A fit of version 0.1.0 of 2026 had no version of its format.
    let mut json: Value = serde_json::from_str(&right).unwrap();
    json.as_object_mut().unwrap().shift_remove("format_version");
    fs::write(&path, json.to_string()).unwrap();
    advise(&out)
        .exits(4)
        .says("another version; fit the shots again");
}

#[test]
fn contract_a_changed_list_of_shooters_is_refused() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("fit");
    let lab = fs::read_to_string("docs/data/lab.csv").unwrap();
    let mut lines = lab.lines();
    let mut table = format!("{},shooter\n", lines.next().unwrap());
    for (number, line) in lines.enumerate() {
        table += &format!("{line},{}\n", ["ann", "bo"][number % 2]);
    }
    let file = write_file(&folder, "team.csv", table);
    fit(file.to_str().unwrap(), &out, &[]).exits(0);
    let read = || Ok(format!("{:?}", Shooters::read(&out)?));
    check(&out, &["shooters.json"], 20, read);
    // The folder of a version that listed its fits in the table alone.
    fs::remove_file(out.join("shooters.json")).unwrap();
    let advise = Answer::of(bankshot().arg("advise").arg(&out));
    advise.exits(4).says("shooters.json is missing");
    fit(file.to_str().unwrap(), &out, &[]).exits(0);
    read().unwrap();
}

#[test]
fn contract_a_changed_run_is_refused_or_read_as_it_was() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "profile.toml", small_profile());
    let out = folder.path().join("run");
    Answer::of(&mut best(&profile, &out));
    assert!(file_names(&out).contains(&"answer.json".to_owned()));
    let read = || {
        let (profile, run) = BestRun::read(&out)?;
        Ok(format!("{profile:?} {run:?}"))
    };
    check(&out, &["answer.json", "profile.toml"], 80, read);
    let mut text = fs::read_to_string(out.join("profile.toml")).unwrap();
    text += "# mine\n";
    fs::write(out.join("profile.toml"), text).unwrap();
    let report = Answer::of(bankshot().arg("report").arg(&out));
    report.exits(4).says("run `bankshot best` again");
}
