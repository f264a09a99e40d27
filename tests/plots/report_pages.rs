//! Report pages: they work in a browser, load nothing, and no name can run a script in them.

use super::browser::{chromium, visit};
use super::support::{SMALL_SWEEP, SweepRun, bankshot, succeed, write_report};
use serde_json::{Value, json};
use std::fs;

/// A name of nearly the greatest length that a profile allows, made of text that could break a
/// page.
fn hostile_name() -> String {
    let mut name = "</script><script>window.evil=1</script><img src=x onerror='window.evil=1'>&amp;\\\"' {{js}} ]]>"
        .repeat(6);
    name.truncate(495);
    name
}

/// A sweep whose name and shooter have the hostile name.
fn hostile_sweep() -> SweepRun {
    let name = hostile_name();
    let config = SMALL_SWEEP
        .replace("name = \"small\"", &format!("name = '''{name}'''"))
        .replace("[shooter]", &format!("[shooter]\nname = '''{name}'''"));
    SweepRun::new(&config)
}

/// A profile of the small sweep's shooter, with the hostile name, at one location.
fn hostile_profile() -> String {
    let (_, shooter) = SMALL_SWEEP.split_once("[shooter]").unwrap();
    let location = "[location]\ndistance = \"12 ft\"\nangle = \"50 deg\"\n";
    format!(
        "{location}[shooter]\nname = '''{}'''{shooter}",
        hostile_name()
    )
}

/// Checks that the page did what it should and nothing went wrong.
#[track_caller]
fn assert_works(seen: &Value) {
    assert_eq!(seen["wrong"], json!([]), "{seen:#}");
    assert_eq!(seen["requests"], json!([]), "{seen:#}");
    assert_eq!(seen["evil"], Value::Null, "{seen:#}");
    assert_eq!(seen["pictures"], 5, "{seen:#}");
    assert_eq!(seen["sorted"], json!(["ascending", true]), "{seen:#}");
}

#[track_caller]
fn assert_starts_with(value: &Value, start: &str) {
    assert!(value.as_str().unwrap().starts_with(start), "{value}");
}

#[test]
fn contract_the_page_of_a_sweep_contains_no_foreign_script_or_address() {
    let sweep = hostile_sweep();
    let html = fs::read_to_string(write_report(&sweep.results())).unwrap();
    assert!(html.len() < 2_000_000);
    assert_eq!(html.matches("<script").count(), 2);
    assert!(!html.contains("<img"));
    // Names of formats, which nothing loads.
    let namespaces = ["2000/svg", "1999/xhtml"];
    let namespaces =
        namespaces.map(|name| html.matches(&format!("http://www.w3.org/{name}")).count());
    assert_eq!(
        html.matches("http://").count(),
        namespaces.iter().sum::<usize>()
    );
    assert!(!html.contains("https://"));
}

#[test]
fn contract_the_page_of_a_sweep_works_in_a_browser() {
    let Some(chromium) = chromium() else { return };
    let sweep = hostile_sweep();
    let page = write_report(&sweep.results());
    for width in [1280, 390] {
        let seen = visit(chromium, &page, width);
        assert_works(&seen);
        assert_eq!(seen["turned"], json!(["descending", true]), "{seen:#}");
        assert_eq!(seen["places"], 9, "{seen:#}");
        assert_eq!(seen["chosen"], 2, "{seen:#}");
        let from = "From 8 ft from the hoop, straight in front.";
        assert_starts_with(&seen["shown"], &format!("{from} Direct: "));
        assert_starts_with(&seen["bank"], &format!("{from} Bank: "));
        assert_eq!(seen["playing"], "Stop");
        assert!(seen["label"].as_str().unwrap().contains("Bank: "));
        // Only tables and plots scroll sideways.
        assert_eq!(seen["wide"], 0, "{seen:#}");
    }
}

#[test]
fn contract_the_page_of_one_location_shows_the_sensitivity_and_works_in_a_browser() {
    let folder = tempfile::TempDir::new().unwrap();
    let profile = folder.path().join("profile.toml");
    fs::write(&profile, hostile_profile()).unwrap();
    let runs = folder.path().join("runs");
    succeed(
        bankshot()
            .args(["best", "--quiet"])
            .arg(&profile)
            .arg("--out")
            .arg(&runs),
    );
    let page = write_report(&runs);
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("What matters most") && html.contains("no scatter in speed"));
    assert!(html.contains("Where to aim") && !html.contains("rests on the physics"));
    succeed(
        bankshot()
            .args(["report", "--with-physics", "--quiet"])
            .arg(&runs),
    );
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("How much rests on the physics"));
    assert!(html.contains("ring restitution 0.41"));
    let Some(chromium) = chromium() else { return };
    for width in [1280, 390] {
        let seen = visit(chromium, &page, width);
        assert_works(&seen);
        assert_eq!(seen["wide"], 0, "{seen:#}");
    }
}
