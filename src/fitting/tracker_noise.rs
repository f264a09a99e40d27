//! What is known of the errors of measurement.

use super::measured_release::Covariance;
use super::prior::ConstantErrorPrior;
use crate::units::{DEGREE_RAD, FOOT_M, INCH_M, REV_RAD};

/// Standard deviations of the errors of one kind of measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackerNoise {
    /// Of a release: speed (m/s), pitch and polar angle (rad), backspin (rad/s).
    pub release: [f64; 4],
    /// Of a landing: depth, left and right (m), entry angle (rad).
    pub landing: [f64; 3],
    /// Of a coordinate of a trajectory, m.
    pub position_m: f64,
    /// Correlation of the errors of a coordinate from frame to frame.
    pub frame_correlation: f64,
    /// Frames in a second of the tracker.
    pub frames_per_s: f64,
}

/// A tracker by name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracker {
    /// Its name.
    pub name: &'static str,
    /// Its errors.
    pub noise: TrackerNoise,
    /// Whether they were measured or are assumed.
    pub source: &'static str,
}

const LAB: TrackerNoise = TrackerNoise {
    release: [
        0.02 * FOOT_M,
        0.05 * DEGREE_RAD,
        0.05 * DEGREE_RAD,
        0.02 * REV_RAD,
    ],
    landing: [0.1 * INCH_M, 0.1 * INCH_M, 0.1 * DEGREE_RAD],
    position_m: 0.005 * FOOT_M,
    frame_correlation: 0.0,
    frames_per_s: 120.0,
};

impl Tracker {
    /// The trackers that have a name.
    pub const ALL: [Self; 4] = [
        Self {
            name: "lab",
            noise: LAB,
            source: "assumed",
        },
        Self {
            name: "noah",
            noise: TrackerNoise {
                landing: [0.5 * INCH_M, 0.5 * INCH_M, 0.5 * DEGREE_RAD],
                ..LAB
            },
            source: "assumed",
        },
        Self {
            name: "optical_25hz",
            noise: TrackerNoise {
                release: [
                    0.15 * FOOT_M,
                    0.34 * DEGREE_RAD,
                    0.55 * DEGREE_RAD,
                    0.02 * REV_RAD,
                ],
                position_m: 0.12 * FOOT_M,
                frame_correlation: 0.3,
                frames_per_s: 25.0,
                ..LAB
            },
            source: "measured",
        },
        Self {
            name: "optical_60hz",
            noise: TrackerNoise {
                release: [
                    0.02 * FOOT_M,
                    0.04 * DEGREE_RAD,
                    0.07 * DEGREE_RAD,
                    0.02 * REV_RAD,
                ],
                position_m: 0.02 * FOOT_M,
                frame_correlation: 0.3,
                frames_per_s: 60.0,
                ..LAB
            },
            source: "assumed",
        },
    ];

    /// The tracker of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|tracker| tracker.name == name)
    }
}

impl TrackerNoise {
    /// The name of a tracker that is known by its tracks alone.
    #[must_use]
    pub fn name_by_tracks(&self) -> String {
        format!(
            "{:.4} frames/s, {:.2} mm, correlation {:.3}",
            self.frames_per_s,
            1000.0 * self.position_m,
            self.frame_correlation
        )
    }

    /// The tracker of such a name.
    #[must_use]
    pub fn named_by_tracks(name: &str) -> Option<Self> {
        let parts: Vec<&str> = name.split(", ").collect();
        let [rate, noise, correlation] = parts[..] else {
            return None;
        };
        let number = |text: Option<&str>| text.and_then(|text| text.trim().parse::<f64>().ok());
        Some(Self {
            frames_per_s: number(rate.strip_suffix("frames/s"))?,
            position_m: number(noise.strip_suffix("mm"))? / 1000.0,
            frame_correlation: number(correlation.strip_prefix("correlation"))?,
            ..Tracker::named("optical_25hz")?.noise
        })
    }

    /// What its constant error may be (assumed): as great as the error of one shot. That of tracks
    /// is that of the landings that they lead to.
    #[must_use]
    pub fn constant_error(&self, has_releases: bool) -> ConstantErrorPrior {
        if has_releases {
            let [speed, pitch, polar, _] = self.release;
            return ConstantErrorPrior::Release([speed, pitch, polar]);
        }
        ConstantErrorPrior::Landing(self.landing)
    }

    /// The covariance of a measured release.
    #[must_use]
    pub fn release_covariance(&self) -> Covariance {
        let variances = self.release.map(|sd| sd * sd);
        Covariance::from_diagonal(&variances.into())
    }
}
