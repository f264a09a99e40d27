//! What is known of a quantity.

use serde::Serialize;

/// Mean, standard deviation and the middle 95 % of some values.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The mean.
    pub mean: f64,
    /// The standard deviation.
    pub sd: f64,
    /// The 2.5 % quantile.
    pub low: f64,
    /// The 97.5 % quantile.
    pub high: f64,
}

impl Interval {
    /// Of at least one value.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
        values.sort_by(f64::total_cmp);
        // Between such order statistics of independent draws lie 95 % of the distribution on
        // average.
        let at = |p: f64| {
            let place = (p * (count + 1.0) - 1.0).clamp(0.0, count - 1.0);
            let below = place.floor() as usize;
            let above = (below + 1).min(values.len() - 1);
            values[below] + (place - place.floor()) * (values[above] - values[below])
        };
        Self {
            mean,
            sd: (squares / (count - 1.0).max(1.0)).sqrt(),
            low: at(0.025),
            high: at(0.975),
        }
    }

    /// The interval in another unit.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self {
            mean: self.mean * factor,
            sd: self.sd * factor,
            low: self.low * factor,
            high: self.high * factor,
        }
    }
}
