//! A draw of the posterior as a profile.

use super::measured_release::Place;
use super::posterior::Draw;
use crate::model::Physics;
use crate::shooter::{
    NominalVariable, Profile, ProfileError, ProfileSettings, SearchChoice, Shooter,
};
use crate::units::REV_RAD;

/// The search tries nominal backspins up to this, or to that of the shooter where it is greater,
/// rad/s.
const USUAL_MAX_BACKSPIN_RAD_S: f64 = 3.0 * REV_RAD;

/// The profile of a shooter with the dispersion of a draw, at a place.
///
/// # Errors
/// The values make no profile: they are beyond what a shooter can have.
pub fn fitted_profile(
    name: &str,
    physics: &Physics,
    draw: &Draw,
    place: &Place,
) -> Result<Profile, ProfileError> {
    let most = draw.means.iter().map(|mean| mean[3]).fold(0.0, f64::max);
    let mut settings = ProfileSettings::new(Shooter {
        name: name.to_owned(),
        release_height_m: place.release_height_m,
        max_backspin_rad_s: USUAL_MAX_BACKSPIN_RAD_S.max(most),
        max_side_spin_rad_s: 0.0,
        dispersion: draw.dispersion(),
    });
    settings.physics = physics.clone();
    settings.at(place.location)
}

/// A profile whose search does not change the backspin: one that was not measured is kept.
///
/// # Errors
/// The backspin is beyond what the shooter can have.
pub(super) fn with_backspin_kept(
    profile: &Profile,
    backspin_rad_s: f64,
) -> Result<Profile, ProfileError> {
    profile.with(|settings| {
        let chosen = settings.search.choice.iter();
        let others: Vec<NominalVariable> = chosen
            .filter(|chosen| *chosen != NominalVariable::Backspin)
            .collect();
        settings.search.choice = SearchChoice::only(&others);
        settings.nominal.backspin_rad_s = Some(backspin_rad_s);
    })
}
