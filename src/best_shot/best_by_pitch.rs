//! The best shot at each of several pitch angles: how much the angle matters, if everything else
//! follows it.

use super::followed::{Starts, carried};
use super::found_shots::{NoShot, NotCleanShot};
use super::shot_table::{FoundAtPlace, ShotTableError, TableKind, TableShot, best, with_fixed};
use crate::probability::{Progress, Silent};
use crate::shooter::{Nominal, NominalVariable, Profile, ShotKind};

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

/// Every so many pitch angles, and at the last, all shots are searched; the optima of these are
/// followed to the angles between them.
const SEARCHED: usize = 5;

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
    let kinds: &[ShotKind] = match &kind {
        TableKind::One(kind) => std::slice::from_ref(kind),
        TableKind::Better => &ShotKind::ALL,
    };
    progress.begin("pitch angles", (kinds.len() * pitches_rad.len()) as u64);
    let of_kinds: Result<Vec<Vec<ShotAtPitch>>, ShotTableError> = kinds
        .iter()
        .map(|&kind| of_kind(profile, kind, pitches_rad, progress))
        .collect();
    progress.end();
    // A clean shot goes before one that is not.
    let rank = |row: &ShotAtPitch| (row.shot.is_some(), row.probability());
    let better = |first, second| {
        if rank(&second) > rank(&first) {
            second
        } else {
            first
        }
    };
    let best = of_kinds?.into_iter().reduce(|best, next| {
        let pairs = best.into_iter().zip(next);
        pairs.map(|(best, next)| better(best, next)).collect()
    });
    Ok(best.unwrap_or_default())
}

/// The best shots of one kind at each pitch angle.
fn of_kind(
    profile: &Profile,
    kind: ShotKind,
    pitches_rad: &[f64],
    progress: &dyn Progress,
) -> Result<Vec<ShotAtPitch>, ShotTableError> {
    let profiles: Vec<Profile> = pitches_rad
        .iter()
        .map(|&pitch_rad| with_fixed(profile, &[(NominalVariable::Pitch, pitch_rad)]))
        .collect::<Result<_, _>>()?;
    let last = profiles.len().saturating_sub(1);
    let is_searched = |number: usize| number.is_multiple_of(SEARCHED) || number == last;
    let mut found: Vec<Option<FoundAtPlace>> = profiles.iter().map(|_| None).collect();
    for (number, here) in profiles.iter().enumerate().filter(|(n, _)| is_searched(*n)) {
        found[number] = Some(best((here, Starts::Table), kind, &Silent)?);
        progress.advance(1);
    }
    for (number, here) in profiles
        .iter()
        .enumerate()
        .filter(|(n, _)| !is_searched(*n))
    {
        let before = number - number % SEARCHED;
        let starts: Vec<Nominal> = [before, (before + SEARCHED).min(last)]
            .into_iter()
            .filter_map(|near| Some((&profiles[near], found[near].as_ref()?)))
            .flat_map(|(near, found)| found.optima.iter().map(|shot| carried(near, here, shot)))
            .collect();
        found[number] = Some(best((here, Starts::of(&starts)), kind, &Silent)?);
        progress.advance(1);
    }
    let rows = pitches_rad.iter().zip(found.into_iter().flatten());
    let row = |(&pitch_rad, FoundAtPlace { shot, .. })| ShotAtPitch {
        pitch_rad,
        not_clean: match &shot {
            Err(NoShot::NotClean(shot)) => Some(*shot),
            _ => None,
        },
        shot: shot.ok(),
    };
    Ok(rows.map(row).collect())
}
