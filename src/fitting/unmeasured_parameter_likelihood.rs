//! A parameter that no sensor sees, by made and missed shots alone.

use super::expected_makes::{common_normals, factor_of, release_given};
use super::measured_release::MeasuredRelease;
use super::posterior::Draw;
use crate::dynamics::BatchWorkspace;
use crate::model::SolidId;
use crate::probability::Progress;
use crate::shooter::{Profile, ProfileError};
use crate::units::REV_RAD;
use rayon::prelude::*;

/// Releases that a shot may have had, for each measured one.
const RELEASES: u32 = 256;
/// Values at which the likelihood is computed.
const VALUES: usize = 17;
/// Twice the logarithm of the likelihood ratio at the ends of a 95 % interval (chi-square, one
/// degree of freedom).
const RATIO_95: f64 = 3.841_458_820_694_124;

/// The parameters that made and missed shots can tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnseenParameter {
    /// The mean backspin.
    Backspin,
    /// The restitution of the hoop.
    HoopRestitution,
}

impl UnseenParameter {
    /// The parameter of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        [Self::Backspin, Self::HoopRestitution]
            .into_iter()
            .find(|parameter| parameter.name() == name)
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Backspin => "backspin",
            Self::HoopRestitution => "hoop_restitution",
        }
    }

    /// The range that is searched: rad/s, or none.
    #[must_use]
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Backspin => (-REV_RAD, 5.0 * REV_RAD),
            Self::HoopRestitution => (0.3, 0.9),
        }
    }

    /// The values that sources give: rad/s, or none. (Rule books let the ring absorb 35 to 50 % of
    /// the energy, and estimates with two masses go down to 0.41; for backspin see
    /// [`PopulationPrior::MEASURED`](super::PopulationPrior).)
    #[must_use]
    pub fn usual_range(self) -> (f64, f64) {
        match self {
            Self::Backspin => (0.5 * REV_RAD, 4.0 * REV_RAD),
            Self::HoopRestitution => (0.41, 0.70),
        }
    }
}

/// The likelihood of the made and missed shots.
#[derive(Clone, Debug, PartialEq)]
pub struct LikelihoodCurve {
    /// The parameter.
    pub parameter: UnseenParameter,
    /// Its value and the logarithm of the likelihood over its greatest value.
    pub points: Vec<(f64, f64)>,
    /// The most likely value.
    pub best: f64,
    /// The 95 % interval by the likelihood ratio. An end at the range's end is open.
    pub interval: [f64; 2],
    /// Whether the interval ends inside the range on both sides: otherwise these shots cannot tell.
    pub is_decided: bool,
}

/// A fitted shooter with the shots of the fit.
#[derive(Clone, Copy)]
pub struct FittedShooter<'a> {
    /// The profiles of the places.
    pub profiles: &'a [Profile],
    /// The shots.
    pub shots: &'a [MeasuredRelease],
    /// The typical draw.
    pub typical: &'a Draw,
    /// How many of the values of each shot were measured.
    pub measured_values: usize,
}

/// The likelihood curve of a parameter that the shooters have in common.
///
/// # Errors
/// A value makes no profile.
pub fn likelihood_curve(
    parameter: UnseenParameter,
    shooters: &[FittedShooter<'_>],
    progress: &dyn Progress,
) -> Result<LikelihoodCurve, ProfileError> {
    let shots = shooters.iter().flat_map(|shooter| shooter.shots);
    let labelled = shots.filter(|shot| shot.made.is_some()).count();
    progress.begin("weighing makes", (2 * VALUES * labelled) as u64);
    let curve = tabulated_curve(parameter, shooters, progress);
    progress.end();
    curve
}

/// [`likelihood_curve`] within its stage.
fn tabulated_curve(
    parameter: UnseenParameter,
    shooters: &[FittedShooter<'_>],
    progress: &dyn Progress,
) -> Result<LikelihoodCurve, ProfileError> {
    let normals = common_normals(RELEASES, 1);
    let of_shooter = |shooter: &FittedShooter<'_>, value: f64| -> Result<f64, ProfileError> {
        let is_labelled = |shot: &&MeasuredRelease| shot.made.is_some();
        let labelled: Vec<&MeasuredRelease> = shooter.shots.iter().filter(is_labelled).collect();
        let mut draw = shooter.typical.clone();
        let mut changed = shooter.profiles.to_vec();
        match parameter {
            UnseenParameter::Backspin => {
                for mean in &mut draw.means {
                    mean[3] = value;
                }
            }
            UnseenParameter::HoopRestitution => {
                for profile in &mut changed {
                    *profile = profile.with(|settings| {
                        let set = settings.physics.set_restitution_on(SolidId::Ring, value);
                        debug_assert!(set.is_ok(), "the range is that of restitutions");
                    })?;
                }
            }
        }
        let measured_values = match parameter {
            UnseenParameter::Backspin => shooter.measured_values.min(3),
            UnseenParameter::HoopRestitution => shooter.measured_values,
        };
        let logarithms: Vec<f64> = labelled
            .par_iter()
            .map_init(BatchWorkspace::default, |workspace, shot| {
                progress.advance(1);
                let Some((mean, covariance)) = release_given(shot, &draw, measured_values) else {
                    return 0.0;
                };
                let factor = factor_of(&covariance);
                let profile = &changed[shot.place];
                let starts: Vec<_> = normals
                    .iter()
                    .map(|z| {
                        let values =
                            nalgebra::Vector4::from(mean) + factor * nalgebra::Vector4::from(*z);
                        shot.release(profile, &values.into()).state()
                    })
                    .collect();
                let verdicts = profile.simulator().finite_verdicts(&starts, workspace);
                let made = verdicts.iter().filter(|verdict| verdict.made).count() as f64;
                // Half a shot more of each: no chance is 0 or 1.
                let chance = (made + 0.5) / (f64::from(RELEASES) + 1.0);
                libm::log(if shot.made == Some(true) {
                    chance
                } else {
                    1.0 - chance
                })
            })
            .collect();
        Ok(logarithms.iter().sum::<f64>())
    };
    let log_likelihood = |value: f64| -> Result<f64, ProfileError> {
        let each = shooters.iter().map(|shooter| of_shooter(shooter, value));
        each.sum()
    };
    let tabulate = |low: f64, high: f64| {
        let step = (high - low) / (VALUES - 1) as f64;
        let values = (0..VALUES).map(|k| low + step * k as f64);
        values
            .map(|value| Ok((value, log_likelihood(value)?)))
            .collect::<Result<Vec<_>, ProfileError>>()
    };
    // Over the whole range, and again where the likelihood is: steps as wide as the interval would
    // make it too narrow.
    let (low, high) = parameter.range();
    let coarse = curve(parameter, tabulate(low, high)?);
    let step = (high - low) / (VALUES - 1) as f64;
    let [from, to] = coarse.interval;
    let fine = tabulate((from - step).max(low), (to + step).min(high))?;
    Ok(curve(parameter, fine))
}

/// Maximum and interval of tabulated logarithms of the likelihood.
fn curve(parameter: UnseenParameter, mut points: Vec<(f64, f64)>) -> LikelihoodCurve {
    let top = (0..points.len())
        .max_by(|&a, &b| points[a].1.total_cmp(&points[b].1))
        .unwrap_or(0);
    let (mut best, mut greatest) = points[top];
    if top > 0 && top + 1 < points.len() {
        // The parabola through the greatest value and its neighbours.
        let (left, right) = (points[top - 1].1, points[top + 1].1);
        let curvature = left - 2.0 * greatest + right;
        if curvature < 0.0 {
            let step = points[top].0 - points[top - 1].0;
            let shift = 0.5 * (left - right) / curvature;
            best += shift * step;
            greatest -= 0.25 * (left - right) * shift;
        }
    }
    for point in &mut points {
        point.1 -= greatest;
    }
    let level = -0.5 * RATIO_95;
    // From the ends inwards: a curve of few shots can dip below the level and rise again, and the
    // interval holds all of it.
    let crossing = |from_end: &mut dyn Iterator<Item = (f64, f64)>| {
        let mut outside: Option<(f64, f64)> = None;
        for point in from_end.chain([(best, 0.0)]) {
            if point.1 >= level {
                let (value, logarithm) = outside?;
                let share = (level - logarithm) / (point.1 - logarithm);
                return Some(value + share * (point.0 - value));
            }
            outside = Some(point);
        }
        None
    };
    let below = crossing(&mut points.iter().copied().filter(|point| point.0 < best));
    let above = crossing(&mut points.iter().rev().copied().filter(|point| point.0 > best));
    let (low, high) = parameter.range();
    LikelihoodCurve {
        parameter,
        best,
        interval: [below.unwrap_or(low), above.unwrap_or(high)],
        is_decided: below.is_some() && above.is_some(),
        points,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Authority: the parabola -x^2/2 about 2 has the interval 2 +- 1.96.
    #[test]
    fn val_interval_of_a_parabola() {
        let points = (0..41)
            .map(|k| {
                let x = -3.0 + 0.25 * f64::from(k);
                (x, 5.0 - 0.5 * (x - 2.1) * (x - 2.1))
            })
            .collect();
        let curve = curve(UnseenParameter::Backspin, points);
        assert!((curve.best - 2.1).abs() < 1e-9);
        assert!((curve.interval[0] - 0.14).abs() < 0.01, "{curve:?}");
        assert!((curve.interval[1] - 4.06).abs() < 0.01);
        assert!(curve.is_decided);
    }

    /// A curve with two maxima whose valley is below the level.
    #[test]
    fn contract_the_interval_holds_every_likely_value() {
        let logarithms = [-9.0, -4.0, -0.5, -3.0, 0.0, -4.0, -9.0];
        let points = logarithms.iter().enumerate();
        let points = points
            .map(|(k, &logarithm)| (k as f64, logarithm))
            .collect();
        let [low, high] = curve(UnseenParameter::Backspin, points).interval;
        assert!(
            (1.0..2.0).contains(&low) && (4.0..5.0).contains(&high),
            "{low} {high}"
        );
    }
}
