//! Shots that resemble the shot before them tell less of the aim than independent ones.

use super::measured_release::{MeasuredRelease, by_place};
use super::posterior::Posterior;
use crate::math::normal_distribution::quantile;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

/// The correlation of neighbouring shots of the population: mean and standard deviation (assumed).
const POPULATION: (f64, f64) = (0.05, 0.2);
/// The greatest one.
const MOST: f64 = 0.8;

/// The correlation of a value with that of the shot before it in the same session and place, and
/// the number of such pairs.
fn correlation(shots: &[MeasuredRelease], sessions: &[String], value: usize) -> (f64, f64) {
    let places = shots.iter().map(|shot| shot.place + 1).max().unwrap_or(0);
    let means: Vec<f64> = by_place(shots, places)
        .iter()
        .map(|here| {
            let count = here.len().max(1) as f64;
            here.iter().map(|shot| shot.values[value]).sum::<f64>() / count
        })
        .collect();
    let deviation = |shot: &MeasuredRelease| shot.values[value] - means[shot.place];
    let squares: f64 = shots
        .iter()
        .map(|shot| deviation(shot) * deviation(shot))
        .sum();
    let (mut products, mut pairs) = (0.0, 0.0);
    for k in 1..shots.len() {
        let is_pair = shots[k].place == shots[k - 1].place
            && (sessions.is_empty() || sessions[k] == sessions[k - 1]);
        if is_pair {
            products += deviation(&shots[k]) * deviation(&shots[k - 1]);
            pairs += 1.0;
        }
    }
    let mean_square = squares / shots.len().max(1) as f64;
    let found = if pairs > 0.0 && mean_square > 0.0 {
        products / pairs / mean_square
    } else {
        0.0
    };
    (found, pairs)
}

/// Moves the aims of the draws farther apart, by what the correlation of neighbouring shots makes
/// their errors greater: the variance of a mean has the factor (1 + r)/(1 - r).
pub(super) fn widen_means(
    posterior: &mut Posterior,
    (shots, sessions): (&[MeasuredRelease], &[String]),
    seed: u64,
) {
    let typical = posterior.typical();
    let mut random = ChaCha12Rng::seed_from_u64(seed);
    random.set_stream(u64::MAX - 1);
    let values = posterior.spin.measured_values();
    let known: Vec<(f64, f64)> = (0..values)
        .map(|value| {
            let (found, pairs) = correlation(shots, sessions, value);
            let (mean, sd) = POPULATION;
            // A correlation of n pairs has an error of one over the root of n; that of the mean of
            // the shots makes it too small.
            let found = found + (1.0 + 3.0 * found) / pairs.max(4.0);
            let weight = sd * sd / (sd * sd + 1.0 / pairs.max(1e-9));
            let error = sd * (1.0 - weight).sqrt();
            (mean + weight * (found - mean), error)
        })
        .collect();
    for draw in &mut posterior.draws {
        for (value, (mean, error)) in known.iter().enumerate() {
            let uniform: f64 = random.random::<f64>().max(f64::MIN_POSITIVE);
            let r = (mean + error * quantile(uniform)).clamp(0.0, MOST);
            let factor = ((1.0 + r) / (1.0 - r)).sqrt();
            for (aim, middle) in draw.means.iter_mut().zip(&typical.means) {
                aim[value] = middle[value] + factor * (aim[value] - middle[value]);
            }
        }
    }
}
