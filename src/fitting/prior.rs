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
            mean: 2.25 * REV_RAD,
            sd: 0.4 * REV_RAD,
        },
        aim: Spread {
            mean: 0.0,
            sd: 0.4 * DEGREE_RAD,
        },
    };
}

/// Student's t distribution with four degrees of freedom.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StudentSpread {
    /// Its middle.
    pub middle: f64,
    /// Its scale: half of it is within 0.74 of these, 95 % within 2.78.
    pub scale: f64,
}

impl StudentSpread {
    /// The normal likelihood that turns this into a distribution with this mean and standard
    /// deviation, as if it were normal; `None` where it is no narrower.
    #[must_use]
    pub fn likelihood(&self, mean: f64, sd: f64) -> Option<Spread> {
        // The variance of t with four degrees of freedom is 2.
        let own = 1.0 / (2.0 * self.scale * self.scale);
        let precision = 1.0 / (sd * sd) - own;
        (precision > 0.0).then(|| Spread {
            mean: (mean / (sd * sd) - self.middle * own) / precision,
            sd: 1.0 / precision.sqrt(),
        })
    }
}

/// The constant error of a tracker: by how much it reads all shots too high, which no shot shows.
/// Each is t distributed about 0 with this scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ConstantErrorPrior {
    /// Of speed (m/s), pitch and polar angle (rad).
    Release([f64; 3]),
    /// Of depth, left and right (m), entry angle (rad) of the landing.
    Landing([f64; 3]),
}

/// What is known, before any make, of what no sensor sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnseenPrior {
    /// The restitution of the ring; `None` where it was measured or given: that of the physics.
    pub ring: Option<StudentSpread>,
    /// What the shots of others under the same ring say of it.
    pub ring_of_others: Option<Spread>,
    /// The constant error of the tracker; `None` for none.
    pub constant_error: Option<ConstantErrorPrior>,
    /// How far shooters aim from their best shot; `None` for a flat prior.
    pub aim: Option<AimPrior>,
}

/// How far the aims of shooters lie from their best shot: scales of a t distribution with four
/// degrees of freedom, in common for all values and places, so that a shooter who is far off in one
/// may be so in the others.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AimPrior {
    /// Of the speed, from the best one for the shooter's own angle, m/s.
    pub speed_m_s: f64,
    /// Of the angle, from the best one, rad.
    pub pitch_rad: f64,
    /// Of the direction, from the best one, rad.
    pub polar_rad: f64,
}

impl AimPrior {
    /// That of the population (assumed; `docs/fitting.md` has the sources).
    pub const POPULATION: Self = Self {
        speed_m_s: 0.08 * FOOT_M,
        pitch_rad: 2.0 * DEGREE_RAD,
        polar_rad: 0.4 * DEGREE_RAD,
    };
}

/// The rings of gyms. One hoop was measured near 0.70; rule books let a ring absorb 35 to 50 % of a
/// ball's energy, and estimates with two masses go down to 0.41. 95 % are from 0.46 to 0.84.
pub const RINGS_OF_GYMS: StudentSpread = StudentSpread {
    middle: 0.65,
    scale: 0.07,
};

impl UnseenPrior {
    /// Nothing but the flights: ring and tracker are right, any aim is as likely as any other.
    pub const NONE: Self = Self {
        ring: None,
        ring_of_others: None,
        constant_error: None,
        aim: None,
    };
}

/// What a prior is of.
#[cfg_attr(test, derive(schemars::JsonSchema))]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PriorOf {
    /// The ring's restitution.
    Ring,
    /// A backspin that was not measured.
    Backspin,
    /// The constant error of the tracker.
    ConstantError,
    /// How far the aim lies from the best shot.
    Aim,
    /// The standard deviations, and the correlation of speed and pitch angle.
    Scatter,
    /// The aim from side to side, where the direction was not measured.
    Direction,
}

/// The logarithm of a prior's density at each draw, but for a constant.
#[derive(Clone, Debug)]
pub struct PriorOfDraws {
    /// See there.
    pub of: PriorOf,
    /// Draw by draw.
    pub log_densities: Vec<f64>,
}
