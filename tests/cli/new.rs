//! `new`: each file that it writes is valid, and nothing is overwritten.

use super::support::{Answer, bankshot, file_names, write_file};
use std::fs;
use std::io::Write;
use std::process::Stdio;
use tempfile::TempDir;

#[test]
fn contract_every_new_file_is_valid() {
    let folder = TempDir::new().unwrap();
    let run = |arguments: &[&str]| {
        let mut command = bankshot();
        Answer::of(command.current_dir(folder.path()).args(arguments))
    };
    for what in ["player", "robot", "sweep", "physics"] {
        run(&["new", what]).exits(0);
    }
    for file in ["player.toml", "robot.toml", "sweep.toml"] {
        run(&["check", file]).exits(0);
    }
    run(&["check", "player.toml", "--physics", "physics.toml"]).exits(0);
    write_file(&folder, "player.toml", "mine");
    run(&["new", "player"])
        .exits(2)
        .says("player.toml: exists already; name another file");
    let kept = fs::read_to_string(folder.path().join("player.toml")).unwrap();
    assert_eq!(kept, "mine");
    let printed = run(&["new", "robot", "-"]).exits(0);
    let robot = fs::read(folder.path().join("robot.toml")).unwrap();
    assert_eq!(printed.stdout, robot);
}

#[test]
fn contract_five_questions_make_a_player() {
    let folder = TempDir::new().unwrap();
    let ask = |answers: &str| {
        let mut child = bankshot()
            .current_dir(folder.path())
            .args(["new", "player", "asked.toml", "--interactive"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child
            .stdin
            .take()
            .unwrap()
            .write_all(answers.as_bytes())
            .unwrap();
        child.wait_with_output().unwrap()
    };
    // A wrong answer is asked again.
    let output = ask("Ann \"Bee\" \\ Lee\n6'4\"\n12,5 ft\n12.5 ft\n\nelite\n");
    assert!(output.status.success(), "{output:?}");
    let remarks = String::from_utf8(output.stderr).unwrap();
    assert!(remarks.contains("has a decimal comma; write 12.5 ft"));
    let text = fs::read_to_string(folder.path().join("asked.toml")).unwrap();
    let profile = bankshot::config::parse_profile(&text, "asked.toml").unwrap();
    assert_eq!(profile.shooter().name, "Ann \"Bee\" \\ Lee");
    assert_eq!(profile.location().distance_m, 12.5 * 0.3048);
    assert!((profile.shooter().release_height_m - 76.0 * 0.0254).abs() < 1e-12);
    assert_eq!(profile.shooter().dispersion.c10_m_s, 0.15 * 0.3048);
    // The end of the input ends the questions.
    fs::remove_file(folder.path().join("asked.toml")).unwrap();
    let output = ask("Ann\nfar\n");
    assert_eq!(output.status.code(), Some(2));
    assert!(file_names(folder.path()).is_empty());
}
