//! What should be said of a fit, as data; the words are elsewhere.

use super::expected_makes::wilson_interval;
use super::interval::Interval;
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

/// Makes that contradict the measured shots: nothing that rests on these is to be used.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction {
    /// Shots that went in.
    pub made: usize,
    /// Shots with a result.
    pub shots: usize,
    /// Shots that the measured releases predict to go in.
    pub expected: f64,
}

impl Contradiction {
    /// That of a whole fit, from its notes and the number of its shots with a result.
    #[must_use]
    pub fn of_fit(notes: &[FitNote], shots: usize) -> Option<Self> {
        notes.iter().find_map(|note| match note {
            FitNote::OtherMakes { made, expected, .. } => Some(Self {
                made: *made,
                shots,
                expected: *expected,
            }),
            _ => None,
        })
    }

    /// That of a place, from P of the current shot there: 3 standard errors or more, which about
    /// 1 of 400 places has by luck.
    #[must_use]
    pub fn of_place((made, shots): (usize, usize), p: &Interval) -> Option<Self> {
        const MOST_STANDARD_ERRORS: f64 = 3.0;
        let count = wilson_interval(made, shots);
        let error = libm::hypot(0.25 * (count.high - count.low), p.sd);
        let differs = libm::fabs(count.share - p.mean) >= MOST_STANDARD_ERRORS * error;
        (shots > 0 && differs).then_some(Self {
            made,
            shots,
            expected: p.mean * shots as f64,
        })
    }
}
