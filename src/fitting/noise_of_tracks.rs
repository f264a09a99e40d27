//! The frame rate and the noise of a tracker, from the flights that it saw.
//!
//! About its highest point a flight is a cubic of the time, but for a tenth of a millimetre. What
//! is left of each coordinate is the tracker's error less the part that a cubic takes: for errors
//! that repeat from frame to frame (of first order) the expected sums of squares and of products of
//! neighbours are known exactly, and the two that were seen give the standard deviation and the
//! correlation.

use super::flight_fit::TrackedPoint;
use super::tracker_noise::{Tracker, TrackerNoise};

/// Half the time about the highest point, s.
const HALF_S: f64 = 0.3;
/// Points of a window, at least and at most.
const POINTS: (usize, usize) = (8, 41);
/// Coefficients of a cubic.
const COEFFICIENTS: usize = 4;
/// Windows that tell enough.
const FEWEST_WINDOWS: usize = 6;
/// Flights that are looked at.
const MOST_FLIGHTS: usize = 80;
/// A residual of so many standard deviations is a mistake of the tracker, and its window is left
/// out.
const MISTAKE: f64 = 5.0;
/// Correlations that are looked for.
const MOST_CORRELATION: f64 = 0.95;
/// No tracker is better than this, m.
const LEAST_NOISE_M: f64 = 1e-4;

/// The noise of the tracker; what does not show in tracks is that of the usual one. `None` where
/// too few flights tell it.
#[must_use]
pub fn noise_of_tracks(tracks: &[&[TrackedPoint]]) -> Option<TrackerNoise> {
    let every = tracks.len().div_ceil(MOST_FLIGHTS).max(1);
    let tracks: Vec<&[TrackedPoint]> = tracks.iter().step_by(every).copied().collect();
    let mut steps: Vec<f64> = tracks
        .iter()
        .flat_map(|points| {
            points
                .windows(2)
                .map(|pair| pair[1].time_s - pair[0].time_s)
        })
        .filter(|step| *step > 0.0)
        .collect();
    let frame_s = median(&mut steps)?;
    let windows: Vec<Window> = tracks
        .iter()
        .filter_map(|points| around_top(points, frame_s))
        .collect();
    let mut sizes: Vec<f64> = windows
        .iter()
        .flat_map(|window| window.residuals.iter().flatten().map(|r| r.abs()))
        .collect();
    // The median of a normal error's size is 0.6745 standard deviations.
    let robust_sd = median(&mut sizes)? / 0.6745;
    let is_good = |window: &&Window| {
        let mut all = window.residuals.iter().flatten();
        all.all(|r| r.abs() <= MISTAKE * robust_sd)
    };
    let good: Vec<&Window> = windows.iter().filter(is_good).collect();
    if good.len() < FEWEST_WINDOWS {
        return None;
    }
    let seen = good.iter().fold([0.0; 2], |sum, window| {
        let [square, product] = window.sums();
        [sum[0] + square, sum[1] + product]
    });
    // The sums for errors of variance 1; windows of one length share them.
    let expected = |correlation: f64| {
        let mut of_length: Vec<(usize, [f64; 2])> = Vec::new();
        let mut sum = [0.0; 2];
        for window in &good {
            let length = window.residuals[0].len();
            let known = of_length.iter().find(|(known, _)| *known == length);
            let [square, product] = match known {
                Some((_, sums)) => *sums,
                None => {
                    let sums = expected_sums(&window.basis, correlation);
                    of_length.push((length, sums));
                    sums
                }
            };
            sum = [sum[0] + 3.0 * square, sum[1] + 3.0 * product];
        }
        sum
    };
    let ratio = seen[1] / seen[0];
    let (mut low, mut high) = (0.0, MOST_CORRELATION);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        let [square, product] = expected(middle);
        if product / square < ratio {
            low = middle;
        } else {
            high = middle;
        }
    }
    let usual = Tracker::named("optical_25hz")?.noise;
    Some(TrackerNoise {
        position_m: (seen[0] / expected(low)[0]).sqrt().max(LEAST_NOISE_M),
        frame_correlation: low,
        frames_per_s: 1.0 / frame_s,
        ..usual
    })
}

fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// The frames about the highest point of a flight.
struct Window {
    /// Orthonormal polynomials at the frames.
    basis: Vec<Vec<f64>>,
    /// What they leave of each coordinate, m.
    residuals: [Vec<f64>; 3],
}

impl Window {
    /// The sums of squares and of products of neighbours, over the coordinates.
    fn sums(&self) -> [f64; 2] {
        let squares = self.residuals.iter().flatten().map(|r| r * r);
        let products = self
            .residuals
            .iter()
            .flat_map(|r| r.windows(2).map(|pair| pair[0] * pair[1]));
        [squares.sum(), products.sum()]
    }
}

fn around_top(points: &[TrackedPoint], frame_s: f64) -> Option<Window> {
    // The first top: a bounce can rise higher than the shot.
    let is_high = |point: &TrackedPoint| point.position_m[2] > 0.0;
    let rise = points.iter().position(is_high)?;
    let fall = points[rise..].iter().position(|point| !is_high(point));
    let flight = &points[rise..fall.map_or(points.len(), |fall| rise + fall)];
    let height = |point: &&TrackedPoint| point.position_m[2];
    let top = flight
        .iter()
        .max_by(|a, b| height(a).total_cmp(&height(b)))?
        .time_s;
    let near: Vec<&TrackedPoint> = flight
        .iter()
        .filter(|point| (point.time_s - top).abs() <= HALF_S)
        .take(POINTS.1)
        .collect();
    let is_even = near.windows(2).all(|pair| {
        let frames = (pair[1].time_s - pair[0].time_s) / frame_s;
        (0.7..1.3).contains(&frames)
    });
    if near.len() < POINTS.0 || !is_even {
        return None;
    }
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for degree in 0..COEFFICIENTS {
        let middle = 0.5 * (near.len() - 1) as f64;
        let powers = (0..near.len()).map(|k| {
            let x = k as f64 / middle - 1.0;
            (0..degree).fold(1.0, |power, _| power * x)
        });
        let mut column: Vec<f64> = without(&basis, powers.collect());
        let norm = column.iter().map(|c| c * c).sum::<f64>().sqrt();
        column.iter_mut().for_each(|c| *c /= norm);
        basis.push(column);
    }
    let residuals = [0, 1, 2].map(|axis| {
        let values = near.iter().map(|point| point.position_m[axis]).collect();
        without(&basis, values)
    });
    Some(Window { basis, residuals })
}

/// Values less their part along orthonormal vectors.
fn without(basis: &[Vec<f64>], mut values: Vec<f64>) -> Vec<f64> {
    for vector in basis {
        let along: f64 = vector.iter().zip(&values).map(|(q, v)| q * v).sum();
        for (value, q) in values.iter_mut().zip(vector) {
            *value -= along * q;
        }
    }
    values
}

/// The expected sums of squares and of products of neighbours of what polynomials leave of errors
/// with variance 1 and this correlation from frame to frame.
fn expected_sums(basis: &[Vec<f64>], correlation: f64) -> [f64; 2] {
    let count = basis[0].len();
    let powers: Vec<f64> = std::iter::successors(Some(1.0), |power| Some(power * correlation))
        .take(count)
        .collect();
    // Columns of M R, M = 1 - Q Q', then rows of M R M.
    let correlated: Vec<Vec<f64>> = (0..count)
        .map(|j| {
            let column = (0..count).map(|i| powers[i.abs_diff(j)]);
            without(basis, column.collect())
        })
        .collect();
    let mut sums = [0.0; 2];
    for i in 0..count {
        let row = without(basis, correlated.iter().map(|column| column[i]).collect());
        sums[0] += row[i];
        if i + 1 < count {
            sums[1] += row[i + 1];
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::normal_distribution::quantile;
    use rand::rngs::ChaCha12Rng;
    use rand::{RngExt, SeedableRng};

    /// Authority: the errors that were put in, on parabolas. The estimates of 60 flights are known
    /// to 3 % and 0.04 (400 frames and more); the bounds are three times that.
    #[test]
    fn val_noise_and_rate_come_out_of_flights() {
        for (rate, sd, rho) in [(25.0, 0.037, 0.3), (100.0, 0.01, 0.0), (60.0, 0.006, 0.6)] {
            let mut random = ChaCha12Rng::seed_from_u64(3);
            let mut normal = || quantile(random.random::<f64>().max(1e-300));
            let tracks: Vec<Vec<TrackedPoint>> = (0..60)
                .map(|flight| {
                    let mut errors = [0.0; 3].map(|_: f64| normal());
                    (0..(1.1 * rate) as usize)
                        .map(|frame| {
                            let t = frame as f64 / rate;
                            errors =
                                errors.map(|e| rho * e + (1.0_f64 - rho * rho).sqrt() * normal());
                            let mut position =
                                [4.2 - 4.0 * t, 0.1 * t, -0.9 + 5.7 * t - 4.9 * t * t];
                            for (value, error) in position.iter_mut().zip(errors) {
                                *value += sd * error;
                            }
                            // One flight in twenty has a frame in the stands.
                            if flight % 20 == 0 && frame == (0.6 * rate) as usize {
                                position[0] += 2.0;
                            }
                            TrackedPoint {
                                time_s: t,
                                position_m: position,
                            }
                        })
                        .collect()
                })
                .collect();
            let tracks: Vec<&[TrackedPoint]> = tracks.iter().map(Vec::as_slice).collect();
            let noise = noise_of_tracks(&tracks).unwrap();
            assert!((noise.frames_per_s / rate - 1.0).abs() < 1e-6);
            assert!((noise.position_m / sd - 1.0).abs() < 0.1, "{noise:?}");
            assert!((noise.frame_correlation - rho).abs() < 0.13, "{noise:?}");
        }
    }
}
