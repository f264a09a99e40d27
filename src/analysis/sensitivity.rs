//! How P depends on the errors of the shooter, on backspin and on the height of the release, and how wide the
//! windows of a shot are.
//!
//! Every comparison is between two shots, or two shooters, under the same Sobol points. Each scramble gives a
//! difference, and the scatter of these gives its standard error.

use super::aim_past_hoop::with_same_aim;
use crate::math::sobol::ScrambleKey;
use crate::probability::{Progress, REPLICATES, Sampler};
use crate::shooter::{Nominal, NominalVariable, Profile, ReleaseVariable, ShotKind};
use crate::units::FOOT_M;
use rayon::prelude::*;
use serde::Serialize;

/// Points of each scramble.
const POINTS: u32 = 512;
/// Scrambles with which the speeds of a re-optimised shot are compared.
const OPTIMISATION_SCRAMBLES: usize = 4;
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShotWindow {
    /// The variable.
    pub variable: NominalVariable,
    /// Lowest and highest value, SI units; `None` if the error-free shot is missed, or was not computed.
    pub ends: Option<(f64, f64)>,
}

impl ShotWindow {
    /// The variables that have a window.
    pub const VARIABLES: [NominalVariable; 3] = [
        NominalVariable::Speed,
        NominalVariable::Pitch,
        NominalVariable::Polar,
    ];

    /// Its width, SI units; 0 if there is none.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.ends.map_or(0.0, |(low, high)| high - low)
    }

    /// First step and far end of the search for an end of the window, SI units.
    fn search_range(variable: NominalVariable) -> (f64, f64) {
        match variable {
            NominalVariable::Speed => (0.002, 2.0),
            _ => (0.000_5, 0.35),
        }
    }
}

/// What one error costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorCost {
    /// The variable with the error.
    pub variable: ReleaseVariable,
    /// Gain in P without the error.
    pub without: Difference,
    /// Gain in P with a standard deviation 10 % less.
    pub a_tenth_less: Difference,
}

/// The gain in P of a changed shot, its speed re-optimised among shots of the same kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Variation {
    /// The changed value, SI units: backspin, or height of the release.
    pub value: f64,
    /// Gain in P.
    pub gain: Difference,
}

/// How P depends on the errors, backspin and height.
#[derive(Clone, Debug, PartialEq, Serialize)]
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
    /// Gain in P of the best backspin over none.
    #[must_use]
    pub fn backspin_gain(&self) -> Option<Difference> {
        let none = self.backspins.first()?;
        let best = self
            .backspins
            .iter()
            .max_by(|a, b| a.gain.value.total_cmp(&b.gain.value))?;
        Some(Difference {
            value: best.gain.value - none.gain.value,
            standard_error: libm::hypot(none.gain.standard_error, best.gain.standard_error),
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
}

impl SensitivityTopics {
    /// Everything.
    pub const ALL: Self = Self {
        windows: true,
        errors: true,
        backspin: true,
        height: true,
    };
    /// Nothing.
    pub const NONE: Self = Self {
        windows: false,
        errors: false,
        backspin: false,
        height: false,
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
    let analysis = Analysis {
        profile,
        nominal,
        means: if topics.needs_probability() {
            means(profile, nominal, REPLICATES as usize)
        } else {
            Vec::new()
        },
        progress,
    };
    let has_backspin = profile.shooter().max_backspin_rad_s > 0.0;
    let backspins = if topics.backspin && has_backspin {
        BACKSPINS
    } else {
        0
    };
    let heights = if topics.height { HEIGHTS_M.len() } else { 0 };
    let total = ReleaseVariable::COUNT + backspins + heights;
    progress.begin("comparing", total as u64);
    let sensitivity = Sensitivity {
        errors: if topics.errors {
            analysis.errors()
        } else {
            Vec::new()
        },
        backspins: analysis.backspins(backspins),
        heights: analysis.heights(&HEIGHTS_M[..heights]),
        windows: ShotWindow::VARIABLES.map(|variable| ShotWindow {
            variable,
            ends: topics.windows.then(|| analysis.window(variable)).flatten(),
        }),
    };
    progress.end();
    sensitivity
}

/// The share of made shots under each of the first `scrambles`.
fn means(profile: &Profile, nominal: &Nominal, scrambles: usize) -> Vec<f64> {
    let sampler = Sampler::new(profile);
    (0..scrambles as u64)
        .into_par_iter()
        .map(|replicate| {
            let scramble = sampler.scramble(ScrambleKey {
                seed: profile.search().seed,
                replicate,
            });
            let counts = sampler.count(nominal, &scramble, (0, POINTS));
            counts.made() as f64 / f64::from(POINTS)
        })
        .collect()
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

struct Analysis<'a> {
    profile: &'a Profile,
    nominal: &'a Nominal,
    /// The share of made shots of the nominal shot under each scramble.
    means: Vec<f64>,
    progress: &'a dyn Progress,
}

impl Analysis<'_> {
    /// The errors of the shooter, the costliest first.
    fn errors(&self) -> Vec<ErrorCost> {
        let sigmas = self.profile.shooter().dispersion.sigmas(self.nominal);
        let mut costs: Vec<ErrorCost> = ReleaseVariable::ALL
            .into_iter()
            .filter(|variable| sigmas[variable.index()] > 0.0)
            .filter_map(|variable| {
                self.progress.advance(1);
                Some(ErrorCost {
                    variable,
                    without: self.gain_with_error_scaled(variable, 0.0)?,
                    a_tenth_less: self.gain_with_error_scaled(variable, A_TENTH_LESS)?,
                })
            })
            .collect();
        costs.sort_by(|a, b| b.without.value.total_cmp(&a.without.value));
        costs
    }

    /// Evenly spaced backspins from none to the shooter's limit. (They do not change the kind of the shot.)
    fn backspins(&self, count: usize) -> Vec<Variation> {
        let most = self.profile.shooter().max_backspin_rad_s;
        (0..count)
            .filter_map(|i| {
                self.progress.advance(1);
                let value = most * i as f64 / (BACKSPINS - 1) as f64;
                let shot = self.nominal.with(NominalVariable::Backspin, value);
                let gain = self.gain_re_optimised(self.profile, &shot)?;
                Some(Variation { value, gain })
            })
            .collect()
    }

    /// Heights of release that are possible.
    fn heights(&self, changes_m: &[f64]) -> Vec<Variation> {
        changes_m
            .iter()
            .filter_map(|by| {
                self.progress.advance(1);
                let other = self
                    .profile
                    .with(|settings| settings.shooter.release_height_m += by)
                    .ok()?;
                let shot = with_same_aim(self.profile, &other, self.nominal);
                Some(Variation {
                    value: other.shooter().release_height_m,
                    gain: self.gain_re_optimised(&other, &shot)?,
                })
            })
            .collect()
    }

    /// Gain in P if the standard deviation of one error is multiplied by `factor`, 0 to 1.
    fn gain_with_error_scaled(&self, variable: ReleaseVariable, factor: f64) -> Option<Difference> {
        let other = self
            .profile
            .with(|settings| {
                let dispersion = &mut settings.shooter.dispersion;
                *dispersion = dispersion.scaled(variable, factor);
            })
            .ok()?;
        Some(self.gain(&other, self.nominal))
    }

    /// Gain in P of another profile or shot.
    fn gain(&self, profile: &Profile, shot: &Nominal) -> Difference {
        let other = means(profile, shot, self.means.len());
        difference(&other, &self.means)
    }

    /// Gain in P of another profile or shot, at the best of a few speeds with which the shot is of the same kind,
    /// direct or bank; `None` if there is no such speed.
    fn gain_re_optimised(&self, profile: &Profile, shot: &Nominal) -> Option<Difference> {
        let kind = ShotKind::of(self.profile, self.nominal);
        let sigma = profile.shooter().dispersion.speed_m_s(shot.speed_m_s);
        let best = SPEEDS
            .iter()
            .map(|by| shot.with(NominalVariable::Speed, shot.speed_m_s + by * sigma))
            .filter(|shot| ShotKind::of(profile, shot) == kind)
            .map(|shot| {
                let made: f64 = means(profile, &shot, OPTIMISATION_SCRAMBLES).iter().sum();
                (made, shot)
            })
            .reduce(|best, next| if next.0 > best.0 { next } else { best });
        best.map(|(_, shot)| self.gain(profile, &shot))
    }

    /// The ends of the window about the error-free shot along a variable.
    fn window(&self, variable: NominalVariable) -> Option<(f64, f64)> {
        let centre = self.nominal.get(variable);
        let is_made = |by: f64| {
            let shot = self.nominal.with(variable, centre + by);
            let start = self.profile.release(&shot).state();
            self.profile.simulator().verdict(start).made
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
}
