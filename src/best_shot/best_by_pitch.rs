//! The best shot at each of several pitch angles: how much the angle matters, if everything else
//! follows it.

use super::shot_table::{ShotTableError, TableShot, best_with_fixed};
use crate::probability::Progress;
use crate::shooter::{NominalVariable, Profile, ShotKind};

/// The best shot at one pitch angle.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotAtPitch {
    /// The pitch angle, rad.
    pub pitch_rad: f64,
    /// `None` where no shot goes in without an error.
    pub shot: Option<TableShot>,
}

/// The best shots of a kind at pitch angles (rad), in their order: speed and polar angle, and
/// backspin if the profile's search has it, follow the pitch angle.
///
/// # Errors
/// A pitch angle is not possible, or the search is too large.
pub fn best_by_pitch(
    profile: &Profile,
    kind: ShotKind,
    pitches_rad: &[f64],
    progress: &dyn Progress,
) -> Result<Vec<ShotAtPitch>, ShotTableError> {
    progress.begin("pitch angles", pitches_rad.len() as u64);
    let shot_at = |&pitch_rad: &f64| {
        let shot = best_with_fixed(profile, kind, &[(NominalVariable::Pitch, pitch_rad)])?;
        progress.advance(1);
        Ok(ShotAtPitch { pitch_rad, shot })
    };
    let shots = pitches_rad.iter().map(shot_at).collect();
    progress.end();
    shots
}
