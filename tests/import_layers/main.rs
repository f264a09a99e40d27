//! Imports go one way: between the layers of the crate, and between the files of each.
#![cfg(feature = "app")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The layers. Each may use those before it.
const LAYERS: [&str; 22] = [
    "escape",
    "math",
    "units",
    "files",
    "model",
    "dynamics",
    "shooter",
    "config",
    "search_space",
    "probability",
    "analysis",
    "best_shot",
    "fitting",
    "measured_shots",
    "store",
    "answers",
    "present",
    "sweep",
    "plots",
    "report",
    "studio",
    "cli",
];

/// A module path from the root of the crate, such as `["dynamics", "contact", "single"]`.
type ModulePath = Vec<String>;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every source file with its path below `src`.
fn source_files() -> Vec<(PathBuf, String)> {
    fn visit(folder: &Path, found: &mut Vec<(PathBuf, String)>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                visit(&path, found);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                found.push((path.strip_prefix(root()).unwrap().to_owned(), text));
            }
        }
    }
    let mut found = Vec::new();
    visit(&root(), &mut found);
    found
}

/// Every source file with its module path, without unit tests.
fn modules() -> BTreeMap<ModulePath, String> {
    let mut found = BTreeMap::new();
    for (path, text) in source_files() {
        let inside = path.with_extension("");
        let mut names: ModulePath = inside
            .iter()
            .map(|part| part.to_string_lossy().into_owned())
            .collect();
        if names.last().is_some_and(|name| name == "mod") {
            names.pop();
        }
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        found.insert(names, without_comments(code));
    }
    found.remove(&vec!["lib".to_owned()]);
    found.remove(&vec!["main".to_owned()]);
    found
}

fn without_comments(code: &str) -> String {
    code.lines()
        .map(|line| line.split("//").next().unwrap())
        .collect::<Vec<_>>()
        .join("\n")
}

/// The paths that begin with one of `crate`, `bankshot`, `super` and `self`, with the braces of a
/// `use` written out.
fn paths(code: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    let mut start = 0;
    while let Some(at) = ["crate::", "bankshot::", "super::", "self::"]
        .iter()
        .filter_map(|head| code[start..].find(head).map(|at| at + start))
        .min()
    {
        let is_start = !code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
        let mut rest = &code[at..];
        if is_start {
            expand(&mut rest, &[], &mut found);
        }
        start = at + code[at..].find("::").unwrap() + 2;
    }
    found
}

/// Reads one path, or the paths in one pair of braces, off the front of `rest`.
fn expand(rest: &mut &str, prefix: &[String], found: &mut Vec<Vec<String>>) {
    let mut path = prefix.to_vec();
    loop {
        *rest = rest.trim_start();
        if let Some(inside) = rest.strip_prefix('{') {
            *rest = inside;
            loop {
                expand(rest, &path, found);
                *rest = rest.trim_start();
                match rest.chars().next() {
                    Some(',') => *rest = &rest[1..],
                    Some('}') => {
                        *rest = &rest[1..];
                        return;
                    }
                    _ => return,
                }
                if rest.trim_start().starts_with('}') {
                    *rest = &rest.trim_start()[1..];
                    return;
                }
            }
        }
        let end = rest
            .find(|c: char| !(c.is_alphanumeric() || c == '_'))
            .unwrap_or(rest.len());
        path.push(rest[..end].to_owned());
        *rest = &rest[end..];
        match rest.strip_prefix("::") {
            Some(after) => *rest = after,
            None => {
                if let Some(after) = rest.strip_prefix(" as ") {
                    *rest = after.trim_start_matches(|c: char| c.is_alphanumeric() || c == '_');
                }
                found.push(path);
                return;
            }
        }
    }
}

/// The paths of `use` declarations that begin with a child module, as paths from `self`.
fn child_paths(code: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for declaration in code.split(';') {
        if let Some(at) = declaration.rfind("use ") {
            let keyword = declaration[..at].trim_end();
            if keyword.is_empty() || keyword.ends_with(['}', ')', '\n', 'b', ']']) {
                expand(
                    &mut &declaration[at + 4..],
                    &["self".to_owned()],
                    &mut found,
                );
            }
        }
    }
    found
}

/// The module that a path in the file `from` names: the longest part of it that is a file.
fn resolve(
    path: &[String],
    from: &ModulePath,
    modules: &BTreeMap<ModulePath, String>,
) -> Option<ModulePath> {
    let mut target = match path[0].as_str() {
        "crate" | "bankshot" => Vec::new(),
        _ => from.clone(),
    };
    let mut parts = path.iter().skip(1).collect::<Vec<_>>();
    if path[0] == "super" {
        target.pop();
        while parts.first().is_some_and(|part| *part == "super") {
            target.pop();
            parts.remove(0);
        }
    }
    for part in parts {
        let mut longer = target.clone();
        longer.push(part.clone());
        if !modules.contains_key(&longer) {
            break;
        }
        target = longer;
    }
    (!target.is_empty()).then_some(target)
}

/// The other files that each file imports from.
fn imports(modules: &BTreeMap<ModulePath, String>) -> BTreeMap<ModulePath, BTreeSet<ModulePath>> {
    modules
        .iter()
        .map(|(from, code)| {
            let children = child_paths(code).into_iter().filter(|path| {
                let mut child = from.clone();
                child.extend(path.get(1).cloned());
                modules.contains_key(&child)
            });
            let targets = paths(code)
                .into_iter()
                .chain(children)
                .collect::<Vec<_>>()
                .iter()
                .filter_map(|path| resolve(path, from, modules))
                .filter(|target| target != from)
                .collect();
            (from.clone(), targets)
        })
        .collect()
}

#[test]
fn contract_paths_are_read_with_braces_and_renames() {
    let found = paths("use crate::{a::B, c::{self, d as e}};\nlet x = super::super::f::g(1);");
    let text: Vec<String> = found.iter().map(|path| path.join("::")).collect();
    assert_eq!(
        text,
        [
            "crate::a::B",
            "crate::c::self",
            "crate::c::d",
            "super::super::f::g",
            "super::f::g"
        ][..4]
    );
}

#[test]
fn contract_every_layer_imports_only_layers_before_it() {
    let modules = modules();
    let place = |layer: &str| {
        LAYERS
            .iter()
            .position(|known| *known == layer)
            .unwrap_or_else(|| panic!("the layer {layer} is not in the list"))
    };
    let mut between = 0;
    for (from, targets) in imports(&modules) {
        for target in targets.iter().filter(|target| target[0] != from[0]) {
            between += 1;
            assert!(
                place(&target[0]) < place(&from[0]),
                "{} imports {}, which comes later",
                from.join("::"),
                target.join("::")
            );
        }
    }
    assert!(modules.len() > 100, "{} files", modules.len());
    assert!(between > 200, "{between} imports between layers");
}

#[test]
fn contract_no_files_import_each_other_in_a_circle() {
    let modules = modules();
    let imports = imports(&modules);
    let mut state: BTreeMap<&ModulePath, bool> = BTreeMap::new();
    fn visit<'a>(
        file: &'a ModulePath,
        imports: &'a BTreeMap<ModulePath, BTreeSet<ModulePath>>,
        state: &mut BTreeMap<&'a ModulePath, bool>,
        trail: &mut Vec<&'a ModulePath>,
    ) {
        match state.get(file) {
            Some(true) => return,
            Some(false) => {
                let start = trail.iter().position(|known| *known == file).unwrap();
                let circle: Vec<String> = trail[start..].iter().map(|f| f.join("::")).collect();
                panic!("a circle of imports: {}", circle.join(" -> "));
            }
            None => {}
        }
        state.insert(file, false);
        trail.push(file);
        for target in &imports[file] {
            visit(target, imports, state, trail);
        }
        trail.pop();
        state.insert(file, true);
    }
    for file in modules.keys() {
        visit(file, &imports, &mut state, &mut Vec::new());
    }
}

/// Names and quoted files are made harmless in `escape`, and nowhere else: what is written past it
/// would be another place to look at.
#[test]
fn contract_texts_of_strangers_pass_the_escapes() {
    let only_in: [(&[&str], &[&str]); 4] = [
        // Cells of CSV.
        (
            &["csv::Writer", "WriterBuilder", "write_record("],
            &["files/csv_text.rs", "cli/commands/simulate.rs"],
        ),
        // Escapes made by hand.
        (
            &[
                "&amp;",
                "&lt;",
                "\\u003c",
                "replace('\"', \"\\\"\\\"\")",
                "escape_unicode",
            ],
            &["escape/mod.rs"],
        ),
        // The terminal.
        (
            &["io::stdout", "io::stderr", "print!(", "println!("],
            &[
                "cli/terminal.rs",
                "cli/commands/simulate.rs",
                "cli/progress_bars.rs",
            ],
        ),
        // Names of files made of other names.
        (
            &["is_ascii_alphanumeric"],
            &[
                "escape/mod.rs",
                "present/shot_table_files/source_code.rs",
                // The name of this machine.
                "sweep/sweep_folder.rs",
            ],
        ),
    ];
    let mut found = Vec::new();
    for (file, text) in source_files() {
        let code = without_comments(text.split("#[cfg(test)]\nmod tests").next().unwrap());
        for (words, files) in only_in {
            let word = words.iter().find(|word| code.contains(**word));
            if let Some(word) = word.filter(|_| !files.iter().any(|known| file.ends_with(known))) {
                found.push(format!("{}: {word}", file.display()));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Comments are as wide as the code, whose width the formatter keeps. Rows of tables may be longer.
#[test]
fn contract_lines_of_comments_have_at_most_100_columns() {
    let mut long = Vec::new();
    for (file, text) in source_files() {
        for line in text.lines() {
            let comment = line.trim_start();
            let is_row = comment.starts_with("//! |") || comment.starts_with("/// |");
            if comment.starts_with("//") && !is_row && line.chars().count() > 100 {
                long.push(format!("{}: {line}", file.display()));
            }
        }
    }
    assert!(long.is_empty(), "{}", long.join("\n"));
}

/// The rows of the packages in the studio's page.
fn page_packages(repository: &Path) -> Vec<String> {
    let text = fs::read_to_string(repository.join("studio/package.json")).unwrap();
    let package: serde_json::Value = serde_json::from_str(&text).unwrap();
    let packages = package["dependencies"].as_object().unwrap().iter();
    packages
        .map(|(name, version)| format!("| {name} {} |", version.as_str().unwrap()))
        .collect()
}

#[test]
fn contract_every_dependency_is_in_the_notices() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR"));
    let notices = fs::read_to_string(repository.join("THIRD-PARTY-NOTICES.md")).unwrap();
    let lock: toml::Table = fs::read_to_string(repository.join("Cargo.lock"))
        .unwrap()
        .parse()
        .unwrap();
    let packages = lock["package"].as_array().unwrap();
    let missing: Vec<String> = packages
        .iter()
        .filter(|package| package.get("source").is_some())
        .map(|package| {
            let text = |key: &str| package[key].as_str().unwrap();
            format!("| {} {} |", text("name"), text("version"))
        })
        .chain(page_packages(repository))
        .filter(|row| !notices.contains(row))
        .collect();
    assert!(
        missing.is_empty(),
        "run python3 packaging/third_party_notices.py: {missing:?}"
    );
}

/// Where a text is looked into by words that this program does not write itself: input of a user,
/// names of files and columns, messages of libraries, requests, a template, the layout of a terminal.
const READS_OF_OTHERS: [(&str, &str); 24] = [
    ("cli/commands/sample_size/tracker.rs", "optical_"),
    ("cli/commands/new.rs", "  #"),
    ("cli/commands/team/one_place.rs", "profile.toml"),
    ("cli/measured_shots_flags.rs", "--map"),
    ("cli/signals.rs", "SigIgn:"),
    ("cli/terminal.rs", "  "),
    ("cli/terminal.rs", "  --"),
    ("cli/terminal.rs", " > "),
    ("cli/terminal.rs", "-->"),
    ("cli/terminal.rs", "error: "),
    ("cli/value_lists.rs", " by "),
    ("cli/value_lists.rs", " to "),
    // The name of a tracker that a fit found in its tracks, which a user may type too.
    ("fitting/tracker_noise.rs", ", "),
    ("fitting/tracker_noise.rs", "correlation"),
    ("fitting/tracker_noise.rs", "frames/s"),
    ("fitting/tracker_noise.rs", "mm"),
    ("report/page.rs", "{{"),
    ("report/page.rs", "}}"),
    ("store/draws.rs", "speed_mean_"),
    ("store/fit.rs", "profile_place_"),
    // What a browser sends.
    ("studio/access.rs", "/files/"),
    ("studio/access.rs", "Bearer "),
    ("studio/access.rs", "token="),
    ("sweep/sqlite_results.rs", "error code="),
];

/// What a sentence says is in the answer as a number or an enum: no code outside of `present` looks
/// for words in a text that the program wrote. (`measured_shots`, `config`, `units` and `files` read
/// files of others.)
#[test]
fn contract_no_code_reads_its_own_sentences() {
    const METHODS: [&str; 9] = [
        "starts_with",
        "ends_with",
        "contains",
        "split_once",
        "rsplit_once",
        "strip_prefix",
        "strip_suffix",
        "split",
        "find",
    ];
    const READERS: [&str; 5] = ["measured_shots", "config", "units", "files", "present"];
    let mut found = BTreeSet::new();
    for (path, text) in source_files() {
        let shown = path.display().to_string();
        if READERS.iter().any(|reader| path.starts_with(reader)) {
            continue;
        }
        let code = text.split("#[cfg(test)]\nmod tests").next().unwrap();
        for method in METHODS {
            for part in code.split(&format!(".{method}(\"")).skip(1) {
                let words = part.split('"').next().unwrap().to_owned();
                found.insert((shown.clone(), words));
            }
        }
    }
    let known = READS_OF_OTHERS.map(|(file, words)| (file.to_owned(), words.to_owned()));
    let known: BTreeSet<_> = known.into_iter().collect();
    let new: Vec<_> = found.difference(&known).collect();
    assert!(new.is_empty(), "reads its own words: {new:?}");
    let gone: Vec<_> = known.difference(&found).collect();
    assert!(gone.is_empty(), "no longer there: {gone:?}");
}
