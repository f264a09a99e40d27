//! The parameters of a fit, by name, in the units of results.

use crate::fitting::{Draw, Interval, Posterior, SpinSource, VALUE_NAMES, pair_name};
use crate::shooter::ReleaseVariable;
use crate::units::{Dimension, UnitName, UnitSystem};
use serde::Serialize;

/// One parameter.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parameter {
    /// Its name, such as `speed_sd`.
    pub name: String,
    /// Its unit.
    pub unit: UnitName,
    /// Its distribution, in that unit.
    #[serde(flatten)]
    pub interval: Interval,
    /// `measured`, `from landings`, `from trajectories`, `from makes` (and its prior), `given` or
    /// `assumed`.
    pub source: &'static str,
}

impl Parameter {
    /// In the unit of results.
    #[must_use]
    pub fn in_results(self, units: UnitSystem) -> Self {
        let unit = self.unit.in_results(units);
        Self {
            interval: self.interval.scaled(self.unit.size() / unit.size()),
            unit,
            ..self
        }
    }
}

/// Unit and its size in SI units of each of the values.
#[must_use]
pub fn value_units(units: UnitSystem) -> [(&'static str, f64); 4] {
    [
        Dimension::Speed,
        Dimension::Angle,
        Dimension::Angle,
        Dimension::Spin,
    ]
    .map(|dimension| units.unit(dimension))
    .map(|unit| (unit.name, unit.size))
}

/// The name of the mean of a value at a place, by its index; the first has no number.
pub(crate) fn mean_name(place: usize, value: &str) -> String {
    match place {
        0 => format!("{value}_mean"),
        _ => format!("place_{}_{value}_mean", place + 1),
    }
}

/// All parameters of a posterior: means (of further places with the number of the place), standard
/// deviations, correlations, the tail weight (one over the degrees of freedom) where it was fitted,
/// the ring and the tracker's constant error where they were,
/// and the coefficients of the speed's standard deviation where there are several. `kind` is what
/// was measured: `releases`, `landings` or `trajectories`. All are in SI units.
#[must_use]
pub fn parameters(posterior: &Posterior, kind: &str) -> Vec<Parameter> {
    // Releases that the flight model found under a landing or a track were not measured.
    let release_source = match kind {
        "landings" => "from landings",
        "trajectories" => "from trajectories",
        "makes" => "from makes",
        _ => "measured",
    };
    let of_value = |value: usize| ReleaseVariable::ALL[value].dimension();
    let is_of_makes = posterior.spin == SpinSource::NothingMeasured;
    let measured = match is_of_makes {
        true => 3,
        false => posterior.spin.measured_values(),
    };
    let source = |value: usize| {
        if value < measured.min(3) {
            release_source
        } else {
            posterior.spin.name()
        }
    };
    let mut parameters = Vec::new();
    let mut add = |name: String, dimension, source, value: &dyn Fn(&Draw) -> f64| {
        parameters.push(Parameter {
            name,
            unit: UnitName::si(dimension),
            interval: posterior.summary(value),
            source,
        });
    };
    for place in 0..posterior.draws[0].means.len() {
        for (i, name) in VALUE_NAMES.iter().enumerate() {
            let name = mean_name(place, name);
            add(name, of_value(i), source(i), &|draw| draw.means[place][i]);
        }
    }
    for (i, name) in VALUE_NAMES.iter().enumerate() {
        let source = match (i < measured.min(3), posterior.spin) {
            (true, _) => release_source,
            (false, SpinSource::Measured) => "measured",
            // The scatter of a spin that was not measured is the population's, also where its
            // mean was given.
            (false, _) => "assumed",
        };
        add(format!("{name}_sd"), of_value(i), source, &|draw| {
            draw.sds[i]
        });
    }
    for j in 1..measured {
        for i in 0..j {
            let name = format!("corr_{}", pair_name(i, j));
            add(name, Dimension::Number, release_source, &|draw| {
                draw.correlation[(i, j)]
            });
        }
    }
    if posterior.draws.iter().any(|draw| draw.tail_weight > 0.0) {
        let name = "tail_weight".to_owned();
        add(name, Dimension::Number, release_source, &|draw| {
            draw.tail_weight
        });
    }
    if posterior.draws[0].ring_restitution.is_some() {
        add(
            "hoop_restitution".to_owned(),
            Dimension::Number,
            "from makes",
            &|draw| draw.ring_restitution.unwrap_or_default(),
        );
    }
    for (i, name) in VALUE_NAMES.iter().enumerate().take(3) {
        let of_draw = |draw: &Draw| draw.constant_errors[0][i];
        if posterior.draws.iter().any(|draw| of_draw(draw) != 0.0) {
            add(
                format!("{name}_reads_high_by"),
                of_value(i),
                "from makes",
                &of_draw,
            );
        }
    }
    let coefficients = [
        ("c10", Dimension::Speed),
        ("c11", Dimension::Number),
        ("c12", Dimension::PerSpeed),
    ];
    if posterior.growth_terms > 0 {
        let coefficients = coefficients.into_iter().enumerate();
        for (k, (name, dimension)) in coefficients.take(posterior.growth_terms + 1) {
            add(name.to_owned(), dimension, release_source, &|draw| {
                draw.speed_coefficients[k]
            });
        }
    }
    parameters
}
