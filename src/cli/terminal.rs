//! Standard output and standard error, without panics if they are closed.

use super::embedded_session;
use super::failure::{Failure, code};
use crate::shooter::is_control_or_direction;
use std::io::{self, Write};

/// Prints an answer. A closed reader (`| head -1`) is not a failure.
pub(crate) fn print_answer(text: &str) -> Result<u8, Failure> {
    print_bytes(text.as_bytes())
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

/// Prints a remark on standard error. A failure to print it is ignored.
pub(crate) fn print_remark(text: &str) {
    let text = harmless(text);
    if !embedded_session::take_remark(&text) {
        let _ = writeln!(io::stderr().lock(), "{text}");
    }
}

/// The text without characters that steer a terminal or turn the direction of text: a message can
/// quote any file.
fn harmless(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        if !matches!(c, '\n' | '\t') && is_control_or_direction(c) {
            safe.extend(c.escape_unicode());
        } else {
            safe.push(c);
        }
    }
    safe
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
