//! An estimated probability with its error.

use super::made_shot_counts::Counts;
use serde::Serialize;

/// P of one nominal shot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Estimate {
    /// Probability of making the shot: made shots over all shots.
    pub probability: f64,
    /// Its standard error, from the scatter of the replicates.
    pub standard_error: f64,
    /// Simulated shots.
    pub shots: u64,
    /// Shares of all shots by the way they were made. They sum to `probability`.
    pub shares: MadeShares,
    /// Shots that the numerics gave up. They count neither as made nor as missed.
    pub unresolved: u64,
    /// There are no errors, so all shots are the same.
    pub certain: bool,
}

/// Shares of all shots by the way they were made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct MadeShares {
    /// Without a touch.
    pub swish: f64,
    /// Off the ring first.
    pub ring: f64,
    /// Off the board, never the ring.
    pub board: f64,
    /// Off the board first, the ring later.
    pub board_and_ring: f64,
}

impl MadeShares {
    /// Off the board first.
    #[must_use]
    pub fn banked(&self) -> f64 {
        self.board + self.board_and_ring
    }
}

impl Estimate {
    /// The 95 % interval of P. It comes from the scatter of the replicates; where few shots were
    /// made, or few missed, it is Wilson's interval for the number of independent shots with the
    /// same standard error. Its upper end is raised by the share of unresolved shots, for these
    /// could have been made.
    #[must_use]
    pub fn interval_95(&self) -> (f64, f64) {
        let shots = self.shots.max(1) as f64;
        let (low, high) = if is_rare(self.probability, shots) && self.standard_error > 0.0 {
            let centre = shrunk(self.probability, shots);
            let independent_shots =
                centre * (1.0 - centre) / (self.standard_error * self.standard_error);
            wilson_interval(self.probability, independent_shots)
        } else {
            // Student's distribution with 31 degrees of freedom.
            let half = 2.04 * self.standard_error;
            (self.probability - half, self.probability + half)
        };
        let unresolved = self.unresolved as f64 / shots;
        (low.max(0.0), (high + unresolved).min(1.0))
    }

    /// From the counts of several replicates with `points` shots each.
    pub(super) fn from_replicates(counts: &[Counts], points: u64) -> Self {
        let n = counts.len() as f64;
        let per_replicate = points as f64;
        let means: Vec<f64> = counts
            .iter()
            .map(|count| count.made() as f64 / per_replicate)
            .collect();
        let probability = means.iter().sum::<f64>() / n;
        let all = counts
            .iter()
            .fold(Counts::default(), |sum, &count| sum.plus(count));
        let share = |count: u64| count as f64 / (n * per_replicate);
        let scatter = standard_error_of_mean(&means, probability);
        Self {
            probability,
            standard_error: standard_error(scatter, probability, n * per_replicate),
            shots: points * counts.len() as u64,
            shares: MadeShares {
                swish: share(all.swish),
                ring: share(all.ring),
                board: share(all.board),
                board_and_ring: share(all.board_and_ring),
            },
            unresolved: all.unresolved,
            certain: false,
        }
    }
}

/// Shots of the rarer outcome, made or missed, below which the scatter of the replicates is not
/// trusted alone.
const RARE: f64 = 200.0;
/// Shots of the rarer outcome at which the scatter and the binomial variance have the same weight.
const EVEN_WEIGHT: f64 = 2.5;

/// Whether few shots were made, or few missed.
fn is_rare(probability: f64, shots: f64) -> bool {
    probability.min(1.0 - probability) * shots < RARE
}

/// P with two more shots made and two more missed (Agresti and Coull 1998): never 0 or 1.
fn shrunk(probability: f64, shots: f64) -> f64 {
    (probability * shots + 2.0) / (shots + 4.0)
}

/// The standard error of P. Sobol points gain little where few shots are made or few missed, and
/// the scatter of few counts says little: there it is drawn towards the binomial standard error,
/// the more the fewer they are.
pub(super) fn standard_error(scatter: f64, probability: f64, shots: f64) -> f64 {
    if !is_rare(probability, shots) {
        return scatter;
    }
    let centre = shrunk(probability, shots);
    let binomial = centre * (1.0 - centre) / shots;
    let rarer = probability.min(1.0 - probability) * shots;
    let weight = EVEN_WEIGHT / (EVEN_WEIGHT + rarer);
    (weight * binomial + (1.0 - weight) * scatter * scatter).sqrt()
}

/// Wilson's 95 % interval for a share of independent shots.
fn wilson_interval(share: f64, shots: f64) -> (f64, f64) {
    const Z: f64 = 1.96;
    let z2 = Z * Z / shots;
    let centre = share + 0.5 * z2;
    let half = Z * (share * (1.0 - share) / shots + 0.25 * z2 / shots).sqrt();
    ((centre - half) / (1.0 + z2), (centre + half) / (1.0 + z2))
}

/// Standard error of the mean of independent values.
pub(crate) fn standard_error_of_mean(values: &[f64], mean: f64) -> f64 {
    let n = values.len() as f64;
    let squares: f64 = values
        .iter()
        .map(|value| (value - mean) * (value - mean))
        .sum();
    (squares / (n * (n - 1.0))).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_unresolved_shots_widen_the_interval_upwards() {
        let resolved = Estimate {
            probability: 0.5,
            standard_error: 0.01,
            shots: 1000,
            ..Estimate::default()
        };
        let unresolved = Estimate {
            unresolved: 20,
            ..resolved
        };
        let (low, high) = resolved.interval_95();
        assert_eq!(unresolved.interval_95(), (low, high + 0.02));
        let all = Estimate {
            unresolved: 1000,
            ..resolved
        };
        assert_eq!(all.interval_95().1, 1.0);
    }
}
