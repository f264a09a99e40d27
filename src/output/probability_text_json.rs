//! The answer of `probability`: P of one nominal shot, as text and as JSON.

use super::fit_files::fit_json::probability_json;
use super::json_object::{Record, number, object, provenance};
use crate::analysis::miss_breakdown::MissBreakdown;
use crate::fitting::DrawProbabilities;
use crate::probability::Estimate;
use crate::shooter::{Nominal, Profile, ReleaseVariable};
use crate::units::{DEGREE_RAD, Dimension, REV_RAD};
use serde_json::Value;

/// Everything that is reported of one nominal shot.
#[derive(Debug)]
pub struct ProbabilityAnswer<'a> {
    /// The shooter and the location.
    pub profile: &'a Profile,
    /// The nominal shot.
    pub nominal: &'a Nominal,
    /// The method of integration.
    pub method: &'a str,
    /// P.
    pub estimate: &'a Estimate,
    /// How shots were missed, if the method draws samples.
    pub misses: Option<MissBreakdown>,
    /// Seed of the samples.
    pub seed: u64,
    /// Wanted standard error.
    pub target: f64,
}

impl ProbabilityAnswer<'_> {
    /// Whether the method states an error.
    fn has_error(&self) -> bool {
        self.method != "paper-grid"
    }

    /// The shares of all shots, the made ones first; empty for the grids.
    fn shares(&self) -> Vec<(&'static str, f64)> {
        let Some(misses) = &self.misses else {
            return Vec::new();
        };
        let made = &self.estimate.shares;
        let mut shares = vec![
            ("swish", made.swish),
            ("ring", made.ring),
            ("board", made.board),
            ("board_and_ring", made.board_and_ring),
        ];
        shares.extend(misses.named());
        shares
    }

    /// The nominal values, with units in the names.
    fn nominal(&self) -> Vec<(String, f64)> {
        let (long, metre) = self.profile.output().units.length();
        let nominal = self.nominal;
        vec![
            (format!("speed_{long}_s"), nominal.speed_m_s / metre),
            ("pitch_deg".to_owned(), nominal.pitch_rad / DEGREE_RAD),
            ("polar_deg".to_owned(), nominal.polar_rad / DEGREE_RAD),
            (
                "backspin_rev_s".to_owned(),
                nominal.backspin_rad_s / REV_RAD,
            ),
            (
                "rifle_spin_rev_s".to_owned(),
                nominal.rifle_spin_rad_s / REV_RAD,
            ),
            (
                "side_spin_rev_s".to_owned(),
                nominal.side_spin_rad_s / REV_RAD,
            ),
        ]
    }

    /// The standard deviations, with units in the names.
    fn sigmas(&self) -> Vec<(String, f64)> {
        let (long, metre) = self.profile.output().units.length();
        let sigmas = self.profile.shooter().dispersion.sigmas(self.nominal);
        ReleaseVariable::ALL
            .into_iter()
            .zip(sigmas)
            .map(|(variable, sigma)| {
                let name = variable.name();
                match variable.dimension() {
                    Dimension::Speed => (format!("{name}_{long}_s"), sigma / metre),
                    Dimension::Length => (format!("{name}_{long}"), sigma / metre),
                    Dimension::Angle => (format!("{name}_deg"), sigma / DEGREE_RAD),
                    _ => (format!("{name}_rev_s"), sigma / REV_RAD),
                }
            })
            .collect()
    }
}

/// The answer as one JSON object; P over the draws of a fit may be in it.
#[must_use]
pub fn answer_json(
    answer: &ProbabilityAnswer<'_>,
    over_draws: Option<&DrawProbabilities>,
) -> Value {
    let estimate = answer.estimate;
    let numbers = |values: Vec<(String, f64)>| {
        object(
            values
                .into_iter()
                .map(|(name, x)| (name, number(x)))
                .collect(),
        )
    };
    let with_error = |value: Value| {
        if answer.has_error() {
            value
        } else {
            Value::Null
        }
    };
    let (low, high) = estimate.interval_95();
    let shares: Record = answer
        .shares()
        .into_iter()
        .map(|(name, share)| (name.to_owned(), number(share)))
        .collect();
    let mut record: Record = vec![
        (
            "shooter".to_owned(),
            answer.profile.shooter().name.clone().into(),
        ),
        ("method".to_owned(), answer.method.into()),
        ("probability".to_owned(), number(estimate.probability)),
        (
            "standard_error".to_owned(),
            with_error(number(estimate.standard_error)),
        ),
        (
            "interval_95".to_owned(),
            with_error(vec![number(low), number(high)].into()),
        ),
        ("shots".to_owned(), estimate.shots.into()),
        (
            "shares".to_owned(),
            if shares.is_empty() {
                Value::Null
            } else {
                object(shares)
            },
        ),
        ("unresolved".to_owned(), estimate.unresolved.into()),
        ("target".to_owned(), number(answer.target)),
        (
            "target_met".to_owned(),
            with_error((estimate.standard_error <= answer.target).into()),
        ),
        ("nominal".to_owned(), numbers(answer.nominal())),
        ("standard_deviations".to_owned(), numbers(answer.sigmas())),
    ];
    record.extend(provenance(answer.profile.hash()));
    record.push(("seed".to_owned(), answer.seed.into()));
    record.extend(over_draws.map(|p| ("over_draws".to_owned(), probability_json(p))));
    object(record)
}

/// The answer as text.
#[must_use]
pub fn answer_text(answer: &ProbabilityAnswer<'_>) -> String {
    let estimate = answer.estimate;
    let (low, high) = estimate.interval_95();
    let shots = estimate.shots;
    let mut text = if answer.has_error() {
        let digits = decimals(estimate.standard_error);
        format!(
            "P = {:.digits$} ± {:.digits$} (95 %: {low:.digits$} to {high:.digits$}), {shots} shots by {}\n",
            estimate.probability, estimate.standard_error, answer.method
        )
    } else {
        format!(
            "P = {:.4}, {shots} shots by {} (its error is unknown; with n about 40 it was 0.004 to 0.02)\n",
            estimate.probability, answer.method
        )
    };
    let list = |values: Vec<(String, f64)>| {
        let parts = values.iter().filter(|(_, x)| *x != 0.0).map(|(name, x)| {
            let (words, unit) = split_unit(name);
            format!("{words} {x:.3} {unit}")
        });
        parts.collect::<Vec<_>>().join(", ")
    };
    text.push_str(&format!("shot    {}\n", list(answer.nominal())));
    let sigmas = list(answer.sigmas());
    let sigmas = if sigmas.is_empty() { "none" } else { &sigmas };
    text.push_str(&format!("errors  {sigmas} (standard deviations)\n"));
    let shares = answer.shares();
    for (label, part) in [("made", 0..4), ("missed", 4..shares.len())] {
        let Some(part) = shares.get(part) else {
            continue;
        };
        let parts: Vec<String> = part
            .iter()
            .filter(|(_, share)| *share >= 5e-5)
            .map(|(name, share)| format!("{} {:.2} %", name.replace('_', " "), 100.0 * share))
            .collect();
        if !parts.is_empty() {
            text.push_str(&format!("{label:7} {}\n", parts.join(", ")));
        }
    }
    text
}

/// Decimals that show a digit of the standard error, 4 to 9.
fn decimals(standard_error: f64) -> usize {
    (4..9)
        .find(|&digits| standard_error * libm::pow(10.0, digits as f64) >= 0.95)
        .unwrap_or(if standard_error > 0.0 { 9 } else { 4 })
}

/// `speed_ft_s` as `speed` and `ft/s`.
fn split_unit(name: &str) -> (String, &'static str) {
    let units = [
        ("_ft_s", "ft/s"),
        ("_rev_s", "rev/s"),
        ("_m_s", "m/s"),
        ("_deg", "deg"),
        ("_ft", "ft"),
        ("_m", "m"),
    ];
    for (suffix, unit) in units {
        if let Some(words) = name.strip_suffix(suffix) {
            return (words.replace('_', " "), unit);
        }
    }
    (name.to_owned(), "")
}
