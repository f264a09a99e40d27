//! P at the end of a session in which a value drifts.

use super::advice::{USUAL_SHOTS, usual_probabilities};
use super::draw_probabilities::DrawProbabilities;
use super::fit_checks::WARNING_LEVEL;
use super::posterior::{Draw, Posterior};
use super::session_trends::SessionTrend;
use crate::math::normal_distribution::quantile;
use crate::shooter::Profile;
use nalgebra::{Matrix3, Vector3};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

/// The least part of the variance of a value that is no drift.
const LEAST_VARIANCE: f64 = 0.1;

/// P of the release at a place as it is at the end of the session, where a value drifts beyond
/// chance; `None` where none does. The drift is the line through the shots, with its error.
pub(super) fn probability_at_the_end(
    profile: &Profile,
    posterior: &Posterior,
    trends: &[SessionTrend],
    place: usize,
) -> Option<DrawProbabilities> {
    let drifts: Vec<(usize, f64)> = trends
        .iter()
        .enumerate()
        .filter(|(value, trend)| *value < 3 && trend.drift_p < WARNING_LEVEL)
        .map(|(value, trend)| (value, trend.drift))
        .collect();
    if drifts.is_empty() {
        return None;
    }
    let mut random = ChaCha12Rng::seed_from_u64(profile.search().seed);
    let count = posterior.shots as f64;
    let at_the_end = |draw: &Draw| {
        let (sds, mut mean) = (draw.sds_at(place), draw.means[place]);
        let mut narrower = Vector3::repeat(1.0);
        for (value, drift) in &drifts {
            // The slope of n evenly spaced shots, over all of them.
            let error = sds[*value] * (12.0 / count).sqrt();
            let uniform: f64 = random.random::<f64>().max(f64::MIN_POSITIVE);
            let drift = drift + error * quantile(uniform);
            mean[*value] += 0.5 * drift;
            // An even drift has a twelfth of its square as variance.
            let own = 1.0 - drift * drift / (12.0 * sds[*value] * sds[*value]);
            narrower[*value] = own.max(LEAST_VARIANCE).sqrt();
        }
        draw.turned(&Matrix3::from_diagonal(&narrower), vec![mean])
            .with_ring(draw.ring_restitution)
    };
    let draws: Vec<Draw> = posterior.draws.iter().map(at_the_end).collect();
    let ended = Posterior {
        draws,
        ..posterior.clone()
    };
    Some(usual_probabilities(profile, &ended, 0, USUAL_SHOTS))
}
