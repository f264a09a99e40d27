//! What a fit took as known, for programs: the tracker's errors and the prior.

use crate::fitting::{PopulationPrior, Spread, TrackerNoise, VALUE_NAMES};
use crate::present::json_object::{number, object};
use crate::store::parameters::value_units;
use crate::units::{DEGREE_RAD, FOOT_M, INCH_M, UnitSystem};
use serde_json::Value;

fn named(name: &str, value: Value) -> (String, Value) {
    (name.to_owned(), value)
}

/// A value with its name and unit.
fn quantity(name: &str, (unit, size): (&str, f64), value: f64) -> Value {
    object(vec![
        named("name", name.into()),
        named("unit", unit.into()),
        named("value", number(value / size)),
    ])
}

/// Standard deviations of the tracker's errors in what was measured (`kind`); of tracked flights
/// those of a coordinate, with the correlation from frame to frame.
pub(super) fn tracker_errors_json(kind: &str, noise: &TrackerNoise, units: UnitSystem) -> Value {
    let of_value = value_units(units);
    let (small, long) = match units {
        UnitSystem::Imperial => (("in", INCH_M), ("ft", FOOT_M)),
        UnitSystem::Metric => (("cm", 0.01), ("m", 1.0)),
    };
    match kind {
        "releases" => (0..VALUE_NAMES.len())
            .map(|i| {
                let name = format!("{}_sd", VALUE_NAMES[i]);
                quantity(&name, of_value[i], noise.release[i])
            })
            .collect(),
        "landings" => [
            quantity("depth_sd", small, noise.landing[0]),
            quantity("left_right_sd", small, noise.landing[1]),
            quantity("entry_angle_sd", ("deg", DEGREE_RAD), noise.landing[2]),
        ]
        .into_iter()
        .collect(),
        _ => [
            quantity("position_sd", long, noise.position_m),
            quantity("frame_correlation", ("", 1.0), noise.frame_correlation),
            quantity("frames_per_s", ("1/s", 1.0), noise.frames_per_s),
        ]
        .into_iter()
        .collect(),
    }
}

/// The prior: normal distributions of the logarithms of the standard deviations, of Fisher's z of
/// the correlations, of the speed scatter's growth, and of a backspin that was not measured. That
/// of the means is flat.
pub(super) fn prior_json(prior: &PopulationPrior, units: UnitSystem) -> Value {
    let of_value = value_units(units);
    let spread = |spread: &Spread, size: f64| {
        object(vec![
            named("mean", number(spread.mean / size)),
            named("sd", number(spread.sd / size)),
        ])
    };
    let scatter = (0..VALUE_NAMES.len()).map(|i| {
        let (unit, size) = of_value[i];
        object(vec![
            named("name", format!("{}_sd", VALUE_NAMES[i]).into()),
            named("unit", unit.into()),
            named("median", number(prior.median_sd[i] / size)),
            named("sd_of_logarithm", number(prior.log_sd[i])),
        ])
    });
    object(vec![
        named("scatter", scatter.collect()),
        named(
            "fisher_z_of_corr_speed_pitch",
            spread(&prior.speed_pitch, 1.0),
        ),
        named(
            "fisher_z_of_other_partial_correlations",
            spread(&prior.other_correlations, 1.0),
        ),
        named("growth_of_speed_sd", spread(&prior.growth, 1.0)),
        named(
            "backspin_mean_rev_s",
            spread(&prior.backspin, of_value[3].1),
        ),
    ])
}
