//! The error of a release that a tracker of positions will measure, before anyone shoots.

use super::flight_fit::{FlightFitError, TrackedPoint, fit_flight};
use super::landing::{release_of_uncertain_landing, start_of};
use super::measured_release::{Covariance, Place, Values};
use super::tracker_noise::TrackerNoise;
use crate::dynamics::Simulator;

/// The hand pushes the ball from rest for so long, s.
const PUSH_S: f64 = 0.35;

/// The covariance of the release that lands as a fitted flight without errors, sampled by the
/// tracker from the hand to the height of the hoop: that of a measured flight, but for its
/// outliers.
///
/// # Errors The release does not reach the hoop, or has too few frames.
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
    let landing = (&fit.landing, &fit.landing_covariance);
    release_of_uncertain_landing(simulator, place, landing, values[3])
        .map(|(_, covariance)| covariance)
        .map_err(|_| FlightFitError::StaysLow)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fitting::Tracker;
    use crate::math::normal_distribution::quantile;
    use crate::model::Preset;
    use crate::shooter::Location;
    use rand::rngs::ChaCha12Rng;
    use rand::{RngExt, SeedableRng};

    /// Authority: the scatter of the fits of 400 flights with the tracker's errors (known to 3.5
    /// %; the bound is four times that, and what the flights' ends cost).
    #[test]
    fn val_the_error_is_that_of_fitted_flights() {
        let simulator = Simulator::new(&Preset::named("ncaa").unwrap().physics()).unwrap();
        let place = Place {
            location: Location {
                distance_m: 4.19,
                angle_rad: 0.0,
            },
            release_height_m: 2.1,
        };
        let values = [7.45, 0.9, 0.0, 13.0];
        let noise = Tracker::named("optical_25hz").unwrap().noise;
        let said = tracked_flight_noise(&simulator, &place, &values, &noise).unwrap();
        let start = start_of(&simulator, &place, &values);
        let (_, fall_s) = simulator.undisturbed_fall_to_hoop(&start).unwrap();
        let mut random = ChaCha12Rng::seed_from_u64(5);
        let mut normal = || quantile(random.random::<f64>().max(1e-300));
        let rho = noise.frame_correlation;
        let mut squares = [0.0; 3];
        const FLIGHTS: usize = 400;
        for _ in 0..FLIGHTS {
            let mut errors = [0.0; 3].map(|_: f64| normal());
            let points: Vec<TrackedPoint> = (0..(fall_s * noise.frames_per_s) as usize)
                .map(|frame| {
                    let time_s = (frame as f64 + 0.5) / noise.frames_per_s;
                    let exact: [f64; 3] = simulator
                        .undisturbed_state(&start, time_s)
                        .position_m
                        .into();
                    errors = errors.map(|e| rho * e + (1.0 - rho * rho).sqrt() * normal());
                    TrackedPoint {
                        time_s,
                        position_m: std::array::from_fn(|i| {
                            exact[i] + noise.position_m * errors[i]
                        }),
                    }
                })
                .collect();
            let fit = fit_flight(&simulator, &points, &noise, 2.1, values[3]).unwrap();
            let landing = (&fit.landing, &fit.landing_covariance);
            let (released, _) =
                release_of_uncertain_landing(&simulator, &place, landing, values[3]).unwrap();
            for (square, (found, exact)) in squares.iter_mut().zip(released.iter().zip(values)) {
                *square += (found - exact) * (found - exact) / FLIGHTS as f64;
            }
        }
        for i in [0, 1] {
            let ratio = (said[(i, i)] / squares[i]).sqrt();
            assert!((ratio - 1.0).abs() < 0.25, "{i}: {ratio}");
        }
    }
}
