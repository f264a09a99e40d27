//! What README and docs print is what the program prints.
//!
//! A block of output stands under a comment with its command, `<!-- bankshot best ... -->`. Each of
//! its lines must come in the output, in this order; a page may leave lines out.

use crate::support::{Answer, bankshot};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The commands of a page, each with the output that the page prints (`None` for a command that
/// only makes files for others).
fn commands(page: &str) -> Vec<(String, Option<String>)> {
    let mut found = Vec::new();
    for part in page.split("<!-- bankshot ").skip(1) {
        let (command, after) = part.split_once(" -->").unwrap();
        let block = after.trim_start().strip_prefix("```text\n");
        let output = block.map(|block| block.split("```").next().unwrap().to_owned());
        found.push((command.replace('\n', " "), output));
    }
    found
}

/// The words of a shell command.
fn arguments(command: &str) -> Vec<String> {
    let mut words = Vec::new();
    for (i, part) in command.split('\'').enumerate() {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

fn check(page: &str, least: usize) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = TempDir::new().unwrap();
    for from in ["docs/data", "configs"] {
        let to = folder.path().join(from);
        fs::create_dir_all(&to).unwrap();
        for entry in fs::read_dir(root.join(from)).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    let text = fs::read_to_string(root.join(page)).unwrap();
    // The launcher of its page.
    if let Some(robot) = text.split("```toml\n").nth(1) {
        let robot = robot.split("```").next().unwrap();
        fs::write(folder.path().join("robot.toml"), robot).unwrap();
    }
    let commands = commands(&text);
    assert!(commands.len() >= least, "{page}: {}", commands.len());
    for (command, expected) in commands {
        let mut program = bankshot();
        program
            .current_dir(folder.path())
            .args(arguments(&command))
            .arg("--quiet");
        let answer = Answer::of(&mut program);
        assert!(matches!(answer.code, Some(0 | 1)), "{command}\n{answer:?}");
        let mut lines = answer.stdout().lines().map(str::trim_end);
        for line in expected.iter().flat_map(|text| text.lines()) {
            assert!(
                lines.any(|printed| printed == line.trim_end()),
                "{page}, bankshot {command}: has not the line\n{line}\n{answer:?}"
            );
        }
    }
}

#[test]
#[ignore = "a minute; `cargo test --test cli campaign_docs -- --ignored`"]
fn campaign_docs_print_what_the_program_prints() {
    check("README.md", 4);
    check("docs/tutorial.md", 2);
    check("docs/study.md", 1);
    check("docs/launcher.md", 3);
}
