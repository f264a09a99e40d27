//! What measured shots say of a shooter: what `fit` prints for programs, and `fit.json`.

use super::json::{Answer, Named, Provenance};
use super::probability::OverDraws;
use crate::fitting::{
    AimPrior, ConstantErrorPrior, FitNote, PopulationPrior, PredictiveCheck, PriorSensitivity,
    ReleaseDifference, ReliabilityBin, SessionTrend, ShapeScore, ShooterFit, Spread, StudentSpread,
    TrackerNoise, UnseenPrior, UnseenSample, VALUE_NAMES, Wilson,
};
use crate::measured_shots::source::Source;
use crate::shooter::ReleaseVariable;
use crate::store::free_parameters::FreeParameter;
use crate::store::parameters::{Parameter, parameters};
use crate::units::{Dimension, Measure, UnitName};
use serde::Serialize;

/// What a fit was made from.
#[derive(Clone, Debug)]
pub struct FitSource<'a> {
    /// What was measured.
    pub kind: Source,
    /// The file.
    pub file: String,
    /// What was found in it, in words.
    pub found: &'a [String],
    /// BLAKE3 of its bytes.
    pub file_blake3: String,
    /// The tracker, and whether its noise was measured or is assumed.
    pub tracker: (String, String),
    /// Its errors.
    pub noise: TrackerNoise,
    /// What was known of the shooter before.
    pub prior: PopulationPrior,
    /// What was known of what no sensor sees.
    pub unseen: UnseenPrior,
    /// The physics.
    pub physics: String,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Whether the file names the shooter; otherwise the name is that of the file.
    pub is_shooter_named: bool,
    /// Rows kept out, and why.
    pub rejected: &'a [(u64, String)],
    /// Releases that were measured beside the landings.
    pub differences: &'a [ReleaseDifference],
    /// The name of each place; empty where the file does not say.
    pub place_names: &'a [String],
}

/// How many shots went in.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Observed {
    /// Shots with a result.
    pub shots: usize,
    /// Those that went in.
    pub made: usize,
    /// The share.
    pub share: Wilson,
}

/// The chances of the measured shots against what became of them.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Prediction {
    /// Makes that were expected.
    pub expected_makes: f64,
    /// The standard deviation of their number.
    pub expected_makes_sd: f64,
    /// By how many of its standard deviations the number of makes is greater.
    pub made_z: Option<f64>,
    /// Mean square of chance less result.
    pub brier: f64,
    /// Mean logarithmic loss.
    pub log_loss: f64,
    /// The first of a forecast that gives every shot the share of makes.
    pub brier_of_share: f64,
    /// The second of it.
    pub log_loss_of_share: f64,
    /// Spiegelhalter's z: about 0 with a standard deviation of 1 if the chances of single shots are
    /// right, above 3 where they are overconfident, below -3 where underconfident; null where
    /// too few of the shots were doubtful to tell.
    pub calibration_z: Option<f64>,
    /// The probability that a made shot had the greater chance than a missed one.
    pub area_under_curve: Option<f64>,
    /// Shots that were predicted to be a swish.
    pub predicted_swishes: usize,
    /// Those of them that went in.
    pub predicted_swishes_made: usize,
    /// The reliability diagram.
    pub reliability: Vec<ReliabilityBin>,
}

/// How far the releases of a place lie apart: standard deviations.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Scatter {
    /// Of the distance.
    pub distance_m: f64,
    /// Of the angle on the court.
    pub court_angle_rad: f64,
    /// Of the height.
    pub height_m: f64,
}

/// A place that was shot from.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlaceAnswer {
    /// Its name; empty where the file does not say.
    pub name: String,
    /// Shots with a result.
    pub shots: usize,
    /// Those that went in.
    pub made: usize,
    /// From how far.
    pub distance_m: f64,
    /// From the court's long axis.
    pub court_angle_rad: f64,
    /// Height of the ball's centre at the release.
    pub release_height_m: f64,
    /// How far the releases lie apart.
    pub place_scatter: Scatter,
    /// P of the current shot.
    pub probability: OverDraws,
    /// P of it as it is at the end of the session, where a value drifts; else null.
    pub probability_at_the_end: Option<OverDraws>,
}

/// How well tracked flights fit.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Residuals {
    /// The root mean square over what the tracker's noise gives.
    pub ratio: f64,
    /// The sum of the squares.
    pub chi_square: f64,
    /// Its expectation.
    pub expected: f64,
}

/// How a value runs over the sessions: p-values.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OrderTests {
    /// The value.
    pub name: ReleaseVariable,
    /// Of a drift within the sessions.
    pub drift_p: f64,
    /// Of a shot like the one before it.
    pub serial_correlation_p: f64,
    /// Of equal sessions.
    pub equal_sessions_p: Option<f64>,
    /// Of equal scatter in them.
    pub equal_scatter_p: Option<f64>,
}

impl From<&SessionTrend> for OrderTests {
    fn from(trend: &SessionTrend) -> Self {
        Self {
            name: trend.of,
            drift_p: trend.drift_p,
            serial_correlation_p: trend.serial_p,
            equal_sessions_p: trend.sessions_p,
            equal_scatter_p: trend.spreads_p,
        }
    }
}

/// The tests of the shots, whether a note comes of them or not.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tests {
    /// Mardia's skewness.
    pub mardia_skewness_p: f64,
    /// Mardia's kurtosis.
    pub mardia_kurtosis_p: f64,
    /// The kurtosis over that of normal values.
    pub kurtosis_over_that_of_normal_values: f64,
    /// Those of the order, for each value.
    pub order: Vec<OrderTests>,
}

/// A row that was kept out.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Rejected {
    /// The row.
    pub row: u64,
    /// Why.
    pub reason: String,
}

/// How far a column differs from what the landings give.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Difference {
    /// The column of the file.
    pub column: String,
    /// The value.
    pub name: &'static str,
    /// Shots with both.
    pub shots: usize,
    /// The column less what the landings give.
    pub mean: Measure,
    /// Its standard error.
    pub standard_error: Measure,
}

/// How the draws were made.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SamplerAnswer {
    /// Their number.
    pub draws: usize,
    /// The greatest R-hat of normal scores, of values and of their distances from the median.
    pub r_hat: f64,
    /// The least effective sample size of a parameter's middle.
    pub bulk_effective_sample_size: f64,
    /// The least of its 5 % and 95 % quantiles.
    pub tail_effective_sample_size: f64,
    /// How evenly what no sensor sees was sampled.
    pub unseen: Option<UnseenSample>,
}

/// A named value.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedMeasure {
    /// The name.
    pub name: String,
    /// The value and its unit.
    #[serde(flatten)]
    pub value: Measure,
}

/// The prior of a standard deviation.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScatterPrior {
    /// Its name.
    pub name: String,
    /// The median.
    pub median: Measure,
    /// The standard deviation of its natural logarithm.
    pub sd_of_logarithm: f64,
}

/// What was known before the shots: normal distributions, and t distributions with four degrees of
/// freedom of what no sensor sees.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PriorAnswer {
    /// Of the logarithms of the standard deviations.
    pub scatter: Vec<ScatterPrior>,
    /// Of Fisher's z of the correlation of speed and pitch angle.
    pub fisher_z_of_corr_speed_pitch: Spread,
    /// Of Fisher's z of the other partial correlations.
    pub fisher_z_of_other_partial_correlations: Spread,
    /// Of the growth of the speed's scatter.
    pub growth_of_speed_sd: Spread,
    /// Of a backspin that was not measured.
    pub backspin_mean_rad_s: Spread,
    /// Of the ring's restitution; null where it was given.
    pub hoop_restitution: Option<StudentSpread>,
    /// Scales of the constant errors of the tracker.
    pub constant_errors: Vec<NamedMeasure>,
    /// Scales of the aims about the best shot.
    pub aim: Option<AimPrior>,
}

impl PriorAnswer {
    fn new(prior: &PopulationPrior, unseen: &UnseenPrior) -> Self {
        let scatter = (0..VALUE_NAMES.len()).map(|i| ScatterPrior {
            name: format!("{}_sd", VALUE_NAMES[i]),
            median: Measure::si(prior.median_sd[i], dimension(i)),
            sd_of_logarithm: prior.log_sd[i],
        });
        Self {
            scatter: scatter.collect(),
            fisher_z_of_corr_speed_pitch: prior.speed_pitch,
            fisher_z_of_other_partial_correlations: prior.other_correlations,
            growth_of_speed_sd: prior.growth,
            backspin_mean_rad_s: prior.backspin,
            hoop_restitution: unseen.ring,
            constant_errors: constant_errors(unseen.constant_error),
            aim: unseen.aim,
        }
    }
}

/// What was measured, by what, and under which physics it was understood.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SourceAnswer {
    /// What was measured.
    pub kind: Source,
    /// The file.
    pub file: String,
    /// BLAKE3 of its bytes.
    pub file_blake3: String,
    /// The tracker.
    pub tracker: String,
    /// Whether its noise was measured or is assumed.
    pub tracker_noise: String,
    /// The standard deviations of its errors.
    pub tracker_errors: Vec<NamedMeasure>,
    /// The physics.
    pub physics: String,
    /// Whether the file names the shooter.
    pub names_the_shooter: bool,
}

impl From<&FitSource<'_>> for SourceAnswer {
    fn from(source: &FitSource<'_>) -> Self {
        Self {
            kind: source.kind,
            file: source.file.clone(),
            file_blake3: source.file_blake3.clone(),
            tracker: source.tracker.0.clone(),
            tracker_noise: source.tracker.1.clone(),
            tracker_errors: tracker_errors(source.kind, &source.noise),
            physics: source.physics.clone(),
            names_the_shooter: source.is_shooter_named,
        }
    }
}

/// The errors of a tracker in what it measured; of tracked flights those of a coordinate, with the
/// correlation from frame to frame.
fn tracker_errors(kind: Source, noise: &TrackerNoise) -> Vec<NamedMeasure> {
    let of = |name: &str, unit: UnitName, value: f64| NamedMeasure {
        name: name.to_owned(),
        value: Measure {
            unit,
            value: value / unit.size(),
        },
    };
    match kind {
        Source::Makes => Vec::new(),
        Source::Releases => (0..VALUE_NAMES.len())
            .map(|i| {
                let name = format!("{}_sd", VALUE_NAMES[i]);
                of(&name, UnitName::si(dimension(i)), noise.release[i])
            })
            .collect(),
        Source::Landings => vec![
            of("depth_sd", UnitName::Centimetres, noise.landing[0]),
            of("left_right_sd", UnitName::Centimetres, noise.landing[1]),
            of("entry_angle_sd", UnitName::Radians, noise.landing[2]),
        ],
        Source::Trajectories => vec![
            of("position_sd", UnitName::Metres, noise.position_m),
            of("frame_correlation", UnitName::None, noise.frame_correlation),
            of("frames_per_s", UnitName::PerSecond, noise.frames_per_s),
        ],
    }
}

/// The scales of the constant errors of a tracker.
fn constant_errors(prior: Option<ConstantErrorPrior>) -> Vec<NamedMeasure> {
    let of = |name: &str, dimension: Dimension, scale: f64| NamedMeasure {
        name: name.to_owned(),
        value: Measure::si(scale, dimension),
    };
    match prior {
        None => Vec::new(),
        Some(ConstantErrorPrior::Release(scales)) => (0..scales.len())
            .map(|i| of(VALUE_NAMES[i], dimension(i), scales[i]))
            .collect(),
        Some(ConstantErrorPrior::Landing([depth, right, entry])) => vec![
            of("depth", Dimension::Length, depth),
            of("left_right", Dimension::Length, right),
            of("entry_angle", Dimension::Angle, entry),
        ],
    }
}

/// The dimension of a value, by its index.
fn dimension(value: usize) -> Dimension {
    ReleaseVariable::ALL[value].dimension()
}

/// What measured shots say of a shooter.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FitAnswer {
    /// Who shoots.
    pub shooter: String,
    /// Means, standard deviations, correlations.
    pub parameters: Vec<Parameter>,
    /// P of the current shot at the first place.
    pub probability: OverDraws,
    /// What went in.
    pub observed: Observed,
    /// What was expected to.
    pub prediction: Prediction,
    /// The places.
    pub places: Vec<PlaceAnswer>,
    /// Of tracked flights.
    pub residuals: Option<Residuals>,
    /// Of the model's assumptions.
    pub tests: Tests,
    /// Shots that were fitted.
    pub shots: usize,
    /// Rows that were kept out.
    pub rejected: Vec<Rejected>,
    /// Columns of releases beside the landings.
    pub measured_minus_from_landings: Vec<Difference>,
    /// What should be said.
    pub notes: Vec<FitNote>,
    /// How the draws were made.
    pub sampler: SamplerAnswer,
    /// How much of what is known of each standard deviation the population says.
    pub weight_of_the_population: Named<f64>,
    /// What was known before.
    pub prior: PriorAnswer,
    /// P of the current shot at the first place if a prior were weaker or stronger.
    pub prior_sensitivity: Vec<PriorSensitivity>,
    /// Predicted against measured.
    pub predictive: PredictiveCheck,
    /// How well shapes of the releases predict shots that were left out.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<ShapeScore>,
    /// What the fit was made from.
    pub source: SourceAnswer,
    /// What made the answer.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// What the shots say of parameters that were not measured.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub free: Vec<FreeParameter>,
}

impl FitAnswer {
    /// What a fit found.
    #[must_use]
    pub fn new(fit: &ShooterFit, source: &FitSource<'_>, free: Vec<FreeParameter>) -> Self {
        let (posterior, makes) = (&fit.posterior, &fit.makes);
        let rejected = source.rejected.iter().map(|(row, reason)| Rejected {
            row: *row,
            reason: reason.clone(),
        });
        let weights = VALUE_NAMES.iter().zip(posterior.prior_weights);
        Self {
            shooter: fit.name.clone(),
            parameters: parameters(posterior, source.kind.name()),
            probability: (&fit.probabilities[0]).into(),
            observed: Observed {
                shots: makes.labelled,
                made: makes.made,
                share: makes.share,
            },
            prediction: prediction(fit),
            places: (0..fit.places.len())
                .map(|place| place_answer(fit, source, place))
                .collect(),
            residuals: fit.residuals.map(|residuals| Residuals {
                ratio: residuals.ratio(),
                chi_square: residuals.chi_square,
                expected: residuals.expected,
            }),
            tests: Tests {
                mardia_skewness_p: fit.shape.skewness_p,
                mardia_kurtosis_p: fit.shape.kurtosis_p,
                kurtosis_over_that_of_normal_values: fit.shape.kurtosis_ratio,
                order: fit.trends.iter().map(OrderTests::from).collect(),
            },
            shots: posterior.shots,
            rejected: rejected.collect(),
            measured_minus_from_landings: source.differences.iter().map(difference).collect(),
            notes: fit.notes.clone(),
            sampler: SamplerAnswer {
                draws: posterior.draws.len(),
                r_hat: posterior.r_hat,
                bulk_effective_sample_size: posterior.bulk_effective_sample_size,
                tail_effective_sample_size: posterior.tail_effective_sample_size,
                unseen: posterior.unseen,
            },
            weight_of_the_population: Named(
                weights
                    .map(|(name, weight)| (format!("{name}_sd"), weight))
                    .collect(),
            ),
            prior: PriorAnswer::new(&source.prior, &source.unseen),
            prior_sensitivity: PriorSensitivity::of(
                &posterior.priors,
                &fit.probabilities[0].of_draws,
            ),
            predictive: fit.predictive.clone(),
            shapes: fit.shapes.clone(),
            source: source.into(),
            provenance: Provenance {
                seed: source.seed,
                ..Provenance::of(&fit.profiles[0])
            },
            free,
        }
    }
}

fn prediction(fit: &ShooterFit) -> Prediction {
    let makes = &fit.makes;
    Prediction {
        expected_makes: makes.expected,
        expected_makes_sd: makes.expected_sd,
        made_z: makes.made_z(),
        brier: makes.brier,
        log_loss: makes.log_loss,
        brier_of_share: makes.losses_of_share[0],
        log_loss_of_share: makes.losses_of_share[1],
        calibration_z: makes.calibration_z,
        area_under_curve: makes.area_under_curve,
        predicted_swishes: makes.swishes.0,
        predicted_swishes_made: makes.swishes.1,
        reliability: makes.bins.clone(),
    }
}

fn place_answer(fit: &ShooterFit, source: &FitSource<'_>, index: usize) -> PlaceAnswer {
    let (place, scatter) = (&fit.places[index], &fit.place_scatter[index]);
    let makes = fit.makes.at_place(index);
    PlaceAnswer {
        name: source.place_names[index].clone(),
        shots: makes.labelled,
        made: makes.made,
        distance_m: place.location.distance_m,
        court_angle_rad: place.location.angle_rad,
        release_height_m: place.release_height_m,
        place_scatter: Scatter {
            distance_m: scatter.distance_m,
            court_angle_rad: scatter.court_angle_rad,
            height_m: scatter.height_m,
        },
        probability: (&fit.probabilities[index]).into(),
        probability_at_the_end: fit.at_the_end[index].as_ref().map(Into::into),
    }
}

fn difference(difference: &ReleaseDifference) -> Difference {
    let in_si = |value: f64| Measure::si(value, dimension(difference.value));
    Difference {
        column: difference.column.clone(),
        name: VALUE_NAMES[difference.value],
        shots: difference.shots,
        mean: in_si(difference.mean),
        standard_error: in_si(difference.standard_error),
    }
}

impl Answer for FitAnswer {
    const NAME: &'static str = "fit";
}
