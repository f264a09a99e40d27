//! The error of a release that a tracker of positions will measure, before anyone shoots.

use super::flight_fit::{FlightFitError, TrackedPoint, fit_flight};
use super::landing::start_of;
use super::measured_release::{Covariance, Place, Values};
use super::tracker_noise::TrackerNoise;
use crate::dynamics::Simulator;

/// The hand pushes the ball from rest for so long, s.
const PUSH_S: f64 = 0.35;

/// The covariance of the fit of a flight without errors, sampled by the tracker from the hand to
/// the height of the hoop: that of a measured flight, but for its outliers.
///
/// # Errors
/// The release does not reach the hoop, or has too few frames.
pub fn tracked_flight_noise(
    simulator: &Simulator,
    place: &Place,
    values: &Values,
    noise: &TrackerNoise,
) -> Result<Covariance, FlightFitError> {
    let start = start_of(simulator, place, values);
    let (_, fall_s) = simulator
        .undisturbed_fall_to_hoop(&start)
        .ok_or(FlightFitError::TooFewPoints(0))?;
    let frame_s = 1.0 / noise.frames_per_s;
    // Half a frame from the release, as on average.
    let first = -(PUSH_S / frame_s).floor() as i64;
    let points: Vec<TrackedPoint> = (first..(fall_s / frame_s) as i64)
        .map(|frame| {
            let time_s = (frame as f64 + 0.5) * frame_s;
            let position = if time_s < 0.0 {
                // Along the line of the release, with constant acceleration.
                let pushed = 1.0 + time_s / PUSH_S;
                start.position_m - start.velocity_m_s * (0.5 * PUSH_S * (1.0 - pushed * pushed))
            } else {
                simulator.undisturbed_state(&start, time_s).position_m
            };
            TrackedPoint {
                time_s,
                position_m: position.into(),
            }
        })
        .collect();
    let fit = fit_flight(simulator, &points, noise, place.release_height_m, values[3])?;
    Ok(fit.aim_covariance)
}
