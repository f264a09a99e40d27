//! The posterior density of a shooter's dispersion, with the means integrated out.
//!
//! The parameters are the logarithms of the standard deviations, Fisher's z of the partial
//! correlations, and the growth of the speed's standard deviation with the speed. Given them, the
//! measurements are normal and the means, whose prior is flat, have a closed form. Measurements
//! with the same noise at the same place count through their number, mean and scatter alone, so a
//! density costs the same for 30 shots and for 3000.

use super::grouped_measurements::measured;
use super::measured_release::MeasuredRelease;
use super::prior::{PopulationPrior, Spread};
use hammer_and_sample::Model;
use nalgebra::{Cholesky, Const, SMatrix, SVector};

/// Measurements at one place with one covariance of their errors.
struct NoiseGroup<const D: usize> {
    place: usize,
    noise: SMatrix<f64, D, D>,
    shots: f64,
    mean: SVector<f64, D>,
    /// Sum of the squares and products of the deviations from the mean.
    scatter: SMatrix<f64, D, D>,
}

/// A dispersion in the values of the model.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dispersion<const D: usize> {
    /// Standard deviations; that of the speed at the reference speed.
    pub(super) sds: SVector<f64, D>,
    /// Cholesky factor of the correlations.
    pub(super) correlation_factor: SMatrix<f64, D, D>,
    /// Relative growth of the speed's standard deviation, linear and quadratic.
    pub(super) growth: [f64; 2],
}

/// A model of releases whose posterior density is sampled.
pub(super) trait ReleaseModel<const D: usize>: Model<Params = Vec<f64>> + Sync {
    /// The part that the dispersion and its prior are read with; its parameters come first.
    fn normal(&self) -> &DispersionPosterior<D>;

    /// The prior of each parameter.
    fn priors(&self) -> Vec<Spread>;

    /// One over the degrees of freedom of the releases; 0 where they are normal.
    fn tail_weight(&self, point: &[f64]) -> f64;

    /// The aim at each place; what the point leaves open is drawn with independent standard
    /// normals.
    fn means(&self, point: &[f64], normal: &mut dyn FnMut() -> f64)
    -> Option<Vec<SVector<f64, D>>>;

    /// The logarithm of the density of each shot's measurement, without the constant of the normal
    /// distribution; `None` where a covariance is not positive definite.
    fn shot_log_densities(
        &self,
        point: &[f64],
        means: &[SVector<f64, D>],
        shots: &[MeasuredRelease],
    ) -> Option<Vec<f64>>;
}

/// The posterior density.
pub(super) struct DispersionPosterior<const D: usize> {
    groups: Vec<NoiseGroup<D>>,
    /// Mean measured speed of each place over the reference speed, less 1.
    relative_speeds: Vec<f64>,
    pub(super) reference_speed: f64,
    /// Terms of the growth: 0, 1 or 2.
    pub(super) growth_terms: usize,
    prior: PopulationPrior,
}

/// Speeds nearer than this, relative, do not tell growth from scatter.
const LEAST_SPEED_STEP: f64 = 0.03;
/// A standard deviation shrinks to this share of that at the reference speed at most.
const LEAST_FACTOR: f64 = 0.05;
/// The greatest speed of a profile, m/s.
const MAX_SPEED_M_S: f64 = 40.0;
/// No standard deviation of the speed is greater than this at any speed, m/s. A profile may have 10
/// m/s; the middle of the draws is a little greater than their mean.
const MAX_SPEED_SD_M_S: f64 = 6.0;

/// Whether a scatter of the speed makes sense at every speed of a profile, not at the measured ones
/// alone: the factor `1 + x (g + h x)` of its standard deviation, with `x = v/v0 - 1`, is positive,
/// and the standard deviation not too great.
#[must_use]
pub fn is_speed_scatter_possible(
    sd_m_s: f64,
    [linear, quadratic]: [f64; 2],
    reference_speed_m_s: f64,
) -> bool {
    let factor = |x: f64| 1.0 + x * (linear + x * quadratic);
    let last = MAX_SPEED_M_S / reference_speed_m_s - 1.0;
    let vertex = (-0.5 * linear / quadratic).clamp(-1.0, last);
    let vertex = if vertex.is_nan() { 0.0 } else { vertex };
    [-1.0, vertex, last]
        .into_iter()
        .map(factor)
        .all(|factor| factor >= LEAST_FACTOR && sd_m_s * factor <= MAX_SPEED_SD_M_S)
}

impl<const D: usize> DispersionPosterior<D> {
    pub(super) fn new(shots: &[MeasuredRelease], places: usize, prior: PopulationPrior) -> Self {
        let mut groups: Vec<NoiseGroup<D>> = Vec::new();
        // One group for each covariance, in the order of the shots.
        for shot in shots {
            let (y, noise) = measured(shot);
            let found = groups
                .iter_mut()
                .rev()
                .take(64)
                .find(|group| group.place == shot.place && group.noise == noise);
            let group = match found {
                Some(group) => group,
                None => {
                    groups.push(NoiseGroup {
                        place: shot.place,
                        noise,
                        shots: 0.0,
                        mean: SVector::zeros(),
                        scatter: SMatrix::zeros(),
                    });
                    groups.last_mut().expect("one was pushed")
                }
            };
            // Welford's update.
            group.shots += 1.0;
            let before = y - group.mean;
            group.mean += before / group.shots;
            group.scatter += before * (y - group.mean).transpose();
        }
        let mean_speed = |place: usize| {
            let of_place = || groups.iter().filter(|group| group.place == place);
            let sum: f64 = of_place().map(|group| group.shots * group.mean[0]).sum();
            sum / of_place().map(|group| group.shots).sum::<f64>()
        };
        let speeds: Vec<f64> = (0..places).map(mean_speed).collect();
        let reference_speed = speeds.iter().sum::<f64>() / places as f64;
        let mut sorted = speeds.clone();
        sorted.sort_by(f64::total_cmp);
        let steps = sorted
            .windows(2)
            .filter(|pair| pair[1] - pair[0] > LEAST_SPEED_STEP * reference_speed);
        Self {
            growth_terms: steps.count().min(2),
            relative_speeds: speeds
                .iter()
                .map(|speed| speed / reference_speed - 1.0)
                .collect(),
            reference_speed,
            groups,
            prior,
        }
    }

    pub(super) fn places(&self) -> usize {
        self.relative_speeds.len()
    }

    pub(super) fn correlations() -> usize {
        D * (D - 1) / 2
    }

    /// The number of parameters.
    pub(super) fn dimension(&self) -> usize {
        D + Self::correlations() + self.growth_terms
    }

    /// The prior of each parameter.
    pub(super) fn priors(&self) -> Vec<Spread> {
        let mut priors: Vec<Spread> = (0..D)
            .map(|i| Spread {
                mean: libm::log(self.prior.median_sd[i]),
                sd: self.prior.log_sd[i],
            })
            .collect();
        priors.push(self.prior.speed_pitch);
        priors.resize(D + Self::correlations(), self.prior.other_correlations);
        priors.resize(self.dimension(), self.prior.growth);
        priors
    }

    /// The dispersion of a point of the parameter space.
    pub(super) fn dispersion(&self, point: &[f64]) -> Dispersion<D> {
        let sds = SVector::from_fn(|i, _| libm::exp(point[i]));
        // From partial correlations, row by row: every point gives a valid matrix (Lewandowski,
        // Kurowicka and Joe, J. Multivariate Anal. 100 (2009) 1989).
        let mut factor = SMatrix::<f64, D, D>::zeros();
        let mut next = D;
        for i in 0..D {
            let mut left = 1.0_f64;
            for j in 0..i {
                let partial = libm::tanh(point[next]);
                next += 1;
                factor[(i, j)] = partial * left.sqrt();
                left *= 1.0 - partial * partial;
            }
            factor[(i, i)] = left.sqrt();
        }
        let mut growth = [0.0; 2];
        let given = &point[D + Self::correlations()..][..self.growth_terms];
        growth[..self.growth_terms].copy_from_slice(given);
        Dispersion {
            sds,
            correlation_factor: factor,
            growth,
        }
    }

    /// The factor of the speed's standard deviation at a place.
    pub(super) fn speed_factor(&self, dispersion: &Dispersion<D>, place: usize) -> f64 {
        let relative = self.relative_speeds[place];
        let [linear, quadratic] = dispersion.growth;
        1.0 + relative * (linear + relative * quadratic)
    }

    /// The Cholesky factor of the covariance of the releases at a place.
    pub(super) fn release_factor(
        &self,
        dispersion: &Dispersion<D>,
        place: usize,
    ) -> SMatrix<f64, D, D> {
        let mut sds = dispersion.sds;
        sds[0] *= self.speed_factor(dispersion, place);
        SMatrix::from_diagonal(&sds) * dispersion.correlation_factor
    }

    /// The logarithm of the density of the measurements, and of each place the mean of the aim and
    /// the Cholesky factorisation of its inverse covariance. `None` where a covariance is not
    /// positive definite.
    fn likelihood(
        &self,
        dispersion: &Dispersion<D>,
    ) -> Option<(f64, Vec<(SVector<f64, D>, Cholesky<f64, Const<D>>)>)> {
        let places = self.places();
        let factors: Vec<_> = (0..places)
            .map(|place| {
                let factor = self.release_factor(dispersion, place);
                factor * factor.transpose()
            })
            .collect();
        let mut precision = vec![SMatrix::<f64, D, D>::zeros(); places];
        let mut weighted = vec![SVector::<f64, D>::zeros(); places];
        let mut sum = 0.0;
        let mut squares = vec![0.0; places];
        for group in &self.groups {
            let covariance = factors[group.place] + group.noise;
            let (inverse, log_determinant) = inverse_and_log_determinant(covariance)?;
            let at_mean = inverse * group.mean;
            sum -= 0.5 * (group.shots * log_determinant + inverse.dot(&group.scatter));
            squares[group.place] += group.shots * group.mean.dot(&at_mean);
            precision[group.place] += inverse * group.shots;
            weighted[group.place] += at_mean * group.shots;
        }
        let mut means = Vec::with_capacity(places);
        for place in 0..places {
            let precision = Cholesky::new(precision[place])?;
            let mean = precision.solve(&weighted[place]);
            let factor = precision.l_dirty();
            let log_determinant: f64 = (0..D).map(|i| 2.0 * libm::log(factor[(i, i)])).sum();
            sum -= 0.5 * (squares[place] - mean.dot(&weighted[place]) + log_determinant);
            means.push((mean, precision));
        }
        Some((sum, means))
    }

    /// The logarithm of the prior density of a point, and its dispersion. `None` where the
    /// posterior density vanishes.
    pub(super) fn log_prior(
        &self,
        point: &[f64],
        priors: &[Spread],
    ) -> Option<(f64, Dispersion<D>)> {
        let mut log_prior = 0.0;
        for (value, prior) in point.iter().zip(priors) {
            let z = (value - prior.mean) / prior.sd;
            log_prior -= 0.5 * z * z;
        }
        // Far outside, and where numbers would leave their range.
        if !(log_prior > -500.0) {
            return None;
        }
        let dispersion = self.dispersion(point);
        let Dispersion { sds, growth, .. } = dispersion;
        is_speed_scatter_possible(sds[0], growth, self.reference_speed)
            .then_some((log_prior, dispersion))
    }
}

/// The inverse of a covariance and the logarithm of its determinant; `None` if it is not positive
/// definite. Each tracked flight has a covariance of its own: so with few divisions and a single
/// logarithm.
#[inline]
pub(super) fn inverse_and_log_determinant<const D: usize>(
    covariance: SMatrix<f64, D, D>,
) -> Option<(SMatrix<f64, D, D>, f64)> {
    let cholesky = Cholesky::new(covariance)?;
    let factor = cholesky.l_dirty();
    // The inverse of the factor, column by column.
    let mut inverse = SMatrix::<f64, D, D>::zeros();
    let mut diagonal = 1.0;
    for i in 0..D {
        diagonal *= factor[(i, i)];
        let reciprocal = 1.0 / factor[(i, i)];
        inverse[(i, i)] = reciprocal;
        for j in 0..i {
            let sum: f64 = (j..i).map(|k| factor[(i, k)] * inverse[(k, j)]).sum();
            inverse[(i, j)] = -sum * reciprocal;
        }
    }
    Some((inverse.tr_mul(&inverse), 2.0 * libm::log(diagonal)))
}

/// The logarithm of a normal density at a deviation from its mean, without its constant.
pub(super) fn normal_log_density<const D: usize>(
    deviation: &SVector<f64, D>,
    covariance: SMatrix<f64, D, D>,
) -> Option<f64> {
    let (inverse, log_determinant) = inverse_and_log_determinant(covariance)?;
    Some(-0.5 * (deviation.dot(&(inverse * deviation)) + log_determinant))
}

impl<const D: usize> Model for DispersionPosterior<D> {
    type Params = Vec<f64>;

    fn log_prob(&self, point: &Vec<f64>) -> f64 {
        let Some((log_prior, dispersion)) = self.log_prior(point, &self.priors()) else {
            return f64::NEG_INFINITY;
        };
        match self.likelihood(&dispersion) {
            Some((log_likelihood, _)) if log_likelihood.is_finite() => log_prior + log_likelihood,
            _ => f64::NEG_INFINITY,
        }
    }
}

impl<const D: usize> ReleaseModel<D> for DispersionPosterior<D> {
    fn normal(&self) -> &DispersionPosterior<D> {
        self
    }

    fn priors(&self) -> Vec<Spread> {
        DispersionPosterior::priors(self)
    }

    fn tail_weight(&self, _point: &[f64]) -> f64 {
        0.0
    }

    fn means(
        &self,
        point: &[f64],
        normal: &mut dyn FnMut() -> f64,
    ) -> Option<Vec<SVector<f64, D>>> {
        let (_, means) = self.likelihood(&self.dispersion(point))?;
        let mut draw = |(mean, precision): (SVector<f64, D>, Cholesky<f64, Const<D>>)| {
            let z = SVector::from_fn(|_, _| normal());
            let deviation = precision.l().transpose().solve_upper_triangular(&z)?;
            Some(mean + deviation)
        };
        means.into_iter().map(&mut draw).collect()
    }

    fn shot_log_densities(
        &self,
        point: &[f64],
        means: &[SVector<f64, D>],
        shots: &[MeasuredRelease],
    ) -> Option<Vec<f64>> {
        let dispersion = self.dispersion(point);
        let of_shot = |shot: &MeasuredRelease| {
            let (values, noise) = measured(shot);
            let factor = self.release_factor(&dispersion, shot.place);
            let deviation = values - means[shot.place];
            normal_log_density(&deviation, factor * factor.transpose() + noise)
        };
        shots.iter().map(of_shot).collect()
    }
}
