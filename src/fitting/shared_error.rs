//! The part of the uncertainty of P that the players of a team have in common.

use super::interval::Interval;
use super::posterior::Draw;
use super::prior::RINGS_OF_GYMS;

/// The standard deviation of the part of P, draw by draw, that all players of one gym have in
/// common. It goes with the ring (linear regression), as far as the ring is known by its prior:
/// what a player's own makes say of it errs for this player alone. With a posterior of the variance
/// `v` and a prior of `V`, the common part is `v/V` of the ring's variance.
#[must_use]
pub fn shared_sd(draws: &[Draw], probabilities: &[f64]) -> f64 {
    let rings: Vec<f64> = draws
        .iter()
        .filter_map(|draw| draw.ring_restitution)
        .collect();
    if rings.is_empty() || rings.len() != probabilities.len() {
        return 0.0;
    }
    let (ring, p) = (
        Interval::of(rings.clone()),
        Interval::of(probabilities.to_vec()),
    );
    let pairs = rings.iter().zip(probabilities);
    let products = pairs.map(|(x, y)| (x - ring.mean) * (y - p.mean));
    let covariance = products.sum::<f64>() / (rings.len() as f64 - 1.0).max(1.0);
    let slope = covariance / (ring.sd * ring.sd).max(1e-12);
    // The variance of t with four degrees of freedom is 2.
    let of_prior = f64::sqrt(2.0) * RINGS_OF_GYMS.scale;
    (slope * ring.sd).abs() * (ring.sd / of_prior).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal_distribution::quantile;
    use nalgebra::SMatrix;

    /// Authority: P that is a linear function of the ring and of something of the player alone, in
    /// a grid of both, so that the two parts are known and independent.
    #[test]
    fn val_the_part_of_the_ring_is_found() {
        let point = |k: usize| quantile((k as f64 + 0.5) / 40.0);
        let (mut draws, mut probabilities) = (Vec::new(), Vec::new());
        for (i, j) in (0..40).flat_map(|i| (0..40).map(move |j| (i, j))) {
            let draw = Draw::new(
                vec![[7.0; 4]],
                [0.1; 4],
                SMatrix::identity(),
                [0.1, 0.0, 0.0],
            );
            draws.push(draw.with_ring(Some(0.65 + 0.05 * point(i))));
            probabilities.push(0.7 - 0.03 * point(i) + 0.04 * point(j));
        }
        let of_points = (0..40).map(|k| point(k) * point(k)).sum::<f64>() / 40.0;
        // The ring's standard deviation here over that of its prior, 0.07 times the root of 2.
        let by_prior = 0.05 * of_points.sqrt() / (0.07 * f64::sqrt(2.0));
        let expected = 0.03 * of_points.sqrt() * by_prior;
        assert!((shared_sd(&draws, &probabilities) - expected).abs() < 1e-4);
        let without: Vec<Draw> = draws.into_iter().map(|draw| draw.with_ring(None)).collect();
        assert!(shared_sd(&without, &probabilities) < 1e-6);
    }
}
