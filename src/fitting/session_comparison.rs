//! Two sessions of one shooter compared.

use super::draw_probabilities::DrawProbabilities;
use super::interval::Interval;
use super::posterior::{Draw, Posterior};

/// What changed in one quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct SessionComparison {
    /// Its values in the two sessions.
    pub before: Interval,
    /// See `before`.
    pub after: Interval,
    /// The second less the first.
    pub change: Interval,
    /// The probability that it has grown.
    pub grew: f64,
    /// Shots in each session that would decide about a change of this size (95 % level, 80 %
    /// power), if the present ones do not.
    pub shots_to_decide: Option<f64>,
}

/// The sum of the normal quantiles of 97.5 % and 80 %.
const POWER: f64 = 1.96 + 0.8416;

/// Compares the values of independent draws, in their order.
fn compare(before: &[f64], after: &[f64], shots: [usize; 2]) -> SessionComparison {
    let count = before.len().min(after.len());
    // The draws are independent, so any pairing will do.
    let changes: Vec<f64> = (0..count).map(|k| after[k] - before[k]).collect();
    let grew = changes.iter().filter(|change| **change > 0.0).count() as f64 / count as f64;
    let change = Interval::of(changes);
    let harmonic = 2.0 / (1.0 / shots[0] as f64 + 1.0 / shots[1] as f64);
    let needed = POWER * change.sd / change.mean.abs();
    let is_decided = change.low > 0.0 || change.high < 0.0;
    SessionComparison {
        before: Interval::of(before.to_vec()),
        after: Interval::of(after.to_vec()),
        change,
        grew,
        shots_to_decide: (!is_decided && needed.is_finite()).then_some(harmonic * needed * needed),
    }
}

/// Compares a function of the draws of two posteriors.
pub fn compare_sessions(
    [before, after]: [&Posterior; 2],
    value: impl Fn(&Draw) -> f64,
) -> SessionComparison {
    let values = |posterior: &Posterior| posterior.draws.iter().map(&value).collect::<Vec<_>>();
    let shots = [before.shots, after.shots];
    compare(&values(before), &values(after), shots)
}

/// The same for the probabilities of their draws.
#[must_use]
pub fn compare_probabilities(
    probabilities: [&DrawProbabilities; 2],
    shots: [usize; 2],
) -> SessionComparison {
    let [before, after] = probabilities;
    compare(&before.of_draws, &after.of_draws, shots)
}
