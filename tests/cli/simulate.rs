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
            "polar_deg,backspin_rev_s,made,kind,contacts,n_board,n_ring,flight_time_s,entry_angle_deg"
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
    // The added columns, the last one first.
    let added = |text: &str| {
        let row = text.lines().nth(1).unwrap();
        let cells = row.rsplit(',').take(7).map(str::to_owned);
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
        "row 4: column speed_ft_s: \"fast\" is not a number",
        "row 5: column pitch_deg: \"nan\" is not a finite number",
        "row 6: column distance_ft: the place is inside the ring's reach",
        "row 7: column",
        "row 9: column pitch_deg: is not UTF-8",
        "row 10: column court_angle_deg: the place is behind the board",
        "row 11: column 9: the row has 9 fields",
        "7 of 11 rows",
    ] {
        assert!(message.contains(words), "{words} in {message}");
    }
    assert_eq!(text.lines().count(), 12);
    let columns = |line: &str| line.split(',').count();
    assert!(text.lines().all(|line| columns(line) == 15), "{text}");
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
    assert!(message.contains("neither the preset"), "{message}");
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
    command.args(["simulate", "-", "--output", "-", "--quiet"]);
    let answer = Answer::with_input(&mut command, input).exits(0);
    let lines = answer.stdout.iter().filter(|&&byte| byte == b'\n').count();
    assert_eq!(lines, 40_001);
}
