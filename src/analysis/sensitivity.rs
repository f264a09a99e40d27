//! How P depends on the errors of the shooter, on backspin and on the height of the release, and
//! how wide the windows of a shot are.
//!
//! Every comparison is between two shots, or two shooters, under the same Sobol points
//! (`probability/shared_sample.rs`). Each scramble gives a difference, and the scatter of these
//! gives its standard error. A shooter without an error, another backspin and another height are
//! simulated. A shooter with 10 % less of an error, and other speeds of a shot, reuse the shots
//! of the nearest simulated one.

use super::aim_past_hoop::with_same_aim;
use crate::probability::{MadeReleases, Progress, SharedSample, Silent};
use crate::shooter::{
    Nominal, NominalVariable, Profile, ReleaseDistribution, ReleaseVariable, ShotKind,
};
use crate::units::FOOT_M;
use serde::{Deserialize, Serialize};

/// Speeds that a re-optimised shot is tried with, in standard deviations of the speed from its own.
const SPEEDS: [f64; 5] = [-0.5, -0.25, 0.0, 0.25, 0.5];
/// Number of backspins, from none to the shooter's limit.
const BACKSPINS: usize = 5;
/// Heights of release, m from the shooter's own.
const HEIGHTS_M: [f64; 4] = [-0.5 * FOOT_M, -0.25 * FOOT_M, 0.25 * FOOT_M, 0.5 * FOOT_M];
/// Factor of the standard deviation of an error that is a tenth smaller.
const A_TENTH_LESS: f64 = 0.9;
/// Halvings that find the end of a window within a step.
const HALVINGS: u32 = 12;

/// A difference of two probabilities.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Difference {
    /// The difference.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl Difference {
    /// Whether the difference is positive by more than two standard errors.
    #[must_use]
    pub fn is_surely_positive(&self) -> bool {
        self.value > 2.0 * self.standard_error
    }
}

/// The values of one variable between which the error-free shot is made, the other variables fixed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShotWindow {
    /// The variable.
    pub variable: NominalVariable,
    /// Lowest and highest value, SI units; `None` if the error-free shot is missed, or was not
    /// computed.
    pub ends: Option<(f64, f64)>,
}

impl ShotWindow {
    /// The variables that have a window.
    pub const VARIABLES: [NominalVariable; 3] = [
        NominalVariable::Speed,
        NominalVariable::Pitch,
        NominalVariable::Polar,
    ];

    /// First step and far end of the search for an end of the window, SI units.
    fn search_range(variable: NominalVariable) -> (f64, f64) {
        match variable {
            NominalVariable::Speed => (0.002, 2.0),
            _ => (0.000_5, 0.35),
        }
    }
}

/// What one error costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorCost {
    /// The variable with the error.
    pub variable: ReleaseVariable,
    /// Gain in P without the error.
    pub without: Difference,
    /// Gain in P with a standard deviation 10 % less.
    pub a_tenth_less: Difference,
}

/// The gain in P of a changed shot, its speed re-optimised among shots of the same kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// The changed value, SI units: backspin, or height of the release.
    pub value: f64,
    /// Gain in P.
    pub gain: Difference,
}

/// How P depends on the errors, backspin and height.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sensitivity {
    /// Windows in speed, pitch angle and polar angle.
    pub windows: [ShotWindow; 3],
    /// The errors of the shooter, the costliest first.
    pub errors: Vec<ErrorCost>,
    /// Backspins from 0 to the shooter's limit against the shot's own.
    pub backspins: Vec<Variation>,
    /// Heights of release against the shooter's own.
    pub heights: Vec<Variation>,
}

impl Sensitivity {
    /// Gain in P of the shot's own backspin over none.
    #[must_use]
    pub fn backspin_gain(&self) -> Option<Difference> {
        let none = self.backspins.first()?;
        Some(Difference {
            value: -none.gain.value,
            standard_error: none.gain.standard_error,
        })
    }
}

/// The topics that are analysed. The others stay empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SensitivityTopics {
    /// The windows.
    pub windows: bool,
    /// The cost of each error.
    pub errors: bool,
    /// Backspin.
    pub backspin: bool,
    /// Height of the release.
    pub height: bool,
    /// P along each variable of a best shot, where it takes samples of its own: where the errors
    /// are not those of Eq. 25, which a table has.
    pub curves: bool,
}

impl SensitivityTopics {
    /// Everything.
    pub const ALL: Self = Self {
        windows: true,
        errors: true,
        backspin: true,
        height: true,
        curves: true,
    };
    /// Nothing.
    pub const NONE: Self = Self {
        windows: false,
        errors: false,
        backspin: false,
        height: false,
        curves: false,
    };

    fn needs_probability(self) -> bool {
        self.errors || self.backspin || self.height
    }
}

/// Analyses some topics of the sensitivity of a nominal shot.
#[must_use]
pub fn analyse(
    profile: &Profile,
    nominal: &Nominal,
    topics: SensitivityTopics,
    progress: &dyn Progress,
) -> Sensitivity {
    let (errors, backspins, heights) = if topics.needs_probability() {
        Comparison::new(profile, nominal, topics).run(progress)
    } else {
        Default::default()
    };
    Sensitivity {
        errors,
        backspins,
        heights,
        windows: ShotWindow::VARIABLES.map(|variable| ShotWindow {
            variable,
            ends: topics
                .windows
                .then(|| window(profile, nominal, variable))
                .flatten(),
        }),
    }
}

fn difference(a: &[f64], b: &[f64]) -> Difference {
    let n = a.len() as f64;
    let value = a.iter().zip(b).map(|(a, b)| a - b).sum::<f64>() / n;
    let squares: f64 = a
        .iter()
        .zip(b)
        .map(|(a, b)| (a - b - value) * (a - b - value))
        .sum();
    Difference {
        value,
        standard_error: (squares / (n * (n - 1.0))).sqrt(),
    }
}

/// A nominal shot of a shooter, to be compared with another one.
struct Variant {
    of: VariantOf,
    profile: Profile,
    nominal: Nominal,
}

/// What is different.
enum VariantOf {
    /// A shooter without an error.
    Error(ReleaseVariable),
    /// The backspin, rad/s.
    Backspin(f64),
    /// The height of the release, m.
    Height(f64),
}

/// The comparison of a shot with its variants.
struct Comparison<'a> {
    profile: &'a Profile,
    nominal: &'a Nominal,
    kind: ShotKind,
    variants: Vec<Variant>,
}

impl<'a> Comparison<'a> {
    fn new(profile: &'a Profile, nominal: &'a Nominal, topics: SensitivityTopics) -> Self {
        let mut variants = Vec::new();
        let fastest = fastest_m_s(profile);
        let mut add = |of, profile: Option<Profile>, mut nominal: Nominal| {
            nominal.speed_m_s = nominal.speed_m_s.min(fastest);
            variants.extend(profile.map(|profile| Variant {
                of,
                profile,
                nominal,
            }));
        };
        let shooter = profile.shooter();
        if topics.errors {
            let sigmas = shooter.dispersion.sigmas(nominal);
            for variable in ReleaseVariable::ALL {
                if sigmas[variable.index()] > 0.0 {
                    let without = with_error_scaled(profile, variable, 0.0);
                    add(VariantOf::Error(variable), without, *nominal);
                }
            }
        }
        let most = shooter.max_backspin_rad_s;
        if topics.backspin && most > 0.0 {
            // Evenly spaced, from none to the shooter's limit. (They do not change the kind of the
            // shot.)
            for i in 0..BACKSPINS {
                let value = most * i as f64 / (BACKSPINS - 1) as f64;
                let shot = nominal.with(NominalVariable::Backspin, value);
                add(VariantOf::Backspin(value), Some(profile.clone()), shot);
            }
        }
        if topics.height {
            // Only heights that are possible.
            for by in HEIGHTS_M {
                let other = profile.with(|settings| settings.shooter.release_height_m += by);
                if let Ok(other) = other {
                    let shot = with_same_aim(profile, &other, nominal);
                    let height = other.shooter().release_height_m;
                    add(VariantOf::Height(height), Some(other), shot);
                }
            }
        }
        Self {
            profile,
            nominal,
            kind: ShotKind::of(profile, nominal),
            variants,
        }
    }

    /// The errors, the costliest first; the backspins; the heights.
    fn run(&self, progress: &dyn Progress) -> (Vec<ErrorCost>, Vec<Variation>, Vec<Variation>) {
        let sample = SharedSample::new(self.profile);
        let mut shots = vec![(self.profile, *self.nominal)];
        shots.extend(self.variants.iter().map(|v| (&v.profile, v.nominal)));
        let simulated = sample.simulate(self.profile.simulator(), &shots, progress);
        let (base, simulated) = simulated
            .split_first()
            .expect("the shot itself is simulated");
        let own = &sample.shares(base);
        let (mut errors, mut backspins, mut heights) = (Vec::new(), Vec::new(), Vec::new());
        for (variant, made) in self.variants.iter().zip(simulated) {
            match variant.of {
                VariantOf::Error(variable) => errors.push(ErrorCost {
                    variable,
                    without: difference(&sample.shares(made), own),
                    a_tenth_less: self.gain_of_a_tenth(&sample, base, variable),
                }),
                VariantOf::Backspin(value) => {
                    let gain = self.gain_re_optimised(&sample, made, variant, own);
                    backspins.extend(gain.map(|gain| Variation { value, gain }));
                }
                VariantOf::Height(value) => {
                    let gain = self.gain_re_optimised(&sample, made, variant, own);
                    heights.extend(gain.map(|gain| Variation { value, gain }));
                }
            }
        }
        errors.sort_by(|a, b| b.without.value.total_cmp(&a.without.value));
        (errors, backspins, heights)
    }

    /// Gain in P if the standard deviation of an error is 10 % less.
    fn gain_of_a_tenth(
        &self,
        sample: &SharedSample,
        base: &MadeReleases,
        variable: ReleaseVariable,
    ) -> Difference {
        let own = sample.shares(base);
        let Some(steadier) = with_error_scaled(self.profile, variable, A_TENTH_LESS) else {
            return Difference::default();
        };
        let shares = self.shares_near(sample, base, &steadier, self.nominal);
        difference(&shares, &own)
    }

    /// The shares of a shot that is near a simulated one: from its shots, or from new ones if the
    /// two overlap too little.
    fn shares_near(
        &self,
        sample: &SharedSample,
        simulated: &MadeReleases,
        profile: &Profile,
        nominal: &Nominal,
    ) -> Vec<f64> {
        let distribution = ReleaseDistribution::new(profile, nominal);
        sample
            .shares_of_other(simulated, &distribution)
            .unwrap_or_else(|| {
                let shot = [(profile, *nominal)];
                let made = sample.simulate(self.profile.simulator(), &shot, &Silent);
                sample.shares(&made[0])
            })
    }

    /// Gain in P of a variant over `own`, at the best of a few speeds with which the shot is of the
    /// same kind, direct or bank; `None` if there is no such speed.
    fn gain_re_optimised(
        &self,
        sample: &SharedSample,
        made: &MadeReleases,
        variant: &Variant,
        own: &[f64],
    ) -> Option<Difference> {
        let Variant {
            profile, nominal, ..
        } = variant;
        let sigma = profile.shooter().dispersion.speed_m_s(nominal.speed_m_s);
        let fastest = fastest_m_s(profile);
        SPEEDS
            .iter()
            .map(|by| (nominal.speed_m_s + by * sigma).min(fastest))
            .map(|speed_m_s| nominal.with(NominalVariable::Speed, speed_m_s))
            .filter(|shot| ShotKind::of(profile, shot) == self.kind)
            .map(|shot| {
                let shares = if shot == *nominal {
                    sample.shares(made)
                } else {
                    self.shares_near(sample, made, profile, &shot)
                };
                difference(&shares, own)
            })
            .reduce(|best, next| if next.value > best.value { next } else { best })
    }
}

/// The greatest speed that the shooter can intend, m/s.
fn fastest_m_s(profile: &Profile) -> f64 {
    profile.search().speed_max_m_s.unwrap_or(f64::INFINITY)
}

/// A profile with the standard deviation of one error multiplied by `factor`, 0 to 1.
fn with_error_scaled(profile: &Profile, variable: ReleaseVariable, factor: f64) -> Option<Profile> {
    profile
        .with(|settings| {
            let dispersion = &mut settings.shooter.dispersion;
            *dispersion = dispersion.scaled(variable, factor);
        })
        .ok()
}

/// The ends of the window about the error-free shot along a variable.
fn window(profile: &Profile, nominal: &Nominal, variable: NominalVariable) -> Option<(f64, f64)> {
    let centre = nominal.get(variable);
    let is_made = |by: f64| {
        let shot = nominal.with(variable, centre + by);
        let start = profile.release(&shot).state();
        profile.simulator().verdict(start).made
    };
    if !is_made(0.0) {
        return None;
    }
    let (step, far) = ShotWindow::search_range(variable);
    let end = |sign: f64| {
        let mut inside = 0.0;
        while inside < far && is_made(sign * (inside + step)) {
            inside += step;
        }
        let mut outside = inside + step;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (inside + outside);
            if is_made(sign * middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        sign * inside
    };
    Some((centre + end(-1.0), centre + end(1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a shot whose backspin is fixed below the best one, the gain is that of its own backspin.
    #[test]
    fn contract_the_gain_from_backspin_is_that_of_the_shot() {
        let gain_of = |value: f64, gain: f64| Variation {
            value,
            gain: Difference {
                value: gain,
                standard_error: 0.001,
            },
        };
        let window = |variable| ShotWindow {
            variable,
            ends: None,
        };
        let sensitivity = Sensitivity {
            windows: ShotWindow::VARIABLES.map(window),
            errors: Vec::new(),
            backspins: vec![gain_of(0.0, -0.08), gain_of(9.0, 0.0), gain_of(18.0, 0.01)],
            heights: Vec::new(),
        };
        assert_eq!(sensitivity.backspin_gain().unwrap().value, 0.08);
    }
}
