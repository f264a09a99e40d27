//! P of all nominal shots of a plan from one table of shots.
//!
//! Whether a release is made does not depend on the nominal values. So one table serves all of
//! them, and Eq. 25 factors into small matrices, one axis after the other: entry (nominal, cell) is
//! the normal density in the cell, times the width of the cell.

use super::gaussian_cell_weights::{
    Gaussian, WeightMatrix, add_weighted, add_weights, polar_shift, speed_shift, spin_shift,
    weight, weight_matrix, widened,
};
use super::progress::Progress;
use crate::dynamics::{BatchWorkspace, ReleaseWithoutSpeed, Verdict};
use crate::math::evenly_spaced::{CellAxis, Linspace};
use crate::model::BallState;
use crate::search_space::{NominalGrid, TablePlan};
use crate::shooter::{Nominal, NominalVariable, Profile, ReleaseDispersion};
use rayon::prelude::*;
use std::ops::Range;

/// Least and greatest number of shots that are simulated together. More shots fill the lanes
/// better; fewer take less memory.
const MIN_BATCH_SHOTS: usize = 2048;
/// See [`MIN_BATCH_SHOTS`].
const MAX_BATCH_SHOTS: usize = 65_536;
/// Greatest memory of a thread's batch, bytes.
pub const MAX_BATCH_BYTES: usize =
    MAX_BATCH_SHOTS * (size_of::<BallState>() + size_of::<Verdict>() + size_of::<f64>());
/// Batches for each thread, so that all threads end at about the same time. (No result depends on
/// it.)
const BATCHES_PER_THREAD: usize = 8;

/// Points farther than this from every nominal shot, in standard deviations of the four errors
/// together, are not simulated. The weights of all of them sum to at most 4.5e-4 (chi-square with
/// four degrees of freedom above 4.5^2): that is for a grid of one shot. At a corner of a wide grid
/// it is 8e-5, within the grid less. In a window that is a third of the points.
const REACH_SIGMAS: f64 = 4.5;

/// The root mean square error of P in the table of a window (`campaign_table`).
pub const TABLE_RMS_ERROR: f64 = 0.001;

/// The made shots of a plan, summed over speed and backspin with the weights of every nominal speed
/// and backspin.
#[derive(Clone, Debug)]
pub struct NominalTable {
    plan: TablePlan,
    /// `[pitch][polar][nominal backspin][nominal speed]`.
    sums: Vec<f64>,
}

/// P of every nominal shot of a table.
#[derive(Clone, Debug)]
pub struct NominalProbabilities {
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
    /// Spin about the horizontal direction of the shot, rad/s.
    pub rifle_spin_rad_s: f64,
    /// Spin about the vertical, rad/s.
    pub side_spin_rad_s: f64,
}

/// The indices of a nominal shot in a table, in the order of [`NominalVariable::TABLE_AXES`].
pub(crate) type TableIndex = [usize; NominalVariable::TABLE_AXES.len()];

impl NominalProbabilities {
    /// The values along each axis, in the order of [`NominalVariable::TABLE_AXES`].
    fn axes(&self) -> [&[f64]; NominalVariable::TABLE_AXES.len()] {
        [
            &self.pitch_rad,
            &self.polar_rad,
            &self.backspin_rad_s,
            &self.speed_m_s,
        ]
    }

    /// Number of values along each axis, in the order of [`NominalVariable::TABLE_AXES`].
    #[must_use]
    pub fn counts(&self) -> TableIndex {
        self.axes().map(<[f64]>::len)
    }

    /// The indices of the nominal shot nearest to the given one.
    #[must_use]
    pub fn index_of(&self, nominal: &Nominal) -> TableIndex {
        let nearest = |values: &[f64], x: f64| {
            (0..values.len())
                .min_by(|&a, &b| (values[a] - x).abs().total_cmp(&(values[b] - x).abs()))
                .unwrap_or(0)
        };
        let axes = self.axes();
        std::array::from_fn(|i| nearest(axes[i], nominal.get(NominalVariable::TABLE_AXES[i])))
    }

    /// P and the nominal shot at an index.
    #[must_use]
    pub fn at(&self, [pitch, polar, backspin, speed]: TableIndex) -> (f64, Nominal) {
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

    /// P and the nominal shot at every index, in their order.
    pub(crate) fn shots(&self) -> impl Iterator<Item = (f64, Nominal)> {
        let counts = self.counts();
        (0..self.values.len()).map(move |index| {
            let speed = index % counts[3];
            let line = index / counts[3];
            let backspin = line % counts[2];
            let plane = line / counts[2];
            self.at([plane / counts[1], plane % counts[1], backspin, speed])
        })
    }
}

impl NominalTable {
    /// Simulates the shots of the plan on the current rayon pool.
    #[must_use]
    pub fn simulate(profile: &Profile, plan: &TablePlan, progress: &dyn Progress) -> Self {
        let dispersion = &profile.shooter().dispersion;
        let nominal = &plan.nominal;
        let speeds = gaussians(nominal.speed.values(), |v| dispersion.speed_m_s(v));
        let spins = gaussians(nominal.backspin.values(), |w| dispersion.backspin_rad_s(w));
        let greatest = |all: &[Gaussian]| all.iter().map(|one| one.sigma).fold(0.0, f64::max);
        let near = |axis, sigma: f64, step: f64| Near {
            axis,
            sigma: widened(sigma, step),
        };
        let simulation = TableSimulation {
            profile,
            plan,
            near_pitch: near(nominal.pitch, dispersion.c20_rad, plan.pitch.step()),
            near_polar: near(nominal.polar, dispersion.c30_rad, plan.polar.step()),
            near_spin: near(nominal.backspin, greatest(&spins), plan.backspin.step()),
            speed_sigma: greatest(&speeds),
            even_speeds: even(&speeds, nominal.speed.step()),
            speeds,
            spins,
        };
        let cell_values = simulation.speeds.len() * simulation.spins.len();
        let mut sums = vec![0.0; plan.pitch.count * plan.polar.count * cell_values];
        progress.begin("simulating", plan.shots);
        let shots_per_cell = plan.backspin.count * plan.speeds_per_line;
        let even = plan.shots as usize / (BATCHES_PER_THREAD * rayon::current_num_threads());
        let batch_shots = even.clamp(MIN_BATCH_SHOTS, MAX_BATCH_SHOTS);
        let batch_cells = (batch_shots / shots_per_cell).max(1);
        sums.par_chunks_mut(cell_values * batch_cells)
            .enumerate()
            .for_each_init(CellBatch::default, |memory, (batch, sums)| {
                let count = sums.len() / cell_values;
                let cells = (batch * batch_cells..)
                    .take(count)
                    .map(|cell| (cell / plan.polar.count, cell % plan.polar.count));
                simulation.run_cells(cells, sums.chunks_mut(cell_values), memory);
                progress.advance((count * shots_per_cell) as u64);
            });
        progress.end();
        Self {
            plan: plan.clone(),
            sums,
        }
    }

    /// Eq. 25 at every nominal shot: the products along polar angle and pitch angle.
    #[must_use]
    pub fn probabilities(self, profile: &Profile) -> NominalProbabilities {
        let plan = &self.plan;
        let NominalGrid {
            speed,
            pitch,
            polar,
            backspin,
            rifle_spin_rad_s,
            side_spin_rad_s,
        } = plan.nominal;
        let pitch_rad: Vec<f64> = pitch.values().collect();
        let polar_rad: Vec<f64> = polar.values().collect();
        let dispersion = &profile.shooter().dispersion;
        let by_pitch: Vec<WeightMatrix> = (0..plan.pitch.count)
            .map(|i| polar_weights(plan, i, &polar_rad, dispersion))
            .collect();
        let inner = speed.count * backspin.count;
        let values = apply_along_axis(self.sums, plan.polar.count, inner, |i| &by_pitch[i]);
        let inner = polar_rad.len() * inner;
        let matrix = weight_matrix(&plan.pitch, 0.5, &pitch_rad, dispersion.c20_rad);
        let values = apply_along_axis(values, plan.pitch.count, inner, |_| &matrix);
        NominalProbabilities {
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

/// Nominal values with the standard deviations of their errors.
fn gaussians(means: impl Iterator<Item = f64>, sigma: impl Fn(f64) -> f64) -> Vec<Gaussian> {
    means
        .map(|mean| Gaussian {
            mean,
            sigma: sigma(mean),
        })
        .collect()
}

/// The nominal values along one axis, to tell how far a point is from all of them.
struct Near {
    axis: Linspace,
    sigma: f64,
}

impl Near {
    /// The square of the distance from the nearest nominal value, in standard deviations.
    fn square(&self, x: f64) -> f64 {
        let distance = (self.axis.low - x).max(x - self.axis.high).max(0.0) / self.sigma;
        distance * distance
    }
}

/// The first of some evenly spaced nominal values and their spacing, if they have one standard
/// deviation.
fn even(nominals: &[Gaussian], spacing: f64) -> Option<(Gaussian, f64)> {
    let first = *nominals.first()?;
    let same = |nominal: &Gaussian| nominal.sigma == first.sigma;
    (spacing > 0.0 && nominals.iter().all(same)).then_some((first, spacing))
}

/// A (pitch, polar) cell of a table.
type Cell = (usize, usize);

/// Memory that a thread reuses for the cells of its batches.
#[derive(Default)]
struct CellBatch {
    workspace: BatchWorkspace,
    starts: Vec<BallState>,
    speeds: Vec<f64>,
    /// For each cell, its line of speeds.
    lines: Vec<Option<CellAxis>>,
    /// For each backspin of each of these lines, the number of its speeds that are simulated.
    counts: Vec<usize>,
    sums: Vec<f64>,
}

/// The simulation of a table.
struct TableSimulation<'a> {
    profile: &'a Profile,
    plan: &'a TablePlan,
    near_pitch: Near,
    near_polar: Near,
    near_spin: Near,
    /// Greatest standard deviation of the nominal speeds, m/s.
    speed_sigma: f64,
    /// Nominal speeds, m/s.
    speeds: Vec<Gaussian>,
    /// The first of them and their spacing, if their errors do not grow with the speed.
    even_speeds: Option<(Gaussian, f64)>,
    /// Nominal backspins, rad/s.
    spins: Vec<Gaussian>,
}

impl TableSimulation<'_> {
    /// Simulates the lines of some cells together, and sums those of each cell over speed and
    /// backspin.
    fn run_cells<'a>(
        &self,
        cells: impl Iterator<Item = Cell> + Clone,
        sums_of_cells: impl Iterator<Item = &'a mut [f64]>,
        memory: &mut CellBatch,
    ) {
        memory.starts.clear();
        memory.speeds.clear();
        memory.lines.clear();
        memory.counts.clear();
        for cell in cells.clone() {
            self.add_shots(cell, memory);
        }
        let simulator = self.profile.simulator();
        let verdicts = simulator.finite_verdicts(&memory.starts, &mut memory.workspace);
        let mut shots = verdicts.iter().zip(&memory.speeds);
        let mut counts = memory.counts.iter();
        for ((cell, line), cell_sums) in cells.zip(&memory.lines).zip(sums_of_cells) {
            let Some(line) = line else {
                continue;
            };
            for (spin_rad_s, &count) in self.spins_of(cell).zip(counts.by_ref()) {
                memory.sums.clear();
                memory.sums.resize(self.speeds.len(), 0.0);
                let mut any_made = false;
                for (verdict, &speed) in shots.by_ref().take(count) {
                    if verdict.made {
                        any_made = true;
                        self.add_speed_weights(&mut memory.sums, speed, line.step());
                    }
                }
                if any_made {
                    let rows = cell_sums.chunks_mut(self.speeds.len());
                    for (row, &nominal) in rows.zip(&self.spins) {
                        let weight = weight(spin_rad_s, nominal, self.plan.backspin.step());
                        add_weighted(row, weight, &memory.sums);
                    }
                }
            }
        }
    }

    /// Adds the weights of a speed under every nominal speed to `sums`.
    fn add_speed_weights(&self, sums: &mut [f64], speed: f64, step: f64) {
        match self.even_speeds {
            Some((first, spacing)) => add_weights(sums, speed, first, spacing, step),
            None => {
                for (sum, &nominal) in sums.iter_mut().zip(&self.speeds) {
                    *sum += weight(speed, nominal, step);
                }
            }
        }
    }

    /// Adds the shots of a cell: a line of speeds for each backspin, or none if no speed of the
    /// plan is in the bracket.
    fn add_shots(&self, (pitch, polar): Cell, memory: &mut CellBatch) {
        let plan = self.plan;
        let pitch_rad = plan.pitch.value(pitch, 0.5);
        let polar_rad = plan.polar.value(polar, polar_shift(pitch));
        let line = plan
            .bracket
            .speeds_m_s(pitch_rad, polar_rad)
            .map(|(least, most)| CellAxis {
                low: least.max(plan.speed_m_s.0),
                high: most.min(plan.speed_m_s.1),
                count: plan.speeds_per_line,
            })
            .filter(|line| line.low < line.high);
        memory.lines.push(line);
        let Some(line) = line else {
            return;
        };
        let direction = ReleaseWithoutSpeed::new(&self.profile.release(&Nominal {
            speed_m_s: 0.0,
            pitch_rad,
            polar_rad,
            backspin_rad_s: 0.0,
            rifle_spin_rad_s: plan.nominal.rifle_spin_rad_s,
            side_spin_rad_s: plan.nominal.side_spin_rad_s,
        }));
        let squares = self.near_pitch.square(pitch_rad) + self.near_polar.square(polar_rad);
        for (spin, spin_rad_s) in self.spins_of((pitch, polar)).enumerate() {
            let left = REACH_SIGMAS * REACH_SIGMAS - squares - self.near_spin.square(spin_rad_s);
            let shift = speed_shift(pitch, polar, spin);
            let range = self.near_speeds(&line, shift, left);
            memory.counts.push(range.len());
            for speed in range.map(|i| line.value(i, shift)) {
                memory.speeds.push(speed);
                memory.starts.push(direction.state(speed, spin_rad_s));
            }
        }
    }

    /// The speeds of a line that are near enough to a nominal one, if the square of their distance
    /// may be `left`.
    fn near_speeds(&self, line: &CellAxis, shift: f64, left: f64) -> Range<usize> {
        if left < 0.0 {
            return 0..0;
        }
        let nominal = self.plan.nominal.speed;
        let reach = left.sqrt() * widened(self.speed_sigma, line.step());
        // A negative number becomes 0.
        let index_of = |speed: f64| ((speed - line.low) / line.step() - shift).ceil() as usize;
        let begin = index_of(nominal.low - reach).min(line.count);
        let end = index_of(nominal.high + reach).min(line.count);
        begin..end.max(begin)
    }

    /// The backspins of a cell's lines, rad/s.
    fn spins_of(&self, (pitch, polar): Cell) -> impl Iterator<Item = f64> + use<> {
        self.plan.backspin.values(spin_shift(pitch, polar))
    }
}

/// The weights of the polar angles of one pitch angle. A mirrored axis counts for both sides.
fn polar_weights(
    plan: &TablePlan,
    pitch: usize,
    nominals: &[f64],
    dispersion: &ReleaseDispersion,
) -> WeightMatrix {
    let (axis, shift) = (&plan.polar, polar_shift(pitch));
    let mut matrix = weight_matrix(axis, shift, nominals, dispersion.c30_rad);
    if plan.mirrored {
        let opposite: Vec<f64> = nominals.iter().map(|polar| -polar).collect();
        let other_side = weight_matrix(axis, shift, &opposite, dispersion.c30_rad);
        for (row, other) in matrix.iter_mut().zip(&other_side) {
            add_weighted(row, 1.0, other);
        }
    }
    matrix
}

/// Applies a matrix along the middle axis of `[outer][cells][inner]`; returns
/// `[outer][rows][inner]`. Each outer index may have its own matrix. Each output row is summed in
/// the order of the cells.
fn apply_along_axis<'a>(
    input: Vec<f64>,
    cells: usize,
    inner: usize,
    matrix: impl Fn(usize) -> &'a WeightMatrix + Sync,
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
                add_weighted(row, weight, cell);
            }
        });
    output
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_apply_along_axis_is_the_matrix_product() {
        let input: Vec<f64> = (0..2 * 3 * 4).map(f64::from).collect();
        let matrix = vec![vec![1.0, 0.0, 0.0], vec![0.5, 0.25, 2.0]];
        let output = apply_along_axis(input.clone(), 3, 4, |_| &matrix);
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
