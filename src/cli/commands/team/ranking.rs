//! Who of some players is best, as far as their measured shots tell.

use crate::math::normal_distribution::cdf;

/// Two players are in order where the first is better with this probability.
const CLEAR: f64 = 0.9;
/// Points of the integral, and how many standard deviations it reaches.
const POINTS: usize = 2001;
const REACH: f64 = 6.0;

/// P of a player and its standard error, without what is the same for all players: the ring as far
/// as no makes tell it, which averaging cannot make smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Standing {
    pub(super) value: f64,
    pub(super) standard_error: f64,
}

/// How far the players of a team lie apart in P: the scale of a half-normal prior. Free-throw
/// percentages of college players have a standard deviation of about 0.1 (assumed for other shots).
const SPREAD_OF_PLAYERS: f64 = 0.1;
/// Standard deviations between players that are averaged over, in steps of a hundredth of the
/// scale.
const SPREADS: usize = 400;
/// A smaller error is that of a profile that is taken as exact.
const EXACT: f64 = 1e-3;

/// What is known of each player if they are of one team (partial pooling: normal players with an
/// unknown mean, flat, and an unknown spread; Gelman et al., *Bayesian Data Analysis*, 3rd edition,
/// 2013, section 5.4): what the shots leave open is drawn towards the mean of the team. Profiles
/// that are taken as exact stay as they are.
pub(super) fn pooled(players: &[Standing]) -> Vec<Standing> {
    let measured: Vec<&Standing> = players
        .iter()
        .filter(|player| player.standard_error > EXACT)
        .collect();
    if measured.len() < 2 {
        return players.to_vec();
    }
    // Of each spread its weight, the team's mean and the precision of it.
    let of_spread = |number: usize| {
        let spread = 0.01 * (number as f64 + 0.5) * SPREAD_OF_PLAYERS;
        let precision = |player: &Standing| {
            1.0 / (player.standard_error * player.standard_error + spread * spread)
        };
        let sum: f64 = measured.iter().map(|player| precision(player)).sum();
        let mean = measured
            .iter()
            .map(|player| precision(player) * player.value / sum)
            .sum::<f64>();
        let of_player = |player: &&Standing| {
            let from_mean = player.value - mean;
            libm::log(precision(player)) - precision(player) * from_mean * from_mean
        };
        let ratio = spread / SPREAD_OF_PLAYERS;
        let twice = measured.iter().map(of_player).sum::<f64>() - libm::log(sum) - ratio * ratio;
        (0.5 * twice, spread, mean, sum)
    };
    let spreads: Vec<_> = (0..SPREADS).map(of_spread).collect();
    let greatest = spreads
        .iter()
        .map(|of| of.0)
        .fold(f64::NEG_INFINITY, f64::max);
    let total: f64 = spreads.iter().map(|of| libm::exp(of.0 - greatest)).sum();
    let of_player = |player: &Standing| {
        if player.standard_error <= EXACT {
            return *player;
        }
        let own = player.standard_error * player.standard_error;
        let (mut first, mut second) = (0.0, 0.0);
        for (log, spread, mean, sum) in &spreads {
            let weight = libm::exp(log - greatest) / total;
            let to_mean = own / (own + spread * spread);
            let value = player.value + to_mean * (mean - player.value);
            let variance = (1.0 - to_mean) * own + to_mean * to_mean / sum;
            first += weight * value;
            second += weight * (variance + value * value);
        }
        Standing {
            value: first,
            standard_error: (second - first * first).max(0.0).sqrt(),
        }
    };
    players.iter().map(of_player).collect()
}

/// A standard deviation without the part that all players have in common.
pub(super) fn own_sd(all: f64, shared: f64) -> f64 {
    (all * all - shared * shared).max(0.0).sqrt()
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

    /// Authority: players who differ by no more than their errors come together by more than half,
    /// those who differ by far more stay where they are, and a profile taken as exact always does.
    /// The eight schools of Rubin (J. Educ. Stat. 6 (1981) 377; *Bayesian Data Analysis*, table
    /// 5.3) in hundredths have posterior means of about 5 to 11 and standard deviations of 6 to 8.
    #[test]
    fn val_pooling_of_players() {
        let spread = |players: &[Standing]| {
            let values = players.iter().map(|player| player.value);
            let (low, high) = values.fold((1.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
            high - low
        };
        let copies = [0.59, 0.62, 0.63, 0.65, 0.66, 0.68].map(|value| player(value, 0.04));
        let together = pooled(&copies);
        assert!(spread(&together) < 0.5 * spread(&copies), "{together:?}");
        assert!(together.iter().all(|player| player.standard_error < 0.04));
        let apart = [0.3, 0.5, 0.8].map(|value| player(value, 0.02));
        for (before, after) in apart.iter().zip(pooled(&apart)) {
            assert!((before.value - after.value).abs() < 0.01, "{after:?}");
        }
        let exact = [player(0.5, 1e-4), player(0.6, 0.05), player(0.7, 0.05)];
        assert_eq!(pooled(&exact)[0], exact[0]);
        let schools = [
            (28, 15),
            (8, 10),
            (-3, 16),
            (7, 11),
            (-1, 9),
            (1, 11),
            (18, 10),
            (12, 18),
        ];
        let schools =
            schools.map(|(value, error)| player(0.01 * f64::from(value), 0.01 * f64::from(error)));
        for school in pooled(&schools) {
            assert!((school.value - 0.079).abs() < 0.045, "{school:?}");
            assert!(school.standard_error < 0.09, "{school:?}");
        }
    }
}
