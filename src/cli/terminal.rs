//! Standard output and standard error, without panics where they are closed.

use super::failure::{Failure, code};
use std::io::{self, Write};

/// Prints an answer. A reader that has gone away (`| head -1`) is no failure.
pub(crate) fn answer(text: &str) -> Result<u8, Failure> {
    answer_bytes(text.as_bytes())
}

/// As [`answer`], for bytes.
pub(crate) fn answer_bytes(bytes: &[u8]) -> Result<u8, Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Ok(()) => Ok(code::WHOLE),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(code::WHOLE),
        Err(error) => Err(Failure::io("standard output", &error)),
    }
}

/// Tells something on standard error; nothing can be done where that fails.
pub(crate) fn tell(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// Tells of an error on standard error.
pub(crate) fn complain(text: &str) {
    let prefix = if text.starts_with("error: ") {
        ""
    } else {
        "error: "
    };
    tell(&format!("{prefix}{text}"));
}
