//! The folder of a run of `best`: its name and its files.

use super::failure::{Failure, code};
use crate::answers::best_shots::BestShotsAnswer;
use crate::answers::json::{self, Provenance, document};
use crate::best_shot::BestShots;
use crate::escape::file_name;
use crate::files::atomic_file;
use crate::present::best_shot_csv::{best_shots_csv, curves_csv, sensitivity_csv};
use crate::shooter::Profile;
use crate::store::best_run::{ANSWER_FILE, BestRun};
use crate::sweep::SweepConfig;
use serde::Serialize;
use std::io::Write as _;
use std::path::{Path, PathBuf};

/// The folder, in that of a comparison, of the best shots of the other shooter.
pub(crate) const AGAINST_FOLDER: &str = "against";
/// The file that says which configuration a folder belongs to.
const PROVENANCE: &str = "provenance.json";
/// The files of a run.
const FILES: [&str; 8] = [
    "best_shots.csv",
    "best_shots.json",
    "curves.csv",
    "sensitivity.csv",
    "profile.toml",
    "plan.json",
    ANSWER_FILE,
    PROVENANCE,
];

/// The link, beside the numbered folders of a name, to the one that was written last.
const LATEST: &str = "latest";

/// The numbered folder of a run in `parent/NAME`: the first one that holds this very configuration,
/// or nothing yet. So the same run again finds its folder, and another configuration of the same
/// name never overwrites it.
fn numbered(parent: &Path, name: &str, hash: &str) -> PathBuf {
    let of_name = parent.join(file_name(name));
    let mut number = 1;
    loop {
        let folder = of_name.join(number.to_string());
        match configuration_hash(&folder) {
            Some(other) if other != hash => number += 1,
            _ => return folder,
        }
    }
}

/// The hash of the configuration whose results are in a folder.
fn configuration_hash(folder: &Path) -> Option<String> {
    [
        ("configuration.json", "hash"),
        (PROVENANCE, "configuration_blake3"),
    ]
    .into_iter()
    .find_map(|(file, key)| {
        let text = std::fs::read_to_string(folder.join(file)).ok()?;
        let json: serde_json::Value = serde_json::from_str(&text).ok()?;
        Some(json.get(key)?.as_str()?.to_owned())
    })
}

/// Points the link `latest` beside a numbered folder to it. A file system without links has none.
pub(crate) fn link_latest(folder: &Path) {
    let (Some(parent), Some(number)) = (folder.parent(), folder.file_name()) else {
        return;
    };
    let new = parent.join(format!("{LATEST}.{}", std::process::id()));
    #[cfg(unix)]
    if std::os::unix::fs::symlink(number, &new).is_ok()
        && std::fs::rename(&new, parent.join(LATEST)).is_err()
    {
        // The link is a help, no result.
        let _ = std::fs::remove_file(&new);
    }
    #[cfg(not(unix))]
    let _ = (number, new);
}

/// The usual folder of a profile's run, in the profile's output folder. It belongs to this profile
/// from now on, also beside other runs of the same name: whoever writes its provenance first has
/// it.
pub(crate) fn of_profile(profile: &Profile) -> Result<PathBuf, Failure> {
    let parent = Path::new(&profile.output().folder);
    loop {
        let folder = numbered(parent, &profile.shooter().name, profile.hash());
        let refuse = |error: std::io::Error| Failure::io(folder.display(), &error);
        std::fs::create_dir_all(&folder).map_err(refuse)?;
        match configuration_hash(&folder) {
            Some(hash) if hash == profile.hash() => return Ok(folder),
            // Another configuration has taken the number in the meantime.
            Some(_) => continue,
            None => {}
        }
        let claim = json::in_si(&Provenance::of(profile));
        let mut file = tempfile::NamedTempFile::new_in(&folder).map_err(refuse)?;
        writeln!(file, "{claim:#}").map_err(refuse)?;
        match file.persist_noclobber(folder.join(PROVENANCE)) {
            Ok(_) => return Ok(folder),
            // Another run has taken the number in the meantime.
            Err(error) if error.error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(refuse(error.error)),
        }
    }
}

/// The usual folder of a sweep.
pub(crate) fn of_sweep(config: &SweepConfig) -> Result<PathBuf, Failure> {
    let parent = Path::new(&config.settings.output.folder);
    Ok(numbered(parent, &config.name, &config.hash()?))
}

/// What a command writes into a folder.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum RunKind {
    Best,
    Fit,
    Sweep,
}

impl RunKind {
    const ALL: [Self; 3] = [Self::Sweep, Self::Fit, Self::Best];

    /// The name of its command, and a file that it alone writes.
    fn command_and_file(self) -> (&'static str, &'static str) {
        match self {
            Self::Best => ("best", "curves.csv"),
            Self::Fit => ("fit", "fit.json"),
            Self::Sweep => ("sweep", "configuration.json"),
        }
    }
}

/// Refuses a folder that holds the results of another command: some files have the same names.
pub(crate) fn refuse_other_results(folder: &Path, own: RunKind) -> Result<(), Failure> {
    for kind in RunKind::ALL {
        let (command, file) = kind.command_and_file();
        if kind != own && folder.join(file).exists() {
            return Err(Failure::usage(format!(
                "{}: has the results of `bankshot {command}`; name another folder",
                folder.display()
            )));
        }
    }
    Ok(())
}

/// Creates a folder and checks that it can be written to, before anything is computed.
pub(crate) fn prepare(folder: &Path, own: RunKind) -> Result<(), Failure> {
    refuse_other_results(folder, own)?;
    let refuse = |error: std::io::Error| Failure::io(folder.display(), &error);
    std::fs::create_dir_all(folder).map_err(refuse)?;
    tempfile::tempfile_in(folder).map_err(refuse)?;
    Ok(())
}

/// What a run was made from.
#[derive(Serialize)]
struct RunProvenance<'a> {
    #[serde(flatten)]
    provenance: Provenance,
    table_shots: u64,
    configuration_si: &'a Profile,
}

/// Writes the files of a run, with the text of the profile.
pub(crate) fn write_best_shots(
    folder: &Path,
    profile_text: String,
    profile: &Profile,
    best: &BestShots,
) -> Result<(), Failure> {
    let units = profile.output().units;
    let json = |value: &serde_json::Value| json::text(value).into_bytes();
    let plan = serde_json::to_value(&best.plan).map_err(Failure::bug)?;
    let provenance = RunProvenance {
        provenance: Provenance::of(profile),
        table_shots: best.plan.shots,
        configuration_si: profile,
    };
    let answer = BestRun::of(best, units).sealed(&profile_text);
    let contents = [
        best_shots_csv(profile, best, units),
        json(&document(&BestShotsAnswer::new(profile, best), units)),
        curves_csv(best, units),
        sensitivity_csv(best, units),
        profile_text.into_bytes(),
        json(&plan),
        answer.into_bytes(),
        json(&json::in_si(&provenance)),
    ];
    for (name, bytes) in FILES.into_iter().zip(contents) {
        let path = folder.join(name);
        atomic_file::write(&path, &bytes).map_err(|error| Failure::io(path.display(), &error))?;
    }
    Ok(())
}

/// Removes the files that [`write_best_shots`] wrote into a folder, and the folder if nothing else
/// is in it.
pub(crate) fn remove_best_shots(folder: &Path) {
    for name in FILES {
        // A file that does not exist needs no removal.
        let _ = std::fs::remove_file(folder.join(name));
    }
    let _ = std::fs::remove_dir(folder);
}

/// The exit code of a run of `best`: without any shot its answer is incomplete.
pub(crate) fn exit_code(profile: &Profile, best: &BestShots) -> u8 {
    let target = profile.search().standard_error;
    let is_imprecise = [&best.direct, &best.bank]
        .into_iter()
        .flatten()
        .any(|shot| shot.estimate.standard_error > target);
    if best.direct.is_err() && best.bank.is_err() {
        code::INCOMPLETE
    } else if is_imprecise {
        code::IMPRECISE
    } else {
        code::DONE
    }
}
