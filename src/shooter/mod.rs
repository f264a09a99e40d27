//! The shooter: release errors, limits, location on the court, and the checked profile of all of them.

mod correlation;
mod dispersion;
mod identity_hash;
mod location;
mod nominal;
mod profile;
mod release_distribution;
mod release_variable;
mod search_settings;
mod setting_error;

pub use correlation::Correlation;
pub use dispersion::ReleaseDispersion;
pub use identity_hash::{IdentityError, identity_hash};
pub use location::{Location, LocationError};
pub use nominal::{Nominal, NominalOverrides};
pub use profile::{OutputSettings, Profile, ProfileError, ProfileSettings, Shooter};
pub use release_distribution::ReleaseDistribution;
pub use release_variable::{NominalVariable, ReleaseVariable};
pub use search_settings::{Search, SearchChoice, SearchSettings, TableGrid};
pub use setting_error::SettingError;
