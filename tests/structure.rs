//! Data flows one way: no module imports one further down the line.

use std::fs;
use std::path::Path;

/// The rooms in the order of the data; each may use those before it.
const LINE: [&str; 11] = [
    "lane",
    "physics",
    "units",
    "court",
    "dynamics",
    "profile",
    "plan",
    "probability",
    "output",
    "sweep",
    "picture",
];
/// Mathematics of the normal distribution, used by the plan to bound what lies outside it.
const ALLOWED: [(&str, &str); 1] = [("plan", "probability::normal")];

fn sources(folder: &Path, found: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push((
                path.display().to_string(),
                fs::read_to_string(&path).unwrap(),
            ));
        }
    }
}

#[test]
fn contract_no_module_imports_one_further_down_the_line() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut checked = 0;
    for (place, room) in LINE.iter().enumerate() {
        let mut files = Vec::new();
        let folder = root.join(room);
        if folder.is_dir() {
            sources(&folder, &mut files);
        } else {
            let path = root.join(format!("{room}.rs"));
            files.push((
                path.display().to_string(),
                fs::read_to_string(path).unwrap(),
            ));
        }
        for (path, text) in files {
            checked += 1;
            for later in &LINE[place + 1..] {
                for line in text
                    .lines()
                    .filter(|line| line.contains(&format!("crate::{later}")))
                {
                    let allowed = ALLOWED
                        .iter()
                        .any(|(from, what)| from == room && line.contains(what));
                    assert!(allowed, "{path} reaches down: {line}");
                }
            }
        }
    }
    assert!(checked > 25, "{checked}");
}
