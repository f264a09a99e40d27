//! Draws of a shooter's aim and dispersion.

use super::chain_diagnostics::{Convergence, ParameterChains};
use super::dispersion_posterior::{Dispersion, DispersionPosterior, ReleaseModel};
use super::importance::UnseenSample;
use super::interval::Interval;
use super::measured_release::{MeasuredRelease, VALUE_NAMES, Values, by_place};
use super::prior::{PopulationPrior, PriorOfDraws, Spread};
use super::student_posterior::StudentPosterior;
use crate::math::normal_distribution::quantile;
use crate::probability::{Progress, Silent};
use crate::shooter::{Correlation, ReleaseDispersion, ReleaseVariable};
use hammer_and_sample::{MinChainLen, Move, Params, Schedule, Serial, Stretch, sample};
use nalgebra::{Matrix3, SMatrix};
use rand::rngs::ChaCha12Rng;
use rand::{Rng, RngExt, SeedableRng};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// Ensembles, which are sampled one apart from the other.
const CHAINS: usize = 4;
/// Least walkers of an ensemble.
const LEAST_WALKERS: usize = 16;
/// Steps that are forgotten, and steps that are kept at first.
const BURN_IN: usize = 300;
const FIRST_STEPS: usize = 500;
/// How often the kept steps are doubled before the sampler gives up.
const DOUBLINGS: u32 = 5;
/// Convergence is judged by every fourth step: neighbours hardly differ.
const THINNING: usize = 4;
/// What a converged sample has.
const LARGEST_R_HAT: f64 = 1.02;
const LEAST_EFFECTIVE_SIZE: f64 = 1000.0;

/// The speed's standard deviation at a place is at least this share of that at the reference speed.
const LEAST_SD_SHARE: f64 = 0.05;

/// Where the backspin comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpinSource {
    /// Measured with each shot.
    Measured,
    /// Its mean was given; its scatter is that of the population.
    Given,
    /// Mean and scatter are those of the population.
    Assumed,
    /// So are those of the direction: a camera from the side sees neither.
    AssumedWithDirection,
    /// No value was measured: makes alone.
    NothingMeasured,
}

impl SpinSource {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Measured => "measured",
            Self::Given => "given",
            Self::Assumed | Self::AssumedWithDirection | Self::NothingMeasured => "assumed",
        }
    }

    /// How many of the values were measured: speed, pitch, polar angle, backspin, in this order.
    #[must_use]
    pub fn measured_values(self) -> usize {
        match self {
            Self::Measured => 4,
            Self::Given | Self::Assumed => 3,
            Self::AssumedWithDirection => 2,
            Self::NothingMeasured => 0,
        }
    }

    /// That of a word.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let all = [Self::Measured, Self::Given, Self::Assumed];
        all.into_iter().find(|source| source.name() == name)
    }
}

/// The distribution of the releases about the aim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tails {
    /// Normal.
    Normal,
    /// Student's t, its degrees of freedom (3 or more) fitted.
    Student,
}

/// What a fit is told.
#[derive(Clone, Copy, Debug)]
pub struct FitOptions {
    /// What is known of shooters.
    pub prior: PopulationPrior,
    /// Whether each release has a measured backspin.
    pub spin: SpinSource,
    /// The distribution of the releases.
    pub tails: Tails,
    /// The number of draws that are kept.
    pub draws: usize,
    /// Seed of the random numbers. The same seed gives the same bits for any number of threads.
    pub seed: u64,
}

impl Default for FitOptions {
    fn default() -> Self {
        Self {
            prior: PopulationPrior::MEASURED,
            spin: SpinSource::Assumed,
            tails: Tails::Normal,
            draws: 1000,
            seed: 1,
        }
    }
}

/// One draw from the posterior.
#[derive(Clone, Debug, PartialEq)]
pub struct Draw {
    /// The aim at each place.
    pub means: Vec<Values>,
    /// The standard deviations at the reference speed.
    pub sds: Values,
    /// The correlations of the values.
    pub correlation: SMatrix<f64, 4, 4>,
    /// `c10`, `c11`, `c12` of Eq. 28 (SI units).
    pub speed_coefficients: [f64; 3],
    /// One over the degrees of freedom of the releases' t distribution; 0 where they are normal.
    pub tail_weight: f64,
    /// The restitution of the ring; `None` for that of the physics.
    pub ring_restitution: Option<f64>,
    /// By how much the tracker reads the values of every shot too high, at each place: the aims are
    /// the measured ones less this.
    pub constant_errors: Vec<Values>,
    /// The Cholesky factor of the covariance of the releases at each place.
    pub(super) factors: Vec<SMatrix<f64, 4, 4>>,
}

impl Draw {
    /// A draw of these aims, standard deviations, correlations, and `c10`, `c11`, `c12` (SI units).
    #[must_use]
    pub fn new(
        means: Vec<Values>,
        sds: Values,
        correlation: SMatrix<f64, 4, 4>,
        speed_coefficients: [f64; 3],
    ) -> Self {
        let lower = correlation
            .cholesky()
            .map_or_else(SMatrix::identity, |cholesky| cholesky.l());
        let [c10, c11, c12] = speed_coefficients;
        let factors = means
            .iter()
            .map(|mean| {
                let mut at_place = sds;
                at_place[0] = (c10 + mean[0] * (c11 + mean[0] * c12)).max(LEAST_SD_SHARE * sds[0]);
                SMatrix::from_diagonal(&at_place.into()) * lower
            })
            .collect();
        Self {
            constant_errors: vec![Values::default(); means.len()],
            means,
            sds,
            correlation,
            speed_coefficients,
            tail_weight: 0.0,
            ring_restitution: None,
            factors,
        }
    }

    /// A draw with heavier tails: `tail_weight` is one over the degrees of freedom, below 1/2.
    /// The standard deviations stay those of the releases.
    #[must_use]
    pub fn with_tail_weight(self, tail_weight: f64) -> Self {
        Self {
            tail_weight,
            ..self
        }
    }

    /// The draw with this restitution of the ring.
    #[must_use]
    pub fn with_ring(self, ring_restitution: Option<f64>) -> Self {
        Self {
            ring_restitution,
            ..self
        }
    }

    /// The draw where a tracker that reads all values too high by these measured it.
    #[must_use]
    pub(crate) fn with_constant_errors(self, constant_errors: Vec<Values>) -> Self {
        Self {
            constant_errors,
            ..self
        }
    }

    /// The draw about other aims, where deviations of speed, pitch and polar angle turn by a
    /// matrix.
    #[must_use]
    pub(super) fn turned(&self, by: &Matrix3<f64>, means: Vec<Values>) -> Self {
        let mut turn = SMatrix::<f64, 4, 4>::identity();
        turn.fixed_view_mut::<3, 3>(0, 0).copy_from(by);
        let scaled = SMatrix::from_diagonal(&self.sds.into());
        let covariance = turn * scaled * self.correlation * scaled * turn.transpose();
        let sds: Values = std::array::from_fn(|i| covariance[(i, i)].max(0.0).sqrt());
        let correlation = SMatrix::from_fn(|i, j| match i == j {
            true => 1.0,
            false => covariance[(i, j)] / (sds[i] * sds[j]).max(f64::MIN_POSITIVE),
        });
        let ratio = if self.sds[0] > 0.0 {
            sds[0] / self.sds[0]
        } else {
            1.0
        };
        let coefficients = self.speed_coefficients.map(|c| c * ratio);
        Self::new(means, sds, correlation, coefficients).with_tail_weight(self.tail_weight)
    }

    /// The aim at a place as the tracker reads it.
    #[must_use]
    pub fn measured_mean(&self, place: usize) -> Values {
        let (mean, error) = (&self.means[place], &self.constant_errors[place]);
        std::array::from_fn(|i| mean[i] + error[i])
    }

    /// A draw with values of single precision, far below what shots resolve. A value that was
    /// written in any unit and read again is rounded to the same bits.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let round = |value: f64| f64::from(value as f32);
        let means = self.means.iter().map(|mean| mean.map(round)).collect();
        Self::new(
            means,
            self.sds.map(round),
            self.correlation.map(round),
            self.speed_coefficients.map(round),
        )
        .with_tail_weight(round(self.tail_weight))
        .with_ring(self.ring_restitution.map(round))
        .with_constant_errors(self.constant_errors.iter().map(|e| e.map(round)).collect())
    }

    /// A draw with the scatter about one other aim.
    #[must_use]
    pub fn aimed_at(&self, mean: Values) -> Self {
        Self::new(
            vec![mean],
            self.sds,
            self.correlation,
            self.speed_coefficients,
        )
        .with_tail_weight(self.tail_weight)
        .with_ring(self.ring_restitution)
    }

    /// The standard deviations at a place.
    #[must_use]
    pub fn sds_at(&self, place: usize) -> Values {
        let factor = &self.factors[place];
        std::array::from_fn(|i| factor.row(i).norm())
    }

    /// The Cholesky factor of the covariance of the releases at a place.
    #[must_use]
    pub fn factor_at(&self, place: usize) -> SMatrix<f64, 4, 4> {
        self.factors[place]
    }

    /// The dispersion of this draw.
    #[must_use]
    pub fn dispersion(&self) -> ReleaseDispersion {
        let [c10_m_s, c11, c12_s_m] = self.speed_coefficients;
        ReleaseDispersion {
            c10_m_s,
            c11,
            c12_s_m,
            c20_rad: self.sds[1],
            c30_rad: self.sds[2],
            c40_rad_s: self.sds[3],
            correlation: correlation_of(&self.correlation),
            ..ReleaseDispersion::NONE
        }
    }
}

/// The correlations of a profile.
pub(super) fn correlation_of(matrix: &SMatrix<f64, 4, 4>) -> Correlation {
    const VARIABLES: [ReleaseVariable; 4] = [
        ReleaseVariable::Speed,
        ReleaseVariable::Pitch,
        ReleaseVariable::Polar,
        ReleaseVariable::Backspin,
    ];
    let mut pairs = Vec::new();
    for i in 0..4 {
        for j in 0..i {
            if matrix[(i, j)] != 0.0 {
                pairs.push((VARIABLES[j], VARIABLES[i], matrix[(i, j)]));
            }
        }
    }
    Correlation::new(&pairs).unwrap_or(Correlation::NONE)
}

/// A sample of the posterior distribution.
#[derive(Clone, Debug)]
pub struct Posterior {
    /// The draws.
    pub draws: Vec<Draw>,
    /// Where the backspin comes from.
    pub spin: SpinSource,
    /// The greatest R-hat of the parameters.
    pub r_hat: f64,
    /// The least effective sample size of the parameters' middles.
    pub bulk_effective_sample_size: f64,
    /// The least of their tails.
    pub tail_effective_sample_size: f64,
    /// The share of the information on each standard deviation that comes from the population.
    pub prior_weights: Values,
    /// Terms of the growth of the speed's scatter that the places tell apart: 0, 1 (c11) or 2 (c11,
    /// c12).
    pub growth_terms: usize,
    /// The number of shots.
    pub shots: usize,
    /// How evenly what no sensor sees was sampled; `None` of flights alone.
    pub unseen: Option<UnseenSample>,
    /// The priors at the draws; none of flights alone, and of a fit that was read from its file.
    pub priors: Vec<PriorOfDraws>,
}

impl Posterior {
    /// A summary of a function of the draws.
    pub fn summary(&self, value: impl Fn(&Draw) -> f64) -> Interval {
        Interval::of(self.draws.iter().map(value).collect())
    }

    /// The draw in the middle: means, and root mean squares of the standard deviations, so that its
    /// releases have the covariance of all draws' releases.
    #[must_use]
    pub fn typical(&self) -> Draw {
        let count = self.draws.len() as f64;
        let mean = |value: &dyn Fn(&Draw) -> f64| self.draws.iter().map(value).sum::<f64>() / count;
        let places = self.draws[0].means.len();
        let root_mean = |value: &dyn Fn(&Draw) -> f64| mean(&|d| value(d) * value(d)).sqrt();
        let sds: Values = std::array::from_fn(|i| root_mean(&|d| d.sds[i]));
        let correlation = SMatrix::from_fn(|i, j| mean(&|d| d.correlation[(i, j)]));
        let scale = {
            let typical = mean(&|d| d.sds[0]);
            if typical > 0.0 { sds[0] / typical } else { 1.0 }
        };
        Draw {
            means: (0..places)
                .map(|p| std::array::from_fn(|i| mean(&|d| d.means[p][i])))
                .collect(),
            sds,
            correlation,
            speed_coefficients: std::array::from_fn(|k| mean(&|d| d.speed_coefficients[k]) * scale),
            tail_weight: mean(&|d| d.tail_weight),
            ring_restitution: self.draws[0]
                .ring_restitution
                .map(|_| mean(&|d| d.ring_restitution.unwrap_or_default())),
            constant_errors: (0..places)
                .map(|p| std::array::from_fn(|i| mean(&|d| d.constant_errors[p][i])))
                .collect(),
            factors: (0..places)
                .map(|p| {
                    let covariance: SMatrix<f64, 4, 4> = self
                        .draws
                        .iter()
                        .map(|d| d.factors[p] * d.factors[p].transpose() / count)
                        .sum();
                    covariance.cholesky().map_or_else(SMatrix::zeros, |c| c.l())
                })
                .collect(),
        }
    }
}

/// Why there is no posterior.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FitError {
    /// The chains disagree.
    #[error(
        "the posterior did not converge: R-hat {r_hat:.3} (at most {LARGEST_R_HAT} is wanted), effective sample size {effective:.0} (at least {LEAST_EFFECTIVE_SIZE}); look at the shots for outliers or mixed shooters, or give another --seed"
    )]
    NotConverged {
        /// The greatest R-hat.
        r_hat: f64,
        /// The least effective sample size.
        effective: f64,
    },
    /// The covariance of the measurements is not positive definite.
    #[error("the shots have no scatter that could be fitted: they are identical or lie on a line")]
    NoScatter,
    /// No shot of an average player goes in from a place.
    #[error(
        "no shot of an average player goes in from place {place}; check its distance and the release height"
    )]
    NoShot {
        /// The number of the place.
        place: usize,
    },
}

/// Steps along the difference of two walkers (ter Braak, Stat. Comput. 16 (2006) 239), and every
/// fourth time a stretch.
struct DifferenceOrStretch {
    scale: f64,
    stretch: Stretch,
}

impl Move<Vec<f64>> for DifferenceOrStretch {
    fn propose<'a, O, R>(&self, this: &'a Vec<f64>, mut other: O, random: &mut R) -> (Vec<f64>, f64)
    where
        O: FnMut(&mut R) -> &'a Vec<f64>,
        R: Rng,
    {
        let uniform: f64 = random.random();
        if uniform < 0.25 {
            return self.stretch.propose(this, other, random);
        }
        let (first, second) = (other(random), other(random));
        let jitter: f64 = random.random();
        let factor = self.scale * (0.5 + jitter);
        let moved = this
            .values()
            .zip(first.values().zip(second.values()))
            .map(|(x, (a, b))| x + factor * (a - b))
            .collect();
        (moved, 0.0)
    }
}

/// The length of a chain, whose steps count as progress.
struct Watched<'a> {
    length: MinChainLen,
    steps: usize,
    progress: &'a dyn Progress,
}

impl Watched<'_> {
    /// Progress is reported after so many steps.
    const STEPS: usize = 50;
}

impl Schedule<Vec<f64>> for Watched<'_> {
    fn next_step(&mut self, chain: &[Vec<f64>]) -> ControlFlow<()> {
        self.steps += 1;
        if self.steps.is_multiple_of(Self::STEPS) {
            self.progress.advance(Self::STEPS as u64);
        }
        self.length.next_step(chain)
    }

    fn iterations(&self, walkers: usize) -> Option<usize> {
        Schedule::<Vec<f64>>::iterations(&self.length, walkers)
    }
}

/// Fits a shooter's releases. `places` is the number of places, each with at least one shot.
///
/// # Errors
/// The chains did not converge, or there is no scatter.
pub fn fit(
    shots: &[MeasuredRelease],
    places: usize,
    options: &FitOptions,
) -> Result<Posterior, FitError> {
    fit_watched((shots, places), options, &Silent)
}

/// [`fit`], with its progress.
pub(super) fn fit_watched(
    (shots, places): (&[MeasuredRelease], usize),
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Posterior, FitError> {
    let releases = (shots, places);
    match options.spin {
        SpinSource::Measured => fit_values::<4>(releases, options, progress),
        SpinSource::Given | SpinSource::Assumed => fit_values::<3>(releases, options, progress),
        SpinSource::AssumedWithDirection => fit_values::<2>(releases, options, progress),
        SpinSource::NothingMeasured => Err(FitError::NoScatter),
    }
}

fn fit_values<const D: usize>(
    (shots, places): (&[MeasuredRelease], usize),
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Posterior, FitError> {
    let prior = options.prior;
    match options.tails {
        Tails::Normal => sample_posterior(
            &DispersionPosterior::<D>::new(shots, places, prior),
            shots,
            options,
            progress,
        ),
        Tails::Student => sample_posterior(
            &StudentPosterior::<D>::new(shots, places, prior),
            shots,
            options,
            progress,
        ),
    }
}

/// A standard normal number.
pub(super) fn standard_normal(random: &mut impl Rng) -> f64 {
    loop {
        let uniform: f64 = random.random();
        if uniform > 0.0 {
            return quantile(uniform);
        }
    }
}

/// Chains that have converged.
pub(super) struct Sampled {
    chains: Vec<Vec<Vec<f64>>>,
    walkers: usize,
    convergence: Convergence,
}

impl Sampled {
    /// All points, walk by walk, so that evenly spaced ones come from every walker.
    pub(super) fn points(&self) -> Vec<&Vec<f64>> {
        walks(&self.chains, self.walkers).collect()
    }

    fn convergence_of(chains: &[Vec<Vec<f64>>], walkers: usize) -> Convergence {
        let of_parameter = |parameter: usize| {
            let walks: Vec<Vec<f64>> = chains
                .iter()
                .flat_map(|chain| (0..walkers).map(move |w| chain.iter().skip(w)))
                .map(|walk| {
                    walk.step_by(THINNING * walkers)
                        .map(|point| point[parameter])
                })
                .map(Iterator::collect)
                .collect();
            ParameterChains {
                steps: walks[0].len(),
                values: walks.concat(),
                chains: CHAINS,
            }
            .convergence()
        };
        let of_each: Vec<Convergence> = (0..chains[0][0].len())
            .into_par_iter()
            .map(of_parameter)
            .collect();
        of_each
            .into_iter()
            .fold(Convergence::PERFECT, Convergence::worse)
    }
}

/// The points of chains, walk by walk.
fn walks(chains: &[Vec<Vec<f64>>], walkers: usize) -> impl Iterator<Item = &Vec<f64>> {
    chains.iter().flat_map(move |chain| {
        (0..walkers).flat_map(move |w| chain.iter().skip(w).step_by(walkers))
    })
}

/// Samples the density of a model until its effective sample sizes are great enough.
pub(super) fn sampled<const D: usize, M: ReleaseModel<D>>(
    model: &M,
    shots: &[MeasuredRelease],
    (seed, least_effective_size): (u64, f64),
    progress: &dyn Progress,
) -> Result<Sampled, FitError> {
    let priors = model.priors();
    let dimension = priors.len();
    let walkers = LEAST_WALKERS.max(2 * dimension).next_multiple_of(2);
    let starts = starting_point(model.normal(), shots, &priors);
    let mut steps = FIRST_STEPS;
    for _ in 0..=DOUBLINGS {
        let burn_in = BURN_IN.max(steps / 4);
        progress.begin("fitting releases", (CHAINS * (burn_in + steps)) as u64);
        let chains: Vec<Vec<Vec<f64>>> = (0..CHAINS)
            .into_par_iter()
            .map(|chain| {
                let walker = |number: usize| {
                    let mut random = ChaCha12Rng::seed_from_u64(seed);
                    random.set_stream((chain * walkers + number) as u64);
                    let start = starts
                        .iter()
                        .map(|start| start.mean + start.sd * standard_normal(&mut random))
                        .collect::<Vec<f64>>();
                    (start, random)
                };
                let proposal = DifferenceOrStretch {
                    scale: 2.38 / (2.0 * dimension as f64).sqrt(),
                    stretch: Stretch::default(),
                };
                let length = MinChainLen((burn_in + steps) * walkers);
                let length = Watched {
                    length,
                    steps: 0,
                    progress,
                };
                let all = (0..walkers).map(walker);
                let (mut chain, _) = sample(model, &proposal, all, length, Serial);
                chain.drain(..burn_in * walkers);
                chain
            })
            .collect();
        progress.end();
        let convergence = Sampled::convergence_of(&chains, walkers);
        let Convergence {
            r_hat,
            bulk_size,
            tail_size,
        } = convergence;
        if !r_hat.is_finite() {
            return Err(FitError::NoScatter);
        }
        let effective = bulk_size.min(tail_size);
        if r_hat <= LARGEST_R_HAT && effective >= least_effective_size {
            return Ok(Sampled {
                chains,
                walkers,
                convergence,
            });
        }
        if steps >= FIRST_STEPS << DOUBLINGS {
            return Err(FitError::NotConverged { r_hat, effective });
        }
        steps *= 2;
    }
    unreachable!("the last pass returns")
}

fn sample_posterior<const D: usize, M: ReleaseModel<D>>(
    model: &M,
    shots: &[MeasuredRelease],
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Posterior, FitError> {
    let effort = (options.seed, LEAST_EFFECTIVE_SIZE);
    let sampled = sampled(model, shots, effort, progress)?;
    let points = sampled.points();
    Ok(Posterior {
        draws: draws_of(model, &points, shots, options)?,
        spin: options.spin,
        r_hat: sampled.convergence.r_hat,
        bulk_effective_sample_size: sampled.convergence.bulk_size,
        tail_effective_sample_size: sampled.convergence.tail_size,
        prior_weights: prior_weights::<D>(&points, &model.priors()),
        growth_terms: model.normal().growth_terms,
        shots: shots.len(),
        unseen: None,
        priors: Vec::new(),
    })
}

/// About the standard deviations of the shots, and the prior for the rest.
fn starting_point<const D: usize>(
    model: &DispersionPosterior<D>,
    shots: &[MeasuredRelease],
    priors: &[Spread],
) -> Vec<Spread> {
    let of_places = by_place(shots, model.places());
    let mut starts = priors.to_vec();
    for (i, start) in starts.iter_mut().enumerate().take(D) {
        let (mut squares, mut freedom, mut noise) = (0.0, 0.0, 0.0);
        for values in &of_places {
            let count = values.len() as f64;
            let mean = values.iter().map(|shot| shot.values[i]).sum::<f64>() / count;
            for shot in values {
                squares += (shot.values[i] - mean) * (shot.values[i] - mean);
                noise += shot.noise[(i, i)] / shots.len() as f64;
            }
            freedom += count - 1.0;
        }
        let least = 0.05 * libm::exp(priors[i].mean);
        let variance = (squares / freedom.max(1.0) - noise).max(least * least);
        // As far from the prior as the data, but where its density does not vanish.
        let logarithm = 0.5 * libm::log(variance);
        let (low, high) = (
            priors[i].mean - 8.0 * priors[i].sd,
            priors[i].mean + 8.0 * priors[i].sd,
        );
        *start = Spread {
            mean: logarithm.clamp(low, high),
            sd: 0.1,
        };
    }
    for start in &mut starts[D..] {
        // A mean with a flat prior is in units of its standard error.
        start.sd = if start.sd.is_finite() {
            0.3 * start.sd
        } else {
            1.0
        };
    }
    starts
}

/// Of each standard deviation, the variance of its logarithm over that of the prior.
fn prior_weights<const D: usize>(points: &[&Vec<f64>], priors: &[Spread]) -> Values {
    let count = points.len() as f64;
    std::array::from_fn(|i| {
        if i >= D {
            return 1.0;
        }
        let mean = points.iter().map(|point| point[i]).sum::<f64>() / count;
        let squares: f64 = points.iter().map(|p| (p[i] - mean) * (p[i] - mean)).sum();
        (squares / count / (priors[i].sd * priors[i].sd)).min(1.0)
    })
}

fn draws_of<const D: usize>(
    model: &impl ReleaseModel<D>,
    points: &[&Vec<f64>],
    shots: &[MeasuredRelease],
    options: &FitOptions,
) -> Result<Vec<Draw>, FitError> {
    // Of a direction that was not measured: towards the hoop's centre.
    let directions: Vec<f64> = by_place(shots, model.normal().places())
        .iter()
        .map(|of_place| of_place.first().map_or(0.0, |shot| shot.values[2]))
        .collect();
    let direction = |place: usize| directions[place];
    let mut random = ChaCha12Rng::seed_from_u64(options.seed);
    random.set_stream(u64::MAX);
    (0..options.draws)
        .map(|k| {
            let point = points[k * points.len() / options.draws];
            let dispersion = model.normal().dispersion(point);
            let means = model
                .means(point, &mut || standard_normal(&mut random))
                .ok_or(FitError::NoScatter)?;
            let unseen = [standard_normal(&mut random), standard_normal(&mut random)];
            let mut draw = draw_of(model.normal(), &dispersion, &means, unseen, options);
            if options.spin == SpinSource::AssumedWithDirection {
                let unseen = [standard_normal(&mut random), standard_normal(&mut random)];
                draw = with_direction(&draw, unseen, &direction, &options.prior);
            }
            Ok(draw.with_tail_weight(model.tail_weight(point)).rounded())
        })
        .collect()
}

/// A draw; `unseen` are standard normals for the mean and the scatter of a backspin that was not
/// measured.
fn draw_of<const D: usize>(
    model: &DispersionPosterior<D>,
    dispersion: &Dispersion<D>,
    means: &[nalgebra::SVector<f64, D>],
    unseen: [f64; 2],
    options: &FitOptions,
) -> Draw {
    let prior = &options.prior;
    let unseen_mean = match options.spin {
        SpinSource::Given => prior.backspin.mean,
        _ => (prior.backspin.mean + prior.backspin.sd * unseen[0]).max(0.0),
    };
    let unseen_sd = prior.median_sd[3] * libm::exp(prior.log_sd[3] * unseen[1]);
    let sds: Values = std::array::from_fn(|i| if i < D { dispersion.sds[i] } else { unseen_sd });
    let mut correlation = SMatrix::<f64, 4, 4>::identity();
    let coefficients = dispersion.correlation_factor * dispersion.correlation_factor.transpose();
    for i in 0..D {
        for j in 0..i {
            correlation[(i, j)] = coefficients[(i, j)];
            correlation[(j, i)] = coefficients[(i, j)];
        }
    }
    // sd (1 + g (v/v0 - 1) + h (v/v0 - 1)^2) as a polynomial in v.
    let (sd, v0) = (sds[0], model.reference_speed);
    let [g, h] = dispersion.growth;
    let of_place = |mean: &nalgebra::SVector<f64, D>| {
        std::array::from_fn(|i| if i < D { mean[i] } else { unseen_mean })
    };
    Draw::new(
        means.iter().map(of_place).collect(),
        sds,
        correlation,
        [
            sd * (1.0 - g + h),
            sd * (g - 2.0 * h) / v0,
            sd * h / (v0 * v0),
        ],
    )
}

/// A draw with a direction of the population; `unseen` are standard normals for its mean and its
/// scatter, `towards_hoop` is the direction of the hoop's centre from a place.
fn with_direction(
    draw: &Draw,
    unseen: [f64; 2],
    towards_hoop: &dyn Fn(usize) -> f64,
    prior: &PopulationPrior,
) -> Draw {
    let mut means = draw.means.clone();
    for (place, mean) in means.iter_mut().enumerate() {
        mean[2] = towards_hoop(place) + prior.aim.mean + prior.aim.sd * unseen[0];
    }
    let mut sds = draw.sds;
    sds[2] = prior.median_sd[2] * libm::exp(prior.log_sd[2] * unseen[1]);
    Draw::new(means, sds, draw.correlation, draw.speed_coefficients)
}

/// The names of two values that are correlated, as in `speed_pitch`.
#[must_use]
pub fn pair_name(i: usize, j: usize) -> String {
    format!("{}_{}", VALUE_NAMES[i], VALUE_NAMES[j])
}
