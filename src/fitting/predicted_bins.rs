//! What was measured of shots, beside what a fit predicts of them.

use serde::Serialize;

/// What was measured of the shots between two values of depth, or of left and right, and what the
/// fit predicts of them.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PredictedBin {
    /// From here on; null for all below.
    pub above_short_m: Option<f64>,
    /// Up to here; null for all above.
    pub below_short_m: Option<f64>,
    /// Shots that were measured there.
    pub shots: usize,
    /// Their number, or of makes the share that went in.
    pub seen: f64,
    /// The mean prediction.
    pub predicted: f64,
    /// Nine in ten predictions are above 5 % of them and below 95 %.
    pub low: f64,
    /// See there.
    pub high: f64,
}

impl PredictedBin {
    /// Whether what was seen is between the ends of nine in ten predictions.
    #[must_use]
    pub fn is_as_predicted(&self) -> bool {
        (self.low..=self.high).contains(&self.seen)
    }
}

/// Predicted against measured.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PredictiveCheck {
    /// Numbers of shots by depth from the front of the ring.
    pub depth: Vec<PredictedBin>,
    /// Numbers of shots to the left (below 0) and right; none where the direction was not measured.
    pub left_right: Vec<PredictedBin>,
    /// Shares of makes by depth; none without results.
    pub makes_by_depth: Vec<PredictedBin>,
}

impl PredictiveCheck {
    /// All bins.
    pub fn bins(&self) -> impl Iterator<Item = &PredictedBin> {
        let all = [&self.depth, &self.left_right, &self.makes_by_depth];
        all.into_iter().flatten()
    }
}
