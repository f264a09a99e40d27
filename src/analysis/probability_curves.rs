//! P along each variable of a nominal shot, the others fixed.

use crate::math::evenly_spaced::Linspace;
use crate::probability::{NominalProbabilities, Sampler, Silent, TABLE_RMS_ERROR};
use crate::search_space::TablePlan;
use crate::shooter::{Nominal, NominalVariable, Profile};
use serde::{Deserialize, Serialize};

/// Values of a curve that is sampled.
const SAMPLED_VALUES: usize = 13;
/// Shots of each of them.
const SAMPLES: u64 = 16384;

/// P at one value of a variable.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurvePoint {
    /// The value (SI units).
    pub value: f64,
    /// P.
    pub probability: f64,
    /// Its numerical standard error. The values share their samples, so differences along a curve
    /// are more exact.
    pub standard_error: f64,
}

/// P along one variable of a nominal shot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProbabilityCurve {
    /// The variable.
    pub variable: NominalVariable,
    /// P at its values, in their order.
    pub points: Vec<CurvePoint>,
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
                    let (probability, nominal) = table.at(at);
                    CurvePoint {
                        value: nominal.get(variable),
                        probability,
                        standard_error: TABLE_RMS_ERROR,
                    }
                })
                .collect(),
        })
        .collect()
}

/// Curves by Sobol points, for errors that a table does not have.
pub(crate) fn from_samples(
    profile: &Profile,
    sampler: &Sampler<'_>,
    window: &TablePlan,
    nominal: &Nominal,
) -> Vec<ProbabilityCurve> {
    let max_side_spin = profile.shooter().max_side_spin_rad_s;
    let search = profile.search();
    // Twice as far as the window, within what is searched.
    let range = |variable| {
        let (least, most) = match variable {
            NominalVariable::Speed => (0.1, window.bracket.speed_max_m_s),
            NominalVariable::Pitch => (search.pitch_min_rad, search.pitch_max_rad),
            NominalVariable::Polar => window.bracket.polar_rad,
            NominalVariable::Backspin => profile.backspin_range_rad_s(),
            NominalVariable::SideSpin | NominalVariable::RifleSpin => {
                return (-max_side_spin, max_side_spin);
            }
        };
        let Linspace { low, high, .. } = window.nominal.axis(variable);
        let more = 0.5 * (high - low);
        ((low - more).max(least), (high + more).min(most))
    };
    profile
        .search()
        .choice
        .iter()
        .map(|variable| (variable, range(variable)))
        .filter(|(_, (low, high))| low < high)
        .map(|(variable, (low, high))| {
            let values = Linspace::new(low, high, SAMPLED_VALUES).values();
            let seed = profile.search().seed;
            let points = values.map(|value| {
                let shot = nominal.with(variable, value);
                let estimate = sampler.estimate_within(&shot, 0.0, SAMPLES, seed, &Silent);
                CurvePoint {
                    value,
                    probability: estimate.probability,
                    standard_error: estimate.standard_error,
                }
            });
            ProbabilityCurve {
                variable,
                points: points.collect(),
            }
        })
        .collect()
}
