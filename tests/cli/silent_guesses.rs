//! What a file or a command leaves open is asked for, or said: no wrong answer is silent.

use crate::support::{Answer, bankshot, small_profile, write_file};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn fit(file: &Path, out: &Path, flags: &[&str]) -> Answer {
    let mut command = bankshot();
    command.arg("fit").arg(file).arg("--out").arg(out);
    Answer::of(command.args(flags))
}

/// The 60 releases of the docs with more columns, each by the number of the row.
fn lab_with(columns: &[(&str, &dyn Fn(usize) -> String)]) -> String {
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let mut lines = text.lines();
    let mut header = lines.next().unwrap().to_owned();
    for (name, _) in columns {
        let _ = write!(header, ",{name}");
    }
    let mut all = header + "\n";
    for (row, line) in lines.enumerate() {
        all += line;
        for (_, value) in columns {
            let _ = write!(all, ",{}", value(row));
        }
        all.push('\n');
    }
    all
}

/// One release, one result: no command has a physics of its own.
#[test]
fn contract_every_command_has_the_same_ball() {
    let folder = TempDir::new().unwrap();
    let profile = small_profile().replace("preset = \"paper\"", "");
    let profile = profile.replace("[physics]\n", "");
    let profile = write_file(&folder, "p.toml", &profile);
    // In a vacuum this shot is long, in air it goes in.
    let shot = [
        "--speed",
        "24.05 ft/s",
        "--pitch",
        "52 deg",
        "--backspin",
        "3 rev/s",
    ];
    let trace = |physics: &[&str]| {
        let mut command = bankshot();
        command.arg("trace").arg(&profile).args(shot).args(physics);
        Answer::of(command.arg("--json")).exits(0).json()["made"]
            .as_bool()
            .unwrap()
    };
    assert!(trace(&[]) && trace(&["--physics", "ncaa"]) && !trace(&["--physics", "paper"]));
    let releases = "distance_ft,court_angle_deg,release_height_ft,speed_ft_s,pitch_deg,polar_deg,backspin_rev_s\n13.75,0,7,24.05,52,0,3\n";
    let releases = write_file(&folder, "r.csv", releases);
    let mut command = bankshot();
    command
        .arg("simulate")
        .arg(&releases)
        .args(["--output", "-"]);
    let answer = Answer::of(&mut command).exits(0);
    let line = answer.stdout().lines().nth(1).unwrap().to_owned();
    assert!(line.starts_with("13.75,0,7,24.05,52,0,3,1,"), "{line}");
    let mut command = bankshot();
    let best = command.arg("check").arg(&profile).arg("--verbose");
    Answer::of(best).exits(0).prints("physics: ncaa");
}

/// The backspin that nobody gives is the profile's, and said; authority: the same command with it.
#[test]
fn contract_a_backspin_that_nobody_gives_is_said() {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "p.toml", small_profile());
    let p = |extra: &[&str]| {
        let mut command = bankshot();
        command.arg("probability").arg(&profile);
        command.args(["--speed", "23.6 ft/s", "--pitch", "53.5 deg", "--json"]);
        Answer::of(command.args(extra)).exits(0)
    };
    let (without, with) = (p(&[]), p(&["--backspin", "3 rev/s"]));
    assert_eq!(without.json()["probability"], with.json()["probability"]);
    without.says("no backspin is given; the profile's max_backspin, 3.0 rev/s, is used");
    assert!(!with.stderr.contains("backspin"), "{with:?}");
    let releases = "distance_ft,court_angle_deg,release_height_ft,speed_ft_s,pitch_deg,polar_deg\n13.75,0,7,24.3,52,0\n";
    let releases = write_file(&folder, "r.csv", releases);
    let mut command = bankshot();
    command
        .arg("simulate")
        .arg(&releases)
        .args(["--output", "-"]);
    Answer::of(&mut command).exits(0).says("no ball spins");
}

/// A fit of the players removes the fit of all as one, from which `advise` would answer.
#[test]
fn contract_a_fit_replaces_the_older_one() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let file = write_file(
        &folder,
        "shots.csv",
        lab_with(&[("code", &|row| ["Ann", "Bob"][row % 2].to_owned())]),
    );
    fit(&file, &out, &[]).exits(0);
    fit(&file, &out, &["--map", "shooter=code"]).exits(0);
    for left in [
        "fit.json",
        "draws.parquet",
        "profile.toml",
        "report.html",
        "plots",
    ] {
        assert!(!out.join(left).exists(), "{left}");
    }
    assert!(out.join("ann/fit.json").exists());
    // A player who is no longer in the file.
    let text = fs::read_to_string(&file).unwrap().replace("Bob", "Cy");
    let file = write_file(&folder, "shots.csv", &text);
    fit(&file, &out, &["--map", "shooter=code"]).exits(0);
    assert!(out.join("cy/fit.json").exists() && !out.join("bob").exists());
    // The file of the user is not overwritten.
    fit(&file, folder.path(), &[])
        .exits(2)
        .says("over your file");
    assert_eq!(fs::read_to_string(&file).unwrap(), text);
}

/// Thirty shots in each of two sessions, the second two degrees steeper: authority is the order of
/// the days.
#[test]
fn contract_sessions_are_in_the_order_of_time() {
    let folder = TempDir::new().unwrap();
    let shots = |dates: &[&str], newest_first: bool| {
        let text = fs::read_to_string("docs/data/lab.csv").unwrap();
        let mut lines = text.lines();
        let header = format!("{},date\n", lines.next().unwrap());
        let of_a_day = 60 / dates.len();
        let mut rows: Vec<String> = lines
            .enumerate()
            .map(|(row, line)| {
                let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
                if row >= 30 {
                    cells[1] = format!("{:.2}", cells[1].parse::<f64>().unwrap() + 4.0);
                }
                format!("{},{}\n", cells.join(","), dates[row / of_a_day])
            })
            .collect();
        if newest_first {
            rows.reverse();
        }
        write_file(&folder, "days.csv", header + &rows.concat())
    };
    let compare = |file: &Path, flags: &[&str]| {
        let mut command = bankshot();
        command
            .arg("compare-sessions")
            .arg(file)
            .args(["--map", "session=date", "--json"]);
        Answer::of(command.args(flags))
    };
    // Which is the later one: the shots of March are steeper.
    let file = shots(&["2025-10-14", "2026-03-02"], true);
    let json = compare(&file, &[]).exits(0).json();
    let quantities = json["quantities"].as_array().or(json["changes"].as_array());
    let all = quantities.unwrap_or_else(|| panic!("{json:#}"));
    let name = |q: &&serde_json::Value| {
        q["name"]
            .as_str()
            .is_some_and(|n| n.starts_with("pitch_mean"))
    };
    let pitch = all.iter().find(name).unwrap_or_else(|| panic!("{json:#}"));
    assert!(pitch["change"]["mean"].as_f64().unwrap() > 2.0, "{json:#}");
    // Three sessions are named in the order of time, however the file has them.
    for (dates, flags) in [
        (["10/14/2025", "01/05/2026", "03/02/2026"], &[][..]),
        (["14.10.2025", "5.1.2026", "2.3.2026"], &[]),
        (
            ["\"Oct 14, 2025\"", "\"Jan 5, 2026\"", "\"Mar 2, 2026\""],
            &[],
        ),
        (["2025-10-14", "2026-01-05", "2026-03-02"], &[]),
        (["45944", "46027", "46083"], &[]),
        (
            ["14/10/2025", "05/01/2026", "02/03/2026"],
            &["--dates", "dmy"],
        ),
    ] {
        for newest_first in [false, true] {
            compare(&shots(&dates, newest_first), flags)
                .exits(2)
                .says("has 3 sessions (2025-10-14, 2026-01-05, 2026-03-02)");
        }
    }
    let out = folder.path().join("out");
    fit(
        &shots(&["04/03/2025", "05/03/2025"], false),
        &out,
        &["--map", "session=date"],
    )
    .exits(2)
    .says("--dates dmy");
    // A stamp for each shot is no session, and is not proposed as one.
    let stamps = lab_with(&[("timestamp", &|row| {
        format!("2025-10-{:02} 17:05:{row:02}", row / 2 + 1)
    })]);
    let file = write_file(&folder, "stamps.csv", stamps);
    fit(&file, &out, &["--map", "session=timestamp"])
        .exits(2)
        .says("30 values in 60 rows: a session needs 3 shots");
    let answer = fit(&file, &out, &[]).exits(0);
    assert!(!answer.stderr.contains("session=timestamp"), "{answer:?}");
    // Several a day are days.
    let stamps = lab_with(&[("timestamp", &|row| {
        format!("10/{}/2025 5:{row:02} PM", 14 + row / 30)
    })]);
    let file = write_file(&folder, "stamps.csv", stamps);
    fit(&file, &out, &[])
        .exits(0)
        .says("they may hold: session=timestamp; add --accept");
    fit(&file, &out, &["--map", "session=timestamp"])
        .exits(0)
        .says("sessions are days in the order of time, from 2025-10-14 to 2025-10-15");
}

/// Players and places are not pooled in silence.
#[test]
fn contract_players_and_places_are_not_pooled() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    for name in ["Name", "Spieler", "Player", "player_id", "Athlete"] {
        let file = lab_with(&[(name, &|row| format!("P{}", row % 4))]);
        let file = write_file(&folder, "players.csv", file);
        fit(&file, &out, &[])
            .exits(2)
            .says("has 4 players (P0, P1, P2, P3)")
            .says(&format!("--map 'shooter={name}'"));
        assert!(!out.exists());
    }
    let places = ["Free Throw", "Left Elbow", "Right Wing 3"];
    for name in ["Spot", "Location", "Where from"] {
        let lab = lab_with(&[(name, &|row| places[row % 3].to_owned())]);
        let without = lab.replace(",distance_ft,", ",other,");
        let file = write_file(&folder, "places.csv", without);
        fit(&file, &out, &["--distance", "13.75 ft"])
            .exits(2)
            .says("one --distance or --at is not that of all")
            .says("Free Throw, Left Elbow, Right Wing 3");
        let file = write_file(&folder, "places.csv", lab);
        fit(&file, &folder.path().join("good"), &[]).exits(0);
    }
}

/// Results of one kind with blanks are asked about; authority: the number of ones in the file.
#[test]
fn contract_blanks_are_not_left_out_in_silence() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let ones = text.lines().filter(|line| line.ends_with(",1")).count();
    let blanks: String = text
        .lines()
        .map(|line| {
            line.strip_suffix(",0")
                .map_or(line.to_owned(), |l| format!("{l},"))
                + "\n"
        })
        .collect();
    let file = write_file(&folder, "blanks.csv", blanks);
    fit(&file, &out, &[]).exits(2).says("--made '1'");
    let json = fit(&file, &out, &["--made", "1", "--json"]).exits(0).json();
    assert_eq!(json["observed"]["made"], ones);
    assert_eq!(json["observed"]["shots"], 60);
    fit(&file, &out, &["--made", "yes"])
        .exits(2)
        .says("has no yes");
}

/// A ball that the board cannot stop: the compression of the undamped bounce, v sqrt(m/k), is more
/// than its radius.
#[test]
fn contract_a_ball_does_not_pass_through_the_board() {
    let folder = TempDir::new().unwrap();
    let base = small_profile().replace(
        "preset = \"paper\"",
        "preset = \"ncaa\"\nball_radius = \"1 cm\"",
    );
    // 0.6 kg on 2000 lb/ft at the 7 m/s of a free throw: 3.2 cm.
    let file = write_file(&folder, "small.toml", &base);
    let mut command = bankshot();
    command
        .arg("trace")
        .arg(&file)
        .args(["--speed", "7.5 m/s", "--pitch", "52 deg"]);
    Answer::of(&mut command).exits(2).says("passes through");
    // A hundredth of the mass: 0.32 cm.
    let light = base.replace("ball_radius", "ball_mass = \"6 g\"\nboard_damping = \"0.05 kg/s\"\nhoop_damping = \"0.05 kg/s\"\nair_density = \"0 kg/m^3\"\nball_radius");
    let file = write_file(&folder, "light.toml", light);
    let mut command = bankshot();
    command.arg("check").arg(&file);
    Answer::of(&mut command).exits(0);
    let mut command = bankshot();
    command.arg("trace").arg("configs/free_throw.toml");
    command.args([
        "--speed",
        "50 m/s",
        "--pitch",
        "20 deg",
        "--backspin",
        "0 rev/s",
    ]);
    Answer::of(&mut command)
        .exits(0)
        .says("cannot stop this ball");
}

/// Six copies of one player are not ranked; each is the best with a sixth.
#[test]
fn contract_copies_of_a_player_are_not_ranked() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("copies");
    let names = ["Ann", "Bo", "Cy"];
    let file = lab_with(&[("shooter", &|row| names[row % 3].to_owned())]);
    let file = write_file(&folder, "team.csv", file);
    fit(&file, &out, &[]).exits(0);
    for name in ["ann", "bo", "cy"] {
        crate::support::make_search_small(&out.join(name));
    }
    let mut command = bankshot();
    let answer = Answer::of(command.arg("team").arg(&out).arg("--quiet")).exits(0);
    let text = answer.stdout();
    assert!(text.contains("as the order is\nnot clear"), "{text}");
    assert!(text.contains("best of all: the probability"), "{text}");
    assert!(!text.contains("the best player first"), "{text}");
}

/// The tracks of the docs, changed point by point: shot, time (s), x and y (ft).
fn tracks_with(change: impl Fn(u32, &mut f64, &mut f64, &mut f64)) -> String {
    let text = fs::read_to_string("docs/data/optical_tracking.csv").unwrap();
    let mut lines = text.lines();
    let mut all = lines.next().unwrap().to_owned() + "\n";
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        let shot = cells[0].parse().unwrap();
        let [mut time, mut x, mut y] = [1, 2, 3].map(|k: usize| cells[k].parse::<f64>().unwrap());
        change(shot, &mut time, &mut x, &mut y);
        let _ = writeln!(
            all,
            "{shot},{time:.3},{x:.3},{y:.3},{},{}",
            cells[4], cells[5]
        );
    }
    all
}

/// The drag of the made-up flights is 0.45: another one is named, and flights from many places give
/// it without a profile.
#[test]
fn contract_a_drag_that_the_flights_reject_is_named() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let heavy = write_file(
        &folder,
        "heavy.toml",
        "[physics]\npreset = \"ncaa\"\ndrag_coefficient = 0.9\n",
    );
    let file = Path::new("docs/data/optical_tracking.csv");
    let answer = fit(
        file,
        &out,
        &["--physics", heavy.to_str().unwrap(), "--json"],
    )
    .exits(0);
    let notes = answer.json()["notes"].to_string();
    assert!(notes.contains("\"code\":\"other_drag\""), "{notes}");
    let answer = fit(file, &out, &["--json"]).exits(0);
    let notes = answer.json()["notes"].to_string();
    assert!(!notes.contains("drag"), "{notes}");
    // A shot every 14 degrees, 3.4 ft from the next.
    let around = tracks_with(|shot, _, x, y| {
        let angle = 0.24 * (f64::from(shot % 13) - 6.0);
        let (sin, cos) = libm::sincos(angle);
        (*x, *y) = (*x * cos - *y * sin, *x * sin + *y * cos);
    });
    let few: String = around
        .lines()
        .filter(|line| {
            line.split(',')
                .next()
                .unwrap()
                .parse()
                .is_ok_and(|shot: u32| shot < 26)
                || line.starts_with("shot")
        })
        .map(|line| line.to_owned() + "\n")
        .collect();
    let file = write_file(&folder, "around.csv", few);
    let answer = fit(&file, &out, &["--free", "drag_coefficient"])
        .exits(3)
        .prints("drag_coefficient  0.")
        .says("no profile was fitted");
    assert!(
        answer.stdout().contains(" flights; the physics ncaa"),
        "{answer:?}"
    );
}

/// A clock that counts milliseconds from 1970 gives the same fit.
#[test]
fn contract_times_have_no_limit() {
    let folder = TempDir::new().unwrap();
    let p = |text: String, name: &str| {
        let file = write_file(&folder, name, text);
        let answer = fit(&file, &folder.path().join("out"), &["--json"]).exits(0);
        answer.json()["probability"]["mean"].as_f64().unwrap()
    };
    let own = p(tracks_with(|_, _, _, _| ()), "s.csv");
    let unix = tracks_with(|_, time, _, _| *time = 1_451_350_000_000.0 + 1000.0 * *time);
    let unix = p(unix.replace("time_s", "time_ms"), "ms.csv");
    assert!((own - unix).abs() < 0.003, "{own} {unix}");
}

/// Releases of a made-up player: speed, angle and direction scatter about an aim near the best one.
fn player(seed: u64, shots: usize) -> String {
    use rand::{RngExt, SeedableRng};
    let mut random = rand::rngs::ChaCha12Rng::seed_from_u64(seed);
    let mut normal = || {
        // Twelve uniform numbers less six are as good as normal here.
        (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0
    };
    let aim = [
        24.2 + 0.12 * normal(),
        52.0 + 2.0 * normal(),
        0.35 * normal(),
    ];
    let sd = [0.25, 1.25, 1.2].map(|sd: f64| sd * libm::exp(0.25 * normal()));
    let mut text = String::from("speed_ft_s,pitch_deg,aim_deg,distance_ft,release_height_ft\n");
    for _ in 0..shots {
        let values: [f64; 3] = std::array::from_fn(|i| aim[i] + sd[i] * normal());
        let _ = writeln!(
            text,
            "{:.4},{:.3},{:.3},13.75,7",
            values[0], values[1], values[2]
        );
    }
    text
}

/// The suggestions of `advise` for several seeds: causes without those that come with others, and
/// whether something is at the limit. No suggestion's interval holds 0.
fn suggestions(player: &Path, seeds: std::ops::RangeInclusive<u32>) -> Vec<(Vec<String>, bool)> {
    let of_seed = |seed: u32| {
        let mut command = bankshot();
        command
            .arg("advise")
            .arg(player)
            .args(["--quiet", "--json", "--seed", &seed.to_string()]);
        let json = Answer::of(&mut command).exits(0).json();
        let causes = json["causes"].as_array().unwrap().clone();
        let with = |support: &str| {
            let causes = causes.iter().filter(|cause| cause["support"] == support);
            causes
                .map(|cause| cause["cause"].as_str().unwrap().to_owned())
                .collect::<Vec<_>>()
        };
        let mut supported = with("supported");
        if supported.contains(&"pitch".to_owned()) {
            supported.retain(|cause| cause != "speed");
        }
        if !supported.is_empty() {
            assert!(
                json["suggested_gain"]["low"].as_f64().unwrap() > 0.0,
                "{json:#}"
            );
        }
        (supported, !with("at_the_limit").is_empty())
    };
    seeds.map(of_seed).collect()
}

fn check_one_suggestion(found: &[(Vec<String>, bool)]) {
    let mut clear: Vec<_> = found
        .iter()
        .filter(|(_, limit)| !limit)
        .map(|(all, _)| all)
        .collect();
    clear.dedup();
    clear.sort();
    clear.dedup();
    assert!(clear.len() <= 1, "{found:?}");
}

#[test]
fn contract_another_seed_gives_the_same_suggestion() {
    let folder = TempDir::new().unwrap();
    for shooter in 1..=2 {
        let file = write_file(&folder, "player.csv", player(shooter, 60));
        check_one_suggestion(&suggestions(&file, 1..=2));
    }
}

/// `cargo test --test cli campaign_seeds -- --ignored --nocapture`
#[test]
#[ignore = "20 minutes"]
fn campaign_seeds_give_one_suggestion() {
    let folder = TempDir::new().unwrap();
    let (mut at_limit, mut all) = (0, 0);
    for shooter in 1..=20 {
        let file = write_file(&folder, "player.csv", player(shooter, 60));
        let found = suggestions(&file, 1..=20);
        at_limit += found.iter().filter(|(_, limit)| *limit).count();
        all += found.len();
        println!(
            "shooter {shooter}: {:?}",
            found
                .iter()
                .map(|(s, l)| (s.join("+"), *l))
                .collect::<std::collections::BTreeSet<_>>()
        );
        check_one_suggestion(&found);
    }
    println!("at the limit: {at_limit} of {all}");
}
