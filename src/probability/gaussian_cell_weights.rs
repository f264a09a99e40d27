//! The normal weights of Eq. 25 on the axes of a table, and the shifts of its points.
//!
//! An axis may be shifted by a fraction of a cell that depends on the cells of the axes that are
//! summed after it: the backspins of each pair of angles, the polar angles of each pitch angle, and
//! the speeds of every line. The points are then a lattice in four dimensions. Without the shifts
//! the thin surfaces between made and missed alias with the grid (errors up to 0.018 in P).

use crate::math::evenly_spaced::CellAxis;
use crate::math::normal_distribution;

/// Shift of the speeds from line to line, in cells, per cell of pitch angle, polar angle and
/// backspin. These and the next two were the best of 60 random draws, judged by the error of P at
/// 72 nominal shots of six shooters and locations. Half of the 60 had at most 1.7 times that error.
const SPEED_SHIFT: [f64; 3] = [0.267, 0.891, 0.564];
/// Shift of the backspins per cell of pitch angle and polar angle.
const SPIN_SHIFT: [f64; 2] = [0.224, 0.082];
/// Shift of the polar angles per cell of pitch angle.
const POLAR_SHIFT: f64 = 0.571;
/// Weights beyond this many standard deviations are omitted. (They sum to 4e-8.)
const REACH_SIGMAS: f64 = 5.5;
/// A standard deviation below this fraction of a cell is widened to it: a narrower weight would
/// fall between the points. This affects the search only; a reported probability is computed
/// without a table.
const MIN_SIGMA_CELLS: f64 = 0.6;

/// Shift of the polar angles of a pitch angle, 0 to 1 cells.
pub(super) fn polar_shift(pitch: usize) -> f64 {
    shift([pitch], [POLAR_SHIFT])
}

/// Shift of the backspins of a pitch angle and a polar angle, 0 to 1 cells.
pub(super) fn spin_shift(pitch: usize, polar: usize) -> f64 {
    shift([pitch, polar], SPIN_SHIFT)
}

/// Shift of the speeds of a line, 0 to 1 cells.
pub(super) fn speed_shift(pitch: usize, polar: usize, spin: usize) -> f64 {
    shift([pitch, polar, spin], SPEED_SHIFT)
}

fn shift<const N: usize>(cells: [usize; N], per_cell: [f64; N]) -> f64 {
    cells
        .iter()
        .zip(per_cell)
        .fold(0.5, |sum, (&i, per_cell)| sum + per_cell * i as f64)
        .fract()
}

/// A nominal value with the standard deviation of its error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gaussian {
    pub(super) mean: f64,
    pub(super) sigma: f64,
}

/// A standard deviation, or the least one that points with this spacing resolve.
pub(super) fn widened(sigma: f64, step: f64) -> f64 {
    sigma.max(MIN_SIGMA_CELLS * step)
}

/// Weight of a point of an axis: the normal density times the width of the cell.
pub(super) fn weight(x: f64, nominal: Gaussian, step: f64) -> f64 {
    let sigma = widened(nominal.sigma, step);
    if (x - nominal.mean).abs() <= REACH_SIGMAS * sigma {
        normal_distribution::density(x, nominal.mean, sigma) * step
    } else {
        0.0
    }
}

/// Adds the weights of a point under evenly spaced nominal values with the same standard deviation
/// to `sums`.
///
/// From one nominal value to the next, `spacing` away, the exponent of the density changes by an
/// amount that is linear in the number of steps. So the densities follow from two products each:
/// `w_(j+1) = w_j r_j`, `r_(j+1) = r_j q`, with `q = exp(-spacing^2 / sigma^2)`. Rounding adds up
/// to about 1e-13 of the greatest weight over 400 values.
pub(super) fn add_weights(sums: &mut [f64], x: f64, first: Gaussian, spacing: f64, step: f64) {
    let sigma = widened(first.sigma, step);
    let reach = REACH_SIGMAS * sigma;
    // A negative number becomes 0.
    let begin = ((x - reach - first.mean) / spacing).ceil() as usize;
    let end = (((x + reach - first.mean) / spacing).floor() + 1.0) as usize;
    let end = end.min(sums.len());
    if begin >= end {
        return;
    }
    let mean = first.mean + begin as f64 * spacing;
    let per_sigma = spacing / sigma;
    let mut weight = normal_distribution::density(x, mean, sigma) * step;
    let mut ratio = libm::exp(((x - mean) / sigma - 0.5 * per_sigma) * per_sigma);
    let ratio_of_ratios = libm::exp(-per_sigma * per_sigma);
    for sum in &mut sums[begin..end] {
        *sum += weight;
        weight *= ratio;
        ratio *= ratio_of_ratios;
    }
}

/// Adds `values * weight` to `sums`.
pub(super) fn add_weighted(sums: &mut [f64], weight: f64, values: &[f64]) {
    if weight != 0.0 {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += weight * value;
        }
    }
}

/// One row for each nominal value, one column for each cell of an axis.
pub(super) type WeightMatrix = Vec<Vec<f64>>;

/// The weights of an axis whose points are shifted by a fraction of a cell.
pub(super) fn weight_matrix(
    axis: &CellAxis,
    shift: f64,
    nominals: &[f64],
    sigma: f64,
) -> WeightMatrix {
    nominals
        .iter()
        .map(|&mean| {
            axis.values(shift)
                .map(|x| weight(x, Gaussian { mean, sigma }, axis.step()))
                .collect()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_weights_along_even_nominals_are_those_one_by_one() {
        for (sigma, spacing, step) in [(0.3, 0.02, 0.01), (0.08, 0.1, 0.2), (2.0, 0.01, 0.03)] {
            let first = Gaussian { mean: 7.0, sigma };
            for x in [5.0, 6.9, 7.013, 8.5, 10.99, 12.0, 30.0] {
                let mut sums = vec![1.0; 400];
                add_weights(&mut sums, x, first, spacing, step);
                for (j, sum) in sums.iter().enumerate() {
                    let mean = first.mean + j as f64 * spacing;
                    let single = weight(x, Gaussian { mean, sigma }, step);
                    // A nominal value at the edge of the reach may count or not.
                    let edge = normal_distribution::density(REACH_SIGMAS, 0.0, 1.0) / sigma * step;
                    let is_at_edge =
                        ((x - mean).abs() - REACH_SIGMAS * widened(sigma, step)).abs() < 1e-9;
                    let allowed = if is_at_edge { 1.01 * edge } else { 2e-13 };
                    assert!(
                        (sum - 1.0 - single).abs() <= allowed,
                        "{x} {j}: {sum} {single}"
                    );
                }
            }
        }
    }

    #[test]
    fn prop_weights_of_a_nominal_inside_the_axis_sum_to_one() {
        let axis = CellAxis {
            low: -3.0,
            high: 5.0,
            count: 40,
        };
        for row in weight_matrix(&axis, 0.3, &[0.0, 1.03, 1.99], 0.3) {
            let sum: f64 = row.iter().sum();
            assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        }
    }
}
