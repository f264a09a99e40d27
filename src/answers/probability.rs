//! P of one nominal shot.
//!
//! ```
//! use bankshot::answers::probability::{Computed, ProbabilityAnswer};
//! use bankshot::probability::{Sampler, Silent};
//! use bankshot::shooter::Nominal;
//! use bankshot::units::{DEGREE_RAD, FOOT_M, REV_RAD};
//!
//! let text = std::fs::read_to_string("configs/free_throw.toml")?;
//! let profile = bankshot::config::parse_profile(&text, "the example")?;
//! let shot = Nominal {
//!     speed_m_s: 24.4 * FOOT_M,
//!     pitch_rad: 52.0 * DEGREE_RAD,
//!     backspin_rad_s: 3.0 * REV_RAD,
//!     ..Nominal::default()
//! };
//! let (target, seed) = (0.01, profile.search().seed);
//! let estimate = Sampler::new(&profile).estimate(&shot, target, seed, &Silent);
//! let computed = Computed {
//!     method: "sobol",
//!     estimate: &estimate,
//!     has_error: true,
//!     misses: None,
//!     target,
//!     seed,
//! };
//! let answer = ProbabilityAnswer::new(&profile, &shot, &computed, None);
//! assert_eq!(answer.target_met, Some(true));
//! assert!(answer.probability > 0.6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::json::{Named, Provenance, si_name};
use crate::analysis::miss_breakdown::MissBreakdown;
use crate::fitting::{DrawProbabilities, Interval};
use crate::probability::Estimate;
use crate::shooter::{Nominal, Profile, ReleaseVariable};
use serde::Serialize;

/// P over the draws of a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OverDraws {
    /// Its mean and what the shots leave open.
    #[serde(flatten)]
    pub interval: Interval,
    /// The numerical standard error of the mean.
    pub numerical_standard_error: f64,
}

impl From<&DrawProbabilities> for OverDraws {
    fn from(draws: &DrawProbabilities) -> Self {
        Self {
            interval: draws.interval(),
            numerical_standard_error: draws.numerical_standard_error(),
        }
    }
}

/// P of one nominal shot, and what was computed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbabilityAnswer {
    /// Who shoots.
    pub shooter: String,
    /// How P was integrated.
    pub method: &'static str,
    /// P.
    pub probability: f64,
    /// Its standard error, if the method has one.
    pub standard_error: Option<f64>,
    /// The 95 % interval.
    pub interval_95: Option<(f64, f64)>,
    /// Simulated shots.
    pub shots: u64,
    /// The shares of all shots by how they end, the made ones first; if the method draws samples.
    pub shares: Option<Named<f64>>,
    /// Shots that the numerics gave up.
    pub unresolved: u64,
    /// The wanted standard error.
    pub target: f64,
    /// Whether it was reached.
    pub target_met: Option<bool>,
    /// The shot.
    pub nominal: Nominal,
    /// The standard deviations of its errors.
    pub standard_deviations: Named<f64>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Seed of the samples.
    pub seed: u64,
    /// P over the draws of a fit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over_draws: Option<OverDraws>,
}

/// How P was computed.
#[derive(Clone, Copy, Debug)]
pub struct Computed<'a> {
    /// The method.
    pub method: &'static str,
    /// What it found.
    pub estimate: &'a Estimate,
    /// Whether it states an error.
    pub has_error: bool,
    /// How shots were missed, if it draws samples.
    pub misses: Option<MissBreakdown>,
    /// The wanted standard error.
    pub target: f64,
    /// Seed of the samples.
    pub seed: u64,
}

impl ProbabilityAnswer {
    /// The answer for a shot of a profile.
    #[must_use]
    pub fn new(
        profile: &Profile,
        nominal: &Nominal,
        computed: &Computed<'_>,
        over_draws: Option<&DrawProbabilities>,
    ) -> Self {
        let estimate = computed.estimate;
        let sigmas = profile.shooter().dispersion.sigmas(nominal);
        let sigmas = ReleaseVariable::ALL.into_iter().zip(sigmas);
        let has_error = computed.has_error;
        Self {
            shooter: profile.shooter().name.clone(),
            method: computed.method,
            probability: estimate.probability,
            standard_error: has_error.then_some(estimate.standard_error),
            interval_95: has_error.then(|| estimate.interval_95()),
            shots: estimate.shots,
            shares: computed.misses.map(|misses| shares(estimate, &misses)),
            unresolved: estimate.unresolved,
            target: computed.target,
            target_met: has_error.then_some(estimate.standard_error <= computed.target),
            nominal: *nominal,
            standard_deviations: Named(
                sigmas
                    .map(|(of, sigma)| (si_name(of.name(), of.dimension()), sigma))
                    .collect(),
            ),
            provenance: Provenance::of(profile.hash()),
            seed: computed.seed,
            over_draws: over_draws.map(OverDraws::from),
        }
    }
}

/// Shares that make a shot; those that miss it come after them.
pub const MADE_SHARES: [&str; 4] = ["swish", "ring", "board", "board_and_ring"];

fn shares(estimate: &Estimate, misses: &MissBreakdown) -> Named<f64> {
    let made = &estimate.shares;
    let values = [made.swish, made.ring, made.board, made.board_and_ring];
    let all = MADE_SHARES.into_iter().zip(values).chain(misses.named());
    Named(all.map(|(name, share)| (name.to_owned(), share)).collect())
}
