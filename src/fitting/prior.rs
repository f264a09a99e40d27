//! What is known of shooters before any shot is measured: the prior.
//!
//! Shooters' standard deviations were measured as 0.15 to 0.45 ft/s (speed), 1.0 to 2.7 deg (pitch
//! angle) and 0.8 to 1.5 deg (polar angle), the correlation of speed and pitch angle as -0.25 to
//! 0.5, and no growth of the scatter with the speed from 4.2 to 6.75 m. Those of the backspin are
//! assumed. The prior is wider: a shooter in twenty is outside 0.21 to 4.8 times the middle of the
//! measured range, and a correlation in twenty outside -0.53 to 0.53 (speed and pitch angle: -0.78
//! to 0.86), so that a test of some tens of shots decides for itself.
//!
//! Wider priors of the other correlations would make the standard deviations too great: three
//! unknown correlations cost them up to two degrees of freedom. Narrower priors of the standard
//! deviations and of the correlation of speed and pitch angle would pull shooters at the edges of
//! the population to its middle, above all where the tracker errs as much as they scatter.

use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD};
use serde::Serialize;

/// A normal distribution.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation.
    pub sd: f64,
}

/// The prior of a shooter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PopulationPrior {
    /// Median standard deviations: speed (m/s), pitch and polar angle (rad), backspin (rad/s).
    pub median_sd: [f64; 4],
    /// Standard deviations of their logarithms.
    pub log_sd: [f64; 4],
    /// Fisher's z (inverse hyperbolic tangent) of the correlation of speed and pitch angle.
    pub speed_pitch: Spread,
    /// Spread of the other partial correlations.
    pub other_correlations: Spread,
    /// Relative growth of the speed's standard deviation for a relative growth of the speed, and
    /// the same of the square.
    pub growth: Spread,
    /// Mean backspin of a shooter whose spin is not measured, rad/s.
    pub backspin: Spread,
    /// Mean direction from the hoop's centre of a shooter whose direction is not measured, rad
    /// (assumed).
    pub aim: Spread,
}

impl PopulationPrior {
    /// That of the measured shooters.
    pub const MEASURED: Self = Self {
        median_sd: [
            0.26 * FOOT_M,
            1.64 * DEGREE_RAD,
            1.1 * DEGREE_RAD,
            0.3 * REV_RAD,
        ],
        log_sd: [0.8, 0.8, 0.8, 0.6],
        speed_pitch: Spread {
            mean: 0.125,
            sd: 0.6,
        },
        other_correlations: Spread { mean: 0.0, sd: 0.3 },
        growth: Spread { mean: 0.0, sd: 0.5 },
        backspin: Spread {
            mean: 2.5 * REV_RAD,
            sd: 0.25 * REV_RAD,
        },
        aim: Spread {
            mean: 0.0,
            sd: 0.4 * DEGREE_RAD,
        },
    };
}
