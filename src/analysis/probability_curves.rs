//! P along each variable of a nominal shot, the others fixed.

use crate::math::evenly_spaced::Linspace;
use crate::math::sobol::Scramble;
use crate::probability::{NominalProbabilities, Sampler};
use crate::search_space::TablePlan;
use crate::shooter::{Nominal, NominalVariable, Profile};
use serde::Serialize;

/// Values of a curve that is sampled.
const SAMPLED_VALUES: usize = 9;
/// Sobol points of each of them.
const SAMPLES: u32 = 16384;

/// P along one variable of a nominal shot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProbabilityCurve {
    /// The variable.
    pub variable: NominalVariable,
    /// Its values (SI units) with P.
    pub points: Vec<(f64, f64)>,
}

/// The lines of a window's table through the nominal shot nearest to the given one.
pub(crate) fn from_table(table: &NominalProbabilities, nominal: &Nominal) -> Vec<ProbabilityCurve> {
    let counts = table.counts();
    let index = table.index_of(nominal);
    NominalVariable::SEARCHABLE
        .into_iter()
        .filter_map(|variable| {
            let axis = NominalVariable::TABLE_AXES
                .iter()
                .position(|&axis| axis == variable)?;
            (counts[axis] > 1).then_some((variable, axis))
        })
        .map(|(variable, axis)| ProbabilityCurve {
            variable,
            points: (0..counts[axis])
                .map(|i| {
                    let mut at = index;
                    at[axis] = i;
                    let (p, nominal) = table.at(at);
                    (nominal.get(variable), p)
                })
                .collect(),
        })
        .collect()
}

/// The same by Sobol points, for errors that a table does not have.
pub(crate) fn from_samples(
    profile: &Profile,
    sampler: &Sampler<'_>,
    scramble: &Scramble,
    window: &TablePlan,
    nominal: &Nominal,
) -> Vec<ProbabilityCurve> {
    let max_side_spin = profile.shooter().max_side_spin_rad_s;
    let range = |variable| match variable {
        NominalVariable::SideSpin => Linspace::new(-max_side_spin, max_side_spin, SAMPLED_VALUES),
        _ => window.nominal.axis(variable),
    };
    profile
        .search()
        .choice
        .iter()
        .map(|variable| (variable, range(variable)))
        .filter(|(_, range)| range.low < range.high)
        .map(|(variable, Linspace { low, high, .. })| {
            let values = Linspace::new(low, high, SAMPLED_VALUES).values();
            let points = values.map(|value| {
                let shot = nominal.with(variable, value);
                let made = sampler.count(&shot, scramble, (0, SAMPLES)).made();
                (value, made as f64 / f64::from(SAMPLES))
            });
            ProbabilityCurve {
                variable,
                points: points.collect(),
            }
        })
        .collect()
}
