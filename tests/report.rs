//! The page of a run: it holds what it should, and works in a browser. Needs Chromium; without it the tests of the
//! browser say so and pass over.

#[path = "common/sweep.rs"]
mod support;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use support::{Place, SWEEP, bankshot, said};

/// Longest name that a profile allows, made of what breaks pages.
fn evil_name() -> String {
    let mut name = "</script><script>window.evil=1</script><img src=x onerror='window.evil=1'>&amp;\\\"' {{js}} ]]>"
        .repeat(6);
    name.truncate(495);
    name
}

fn chromium() -> Option<&'static str> {
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|name| Command::new(name).arg("--version").output().is_ok());
    if found.is_none() {
        eprintln!("passed over: there is no Chromium here");
    }
    found
}

/// Installed before the page's own script: keeps what goes wrong.
const BEFORE: &str = "<script>window.wrong = [];
addEventListener('error', (event) => wrong.push(event.message));
addEventListener('securitypolicyviolation', (event) => wrong.push('blocked ' + event.blockedURI));
console.error = (...words) => wrong.push(words.join(' '));</script>";

/// After it: does what a visitor does, and writes down what is then to be seen.
const AFTER: &str = r#"<script>
const seen = {};
const canvas = document.getElementById("view");
canvas.setPointerCapture = () => {};
const picture = () => {
  const bytes = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  let sum = 0;
  for (let i = 0; i < bytes.length; i++) sum = (sum * 31 + bytes[i]) | 0;
  return sum;
};
const key = (name) => canvas.dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
const drag = (name, x, y) => canvas.dispatchEvent(new PointerEvent(name, { pointerId: 1, clientX: x, clientY: y, bubbles: true }));
const pictures = [picture()];
key("ArrowLeft"); pictures.push(picture());
drag("pointerdown", 100, 100); drag("pointermove", 160, 120); drag("pointerup", 160, 120); pictures.push(picture());
const time = document.getElementById("time");
time.value = "300"; time.dispatchEvent(new Event("input")); pictures.push(picture());
key("+"); pictures.push(picture());
seen.pictures = new Set(pictures).size;
seen.size = [canvas.width, canvas.height];
const table = document.querySelector("table.sortable");
const column = (i) => [...table.tBodies[0].rows].map((row) => Number(row.cells[i].textContent));
const head = table.tHead.rows[0].cells[3];
const rising = (list) => list.every((value, i) => i === 0 || list[i - 1] <= value);
head.querySelector("button").click();
seen.sorted = [head.getAttribute("aria-sort"), rising(column(3))];
head.querySelector("button").click();
seen.turned = [head.getAttribute("aria-sort"), rising(column(3).reverse())];
const place = document.getElementById("place");
const words = [];
for (let i = 0; i <= Number(place.max); i++) {
  place.value = String(i); place.dispatchEvent(new Event("input"));
  words.push(document.getElementById("place-name").textContent);
}
seen.places = new Set(words).size;
table.tBodies[0].rows[0].cells[0].click();
seen.chosen = document.querySelectorAll("tr.chosen").length;
seen.shown = document.getElementById("shown").textContent;
const kind = document.getElementById("kind");
kind.value = "bank"; kind.dispatchEvent(new Event("change"));
seen.bank = document.getElementById("shown").textContent;
document.getElementById("play").click();
seen.playing = document.getElementById("play").textContent;
seen.label = canvas.getAttribute("aria-label");
seen.requests = performance.getEntriesByType("resource").map((entry) => entry.name);
seen.evil = window.evil;
seen.wide = document.documentElement.scrollWidth - document.documentElement.clientWidth;
seen.wrong = window.wrong;
const result = document.createElement("pre");
result.id = "seen";
result.textContent = "SEEN" + JSON.stringify(seen) + "NEES";
document.body.append(result);
</script>"#;

/// What a visitor sees of a page.
fn visit(chromium: &str, page: &Path, width: u32) -> serde_json::Value {
    let html = fs::read_to_string(page).unwrap();
    let html = html.replacen("<head>", &format!("<head>{BEFORE}"), 1);
    let end = html.rfind("</body>").unwrap();
    let visited = page.with_file_name("visited.html");
    fs::write(&visited, format!("{}{AFTER}{}", &html[..end], &html[end..])).unwrap();
    let folder = tempfile::TempDir::new().unwrap();
    let output = Command::new(chromium)
        .args([
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-quic",
            "--no-first-run",
        ])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
            "--disable-sync",
        ])
        .arg(format!("--window-size={width},900"))
        .arg(format!("--user-data-dir={}", folder.path().display()))
        .arg("--dump-dom")
        .arg(format!("file://{}", visited.display()))
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout).into_owned();
    let seen = dom
        .rsplit_once("SEEN")
        .and_then(|(_, rest)| rest.split_once("NEES"))
        .unwrap_or_else(|| panic!("the page's script did not end: {dom:.2000}"))
        .0
        .replace("&lt;", "<")
        .replace("&gt;", ">")
        .replace("&amp;", "&");
    serde_json::from_str(&seen).unwrap()
}

fn report(folder: &Path) -> PathBuf {
    let output = bankshot().arg("report").arg(folder).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    folder.join("report.html")
}

/// A sweep with a name that breaks pages, and its folder.
fn swept(place: &Place) -> PathBuf {
    let out = place.out("sweep");
    let output = place.run(&out, &["--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    out
}

fn evil_sweep() -> Place {
    let name = evil_name();
    Place::with(
        &SWEEP
            .replace("name = \"small\"", &format!("name = '''{name}'''"))
            .replace("[shooter]", &format!("[shooter]\nname = '''{name}'''")),
    )
}

#[test]
fn contract_the_page_of_a_sweep_works_and_no_name_can_script_it() {
    let place = evil_sweep();
    let page = report(&swept(&place));
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.len() < 2_000_000);
    assert_eq!(html.matches("<script").count(), 2);
    assert!(!html.contains("<img"));
    assert!(
        !html.contains("http://")
            || html.matches("http://").count()
                == html.matches("http://www.w3.org/2000/svg").count()
    );
    assert!(!html.contains("https://"));
    let Some(chromium) = chromium() else { return };
    for width in [1280, 500] {
        let seen = visit(chromium, &page, width);
        assert_eq!(seen["wrong"], serde_json::json!([]), "{seen:#}");
        assert_eq!(seen["requests"], serde_json::json!([]), "{seen:#}");
        assert_eq!(seen["evil"], serde_json::Value::Null);
        assert_eq!(seen["pictures"], 5, "{seen:#}");
        assert_eq!(
            seen["sorted"],
            serde_json::json!(["ascending", true]),
            "{seen:#}"
        );
        assert_eq!(
            seen["turned"],
            serde_json::json!(["descending", true]),
            "{seen:#}"
        );
        assert_eq!(seen["places"], 9, "{seen:#}");
        assert_eq!(seen["chosen"], 2, "{seen:#}");
        assert!(
            seen["shown"].as_str().unwrap().starts_with("Direct: P "),
            "{seen:#}"
        );
        assert!(
            seen["bank"].as_str().unwrap().starts_with("Bank: P "),
            "{seen:#}"
        );
        assert_eq!(seen["playing"], "Stop");
        assert!(seen["label"].as_str().unwrap().contains("Bank: P "));
        // Nothing but tables and pictures scrolls sideways.
        assert_eq!(seen["wide"], 0, "{seen:#}");
    }
}

#[test]
fn contract_the_page_of_one_place_works() {
    let place = Place::new();
    let text = SWEEP.split("[shooter]").last().unwrap();
    let profile = place.out("profile.toml");
    fs::write(
        &profile,
        format!("[location]\ndistance = \"12 ft\"\nangle = \"50 deg\"\n[shooter]\nname = '''{}'''{text}", evil_name()),
    )
    .unwrap();
    let output = bankshot()
        .args(["best", "--quiet"])
        .arg(&profile)
        .arg("--out")
        .arg(place.out("best"))
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let run = fs::read_dir(place.out("best"))
        .unwrap()
        .next()
        .unwrap()
        .unwrap()
        .path();
    let page = report(&run);
    let html = fs::read_to_string(&page).unwrap();
    assert!(
        html.contains("What the shooter learns") && html.contains("without the error in speed")
    );
    let Some(chromium) = chromium() else { return };
    let seen = visit(chromium, &page, 1280);
    assert_eq!(seen["wrong"], serde_json::json!([]), "{seen:#}");
    assert_eq!(seen["requests"], serde_json::json!([]), "{seen:#}");
    assert_eq!(seen["evil"], serde_json::Value::Null);
    assert_eq!(seen["pictures"], 5, "{seen:#}");
    assert_eq!(seen["sorted"], serde_json::json!(["ascending", true]));
}

#[test]
fn contract_comparisons_are_drawn_and_reported() {
    let place = Place::new();
    let out = swept(&place);
    let pictures = place.out("pictures");
    let compare = |more: &[&Path]| {
        let mut command = bankshot();
        command.arg("compare").arg(&out).arg("--out").arg(&pictures);
        for path in more {
            command.arg("--against").arg(path);
        }
        command.output().unwrap()
    };
    let output = compare(&[]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    for name in [
        "bank_and_direct",
        "best_p",
        "best_kind",
        "best_pitch",
        "best_spin",
    ] {
        for ending in ["svg", "png"] {
            assert!(
                pictures.join(format!("{name}.{ending}")).exists(),
                "{name}.{ending}"
            );
        }
    }
    let again = fs::read(pictures.join("bank_and_direct.png")).unwrap();
    assert_eq!(compare(&[]).status.code(), Some(0));
    assert_eq!(
        fs::read(pictures.join("bank_and_direct.png")).unwrap(),
        again
    );
    // A steadier shooter over the same places.
    let better = Place::with(&SWEEP.replace("0.25 ft/s", "0.15 ft/s"));
    let other = swept(&better);
    let output = compare(&[&other]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(
        said(&output).contains("less shooter (small): +"),
        "{output:?}"
    );
    assert!(pictures.join("against.png").exists());
    assert!(report(&pictures).exists());
    // Apples and pears.
    let profile = concat!(env!("CARGO_MANIFEST_DIR"), "/configs/elite.toml");
    assert_eq!(compare(&[Path::new(profile)]).status.code(), Some(2));
    let output = bankshot()
        .arg("report")
        .arg(place.folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2), "{output:?}");
}

#[test]
fn contract_a_shot_is_drawn_with_its_swarm() {
    let place = Place::new();
    let trace = |plot: &Path| {
        bankshot()
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args([
                "trace",
                "configs/free_throw.toml",
                "--speed",
                "23.6 ft/s",
                "--pitch",
                "53.5 deg",
            ])
            .args(["--swarm", "12", "--plot"])
            .arg(plot)
            .output()
            .unwrap()
    };
    for name in ["shot.svg", "shot.png"] {
        let output = trace(&place.out(name));
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        assert!(fs::metadata(place.out(name)).unwrap().len() > 10_000);
    }
    let svg = fs::read_to_string(place.out("shot.svg")).unwrap();
    assert!(svg.contains("from the side") && svg.contains("facing the board"));
    let output = trace(&place.out("shot.gif"));
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(said(&output).contains("must end in .svg or .png"));
}
