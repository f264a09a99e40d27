//! What should be said of a fit, as data; the words are elsewhere.

use crate::shooter::ReleaseVariable;
use crate::units::Measure;
use serde::{Deserialize, Serialize};

/// A shot with its chance and what became of it.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurprisingShot {
    /// The line or row of the file.
    pub row: u64,
    /// The chance that it goes in.
    pub chance: f64,
    /// Whether it went in.
    pub made: bool,
}

/// What should be said of a fit.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "code", rename_all = "snake_case")]
pub enum FitNote {
    /// The tracker's error is as large as the scatter.
    NoisyTracker {
        /// Of which value.
        of: ReleaseVariable,
        /// Its share of the variance of the measurements.
        share: f64,
    },
    /// The population tells more of the scatter than the shots.
    MostlyPopulation {
        /// Of which value.
        of: ReleaseVariable,
        /// Its weight.
        weight: f64,
    },
    /// The tracker seems to err more, or less, than stated.
    OtherNoise {
        /// The seen over the stated error of a position.
        scatter_ratio: f64,
    },
    /// The flights reject the drag coefficient of the physics.
    OtherDrag {
        /// The one that they fit.
        best: f64,
        /// 2.5 % of its distribution are below.
        low: f64,
        /// 2.5 % are above.
        high: f64,
        /// That of the physics.
        of_physics: f64,
    },
    /// The shots are not normal.
    NotNormal {
        /// p-value of Mardia's skewness.
        skewness_p: f64,
        /// p-value of Mardia's kurtosis.
        kurtosis_p: f64,
        /// Whether the sessions differ, which alone can cause it.
        sessions_differ: bool,
    },
    /// Heavier tails than normal ones were fitted.
    HeavyTails {
        /// Of Student's t.
        degrees_of_freedom: f64,
        /// Whether the shots show that they are heavier.
        is_seen: bool,
    },
    /// The aim drifts within the sessions.
    Drift {
        /// Of which value.
        of: ReleaseVariable,
        /// The p-value.
        p: f64,
        /// By how much, from the first shot to the last.
        by: Measure,
    },
    /// The means of the sessions differ.
    SessionsDiffer {
        /// Of which value.
        of: ReleaseVariable,
        /// The p-value.
        p: f64,
    },
    /// The scatter of sessions differs.
    ScatterDiffers {
        /// Of which value.
        of: ReleaseVariable,
        /// The p-value.
        p: f64,
    },
    /// The number of makes is not what these shots give.
    OtherMakes {
        /// Makes that were seen.
        made: usize,
        /// Makes that were expected.
        expected: f64,
        /// The standard deviation of their number.
        expected_sd: f64,
    },
    /// The chances are overconfident.
    TooSure {
        /// See [`ExpectedMakes::calibration_z`](super::ExpectedMakes).
        calibration_z: f64,
        /// The most surprising shots.
        shots: Vec<SurprisingShot>,
    },
    /// Neighbouring shots are alike.
    SerialCorrelation {
        /// Of which value.
        of: ReleaseVariable,
        /// The p-value.
        p: f64,
    },
}
