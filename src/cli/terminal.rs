//! Standard output and standard error, without panics if they are closed.

use super::embedded_session;
use super::failure::{Failure, code};
use crate::escape;
use crate::present::layout::TextAnswer;
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Prints an answer. A closed reader (`| head -1`) is not a failure.
pub(crate) fn print_answer(text: &str) -> Result<u8, Failure> {
    print_bytes(escape::terminal(text).as_bytes())
}

/// As [`print_answer`], for prose: lines of more than 80 columns are wrapped. What follows a label
/// stays in its column.
pub(crate) fn print_prose(text: &str) -> Result<u8, Failure> {
    print_answer(&wrapped(text))
}

/// Columns of a terminal of the usual width.
const COLUMNS: usize = 80;

/// Prose in lines of at most 80 columns, as [`print_prose`] prints it.
pub(crate) fn wrapped(text: &str) -> String {
    let mut wrapped = String::with_capacity(text.len());
    for line in text.lines() {
        if line.chars().count() <= COLUMNS {
            wrapped += line;
        } else {
            wrapped += &wrapped_line(line, column_of_text(line));
        }
        wrapped.push('\n');
    }
    wrapped
}

/// A line in lines of at most 80 columns, of which all but the first are indented.
pub(crate) fn wrapped_line(line: &str, indentation: usize) -> String {
    let hanging = " ".repeat(indentation);
    let options = textwrap::Options::new(COLUMNS)
        .subsequent_indent(&hanging)
        .break_words(false)
        .word_splitter(textwrap::WordSplitter::NoHyphenation);
    textwrap::fill(&with_bound_units(line), options).replace(NO_BREAK_SPACE, " ")
}

const NO_BREAK_SPACE: &str = "\u{a0}";

/// The line with each unit bound to its number.
fn with_bound_units(line: &str) -> String {
    const UNITS: [&str; 12] = [
        "%", "ft", "in", "m", "cm", "deg", "ft/s", "m/s", "rev/s", "s", "min", "MB",
    ];
    let mut bound = String::with_capacity(line.len());
    let mut follows_number = false;
    for (i, word) in line.split(' ').enumerate() {
        if i > 0 {
            let is_unit = UNITS.contains(&word.trim_end_matches([',', ';', '.', ':', ')']));
            bound += if follows_number && is_unit {
                NO_BREAK_SPACE
            } else {
                " "
            };
        }
        follows_number = word.trim_start_matches('(').parse::<f64>().is_ok();
        bound += word;
    }
    bound
}

/// The column of what follows the label of a line (two or more spaces stand between), or the
/// indentation.
fn column_of_text(line: &str) -> usize {
    let indentation = line.chars().take_while(|c| *c == ' ').count();
    let label = line.trim_start();
    match label.find("  ") {
        Some(end) if end < 16 => {
            let rest = label[end..].chars().take_while(|c| *c == ' ').count();
            indentation + label[..end].chars().count() + rest
        }
        _ => indentation,
    }
}

/// As [`print_answer`], for bytes.
pub(crate) fn print_bytes(bytes: &[u8]) -> Result<u8, Failure> {
    if embedded_session::take_answer(bytes) {
        return Ok(code::DONE);
    }
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Ok(()) => Ok(code::DONE),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(code::DONE),
        Err(error) => Err(Failure::io("standard output", &error)),
    }
}

/// Whether the user wants no remarks that can be left out, and no progress bars. It belongs to the
/// terminal, as the level of a log does.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Sets whether the user wants only what was asked for.
pub(crate) fn set_quiet(quiet: bool) {
    QUIET.store(quiet, Ordering::Relaxed);
}

/// See [`set_quiet`].
pub(crate) fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Whether the user wants everything that is known.
static DETAILS: AtomicBool = AtomicBool::new(false);

/// Sets whether the user wants everything that is known.
pub(crate) fn set_details(details: bool) {
    DETAILS.store(details, Ordering::Relaxed);
}

/// See [`set_details`].
pub(crate) fn has_details() -> bool {
    DETAILS.load(Ordering::Relaxed)
}

/// Prints an answer in text.
pub(crate) fn print_text(answer: &TextAnswer) -> Result<u8, Failure> {
    print_answer(&answer.text(has_details()))
}

/// Prints where an answer was saved and what comes next.
pub(crate) fn print_next(saved: Option<&Path>, next: &str) {
    print_hint("");
    if let Some(folder) = saved {
        print_hint(&format!("Saved: {}", folder.display()));
    }
    let more = if has_details() { "" } else { "More: --details" };
    match next {
        "" if more.is_empty() => {}
        "" => print_hint(more),
        next => print_hint(format!("Next:  {next:<50} {more}").trim_end()),
    }
}

/// Prints a remark that the user may not want.
pub(crate) fn print_hint(text: &str) {
    if !is_quiet() {
        print_remark(text);
    }
}

/// Prints a remark on standard error. A failure to print it is ignored.
pub(crate) fn print_remark(text: &str) {
    let text = escape::terminal(text);
    if embedded_session::take_remark(&text) {
        return;
    }
    let mut out = io::stderr().lock();
    let text = if out.is_terminal() {
        wrapped_remark(&text).into()
    } else {
        text
    };
    let text = if has_colours(&out) {
        coloured(&text).into()
    } else {
        text
    };
    let _ = writeln!(out, "{text}");
}

/// A remark in lines of at most 80 columns. Lines of a quoted file stay as they are: a mark below
/// one points into it.
fn wrapped_remark(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let is_quoted = line
            .find("-->")
            .or_else(|| line.find('|'))
            .is_some_and(|at| is_gutter(&line[..at]));
        // What can be pasted into a shell is not broken inside its quotes.
        let is_to_paste = line.starts_with("  --") || line.contains(" > ");
        if is_quoted || is_to_paste || line.chars().count() <= COLUMNS {
            line.to_owned()
        } else {
            wrapped_line(line, column_of_text(line) + 2)
        }
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Whether standard error is a terminal and the user has not asked for none
/// (<https://no-color.org>).
fn has_colours(out: &impl IsTerminal) -> bool {
    let is_set = |name| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let is_dumb = std::env::var_os("TERM").is_some_and(|name| name == "dumb");
    !is_set("NO_COLOR") && !is_dumb && (out.is_terminal() || is_set("CLICOLOR_FORCE"))
}

/// The text with the colours of cargo's messages: errors red, warnings yellow, places blue.
fn coloured(text: &str) -> String {
    const RED: &str = "\x1b[1;31m";
    const YELLOW: &str = "\x1b[1;33m";
    const BLUE: &str = "\x1b[1;34m";
    const PLAIN: &str = "\x1b[0m";
    let lines = text.lines().map(|line| {
        for (word, colour) in [("error", RED), ("warning", YELLOW), ("note", BLUE)] {
            if let Some(rest) = line.strip_prefix(word)
                && rest.starts_with(':')
            {
                return format!("{colour}{word}{PLAIN}{rest}");
            }
        }
        // A place, or a line of a quoted file: `  --> file:1:2`, `3 | text`, `  | ^^^^ text`.
        let (gutter, rest) = match line.find("-->").or_else(|| line.find('|')) {
            Some(at) if is_gutter(&line[..at]) => {
                let mark = if line[at..].starts_with('|') { 1 } else { 3 };
                line.split_at(at + mark)
            }
            _ => return line.to_owned(),
        };
        let is_mark = rest.trim_start().starts_with('^');
        if is_mark {
            format!("{BLUE}{gutter}{RED}{rest}{PLAIN}")
        } else {
            format!("{BLUE}{gutter}{PLAIN}{rest}")
        }
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Whether this can stand before the bar of a quoted line: spaces and its number.
fn is_gutter(text: &str) -> bool {
    text.chars().all(|c| c == ' ' || c.is_ascii_digit())
}

/// A time for people: `12 s`, `22 min`, `3.1 h`.
pub(crate) fn time_in_words(seconds: f64) -> String {
    if seconds < 90.0 {
        format!("{seconds:.0} s")
    } else if seconds < 90.0 * 60.0 {
        format!("{:.0} min", seconds / 60.0)
    } else {
        format!("{:.1} h", seconds / 3600.0)
    }
}

/// Prints an error on standard error.
pub(crate) fn print_error(text: &str) {
    let prefix = if text.starts_with("error: ") {
        ""
    } else {
        "error: "
    };
    print_remark(&format!("{prefix}{text}"));
}

/// Asks a question on a terminal; no where nobody can answer.
pub(crate) fn confirm(question: &str) -> bool {
    if is_quiet()
        || embedded_session::progress().is_some()
        || !io::stdin().is_terminal()
        || !io::stderr().is_terminal()
    {
        return false;
    }
    print_remark(&format!("{question} [y/n]"));
    let mut answer = String::new();
    io::stdin().read_line(&mut answer).is_ok()
        && matches!(answer.trim().to_lowercase().as_str(), "y" | "yes")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_long_lines_are_wrapped_below_their_text() {
        let line = format!("errors  {}", "speed 0.250 ft/s, ".repeat(8));
        let text = wrapped(&format!("short\n{line}\n"));
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "short");
        assert!(lines.iter().all(|line| line.chars().count() <= COLUMNS));
        assert!(lines.len() == 4 && lines[2].starts_with("        speed") || lines.len() == 3);
        let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_eq!(words(&lines[1..].join(" ")), words(&line));
        // A unit stays with its number.
        let line = "missed  ".to_owned() + &"short 10.32 %, ".repeat(12);
        assert!(
            !wrapped(&line)
                .lines()
                .any(|line| line.trim().starts_with('%'))
        );
        // No space is lost from a table.
        let table = format!("a{}b\n", " ".repeat(60));
        assert_eq!(wrapped(&table), table);
    }

    #[test]
    fn contract_times_have_a_unit_that_suits_them() {
        let words = [12.4, 89.0, 600.0, 5390.0, 11_160.0].map(time_in_words);
        assert_eq!(words, ["12 s", "89 s", "10 min", "90 min", "3.1 h"]);
    }

    #[test]
    fn contract_remarks_fit_a_terminal_and_quoted_lines_stay() {
        let quoted = format!("3 | {}\n  | {}^^^^", "long = 1 ".repeat(12), " ".repeat(90));
        // A message may start with an option; the option itself, to be copied, is indented.
        let message = format!("--pitch is missing{}", "; give it".repeat(9));
        assert_eq!(wrapped_remark(&message).lines().count(), 2);
        let option = format!("  --map '{}'", "a long name ".repeat(8));
        assert_eq!(wrapped_remark(&option), option);
        let error = format!("error: {}\n{quoted}", "a word or two ".repeat(8).trim_end());
        let text = wrapped_remark(&error);
        assert!(text.ends_with(&quoted), "{text}");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4);
        assert!(lines[..2].iter().all(|line| line.len() <= COLUMNS));
        assert!(
            lines[1].starts_with("  a ") || lines[1].starts_with("  w"),
            "{text}"
        );
    }

    #[test]
    fn contract_colours_leave_the_text_as_it_is() {
        let message =
            "error: a.b: is wrong\n --> file:3:1\n  |\n3 | b = 1\n  | ^^^^\nwarning: x | y\n";
        let with = coloured(message);
        assert!(with.starts_with("\x1b[1;31merror\x1b[0m: a.b"));
        assert!(with.contains("\x1b[1;31m ^^^^\x1b[0m"));
        let mut plain = String::new();
        let mut rest = with.as_str();
        while let Some((text, code)) = rest.split_once('\x1b') {
            plain += text;
            rest = code.split_once('m').unwrap().1;
        }
        assert_eq!((plain + rest).trim_end(), message.trim_end());
    }
}
