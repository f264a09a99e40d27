//! How uncertain P at each of several pitch angles is, and its difference from the best of them.

use super::draw_probabilities::DrawProbabilities;
use super::interval::Interval;

/// P of the best shot at one pitch angle over the draws of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleOverDraws {
    /// P.
    pub probability: Interval,
    /// By how much it is less than at the angle with the highest mean, draw by draw.
    pub less: Interval,
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
                less: best?.minus(p).interval(),
            })
        };
        angles.iter().map(|p| angle(p.as_ref()?)).collect()
    }
}
