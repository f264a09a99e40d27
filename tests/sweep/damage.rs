//! Damaged and contradictory files: they are found, set aside or refused, and never used.

use crate::support::{
    JOBS, TestFolder, assert_code, assert_printed, bankshot, copy_unfinished, printed, store,
    tables,
};
use bankshot::sweep::columns;
use bankshot::sweep::result_row::ResultRow;
use bankshot::sweep::sqlite_results::{ResultStore, read_rows};
use bankshot::sweep::sweep_folder::SweepFolder;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use std::fs;
use std::path::Path;

/// Damaged versions of a valid store, each with what is wrong with it.
fn damaged_versions(valid: &[u8]) -> Vec<(String, Vec<u8>)> {
    let mut random = ChaCha12Rng::seed_from_u64(9);
    let mut cases: Vec<(String, Vec<u8>)> = Vec::new();
    for part in 0..8 {
        let length = valid.len() * part / 8 + random.random_range(0..valid.len() / 8);
        cases.push((format!("cut at {length}"), valid[..length].to_vec()));
    }
    for _ in 0..24 {
        let at = random.random_range(0..valid.len());
        let bit = random.random_range(0..8);
        let mut bytes = valid.to_vec();
        bytes[at] ^= 1 << bit;
        cases.push((format!("byte {at} bit {bit}"), bytes));
    }
    // Damage that reading the rows does not show: the header's versions, and the schema of the
    // small tables.
    for at in [18, 19] {
        let mut bytes = valid.to_vec();
        bytes[at] ^= 2;
        cases.push((format!("byte {at} of the header"), bytes));
    }
    for (from, to) in [("aborts", "abosts"), ("started (spot", "started (spit")] {
        let at = valid
            .windows(from.len())
            .position(|window| window == from.as_bytes())
            .unwrap();
        let mut bytes = valid.to_vec();
        bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
        cases.push((format!("{to} in the schema"), bytes));
    }
    let mut longer = valid.to_vec();
    longer.extend([0; 5000]);
    cases.push(("zeros appended".to_owned(), longer));
    cases.push(("all zero".to_owned(), vec![0; valid.len()]));
    cases.push(("not a database".to_owned(), b"hello".repeat(1000)));
    cases
}

#[test]
fn contract_a_damaged_store_is_set_aside_and_its_damage_never_used() {
    let test = TestFolder::new();
    let (complete, bytes) = test.undisturbed();
    let name = store(&complete).file_name().unwrap().to_owned();
    let valid = fs::read(store(&complete)).unwrap();
    let mut set_aside = 0;
    for (number, (what, damaged)) in damaged_versions(&valid).iter().enumerate() {
        let out = test.out(&format!("damaged-{number}"));
        copy_unfinished(&complete, &out);
        fs::write(out.join("store").join(&name), damaged).unwrap();
        let output = test.run(&out, &["--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{what}: {output:?}");
        assert_eq!(tables(&out), bytes, "{what}");
        set_aside += usize::from(printed(&output).contains("is set aside as"));
        fs::remove_dir_all(&out).unwrap();
    }
    assert!(set_aside > 10, "{set_aside}");
}

#[test]
fn contract_salvaged_failures_never_replace_a_better_result() {
    let test = TestFolder::new();
    let (_, bytes) = test.undisturbed();
    let out = test.out("salvage");
    let output = test.run(&out, &["--quiet", "--fault", "panic:2"]);
    assert_code(&output, 3);
    // The store of a machine has the failures, and is damaged later. Another machine has computed
    // them again.
    let old = out.join("store/1-of-9.elsewhere.sqlite");
    fs::copy(store(&out), &old).unwrap();
    let output = test.run(&out, &["--quiet", "--retry-failed"]);
    assert_code(&output, 0);
    let mut damaged = fs::read(&old).unwrap();
    damaged[18] ^= 2;
    fs::write(&old, damaged).unwrap();
    let output = test.run(&out, &["--quiet"]);
    assert_code(&output, 0);
    assert_printed(&output, "12 valid results of it are kept");
    assert_eq!(tables(&out), bytes);
    for name in [
        "1-of-9.elsewhere.sqlite.damaged-1",
        "1-of-9.elsewhere.salvaged-1.sqlite",
    ] {
        assert!(out.join("store").join(name).exists(), "{name}");
    }
}

#[test]
fn contract_a_damaged_manifest_is_written_again() {
    let test = TestFolder::new();
    let (out, bytes) = test.undisturbed();
    let file = out.join("configuration.json");
    let text = fs::read_to_string(&file).unwrap();
    for damaged in [&text[..text.len() / 2], "", &text.replace("16 ft", "17 ft")] {
        fs::write(&file, damaged).unwrap();
        let output = bankshot().arg("merge").arg(&out).output().unwrap();
        assert_code(&output, 2);
        let output = test.run(&out, &["--quiet"]);
        assert_code(&output, 0);
        assert_eq!(fs::read_to_string(&file).unwrap(), text);
        assert_eq!(tables(&out), bytes);
    }
}

/// Writes a row with another P, and a checksum that matches it, into a store of its own. Returns
/// its job.
fn add_contradiction(out: &Path) -> u64 {
    let (folder, _) = SweepFolder::existing(out).unwrap();
    let mut rows: Vec<ResultRow> = Vec::new();
    read_rows(&store(out), folder.hash(), JOBS as u64, |row| {
        rows.push(row)
    })
    .unwrap();
    let mut row = rows[3].clone();
    row.set_real(columns::PROBABILITY, 0.123);
    let path = out.join("store/0-other.sqlite");
    let mut other = ResultStore::open(&path, folder.hash()).unwrap();
    other
        .finish_spot(0, std::slice::from_ref(&row), 1.0)
        .unwrap();
    row.job
}

#[test]
fn contract_contradictory_stores_are_refused_and_the_job_is_named() {
    let test = TestFolder::new();
    let (out, bytes) = test.undisturbed();
    let job = add_contradiction(&out);
    let output = bankshot().arg("merge").arg(&out).output().unwrap();
    assert_code(&output, 4);
    assert_printed(&output, &format!("job {job} has two different results"));
    assert_eq!(tables(&out), bytes);
}

#[test]
fn contract_verify_finds_a_result_that_was_never_computed() {
    let test = TestFolder::new();
    let (out, _) = test.undisturbed();
    let verify = |fraction: &str| {
        bankshot()
            .args(["verify", "--quiet", "--recompute", fraction])
            .arg(&out)
            .output()
            .unwrap()
    };
    let output = verify("50%");
    assert_code(&output, 0);
    assert_printed(&output, "recomputed 6 jobs: 0 differ");
    let computed = store(&out);
    let job = add_contradiction(&out);
    fs::remove_file(computed).unwrap();
    let output = verify("1");
    assert_code(&output, 4);
    assert_printed(&output, &format!("differs: job {job}"));
}

/// Everything in a folder that must stay as it is.
#[cfg(unix)]
fn precious(folder: &Path) -> std::path::PathBuf {
    let file = folder.join("precious.txt");
    fs::write(&file, "precious").unwrap();
    file
}

#[cfg(unix)]
#[test]
fn contract_the_folder_of_a_sweep_is_never_written_through_a_link() {
    use std::os::unix::fs::symlink;
    let test = TestFolder::new();
    let (complete, _) = test.undisturbed();
    let lock_name = fs::read_dir(complete.join("store"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .find(|name| name.ends_with(".lock"))
        .unwrap();
    let aborted = lock_name.replace(".lock", ".aborted");
    let store = lock_name.replace(".lock", ".sqlite");
    for (i, name) in [
        format!("store/{lock_name}"),
        format!("store/{aborted}"),
        format!("store/{store}"),
        "store".to_owned(),
        "best_shots.csv".to_owned(),
        "best_shots.parquet".to_owned(),
        "provenance.json".to_owned(),
    ]
    .into_iter()
    .enumerate()
    {
        let target = precious(test.folder.path());
        let out = test.out(&format!("linked-{i}"));
        fs::create_dir_all(out.join("store")).unwrap();
        let link = out.join(&name);
        if name == "store" {
            fs::remove_dir(&link).unwrap();
            symlink(test.folder.path(), &link).unwrap();
        } else {
            symlink(&target, &link).unwrap();
        }
        let output = test.run(&out, &["--quiet"]);
        assert!(
            matches!(output.status.code(), Some(4 | 74)),
            "{name}: {output:?}"
        );
        assert_printed(&output, "it is a link");
        assert_printed(&output, &link.display().to_string());
        assert_eq!(fs::read_to_string(&target).unwrap(), "precious", "{name}");
    }
}

#[cfg(unix)]
#[test]
fn contract_a_manifest_that_is_no_file_is_refused_at_once() {
    let test = TestFolder::new();
    for (kind, words) in [
        ("link", "leads nowhere"),
        ("pipe", "is not a file"),
        ("folder", "is not a file"),
    ] {
        let out = test.out(kind);
        fs::create_dir_all(&out).unwrap();
        let manifest = out.join("configuration.json");
        match kind {
            "link" => std::os::unix::fs::symlink("nowhere", &manifest).unwrap(),
            "pipe" => {
                let made = std::process::Command::new("mkfifo").arg(&manifest).status();
                assert!(made.unwrap().success());
            }
            _ => fs::create_dir(&manifest).unwrap(),
        }
        let sweep = test.run(&out, &["--quiet"]);
        let mut others = vec![sweep];
        for command in ["status", "report"] {
            others.push(bankshot().arg(command).arg(&out).output().unwrap());
        }
        for output in others {
            assert!(
                matches!(output.status.code(), Some(2 | 4)),
                "{kind}: {output:?}"
            );
            assert_printed(&output, words);
            assert_printed(&output, &manifest.display().to_string());
        }
    }
}

#[cfg(unix)]
#[test]
fn contract_pipes_and_linked_plots_are_refused_at_once() {
    let test = TestFolder::new();
    let (out, _) = test.undisturbed();
    let store_name = store(&out)
        .file_name()
        .unwrap()
        .to_str()
        .unwrap()
        .to_owned();
    let pipe = |name: &str| {
        let path = out.join(name);
        let _ = fs::remove_file(&path);
        let made = std::process::Command::new("mkfifo").arg(&path).status();
        assert!(made.unwrap().success());
        path
    };
    let journal = format!("store/{store_name}-journal");
    let aborted = format!("store/{}", store_name.replace(".sqlite", ".aborted"));
    for (name, commands) in [
        ("best_shots.csv", &["sweep"][..]),
        ("report.html", &["report"]),
        (journal.as_str(), &["sweep", "status", "report"]),
        (aborted.as_str(), &["sweep"]),
    ] {
        let path = pipe(name);
        for command in commands {
            let output = match *command {
                "sweep" => test.run(&out, &["--quiet"]),
                command => bankshot().arg(command).arg(&out).output().unwrap(),
            };
            assert!(
                matches!(output.status.code(), Some(4 | 74)),
                "{name}: {output:?}"
            );
            assert_printed(&output, "not a regular file");
        }
        fs::remove_file(path).unwrap();
    }
    let target = precious(test.folder.path());
    fs::create_dir_all(out.join("plots")).unwrap();
    std::os::unix::fs::symlink(&target, out.join("plots/bank_and_direct.svg")).unwrap();
    let output = bankshot().arg("map").arg(&out).output().unwrap();
    assert_code(&output, 74);
    assert_eq!(fs::read_to_string(&target).unwrap(), "precious");
}

/// The final tables are looked at too.
#[test]
fn contract_verify_finds_a_damaged_table() {
    let test = TestFolder::new();
    let (complete, _) = test.undisturbed();
    let verify = || bankshot().arg("verify").arg(&complete).output().unwrap();
    assert_code(&verify(), 0);
    for name in ["best_shots.csv", "best_shots.parquet", "provenance.json"] {
        let path = complete.join(name);
        let valid = fs::read(&path).unwrap();
        fs::write(&path, &valid[..valid.len() / 2]).unwrap();
        let answer = verify();
        assert_code(&answer, 4);
        assert_printed(&answer, name);
        fs::remove_file(&path).unwrap();
        assert_code(&verify(), 4);
        fs::write(&path, &valid).unwrap();
    }
    assert_code(&verify(), 0);
}
