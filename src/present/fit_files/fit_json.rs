//! `fit.json`: a fit for programs.

use super::assumptions_json::{prior_json, tracker_errors_json};
use crate::fitting::{
    ConstantError, DrawProbabilities, Interval, PlaceScatter, PopulationPrior, ReleaseDifference,
    ShooterFit, TrackerNoise, VALUE_NAMES, Wilson, constant_errors,
};
use crate::present::json_object::{Record, number, object, provenance};
use crate::store::parameters::{parameters, value_units};
use crate::units::{DEGREE_RAD, UnitSystem};
use serde_json::Value;

/// What a fit was made from.
#[derive(Clone, Debug)]
pub struct FitSource<'a> {
    /// `releases`, `landings` or `trajectories`.
    pub kind: &'a str,
    /// The file.
    pub file: String,
    /// BLAKE3 of its bytes.
    pub file_blake3: String,
    /// The tracker, and whether its noise was measured or is assumed.
    pub tracker: (String, String),
    /// Its errors.
    pub noise: TrackerNoise,
    /// What was known of the shooter before.
    pub prior: PopulationPrior,
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

fn named(name: &str, value: Value) -> (String, Value) {
    (name.to_owned(), value)
}

/// An interval as an object.
#[must_use]
pub fn interval_json(interval: &Interval) -> Record {
    vec![
        named("mean", number(interval.mean)),
        named("sd", number(interval.sd)),
        named("low", number(interval.low)),
        named("high", number(interval.high)),
    ]
}

/// How far the releases of a place lie apart, for programs.
fn place_scatter_json(scatter: &PlaceScatter, units: UnitSystem) -> Value {
    let (long, metre) = units.length();
    object(vec![
        named(
            &format!("distance_{long}"),
            number(scatter.distance_m / metre),
        ),
        named(
            "court_angle_deg",
            number(scatter.court_angle_rad / DEGREE_RAD),
        ),
        named(&format!("height_{long}"), number(scatter.height_m / metre)),
    ])
}

/// P over the draws.
#[must_use]
pub fn probability_json(probabilities: &DrawProbabilities) -> Value {
    let mut record = interval_json(&probabilities.interval());
    record.push(named(
        "numerical_standard_error",
        number(probabilities.numerical_standard_error()),
    ));
    object(record)
}

fn wilson_json(wilson: &Wilson) -> Value {
    object(vec![
        named("share", number(wilson.share)),
        named("low", number(wilson.low)),
        named("high", number(wilson.high)),
    ])
}

/// The whole fit.
#[must_use]
pub fn fit_json(fit: &ShooterFit, source: &FitSource<'_>, units: UnitSystem) -> Value {
    let posterior = &fit.posterior;
    let (long, metre) = units.length();
    let listed = parameters(posterior, source.kind, units)
        .into_iter()
        .map(|parameter| {
            let mut record = vec![
                named("name", parameter.name.into()),
                named("unit", parameter.unit.into()),
            ];
            record.extend(interval_json(&parameter.interval));
            record.push(named("source", parameter.source.into()));
            object(record)
        });
    let places = fit.places.iter().zip(&fit.probabilities).enumerate();
    let places = places.map(|(index, (place, p))| {
        let makes = fit.makes.at_place(index);
        object(vec![
            named("name", source.place_names[index].clone().into()),
            named("shots", makes.labelled.into()),
            named("made", makes.made.into()),
            named(
                &format!("distance_{long}"),
                number(place.location.distance_m / metre),
            ),
            named(
                "court_angle_deg",
                number(place.location.angle_rad / DEGREE_RAD),
            ),
            named(
                &format!("release_height_{long}"),
                number(place.release_height_m / metre),
            ),
            named(
                "place_scatter",
                place_scatter_json(&fit.place_scatter[index], units),
            ),
            named("probability", probability_json(p)),
        ])
    });
    let makes = &fit.makes;
    let observed = object(vec![
        named("shots", makes.labelled.into()),
        named("made", makes.made.into()),
        named("share", wilson_json(&makes.share)),
    ]);
    let reliability = makes.bins.iter().map(|bin| {
        object(vec![
            named("shots", bin.shots.into()),
            named("predicted", number(bin.predicted)),
            named("observed", wilson_json(&bin.observed)),
        ])
    });
    let prediction = object(vec![
        named("expected_makes", number(makes.expected)),
        named("expected_makes_sd", number(makes.expected_sd)),
        named("made_z", makes.made_z().map_or(Value::Null, number)),
        named("brier", number(makes.brier)),
        named("log_loss", number(makes.log_loss)),
        named("brier_of_share", number(makes.losses_of_share[0])),
        named("log_loss_of_share", number(makes.losses_of_share[1])),
        named(
            "calibration_z",
            makes.calibration_z.map_or(Value::Null, number),
        ),
        named(
            "calibration_note",
            match makes.calibration_z {
                Some(_) => "about 0 \u{b1} 1 if the chances of single shots are right; above 3 they are too sure, below -3 not sure enough",
                None => "null: too few of the shots were doubtful to tell",
            }
            .into(),
        ),
        named(
            "area_under_curve",
            makes.area_under_curve.map_or(Value::Null, number),
        ),
        named("predicted_swishes", makes.swishes.0.into()),
        named("predicted_swishes_made", makes.swishes.1.into()),
        named("reliability", reliability.collect()),
    ]);
    let rejected = source.rejected.iter().map(|(row, reason)| {
        object(vec![
            named("row", (*row).into()),
            named("reason", reason.clone().into()),
        ])
    });
    let of_value = value_units(units);
    let differences = source.differences.iter().map(|difference| {
        let (unit, size) = of_value[difference.value];
        object(vec![
            named("column", difference.column.clone().into()),
            named("name", VALUE_NAMES[difference.value].into()),
            named("unit", unit.into()),
            named("shots", difference.shots.into()),
            named("mean", number(difference.mean / size)),
            named("standard_error", number(difference.standard_error / size)),
        ])
    });
    let weights = ["speed_sd", "pitch_sd", "polar_sd", "backspin_sd"]
        .iter()
        .zip(posterior.prior_weights)
        .map(|(name, weight)| named(name, number(weight)));
    let mut record = vec![
        named("shooter", fit.name.clone().into()),
        named("parameters", listed.collect()),
        named("probability", probability_json(&fit.probabilities[0])),
        named("observed", observed),
        named("prediction", prediction),
        named("places", places.collect()),
        named(
            "residuals",
            fit.residuals.as_ref().map_or(Value::Null, |residuals| {
                object(vec![
                    named("ratio", number(residuals.ratio())),
                    named("chi_square", number(residuals.chi_square)),
                    named("expected", number(residuals.expected)),
                ])
            }),
        ),
        named("tests", tests_json(fit)),
        named("constant_errors", constant_errors_json(fit, source, units)),
        named("shots", posterior.shots.into()),
        named("rejected", rejected.collect()),
        named("measured_less_from_landings", differences.collect()),
        named(
            "warnings",
            fit.warnings
                .iter()
                .map(|w| Value::from(w.to_string()))
                .collect(),
        ),
        named(
            "sampler",
            object(vec![
                named("draws", posterior.draws.len().into()),
                named("r_hat", number(posterior.r_hat)),
                named(
                    "effective_sample_size",
                    number(posterior.effective_sample_size),
                ),
                named("seed", source.seed.into()),
            ]),
        ),
        named("weight_of_the_population", object(weights.collect())),
        named("prior", prior_json(&source.prior, units)),
        named(
            "source",
            object(vec![
                named("kind", source.kind.into()),
                named("file", source.file.clone().into()),
                named("file_blake3", source.file_blake3.clone().into()),
                named("tracker", source.tracker.0.clone().into()),
                named("tracker_noise", source.tracker.1.clone().into()),
                named(
                    "tracker_errors",
                    tracker_errors_json(source.kind, &source.noise, units),
                ),
                named("physics", source.physics.clone().into()),
                named("names_the_shooter", source.is_shooter_named.into()),
            ]),
        ),
    ];
    record.extend(provenance(fit.profiles[0].hash()));
    object(record)
}

/// The tests of the shots, whether they warn or not.
fn tests_json(fit: &ShooterFit) -> Value {
    let trends = fit.trends.iter().map(|trend| {
        object(vec![
            named("name", trend.name.into()),
            named("drift_p", number(trend.drift_p)),
            named("serial_correlation_p", number(trend.serial_p)),
            named(
                "equal_sessions_p",
                trend.sessions_p.map_or(Value::Null, number),
            ),
            named(
                "equal_scatter_p",
                trend.spreads_p.map_or(Value::Null, number),
            ),
        ])
    });
    object(vec![
        named("mardia_skewness_p", number(fit.shape.skewness_p)),
        named("mardia_kurtosis_p", number(fit.shape.kurtosis_p)),
        named(
            "kurtosis_over_that_of_normal_values",
            number(fit.shape.kurtosis_ratio),
        ),
        named("order", trends.collect()),
    ])
}

/// What constant errors of the tracker would do.
fn constant_errors_json(fit: &ShooterFit, source: &FitSource<'_>, units: UnitSystem) -> Value {
    let errors = constant_errors_of(fit, source).into_iter();
    let error = |error: ConstantError| {
        let (unit, size) = value_units(units)[error.value];
        object(vec![
            named("name", VALUE_NAMES[error.value].into()),
            named("unit", unit.into()),
            named("reads_too_high_by", number(error.by / size)),
            named("probability", number(error.probability)),
            named("made_z", error.made_z.map_or(Value::Null, number)),
        ])
    };
    errors.map(error).collect()
}

/// What constant errors of the tracker would do; empty where no releases were measured.
pub(super) fn constant_errors_of(fit: &ShooterFit, source: &FitSource<'_>) -> Vec<ConstantError> {
    if source.kind != "releases" {
        return Vec::new();
    }
    let noise = source.noise.release_covariance();
    constant_errors(fit, [0, 1, 2].map(|i| libm::sqrt(noise[(i, i)].max(0.0))))
}
