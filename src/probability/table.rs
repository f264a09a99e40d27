//! The table of `cond` of one place, and Eq. 25 at every nominal shot.
//!
//! `cond(v, alpha, beta, w)` does not depend on the nominal values, so one table serves all of them,
//! and Eq. 25 factors into one small matrix per axis: entry (nominal, cell) is the normal density of
//! the cell under the nominal's sigma, times the cell's width. Speed comes first, line by line, so
//! each line can have its own bracket and its own shift of the speed grid: on one common grid the
//! thin surfaces of `cond` alias with it (errors up to 0.018 in P); `docs/performance.md` has what is
//! left with the shifts.

use super::{Progress, normal};
use crate::dynamics::{Aim, Room, Simulator};
use crate::plan::{Axis, Plan};
use crate::profile::{Nominal, Profile};
use rayon::prelude::*;

/// Shift of the speed grid from line to line, in parts of a step, per step of the other axes.
const SHIFT_PER_STEP: [f64; 3] = [0.819, 0.671, 0.550];
/// Normal weights beyond this many standard deviations are left out (they sum to 4e-8).
const REACH_SIGMAS: f64 = 5.5;
/// Standard deviations below this part of a cell are widened to it, for the search only: a narrower
/// weight would fall between the points. The probability that is reported is computed without.
const LEAST_SIGMA_CELLS: f64 = 0.6;

/// Sums over speed of `cond`, for every line and nominal speed.
#[derive(Clone, Debug)]
pub struct Table {
    plan: Plan,
    /// `[pitch][polar][backspin][nominal speed]`.
    sums: Vec<f64>,
}

/// P of every nominal shot of a table.
#[derive(Clone, Debug)]
pub struct Probabilities {
    /// Nominal pitch angles, rad.
    pub pitch_rad: Vec<f64>,
    /// Nominal polar angles, rad.
    pub polar_rad: Vec<f64>,
    /// Nominal backspins, rad/s.
    pub backspin_rad_s: Vec<f64>,
    /// Nominal speeds, m/s.
    pub speed_m_s: Vec<f64>,
    /// `[pitch][polar][backspin][speed]`, 0 to 1.
    pub values: Vec<f64>,
}

impl Probabilities {
    /// P and the nominal shot at the indices of pitch, polar angle, backspin and speed.
    #[must_use]
    pub fn at(&self, [pitch, polar, backspin, speed]: [usize; 4]) -> (f64, Nominal) {
        let index = ((pitch * self.polar_rad.len() + polar) * self.backspin_rad_s.len() + backspin)
            * self.speed_m_s.len()
            + speed;
        let nominal = Nominal {
            speed_m_s: self.speed_m_s[speed],
            pitch_rad: self.pitch_rad[pitch],
            polar_rad: self.polar_rad[polar],
            backspin_rad_s: self.backspin_rad_s[backspin],
        };
        (self.values[index], nominal)
    }
}

impl Table {
    /// Simulates the plan's shots on the current rayon pool.
    #[must_use]
    pub fn build(
        profile: &Profile,
        plan: &Plan,
        simulator: &Simulator,
        progress: &dyn Progress,
    ) -> Self {
        let nominals: Vec<(f64, f64)> = plan
            .nominal_speed
            .values()
            .map(|speed| (speed, profile.shooter.errors.speed_m_s(speed)))
            .collect();
        let block = plan.backspin.count * nominals.len();
        let mut sums = vec![0.0; plan.pitch.count * plan.polar.count * block];
        progress.begin("simulating", plan.shots);
        sums.par_chunks_mut(block).enumerate().for_each_init(
            Room::default,
            |room, (pair, block)| {
                let cell = (pair / plan.polar.count, pair % plan.polar.count);
                fill(profile, plan, (simulator, room), &nominals, cell, block);
                progress.advance((plan.backspin.count * plan.speeds_per_line) as u64);
            },
        );
        progress.end();
        Self {
            plan: plan.clone(),
            sums,
        }
    }

    /// Eq. 25 at every nominal shot: the products along backspin, polar angle and pitch angle.
    #[must_use]
    pub fn probabilities(self, profile: &Profile) -> Probabilities {
        let plan = &self.plan;
        let errors = &profile.shooter.errors;
        let search = &profile.search;
        let pitch_rad = spread(search.pitch_min_rad, search.pitch_max_rad, plan.pitch.count);
        let polar_rad: Vec<f64> = plan.polar.values().collect();
        let backspin_rad_s = spread(0.0, profile.shooter.max_backspin_rad_s, plan.backspin.count);
        let speed_m_s: Vec<f64> = plan.nominal_speed.values().collect();

        let speeds = speed_m_s.len();
        let spin = weights(&plan.backspin, &backspin_rad_s, |w| {
            errors.backspin_rad_s(w)
        });
        let polar = weights(&plan.polar, &polar_rad, |_| errors.c30_rad);
        let pitch = weights(&plan.pitch, &pitch_rad, |_| errors.c20_rad);
        let values = along_axis(self.sums, plan.backspin.count, speeds, &spin);
        let inner = backspin_rad_s.len() * speeds;
        let values = along_axis(values, plan.polar.count, inner, &polar);
        let inner = polar_rad.len() * inner;
        let values = along_axis(values, plan.pitch.count, inner, &pitch);
        Probabilities {
            pitch_rad,
            polar_rad,
            backspin_rad_s,
            speed_m_s,
            values,
        }
    }
}

/// `count` values from `low` to `high`, both included; one where they are the same.
fn spread(low: f64, high: f64, count: usize) -> Vec<f64> {
    if !(low < high) {
        return vec![low];
    }
    (0..count)
        .map(|i| low + (high - low) * i as f64 / (count - 1) as f64)
        .collect()
}

/// Simulates the lines of one (pitch, polar) cell and sums each over speed.
fn fill(
    profile: &Profile,
    plan: &Plan,
    (simulator, room): (&Simulator, &mut Room),
    nominals: &[(f64, f64)],
    (pitch, polar): (usize, usize),
    block: &mut [f64],
) {
    let (pitch_rad, polar_rad) = (plan.pitch.value(pitch), plan.polar.value(polar));
    let Some((least, most)) = plan.bracket.speeds_m_s(pitch_rad, polar_rad) else {
        return;
    };
    let step = (most - least) / plan.speeds_per_line as f64;
    let aim = Aim::new(&profile.release(&Nominal {
        speed_m_s: 0.0,
        pitch_rad,
        polar_rad,
        backspin_rad_s: 0.0,
    }));
    let mut speeds = Vec::with_capacity(plan.backspin.count * plan.speeds_per_line);
    let mut starts = Vec::with_capacity(speeds.capacity());
    for backspin in 0..plan.backspin.count {
        let shift = [pitch, polar, backspin]
            .iter()
            .zip(SHIFT_PER_STEP)
            .fold(0.5, |sum, (&i, per_step)| sum + per_step * i as f64)
            .fract();
        let spin = plan.backspin.value(backspin);
        for i in 0..plan.speeds_per_line {
            let speed = least + (i as f64 + shift) * step;
            speeds.push(speed);
            starts.push(aim.state(speed, spin));
        }
    }
    let verdicts = simulator.verdicts(&starts, room);
    for (i, (verdict, speed)) in verdicts.iter().zip(speeds).enumerate() {
        if verdict.made {
            let line = i / plan.speeds_per_line * nominals.len();
            add_speed(
                &mut block[line..line + nominals.len()],
                nominals,
                speed,
                step,
            );
        }
    }
}

/// Adds a made shot to the sums of the nominal speeds that it counts for.
fn add_speed(line: &mut [f64], nominals: &[(f64, f64)], speed: f64, step: f64) {
    for (sum, &(nominal, sigma)) in line.iter_mut().zip(nominals) {
        let sigma = sigma.max(LEAST_SIGMA_CELLS * step);
        if (speed - nominal).abs() <= REACH_SIGMAS * sigma {
            *sum += normal::density(speed, nominal, sigma) * step;
        }
    }
}

/// One matrix of Eq. 25: rows are nominal values, columns the cells of the axis.
fn weights(axis: &Axis, nominals: &[f64], sigma: impl Fn(f64) -> f64) -> Vec<Vec<f64>> {
    let step = axis.step();
    nominals
        .iter()
        .map(|&nominal| {
            let sigma = sigma(nominal).max(LEAST_SIGMA_CELLS * step);
            axis.values()
                .map(|x| {
                    let near = (x - nominal).abs() <= REACH_SIGMAS * sigma;
                    if near {
                        normal::density(x, nominal, sigma) * step
                    } else {
                        0.0
                    }
                })
                .collect()
        })
        .collect()
}

/// Applies a matrix along the middle axis of `[outer][cells][inner]`, giving
/// `[outer][rows][inner]`; the input is given up. Each output row is summed in the order of the cells.
fn along_axis(input: Vec<f64>, cells: usize, inner: usize, matrix: &[Vec<f64>]) -> Vec<f64> {
    let outer = input.len() / (cells * inner);
    let mut output = vec![0.0; outer * matrix.len() * inner];
    output
        .par_chunks_mut(inner)
        .enumerate()
        .for_each(|(index, row)| {
            let (block, nominal) = (index / matrix.len(), index % matrix.len());
            let source = &input[block * cells * inner..(block + 1) * cells * inner];
            for (&weight, cell) in matrix[nominal].iter().zip(source.chunks(inner)) {
                if weight != 0.0 {
                    for (sum, value) in row.iter_mut().zip(cell) {
                        *sum += weight * value;
                    }
                }
            }
        });
    output
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_weights_of_a_nominal_inside_the_axis_sum_to_one() {
        let axis = Axis {
            low: -3.0,
            high: 5.0,
            count: 40,
        };
        for row in weights(&axis, &[0.0, 1.03, 1.99], |_| 0.3) {
            let sum: f64 = row.iter().sum();
            assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        }
    }

    #[test]
    fn prop_along_axis_is_the_matrix_product() {
        let input: Vec<f64> = (0..2 * 3 * 4).map(f64::from).collect();
        let matrix = vec![vec![1.0, 0.0, 0.0], vec![0.5, 0.25, 2.0]];
        let output = along_axis(input.clone(), 3, 4, &matrix);
        for outer in 0..2 {
            for (row, weights) in matrix.iter().enumerate() {
                for inner in 0..4 {
                    let want: f64 = (0..3)
                        .map(|cell| weights[cell] * input[(outer * 3 + cell) * 4 + inner])
                        .sum();
                    assert_eq!(output[(outer * 2 + row) * 4 + inner], want);
                }
            }
        }
    }
}
