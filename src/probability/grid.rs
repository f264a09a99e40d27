//! P of one nominal shot by Eq. 25: to the letter of the paper, on one common grid, and on grids that
//! are shifted from line to line. Both are here to be compared with the Sobol points of `estimate`,
//! which need a hundredth of the shots; only the four errors of Eq. 25 can be integrated so.

use super::table::{points_of_line, weight};
use super::{Progress, estimate::Estimate};
use crate::dynamics::{Aim, Room, Simulator};
use crate::plan::{Axis, Plan};
use crate::profile::{Nominal, Profile};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;

/// Random offsets of the shifted grid; their scatter gives the standard error.
pub const OFFSETS: u64 = 4;
/// Standard deviations that a shifted grid reaches to both sides of the nominal shot.
const SHIFTED_REACH: f64 = 4.5;

/// The sum of Eq. 25 with the cells' shots that were simulated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sum {
    /// P.
    pub probability: f64,
    /// Shots simulated.
    pub shots: u64,
}

/// Eq. 25 to the letter: `n` values of each of speed, pitch, polar angle and backspin over all that can
/// be made from the place, on one common grid.
#[must_use]
pub fn to_the_letter(
    profile: &Profile,
    plan: &Plan,
    simulator: &Simulator,
    nominal: &Nominal,
    n: usize,
    progress: &dyn Progress,
) -> Sum {
    let axis = |low, high| Axis {
        low,
        high,
        count: n,
    };
    // The speeds that can be made at any of the angles.
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    let pitches = axis(plan.pitch.low, plan.pitch.high);
    let polars = axis(plan.bracket.polar_rad.0, plan.bracket.polar_rad.1);
    for pitch in pitches.values(0.5) {
        for polar in polars.values(0.5) {
            if let Some((least, most)) = plan.bracket.speeds_m_s(pitch, polar) {
                low = low.min(least);
                high = high.max(most);
            }
        }
    }
    let axes = [
        pitches,
        polars,
        axis(plan.backspin.low, plan.backspin.high),
        axis(low.min(high), high),
    ];
    sum(profile, plan, simulator, nominal, &axes, None, progress)
}

/// Eq. 25 on [`OFFSETS`] shifted grids of `n` to the fourth points each, reaching 4.5 standard
/// deviations about the nominal shot; the scatter of the four gives the standard error.
#[must_use]
pub fn shifted(
    profile: &Profile,
    plan: &Plan,
    simulator: &Simulator,
    nominal: &Nominal,
    n: usize,
    seed: u64,
    progress: &dyn Progress,
) -> Estimate {
    let [speed, pitch, polar, spin, ..] = profile.shooter.errors.sigmas(nominal);
    let about = |centre: f64, sigma: f64| Axis {
        low: centre - SHIFTED_REACH * sigma,
        high: centre + SHIFTED_REACH * sigma,
        // Without an error the nominal value is all there is.
        count: if sigma > 0.0 { n } else { 1 },
    };
    let axes = [
        about(nominal.pitch_rad, pitch),
        about(nominal.polar_rad, polar),
        about(nominal.backspin_rad_s, spin),
        about(nominal.speed_m_s, speed),
    ];
    let sums: Vec<Sum> = (0..OFFSETS)
        .map(|stream| {
            let mut random = ChaCha12Rng::seed_from_u64(seed);
            random.set_stream(stream);
            let offset = std::array::from_fn(|_| random.random::<f64>());
            let offset = Some(offset);
            sum(profile, plan, simulator, nominal, &axes, offset, progress)
        })
        .collect();
    let count = sums.len() as f64;
    let probability = sums.iter().map(|sum| sum.probability).sum::<f64>() / count;
    let square: f64 = sums
        .iter()
        .map(|sum| (sum.probability - probability).powi(2))
        .sum();
    Estimate {
        probability,
        standard_error: (square / (count * (count - 1.0))).sqrt(),
        shots: sums.iter().map(|sum| sum.shots).sum(),
        certain: axes.iter().all(|axis| axis.count == 1),
        ..Estimate::default()
    }
}

/// The sum over the axes of pitch, polar angle, backspin and speed; a common grid without an `offset`,
/// one shifted from line to line with it.
fn sum(
    profile: &Profile,
    plan: &Plan,
    simulator: &Simulator,
    nominal: &Nominal,
    axes: &[Axis; 4],
    offset: Option<[f64; 4]>,
    progress: &dyn Progress,
) -> Sum {
    let [speed_sigma, pitch_sigma, polar_sigma, spin_sigma, ..] =
        profile.shooter.errors.sigmas(nominal);
    let [pitches, polars, spins, speeds] = axes;
    // The weight of an axis without an error is its one value's.
    let factor = |axis: &Axis, x: f64, centre: f64, sigma: f64| {
        if axis.count == 1 && sigma == 0.0 {
            1.0
        } else {
            weight(x, (centre, sigma), axis.step())
        }
    };
    let pairs = pitches.count * polars.count;
    progress.begin("simulating", pairs as u64);
    let rows: Vec<Sum> = (0..pairs)
        .into_par_iter()
        .map_init(Room::default, |room, pair| {
            progress.advance(1);
            let cell = (pair / polars.count, pair % polars.count);
            let (pitch_shift, polar_shift) = offset.map_or((0.5, 0.5), |offset| {
                (
                    offset[0],
                    (points_of_line::polar(cell.0) + offset[1]).fract(),
                )
            });
            let pitch_rad = pitches.value(cell.0, pitch_shift);
            let polar_rad = polars.value(cell.1, polar_shift);
            let angles = factor(pitches, pitch_rad, nominal.pitch_rad, pitch_sigma)
                * factor(polars, polar_rad, nominal.polar_rad, polar_sigma);
            let nothing = Sum {
                probability: 0.0,
                shots: 0,
            };
            let Some((least, most)) = plan.bracket.speeds_m_s(pitch_rad, polar_rad) else {
                return nothing;
            };
            if angles == 0.0 {
                return nothing;
            }
            let aim = Aim::new(&profile.release(&Nominal {
                pitch_rad,
                polar_rad,
                ..*nominal
            }));
            let mut starts = Vec::with_capacity(spins.count * speeds.count);
            let mut weights = Vec::with_capacity(starts.capacity());
            let spin_shift = offset.map_or(0.5, |offset| {
                (points_of_line::spin(cell.0, cell.1) + offset[2]).fract()
            });
            for (k, spin) in spins.values(spin_shift).enumerate() {
                let of_spin = factor(spins, spin, nominal.backspin_rad_s, spin_sigma);
                let speed_shift = offset.map_or(0.5, |offset| {
                    (points_of_line::speed(cell.0, cell.1, k) + offset[3]).fract()
                });
                for speed in speeds.values(speed_shift) {
                    let of_speed = factor(speeds, speed, nominal.speed_m_s, speed_sigma);
                    // Outside the bracket nothing is made.
                    if of_spin * of_speed > 0.0 && speed >= least && speed <= most {
                        starts.push(aim.state(speed, spin));
                        weights.push(of_spin * of_speed);
                    }
                }
            }
            let made = simulator.verdicts(&starts, room).iter().zip(&weights);
            let inner: f64 = made
                .filter(|(verdict, _)| verdict.made)
                .map(|(_, weight)| weight)
                .sum();
            Sum {
                probability: angles * inner,
                shots: starts.len() as u64,
            }
        })
        .collect();
    progress.end();
    // In the order of the cells, so that the threads change nothing.
    rows.iter().fold(
        Sum {
            probability: 0.0,
            shots: 0,
        },
        |sum, row| Sum {
            probability: sum.probability + row.probability,
            shots: sum.shots + row.shots,
        },
    )
}
