//! The folder of a run of `best`: what its page is made of.

use super::StoreError;
use super::sealed::{Sealed, seal};
use crate::analysis::probability_curves::ProbabilityCurve;
use crate::analysis::sensitivity::Sensitivity;
use crate::best_shot::{BestShot, BestShots};
use crate::config::parse_profile;
use crate::shooter::{Nominal, Profile, ShotKind};
use crate::units::UnitSystem;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The file of the answer, which seals the profile.
pub const ANSWER_FILE: &str = "answer.json";
/// The profile.
pub const PROFILE_FILE: &str = "profile.toml";

const AGAIN: &str = "run `bankshot best` again";

/// What a run of `best` found, as far as its page shows it (SI units).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BestRun {
    /// The units of the run, which can be others than the profile's.
    pub units: UnitSystem,
    /// The best shot of each kind that has one.
    pub shots: Vec<FoundShot>,
}

/// The best shot of a kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FoundShot {
    /// Direct or bank.
    pub kind: ShotKind,
    /// The shot.
    pub nominal: Nominal,
    /// Its P.
    pub probability: f64,
    /// Standard error of P.
    pub standard_error: f64,
    /// Where the centre of the ball meets the board: to the right, facing it, and above the hoop.
    pub board_point_m: Option<(f64, f64)>,
    /// How far past the hoop's centre the undisturbed path passes its plane.
    pub aim_past_centre_m: Option<f64>,
    /// P along each variable.
    pub curves: Vec<ProbabilityCurve>,
    /// What P depends on.
    pub sensitivity: Sensitivity,
}

impl FoundShot {
    fn of(kind: ShotKind, shot: &BestShot) -> Self {
        Self {
            kind,
            nominal: shot.nominal,
            probability: shot.estimate.probability,
            standard_error: shot.estimate.standard_error,
            board_point_m: shot.outcome.board_point_m.map(|(_, y, z)| (y, z)),
            aim_past_centre_m: shot.aim_past_centre_m,
            curves: shot.curves.clone(),
            sensitivity: shot.sensitivity.clone(),
        }
    }
}

impl BestRun {
    /// What a search found.
    #[must_use]
    pub fn of(best: &BestShots, units: UnitSystem) -> Self {
        let found = best.by_kind().into_iter();
        let shots = found.filter_map(|(kind, shot)| Some(FoundShot::of(kind, shot.as_ref().ok()?)));
        Self {
            units,
            shots: shots.collect(),
        }
    }

    /// The text of [`ANSWER_FILE`], beside the text of its profile.
    #[must_use]
    pub fn sealed(&self, profile: &str) -> String {
        let object = serde_json::to_value(self).unwrap_or_default();
        seal(object, &[(PROFILE_FILE, profile.as_bytes())])
    }

    /// Reads a folder: the profile, in the units of the run, and what was found.
    ///
    /// # Errors
    /// A file is missing or damaged.
    pub fn read(folder: &Path) -> Result<(Profile, Self), StoreError> {
        let sealed = Sealed::<Self>::read(&folder.join(ANSWER_FILE), AGAIN)?;
        let bytes = sealed.file(folder, PROFILE_FILE)?;
        let text = String::from_utf8_lossy(&bytes);
        let run = sealed.content;
        let origin = folder.join(PROFILE_FILE).display().to_string();
        let profile = parse_profile(&text, &origin)?;
        let profile = profile.with(|settings| settings.output.units = run.units)?;
        Ok((profile, run))
    }
}
