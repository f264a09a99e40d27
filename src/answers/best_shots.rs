//! The best direct and the best bank shot from a place.
//!
//! ```
//! use bankshot::answers::best_shots::BestShotsAnswer;
//! use bankshot::answers::json::in_units;
//! use bankshot::probability::Silent;
//! use bankshot::units::UnitSystem;
//!
//! let text = r#"
//! location = { distance = "13.75 ft", angle = "0 deg" }
//! grid = { speed = 16, pitch = 10, polar = 10, backspin = 4 }
//! search = { standard_error = 0.01 }
//! [shooter]
//! release_height = "7 ft"
//! max_backspin = "3 rev/s"
//! errors = { speed = "0.25 ft/s", pitch = "1.2 deg", polar = "1.22 deg", backspin = "0.3 rev/s" }
//! "#;
//! let profile = bankshot::config::parse_profile(text, "the example")?;
//! let best = bankshot::best_shot::find(&profile, &Silent)?;
//! let answer = BestShotsAnswer::new(&profile, &best);
//! let direct = answer.direct.as_ref().unwrap();
//! assert!(direct.shot.probability > 0.6);
//! // The same for programs, in the units of results.
//! let json = in_units(&answer, UnitSystem::Metric);
//! assert!(json["direct"]["speed_m_s"].as_f64().unwrap() > 7.0);
//! assert_eq!(json["program"], "bankshot");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::json::{Answer, Named, Provenance, si_name};
use crate::analysis::bank_aim::closed_form_polar_rad;
use crate::analysis::sensitivity::{Difference, Sensitivity};
use crate::best_shot::{BestShot, BestShots, DraftShot, Limit, NotCleanShot};
use crate::dynamics::OutcomeKind;
use crate::shooter::{Profile, ReleaseVariable, ShotKind};
use serde::Serialize;

/// A gain in P.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Gain {
    /// By how much P is greater.
    pub gain: f64,
    /// Its numerical standard error.
    pub standard_error: f64,
}

impl From<Difference> for Gain {
    fn from(difference: Difference) -> Self {
        Self {
            gain: difference.value,
            standard_error: difference.standard_error,
        }
    }
}

/// What a search knows before it refines the best shots.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BestShotsDraft {
    /// The best shot of each kind so far.
    pub shots: Vec<DraftShot>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl Answer for BestShotsDraft {
    const NAME: &'static str = "best_shots_draft";
}

/// A more probable shot that misses when it has no errors.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NotClean {
    /// Its speed.
    pub speed_m_s: f64,
    /// Above the horizontal.
    pub pitch_rad: f64,
    /// From the court's long axis.
    pub polar_rad: f64,
    /// Its backspin.
    pub backspin_rad_s: f64,
    /// Its P.
    pub probability: f64,
}

impl From<NotCleanShot> for NotClean {
    fn from(shot: NotCleanShot) -> Self {
        Self {
            speed_m_s: shot.nominal.speed_m_s,
            pitch_rad: shot.nominal.pitch_rad,
            polar_rad: shot.nominal.polar_rad,
            backspin_rad_s: shot.nominal.backspin_rad_s,
            probability: shot.probability,
        }
    }
}

/// The best shot of a kind.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShotAnswer {
    /// Its speed.
    pub speed_m_s: f64,
    /// Above the horizontal.
    pub pitch_rad: f64,
    /// From the court's long axis.
    pub polar_rad: f64,
    /// Its backspin.
    pub backspin_rad_s: f64,
    /// Its spin about the vertical.
    pub side_spin_rad_s: f64,
    /// P of making it.
    pub probability: f64,
    /// Its numerical standard error.
    pub standard_error: f64,
    /// Simulated shots.
    pub shots: u64,
    /// The share of all shots that touch nothing and go in.
    pub share_swish: f64,
    /// The share that goes in off the ring.
    pub share_ring: f64,
    /// The share that goes in off the board.
    pub share_board: f64,
    /// Shots that the numerics gave up.
    pub unresolved: u64,
    /// How the shot without errors goes in.
    pub error_free_kind: OutcomeKind,
    /// What it touches.
    pub error_free_contacts: String,
    /// At which angle it falls through the ring.
    pub entry_angle_rad: Option<f64>,
    /// How far past the hoop's centre the undisturbed path passes.
    pub aim_past_centre_short_m: Option<f64>,
    /// Where the ball's centre meets the board: to the right, facing it.
    pub board_aim_across_short_m: Option<f64>,
    /// Height above the hoop of the ball's centre at the board.
    pub board_aim_above_hoop_short_m: Option<f64>,
    /// The highest point of the ball's centre.
    pub apex_above_floor_m: f64,
    /// From the release to the end.
    pub flight_time_s: f64,
    /// Upper bound of the probability that errors lead outside what was searched.
    pub mass_outside_bracket: f64,
    /// The limits of the search that it lies at, such as `max_backspin`, with spaces between them.
    pub at_limits: String,
    /// A more probable shot that is not clean.
    pub more_probable_not_clean: Option<NotClean>,
}

impl ShotAnswer {
    /// A shot that a search found.
    #[must_use]
    pub fn new(profile: &Profile, shot: &BestShot) -> Self {
        let (nominal, estimate, outcome) = (&shot.nominal, &shot.estimate, &shot.outcome);
        Self {
            speed_m_s: nominal.speed_m_s,
            pitch_rad: nominal.pitch_rad,
            polar_rad: nominal.polar_rad,
            backspin_rad_s: nominal.backspin_rad_s,
            side_spin_rad_s: nominal.side_spin_rad_s,
            probability: estimate.probability,
            standard_error: estimate.standard_error,
            shots: estimate.shots,
            share_swish: estimate.shares.swish,
            share_ring: estimate.shares.ring,
            share_board: estimate.shares.banked(),
            unresolved: estimate.unresolved,
            error_free_kind: outcome.kind,
            error_free_contacts: outcome.verdict.contacts.to_string(),
            entry_angle_rad: outcome.entry.map(|entry| entry.angle_rad),
            aim_past_centre_short_m: shot.aim_past_centre_m,
            board_aim_across_short_m: outcome.board_point_m.map(|(_, y, _)| y),
            board_aim_above_hoop_short_m: outcome.board_point_m.map(|(_, _, z)| z),
            apex_above_floor_m: outcome.apex_m + profile.physics().hoop_plane_height_m(),
            flight_time_s: outcome.verdict.time_s,
            mass_outside_bracket: shot.mass_outside,
            at_limits: limit_names(shot),
            more_probable_not_clean: shot.more_probable.map(NotClean::from),
        }
    }
}

/// The names of the limits that a shot lies at.
fn limit_names(shot: &BestShot) -> String {
    let limits = shot.at_limits.iter().copied();
    let names: Vec<&str> = limits.map(Limit::name).collect();
    names.join(" ")
}

/// What an error of a variable costs.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorCost {
    /// The variable.
    pub variable: ReleaseVariable,
    /// What its error away gains.
    pub without: Gain,
    /// What a tenth less error gains.
    pub a_tenth_less: Gain,
}

/// What another backspin gains.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OtherBackspin {
    /// The backspin.
    pub backspin_rad_s: f64,
    /// The gain.
    #[serde(flatten)]
    pub gain: Gain,
}

/// What another height of the release gains.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OtherHeight {
    /// The height.
    pub release_height_m: f64,
    /// The gain.
    #[serde(flatten)]
    pub gain: Gain,
}

/// What P of a shot depends on.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SensitivityAnswer {
    /// The least and the greatest value of each variable that goes in without errors.
    pub windows: Named<Option<(f64, f64)>>,
    /// What each error costs.
    pub errors: Vec<ErrorCost>,
    /// Other backspins.
    pub backspins: Vec<OtherBackspin>,
    /// Other heights.
    pub heights: Vec<OtherHeight>,
}

impl From<&Sensitivity> for SensitivityAnswer {
    fn from(sensitivity: &Sensitivity) -> Self {
        let windows = sensitivity.windows.iter().map(|window| {
            let variable = window.variable;
            let name = si_name(variable.name(), variable.dimension());
            (name, window.ends)
        });
        let errors = sensitivity.errors.iter().map(|cost| ErrorCost {
            variable: cost.variable,
            without: cost.without.into(),
            a_tenth_less: cost.a_tenth_less.into(),
        });
        let backspins = sensitivity.backspins.iter().map(|spin| OtherBackspin {
            backspin_rad_s: spin.value,
            gain: spin.gain.into(),
        });
        let heights = sensitivity.heights.iter().map(|height| OtherHeight {
            release_height_m: height.value,
            gain: height.gain.into(),
        });
        Self {
            windows: Named(windows.collect()),
            errors: errors.collect(),
            backspins: backspins.collect(),
            heights: heights.collect(),
        }
    }
}

/// The best shot of a kind with what it depends on.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct KindAnswer {
    /// The shot.
    #[serde(flatten)]
    pub shot: ShotAnswer,
    /// Of a bank shot the polar angle by the law of reflection.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub closed_form_polar_rad: Option<f64>,
    /// What its P depends on.
    pub sensitivity: SensitivityAnswer,
}

impl KindAnswer {
    fn new(profile: &Profile, kind: ShotKind, shot: &BestShot) -> Self {
        let closed_form = || closed_form_polar_rad(profile.physics(), profile.location());
        Self {
            shot: ShotAnswer::new(profile, shot),
            closed_form_polar_rad: (kind == ShotKind::Bank).then(closed_form),
            sensitivity: (&shot.sensitivity).into(),
        }
    }
}

/// The best shots from a place.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BestShotsAnswer {
    /// Who shoots.
    pub shooter: String,
    /// From how far.
    pub distance_m: f64,
    /// From the court's long axis.
    pub court_angle_rad: f64,
    /// Height of the ball's centre at the release.
    pub release_height_m: f64,
    /// The best direct shot.
    pub direct: Option<KindAnswer>,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub direct_reason: Option<String>,
    /// The best bank shot.
    pub bank: Option<KindAnswer>,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bank_reason: Option<String>,
    /// P of the bank shot less that of the direct one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bank_minus_direct: Option<Gain>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Shots of the search's table.
    pub table_shots: u64,
    /// All shots that were simulated for this answer, and for earlier ones of the same profile.
    pub simulated_shots: u64,
}

impl BestShotsAnswer {
    /// What a search found.
    #[must_use]
    pub fn new(profile: &Profile, best: &BestShots) -> Self {
        let [direct, bank] = best.by_kind().map(|(kind, shot)| match shot {
            Ok(shot) => (Some(KindAnswer::new(profile, kind, shot)), None),
            Err(reason) => (None, Some(reason.to_string())),
        });
        Self {
            shooter: profile.shooter().name.clone(),
            distance_m: profile.location().distance_m,
            court_angle_rad: profile.location().angle_rad,
            release_height_m: profile.shooter().release_height_m,
            direct: direct.0,
            direct_reason: direct.1,
            bank: bank.0,
            bank_reason: bank.1,
            bank_minus_direct: bank_minus_direct(best).map(Gain::from),
            provenance: Provenance::of(profile),
            table_shots: best.plan.shots,
            simulated_shots: profile.simulator().simulated_shots(),
        }
    }
}

/// P of the bank shot less that of the direct shot.
#[must_use]
pub fn bank_minus_direct(best: &BestShots) -> Option<Difference> {
    let (Ok(direct), Ok(bank)) = (&best.direct, &best.bank) else {
        return None;
    };
    let (direct, bank) = (&direct.estimate, &bank.estimate);
    Some(Difference {
        value: bank.probability - direct.probability,
        standard_error: libm::hypot(bank.standard_error, direct.standard_error),
    })
}

impl Answer for BestShotsAnswer {
    const NAME: &'static str = "best_shots";
}
