//! Opens a page in Chromium and does what a visitor does.

use std::fs;
use std::path::Path;
use std::process::Command;

/// The name of Chromium's program; `None` if it is not installed. With `BANKSHOT_NO_SKIP` in the
/// environment, a missing Chromium is a failure.
pub(crate) fn chromium() -> Option<&'static str> {
    let found = ["chromium", "chromium-browser", "google-chrome"]
        .into_iter()
        .find(|name| Command::new(name).arg("--version").output().is_ok());
    if found.is_none() {
        assert!(
            std::env::var_os("BANKSHOT_NO_SKIP").is_none(),
            "chromium is not installed, but BANKSHOT_NO_SKIP is set"
        );
        eprintln!("skipped: chromium is not installed");
    }
    found
}

/// Installed before the page's own script: records errors and blocked requests.
const BEFORE: &str = "<script>window.wrong = [];
addEventListener('error', (event) => wrong.push(event.message));
addEventListener('securitypolicyviolation', (event) => wrong.push('blocked ' + event.blockedURI));
console.error = (...words) => wrong.push(words.join(' '));</script>";

/// Runs after the page's own script: does what a visitor does, and records what the page then
/// shows.
const AFTER: &str = include_str!("use_report_page.js");

/// What a visitor sees of a page in a window of some width, px.
pub(crate) fn visit(chromium: &str, page: &Path, width: u32) -> serde_json::Value {
    let html = fs::read_to_string(page).unwrap();
    let html = html.replacen("<head>", &format!("<head>{BEFORE}"), 1);
    let end = html.rfind("</body>").unwrap();
    let (body, rest) = html.split_at(end);
    let visited = page.with_file_name("visited.html");
    fs::write(&visited, format!("{body}<script>\n{AFTER}</script>{rest}")).unwrap();
    let folder = tempfile::TempDir::new().unwrap();
    let output = Command::new(chromium)
        .args([
            "--headless",
            "--no-sandbox",
            "--use-gl=angle",
            "--use-angle=swiftshader",
        ])
        .arg("--enable-unsafe-swiftshader")
        .args(["--disable-quic", "--no-first-run", "--disable-sync"])
        .args([
            "--disable-background-networking",
            "--disable-component-update",
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
