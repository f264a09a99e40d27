//! Which shape of the releases predicts shots that it has not seen: leave-one-out by
//! Pareto-smoothed importance sampling (Vehtari, Gelman and Gabry, Stat. Comput. 27 (2017) 1413).

use super::dispersion_posterior::{DispersionPosterior, ReleaseModel};
use super::importance::pareto_smoothed;
use super::measured_release::MeasuredRelease;
use super::posterior::{FitError, FitOptions, SpinSource, sampled, standard_normal};
use super::skew_posterior::SkewPosterior;
use super::student_posterior::StudentPosterior;
use crate::probability::Progress;
use rand::SeedableRng;
use rand::rngs::ChaCha12Rng;
use rayon::prelude::*;
use serde::Serialize;

/// A shape of the releases about the aim.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// Normal.
    Normal,
    /// Student's t.
    HeavierTails,
    /// Skew-normal.
    Skewed,
}

/// How well a shape predicts each shot from the others.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShapeScore {
    /// The shape.
    pub shape: Shape,
    /// The sum over the shots of the logarithm of the predictive density, less that of the normal
    /// shape: above 0 the shape predicts better.
    pub better_than_normal: f64,
    /// The standard error of it.
    pub standard_error: f64,
    /// The worst shape of the weights of a shot that was left out, of this shape and of the normal
    /// one: above 0.7 the score is no more than a hint.
    pub pareto_k: f64,
}

/// Points of each posterior.
const POINTS: usize = 1000;
/// A score needs fewer independent points than the ends of an interval.
const LEAST_EFFECTIVE_SIZE: f64 = 400.0;

/// Of each shot the logarithm of its predictive density, and the worst shape of its weights.
struct LeftOut {
    of_shots: Vec<f64>,
    pareto_k: f64,
}

fn left_out<const D: usize, M: ReleaseModel<D>>(
    model: &M,
    shots: &[MeasuredRelease],
    seed: u64,
    progress: &dyn Progress,
) -> Result<LeftOut, FitError> {
    let sampled = sampled(model, shots, (seed, LEAST_EFFECTIVE_SIZE), progress)?;
    let points = sampled.points();
    let of_point = |number: usize| {
        let point = points[number * points.len() / POINTS];
        let mut random = ChaCha12Rng::seed_from_u64(seed);
        random.set_stream(number as u64);
        let means = model.means(point, &mut || standard_normal(&mut random))?;
        model.shot_log_densities(point, &means, shots)
    };
    let of_points: Option<Vec<Vec<f64>>> = (0..POINTS).into_par_iter().map(of_point).collect();
    let of_points = of_points.ok_or(FitError::NoScatter)?;
    let of_shot = |shot: usize| {
        let densities = || of_points.iter().map(|of_point| of_point[shot]);
        let least = densities().fold(f64::INFINITY, f64::min);
        let ratios = densities().map(|log| libm::exp(least - log)).collect();
        let (weights, shape) = pareto_smoothed(ratios);
        let sum: f64 = weights.iter().sum();
        let weighted = weights.iter().zip(densities());
        let mean = weighted
            .map(|(weight, log)| weight * libm::exp(log - least))
            .sum::<f64>()
            / sum;
        (least + libm::log(mean), shape)
    };
    let of_shots: Vec<(f64, f64)> = (0..shots.len()).into_par_iter().map(of_shot).collect();
    Ok(LeftOut {
        pareto_k: of_shots.iter().map(|(_, k)| *k).fold(0.0, f64::max),
        of_shots: of_shots.into_iter().map(|(log, _)| log).collect(),
    })
}

fn compare<const D: usize>(
    shots: &[MeasuredRelease],
    places: usize,
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Vec<ShapeScore>, FitError> {
    let (prior, seed) = (options.prior, options.seed);
    let normal = DispersionPosterior::<D>::new(shots, places, prior);
    let normal = left_out(&normal, shots, seed, progress)?;
    let heavier = StudentPosterior::<D>::new(shots, places, prior);
    let heavier = left_out(&heavier, shots, seed, progress)?;
    let skewed = SkewPosterior::<D>::new(shots, places, prior);
    let skewed = left_out(&skewed, shots, seed, progress)?;
    let count = shots.len() as f64;
    let score = |shape: Shape, left_out: &LeftOut| {
        let pairs = left_out.of_shots.iter().zip(&normal.of_shots);
        let differences: Vec<f64> = pairs.map(|(own, normal)| own - normal).collect();
        let sum: f64 = differences.iter().sum();
        let squares = differences
            .iter()
            .map(|d| (d - sum / count) * (d - sum / count));
        ShapeScore {
            shape,
            better_than_normal: sum,
            standard_error: (count / (count - 1.0) * squares.sum::<f64>()).sqrt(),
            pareto_k: left_out.pareto_k.max(normal.pareto_k),
        }
    };
    Ok(vec![
        score(Shape::Normal, &normal),
        score(Shape::HeavierTails, &heavier),
        score(Shape::Skewed, &skewed),
    ])
}

/// How well normal, heavier-tailed and skewed releases predict shots that were left out; none where
/// no release was measured.
///
/// # Errors
/// A posterior did not converge.
pub fn compare_shapes(
    shots: &[MeasuredRelease],
    places: usize,
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Vec<ShapeScore>, FitError> {
    match options.spin {
        SpinSource::Measured => compare::<4>(shots, places, options, progress),
        SpinSource::Given | SpinSource::Assumed => compare::<3>(shots, places, options, progress),
        SpinSource::AssumedWithDirection => compare::<2>(shots, places, options, progress),
        SpinSource::NothingMeasured => Ok(Vec::new()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::measured_release::Covariance;
    use super::*;
    use crate::probability::Silent;

    fn shots(values: impl Fn(&mut dyn FnMut() -> f64) -> [f64; 3]) -> Vec<MeasuredRelease> {
        let mut random = ChaCha12Rng::seed_from_u64(1);
        let mut normal = || standard_normal(&mut random);
        (0..120)
            .map(|row| {
                let [a, b, c] = values(&mut normal);
                MeasuredRelease {
                    row,
                    place: 0,
                    values: [7.4 + 0.08 * a, 0.92 + 0.02 * b, 0.02 * c, 0.0],
                    noise: Covariance::zeros(),
                    made: None,
                    own: None,
                }
            })
            .collect()
    }

    /// Each shape wins on its own shots, by more than a standard error; of normal shots no other is
    /// better by two. The seed is fixed.
    #[test]
    fn val_each_shape_predicts_its_own_shots_best() {
        let scores = |shots: &[MeasuredRelease]| {
            let found = compare_shapes(shots, 1, &FitOptions::default(), &Silent).unwrap();
            assert_eq!(found[0].better_than_normal, 0.0);
            [1, 2].map(|k| found[k].better_than_normal / found[k].standard_error)
        };
        let normal = scores(&shots(|normal| [normal(), normal(), normal()]));
        assert!(normal[0] < 2.0 && normal[1] < 2.0, "{normal:?}");
        let [heavier, skewed] = scores(&shots(|normal| {
            let square = (0..4).map(|_| normal()).map(|z| z * z).sum::<f64>();
            let wide = (2.0 / square).sqrt();
            [wide * normal(), wide * normal(), wide * normal()]
        }));
        assert!(heavier > 1.0 && heavier > skewed, "{heavier} {skewed}");
        let [heavier, skewed] = scores(&shots(|normal| {
            let lean = normal().abs();
            [2.0 * lean + 0.3 * normal(), normal(), normal()]
        }));
        assert!(skewed > 1.0 && skewed > heavier, "{heavier} {skewed}");
    }
}
