//! The posterior density where the releases lean to one side: a multivariate skew-normal
//! distribution (Azzalini and Dalla Valle, Biometrika 83 (1996) 715).
//!
//! A release is `mu + a (|u| - sqrt(2/pi)) + e` with a standard normal `u` and `e ~ N(0, K (I - g
//! g^T) K^T)`, `a = K g`, the length of `g` below 1. With a normal error of the tracker it stays
//! skew-normal, so the density has a closed form. The parameters are the centred ones
//! (Arellano-Valle and Azzalini, J. Multivariate Anal. 99 (2008) 1362): mean, covariance and
//! skewness, in which the likelihood is smooth where `g` vanishes. It serves to compare shapes: P
//! rests on the symmetric ones.

use super::dispersion_posterior::{
    Dispersion, DispersionPosterior, ReleaseModel, inverse_and_log_determinant,
};
use super::grouped_measurements::{GroupedMeasurements, measured};
use super::measured_release::MeasuredRelease;
use super::prior::{PopulationPrior, Spread};
use crate::math::normal_distribution::cdf;
use hammer_and_sample::Model;
use nalgebra::{SMatrix, SVector};

/// The skewness along its direction is this times the hyperbolic tangent of the length of a vector
/// with normal components, which have this standard deviation. A skew-normal number has 0.995 at
/// most.
const MOST_SKEWNESS: f64 = 0.97;
const SD_OF_SHAPE: f64 = 0.7;

/// The mean of the absolute value of a standard normal number.
const MEAN_OF_ABSOLUTE: f64 = 0.797_884_560_802_865_4;

/// The posterior density of dispersion, skewness and means.
pub(super) struct SkewPosterior<const D: usize> {
    normal: DispersionPosterior<D>,
    measurements: GroupedMeasurements<D>,
}

/// A skew-normal density of measurements with one covariance of their errors.
struct SkewNormal<const D: usize> {
    inverse: SMatrix<f64, D, D>,
    log_determinant: f64,
    /// What a deviation is multiplied by in the argument of the distribution function.
    slope: SVector<f64, D>,
    /// From the start to the mean.
    to_mean: SVector<f64, D>,
}

/// `g` of a direction and the skewness along it.
struct Lean<const D: usize> {
    direction: SVector<f64, D>,
    length: f64,
}

impl<const D: usize> Lean<D> {
    fn new(shape: &SVector<f64, D>) -> Self {
        let length = shape.norm();
        let skewness = MOST_SKEWNESS * libm::tanh(length);
        let ratio = libm::cbrt(2.0 * skewness / (4.0 - std::f64::consts::PI));
        let mean = ratio / (1.0 + ratio * ratio).sqrt();
        Self {
            direction: shape / length.max(f64::MIN_POSITIVE),
            length: mean / MEAN_OF_ABSOLUTE,
        }
    }
}

impl<const D: usize> SkewNormal<D> {
    /// Of releases whose covariance has this Cholesky factor.
    fn new(
        factor: &SMatrix<f64, D, D>,
        lean: &Lean<D>,
        noise: &SMatrix<f64, D, D>,
    ) -> Option<Self> {
        // What leans has the variance 1 - 2 g^2/pi along its direction: so much wider is K.
        let mean = lean.length * MEAN_OF_ABSOLUTE;
        let widening = 1.0 / (1.0 - mean * mean).sqrt();
        let along = factor * lean.direction;
        let covariance =
            factor * factor.transpose() + along * along.transpose() * (widening * widening - 1.0);
        let (inverse, log_determinant) = inverse_and_log_determinant(covariance + noise)?;
        let along = along * (widening * lean.length);
        let slope = inverse * along;
        let rest = 1.0 - along.dot(&slope);
        (rest > 0.0).then(|| Self {
            inverse,
            log_determinant,
            slope: slope / rest.sqrt(),
            to_mean: along * MEAN_OF_ABSOLUTE,
        })
    }

    /// The logarithm of the density, without that of the normal distribution's constant.
    fn log_density(&self, from_mean: &SVector<f64, D>) -> f64 {
        let deviation = from_mean + self.to_mean;
        let side = cdf(self.slope.dot(&deviation)).max(1e-300);
        let square = deviation.dot(&(self.inverse * deviation));
        libm::log(2.0 * side) - 0.5 * (square + self.log_determinant)
    }
}

impl<const D: usize> SkewPosterior<D> {
    pub(super) fn new(shots: &[MeasuredRelease], places: usize, prior: PopulationPrior) -> Self {
        Self {
            normal: DispersionPosterior::new(shots, places, prior),
            measurements: GroupedMeasurements::new(shots, places),
        }
    }

    fn lean(&self, point: &[f64]) -> Lean<D> {
        let first = self.normal.dimension();
        Lean::new(&SVector::from_fn(|i, _| point[first + i]))
    }

    fn log_likelihood(&self, point: &[f64], dispersion: &Dispersion<D>) -> Option<f64> {
        let lean = self.lean(point);
        let mut sum = 0.0;
        for group in &self.measurements.groups {
            let factor = self.normal.release_factor(dispersion, group.place);
            let density = SkewNormal::new(&factor, &lean, &group.noise)?;
            let mean = self
                .measurements
                .mean(point, self.normal.dimension() + D, group.place);
            let values = group.values.iter();
            sum += values
                .map(|y| density.log_density(&(y - mean)))
                .sum::<f64>();
        }
        Some(sum)
    }
}

impl<const D: usize> Model for SkewPosterior<D> {
    type Params = Vec<f64>;

    fn log_prob(&self, point: &Vec<f64>) -> f64 {
        let Some((log_prior, dispersion)) = self.normal.log_prior(point, &self.priors()) else {
            return f64::NEG_INFINITY;
        };
        match self.log_likelihood(point, &dispersion) {
            Some(log_likelihood) if log_likelihood.is_finite() => log_prior + log_likelihood,
            _ => f64::NEG_INFINITY,
        }
    }
}

impl<const D: usize> ReleaseModel<D> for SkewPosterior<D> {
    fn normal(&self) -> &DispersionPosterior<D> {
        &self.normal
    }

    fn priors(&self) -> Vec<Spread> {
        let mut priors = self.normal.priors();
        let shape = Spread {
            mean: 0.0,
            sd: SD_OF_SHAPE,
        };
        priors.resize(priors.len() + D, shape);
        self.measurements.add_priors(&mut priors);
        priors
    }

    fn tail_weight(&self, _point: &[f64]) -> f64 {
        0.0
    }

    fn means(
        &self,
        point: &[f64],
        _normal: &mut dyn FnMut() -> f64,
    ) -> Option<Vec<SVector<f64, D>>> {
        let first = self.normal.dimension() + D;
        Some(self.measurements.all_means(point, first))
    }

    fn shot_log_densities(
        &self,
        point: &[f64],
        means: &[SVector<f64, D>],
        shots: &[MeasuredRelease],
    ) -> Option<Vec<f64>> {
        let (dispersion, lean) = (self.normal.dispersion(point), self.lean(point));
        let of_shot = |shot: &MeasuredRelease| {
            let (values, noise) = measured(shot);
            let factor = self.normal.release_factor(&dispersion, shot.place);
            let density = SkewNormal::new(&factor, &lean, &noise)?;
            Some(density.log_density(&(values - means[shot.place])))
        };
        shots.iter().map(of_shot).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Authority: the definition. By summing the density the mean is 0, the variance 1 plus that of
    /// the noise, and the third central moment is the skewness, which normal noise does not change.
    #[test]
    fn val_moments_of_the_skew_normal_density() {
        for (shape, noise) in [(0.0_f64, 0.0), (0.5, 0.0), (-1.5, 0.25)] {
            let density = SkewNormal::<1>::new(
                &SMatrix::from([[1.0]]),
                &Lean::new(&SVector::from([shape])),
                &SMatrix::from([[noise]]),
            )
            .unwrap();
            let constant = (2.0 * std::f64::consts::PI).sqrt();
            let step = 0.001;
            let mut moments = [0.0; 4];
            for k in -9000..9000 {
                let x = step * f64::from(k);
                let p = step / constant * libm::exp(density.log_density(&SVector::from([x])));
                let powers = [1.0, x, x * x, x * x * x];
                moments
                    .iter_mut()
                    .zip(powers)
                    .for_each(|(m, power)| *m += p * power);
            }
            let skewness = MOST_SKEWNESS * libm::tanh(shape);
            let expected = [1.0, 0.0, 1.0 + noise, skewness];
            for (seen, expected) in moments.iter().zip(expected) {
                assert!((seen - expected).abs() < 1e-5, "{shape}: {moments:?}");
            }
        }
    }
}
