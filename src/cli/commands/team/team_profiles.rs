//! The profiles of a team's players.

use crate::cli::config_files::{read_text, warnings_of_fit};
use crate::cli::failure::Failure;
use crate::cli::loaded_profile::LoadedProfile;
use crate::cli::terminal::print_hint;
use crate::cli::value_parsers::PhysicsArg;
use crate::escape::file_name;
use crate::shooter::{Profile, implausible_values};
use crate::store::fit::profile_file;
use crate::store::shooters::fits_within;
use crate::sweep::sweep_toml::is_sweep;
use std::collections::HashSet;
use std::path::{Path, PathBuf};

/// The files of the profiles: in place of the folder of a fit its profile, and those of all
/// shooters in place of the folder of their fits. With a number of a place those of that place.
fn files_of_players(paths: &[PathBuf], place: Option<u32>) -> Result<Vec<PathBuf>, Failure> {
    let mut fits: Vec<PathBuf> = Vec::new();
    for path in paths {
        match &fits_within(path)?[..] {
            [] => fits.push(path.clone()),
            shooters => fits.extend_from_slice(shooters),
        }
    }
    let files = fits.into_iter().map(|path| {
        let number = place.unwrap_or(1) as usize;
        let profile = path.join(profile_file(number - 1));
        if profile.is_file() || (path.is_dir() && place.is_some()) {
            profile
        } else {
            path
        }
    });
    Ok(files.collect())
}

/// The players' profiles. Each has a name of its own, which is also that of its folder.
pub(super) fn load_players(
    paths: &[PathBuf],
    place: Option<u32>,
) -> Result<Vec<(PathBuf, Profile)>, Failure> {
    let mut players: Vec<(PathBuf, Profile)> = Vec::new();
    let mut folders = HashSet::new();
    for path in files_of_players(paths, place)? {
        if is_sweep(&read_text(&path)?) {
            return Err(Failure::usage(format!(
                "{path}: this is a sweep, not a player; name the players alone, and the sweep with --sweep {path}",
                path = path.display()
            )));
        }
        let player = LoadedProfile::read(&path, &PhysicsArg::default())?.profile;
        let name = &player.shooter().name;
        if !folders.insert(file_name(name)) {
            return Err(Failure::usage(format!(
                "{}: two players have the name \"{name}\"; give each their own",
                path.display()
            )));
        }
        players.push((path, player));
    }
    Ok(players)
}

/// Warns of what is implausible in a player's profile, and of what its fit warned of.
pub(super) fn warn_of(path: &Path, player: &Profile) -> Result<(), Failure> {
    let of_fit = warnings_of_fit(path)?.into_iter();
    let of_fit = of_fit.map(|words| format!("its fit warned: {words}"));
    let implausible = implausible_values(player).into_iter();
    let implausible = implausible.map(|value| value.to_string());
    for words in implausible.chain(of_fit) {
        print_hint(&format!("{}: warning: {words}", player.shooter().name));
    }
    Ok(())
}
