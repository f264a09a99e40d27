//! The table of `cond` of one place, and Eq. 25 at every nominal shot.
//!
//! `cond(v, alpha, beta, w)` does not depend on the nominal values, so one table serves all of them,
//! and Eq. 25 factors into small matrices, one axis after the other: entry (nominal, cell) is the
//! normal density in the cell under the nominal's sigma, times the cell's width. An axis may be
//! shifted by any part of a cell that depends on the cells of the axes that are summed after it: the
//! backspins of each pair of angles, the polar angles of each pitch angle, and the speeds of every
//! line. The points are then a lattice in four dimensions. Without the shifts the thin surfaces of
//! `cond` alias with the grid (errors up to 0.018 in P); `docs/performance.md` has what is left.

use super::{Progress, normal};
use crate::dynamics::{Aim, Room, Simulator};
use crate::plan::{Axis, Nominals, Plan};
use crate::profile::{Errors, Nominal, Profile};
use rayon::prelude::*;

/// Shift of the speeds from line to line, in parts of a step, per step of pitch angle, polar angle and
/// backspin. This and the next two were the best of 60 drawn at random, judged by the error of P at 72
/// nominal shots of six shooters and places; half of the 60 came within 1.7 times of it.
const SPEED_SHIFT: [f64; 3] = [0.267, 0.891, 0.564];
/// Shift of the backspins per step of pitch angle and polar angle.
const SPIN_SHIFT: [f64; 2] = [0.224, 0.082];
/// Shift of the polar angles per step of pitch angle.
const POLAR_SHIFT: f64 = 0.571;
/// Normal weights beyond this many standard deviations are left out (they sum to 4e-8).
const REACH_SIGMAS: f64 = 5.5;
/// Standard deviations below this part of a cell are widened to it, for the search only: a narrower
/// weight would fall between the points. The probability that is reported is computed without.
const LEAST_SIGMA_CELLS: f64 = 0.6;

/// Sums over speed and backspin of `cond`, for every pair of angles, nominal backspin and nominal speed.
#[derive(Clone, Debug)]
pub struct Table {
    plan: Plan,
    /// `[pitch][polar][nominal backspin][nominal speed]`.
    sums: Vec<f64>,
}

/// Where on their axes the points of a line lie, in parts of a cell.
pub(super) mod points_of_line {
    use super::{POLAR_SHIFT, SPEED_SHIFT, SPIN_SHIFT, shift};

    /// The polar angles of a pitch angle.
    pub(crate) fn polar(pitch: usize) -> f64 {
        shift([pitch], [POLAR_SHIFT])
    }

    /// The backspins of a pitch angle and a polar angle.
    pub(crate) fn spin(pitch: usize, polar: usize) -> f64 {
        shift([pitch, polar], SPIN_SHIFT)
    }

    /// The speeds of a line.
    pub(crate) fn speed(pitch: usize, polar: usize, spin: usize) -> f64 {
        shift([pitch, polar, spin], SPEED_SHIFT)
    }
}

/// The shift of a cell's points, in parts of a cell, 0 to 1.
fn shift<const N: usize>(cells: [usize; N], per_step: [f64; N]) -> f64 {
    cells
        .iter()
        .zip(per_step)
        .fold(0.5, |sum, (&i, per_step)| sum + per_step * i as f64)
        .fract()
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
    /// Spin about the level direction of the shot, rad/s.
    pub rifle_spin_rad_s: f64,
    /// Spin about the vertical, rad/s.
    pub side_spin_rad_s: f64,
}

impl Probabilities {
    /// Nominal values of pitch, polar angle, backspin and speed.
    #[must_use]
    pub fn counts(&self) -> [usize; 4] {
        [
            self.pitch_rad.len(),
            self.polar_rad.len(),
            self.backspin_rad_s.len(),
            self.speed_m_s.len(),
        ]
    }

    /// The indices of the nominal shot nearest to the given one.
    #[must_use]
    pub fn index_of(&self, nominal: &Nominal) -> [usize; 4] {
        let nearest = |values: &[f64], x: f64| {
            (0..values.len())
                .min_by(|&a, &b| (values[a] - x).abs().total_cmp(&(values[b] - x).abs()))
                .unwrap_or(0)
        };
        [
            nearest(&self.pitch_rad, nominal.pitch_rad),
            nearest(&self.polar_rad, nominal.polar_rad),
            nearest(&self.backspin_rad_s, nominal.backspin_rad_s),
            nearest(&self.speed_m_s, nominal.speed_m_s),
        ]
    }

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
            rifle_spin_rad_s: self.rifle_spin_rad_s,
            side_spin_rad_s: self.side_spin_rad_s,
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
        let with_sigma = |sigma: &dyn Fn(f64) -> f64, values: Vec<f64>| -> Vec<(f64, f64)> {
            values.into_iter().map(|x| (x, sigma(x))).collect()
        };
        let errors = profile.shooter.errors;
        let nominals = &plan.nominal;
        let builder = Builder {
            profile,
            plan,
            simulator,
            speeds: with_sigma(&|v| errors.speed_m_s(v), nominals.speed.values().collect()),
            spins: with_sigma(
                &|w| errors.backspin_rad_s(w),
                nominals.backspin.values().collect(),
            ),
        };
        let block = builder.speeds.len() * builder.spins.len();
        let mut sums = vec![0.0; plan.pitch.count * plan.polar.count * block];
        progress.begin("simulating", plan.shots);
        let shots_of_cell = plan.backspin.count * plan.speeds_per_line;
        let even = plan.shots as usize / (BATCHES_PER_THREAD * rayon::current_num_threads());
        let shots = even.clamp(BATCH_SHOTS.0, BATCH_SHOTS.1);
        let cells = (shots / shots_of_cell).max(1);
        sums.par_chunks_mut(block * cells)
            .enumerate()
            .for_each_init(Workplace::default, |place, (batch, blocks)| {
                let count = blocks.len() / block;
                let cells = (batch * cells..).take(count).map(|pair| {
                    let (pitch, polar) = (pair / plan.polar.count, pair % plan.polar.count);
                    (pitch, polar)
                });
                builder.fill(cells, blocks.chunks_mut(block), place);
                progress.advance((count * shots_of_cell) as u64);
            });
        progress.end();
        Self {
            plan: plan.clone(),
            sums,
        }
    }

    /// Eq. 25 at every nominal shot: the products along polar angle and pitch angle.
    #[must_use]
    pub fn probabilities(self, profile: &Profile) -> Probabilities {
        let plan = &self.plan;
        let Nominals {
            speed,
            pitch,
            polar,
            backspin,
            rifle_spin_rad_s,
            side_spin_rad_s,
        } = plan.nominal;
        let pitch_rad: Vec<f64> = pitch.values().collect();
        let polar_rad: Vec<f64> = polar.values().collect();
        let errors = &profile.shooter.errors;
        let by_pitch: Vec<Matrix> = (0..plan.pitch.count)
            .map(|i| polar_weights(plan, i, &polar_rad, errors))
            .collect();
        let inner = speed.count * backspin.count;
        let values = along_axis(self.sums, plan.polar.count, inner, |outer| &by_pitch[outer]);
        let inner = polar_rad.len() * inner;
        let matrix = weights(&plan.pitch, 0.5, &pitch_rad, errors.c20_rad);
        let values = along_axis(values, plan.pitch.count, inner, |_| &matrix);
        Probabilities {
            pitch_rad,
            polar_rad,
            backspin_rad_s: backspin.values().collect(),
            speed_m_s: speed.values().collect(),
            values,
            rifle_spin_rad_s,
            side_spin_rad_s,
        }
    }
}

/// Least and most shots that are simulated together: the more, the better they fill the lanes to the
/// end; the fewer, the less memory they take.
const BATCH_SHOTS: (usize, usize) = (2048, 65_536);
/// Most memory that a thread needs for its batch, bytes.
pub const BATCH_BYTES: usize = BATCH_SHOTS.1
    * (size_of::<crate::dynamics::State>() + size_of::<crate::dynamics::Verdict>() + 8);
/// Batches for each thread, so that all end at about the same time. (No result depends on it.)
const BATCHES_PER_THREAD: usize = 8;

/// Memory that each thread uses from cell to cell.
#[derive(Default)]
struct Workplace {
    room: Room,
    starts: Vec<crate::dynamics::State>,
    speeds: Vec<f64>,
    /// Of each cell.
    lines: Vec<Option<Axis>>,
    sums: Vec<f64>,
}

/// Fills the cells of a table.
struct Builder<'a> {
    profile: &'a Profile,
    plan: &'a Plan,
    simulator: &'a Simulator,
    /// Nominal speeds with their standard deviations, m/s.
    speeds: Vec<(f64, f64)>,
    /// Nominal backspins with their standard deviations, rad/s.
    spins: Vec<(f64, f64)>,
}

impl Builder<'_> {
    /// Simulates the lines of some (pitch, polar) cells together and sums those of each over speed and
    /// backspin.
    fn fill<'a>(
        &self,
        cells: impl Iterator<Item = (usize, usize)> + Clone,
        blocks: impl Iterator<Item = &'a mut [f64]>,
        place: &mut Workplace,
    ) {
        place.starts.clear();
        place.speeds.clear();
        place.lines.clear();
        for cell in cells.clone() {
            self.draw(cell, place);
        }
        let verdicts = self.simulator.verdicts(&place.starts, &mut place.room);
        let mut verdicts = verdicts.iter();
        let mut speeds = place.speeds.iter();
        for ((cell, line), block) in cells.zip(&place.lines).zip(blocks) {
            let Some(line) = line else {
                continue;
            };
            for spin_rad_s in self.spins_of(cell) {
                place.sums.clear();
                place.sums.resize(self.speeds.len(), 0.0);
                let mut made = false;
                let shots = verdicts.by_ref().zip(speeds.by_ref()).take(line.count);
                for (verdict, &speed) in shots {
                    if verdict.made {
                        made = true;
                        for (sum, &nominal) in place.sums.iter_mut().zip(&self.speeds) {
                            *sum += weight(speed, nominal, line.step());
                        }
                    }
                }
                if made {
                    let rows = block.chunks_mut(self.speeds.len());
                    for (row, &nominal) in rows.zip(&self.spins) {
                        let weight = weight(spin_rad_s, nominal, self.plan.backspin.step());
                        add(row, weight, &place.sums);
                    }
                }
            }
        }
    }

    /// Lays out the shots of a cell: a line of speeds for each backspin, or none where no speed of the
    /// plan's is in the bracket.
    fn draw(&self, (pitch, polar): (usize, usize), place: &mut Workplace) {
        let plan = self.plan;
        let pitch_rad = plan.pitch.value(pitch, 0.5);
        let polar_rad = plan.polar.value(polar, points_of_line::polar(pitch));
        let line = plan
            .bracket
            .speeds_m_s(pitch_rad, polar_rad)
            .map(|(least, most)| Axis {
                low: least.max(plan.speed_m_s.0),
                high: most.min(plan.speed_m_s.1),
                count: plan.speeds_per_line,
            })
            .filter(|line| line.low < line.high);
        place.lines.push(line);
        let Some(line) = line else {
            return;
        };
        let aim = Aim::new(&self.profile.release(&Nominal {
            speed_m_s: 0.0,
            pitch_rad,
            polar_rad,
            backspin_rad_s: 0.0,
            rifle_spin_rad_s: plan.nominal.rifle_spin_rad_s,
            side_spin_rad_s: plan.nominal.side_spin_rad_s,
        }));
        for (spin, spin_rad_s) in self.spins_of((pitch, polar)).enumerate() {
            for speed in line.values(points_of_line::speed(pitch, polar, spin)) {
                place.speeds.push(speed);
                place.starts.push(aim.state(speed, spin_rad_s));
            }
        }
    }

    /// The backspins of a cell's lines, rad/s.
    fn spins_of(&self, (pitch, polar): (usize, usize)) -> impl Iterator<Item = f64> + use<> {
        let backspin = self.plan.backspin;
        backspin.values(points_of_line::spin(pitch, polar))
    }
}

/// Weight of a point of an axis for a nominal value with its standard deviation: the normal density
/// times the cell's width.
pub(super) fn weight(x: f64, (nominal, sigma): (f64, f64), step: f64) -> f64 {
    let sigma = sigma.max(LEAST_SIGMA_CELLS * step);
    if (x - nominal).abs() <= REACH_SIGMAS * sigma {
        normal::density(x, nominal, sigma) * step
    } else {
        0.0
    }
}

/// Adds `weight` times `values`.
fn add(sums: &mut [f64], weight: f64, values: &[f64]) {
    if weight != 0.0 {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += weight * value;
        }
    }
}

/// Rows are nominal values, columns the cells of an axis.
type Matrix = Vec<Vec<f64>>;

/// One matrix of Eq. 25, for an axis shifted by a part of a cell.
fn weights(axis: &Axis, shift: f64, nominals: &[f64], sigma: f64) -> Matrix {
    nominals
        .iter()
        .map(|&nominal| {
            axis.values(shift)
                .map(|x| weight(x, (nominal, sigma), axis.step()))
                .collect()
        })
        .collect()
}

/// The matrix of the polar angles of one pitch angle; a mirrored axis counts for both sides.
fn polar_weights(plan: &Plan, pitch: usize, nominals: &[f64], errors: &Errors) -> Matrix {
    let (axis, shift) = (&plan.polar, points_of_line::polar(pitch));
    let mut matrix = weights(axis, shift, nominals, errors.c30_rad);
    if plan.mirrored {
        let opposite: Vec<f64> = nominals.iter().map(|polar| -polar).collect();
        let other_side = weights(axis, shift, &opposite, errors.c30_rad);
        for (row, other) in matrix.iter_mut().zip(&other_side) {
            add(row, 1.0, other);
        }
    }
    matrix
}

/// Applies a matrix along the middle axis of `[outer][cells][inner]`, giving
/// `[outer][rows][inner]`; the input is given up. Each outer index may have its own matrix. Each output
/// row is summed in the order of the cells.
fn along_axis<'a>(
    input: Vec<f64>,
    cells: usize,
    inner: usize,
    matrix: impl Fn(usize) -> &'a Matrix + Sync,
) -> Vec<f64> {
    let outer = input.len() / (cells * inner);
    let rows = matrix(0).len();
    let mut output = vec![0.0; outer * rows * inner];
    output
        .par_chunks_mut(inner)
        .enumerate()
        .for_each(|(index, row)| {
            let (block, nominal) = (index / rows, index % rows);
            let source = &input[block * cells * inner..(block + 1) * cells * inner];
            for (&weight, cell) in matrix(block)[nominal].iter().zip(source.chunks(inner)) {
                add(row, weight, cell);
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
        for row in weights(&axis, 0.3, &[0.0, 1.03, 1.99], 0.3) {
            let sum: f64 = row.iter().sum();
            assert!((sum - 1.0).abs() < 1e-6, "{sum}");
        }
    }

    #[test]
    fn prop_along_axis_is_the_matrix_product() {
        let input: Vec<f64> = (0..2 * 3 * 4).map(f64::from).collect();
        let matrix = vec![vec![1.0, 0.0, 0.0], vec![0.5, 0.25, 2.0]];
        let output = along_axis(input.clone(), 3, 4, |_| &matrix);
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
