//! Outcomes and P over speed and pitch angle, the other nominal values held: the pictures of the paper's
//! Figs. 12 to 15, and what a shooter's errors make of them.
//!
//! P at a point is Eq. 25 there: every cell, and those beyond the map's edges as far as errors reach, is shot a
//! few times with errors in polar angle and backspin drawn by a Kronecker sequence, and the parts made are
//! averaged with the normal densities of speed and pitch angle. Other errors are left out.

use super::normal;
use crate::dynamics::{Aim, Kind, Room, Simulator};
use crate::profile::{Nominal, Profile};
use rayon::prelude::*;

/// Shots of each cell.
const DRAWS: usize = 8;
/// Standard deviations beyond the map's edges that are shot.
const REACH: f64 = 4.0;
/// Steps of the sequence by which errors are drawn: powers of the inverse of the plastic number (Roberts 2018).
const STEPS: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053_3];

/// The cells of a map: speeds from left to right, pitch angles from below.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cells {
    /// Least and greatest speed, m/s.
    pub speed_m_s: (f64, f64),
    /// Least and greatest pitch angle, rad.
    pub pitch_rad: (f64, f64),
    /// Cells along the speed.
    pub columns: usize,
    /// Cells along the pitch angle.
    pub rows: usize,
}

fn middle((low, high): (f64, f64), i: f64, count: usize) -> f64 {
    low + (high - low) * (i + 0.5) / count as f64
}

impl Cells {
    /// Speed and pitch angle in the middle of a cell, which may lie beyond the edges.
    #[must_use]
    pub fn at(&self, column: f64, row: f64) -> (f64, f64) {
        (
            middle(self.speed_m_s, column, self.columns),
            middle(self.pitch_rad, row, self.rows),
        )
    }
}

/// How the shot in the middle of each cell ends, without errors; row by row from the lowest pitch angle.
#[must_use]
pub fn outcomes(
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    cells: &Cells,
) -> Vec<Kind> {
    (0..cells.rows * cells.columns)
        .into_par_iter()
        .with_min_len(64)
        .map(|i| {
            let (row, column) = (i / cells.columns, i % cells.columns);
            let (speed_m_s, pitch_rad) = cells.at(column as f64, row as f64);
            let shot = Nominal {
                speed_m_s,
                pitch_rad,
                ..*nominal
            };
            simulator.shoot(&profile.release(&shot)).kind
        })
        .collect()
}

/// P of the nominal shot in the middle of each cell under the four errors of Eq. 25; in the same order.
#[must_use]
pub fn probabilities(
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    cells: &Cells,
) -> Vec<f64> {
    let errors = &profile.shooter.errors;
    let width = |(low, high): (f64, f64), count: usize| (high - low) / count as f64;
    let speed_step = width(cells.speed_m_s, cells.columns);
    let pitch_step = width(cells.pitch_rad, cells.rows);
    let speed_sigma = errors
        .speed_m_s(cells.speed_m_s.0)
        .max(errors.speed_m_s(cells.speed_m_s.1));
    let reach = |sigma: f64, step: f64| (REACH * sigma / step).ceil() as usize;
    let beside = reach(speed_sigma, speed_step);
    let above = reach(errors.c20_rad, pitch_step);
    let columns = cells.columns + 2 * beside;
    let rows = cells.rows + 2 * above;
    let spin_sigma = errors.backspin_rad_s(nominal.backspin_rad_s);
    // Along the speed each row is averaged at once.
    let weights: Vec<Vec<f64>> = (0..cells.columns)
        .map(|column| {
            let (speed, _) = cells.at(column as f64, 0.0);
            let sigma = errors.speed_m_s(speed) / speed_step;
            (0..columns)
                .map(|i| weight(i as f64 - (column + beside) as f64, sigma))
                .collect()
        })
        .collect();
    let by_row: Vec<Vec<f64>> = (0..rows)
        .into_par_iter()
        .map_init(Room::default, |room, row| {
            let mut starts = Vec::with_capacity(columns * DRAWS);
            for column in 0..columns {
                let (speed_m_s, pitch_rad) =
                    cells.at(column as f64 - beside as f64, row as f64 - above as f64);
                for draw in 0..DRAWS {
                    let index = ((row * columns + column) * DRAWS + draw + 1) as f64;
                    let [polar, spin] = STEPS.map(|step| {
                        normal::quantile((index * step).fract().clamp(1e-12, 1.0 - 1e-12))
                    });
                    let shot = Nominal {
                        speed_m_s,
                        pitch_rad,
                        polar_rad: nominal.polar_rad + errors.c30_rad * polar,
                        backspin_rad_s: nominal.backspin_rad_s + spin_sigma * spin,
                        ..*nominal
                    };
                    let aim = Aim::new(&profile.release(&shot));
                    starts.push(aim.state(shot.speed_m_s, shot.backspin_rad_s));
                }
            }
            let verdicts = simulator.verdicts(&starts, room);
            let made: Vec<f64> = verdicts
                .chunks(DRAWS)
                .map(|draws| {
                    draws.iter().filter(|verdict| verdict.made).count() as f64 / DRAWS as f64
                })
                .collect();
            weights.iter().map(|weights| mean(weights, &made)).collect()
        })
        .collect();
    let sigma = errors.c20_rad / pitch_step;
    (0..cells.rows)
        .into_par_iter()
        .flat_map_iter(|row| {
            let weights: Vec<f64> = (0..rows)
                .map(|i| weight(i as f64 - (row + above) as f64, sigma))
                .collect();
            let by_row = &by_row;
            (0..cells.columns).map(move |column| {
                let (mut sum, mut all) = (0.0, 0.0);
                for (weight, values) in weights.iter().zip(by_row) {
                    if *weight != 0.0 {
                        sum += weight * values[column];
                        all += weight;
                    }
                }
                sum / all
            })
        })
        .collect()
}

/// The normal density at a distance in cells, or the cell itself where it is narrower than that.
fn weight(distance: f64, sigma: f64) -> f64 {
    if sigma < 0.4 {
        return if distance == 0.0 { 1.0 } else { 0.0 };
    }
    if distance.abs() > REACH * sigma {
        return 0.0;
    }
    normal::density(distance, 0.0, sigma)
}

fn mean(weights: &[f64], values: &[f64]) -> f64 {
    let (mut sum, mut all) = (0.0, 0.0);
    for (weight, value) in weights.iter().zip(values) {
        if *weight != 0.0 {
            sum += weight * value;
            all += weight;
        }
    }
    sum / all
}
