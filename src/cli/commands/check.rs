//! `bankshot check`: whether a profile or a sweep is valid.

use crate::cli::command_line_flags::CheckOptions;
use crate::cli::config_files::{load_profile, load_sweep, read_text};
use crate::cli::failure::Failure;
use crate::cli::terminal::print_answer;
use bankshot::search_space::TablePlan;
use bankshot::sweep::sweep_toml::is_sweep;
use bankshot::units::DEGREE_RAD;

pub(crate) fn run(options: &CheckOptions) -> Result<u8, Failure> {
    let path = options.profile.display();
    if is_sweep(&read_text(&options.profile)?) {
        let (config, _) = load_sweep(&options.profile)?;
        let (name, places) = (&config.name, config.places.len());
        return print_answer(&format!("{path}: valid ({name}, {places} places)\n"));
    }
    let profile = load_profile(&options.profile, &options.physics)?;
    TablePlan::for_search(&profile)?;
    let (long, metre) = profile.output().units.length();
    let location = profile.location();
    print_answer(&format!(
        "{path}: valid ({}, {:.2} {long} from the hoop at {:.1} deg)\n",
        profile.shooter().name,
        location.distance_m / metre,
        location.angle_rad / DEGREE_RAD
    ))
}
