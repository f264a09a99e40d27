//! What a shooter learns from a best shot: how wide its windows are, which of the errors costs most, and
//! what spin and the height of the release are worth.
//!
//! Every comparison is between two shots, or two shooters, under the same Sobol points: each of the
//! scrambles gives a difference, and their scatter is its standard error.

use super::Progress;
use super::estimate::{REPLICATES, Sampler};
use super::sobol::Key;
use crate::dynamics::Simulator;
use crate::physics::FOOT_M;
use crate::profile::{ERROR_NAMES, ERRORS, Nominal, Profile};
use rayon::prelude::*;
use serde::Serialize;

/// Points of each scramble.
const POINTS: u32 = 512;
/// Scrambles by which the speeds of a shot that is aimed anew are compared.
const AIMING: usize = 4;
/// Spins that are tried, from none to the shooter's limit.
const SPINS: usize = 5;
/// Heights of release that are tried, m from the shooter's own.
const HEIGHTS_M: [f64; 4] = [-0.5 * FOOT_M, -0.25 * FOOT_M, 0.25 * FOOT_M, 0.5 * FOOT_M];
/// Speeds tried about a shot that is aimed anew, in standard deviations of the speed.
const SPEEDS: [f64; 5] = [-0.5, -0.25, 0.0, 0.25, 0.5];
/// First steps and far ends of the search for the ends of a window: speed (m/s) and angles (rad).
const WINDOW_STEPS: [f64; 3] = [0.002, 0.000_5, 0.000_5];
const WINDOW_ENDS: [f64; 3] = [2.0, 0.35, 0.35];
/// Halvings that find the end of a window within a step.
const HALVINGS: u32 = 12;

/// A difference of two probabilities with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Difference {
    /// The difference.
    pub by: f64,
    /// Its standard error.
    pub standard_error: f64,
}

/// Values between which the error-free shot is made, all others held.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Window {
    /// Lowest and highest value, SI units; none where the error-free shot is missed.
    pub ends: Option<(f64, f64)>,
}

impl Window {
    /// Its width, SI units; 0 where the error-free shot is missed.
    #[must_use]
    pub fn width(&self) -> f64 {
        self.ends.map_or(0.0, |(low, high)| high - low)
    }
}

/// What one error costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cost {
    /// Name of the error, as in the profile.
    pub error: &'static str,
    /// What P would gain without it.
    pub without: Difference,
    /// What P would gain if its standard deviation were 10 % less.
    pub a_tenth_less: Difference,
}

/// P of a shot aimed anew after one thing was changed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Changed {
    /// The changed value, SI units: backspin, or height of the release.
    pub value: f64,
    /// What P gains by the change.
    pub gain: Difference,
}

/// What a shooter learns from one shot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lessons {
    /// Windows in speed, pitch angle and polar angle.
    pub windows: [Window; 3],
    /// The errors that are there, the costliest first.
    pub costs: Vec<Cost>,
    /// Backspin from 0 to the shooter's limit, speed aimed anew, against the shot's own.
    pub spins: Vec<Changed>,
    /// Heights of release, speed aimed anew, against the shooter's own.
    pub heights: Vec<Changed>,
}

impl Lessons {
    /// What the most gainful backspin gains over none.
    #[must_use]
    pub fn spin_is_worth(&self) -> Option<Difference> {
        let none = self.spins.first()?;
        let best = self
            .spins
            .iter()
            .max_by(|a, b| a.gain.by.total_cmp(&b.gain.by))?;
        Some(Difference {
            by: best.gain.by - none.gain.by,
            standard_error: libm::hypot(none.gain.standard_error, best.gain.standard_error),
        })
    }
}

/// Which lessons are drawn; the others stay empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Topics {
    /// The windows.
    pub windows: bool,
    /// What each error costs.
    pub costs: bool,
    /// What spin is worth.
    pub spins: bool,
    /// What height is worth.
    pub heights: bool,
}

impl Topics {
    /// Everything.
    pub const ALL: Self = Self {
        windows: true,
        costs: true,
        spins: true,
        heights: true,
    };
    /// Nothing.
    pub const NONE: Self = Self {
        windows: false,
        costs: false,
        spins: false,
        heights: false,
    };
}

/// Draws the lessons of some topics from a nominal shot.
#[must_use]
pub fn draw(
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    topics: Topics,
    progress: &dyn Progress,
) -> Lessons {
    let teacher = Teacher {
        profile,
        simulator,
        own: if topics.costs || topics.spins || topics.heights {
            means(profile, simulator, nominal, REPLICATES as usize)
        } else {
            Vec::new()
        },
    };
    let present =
        (0..ERRORS).filter(|&k| topics.costs && profile.shooter.errors.sigmas(nominal)[k] > 0.0);
    let heights_m: &[f64] = if topics.heights { &HEIGHTS_M } else { &[] };
    let top = profile.shooter.max_backspin_rad_s;
    let spins = if topics.spins && top > 0.0 { SPINS } else { 0 };
    progress.begin("comparing", (ERRORS + spins + heights_m.len()) as u64);
    let mut costs: Vec<Cost> = present
        .map(|k| {
            progress.advance(1);
            Cost {
                error: ERROR_NAMES[k],
                without: teacher.with_error(nominal, k, 0.0),
                a_tenth_less: teacher.with_error(nominal, k, 0.9),
            }
        })
        .collect();
    costs.sort_by(|a, b| b.without.by.total_cmp(&a.without.by));
    let spins = (0..spins)
        .map(|i| {
            progress.advance(1);
            let value = top * i as f64 / (SPINS - 1) as f64;
            let shot = Nominal {
                backspin_rad_s: value,
                ..*nominal
            };
            Changed {
                value,
                gain: teacher.aimed_anew(profile, &shot),
            }
        })
        .collect();
    let heights = heights_m
        .iter()
        .map(|by| {
            progress.advance(1);
            let mut other = profile.clone();
            other.shooter.release_height_m += by;
            let shot = with_the_same_aim(profile, &other, nominal);
            Changed {
                value: other.shooter.release_height_m,
                gain: teacher.aimed_anew(&other, &shot),
            }
        })
        .collect();
    progress.end();
    Lessons {
        windows: std::array::from_fn(|axis| {
            if topics.windows {
                teacher.window(nominal, axis)
            } else {
                Window { ends: None }
            }
        }),
        costs,
        spins,
        heights,
    }
}

/// The part of the shots made under each of the first `scrambles`.
fn means(
    profile: &Profile,
    simulator: &Simulator,
    nominal: &Nominal,
    scrambles: usize,
) -> Vec<f64> {
    let sampler = Sampler::new(profile, simulator);
    (0..scrambles as u64)
        .into_par_iter()
        .map(|replicate| {
            let scramble = sampler.scramble(Key {
                seed: profile.search.seed,
                replicate,
            });
            let counts = sampler.count(nominal, &scramble, (0, POINTS));
            counts.made() as f64 / f64::from(POINTS)
        })
        .collect()
}

fn difference(a: &[f64], b: &[f64]) -> Difference {
    let n = a.len() as f64;
    let by = a.iter().zip(b).map(|(a, b)| a - b).sum::<f64>() / n;
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b - by).powi(2)).sum();
    Difference {
        by,
        standard_error: (square / (n * (n - 1.0))).sqrt(),
    }
}

struct Teacher<'a> {
    profile: &'a Profile,
    simulator: &'a Simulator,
    own: Vec<f64>,
}

impl Teacher<'_> {
    /// What P gains when one error is `times` as large.
    fn with_error(&self, nominal: &Nominal, error: usize, times: f64) -> Difference {
        let mut other = self.profile.clone();
        other.shooter.errors.scale(error, times);
        self.gain(&other, nominal)
    }

    /// What P gains with another profile or shot.
    fn gain(&self, profile: &Profile, shot: &Nominal) -> Difference {
        let other = means(profile, self.simulator, shot, self.own.len());
        difference(&other, &self.own)
    }

    /// What P gains with another profile or shot, at the best of a few speeds.
    fn aimed_anew(&self, profile: &Profile, shot: &Nominal) -> Difference {
        let sigma = profile.shooter.errors.speed_m_s(shot.speed_m_s);
        let aimed = SPEEDS
            .iter()
            .map(|by| Nominal {
                speed_m_s: shot.speed_m_s + by * sigma,
                ..*shot
            })
            .map(|shot| {
                let made: f64 = means(profile, self.simulator, &shot, AIMING).iter().sum();
                (made, shot)
            })
            .reduce(|best, next| if next.0 > best.0 { next } else { best });
        self.gain(profile, &aimed.map_or(*shot, |(_, shot)| shot))
    }

    /// The window about the error-free shot along speed, pitch angle or polar angle.
    fn window(&self, nominal: &Nominal, axis: usize) -> Window {
        let made = |by: f64| {
            let mut shot = *nominal;
            *value(&mut shot, axis) += by;
            self.simulator.verdict(&self.profile.release(&shot)).made
        };
        if !made(0.0) {
            return Window { ends: None };
        }
        let end = |sign: f64| {
            let (step, far) = (WINDOW_STEPS[axis], WINDOW_ENDS[axis]);
            let mut inside = 0.0;
            while inside < far && made(sign * (inside + step)) {
                inside += step;
            }
            let mut outside = inside + step;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inside + outside);
                if made(sign * middle) {
                    inside = middle;
                } else {
                    outside = middle;
                }
            }
            sign * inside
        };
        let mut shot = *nominal;
        let centre = *value(&mut shot, axis);
        Window {
            ends: Some((centre + end(-1.0), centre + end(1.0))),
        }
    }
}

fn value(nominal: &mut Nominal, axis: usize) -> &mut f64 {
    match axis {
        0 => &mut nominal.speed_m_s,
        1 => &mut nominal.pitch_rad,
        _ => &mut nominal.polar_rad,
    }
}

/// The shot from another height that passes the plane of the hoop at the same place, by its parabola.
fn with_the_same_aim(profile: &Profile, other: &Profile, nominal: &Nominal) -> Nominal {
    let (sin, cos) = libm::sincos(nominal.pitch_rad);
    let g = profile.physics.gravity_m_s2;
    let up = nominal.speed_m_s * sin;
    let square = up * up + 2.0 * g * profile.height_above_hoop_m();
    let length = nominal.speed_m_s * cos * (up + square.max(0.0).sqrt()) / g;
    let over = other.height_above_hoop_m() + length * sin / cos;
    if !(over > 0.0) {
        return *nominal;
    }
    Nominal {
        speed_m_s: length / cos * (0.5 * g / over).sqrt(),
        ..*nominal
    }
}
