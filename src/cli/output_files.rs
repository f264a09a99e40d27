//! Files that `--output` names, beside what a command prints.

use super::failure::{Failure, code};
use super::terminal::{print_answer, print_hint, print_text};
use crate::files::atomic_file;
use crate::present::layout::TextAnswer;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// How an answer is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum OutputForm {
    Csv,
    Json,
    Text,
}

/// The form that a file's name asks for.
fn form_of(path: &Path) -> Result<OutputForm, Failure> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => Ok(OutputForm::Csv),
        Some("json") => Ok(OutputForm::Json),
        Some("txt") => Ok(OutputForm::Text),
        _ => Err(Failure::usage(format!(
            "--output: {}: the name must end in .csv, .json or .txt",
            path.display()
        ))),
    }
}

/// Says before anything is computed that an output could not be written after it.
pub(crate) fn check(paths: &[PathBuf]) -> Result<(), Failure> {
    for path in paths {
        form_of(path)?;
        if let Some(folder) = path.parent()
            && !folder.as_os_str().is_empty()
            && !folder.is_dir()
        {
            return Err(Failure {
                code: code::IO,
                message: format!("--output: there is no folder {}", folder.display()),
            });
        }
    }
    Ok(())
}

/// An answer in each of its forms.
pub(crate) trait Rendered {
    fn text(&self) -> TextAnswer;
    fn json(&self) -> Value;
    fn csv(&self) -> String;
}

/// Writes an answer into the outputs, each in the form that its name asks for, and prints it.
pub(crate) fn deliver(
    answer: &impl Rendered,
    paths: &[PathBuf],
    is_json: bool,
) -> Result<(), Failure> {
    let json = || format!("{:#}\n", answer.json());
    for path in paths {
        let content = match form_of(path)? {
            OutputForm::Csv => answer.csv(),
            OutputForm::Json => json(),
            OutputForm::Text => answer.text().text(true),
        };
        atomic_file::write(path, content.as_bytes())
            .map_err(|error| Failure::io(path.display(), &error))?;
    }
    match is_json {
        true => print_answer(&json())?,
        false => print_text(&answer.text())?,
    };
    Ok(())
}

/// Says which of some files there are now.
pub(crate) fn print_written<'a>(paths: impl Iterator<Item = &'a PathBuf>) {
    for path in paths.filter(|path| path.exists()) {
        print_hint(&format!("written: {}", path.display()));
    }
}
