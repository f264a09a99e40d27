//! `bankshot fit`: a profile from measured shots.

mod failure;
mod files;
mod one_shooter;
mod options;
mod remarks;
mod several_shooters;
mod shooters_table;
mod unmeasured_parameters;

use crate::cli::failure::{Failure, code, refuse_file};
use crate::cli::terminal::is_quiet;
use crate::escape::file_name;
use crate::files::atomic_file::same_file;
use crate::store::fit::SHOTS_FILE;
use remarks::print_sides;
use std::path::{Path, PathBuf};

pub(crate) use failure::failure;
pub(crate) use options::FitOptions;
pub(crate) use remarks::{print_sessions, print_unused, report_rejected};
pub(crate) use several_shooters::fit_each;

pub(crate) fn run(options: &FitOptions) -> Result<u8, Failure> {
    unmeasured_parameters::check_names(&options.free)?;
    let file = options.measured.read(&options.shots)?;
    let out = options.out.clone().unwrap_or_else(|| {
        let folder = default_folder(&options.shots, &options.measured.session);
        // Where a fit of all shooters puts this one.
        match &options.measured.shooter {
            Some(name) => folder.join(file_name(name)),
            None => folder,
        }
    });
    refuse_file(&out)?;
    if same_file(&options.shots, &out.join(SHOTS_FILE)) {
        return Err(Failure::usage(format!(
            "--output {}: the fit would write its own {SHOTS_FILE} over your file; name another folder",
            out.display()
        )));
    }
    for shots in &file.shooters {
        report_rejected(&file, shots, file.shooters.len() == 1);
    }
    if !is_quiet() {
        // Before the fit: a wrong side makes it worthless.
        print_sides(&file.shooters);
        print_sessions(&file);
    }
    let is_complete = file.shooters.iter().all(|shots| shots.rejected.is_empty());
    let code = if is_complete {
        code::DONE
    } else {
        code::INCOMPLETE
    };
    if let [shots] = &file.shooters[..] {
        return Ok(one_shooter::fit(&file, shots, &out, options)?.max(code));
    }
    // A ring and the air are the same for all, a backspin is not.
    if options.free.iter().any(|name| name == "backspin") {
        file.only_shooter()?;
    }
    let worst = several_shooters::fit(&file, &out, options)?;
    Ok(worst.max(code))
}

/// `results/NAME-fit`, or `results/NAME-SESSION-fit` of some sessions alone.
fn default_folder(shots: &Path, sessions: &[String]) -> PathBuf {
    let mut stem = shots
        .file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    for session in sessions {
        stem += &format!("-{session}");
    }
    Path::new("results").join(format!("{}-fit", file_name(&stem)))
}
