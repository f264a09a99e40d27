//! How sure it is that a bank shot is better: over the draws of a fit, and over the rings and
//! boards that a gym may have.

use crate::analysis::sensitivity::Difference;
use crate::best_shot::likely_board_restitutions;
use crate::cli::failure::Failure;
use crate::cli::fit_folder;
use crate::fitting::{DrawProbabilities, nominal_of};
use crate::model::SolidId;
use crate::probability::{Progress, Sampler, Silent};
use crate::store::fit::Fit;
use crate::sweep::SweepConfig;
use crate::sweep::probability_by_place::{LeastGain, PlaceProbabilities, Preference};
use std::time::Instant;

/// Kinds that differ by more than this in P are compared by no draws: the better one is.
const FAR_APART: f64 = 0.1;

/// Finds in how many draws of a player's fit the bank shot is the better one, at each place where
/// one kind is preferred to the other. A place and its mirror image have one answer, of both
/// together, unless the draws tell the two sides apart: few shots are measured, and what a player
/// does on the left is then what is known of the right.
pub(super) fn find_sureness(
    places: &mut [PlaceProbabilities],
    config: &SweepConfig,
    fit: &Fit,
    progress: &dyn Progress,
) -> Result<(), Failure> {
    let is_open = |place: &PlaceProbabilities| {
        let is_near = |gain: Difference| gain.value.abs() <= FAR_APART;
        place.preference() != Some(Preference::Either) && place.bank_gain().is_some_and(is_near)
    };
    let mirror_of = |places: &[PlaceProbabilities], i: usize| {
        let mut others = places.iter();
        others.position(|other| places[i].has_mirror_in(&[other]))
    };
    let mirrors: Vec<Option<usize>> = (0..places.len()).map(|i| mirror_of(places, i)).collect();
    let is_asked =
        |i: usize| is_open(&places[i]) || mirrors[i].is_some_and(|mirror| is_open(&places[mirror]));
    let asked: Vec<usize> = (0..places.len()).filter(|&i| is_asked(i)).collect();
    progress.begin("bank or direct, over the draws", asked.len() as u64);
    let mut gains: Vec<Option<DrawProbabilities>> = vec![None; places.len()];
    for &i in &asked {
        if let [Some(direct), Some(bank)] = &places[i].nominals {
            let profile = config.settings.at(places[i].place.location())?;
            let gain = fit_folder::bank_gain_over_draws(fit, &profile, [direct, bank])?;
            gains[i] = Some(gain);
        }
        progress.advance(1);
    }
    progress.end();
    for &i in &asked {
        let Some(gain) = &gains[i] else { continue };
        let mirror = mirrors[i].and_then(|mirror| gains[mirror].as_ref());
        let told_apart = mirror.and_then(|mirror| told_apart(gain, mirror));
        let both = mirror.is_some() && told_apart.is_none();
        let of_mirror = mirrors[i].filter(|_| both);
        let of_mirror = of_mirror.and_then(|mirror| places[mirror].bank_gain());
        let own = places[i].bank_gain();
        let place = &mut places[i];
        place.gain_of_both_sides = own.zip(of_mirror).map(|(a, b)| Difference {
            value: 0.5 * (a.value + b.value),
            standard_error: 0.5 * libm::hypot(a.standard_error, b.standard_error),
        });
        place.fitted_shots = Some(fit.posterior.shots);
        place.sides_differ = told_apart;
        place.bank_is_better = Some(match mirror {
            Some(mirror) if told_apart.is_none() => share_of_both(gain, mirror),
            _ => gain.share_positive(),
        });
    }
    Ok(())
}

/// The share of the draws that agree on which side bank gains more, where it is so large that the
/// sides differ.
fn told_apart(gain: &DrawProbabilities, mirror: &DrawProbabilities) -> Option<f64> {
    const TOLD_APART: f64 = 0.975;
    let more_here = gain.minus(mirror).share_positive();
    let agree = more_here.max(1.0 - more_here);
    (agree >= TOLD_APART).then_some(agree)
}

/// The share of the draws in which bank is better at a place and its mirror image together.
fn share_of_both(gain: &DrawProbabilities, mirror: &DrawProbabilities) -> f64 {
    let both = gain.of_draws.iter().zip(&mirror.of_draws);
    let positive = both.filter(|(a, b)| *a + *b > 0.0).count();
    positive as f64 / gain.of_draws.len() as f64
}

/// Seconds that [`find_sureness`] takes at one place, measured with a shot of the fit.
pub(super) fn sureness_s(fit: &Fit) -> f64 {
    let nominal = nominal_of(&fit.posterior.typical().means[0]);
    let start = Instant::now();
    match fit_folder::bank_gain_over_draws(fit, &fit.profiles[0], [&nominal; 2]) {
        Ok(_) => start.elapsed().as_secs_f64(),
        Err(_) => 0.0,
    }
}

/// Standard error of P with another ring or board: the differences share their samples.
const HOOP_ERROR: f64 = 0.002;

/// Finds by how much the bank shot, where it is preferred, is better on the rings and boards that
/// the gym may have: nobody measured those. The shots stay as they are.
pub(super) fn find_hoop_dependence(
    places: &mut [PlaceProbabilities],
    config: &SweepConfig,
    (low, high): (f64, f64),
    progress: &dyn Progress,
) -> Result<(), Failure> {
    let is_bank = |place: &&mut PlaceProbabilities| place.preference() == Some(Preference::Bank);
    let places: Vec<&mut PlaceProbabilities> = places.iter_mut().filter(is_bank).collect();
    progress.begin("bank or direct on other hoops", places.len() as u64);
    for place in places {
        if let [Some(direct), Some(bank)] = place.nominals {
            let profile = config.settings.at(place.place.location())?;
            let boards = likely_board_restitutions(profile.physics());
            let rings = [low, high].map(|of| (SolidId::Ring, of));
            let all = rings
                .into_iter()
                .chain(boards.map(|of| (SolidId::Board, of)));
            for (solid, restitution) in all {
                let other = profile.with(|settings| {
                    let set = settings.physics.set_restitution_on(solid, restitution);
                    debug_assert!(set.is_ok(), "between 0 and 1");
                })?;
                let sampler = Sampler::new(&other);
                let [direct, bank] = [&direct, &bank].map(|shot| {
                    let seed = other.search().seed;
                    sampler
                        .estimate(shot, HOOP_ERROR, seed, &Silent)
                        .probability
                });
                let found = LeastGain {
                    gain: bank - direct,
                    solid,
                    restitution,
                };
                let is_less = |least: LeastGain| found.gain < least.gain;
                if place.least_gain.is_none_or(is_less) {
                    place.least_gain = Some(found);
                }
            }
        }
        progress.advance(1);
    }
    progress.end();
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both sides have the share of the draws in which bank gains on the two together; where the
    /// draws tell the sides apart each has its own.
    #[test]
    fn contract_mirror_images_have_one_answer_unless_told_apart() {
        let gains = |gain: &dyn Fn(usize) -> f64| {
            DrawProbabilities::of_values((0..100).map(gain).collect())
        };
        // Bank is better in 80 draws here and in 40 there, on average in 60.
        let here = gains(&|draw| if draw < 80 { 0.01 } else { -0.01 });
        let there = gains(&|draw| if draw % 5 < 2 { 0.012 } else { -0.009 });
        let both = share_of_both(&here, &there);
        assert_eq!(both, share_of_both(&there, &here));
        // Of the 80 draws the mean is above 0 in each, of the other 20 in the 8 of the second side.
        assert!((both - 0.88).abs() < 1e-12, "{both}");
        assert_eq!(told_apart(&here, &there), None);
        let surely_more = gains(&|_| 0.02);
        assert_eq!(told_apart(&here, &surely_more), Some(1.0));
        assert_eq!(told_apart(&surely_more, &here), Some(1.0));
    }
}
