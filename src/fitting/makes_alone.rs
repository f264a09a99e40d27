//! A shooter of whom only makes and misses were counted.
//!
//! The counts of each place are binomial, with P by simulated shots. Scatter, ring, backspin and
//! aims have the priors of the population, and the counts choose among them: the scatters, the ring
//! and the backspin by importance ([`super::importance`]), the aims of each place by a few tries
//! for each point, over which the likelihood is averaged. `docs/fitting.md` has the model.

use super::best_aims::BestAims;
use super::draw_probabilities::{RING_RANGE, under_ring};
use super::fitted_profile::fitted_profile;
use super::importance::{
    Stages, UnseenSample, WeightedPoints, effective_size, pareto_shape, sample, student_log_density,
};
use super::landing::{CENTRE_DEPTH_M, Landing, release_of_landing};
use super::measured_release::{MeasuredRelease, Place, Values, by_place, nominal_of};
use super::posterior::{Draw, FitError, FitOptions, Posterior, SpinSource};
use super::prior::{AimPrior, PriorOf, PriorOfDraws, UnseenPrior};
use crate::dynamics::BatchWorkspace;
use crate::math::normal_distribution::quantile;
use crate::math::sobol::{ScrambleKey, Sobol};
use crate::model::Physics;
use crate::probability::Progress;
use crate::shooter::{Profile, ProfileError};
use crate::units::{DEGREE_RAD, INCH_M};
use nalgebra::{SMatrix, Vector4};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use std::cell::RefCell;

/// Aims that are tried at each place for each point.
const AIMS: usize = 4;
/// Shots of a point, over all places and aims; and of one aim at least.
const SHOTS: usize = 2048;
const LEAST_SHOTS: usize = 64;
/// Standard deviation of the logarithm of a scatter, where no flight shows it: half of that of
/// measured shooters' prior, which is so wide that flights decide.
const LOG_SD: f64 = 0.4;
/// Standard deviation of Fisher's z of the correlation of speed and angle.
const Z_OF_CORRELATION: f64 = 0.3;

/// What was counted at a place, and where its shots start.
struct CountedPlace {
    profile: Profile,
    best: BestAims,
    made: u32,
    shots: u32,
}

/// Everything that points are weighed with.
struct Counts<'a> {
    places: Vec<CountedPlace>,
    options: &'a FitOptions,
    unseen: &'a UnseenPrior,
    /// Standard normals of the shots of each aim.
    normals: Vec<Vec<Values>>,
}

/// A shooter that a point stands for, with the aims that were tried and what the counts say of
/// each.
struct Tried {
    sds: Values,
    correlation: SMatrix<f64, 4, 4>,
    coefficients: [f64; 3],
    ring: Option<f64>,
    /// Of each place the aims, and the logarithm of the likelihood of each.
    aims: Vec<Vec<(Values, f64)>>,
}

thread_local! {
    static WORKSPACE: RefCell<BatchWorkspace> = RefCell::default();
}

const STAGES: Stages = Stages {
    points: 256,
    count: 3,
    more: 8,
};
/// Scatters, ring and backspin in a point.
const UNKNOWNS: usize = 5;

fn normal(random: &mut ChaCha12Rng) -> f64 {
    quantile(random.random::<f64>().max(f64::MIN_POSITIVE))
}

/// Why a shooter was not fitted.
pub(super) enum CountsError {
    Fit(FitError),
    Profile(ProfileError),
}

/// The posterior of a shooter whose shots say no more than their place and whether they went in.
pub(super) fn posterior_of_makes(
    name: &str,
    (places, shots): (&[Place], &[MeasuredRelease]),
    physics: &Physics,
    (options, unseen): (&FitOptions, &UnseenPrior),
    progress: &dyn Progress,
) -> Result<Posterior, CountsError> {
    let of_places = by_place(shots, places.len());
    let of_place = |(index, place): (usize, &Place)| {
        progress.advance(1);
        let counted = of_places[index].iter().filter_map(|shot| shot.made);
        let (made, all) = counted.fold((0, 0), |(made, all), is_made| {
            (made + u32::from(is_made), all + 1)
        });
        let typical =
            typical_at(physics, place, options).ok_or(FitError::NoShot { place: index + 1 });
        let typical = typical.map_err(CountsError::Fit)?;
        let profile =
            fitted_profile(name, physics, &typical, place).map_err(CountsError::Profile)?;
        let best = BestAims::near(&profile, &typical, 0);
        let best = best.ok_or(CountsError::Fit(FitError::NoShot { place: index + 1 }))?;
        Ok(CountedPlace {
            profile,
            best,
            made,
            shots: all,
        })
    };
    let counted = places.iter().enumerate().map(of_place);
    progress.begin("finding shots", places.len() as u64);
    let counted: Result<Vec<CountedPlace>, CountsError> = counted.collect();
    progress.end();
    let counted = counted?;
    let of_aim = (SHOTS / AIMS / counted.len())
        .max(LEAST_SHOTS)
        .next_power_of_two() as u32;
    let sobol = Sobol::new();
    let normals = (0..(AIMS * counted.len()) as u64).map(|replicate| {
        let scramble = sobol.scrambled(ScrambleKey {
            seed: options.seed,
            replicate,
        });
        let point = |index| std::array::from_fn(|k| quantile(scramble.point(index, k)));
        (0..of_aim).map(point).collect()
    });
    let counts = Counts {
        normals: normals.collect(),
        places: counted,
        options,
        unseen,
    };
    let most = STAGES.points as usize * (STAGES.count + STAGES.more);
    progress.begin("weighing makes", most as u64);
    let WeightedPoints { points, weights } = sample::<UNKNOWNS>((STAGES, options.seed), |point| {
        progress.advance(1);
        counts.log_density(point)
    });
    progress.end();
    let mut random = ChaCha12Rng::seed_from_u64(options.seed);
    random.set_stream(u64::MAX - 3);
    let first: f64 = random.random();
    let chosen = super::importance::systematic(&weights, options.draws, first);
    let draws = chosen.iter().map(|&index| {
        let tried = counts.tried(&points[index]);
        tried.draw(&mut random).rounded()
    });
    let effective = effective_size(&weights);
    Ok(Posterior {
        draws: draws.collect(),
        spin: SpinSource::NothingMeasured,
        r_hat: 1.0,
        bulk_effective_sample_size: effective,
        tail_effective_sample_size: effective,
        priors: counts.priors(chosen.iter().map(|&index| &points[index])),
        prior_weights: [1.0; 4],
        growth_terms: usize::from(places.len() > 1),
        shots: shots.len(),
        unseen: Some(UnseenSample {
            effective_sample_size: effective,
            pareto_k: pareto_shape(&weights),
        }),
    })
}

/// A usual shooter, with a shot that falls into the middle of the hoop.
fn typical_at(physics: &Physics, place: &Place, options: &FitOptions) -> Option<Draw> {
    let simulator = crate::dynamics::Simulator::new(physics).ok()?;
    let backspin = options.prior.backspin.mean;
    let release = [45.0, 50.0, 40.0, 55.0].into_iter().find_map(|entry_deg| {
        let landing = Landing {
            depth_m: CENTRE_DEPTH_M + INCH_M,
            right_m: 0.0,
            entry_angle_rad: entry_deg * DEGREE_RAD,
        };
        let found = release_of_landing(&simulator, place, &landing, &[0.0; 3], backspin);
        found.ok().map(|(values, _)| values)
    })?;
    let sds = options.prior.median_sd;
    Some(Draw::new(
        vec![release],
        sds,
        SMatrix::identity(),
        [sds[0], 0.0, 0.0],
    ))
}

impl Counts<'_> {
    fn ring(&self, point: &[f64]) -> Option<f64> {
        self.unseen
            .ring
            .map(|ring| ring.middle + ring.scale * point[3])
    }

    fn log_density(&self, point: &[f64]) -> f64 {
        let ring = self.ring(point);
        if ring.is_some_and(|ring| !(RING_RANGE.0..=RING_RANGE.1).contains(&ring)) {
            return f64::NEG_INFINITY;
        }
        let of_others = self
            .unseen
            .ring_of_others
            .zip(ring)
            .map_or(0.0, |(others, ring)| {
                let z = (ring - others.mean) / others.sd;
                -0.5 * z * z
            });
        let normal = |i: usize| -0.5 * point[i] * point[i];
        let prior = normal(0) + normal(1) + normal(2) + normal(4) + student_log_density(point[3]);
        let tried = self.tried(point);
        let of_places = tried.aims.iter().map(|aims| {
            let greatest = aims
                .iter()
                .map(|(_, log)| *log)
                .fold(f64::NEG_INFINITY, f64::max);
            let sum: f64 = aims.iter().map(|(_, log)| libm::exp(log - greatest)).sum();
            greatest + libm::log(sum)
        });
        prior + of_others + of_places.sum::<f64>()
    }

    /// The priors at points. The aims are drawn from theirs.
    fn priors<'a>(&self, points: impl Iterator<Item = &'a Vec<f64>> + Clone) -> Vec<PriorOfDraws> {
        let normal = |x: f64| -0.5 * x * x;
        let each = |of: PriorOf, log_density: &dyn Fn(&[f64]) -> f64| PriorOfDraws {
            of,
            log_densities: points.clone().map(|point| log_density(point)).collect(),
        };
        let scatter = |point: &[f64]| point[..3].iter().map(|x| normal(*x)).sum();
        let mut priors = vec![each(PriorOf::Scatter, &scatter)];
        if self.unseen.ring.is_some() {
            priors.push(each(PriorOf::Ring, &|point| student_log_density(point[3])));
        }
        if self.options.spin != SpinSource::Given {
            priors.push(each(PriorOf::Backspin, &|point| normal(point[4])));
        }
        priors
    }

    /// The shooter of a point; the same for the same point.
    fn tried(&self, point: &[f64]) -> Tried {
        let bits = point.iter().fold(self.options.seed, |bits, x| {
            (bits ^ x.to_bits())
                .wrapping_mul(0x9e37_79b9_7f4a_7c15)
                .rotate_left(31)
        });
        let mut random = ChaCha12Rng::seed_from_u64(bits);
        let prior = &self.options.prior;
        let unseen_sd = prior.log_sd[3] * normal(&mut random);
        let sds: Values = std::array::from_fn(|i| {
            let log = if i < 3 { LOG_SD * point[i] } else { unseen_sd };
            prior.median_sd[i] * libm::exp(log)
        });
        let z = prior.speed_pitch.mean + Z_OF_CORRELATION * normal(&mut random);
        let r = libm::tanh(z);
        let mut correlation = SMatrix::<f64, 4, 4>::identity();
        (correlation[(0, 1)], correlation[(1, 0)]) = (r, r);
        let backspin = match self.options.spin {
            SpinSource::Given => prior.backspin.mean,
            _ => (prior.backspin.mean + prior.backspin.sd * point[4]).max(0.0),
        };
        // The aims of a shooter have a common scale: that of a t distribution.
        let squares: f64 = (0..4).map(|_| normal(&mut random)).map(|z| z * z).sum();
        let scale = (4.0 / squares).sqrt();
        let aim = self.unseen.aim.unwrap_or(AimPrior::POPULATION);
        let reference = self
            .places
            .iter()
            .map(|place| place.best.at_angle(0.0)[0])
            .sum::<f64>()
            / self.places.len() as f64;
        let growth = match self.places.len() {
            1 => 0.0,
            _ => prior.growth.mean + prior.growth.sd * normal(&mut random),
        };
        // sd (1 + g (v/v0 - 1)).
        let coefficients = [sds[0] * (1.0 - growth), sds[0] * growth / reference, 0.0];
        let mut tried = Tried {
            sds,
            correlation,
            coefficients,
            ring: self.ring(point),
            aims: Vec::with_capacity(self.places.len()),
        };
        for (index, place) in self.places.iter().enumerate() {
            let aims = (0..AIMS).map(|_| {
                let mut aimed = place
                    .best
                    .at_angle(scale * aim.pitch_rad * normal(&mut random));
                aimed[0] += scale * aim.speed_m_s * normal(&mut random);
                aimed[2] += scale * aim.polar_rad * normal(&mut random);
                aimed[3] = backspin;
                aimed
            });
            let aims: Vec<Values> = aims.collect();
            let judged = self.judged(index, place, &tried, aims);
            tried.aims.push(judged);
        }
        tried
    }

    /// The aims of a place with the logarithm of the likelihood of its counts.
    fn judged(
        &self,
        index: usize,
        place: &CountedPlace,
        tried: &Tried,
        aims: Vec<Values>,
    ) -> Vec<(Values, f64)> {
        let profile = &place.profile;
        let simulator = under_ring(profile, tried.ring);
        let mut starts = Vec::new();
        for (number, aim) in aims.iter().enumerate() {
            let draw = Draw::new(vec![*aim], tried.sds, tried.correlation, tried.coefficients);
            let factor = draw.factor_at(0);
            for z in &self.normals[index * AIMS + number] {
                let values: Values = (Vector4::from(*aim) + factor * Vector4::from(*z)).into();
                starts.push(profile.release(&nominal_of(&values)).state());
            }
        }
        let each = starts.len() / aims.len();
        WORKSPACE.with_borrow_mut(|workspace| {
            let verdicts = simulator.finite_verdicts(&starts, workspace);
            let judge = |(aim, verdicts): (Values, &[crate::dynamics::Verdict])| {
                let made = verdicts.iter().filter(|verdict| verdict.made).count() as f64;
                let p = (made + 0.5) / (each as f64 + 1.0);
                let (hit, missed) = (f64::from(place.made), f64::from(place.shots - place.made));
                (aim, hit * libm::log(p) + missed * libm::log(1.0 - p))
            };
            aims.into_iter()
                .zip(verdicts.chunks(each))
                .map(judge)
                .collect()
        })
    }
}

impl Tried {
    /// The shooter, with one of the aims of each place by its likelihood.
    fn draw(&self, random: &mut ChaCha12Rng) -> Draw {
        let chosen = self.aims.iter().map(|aims| {
            let greatest = aims
                .iter()
                .map(|(_, log)| *log)
                .fold(f64::NEG_INFINITY, f64::max);
            let weights: Vec<f64> = aims
                .iter()
                .map(|(_, log)| libm::exp(log - greatest))
                .collect();
            aims[super::importance::systematic(&weights, 1, random.random())[0]].0
        });
        let means = chosen.collect();
        Draw::new(means, self.sds, self.correlation, self.coefficients).with_ring(self.ring)
    }
}
