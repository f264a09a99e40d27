//! How likely the made and missed shots are for a ring, a backspin and a constant error of the
//! tracker.
//!
//! Of each shot whose result is known, a few releases are simulated that it may have been, given
//! its measurement. They are the same for all values of the unknowns, moved by these, so that the
//! likelihood is smooth in them.

use super::constant_error::Correction;
use super::draw_probabilities::under_ring;
use super::expected_makes::{factor_of, release_given};
use super::measured_release::{MeasuredRelease, Place, Values};
use super::posterior::Draw;
use super::prior::ConstantErrorPrior;
use crate::dynamics::{BatchWorkspace, Verdict};
use crate::math::normal_distribution::quantile;
use crate::math::sobol::{ScrambleKey, Sobol};
use crate::shooter::Profile;
use nalgebra::{Vector3, Vector4};
use rayon::prelude::*;
use std::cell::RefCell;

/// Releases of a shot, least and most, and about how many there are for all shots together that are
/// not settled.
const RELEASES: (usize, usize) = (8, 32);
const ALL_RELEASES: usize = 512;
/// Results that are written down wrongly, and touches that no model has: so many of all.
const WRONG_RESULTS: f64 = 0.01;

/// A shot with a result, and the releases that it may have been: deviations from the likeliest one.
struct KnownShot<'a> {
    shot: &'a MeasuredRelease,
    likeliest: Values,
    deviations: Vec<Values>,
    correction: Correction,
    made: bool,
}

/// The shots with a result of one shooter.
pub(super) struct MakesLikelihood<'a> {
    profiles: &'a [Profile],
    /// Those of each place that are not settled.
    places: Vec<Vec<KnownShot<'a>>>,
    /// The logarithm of the likelihood of those that are.
    settled: f64,
    /// Releases of a shot that are simulated.
    releases: usize,
}

/// What no sensor sees.
#[derive(Clone, Debug)]
pub(super) struct Unseen {
    /// The restitution of the ring; `None` for that of the physics.
    pub(super) ring: Option<f64>,
    /// The mean backspin less that of the typical draw, rad/s.
    pub(super) more_backspin: f64,
    /// The tracker's constant errors, in scales of their prior.
    pub(super) constant_errors: Vector3<f64>,
}

thread_local! {
    static WORKSPACE: RefCell<BatchWorkspace> = RefCell::default();
}

impl<'a> MakesLikelihood<'a> {
    /// `typical` is the middle of what is known by the flights, `profiles` are those of its places.
    pub(super) fn new(
        (profiles, places): (&'a [Profile], &[Place]),
        shots: &'a [MeasuredRelease],
        (typical, measured_values): (&Draw, usize),
        constant_error: Option<ConstantErrorPrior>,
        seed: u64,
    ) -> Self {
        let sobol = Sobol::new();
        let known_shot = |(number, shot): (usize, &'a MeasuredRelease)| {
            let made = shot.made?;
            let (likeliest, covariance) = release_given(shot, typical, measured_values)?;
            let factor = factor_of(&covariance);
            let scramble = sobol.scrambled(ScrambleKey {
                seed,
                replicate: number as u64,
            });
            let deviation = |index: u32| -> Values {
                let z = Vector4::from_fn(|k, _| quantile(scramble.point(index, k)));
                (factor * z).into()
            };
            let simulator = profiles[shot.place].simulator();
            let place = &places[shot.place];
            Some(KnownShot {
                deviations: (0..RELEASES.1 as u32).map(deviation).collect(),
                correction: Correction::new(simulator, place, &likeliest, constant_error),
                likeliest,
                made,
                shot,
            })
        };
        let of_place = |place: usize| {
            let here = shots.iter().filter(|shot| shot.place == place);
            here.enumerate().filter_map(known_shot).collect()
        };
        Self {
            places: (0..profiles.len()).map(of_place).collect(),
            settled: 0.0,
            releases: RELEASES.0,
            profiles,
        }
    }

    /// Settles the shots that go in, or miss, whatever the unknowns are: with the first of their
    /// releases at each of these points. They need not be simulated again.
    pub(super) fn settle(&mut self, points: &[Unseen]) {
        for place in 0..self.places.len() {
            let chances: Vec<Vec<f64>> = points
                .par_iter()
                .map(|unseen| self.chances(place, unseen))
                .collect();
            let is_open = |number: usize| {
                let first = chances[0][number];
                let same = chances.iter().all(|of_point| of_point[number] == first);
                !(same && (first == 0.0 || first == 1.0))
            };
            let count = self.places[place].len();
            let open: Vec<bool> = (0..count).map(is_open).collect();
            for (number, known) in self.places[place].iter().enumerate() {
                if !open[number] {
                    self.settled += known.log_likelihood(chances[0][number]);
                }
            }
            let mut open = open.into_iter();
            self.places[place].retain(|_| open.next() == Some(true));
        }
        let open: usize = self.places.iter().map(Vec::len).sum();
        self.releases = (ALL_RELEASES / open.max(1)).clamp(RELEASES.0, RELEASES.1);
    }

    /// The logarithm of the likelihood.
    pub(super) fn logarithm(&self, unseen: &Unseen) -> f64 {
        let of_place = |place: usize| -> f64 {
            let chances = self.chances(place, unseen);
            let each = self.places[place].iter().zip(chances);
            each.map(|(known, chance)| known.log_likelihood(chance))
                .sum()
        };
        self.settled + (0..self.places.len()).map(of_place).sum::<f64>()
    }

    /// The chance of each shot from a place.
    fn chances(&self, place: usize, unseen: &Unseen) -> Vec<f64> {
        let shots = &self.places[place];
        if shots.is_empty() {
            return Vec::new();
        }
        let profile = &self.profiles[place];
        let simulator = under_ring(profile, unseen.ring);
        let errors = &unseen.constant_errors;
        let mut starts = Vec::with_capacity(shots.len() * self.releases);
        for known in shots {
            let (change, turn) = (
                known.correction.change(errors),
                known.correction.turn(errors),
            );
            let likeliest = &known.likeliest;
            for [a, b, c, spin] in &known.deviations[..self.releases] {
                let deviation = change + turn * Vector3::new(*a, *b, *c);
                let values = [
                    likeliest[0] + deviation[0],
                    likeliest[1] + deviation[1],
                    likeliest[2] + deviation[2],
                    likeliest[3] + spin + unseen.more_backspin,
                ];
                starts.push(known.shot.release(profile, &values).state());
            }
        }
        WORKSPACE.with_borrow_mut(|workspace| {
            let verdicts = simulator.finite_verdicts(&starts, workspace);
            let of_shots = verdicts.chunks(self.releases);
            let share = |verdicts: &[Verdict]| {
                let made = verdicts.iter().filter(|verdict| verdict.made).count() as f64;
                made / verdicts.len() as f64
            };
            of_shots.map(share).collect()
        })
    }
}

impl KnownShot<'_> {
    /// The logarithm of the likelihood of the result, where the shot goes in with this chance.
    fn log_likelihood(&self, chance: f64) -> f64 {
        let right = if self.made { chance } else { 1.0 - chance };
        libm::log(WRONG_RESULTS + (1.0 - 2.0 * WRONG_RESULTS) * right)
    }
}
