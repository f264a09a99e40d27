//! What a team's sweeps hold for each player, and who is best from where.

use super::player_advice::PlayerAdvice;
use crate::analysis::sensitivity::Difference;
use crate::sweep::probability_by_place::{PlaceProbabilities, Preference};

/// A player's finished sweep.
pub(super) struct PlayerSweep {
    pub(super) name: String,
    pub(super) places: Vec<PlaceProbabilities>,
    /// The standard deviation of P that a fitted player's shots leave; 0 for an exact profile.
    pub(super) probability_sd: f64,
    /// The part of it that all players have in common: the ring.
    pub(super) shared_sd: f64,
    /// What a fitted player's own shots say.
    pub(super) advice: Option<PlayerAdvice>,
}

impl PlayerSweep {
    /// The places where a bank shot is surely better, those with the greatest gain first.
    pub(super) fn bank_places(&self) -> Vec<&PlaceProbabilities> {
        self.by_gain(|place| place.preference() == Some(Preference::Bank) && place.is_sure())
    }

    /// The places where the measured shots leave bank or direct open.
    pub(super) fn unsure_places(&self) -> Vec<&PlaceProbabilities> {
        self.by_gain(|place| !place.is_sure())
    }

    /// Some places, those where a bank shot gains most first.
    fn by_gain(&self, wanted: impl Fn(&PlaceProbabilities) -> bool) -> Vec<&PlaceProbabilities> {
        let mut places: Vec<&PlaceProbabilities> =
            self.places.iter().filter(|place| wanted(place)).collect();
        let gain = |place: &PlaceProbabilities| place.bank_gain().map_or(1.0, |gain| gain.value);
        places.sort_by(|a, b| gain(b).total_cmp(&gain(a)));
        places
    }
}

/// Players whose P differs by less than this are level.
const LEVEL: f64 = 0.01;

/// The players with the greatest P at each place: those who are not surely worse than the best one
/// by a shot in 100, or by twice the error of the difference.
pub(super) fn best_players(players: &[PlayerSweep]) -> Vec<Vec<usize>> {
    (0..players[0].places.len())
        .map(|place| {
            let found: Vec<(usize, Difference)> = players
                .iter()
                .enumerate()
                .filter_map(|(i, player)| {
                    let mut p = player.places[place].best()?;
                    p.standard_error = libm::hypot(p.standard_error, player.probability_sd);
                    Some((i, p))
                })
                .collect();
            let best = found.iter().map(|(_, p)| *p);
            let Some(best) = best.reduce(|a, b| if b.value > a.value { b } else { a }) else {
                return Vec::new();
            };
            let is_level = |(_, p): &&(usize, Difference)| {
                let error = libm::hypot(p.standard_error, best.standard_error);
                best.value - p.value <= LEVEL.max(2.0 * error)
            };
            found.iter().filter(is_level).map(|(i, _)| *i).collect()
        })
        .collect()
}
