//! Outcomes and P over speed and pitch angle, the other nominal values fixed: the paper's Figs. 12
//! to 15, and what a shooter's errors make of them.
//!
//! P at a point is Eq. 25. Every cell, and the cells beyond the map's edges that errors reach, gets
//! a few shots with errors in polar angle and backspin from a Kronecker sequence. The shares of
//! made shots are averaged with the normal densities of speed and pitch angle. Other errors are
//! left out.

use crate::dynamics::{BatchWorkspace, OutcomeKind, ReleaseWithoutSpeed};
use crate::math::normal_distribution;
use crate::model::BallState;
use crate::shooter::{Nominal, Profile};
use rayon::prelude::*;

/// Shots of each cell.
const DRAWS: usize = 8;
/// Standard deviations that are simulated beyond the map's edges.
const REACH_SIGMAS: f64 = 4.0;
/// A standard deviation below this many cells counts as zero.
const MIN_SIGMA_CELLS: f64 = 0.4;
/// Steps of the Kronecker sequence: powers of the inverse of the plastic number (Roberts 2018).
const KRONECKER_STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_3];

/// The cells of a map: speeds from left to right, pitch angles from below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReleaseCells {
    /// Least and greatest speed, m/s.
    pub speed_m_s: (f64, f64),
    /// Least and greatest pitch angle, rad.
    pub pitch_rad: (f64, f64),
    /// Cells along the speed.
    pub columns: usize,
    /// Cells along the pitch angle.
    pub rows: usize,
}

fn cell_centre((low, high): (f64, f64), i: f64, count: usize) -> f64 {
    low + (high - low) * (i + 0.5) / count as f64
}

impl ReleaseCells {
    /// Speed and pitch angle at the centre of a cell, which may lie beyond the edges.
    #[must_use]
    pub fn centre(&self, column: f64, row: f64) -> (f64, f64) {
        (
            cell_centre(self.speed_m_s, column, self.columns),
            cell_centre(self.pitch_rad, row, self.rows),
        )
    }
}

/// The outcome of the error-free shot at the centre of each cell, row by row from the lowest pitch
/// angle.
#[must_use]
pub fn outcomes(profile: &Profile, nominal: &Nominal, cells: &ReleaseCells) -> Vec<OutcomeKind> {
    (0..cells.rows * cells.columns)
        .into_par_iter()
        .with_min_len(64)
        .map(|i| {
            let (row, column) = (i / cells.columns, i % cells.columns);
            let (speed_m_s, pitch_rad) = cells.centre(column as f64, row as f64);
            let shot = Nominal {
                speed_m_s,
                pitch_rad,
                ..*nominal
            };
            let start = profile.release(&shot).state();
            profile.simulator().outcome(start).kind
        })
        .collect()
}

/// P of the nominal shot at the centre of each cell under the four errors of Eq. 25, in the same
/// order.
#[must_use]
pub fn probabilities(profile: &Profile, nominal: &Nominal, cells: &ReleaseCells) -> Vec<f64> {
    let map = ProbabilityMap::new(profile, nominal, cells);
    let by_row = map.average_over_speed();
    map.average_over_pitch(&by_row)
}

struct ProbabilityMap<'a> {
    profile: &'a Profile,
    nominal: &'a Nominal,
    cells: &'a ReleaseCells,
    /// Width and height of a cell, m/s and rad.
    step: (f64, f64),
    /// Cells beyond the edges of the map, on each side and above and below.
    margin: (usize, usize),
}

impl<'a> ProbabilityMap<'a> {
    fn new(profile: &'a Profile, nominal: &'a Nominal, cells: &'a ReleaseCells) -> Self {
        let dispersion = &profile.shooter().dispersion;
        let width = |(low, high): (f64, f64), count: usize| (high - low) / count as f64;
        let step = (
            width(cells.speed_m_s, cells.columns),
            width(cells.pitch_rad, cells.rows),
        );
        let speed_sigma = dispersion
            .speed_m_s(cells.speed_m_s.0)
            .max(dispersion.speed_m_s(cells.speed_m_s.1));
        let reach = |sigma: f64, step: f64| (REACH_SIGMAS * sigma / step).ceil() as usize;
        Self {
            profile,
            nominal,
            cells,
            step,
            margin: (
                reach(speed_sigma, step.0),
                reach(dispersion.c20_rad, step.1),
            ),
        }
    }

    /// Columns and rows with the margin.
    fn size(&self) -> (usize, usize) {
        (
            self.cells.columns + 2 * self.margin.0,
            self.cells.rows + 2 * self.margin.1,
        )
    }

    /// The states of the shots of a row, [`DRAWS`] for each cell.
    fn starts_of_row(&self, row: usize) -> Vec<BallState> {
        let dispersion = &self.profile.shooter().dispersion;
        let spin_sigma = dispersion.backspin_rad_s(self.nominal.backspin_rad_s);
        let (columns, _) = self.size();
        let mut starts = Vec::with_capacity(columns * DRAWS);
        for column in 0..columns {
            let (speed_m_s, pitch_rad) = self.cells.centre(
                column as f64 - self.margin.0 as f64,
                row as f64 - self.margin.1 as f64,
            );
            for draw in 0..DRAWS {
                let index = ((row * columns + column) * DRAWS + draw + 1) as f64;
                let [polar, spin] = KRONECKER_STEPS.map(|step| {
                    let uniform = (index * step).fract().clamp(1e-12, 1.0 - 1e-12);
                    normal_distribution::quantile(uniform)
                });
                let shot = Nominal {
                    speed_m_s,
                    pitch_rad,
                    polar_rad: self.nominal.polar_rad + dispersion.c30_rad * polar,
                    backspin_rad_s: self.nominal.backspin_rad_s + spin_sigma * spin,
                    ..*self.nominal
                };
                let direction = ReleaseWithoutSpeed::new(&self.profile.release(&shot));
                starts.push(direction.state(shot.speed_m_s, shot.backspin_rad_s));
            }
        }
        starts
    }

    /// For each row with the margin: the share of made shots, averaged over the error in speed.
    fn average_over_speed(&self) -> Vec<Vec<f64>> {
        let dispersion = &self.profile.shooter().dispersion;
        let (columns, rows) = self.size();
        let weights: Vec<Vec<f64>> = (0..self.cells.columns)
            .map(|column| {
                let (speed, _) = self.cells.centre(column as f64, 0.0);
                let sigma = dispersion.speed_m_s(speed) / self.step.0;
                cell_weights(columns, column + self.margin.0, sigma)
            })
            .collect();
        (0..rows)
            .into_par_iter()
            .map_init(BatchWorkspace::default, |workspace, row| {
                let starts = self.starts_of_row(row);
                let verdicts = self.profile.simulator().finite_verdicts(&starts, workspace);
                let made: Vec<f64> = verdicts
                    .chunks(DRAWS)
                    .map(|draws| {
                        draws.iter().filter(|verdict| verdict.made).count() as f64 / DRAWS as f64
                    })
                    .collect();
                weights
                    .iter()
                    .map(|weights| weighted_mean(weights, made.iter().copied()))
                    .collect()
            })
            .collect()
    }

    /// The values of [`ProbabilityMap::average_over_speed`], averaged over the error in pitch
    /// angle.
    fn average_over_pitch(&self, by_row: &[Vec<f64>]) -> Vec<f64> {
        let sigma = self.profile.shooter().dispersion.c20_rad / self.step.1;
        let (_, rows) = self.size();
        (0..self.cells.rows)
            .into_par_iter()
            .flat_map_iter(|row| {
                let weights = cell_weights(rows, row + self.margin.1, sigma);
                (0..self.cells.columns).map(move |column| {
                    weighted_mean(&weights, by_row.iter().map(|values| values[column]))
                })
            })
            .collect()
    }
}

/// The normal weights of `count` cells about the cell `centre`; `sigma` is in cells.
fn cell_weights(count: usize, centre: usize, sigma: f64) -> Vec<f64> {
    (0..count)
        .map(|i| {
            let distance = i as f64 - centre as f64;
            if sigma < MIN_SIGMA_CELLS {
                f64::from(distance == 0.0)
            } else if distance.abs() > REACH_SIGMAS * sigma {
                0.0
            } else {
                normal_distribution::density(distance, 0.0, sigma)
            }
        })
        .collect()
}

fn weighted_mean(weights: &[f64], values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut total) = (0.0, 0.0);
    for (weight, value) in weights.iter().zip(values) {
        if *weight != 0.0 {
            sum += weight * value;
            total += weight;
        }
    }
    sum / total
}
