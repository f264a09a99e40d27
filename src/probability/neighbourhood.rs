//! P of all nominal shots near one, from one sample of simulated shots.
//!
//! The shots are drawn once about the one in the middle, with errors somewhat greater than the
//! shooter's. For a nominal shot beside it, each counts with the ratio of the densities
//! (self-normalised importance sampling; Owen, *Monte Carlo theory, methods and examples*, 2013,
//! chapter 9). All of them share the shots, so their differences hardly have a numerical error.

use crate::dynamics::BatchWorkspace;
use crate::math::exponential::exponential;
use crate::math::real::{Real, SimdReal};
use crate::math::simd::F64x8;
use crate::math::sobol::Scramble;
use crate::model::BallState;
use crate::shooter::{Nominal, NormalsMap, Profile, ReleaseDistribution, ReleaseVariable};
use fearless_simd::{Level, Simd};
use rayon::prelude::*;

const N: usize = ReleaseVariable::COUNT;
/// Shots that are simulated, or weighed, together.
const BLOCK: usize = 4096;
/// Shots that are weighed at a time.
const LANES: usize = 8;

/// The simulated shots.
pub(crate) struct Neighbourhood<'a> {
    profile: &'a Profile,
    distribution: ReleaseDistribution,
    blocks: Vec<Block>,
}

/// Some of them.
struct Block {
    /// The independent standard normals of each variable.
    normals: [Vec<f64>; N],
    /// 1 for a made shot, else 0.
    made: Vec<f64>,
}

/// P of a nominal shot.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WeighedProbability {
    pub(crate) probability: f64,
    /// As if the points were random; those of a Sobol sequence err less.
    pub(crate) standard_error: f64,
}

impl<'a> Neighbourhood<'a> {
    /// Simulates so many points of a scramble, or a few more, about a nominal shot, with errors so
    /// many times as great.
    pub(crate) fn simulate(
        profile: &'a Profile,
        nominal: &Nominal,
        (scramble, points): (&Scramble, u32),
        widening: f64,
    ) -> Self {
        let distribution = ReleaseDistribution::new(profile, nominal).widened(widening);
        let points = points.next_multiple_of(LANES as u32);
        let blocks = (0..points as usize).step_by(BLOCK).collect::<Vec<_>>();
        let simulate = |workspace: &mut BatchWorkspace, from: usize| {
            let to = (from + BLOCK).min(points as usize);
            let mut normals: [Vec<f64>; N] = std::array::from_fn(|_| Vec::with_capacity(to - from));
            let mut starts: Vec<BallState> = Vec::with_capacity(to - from);
            distribution.for_each_state_and_normals(
                scramble,
                (from as u32, to as u32),
                |state, point| {
                    starts.push(state);
                    for (values, value) in normals.iter_mut().zip(point) {
                        values.push(*value);
                    }
                },
            );
            let verdicts = profile.simulator().finite_verdicts(&starts, workspace);
            let made = verdicts.iter().map(|verdict| verdict.made);
            Block {
                made: made.map(|made| f64::from(u8::from(made))).collect(),
                normals,
            }
        };
        Self {
            blocks: blocks
                .into_par_iter()
                .map_init(BatchWorkspace::default, simulate)
                .collect(),
            distribution,
            profile,
        }
    }

    /// P of a nominal shot. Not a number where a variable without an error differs.
    pub(crate) fn probability(&self, nominal: &Nominal) -> WeighedProbability {
        let other = ReleaseDistribution::new(self.profile, nominal);
        let density = Density::new(&other.normals_from(&self.distribution));
        let level = Level::new();
        let of_block =
            |block: &Block| fearless_simd::dispatch!(level, simd => block.weighed(simd, &density));
        let sums: Vec<[f64; 4]> = self.blocks.par_iter().map(of_block).collect();
        let mut total = [0.0; 4];
        for of_block in sums {
            for (sum, part) in total.iter_mut().zip(of_block) {
                *sum += part;
            }
        }
        let [made, all, made_squares, squares] = total;
        let p = made / all;
        // The sum of the squares of w (made - p).
        let spread = (1.0 - 2.0 * p) * made_squares + p * p * squares;
        WeighedProbability {
            probability: p,
            standard_error: spread.max(0.0).sqrt() / all,
        }
    }
}

/// The density of a distribution over normals of another.
struct Density {
    /// Of each variable that is another one there: its number, its offset, and the slopes for some
    /// normals.
    rows: Vec<(usize, f64, Vec<(usize, f64)>)>,
}

impl Density {
    fn new(map: &NormalsMap) -> Self {
        let row = |i: usize| {
            let slopes = map.rows[i].iter().copied().enumerate();
            let slopes: Vec<(usize, f64)> = slopes.filter(|(_, slope)| *slope != 0.0).collect();
            let is_same = map.offsets[i] == 0.0 && slopes == [(i, 1.0)];
            (!is_same).then_some((i, map.offsets[i], slopes))
        };
        Self {
            rows: (0..N).filter_map(row).collect(),
        }
    }
}

impl Block {
    /// The sums of the weights of made shots and of all, and of their squares.
    #[inline(always)]
    fn weighed<S: Simd>(&self, simd: S, density: &Density) -> [f64; 4] {
        simd.vectorize(
            #[inline(always)]
            || {
                let mut sums = [F64x8::broadcast(simd, 0.0); 4];
                for first in (0..self.made.len()).step_by(LANES) {
                    let at = |values: &[f64]| F64x8::load(simd, &values[first..]);
                    // The logarithm of the weight but for a constant: half of |z|^2 - |A z + b|^2.
                    let mut twice = F64x8::broadcast(simd, 0.0);
                    for (i, offset, slopes) in &density.rows {
                        let mut own = F64x8::broadcast(simd, *offset);
                        for (j, slope) in slopes {
                            own += at(&self.normals[*j]) * *slope;
                        }
                        twice += at(&self.normals[*i]).squared() - own.squared();
                    }
                    let weight = exponential(twice * 0.5);
                    let counted = weight * at(&self.made);
                    sums[0] += counted;
                    sums[1] += weight;
                    sums[2] += weight * counted;
                    sums[3] += weight * weight;
                }
                sums.map(|lanes| {
                    let mut each = [0.0; LANES];
                    lanes.store(&mut each);
                    each.iter().sum::<f64>()
                })
            },
        )
    }
}
