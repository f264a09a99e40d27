//! Measurements in groups of one place and one covariance of their errors, and the means of the
//! places as parameters of a model.

use super::measured_release::{MeasuredRelease, by_place};
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
        let mean_of = |of_place: &[&MeasuredRelease], i: usize| {
            let count = of_place.len() as f64;
            let mean = of_place.iter().map(|shot| shot.values[i]).sum::<f64>() / count;
            let deviation = |shot: &MeasuredRelease| shot.values[i] - mean;
            let squares = of_place.iter().map(|s| deviation(s) * deviation(s));
            let squares: f64 = squares.sum();
            Spread {
                mean,
                sd: (squares / (count - 1.0).max(1.0) / count).sqrt(),
            }
        };
        let of_places = by_place(shots, places);
        let means = of_places
            .iter()
            .map(|of_place| std::array::from_fn(|i| mean_of(of_place, i)));
        Self {
            groups,
            means: means.collect(),
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
