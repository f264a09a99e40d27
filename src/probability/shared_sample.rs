//! The same random numbers for many nominal shots and shooters: their differences are then known
//! much better than each P.
//!
//! The normal errors are drawn once. They are turned into releases of every distribution, and all
//! of these releases are simulated in common batches. Where two distributions overlap well, the
//! shots of one also tell about the other: each counts with the ratio of the two densities
//! (importance sampling; Owen, *Monte Carlo theory, methods and examples*, 2013, chapter 9).

use super::progress::Progress;
use super::sobol_integration::{REPLICATES, Sampler};
use crate::dynamics::{BatchWorkspace, Simulator};
use crate::math::sobol::ScrambleKey;
use crate::model::BallState;
use crate::shooter::{Nominal, Profile, ReleaseDistribution, ReleaseVariable};
use rayon::prelude::*;

/// Points of each scramble.
const POINTS: u32 = 256;
/// Scrambles whose shots are simulated together: enough shots for the lanes, and few enough for the
/// threads.
const SCRAMBLES_PER_BATCH: usize = 32;
/// Least effective number of shots, as a share of all, for which densities may be exchanged.
const MIN_EFFECTIVE_SHARE: f64 = 0.5;

/// Independent standard normals of every point, one scramble after the other.
pub(crate) struct SharedSample {
    normals: Vec<[f64; ReleaseVariable::COUNT]>,
}

/// Which releases of one distribution are made.
pub(crate) struct MadeReleases {
    distribution: ReleaseDistribution,
    made: Vec<bool>,
}

impl SharedSample {
    /// The points of all scrambles with a profile's seed.
    pub(crate) fn new(profile: &Profile) -> Self {
        let sampler = Sampler::new(profile);
        let points = |replicate| {
            let scramble = sampler.scramble(ScrambleKey {
                seed: profile.search().seed,
                replicate,
            });
            (0..POINTS)
                .map(|index| ReleaseDistribution::normals(|k| scramble.point(index, k)))
                .collect::<Vec<_>>()
        };
        Self {
            normals: (0..REPLICATES)
                .into_par_iter()
                .flat_map_iter(points)
                .collect(),
        }
    }

    /// Simulates the releases of some nominal shots, each of a shooter; the physics are those of
    /// `simulator`.
    pub(crate) fn simulate(
        &self,
        simulator: &Simulator,
        shots: &[(&Profile, Nominal)],
        progress: &dyn Progress,
    ) -> Vec<MadeReleases> {
        let batch = SCRAMBLES_PER_BATCH * POINTS as usize;
        let mut made_releases: Vec<MadeReleases> = shots
            .iter()
            .map(|(profile, nominal)| MadeReleases {
                distribution: ReleaseDistribution::new(profile, nominal),
                made: vec![false; self.normals.len()],
            })
            .collect();
        progress.begin("comparing", shots.len() as u64);
        made_releases.par_iter_mut().for_each(|releases| {
            let distribution = &releases.distribution;
            releases
                .made
                .par_chunks_mut(batch)
                .zip(self.normals.par_chunks(batch))
                .for_each_init(BatchWorkspace::default, |workspace, (made, normals)| {
                    let starts: Vec<BallState> = normals
                        .iter()
                        .map(|normals| distribution.state(*normals))
                        .collect();
                    let verdicts = simulator.finite_verdicts(&starts, workspace);
                    for (made, verdict) in made.iter_mut().zip(verdicts) {
                        *made = verdict.made;
                    }
                });
            progress.advance(1);
        });
        progress.end();
        made_releases
    }

    /// The share of made releases under each scramble.
    pub(crate) fn shares(&self, releases: &MadeReleases) -> Vec<f64> {
        releases
            .made
            .chunks(POINTS as usize)
            .map(|made| made.iter().filter(|&&made| made).count() as f64 / f64::from(POINTS))
            .collect()
    }

    /// The share that would be made under each scramble with another distribution; `None` if the
    /// two overlap too little.
    pub(crate) fn shares_of_other(
        &self,
        releases: &MadeReleases,
        other: &ReleaseDistribution,
    ) -> Option<Vec<f64>> {
        let weights: Vec<f64> = self
            .normals
            .par_iter()
            .map(|normals| other.relative_density(&releases.distribution, normals))
            .collect();
        let sum: f64 = weights.iter().sum();
        let squares: f64 = weights.iter().map(|w| w * w).sum();
        // Also false if a weight is not a number.
        let overlaps = sum * sum / squares > MIN_EFFECTIVE_SHARE * weights.len() as f64;
        if !overlaps {
            return None;
        }
        // The weights have the mean 1. So the mean share can be taken out of what they multiply.
        let made = |made: bool| f64::from(u8::from(made));
        let total: f64 = releases.made.iter().map(|&m| made(m)).sum();
        let mean = total / releases.made.len() as f64;
        let points = POINTS as usize;
        let scrambles = releases.made.chunks(points).zip(weights.chunks(points));
        Some(
            scrambles
                .map(|(flags, weights)| {
                    let terms = flags
                        .iter()
                        .zip(weights)
                        .map(|(&m, w)| w * (made(m) - mean));
                    mean + terms.sum::<f64>() / f64::from(POINTS)
                })
                .collect(),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::parse_profile;
    use crate::probability::Silent;

    /// The standard error of a mean of the values of independent scrambles.
    fn mean_and_error(values: &[f64]) -> (f64, f64) {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
        (mean, (squares / (n * (n - 1.0))).sqrt())
    }

    #[test]
    fn val_weighted_shots_give_the_p_of_another_distribution() {
        // Six comparisons with a separate simulation, at 5 standard errors: false alarm 4e-6. The
        // errors are correlated.
        let text = include_str!("../../configs/errors_in_all_nine_variables.toml");
        let profile = parse_profile(text, "").unwrap();
        let shot = Nominal {
            speed_m_s: 23.6 * crate::units::FOOT_M,
            pitch_rad: 53.5 * crate::units::DEGREE_RAD,
            polar_rad: 0.0,
            backspin_rad_s: 12.0,
            rifle_spin_rad_s: 0.0,
            side_spin_rad_s: 0.0,
        };
        let sample = SharedSample::new(&profile);
        let simulator = profile.simulator();
        let base = &sample.simulate(simulator, &[(&profile, shot)], &Silent)[0];
        let steadier = |variable| {
            let changed = profile.with(|settings| {
                let dispersion = &mut settings.shooter.dispersion;
                *dispersion = dispersion.scaled(variable, 0.9);
            });
            (changed.unwrap(), shot)
        };
        let faster = |by: f64| {
            let mut shot = shot;
            shot.speed_m_s += by;
            (profile.with(|_| ()).unwrap(), shot)
        };
        let others = [
            steadier(ReleaseVariable::Speed),
            steadier(ReleaseVariable::Pitch),
            steadier(ReleaseVariable::Polar),
            steadier(ReleaseVariable::Height),
            faster(0.01),
            faster(-0.03),
        ];
        for (other, shot) in &others {
            let distribution = ReleaseDistribution::new(other, shot);
            let weighted = sample.shares_of_other(base, &distribution).unwrap();
            let simulated = &sample.simulate(simulator, &[(other, *shot)], &Silent)[0];
            let (a, error_a) = mean_and_error(&weighted);
            let (b, error_b) = mean_and_error(&sample.shares(simulated));
            assert!(
                (a - b).abs() < 5.0 * (error_a + error_b),
                "{a} {error_a} {b} {error_b}"
            );
        }
        // Far away nothing is known.
        let (other, shot) = faster(3.0);
        let far = ReleaseDistribution::new(&other, &shot);
        assert!(sample.shares_of_other(base, &far).is_none());
    }
}
