//! The commands of `docs/tutorial.md` print what the page says.

use super::support::{Answer, bankshot};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The commands of the page that are followed by their output.
fn commands_with_output(page: &str) -> Vec<(Vec<String>, &str)> {
    let mut found = Vec::new();
    for part in page.split("```sh\n").skip(1) {
        let Some((command, after)) = part.split_once("\n```\n") else {
            continue;
        };
        let Some(output) = after.strip_prefix("```text\n") else {
            continue;
        };
        let output = output.split("```").next().unwrap();
        found.push((arguments(command), output));
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
    words.remove(0);
    words
}

#[test]
fn contract_the_tutorial_prints_what_it_says() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = TempDir::new().unwrap();
    for file in ["docs/data/gym_sensor.csv", "configs/free_throw.toml"] {
        let to = folder.path().join(file);
        fs::create_dir_all(to.parent().unwrap()).unwrap();
        fs::copy(root.join(file), to).unwrap();
    }
    let page = fs::read_to_string(root.join("docs/tutorial.md")).unwrap();
    let commands = commands_with_output(&page);
    assert_eq!(commands.len(), 3);
    for (arguments, output) in commands {
        let mut command = bankshot();
        command
            .current_dir(folder.path())
            .args(&arguments)
            .arg("--quiet");
        let answer = Answer::of(&mut command).exits(0);
        assert_eq!(answer.stdout(), output, "{arguments:?}");
    }
}
