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
/// Least effective size of the weighted sample, as a part of its shots (Owen, section 9.3). Below
/// it a handful of shots decides P, and the standard error misleads as well.
const LEAST_EFFECTIVE_PART: f64 = 1.0 / 64.0;

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

    /// P of a nominal shot; `None` where it is too far away: too few shots of the sample count for
    /// it, or it differs in a variable without an error.
    pub(crate) fn probability(&self, nominal: &Nominal) -> Option<WeighedProbability> {
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
        let points: usize = self.blocks.iter().map(|block| block.made.len()).sum();
        let is_near = all * all >= LEAST_EFFECTIVE_PART * points as f64 * squares;
        if !(is_near && all > 0.0) {
            return None;
        }
        let p = made / all;
        // The sum of the squares of w (made - p).
        let spread = (1.0 - 2.0 * p) * made_squares + p * p * squares;
        Some(WeighedProbability {
            probability: p,
            standard_error: spread.max(0.0).sqrt() / all,
        })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::sobol::ScrambleKey;
    use crate::probability::{Sampler, Silent};
    use crate::shooter::{Location, NominalVariable, ProfileSettings, ReleaseDispersion, Shooter};

    /// A free throw with this error of the speed, and a shot of it.
    fn free_throw(c10_m_s: f64) -> (Profile, Nominal) {
        let settings = ProfileSettings::new(Shooter {
            name: "test".to_owned(),
            release_height_m: 2.1,
            max_backspin_rad_s: 20.0,
            max_side_spin_rad_s: 0.0,
            dispersion: ReleaseDispersion {
                c10_m_s,
                c20_rad: 0.02,
                c30_rad: 0.01,
                c40_rad_s: 2.0,
                ..ReleaseDispersion::NONE
            },
        });
        let profile = settings.at(Location {
            distance_m: 4.19,
            angle_rad: 0.0,
        });
        let nominal = Nominal {
            speed_m_s: 6.9,
            pitch_rad: 0.9,
            backspin_rad_s: 10.0,
            ..Nominal::default()
        };
        (profile.unwrap(), nominal)
    }

    /// P of 17 shots beside one by its sample is that of fresh shots, within the errors of both: 6
    /// standard errors, as those of weights have tails. How many of them are near enough.
    fn agreeing_shots(c10_m_s: f64) -> usize {
        let (profile, nominal) = free_throw(c10_m_s);
        let sampler = Sampler::new(&profile);
        let scramble = sampler.scramble(ScrambleKey {
            seed: 1,
            replicate: 0,
        });
        let near = Neighbourhood::simulate(&profile, &nominal, (&scramble, 16_384), 1.4);
        let mut near_enough = 0;
        for step in -8..=8 {
            // The speed goes with the pitch angle, as along a ridge of P.
            let by = 0.005 * f64::from(step);
            let shot = nominal
                .with(NominalVariable::Pitch, nominal.pitch_rad + by)
                .with(NominalVariable::Speed, nominal.speed_m_s - 0.7 * by);
            let Some(weighed) = near.probability(&shot) else {
                continue;
            };
            near_enough += 1;
            let counted = sampler.estimate(&shot, 0.001, 2, &Silent);
            let error = libm::hypot(weighed.standard_error, counted.standard_error);
            let difference = (weighed.probability - counted.probability).abs();
            assert!(
                difference < 6.0 * error,
                "step {step}: {weighed:?} {counted:?}"
            );
        }
        near_enough
    }

    #[test]
    fn a_sample_has_p_of_shots_nearby_and_of_no_others() {
        assert_eq!(agreeing_shots(0.08), 17);
        let of_steady_speed = agreeing_shots(0.003);
        assert!(
            (3..17).contains(&of_steady_speed),
            "{of_steady_speed} of 17"
        );
    }
}
