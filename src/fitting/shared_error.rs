//! The part of the uncertainty of P that the players of a team have in common.

use super::posterior::Draw;
use nalgebra::{SMatrix, SVector};

/// What one gym and one sensor leave open for all players alike: the ring, and the constant errors
/// of speed, pitch and polar angle.
const SHARED: usize = 4;

/// The standard deviation of the part of P, draw by draw, that goes with the ring and with the
/// constant errors of the sensor (linear regression).
#[must_use]
pub fn shared_sd(draws: &[Draw], probabilities: &[f64]) -> f64 {
    let of_draw = |draw: &Draw| {
        let errors = draw.constant_errors.first().copied().unwrap_or_default();
        let ring = draw.ring_restitution.unwrap_or_default();
        SVector::<f64, SHARED>::new(ring, errors[0], errors[1], errors[2])
    };
    let count = draws.len().min(probabilities.len()).max(1) as f64;
    let shared: Vec<SVector<f64, SHARED>> = draws.iter().map(of_draw).collect();
    let pairs = || shared.iter().zip(probabilities);
    let mean = pairs().map(|(x, _)| *x).sum::<SVector<f64, SHARED>>() / count;
    let p_mean = pairs().map(|(_, p)| p).sum::<f64>() / count;
    let (mut squares, mut products) = (
        SMatrix::<f64, SHARED, SHARED>::zeros(),
        SVector::<f64, SHARED>::zeros(),
    );
    for (x, p) in pairs() {
        squares += (x - mean) * (x - mean).transpose() / count;
        products += (x - mean) * ((p - p_mean) / count);
    }
    // What does not vary explains nothing.
    for i in 0..SHARED {
        squares[(i, i)] = squares[(i, i)] * (1.0 + 1e-9) + 1e-18;
    }
    let explained = squares
        .cholesky()
        .map_or(0.0, |c| products.dot(&c.solve(&products)));
    explained.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal_distribution::quantile;

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
        let expected = 0.03 * of_points.sqrt();
        assert!((shared_sd(&draws, &probabilities) - expected).abs() < 1e-6);
        let without: Vec<Draw> = draws.into_iter().map(|draw| draw.with_ring(None)).collect();
        assert!(shared_sd(&without, &probabilities) < 1e-6);
    }
}
