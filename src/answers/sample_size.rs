//! What a session of some size would tell of a shooter, before anyone shoots.

use super::json::{Answer, Provenance};
use serde::Serialize;

/// What sessions of one size tell.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SizeAnswer {
    /// Shots of the session.
    pub shots: usize,
    /// Simulated sessions.
    pub repetitions: u64,
    /// How far the scatter of the speed is known, as a share of it: one standard deviation.
    pub speed_sd_relative_error: f64,
    /// Relative error of the standard deviation of the release angle.
    pub pitch_sd_relative_error: f64,
    /// Relative error of the standard deviation of the direction.
    pub polar_sd_relative_error: f64,
    /// How far P is known by the fit.
    pub probability_error: f64,
    /// How far that is known itself, by the number of repetitions.
    pub simulation_error: f64,
    /// How far P is known by counting makes.
    pub counting_error: f64,
    /// The least change of P that shows.
    pub least_change_of_probability: f64,
}

/// The shots that show a change.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShotsForChange {
    /// The change of P.
    pub change_of_probability: f64,
    /// Of a second session after the first one; null if no number shows it.
    pub shots_in_second_session: Option<f64>,
    /// In each of two equal sessions.
    pub shots_in_each_of_two: f64,
}

/// A session that is there already.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FirstSessionAnswer {
    /// Its shots.
    pub shots: usize,
    /// How far it knows P.
    pub probability_error: f64,
    /// How far it knows the scatter, as a share of it.
    pub sd_relative_error: f64,
}

/// The size that makes P known so far.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TargetAnswer {
    /// The standard deviation of P.
    pub probability_error: f64,
    /// The shots.
    pub shots: usize,
}

/// The shots that show how a second shooter differs in one quantity.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShotsForDifference {
    /// The quantity.
    pub name: &'static str,
    /// The difference: of P, of a mean in SI units, or of a scatter as a share of it.
    pub change: f64,
    /// In each of two equal sessions.
    pub shots_in_each_of_two: f64,
    /// Of a second session after the first one.
    pub shots_in_second_session: Option<f64>,
}

/// How a second shooter differs.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AgainstAnswer {
    /// Who.
    pub shooter: String,
    /// In what.
    pub differences: Vec<ShotsForDifference>,
}

/// What sessions of several sizes tell.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SampleSizeAnswer {
    /// Who shoots.
    pub shooter: String,
    /// P of the shot that the sessions repeat.
    pub probability: f64,
    /// The tracker.
    pub tracker: String,
    /// Whether its noise was measured or is assumed.
    pub tracker_noise: String,
    /// The shots for the changes that were asked about.
    pub changes: Vec<ShotsForChange>,
    /// The session that is there already.
    pub first_session: Option<FirstSessionAnswer>,
    /// The sizes.
    pub tests: Vec<SizeAnswer>,
    /// The size that was asked for.
    pub target: Option<TargetAnswer>,
    /// A second shooter.
    pub against: Option<AgainstAnswer>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl Answer for SampleSizeAnswer {
    const NAME: &'static str = "sample_size";
}
