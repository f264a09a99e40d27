//! P of a nominal shot along one of its variables.

use super::json::{Answer, Named, Provenance, si_name};
use crate::analysis::miss_breakdown::MissBreakdown;
use crate::fitting::AngleOverDraws;
use crate::probability::Estimate;
use crate::shooter::{Nominal, NominalVariable, Profile};
use serde::Serialize;

/// P of the shot with one value of the variable.
#[derive(Clone, Debug)]
pub struct PointAlong {
    /// The shot.
    pub nominal: Nominal,
    /// Its P.
    pub estimate: Estimate,
    /// How it is missed.
    pub misses: MissBreakdown,
    /// P over the draws of a fit, if one is given, and by how much it is less than where its mean
    /// is highest.
    pub over_draws: Option<AngleOverDraws>,
}

/// A point for programs.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointRow {
    /// The value, under the name of the variable.
    #[serde(flatten)]
    pub value: Named<f64>,
    /// P.
    pub probability: f64,
    /// Its numerical standard error.
    pub standard_error: f64,
    /// Simulated shots.
    pub shots: u64,
    /// The shares of all shots that miss, by how.
    pub misses: Named<f64>,
    /// P over the draws of a fit.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub over_draws: Option<AngleOverDraws>,
}

/// The values between which the best one lies in 95 of 100 draws.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BestOverDraws {
    /// The least.
    pub low: Named<f64>,
    /// The greatest.
    pub high: Named<f64>,
}

/// P along a variable.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AlongAnswer {
    /// Who shoots.
    pub shooter: String,
    /// The variable: `aim` for a polar angle from the line to the hoop's centre.
    pub variable: &'static str,
    /// The points.
    pub points: Vec<PointRow>,
    /// Where the best one lies.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub best_over_draws: Option<BestOverDraws>,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

/// What varies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Varied {
    /// The variable.
    pub variable: NominalVariable,
    /// Whether a polar angle is counted from the line to the hoop's centre.
    pub is_aim: bool,
}

impl Varied {
    /// The name of the variable.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.is_aim {
            true => "aim",
            false => self.variable.name(),
        }
    }

    /// The value in a shot, in SI units.
    #[must_use]
    pub fn value(self, profile: &Profile, nominal: &Nominal) -> f64 {
        let start = match self.is_aim {
            true => profile.location().angle_rad,
            false => 0.0,
        };
        nominal.get(self.variable) - start
    }

    fn named(self, profile: &Profile, nominal: &Nominal) -> Named<f64> {
        let name = si_name(self.name(), self.variable.dimension());
        Named(vec![(name, self.value(profile, nominal))])
    }
}

impl AlongAnswer {
    /// The points of a variable, in its order. `best` are the first and the last between which the
    /// best one lies over the draws of a fit.
    #[must_use]
    pub fn new(
        profile: &Profile,
        varied: Varied,
        points: &[PointAlong],
        best: Option<(usize, usize)>,
    ) -> Self {
        let at = |index: usize| varied.named(profile, &points[index].nominal);
        let row = |point: &PointAlong| {
            let misses = point.misses.named().into_iter();
            PointRow {
                value: varied.named(profile, &point.nominal),
                probability: point.estimate.probability,
                standard_error: point.estimate.standard_error,
                shots: point.estimate.shots,
                misses: Named(
                    misses
                        .map(|(name, share)| (name.to_owned(), share))
                        .collect(),
                ),
                over_draws: point.over_draws,
            }
        };
        Self {
            shooter: profile.shooter().name.clone(),
            variable: varied.name(),
            points: points.iter().map(row).collect(),
            best_over_draws: best.map(|(low, high)| BestOverDraws {
                low: at(low),
                high: at(high),
            }),
            provenance: Provenance::of(profile),
        }
    }
}

impl Answer for AlongAnswer {
    const NAME: &'static str = "probability_along";
}
