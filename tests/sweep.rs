//! What a sweep promises: the same bytes whatever happens to it, and clear words when something is wrong.

#[path = "common/sweep.rs"]
mod support;

use bankshot::sweep::folder::Folder;
use bankshot::sweep::row::{Cell, Row, place_of};
use bankshot::sweep::store::{self, Store};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};
use support::{JOBS, Place, SWEEP, bankshot, copy_unfinished, said, start, store, stores, tables};

#[test]
fn contract_threads_shards_and_missing_instructions_change_no_byte() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    for (shards, threads) in [(1, 1), (2, 1), (3, 2), (7, 64)] {
        let out = place.out(&format!("{shards}"));
        for shard in 1..=shards {
            let mut command = place.command(&out);
            command
                .args(["--quiet", "--threads", &threads.to_string()])
                .args(["--shard", &format!("{shard}/{shards}")]);
            if threads == 1 {
                // The system's library without these instructions.
                command.env("GLIBC_TUNABLES", "glibc.cpu.hwcaps=-AVX2,-FMA");
            }
            let output = command.output().unwrap();
            assert_eq!(output.status.code(), Some(0), "{output:?}");
        }
        let output = bankshot().arg("merge").arg(&out).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert_eq!(tables(&out), bytes, "{shards} shards, {threads} threads");
    }
}

#[test]
fn contract_a_hundred_kills_change_no_byte() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    let mut random = ChaCha12Rng::seed_from_u64(5);
    let out = place.out("killed");
    let (mut kills, mut rounds, mut resumed) = (0, 0, 0);
    while kills < 100 {
        let mut child = start(place.command(&out));
        let until = Instant::now() + Duration::from_secs_f64(0.5 * random.random::<f64>());
        while Instant::now() < until && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(2));
        }
        // One that has ended by itself is not hurt by this.
        let _ = child.kill();
        let output = child.wait_with_output().unwrap();
        resumed += usize::from(said(&output).contains("resuming: "));
        match output.status.code() {
            None => kills += 1,
            Some(0) => {
                assert_eq!(tables(&out), bytes);
                rounds += 1;
                fs::remove_dir_all(&out).unwrap();
            }
            Some(_) => panic!("{output:?}"),
        }
    }
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(tables(&out), bytes);
    assert!(resumed > 10, "{rounds} rounds, {resumed} resumed");
}

#[test]
fn contract_a_resumed_sweep_computes_no_finished_job_again() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    let out = place.out("resumed");
    let mut child = start(place.command(&out));
    let enough = JOBS * 6 / 10;
    let done = || -> Vec<(i64, f64)> {
        let Some(path) = out
            .join("store")
            .is_dir()
            .then(|| stores(&out))
            .and_then(|mut all| all.pop())
        else {
            return Vec::new();
        };
        let read = || {
            let connection = rusqlite::Connection::open(&path)?;
            connection.busy_timeout(Duration::from_secs(5))?;
            let mut statement =
                connection.prepare("SELECT job, seconds FROM timing ORDER BY job")?;
            let rows = statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?)))?;
            rows.collect::<Result<Vec<_>, _>>()
        };
        read().unwrap_or_default()
    };
    while done().len() < enough {
        std::thread::sleep(Duration::from_millis(5));
    }
    let _ = child.kill();
    child.wait().unwrap();
    let before = done();
    assert!(before.len() >= enough);
    let output = place.run(&out, &[]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let word = format!("resuming: {} of {JOBS} done", before.len());
    assert!(
        before.len() == JOBS || said(&output).contains(&word),
        "{output:?}"
    );
    let after = done();
    assert_eq!(after.len(), JOBS);
    for time in &before {
        // A job computed again would have taken another time.
        assert!(after.contains(time), "{time:?} {after:?}");
    }
    assert_eq!(tables(&out), bytes);
}

#[test]
fn contract_a_damaged_store_is_set_aside_and_never_believed() {
    let place = Place::new();
    let (whole, bytes) = place.undisturbed();
    let name = store(&whole).file_name().unwrap().to_owned();
    let sound = fs::read(store(&whole)).unwrap();
    let mut random = ChaCha12Rng::seed_from_u64(9);
    let mut cases: Vec<(String, Vec<u8>)> = Vec::new();
    for part in 0..8 {
        let length = sound.len() * part / 8 + random.random_range(0..sound.len() / 8);
        cases.push((format!("cut at {length}"), sound[..length].to_vec()));
    }
    for _ in 0..24 {
        let (at, bit) = (
            random.random_range(0..sound.len()),
            random.random_range(0..8),
        );
        let mut bytes = sound.clone();
        bytes[at] ^= 1 << bit;
        cases.push((format!("byte {at} bit {bit}"), bytes));
    }
    // Where reading shows nothing: the header's versions, and the layout of the small tables.
    for at in [18, 19] {
        let mut bytes = sound.clone();
        bytes[at] ^= 2;
        cases.push((format!("byte {at} of the header"), bytes));
    }
    for (from, to) in [("aborts", "abosts"), ("started (place", "started (plaze")] {
        let at = sound
            .windows(from.len())
            .position(|window| window == from.as_bytes())
            .unwrap();
        let mut bytes = sound.clone();
        bytes[at..at + to.len()].copy_from_slice(to.as_bytes());
        cases.push((format!("{to} in the layout"), bytes));
    }
    let mut longer = sound.clone();
    longer.extend([0; 5000]);
    cases.push(("zeros appended".to_owned(), longer));
    cases.push(("all zero".to_owned(), vec![0; sound.len()]));
    cases.push(("not a database".to_owned(), b"hello".repeat(1000)));
    let mut set_aside = 0;
    for (number, (what, damaged)) in cases.iter().enumerate() {
        let out = place.out(&format!("damaged-{number}"));
        copy_unfinished(&whole, &out);
        fs::write(out.join("store").join(&name), damaged).unwrap();
        let output = place.run(&out, &["--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{what}: {output:?}");
        assert_eq!(tables(&out), bytes, "{what}");
        set_aside += usize::from(said(&output).contains("is set aside as"));
        fs::remove_dir_all(&out).unwrap();
    }
    assert!(set_aside > 10, "{set_aside}");
}

#[test]
fn contract_salvage_never_takes_the_place_of_a_better_result() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    let out = place.out("salvage");
    let output = place.run(&out, &["--quiet", "--fault", "panic:2"]);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    // A machine's store with the failures, which then breaks; another machine has mended them.
    let old = out.join("store/1-of-9.elsewhere.sqlite");
    fs::copy(store(&out), &old).unwrap();
    let output = place.run(&out, &["--quiet", "--retry-failed"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let mut broken = fs::read(&old).unwrap();
    broken[18] ^= 2;
    fs::write(&old, broken).unwrap();
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(
        said(&output).contains("12 sound results of it are kept"),
        "{output:?}"
    );
    assert_eq!(tables(&out), bytes);
    assert!(out.join("store/1-of-9.elsewhere.sqlite.damaged-1").exists());
    assert!(
        out.join("store/1-of-9.elsewhere.salvaged-1.sqlite")
            .exists()
    );
}

#[test]
fn contract_a_shard_answers_for_its_own_jobs_alone() {
    let place = Place::new();
    let out = place.out("own");
    for (more, code) in [
        (["--shard", "1/2", "--fault", "panic:0"], 3),
        (["--shard", "2/2", "--fault", "panic:99"], 0),
    ] {
        let output = place
            .command(&out)
            .arg("--quiet")
            .args(more)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(code), "{output:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn contract_a_signal_that_the_shell_ignores_stays_ignored() {
    let place = Place::new();
    let out = place.out("nohup");
    let sweep = place.command(&out);
    let mut command = std::process::Command::new("sh");
    command
        .args(["-c", "trap '' HUP; exec \"$@\"", "sh"])
        .arg(sweep.get_program())
        .args(sweep.get_args());
    let child = start(command);
    std::thread::sleep(Duration::from_millis(150));
    let _ = std::process::Command::new("kill")
        .args(["-HUP", &child.id().to_string()])
        .stderr(Stdio::null())
        .status();
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
}

#[test]
fn contract_a_damaged_configuration_is_written_anew() {
    let place = Place::new();
    let (out, bytes) = place.undisturbed();
    let file = out.join("configuration.json");
    let text = fs::read_to_string(&file).unwrap();
    for damaged in [&text[..text.len() / 2], "", &text.replace("16 ft", "17 ft")] {
        fs::write(&file, damaged).unwrap();
        let output = bankshot().arg("merge").arg(&out).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        let output = place.run(&out, &["--quiet"]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert_eq!(fs::read_to_string(&file).unwrap(), text);
        assert_eq!(tables(&out), bytes);
    }
}

#[test]
fn contract_another_configuration_is_refused_and_a_reformatted_one_is_not() {
    let place = Place::new();
    let (out, bytes) = place.undisturbed();
    let reformatted = SWEEP
        .replace("\"8 ft\", \"12 ft\"", "  \"8.0 ft\" ,\n \"12 ft\"")
        .replace("standard_error = 0.02", "standard_error = 2e-2 # the same");
    fs::write(&place.sweep, reformatted).unwrap();
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    fs::write(&place.sweep, SWEEP.replace("0.25 ft/s", "0.26 ft/s")).unwrap();
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(4), "{output:?}");
    assert!(
        said(&output).contains("template.shooter.errors.c10_m_s"),
        "{output:?}"
    );
    assert_eq!(tables(&out), bytes);
    // Another version of the program gives another hash, and says which it was.
    let file = out.join("configuration.json");
    let text = fs::read_to_string(&file).unwrap();
    let mut kept: serde_json::Value = serde_json::from_str(&text).unwrap();
    kept["version"] = "9.9.9".into();
    kept["hash"] = "0".repeat(64).into();
    let sealed = serde_json::to_string(&(&kept["hash"], &kept["texts"])).unwrap();
    kept["checksum"] = blake3::hash(sealed.as_bytes()).to_hex().to_string().into();
    fs::write(&file, kept.to_string()).unwrap();
    fs::write(&place.sweep, SWEEP).unwrap();
    let output = bankshot().arg("status").arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    for output in [
        place.run(&out, &["--quiet"]),
        bankshot().arg("merge").arg(&out).output().unwrap(),
    ] {
        assert_eq!(output.status.code(), Some(4), "{output:?}");
        assert!(
            said(&output).contains("program.version: there \"9.9.9\""),
            "{output:?}"
        );
    }
}

#[test]
fn contract_two_runs_in_one_folder_are_refused_with_who_is_there() {
    let place = Place::new();
    let out = place.out("twice");
    let mut child = start(place.command(&out));
    while !out.join("store").is_dir() || stores(&out).is_empty() {
        std::thread::sleep(Duration::from_millis(5));
    }
    let output = place.run(&out, &["--quiet"]);
    if child.try_wait().unwrap().is_none() {
        assert_eq!(output.status.code(), Some(75), "{output:?}");
        let pid = child.id().to_string();
        assert!(
            said(&output).contains(&format!("process {pid}")),
            "{output:?}"
        );
    }
    // Its end, however it comes, frees the folder.
    let _ = child.kill();
    child.wait().unwrap();
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
}

#[test]
fn contract_missing_shards_are_named_and_copies_do_no_harm() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    let out = place.out("shards");
    for shard in ["1/6", "3/6", "6/6"] {
        let output = place.run(&out, &["--quiet", "--shard", shard]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
    let merge = || {
        bankshot()
            .arg("merge")
            .arg(&out)
            .args(["--shards", "6"])
            .output()
            .unwrap()
    };
    let missing = || {
        bankshot()
            .arg("missing")
            .arg(&out)
            .args(["--shards", "6"])
            .output()
            .unwrap()
    };
    let output = merge();
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    assert!(said(&output).contains("--array=2,4-5"), "{output:?}");
    assert!(!out.join("best_shots.csv").exists());
    assert_eq!(String::from_utf8(missing().stdout).unwrap(), "2,4-5\n");
    // Another division goes on with what is there.
    for shard in ["1/2", "2/2"] {
        let output = place.run(&out, &["--quiet", "--shard", shard]);
        assert_eq!(output.status.code(), Some(0), "{output:?}");
    }
    assert_eq!(missing().status.code(), Some(0));
    for path in stores(&out) {
        fs::copy(&path, path.with_extension("copy.sqlite")).unwrap();
    }
    let output = merge();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(tables(&out), bytes);
}

/// Puts a row with another P, and its right checksum, into a store of its own.
fn contradict(out: &Path) -> u64 {
    let (folder, _) = Folder::existing(out).unwrap();
    let mut rows: Vec<Row> = Vec::new();
    store::read(&store(out), folder.hash(), JOBS as u64, |row| {
        rows.push(row)
    })
    .unwrap();
    let mut row = rows[3].clone();
    row.cells[place_of("probability")] = Cell::Real(0.123);
    let mut other = Store::open(&out.join("store/0-other.sqlite"), folder.hash()).unwrap();
    other.finish(0, std::slice::from_ref(&row), 1.0).unwrap();
    row.job
}

#[test]
fn contract_contradicting_stores_are_refused_and_the_job_is_named() {
    let place = Place::new();
    let (out, bytes) = place.undisturbed();
    let job = contradict(&out);
    let output = bankshot().arg("merge").arg(&out).output().unwrap();
    assert_eq!(output.status.code(), Some(4), "{output:?}");
    assert!(said(&output).contains(&format!("job {job} ")), "{output:?}");
    assert_eq!(tables(&out), bytes);
}

#[test]
fn contract_verify_finds_a_result_that_was_never_computed() {
    let place = Place::new();
    let (out, _) = place.undisturbed();
    let verify = |part: &str| {
        bankshot()
            .args(["verify", "--quiet", "--recompute", part])
            .arg(&out)
            .output()
            .unwrap()
    };
    let output = verify("50%");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(
        said(&output).contains("recomputed 6 jobs: 0 differ"),
        "{output:?}"
    );
    let job = contradict(&out);
    fs::remove_file(store(&out)).unwrap();
    let output = verify("1");
    assert_eq!(output.status.code(), Some(4), "{output:?}");
    assert!(
        said(&output).contains(&format!("differs: job {job}")),
        "{output:?}"
    );
}

#[test]
fn contract_a_job_that_panics_fails_alone() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    let out = place.out("panic");
    let output = place.run(&out, &["--quiet", "--fault", "panic:2"]);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    assert!(said(&output).contains("10 found") && said(&output).contains("panicked: as asked for"));
    // It stays failed, and is named, until it is asked for again.
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    let output = place.run(&out, &["--quiet", "--retry-failed"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(tables(&out), bytes);
}

#[cfg(unix)]
#[test]
fn contract_a_place_that_aborts_the_program_twice_is_given_up_by_name() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    let out = place.out("abort");
    let faulty = ["--quiet", "--threads", "2", "--fault", "abort:2"];
    for _ in 0..2 {
        assert_eq!(place.run(&out, &faulty).status.code(), None);
    }
    let output = place.run(&out, &faulty);
    assert_eq!(output.status.code(), Some(3), "{output:?}");
    assert!(said(&output).contains("10 found"), "{output:?}");
    assert!(
        said(&output).contains("the program aborted twice"),
        "{output:?}"
    );
    let output = place.run(&out, &["--quiet", "--retry-failed"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(tables(&out), bytes);
}

#[cfg(unix)]
#[test]
fn contract_signals_end_it_within_a_second_and_it_goes_on() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    let out = place.out("signals");
    for (signal, twice, code) in [("TERM", false, 75), ("INT", true, 130), ("HUP", false, 75)] {
        let mut child = start(place.command(&out));
        std::thread::sleep(Duration::from_millis(150));
        let began = Instant::now();
        for _ in 0..=usize::from(twice) {
            let pid = child.id().to_string();
            let _ = std::process::Command::new("kill")
                .args([&format!("-{signal}"), &pid])
                .stderr(Stdio::null())
                .status();
        }
        while child.try_wait().unwrap().is_none() {
            assert!(began.elapsed() < Duration::from_secs(10), "{signal}");
            std::thread::sleep(Duration::from_millis(5));
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{output:?}");
        assert!(
            said(&output).contains("the same command goes on"),
            "{output:?}"
        );
    }
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert_eq!(tables(&out), bytes);
}

#[cfg(unix)]
#[test]
fn contract_closed_and_full_outputs_lose_no_result() {
    let place = Place::new();
    let (_, bytes) = place.undisturbed();
    for (name, shell, code) in [
        ("full", "\"$@\" >/dev/full", 74),
        ("closed", "\"$@\" >&- 2>&-", 0),
        ("head", "\"$@\" | true", 0),
        ("no-home", "env -u HOME -u TERM \"$@\"", 0),
    ] {
        let out = place.out(name);
        let command = place.command(&out);
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
fn contract_folders_that_cannot_be_used_are_found_before_computing() {
    let place = Place::new();
    let file = place.out("file");
    fs::write(&file, "x").unwrap();
    for out in [file.clone(), file.join("below")] {
        let output = place.run(&out, &["--quiet"]);
        assert_eq!(output.status.code(), Some(74), "{output:?}");
    }
    let output = bankshot()
        .arg("status")
        .arg(place.out("nothing"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    // Foreign files are ignored.
    let out = place.out("foreign");
    fs::create_dir_all(out.join("store")).unwrap();
    fs::write(out.join("store/notes.txt"), "hello").unwrap();
    fs::create_dir(out.join("store/folder.sqlite")).unwrap();
    fs::write(out.join("best.docx"), [0; 100]).unwrap();
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
}

#[test]
fn contract_bad_sweeps_are_refused_with_every_fault_at_its_line() {
    for (from, to, message) in [
        ("\"8 ft\", \"12 ft\"", "\"8\", \"12 ft\"", "unit"),
        ("\"8 ft\"", "\"nan ft\"", "finite"),
        ("\"8 ft\"", "\"-8 ft\"", ""),
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
        ("name = \"small\"", "colour = \"red\"", "is not a key here"),
        (
            "[grid]",
            "[location]\ndistance = \"10 ft\"\n[grid]",
            "is not a key here",
        ),
        ("speed = 12", "speed = 65536000", "from 2 to 100000"),
        ("[sweep]", "[sweeps]", "there is no [sweep]"),
        ("[sweep]", "[sweep]\nname = \"twice\"", "duplicate key"),
    ] {
        let text = SWEEP.replace(from, to);
        assert_ne!(text, SWEEP);
        let place = Place::with(&text);
        let out = place.out("out");
        let output = place.run(&out, &["--quiet"]);
        if to == "\"-8 ft\"" {
            // A negative distance is the opposite place, which one cannot shoot from: it is left out.
            assert_eq!(output.status.code(), Some(0), "{output:?}");
            continue;
        }
        assert_eq!(output.status.code(), Some(2), "{to}: {output:?}");
        assert!(said(&output).contains(message), "{to}: {output:?}");
        assert!(!out.exists(), "{to}");
    }
}

#[test]
fn contract_places_of_a_file_are_read_by_name_and_refused_by_row() {
    let head = SWEEP.split("region").next().unwrap();
    let tail = &SWEEP[SWEEP.find("[shooter]").unwrap()..];
    let text = format!("{head}region = \"places\"\nplaces = \"places.csv\"\n{tail}");
    let place = Place::with(&text);
    let file = place.out("places.csv");
    for (places, message) in [
        (
            "x_ft,y_ft\n10,2\n1,0\n",
            "row 2: the place is inside the ring",
        ),
        ("x_ft,y_ft\n10,two\n", "row 1: y_ft must be a number"),
        ("x,y\n10,2\n", "needs the columns"),
        ("x_ft,y_ft\n", "holds no place"),
    ] {
        fs::write(&file, places).unwrap();
        let output = place.run(&place.out("out"), &["--quiet"]);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        assert!(said(&output).contains(message), "{output:?}");
    }
    // One place, its mirror image and itself again: one is computed, all are told.
    fs::write(
        &file,
        "name,distance_ft,court_angle_deg\na,10,30\nb,10,-30\nc,10,30\n",
    )
    .unwrap();
    let out = place.out("out");
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(said(&output).starts_with("2 of 2 jobs"), "{output:?}");
    let csv = fs::read_to_string(out.join("best_shots.csv")).unwrap();
    assert_eq!(csv.lines().count(), 7);
}

#[test]
fn contract_names_never_become_paths() {
    for name in ["../../escape", "a/b", &"long ".repeat(90)] {
        let text = SWEEP.replace("\"small\"", &format!("\"{name}\""));
        let place = Place::with(&text);
        let output = bankshot()
            .current_dir(place.folder.path())
            .args(["sweep", "sweep.toml", "--quiet"])
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let made: Vec<_> = fs::read_dir(place.out("results")).unwrap().collect();
        assert_eq!(made.len(), 1);
    }
}

#[test]
fn prop_a_mirror_image_is_worth_what_its_place_is() {
    // The mirrored row against a search of its own at that place: two comparisons at 4.5 standard errors, and what
    // a table this coarse may lose.
    let place = Place::new();
    let (out, _) = place.undisturbed();
    let text = SWEEP.split("[sweep]").last().unwrap();
    let profile = format!(
        "{}\n[location]\ndistance = \"12 ft\"\nangle = \"-40 deg\"\n",
        &text[text.find("[shooter]").unwrap()..]
    );
    let profile = bankshot::profile::parse(&profile, "test").unwrap();
    let best = bankshot::probability::best::find(&profile, &bankshot::probability::Silent).unwrap();
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
        let by = number(row, "probability") - shot.estimate.probability;
        assert!(by.abs() < 4.5 * error + 0.02, "{kind}: {by} +- {error}");
    }
}
