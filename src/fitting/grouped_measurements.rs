//! Measurements in groups of one place and one covariance of their errors, and the means of the
//! places as parameters of a model.

use super::measured_release::MeasuredRelease;
use super::prior::Spread;
use nalgebra::{SMatrix, SVector};

/// Measurements at one place with one covariance of their errors.
pub(super) struct NoiseGroup<const D: usize> {
    pub(super) place: usize,
    pub(super) noise: SMatrix<f64, D, D>,
    pub(super) values: Vec<SVector<f64, D>>,
}

/// All measurements.
pub(super) struct GroupedMeasurements<const D: usize> {
    pub(super) groups: Vec<NoiseGroup<D>>,
    /// Of each place the means of the measurements and their standard errors, the unit of the
    /// parameters.
    means: Vec<[Spread; D]>,
}

/// A shot's values and the covariance of their errors.
pub(super) fn measured<const D: usize>(
    shot: &MeasuredRelease,
) -> (SVector<f64, D>, SMatrix<f64, D, D>) {
    let values = SVector::from_fn(|i, _| shot.values[i]);
    (values, SMatrix::from_fn(|i, j| shot.noise[(i, j)]))
}

impl<const D: usize> GroupedMeasurements<D> {
    pub(super) fn new(shots: &[MeasuredRelease], places: usize) -> Self {
        let mut groups: Vec<NoiseGroup<D>> = Vec::new();
        for shot in shots {
            let (y, noise) = measured(shot);
            let mut latest = groups.iter_mut().rev().take(64);
            match latest.find(|group| group.place == shot.place && group.noise == noise) {
                Some(group) => group.values.push(y),
                None => groups.push(NoiseGroup {
                    place: shot.place,
                    noise,
                    values: vec![y],
                }),
            }
        }
        let mean_of = |place: usize, i: usize| {
            let of_place = || shots.iter().filter(|shot| shot.place == place);
            let count = of_place().count() as f64;
            let mean = of_place().map(|shot| shot.values[i]).sum::<f64>() / count;
            let deviation = |shot: &MeasuredRelease| shot.values[i] - mean;
            let squares: f64 = of_place().map(|s| deviation(s) * deviation(s)).sum();
            Spread {
                mean,
                sd: (squares / (count - 1.0).max(1.0) / count).sqrt(),
            }
        };
        let of_place = |place| std::array::from_fn(|i| mean_of(place, i));
        Self {
            groups,
            means: (0..places).map(of_place).collect(),
        }
    }

    /// The mean of a place by its parameters, of which `first` is the first of the first place.
    pub(super) fn mean(&self, point: &[f64], first: usize, place: usize) -> SVector<f64, D> {
        SVector::from_fn(|i, _| {
            let spread = self.means[place][i];
            spread.mean + spread.sd * point[first + place * D + i]
        })
    }

    /// The means of all places.
    pub(super) fn all_means(&self, point: &[f64], first: usize) -> Vec<SVector<f64, D>> {
        let places = 0..self.means.len();
        places.map(|place| self.mean(point, first, place)).collect()
    }

    /// Adds the flat priors of the means.
    pub(super) fn add_priors(&self, priors: &mut Vec<Spread>) {
        let flat = Spread {
            mean: 0.0,
            sd: f64::INFINITY,
        };
        priors.resize(priors.len() + D * self.means.len(), flat);
    }
}
