//! `fit` and what follows from it: from measured shots to a profile and advice.

use super::support::{Answer, bankshot, fit, make_search_small, write_file};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Of the made-up player of `examples/make_measured_shots.rs`: standard deviations of speed (ft/s),
/// pitch and aim (deg).
const TRUE_SCATTER: [(&str, f64); 3] = [("speed_sd", 0.25), ("pitch_sd", 1.3), ("polar_sd", 1.2)];

/// Each kind of file of the docs gives intervals that cover the truth (95 % each: the files are
/// fixed).
#[test]
fn contract_each_kind_of_measurement_gives_a_profile() {
    let folder = TempDir::new().unwrap();
    for (file, source) in [
        ("lab", "measured"),
        ("gym_sensor", "from landings"),
        ("optical_tracking", "from trajectories"),
    ] {
        let out = folder.path().join(file);
        let answer = fit(&format!("docs/data/{file}.csv"), &out, &["--json"])
            .exits(0)
            .json();
        let parameters = answer["parameters"].as_array().unwrap();
        for (name, truth) in TRUE_SCATTER {
            let found = parameters.iter().find(|p| p["name"] == name).unwrap();
            let (low, high) = (
                found["low"].as_f64().unwrap(),
                found["high"].as_f64().unwrap(),
            );
            // Two of nine intervals just miss it.
            let margin = 0.25 * (high - low);
            assert!(
                low - margin < truth && truth < high + margin,
                "{file} {name} {low} {high}"
            );
            assert_eq!(found["source"], source);
        }
        let p = &answer["probability"];
        assert!(p["low"].as_f64().unwrap() < p["high"].as_f64().unwrap());
        assert!(p["numerical_standard_error"].as_f64().unwrap() < 0.002);
        let observed = &answer["observed"];
        assert!(observed["made"].as_u64().unwrap() < observed["shots"].as_u64().unwrap());
        for name in [
            "fit.json",
            "profile.toml",
            "draws.parquet",
            "shots.csv",
            "report.html",
            "plots/make_zone.svg",
            "plots/reliability.png",
        ] {
            assert!(out.join(name).exists(), "{name}");
        }
        // The profile can be used at once.
        let profile = out.join("profile.toml");
        let checked = Answer::of(bankshot().arg("check").arg(&profile));
        checked.exits(0);
    }
}

#[test]
fn contract_threads_change_no_bit_of_a_fit() {
    let folder = TempDir::new().unwrap();
    let files = ["1", "2"].map(|threads| {
        let out = folder.path().join(threads);
        fit("docs/data/gym_sensor.csv", &out, &["--threads", threads]).exits(0);
        fs::read(out.join("draws.parquet")).unwrap()
    });
    assert!(files[0] == files[1]);
}

#[test]
fn contract_columns_of_other_names_and_units_give_the_same_profile() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let renamed = text
        .replace("speed_ft_s", "Release Speed")
        .replace("aim_deg", "Direction");
    let path = folder.path().join("other.csv");
    fs::write(&path, renamed).unwrap();
    let own = fit("docs/data/lab.csv", &folder.path().join("a"), &["--json"])
        .exits(0)
        .json();
    let maps = [
        "--json",
        "--map",
        "speed_ft_s=Release Speed",
        "--map",
        "aim_deg=Direction",
    ];
    let other = fit(path.to_str().unwrap(), &folder.path().join("b"), &maps)
        .exits(0)
        .json();
    assert_eq!(own["parameters"], other["parameters"]);
    // The maps in a file, as they are typed and as a message proposes them.
    let lines = "# the lab's names\nspeed_ft_s=Release Speed\n  --map 'aim_deg=Direction' \\\n\n";
    let file = format!("@{}", write_file(&folder, "maps.txt", lines).display());
    let of_file = ["--json", "--map", &file];
    let of_file = fit(path.to_str().unwrap(), &folder.path().join("c"), &of_file)
        .exits(0)
        .json();
    assert_eq!(own["parameters"], of_file["parameters"]);
}

#[test]
fn contract_advice_is_the_same_from_a_file_and_from_its_fit() {
    let folder = TempDir::new().unwrap();
    fit("docs/data/lab.csv", folder.path(), &[]).exits(0);
    let advise = |shots: &str| {
        let answer = Answer::of(bankshot().args(["advise", shots, "--quiet", "--json"]));
        answer.exits(0).json()
    };
    let of_file = advise("docs/data/lab.csv");
    let of_folder = advise(folder.path().to_str().unwrap());
    for key in ["kind", "observed", "best"] {
        assert_eq!(of_file[key], of_folder[key], "{key}");
    }
    let mean = |answer: &serde_json::Value, key: &str| answer[key]["mean"].as_f64().unwrap();
    for key in ["current_probability", "best_probability", "gain"] {
        assert!(
            (mean(&of_file, key) - mean(&of_folder, key)).abs() < 1e-6,
            "{key}"
        );
    }
    assert!(mean(&of_file, "gain") > 0.0);
    // The steps lead to within half a shot in 100 of the best shot.
    let causes = of_file["causes"].as_array().unwrap();
    let sum: f64 = causes
        .iter()
        .map(|cause| cause["mean"].as_f64().unwrap())
        .sum();
    assert!((sum - mean(&of_file, "gain")).abs() < 0.01, "{sum}");
    make_search_small(folder.path());
    let draws = folder.path().to_str().unwrap();
    let profile = folder.path().join("profile.toml");
    let flags = [
        "--speed",
        "24.1 ft/s",
        "--pitch",
        "51 deg",
        "--draws",
        draws,
        "--target",
        "0.01",
    ];
    let answer = Answer::of(
        bankshot()
            .arg("probability")
            .arg(profile)
            .args(flags)
            .arg("--quiet"),
    );
    let text = answer.exits(0).stdout().to_owned();
    assert!(text.contains("from the measured shots"), "{text}");
    // At several pitch angles: in the text, in the file and in JSON.
    let curve = folder.path().join("curve.csv");
    let mut command = bankshot();
    command.arg("pitch-curve").arg(folder.path());
    command.args(["--quiet", "--draws", draws, "--pitches", "52 deg, 56 deg"]);
    command.arg("-o").arg(&curve).arg("--json");
    let json = Answer::of(&mut command).exits(0).json();
    let header = "over_draws_below_best_mean,over_draws_below_best_sd,over_draws_below_best_low,over_draws_below_best_high";
    let csv = fs::read_to_string(&curve).unwrap();
    assert!(csv.lines().next().unwrap().ends_with(header), "{csv}");
    let over = |k: usize, value: &str, end: &str| {
        let shot = &json["shots"][k];
        (shot["over_draws"][value][end].as_f64().unwrap(), shot)
    };
    for (k, line) in csv.lines().skip(1).enumerate() {
        let cells: Vec<&str> = line.rsplit(',').collect();
        let (mean, shot) = over(k, "probability", "mean");
        assert!((cells[7].parse::<f64>().unwrap() - mean).abs() < 1e-5);
        let exact = shot["probability"].as_f64().unwrap();
        assert!((mean - exact).abs() < 0.03, "{mean} {exact}");
    }
    let less = [0, 1].map(|k| over(k, "below_best", "mean").0);
    assert!(
        less.contains(&0.0) && less[0].max(less[1]) > 0.0,
        "{less:?}"
    );
    // Bank against direct over the same draws.
    let mut command = bankshot();
    command.arg("best").arg(folder.path()).arg("--quiet");
    command.args([
        "--draws",
        draws,
        "--out",
        folder.path().join("best").to_str().unwrap(),
    ]);
    let text = Answer::of(&mut command).exits(0).stdout().to_owned();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "95 % interval ",
        ", from the measured shots; the probability that it beats bank is",
    ] {
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn contract_bad_shots_are_refused_or_named() {
    let folder = TempDir::new().unwrap();
    let header = "speed_ft_s,pitch_deg,aim_deg,distance_ft,release_height_ft,made\n";
    let row =
        |i: usize, speed: f64| format!("{speed:.2},{},0.{},13.75,7,{}\n", 50 + i % 4, i % 9, i % 2);
    let speeds = |first: f64| -> String {
        (0..30)
            .map(|i| row(i, first + 0.1 * ((i * 7) % 10) as f64))
            .collect()
    };
    let same: String = (0..30).map(|_| row(0, 24.2)).collect();
    let few: String = (0..5).map(|i| row(i, 24.0 + 0.1 * i as f64)).collect();
    let bad_rows = speeds(23.8)
        + "NaN,50,0,13.75,7,1\n24,50,150,13.75,7,1\n9,50,0,13.75,7,0\n24,50,0,13.75,7,perhaps\n";
    for (name, text, code, message) in [
        ("few", few, 2, "has 5 usable shots; a fit needs at least 10"),
        (
            "same",
            same,
            2,
            "every shot at one place has the same value",
        ),
        ("metres", speeds(7.1), 2, "looks like m/s"),
        (
            "rows",
            bad_rows,
            3,
            "30 shots used, 4 left out; if those were misses",
        ),
        ("none", String::new(), 2, "has no rows"),
    ] {
        let path = folder.path().join(format!("{name}.csv"));
        fs::write(&path, format!("{header}{text}")).unwrap();
        let out = folder.path().join(name);
        let answer = fit(path.to_str().unwrap(), &out, &[]).exits(code);
        assert!(answer.stderr.contains(message), "{name}: {}", answer.stderr);
        assert_eq!(out.join("fit.json").exists(), code == 3, "{name}");
    }
    // A shot that falls far short is read as one; only the others of the file make it doubtful.
    let text = fs::read_to_string("docs/data/gym_sensor.csv").unwrap();
    let path = folder.path().join("short.csv");
    fs::write(
        &path,
        text + "126,32,-19.0,1.0,13.75,7,0\n127,41,-60,0,13.75,7,0\n",
    )
    .unwrap();
    fit(path.to_str().unwrap(), &folder.path().join("short"), &[])
        .exits(3)
        .says("line 127: left out as doubtful: it is more than 6 robust standard deviations")
        .says("-60.0 in is no shot at this hoop (0 in is the front of the ring, 18 in its back; -48 to 66 are read) (a miss)");
    // A comma inside a name shifts all columns after it; one at the end of the line names none.
    let path = folder.path().join("names.csv");
    fs::write(&path, "entry,Depth (in, + = long),made\n45,9,1\n").unwrap();
    fit(path.to_str().unwrap(), &folder.path().join("names"), &[])
        .exits(2)
        .says("has 4 names, and no row has more than 3 values");
    fs::write(&path, "entry,made,\n45,1\n").unwrap();
    fit(path.to_str().unwrap(), &folder.path().join("names"), &[])
        .exits(2)
        .says("needs the columns of releases");
    // The folder of another command is left alone, and nothing is computed for it.
    let of_best = folder.path().join("of_best");
    fs::create_dir(&of_best).unwrap();
    fs::write(of_best.join("curves.csv"), "kept").unwrap();
    fit("docs/data/lab.csv", &of_best, &[])
        .exits(2)
        .says("has the results of `bankshot best`; name another folder");
    assert_eq!(fs::read_dir(&of_best).unwrap().count(), 1);
    for (flags, message) in [
        (vec!["--tracker", "nobody"], "is neither a tracker"),
        (vec!["--free", "luck"], "--free luck: must be"),
        (vec!["--free", "drag_coefficient"], "needs trajectories"),
        (
            vec!["--map", "pitch_deg=nothing"],
            "there is no column nothing",
        ),
        (vec!["--hoop", "3"], "must be two lengths and a direction"),
    ] {
        let answer = fit("docs/data/lab.csv", &folder.path().join("flags"), &flags).exits(2);
        assert!(answer.stderr.contains(message), "{}", answer.stderr);
    }
}

/// A hoop whose court lies on the other side is told which way it lies.
#[test]
fn contract_shots_from_behind_the_board_name_the_direction() {
    let folder = TempDir::new().unwrap();
    let tracks = "docs/data/optical_tracking.csv";
    let hoop = ["--hoop", "0 m,0 m,-x"];
    fit(tracks, &folder.path().join("fit"), &hoop)
        .exits(2)
        .says("the shots begin behind the board if -x leads from the hoop onto the court; --hoop with +x has them in front of it");
}

/// A column that holds something else than its name says would give a profile that looks fine.
#[test]
fn contract_columns_in_another_unit_or_place_are_refused() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/gym_sensor.csv").unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    // shot, entry angle, depth, left and right, and the rest.
    let changed = |change: &dyn Fn(&mut [f64; 3])| -> String {
        let rows = rows.lines().map(|line| {
            let cells: Vec<&str> = line.splitn(5, ',').collect();
            let mut values = [1, 2, 3].map(|i| cells[i].parse::<f64>().unwrap());
            change(&mut values);
            let [entry, depth, right] = values;
            format!(
                "{},{entry:.4},{depth:.2},{right:.2},{}\n",
                cells[0], cells[4]
            )
        });
        format!("{header}\n{}", rows.collect::<String>())
    };
    for (name, text, message) in [
        (
            "cm",
            changed(&|v| v[1] *= 2.54),
            "The numbers look like cm: --map 'depth=depth_in:cm'",
        ),
        (
            "rad",
            changed(&|v| v[0] = v[0].to_radians()),
            "The numbers look like rad: --map 'entry_angle=entry_angle_deg:rad'",
        ),
        (
            "swapped",
            changed(&|v| v.swap(1, 2)),
            "the two look swapped",
        ),
        (
            "centre",
            changed(&|v| v[1] -= 9.0),
            "but 89 of 125 shots went in",
        ),
    ] {
        let path = folder.path().join(format!("{name}.csv"));
        fs::write(&path, text).unwrap();
        let out = folder.path().join(name);
        let answer = fit(path.to_str().unwrap(), &out, &[]).exits(2);
        assert!(answer.stderr.contains(message), "{name}: {}", answer.stderr);
        assert!(!out.join("fit.json").exists(), "{name}");
    }
}

/// What a spreadsheet saves where the decimal separator is a comma, and a table with tabs: the same
/// fit. A name may hold a comma.
#[test]
fn contract_semicolons_with_decimal_commas_are_read() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/gym_sensor.csv").unwrap();
    let semicolons =
        text.replace(',', ";")
            .replace('.', ",")
            .replacen("depth_in", "\"Depth, in\"", 1);
    let map = ["--map", "depth=Depth, in:in"];
    let fitted = |name: &str, text: &str, more: &[&str]| {
        let path = folder.path().join(format!("{name}.csv"));
        fs::write(&path, text).unwrap();
        let out = folder.path().join(name);
        fit(path.to_str().unwrap(), &out, more).exits(0);
        let json: serde_json::Value =
            serde_json::from_slice(&fs::read(out.join("fit.json")).unwrap()).unwrap();
        json["parameters"].clone()
    };
    let commas = fitted("commas", &text, &[]);
    assert_eq!(fitted("semicolons", &semicolons, &map), commas);
    let named = format!("sep=;\r\n{semicolons}");
    assert_eq!(fitted("separator", &named, &map), commas);
    assert_eq!(fitted("tabs", &text.replace(',', "\t"), &[]), commas);
}

/// Releases of one place whose heights differ by inches are those of one place; a jump of two feet
/// makes two.
#[test]
fn contract_heights_of_one_place_are_one_place() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap();
    let column = header
        .split(',')
        .position(|name| name == "release_height_ft")
        .unwrap();
    let rows: Vec<&str> = lines.collect();
    let with_heights = |height_of: &dyn Fn(usize) -> f64| {
        let rows = rows.iter().enumerate().map(|(i, row)| {
            let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
            cells[column] = height_of(i).to_string();
            cells.join(",") + "\n"
        });
        format!("{header}\n{}", rows.collect::<String>())
    };
    let places = |name: &str, text: String| {
        let path = write_file(&folder, name, &text);
        let out = folder.path().join(name.trim_end_matches(".csv"));
        let mut command = bankshot();
        command.arg("fit").arg(path).arg("--out").arg(&out);
        let answer = Answer::of(&mut command).exits(0);
        let json = fs::read_to_string(out.join("fit.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        (json["places"].as_array().unwrap().clone(), answer.stderr)
    };
    let (found, told) = places("inches.csv", with_heights(&|i| 6.8 + 0.1 * (i % 5) as f64));
    assert_eq!(found.len(), 1);
    assert!((found[0]["release_height_ft"].as_f64().unwrap() - 7.0).abs() < 0.01);
    assert!(
        told.contains(
            "the releases are from scattered places (standard deviation): 0.14 ft in height"
        ),
        "{told}"
    );
    let (found, _) = places("feet.csv", with_heights(&|i| 7.0 + 2.0 * (i % 2) as f64));
    assert_eq!(found.len(), 2);
}

#[test]
fn contract_shooters_have_a_folder_each_and_one_table() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let mut lines = text.lines();
    let mut both = format!("{},shooter\n", lines.next().unwrap());
    for (i, line) in lines.enumerate() {
        both += &format!("{line},{}\n", if i % 2 == 0 { "Ann" } else { "Bob" });
    }
    let path = folder.path().join("team.csv");
    fs::write(&path, both).unwrap();
    let out = folder.path().join("out");
    let answer = fit(path.to_str().unwrap(), &out, &[]).exits(0);
    assert!(answer.stdout().starts_with("2 players fitted."));
    for name in ["ann", "bob"] {
        assert!(out.join(name).join("profile.toml").exists());
    }
    let table = fs::read_to_string(out.join("shooters.csv")).unwrap();
    assert!(table.starts_with(
        "shooter,shots,made,place,distance_ft,court_angle_deg,release_height_ft,probability,low,high,"
    ));
    assert_eq!(table.lines().count(), 3);
    // A height for each shooter, where the file has none.
    let lacks: String = fs::read_to_string(&path)
        .unwrap()
        .lines()
        .map(|line| {
            let mut cells: Vec<&str> = line.split(',').collect();
            cells.remove(5);
            cells.join(",") + "\n"
        })
        .collect();
    let lacks = write_file(&folder, "heights.csv", &lacks);
    let with = |heights: &[&str]| {
        let flags: Vec<&str> = heights
            .iter()
            .flat_map(|h| ["--release-height", h])
            .collect();
        fit(
            lacks.to_str().unwrap(),
            &folder.path().join("of_heights"),
            &flags,
        )
    };
    with(&["Ann=7 ft"])
        .exits(2)
        .says("--release-height gives none for Bob");
    with(&["Ann=7 ft", "Bib=7 ft", "6 ft"])
        .exits(2)
        .says("has no shooter \"Bib\" for --release-height; it has Ann, Bob");
    with(&["6 ft", "7 ft"]).exits(2).says("is given twice");
    with(&["Ann=7 ft", "6.8 ft"]).exits(0);
    let table = fs::read_to_string(folder.path().join("of_heights/shooters.csv")).unwrap();
    let height = |row: usize| table.lines().nth(row).unwrap().split(',').nth(6).unwrap();
    assert_eq!((height(1), height(2)), ("7.000", "6.800"));
    // One of them, by name.
    let one = folder.path().join("one");
    let answer = fit(path.to_str().unwrap(), &one, &["--shooter", "Ann"]).exits(0);
    assert!(
        answer.stdout().contains("from 30 measured shots") && answer.stdout().contains("\nAnn: "),
        "{}",
        answer.stdout()
    );
    let sessions = Answer::of(bankshot().arg("compare-sessions").arg(&path));
    sessions
        .exits(2)
        .says("has no column session: say which column it is with --map 'session=COLUMN'");
    fit(path.to_str().unwrap(), &one, &["--shooter", "Cy"])
        .exits(2)
        .says("has no shooter \"Cy\"; it has Ann, Bob");
    // Two players as two sessions: P differs by no more than luck, one angle by more.
    let sessions = fs::read_to_string(&path)
        .unwrap()
        .replacen("shooter", "session", 1);
    fs::write(&path, sessions).unwrap();
    let compared = Answer::of(bankshot().arg("compare-sessions").arg(&path).arg("--quiet"));
    let text = compared.exits(0).stdout().to_owned();
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    // Form of the day alone can do that.
    assert!(
        text.contains("before    Ann, 30 shots, ")
            && text.starts_with("No change shown: ")
            && !words.contains("changed: the angle"),
        "{text}"
    );
}

/// Several shooters or sessions in one file: pairs of sessions, the folder of all, its units.
#[test]
fn contract_a_file_of_several_shooters_and_sessions_is_one_command_each() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let write = |name: &str, columns: &str, of_row: &dyn Fn(usize) -> String| {
        let mut all = format!("{header},{columns}\n");
        for (i, row) in rows.lines().enumerate() {
            all += &format!("{row},{}\n", of_row(i));
        }
        let path = folder.path().join(name);
        fs::write(&path, all).unwrap();
        path
    };
    let compare = |path: &Path, sessions: &[&str]| {
        let mut command = bankshot();
        command.arg("compare-sessions").arg(path).arg("--quiet");
        Answer::of(command.args(sessions.iter().flat_map(|name| ["--session", name])))
    };
    let season = write("season.csv", "session", &|i| {
        ["May", "June", "July"][i / 20].to_owned()
    });
    compare(&season, &[])
        .exits(2)
        .says("has 3 sessions (May, June, July); choose two with --session");
    compare(&season, &["May"])
        .exits(2)
        .says("name two sessions");
    compare(&season, &["May", "March"])
        .exits(2)
        .says("has no session March; it has May, June, July");
    let pair = compare(&season, &["July", "May"]).exits(0);
    assert!(
        pair.stdout().contains("before    July, 20 shots"),
        "{pair:?}"
    );
    // One session alone is what a file of it alone is.
    let kept = |row: &&str| row.ends_with("session") || row.ends_with(",June");
    let june: String = fs::read_to_string(&season)
        .unwrap()
        .lines()
        .filter(kept)
        .map(|row| format!("{row}\n"))
        .collect();
    let june = write_file(&folder, "june.csv", june);
    let parameters = |path: &Path, flags: &[&str]| {
        let flags = [&["--json"], flags].concat();
        let out = folder.path().join(format!("sessions-{}", flags.len()));
        fit(path.to_str().unwrap(), &out, &flags).exits(0).json()["parameters"].clone()
    };
    assert_eq!(
        parameters(&june, &[]),
        parameters(&season, &["--session", "June"])
    );
    let refused = |path: &Path, session: &str| {
        let out = folder.path().join("refused");
        fit(path.to_str().unwrap(), &out, &["--session", session]).exits(2)
    };
    refused(&season, "March").says("has no session March; it has May, June, July");
    refused(Path::new("docs/data/lab.csv"), "May").says("has no column session");
    refused(Path::new("configs/free_throw.toml"), "May")
        .says("is a profile or a sweep, not measured shots");
    let team = write("team.csv", "shooter,session", &|i| {
        format!("{},{}", ["Ann", "Bob"][i % 2], ["May", "June"][i / 30])
    });
    let both = compare(&team, &[]).exits(0);
    let text = both.stdout();
    assert!(
        text.starts_with("Ann\n") && text.contains("\nBob\n"),
        "{text}"
    );
    assert!(text.contains("Counting makes alone: "), "{text}");
    // One of them has one session: the other is still compared.
    let partial = write("partial.csv", "shooter,session", &|i| {
        let session = if i < 22 { "May" } else { "June" };
        format!("{},{session}", if i < 44 { "Ann" } else { "Bob" })
    });
    let one = compare(&partial, &[]).exits(3);
    assert!(one.stdout().starts_with("Ann\n"), "{one:?}");
    one.says("Bob: ").says("has one session, June");
    let out = folder.path().join("out");
    fit(team.to_str().unwrap(), &out, &["--units", "metric"]).exits(0);
    for name in ["ann", "bob"] {
        make_search_small(&out.join(name));
    }
    let mut advise = bankshot();
    let answer = Answer::of(advise.arg("advise").arg(&out).arg("--quiet")).exits(0);
    let text = answer.stdout();
    assert!(
        text.starts_with("Ann\n") && text.contains("\nBob\n"),
        "{text}"
    );
    // In the units of the fit.
    assert!(text.contains(" m/s ") && !text.contains("ft/s"), "{text}");
    let mut design = bankshot();
    Answer::of(design.arg("design").arg(&out))
        .exits(2)
        .says("has a fit for each shooter; name one");
}

/// One ring for two shooters: the likelihood of both together is the product of theirs.
#[test]
fn contract_a_ring_is_told_by_the_makes_of_all_shooters() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/gym_sensor.csv").unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let mut several = format!("{header},shooter\n");
    for (k, row) in rows.lines().enumerate() {
        several += &format!("{row},{}\n", ["Ann", "Bob"][k % 2]);
    }
    let path = write_file(&folder, "two.csv", several);
    let free = |out: &str, flags: &[&str]| {
        let flags = [&["--free", "hoop_restitution"], flags].concat();
        fit(path.to_str().unwrap(), &folder.path().join(out), &flags)
    };
    let both = free("both", &[]).exits(0);
    let text = both.stdout().replace('\n', " ");
    assert!(text.contains("shots of 2 shooters together"), "{text}");
    let read = |path: &str| -> serde_json::Value {
        serde_json::from_slice(&fs::read(folder.path().join(path)).unwrap()).unwrap()
    };
    let together = read("both/shooters.json")["free"][0].clone();
    let interval = |of: &serde_json::Value| {
        let [low, high] = ["low", "high"].map(|end| of[end].as_f64().unwrap());
        (low, high)
    };
    let each = ["Ann", "Bob"].map(|name| {
        free(name, &["--shooter", name]).exits(0);
        interval(&read(&format!("{name}/fit.json"))["free"][0])
    });
    // Together they know it better than the one who knows it less.
    let (low, high) = interval(&together);
    let widest = each
        .iter()
        .map(|(low, high)| high - low)
        .fold(0.0, f64::max);
    assert!(high - low < widest && high > low, "{together} {each:?}");
    // A backspin is each shooter's own.
    fit(
        path.to_str().unwrap(),
        &folder.path().join("spin"),
        &["--free", "backspin"],
    )
    .exits(2)
    .says("choose one with --shooter NAME");
}

/// P along the pitch of a fitted shot is as uncertain as P of the fit, where the shot is the usual
/// one; a speed that is given is exact.
#[test]
fn contract_vary_has_the_uncertainty_of_the_usual_shot() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("fit");
    fit("docs/data/gym_sensor.csv", &out, &[]).exits(0);
    let json: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("fit.json")).unwrap()).unwrap();
    let parameters = json["parameters"].as_array().unwrap();
    let mean = |name: &str| {
        let found = parameters.iter().find(|of| of["name"] == name).unwrap();
        found["mean"].as_f64().unwrap()
    };
    let width = |flags: &[&str]| {
        let mut command = bankshot();
        command
            .arg("probability")
            .arg(&out)
            .arg("--draws")
            .arg(&out);
        let pitch = format!("pitch={} deg", mean("pitch_mean"));
        command.args(["--vary", &pitch, "--json", "--quiet"]);
        let json = Answer::of(command.args(flags)).exits(0).json();
        let p = json["points"][0]["over_draws"]["probability"].clone();
        p["high"].as_f64().unwrap() - p["low"].as_f64().unwrap()
    };
    let p = &json["probability"];
    let of_fit = p["high"].as_f64().unwrap() - p["low"].as_f64().unwrap();
    let own = width(&[]);
    let speed = format!("{} ft/s", mean("speed_mean"));
    let exact = width(&["--speed", &speed]);
    assert!(
        own > exact && own > 0.8 * of_fit && own < 1.2 * of_fit,
        "{own} {exact} {of_fit}"
    );
}

/// A sensor that tells speeds beside the landings: what it says more than they give is said.
#[test]
fn contract_speeds_beside_landings_are_compared_with_them() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let plain = fit("docs/data/gym_sensor.csv", &out, &["--json"])
        .exits(0)
        .json();
    let mean = |fit: &serde_json::Value, name: &str| {
        let listed = fit["parameters"].as_array().unwrap();
        let found = listed.iter().find(|parameter| parameter["name"] == name);
        found.unwrap()["mean"].as_f64().unwrap()
    };
    let speed_ft_s = mean(&plain, "speed_mean");
    let text = fs::read_to_string("docs/data/gym_sensor.csv").unwrap();
    let mut lines = text.lines();
    let mut with_speed = format!("{},speed_ft_s\n", lines.next().unwrap());
    for line in lines {
        with_speed += &format!("{line},{:.3}\n", speed_ft_s + 0.5);
    }
    let path = folder.path().join("with_speed.csv");
    fs::write(&path, with_speed).unwrap();
    let answer = fit(path.to_str().unwrap(), &out, &["--json"])
        .exits(0)
        .json();
    let found = &answer["measured_minus_from_landings"][0];
    assert!(
        (found["mean"]["value"].as_f64().unwrap() - 0.5).abs() < 0.05,
        "{found}"
    );
    assert_eq!(found["mean"]["unit"], "ft/s");
    assert_eq!(answer["parameters"], plain["parameters"]);
    let said = fit(path.to_str().unwrap(), &out, &["--details"]).exits(0);
    assert!(
        said.stdout().contains("Column speed_ft_s: +0."),
        "{}",
        said.stdout()
    );
}

/// What was measured stays the same under each physics: how the ball falls to the hoop.
#[test]
fn contract_the_advice_is_told_under_each_physics() {
    let folder = TempDir::new().unwrap();
    // With the ring of the preset, and without results: those would say another ring under each.
    let text = fs::read_to_string("docs/data/gym_sensor.csv").unwrap();
    let without: Vec<&str> = text
        .lines()
        .map(|line| line.rsplit_once(',').unwrap().0)
        .collect();
    let shots = write_file(&folder, "without.csv", without.join("\n"));
    let shots = shots.to_str().unwrap();
    fit(shots, folder.path(), &["--ring", "0.6"]).exits(0);
    let profile = folder.path().join("profile.toml");
    let text = fs::read_to_string(&profile).unwrap();
    // The backspin was not measured, and is kept.
    let choice = "choose = [\"speed\", \"pitch\", \"polar\"]\n";
    assert!(text.contains(choice), "{text}");
    let quick = "standard_error = 0.01\nchoose = [\"speed\"]\n";
    fs::write(&profile, text.replace(choice, quick)).unwrap();
    let physics = |extra: &[&str]| {
        let mut command = bankshot();
        command.arg("physics").arg(folder.path()).args(extra);
        Answer::of(command.args(["--json", "--quiet"]))
    };
    physics(&["--place", "2"])
        .exits(2)
        .says("--place 2: there is one place");
    let answer = physics(&[]).exits(0).json();
    let row = |name: &str| {
        let mut rows = answer["rows"].as_array().unwrap().iter();
        let row = rows.find(|row| row["physics"].as_str().unwrap().ends_with(name));
        row.unwrap_or_else(|| panic!("{name}"))["fit"].clone()
    };
    let usual = |name: &str| row(name)["current_probability"]["mean"].as_f64().unwrap();
    // The profile's own physics is that of the fit, a preset.
    assert!((usual("the profile's") - usual("ncaa")).abs() < 1e-6);
    // A release that was taken for higher than it is makes other speeds, and the same landings.
    let lower = usual("release 0.1 ft lower");
    assert!((lower - usual("ncaa")).abs() < 0.01, "{lower}");
    // Where the flight is another one, aim and scatter are those that give the same landings.
    let in_vacuum = fit(
        shots,
        &folder.path().join("vacuum"),
        &["--physics", "paper", "--json"],
    );
    let in_vacuum = in_vacuum.exits(0).json();
    let fitted = in_vacuum["probability"]["mean"]
        .as_f64()
        .or_else(|| in_vacuum["probability"][0]["mean"].as_f64())
        .unwrap();
    let in_paper = usual("paper");
    assert!((in_paper - fitted).abs() < 0.007, "{in_paper} {fitted}");
    // A soft ring holds more shots than a hard one.
    assert!(usual("ring restitution 0.41") > usual("ring restitution 0.70") + 0.02);
}

/// Counts of places, without any flight: P is near the share that went in, another place has its
/// own, and `best`, `advise` and `sample-size` take the fit. A row with more makes than attempts is
/// kept out.
#[test]
fn contract_makes_alone_are_a_fit() {
    let folder = TempDir::new().unwrap();
    let counts = write_file(
        &folder,
        "counts.csv",
        "place,attempts,makes\nfree throw,100,72\nleft elbow,60,35\nright wing,3,4\n",
    );
    let out = folder.path().join("counted");
    let height = ["--release-height", "7 ft", "--json"];
    let answer = fit(counts.to_str().unwrap(), &out, &height);
    let answer = answer.exits(3).says("has 4 makes of 3 attempts").json();
    let places = answer["places"].as_array().unwrap();
    let p = |place: usize| places[place]["probability"]["mean"].as_f64().unwrap();
    assert!(
        (p(0) - 0.72).abs() < 0.05 && (p(1) - 0.58).abs() < 0.07,
        "{answer}"
    );
    assert_eq!(answer["source"]["kind"], "makes");
    assert_eq!(places[0]["name"], "free throw");
    make_search_small(&out);
    let advise = Answer::of(bankshot().arg("advise").arg(&out));
    let advise = advise.exits(0);
    assert!(advise.stdout().contains("Keep your release"));
    let profile = out.join("profile.toml");
    let best = Answer::of(
        bankshot()
            .arg("best")
            .arg(&profile)
            .args(["--json", "--out"])
            .arg(folder.path().join("best")),
    );
    let best = best.exits(0).json();
    let p_of_best = best["direct"]["probability"].as_f64().unwrap();
    assert!((p_of_best - 0.72).abs() < 0.1, "{p_of_best}");
    let none = write_file(
        &folder,
        "none.csv",
        "place,attempts,makes\nfree throw,0,0\n",
    );
    fit(none.to_str().unwrap(), &folder.path().join("none"), &height)
        .exits(2)
        .says("has no usable shots");
    // A result in each row says the same.
    let mut rows = "place,made\n".to_owned();
    for number in 0..100 {
        rows += &format!("free throw,{}\n", u8::from(number < 72));
    }
    let rows = write_file(&folder, "rows.csv", rows);
    let of_rows = fit(rows.to_str().unwrap(), &folder.path().join("rows"), &height)
        .exits(0)
        .json();
    let of_rows = of_rows["probability"]["mean"].as_f64().unwrap();
    assert!((of_rows - 0.72).abs() < 0.04, "{of_rows}");
}

/// What the makes of each ball say of a physics: the fit's own z in the first row, and no range
/// with what is more than 3 standard deviations away.
#[test]
fn contract_the_makes_rule_out_a_physics() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("lab");
    let with_ring = ["--json", "--ring", "0.6"];
    let fitted = fit("docs/data/lab.csv", &out, &with_ring).exits(0).json();
    let own_z = fitted["prediction"]["made_z"].as_f64().unwrap();
    make_search_small(&out);
    let physics = |more: &[&str]| {
        let mut command = bankshot();
        command.arg("physics").arg(&out).arg("--quiet").args(more);
        Answer::of(&mut command).exits(0)
    };
    let rows = physics(&["--json"]).json();
    let rows = rows["rows"].as_array().unwrap();
    let z = |row: &serde_json::Value| row["fit"]["made_z"].as_f64().unwrap();
    // But for errors of each value alone.
    assert!((z(&rows[0]) - own_z).abs() < 0.3, "{} {own_z}", z(&rows[0]));
    let text = physics(&[]);
    let words = text.stdout().split_whitespace().collect::<Vec<_>>();
    let words = words.join(" ");
    let (_, ruled_out) = words
        .split_once("The makes rule out part of the range: ")
        .unwrap();
    let (ruled_out, _) = ruled_out.split_once(". ").unwrap();
    let mut some = false;
    for row in rows {
        let name = row["physics"].as_str().unwrap();
        let is_varied = [
            "drag",
            "release",
            "restitution",
            "stiff",
            "friction",
            "lift",
        ];
        if is_varied.iter().any(|quantity| name.contains(quantity)) {
            let name = name.split_once(", ").map_or(name, |(_, change)| change);
            let name = format!("{name} (");
            let name = name.as_str();
            assert_eq!(ruled_out.contains(name), z(row).abs() > 3.0, "{name}");
            some |= z(row).abs() > 3.0;
        }
    }
    assert!(some);
}

/// Two shooters from two places. Then the same shots as those of one shooter in two sessions: the
/// first begins at one place, the second holds shots from the other alone.
#[test]
fn contract_places_of_a_shooter_are_told_apart() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let mut all = format!("{header},shooter,place\n");
    let mut sessions = format!("{header},session\n");
    for (i, row) in rows.lines().enumerate() {
        let session = i / 30;
        let is_high = session == 1 || i % 2 == 1;
        let cells: Vec<&str> = row.split(',').collect();
        let height = if is_high { "8.5" } else { "7" };
        let row = format!("{},{height},{}", cells[..5].join(","), cells[6]);
        let place = if is_high { "high post" } else { "low post" };
        all += &format!("{row},{},{place}\n", ["Ann", "Bob"][i / 2 % 2]);
        sessions += &format!("{row},{}\n", session + 1);
    }
    let path = write_file(&folder, "places.csv", &all);
    let out = folder.path().join("places-fit");
    let answer = fit(path.to_str().unwrap(), &out, &[]).exits(0);
    let table = answer.stdout();
    assert!(
        table.contains("from") && table.contains("8.50 ft high"),
        "{table}"
    );
    assert!(
        table.lines().all(|line| line.chars().count() <= 80),
        "{table}"
    );
    let csv = fs::read_to_string(out.join("shooters.csv")).unwrap();
    let rows: Vec<Vec<&str>> = csv
        .lines()
        .skip(1)
        .map(|row| row.split(',').collect())
        .collect();
    assert_eq!(rows.len(), 4, "{csv}");
    let shots: usize = rows
        .iter()
        .map(|row| row[1].parse::<usize>().unwrap())
        .sum();
    assert_eq!(shots, 60);
    assert_eq!((rows[0][3], rows[1][3]), ("low post", "high post"));
    for name in ["ann", "bob"] {
        make_search_small(&out.join(name));
    }
    let mut advise = bankshot();
    advise.arg("advise").arg(out.join("ann"));
    let brief = Answer::of(advise.args(["--brief", "--quiet"])).exits(0);
    let brief = brief.stdout();
    assert!(
        brief.starts_with("low post: 13.75 ft from ") && brief.contains("\nhigh post: 13.75 ft "),
        "{brief}"
    );
    assert!(
        brief.contains("No advice yet: 23 of 30 went in") && !brief.contains("current"),
        "{brief}"
    );
    assert_eq!(rows[0][6], "7.000");
    assert_eq!(rows[1][6], "8.500");
    assert_ne!(rows[0][7], rows[1][7]);
    let shots = fs::read_to_string(out.join("ann").join("shots.csv")).unwrap();
    assert!(shots.starts_with("row,session,place,"));
    // Each place has its profile and its plots.
    let read = |name: &str| fs::read_to_string(out.join("ann").join(name)).unwrap();
    let own = "release_height = \"8.5000 ft\"";
    assert!(!read("profile.toml").contains(own) && read("profile_place_2.toml").contains(own));
    assert!(read("plots/make_zone_place_2.svg").contains("place 2"));
    let mut command = bankshot();
    Answer::of(
        command
            .arg("check")
            .arg(out.join("ann/profile_place_2.toml")),
    )
    .exits(0);
    // A team at the second place of each.
    let mut command = bankshot();
    command
        .arg("team")
        .arg(&out)
        .args(["--place", "2", "--quiet"]);
    let second = Answer::of(&mut command).exits(0);
    assert!(second.stdout().contains("Ann") && second.stdout().contains("Bob"));
    let mut command = bankshot();
    command.arg("team").arg(&out).args(["--place", "3"]);
    Answer::of(&mut command)
        .exits(2)
        .says("profile_place_3.toml");
    // A later fit of one shooter, from one place, renews that shooter's rows and files alone.
    write_file(&folder, "places.csv", all.replace(",8.5,", ",7,"));
    let (ann, flags) = (out.join("ann"), ["--shooter", "Ann"]);
    fit(path.to_str().unwrap(), &ann, &flags).exits(0);
    let renewed = fs::read_to_string(out.join("shooters.csv")).unwrap();
    let names: Vec<&str> = renewed.lines().map(|row| &row[..3]).collect();
    assert_eq!(names, ["sho", "Ann", "Bob", "Bob"], "{renewed}");
    assert_eq!(renewed.lines().last(), csv.lines().last());
    assert!(!ann.join("profile_place_2.toml").exists());
    assert!(!ann.join("plots/make_zone_place_2.svg").exists());
    // A folder of fits is a team.
    let mut command = bankshot();
    let team = Answer::of(command.arg("team").arg(&out).arg("--quiet")).exits(0);
    assert!(team.stdout().contains("Ann") && team.stdout().contains("Bob"));
    // How sure the better kind is, of the draws.
    let is_told =
        |line: &str| line.contains("Ann") && line.contains("direct ") && line.contains(" %");
    assert!(team.stdout().lines().any(is_told), "{team:?}");
    // The place that both sessions have is compared: P of the second session is that of a fit of it
    // alone.
    let sessions = write_file(&folder, "sessions.csv", &sessions);
    let compare = |more: &[&str]| {
        let mut command = bankshot();
        Answer::of(command.arg("compare-sessions").arg(&sessions).args(more))
    };
    let compared = compare(&[]).exits(0);
    let words = compared.stdout().split_whitespace();
    let words = words.collect::<Vec<_>>().join(" ");
    assert!(
        words.starts_with("Shots from 2 places: makes, speed and direction are for place 1, ")
            && words.contains("released 8.50 ft high"),
        "{words}"
    );
    assert!(!compared.stderr.contains("from different places"));
    compare(&["--place", "2"])
        .exits(2)
        .says("there is one place");
    // What follows from a fit's profile, and what does not.
    let profile = out.join("ann").join("profile.toml");
    let json: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(out.join("ann").join("fit.json")).unwrap())
            .unwrap();
    let warnings = json["notes"].as_array().unwrap();
    let mut command = bankshot();
    let checked = Answer::of(command.arg("check").arg(&profile)).exits(0);
    assert_eq!(
        checked.stderr.matches("its fit warned: ").count(),
        warnings.len(),
        "{}",
        checked.stderr
    );
}

/// A fit's warnings are said again where its profile is used.
#[test]
fn contract_warnings_of_a_fit_follow_its_profile() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    // Nobody makes every shot with these releases.
    let mut lines = text.lines();
    let mut made = format!("{}\n", lines.next().unwrap());
    for (i, line) in lines.enumerate() {
        let (rest, _) = line.rsplit_once(',').unwrap();
        made += &format!("{rest},{}\n", u8::from(i > 0));
    }
    let path = write_file(&folder, "made.csv", &made);
    let out = folder.path().join("made-fit");
    let answer = fit(path.to_str().unwrap(), &out, &[]).exits(0);
    assert!(
        answer
            .stdout()
            .contains("59 of 60 went in, but the measured shots"),
        "{answer:?}"
    );
    make_search_small(&out);
    // Advice that the makes contradict begins with that.
    let mut advise = bankshot();
    Answer::of(advise.arg("advise").arg(&out).arg("--quiet"))
        .exits(0)
        .prints("No advice yet: 59 of 60 went in");
    let mut command = bankshot();
    command.arg("team").arg(out.join("profile.toml"));
    Answer::of(&mut command)
        .exits(0)
        .says("its fit warned: 59 shots went in, but the measured");
    // The usual shot cannot have more backspin than the player can give.
    let profile = fs::read_to_string(out.join("profile.toml")).unwrap();
    let lowered: String = profile
        .lines()
        .map(|line| match line.split_once(" = ") {
            Some(("max_backspin" | "backspin", value))
                if value.contains("rev/s") && !line.contains("_sd") =>
            {
                line.split(" = ").next().unwrap().to_owned() + " = \"1.5 rev/s\"\n"
            }
            _ => format!("{line}\n"),
        })
        .collect();
    fs::write(out.join("profile.toml"), lowered).unwrap();
    let mut advise = bankshot();
    Answer::of(advise.arg("advise").arg(&out).arg("--quiet"))
        .exits(2)
        .says("max_backspin is 1.50 rev/s")
        .says("fit them again with --backspin '1.50 rev/s'");
}

/// One place, with a coarse search.
const ONE_PLACE: &str = r#"
[sweep]
name = "one place"
shooter = "any.toml"
court = "ncaa"
compute = ["direct", "bank"]
region = "arcs"
distances = ["10 ft"]
angles = ["0 deg", "40 deg"]
angle_step = "40 deg"
[grid]
speed = 16
pitch = 10
polar = 10
backspin = 3
[search]
standard_error = 0.01
"#;

/// The row of a measured player on the page of a team is the advice in short.
#[test]
fn contract_the_row_of_a_player_is_the_advice() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("ann");
    fit("docs/data/lab.csv", &out, &[]).exits(0);
    make_search_small(&out);
    write_file(&folder, "place.toml", ONE_PLACE);
    let mut team = bankshot();
    team.current_dir(folder.path());
    team.args(["team", "ann", "--sweep", "place.toml", "--out", "team"]);
    Answer::of(team.arg("--quiet")).exits(0);
    let page = fs::read_to_string(folder.path().join("team/team.html")).unwrap();
    let cell = |name: &str| {
        let start = format!("data-label=\"{name}\"><span><span class=\"entry\">");
        let from = page.split_once(&start);
        let (text, _) = from.unwrap().1.split_once("</span>").unwrap();
        text.replace('\u{a0}', " ")
    };
    let advise = Answer::of(bankshot().args(["advise", "--brief"]).arg(&out)).exits(0);
    let words = advise.stdout().split_whitespace().collect::<Vec<_>>();
    let words = words.join(" ");
    let now = cell("now");
    let (share, range) = now.split_once(" (").unwrap();
    assert!(range.contains(" to "), "{now}");
    let change = cell("change");
    let (change, first) = change.split_once("; ").unwrap_or((&change, ""));
    let can = cell("after");
    let can = can.split(' ').next().unwrap();
    assert!(
        words.contains(&format!(": {can} of 100 instead of {share}.")),
        "{can}: {words}"
    );
    let said = words.to_lowercase();
    for part in change.split(", ") {
        assert!(said.contains(part), "{change}: {words}");
    }
    assert!(
        first.contains("together") == said.contains("change both together"),
        "{first}: {words}"
    );
    let train = cell("train");
    let (value, _) = train.split_once(' ').unwrap_or((&train, ""));
    assert!(
        words.contains(&format!("train the {}", value.trim_end_matches(','))),
        "{train}: {words}"
    );
}

/// The page of a fit gets the advice, and once only.
#[test]
fn contract_a_report_of_a_fit_has_the_advice() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("fit");
    fit("docs/data/gym_sensor.csv", &out, &[]).exits(0);
    let page = || fs::read_to_string(out.join("report.html")).unwrap();
    assert!(!page().contains("What to change"));
    let report = || Answer::of(bankshot().arg("report").arg(&out).arg("--quiet"));
    report().exits(0);
    let once = page();
    assert_eq!(once.matches("What to change").count(), 1);
    assert!(once.contains("10 % less scatter"));
    report().exits(0);
    assert_eq!(page(), once);
    // A folder that holds runs is not one.
    Answer::of(bankshot().arg("report").arg(folder.path()))
        .exits(2)
        .says("name a run in it");
}
