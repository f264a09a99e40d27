//! Who of some players is best, as far as their measured shots tell.

use crate::math::normal_distribution::cdf;

/// Two players are in order where the first is better with this probability.
const CLEAR: f64 = 0.9;
/// Points of the integral, and how many standard deviations it reaches.
const POINTS: usize = 2001;
const REACH: f64 = 6.0;

/// P of a player and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Standing {
    pub(super) value: f64,
    pub(super) standard_error: f64,
}

/// The order of players.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ranking {
    /// Their numbers: the best first where that is clear, else as they came.
    pub(super) order: Vec<usize>,
    pub(super) is_clear: bool,
    /// The probability that each is the best one, for independent normal errors.
    pub(super) is_best: Vec<f64>,
}

impl Ranking {
    pub(super) fn of(players: &[Standing]) -> Self {
        let mut order: Vec<usize> = (0..players.len()).collect();
        order.sort_by(|&a, &b| players[b].value.total_cmp(&players[a].value));
        let is_clear = order.windows(2).all(|pair| {
            let [better, worse] = [players[pair[0]], players[pair[1]]];
            let error = libm::hypot(better.standard_error, worse.standard_error).max(1e-12);
            cdf((better.value - worse.value) / error) >= CLEAR
        });
        if !is_clear {
            order.sort_unstable();
        }
        Self {
            order,
            is_clear,
            is_best: probabilities_of_best(players),
        }
    }

    /// How a table of the players is ordered.
    pub(super) fn in_words(&self) -> &'static str {
        if self.is_clear {
            "highest first"
        } else {
            "in the given order, as the order is not clear"
        }
    }
}

/// For each player, the integral of their density and the others' distributions.
fn probabilities_of_best(players: &[Standing]) -> Vec<f64> {
    let z =
        |player: &Standing, value: f64| (value - player.value) / player.standard_error.max(1e-6);
    let of_player = |own: usize| {
        let player = &players[own];
        let mut sum = 0.0;
        let mut weights = 0.0;
        for k in 0..POINTS {
            let x = REACH * (2.0 * k as f64 / (POINTS - 1) as f64 - 1.0);
            let value = player.value + x * player.standard_error.max(1e-6);
            let weight = libm::exp(-0.5 * x * x);
            let others = players
                .iter()
                .enumerate()
                .filter(|(other, _)| *other != own);
            sum += weight
                * others
                    .map(|(_, other)| cdf(z(other, value)))
                    .product::<f64>();
            weights += weight;
        }
        sum / weights
    };
    (0..players.len()).map(of_player).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn player(value: f64, standard_error: f64) -> Standing {
        Standing {
            value,
            standard_error,
        }
    }

    /// Authority: symmetry (equal players are best with 1/n each), and the distribution of the
    /// difference of two normal numbers.
    #[test]
    fn val_probability_of_being_best() {
        let copies = Ranking::of(&[player(0.6, 0.04); 6]);
        assert!(copies.is_best.iter().all(|p| (p - 1.0 / 6.0).abs() < 1e-6));
        assert!(!copies.is_clear && copies.order == [0, 1, 2, 3, 4, 5]);
        let two = Ranking::of(&[player(0.60, 0.03), player(0.65, 0.04)]);
        assert!((two.is_best[1] - cdf(1.0)).abs() < 1e-4, "{two:?}");
        assert!(!two.is_clear);
        let clear = Ranking::of(&[player(0.6, 0.001), player(0.7, 0.001)]);
        assert!(clear.is_clear && clear.order == [1, 0]);
    }
}
