//! What a table of shots will simulate, and for which nominal shots.

use super::geometric_bounds::Bracket;
use super::nominal_grid::NominalGrid;
use crate::math::evenly_spaced::{CellAxis, Linspace};
use crate::math::normal_distribution;
use crate::shooter::{Nominal, NominalVariable, Profile, TableGrid};
use crate::units::FOOT_M;
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;

/// Standard deviations by which pitch and backspin are widened beyond the nominal values.
pub const MARGIN_SIGMAS: f64 = 4.5;
/// Standard deviations on every axis of a window. The probability beyond, 3e-5 on each side for a
/// nominal shot
/// at an end and far less for the others, does not matter.
const WINDOW_MARGIN_SIGMAS: f64 = 4.0;
/// Least margin of the backspin, rad/s.
const MIN_SPIN_MARGIN_RAD_S: f64 = 0.3;
/// Largest table, bytes.
const MAX_TABLE_BYTES: f64 = 2.0 * (1u64 << 30) as f64;
/// Largest table, points.
const MAX_TABLE_POINTS: f64 = 1e12;
/// Most nominal speeds.
const MAX_NOMINAL_SPEEDS: usize = 400;
/// The nominal values of a window reach this many standard deviations from its centre.
const WINDOW_SIGMAS: f64 = 1.0;
/// Least reach of the nominal values of a window: speed (m/s), angles (rad), backspin (rad/s).
const MIN_WINDOW_SPEED_M_S: f64 = 0.02;
const MIN_WINDOW_ANGLE_RAD: f64 = 0.005;
const MIN_WINDOW_SPIN_RAD_S: f64 = 3.0;
/// Nominal values of a window along speed, pitch angle and polar angle, and along backspin.
const WINDOW_POINTS: usize = 31;
const WINDOW_SPIN_POINTS: usize = 13;

/// A range of values, low and high.
type Range = (f64, f64);

/// The plan of a table of shots.
///
/// [`TablePlan::for_search`] covers everything the shooter can intend, coarsely, to find where the
/// good shots are. [`TablePlan::window`] covers what the errors can lead to from the nominal shots
/// about one of them, finely.
#[derive(Clone, Debug, Serialize)]
pub struct TablePlan {
    /// The releases that can go in.
    pub bracket: Bracket,
    /// Axis of the pitch angle, rad.
    pub pitch: CellAxis,
    /// Axis of the polar angle, rad. If `mirrored`, the angles on one side.
    pub polar: CellAxis,
    /// Axis of the backspin, rad/s.
    pub backspin: CellAxis,
    /// Speeds on each line.
    pub speeds_per_line: usize,
    /// Least and greatest speed of the lines, m/s. The bracket can make a line shorter.
    pub speed_m_s: Range,
    /// Straight in front of the hoop a shot and its mirror image end alike, so one side is
    /// simulated for both.
    pub mirrored: bool,
    /// The nominal shots.
    pub nominal: NominalGrid,
    /// Shots in the table.
    pub shots: u64,
    /// Peak memory of the table, bytes.
    pub memory_bytes: u64,
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// The table is too large.
    #[error(
        "grid: {points:.3e} points need {need_gib:.1} GiB of memory; at most {most_gib:.0} GiB are used, so take fewer points"
    )]
    TooLarge {
        /// Points of the table.
        points: f64,
        /// Memory that they need, GiB.
        need_gib: f64,
        /// Memory that is allowed, GiB.
        most_gib: f64,
    },
    /// No release within the limits reaches the hoop.
    #[error(
        "search: no release within the limits reaches the hoop from there; raise speed_max{}, or allow other pitch angles (pitch_min, pitch_max, a fixed pitch)", in_words(*.least_speed_m_s)
    )]
    OutOfReach {
        /// The least speed that reaches it at the allowed pitch angles, if one does, m/s.
        least_speed_m_s: Option<f64>,
    },
}

/// The least speed that would reach the hoop, for a message without units of its own.
fn in_words(least_speed_m_s: Option<f64>) -> String {
    least_speed_m_s.map_or_else(String::new, |speed| {
        format!(
            " (a ball touches the hoop from {speed:.1} m/s, {:.1} ft/s, on)",
            speed / FOOT_M
        )
    })
}

/// Why no release within the limits of a profile reaches the hoop.
fn out_of_reach(profile: &Profile) -> PlanError {
    let unlimited = profile.with(|settings| settings.search.speed_max_m_s = None);
    let least_speed_m_s = unlimited.ok().and_then(|unlimited| {
        let speeds = nominal_speeds(&unlimited, &Bracket::new(&unlimited)?)?;
        speeds.values().next()
    });
    PlanError::OutOfReach { least_speed_m_s }
}

fn around(centre: f64, margin: f64) -> Range {
    (centre - margin, centre + margin)
}

/// Peak memory of a table and its products, bytes.
fn memory_bytes(grid: &TableGrid, nominal: &NominalGrid) -> f64 {
    let inner = nominal.backspin.count as f64 * nominal.speed.count as f64;
    let sums = grid.pitch as f64 * grid.polar as f64;
    let by_polar = grid.pitch as f64 * nominal.polar.count as f64;
    let values = nominal.pitch.count as f64 * nominal.polar.count as f64;
    8.0 * inner * (sums + by_polar).max(by_polar + values)
}

impl TablePlan {
    /// The table of the search of a profile.
    ///
    /// # Errors
    /// The table would be too large, or no release reaches the hoop.
    pub fn for_search(profile: &Profile) -> Result<Self, PlanError> {
        let searches_side_spin = profile.search().choice.includes(NominalVariable::SideSpin);
        let side_spin_rad_s = if searches_side_spin {
            0.0
        } else {
            profile.fixed_nominal().side_spin_rad_s
        };
        Self::for_search_with_side_spin(profile, side_spin_rad_s)
    }

    /// As [`TablePlan::for_search`], for nominal shots with this spin about the vertical.
    ///
    /// # Errors
    /// As there.
    pub fn for_search_with_side_spin(
        profile: &Profile,
        side_spin_rad_s: f64,
    ) -> Result<Self, PlanError> {
        let bracket = Bracket::new(profile).ok_or_else(|| out_of_reach(profile))?;
        let grid = profile.grid().of_search();
        let search = profile.search();
        let fixed = profile.fixed_nominal();
        let (nominal_speed, speed_m_s) = search_speeds(profile, &bracket)?;
        let (low_spin, high_spin) = profile.backspin_range_rad_s();
        let rotates_sideways = fixed.rifle_spin_rad_s != 0.0 || side_spin_rad_s != 0.0;
        let mirrored = profile.location().angle_rad == 0.0
            && !rotates_sideways
            && search.choice.includes(NominalVariable::Polar);
        let (nominal_polar, polar) = search_polar_angles(profile, &bracket, mirrored);
        let nominal = NominalGrid {
            speed: nominal_speed,
            pitch: Linspace::new(search.pitch_min_rad, search.pitch_max_rad, grid.pitch),
            polar: nominal_polar,
            backspin: Linspace::new(low_spin, high_spin, grid.backspin),
            rifle_spin_rad_s: fixed.rifle_spin_rad_s,
            side_spin_rad_s,
        };
        let (pitch_margin, spin_margin) = search_margins(profile);
        let axis = |(low, high): Range, count| CellAxis { low, high, count };
        Self {
            pitch: axis(
                (
                    (search.pitch_min_rad - pitch_margin).max(-FRAC_PI_2),
                    (search.pitch_max_rad + pitch_margin).min(FRAC_PI_2),
                ),
                grid.pitch,
            ),
            polar: axis(polar, grid.polar),
            backspin: axis(
                (low_spin - spin_margin, high_spin + spin_margin),
                grid.backspin,
            ),
            speeds_per_line: grid.speed,
            speed_m_s,
            mirrored,
            nominal,
            bracket,
            shots: 0,
            memory_bytes: 0,
        }
        .with_size(&grid)
    }

    /// A window about a nominal shot: all that the errors can lead to from nominal shots within a
    /// standard deviation of it, on the points of the profile's grid.
    ///
    /// # Errors
    /// The table would be too large.
    pub fn window(&self, profile: &Profile, centre: &Nominal) -> Result<Self, PlanError> {
        let dispersion = &profile.shooter().dispersion;
        let search = profile.search();
        let grid = profile.grid();
        let range = |variable, searched: Range| {
            if search.choice.includes(variable) {
                searched
            } else {
                let value = centre.get(variable);
                (value, value)
            }
        };
        let speed = WindowAxis {
            centre: centre.speed_m_s,
            sigma: dispersion.speed_m_s(centre.speed_m_s),
            min_reach: MIN_WINDOW_SPEED_M_S,
            range: range(NominalVariable::Speed, (0.1, self.bracket.speed_max_m_s)),
            points: WINDOW_POINTS,
        };
        let pitch = WindowAxis {
            centre: centre.pitch_rad,
            sigma: dispersion.c20_rad,
            min_reach: MIN_WINDOW_ANGLE_RAD,
            range: (search.pitch_min_rad, search.pitch_max_rad),
            points: WINDOW_POINTS,
        };
        let polar = WindowAxis {
            centre: centre.polar_rad,
            sigma: dispersion.c30_rad,
            min_reach: MIN_WINDOW_ANGLE_RAD,
            range: range(NominalVariable::Polar, self.bracket.polar_rad),
            points: WINDOW_POINTS,
        };
        let backspin = WindowAxis {
            centre: centre.backspin_rad_s,
            sigma: dispersion.backspin_rad_s(centre.backspin_rad_s),
            min_reach: MIN_WINDOW_SPIN_RAD_S,
            range: profile.backspin_range_rad_s(),
            points: WINDOW_SPIN_POINTS,
        };
        let speed_m_s = if search.choice.includes(NominalVariable::Speed) {
            speed.cells()
        } else {
            let (low, high) = speed.cells();
            around(centre.speed_m_s, 0.5 * (high - low) + MIN_WINDOW_SPEED_M_S)
        };
        let (mut nominal_polar, mut polar_rad) = (polar.nominal(), polar.cells());
        let rotates_sideways = centre.rifle_spin_rad_s != 0.0 || centre.side_spin_rad_s != 0.0;
        let mirrored = self.mirrored && !rotates_sideways && polar_rad.0 < 0.0 && polar_rad.1 > 0.0;
        if mirrored {
            let high = nominal_polar.high.max(-nominal_polar.low);
            nominal_polar = Linspace::new(0.0, high, WINDOW_POINTS);
            polar_rad = (0.0, polar_rad.1.max(-polar_rad.0));
        }
        let everything = (f64::NEG_INFINITY, f64::INFINITY);
        let min_angle = 0.5 * MIN_WINDOW_ANGLE_RAD;
        let searched_pitch = (self.pitch.low, self.pitch.high);
        Self {
            pitch: cell_axis(pitch.cells(), searched_pitch, grid.pitch, min_angle),
            polar: cell_axis(polar_rad, self.bracket.polar_rad, grid.polar, min_angle),
            backspin: cell_axis(
                backspin.cells(),
                everything,
                grid.backspin,
                MIN_SPIN_MARGIN_RAD_S,
            ),
            speeds_per_line: grid.speed,
            speed_m_s,
            mirrored,
            nominal: NominalGrid {
                speed: speed.nominal(),
                pitch: pitch.nominal(),
                polar: nominal_polar,
                backspin: backspin.nominal(),
                rifle_spin_rad_s: centre.rifle_spin_rad_s,
                side_spin_rad_s: centre.side_spin_rad_s,
            },
            bracket: self.bracket.clone(),
            shots: 0,
            memory_bytes: 0,
        }
        .with_size(&grid)
    }

    /// Sets the numbers of shots and bytes, if they are not too large.
    fn with_size(self, grid: &TableGrid) -> Result<Self, PlanError> {
        let memory = memory_bytes(grid, &self.nominal);
        let points =
            grid.speed as f64 * grid.pitch as f64 * grid.polar as f64 * grid.backspin as f64;
        if !(memory <= MAX_TABLE_BYTES && points < MAX_TABLE_POINTS) {
            let gib = (1u64 << 30) as f64;
            return Err(PlanError::TooLarge {
                points,
                need_gib: memory / gib,
                most_gib: MAX_TABLE_BYTES / gib,
            });
        }
        Ok(Self {
            shots: points as u64,
            memory_bytes: memory as u64,
            ..self
        })
    }

    /// Upper bound of the probability that the errors take this nominal shot outside the table's
    /// pitch angles and backspins, where shots are not simulated but can go in.
    #[must_use]
    pub fn mass_outside(&self, profile: &Profile, nominal: &Nominal) -> f64 {
        let dispersion = &profile.shooter().dispersion;
        let spin_sigma = dispersion.backspin_rad_s(nominal.backspin_rad_s);
        [
            (self.pitch, nominal.pitch_rad, dispersion.c20_rad),
            (self.backspin, nominal.backspin_rad_s, spin_sigma),
        ]
        .into_iter()
        .map(|(axis, centre, sigma)| {
            if sigma > 0.0 {
                normal_distribution::cdf((axis.low - centre) / sigma)
                    + normal_distribution::cdf((centre - axis.high) / sigma)
            } else {
                0.0
            }
        })
        .sum()
    }
}

/// One axis of a window: its centre, and the range within which nominal values are allowed.
struct WindowAxis {
    centre: f64,
    sigma: f64,
    min_reach: f64,
    range: Range,
    points: usize,
}

impl WindowAxis {
    /// The nominal values.
    fn nominal(&self) -> Linspace {
        let reach = (WINDOW_SIGMAS * self.sigma).max(self.min_reach);
        let (low, high) = self.range;
        Linspace::new(
            (self.centre - reach).clamp(low, high),
            (self.centre + reach).clamp(low, high),
            self.points,
        )
    }

    /// What the errors can lead to from the nominal values.
    fn cells(&self) -> Range {
        let nominal = self.nominal();
        let margin = WINDOW_MARGIN_SIGMAS * self.sigma;
        (nominal.low - margin, nominal.high + margin)
    }
}

/// An axis of cells over a range, within `limits`, and at least `min_half_width` to both sides.
fn cell_axis((low, high): Range, limits: Range, count: usize, min_half_width: f64) -> CellAxis {
    let (low, high) = (low.max(limits.0), high.min(limits.1));
    let widen = (min_half_width - 0.5 * (high - low)).max(0.0);
    CellAxis {
        low: low - widen,
        high: high + widen,
        count,
    }
}

/// The nominal speeds of the search, and the speeds of its lines.
fn search_speeds(profile: &Profile, bracket: &Bracket) -> Result<(Linspace, Range), PlanError> {
    let in_reach = nominal_speeds(profile, bracket).ok_or_else(|| out_of_reach(profile))?;
    if profile.search().choice.includes(NominalVariable::Speed) {
        return Ok((in_reach, (0.0, bracket.release_speed_max_m_s)));
    }
    let speed = profile.fixed_nominal().speed_m_s;
    let margin =
        MARGIN_SIGMAS * profile.shooter().dispersion.speed_m_s(speed) + MIN_WINDOW_SPEED_M_S;
    Ok((Linspace::single(speed), around(speed, margin)))
}

/// The nominal polar angles of the search, and those of its table.
fn search_polar_angles(profile: &Profile, bracket: &Bracket, mirrored: bool) -> (Linspace, Range) {
    let points = profile.grid().of_search().polar;
    let (low, high) = bracket.polar_rad;
    if mirrored {
        let one_side = (0.0, high.max(-low));
        (Linspace::new(one_side.0, one_side.1, points), one_side)
    } else if profile.search().choice.includes(NominalVariable::Polar) {
        (Linspace::new(low, high, points), bracket.polar_rad)
    } else {
        let polar = profile.fixed_nominal().polar_rad;
        let margin = MARGIN_SIGMAS * profile.shooter().dispersion.c30_rad + MIN_WINDOW_ANGLE_RAD;
        (Linspace::single(polar), around(polar, margin))
    }
}

/// Margins of pitch angle and backspin in the table of the search, rad and rad/s. A fixed value
/// without an error would leave its axis no width.
fn search_margins(profile: &Profile) -> (f64, f64) {
    let dispersion = &profile.shooter().dispersion;
    let min_pitch = if profile.search().choice.includes(NominalVariable::Pitch) {
        0.0
    } else {
        MIN_WINDOW_ANGLE_RAD
    };
    let (low_spin, high_spin) = profile.backspin_range_rad_s();
    let spin_margin = MARGIN_SIGMAS
        * dispersion
            .backspin_rad_s(high_spin)
            .max(dispersion.backspin_rad_s(low_spin));
    (
        MARGIN_SIGMAS * dispersion.c20_rad + min_pitch,
        spin_margin.max(MIN_SPIN_MARGIN_RAD_S),
    )
}

/// The nominal speeds: every speed of the bracket within the nominal pitch angles, about half a
/// standard deviation apart.
fn nominal_speeds(profile: &Profile, bracket: &Bracket) -> Option<Linspace> {
    const PITCHES: u32 = 70;
    let search = profile.search();
    let (polar_low, polar_high) = bracket.polar_rad;
    let middle = 0.5 * (polar_low + polar_high);
    let mut low = f64::INFINITY;
    let mut high = f64::NEG_INFINITY;
    for i in 0..=PITCHES {
        let part = f64::from(i) / f64::from(PITCHES);
        let pitch = search.pitch_min_rad + part * (search.pitch_max_rad - search.pitch_min_rad);
        for polar in [polar_low, middle, polar_high] {
            if let Some((least, most)) = bracket.speeds_m_s(pitch, polar)
                && least < bracket.speed_max_m_s
            {
                low = low.min(least);
                high = high.max(most.min(bracket.speed_max_m_s));
            }
        }
    }
    if !(low < high) {
        return None;
    }
    let sigma = profile.shooter().dispersion.speed_m_s(low);
    let step = (0.5 * sigma).clamp(0.01, 0.06);
    let count = ((high - low) / step).ceil() as usize;
    Some(Linspace::new(
        low,
        high,
        count.clamp(10, MAX_NOMINAL_SPEEDS),
    ))
}
