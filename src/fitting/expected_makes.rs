//! Predicted against observed: each measured shot's chance, and how good these chances are.

use super::fit_note::SurprisingShot;
use super::measured_release::{Covariance, MeasuredRelease, Values, nominal_of};
use super::posterior::Draw;
use crate::dynamics::OutcomeKind;
use crate::math::normal_distribution::quantile;
use crate::math::sobol::{ScrambleKey, Sobol};
use crate::probability::Progress;
use crate::shooter::Profile;
use rayon::prelude::*;
use serde::Serialize;

/// Releases that a shot may have had, for each measured one.
const RELEASES: u32 = 128;
/// Shots in a bin of the reliability diagram, at least, and bins at most.
const LEAST_IN_BIN: usize = 8;
const MOST_BINS: usize = 8;
/// The least variance of the excess squared error with which it is about normal.
const LEAST_EXCESS_VARIANCE: f64 = 1.0;
/// A shot is predicted to be a swish from this chance of one on.
const PREDICTED: f64 = 0.5;

/// What is known of one measured shot.
#[derive(Clone, Debug, PartialEq)]
pub struct ShotChance {
    /// The line or row of the file.
    pub row: u64,
    /// The release: the mean, given the measurement and the shooter.
    pub release: Values,
    /// The standard deviations of it.
    pub release_sd: Values,
    /// Index of its place.
    pub place: usize,
    /// The chance that it goes in.
    pub chance: f64,
    /// The chance that it goes in without a touch.
    pub swish_chance: f64,
    /// The distance from the shooter's aim in standard deviations (Mahalanobis).
    pub distance: f64,
    /// Whether it went in.
    pub made: Option<bool>,
}

/// Some shots of similar chance.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ReliabilityBin {
    /// The number of shots.
    pub shots: usize,
    /// Mean chance.
    pub predicted: f64,
    /// The share that went in, and its interval.
    pub observed: Wilson,
}

/// A share with Wilson's 95 % interval.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Wilson {
    /// The share.
    pub share: f64,
    /// The ends of the interval.
    pub low: f64,
    /// See `low`.
    pub high: f64,
}

/// Wilson's interval of a share (J. Am. Stat. Assoc. 22 (1927) 209).
#[must_use]
pub fn wilson_interval(made: usize, shots: usize) -> Wilson {
    const Z: f64 = 1.959_963_984_540_054;
    let n = (shots as f64).max(1.0);
    let share = made as f64 / n;
    let centre = (share + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (share * (1.0 - share) / n + Z * Z / (4.0 * n * n)).sqrt();
    Wilson {
        share,
        low: (centre - half).max(0.0),
        high: (centre + half).min(1.0),
    }
}

/// The change from one share to another, each of `(made, shots)`, with its 95 % interval (the
/// "square and add" interval from two of Wilson's; Newcombe, Stat. Med. 17 (1998) 873, method 10).
#[must_use]
pub fn change_of_share(before: (usize, usize), after: (usize, usize)) -> Wilson {
    let [a, b] = [after, before].map(|(made, shots)| wilson_interval(made, shots));
    let change = a.share - b.share;
    Wilson {
        share: change,
        low: change - libm::hypot(a.share - a.low, b.high - b.share),
        high: change + libm::hypot(a.high - a.share, b.share - b.low),
    }
}

/// Predicted against observed.
#[derive(Clone, Debug)]
pub struct ExpectedMakes {
    /// Every shot.
    pub shots: Vec<ShotChance>,
    /// Shots whose result is known.
    pub labelled: usize,
    /// Makes that were expected of these.
    pub expected: f64,
    /// The standard deviation of the number of makes if the chances are right.
    pub expected_sd: f64,
    /// Makes that were seen.
    pub made: usize,
    /// The share of makes.
    pub share: Wilson,
    /// Mean square of chance less result.
    pub brier: f64,
    /// Mean logarithmic loss.
    pub log_loss: f64,
    /// Both losses of a forecast that gives every shot the share of makes.
    pub losses_of_share: [f64; 2],
    /// By how many of its standard deviations the squared error is greater than chances that are
    /// right would give (Spiegelhalter, Stat. Med. 5 (1986) 421). About standard normal if they
    /// are; positive for overconfident chances. `None` where too few shots are doubtful.
    pub calibration_z: Option<f64>,
    /// The probability that a made shot had the greater chance than a missed one; where there are
    /// both.
    pub area_under_curve: Option<f64>,
    /// Shots that were predicted to be a swish, and how many of them went in.
    pub swishes: (usize, usize),
    /// The reliability diagram.
    pub bins: Vec<ReliabilityBin>,
}

impl ExpectedMakes {
    /// By how many of its standard deviations the number of makes is greater than expected; about
    /// standard normal if the chances are right. `None` where no result is in doubt.
    #[must_use]
    pub fn made_z(&self) -> Option<f64> {
        let excess = self.made as f64 - self.expected;
        (self.expected_sd > 0.0).then(|| excess / self.expected_sd)
    }

    /// The three shots with the least chance of what became of them: line, chance of a make, and
    /// whether it went in.
    pub(super) fn most_surprising(&self) -> Vec<SurprisingShot> {
        let known = self.shots.iter().filter_map(|shot| {
            Some(SurprisingShot {
                row: shot.row,
                chance: shot.chance,
                made: shot.made?,
            })
        });
        let mut shots: Vec<SurprisingShot> = known.collect();
        let of_result = |shot: &SurprisingShot| match shot.made {
            true => shot.chance,
            false => 1.0 - shot.chance,
        };
        shots.sort_by(|a, b| of_result(a).total_cmp(&of_result(b)));
        shots.truncate(3);
        shots
    }
}

/// The release of a measured shot, given the shooter and the tracker's constant error: mean and
/// covariance.
pub(super) fn release_given(
    shot: &MeasuredRelease,
    draw: &Draw,
    measured_values: usize,
) -> Option<(Values, Covariance)> {
    let factor = draw.factors[shot.place];
    let mut prior = factor * factor.transpose();
    let mean = nalgebra::Vector4::from(draw.means[shot.place]);
    let mut noise = shot.noise;
    let error = nalgebra::Vector4::from(draw.constant_errors[shot.place]);
    let mut values = nalgebra::Vector4::from(shot.values) - error;
    for i in measured_values..4 {
        // A measurement that says nothing.
        noise[(i, i)] = 1e9;
        values[i] = mean[i];
    }
    if draw.tail_weight > 0.0 {
        // The farther a shot, the wider the normal part of the mixture that it comes from: with d
        // values and n degrees of freedom the expected inverse scale is (n + d)/(n + squared
        // distance).
        let dimension = measured_values as f64;
        let freedom = 1.0 / draw.tail_weight;
        prior *= 1.0 - 2.0 * draw.tail_weight;
        let deviation = values - mean;
        let square = deviation.dot(&((prior + noise).try_inverse()? * deviation));
        prior *= (freedom + square) / (freedom + dimension);
    }
    let gain = prior * (prior + noise).try_inverse()?;
    let posterior = mean + gain * (values - mean);
    let covariance = prior - gain * prior;
    Some((
        posterior.into(),
        (covariance + covariance.transpose()) * 0.5,
    ))
}

/// A factor of a covariance that may be singular.
pub(super) fn factor_of(covariance: &Covariance) -> Covariance {
    let eigen = covariance.symmetric_eigen();
    let roots = eigen.eigenvalues.map(|value| value.max(0.0).sqrt());
    eigen.eigenvectors * Covariance::from_diagonal(&roots)
}

/// Standard normals that every shot shares.
pub(super) fn common_normals(count: u32, seed: u64) -> Vec<Values> {
    let scramble = Sobol::new().scrambled(ScrambleKey { seed, replicate: 0 });
    (0..count)
        .map(|index| std::array::from_fn(|k| quantile(scramble.point(index, k))))
        .collect()
}

/// A release that is known but for errors that do not depend on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownRelease {
    /// Index of its place.
    pub place: usize,
    /// The mean.
    pub release: Values,
    /// The standard deviations.
    pub release_sd: Values,
    /// Whether it went in.
    pub made: bool,
}

impl ExpectedMakes {
    /// The shots whose result is known.
    #[must_use]
    pub fn known_releases(&self) -> Vec<KnownRelease> {
        let known = self.shots.iter().filter_map(|shot| {
            Some(KnownRelease {
                place: shot.place,
                release: shot.release,
                release_sd: shot.release_sd,
                made: shot.made?,
            })
        });
        known.collect()
    }
}

/// By how many of its standard deviations the number of makes is greater than expected, if each
/// release was another one by `shift` and was shot under the physics of `profiles`, those of the
/// places. `None` where no result is in doubt.
#[must_use]
pub fn made_z_of_releases(
    profiles: &[Profile],
    shots: &[KnownRelease],
    shift: &Values,
) -> Option<f64> {
    let normals = common_normals(RELEASES, 1);
    let chances: Vec<f64> = shots
        .par_iter()
        .map(|shot| {
            let profile = &profiles[shot.place];
            let made = normals.iter().filter(|z| {
                let values: Values =
                    std::array::from_fn(|i| shot.release[i] + shift[i] + shot.release_sd[i] * z[i]);
                let release = profile.release(&nominal_of(&values));
                let outcome = profile.simulator().simulate(&release);
                outcome.is_ok_and(|outcome| outcome.verdict.made)
            });
            made.count() as f64 / f64::from(RELEASES)
        })
        .collect();
    let expected: f64 = chances.iter().sum();
    let variance: f64 = chances.iter().map(|p| p * (1.0 - p)).sum();
    let made = shots.iter().filter(|shot| shot.made).count();
    (variance > 0.0).then(|| (made as f64 - expected) / variance.sqrt())
}

/// The chances of measured shots for the typical draw. `profiles` are those of the places.
#[must_use]
pub fn expected_makes(
    profiles: &[Profile],
    shots: &[MeasuredRelease],
    (typical, measured_values): (&Draw, usize),
    progress: &dyn Progress,
) -> ExpectedMakes {
    let normals = common_normals(RELEASES, 1);
    progress.begin("chances of shots", shots.len() as u64);
    let shots: Vec<ShotChance> = shots
        .par_iter()
        .filter_map(|shot| {
            progress.advance(1);
            let (mean, covariance) = release_given(shot, typical, measured_values)?;
            let factor = factor_of(&covariance);
            let profile = &profiles[shot.place];
            let (mut made, mut swishes) = (0, 0);
            for z in &normals {
                let values = nalgebra::Vector4::from(mean) + factor * nalgebra::Vector4::from(*z);
                let release = shot.release(profile, &values.into());
                if let Ok(outcome) = profile.simulator().simulate(&release) {
                    made += u32::from(outcome.verdict.made);
                    swishes += u32::from(outcome.kind == OutcomeKind::Swish);
                }
            }
            let aim = nalgebra::Vector4::from(typical.means[shot.place]);
            let whitened = typical.factors[shot.place]
                .solve_lower_triangular(&(nalgebra::Vector4::from(mean) - aim))?;
            Some(ShotChance {
                row: shot.row,
                place: shot.place,
                release: mean,
                release_sd: std::array::from_fn(|i| covariance[(i, i)].max(0.0).sqrt()),
                chance: f64::from(made) / f64::from(RELEASES),
                swish_chance: f64::from(swishes) / f64::from(RELEASES),
                distance: whitened.norm(),
                made: shot.made,
            })
        })
        .collect();
    progress.end();
    summary(shots)
}

impl ExpectedMakes {
    /// Expected makes of the shots from one place.
    #[must_use]
    pub fn at_place(&self, place: usize) -> Self {
        let here = self.shots.iter().filter(|shot| shot.place == place);
        summary(here.cloned().collect())
    }
}

/// Shots of which no more is known than their place and whether they went in; `chance` is P at a
/// place.
pub(super) fn makes_of_counts(
    shots: &[MeasuredRelease],
    typical: &Draw,
    chance: impl Fn(usize) -> f64,
) -> ExpectedMakes {
    let chances: Vec<f64> = (0..typical.means.len()).map(chance).collect();
    let of_shot = |shot: &MeasuredRelease| ShotChance {
        row: shot.row,
        release: typical.means[shot.place],
        release_sd: typical.sds_at(shot.place),
        place: shot.place,
        chance: chances[shot.place],
        swish_chance: 0.0,
        distance: 0.0,
        made: shot.made,
    };
    summary(shots.iter().map(of_shot).collect())
}

fn summary(shots: Vec<ShotChance>) -> ExpectedMakes {
    let mut labelled: Vec<(f64, bool)> = shots
        .iter()
        .filter_map(|shot| Some((shot.chance, shot.made?)))
        .collect();
    let count = labelled.len().max(1) as f64;
    let expected: f64 = labelled.iter().map(|(chance, _)| chance).sum();
    let variance: f64 = labelled.iter().map(|(p, _)| p * (1.0 - p)).sum();
    let made = labelled.iter().filter(|(_, made)| *made).count();
    let brier = labelled
        .iter()
        .map(|(p, made)| {
            let error = p - f64::from(u8::from(*made));
            error * error
        })
        .sum::<f64>()
        / count;
    // A chance from few simulated releases is not 0 or 1.
    let least = 0.5 / f64::from(RELEASES);
    let (mut excess, mut excess_variance) = (0.0, 0.0);
    for (p, made) in &labelled {
        let p = p.clamp(least, 1.0 - least);
        excess += (f64::from(u8::from(*made)) - p) * (1.0 - 2.0 * p);
        excess_variance += (1.0 - 2.0 * p) * (1.0 - 2.0 * p) * p * (1.0 - p);
    }
    // Of few doubtful shots it is far from normal: one surprise would be many standard deviations.
    let calibration_z =
        (excess_variance >= LEAST_EXCESS_VARIANCE).then(|| excess / excess_variance.sqrt());
    let share = made as f64 / count;
    let entropy = [share, 1.0 - share]
        .into_iter()
        .filter(|part| *part > 0.0)
        .map(|part| -part * libm::log(part))
        .sum::<f64>()
        .max(0.0)
        // No negative zero.
        + 0.0;
    let log_loss = labelled
        .iter()
        .map(|(p, made)| {
            let p = p.clamp(least, 1.0 - least);
            -libm::log(if *made { p } else { 1.0 - p })
        })
        .sum::<f64>()
        / count;
    let swish = |shot: &&ShotChance| shot.swish_chance >= PREDICTED && shot.made.is_some();
    let swishes = shots.iter().filter(swish).count();
    let swishes_made = shots
        .iter()
        .filter(swish)
        .filter(|s| s.made == Some(true))
        .count();
    labelled.sort_by(|a, b| a.0.total_cmp(&b.0));
    let bins = (labelled.len() / LEAST_IN_BIN).min(MOST_BINS);
    ExpectedMakes {
        labelled: labelled.len(),
        expected,
        expected_sd: variance.sqrt(),
        made,
        share: wilson_interval(made, labelled.len()),
        brier,
        log_loss,
        losses_of_share: [share * (1.0 - share), entropy],
        calibration_z,
        area_under_curve: area_under_curve(&labelled),
        swishes: (swishes, swishes_made),
        bins: (0..bins)
            .map(|bin| {
                let range = bin * labelled.len() / bins..(bin + 1) * labelled.len() / bins;
                let in_bin = &labelled[range];
                let made = in_bin.iter().filter(|(_, made)| *made).count();
                ReliabilityBin {
                    predicted: in_bin.iter().map(|(p, _)| p).sum::<f64>() / in_bin.len() as f64,
                    observed: wilson_interval(made, in_bin.len()),
                    shots: in_bin.len(),
                }
            })
            .collect(),
        shots,
    }
}

/// Of chances in ascending order: ties count half.
fn area_under_curve(labelled: &[(f64, bool)]) -> Option<f64> {
    let made = labelled.iter().filter(|(_, made)| *made).count();
    let missed = labelled.len() - made;
    if made == 0 || missed == 0 {
        return None;
    }
    let mut sum = 0.0;
    let mut start = 0;
    let mut missed_below = 0.0;
    while start < labelled.len() {
        let chance = labelled[start].0;
        let tied = labelled[start..].iter().take_while(|(p, _)| *p == chance);
        let tied: Vec<bool> = tied.map(|(_, made)| *made).collect();
        let made_here = tied.iter().filter(|made| **made).count() as f64;
        let missed_here = tied.len() as f64 - made_here;
        sum += made_here * (missed_below + 0.5 * missed_here);
        missed_below += missed_here;
        start += tied.len();
    }
    Some(sum / (made as f64 * missed as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Authority: Wilson's interval of 8 in 10 (Agresti and Coull 1998: 0.490 to 0.943).
    #[test]
    fn val_wilson_interval() {
        let wilson = wilson_interval(8, 10);
        assert!((wilson.low - 0.490).abs() < 5e-4, "{wilson:?}");
        assert!((wilson.high - 0.943).abs() < 5e-4, "{wilson:?}");
        assert_eq!(wilson_interval(0, 10).low, 0.0);
    }

    /// Authority: Newcombe 1998, table II, 56 of 70 less 48 of 80: 0.0524 to 0.3339.
    #[test]
    fn val_change_of_share() {
        let change = change_of_share((48, 80), (56, 70));
        assert!((change.share - 0.2).abs() < 1e-12, "{change:?}");
        assert!((change.low - 0.0524).abs() < 5e-5, "{change:?}");
        assert!((change.high - 0.3339).abs() < 5e-5, "{change:?}");
    }

    /// By hand: chances of 0.8 and 0.2 are right if they are wrong once in five, and too sure if
    /// they are always wrong.
    #[test]
    fn val_calibration_z() {
        let shot = |chance: f64, made: bool| ShotChance {
            place: 0,
            row: 0,
            release: [0.0; 4],
            release_sd: [0.0; 4],
            chance,
            swish_chance: 0.0,
            distance: 0.0,
            made: Some(made),
        };
        let right = (0..50).map(|k| shot(0.8, k % 5 != 0));
        let z = summary(right.collect()).calibration_z.unwrap();
        assert!(z.abs() < 1e-12);
        // One surprise among twenty sure shots.
        let few = (0..20).map(|k| shot(1.0, k != 0));
        assert_eq!(summary(few.collect()).calibration_z, None);
        let all_made = summary((0..20).map(|_| shot(0.9, true)).collect());
        assert!(all_made.losses_of_share[1].is_sign_positive());
        let wrong = (0..50).map(|k| shot(if k % 2 == 0 { 0.8 } else { 0.2 }, k % 2 == 1));
        // Each adds 0.8 * 0.6 with a variance of 0.36 * 0.16.
        let expected = 50.0 * 0.48 / (50.0 * 0.36 * 0.16_f64).sqrt();
        let found = summary(wrong.collect());
        assert_eq!(found.most_surprising()[0].chance, 0.8);
        assert!(!found.most_surprising()[0].made);
        assert!(
            (found.calibration_z.unwrap() - expected).abs() < 1e-9,
            "{found:?}"
        );
        assert_eq!(found.losses_of_share, [0.25, libm::log(2.0)]);
    }

    /// By hand: of the four pairs of a made and a missed shot, three are in order and one is tied.
    #[test]
    fn val_area_under_curve() {
        let labelled = [(0.2, false), (0.5, false), (0.5, true), (0.9, true)];
        assert_eq!(area_under_curve(&labelled), Some(3.5 / 4.0));
        assert_eq!(area_under_curve(&[(0.5, true)]), None);
    }
}
