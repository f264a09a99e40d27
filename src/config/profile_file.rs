//! A shooter's profile as a TOML file.

use super::diagnostics::{ConfigError, Diagnostic, Problem};
use super::location_table::read_location;
use super::physics_table::read_physics;
use super::search_tables::{read_grid, read_output, read_search};
use super::shooter_tables::{read_nominal, read_shooter};
use super::toml_reader::{TableReader, parse_toml};
use crate::shooter::{Profile, ProfileError, ProfileSettings};

/// Largest file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 16 * 1024 * 1024;
/// Largest TOML file that is read, in bytes: what the parser reads in a second.
pub const MAX_TOML_BYTES: u64 = 1024 * 1024;

/// Parses a profile. `origin` names the file in messages.
///
/// ```
/// let text = r#"
///     [shooter]
///     release_height = "7 ft"
///     max_backspin = "3 rev/s"
///     [shooter.errors]
///     c10 = "0.25 ft/s"
///     c20 = "1.2 deg"
///     c30 = "1.22 deg"
///     c40 = "0.3 rev/s"
///     [location]
///     distance = "13.75 ft"
///     angle = "0 deg"
/// "#;
/// let profile = bankshot::config::parse_profile(text, "example")?;
/// assert_eq!(profile.location().distance_m, 13.75 * 0.3048);
/// # Ok::<(), bankshot::config::ConfigError>(())
/// ```
///
/// # Errors
/// Everything that is wrong with the profile.
pub fn parse_profile(text: &str, origin: &str) -> Result<Profile, ConfigError> {
    parse_toml(text, origin, |mut root, diagnostics| {
        let location_table = root.table("location", diagnostics);
        let read = read_settings(&mut root, diagnostics);
        let location = read_location(location_table.clone(), &read.settings.physics, diagnostics);
        root.report_unknown_keys(diagnostics);
        if !read.is_valid {
            return None;
        }
        match read.settings.at(location?) {
            Ok(profile) => Some(profile),
            Err(ProfileError::Settings(_)) => None,
            Err(error) => {
                diagnostics.push(location_table.table_diagnostic(error.to_string()));
                None
            }
        }
    })
}

/// The settings of a file.
pub(crate) struct ReadSettings {
    /// The settings. A value that is missing or wrong has a placeholder.
    pub(crate) settings: ProfileSettings,
    /// Whether nothing is wrong.
    pub(crate) is_valid: bool,
}

/// Reads and checks all of a profile except its location.
pub(crate) fn read_settings(
    root: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> ReadSettings {
    let before = diagnostics.len();
    let shooter = read_shooter(root, diagnostics);
    let mut settings = ProfileSettings::new(shooter);
    settings.nominal = read_nominal(root, diagnostics);
    (settings.physics, settings.integrator) = read_physics(root, diagnostics);
    read_settings_of(root, settings, before, diagnostics)
}

/// Reads the tables besides shooter, nominal values, physics and location into `settings`, and
/// checks all of them. The diagnostics from `before` on are those of this profile.
pub(crate) fn read_settings_of(
    root: &mut TableReader<'_, '_>,
    mut settings: ProfileSettings,
    before: usize,
    diagnostics: &mut Vec<Diagnostic>,
) -> ReadSettings {
    settings.grid = read_grid(root, diagnostics);
    settings.search = read_search(root, &settings.search, diagnostics);
    settings.output = read_output(root, settings.output.units, diagnostics);
    for error in settings.errors() {
        // A placeholder can be out of range too, but its key has been reported.
        let is_reported = diagnostics[before..]
            .iter()
            .any(|diagnostic| diagnostic.key == error.key);
        if !is_reported {
            let (key, span) = root.as_written(&error.key);
            diagnostics.push(Diagnostic {
                span,
                key,
                message: error.message,
                problem: Problem::Other,
            });
        }
    }
    ReadSettings {
        settings,
        is_valid: diagnostics.len() == before,
    }
}
