//! Configuration files: from TOML to checked settings, with every error at its line.

mod diagnostics;
mod location_table;
#[cfg(feature = "app")]
mod locations_csv;
mod physics_table;
mod profile_file;
pub mod schema;
mod search_tables;
mod shooter_tables;
pub(crate) mod toml_reader;

pub use diagnostics::{ConfigError, Diagnostic};
#[cfg(feature = "app")]
pub use locations_csv::{NamedLocations, parse_locations};
#[cfg(feature = "app")]
pub use physics_table::is_physics_alone;
pub use physics_table::parse_physics;
pub use profile_file::{MAX_FILE_BYTES, MAX_TOML_BYTES, parse_profile};
#[cfg(feature = "app")]
pub(crate) use profile_file::{ReadSettings, read_settings, read_settings_of};
#[cfg(feature = "app")]
pub(crate) use toml_reader::parse_toml;
