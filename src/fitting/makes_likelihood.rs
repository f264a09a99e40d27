//! How likely the made and missed shots are for a ring, a backspin and a constant error of the
//! tracker.
//!
//! The chance that a measured shot goes in is the share of the releases that it may have been,
//! given its measurement. For each place a table of simulated shots is made once, over speed and
//! direction, at a few angles, backspins and rings, and smoothed by the uncertainty of a
//! measurement. Each chance is then looked up, so that the likelihood is smooth in the unknowns and
//! in the data.

use super::constant_error::{ConstantErrors, Correction};
use super::draw_probabilities::{lagrange, under_ring};
use super::expected_makes::release_given;
use super::interval::Interval;
use super::measured_release::{Covariance, MeasuredRelease, Place, Values, by_place, nominal_of};
use super::posterior::Draw;
use super::prior::{ConstantErrorPrior, StudentSpread};
use crate::dynamics::{BatchWorkspace, Simulator};
use crate::probability::Progress;
use crate::shooter::Profile;
use nalgebra::Vector3;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// Nodes of speed and direction, and of the angle. With several places there are fewer of the first
/// two: the more places, the less the noise of each matters.
const NODES: [usize; 2] = [64, 40];
const PITCHES: usize = 5;
/// What the ends of their axes are rounded to: relative speed, polar angle, angle (rad).
const ROUND: [f64; 3] = [0.01, 0.01, 0.05];
/// Rings and backspins of a table, between which chances are parabolas: so many scales, or standard
/// deviations, from the middle.
const RINGS: [f64; 4] = [-3.0, -1.0, 1.0, 3.0];
const BACKSPINS: [f64; 3] = [-2.0, 0.0, 2.0];
/// A table reaches for constant errors of so many scales.
const ERRORS: f64 = 3.0;
/// Where the backspin is known, rad/s.
const LEAST_BACKSPIN_SD_RAD_S: f64 = 0.5;
/// It reaches so many standard deviations of a measurement beyond its shots.
const MARGIN: f64 = 3.0;
/// A shot that comes down farther from the middle, m, misses.
const FARTHEST_M: f64 = 0.8;
/// Results that are written down wrongly, and touches that no model has: so many of all.
const WRONG_RESULTS: f64 = 0.01;

/// What no sensor sees.
#[derive(Clone, Debug)]
pub(super) struct Unseen {
    /// The restitution of the ring; `None` for that of the physics.
    pub(super) ring: Option<f64>,
    /// The mean backspin less that of the typical draw, rad/s.
    pub(super) more_backspin: f64,
    /// The tracker's constant errors.
    pub(super) constant_errors: ConstantErrors,
}

/// What the unknowns are known by beforehand; `None` for those that are known.
#[derive(Clone, Copy)]
pub(super) struct UnknownScales {
    pub(super) ring: Option<StudentSpread>,
    /// Standard deviation of the mean backspin, rad/s; 0 where it is known.
    pub(super) backspin_sd: f64,
    pub(super) constant_error: Option<ConstantErrorPrior>,
}

/// A shot with a result.
struct KnownShot {
    likeliest: Values,
    correction: Correction,
    made: bool,
}

impl KnownShot {
    /// The likeliest release, if the unknowns are these.
    fn release(&self, unseen: &Unseen) -> Values {
        let change = self.correction.change(&unseen.constant_errors);
        let [speed, pitch, polar, backspin] = self.likeliest;
        [
            speed + change[0],
            pitch + change[1],
            polar + change[2],
            backspin + unseen.more_backspin,
        ]
    }
}

/// The shots with a result of one shooter.
pub(super) struct MakesLikelihood {
    places: Vec<PlaceMakes>,
}

/// Those from one place.
struct PlaceMakes {
    shots: Vec<KnownShot>,
    table: ChanceTable,
}

impl MakesLikelihood {
    /// `typical` is the middle of what is known by the flights, `profiles` are those of its places.
    pub(super) fn new(
        (profiles, places): (&[Profile], &[Place]),
        shots: &[MeasuredRelease],
        (typical, measured_values): (&Draw, usize),
        scales: &UnknownScales,
        (seed, progress): (u64, &dyn Progress),
    ) -> Self {
        progress.begin("simulating shots", shots.len() as u64);
        let part = libm::pow(places.len() as f64, -0.25);
        let sample = (NODES.map(|count| (count as f64 * part) as usize), seed);
        let of_places = by_place(shots, places.len());
        let at_place = |(index, place): (usize, &Place)| {
            let profile = &profiles[index];
            let known = of_places[index].par_iter().filter_map(|shot| {
                progress.advance(1);
                let made = shot.made?;
                let (likeliest, uncertainty) = release_given(shot, typical, measured_values)?;
                let simulator = profile.simulator();
                let errors = scales.constant_error;
                let known = KnownShot {
                    correction: Correction::new(simulator, place, &likeliest, errors),
                    likeliest,
                    made,
                };
                Some((known, uncertainty))
            });
            let (known, uncertainties): (Vec<KnownShot>, Vec<Covariance>) = known.unzip();
            let sum = uncertainties.iter().sum::<Covariance>();
            let covariance = sum / known.len().max(1) as f64;
            let middle = &typical.means[index];
            let table = ChanceTable::new(profile, (&known, middle), &covariance, scales, sample);
            table.map(|table| PlaceMakes {
                shots: known,
                table,
            })
        };
        let places = places.iter().enumerate();
        let places = places.filter_map(at_place).collect();
        progress.end();
        Self { places }
    }

    /// The logarithm of the likelihood.
    pub(super) fn logarithm(&self, unseen: &Unseen) -> f64 {
        self.places
            .iter()
            .map(|place| place.logarithm(unseen))
            .sum()
    }

    /// How many of the shots should go in.
    pub(super) fn expected(&self, unseen: &Unseen) -> f64 {
        let places = self.places.iter();
        let chances = places.flat_map(|place| place.chances(unseen));
        chances.map(|(chance, _)| chance).sum()
    }
}

impl PlaceMakes {
    /// The chance of each shot, and whether it went in.
    fn chances(&self, unseen: &Unseen) -> impl Iterator<Item = (f64, bool)> {
        let rings = self.table.ring_weights(unseen.ring);
        let chance =
            move |shot: &KnownShot| (self.table.at(&shot.release(unseen), rings), shot.made);
        self.shots.iter().map(chance)
    }

    fn logarithm(&self, unseen: &Unseen) -> f64 {
        let each = self.chances(unseen).map(|(chance, made)| {
            let right = if made { chance } else { 1.0 - chance };
            libm::log(WRONG_RESULTS + (1.0 - 2.0 * WRONG_RESULTS) * right)
        });
        each.sum()
    }
}

/// Evenly spaced values, two at least.
#[derive(Clone, Copy)]
struct Axis {
    first: f64,
    step: f64,
    count: usize,
}

impl Axis {
    /// From and to round numbers, so that the last digits of the data do not move the nodes.
    fn over((low, high): (f64, f64), round_to: f64, count: usize) -> Self {
        let first = (low / round_to).floor() * round_to;
        let last = (high / round_to).ceil() * round_to;
        Self {
            first,
            step: (last - first).max(round_to) / (count - 1) as f64,
            count,
        }
    }

    fn value(&self, node: f64) -> f64 {
        self.first + self.step * node
    }

    /// The node below a value and the part of the way to the next; beyond the ends, the ends.
    fn place(&self, x: f64) -> (usize, f64) {
        let nodes = ((x - self.first) / self.step).clamp(0.0, (self.count - 1) as f64);
        let below = (nodes as usize).min(self.count - 2);
        (below, nodes - below as f64)
    }
}

/// The chance of a shot whose measurement gives a release.
struct ChanceTable {
    scale: SpeedScale,
    /// Relative speed, polar angle, pitch angle.
    axes: [Axis; 3],
    backspins: [f64; BACKSPINS.len()],
    rings: Vec<f64>,
    /// By pitch angle, relative speed, polar angle, ring, backspin: those of a lookup stand
    /// together.
    chances: Vec<f64>,
}

/// The speed that reaches the middle of the hoop without air, by the angle. Relative to it, the
/// speeds that go in hardly depend on the angle.
#[derive(Clone, Copy)]
struct SpeedScale {
    distance_m: f64,
    height_m: f64,
    gravity_m_s2: f64,
}

impl SpeedScale {
    fn speed_m_s(&self, pitch_rad: f64) -> f64 {
        let (sin, cos) = libm::sincos(pitch_rad);
        let least = 0.05 * self.distance_m;
        let rise = (self.distance_m * sin / cos + self.height_m).max(least);
        self.distance_m / cos * (0.5 * self.gravity_m_s2 / rise).sqrt()
    }

    /// By how much relative speed a shot comes down so much farther.
    fn for_depth(&self, pitch_rad: f64, depth_m: f64) -> f64 {
        let farther = Self {
            distance_m: self.distance_m + depth_m,
            ..*self
        };
        let change = farther.speed_m_s(pitch_rad) / self.speed_m_s(pitch_rad) - 1.0;
        change.abs().max(0.25 * depth_m / self.distance_m)
    }

    fn relative(&self, values: &Values) -> f64 {
        values[0] / self.speed_m_s(values[1])
    }

    /// The standard deviation of the relative speed.
    fn relative_sd(&self, middle: &Values, covariance: &Covariance) -> f64 {
        let step = 1e-3;
        let mut steeper = *middle;
        steeper[1] += step;
        let by_speed = 1.0 / self.speed_m_s(middle[1]);
        let by_pitch = (self.relative(&steeper) - self.relative(middle)) / step;
        let variance = by_speed * by_speed * covariance[(0, 0)]
            + 2.0 * by_speed * by_pitch * covariance[(0, 1)]
            + by_pitch * by_pitch * covariance[(1, 1)];
        variance.max(0.0).sqrt()
    }
}

impl ChanceTable {
    /// `None` without shots.
    fn new(
        profile: &Profile,
        (shots, middle): (&[KnownShot], &Values),
        covariance: &Covariance,
        scales: &UnknownScales,
        (nodes, seed): ([usize; 2], u64),
    ) -> Option<Self> {
        let release = profile.release(&nominal_of(middle));
        let scale = SpeedScale {
            distance_m: release.distance_m,
            height_m: release.height_above_hoop_m,
            gravity_m_s2: profile.physics().gravity_less_buoyancy_m_s2(),
        };
        let sds = [
            scale.relative_sd(middle, covariance),
            covariance[(2, 2)].max(0.0).sqrt(),
        ];
        if shots.is_empty() {
            return None;
        }
        let reach = reach(shots, scales);
        let axes = axes((&scale, nodes), &reach, middle, sds);
        let backspins = Interval::of(shots.iter().map(|shot| shot.likeliest[3]).collect());
        let sd = libm::hypot(backspins.sd, scales.backspin_sd).max(LEAST_BACKSPIN_SD_RAD_S);
        let backspins = BACKSPINS.map(|t| backspins.mean + t * sd);
        let rings = match scales.ring {
            Some(ring) => RINGS.map(|t| ring.middle + t * ring.scale).to_vec(),
            None => Vec::new(),
        };
        let mut table = Self {
            scale,
            axes,
            backspins,
            rings,
            chances: Vec::new(),
        };
        table.simulate(profile, sds, seed);
        Some(table)
    }

    fn simulate(&mut self, profile: &Profile, sds: [f64; 2], seed: u64) {
        let under: Vec<Simulator> = match self.rings.is_empty() {
            true => vec![profile.simulator().clone()],
            false => self
                .rings
                .iter()
                .map(|ring| under_ring(profile, Some(*ring)))
                .collect(),
        };
        let [speeds, polars, pitches] = self.axes;
        let kernels = [kernel(sds[0] / speeds.step), kernel(sds[1] / polars.step)];
        let planes: Vec<Vec<Vec<f64>>> = (0..pitches.count * self.backspins.len())
            .into_par_iter()
            .map_init(BatchWorkspace::default, |workspace, number| {
                let pitch = pitches.value((number % pitches.count) as f64);
                let backspin = self.backspins[number / pitches.count];
                let speed = self.scale.speed_m_s(pitch);
                // A shot somewhere in each cell, the same under each ring.
                let mut random = ChaCha12Rng::seed_from_u64(seed);
                random.set_stream(number as u64);
                let mut starts = Vec::with_capacity(speeds.count * polars.count);
                for i in 0..speeds.count {
                    for j in 0..polars.count {
                        let mut somewhere = || random.random::<f64>() - 0.5;
                        let relative = speeds.value(i as f64 + somewhere());
                        let polar = polars.value(j as f64 + somewhere());
                        let values = [relative * speed, pitch, polar, backspin];
                        starts.push(profile.release(&nominal_of(&values)).state());
                    }
                }
                let made_under = |simulator: &Simulator| {
                    let verdicts = simulator.finite_verdicts(&starts, workspace);
                    let made = verdicts.iter().map(|verdict| verdict.made);
                    let made: Vec<f64> = made.map(|made| f64::from(u8::from(made))).collect();
                    smoothed(&made, polars.count, &kernels)
                };
                under.iter().map(made_under).collect()
            })
            .collect();
        for pitch in 0..pitches.count {
            for cell in 0..speeds.count * polars.count {
                for ring in 0..under.len() {
                    let of_backspins = planes.iter().skip(pitch).step_by(pitches.count);
                    self.chances
                        .extend(of_backspins.map(|plane| plane[ring][cell]));
                }
            }
        }
    }

    /// The weight of each ring of the table in a value under another.
    fn ring_weights(&self, ring: Option<f64>) -> [f64; RINGS.len()] {
        match ring.zip(self.rings.first().zip(self.rings.last())) {
            Some((ring, (first, last))) => lagrange(&self.rings, ring.clamp(*first, *last)),
            None => std::array::from_fn(|k| f64::from(u8::from(k == 0))),
        }
    }

    fn at(&self, values: &Values, rings: [f64; RINGS.len()]) -> f64 {
        let of_values = [self.scale.relative(values), values[2], values[1]];
        let places: [(usize, f64); 3] = std::array::from_fn(|i| self.axes[i].place(of_values[i]));
        let [speeds, polars, _] = self.axes.map(|axis| axis.count);
        let (first, last) = (self.backspins[0], self.backspins[BACKSPINS.len() - 1]);
        let backspins: [f64; BACKSPINS.len()] =
            lagrange(&self.backspins, values[3].clamp(first, last));
        let parts: [f64; RINGS.len() * BACKSPINS.len()] =
            std::array::from_fn(|k| rings[k / BACKSPINS.len()] * backspins[k % BACKSPINS.len()]);
        let of_cell = self.rings.len().max(1) * BACKSPINS.len();
        let mut chance = 0.0;
        for corner in 0..8 {
            let is_above = |i: usize| corner >> i & 1;
            let weight: f64 = (0..3)
                .map(|i| [1.0 - places[i].1, places[i].1][is_above(i)])
                .product();
            let [speed, polar, pitch]: [usize; 3] =
                std::array::from_fn(|i| places[i].0 + is_above(i));
            let cell = (pitch * speeds + speed) * polars + polar;
            let each = self.chances[cell * of_cell..][..of_cell].iter();
            let of_corner = each.zip(&parts).map(|(chance, part)| part * chance);
            chance += weight * of_corner.sum::<f64>();
        }
        // A parabola may leave the range.
        chance.clamp(0.0, 1.0)
    }
}

/// Axes of relative speed, polar angle and pitch angle over the releases that shots may have been.
fn axes(
    (scale, nodes): (&SpeedScale, [usize; 2]),
    reach: &[Values],
    middle: &Values,
    sds: [f64; 2],
) -> [Axis; 3] {
    let range = |value: &dyn Fn(&Values) -> f64| {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        reach
            .iter()
            .map(value)
            .fold(ends, |(low, high), x| (f64::min(low, x), f64::max(high, x)))
    };
    let within = |(low, high): (f64, f64), sd: f64, centre: f64, most: f64| {
        let low = (low - MARGIN * sd).clamp(centre - most, centre + most);
        let high = (high + MARGIN * sd).clamp(centre - most, centre + most);
        (low, high)
    };
    let farthest = scale.for_depth(middle[1], FARTHEST_M);
    let sideways = FARTHEST_M / scale.distance_m;
    let relative = scale.relative(middle);
    let speeds = within(
        range(&|values| scale.relative(values)),
        sds[0],
        relative,
        farthest,
    );
    let polars = within(range(&|values| values[2]), sds[1], middle[2], sideways);
    let pitches = range(&|values| values[1]);
    [
        Axis::over(speeds, ROUND[0], nodes[0]),
        Axis::over(polars, ROUND[1], nodes[1]),
        Axis::over(pitches, ROUND[2], PITCHES),
    ]
}

/// Releases at the ends of what shots may have been.
fn reach(shots: &[KnownShot], scales: &UnknownScales) -> Vec<Values> {
    let errors: &[f64] = match scales.constant_error {
        Some(_) => &[-ERRORS, 0.0, ERRORS],
        None => &[0.0],
    };
    let mut reach = Vec::with_capacity(shots.len() * 3 * errors.len());
    for shot in shots {
        for i in 0..3 {
            reach.extend(errors.iter().map(|error| {
                shot.release(&Unseen {
                    ring: None,
                    more_backspin: 0.0,
                    constant_errors: Vector3::from_fn(|k, _| if k == i { *error } else { 0.0 })
                        .into(),
                })
            }));
        }
    }
    reach
}

/// Normal weights of neighbours at distances of 0, 1, ... nodes, for a standard deviation in nodes.
fn kernel(sd: f64) -> Vec<f64> {
    let count = (MARGIN * sd).min(1e3) as usize + 1;
    let weight = |k: usize| {
        let z = k as f64 / sd.max(1e-9);
        libm::exp(-0.5 * z * z)
    };
    (0..count).map(weight).collect()
}

/// Rows of numbers, smoothed across the rows and along them.
fn smoothed(numbers: &[f64], of_row: usize, [across, along]: &[Vec<f64>; 2]) -> Vec<f64> {
    let rows = numbers.len() / of_row;
    let smooth =
        |from: &[f64], kernel: &[f64], (count, stride): (usize, usize), others: &[usize]| {
            let mut out = vec![0.0; from.len()];
            for &first in others {
                for i in 0..count {
                    let (mut sum, mut total) = (0.0, 0.0);
                    let nearest = i.saturating_sub(kernel.len() - 1)..(i + kernel.len()).min(count);
                    for other in nearest {
                        let weight = kernel[other.abs_diff(i)];
                        sum += weight * from[first + other * stride];
                        total += weight;
                    }
                    out[first + i * stride] = sum / total;
                }
            }
            out
        };
    let columns: Vec<usize> = (0..of_row).collect();
    let starts: Vec<usize> = (0..rows).map(|row| row * of_row).collect();
    let once = smooth(numbers, across, (rows, of_row), &columns);
    smooth(&once, along, (of_row, 1), &starts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitting::expected_makes::{common_normals, factor_of};
    use crate::model::Preset;
    use crate::probability::Silent;
    use crate::shooter::Location;
    use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD};
    use nalgebra::{SMatrix, Vector4};

    /// Authority: releases of each shot, simulated under the ring itself. Chances of shots from
    /// short of the ring to the board agree within what the tables' cells leave open; the seed is
    /// fixed.
    #[test]
    fn val_chances_are_those_of_simulated_releases() {
        let place = Place {
            location: Location {
                distance_m: 13.75 * FOOT_M,
                angle_rad: 0.0,
            },
            release_height_m: 7.0 * FOOT_M,
        };
        let physics = Preset::named("ncaa").unwrap().physics();
        let sds = [
            0.25 * FOOT_M,
            1.5 * DEGREE_RAD,
            1.2 * DEGREE_RAD,
            0.3 * REV_RAD,
        ];
        let middle = [24.2 * FOOT_M, 51.0 * DEGREE_RAD, 0.0, 2.25 * REV_RAD];
        let typical = Draw::new(vec![middle], sds, SMatrix::identity(), [sds[0], 0.0, 0.0]);
        let profile = super::super::fitted_profile::fitted_profile("x", &physics, &typical, &place);
        let profiles = [profile.unwrap()];
        let noise = Vector4::new(0.06 * FOOT_M, 0.8 * DEGREE_RAD, 0.5 * DEGREE_RAD, 0.0);
        let shots: Vec<MeasuredRelease> = (0..25)
            .map(|k| {
                let (speed, side) = (f64::from(k / 5 - 2), f64::from(k % 5 - 2));
                let mut values = middle;
                values[0] += 0.22 * FOOT_M * speed;
                values[2] += 1.1 * DEGREE_RAD * side;
                MeasuredRelease {
                    row: 0,
                    place: 0,
                    values,
                    noise: Covariance::from_diagonal(&noise.component_mul(&noise)),
                    made: Some(true),
                    own: None,
                }
            })
            .collect();
        let scales = UnknownScales {
            ring: Some(StudentSpread {
                middle: 0.65,
                scale: 0.07,
            }),
            backspin_sd: 0.4 * REV_RAD,
            constant_error: None,
        };
        let place_of = [place];
        let makes = MakesLikelihood::new(
            (&profiles, &place_of),
            &shots,
            (&typical, 3),
            &scales,
            (1, &Silent),
        );
        let (mut square, mut bias) = (0.0, 0.0);
        let tries = [(0.65, 0.0), (0.5, 3.0), (0.78, -4.0)];
        for (ring, more_backspin) in tries {
            let unseen = Unseen {
                ring: Some(ring),
                more_backspin,
                constant_errors: Vector3::zeros().into(),
            };
            let simulator = under_ring(&profiles[0], Some(ring));
            let chances: Vec<f64> = makes.places[0].chances(&unseen).map(|(p, _)| p).collect();
            for (shot, chance) in shots.iter().zip(chances) {
                let (likeliest, covariance) = release_given(shot, &typical, 3).unwrap();
                let factor = factor_of(&covariance);
                let starts: Vec<_> = common_normals(2048, 7)
                    .into_iter()
                    .map(|z| {
                        let mut values = Vector4::from(likeliest) + factor * Vector4::from(z);
                        values[3] += more_backspin;
                        shot.release(&profiles[0], &values.into()).state()
                    })
                    .collect();
                let mut workspace = BatchWorkspace::default();
                let verdicts = simulator.finite_verdicts(&starts, &mut workspace);
                let made = verdicts.iter().filter(|verdict| verdict.made).count();
                let direct = made as f64 / starts.len() as f64;
                square += (chance - direct) * (chance - direct);
                bias += chance - direct;
            }
        }
        let count = (tries.len() * shots.len()) as f64;
        let (rms, bias) = ((square / count).sqrt(), bias / count);
        assert!(rms < 0.06 && bias.abs() < 0.01, "{rms} {bias}");
    }
}
