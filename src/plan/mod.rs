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
/// The same for all axes of a window, where the mass beyond, 3e-5 on each side for a nominal shot at an
/// end and far less for the others, does not matter.
const WINDOW_MARGIN_SIGMAS: f64 = 4.0;
/// Least widening of the backspin, rad/s.
const LEAST_SPIN_MARGIN_RAD_S: f64 = 0.3;
/// Largest table that is built, in bytes.
pub const LARGEST_TABLE_BYTES: f64 = 2.0 * (1u64 << 30) as f64;
/// Most nominal speeds that are considered.
pub const MOST_NOMINAL_SPEEDS: usize = 400;
/// A window's nominal values reach this many standard deviations from its centre.
const WINDOW_SIGMAS: f64 = 1.0;
/// Least reach of a window's nominal values: speed (m/s), angles (rad), backspin (rad/s).
const LEAST_WINDOW: [f64; 3] = [0.02, 0.005, 3.0];
/// Nominal values of a window along speed, pitch angle and polar angle, and along backspin.
const WINDOW_STATIONS: (usize, usize) = (31, 13);

/// Evenly spaced values of one axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Axis {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Number of cells.
    pub count: usize,
}

impl Axis {
    /// Width of a cell.
    #[must_use]
    pub fn step(&self) -> f64 {
        (self.high - self.low) / self.count as f64
    }

    /// The value in cell `i`, `shift` (0 to 1) of a cell from its lower end.
    #[must_use]
    pub fn value(&self, i: usize, shift: f64) -> f64 {
        self.low + (i as f64 + shift) * self.step()
    }

    /// A value in each cell, `shift` (0 to 1) of a cell from its lower end.
    pub fn values(&self, shift: f64) -> impl Iterator<Item = f64> + Clone + use<> {
        let axis = *self;
        (0..axis.count).map(move |i| axis.value(i, shift))
    }
}

/// Evenly spaced nominal values, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Stations {
    /// The first.
    pub low: f64,
    /// The last.
    pub high: f64,
    /// How many; one where the ends are the same.
    pub count: usize,
}

impl Stations {
    /// `count` values from `low` to `high`, two at least where these differ.
    #[must_use]
    pub fn new(low: f64, high: f64, count: usize) -> Self {
        let count = if low < high { count.max(2) } else { 1 };
        Self { low, high, count }
    }

    fn one(value: f64) -> Self {
        Self::new(value, value, 1)
    }

    /// All values.
    pub fn values(&self) -> impl Iterator<Item = f64> + Clone + use<> {
        let Self { low, high, count } = *self;
        let step = (high - low) / count.saturating_sub(1).max(1) as f64;
        (0..count).map(move |i| low + i as f64 * step)
    }
}

/// The nominal shots whose P a table gives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Nominals {
    /// Speeds, m/s.
    pub speed: Stations,
    /// Pitch angles, rad.
    pub pitch: Stations,
    /// Polar angles, rad.
    pub polar: Stations,
    /// Backspins, rad/s.
    pub backspin: Stations,
    /// Spin about the level direction of the shot, one for all, rad/s.
    pub rifle_spin_rad_s: f64,
    /// Spin about the vertical, one for all, rad/s.
    pub side_spin_rad_s: f64,
}

impl Nominals {
    /// Does a nominal shot lie at an end of an axis beyond which the `next` window would reach?
    #[must_use]
    pub fn is_at_edge(&self, nominal: &Nominal, next: &Self) -> bool {
        let at_edge = |x: f64, here: Stations, next: Stations| {
            let slack = 1e-6 * (here.high - here.low);
            let beyond = 0.25 * (here.high - here.low);
            (x <= here.low + slack && next.low < here.low - beyond)
                || (x >= here.high - slack && next.high > here.high + beyond)
        };
        at_edge(nominal.speed_m_s, self.speed, next.speed)
            || at_edge(nominal.pitch_rad, self.pitch, next.pitch)
            || at_edge(nominal.polar_rad, self.polar, next.polar)
            || at_edge(nominal.backspin_rad_s, self.backspin, next.backspin)
    }
}

/// One table of shots: what will be simulated from a place, and for which nominal shots.
///
/// [`Plan::new`] covers everything the shooter may intend, coarsely, to find where the good shots are;
/// [`Plan::around`] covers what the errors can lead to from the nominal shots about one of them, finely.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// The releases that can go in.
    pub bracket: Bracket,
    /// Table axis of the pitch angle, rad.
    pub pitch: Axis,
    /// Table axis of the polar angle, rad. Where `mirrored`, those on one side.
    pub polar: Axis,
    /// Table axis of the backspin, rad/s.
    pub backspin: Axis,
    /// Points on each line of speeds.
    pub speeds_per_line: usize,
    /// Least and greatest speed of the lines, m/s; each line's own bracket may be narrower.
    pub speed_m_s: (f64, f64),
    /// Straight in front of the hoop a shot and its mirror image have the same end, so one side is
    /// simulated for both.
    pub mirrored: bool,
    /// The nominal shots.
    pub nominal: Nominals,
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

fn about(centre: f64, margin: f64) -> (f64, f64) {
    (centre - margin, centre + margin)
}

/// Bytes that the table and its products need at their peak.
fn memory_bytes(grid: &Grid, nominal: &Nominals) -> f64 {
    let inner = nominal.backspin.count as f64 * nominal.speed.count as f64;
    let sums = grid.pitch as f64 * grid.polar as f64;
    let by_polar = grid.pitch as f64 * nominal.polar.count as f64;
    let values = nominal.pitch.count as f64 * nominal.polar.count as f64;
    8.0 * inner * (sums + by_polar).max(by_polar + values)
}

impl Plan {
    /// Plans the table of the search for a profile's place and shooter.
    ///
    /// # Errors
    /// When the table would be too large, or no release reaches the hoop.
    pub fn new(profile: &Profile) -> Result<Self, PlanError> {
        let held = profile.held();
        let side_spin_rad_s = if profile.search.choose.side_spin {
            0.0
        } else {
            held.side_spin_rad_s
        };
        Self::with_side_spin(profile, side_spin_rad_s)
    }

    /// As [`Plan::new`], for nominal shots with this spin about the vertical.
    ///
    /// # Errors
    /// As there.
    pub fn with_side_spin(profile: &Profile, side_spin_rad_s: f64) -> Result<Self, PlanError> {
        let bracket = Bracket::new(profile).ok_or(PlanError::OutOfReach)?;
        let grid = profile.grid.of_search();
        let errors = &profile.shooter.errors;
        let search = &profile.search;
        let choose = search.choose;
        let held = profile.held();
        let in_reach = nominal_speeds(profile, &bracket).ok_or(PlanError::OutOfReach)?;
        let (speed, speed_m_s) = if choose.speed {
            (in_reach, (0.0, bracket.speed_max_m_s))
        } else {
            let margin = MARGIN_SIGMAS * errors.speed_m_s(held.speed_m_s) + LEAST_WINDOW[0];
            (Stations::one(held.speed_m_s), about(held.speed_m_s, margin))
        };
        // A held value without an error would leave its axis no width.
        let least_margin = if search.choose.pitch {
            0.0
        } else {
            LEAST_WINDOW[1]
        };
        let pitch_margin = MARGIN_SIGMAS * errors.c20_rad + least_margin;
        let (low_spin, top_spin) = profile.backspins_rad_s();
        let spin_margin = MARGIN_SIGMAS
            * errors
                .backspin_rad_s(top_spin)
                .max(errors.backspin_rad_s(low_spin));
        // Without spin and its error the axis would have no width.
        let spin_margin = spin_margin.max(LEAST_SPIN_MARGIN_RAD_S);
        let right_angle = 0.5 * std::f64::consts::PI;
        let without_a_side = held.rifle_spin_rad_s == 0.0 && side_spin_rad_s == 0.0;
        let mirrored = profile.place.angle_rad == 0.0 && without_a_side && choose.polar;
        let (nominal_polar, polar) = if mirrored {
            let one_side = (0.0, bracket.polar_rad.1.max(-bracket.polar_rad.0));
            (Stations::new(one_side.0, one_side.1, grid.polar), one_side)
        } else if choose.polar {
            let (low, high) = bracket.polar_rad;
            (Stations::new(low, high, grid.polar), bracket.polar_rad)
        } else {
            let margin = MARGIN_SIGMAS * errors.c30_rad + LEAST_WINDOW[1];
            (Stations::one(held.polar_rad), about(held.polar_rad, margin))
        };
        let nominal = Nominals {
            speed,
            pitch: Stations::new(search.pitch_min_rad, search.pitch_max_rad, grid.pitch),
            polar: nominal_polar,
            backspin: Stations::new(low_spin, top_spin, grid.backspin),
            rifle_spin_rad_s: held.rifle_spin_rad_s,
            side_spin_rad_s,
        };
        Self {
            pitch: Axis {
                low: (search.pitch_min_rad - pitch_margin).max(-right_angle),
                high: (search.pitch_max_rad + pitch_margin).min(right_angle),
                count: grid.pitch,
            },
            polar: Axis {
                low: polar.0,
                high: polar.1,
                count: grid.polar,
            },
            backspin: Axis {
                low: low_spin - spin_margin,
                high: top_spin + spin_margin,
                count: grid.backspin,
            },
            speeds_per_line: grid.speed,
            speed_m_s,
            mirrored,
            nominal,
            bracket,
            shots: 0,
            memory_bytes: 0,
        }
        .counted(&grid)
    }

    /// Plans a window about a nominal shot: all that the errors can lead to from nominal shots within
    /// a standard deviation of it, on the points of the profile's grid.
    ///
    /// # Errors
    /// When the table would be too large.
    pub fn around(&self, profile: &Profile, centre: &Nominal) -> Result<Self, PlanError> {
        let errors = &profile.shooter.errors;
        let search = &profile.search;
        let grid = profile.grid;
        let (most, most_spins) = WINDOW_STATIONS;
        let window = |centre: f64, sigma: f64, least: f64, (low, high): (f64, f64), count| {
            let reach = (WINDOW_SIGMAS * sigma).max(least);
            let nominal = Stations::new(
                (centre - reach).clamp(low, high),
                (centre + reach).clamp(low, high),
                count,
            );
            let margin = WINDOW_MARGIN_SIGMAS * sigma;
            (nominal, (nominal.low - margin, nominal.high + margin))
        };
        let [least_speed, least_angle, least_spin] = LEAST_WINDOW;
        let choose = search.choose;
        let range =
            |chosen: bool, all: (f64, f64), held: f64| if chosen { all } else { (held, held) };
        let (speed, speed_m_s) = window(
            centre.speed_m_s,
            errors.speed_m_s(centre.speed_m_s),
            least_speed,
            range(
                choose.speed,
                (0.1, self.bracket.speed_max_m_s),
                centre.speed_m_s,
            ),
            most,
        );
        let (pitch, pitch_rad) = window(
            centre.pitch_rad,
            errors.c20_rad,
            least_angle,
            (search.pitch_min_rad, search.pitch_max_rad),
            most,
        );
        let (mut polar, mut polar_rad) = window(
            centre.polar_rad,
            errors.c30_rad,
            least_angle,
            range(choose.polar, self.bracket.polar_rad, centre.polar_rad),
            most,
        );
        let without_a_side = centre.rifle_spin_rad_s == 0.0 && centre.side_spin_rad_s == 0.0;
        let mirrored = self.mirrored && without_a_side && polar_rad.0 < 0.0 && polar_rad.1 > 0.0;
        if mirrored {
            polar = Stations::new(0.0, polar.high.max(-polar.low), most);
            polar_rad = (0.0, polar_rad.1.max(-polar_rad.0));
        }
        let (backspin, spin_rad_s) = window(
            centre.backspin_rad_s,
            errors.backspin_rad_s(centre.backspin_rad_s),
            least_spin,
            profile.backspins_rad_s(),
            most_spins,
        );
        let axis = |(low, high): (f64, f64), all: (f64, f64), count, least: f64| {
            let (low, high) = (low.max(all.0), high.min(all.1));
            let widen = (least - 0.5 * (high - low)).max(0.0);
            Axis {
                low: low - widen,
                high: high + widen,
                count,
            }
        };
        Self {
            pitch: axis(
                pitch_rad,
                (self.pitch.low, self.pitch.high),
                grid.pitch,
                0.5 * least_angle,
            ),
            polar: axis(
                polar_rad,
                self.bracket.polar_rad,
                grid.polar,
                0.5 * least_angle,
            ),
            backspin: axis(
                spin_rad_s,
                (f64::NEG_INFINITY, f64::INFINITY),
                grid.backspin,
                LEAST_SPIN_MARGIN_RAD_S,
            ),
            speeds_per_line: grid.speed,
            speed_m_s: if choose.speed {
                speed_m_s
            } else {
                about(
                    centre.speed_m_s,
                    0.5 * (speed_m_s.1 - speed_m_s.0) + least_speed,
                )
            },
            mirrored,
            nominal: Nominals {
                speed,
                pitch,
                polar,
                backspin,
                rifle_spin_rad_s: centre.rifle_spin_rad_s,
                side_spin_rad_s: centre.side_spin_rad_s,
            },
            bracket: self.bracket.clone(),
            shots: 0,
            memory_bytes: 0,
        }
        .counted(&grid)
    }

    /// With the numbers of shots and bytes, if they are not too large.
    fn counted(self, grid: &Grid) -> Result<Self, PlanError> {
        let memory = memory_bytes(grid, &self.nominal);
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
        Ok(Self {
            shots: points as u64,
            memory_bytes: memory as u64,
            ..self
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
fn nominal_speeds(profile: &Profile, bracket: &Bracket) -> Option<Stations> {
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
    Some(Stations::new(
        low,
        high,
        count.clamp(10, MOST_NOMINAL_SPEEDS),
    ))
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
            0.5 * self.nominal.speed.low,
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
                        ..Nominal::default()
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
