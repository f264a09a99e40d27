//! Names that are formulas, scripts, sources, paths and codes, in every output: they stay text.
//!
//! An ordinary run takes each kind of name once; `cargo test --test cli -- --ignored --nocapture
//! campaign_hostile_names` takes 5,000 (`docs/reliability.md`).

use crate::support::*;
use bankshot::best_shot::{ShotKind, ShotTable, ShotTableRequest, TableKind};
use bankshot::config::parse_profile;
use bankshot::escape::toml_string;
use bankshot::present::shot_table_files::source_code::{Language, source_code};
use bankshot::probability::Silent;
use bankshot::units::FOOT_M;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

const NAMES: [&str; 78] = [
    // Pages and drawings.
    "<script>hit('evil')</script>",
    "\"><img src=evil onerror=hit('evil')>",
    "'><svg onload=hit('evil')>",
    "</title><script>hit('evil')</script>",
    "</script><script>hit('evil')</script>",
    "</text><script>hit('evil')</script>",
    "</style><style>*{background:url(http://evil.example/)}",
    "<!--",
    "-->",
    "]]>",
    "<![CDATA[",
    "javascript:hit('evil')",
    "&lt;b&gt;&amp;&#x3c;",
    "<a xlink:href='http://evil.example'>",
    "<iframe srcdoc='<script>parent.hit(1)</script>'>",
    // Spreadsheets.
    "=HYPERLINK(\"http://evil.example\";\"x\")",
    "+1+cmd|' /C calc'!A0",
    "-2+3",
    "@SUM(1+1)",
    "\u{ff1d}1+1",
    "=1,2;3",
    "-",
    // Sources.
    "*/ evil(); /*",
    "\\u000a static { System.exit(3); } //",
    "\\u002a\\u002f",
    "\"\"\"; raise SystemExit(3)",
    "what??/",
    "ends with \\",
    "@ROWS@",
    "@ABOUT@ @CLASS@ @NAMES@",
    "{{data}} {data} %s%n%d {0}",
    "#include <evil>",
    "#}",
    // Shells, SQL and paths.
    "${HOME} $(touch evil) `touch evil`",
    "; touch evil; '",
    "'; DROP TABLE results; --",
    "../../evil",
    "/tmp/evil",
    "C:\\evil",
    "\\\\evil\\share",
    "CON",
    "nul.txt",
    "ends with a dot.",
    ".",
    "..",
    "~",
    "-rf",
    "--output=evil",
    // Letters.
    "e\u{301}",
    "\u{e9}",
    "\u{1f3c0}",
    "\u{540d}\u{524d}",
    "\u{200b}",
    "\u{feff}x",
    "\u{2028}x",
    "\u{ffff}",
    // Values and separators.
    "'",
    "\"",
    "''",
    "\"\"\"",
    "a,b",
    "a;b",
    "a|b",
    "# = [x]",
    "null",
    "NaN",
    "1e999",
    "true",
    // What no name may have.
    "\u{1b}[31mred",
    "\u{1b}]0;evil\u{7}",
    "\u{9b}31m",
    "a\rb",
    "a\nb",
    "\t=1+1",
    "\u{7f}",
    "\u{202e}evil",
    "\u{2066}x\u{2069}",
    "\u{0}",
];

/// Each name once, then two of them joined with something in between.
fn hostile_names(count: usize) -> Vec<String> {
    const LONGEST: usize = 90;
    let mut rng = ChaCha12Rng::seed_from_u64(54);
    let mut names: Vec<String> = NAMES.map(str::to_owned).to_vec();
    names.truncate(count);
    while names.len() < count {
        let [first, second] = [0; 2].map(|_| NAMES[rng.random_range(0..NAMES.len())]);
        let between = ["", " ", "a", "\"", "\\", "7"][rng.random_range(0..6)];
        let name: String = format!("{first}{between}{second}");
        names.push(name.chars().take(LONGEST).collect());
    }
    names
}

/// Whether a profile or a place may have this name.
fn is_allowed(name: &str) -> bool {
    !name.contains(bankshot::escape::is_control_or_direction)
}

/// A small profile of a shooter with this name.
fn named_profile(name: &str) -> String {
    small_profile().replacen("\"college guard\"", &toml_string(name), 1)
}

/// A cell of a CSV file. (A file with a NUL is no text, and is refused whole.)
fn quoted(name: &str) -> String {
    format!("\"{}\"", name.replace('"', "\"\"").replace('\0', "0"))
}

/// What was looked at.
#[derive(Default, Debug)]
struct Seen {
    names: usize,
    refused: usize,
    pages: usize,
    drawings: usize,
    cells: usize,
    documents: usize,
    sources: usize,
    prints: usize,
}

impl Seen {
    /// What a terminal gets. A tab only moves on, and belongs to the cells of a table.
    fn terminal(&mut self, printed: &str) {
        let steers = |c: char| !"\n\t".contains(c) && bankshot::escape::is_control_or_direction(c);
        assert!(!printed.contains(steers), "{printed:?}");
        self.prints += 1;
    }

    fn answer(&mut self, answer: Answer, codes: &[i32]) -> Answer {
        let code = answer.code.unwrap_or(-1);
        assert!(codes.contains(&code), "{answer:?}");
        self.terminal(answer.stdout());
        self.terminal(&answer.stderr);
        answer
    }

    /// No cell is run by a spreadsheet.
    fn csv(&mut self, bytes: &[u8]) -> Vec<Vec<String>> {
        let mut reader = csv::ReaderBuilder::new();
        let mut reader = reader.has_headers(false).flexible(true).from_reader(bytes);
        let rows = reader.records().map(|row| {
            let row = row.unwrap();
            let cells = row.iter().map(|cell| {
                self.cells += 1;
                let runs = cell.starts_with(['=', '+', '-', '@', '\t', '\r', '\u{ff1d}']);
                assert!(!runs || cell.parse::<f64>().is_ok(), "{cell:?}");
                let steers = |c: char| c.is_control() && !"\t\r\n".contains(c);
                assert!(!cell.contains(steers), "{cell:?}");
                cell.to_owned()
            });
            cells.collect()
        });
        rows.collect()
    }

    /// Every file of a folder.
    fn folder(&mut self, folder: &Path) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
            assert!(name.chars().all(plain), "{name:?}");
            let kind = path.extension().unwrap_or_default().to_string_lossy();
            match &*kind {
                _ if path.is_dir() => self.folder(&path),
                "csv" => {
                    self.csv(&fs::read(&path).unwrap());
                }
                "json" => {
                    let text = fs::read_to_string(&path).unwrap();
                    let _: serde_json::Value = serde_json::from_str(&text).unwrap();
                    self.documents += 1;
                }
                "toml" => {
                    let _: toml::Table = fs::read_to_string(&path).unwrap().parse().unwrap();
                    self.documents += 1;
                }
                "html" => self.page(&path),
                "svg" => self.drawing(&fs::read_to_string(&path).unwrap()),
                _ => {}
            }
        }
    }

    /// A drawing has nothing that runs or loads.
    fn drawing(&mut self, svg: &str) {
        self.drawings += 1;
        for tag in svg.split('<').skip(1) {
            let tag = tag.split('>').next().unwrap();
            let word = tag.split([' ', '/']).find(|word| !word.is_empty()).unwrap();
            let known = [
                "svg",
                "g",
                "path",
                "rect",
                "circle",
                "ellipse",
                "line",
                "polyline",
                "polygon",
                "text",
                "tspan",
                "title",
                "desc",
                "defs",
                "clipPath",
                "image",
                "use",
                "style",
                "marker",
                "pattern",
                "linearGradient",
                "stop",
            ];
            assert!(known.contains(&word), "<{tag}>");
            assert!(!tag.contains("evil"), "<{tag}>");
            assert!(!tag.contains(" on"), "<{tag}>");
        }
    }

    /// A page, opened in Chromium: nothing of a name runs, loads or becomes an element.
    fn page(&mut self, page: &Path) {
        let Some(chromium) = chromium() else { return };
        const BEFORE: &str =
            "<script>window.hits = 0; window.hit = () => hits++; window.alert = hit;</script>";
        const AFTER: &str = "<script>
const bad = [...document.querySelectorAll('*')].filter((element) => [...element.attributes].some((a) =>
  /^on/.test(a.name) || (/^(src|href|xlink:href|srcdoc|style|action|d)$/.test(a.name) && a.value.includes('evil'))));
const loaded = performance.getEntriesByType('resource').filter((entry) => !entry.name.startsWith('blob:')).length;
const said = document.createElement('pre');
said.textContent = 'SEEN ' + hits + ' ' + bad.length + ' ' + loaded + ' ' + document.querySelectorAll('iframe,object,embed').length + ' NEES';
document.body.append(said);
</script>";
        let html = fs::read_to_string(page).unwrap();
        let start = html
            .find("<meta")
            .unwrap_or_else(|| panic!("{}", page.display()));
        let (before, rest) = html.split_at(start);
        let folder = TempDir::new().unwrap();
        let visited = folder.path().join("visited.html");
        fs::write(&visited, format!("{before}{BEFORE}{rest}{AFTER}")).unwrap();
        let output = Command::new(chromium)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--no-first-run",
            ])
            .args([
                "--disable-background-networking",
                "--disable-component-update",
            ])
            .arg(format!(
                "--user-data-dir={}",
                folder.path().join("user").display()
            ))
            .args(["--virtual-time-budget=2000", "--dump-dom"])
            .arg(format!("file://{}", visited.display()))
            .output()
            .unwrap();
        let dom = String::from_utf8_lossy(&output.stdout).into_owned();
        let said = dom
            .rsplit_once(">SEEN ")
            .and_then(|(_, rest)| rest.split_once(" NEES"));
        let said = said
            .unwrap_or_else(|| panic!("{}: {dom:.3000}", page.display()))
            .0;
        assert_eq!(said, "0 0 0 0", "{}", page.display());
        self.pages += 1;
    }
}

fn chromium() -> Option<&'static str> {
    let mut names = ["chromium", "chromium-browser", "google-chrome"].into_iter();
    let found = names.find(|name| Command::new(name).arg("--version").output().is_ok());
    let is_needed = std::env::var_os("BANKSHOT_NO_SKIP").is_some();
    assert!(found.is_some() || !is_needed, "chromium is not installed");
    found
}

/// The columns and the notes of a file of releases.
fn simulate(names: &[String], seen: &mut Seen) {
    let folder = TempDir::new().unwrap();
    let columns: Vec<&String> = names.iter().take(100).collect();
    let header: Vec<String> = columns
        .iter()
        .enumerate()
        .map(|(k, name)| quoted(&format!("{name}{k}")))
        .collect();
    let mut text = format!(
        "{},note,pitch_deg,speed_ft_s,distance_ft,court_angle_deg,release_height_ft,polar_deg,backspin_rev_s\n",
        header.join(",")
    );
    for name in names {
        text += &format!(
            "{}{},52,23.5,13.75,0,7,0,3\n",
            ",".repeat(columns.len()),
            quoted(name)
        );
    }
    let input = write_file(&folder, "in.csv", text);
    let run = |output: &str| {
        let mut command = bankshot();
        command
            .arg("simulate")
            .arg(&input)
            .args(["--physics", "paper", "-o"]);
        Answer::of(command.arg(match output {
            "-" => "-".into(),
            name => folder.path().join(name),
        }))
    };
    let printed = run("-");
    assert_eq!(printed.code, Some(0), "{printed:?}");
    for output in ["out.csv", "out.parquet"] {
        seen.answer(run(output), &[0]);
    }
    let written = fs::read(folder.path().join("out.csv")).unwrap();
    assert_eq!(written, printed.stdout);
    let rows = seen.csv(&written);
    assert_eq!(rows.len(), names.len() + 1);
    for (row, name) in rows[1..].iter().zip(names) {
        let note = &row[columns.len()];
        let is_whole = !name.contains(char::is_control);
        assert!(
            !is_whole || note.ends_with(name.as_str()),
            "{note:?} {name:?}"
        );
        assert!(row.contains(&"1".to_owned()) || row.len() > columns.len() + 6);
    }
    seen.names += names.len();
}

/// The name of a shooter: checked profiles, and the answers of `shot`.
fn profiles(names: &[String], seen: &mut Seen) {
    let folder = TempDir::new().unwrap();
    for name in names {
        let profile = write_file(&folder, "profile.toml", named_profile(name));
        let shot = |flags: &[&str]| {
            let mut command = bankshot();
            command
                .arg("shot")
                .arg(&profile)
                .args(["--speed", "23.5 ft/s", "--pitch", "52 deg"]);
            Answer::of(command.args(flags))
        };
        let answer = seen.answer(shot(&["--json"]), &[0, 1, 2]);
        seen.names += 1;
        assert_eq!(
            answer.code == Some(2),
            !is_allowed(name),
            "{name:?} {answer:?}"
        );
        if answer.code == Some(2) {
            seen.refused += 1;
            continue;
        }
        assert!(answer.json().to_string().contains("\"probability\""));
        seen.answer(shot(&[]), &[0, 1]);
    }
}

/// Exported sources are compiled where there is a compiler, and give the same numbers.
fn sources(names: &[String], seen: &mut Seen) {
    let profile = parse_profile(&small_profile(), "small").unwrap();
    let units = profile.output().units;
    let request = ShotTableRequest {
        kind: TableKind::One(ShotKind::Direct),
        distances_m: vec![10.0 * FOOT_M, 12.0 * FOOT_M],
        angles_rad: vec![0.0],
        fixed: Vec::new(),
        max_loss: 1.0,
        least_probability: 0.0,
        is_draft: true,
    };
    let table = ShotTable::compute(&profile, &request, &Silent).unwrap();
    let folder = TempDir::new().unwrap();
    let names: Vec<&String> = names.iter().filter(|name| is_allowed(name)).collect();
    for (k, name) in names.iter().enumerate() {
        let named = profile.with(|settings| settings.shooter.name = (*name).clone());
        let Ok(named) = named else { continue };
        for (language, file) in [
            (Language::Java, format!("T{k}.java")),
            (Language::Cpp, format!("t{k}.hpp")),
            (Language::Python, format!("t{k}.py")),
        ] {
            let class = if language == Language::Java {
                format!("T{k}")
            } else {
                format!("t{k}")
            };
            let text = source_code(&table, (language, &class), (&named, units));
            write_file(&folder, &file, text);
            seen.sources += 1;
        }
        seen.names += 1;
    }
    let shot = table.shots[0].as_ref().unwrap();
    let speed = format!("{:.6}", shot.nominal.speed_m_s / units.length().1);
    let at = format!("{:.6}", 10.0);
    let run = |program: &str, arguments: &[String]| {
        let output = Command::new(program)
            .args(arguments)
            .current_dir(folder.path())
            .output();
        // C++, Java and Python are not needed to build bankshot.
        let Ok(output) = output else {
            eprintln!("skipped: {program} is not installed");
            return;
        };
        let (out, err) = (&output.stdout, &output.stderr);
        assert!(
            output.status.success(),
            "{program}: {} {}",
            String::from_utf8_lossy(out),
            String::from_utf8_lossy(err)
        );
        if !out.is_empty() {
            let numbers = String::from_utf8_lossy(out);
            assert!(
                numbers.split_whitespace().all(|number| number == speed),
                "{numbers:.500}"
            );
        }
    };
    let all: Vec<usize> = (0..names.len()).collect();
    let checks: String = all
        .iter()
        .map(|k| format!("import t{k}\nprint('%.6f' % t{k}.look_up({at})[0])\n"))
        .collect();
    write_file(&folder, "check.py", checks);
    run("python3", &["-B".to_owned(), "check.py".to_owned()]);
    for (part, some) in all.chunks(200).enumerate() {
        let includes: String = some
            .iter()
            .map(|k| format!("#include \"t{k}.hpp\"\n"))
            .collect();
        let prints: String = some
            .iter()
            .map(|k| format!("std::printf(\"%.6f\\n\", t{k}::look_up({at})[0]);\n"))
            .collect();
        write_file(
            &folder,
            "check.cpp",
            format!("#include <cstdio>\n{includes}int main() {{\n{prints}}}\n"),
        );
        let flags = [
            "-std=c++11",
            "-trigraphs",
            "-Wall",
            "-Werror=comment",
            "-O0",
            "check.cpp",
            "-o",
        ];
        let program = format!("check{part}");
        run(
            "g++",
            &flags
                .map(str::to_owned)
                .into_iter()
                .chain([program.clone()])
                .collect::<Vec<_>>(),
        );
        if folder.path().join(&program).exists() {
            run(&format!("./{program}"), &[]);
        }
        let prints: String = some.iter().map(|k| format!("System.out.println(String.format(java.util.Locale.ROOT, \"%.6f\", T{k}.lookUp({at})[0]));\n")).collect();
        let check =
            format!("class Check{part} {{ public static void main(String[] a) {{\n{prints}}} }}\n");
        write_file(&folder, &format!("Check{part}.java"), check);
        let files = some.iter().map(|k| format!("T{k}.java"));
        let ascii = ["-encoding", "US-ASCII"].map(str::to_owned).into_iter();
        run(
            "javac",
            &ascii
                .chain(files)
                .chain([format!("Check{part}.java")])
                .collect::<Vec<_>>(),
        );
        if folder.path().join(format!("Check{part}.class")).exists() {
            run(
                "java",
                &["-cp".to_owned(), ".".to_owned(), format!("Check{part}")],
            );
        }
    }
}

/// The names of places in a sweep, its tables and its page.
fn places(names: &[String], seen: &mut Seen) {
    let folder = TempDir::new().unwrap();
    let names: Vec<&String> = names
        .iter()
        .filter(|name| is_allowed(name) && !name.is_empty())
        .collect();
    let sweep = include_str!("../small_sweep.toml");
    let (head, tail) = (
        sweep.find("region").unwrap(),
        sweep.find("[shooter]").unwrap(),
    );
    let name = toml_string(names[0]);
    let head = sweep[..head].replace("\"small\"", &name);
    let text = format!(
        "{head}region = \"places\"\nplaces = \"places.csv\"\n{}",
        &sweep[tail..]
    );
    let sweep = write_file(&folder, "sweep.toml", text);
    let mut rows = "name,x_ft,y_ft\n".to_owned();
    for (k, name) in names.iter().enumerate() {
        rows += &format!(
            "{},{:.2},{:.2}\n",
            quoted(name),
            6.0 + 0.1 * (k % 100) as f64,
            0.1 * (k / 100) as f64
        );
    }
    write_file(&folder, "places.csv", rows);
    let out = folder.path().join("out");
    let mut command = bankshot();
    seen.answer(
        Answer::of(command.arg("sweep").arg(&sweep).arg("--output").arg(&out)),
        &[0, 3],
    );
    let written = seen.csv(&fs::read(out.join("best_shots.csv")).unwrap());
    let cells: Vec<&String> = written.iter().flatten().collect();
    for name in &names {
        // A mark of the order of bytes at an end is no part of a text.
        let name = name.trim_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
        let is_there = cells.iter().any(|cell| cell.ends_with(name));
        assert!(is_there, "{name:?}");
    }
    let mut command = bankshot();
    seen.answer(Answer::of(command.arg("report").arg(&out)), &[0]);
    seen.folder(&out);
    seen.names += names.len();
}

/// The names of a player, sessions, shots and columns of a file, and the file's own.
fn measured(names: &[String], seen: &mut Seen) {
    let folder = TempDir::new().unwrap();
    let data = include_str!("../../docs/data/gym_sensor.csv");
    let name = |k: usize| &names[k % names.len()];
    let columns: Vec<String> = (0..6)
        .map(|k| quoted(&format!("{} {k}", name(k + 3))))
        .collect();
    let mut text = String::new();
    for (k, line) in data.lines().enumerate() {
        let (_, rest) = line.split_once(',').unwrap();
        text += &match k {
            0 => format!("shot,session,player,{rest},{}\n", columns.join(",")),
            _ => format!(
                "{},{},{},{rest},{}\n",
                quoted(name(k)),
                quoted(name(k % 2)),
                quoted(name(2)),
                quoted(name(k)) + &",x".repeat(5)
            ),
        };
    }
    let file = write_file(&folder, "=evil <b>.csv", text);
    let out = folder.path().join("fit");
    let mut command = bankshot();
    let fitted = command.arg("fit").arg(&file).arg("--output").arg(&out);
    let answer = seen.answer(Answer::of(fitted), &[0, 2]);
    seen.names += data.lines().count();
    if answer.code == Some(2) {
        seen.refused += 1;
        return;
    }
    for command in ["advise", "report"] {
        let mut run = bankshot();
        let answer = Answer::of(run.arg(command).arg(&out));
        seen.answer(answer, &[0, 1, 3]);
    }
    let mut run = bankshot();
    let picture = folder.path().join("changes.svg");
    let compared = run.arg("compare").arg(&file).arg("--plot").arg(&picture);
    seen.answer(Answer::of(compared), &[0, 1, 2, 3]);
    if picture.exists() {
        seen.drawing(&fs::read_to_string(picture).unwrap());
    }
    seen.folder(&out);
}

/// The name of a shooter in the files of `best`.
fn best_shots(name: &str, seen: &mut Seen) {
    let folder = TempDir::new().unwrap();
    let profile = write_file(&folder, "profile.toml", named_profile(name));
    let out = folder.path().join("best");
    seen.answer(Answer::of(&mut best(&profile, &out)), &[0, 1]);
    let mut run = bankshot();
    seen.answer(Answer::of(run.arg("report").arg(&out)), &[0]);
    seen.folder(&out);
    seen.names += 1;
}

#[test]
fn contract_hostile_names_stay_text() {
    let names = hostile_names(NAMES.len());
    let mut seen = Seen::default();
    simulate(&names, &mut seen);
    profiles(&names[60..], &mut seen);
    sources(&names, &mut seen);
    places(&names[..12], &mut seen);
    best_shots(NAMES[4], &mut seen);
    measured(&names, &mut seen);
    println!("{seen:?}");
    assert!(seen.sources > 100 && seen.refused > 5);
}

/// How many names the campaigns take.
const CAMPAIGN: usize = 5000;

#[test]
#[ignore = "about eight minutes"]
fn campaign_hostile_names_in_texts() {
    let names = hostile_names(CAMPAIGN);
    let mut seen = Seen::default();
    simulate(&names, &mut seen);
    println!("columns and notes of simulate: {seen:?}");
    profiles(&names, &mut seen);
    println!("profiles: {seen:?}");
    sources(&names, &mut seen);
    println!("sources: {seen:?}");
}

#[test]
#[ignore = "about fifteen minutes"]
fn campaign_hostile_names_in_places() {
    let mut seen = Seen::default();
    for some in hostile_names(CAMPAIGN).chunks(500) {
        places(some, &mut seen);
    }
    println!("places: {seen:?}");
}

#[test]
#[ignore = "about ten minutes"]
fn campaign_hostile_names_in_results() {
    let names = hostile_names(CAMPAIGN);
    let mut seen = Seen::default();
    for some in names.chunks(127) {
        measured(some, &mut seen);
    }
    println!("measured shots: {seen:?}");
    for name in names.iter().filter(|name| is_allowed(name)).step_by(100) {
        best_shots(name, &mut seen);
    }
    println!("best shots: {seen:?}");
}
