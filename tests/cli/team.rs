//! `team`: players side by side, at their places and over a court.

use super::support::{Answer, bankshot, file_names, small_profile, write_file};
use std::fs;
use tempfile::TempDir;

const COURT: &str = r#"
[sweep]
name = "small court"
shooter = "ann.toml"
court = "ncaa"
compute = ["direct", "bank"]
region = "arcs"
distances = ["8 ft", "14 ft"]
angles = ["-50 deg", "50 deg"]
angle_step = "50 deg"
[grid]
speed = 16
pitch = 10
polar = 10
backspin = 3
[search]
standard_error = 0.01
"#;

#[test]
fn contract_a_team_has_a_table_maps_and_posters() {
    let folder = TempDir::new().unwrap();
    let player = |file: &str, name: &str, pitch: &str| {
        let text = small_profile()
            .replace("college guard", name)
            .replace("\"1.2 deg\"", pitch);
        write_file(&folder, file, text);
    };
    player("ann.toml", "Ann", "\"1.2 deg\"");
    player("bo.toml", "Bo <b>", "\"6 deg\"");
    write_file(&folder, "court.toml", COURT);
    let team = |more: &[&str]| {
        let mut command = bankshot();
        command.current_dir(folder.path());
        command.args(["team", "ann.toml", "bo.toml", "--quiet"]);
        Answer::of(command.args(more))
    };
    team(&[])
        .exits(0)
        .prints("Ann")
        .prints("13.75 ft,")
        .prints("in front");
    let first = team(&["--sweep", "court.toml", "--out", "out"]).exits(0);
    let out = folder.path().join("out");
    assert_eq!(
        file_names(&out),
        [
            "ann",
            "bo-b",
            "posters.html",
            "team.csv",
            "team.html",
            "team.png",
            "team.svg"
        ]
    );
    for player in ["ann", "bo-b"] {
        let files = file_names(&out.join(player));
        for file in ["bank_and_direct.svg", "poster.html", "poster.png"] {
            assert!(files.iter().any(|name| name == file), "{files:?}");
        }
        let html = fs::read_to_string(out.join(player).join("poster.html")).unwrap();
        assert!(html.contains("Your best place: ") && !html.contains("<b>"));
    }
    let page = fs::read_to_string(out.join("team.html")).unwrap();
    assert!(page.contains("href=\"posters.html\"") && page.contains(">the best of the team<"));
    assert!(!page.contains("<b>"));
    // On paper: a row for each player and the maps, nothing else.
    let (printed, details) = page.split_once("<section class=\"unprinted\">").unwrap();
    let summary = printed.split_once("<section class=\"summary\">").unwrap().1;
    assert_eq!(summary.matches("<tr><td").count(), 2, "{summary}");
    assert!(summary.contains(">bank it from<") && !summary.contains(">change<"));
    assert!(details.contains("Makes per 100 at each place: direct/bank"));
    let posters = fs::read_to_string(out.join("posters.html")).unwrap();
    assert_eq!(posters.matches("<section>").count(), 2);
    assert!(!posters.contains("<b>"));
    let maps = fs::read_to_string(out.join("team.svg")).unwrap();
    assert!(maps.contains(">the best of the team<") && maps.contains(">level<"));
    let csv = fs::read_to_string(out.join("team.csv")).unwrap();
    assert_eq!(csv.lines().count(), 1 + 6);
    // The steady player is the better one everywhere.
    assert_eq!(csv.matches(",Ann,").count(), 6);
    // The same command again computes nothing and says the same.
    let again = team(&["--sweep", "court.toml", "--out", "out"]).exits(0);
    assert_eq!(again.stdout, first.stdout);
}

#[test]
fn contract_two_players_of_one_name_are_refused_and_a_court_with_a_shooter_is_not() {
    let folder = TempDir::new().unwrap();
    write_file(&folder, "ann.toml", small_profile());
    write_file(&folder, "bo.toml", small_profile());
    write_file(&folder, "court.toml", COURT);
    let team = |court: &str| {
        let mut command = bankshot();
        command.current_dir(folder.path());
        command.args(["team", "ann.toml", "bo.toml", "--sweep", court, "--quiet"]);
        Answer::of(&mut command).exits(2)
    };
    team("court.toml").says("two players have the name");
    let (_, shooter) = small_profile().split_once("[shooter]").map_or_else(
        || unreachable!("a profile has a shooter"),
        |(a, b)| {
            (
                a.to_owned(),
                b.split("[location]").next().unwrap().to_owned(),
            )
        },
    );
    let own = COURT.replace("shooter = \"ann.toml\"\n", "") + "[shooter]" + &shooter;
    write_file(&folder, "own.toml", own);
    team("own.toml").says("two players have the name");
    let mut at_their_places = bankshot();
    at_their_places.current_dir(folder.path());
    at_their_places.args(["team", "ann.toml", "bo.toml", "--quiet"]);
    Answer::of(&mut at_their_places)
        .exits(2)
        .says("two players have the name");
    assert_eq!(file_names(folder.path()).len(), 4);
    // A sweep names players, or stands among them: both say what to write.
    let run = |arguments: &[&str]| {
        let mut command = bankshot();
        command.current_dir(folder.path());
        Answer::of(command.args(arguments).arg("--quiet"))
    };
    run(&["team", "ann.toml", "court.toml"])
        .exits(2)
        .says("this is a sweep, not a player; name the players alone, and the sweep with --sweep court.toml");
    let unwritten = COURT.replace("ann.toml", "not_written.toml");
    write_file(&folder, "unwritten.toml", unwritten);
    run(&["plan", "unwritten.toml"])
        .exits(2)
        .says("there is no such file; write one: bankshot new player not_written.toml");
    // A team needs no such file.
    run(&["team", "ann.toml", "--sweep", "unwritten.toml", "--plan"])
        .exits(0)
        .prints("1 player: about ");
    fs::remove_file(folder.path().join("unwritten.toml")).unwrap();
    // A sweep with a shooter of its own serves as well.
    write_file(
        &folder,
        "bo.toml",
        small_profile().replace("college guard", "Bo"),
    );
    let mut command = bankshot();
    command.current_dir(folder.path());
    command.args(["team", "ann.toml", "bo.toml", "--sweep", "own.toml"]);
    Answer::of(command.args(["--out", "out", "--quiet"]))
        .exits(0)
        .prints("Bo: ");
    let csv = fs::read_to_string(folder.path().join("out/team.csv")).unwrap();
    assert!(csv.starts_with(
        "place,name,x_ft,y_ft,distance_ft,court_angle_deg,best_players,college guard direct"
    ));
}
