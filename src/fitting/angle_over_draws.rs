//! How uncertain P at each of several pitch angles is, and its difference from the best of them.

use super::draw_probabilities::DrawProbabilities;
use super::interval::Interval;
use serde::Serialize;

/// P of the best shot at one pitch angle over the draws of a fit.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AngleOverDraws {
    /// P.
    pub probability: Interval,
    /// By how much it is less than at the angle with the highest mean, draw by draw.
    pub below_best: Interval,
}

/// The first and the last of the indices between which the best angle lies in 95 of 100 draws;
/// `None` without a draw.
#[must_use]
pub fn best_angles_of_draws(angles: &[Option<DrawProbabilities>]) -> Option<(usize, usize)> {
    let shots = angles.iter().enumerate();
    let shots: Vec<(usize, &[f64])> = shots
        .filter_map(|(i, p)| Some((i, &p.as_ref()?.of_draws[..])))
        .collect();
    let draws = shots.first()?.1.len();
    let mut best: Vec<usize> = (0..draws)
        .filter_map(|draw| {
            let of_draw = shots.iter().map(|(i, p)| (*i, p[draw]));
            Some(of_draw.reduce(|a, b| if b.1 > a.1 { b } else { a })?.0)
        })
        .collect();
    best.sort_unstable();
    // As many draws beyond each end as 2.5 of 100 are at most.
    let beyond = (0.025 * draws as f64) as usize;
    Some((*best.get(beyond)?, *best.get(draws - 1 - beyond)?))
}

impl AngleOverDraws {
    /// For each angle, in their order; `None` where there is no shot.
    #[must_use]
    pub fn of_angles(angles: &[Option<DrawProbabilities>]) -> Vec<Option<Self>> {
        let shots = angles.iter().flatten();
        let best = shots.max_by(|a, b| a.interval().mean.total_cmp(&b.interval().mean));
        let angle = |p: &DrawProbabilities| {
            Some(Self {
                probability: p.interval(),
                below_best: best?.minus(p).interval(),
            })
        };
        angles.iter().map(|p| angle(p.as_ref()?)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten draws whose best angles are the first, eight times the second, and the third; and 200
    /// that have them 4, 192 and 4 times.
    #[test]
    fn contract_the_best_angles_leave_out_a_fortieth_of_the_draws_at_each_end() {
        let of = |counts: [usize; 3]| {
            let draws: Vec<usize> = (0..3).flat_map(|i| vec![i; counts[i]]).collect();
            let p = |angle: usize| {
                let of_draws = draws.iter().map(|best| f64::from(u8::from(*best == angle)));
                Some(DrawProbabilities::of_values(of_draws.collect()))
            };
            best_angles_of_draws(&[p(0), None, p(1), p(2)])
        };
        assert_eq!(of([1, 8, 1]), Some((0, 3)));
        assert_eq!(of([4, 192, 4]), Some((2, 2)));
        assert_eq!(best_angles_of_draws(&[None]), None);
    }
}
