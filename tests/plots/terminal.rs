//! The picture of a terminal in the README. `examples/draw_terminal.rs` draws it.

use bankshot::cli::answer_of;
use bankshot::probability::Silent;
use std::fmt::Write;
use std::sync::Arc;

/// The commands of the picture, and how many lines of each answer a reader takes in at a glance.
const COMMANDS: [(&str, usize); 2] = [
    ("best configs/free_throw.toml", 9),
    ("advise docs/data/gym_sensor.csv", 8),
];
/// Columns of the terminal.
const COLUMNS: usize = 80;
const LETTER: (f64, f64) = (8.43, 19.0);
const MARGIN: f64 = 18.0;

/// Draws what the commands print, run in the folder of the repository.
pub(crate) fn draw() -> std::io::Result<String> {
    let runs = tempfile::tempdir()?;
    // Whether a line is a command, and the line.
    let mut lines: Vec<(bool, String)> = Vec::new();
    for (command, count) in COMMANDS {
        let mut arguments: Vec<String> = vec!["bankshot".into(), "--quiet".into()];
        arguments.extend(command.split(' ').map(str::to_owned));
        if command.starts_with("best") {
            arguments.push("-o".into());
            arguments.push(runs.path().join("run").display().to_string());
        }
        let answer = answer_of(&arguments, Arc::new(Silent)).answer;
        let text = String::from_utf8(answer).map_err(std::io::Error::other)?;
        lines.push((true, format!("$ bankshot {command}")));
        let shown = text.lines().take(count);
        lines.extend(shown.map(|line| (false, line.to_owned())));
        lines.push((false, String::new()));
    }
    Ok(svg(&lines))
}

fn svg(lines: &[(bool, String)]) -> String {
    let width = 2.0 * MARGIN + COLUMNS as f64 * LETTER.0;
    let height = 2.0 * MARGIN + lines.len() as f64 * LETTER.1;
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"DejaVu Sans Mono, Menlo, Consolas, monospace\" font-size=\"14\">\n<rect width=\"{width:.0}\" height=\"{height:.0}\" rx=\"10\" fill=\"#1d232b\"/>\n"
    );
    for (number, (is_command, line)) in lines.iter().enumerate() {
        let y = MARGIN + (number as f64 + 0.75) * LETTER.1;
        let fill = if *is_command { "#7fd1ae" } else { "#e6e9ee" };
        let text = line
            .replace('&', "&amp;")
            .replace('<', "&lt;")
            .replace('>', "&gt;");
        // Writing to a String does not fail.
        let _ = writeln!(
            svg,
            "<text x=\"{MARGIN}\" y=\"{y:.1}\" fill=\"{fill}\" xml:space=\"preserve\">{text}</text>"
        );
    }
    svg + "</svg>\n"
}
