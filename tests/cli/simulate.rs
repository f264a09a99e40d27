//! `simulate`: rows in, outcomes out.

use super::support::{Answer, RELEASES, bankshot, write_file};
use std::fs;
use tempfile::TempDir;

/// The exit code, the output file (empty if there is none) and standard error of `simulate`.
fn simulate(
    folder: &TempDir,
    rows: impl AsRef<[u8]>,
    options: &[&str],
) -> (Option<i32>, String, String) {
    let releases = write_file(folder, "in.csv", rows);
    let out = folder.path().join("out.csv");
    let _ = fs::remove_file(&out);
    let mut command = bankshot();
    command.arg("simulate").arg(&releases);
    if !options.contains(&"--physics") {
        command.args(["--physics", "paper"]);
    }
    let answer = Answer::of(command.arg("--output").arg(&out).args(options));
    let text = fs::read(&out).map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    (answer.code, text.unwrap_or_default(), answer.stderr)
}

#[test]
fn contract_simulate_keeps_columns_and_adds_outcomes() {
    let folder = TempDir::new().unwrap();
    for options in [&["--integrator", "exact"], &["--integrator", "paper"]] {
        let (code, text, _) = simulate(&folder, RELEASES, options);
        assert_eq!(code, Some(0));
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].ends_with(
            "polar_deg,backspin_rev_s,made,kind,contacts,n_board,n_ring,flight_time_s,entry_angle_deg,first_touch_s"
        ));
        let expected = "swish,52,23.5,13.75,0,7,0,0,1,swish,,0,0,";
        assert!(lines[1].starts_with(expected), "{}", lines[1]);
        let expected = "bank,52,24.7,13.75,0,7,0,3,1,bank-in,board,1,0,";
        assert!(lines[2].starts_with(expected), "{}", lines[2]);
        assert!(lines[3].contains(",0,airball,,0,0,"), "{}", lines[3]);
    }
}

#[test]
fn contract_simulate_reads_metres_and_radians() {
    let folder = TempDir::new().unwrap();
    let metric = "\
speed_m_s,distance_m,court_angle_rad,release_height_m,polar_rad,pitch_rad,backspin_rad_s
7.1628,4.191,0,2.1336,0,0.9075712110370514,0
";
    let (_, feet, _) = simulate(&folder, RELEASES, &[]);
    let (code, metres, _) = simulate(&folder, metric, &[]);
    assert_eq!(code, Some(0));
    // The added columns from the entry angle back; the first touch is empty for a swish.
    let added = |text: &str| {
        let row = text.lines().nth(1).unwrap();
        let cells = row.rsplit(',').skip(1).take(7).map(str::to_owned);
        cells.collect::<Vec<_>>()
    };
    let (a, b) = (added(&feet), added(&metres));
    assert_eq!(a[2..], b[2..]);
    let number = |text: &String| text.parse::<f64>().unwrap();
    assert!((number(&a[0]) - number(&b[0])).abs() < 1e-9);
}

#[test]
fn contract_bad_rows_are_named_and_the_others_are_simulated() {
    let folder = TempDir::new().unwrap();
    let mut rows = RELEASES.as_bytes().to_vec();
    rows.extend_from_slice(
        b"a,52,fast,13.75,0,7,0,0\nb,nan,23,13.75,0,7,0,0\nc,52,23.5,1,0,7,0,0\nd,52\n",
    );
    rows.extend_from_slice(
        b"e\xff,52,23.5,13.75,0,7,0,0\nf,5\xff,23.5,13.75,0,7,0,0\ng,52,23.5,13.75,170,7,0,0\nh,52,23.5,13.75,0,7,0,0,more\n",
    );
    let (code, text, message) = simulate(&folder, rows, &[]);
    assert_eq!(code, Some(3), "{message}");
    for words in [
        "line 5: column speed_ft_s: \"fast\" is not a number",
        "line 6: column pitch_deg: \"nan\" is not a finite number",
        "line 7: column distance_ft: the place is inside the ring's reach",
        "line 8: column",
        "line 10: column pitch_deg: is not UTF-8",
        "line 11: column court_angle_deg: the place is behind the board",
        "line 12: column 9: the row has 9 fields",
        "7 of 11 rows",
    ] {
        assert!(message.contains(words), "{words} in {message}");
    }
    assert_eq!(text.lines().count(), 12);
    let columns = |line: &str| line.split(',').count();
    assert!(text.lines().all(|line| columns(line) == 16), "{text}");
    assert!(text.lines().nth(8).unwrap().contains(",1,swish,"), "{text}");
}

#[test]
fn contract_bad_headers_and_physics_are_refused() {
    let folder = TempDir::new().unwrap();
    let (code, _, message) = simulate(&folder, "speed_ft_s,speed_m_s,made\n1,1,1\n", &[]);
    assert_eq!(code, Some(2));
    for words in [
        "distance_ft (or distance_m) is missing",
        "speed_ft_s and speed_m_s",
        "made",
    ] {
        assert!(message.contains(words), "{words} in {message}");
    }
    let (code, _, message) = simulate(&folder, RELEASES, &["--physics", "moon"]);
    assert_eq!(code, Some(2));
    assert!(message.contains("neither a preset"), "{message}");
    let bad = "[physics]\nrestitution = 0.8457\nball_mass = \"21 ft\"\n";
    let path = write_file(&folder, "physics.toml", bad);
    let options = ["--physics", path.to_str().unwrap()];
    let (code, _, message) = simulate(&folder, RELEASES, &options);
    assert_eq!(code, Some(2));
    assert!(message.contains("physics.ball_mass"), "{message}");
    write_file(&folder, "physics.toml", "[physics]\nrestitution = 0.8457\n");
    let (code, _, message) = simulate(&folder, RELEASES, &options);
    assert_eq!(code, Some(0), "{message}");
}

#[test]
fn contract_simulate_streams_standard_input_and_output() {
    let mut lines = RELEASES.lines();
    let (header, row) = (lines.next().unwrap(), lines.next().unwrap());
    let input = format!("{header}{}", format!("\n{row}").repeat(40_000));
    let mut command = bankshot();
    command.args([
        "simulate",
        "-",
        "--output",
        "-",
        "--quiet",
        "--physics",
        "paper",
    ]);
    let answer = Answer::with_input(&mut command, input).exits(0);
    let lines = answer.stdout.iter().filter(|&&byte| byte == b'\n').count();
    assert_eq!(lines, 40_001);
}

#[test]
fn contract_unknown_quantities_are_refused_or_carried() {
    let folder = TempDir::new().unwrap();
    for name in ["spin_rev_s", "spin_rpm", "backspin_rps"] {
        let rows = RELEASES.replace("backspin_rev_s", name);
        let (code, _, message) = simulate(&folder, &rows, &[]);
        assert_eq!(code, Some(2), "{message}");
        assert!(message.contains(&format!("column {name} looks like a quantity")));
        assert!(message.contains("spin_rev_s?"), "{message}");
        let (code, text, message) = simulate(&folder, &rows, &["--carry", name]);
        assert_eq!(code, Some(0), "{message}");
        assert!(text.lines().next().unwrap().contains(name));
    }
    let (code, _, message) = simulate(&folder, RELEASES, &["--carry", "hang_s,speed_ft_s"]);
    assert_eq!(code, Some(2));
    assert!(
        message.contains("--carry hang_s: there is no such column"),
        "{message}"
    );
    assert!(
        message.contains("--carry speed_ft_s: this column is used"),
        "{message}"
    );
}

#[test]
fn contract_the_input_is_never_overwritten() {
    let folder = TempDir::new().unwrap();
    let releases = write_file(&folder, "in.csv", RELEASES);
    let link = folder.path().join("link.csv");
    fs::hard_link(&releases, &link).unwrap();
    for output in [&releases, &link] {
        let mut command = bankshot();
        command
            .args(["simulate", "--physics", "paper"])
            .arg(&releases)
            .arg("-o")
            .arg(output);
        let answer = Answer::of(&mut command).exits(2);
        assert!(answer.stderr.contains("this is the input"), "{answer:?}");
        assert_eq!(fs::read_to_string(&releases).unwrap(), RELEASES);
    }
}

#[test]
fn contract_parquet_goes_in_and_out_with_the_same_values() {
    let folder = TempDir::new().unwrap();
    let rows = format!("{RELEASES}\"a, b\",52,fast,13.75,0,7,0,0\n");
    let (_, csv, _) = simulate(&folder, &rows, &[]);
    let path = |name: &str| folder.path().join(name);
    let run = |from: &str, to: &str| {
        let mut command = bankshot();
        command
            .args(["simulate", "--physics", "paper"])
            .arg(path(from))
            .arg("-o")
            .arg(path(to));
        Answer::of(&mut command).exits(3)
    };
    let answer = run("in.csv", "first.parquet");
    assert!(
        answer.stderr.contains("line 5: column speed_ft_s"),
        "{answer:?}"
    );
    assert!(
        fs::read(path("first.parquet"))
            .unwrap()
            .starts_with(b"PAR1")
    );
    let again = bankshot()
        .args(["simulate", "--physics", "paper"])
        .arg(path("first.parquet"))
        .arg("-o")
        .arg(path("x.csv"))
        .output()
        .unwrap();
    let message = String::from_utf8(again.stderr).unwrap();
    assert!(
        message.contains("made is written by the simulation"),
        "{message}"
    );
    // Releases as Parquet: those of the first file without its results.
    releases_as_parquet(&rows, &path("releases.parquet"));
    let answer = run("releases.parquet", "out.csv");
    assert!(
        answer.stderr.contains("row 4: column speed_ft_s"),
        "{answer:?}"
    );
    let text = fs::read_to_string(path("out.csv")).unwrap();
    // A text is null as a number, and numbers are printed at their shortest.
    let expected = csv.replace(",fast,", ",,").replace(",22.0,", ",22,");
    assert_eq!(text, expected);
    run("releases.parquet", "second.parquet");
    assert_eq!(
        fs::read(path("first.parquet")).unwrap(),
        fs::read(path("second.parquet")).unwrap()
    );
    fs::write(path("broken.parquet"), "PAR1 and no more").unwrap();
    let mut command = bankshot();
    command
        .args(["simulate", "--physics", "paper"])
        .arg(path("broken.parquet"))
        .arg("-o")
        .arg(path("x.csv"));
    let answer = Answer::of(&mut command).exits(2);
    assert!(answer.stderr.contains("broken.parquet"), "{answer:?}");
}

/// Writes the rows of a CSV text as Parquet: a text and numbers.
fn releases_as_parquet(rows: &str, path: &std::path::Path) {
    use bankshot::files::parquet_rows::{ParquetSink, column};
    use parquet::basic::Type;
    let mut reader = csv::Reader::from_reader(rows.as_bytes());
    let header = reader.byte_headers().unwrap().clone();
    let columns: Vec<_> = header
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let of = if i == 0 {
                Type::BYTE_ARRAY
            } else {
                Type::DOUBLE
            };
            column(std::str::from_utf8(name).unwrap(), of).unwrap()
        })
        .collect();
    let mut sink = ParquetSink::new(fs::File::create(path).unwrap(), &columns).unwrap();
    for row in reader.byte_records() {
        sink.push(row.unwrap()).unwrap();
    }
    sink.finish().unwrap();
}

#[test]
fn contract_an_open_quote_and_empty_lines_cost_their_lines_only() {
    let folder = TempDir::new().unwrap();
    let mut lines: Vec<String> = RELEASES.lines().map(str::to_owned).collect();
    let row = lines[1].clone();
    lines.extend(vec![row.clone(); 2000]);
    lines[10] = format!("\"{row}");
    lines[20] = String::new();
    let (code, text, message) = simulate(&folder, lines.join("\n"), &[]);
    assert_eq!(code, Some(3), "{message}");
    assert!(
        message.contains("line 11: a quote is opened here and not closed"),
        "{message}"
    );
    // An empty line is no row.
    assert!(!message.contains("line 21"), "{message}");
    assert!(message.contains("1 of 2002 rows"), "{message}");
    assert_eq!(text.lines().count(), 2003);
    assert_eq!(text.matches(",1,swish,").count(), 1999);
}

#[test]
fn contract_the_first_touch_comes_before_the_end() {
    let folder = TempDir::new().unwrap();
    let (_, text, _) = simulate(&folder, RELEASES, &[]);
    let cells = |line: usize| -> Vec<String> {
        let row = text.lines().nth(line).unwrap();
        row.rsplit(',').take(3).map(str::to_owned).collect()
    };
    // A swish touches nothing; a bank shot touches the board before it ends.
    assert_eq!(cells(1)[0], "");
    let [touch, end] = [&cells(2)[0], &cells(2)[2]].map(|cell| cell.parse::<f64>().unwrap());
    assert!(0.5 < touch && touch < end, "{touch} {end}");
}

#[test]
fn contract_no_row_is_lost_at_the_end_of_a_file() {
    let folder = TempDir::new().unwrap();
    let lines: Vec<&str> = RELEASES.lines().collect();
    let quoted = format!("{},remark\n{},\"fine\"", lines[0], lines[1]);
    let old_mac = lines.join("\r");
    for (text, rows) in [(quoted, 1), (old_mac, 3)] {
        let (code, out, message) = simulate(&folder, &text, &[]);
        assert_eq!(code, Some(0), "{message}");
        assert_eq!(out.lines().count(), rows + 1, "{out}");
        assert!(out.contains(",1,swish,"), "{out}");
    }
}

#[test]
fn contract_messages_do_not_steer_the_terminal() {
    let folder = TempDir::new().unwrap();
    let rows = RELEASES.replace(",23.5,", ",\u{1b}[31m\u{202e}fast,");
    let (code, _, message) = simulate(&folder, &rows, &[]);
    assert_eq!(code, Some(3));
    assert!(message.contains("\\u{1b}[31m\\u{202e}fast"), "{message}");
    assert!(!message.contains('\u{1b}') && !message.contains('\u{202e}'));
}

#[test]
fn contract_the_results_of_a_simulation_are_no_releases() {
    let folder = TempDir::new().unwrap();
    let (_, text, _) = simulate(&folder, RELEASES, &[]);
    let (code, _, message) = simulate(&folder, &text, &[]);
    assert_eq!(code, Some(2));
    assert!(
        message.contains("first_touch_s is written by the simulation"),
        "{message}"
    );
    assert!(!message.contains("--carry"), "{message}");
}
