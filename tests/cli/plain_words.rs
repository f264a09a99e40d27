//! One name for each quantity: the glossary of the docs lists them, and no other is used where
//! people read.

use super::support::{Answer, bankshot};
use std::fs;
use std::path::Path;

/// Words and phrases that stand for something in the glossary, or for nothing. `P` is the symbol of
/// the paper and of the pages about it.
const BANNED: [&str; 18] = [
    "sure",
    "surest",
    "usual",
    "steadier",
    "heed",
    "heeds",
    "deg up",
    "points of P",
    "points more",
    "points less",
    "such shots",
    "in 100 draws",
    "of 100 draws",
    "range made",
    "chance of 100",
    "clean shot",
    "no clean",
    "not clean",
];

/// The banned phrases in a text, each with its line.
pub(crate) fn banned_in(text: &str, more: &[&str]) -> Vec<String> {
    let mut found = Vec::new();
    let words_of = |text: &str| {
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
        let words = text.split(|c| !is_word(c)).filter(|word| !word.is_empty());
        format!(" {} ", words.collect::<Vec<_>>().join(" "))
    };
    for (number, line) in text.lines().enumerate() {
        let words = words_of(line);
        for phrase in BANNED.iter().chain(more) {
            if words.contains(&format!(" {phrase} ")) {
                found.push(format!("{}: \"{phrase}\" in: {line}", number + 1));
            }
        }
    }
    found
}

/// What outputs and help do not have either; pages about the paper and the store of a sweep do.
pub(crate) const IN_OUTPUTS: [&str; 5] = ["P", "spot", "spots", "numerics", "of the draws"];

#[test]
fn contract_help_and_docs_have_one_name_for_each_quantity() {
    let mut found = Vec::new();
    let mut look = |name: &str, text: &str, more: &[&str]| {
        let banned = banned_in(text, more).into_iter();
        found.extend(banned.map(|words| format!("{name}:{words}")));
    };
    for command in super::help_examples::COMMANDS {
        let help = Answer::of(bankshot().args([command, "--help"])).exits(0);
        look(&format!("{command} --help"), help.stdout(), &IN_OUTPUTS);
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    // The changelog names old keys.
    let mut pages = vec![root.join("README.md")];
    pages.extend(
        fs::read_dir(root.join("docs"))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|end| end == "md")),
    );
    pages.sort();
    assert!(pages.len() > 15, "{pages:?}");
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        look(&page.display().to_string(), &text, &[]);
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A page that no list of pages names is not found; a link to no page leads nowhere.
#[test]
fn contract_every_page_is_in_the_book_and_every_link_leads_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let summary = fs::read_to_string(root.join("docs/SUMMARY.md")).unwrap();
    let index = fs::read_to_string(root.join("docs/README.md")).unwrap();
    let mut pages = vec![
        root.join("README.md"),
        root.join("CONTRIBUTING.md"),
        root.join("CHANGELOG.md"),
    ];
    for entry in fs::read_dir(root.join("docs")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "md") {
            continue;
        }
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let link = format!("]({name})");
        if name != "SUMMARY.md" {
            assert!(summary.contains(&link), "docs/SUMMARY.md lacks {name}");
        }
        if !["SUMMARY.md", "README.md"].contains(&name.as_str()) {
            assert!(index.contains(&link), "docs/README.md lacks {name}");
        }
        pages.push(path);
    }
    let mut links = 0;
    for page in pages {
        let text = fs::read_to_string(&page).unwrap();
        for part in text.split("](").skip(1) {
            let link = part.split(')').next().unwrap();
            let file = link.split('#').next().unwrap();
            if file.is_empty() || file.contains("://") || file.starts_with("mailto:") {
                continue;
            }
            let target = page.parent().unwrap().join(file);
            assert!(target.exists(), "{}: no file {link}", page.display());
            links += 1;
        }
    }
    assert!(links > 60, "{links}");
}
