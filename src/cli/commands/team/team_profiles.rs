//! The profiles of a team's players.

use crate::cli::config_files::{load_profile, read_text, warnings_of_fit};
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::cli::run_folder;
use crate::cli::shooter_folders;
use crate::cli::terminal::print_remark;
use crate::cli::value_parsers::PhysicsArg;
use crate::shooter::{Profile, implausible_values};
use crate::sweep::sweep_toml::is_sweep;
use std::path::PathBuf;

/// The files of the profiles: in place of the folder of a fit its profile, and those of all
/// shooters in place of the folder of their fits. With a number of a place those of that place.
fn files_of_players(paths: &[PathBuf], place: Option<u32>) -> Vec<PathBuf> {
    let fits = paths.iter().flat_map(|path| {
        let shooters = shooter_folders::of_shooters(path);
        if shooters.is_empty() {
            vec![path.clone()]
        } else {
            shooters
        }
    });
    fits.map(|path| {
        let number = place.unwrap_or(1) as usize;
        let profile = path.join(fit_folder::profile_file(number - 1));
        if profile.is_file() || (path.is_dir() && place.is_some()) {
            profile
        } else {
            path
        }
    })
    .collect()
}

/// The players' profiles. Each has a name of its own, which is also that of its folder.
pub(super) fn load_players(
    (paths, place): (&[PathBuf], Option<u32>),
    quiet: bool,
) -> Result<Vec<(PathBuf, Profile)>, Failure> {
    let mut players: Vec<(PathBuf, Profile)> = Vec::new();
    for path in files_of_players(paths, place) {
        if is_sweep(&read_text(&path)?) {
            return Err(Failure::usage(format!(
                "{path}: this is a sweep, not a player; name the players alone, and the sweep with --sweep {path}",
                path = path.display()
            )));
        }
        let player = load_profile(&path, &PhysicsArg::default(), true)?;
        if !quiet {
            let of_fit = warnings_of_fit(&path).into_iter();
            let of_fit = of_fit.map(|words| format!("its fit warned: {words}"));
            for words in implausible_values(&player).into_iter().chain(of_fit) {
                print_remark(&format!("{}: warning: {words}", player.shooter().name));
            }
        }
        let name = &player.shooter().name;
        let folder = run_folder::safe_name(name);
        if players
            .iter()
            .any(|(_, other)| run_folder::safe_name(&other.shooter().name) == folder)
        {
            return Err(Failure::usage(format!(
                "{}: two players have the name \"{name}\"; give each their own",
                path.display()
            )));
        }
        players.push((path, player));
    }
    Ok(players)
}
