//! P of one nominal shot by Eq. 25 on grids: exactly as the paper prints it, on one common grid,
//! and on grids that are shifted from line to line.
//!
//! Both serve to check the Sobol estimate, which needs a hundredth of the shots. Only the four
//! errors of Eq. 25 can be integrated like this.

use super::gaussian_cell_weights::{Gaussian, polar_shift, speed_shift, spin_shift, weight};
use super::probability_and_error::{Estimate, standard_error_of_mean};
use super::progress::Progress;
use crate::dynamics::{BatchWorkspace, ReleaseWithoutSpeed};
use crate::math::evenly_spaced::CellAxis;
use crate::search_space::TablePlan;
use crate::shooter::{Nominal, NominalVariable, Profile};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// Random offsets of the shifted grid. Their scatter gives the standard error.
const OFFSETS: u64 = 4;
/// Standard deviations that a shifted grid reaches to both sides of the nominal shot.
const SHIFTED_REACH: f64 = 4.5;
/// Axes of a grid, in the order of [`NominalVariable::TABLE_AXES`].
const AXES: usize = NominalVariable::TABLE_AXES.len();

/// The sum of Eq. 25, and its simulated shots.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridSum {
    /// P.
    pub probability: f64,
    /// Simulated shots.
    pub shots: u64,
}

/// Eq. 25 as printed: `n` values of each of speed, pitch, polar angle and backspin over all that
/// can be made from the location, on one common grid.
#[must_use]
pub fn common_grid(
    profile: &Profile,
    plan: &TablePlan,
    nominal: &Nominal,
    n: usize,
    progress: &dyn Progress,
) -> GridSum {
    let axis = |low, high| CellAxis {
        low,
        high,
        count: n,
    };
    // The speeds that can be made at any of the angles.
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    let pitches = axis(plan.pitch.low, plan.pitch.high);
    let polars = axis(plan.bracket.polar_rad.0, plan.bracket.polar_rad.1);
    for pitch in pitches.values(0.5) {
        for polar in polars.values(0.5) {
            if let Some((least, most)) = plan.bracket.speeds_m_s(pitch, polar) {
                low = low.min(least);
                high = high.max(most);
            }
        }
    }
    let axes = [
        pitches,
        polars,
        axis(plan.backspin.low, plan.backspin.high),
        axis(low.min(high), high),
    ];
    Grid::new(profile, plan, nominal, axes, None).sum(progress)
}

/// Eq. 25 on four shifted grids of `n` to the fourth points each, which reach 4.5 standard
/// deviations about the nominal shot. The scatter of the four gives the standard error.
#[must_use]
pub fn shifted_grids(
    profile: &Profile,
    plan: &TablePlan,
    nominal: &Nominal,
    n: usize,
    seed: u64,
    progress: &dyn Progress,
) -> Estimate {
    let axes = Grid::gaussians(profile, nominal).map(|Gaussian { mean, sigma }| CellAxis {
        low: mean - SHIFTED_REACH * sigma,
        high: mean + SHIFTED_REACH * sigma,
        // Without an error there is only the nominal value.
        count: if sigma > 0.0 { n } else { 1 },
    });
    let sums: Vec<GridSum> = (0..OFFSETS)
        .map(|stream| {
            let mut random = ChaCha12Rng::seed_from_u64(seed);
            random.set_stream(stream);
            let offset = std::array::from_fn(|_| random.random::<f64>());
            Grid::new(profile, plan, nominal, axes, Some(offset)).sum(progress)
        })
        .collect();
    let values: Vec<f64> = sums.iter().map(|sum| sum.probability).collect();
    let probability = values.iter().sum::<f64>() / values.len() as f64;
    Estimate {
        probability,
        standard_error: standard_error_of_mean(&values, probability),
        shots: sums.iter().map(|sum| sum.shots).sum(),
        certain: axes.iter().all(|axis| axis.count == 1),
        ..Estimate::default()
    }
}

/// One grid: common without an `offset`, shifted from line to line with it.
struct Grid<'a> {
    profile: &'a Profile,
    plan: &'a TablePlan,
    nominal: &'a Nominal,
    axes: [CellAxis; AXES],
    errors: [Gaussian; AXES],
    offset: Option<[f64; AXES]>,
}

impl<'a> Grid<'a> {
    fn new(
        profile: &'a Profile,
        plan: &'a TablePlan,
        nominal: &'a Nominal,
        axes: [CellAxis; AXES],
        offset: Option<[f64; AXES]>,
    ) -> Self {
        Self {
            profile,
            plan,
            nominal,
            axes,
            errors: Self::gaussians(profile, nominal),
            offset,
        }
    }

    /// The nominal values along the axes with the standard deviations of their errors.
    fn gaussians(profile: &Profile, nominal: &Nominal) -> [Gaussian; AXES] {
        let [speed, pitch, polar, spin, ..] = profile.shooter().dispersion.sigmas(nominal);
        let sigmas = [pitch, polar, spin, speed];
        std::array::from_fn(|i| Gaussian {
            mean: nominal.get(NominalVariable::TABLE_AXES[i]),
            sigma: sigmas[i],
        })
    }

    /// Position of the points of an axis within their cells, for the cells' own shift.
    fn position(&self, axis: usize, shift: impl FnOnce() -> f64) -> f64 {
        self.offset
            .map_or(0.5, |offset| (shift() + offset[axis]).fract())
    }

    /// Weight of a value along an axis. An axis without an error has one value of weight 1.
    fn weight(&self, axis: usize, x: f64) -> f64 {
        let (cells, error) = (&self.axes[axis], self.errors[axis]);
        if cells.count == 1 && error.sigma == 0.0 {
            1.0
        } else {
            weight(x, error, cells.step())
        }
    }

    /// The sum over all axes.
    fn sum(&self, progress: &dyn Progress) -> GridSum {
        let [pitches, polars, ..] = &self.axes;
        let cells = pitches.count * polars.count;
        progress.begin("simulating", cells as u64);
        let sums: Vec<GridSum> = (0..cells)
            .into_par_iter()
            .map_init(BatchWorkspace::default, |workspace, cell| {
                progress.advance(1);
                self.cell_sum((cell / polars.count, cell % polars.count), workspace)
            })
            .collect();
        progress.end();
        // In the order of the cells, so that the number of threads changes nothing.
        sums.iter().fold(GridSum::default(), |total, sum| GridSum {
            probability: total.probability + sum.probability,
            shots: total.shots + sum.shots,
        })
    }

    /// The sum over speed and backspin of one (pitch, polar) cell.
    fn cell_sum(&self, (pitch, polar): (usize, usize), workspace: &mut BatchWorkspace) -> GridSum {
        let [pitches, polars, spins, speeds] = &self.axes;
        // The pitch angles all have the same position.
        let pitch_position = self.offset.map_or(0.5, |offset| offset[0]);
        let pitch_rad = pitches.value(pitch, pitch_position);
        let polar_rad = polars.value(polar, self.position(1, || polar_shift(pitch)));
        let angle_weight = self.weight(0, pitch_rad) * self.weight(1, polar_rad);
        let Some((least, most)) = self.plan.bracket.speeds_m_s(pitch_rad, polar_rad) else {
            return GridSum::default();
        };
        if angle_weight == 0.0 {
            return GridSum::default();
        }
        let direction = ReleaseWithoutSpeed::new(&self.profile.release(&Nominal {
            pitch_rad,
            polar_rad,
            ..*self.nominal
        }));
        let mut starts = Vec::with_capacity(spins.count * speeds.count);
        let mut weights = Vec::with_capacity(starts.capacity());
        let spin_position = self.position(2, || spin_shift(pitch, polar));
        for (k, spin) in spins.values(spin_position).enumerate() {
            let spin_weight = self.weight(2, spin);
            let speed_position = self.position(3, || speed_shift(pitch, polar, k));
            for speed in speeds.values(speed_position) {
                let weight = spin_weight * self.weight(3, speed);
                // Outside the bracket nothing is made.
                if weight > 0.0 && speed >= least && speed <= most {
                    starts.push(direction.state(speed, spin));
                    weights.push(weight);
                }
            }
        }
        let verdicts = self.profile.simulator().finite_verdicts(&starts, workspace);
        let inner: f64 = verdicts
            .iter()
            .zip(&weights)
            .filter(|(verdict, _)| verdict.made)
            .map(|(_, weight)| weight)
            .sum();
        GridSum {
            probability: angle_weight * inner,
            shots: starts.len() as u64,
        }
    }
}
