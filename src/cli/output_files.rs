//! Files that `--output` names, beside what a command prints.

use super::failure::{Failure, code};
use super::terminal::print_remark;
use crate::files::atomic_file;
use std::path::{Path, PathBuf};

/// How an answer is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum OutputForm {
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

/// Writes the outputs, each in the form that its name asks for.
pub(crate) fn write(
    paths: &[PathBuf],
    content: impl Fn(OutputForm) -> String,
) -> Result<(), Failure> {
    for path in paths {
        atomic_file::write(path, content(form_of(path)?).as_bytes())
            .map_err(|error| Failure::io(path.display(), &error))?;
    }
    Ok(())
}

/// Says which of some files there are now.
pub(crate) fn print_written<'a>(paths: impl Iterator<Item = &'a PathBuf>, quiet: bool) {
    for path in paths.filter(|path| !quiet && path.exists()) {
        print_remark(&format!("written: {}", path.display()));
    }
}
