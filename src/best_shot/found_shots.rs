//! The best shots that a search finds, or why there are none.

use crate::analysis::probability_curves::ProbabilityCurve;
use crate::analysis::sensitivity::Sensitivity;
use crate::dynamics::Outcome;
use crate::probability::Estimate;
use crate::search_space::{PlanError, TablePlan};
use crate::shooter::{Nominal, ShotKind};
use crate::units::{DEGREE_RAD, FOOT_M};
use serde::Serialize;

/// A limit of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Limit {
    /// The smallest pitch angle.
    PitchMin,
    /// The largest pitch angle.
    PitchMax,
    /// No backspin.
    NoBackspin,
    /// The largest backspin.
    MaxBackspin,
    /// The largest side spin.
    MaxSideSpin,
    /// The largest speed.
    SpeedMax,
}

impl Limit {
    /// The name in tables and files, such as `max_backspin`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PitchMin => "pitch_min",
            Self::PitchMax => "pitch_max",
            Self::NoBackspin => "no_backspin",
            Self::MaxBackspin => "max_backspin",
            Self::MaxSideSpin => "max_side_spin",
            Self::SpeedMax => "speed_max",
        }
    }
}

/// The best shot of one kind.
#[derive(Clone, Debug)]
pub struct BestShot {
    /// The nominal shot.
    pub nominal: Nominal,
    /// Its probability.
    pub estimate: Estimate,
    /// P by the shots that the search found it with; `None` where it went by counts alone.
    pub search_probability: Option<f64>,
    /// The outcome of the error-free shot.
    pub outcome: Outcome,
    /// P along each variable of the shot.
    pub curves: Vec<ProbabilityCurve>,
    /// How P depends on errors, spin and height.
    pub sensitivity: Sensitivity,
    /// Where the undisturbed path passes the plane of the hoop: past the centre along its own
    /// direction, m (positive is long).
    pub aim_past_centre_m: Option<f64>,
    /// Upper bound of the probability that errors lead outside the table's pitch angles and
    /// backspins.
    pub mass_outside: f64,
    /// Limits of the search that the shot lies at.
    pub at_limits: Vec<Limit>,
    /// A more probable shot of the kind that misses without errors, if it is so by more than a shot
    /// in 100.
    pub more_probable: Option<NotCleanShot>,
}

/// A shot that misses when it has no errors, and goes in with some.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotCleanShot {
    /// Its kind.
    pub kind: ShotKind,
    /// The shot.
    pub nominal: Nominal,
    /// Its P.
    pub probability: f64,
}

impl NotCleanShot {
    /// Its release, such as `8.60 m/s (28.22 ft/s), 58.0 deg up`.
    #[must_use]
    pub fn in_words(&self) -> String {
        format!(
            "{:.2} m/s ({:.2} ft/s), {:.1} deg",
            self.nominal.speed_m_s,
            self.nominal.speed_m_s / FOOT_M,
            self.nominal.pitch_rad / DEGREE_RAD
        )
    }
}

impl BestShot {
    /// The share of its makes that are of the other kind than `kind`, its own: of a bank shot
    /// those that do not touch the board first.
    #[must_use]
    pub fn share_of_other_kind(&self, kind: ShotKind) -> f64 {
        let makes = self.estimate.probability.max(f64::MIN_POSITIVE);
        let banked = self.estimate.shares.banked() / makes;
        match kind {
            ShotKind::Direct => banked,
            ShotKind::Bank => 1.0 - banked,
        }
    }
}

/// The best shots from a location.
#[derive(Clone, Debug)]
pub struct BestShots {
    /// The plan of the search's table.
    pub plan: TablePlan,
    /// The best direct shot, or why there is none.
    pub direct: Result<BestShot, NoShot>,
    /// The best bank shot, or why there is none.
    pub bank: Result<BestShot, NoShot>,
}

impl BestShots {
    /// The best shot of each kind.
    pub fn by_kind(&self) -> [(ShotKind, &Result<BestShot, NoShot>); 2] {
        [
            (ShotKind::Direct, &self.direct),
            (ShotKind::Bank, &self.bank),
        ]
    }
}

/// Why there is no best shot of a kind.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoShot {
    /// No shot within the limits can go in.
    #[error("no {} shot within the limits can go in from this place", .0.name())]
    Impossible(ShotKind),
    /// No shot near the most probable one goes in without errors.
    #[error("no exact {} shot goes in from this place; the best such release makes {:.1} of 100, but misses when it is exact ({})", .0.kind.name(), 100.0 * .0.probability, .0.in_words())]
    NotClean(NotCleanShot),
}

/// Why the search could not start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BestShotError {
    /// There is no plan.
    #[error(transparent)]
    Plan(#[from] PlanError),
}
