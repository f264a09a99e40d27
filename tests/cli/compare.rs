//! `compare-sessions`: what changed between two sessions of a shooter.

use super::support::{Answer, bankshot, fit, write_file};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Flights of one session, from two heights of the release: nothing changed.
#[test]
fn contract_sessions_are_compared_at_one_release_height() {
    let folder = TempDir::new().unwrap();
    let outs = ["6.8 ft", "7.2 ft"].map(|height| {
        let out = folder.path().join(height);
        let file = "docs/data/optical_tracking.csv";
        fit(file, &out, &["--release-height", height]).exits(0);
        out
    });
    let mut command = bankshot();
    command.arg("compare-sessions").args(&outs).arg("--json");
    let answer = Answer::of(&mut command).exits(0);
    assert!(
        answer
            .stderr
            .contains("the release heights are 6.80 and 7.20 ft")
    );
    let json = answer.json();
    let change = |name: &str| {
        let mut changes = json["changes"].as_array().unwrap().iter();
        let found = changes.find(|change| change["name"] == name).unwrap();
        found["change"]["mean"].as_f64().unwrap()
    };
    // 0.4 ft along the path are 0.5 ft/s and 1.4 deg.
    assert!(change("speed_mean").abs() < 0.05, "{json}");
    assert!(change("pitch_mean").abs() < 0.2, "{json}");
}

/// The same shots, half a foot per second slower: all of the change is that of the speed's mean.
#[test]
fn contract_the_change_of_p_is_that_of_the_mean_that_changed() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let column = header
        .split(',')
        .position(|name| name == "speed_ft_s")
        .unwrap();
    let slower = rows.lines().map(|row| {
        let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
        cells[column] = (cells[column].parse::<f64>().unwrap() - 0.5).to_string();
        cells.join(",") + "\n"
    });
    let slower = write_file(
        &folder,
        "slower.csv",
        format!("{header}\n{}", slower.collect::<String>()),
    );
    let mut command = bankshot();
    command
        .args(["compare-sessions", "docs/data/lab.csv"])
        .arg(&slower);
    let json = Answer::of(command.args(["--json", "--quiet"]))
        .exits(0)
        .json();
    let mean = |name: &str| {
        json[format!("change_of_probability_by_{name}")]["mean"]
            .as_f64()
            .unwrap()
    };
    let all = json["changes"][0]["change"]["mean"].as_f64().unwrap();
    assert!(all < -10.0, "{all}");
    // But for the numerical errors of the samples, 0.2 per 100 each.
    assert!((mean("mean_release") - all).abs() < 1.0);
    assert!(
        (mean("speed_alone") - all).abs() < 1.0,
        "{}",
        mean("speed_alone")
    );
    for other in ["pitch_alone", "polar_alone", "scatter"] {
        assert!(mean(other).abs() < 1.0, "{other} {}", mean(other));
    }
}

/// The folder of a fit holds what its file tells.
#[test]
fn contract_sessions_are_the_same_from_files_and_from_their_fits() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let rows: Vec<&str> = rows.lines().collect();
    let paths = ["a", "b"].map(|name| folder.path().join(format!("{name}.csv")));
    for (path, part) in paths.iter().zip([&rows[..30], &rows[30..]]) {
        fs::write(path, format!("{header}\n{}\n", part.join("\n"))).unwrap();
    }
    let compare = |first: &Path, second: &Path, flags: &[&str]| {
        let mut command = bankshot();
        command.arg("compare-sessions").args([first, second]);
        Answer::of(command.args(["--json", "--quiet"]).args(flags))
    };
    let of_files = compare(&paths[0], &paths[1], &[]).exits(0);
    // The files do not say whose shots they are.
    assert!(!of_files.stderr.contains("two shooters"), "{of_files:?}");
    let of_files = of_files.json();
    let folders = ["a", "b"].map(|name| folder.path().join(name));
    for (path, out) in paths.iter().zip(&folders) {
        fit(path.to_str().unwrap(), out, &[]).exits(0);
    }
    let of_folders = compare(&folders[0], &folders[1], &[]).exits(0).json();
    assert_eq!(of_files["changes"], of_folders["changes"]);
    let p = &of_files["changes"][0];
    let grew = p["probability_of_growth"].as_f64().unwrap();
    assert!(
        p["name"] == "probability" && (0.0..=1.0).contains(&grew),
        "{p}"
    );
    // Scatter and aim make the change together, but for the numerical error of three samples.
    let mean = |value: &serde_json::Value| value["mean"].as_f64().unwrap();
    let parts = mean(&of_files["change_of_probability_by_scatter"])
        + mean(&of_files["change_of_probability_by_mean_release"]);
    assert!((parts - mean(&p["change"])).abs() < 0.5, "{parts} {p}");
    // Each cause has the mean of both orders of change, and the orders differ.
    let [first, last] = ["first", "last"]
        .map(|order| mean(&of_files[format!("change_of_probability_by_scatter_{order}")]));
    let of_scatter = mean(&of_files["change_of_probability_by_scatter"]);
    assert!((0.5 * (first + last) - of_scatter).abs() < 1e-9 && first != last);
    // The other way round the same causes have the other sign, but for numerical errors.
    let reversed = compare(&folders[1], &folders[0], &[]).exits(0).json();
    let reversed = mean(&reversed["change_of_probability_by_scatter"]);
    assert!(
        (of_scatter + reversed).abs() < 0.5,
        "{of_scatter} {reversed}"
    );
    // Of planned values alone chance has fewer to strike at.
    let planned = compare(&folders[0], &folders[1], &["--planned", "speed_sd"]);
    let planned = planned.exits(0).json();
    let [p, speed] = &planned["changes"].as_array().unwrap()[..] else {
        panic!("{planned}")
    };
    assert_eq!(*p, of_folders["changes"][0]);
    let all = of_folders["changes"].as_array().unwrap();
    let among_all = all.iter().find(|change| change["name"] == "speed_sd");
    assert_eq!(speed["change"], among_all.unwrap()["change"]);
    let shots = |of: &serde_json::Value| of["shots_to_decide"].as_f64().unwrap_or(0.0);
    assert!(shots(speed) <= shots(among_all.unwrap()));
    compare(&folders[0], &folders[1], &["--planned", "speed"])
        .exits(2)
        .says("--planned: \"speed\" is no value of these sessions; write some of speed_mean");
    // What only a file has a use for is refused beside the folder of a fit.
    let mut advise = bankshot();
    advise.arg("advise").arg(&folders[0]);
    Answer::of(advise.args(["--distance", "20 ft"]))
        .exits(2)
        .says("is a fit already; fit the shots again with it");
    compare(&folders[0], &folders[1], &["--distance", "20 ft"])
        .exits(2)
        .says("--distance: ");
    // A test is designed for the tracker of the fit.
    let mut design = bankshot();
    design.arg("design").arg(&folders[0]);
    let design = design.args(["--shots", "25", "--repetitions", "4", "--json", "--quiet"]);
    assert_eq!(Answer::of(design).exits(0).json()["tracker"], "lab");
    // The profile of a fit has its usual shot.
    let mut probability = bankshot();
    probability
        .arg("probability")
        .arg(folders[0].join("profile.toml"));
    Answer::of(probability.args(["--json", "--quiet"])).exits(0);
    let of_nba = folder.path().join("nba");
    fit(paths[1].to_str().unwrap(), &of_nba, &["--physics", "nba"]).exits(0);
    compare(&folders[0], &of_nba, &[])
        .exits(2)
        .says("fitted with different physics");
}

/// The figure of two sessions has each value of the table, and is of one shooter.
#[test]
fn contract_two_sessions_are_drawn() {
    let folder = TempDir::new().unwrap();
    let text = fs::read_to_string("docs/data/lab.csv").unwrap();
    let (header, rows) = text.split_once('\n').unwrap();
    let write = |name: &str, columns: &str, of_row: &dyn Fn(usize) -> String| {
        let rows = rows.lines().enumerate();
        let rows = rows.map(|(i, row)| format!("{row},{}\n", of_row(i)));
        write_file(
            &folder,
            name,
            format!("{header},{columns}\n{}", rows.collect::<String>()),
        )
    };
    let draw = |path: &Path, plot: &str| {
        let mut command = bankshot();
        command.arg("compare-sessions").arg(path).arg("--quiet");
        Answer::of(command.arg("--plot").arg(folder.path().join(plot)))
    };
    let season = write("season.csv", "session", &|i| {
        ["May <b>", "June"][i / 30].to_owned()
    });
    let table = draw(&season, "season.svg").exits(0);
    let svg = fs::read_to_string(folder.path().join("season.svg")).unwrap();
    assert!(svg.contains(">before: May &lt;b&gt;<") && svg.contains(">after: June<"));
    let of_table = |name: &str| {
        let mut lines = table.stdout().lines();
        let line = lines.find(|line| line.starts_with(name)).unwrap();
        let mut cells = line[name.len()..].split_whitespace();
        [cells.next().unwrap(), cells.next().unwrap()].map(str::to_owned)
    };
    for (label, name) in [
        ("makes per 100", "makes per 100"),
        ("the speed", "speed (ft/s)"),
    ] {
        assert!(svg.contains(&format!(">{label}<")), "{label}");
        for value in of_table(name) {
            assert!(svg.contains(&format!(">{value}<")), "{label}: {value}");
        }
    }
    assert!(svg.contains(">the mean release<"));
    draw(&season, "season.gif").exits(2).says("season.gif");
    let team = write("team.csv", "shooter,session", &|i| {
        format!("{},{}", ["Ann", "Bob"][i % 2], ["May", "June"][i / 30])
    });
    draw(&team, "team.svg")
        .exits(2)
        .says("--plot: draws the sessions of one shooter; choose with --shooter NAME");
}
