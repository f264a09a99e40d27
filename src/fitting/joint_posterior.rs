//! Flights and makes in one posterior, with what no sensor sees: the ring, the backspin, the
//! constant error of the tracker, and how far shooters aim from their best shot.
//!
//! The flights alone give draws of aim and scatter under a flat prior of the aims ([`super::fit`]).
//! The unknowns are sampled by importance ([`super::importance`]): a point of them has the weight
//! of its prior, of the makes ([`super::makes_likelihood`]), and of the aims that it leaves, which
//! the population holds to be near the best shot ([`super::best_aims`]). Then each point of the
//! sample takes a draw of the flights, by the density of its aims. `docs/fitting.md` has the
//! derivation.

use super::advice::usual_probabilities;
use super::best_aims::BestAims;
use super::constant_error::Correction;
use super::fitted_profile::fitted_profile;
use super::importance::{
    Stages, UnseenSample, WeightedPoints, effective_size, pareto_shape, sample,
    student_log_density, systematic,
};
use super::makes_likelihood::{MakesLikelihood, UnknownScales, Unseen};
use super::measured_release::{MeasuredRelease, Place, Values};
use super::posterior::{Draw, FitOptions, Posterior, SpinSource};
use super::prior::{AimPrior, PriorOf, PriorOfDraws, UnseenPrior};
use super::prior_sensitivity::{log_prior_of_scatter, log_student};
use crate::model::Physics;
use crate::probability::Progress;
use crate::shooter::{Profile, ProfileError};
use nalgebra::Vector3;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// Points of the unknowns. Their number does not depend on the data: one more stage would move P by
/// its numerical error.
const STAGES: Stages = Stages {
    points: 1024,
    count: 4,
    more: 0,
};
const POINTS: u64 = STAGES.points as u64 * STAGES.count as u64;
/// Draws of the flights that the aims of a point are averaged over.
const AVERAGED: usize = 250;
/// A draw of the sample takes one of every so many of the flights.
const TURNS: usize = 4;
/// Degrees of freedom of the aims about the best ones.
const FREEDOM_OF_AIMS: f64 = 4.0;

/// An unknown, by its place in a point.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Unknown {
    Ring,
    Backspin,
    ConstantError(usize),
}

/// A shooter's shots, and what the flights say.
#[derive(Clone)]
pub(super) struct FlightsOf<'a> {
    pub(super) name: &'a str,
    /// With the usual ring, where it is not known.
    pub(super) physics: Physics,
    pub(super) places: &'a [Place],
    pub(super) shots: &'a [MeasuredRelease],
    /// More draws than are wanted.
    pub(super) posterior: Posterior,
}

/// What a point stands for, and how it is weighed.
struct Model<'a> {
    unknowns: Vec<Unknown>,
    prior: &'a UnseenPrior,
    backspin_sd: f64,
    /// Of each place, how the tracker's constant error changes the typical release.
    corrections: Vec<Correction>,
    makes: MakesLikelihood,
    aims: Vec<Option<BestAims>>,
    spin: SpinSource,
    /// The direction of the hoop's centre from each place.
    towards_hoop: Vec<f64>,
    /// Values whose aim is near that of the best shot.
    aim_values: usize,
}

impl Model<'_> {
    fn unseen(&self, point: &[f64]) -> Unseen {
        let at = |unknown| {
            let index = self.unknowns.iter().position(|other| *other == unknown);
            index.map(|index| point[index])
        };
        let errors = Vector3::from_fn(|i, _| at(Unknown::ConstantError(i)).unwrap_or(0.0));
        let ring = self.prior.ring.zip(at(Unknown::Ring));
        Unseen {
            ring: ring.map(|(ring, t)| ring.middle + ring.scale * t),
            more_backspin: self.backspin_sd * at(Unknown::Backspin).unwrap_or(0.0),
            constant_errors: errors.into(),
        }
    }

    fn log_prior(&self, point: &[f64], unseen: &Unseen) -> f64 {
        let (low, high) = super::draw_probabilities::RING_RANGE;
        if unseen
            .ring
            .is_some_and(|ring| !(low..=high).contains(&ring))
        {
            return f64::NEG_INFINITY;
        }
        let of_others = |ring: f64| {
            self.prior.ring_of_others.map_or(0.0, |others| {
                let z = (ring - others.mean) / others.sd;
                -0.5 * z * z
            })
        };
        let each = self.unknowns.iter().zip(point);
        let each = each.map(|(unknown, &x)| match unknown {
            Unknown::Backspin => -0.5 * x * x,
            Unknown::Ring | Unknown::ConstantError(_) => student_log_density(x),
        });
        each.sum::<f64>() + unseen.ring.map_or(0.0, of_others)
    }

    /// The density of a draw's aims if the tracker errs so, but for a factor.
    fn aims(&self, prior: &AimPrior, draw: &Draw, changes: &[Vector3<f64>]) -> f64 {
        let scales = [prior.speed_m_s, prior.pitch_rad, prior.polar_rad];
        let (mut square, mut dimension) = (0.0, 0.0);
        for (place, best) in self.aims.iter().enumerate() {
            let Some(best) = best else { continue };
            let change = |i: usize| if i < 3 { changes[place][i] } else { 0.0 };
            let aim = std::array::from_fn(|i| draw.means[place][i] + change(i));
            let deviation = best.deviation(&aim);
            for i in 0..self.aim_values {
                square += (deviation[i] / scales[i]) * (deviation[i] / scales[i]);
                dimension += 1.0;
            }
        }
        let exponent = -0.5 * (FREEDOM_OF_AIMS + dimension);
        libm::exp(exponent * libm::log1p(square / FREEDOM_OF_AIMS))
    }

    /// How the constant error changes the typical release of each place.
    fn changes(&self, unseen: &Unseen) -> Vec<Vector3<f64>> {
        let corrections = self.corrections.iter();
        corrections
            .map(|correction| correction.change(&unseen.constant_errors))
            .collect()
    }

    /// A draw of the flights with what no sensor sees.
    fn moved(&self, draw: &Draw, typical: &Draw, unseen: &Unseen) -> Draw {
        let errors = &unseen.constant_errors;
        let has_backspin = self.unknowns.contains(&Unknown::Backspin);
        let places = draw.means.iter().zip(&typical.means).zip(&self.corrections);
        let means: Vec<Values> = places
            .map(|((mean, typical), correction)| {
                let from_typical = Vector3::from_fn(|i, _| mean[i] - typical[i]);
                let change = correction.change(errors) + correction.turn(errors) * from_typical;
                let backspin = match has_backspin {
                    true => (typical[3] + unseen.more_backspin).max(0.0),
                    false => mean[3],
                };
                let value = |i: usize| typical[i] + change[i];
                [value(0), value(1), value(2), backspin]
            })
            .collect();
        let read_high = |(measured, mean): (&Values, &Values)| {
            std::array::from_fn(|i| if i < 3 { measured[i] - mean[i] } else { 0.0 })
        };
        let constant_errors = draw.means.iter().zip(&means).map(read_high).collect();
        // One scatter for all places: they turn nearly alike.
        draw.turned(&self.corrections[0].turn(errors), means)
            .with_ring(unseen.ring)
            .with_constant_errors(constant_errors)
    }

    fn mean_of_aims(&self, draws: &[Draw], unseen: &Unseen) -> f64 {
        let Some(prior) = &self.prior.aim else {
            return 1.0;
        };
        let changes = self.changes(unseen);
        let step = draws.len().div_ceil(AVERAGED);
        let some = draws.iter().step_by(step);
        let count = some.len() as f64;
        some.map(|draw| self.aims(prior, draw, &changes))
            .sum::<f64>()
            / count
    }
}

impl Model<'_> {
    /// Draws of the unknowns and of the flights together. Both are put in the order of the makes
    /// that they promise, and pairs are taken evenly over both (a lattice), so that P has next to
    /// no noise from the choice.
    fn joint_draws(
        &self,
        sampled: &WeightedPoints,
        flights: &FlightsOf<'_>,
        profiles: &[Profile],
        (options, progress): (&FitOptions, &dyn Progress),
    ) -> (Vec<Draw>, Vec<PriorOfDraws>) {
        let typical = flights.posterior.typical();
        let promised = promised_makes(&flights.posterior, profiles, progress);
        let draws = in_order(&flights.posterior.draws, &promised);
        let unseen: Vec<Unseen> = sampled
            .points
            .iter()
            .map(|point| self.unseen(point))
            .collect();
        progress.begin("counting makes", POINTS);
        let expected: Vec<f64> = unseen
            .par_iter()
            .map(|unseen| {
                progress.advance(1);
                self.makes.expected(unseen)
            })
            .collect();
        progress.end();
        let points: Vec<(&Unseen, f64)> =
            unseen.iter().zip(sampled.weights.iter().copied()).collect();
        let points = in_order(&points, &expected);
        let weights: Vec<f64> = points.iter().map(|(_, weight)| *weight).collect();
        let mut random = ChaCha12Rng::seed_from_u64(options.seed);
        random.set_stream(u64::MAX - 2);
        let (first, second): (f64, f64) = (random.random(), random.random());
        let count = options.draws;
        let chosen = systematic(&weights, count, first);
        let stride = stride_over(count);
        let draw = |number: usize| {
            let position = number * stride % count;
            let unseen = points[chosen[position]].0;
            let along = (second + GOLDEN_RATIO * position as f64).fract();
            // Some of the flights in turn: all together choose no better.
            let some = || draws.iter().skip(number % TURNS).step_by(TURNS);
            let weights: Vec<f64> = match &self.prior.aim {
                Some(prior) => {
                    let changes = self.changes(unseen);
                    some()
                        .map(|draw| self.aims(prior, draw, &changes))
                        .collect()
                }
                None => vec![1.0; some().count()],
            };
            let place = systematic(&weights, 1, along)[0];
            let draw = draws[number % TURNS + TURNS * place];
            let priors = self.log_priors(draw, unseen, options);
            (self.moved(draw, &typical, unseen).rounded(), priors)
        };
        let (draws, priors): (Vec<Draw>, Vec<_>) = (0..count).into_par_iter().map(draw).unzip();
        let of_kind = |kind: usize| PriorOfDraws {
            of: priors[0][kind].0,
            log_densities: priors.iter().map(|of_draw| of_draw[kind].1).collect(),
        };
        let priors = (0..priors[0].len()).map(of_kind).collect();
        (draws, priors)
    }

    /// The logarithms of the priors of a draw of the flights with what no sensor sees.
    fn log_priors(
        &self,
        draw: &Draw,
        unseen: &Unseen,
        options: &FitOptions,
    ) -> Vec<(PriorOf, f64)> {
        let scatter = log_prior_of_scatter(draw, &options.prior);
        let mut priors = vec![(PriorOf::Scatter, scatter)];
        if self.spin == SpinSource::AssumedWithDirection {
            let prior = &options.prior.aim;
            let of_place = |(mean, hoop): (&Values, &f64)| {
                let z = (mean[2] - hoop - prior.mean) / prior.sd;
                -0.5 * z * z
            };
            // One direction for all places.
            let first = draw.means.iter().zip(&self.towards_hoop).next();
            priors.push((PriorOf::Direction, first.map_or(0.0, of_place)));
        }
        if let Some(prior) = &self.prior.aim {
            let density = self.aims(prior, draw, &self.changes(unseen));
            priors.push((PriorOf::Aim, libm::log(density.max(f64::MIN_POSITIVE))));
        }
        if let Some((prior, ring)) = self.prior.ring.zip(unseen.ring) {
            let t = (ring - prior.middle) / prior.scale;
            priors.push((PriorOf::Ring, log_student(&[t])));
        }
        if self.unknowns.contains(&Unknown::Backspin) {
            let z = unseen.more_backspin / self.backspin_sd;
            priors.push((PriorOf::Backspin, -0.5 * z * z));
        }
        if self.unknowns.contains(&Unknown::ConstantError(0)) {
            let errors = log_student(unseen.constant_errors.scales.as_slice());
            priors.push((PriorOf::ConstantError, errors));
        }
        priors
    }
}

/// The fractional part of the golden ratio: its multiples are spread evenly.
const GOLDEN_RATIO: f64 = 0.618_033_988_749_894_9;
/// Shots of a sample that draws of flights are put in order by.
const ORDER_SHOTS: usize = 4096;

/// P of draws of the flights, over all places.
fn promised_makes(flights: &Posterior, profiles: &[Profile], progress: &dyn Progress) -> Vec<f64> {
    progress.begin("chances of places", profiles.len() as u64);
    let mut sums = vec![0.0; flights.draws.len()];
    for (place, profile) in profiles.iter().enumerate() {
        let of_draws = usual_probabilities(profile, flights, place, ORDER_SHOTS).of_draws;
        sums.iter_mut().zip(of_draws).for_each(|(sum, p)| *sum += p);
        progress.advance(1);
    }
    progress.end();
    sums
}

/// The values in ascending order of their keys.
fn in_order<'a, T>(values: &'a [T], keys: &[f64]) -> Vec<&'a T> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| keys[*a].total_cmp(&keys[*b]));
    order.into_iter().map(|index| &values[index]).collect()
}

/// A step that visits each of so many positions once, neighbours far apart.
fn stride_over(count: usize) -> usize {
    let has_no_factor = |stride: &usize| {
        let (mut a, mut b) = (*stride, count);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a == 1
    };
    let first = (GOLDEN_RATIO * count as f64) as usize;
    (first.max(1)..).find(has_no_factor).unwrap_or(1)
}

/// The posterior of flights and makes together.
///
/// # Errors
/// The fitted values make no profile.
pub(super) fn with_unseen(
    flights: &FlightsOf<'_>,
    prior: &UnseenPrior,
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Posterior, ProfileError> {
    let typical = flights.posterior.typical();
    let profiles = flights
        .places
        .iter()
        .map(|place| fitted_profile(flights.name, &flights.physics, &typical, place))
        .collect::<Result<Vec<Profile>, ProfileError>>()?;
    let model = model(flights, &profiles, (&typical, prior), (options, progress));
    let draws = &flights.posterior.draws;
    progress.begin("weighing makes", POINTS);
    let log_density = |point: &[f64]| {
        progress.advance(1);
        let unseen = model.unseen(point);
        let log_prior = model.log_prior(point, &unseen);
        if log_prior == f64::NEG_INFINITY {
            return log_prior;
        }
        let aims = model.mean_of_aims(draws, &unseen).max(f64::MIN_POSITIVE);
        log_prior + model.makes.logarithm(&unseen) + libm::log(aims)
    };
    let sampled = match model.unknowns.len() {
        1 => sample::<1>((STAGES, options.seed), log_density),
        2 => sample::<2>((STAGES, options.seed), log_density),
        3 => sample::<3>((STAGES, options.seed), log_density),
        4 => sample::<4>((STAGES, options.seed), log_density),
        5 => sample::<5>((STAGES, options.seed), log_density),
        _ => WeightedPoints {
            points: vec![Vec::new()],
            weights: vec![1.0],
        },
    };
    progress.end();
    let (joint, priors) = model.joint_draws(&sampled, flights, &profiles, (options, progress));
    Ok(Posterior {
        unseen: Some(UnseenSample {
            effective_sample_size: effective_size(&sampled.weights),
            pareto_k: pareto_shape(&sampled.weights),
        }),
        draws: joint,
        priors,
        ..flights.posterior.clone()
    })
}

fn model<'a>(
    flights: &'a FlightsOf<'_>,
    profiles: &'a [Profile],
    (typical, prior): (&Draw, &'a UnseenPrior),
    (options, progress): (&FitOptions, &dyn Progress),
) -> Model<'a> {
    let mut unknowns = Vec::new();
    if prior.ring.is_some() {
        unknowns.push(Unknown::Ring);
    }
    let spin = flights.posterior.spin;
    if !matches!(spin, SpinSource::Measured | SpinSource::Given) {
        unknowns.push(Unknown::Backspin);
    }
    let of_place = |index: usize| {
        let (simulator, place) = (profiles[index].simulator(), &flights.places[index]);
        Correction::new(
            simulator,
            place,
            &typical.means[index],
            prior.constant_error,
        )
    };
    if prior.constant_error.is_some() {
        unknowns.extend((0..3).map(Unknown::ConstantError));
    }
    let measured = spin.measured_values();
    let near = |place| {
        let aims = BestAims::near(&profiles[place], typical, place);
        progress.advance(1);
        aims
    };
    let is_unknown = unknowns.contains(&Unknown::Backspin);
    let backspin_sd = options.prior.backspin.sd;
    let scales = UnknownScales {
        ring: prior.ring,
        backspin_sd: if is_unknown { backspin_sd } else { 0.0 },
        constant_error: prior.constant_error,
    };
    progress.begin("finding shots", profiles.len() as u64);
    let aims = match prior.aim {
        Some(_) => (0..profiles.len()).map(near).collect(),
        None => Vec::new(),
    };
    progress.end();
    Model {
        unknowns,
        prior,
        backspin_sd,
        corrections: (0..profiles.len()).map(of_place).collect(),
        makes: MakesLikelihood::new(
            (profiles, flights.places),
            flights.shots,
            (typical, measured),
            &scales,
            (options.seed, progress),
        ),
        aims,
        spin,
        towards_hoop: flights
            .places
            .iter()
            .map(|place| place.location.angle_rad)
            .collect(),
        aim_values: measured.min(3),
    }
}
