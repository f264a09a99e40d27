//! Two sessions of one shooter compared.

use super::draw_probabilities::{DrawProbabilities, WeightedShots};
use super::interval::Interval;
use super::measured_release::Values;
use super::posterior::{Draw, Posterior, SpinSource};
use crate::math::normal_distribution::quantile;
use crate::shooter::Profile;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

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
    /// The harmonic mean of the shots of the two sessions.
    pub shots: f64,
    /// Draws of each posterior.
    pub draws: usize,
}

impl SessionComparison {
    /// Whether the 95 % interval of the change leaves out zero.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        self.change.low > 0.0 || self.change.high < 0.0
    }

    /// By how many of its standard errors it changed, and the numerical standard error of that
    /// number: mean and standard deviation are those of a finite number of draws.
    #[must_use]
    pub fn standard_errors(&self) -> (f64, f64) {
        let z = self.change.mean.abs() / self.change.sd;
        (z, ((1.0 + 0.5 * z * z) / self.draws.max(1) as f64).sqrt())
    }

    /// Shots in each session that would decide about a change of this size with 80 % power, where a
    /// change of `quantile` standard errors decides. `None` if the change is smaller than its
    /// standard deviation: its size then says nothing of the true one.
    #[must_use]
    pub fn shots_to_decide(&self, quantile: f64) -> Option<f64> {
        let needed = (quantile + QUANTILE_OF_POWER) * self.change.sd / self.change.mean.abs();
        (self.change.mean.abs() > self.change.sd).then_some(self.shots * needed * needed)
    }
}

/// The normal quantile of 97.5 %.
pub const TWO_SIDED_95: f64 = 1.96;
/// The normal quantile of 80 %.
const QUANTILE_OF_POWER: f64 = 0.8416;
/// A change of so many of its standard errors is seen at the 95 % level with a power of 80 %.
pub const POWER: f64 = TWO_SIDED_95 + QUANTILE_OF_POWER;

/// How often each draw is paired with one of the other fit.
const PAIRINGS: usize = 16;

/// Compares the values of the draws of two fits.
fn compare(before: &[f64], after: &[f64], shots: [usize; 2]) -> SessionComparison {
    let count = before.len().min(after.len());
    // Two fits with one seed have the same random numbers at the same place, and so values that
    // go together: pairs of equal places would make every change look sure. Other pairs are
    // independent.
    let changes: Vec<f64> = (1..=PAIRINGS)
        .map(|pairing| pairing * count / (PAIRINGS + 1))
        .flat_map(|shift| (0..count).map(move |k| after[(k + shift) % count] - before[k]))
        .collect();
    let grew = changes.iter().filter(|change| **change > 0.0).count() as f64 / changes.len() as f64;
    let change = Interval::of(changes);
    SessionComparison {
        before: Interval::of(before.to_vec()),
        after: Interval::of(after.to_vec()),
        change,
        grew,
        shots: 2.0 / (1.0 / shots[0] as f64 + 1.0 / shots[1] as f64),
        draws: count,
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

/// Compares the probabilities of the draws of two sessions.
#[must_use]
pub fn compare_probabilities(
    probabilities: [&DrawProbabilities; 2],
    shots: [usize; 2],
) -> SessionComparison {
    let [before, after] = probabilities;
    compare(&before.of_draws, &after.of_draws, shots)
}

/// How far the aims of a day lie from the shooter's own, in standard deviations of the shots
/// (assumed: two sessions cannot tell it).
pub const DAILY_FORM: f64 = 0.3;

/// Two sessions of a shooter at a place each, as if one tracker had measured them under one ring:
/// what no sensor sees is their mean in both, so that it does not count as a change. Form of the
/// day is added to the aims of each. The ring that they have in common is returned.
#[must_use]
pub fn share_unseen(
    [(before, place_before), (after, place_after)]: [(&mut Posterior, usize); 2],
) -> Option<f64> {
    let [one, other] = [before.typical(), after.typical()];
    let mean = |a: f64, b: f64| 0.5 * (a + b);
    let ring = one.ring_restitution.zip(other.ring_restitution);
    let ring = ring.map(|(one, other)| mean(one, other));
    let errors = (
        &one.constant_errors[place_before],
        &other.constant_errors[place_after],
    );
    let error: Values = std::array::from_fn(|i| mean(errors.0[i], errors.1[i]));
    let is_measured = before.spin == SpinSource::Measured && after.spin == SpinSource::Measured;
    let backspin = mean(one.means[place_before][3], other.means[place_after][3]);
    for (number, (posterior, place)) in [(before, place_before), (after, place_after)]
        .into_iter()
        .enumerate()
    {
        let mut random = ChaCha12Rng::seed_from_u64(number as u64);
        let values = posterior.spin.measured_values();
        for draw in &mut posterior.draws {
            let measured = draw.measured_mean(place);
            let sds = draw.sds_at(place);
            let mut aim: Values = std::array::from_fn(|i| measured[i] - error[i]);
            for i in 0..values {
                let uniform: f64 = random.random::<f64>().max(f64::MIN_POSITIVE);
                aim[i] += DAILY_FORM * sds[i] * quantile(uniform);
            }
            if !is_measured {
                aim[3] = backspin;
            }
            draw.means[place] = aim;
            draw.ring_restitution = None;
            draw.constant_errors[place] = Values::default();
        }
    }
    ring
}

/// What the change of P between two sessions comes from. What each of two causes does depends on
/// which of them changes first, so each is the mean of both orders (Shapley's value); the two add
/// up to the change.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbabilityChange {
    /// By the scatter: standard deviations and correlations.
    pub by_scatter: Interval,
    /// By the mean release.
    pub by_means: Interval,
    /// By the scatter where it changes first, at the mean release before, and where it changes
    /// last, at the one after.
    pub by_scatter_first_and_last: [Interval; 2],
    /// By the mean of the speed, of the pitch and of the polar angle, each alone and all else as
    /// before.
    pub by_mean_alone: [Interval; 3],
}

/// Splits the change of P at a place. `profile` is that of the place, `probabilities` have P of the
/// draws before and after; about `shots` shots are simulated for each order.
#[must_use]
pub fn probability_change(
    profile: &Profile,
    [before, after]: [&Posterior; 2],
    place: usize,
    probabilities: [&DrawProbabilities; 2],
    shots: usize,
) -> ProbabilityChange {
    let count = before.draws.len().min(after.draws.len());
    // Not the draw at the same place: it has the same random numbers.
    let partner = |k: usize| (k + count / 2) % count;
    // P of the usual release of one session with the scatter of the other.
    let p_of_mixed = |mixed: Vec<Draw>| {
        let means: Vec<Values> = mixed.iter().map(|draw| draw.means[place]).collect();
        let seed = profile.search().seed;
        WeightedShots::simulate(profile, (&mixed, place), &means, shots, seed)
            .probabilities(
                &mixed,
                |draw| draw.means[place],
                |draw| draw.factor_at(place),
            )
            .of_draws
    };
    let mixed = |means: &Draw, scatter: &Draw| {
        let mut draw = Draw::new(
            means.means.clone(),
            scatter.sds,
            scatter.correlation,
            scatter.speed_coefficients,
        );
        draw.tail_weight = scatter.tail_weight;
        draw
    };
    let pairs = || (0..count).map(|k| (&before.draws[k], &after.draws[partner(k)]));
    let new_scatter = p_of_mixed(pairs().map(|(old, new)| mixed(old, new)).collect());
    let new_means = p_of_mixed(pairs().map(|(old, new)| mixed(new, old)).collect());
    let one_mean = [0, 1, 2].map(|i| {
        let with_mean = |(old, new): (&Draw, &Draw)| {
            let mut draw = old.clone();
            draw.means[place][i] = new.means[place][i];
            // The scatter is that of before, at whatever speed.
            draw
        };
        p_of_mixed(pairs().map(with_mean).collect())
    });
    let [p_before, p_after] = probabilities.map(|p| &p.of_draws);
    let interval = |value: &dyn Fn(usize) -> f64| Interval::of((0..count).map(value).collect());
    let first = |k: usize| new_scatter[k] - p_before[k];
    let last = |k: usize| p_after[partner(k)] - new_means[k];
    let by_scatter = |k: usize| 0.5 * (first(k) + last(k));
    ProbabilityChange {
        by_scatter: interval(&by_scatter),
        by_means: interval(&|k| p_after[partner(k)] - p_before[k] - by_scatter(k)),
        by_scatter_first_and_last: [interval(&first), interval(&last)],
        by_mean_alone: [0, 1, 2].map(|i| interval(&|k| one_mean[i][k] - p_before[k])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand::rngs::ChaCha12Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// Authority: the difference of two independent normal numbers has twice the variance. The
    /// draws are the same, as those of two fits of one file with one seed are. The seed is fixed:
    /// no false alarm.
    #[test]
    fn val_the_change_between_equal_draws_is_as_wide_as_that_of_independent_ones() {
        let mut random = ChaCha12Rng::seed_from_u64(1);
        let draws: Vec<f64> = (0..1000)
            .map(|_| StandardNormal.sample(&mut random))
            .collect();
        let compared = compare(&draws, &draws, [50, 50]);
        let expected = f64::sqrt(2.0) * compared.before.sd;
        assert!(
            (compared.change.sd / expected - 1.0).abs() < 0.05,
            "{compared:?}"
        );
        assert_eq!(compared.draws, 1000);
        assert!((compared.grew - 0.5).abs() < 0.05 && compared.change.mean.abs() < 0.01);
    }
}
