//! The best shot at each of several pitch angles: how much the angle matters, if everything else
//! follows it.

use super::found_shots::{NoShot, NotCleanShot};
use super::shot_table::{ShotTableError, TableKind, TableShot, best_with_fixed};
use crate::probability::Progress;
use crate::shooter::{NominalVariable, Profile, ShotKind};

/// The best shot at one pitch angle.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotAtPitch {
    /// The pitch angle, rad.
    pub pitch_rad: f64,
    /// `None` where no shot goes in without an error.
    pub shot: Option<TableShot>,
    /// Where there is none, the most probable shot: it misses when it has no errors.
    pub not_clean: Option<NotCleanShot>,
}

impl ShotAtPitch {
    /// P of the most probable shot; zero where none goes in at all.
    #[must_use]
    pub fn probability(&self) -> f64 {
        let clean = self.shot.as_ref().map(|shot| shot.probability);
        let any = clean.or(self.not_clean.map(|shot| shot.probability));
        any.unwrap_or(0.0)
    }
}

/// The best shots at pitch angles (rad), in their order, of one kind, or at each angle of the kind
/// with the higher P (a clean shot goes before one that misses without errors): speed and polar
/// angle, and backspin if the profile's search has it, follow the pitch angle.
///
/// # Errors
/// A pitch angle is not possible, or the search is too large.
pub fn best_by_pitch(
    profile: &Profile,
    kind: TableKind,
    pitches_rad: &[f64],
    progress: &dyn Progress,
) -> Result<Vec<ShotAtPitch>, ShotTableError> {
    progress.begin("pitch angles", pitches_rad.len() as u64);
    let of_kind = |pitch_rad: f64, kind: ShotKind| {
        let found = best_with_fixed(profile, kind, &[(NominalVariable::Pitch, pitch_rad)])?;
        let not_clean = match &found {
            Err(NoShot::NotClean(shot)) => Some(*shot),
            _ => None,
        };
        Ok::<_, ShotTableError>(ShotAtPitch {
            pitch_rad,
            shot: found.ok(),
            not_clean,
        })
    };
    let shot_at = |&pitch_rad: &f64| {
        let shot = match kind {
            TableKind::One(kind) => of_kind(pitch_rad, kind)?,
            TableKind::Better => {
                let direct = of_kind(pitch_rad, ShotKind::Direct)?;
                let bank = of_kind(pitch_rad, ShotKind::Bank)?;
                // A clean shot goes before one that is not.
                let rank = |row: &ShotAtPitch| (row.shot.is_some(), row.probability());
                if rank(&bank) > rank(&direct) {
                    bank
                } else {
                    direct
                }
            }
        };
        progress.advance(1);
        Ok(shot)
    };
    let shots = pitches_rad.iter().map(shot_at).collect();
    progress.end();
    shots
}
