//! P as a function of each part of a nominal shot, the others held at the best.

use super::estimate::Sampler;
use super::sobol::Scramble;
use super::table::Probabilities;
use crate::plan::{Plan, Stations};
use crate::profile::{CHOICES, Nominal, Profile};
use serde::Serialize;

/// Values of a curve that is sampled.
const SAMPLED_VALUES: usize = 9;
/// Sobol points of each of them.
const SAMPLES: u32 = 16384;

/// P along one part of a nominal shot.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Curve {
    /// Which, one of [`CHOICES`].
    pub nominal: &'static str,
    /// Its values (SI units) with P.
    pub points: Vec<(f64, f64)>,
}

/// The lines of a window's table through the nominal shot nearest to the given one.
pub(super) fn from_table(table: &Probabilities, nominal: &Nominal) -> Vec<Curve> {
    let counts = table.counts();
    let index = table.index_of(nominal);
    // A table's axes are pitch angle, polar angle, backspin and speed.
    [3, 0, 1, 2]
        .into_iter()
        .enumerate()
        .filter(|&(_, axis)| counts[axis] > 1)
        .map(|(choice, axis)| Curve {
            nominal: CHOICES[choice],
            points: (0..counts[axis])
                .map(|i| {
                    let mut at = index;
                    at[axis] = i;
                    let (p, mut nominal) = table.at(at);
                    (*part(&mut nominal, choice), p)
                })
                .collect(),
        })
        .collect()
}

/// The same by Sobol points, for errors that the table does not know.
pub(super) fn from_samples(
    profile: &Profile,
    sampler: &Sampler<'_>,
    scramble: &Scramble,
    window: &Plan,
    nominal: &Nominal,
) -> Vec<Curve> {
    let spin = profile.shooter.max_side_spin_rad_s;
    let stations = [
        window.nominal.speed,
        window.nominal.pitch,
        window.nominal.polar,
        window.nominal.backspin,
        Stations::new(-spin, spin, SAMPLED_VALUES),
    ];
    let chosen = profile.search.choose.flags();
    (0..CHOICES.len())
        .filter(|&choice| chosen[choice] && stations[choice].low < stations[choice].high)
        .map(|choice| {
            let Stations { low, high, .. } = stations[choice];
            let values = Stations::new(low, high, SAMPLED_VALUES).values();
            let points = values.map(|value| {
                let mut shot = *nominal;
                *part(&mut shot, choice) = value;
                let made = sampler.count(&shot, scramble, (0, SAMPLES)).made();
                (value, made as f64 / f64::from(SAMPLES))
            });
            Curve {
                nominal: CHOICES[choice],
                points: points.collect(),
            }
        })
        .collect()
}

/// A part of a nominal shot by its place in [`CHOICES`].
pub(super) fn part(nominal: &mut Nominal, choice: usize) -> &mut f64 {
    match choice {
        0 => &mut nominal.speed_m_s,
        1 => &mut nominal.pitch_rad,
        2 => &mut nominal.polar_rad,
        3 => &mut nominal.backspin_rad_s,
        _ => &mut nominal.side_spin_rad_s,
    }
}
