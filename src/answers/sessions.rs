//! What changed between two sessions of a shooter.

use super::json::{Answer, Provenance};
use crate::fitting::{
    Interval, ProbabilityChange, SessionComparison, TWO_SIDED_95, change_of_share,
};
use crate::math::normal_distribution::quantile;
use crate::shooter::Profile;
use serde::Serialize;

/// What changed in one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct SessionChange {
    /// Such as `probability`, `polar_mean`.
    pub name: String,
    /// The unit of results.
    pub unit: &'static str,
    /// The size of the unit in SI units.
    pub size: f64,
    /// Before and after, in SI units.
    pub comparison: SessionComparison,
    /// The second over the first; of a standard deviation.
    pub ratio: Option<Interval>,
}

/// Whether a change is beyond chance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decision {
    /// It is.
    Made,
    /// It is not; about so many shots in each session would decide one of this size.
    Needs(f64),
    /// It is less than its own uncertainty, so its size says nothing.
    Unknown,
}

/// A change of so many standard errors is beyond chance although `tested` values were looked at
/// (Bonferroni).
#[must_use]
pub fn quantile_among(tested: usize) -> f64 {
    quantile(1.0 - 0.025 / tested as f64)
}

impl SessionChange {
    /// Whether the change is beyond chance although `tested` values were looked at.
    #[must_use]
    pub fn is_certain_among(&self, tested: usize) -> bool {
        let change = &self.comparison.change;
        change.mean.abs() > quantile_among(tested) * change.sd
    }

    /// Whether other draws may turn the verdict on a change among `tested` values.
    #[must_use]
    pub fn is_at_the_limit(&self, tested: usize) -> bool {
        let (z, error) = self.comparison.standard_errors();
        (z - self.quantile(tested)).abs() < 2.0 * error
    }

    /// Whether its own 95 % interval leaves out zero.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.comparison.is_decided()
    }

    /// That of P is what a comparison is made for: it is one test.
    fn is_probability(&self) -> bool {
        self.name == "probability"
    }

    fn quantile(&self, tested: usize) -> f64 {
        match self.is_probability() {
            true => TWO_SIDED_95,
            false => quantile_among(tested),
        }
    }

    /// Whether the change is decided, and else about how many shots in each session would decide
    /// one of this size: at the 95 % level for P, and with room for the `tested` values that were
    /// looked at for the others.
    #[must_use]
    pub fn decision(&self, tested: usize) -> Decision {
        let is_beyond = self.is_probability() || self.is_certain_among(tested);
        match self.comparison.shots_to_decide(self.quantile(tested)) {
            _ if self.is_decided() && is_beyond => Decision::Made,
            Some(shots) => Decision::Needs(shots),
            None => Decision::Unknown,
        }
    }
}

/// A session.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SessionAnswer {
    /// Its name.
    pub name: String,
    /// Its shots.
    pub shots: usize,
    /// Those that went in.
    pub made: usize,
    /// Shots with a result.
    pub with_result: usize,
}

/// A change of the makes.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ChangeOfMakes {
    /// `%`.
    pub unit: &'static str,
    /// The change.
    pub mean: f64,
    /// The lower end of its 95 % interval.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

/// A change for programs.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChangeAnswer {
    /// Such as `probability`, `polar_mean`.
    pub name: String,
    /// The unit of the three intervals.
    pub unit: &'static str,
    /// The first session.
    pub before: Interval,
    /// The second.
    pub after: Interval,
    /// The second less the first.
    pub change: Interval,
    /// The probability that it has grown.
    pub probability_of_growth: f64,
    /// The second over the first.
    pub ratio: Option<Interval>,
    /// Whether it is beyond chance.
    pub is_decided: bool,
    /// Whether other draws may turn that.
    pub is_at_the_limit: bool,
    /// About how many shots of each session would decide it.
    pub shots_to_decide: Option<f64>,
}

/// What changed between two sessions. Changes of P are in percent.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SessionsAnswer {
    /// Who shoots.
    pub shooter: String,
    /// The first session.
    pub before: SessionAnswer,
    /// The second.
    pub after: SessionAnswer,
    /// Of the makes, where both have results.
    pub change_of_makes: Option<ChangeOfMakes>,
    /// P first.
    pub changes: Vec<ChangeAnswer>,
    /// By the scatter.
    #[serde(rename = "change_of_probability_by_scatter")]
    pub by_scatter: Interval,
    /// By the means.
    #[serde(rename = "change_of_probability_by_mean_release")]
    pub by_mean_release: Interval,
    /// By the mean of the speed alone.
    #[serde(rename = "change_of_probability_by_speed_alone")]
    pub by_speed_alone: Interval,
    /// By the mean pitch angle alone.
    #[serde(rename = "change_of_probability_by_pitch_alone")]
    pub by_pitch_alone: Interval,
    /// By the mean polar angle alone.
    #[serde(rename = "change_of_probability_by_polar_alone")]
    pub by_polar_alone: Interval,
    /// By the scatter at the old means.
    #[serde(rename = "change_of_probability_by_scatter_first")]
    pub by_scatter_first: Interval,
    /// By the scatter at the new means.
    #[serde(rename = "change_of_probability_by_scatter_last")]
    pub by_scatter_last: Interval,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
}

impl SessionsAnswer {
    /// The comparison of two sessions.
    #[must_use]
    pub fn new(
        profile: &Profile,
        [before, after]: [SessionAnswer; 2],
        changes: &[SessionChange],
        causes: &ProbabilityChange,
    ) -> Self {
        let tested = changes.len() - 1;
        let percent = |interval: &Interval| interval.scaled(100.0);
        let change = |change: &SessionChange| {
            let comparison = &change.comparison;
            let decision = change.decision(tested);
            let scaled = |interval: &Interval| interval.scaled(1.0 / change.size);
            ChangeAnswer {
                name: change.name.clone(),
                unit: change.unit,
                before: scaled(&comparison.before),
                after: scaled(&comparison.after),
                change: scaled(&comparison.change),
                probability_of_growth: comparison.grew,
                ratio: change.ratio,
                is_decided: decision == Decision::Made,
                is_at_the_limit: change.is_at_the_limit(tested),
                shots_to_decide: match decision {
                    Decision::Needs(shots) => Some(shots.ceil()),
                    Decision::Made | Decision::Unknown => None,
                },
            }
        };
        let [by_scatter_first, by_scatter_last] =
            causes.by_scatter_first_and_last.each_ref().map(percent);
        let [by_speed_alone, by_pitch_alone, by_polar_alone] =
            causes.by_mean_alone.each_ref().map(percent);
        Self {
            shooter: profile.shooter().name.clone(),
            change_of_makes: change_of_makes(&before, &after),
            before,
            after,
            changes: changes.iter().map(change).collect(),
            by_scatter: percent(&causes.by_scatter),
            by_mean_release: percent(&causes.by_means),
            by_speed_alone,
            by_pitch_alone,
            by_polar_alone,
            by_scatter_first,
            by_scatter_last,
            provenance: Provenance::of(profile),
        }
    }
}

fn change_of_makes(before: &SessionAnswer, after: &SessionAnswer) -> Option<ChangeOfMakes> {
    let has_results = before.with_result > 0 && after.with_result > 0;
    has_results.then(|| {
        let makes = [before, after].map(|session| (session.made, session.with_result));
        let change = change_of_share(makes[0], makes[1]);
        ChangeOfMakes {
            unit: "%",
            mean: 100.0 * change.share,
            low: 100.0 * change.low,
            high: 100.0 * change.high,
        }
    })
}

impl Answer for SessionsAnswer {
    const NAME: &'static str = "sessions";
}
