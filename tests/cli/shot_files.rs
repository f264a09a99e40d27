//! Measured shots in the forms that people have them: one made-up player's 125 landings in many
//! dialects give the fit of the clean file, and what cannot be read has one clear message.
//!
//! Authority: the fit of `docs/data/gym_sensor.csv`, whose columns have the names and units of the
//! documentation.

use crate::support::{Answer, bankshot};
use encoding_rs::{UTF_16LE, WINDOWS_1252};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// A shot as the clean file has it.
#[derive(Clone, Debug)]
struct Shot {
    entry_deg: f64,
    depth_in: f64,
    right_in: f64,
    made: bool,
    /// Days since the first session.
    day: usize,
}

fn shots() -> Vec<Shot> {
    let text = fs::read_to_string("docs/data/gym_sensor.csv").unwrap();
    let rows: Vec<Vec<&str>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect();
    let count = rows.len();
    let shot = |(number, cells): (usize, &Vec<&str>)| Shot {
        entry_deg: cells[1].parse().unwrap(),
        depth_in: cells[2].parse().unwrap(),
        right_in: cells[3].parse().unwrap(),
        made: cells[6] == "1",
        day: 5 * number / count,
    };
    rows.iter().enumerate().map(shot).collect()
}

/// A table with a row for each shot.
fn table(header: &str, row: impl Fn(usize, &Shot) -> String) -> String {
    let mut text = format!("{header}\n");
    for (number, shot) in shots().iter().enumerate() {
        writeln!(text, "{}", row(number + 1, shot)).unwrap();
    }
    text
}

/// The clean file without its place, and with another column of results.
fn with_result(name: &str, result: impl Fn(usize, &Shot) -> String) -> String {
    table(
        &format!("shot,entry_angle_deg,depth_in,left_right_in,{name}"),
        |number, s| {
            let [entry, depth, right] = [s.entry_deg, s.depth_in, s.right_in];
            format!("{number},{entry},{depth},{right},{}", result(number, s))
        },
    )
}

fn word(made: bool, words: [&str; 2]) -> String {
    words[usize::from(!made)].to_owned()
}

/// Runs `fit` on a file, from the free-throw line.
fn fit(file: &Path, options: &[&str]) -> (Answer, PathBuf) {
    let out = file.with_extension("fit");
    let mut command = bankshot();
    command
        .arg("fit")
        .arg(file)
        .arg("-o")
        .arg(&out)
        .arg("--quiet");
    command.args(["--release-height", "7 ft"]).args(options);
    (Answer::of(&mut command), out)
}

const AT_THE_LINE: [&str; 2] = ["--at", "free throw"];

/// P of the current shot of a fit, and the number of shots with a result.
fn probability(folder: &Path) -> (f64, u64) {
    let text = fs::read_to_string(folder.join("fit.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let shots = json["observed"]["shots"].as_u64().unwrap();
    (json["probability"]["mean"].as_f64().unwrap(), shots)
}

/// P of the clean file.
fn clean() -> f64 {
    static CLEAN: OnceLock<f64> = OnceLock::new();
    *CLEAN.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("clean.csv");
        fs::copy("docs/data/gym_sensor.csv", &file).unwrap();
        let out = folder.path().join("fit");
        let mut command = bankshot();
        command
            .arg("fit")
            .arg(&file)
            .arg("-o")
            .arg(&out)
            .arg("--quiet");
        Answer::of(&mut command).exits(0);
        probability(&out).0
    })
}

/// Fits a file of these bytes, which must give the P of the clean file.
fn gives_the_clean_fit(name: &str, bytes: &[u8], options: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    fs::write(&file, bytes).unwrap();
    let (answer, out) = fit(&file, options);
    assert_eq!(answer.code, Some(0), "{name}: {answer:?}");
    let (p, _) = probability(&out);
    // Which shots went in is the same to the last one.
    let made = |out: &Path| {
        let text = fs::read_to_string(out.join("fit.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&text).unwrap();
        json["observed"]["made"].as_u64().unwrap()
    };
    let all = shots().iter().filter(|shot| shot.made).count();
    assert_eq!(made(&out), all as u64, "{name}");
    // Numbers that were rounded in another unit turn single simulated shots.
    assert!((p - clean()).abs() < 1e-3, "{name}: {p} for {}", clean());
}

/// A file of these bytes is refused with a message that has all of these parts.
fn is_refused(name: &str, bytes: &[u8], options: &[&str], parts: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join(name);
    fs::write(&file, bytes).unwrap();
    let (answer, out) = fit(&file, options);
    assert_eq!(answer.code, Some(2), "{name}: {answer:?}");
    for part in parts {
        assert!(
            answer.stderr.contains(part),
            "{name}: no {part} in {}",
            answer.stderr
        );
    }
    assert!(
        answer.stderr.len() < 4000,
        "{name}: {}",
        answer.stderr.len()
    );
    let controls = answer
        .stderr
        .chars()
        .filter(|c| c.is_control() && *c != '\n');
    assert_eq!(controls.count(), 0, "{name}: {:?}", answer.stderr);
    assert!(!out.exists(), "{name}");
}

/// As [`gives_the_clean_fit`], from the free-throw line and with the proposed columns.
fn accepted(name: &str, bytes: &[u8]) {
    let options = [&AT_THE_LINE[..], &["--accept"]].concat();
    gives_the_clean_fit(name, bytes, &options);
}

fn sensor_of_an_app() -> String {
    table(
        "Shot Number,Player,Angle,Depth,Left/Right,Result,Date",
        |n, s| {
            let (entry, depth, right) = (s.entry_deg, s.depth_in, s.right_in);
            let result = word(s.made, ["Made", "Missed"]);
            format!(
                "{n},Ana,{entry},{depth},{right},{result},2025-10-{}",
                13 + s.day
            )
        },
    )
}

fn german() -> String {
    let comma = |number: f64| number.to_string().replace('.', ",");
    table(
        "Schuss;Schütze;Eintrittswinkel (Grad);Tiefe (in);Links/Rechts (in);Treffer",
        |n, s| {
            let [entry, depth, right] = [s.entry_deg, s.depth_in, s.right_in].map(comma);
            let result = word(s.made, ["WAHR", "FALSCH"]);
            format!("{n};Jörg;{entry};{depth};{right};{result}")
        },
    )
}

fn with_title_and_units() -> String {
    let rows = table(
        "Shot,Entry Angle,Depth,Left Right,Made\n,deg,in,in,",
        |n, s| {
            let made = u8::from(s.made);
            format!("{n},{},{},{},{made}", s.entry_deg, s.depth_in, s.right_in)
        },
    );
    format!("Shooting report,,,,\nTeam: Wildcats,,,,\n\n{rows}")
}

/// Units and sides in the cells, a comma at the end of each line, and an empty last row.
fn with_units_in_cells() -> String {
    let mut rows = table("shot,entry_angle,depth,left_right,made,,", |n, s| {
        let side = if s.right_in < 0.0 { "L" } else { "R" };
        format!(
            "{n},{}°,\"{}\"\"\",{side} {},{},,",
            s.entry_deg,
            s.depth_in,
            s.right_in.abs(),
            u8::from(s.made)
        )
    });
    rows += ",,,,,,\n";
    rows
}

fn json_of_an_interface() -> String {
    let shots: Vec<serde_json::Value> = shots()
        .iter()
        .map(|s| {
            serde_json::json!({
                "shooter": {"name": "Ana"},
                "metrics": {"entry_angle_deg": s.entry_deg, "depth_in": s.depth_in, "left_right_in": s.right_in},
                "is_made": s.made,
            })
        })
        .collect();
    serde_json::json!({"count": shots.len(), "shots": shots}).to_string()
}

/// The clean shots as a Parquet file, compressed with zstd as polars does.
fn zstd_parquet() -> Vec<u8> {
    use parquet::basic::{Compression, ZstdLevel};
    use parquet::data_type::{BoolType, DoubleType};
    use parquet::file::properties::WriterProperties;
    use parquet::file::writer::SerializedFileWriter;
    use parquet::schema::parser::parse_message_type;
    let schema = "message shots { required double entry_angle_deg; required double depth_in; \
                  required double left_right_in; required boolean made; }";
    let schema = std::sync::Arc::new(parse_message_type(schema).unwrap());
    let zstd = Compression::ZSTD(ZstdLevel::default());
    let properties = WriterProperties::builder().set_compression(zstd).build();
    let mut bytes = Vec::new();
    let mut writer =
        SerializedFileWriter::new(&mut bytes, schema, std::sync::Arc::new(properties)).unwrap();
    let mut group = writer.next_row_group().unwrap();
    let values: [fn(&Shot) -> f64; 3] = [|s| s.entry_deg, |s| s.depth_in, |s| s.right_in];
    for value in values {
        let column: Vec<f64> = shots().iter().map(value).collect();
        let mut out = group.next_column().unwrap().unwrap();
        out.typed::<DoubleType>()
            .write_batch(&column, None, None)
            .unwrap();
        out.close().unwrap();
    }
    let made: Vec<bool> = shots().iter().map(|s| s.made).collect();
    let mut out = group.next_column().unwrap().unwrap();
    out.typed::<BoolType>()
        .write_batch(&made, None, None)
        .unwrap();
    out.close().unwrap();
    group.close().unwrap();
    writer.close().unwrap();
    bytes
}

#[test]
fn val_twelve_dialects_give_the_fit_of_the_clean_file() {
    accepted("app.csv", sensor_of_an_app().as_bytes());
    accepted(
        "events.csv",
        table(
            "shot_id,shooter_name,entry_angle,depth,left_right,is_made,timestamp",
            |n, s| {
                let time = 1_760_000_000_000_u64 + 86_400_000 * s.day as u64 + 1000 * n as u64;
                let (entry, depth, right) = (s.entry_deg, s.depth_in, s.right_in);
                format!("{n},Ana,{entry},{depth},{right},{},{time}", s.made)
            },
        )
        .as_bytes(),
    );
    accepted("german.csv", &WINDOWS_1252.encode(&german()).0);
    let mut newest_first: Vec<String> = table(
        "shot,date,entry_angle_deg,depth_in,left_right_in,made",
        |n, s| {
            let made = u8::from(s.made);
            let (entry, depth, right) = (s.entry_deg, s.depth_in, s.right_in);
            format!("{n},10/{}/2025,{entry},{depth},{right},{made}", 13 + s.day)
        },
    )
    .lines()
    .map(str::to_owned)
    .collect();
    newest_first[1..].reverse();
    accepted("us.csv", newest_first.join("\n").as_bytes());
    accepted("title.csv", with_title_and_units().as_bytes());
    accepted(
        "workbook.xlsx",
        &fs::read("docs/data/gym_sensor.xlsx").unwrap(),
    );
    let wide: Vec<u8> = with_result("made", |_, s| u8::from(s.made).to_string())
        .replace(',', "\t")
        .encode_utf16()
        .flat_map(u16::to_le_bytes)
        .collect();
    accepted("utf16.csv", &[b"\xff\xfe".to_vec(), wide].concat());
    accepted("polars.parquet", &zstd_parquet());
    let gaps = with_result("made", |n, s| match n % 10 {
        4 => String::new(),
        _ => word(s.made, ["1.0", "0.0"]),
    });
    // Fewer results tell less of the ring: P is not the same, but near.
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("gaps.csv");
    fs::write(&file, gaps).unwrap();
    let options = [&AT_THE_LINE[..], &["--accept"]].concat();
    let (answer, out) = fit(&file, &options);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let (p, _) = probability(&out);
    assert!((p - clean()).abs() < 0.02, "{p} for {}", clean());
    let words = with_result("Shot Result", |_, s| {
        word(s.made, ["Made Shot", "Missed Shot"])
    });
    accepted("words.csv", words.as_bytes());
    let places = with_result("Spot,made", |_, s| {
        format!("Free Throw,{}", u8::from(s.made))
    });
    gives_the_clean_fit("places.csv", places.as_bytes(), &["--accept"]);
    accepted("cells.csv", with_units_in_cells().as_bytes());
    accepted("interface.json", json_of_an_interface().as_bytes());
}

/// Rows 1, 3 and 5 of the kinds of faults: what else of their kinds is read.
#[test]
fn contract_common_forms_of_cells_are_read() {
    for pair in [
        ["successful", "unsuccessful"],
        ["vrai", "faux"],
        ["good", "bad"],
        ["T", "F"],
    ] {
        let text = with_result("made", |_, s| word(s.made, pair));
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("words.csv");
        fs::write(&file, text.lines().take(40).collect::<Vec<_>>().join("\n")).unwrap();
        let (answer, out) = fit(&file, &AT_THE_LINE);
        assert_eq!(answer.code, Some(0), "{pair:?} {answer:?}");
        assert_eq!(probability(&out).1, 39, "{pair:?}");
    }
    let semicolons = with_result("made", |_, s| u8::from(s.made).to_string()).replace(',', ";");
    gives_the_clean_fit(
        "semicolons.csv",
        (semicolons + ";;;;;\n;;;;\n").as_bytes(),
        &AT_THE_LINE,
    );
    let remarks = with_result("made", |_, s| u8::from(s.made).to_string());
    gives_the_clean_fit(
        "remarks.csv",
        format!(
            "sep=,\r\n# written by a sensor\r\n{}",
            remarks.replace('\n', "\r\n")
        )
        .as_bytes(),
        &AT_THE_LINE,
    );
}

/// What would be guessed is asked, with what to type.
#[test]
fn contract_open_questions_are_asked() {
    let commas = table(
        "shot,entry_angle_deg,depth_in,left_right_in,made",
        |n, s| {
            let comma = |number: f64| format!("{number:.1}").replace('.', ",");
            let [entry, depth, right] = [s.entry_deg, s.depth_in, s.right_in].map(comma);
            format!("{n},{entry},{depth},{right},{}", u8::from(s.made))
        },
    );
    is_refused(
        "commas.csv",
        commas.as_bytes(),
        &AT_THE_LINE,
        &["decimal commas?"],
    );
    for (pair, part) in [
        (["x", ""], "column made has x and blanks (36 rows)"),
        (["1", ""], "--made '1'"),
        (
            ["erfolgreich", "nichts"],
            "column made has erfolgreich, nichts",
        ),
    ] {
        let text = with_result("made", |_, s| word(s.made, pair));
        is_refused(
            "results.csv",
            text.as_bytes(),
            &AT_THE_LINE,
            &[part, "--made"],
        );
    }
    let x = with_result("made", |_, s| word(s.made, ["x", ""]));
    let options = [&AT_THE_LINE[..], &["--made", "x"]].concat();
    gives_the_clean_fit("x.csv", x.as_bytes(), &options);
    // Several places, several players.
    let spots = with_result("place", |n, _| {
        word(n % 2 == 0, ["Left Elbow", "right corner 3"])
    });
    is_refused(
        "spots.csv",
        spots.as_bytes(),
        &AT_THE_LINE,
        &["2 places", "leave it out"],
    );
    for name in ["Name", "Spieler", "Athlete", "player_id"] {
        let players = with_result(name, |n, _| format!("P{}", n % 4));
        is_refused(
            "players.csv",
            players.as_bytes(),
            &AT_THE_LINE,
            &["4 players", &format!("--map 'shooter={name}'")],
        );
    }
    let unknown = with_result("place", |_, _| "the barn".to_owned());
    is_refused(
        "barn.csv",
        unknown.as_bytes(),
        &[],
        &["125 rows", "\"the barn\" is not known"],
    );
}

/// The mapping files of the repository; the data are made up, in the form that each documents.
#[test]
fn val_mapping_files_read_the_exports_that_they_are_for() {
    let trials: Vec<String> = shots()
        .iter()
        .enumerate()
        .map(|(number, s)| {
            let trial = serde_json::json!({
                "sampling_rate": 30,
                "trial_date": format!("2024-08-{:02}", 20 + s.day),
                "participant_id": "P0001",
                "trial_id": format!("T{number:04}"),
                "result": word(s.made, ["made", "missed"]),
                "landing_x": s.right_in,
                "landing_y": s.depth_in,
                "entry_angle": s.entry_deg,
                "tracking": [{"frame": 0, "time": 0, "data": {"ball": ["NAN", "NAN", "NAN"]}}],
            });
            trial.to_string().replace("\"NAN\"", "NaN")
        })
        .collect();
    let options = [
        &AT_THE_LINE[..],
        &["--map", "@configs/exports/spl_open_data.txt"],
    ]
    .concat();
    gives_the_clean_fit("trials.json", trials.join("\n").as_bytes(), &options);
}

/// A column of players under a name that nobody knows is not pooled in silence.
#[test]
fn contract_possible_players_are_named() {
    let names = ["Ana", "Ben", "Cleo"];
    let text = with_result("Gryphon", |n, _| names[n % 3].to_owned());
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("odd.csv");
    fs::write(&file, text).unwrap();
    let out = folder.path().join("fit");
    let mut command = bankshot();
    command
        .arg("fit")
        .arg(&file)
        .arg("-o")
        .arg(&out)
        .args(AT_THE_LINE);
    let answer = Answer::of(command.args(["--release-height", "7 ft"])).exits(0);
    assert!(
        answer.stderr.contains("--map 'shooter=Gryphon'"),
        "{answer:?}"
    );
}

/// Proposals that the cells contradict are not made, and one with an open unit is not accepted.
#[test]
fn contract_proposals_follow_the_cells() {
    let text = table("Stamp of session,Angle,Entry,Depth,LR,Result", |n, s| {
        let (entry, depth, right) = (s.entry_deg, s.depth_in, s.right_in);
        format!(
            "{n}.5,{:.1},{entry},{depth},{right},{}",
            9.0 + 0.01 * n as f64,
            s.made
        )
    });
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("odd.csv");
    fs::write(&file, &text).unwrap();
    let (answer, _) = fit(&file, &AT_THE_LINE);
    assert_eq!(answer.code, Some(2), "{answer:?}");
    for part in [
        "--map 'entry_angle=Entry:deg'   (",
        "--map 'depth=Depth:in'",
        "made=Result",
    ] {
        assert!(answer.stderr.contains(part), "{answer:?}");
    }
    for part in ["=Stamp", "=Angle"] {
        assert!(!answer.stderr.contains(part), "{part} {answer:?}");
    }
    accepted("odd.csv", text.as_bytes());
    let speeds = "Release velocity,Launch angle,Aim\n24.1,51,0.2\n24.3,52,0.1\n24.0,50,-0.3\n";
    is_refused(
        "speeds.csv",
        speeds.as_bytes(),
        &["--accept"],
        &[
            "nothing says the unit of speed",
            "--map 'speed=Release velocity:ft_s'",
        ],
    );
}

/// Row 8: what is no table is named, and nothing of it reaches the terminal.
#[test]
fn contract_foreign_files_are_named() {
    for (name, bytes, part) in [
        ("shots.csv", &b"\x1f\x8b\x08\x00abc"[..], "gzip archive"),
        ("shots.zip", b"PK\x03\x04\x14\0\0\0\0\0abc", "zip archive"),
        ("ball.c3d", b"\x02\x50\x08\x00abc", "C3D file"),
        ("shots.parquet", b"PAR1\x15\x04\x15", "Parquet"),
        ("report.pdf", b"%PDF-1.7 abc", "PDF"),
        (
            "one.json",
            b"{\"a\": [1, 2], \"b\": 3}",
            "its columns are b",
        ),
        ("bad.json", b"[{\"a\": 1,", "is no JSON"),
    ] {
        is_refused(name, bytes, &AT_THE_LINE, &[part]);
    }
    let long = format!("[{{\"{}\": 1}}]", "k".repeat(200_000));
    is_refused("long.json", long.as_bytes(), &AT_THE_LINE, &["kkk..."]);
    let many: Vec<String> = (0..300).map(|k| format!("column{k}")).collect();
    let many = format!("{}\n{}\n", many.join(","), vec!["1"; 300].join(","));
    is_refused("many.csv", many.as_bytes(), &AT_THE_LINE, &["and 280 more"]);
}

/// A column of releases beside landings may hold no number at all.
#[test]
fn contract_a_speed_without_numbers_says_nothing_of_the_landings() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("shots.csv");
    let header = "shot,entry_angle_deg,depth_in,left_right_in,speed_ft_s,distance_ft,made";
    let text = table(header, |number, s| {
        let [entry, depth, right] = [s.entry_deg, s.depth_in, s.right_in];
        format!(
            "{number},{entry},{depth},{right},-,13.75,{}",
            u8::from(s.made)
        )
    });
    fs::write(&path, text).unwrap();
    let fitted = bankshot()
        .arg("fit")
        .arg(&path)
        .args(["--release-height", "7 ft", "--output"])
        .arg(folder.path().join("fit"))
        .output()
        .unwrap();
    let words = String::from_utf8_lossy(&fitted.stderr);
    assert_eq!(fitted.status.code(), Some(0), "{words}");
}

/// Row 12: frames in which the ball was not seen are dropped, not the shot. Row 17: the reasons of
/// rows that were kept out, with their counts.
#[test]
fn contract_gaps_of_a_track_and_reasons_are_told() {
    let text = fs::read_to_string("docs/data/optical_tracking.csv").unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let z = lines[0]
        .split(',')
        .position(|name| name.starts_with("z_"))
        .unwrap();
    let with_gaps: Vec<String> = lines
        .iter()
        .enumerate()
        .map(|(number, line)| {
            let mut cells: Vec<&str> = line.split(',').collect();
            // A gap in each shot.
            if number > 0 && number % 9 == 4 {
                cells[z] = if number % 2 == 0 { "" } else { "NaN" };
            }
            cells.join(",")
        })
        .collect();
    let folder = tempfile::tempdir().unwrap();
    let shots_of = |text: &str, name: &str| {
        let file = folder.path().join(name);
        fs::write(&file, text).unwrap();
        let out = file.with_extension("fit");
        let mut command = bankshot();
        command
            .arg("fit")
            .arg(&file)
            .arg("-o")
            .arg(&out)
            .arg("--quiet");
        let answer = Answer::of(&mut command);
        assert_eq!(answer.code, Some(0), "{name}: {answer:?}");
        let json = fs::read_to_string(out.join("fit.json")).unwrap();
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        (json["shots"].as_u64().unwrap(), probability(&out).0)
    };
    let (shots, p) = shots_of(&text, "whole.csv");
    let (shots_with_gaps, p_with_gaps) = shots_of(&with_gaps.join("\n"), "gaps.csv");
    assert_eq!(shots, shots_with_gaps);
    assert!((p - p_with_gaps).abs() < 0.03, "{p} {p_with_gaps}");
    let absurd = table("entry_angle_deg,depth_in,left_right_in", |n, s| {
        match n % 3 {
            0 => format!("{},900,{}", s.entry_deg, s.right_in),
            1 => format!("{},{},999", s.entry_deg, s.depth_in),
            _ => format!("{},{},{}", s.entry_deg, s.depth_in, s.right_in),
        }
    });
    is_refused(
        "absurd.csv",
        absurd.as_bytes(),
        &AT_THE_LINE,
        &[
            "83 of 125 rows",
            "42 rows, the first in row 2",
            "41 rows, the first in row 4",
        ],
    );
}

/// Row 14: cameras at the side see no direction; it is the population's, and says so.
#[test]
fn contract_a_direction_that_nobody_measured_is_assumed() {
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let header: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let polar = header
        .iter()
        .position(|name| name.starts_with("polar") || name.starts_with("aim"))
        .unwrap();
    let lines: Vec<String> = text
        .lines()
        .map(|line| {
            let mut cells: Vec<&str> = line.split(',').collect();
            cells.remove(polar);
            cells.join(",")
        })
        .collect();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("side.csv");
    fs::write(&file, lines.join("\n")).unwrap();
    let out = folder.path().join("fit");
    let mut command = bankshot();
    command
        .arg("fit")
        .arg(&file)
        .arg("-o")
        .arg(&out)
        .arg("--quiet");
    let answer = Answer::of(&mut command).exits(0);
    assert!(
        answer.stdout().contains("The direction was not measured"),
        "{answer:?}"
    );
    let json = fs::read_to_string(out.join("fit.json")).unwrap();
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    let parameter = |name: &str| {
        let all = json["parameters"].as_array().unwrap();
        all.iter().find(|one| one["name"] == name).unwrap().clone()
    };
    assert_eq!(parameter("polar_sd")["source"], "assumed");
    assert_eq!(parameter("speed_sd")["source"], "measured");
    // As wide as what is known of shooters: a factor of two to each side, and more.
    let (low, high) = (
        &parameter("polar_sd")["low"],
        &parameter("polar_sd")["high"],
    );
    assert!(
        high.as_f64().unwrap() > 6.0 * low.as_f64().unwrap(),
        "{low} {high}"
    );
    // The folder is read back, and nothing of the direction is suggested.
    let mut advise = bankshot();
    let advice = Answer::of(advise.arg("advise").arg(&out).args(["--json", "--quiet"])).exits(0);
    let causes = advice.json()["causes"].to_string();
    assert!(!causes.contains("\"aim\""), "{causes}");
}

/// Row 18: `simulate` and the places of a sweep read what `fit` reads.
#[test]
fn contract_one_reader_for_all() {
    let folder = tempfile::tempdir().unwrap();
    let releases = "\
distance_ft;court_angle_deg;release_height_ft;speed_ft_s;pitch_deg;polar_deg;backspin_rev_s
13,75;0;7;23,5;52;0;0
13,75;0;7;22,0;52;0;3
;;;;;;
";
    let outcomes = |name: &str, bytes: &[u8]| {
        let file = folder.path().join(name);
        fs::write(&file, bytes).unwrap();
        let mut command = bankshot();
        command
            .arg("simulate")
            .arg(&file)
            .args(["-o", "-", "--quiet"]);
        let answer = Answer::of(&mut command).exits(0);
        answer.stdout().to_owned()
    };
    let points = releases.replace(',', ".").replace(';', ",");
    let expected = outcomes("points.csv", points.as_bytes());
    assert_eq!(expected.lines().count(), 3, "{expected}");
    assert_eq!(outcomes("commas.csv", releases.as_bytes()), expected);
    assert_eq!(outcomes("wide.csv", &utf16(releases)), expected);
    let titled = format!("Releases of Monday\n\n{releases}");
    assert_eq!(outcomes("titled.csv", titled.as_bytes()), expected);
    // Places of a sweep with semicolons, and by their names.
    fs::write(
        folder.path().join("places.csv"),
        "name;x_ft;y_ft\nelbow;13,75;6\n",
    )
    .unwrap();
    let sweep = |region: &str| {
        let text = fs::read_to_string("configs/quick_sweep.toml").unwrap();
        let start = text.find("region").unwrap();
        let end = text[start..]
            .find("\n\n")
            .map_or(text.len(), |end| start + end);
        let text = format!("{}{region}{}", &text[..start], &text[end..]);
        let text = text.replace("shooter = \"", "shooter = \"/");
        text.replace(
            "shooter = \"/",
            &format!("shooter = \"{}/configs/", env!("CARGO_MANIFEST_DIR")),
        )
    };
    for region in [
        "region = \"places\"\nplaces = \"places.csv\"\n",
        "region = \"places\"\nnames = [\"Right Elbow\"]\n",
    ] {
        let file = folder.path().join("sweep.toml");
        fs::write(&file, sweep(region)).unwrap();
        let mut check = bankshot();
        let answer = Answer::of(check.arg("check").arg(&file));
        assert_eq!(answer.code, Some(0), "{answer:?}");
    }
}

/// `coach` from an export to a sheet, and with a sweep of two places to a team's page and posters.
#[test]
fn contract_coach_goes_from_an_export_to_posters() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("export.csv");
    let two = table("Athlete,Spot,Arc,Depth,Left-Right,Result", |n, s| {
        let name = word(n % 2 == 0, ["Ana", "Ben <b>"]);
        let (entry, depth, right) = (s.entry_deg, s.depth_in, s.right_in);
        format!(
            "{name},Free Throw,{entry},{depth},{right},{}",
            word(s.made, ["Make", "Miss"])
        )
    });
    fs::write(&file, two).unwrap();
    let sweep = folder.path().join("sweep.toml");
    let text = include_str!("../../src/cli/commands/new_templates/coach_sweep.toml");
    let (start, end) = (
        text.find("names = [").unwrap(),
        text.find("]\n\n[grid]").unwrap(),
    );
    let text = format!("{}names = [\"free throw\"{}", &text[..start], &text[end..]);
    let text = text
        .replace("{court}", "ncaa")
        .replace("{units}", "imperial");
    fs::write(&sweep, text).unwrap();
    let out = folder.path().join("out");
    let mut command = bankshot();
    command
        .arg("coach")
        .arg(&file)
        .arg("-o")
        .arg(&out)
        .arg("--quiet");
    command
        .args(["--release-height", "7 ft", "--sweep"])
        .arg(&sweep);
    let answer = Answer::of(&mut command).exits(0);
    for part in ["Ana: Now ", "Ben <b>: Now ", "from the Free Throw"] {
        assert!(answer.stdout().contains(part), "{part}: {answer:?}");
    }
    let sheet = fs::read_to_string(out.join("sheet.html")).unwrap();
    assert!(
        sheet.contains("<h2>Ana</h2>") && sheet.contains("Ben &lt;b&gt;"),
        "{sheet}"
    );
    for file in [
        "team/posters.html",
        "team/team.html",
        "team/team.csv",
        "players/ana/fit.json",
    ] {
        assert!(out.join(file).exists(), "{file}");
    }
}

fn utf16(text: &str) -> Vec<u8> {
    let bytes = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let marked: Vec<u8> = [b"\xff\xfe".to_vec(), bytes].concat();
    assert_eq!(UTF_16LE.decode(&marked).0, text);
    marked
}

/// 60 exports: dialects, encodings, names of columns and dates, each with each. About a minute.
#[test]
#[ignore = "a campaign: cargo test --test cli -- --ignored campaign_exports"]
fn campaign_exports() {
    let names = [
        ["entry_angle_deg", "depth_in", "left_right_in", "made"],
        ["Entry Angle (deg)", "Depth (in)", "Left/Right (in)", "Made"],
        ["Arc", "Depth", "Left-Right", "Result"],
    ];
    let dates: [(&str, fn(usize) -> String); 4] = [
        ("", |_| String::new()),
        ("Date", |day| format!("2025-10-{}", 13 + day)),
        ("Day", |day| format!("{}. Oct 2025", 13 + day)),
        ("date", |day| format!("10/{}/2025 18:05", 13 + day)),
    ];
    let dialects: [(&str, fn(&str) -> Vec<u8>); 5] = [
        ("commas", |text| text.as_bytes().to_vec()),
        ("semicolons", |text| {
            text.replace(',', ";").replace('.', ",").into_bytes()
        }),
        ("tabs", |text| utf16(&text.replace(',', "\t"))),
        ("crlf", |text| {
            format!("\u{feff}Report\n{}", text.replace('\n', ",,\n"))
                .replace('\n', "\r\n")
                .into_bytes()
        }),
        ("quotes", |text| {
            let line = |line: &str| {
                let cells = line.split(',').map(|cell| format!("\"{cell}\""));
                cells.collect::<Vec<_>>().join(",")
            };
            text.lines()
                .map(line)
                .collect::<Vec<_>>()
                .join("\r")
                .into_bytes()
        }),
    ];
    let mut read = 0;
    for names in names {
        for (date_name, date) in dates {
            let text = table(&format!("shot,{date_name},{}", names.join(",")), |n, s| {
                let made = u8::from(s.made);
                let (entry, depth, right) = (s.entry_deg, s.depth_in, s.right_in);
                format!("{n},{},{entry},{depth},{right},{made}", date(s.day))
            });
            for (dialect, bytes) in &dialects {
                let bytes = match *dialect {
                    // A decimal point in a date stays.
                    "semicolons" if date_name == "Day" => text.replace(',', ";").into_bytes(),
                    _ => bytes(&text),
                };
                accepted(&format!("{dialect}.csv"), &bytes);
                read += 1;
            }
        }
    }
    println!("{read} exports read");
    assert_eq!(read, 60);
}
