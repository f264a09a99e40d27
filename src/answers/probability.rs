//! P of one nominal shot.
//!
//! ```
//! use bankshot::answers::nominal_shot::NominalRequest;
//! use bankshot::answers::probability::Effort;
//! use bankshot::probability::Silent;
//!
//! let text = std::fs::read_to_string("configs/free_throw.toml")?;
//! let profile = bankshot::config::parse_profile(&text, "the example")?;
//! let shot = NominalRequest {
//!     speed: Some("24.4 ft/s".into()),
//!     pitch: Some("52 deg".into()),
//!     ..NominalRequest::default()
//! };
//! let shot = shot.resolve(&profile).map_err(|errors| errors[0].clone())?;
//! let effort = Effort { target: Some(0.01), ..Effort::default() };
//! let (answer, _) = effort.probability(&profile, &shot, None, &Silent)?;
//! assert_eq!(answer.target_met, Some(true));
//! assert!(answer.probability > 0.6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use super::json::{Answer, Named, Provenance, si_name};
use super::nominal_shot::FieldError;
use super::rebounds::ReboundsAnswer;
use crate::analysis::miss_breakdown::{MissBreakdown, classify_misses};
use crate::fitting::{DrawProbabilities, Interval};
use crate::probability::{
    Estimate, MAX_SHOTS, MIN_SHOTS, Progress, Sampler, grid_integration, monte_carlo,
};
use crate::search_space::{PlanError, TablePlan};
use crate::shooter::{Nominal, Profile, ReleaseVariable};
use serde::{Deserialize, Serialize};

/// P over the draws of a fit.
#[cfg_attr(test, derive(schemars::JsonSchema))]
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
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbabilityAnswer {
    /// Who shoots.
    pub shooter: String,
    /// How P was integrated.
    pub method: Method,
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
    /// P over the draws of a fit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over_draws: Option<OverDraws>,
    /// Where the misses come down; null where nobody asked, and under the grid methods.
    pub rebounds: Option<ReboundsAnswer>,
}

/// The methods of computing P.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Scrambled Sobol points.
    #[default]
    Sobol,
    /// Plain random samples.
    MonteCarlo,
    /// The grid of Eq. 25 (Silverberg et al. 2003), shifted from line to line; for four errors
    /// only.
    Grid,
    /// Eq. 25 as printed in the paper, on one common grid (four errors only).
    PaperGrid,
}

impl Method {
    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Sobol => "sobol",
            Self::MonteCarlo => "monte-carlo",
            Self::Grid => "grid",
            Self::PaperGrid => "paper-grid",
        }
    }

    /// Whether it uses all points of a grid.
    #[must_use]
    pub fn is_grid(self) -> bool {
        matches!(self, Self::Grid | Self::PaperGrid)
    }
}

/// How P is computed, and how precisely.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Effort {
    /// The method.
    pub method: Method,
    /// The wanted standard error; else the profile's.
    pub target: Option<f64>,
    /// Greatest number of shots.
    pub budget: Option<u64>,
    /// Seed of the samples; else the profile's.
    pub seed: Option<u64>,
    /// Values along each axis of a grid.
    pub grid: Option<usize>,
}

/// Default values along each axis of the paper's grid.
const PAPER_GRID_VALUES: usize = 40;
/// Default values along each axis of the shifted grids.
const SHIFTED_GRID_VALUES: usize = 20;

impl Effort {
    fn seed(&self, profile: &Profile) -> u64 {
        self.seed.unwrap_or(profile.search().seed)
    }

    /// The wanted standard error.
    #[must_use]
    pub fn target(&self, profile: &Profile) -> f64 {
        self.target.unwrap_or(profile.search().standard_error)
    }

    /// Refuses what the method does not have.
    ///
    /// # Errors
    /// The first field that is wrong.
    pub fn check(&self, profile: &Profile) -> Result<(), FieldError> {
        let refuse = |field, message: String| Err(FieldError { field, message });
        let is_grid = self.method.is_grid();
        if self.grid.is_some() && !is_grid {
            let words = "only the methods grid and paper-grid have one";
            return refuse("grid", words.to_owned());
        }
        if self.budget.is_some() && is_grid {
            let words = "a grid uses all its points; give its values along each axis";
            return refuse("budget", words.to_owned());
        }
        if is_grid && !profile.shooter().dispersion.is_of_eq_25() {
            return refuse(
                "method",
                format!(
                    "{}: Eq. 25 has only independent errors of speed, pitch, polar angle and backspin; for others use sobol or monte-carlo",
                    self.method.name()
                ),
            );
        }
        Ok(())
    }

    /// P of a shot. `draws` is P over the draws of a fit, if it is known.
    ///
    /// # Errors
    /// The profile has no table that a grid could be laid in.
    pub fn probability(
        &self,
        profile: &Profile,
        nominal: &Nominal,
        draws: Option<&DrawProbabilities>,
        progress: &dyn Progress,
    ) -> Result<(ProbabilityAnswer, Estimate), PlanError> {
        let estimate = self.estimate(profile, nominal, progress)?;
        let misses = (!self.method.is_grid())
            .then(|| classify_misses(profile, nominal, &estimate, self.seed(profile)));
        let mut answer = self.answer(profile, nominal, &estimate, misses);
        answer.over_draws = draws.map(OverDraws::from);
        Ok((answer, estimate))
    }

    fn estimate(
        &self,
        profile: &Profile,
        nominal: &Nominal,
        progress: &dyn Progress,
    ) -> Result<Estimate, PlanError> {
        let (target, seed) = (self.target(profile), self.seed(profile));
        let budget = self.budget.unwrap_or(MAX_SHOTS);
        Ok(match self.method {
            Method::Sobol => {
                let budget = budget.max(MIN_SHOTS);
                Sampler::new(profile).estimate_within(nominal, target, budget, seed, progress)
            }
            Method::MonteCarlo => {
                monte_carlo::estimate_within(profile, nominal, target, budget, seed, progress)
            }
            Method::Grid => {
                let plan = TablePlan::for_search(profile)?;
                let n = self.grid.unwrap_or(SHIFTED_GRID_VALUES);
                grid_integration::shifted_grids(profile, &plan, nominal, n, seed, progress)
            }
            Method::PaperGrid => {
                let plan = TablePlan::for_search(profile)?;
                let n = self.grid.unwrap_or(PAPER_GRID_VALUES);
                let sum = grid_integration::common_grid(profile, &plan, nominal, n, progress);
                Estimate {
                    probability: sum.probability,
                    // The method gives no error.
                    standard_error: 0.0,
                    shots: sum.shots,
                    ..Estimate::default()
                }
            }
        })
    }

    fn answer(
        &self,
        profile: &Profile,
        nominal: &Nominal,
        estimate: &Estimate,
        misses: Option<MissBreakdown>,
    ) -> ProbabilityAnswer {
        let sigmas = profile.shooter().dispersion.sigmas(nominal);
        let sigmas = ReleaseVariable::ALL.into_iter().zip(sigmas);
        let has_error = self.method != Method::PaperGrid;
        let target = self.target(profile);
        ProbabilityAnswer {
            shooter: profile.shooter().name.clone(),
            method: self.method,
            probability: estimate.probability,
            standard_error: has_error.then_some(estimate.standard_error),
            interval_95: has_error.then(|| estimate.interval_95()),
            shots: estimate.shots,
            shares: misses.map(|misses| shares(estimate, &misses)),
            unresolved: estimate.unresolved,
            target,
            target_met: has_error.then_some(estimate.standard_error <= target),
            nominal: *nominal,
            standard_deviations: Named(
                sigmas
                    .map(|(of, sigma)| (si_name(of.name(), of.dimension()), sigma))
                    .collect(),
            ),
            provenance: Provenance {
                seed: self.seed(profile),
                ..Provenance::of(profile)
            },
            over_draws: None,
            rebounds: None,
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

impl Answer for ProbabilityAnswer {
    const NAME: &'static str = "probability";
}
