//! A flight fitted to a tracked trajectory.
//!
//! The unknowns are position and velocity at the highest tracked point. The model is the product's
//! own undisturbed flight; the errors of a coordinate are normal and correlated from frame to
//! frame, and outliers are weighed down (Huber, *Robust Statistics*, 1981). Where free flight
//! begins and ends is found: from the highest point the fit is extended, point by point, until two
//! in a row are not where the ball would be.

use super::landing::{Landing, landing_of_state, vector};
use super::measured_release::{Covariance, Place, Values};
use super::tracker_noise::TrackerNoise;
use crate::dynamics::Simulator;
use crate::math::vector::Vec3;
use crate::model::{BallState, Physics};
use crate::probability::Progress;
use crate::shooter::Location;
use nalgebra::{Matrix3, SMatrix, SVector};
use rayon::prelude::*;

/// The ball's centre at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackedPoint {
    /// s.
    pub time_s: f64,
    /// Towards the court from the hoop's centre, across, and above the hoop, m.
    pub position_m: [f64; 3],
}

/// A fitted flight and the release on it.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightFit {
    /// Speed, pitch, polar angle and the given backspin where the ball rises through the height of
    /// release.
    pub values: Values,
    /// The covariance of the errors of the first three.
    pub covariance: Covariance,
    /// Where that is.
    pub place: Place,
    /// Where it lands, and the covariance of the errors of depth, left and right, and entry angle.
    pub landing: Landing,
    /// See `landing`.
    pub landing_covariance: Matrix3<f64>,
    /// The variances of the errors of the distance (m^2) and of the court angle (rad^2).
    pub place_variances: [f64; 2],
    /// The tracked points that belong to the flight.
    pub points: std::ops::Range<usize>,
    /// Among them, those that are far from it.
    pub outliers: usize,
    /// Where free flight begins, about: height above the floor, m.
    pub begins_at_m: f64,
    /// The sum of the squared normalised residuals, and the number that is expected of it.
    pub chi_square: (f64, f64),
}

/// Why a trajectory is not fitted.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FlightFitError {
    /// A time is not after the one before.
    #[error("the time goes back or stands still after {0:.3} s")]
    TimeGoesBack(f64),
    /// Not enough points.
    #[error("has {0} points in free flight; at least {LEAST_POINTS} are needed")]
    TooFewPoints(usize),
    /// The flight stays below the hoop.
    #[error("does not rise to the hoop: no shot")]
    StaysLow,
    /// The flight does not pass the height of release upwards.
    #[error("does not rise through the height of release")]
    NoRelease,
    /// The fit does not converge to a flight.
    #[error("is not the flight of a ball")]
    NotAFlight,
}

/// Fewest points of a flight.
const LEAST_POINTS: usize = 6;
/// Half the time that is fitted at first, s.
const FIRST_HALF_S: f64 = 0.25;
/// A point farther from the flight than this many standard deviations does not belong to it.
const LARGEST_RESIDUAL: f64 = 4.0;
/// The acceleration of a ball in a hand or at the hoop beyond that of flight, about, m/s^2: 7 m/s
/// in a third of a second.
const OTHER_ACCELERATION_M_S2: f64 = 20.0;
/// From here on a residual counts linearly (Huber's k), in standard deviations.
const HUBER: f64 = 2.5;
/// Steps of the Gauss-Newton method.
const MAX_STEPS: u32 = 12;
/// Differences of the derivatives: position (m) and velocity (m/s).
const DIFFERENCE: f64 = 1e-5;

type Parameters = SVector<f64, 6>;

/// A trajectory with what is needed to fit it.
struct Track<'a> {
    simulator: &'a Simulator,
    points: &'a [TrackedPoint],
    noise: &'a TrackerNoise,
    reference_s: f64,
    backspin_rad_s: f64,
}

/// The state of a fit.
struct Solution {
    parameters: Parameters,
    covariance: SMatrix<f64, 6, 6>,
    chi_square: f64,
    /// The sum of Huber's losses, which the solution makes least; the squares where all are small.
    loss: f64,
    outliers: usize,
}

impl Track<'_> {
    fn state(&self, parameters: &Parameters) -> BallState {
        let p = parameters;
        let horizontal = libm::hypot(p[3], p[4]).max(1e-9);
        let axis = [p[4] / horizontal, -p[3] / horizontal];
        BallState {
            position_m: Vec3::new(p[0], p[1], p[2]),
            velocity_m_s: Vec3::new(p[3], p[4], p[5]),
            spin_rad_s: Vec3::new(
                axis[0] * self.backspin_rad_s,
                axis[1] * self.backspin_rad_s,
                0.0,
            ),
        }
    }

    /// The positions of the points on a flight.
    fn positions(&self, parameters: &Parameters, indices: &[usize]) -> Vec<[f64; 3]> {
        let times = indices
            .iter()
            .map(|&i| self.points[i].time_s - self.reference_s);
        self.simulator
            .undisturbed_states(&self.state(parameters), times)
            .map(|state| state.position_m.into())
            .collect()
    }

    /// What makes the errors of one coordinate independent with unit variance: the share of the
    /// error before that an error repeats, and the standard deviation of the rest.
    fn whitening(&self, indices: &[usize]) -> Vec<(f64, f64)> {
        let sigma = self.noise.position_m;
        let correlation = self.noise.frame_correlation;
        let of_pair = |pair: &[usize]| {
            let step = self.points[pair[1]].time_s - self.points[pair[0]].time_s;
            let frames = step * self.noise.frames_per_s;
            let rho = if correlation > 0.0 {
                libm::pow(correlation, frames)
            } else {
                0.0
            };
            (rho, sigma * (1.0 - rho * rho).sqrt())
        };
        std::iter::once((0.0, sigma))
            .chain(indices.windows(2).map(of_pair))
            .collect()
    }

    /// Fits the points `indices`, from a guess.
    fn solve(&self, indices: &[usize], guess: Parameters) -> Option<Solution> {
        let mut parameters = guess;
        let count = 3 * indices.len();
        let whitening = self.whitening(indices);
        let mut last = None;
        for _ in 0..MAX_STEPS {
            let at = self.positions(&parameters, indices);
            let mut residuals = vec![0.0; count];
            for axis in 0..3 {
                let rows: Vec<f64> = indices
                    .iter()
                    .zip(&at)
                    .map(|(&i, at)| self.points[i].position_m[axis] - at[axis])
                    .collect();
                for (k, value) in whitened(&whitening, &rows).enumerate() {
                    residuals[3 * k + axis] = value;
                }
            }
            let mut derivatives = vec![Parameters::zeros(); count];
            for j in 0..6 {
                let moved = |sign: f64| {
                    let mut moved = parameters;
                    moved[j] += sign * DIFFERENCE;
                    self.positions(&moved, indices)
                };
                let (up, down) = (moved(1.0), moved(-1.0));
                for axis in 0..3 {
                    let rows: Vec<f64> = up
                        .iter()
                        .zip(&down)
                        .map(|(up, down)| (up[axis] - down[axis]) / (2.0 * DIFFERENCE))
                        .collect();
                    for (k, value) in whitened(&whitening, &rows).enumerate() {
                        derivatives[3 * k + axis][j] = value;
                    }
                }
            }
            let (mut chi_square, mut loss) = (0.0, 0.0);
            let mut outliers = 0;
            let mut normal = SMatrix::<f64, 6, 6>::zeros();
            let mut right = Parameters::zeros();
            for (residual, derivative) in residuals.iter().zip(&derivatives) {
                let size = residual.abs();
                let weight = if size > HUBER { HUBER / size } else { 1.0 };
                outliers += usize::from(size > LARGEST_RESIDUAL);
                chi_square += residual * residual;
                loss += if size > HUBER {
                    HUBER * (2.0 * size - HUBER)
                } else {
                    size * size
                };
                normal += derivative * derivative.transpose() * weight;
                right += derivative * (weight * residual);
            }
            let cholesky = normal.cholesky()?;
            let step = cholesky.solve(&right);
            if !step.iter().all(|x| x.is_finite()) || step.norm() > 1e3 {
                return None;
            }
            last = Some(Solution {
                parameters,
                covariance: cholesky.inverse(),
                chi_square,
                loss,
                outliers,
            });
            parameters += step;
            if step.norm() < 1e-7 {
                break;
            }
        }
        last.map(|solution| Solution {
            parameters,
            ..solution
        })
    }

    /// Whether a point is where the fitted ball would be.
    fn belongs(&self, solution: &Solution, index: usize) -> bool {
        let one = [index];
        let at = self.positions(&solution.parameters, &one)[0];
        let mut derivatives = SMatrix::<f64, 3, 6>::zeros();
        for j in 0..6 {
            let mut moved = solution.parameters;
            moved[j] += DIFFERENCE;
            let up = self.positions(&moved, &one)[0];
            for axis in 0..3 {
                derivatives[(axis, j)] = (up[axis] - at[axis]) / DIFFERENCE;
            }
        }
        let predicted = derivatives * solution.covariance * derivatives.transpose();
        let sigma = self.noise.position_m;
        (0..3).all(|axis| {
            let allowed = (sigma * sigma + predicted[(axis, axis)]).sqrt();
            let residual = self.points[index].position_m[axis] - at[axis];
            residual.abs() <= LARGEST_RESIDUAL * allowed
        })
    }

    /// A parabola through the points.
    fn parabola(&self, indices: &[usize]) -> Option<Parameters> {
        let g = self.simulator.physics().gravity_m_s2;
        let count = indices.len() as f64;
        let times: Vec<f64> = indices
            .iter()
            .map(|&i| self.points[i].time_s - self.reference_s)
            .collect();
        let mean_time = times.iter().sum::<f64>() / count;
        let spread: f64 = times
            .iter()
            .map(|t| (t - mean_time) * (t - mean_time))
            .sum();
        if !(spread > 0.0) {
            return None;
        }
        let mut parameters = Parameters::zeros();
        for axis in 0..3 {
            let fall = if axis == 2 { 0.5 * g } else { 0.0 };
            let values: Vec<f64> = indices
                .iter()
                .zip(&times)
                .map(|(&i, t)| self.points[i].position_m[axis] + fall * t * t)
                .collect();
            let mean = values.iter().sum::<f64>() / count;
            let product: f64 = values
                .iter()
                .zip(&times)
                .map(|(value, t)| (value - mean) * (t - mean_time))
                .sum();
            let slope = product / spread;
            parameters[axis] = mean - slope * mean_time;
            parameters[3 + axis] = slope;
        }
        Some(parameters)
    }

    /// Extends the fit from its last index outwards, point by point; returns whether it ended
    /// before the track did.
    fn extend(&self, indices: &mut Vec<usize>, solution: &mut Solution, forwards: bool) -> bool {
        let radius = self.simulator.physics().ball_radius_m;
        let mut skipped = 0;
        let mut next = if forwards {
            indices.last().map(|last| last + 1)
        } else {
            indices.first().and_then(|first| first.checked_sub(1))
        };
        while let Some(index) = next.filter(|&index| index < self.points.len()) {
            // Lower than this the ball can touch the ring, or is in the net.
            if forwards && self.positions(&solution.parameters, &[index])[0][2] < radius {
                return false;
            }
            if self.belongs(solution, index) {
                skipped = 0;
                if forwards {
                    indices.push(index);
                } else {
                    indices.insert(0, index);
                }
                match self.solve(indices, solution.parameters) {
                    Some(better) => *solution = better,
                    None => return true,
                }
            } else {
                skipped += 1;
                if skipped == 2 {
                    return true;
                }
            }
            next = if forwards {
                Some(index + 1)
            } else {
                index.checked_sub(1)
            };
        }
        false
    }

    /// How many points at an end can be of a hand or a touch without being seen: there the ball has
    /// [`OTHER_ACCELERATION_M_S2`] more than in flight, and needs this long to be off by
    /// [`LARGEST_RESIDUAL`]. (To choose the end that fits best would make the errors greater than
    /// the covariance says, by a third.)
    fn margin(&self) -> usize {
        let off_m = LARGEST_RESIDUAL * self.noise.position_m;
        let unseen_s = (2.0 * off_m / OTHER_ACCELERATION_M_S2).sqrt();
        (unseen_s * self.noise.frames_per_s).ceil() as usize
    }

    /// Speed, pitch, polar angle, distance and court angle where the fitted ball rises through a
    /// height.
    fn release(&self, parameters: &Parameters, height_m: f64) -> Option<[f64; 5]> {
        let start = self.state(parameters);
        let mut state = start;
        let mut time = 0.0;
        // Backwards from the highest point; Newton's method in time.
        if state.velocity_m_s.z < 1.0 {
            let g = self.simulator.physics().gravity_m_s2;
            time = -((2.0 * (state.position_m.z - height_m).max(0.01) / g).sqrt())
                + state.velocity_m_s.z / g;
            state = self.simulator.undisturbed_state(&start, time);
        }
        for _ in 0..50 {
            let miss = state.position_m.z - height_m;
            let rate = state.velocity_m_s.z;
            if !(rate > 1e-3) {
                return None;
            }
            if miss.abs() < 1e-12 {
                break;
            }
            time -= miss / rate;
            if !(time.abs() < 10.0) {
                return None;
            }
            state = self.simulator.undisturbed_state(&start, time);
        }
        let (p, v) = (state.position_m, state.velocity_m_s);
        let horizontal = libm::hypot(v.x, v.y);
        let polar = libm::atan2(-v.y, -v.x);
        let court_angle = libm::atan2(p.y, p.x);
        Some([
            libm::hypot(horizontal, v.z),
            libm::atan2(v.z, horizontal),
            polar,
            libm::hypot(p.x, p.y),
            court_angle,
        ])
    }
}

/// The values of one coordinate, each less what the one before predicts.
fn whitened(whitening: &[(f64, f64)], rows: &[f64]) -> impl Iterator<Item = f64> {
    let before = std::iter::once(0.0).chain(rows.iter().copied());
    let next = whitening.iter().zip(rows).zip(before);
    next.map(|((&(rho, sd), row), before)| (row - rho * before) / sd)
}

/// Fits the flight of one tracked shot. `release_height_m` is above the floor.
///
/// # Errors
/// The track is no flight from that height.
pub fn fit_flight(
    simulator: &Simulator,
    points: &[TrackedPoint],
    noise: &TrackerNoise,
    release_height_m: f64,
    backspin_rad_s: f64,
) -> Result<FlightFit, FlightFitError> {
    for pair in points.windows(2) {
        if !(pair[1].time_s > pair[0].time_s) {
            return Err(FlightFitError::TimeGoesBack(pair[0].time_s));
        }
    }
    // Not later than the first fall to the ring: a bounce can rise higher than the shot.
    let low = simulator.physics().ball_radius_m + 2.0 * noise.position_m;
    let is_high = |point: &TrackedPoint| point.position_m[2] > low;
    let rise = points.windows(3).position(|next| next.iter().all(is_high));
    let fall = rise.and_then(|rise| points[rise..].iter().position(|point| !is_high(point)));
    let points = match (rise, fall) {
        (Some(rise), Some(fall)) => &points[..rise + fall],
        _ => points,
    };
    let top = (0..points.len())
        .max_by(|&a, &b| points[a].position_m[2].total_cmp(&points[b].position_m[2]))
        .ok_or(FlightFitError::TooFewPoints(0))?;
    let track = Track {
        simulator,
        points,
        noise,
        reference_s: points[top].time_s,
        backspin_rad_s,
    };
    let mut indices: Vec<usize> = (0..points.len())
        .filter(|&i| (points[i].time_s - track.reference_s).abs() <= FIRST_HALF_S)
        .collect();
    while indices.len() < LEAST_POINTS {
        let before = indices[0].checked_sub(1);
        let after = indices
            .last()
            .map(|last| last + 1)
            .filter(|&i| i < points.len());
        match (before, after) {
            (None, None) => return Err(FlightFitError::TooFewPoints(indices.len())),
            (Some(before), None) => indices.insert(0, before),
            (None, Some(after)) => indices.push(after),
            (Some(before), Some(after)) => {
                indices.insert(0, before);
                indices.push(after);
            }
        }
    }
    let guess = track.parabola(&indices).ok_or(FlightFitError::NotAFlight)?;
    let mut solution = track
        .solve(&indices, guess)
        .ok_or(FlightFitError::NotAFlight)?;
    let ended = track.extend(&mut indices, &mut solution, true);
    let began = track.extend(&mut indices, &mut solution, false);
    for (is_cut, at_end) in [(ended, true), (began, false)] {
        let margin = track
            .margin()
            .min(indices.len().saturating_sub(LEAST_POINTS));
        if is_cut && at_end {
            indices.truncate(indices.len() - margin);
        } else if is_cut {
            indices.drain(..margin);
        }
    }
    let solution = track
        .solve(&indices, solution.parameters)
        .ok_or(FlightFitError::NotAFlight)?;
    // In the middle of the points that may be of the hand.
    let unseen = if began {
        0.5 * track.margin() as f64
    } else {
        0.0
    };
    let begins_s = points[indices[0]].time_s - track.reference_s - unseen / noise.frames_per_s;
    let first = simulator.undisturbed_state(&track.state(&solution.parameters), begins_s);
    let begins_at_m = first.position_m.z + simulator.physics().hoop_plane_height_m();
    let height_m = release_height_m - simulator.physics().hoop_plane_height_m();
    let landing_at = |parameters: &Parameters, angle_rad: f64| {
        landing_of_state(simulator, &track.state(parameters), angle_rad)
    };
    // Speed, pitch, polar angle, distance, court angle, and the landing.
    let at = |parameters: &Parameters| {
        let [speed, pitch, polar, distance, angle] = track.release(parameters, height_m)?;
        let landing = vector(&landing_at(parameters, angle)?);
        Some([
            speed, pitch, polar, distance, angle, landing.x, landing.y, landing.z,
        ])
    };
    let found = track
        .release(&solution.parameters, height_m)
        .ok_or(FlightFitError::NoRelease)?;
    let landing = landing_at(&solution.parameters, found[4]).ok_or(FlightFitError::StaysLow)?;
    let mut derivatives = SMatrix::<f64, 8, 6>::zeros();
    for j in 0..6 {
        let mut moved = solution.parameters;
        moved[j] += DIFFERENCE;
        let up = at(&moved).ok_or(FlightFitError::NoRelease)?;
        moved[j] -= 2.0 * DIFFERENCE;
        let down = at(&moved).ok_or(FlightFitError::NoRelease)?;
        for i in 0..8 {
            derivatives[(i, j)] = (up[i] - down[i]) / (2.0 * DIFFERENCE);
        }
    }
    let all = derivatives * solution.covariance * derivatives.transpose();
    let mut covariance = Covariance::zeros();
    covariance
        .fixed_view_mut::<3, 3>(0, 0)
        .copy_from(&all.fixed_view::<3, 3>(0, 0));
    let [speed, pitch, polar, distance_m, angle_rad] = found;
    Ok(FlightFit {
        values: [speed, pitch, polar, backspin_rad_s],
        covariance,
        place: Place {
            location: Location {
                distance_m,
                angle_rad,
            },
            release_height_m,
        },
        landing,
        landing_covariance: all.fixed_view::<3, 3>(5, 5).into_owned(),
        place_variances: [all[(3, 3)], all[(4, 4)]],
        points: indices[0]..indices[indices.len() - 1] + 1,
        outliers: solution.outliers,
        begins_at_m,
        chi_square: (solution.chi_square, (3 * indices.len()) as f64 - 6.0),
    })
}

/// A drag coefficient from tracked flights.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DragEstimate {
    /// The value that fits best.
    pub best: f64,
    /// Its standard error, by how much the flights differ from each other.
    pub standard_error: f64,
    /// The 95 % interval (Student's t over the flights).
    pub interval: [f64; 2],
    /// Flights that it is from.
    pub flights: usize,
}

/// So long after its first frame in the air a flight counts for the drag, s. A hand that still
/// leads the ball, unseen beside the tracker's noise, makes the drag too small: with 2 to 4 frames
/// of a 25 Hz tracker less, measured three-point shots give 0.39 to 0.41 in place of 0.35.
const HAND_S: f64 = 0.12;

/// The drag coefficient that fits tracked flights best. `tracks` are the points in free flight of
/// each shot, which may be from anywhere.
///
/// Its error is that of a sum of independent flights (White, Econometrica 48 (1980) 817): what
/// differs from flight to flight, such as the spin, is in it. `None` where fewer than three
/// flights, or none with air, tell it.
#[must_use]
pub fn fit_drag_coefficient(
    physics: &Physics,
    tracks: &[&[TrackedPoint]],
    noise: &TrackerNoise,
    backspin_rad_s: f64,
    progress: &dyn Progress,
) -> Option<DragEstimate> {
    if tracks.is_empty() {
        return None;
    }
    progress.begin("finding the drag", 12 * tracks.len() as u64);
    let found = best_drag_coefficient(physics, tracks, (noise, backspin_rad_s), progress);
    progress.end();
    found
}

/// [`fit_drag_coefficient`] within its stage: twelve coefficients are tried on each flight.
fn best_drag_coefficient(
    physics: &Physics,
    tracks: &[&[TrackedPoint]],
    (noise, backspin_rad_s): (&TrackerNoise, f64),
    progress: &dyn Progress,
) -> Option<DragEstimate> {
    let flights: Vec<&[TrackedPoint]> = tracks
        .iter()
        .map(|points| {
            let free = points
                .iter()
                .position(|point| point.time_s >= points[0].time_s + HAND_S)
                .unwrap_or(0);
            &points[free.min(points.len().saturating_sub(LEAST_POINTS))..]
        })
        .collect();
    // The loss of each flight.
    let losses = |coefficient: f64| -> Option<Vec<f64>> {
        let mut changed = physics.clone();
        changed.air.drag_coefficient = coefficient;
        let simulator = Simulator::new(&changed).ok()?;
        let loss = |points: &&[TrackedPoint]| {
            progress.advance(1);
            let middle = points.len() / 2;
            let track = Track {
                simulator: &simulator,
                points,
                noise,
                reference_s: points[middle].time_s,
                backspin_rad_s,
            };
            let indices: Vec<usize> = (0..points.len()).collect();
            let guess = track.parabola(&indices)?;
            Some(track.solve(&indices, guess)?.loss)
        };
        flights.par_iter().map(loss).collect()
    };
    let around = |centre: f64, step: f64| -> Option<[Vec<f64>; 3]> {
        Some([
            losses(centre - step)?,
            losses(centre)?,
            losses(centre + step)?,
        ])
    };
    let curvature_of = |of_each: &[Vec<f64>; 3], step: f64| {
        let [low, middle, high] = of_each.each_ref().map(|losses| losses.iter().sum::<f64>());
        (low - 2.0 * middle + high) / (step * step)
    };
    // The sum is nearly a parabola of the coefficient.
    let (mut centre, mut step) = (0.5, 0.3);
    for _ in 0..3 {
        let of_each = around(centre, step)?;
        let curvature = curvature_of(&of_each, step);
        if !(curvature > 0.0) {
            return None;
        }
        let [low, high] = [0, 2].map(|k: usize| of_each[k].iter().sum::<f64>());
        centre = (centre + 0.5 * (low - high) / (step * curvature)).clamp(0.0, 3.0);
        // About the standard error: the loss grows by 1.
        step = (2.0 / curvature).sqrt().clamp(1e-4, 0.3);
        centre = centre.max(step);
    }
    let of_each = around(centre, step)?;
    let curvature = curvature_of(&of_each, step);
    let count = flights.len() as f64;
    if flights.len() < 3 || !(curvature > 0.0) {
        return None;
    }
    let slopes = of_each[2].iter().zip(&of_each[0]);
    let square: f64 = slopes
        .map(|(high, low)| 0.5 * (high - low) / step)
        .map(|slope| slope * slope)
        .sum();
    let standard_error = (square * count / (count - 1.0)).sqrt() / curvature;
    let half = standard_error * student_975(count - 1.0);
    Some(DragEstimate {
        best: centre,
        standard_error,
        interval: [centre - half, centre + half],
        flights: flights.len(),
    })
}

/// The 0.975 quantile of Student's t (Abramowitz and Stegun 26.7.5), to 1 % from 4 degrees of
/// freedom on.
fn student_975(freedom: f64) -> f64 {
    const Z: f64 = 1.959_963_984_540_054;
    let square = Z * Z;
    let first = Z * (square + 1.0) / 4.0;
    let second = Z * (5.0 * square * square + 16.0 * square + 3.0) / 96.0;
    let third = Z * (((3.0 * square + 19.0) * square + 17.0) * square - 15.0) / 384.0;
    Z + (first + (second + third / freedom) / freedom) / freedom
}

#[cfg(test)]
mod tests {
    use super::super::landing::start_of;
    use super::super::tracker_noise::Tracker;
    use super::*;
    use crate::math::normal_distribution::quantile;
    use crate::model::Preset;
    use crate::probability::Silent;
    use crate::units::{DEGREE_RAD, FOOT_M};
    use rand::rngs::ChaCha12Rng;
    use rand::{RngExt, SeedableRng};

    /// A shot tracked in the hand, in flight, and after it has met the ring.
    fn tracked(
        simulator: &Simulator,
        place: &Place,
        values: &Values,
        noise: &TrackerNoise,
        random: &mut ChaCha12Rng,
    ) -> Vec<TrackedPoint> {
        let start = start_of(simulator, place, values);
        let (_, fall_s) = simulator.undisturbed_fall_to_hoop(&start).unwrap();
        let frame_s = 1.0 / noise.frames_per_s;
        let phase: f64 = random.random();
        let rho = noise.frame_correlation;
        let mut errors = [0.0; 3];
        let mut points = Vec::new();
        for frame in -8..((fall_s + 0.3) / frame_s) as i32 {
            let t = (f64::from(frame) + phase) * frame_s;
            let position = if t < 0.0 {
                // Pushed along the line of the release, from rest.
                let back = 0.5 * (1.0 - (1.0 + t / 0.35).max(0.0) * (1.0 + t / 0.35));
                start.position_m - start.velocity_m_s * (back * 0.35)
            } else if t < fall_s {
                simulator.undisturbed_state(&start, t).position_m
            } else {
                let end = simulator.undisturbed_state(&start, fall_s);
                end.position_m + Vec3::new(1.0, 0.3, 2.0) * (t - fall_s)
            };
            let mut point: [f64; 3] = position.into();
            for (value, error) in point.iter_mut().zip(&mut errors) {
                let z = quantile(random.random::<f64>().max(1e-12));
                *error = if frame == -8 {
                    z
                } else {
                    rho * *error + (1.0 - rho * rho).sqrt() * z
                };
                *value += noise.position_m * *error;
            }
            points.push(TrackedPoint {
                time_s: 10.0 + t,
                position_m: point,
            });
        }
        points
    }

    fn place() -> Place {
        Place {
            location: Location {
                distance_m: 13.75 * FOOT_M,
                angle_rad: 0.4,
            },
            release_height_m: 7.0 * FOOT_M,
        }
    }

    /// The errors of 400 shots against their stated covariances. A correct fit fails one run in a
    /// thousand; the random numbers are fixed.
    #[test]
    fn val_releases_of_tracked_flights_err_as_stated() {
        let physics = Preset::named("ncaa").unwrap().physics();
        let simulator = Simulator::new(&physics).unwrap();
        let place = place();
        for name in ["optical_25hz", "optical_60hz"] {
            let noise = Tracker::named(name).unwrap().noise;
            let mut random = ChaCha12Rng::seed_from_u64(7);
            let (mut sum, mut shots) = (0.0, 0);
            for i in 0..400 {
                let values = [
                    (23.9 + 0.2 * f64::from(i % 7 - 3)) * FOOT_M,
                    (51.0 + f64::from(i % 5)) * DEGREE_RAD,
                    0.4 + 0.01 * f64::from(i % 3 - 1),
                    0.0,
                ];
                let points = tracked(&simulator, &place, &values, &noise, &mut random);
                let fit =
                    fit_flight(&simulator, &points, &noise, place.release_height_m, 0.0).unwrap();
                let error = SVector::<f64, 3>::from_fn(|i, _| fit.values[i] - values[i]);
                let covariance = fit.covariance.fixed_view::<3, 3>(0, 0).into_owned();
                sum += error.dot(&covariance.cholesky().unwrap().solve(&error));
                shots += 1;
            }
            // Chi-square with 1200 degrees of freedom: mean 1200, standard deviation 49.
            let expected = 3.0 * f64::from(shots);
            let limit = 3.3 * (2.0 * expected).sqrt();
            assert!(
                (sum - expected).abs() < limit,
                "{name}: {sum} of {expected}"
            );
        }
    }

    #[test]
    fn val_the_drag_coefficient_comes_out_of_thirty_flights() {
        let physics = Preset::named("ncaa").unwrap().physics();
        let simulator = Simulator::new(&physics).unwrap();
        let noise = Tracker::named("optical_25hz").unwrap().noise;
        let mut random = ChaCha12Rng::seed_from_u64(3);
        let place = place();
        let tracks: Vec<Vec<TrackedPoint>> = (0..30)
            .map(|_| {
                let values = [24.0 * FOOT_M, 0.9, 0.4, 0.0];
                let points = tracked(&simulator, &place, &values, &noise, &mut random);
                let fit =
                    fit_flight(&simulator, &points, &noise, place.release_height_m, 0.0).unwrap();
                points[fit.points].to_vec()
            })
            .collect();
        let tracks: Vec<&[TrackedPoint]> = tracks.iter().map(Vec::as_slice).collect();
        let DragEstimate {
            best,
            interval: [low, high],
            ..
        } = fit_drag_coefficient(&physics, &tracks, &noise, 0.0, &Silent).unwrap();
        let truth = physics.air.drag_coefficient;
        assert!(low < truth && truth < high, "{best} {low} {high}");
        assert!(high - low < 0.6, "{low} {high}");
    }

    #[test]
    fn contract_bad_tracks_are_refused() {
        let simulator = Simulator::new(&Preset::named("ncaa").unwrap().physics()).unwrap();
        let noise = Tracker::named("optical_25hz").unwrap().noise;
        let mut random = ChaCha12Rng::seed_from_u64(1);
        let values = [24.0 * FOOT_M, 0.9, 0.4, 0.0];
        let points = tracked(&simulator, &place(), &values, &noise, &mut random);
        let fit = |points: &[TrackedPoint]| fit_flight(&simulator, points, &noise, 2.1336, 0.0);
        assert_eq!(fit(&points[10..13]), Err(FlightFitError::TooFewPoints(3)));
        let mut back = points.clone();
        back.swap(10, 11);
        assert!(matches!(fit(&back), Err(FlightFitError::TimeGoesBack(_))));
        assert!(fit(&[]).is_err());
    }
}
