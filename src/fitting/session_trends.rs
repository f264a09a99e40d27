//! How the shots run over their sessions: whether a value drifts within one, whether a shot is like
//! the one before it, and whether the sessions differ.

use super::measured_release::{MeasuredRelease, Values};
use crate::math::normal_distribution::cdf;
use crate::shooter::ReleaseVariable;
use std::collections::{HashMap, HashSet};

/// How one value runs over the sessions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SessionTrend {
    /// The value.
    pub of: ReleaseVariable,
    /// p-value of a drift within the sessions (normal approximation of the correlation with the
    /// order).
    pub drift_p: f64,
    /// Change from the first shot of a session of mean length to its last, by the line through
    /// them, m/s, rad or rad/s.
    pub drift: f64,
    /// p-value of the correlation of a shot with the one before it in its session.
    pub serial_p: f64,
    /// p-value of equal means in all sessions (F test by Paulson's approximation, Annals of
    /// Mathematical Statistics 13 (1942) 233). `None` with one session, and where none varies.
    pub sessions_p: Option<f64>,
    /// p-value of equal scatter in all sessions (Levene's test: the same F test of the distances
    /// from the median of the session; Brown and Forsythe, JASA 69 (1974) 364). `None` with
    /// fewer than two sessions of ten shots.
    pub spreads_p: Option<f64>,
}

/// The different names of sessions: in the order of time where all are numbers, or dates with the
/// year first; else in the order in which they come.
#[must_use]
pub fn session_names(sessions: &[String]) -> Vec<&String> {
    let mut known = HashSet::new();
    let different = sessions.iter().filter(|session| known.insert(*session));
    let mut names: Vec<&String> = different.collect();
    let numbers: Option<Vec<Vec<u64>>> = names.iter().map(|name| numbers_of(name)).collect();
    if let Some(numbers) = numbers
        && numbers
            .windows(2)
            .all(|pair| pair[0].len() == pair[1].len())
    {
        let mut order: Vec<usize> = (0..names.len()).collect();
        order.sort_by(|&a, &b| numbers[a].cmp(&numbers[b]));
        names = order.into_iter().map(|k| names[k]).collect();
    }
    names
}

/// The numbers of a name that is a number, or a date with the year first.
fn numbers_of(name: &str) -> Option<Vec<u64>> {
    let is_separator = |c: char| matches!(c, '-' | '/' | '.' | ':' | ' ' | 'T');
    let parts = name.trim().split(is_separator).map(|part| {
        let is_number = !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
        part.parse().ok().filter(|_| is_number)
    });
    let numbers: Vec<u64> = parts.collect::<Option<_>>()?;
    let is_date = numbers.first().is_some_and(|year| *year >= 1900);
    (numbers.len() == 1 || is_date).then_some(numbers)
}

/// The shots of each session, in the order of the file. Without names all are of one session.
fn by_session(shots: usize, sessions: &[String]) -> Vec<Vec<usize>> {
    let mut numbers: HashMap<&str, usize> = HashMap::new();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for shot in 0..shots {
        let name = sessions.get(shot).map_or("", String::as_str);
        let group = *numbers.entry(name).or_insert(groups.len());
        if group == groups.len() {
            groups.push(Vec::new());
        }
        groups[group].push(shot);
    }
    groups
}

/// The trends of the first `values` values. `means` and `sds` are the means and the standard
/// deviations at the places; `sessions` has the name of each shot's session, or nothing.
#[must_use]
pub fn trends(
    shots: &[MeasuredRelease],
    sessions: &[String],
    (means, sds): (&[Values], &[Values]),
    values: usize,
) -> Vec<SessionTrend> {
    let groups = by_session(shots.len(), sessions);
    (0..values)
        .map(|i| trend(shots, &groups, (means, sds), i))
        .collect()
}

fn trend(
    shots: &[MeasuredRelease],
    groups: &[Vec<usize>],
    (means, sds): (&[Values], &[Values]),
    i: usize,
) -> SessionTrend {
    let deviation = |shot: &usize| shots[*shot].values[i] - means[shots[*shot].place][i];
    let (mut product, mut squares, mut order, mut lagged) = (0.0, 0.0, 0.0, 0.0);
    let mut values_of_groups = Vec::with_capacity(groups.len());
    for group in groups {
        let count = group.len() as f64;
        let own: Vec<f64> = group.iter().map(deviation).collect();
        let mean = own.iter().sum::<f64>() / count;
        let middle = 0.5 * (count - 1.0);
        for (k, deviation) in own.iter().enumerate() {
            let (t, x) = (k as f64 - middle, deviation - mean);
            product += t * x;
            squares += x * x;
            order += t * t;
        }
        let pairs = own.windows(2);
        lagged += pairs
            .map(|pair| (pair[0] - mean) * (pair[1] - mean))
            .sum::<f64>();
        values_of_groups.push(own);
    }
    let count = shots.len() as f64;
    // Each session has a mean of its own.
    let free = (count - groups.len() as f64 + 1.0).max(1.0);
    let squares = squares.max(f64::MIN_POSITIVE);
    let p_of = |correlation: f64| 2.0 * (1.0 - cdf(correlation.abs() * free.sqrt()));
    let length = count / groups.len() as f64 - 1.0;
    SessionTrend {
        of: ReleaseVariable::ALL[i],
        drift: length * product / order.max(f64::MIN_POSITIVE),
        drift_p: p_of(product / (squares * order).sqrt().max(f64::MIN_POSITIVE)),
        serial_p: p_of(lagged / squares),
        sessions_p: equal_means_p(&values_of_groups),
        spreads_p: {
            // The scatter of the speed grows with the speed, so each deviation is in units of the
            // standard deviation at its place.
            let in_sds = |shot: &usize| deviation(shot) / sds[shots[*shot].place][i];
            let large = groups.iter().filter(|group| group.len() >= LEAST_SHOTS);
            let distances = large.map(|group| {
                let own: Vec<f64> = group.iter().map(in_sds).collect();
                distances_from_median(&own)
            });
            equal_means_p(&distances.collect::<Vec<_>>())
        },
    }
}

/// Of a session with fewer shots the scatter is not compared: the distances from the median of a
/// few shots are far from independent.
const LEAST_SHOTS: usize = 10;

/// The distances of values from their median.
fn distances_from_median(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    let median = match sorted.len() {
        0 => 0.0,
        count if count % 2 == 0 => 0.5 * (sorted[middle - 1] + sorted[middle]),
        _ => sorted[middle],
    };
    values.iter().map(|value| (value - median).abs()).collect()
}

/// The p-value of equal means of groups; `None` for fewer than two, and where no group varies.
fn equal_means_p(groups: &[Vec<f64>]) -> Option<f64> {
    let count = groups.iter().map(Vec::len).sum::<usize>() as f64;
    let (mut within, mut between, mut total) = (0.0, 0.0, 0.0);
    for group in groups {
        let sum: f64 = group.iter().sum();
        let mean = sum / group.len() as f64;
        let squares = group.iter().map(|value| (value - mean) * (value - mean));
        within += squares.sum::<f64>();
        between += sum * mean;
        total += sum;
    }
    let freedom = [groups.len() as f64 - 1.0, count - groups.len() as f64];
    let between = between - total * total / count;
    (groups.len() > 1 && within > 0.0)
        .then(|| f_test(between / freedom[0] / (within / freedom[1]), freedom))
}

/// The probability that a ratio of mean squares with these degrees of freedom is greater.
fn f_test(ratio: f64, [above, below]: [f64; 2]) -> f64 {
    let root = libm::cbrt(ratio.max(0.0));
    let spread = |freedom: f64| 2.0 / (9.0 * freedom);
    let (a, b) = (spread(above), spread(below));
    1.0 - cdf(((1.0 - b) * root - (1.0 - a)) / (b * root * root + a).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitting::Covariance;
    use rand::SeedableRng;
    use rand::rngs::ChaCha12Rng;
    use rand_distr::{Distribution, StandardNormal};

    /// Sessions of normal shots; `value` makes the speed of a shot from its session, its number
    /// there and a standard normal number.
    fn simulated(
        sizes: &[usize],
        random: &mut ChaCha12Rng,
        value: impl Fn(usize, usize, f64) -> f64,
    ) -> (Vec<MeasuredRelease>, Vec<String>) {
        let (mut shots, mut sessions) = (Vec::new(), Vec::new());
        for (session, size) in sizes.iter().enumerate() {
            for number in 0..*size {
                let noise: f64 = StandardNormal.sample(random);
                shots.push(MeasuredRelease {
                    row: shots.len() as u64,
                    place: 0,
                    values: [value(session, number, noise), 0.0, 0.0, 0.0],
                    noise: Covariance::zeros(),
                    made: None,
                    own: None,
                });
                sessions.push(session.to_string());
            }
        }
        (shots, sessions)
    }

    fn speed_trend(sizes: &[usize], random: &mut ChaCha12Rng, of: Shape) -> SessionTrend {
        let (shots, sessions) = simulated(sizes, random, of);
        trends(&shots, &sessions, (&[[0.0; 4]], &[[1.0; 4]]), 1)[0]
    }

    type Shape = fn(usize, usize, f64) -> f64;

    /// Authority: a p-value is uniform where nothing differs. Of 2000 tests 100 are below 0.05,
    /// give or take 10; the seed is fixed: no false alarm.
    #[test]
    fn val_p_values_of_equal_sessions_are_uniform() {
        let mut random = ChaCha12Rng::seed_from_u64(1);
        let mut below = [0; 4];
        for _ in 0..2000 {
            let trend = speed_trend(&[30, 50, 40], &mut random, |_, _, noise| noise);
            let of_sessions = [trend.sessions_p, trend.spreads_p].map(Option::unwrap);
            let [means_p, spreads_p] = of_sessions;
            let all = [trend.drift_p, trend.serial_p, means_p, spreads_p];
            for (count, p) in below.iter_mut().zip(all) {
                *count += usize::from(p < 0.05);
            }
        }
        assert!(
            below.iter().all(|count| (60..=140).contains(count)),
            "{below:?}"
        );
    }

    /// A scatter that doubles is seen, and small sessions say nothing.
    #[test]
    fn val_a_scatter_that_differs_between_sessions_is_seen() {
        let mut random = ChaCha12Rng::seed_from_u64(3);
        let doubled = speed_trend(&[60, 60], &mut random, |session, _, noise| {
            (1 + session) as f64 * noise
        });
        assert!(doubled.spreads_p.unwrap() < 1e-3, "{doubled:?}");
        assert!(doubled.sessions_p.unwrap() > 0.005, "{doubled:?}");
        for small in [&[60, 1, 2][..], &[2, 2, 2]] {
            let trend = speed_trend(small, &mut random, |_, _, noise| noise);
            assert_eq!(trend.spreads_p, None, "{small:?}");
        }
        let constant = speed_trend(&[20, 20], &mut random, |_, _, _| 1.0);
        assert_eq!(constant.spreads_p, None);
    }

    #[test]
    fn contract_sessions_that_are_dates_or_numbers_are_in_order() {
        for (given, expected) in [
            (["2026-11-10", "2026-11-3"], ["2026-11-3", "2026-11-10"]),
            (["10", "9"], ["9", "10"]),
            // The day may come first or second.
            (["10/11/2026", "3/11/2026"], ["10/11/2026", "3/11/2026"]),
            (["spring", "autumn"], ["spring", "autumn"]),
            (["2026-11-10", "late"], ["2026-11-10", "late"]),
        ] {
            let sessions = given.map(str::to_owned);
            assert_eq!(session_names(&sessions), expected);
        }
    }

    /// Two sessions with other means are no drift, and a drift within sessions is not hidden by
    /// means that differ the other way.
    #[test]
    fn val_a_difference_between_sessions_is_no_drift() {
        let mut random = ChaCha12Rng::seed_from_u64(2);
        let apart = speed_trend(&[60, 60], &mut random, |session, _, noise| {
            1.5 * session as f64 + noise
        });
        assert!(
            apart.sessions_p.unwrap() < 1e-6 && apart.drift_p > 0.005 && apart.serial_p > 0.005,
            "{apart:?}"
        );
        let drifting = speed_trend(&[60, 60], &mut random, |session, number, noise| {
            0.03 * number as f64 - 1.8 * session as f64 + noise
        });
        assert!(drifting.drift_p < 1e-3, "{drifting:?}");
        // 59 steps of 0.03. The standard error of 59 slopes of these 120 shots is 0.31.
        assert!((drifting.drift - 59.0 * 0.03).abs() < 1.3, "{drifting:?}");
        let one = speed_trend(&[60], &mut random, |_, _, noise| noise);
        assert_eq!(one.sessions_p, None);
    }

    /// Authority: the quantiles of the F distribution in any table. The approximation is worst with
    /// two sessions, where its p is up to 6 % too small; with more it is good to 2 %.
    #[test]
    fn val_paulsons_approximation_has_the_quantiles_of_f() {
        for (ratio, freedom, p) in [
            (3.94, [1.0, 100.0], 0.05),
            (6.90, [1.0, 100.0], 0.01),
            (2.46, [4.0, 100.0], 0.05),
            (3.51, [4.0, 100.0], 0.01),
            (2.87, [4.0, 20.0], 0.05),
        ] {
            let found = f_test(ratio, freedom);
            let tolerance = if freedom[0] == 1.0 { 0.06 } else { 0.02 };
            assert!(libm::fabs(found / p - 1.0) < tolerance, "{ratio}: {found}");
        }
    }
}
