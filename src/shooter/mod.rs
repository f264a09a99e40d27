//! The shooter: release errors, limits, location on the court, and the checked profile of all of
//! them.

mod correlation;
mod identity_hash;
mod invalid_setting;
mod location;
mod nominal;
mod plausibility;
mod profile;
mod release_distribution;
mod release_errors;
mod release_variable;
mod search_settings;
mod shot_kind;

pub use correlation::Correlation;
pub use identity_hash::{IdentityError, identity_hash};
pub use invalid_setting::SettingError;
pub use location::{Location, LocationError};
pub use nominal::{Nominal, NominalOverrides};
pub use plausibility::{Implausible, implausible_values, nominal_values_not_fixed};
pub use profile::{OutputSettings, Profile, ProfileError, ProfileSettings, Shooter};
pub use release_distribution::ReleaseDistribution;
pub(crate) use release_distribution::{LEAST_WIDE_SPIN_RAD_S, NormalsMap};
pub use release_errors::ReleaseDispersion;
pub use release_variable::{NominalVariable, ReleaseVariable};
pub use search_settings::{Search, SearchChoice, SearchSettings, TableGrid};
pub use shot_kind::ShotKind;
