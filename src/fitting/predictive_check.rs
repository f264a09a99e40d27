//! What the fit predicts of shots like the measured ones, against what was measured: depth, left
//! and right, and makes by depth (posterior predictive checks; Gelman et al., *Bayesian Data
//! Analysis*, 3rd edition, 2013, chapter 6).
//!
//! Some draws of the posterior shoot every measured shot again, with the tracker's errors, under
//! their own ring.

use super::draw_probabilities::under_ring;
use super::landing::{CENTRE_DEPTH_M, landing_of};
use super::measured_release::{MeasuredRelease, Values};
use super::posterior::{Draw, standard_normal};
use super::predicted_bins::{PredictedBin, PredictiveCheck};
use super::shooter_fit::ShooterFit;
use crate::probability::Progress;
use crate::units::INCH_M;
use nalgebra::{SMatrix, Vector4};
use rand::SeedableRng;
use rand::rngs::ChaCha12Rng;
use rayon::prelude::*;

/// Draws that shoot, at most and at least, and shots of all of them.
const MOST_DRAWS: usize = 100;
const LEAST_DRAWS: usize = 40;
const SHOTS: usize = 30_000;
/// The inner bins of depth and of left and right are so wide; there are so many of them.
const BIN_M: f64 = 2.0 * INCH_M;
const INNER_BINS: usize = 10;
/// Bins of the makes.
const BINS_OF_MAKES: usize = 6;

/// Where a shot fell, and whether it went in.
#[derive(Clone, Copy)]
struct Fallen {
    depth_m: f64,
    right_m: f64,
    made: Option<bool>,
}

/// Predicted against measured, of all places together. Nothing where no flight was measured.
#[must_use]
pub fn predictive_check(
    fit: &ShooterFit,
    shots: &[MeasuredRelease],
    progress: &dyn Progress,
) -> PredictiveCheck {
    let measured = fit.posterior.spin.measured_values();
    let seen: Vec<Fallen> = shots
        .iter()
        .filter_map(|shot| fallen(fit, shot.place, &shot.values, shot.made))
        .collect();
    if measured == 0 || seen.is_empty() {
        return PredictiveCheck::default();
    }
    let draws = &fit.posterior.draws;
    let count = (SHOTS / shots.len()).clamp(LEAST_DRAWS, MOST_DRAWS);
    progress.begin("checking the fit", count as u64);
    let predicted: Vec<Vec<Fallen>> = (0..count)
        .into_par_iter()
        .map(|number| {
            let again = shoot_again(fit, shots, &draws[number * draws.len() / count], number);
            progress.advance(1);
            again
        })
        .collect();
    progress.end();
    let inner = |middle: f64| -> Vec<f64> {
        let first = middle - 0.5 * INNER_BINS as f64 * BIN_M;
        (0..=INNER_BINS).map(|k| first + BIN_M * k as f64).collect()
    };
    let counted = |edges: Vec<f64>, value: &(dyn Fn(&Fallen) -> f64 + Sync)| {
        bins(&edges, (&seen, &predicted), value, &|inside| {
            Some(inside.len() as f64)
        })
    };
    let mut depths: Vec<f64> = seen
        .iter()
        .filter(|shot| shot.made.is_some())
        .map(|shot| shot.depth_m)
        .collect();
    depths.sort_by(f64::total_cmp);
    let edges: Vec<f64> = (1..BINS_OF_MAKES)
        .filter_map(|k| depths.get(k * depths.len() / BINS_OF_MAKES).copied())
        .collect();
    let share = |inside: &[&Fallen]| {
        let results = inside.iter().filter_map(|shot| shot.made);
        let (made, all) = results.fold((0, 0), |(made, all), is_made| {
            (made + u32::from(is_made), all + 1)
        });
        (all > 0).then(|| f64::from(made) / f64::from(all))
    };
    PredictiveCheck {
        depth: counted(inner(CENTRE_DEPTH_M), &|shot| shot.depth_m),
        left_right: match measured {
            2 => Vec::new(),
            _ => counted(inner(0.0), &|shot| shot.right_m),
        },
        makes_by_depth: match depths.is_empty() {
            true => Vec::new(),
            false => {
                let with_result: Vec<Fallen> = seen
                    .iter()
                    .filter(|shot| shot.made.is_some())
                    .copied()
                    .collect();
                bins(
                    &edges,
                    (&with_result, &predicted),
                    &|shot| shot.depth_m,
                    &share,
                )
            }
        },
    }
}

fn fallen(fit: &ShooterFit, place: usize, values: &Values, made: Option<bool>) -> Option<Fallen> {
    let simulator = fit.profiles[place].simulator();
    let landing = landing_of(simulator, &fit.places[place], values)?;
    Some(Fallen {
        depth_m: landing.depth_m,
        right_m: landing.right_m,
        made,
    })
}

/// Every shot again, by one draw.
fn shoot_again(
    fit: &ShooterFit,
    shots: &[MeasuredRelease],
    draw: &Draw,
    number: usize,
) -> Vec<Fallen> {
    let mut random = ChaCha12Rng::seed_from_u64(1);
    random.set_stream(number as u64);
    let rings = fit.profiles.iter();
    let simulators: Vec<_> = rings
        .map(|profile| under_ring(profile, draw.ring_restitution))
        .collect();
    let again = shots.iter().filter_map(|shot| {
        let place = shot.place;
        let mut normals = || Vector4::from_fn(|_, _| standard_normal(&mut random));
        let (z, noise) = (normals(), normals());
        let from_aim = draw.factor_at(place) * z * tail_scale(draw.tail_weight, &mut random);
        let released: Values = (Vector4::from(draw.means[place]) + from_aim).into();
        let mut seen =
            Vector4::from(draw.measured_mean(place)) + from_aim + error_factor(shot) * noise;
        if fit.posterior.spin.measured_values() < 4 {
            // That with which its landing was turned into a release.
            seen[3] = shot.values[3];
        }
        let release = shot.release(&fit.profiles[place], &released);
        let made = shot.made.map(|_| {
            let outcome = simulators[place].simulate(&release);
            outcome.is_ok_and(|outcome| outcome.verdict.made)
        });
        fallen(fit, place, &seen.into(), made)
    });
    again.collect()
}

/// What a deviation of a t distribution is multiplied by: the root of `(1 - 2 t)/w`, with the cube
/// root of `w` as a normal number (Wilson and Hilferty, Proc. Natl. Acad. Sci. 17 (1931) 684).
fn tail_scale(tail_weight: f64, random: &mut ChaCha12Rng) -> f64 {
    if tail_weight <= 0.0 {
        return 1.0;
    }
    let spread = 2.0 * tail_weight / 9.0;
    let root = (1.0 - spread + spread.sqrt() * standard_normal(random)).max(0.1);
    ((1.0 - 2.0 * tail_weight) / (root * root * root)).sqrt()
}

/// The Cholesky factor of a tracker's error; values that were not measured have none.
fn error_factor(shot: &MeasuredRelease) -> SMatrix<f64, 4, 4> {
    let some = shot.noise + SMatrix::identity() * 1e-18;
    some.cholesky().map_or_else(SMatrix::zeros, |c| c.l())
}

/// Bins between edges, open at both ends.
fn bins(
    edges: &[f64],
    (seen, predicted): (&[Fallen], &[Vec<Fallen>]),
    value: &(dyn Fn(&Fallen) -> f64 + Sync),
    judge: &dyn Fn(&[&Fallen]) -> Option<f64>,
) -> Vec<PredictedBin> {
    let of_bin = |number: usize| {
        let low = number.checked_sub(1).map(|before| edges[before]);
        let high = edges.get(number).copied();
        let is_inside = |shot: &&Fallen| {
            let x = value(shot);
            low.is_none_or(|low| x >= low) && high.is_none_or(|high| x < high)
        };
        let inside: Vec<&Fallen> = seen.iter().filter(is_inside).collect();
        let of_draw = |shots: &Vec<Fallen>| {
            let inside: Vec<&Fallen> = shots.iter().filter(is_inside).collect();
            judge(&inside)
        };
        let mut of_draws: Vec<f64> = predicted.iter().filter_map(of_draw).collect();
        of_draws.sort_by(f64::total_cmp);
        let last = of_draws.len().checked_sub(1)?;
        let at = |share: f64| of_draws[(share * last as f64 + 0.5) as usize];
        Some(PredictedBin {
            above_short_m: low,
            below_short_m: high,
            shots: inside.len(),
            seen: judge(&inside)?,
            predicted: of_draws.iter().sum::<f64>() / of_draws.len() as f64,
            low: at(0.05),
            high: at(0.95),
        })
    };
    (0..=edges.len()).filter_map(of_bin).collect()
}
