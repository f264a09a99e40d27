//! Which releases are worth simulating from a place, and what that will cost.
//!
//! The bracket comes from geometry alone ([`Bracket`]): outside its speeds and polar angles no shot
//! can go in. Pitch and backspin are bracketed by what the shooter may intend, widened by
//! [`MARGIN_SIGMAS`] standard deviations of the errors; the normal mass beyond is bounded by
//! [`Plan::mass_outside`].

mod bracket;

pub use bracket::Bracket;

use crate::dynamics::Simulator;
use crate::probability::normal;
use crate::profile::{Grid, Nominal, Profile};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use serde::Serialize;

/// Standard deviations by which pitch and backspin are widened beyond the nominal values.
pub const MARGIN_SIGMAS: f64 = 4.5;
/// Least widening of the backspin, rad/s.
const LEAST_SPIN_MARGIN_RAD_S: f64 = 0.3;
/// Largest table that is built, in bytes.
pub const LARGEST_TABLE_BYTES: f64 = 2.0 * (1u64 << 30) as f64;
/// Most nominal speeds that are considered.
pub const MOST_NOMINAL_SPEEDS: usize = 400;

/// Evenly spaced values of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Number of cells; values are the cells' centres.
    pub count: usize,
}

impl Axis {
    /// Width of a cell.
    #[must_use]
    pub fn step(&self) -> f64 {
        (self.high - self.low) / self.count as f64
    }

    /// Centre of cell `i`.
    #[must_use]
    pub fn value(&self, i: usize) -> f64 {
        self.low + (i as f64 + 0.5) * self.step()
    }

    /// The centres of all cells.
    pub fn values(&self) -> impl Iterator<Item = f64> + use<> {
        let axis = *self;
        (0..axis.count).map(move |i| axis.value(i))
    }
}

/// What will be simulated from one place.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// The releases that can go in.
    pub bracket: Bracket,
    /// Table axis of the pitch angle, rad.
    pub pitch: Axis,
    /// Table axis of the polar angle, rad.
    pub polar: Axis,
    /// Table axis of the backspin, rad/s.
    pub backspin: Axis,
    /// Points on each line of speeds.
    pub speeds_per_line: usize,
    /// Nominal speeds, m/s.
    pub nominal_speed: Axis,
    /// Shots in the table.
    pub shots: u64,
    /// Peak memory of the table, bytes.
    pub memory_bytes: u64,
}

/// Why there is nothing to plan.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// The table does not fit.
    #[error(
        "grid: {points:.3e} points need {need_gib:.1} GiB of memory; at most {most_gib:.0} GiB are used, so take fewer points"
    )]
    TooLarge {
        /// Points of the table.
        points: f64,
        /// What they need.
        need_gib: f64,
        /// What is allowed.
        most_gib: f64,
    },
    /// No release within the limits reaches the hoop.
    #[error(
        "search: no release within the limits reaches the hoop from there; raise speed_max or pitch_max"
    )]
    OutOfReach,
}

/// Bytes that the table and its products need at their peak.
fn memory_bytes(grid: &Grid, nominal_speeds: usize) -> f64 {
    let lines = grid.pitch as f64 * grid.polar as f64 * grid.backspin as f64;
    2.0 * 8.0 * lines * nominal_speeds as f64
}

impl Plan {
    /// Plans the table for a profile's place and shooter.
    ///
    /// # Errors
    /// When the table would be too large, or no release reaches the hoop.
    pub fn new(profile: &Profile) -> Result<Self, PlanError> {
        let bracket = Bracket::new(profile).ok_or(PlanError::OutOfReach)?;
        let grid = profile.grid;
        let errors = &profile.shooter.errors;
        let search = &profile.search;
        let nominal_speed = nominal_speeds(profile, &bracket).ok_or(PlanError::OutOfReach)?;
        let memory = memory_bytes(&grid, nominal_speed.count);
        let points =
            grid.speed as f64 * grid.pitch as f64 * grid.polar as f64 * grid.backspin as f64;
        if !(memory <= LARGEST_TABLE_BYTES && points < 1e12) {
            let gib = (1u64 << 30) as f64;
            return Err(PlanError::TooLarge {
                points,
                need_gib: memory / gib,
                most_gib: LARGEST_TABLE_BYTES / gib,
            });
        }
        let pitch_margin = MARGIN_SIGMAS * errors.c20_rad;
        let top_spin = profile.shooter.max_backspin_rad_s;
        let spin_margin = MARGIN_SIGMAS * errors.backspin_rad_s(top_spin).max(errors.c40_rad_s);
        // Without spin and its error the axis would have no width.
        let spin_margin = spin_margin.max(LEAST_SPIN_MARGIN_RAD_S);
        let pitch = Axis {
            low: (search.pitch_min_rad - pitch_margin).max(-0.5 * std::f64::consts::PI),
            high: (search.pitch_max_rad + pitch_margin).min(0.5 * std::f64::consts::PI),
            count: grid.pitch,
        };
        let polar = Axis {
            low: bracket.polar_rad.0,
            high: bracket.polar_rad.1,
            count: grid.polar,
        };
        let backspin = Axis {
            low: -spin_margin,
            high: top_spin + spin_margin,
            count: grid.backspin,
        };
        Ok(Self {
            bracket,
            pitch,
            polar,
            backspin,
            speeds_per_line: grid.speed,
            nominal_speed,
            shots: points as u64,
            memory_bytes: memory as u64,
        })
    }

    /// Upper bound of the probability that the errors take this nominal shot outside the table's
    /// pitch angles and backspins, where shots are not simulated but could go in.
    #[must_use]
    pub fn mass_outside(&self, profile: &Profile, nominal: &Nominal) -> f64 {
        let errors = &profile.shooter.errors;
        let spin_sigma = errors.backspin_rad_s(nominal.backspin_rad_s);
        [
            (self.pitch, nominal.pitch_rad, errors.c20_rad),
            (self.backspin, nominal.backspin_rad_s, spin_sigma),
        ]
        .into_iter()
        .map(|(axis, centre, sigma)| {
            if sigma > 0.0 {
                normal::cdf((axis.low - centre) / sigma) + normal::cdf((centre - axis.high) / sigma)
            } else {
                0.0
            }
        })
        .sum()
    }
}

/// Nominal speeds: every speed of the bracket within the nominal pitch angles, about half a standard
/// deviation apart.
fn nominal_speeds(profile: &Profile, bracket: &Bracket) -> Option<Axis> {
    let search = &profile.search;
    let polar = 0.5 * (bracket.polar_rad.0 + bracket.polar_rad.1);
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    for i in 0..=70 {
        let part = f64::from(i) / 70.0;
        let pitch = search.pitch_min_rad + part * (search.pitch_max_rad - search.pitch_min_rad);
        for polar in [bracket.polar_rad.0, polar, bracket.polar_rad.1] {
            if let Some((least, most)) = bracket.speeds_m_s(pitch, polar) {
                low = low.min(least);
                high = high.max(most);
            }
        }
    }
    if !(low < high) {
        return None;
    }
    let sigma = profile.shooter.errors.speed_m_s(low);
    let step = (0.5 * sigma).clamp(0.01, 0.06);
    let count = ((high - low) / step).ceil() as usize;
    Some(Axis {
        low,
        high,
        count: count.clamp(10, MOST_NOMINAL_SPEEDS),
    })
}

/// A check of the bracket: shots outside it that went in nevertheless.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct WideSample {
    /// Shots drawn uniformly from a box wider than the bracket.
    pub drawn: u64,
    /// Those outside the bracket, all of which were simulated.
    pub outside: u64,
    /// Those of them that were made: 0 when the bracket loses nothing.
    pub made_outside: u64,
}

impl Plan {
    /// Draws `shots` uniformly from speeds of half to 1.3 times the bracket's, all its pitch angles
    /// and backspins, and 20 degrees more of polar angle on both sides, and simulates those outside
    /// the bracket.
    #[must_use]
    pub fn wide_sample(&self, profile: &Profile, simulator: &Simulator, shots: u64) -> WideSample {
        const BLOCK: u64 = 4096;
        let (polar_low, polar_high) = self.bracket.polar_rad;
        let room = 20.0 * crate::units::DEGREE_RAD;
        let speeds = (
            0.5 * self.nominal_speed.low,
            1.3 * self.bracket.speed_max_m_s,
        );
        let (outside, made_outside) = (0..shots.div_ceil(BLOCK))
            .into_par_iter()
            .map(|block| {
                let mut random = ChaCha12Rng::seed_from_u64(profile.search.seed);
                random.set_stream(block);
                let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
                let (mut outside, mut made) = (0, 0);
                for _ in 0..BLOCK.min(shots - block * BLOCK) {
                    let nominal = Nominal {
                        speed_m_s: between(speeds.0, speeds.1),
                        pitch_rad: between(self.pitch.low, self.pitch.high),
                        polar_rad: between(polar_low - room, polar_high + room),
                        backspin_rad_s: between(self.backspin.low, self.backspin.high),
                    };
                    let Nominal {
                        speed_m_s,
                        pitch_rad,
                        polar_rad,
                        ..
                    } = nominal;
                    if !self.bracket.contains(speed_m_s, pitch_rad, polar_rad) {
                        outside += 1;
                        made += u64::from(simulator.verdict(&profile.release(&nominal)).made);
                    }
                }
                (outside, made)
            })
            .reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        WideSample {
            drawn: shots,
            outside,
            made_outside,
        }
    }
}
