//! P along each variable of a nominal shot, the others fixed.

use crate::math::evenly_spaced::Linspace;
use crate::math::sobol::Scramble;
use crate::probability::{Neighbourhood, Sampler, Silent};
use crate::search_space::TablePlan;
use crate::shooter::{Nominal, NominalVariable, Profile};
use serde::{Deserialize, Serialize};

/// Values of a curve.
const VALUES: usize = 17;
/// Points of the sample, and how much greater its errors are than the shooter's.
const POINTS: u32 = 32_768;
const WIDENING: f64 = 1.6;
/// Shots of a value that the sample does not tell.
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

/// Curves around a nominal shot, twice as far as its window. Values nearby come from one weighted
/// sample, the others have shots of their own.
pub(crate) fn about(
    profile: &Profile,
    (sampler, scramble): (&Sampler<'_>, &Scramble),
    window: &TablePlan,
    nominal: &Nominal,
) -> Vec<ProbabilityCurve> {
    let near = Neighbourhood::simulate(profile, nominal, (scramble, POINTS), WIDENING);
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
            let values = Linspace::new(low, high, VALUES).values();
            let seed = profile.search().seed;
            let points = values.map(|value| {
                let shot = nominal.with(variable, value);
                let (probability, standard_error) = match near.probability(&shot) {
                    Some(weighed) => (weighed.probability, weighed.standard_error),
                    None => {
                        let estimate = sampler.estimate_within(&shot, 0.0, SAMPLES, seed, &Silent);
                        (estimate.probability, estimate.standard_error)
                    }
                };
                CurvePoint {
                    value,
                    probability,
                    standard_error,
                }
            });
            ProbabilityCurve {
                variable,
                points: points.collect(),
            }
        })
        .collect()
}
