//! A segment of a flight as a polynomial of time: gravity, drag and lift.
//!
//! The coefficients are those of the Taylor series of the motion, term by term from
//!
//! ```text
//! v' = -g z^ - k s v + l (w x v)        s = |v|,  s^2 = v.v
//! ```
//!
//! As a function of complex time, `|v|` has a singularity at a distance of about `|v|/|a|` (for
//! gravity alone exactly there: where `v_h^2 + (v_z - g t)^2 = 0`), with |a| the sum of the sizes
//! of all accelerations. That limits the radius of convergence, so a path holds for a fraction of
//! that time. Without air it is the parabola.

use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec3};
use crate::model::BallState;
use crate::model::ball_params::BallParams;

/// Terms of the velocity.
const TERMS: usize = 9;
/// The time for which a path holds, as a fraction of |v|/|a|: the position then errs by less than
/// 1e-7 m.
const FRACTION: f64 = 0.45;
/// The shortest path, s.
pub(super) const SHORTEST_S: f64 = 0.01;
/// Where the shortest path is a greater fraction than this of |v|/|a|, |v| is taken as constant.
pub(super) const LONGEST_FRACTION: f64 = 0.6;

/// A segment of a flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FlightPath<T: Real = f64> {
    /// Coefficients of the position, m.
    position: [Vec3<T>; TERMS + 1],
    spin_rad_s: Vec3<T>,
    has_air: bool,
    /// For how long it holds, s.
    pub(crate) longest_s: T,
    /// The inverse of a bound on the speed until then, s/m.
    pub(crate) inverse_speed_bound: T,
    /// A bound on the acceleration until then, m/s^2.
    pub(crate) acceleration_bound: T,
    /// A bound on the acceleration by the air alone, m/s^2.
    pub(crate) air_acceleration_bound: T,
}

impl<T: Real> FlightPath<T> {
    /// The path that starts at `state`.
    #[inline(always)]
    pub(crate) fn new(ball: &BallParams<T>, state: &BallState<T>) -> Self {
        let (v, w) = (state.velocity_m_s, state.spin_rad_s);
        let (zero, one) = (ball.zero(), ball.one());
        let acceleration = ball.free_acceleration(v, w);
        let speed = v.norm();
        let spin = w.norm();
        let accelerations = ball.gravity + (ball.drag * speed + ball.lift.abs() * spin) * speed;
        let singular_s = speed / accelerations;
        let shortest = ball.splat(SHORTEST_S);
        let longest_s = Real::max(singular_s * FRACTION, shortest);
        let speed_bound = speed + ball.gravity * longest_s;
        let air_acceleration_bound = if ball.has_air {
            (ball.drag * speed_bound + ball.lift.abs() * spin) * speed_bound
        } else {
            zero
        };
        let mut path = Self {
            position: [Vec3::splat(zero); TERMS + 1],
            spin_rad_s: w,
            has_air: ball.has_air,
            longest_s,
            inverse_speed_bound: one / Real::max(speed_bound, ball.splat(1e-9)),
            acceleration_bound: air_acceleration_bound + ball.gravity,
            air_acceleration_bound,
        };
        path.position[0] = state.position_m;
        path.position[1] = v;
        path.position[2] = acceleration * (one * 0.5);
        if !ball.has_air {
            return path;
        }
        let mut velocity = [Vec3::splat(zero); TERMS];
        (velocity[0], velocity[1]) = (v, acceleration);
        let mut speeds = [zero; TERMS];
        speeds[0] = speed;
        let varies = shortest.le(singular_s * LONGEST_FRACTION);
        let half_inverse = (one * 0.5) / speed.select(varies, one);
        for n in 1..TERMS - 1 {
            // The coefficient n of v.v, and from it that of |v|.
            let mut square = zero;
            for i in 0..=n {
                square += velocity[i].dot(velocity[n - i]);
            }
            for i in 1..n {
                square -= speeds[i] * speeds[n - i];
            }
            speeds[n] = (square * half_inverse).select(varies, zero);
            // The coefficient n of |v| v.
            let mut product = Vec3::splat(zero);
            for i in 0..=n {
                product = product.add_scaled(velocity[n - i], speeds[i]);
            }
            let u = velocity[n];
            let lift = Vec3::new(
                w.y * u.z - w.z * u.y,
                w.z * u.x - w.x * u.z,
                w.x * u.y - w.y * u.x,
            );
            let rate = lift * ball.lift - product * ball.drag;
            velocity[n + 1] = rate * (one * (1.0 / (n + 1) as f64));
        }
        for (n, coefficient) in velocity.iter().enumerate().skip(2) {
            path.position[n + 1] = *coefficient * (one * (1.0 / (n + 1) as f64));
        }
        path
    }

    /// Position and velocity after `t`.
    #[inline(always)]
    pub(crate) fn position_and_velocity(&self, t: T) -> (Vec3<T>, Vec3<T>) {
        let last = if self.has_air { TERMS } else { 2 };
        let mut position = self.position[last];
        let mut velocity = Vec3::splat(t.zero());
        for n in (0..last).rev() {
            velocity = position + velocity * t;
            position = self.position[n] + position * t;
        }
        (position, velocity)
    }

    /// z and its rate after `t`.
    #[inline(always)]
    pub(crate) fn height_and_rate(&self, t: T) -> (T, T) {
        self.coordinate(t, 2)
    }

    /// x and its rate after `t`.
    #[inline(always)]
    pub(crate) fn x_and_rate(&self, t: T) -> (T, T) {
        self.coordinate(t, 0)
    }

    #[inline(always)]
    fn coordinate(&self, t: T, axis: usize) -> (T, T) {
        let last = if self.has_air { TERMS } else { 2 };
        let mut value = self.position[last][axis];
        let mut rate = t.zero();
        for n in (0..last).rev() {
            rate = value + rate * t;
            value = self.position[n][axis] + value * t;
        }
        (value, rate)
    }

    /// The state after `t`.
    #[inline(always)]
    pub(crate) fn state_after(&self, t: T) -> BallState<T> {
        let (position_m, velocity_m_s) = self.position_and_velocity(t);
        BallState {
            position_m,
            velocity_m_s,
            spin_rad_s: self.spin_rad_s,
        }
    }

    /// The time near `guess` at which a ball that falls at the end of the path is at the height
    /// `z`. (z is concave in time: Newton's steps approach the root from later times. Before the
    /// highest point a step goes half of the way to the end.)
    #[inline(always)]
    pub(crate) fn falls_through(&self, z: T, guess: T) -> T {
        let mut t = guess;
        let mut searching = z.splat_mask(true);
        for _ in 0..MAX_STEPS_TO_FALL {
            let (height, rate) = self.height_and_rate(t);
            let falls = rate.is_negative();
            let above = height - z;
            let arrives = falls & above.abs().le(z.splat(FALL_TOLERANCE_M));
            searching = searching & !arrives;
            if !searching.any() {
                break;
            }
            let later = (t + self.longest_s) * 0.5;
            let next = (t - above / rate.select(falls, t.one())).select(falls, later);
            t = Real::min(next, self.longest_s).select(searching, t);
        }
        t
    }

    /// The time near `guess` at which a rising ball is at the height `z`.
    #[inline(always)]
    pub(crate) fn rises_through(&self, z: T, guess: T) -> T {
        let mut t = guess;
        for _ in 0..NEWTON_STEPS {
            let (height, rate) = self.height_and_rate(t);
            let rises = rate.is_positive();
            let next = t - (height - z) / rate.select(rises, t.one());
            t = next.select(rises, t);
        }
        t
    }

    /// The time of the highest point, for a ball that rises at first and reaches it on this path.
    #[inline(always)]
    pub(crate) fn highest_s(&self, ball: &BallParams<T>) -> T {
        let mut t = self.position[1].z * ball.inverse_gravity;
        for _ in 0..NEWTON_STEPS {
            let t_limited = Real::min(t, self.longest_s);
            let (_, rate) = self.height_and_rate(t_limited);
            // The vertical acceleration hardly changes: a secant through the start will do.
            let fallen = self.position[1].z - rate;
            let steep = fallen.is_positive();
            let slope = fallen / t_limited.select(steep, t.one());
            let next = t_limited + rate / slope.select(steep, t.one());
            t = next.select(steep, t_limited);
        }
        t
    }
}

/// Newton steps to a height.
const NEWTON_STEPS: u32 = 5;
/// Limit on Newton steps of a falling ball. More than five are needed only where the path is nearly
/// flat.
const MAX_STEPS_TO_FALL: u32 = 40;
/// Distance from the height at which they end, m.
const FALL_TOLERANCE_M: f64 = 1e-11;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Physics;
    use crate::model::Preset;
    use crate::model::constants_per_ball_mass::ModelParams;

    fn state(velocity: [f64; 3], spin: [f64; 3]) -> BallState {
        BallState {
            position_m: Vec3::new(4.0, 0.1, -1.0),
            velocity_m_s: velocity.into(),
            spin_rad_s: spin.into(),
        }
    }

    /// Authority: the same equation by RK4 in steps of 0.1 ms.
    #[test]
    fn val_the_series_are_the_flight() {
        let mut physics = Preset::named("ncaa").unwrap().physics();
        let mut light = physics.clone();
        light.ball_mass_kg = 0.136;
        physics.air.lift_slope = 1.0;
        for (physics, allowed_m) in [(&physics, 1e-7), (&light, 2e-5)] {
            let ball = ModelParams::new(physics).ball;
            for start in [
                state([-4.4, 0.2, 5.7], [0.0, 19.0, 0.0]),
                state([-4.4, 0.0, 0.0], [5.0, 19.0, -8.0]),
                state([-0.3, 0.0, 3.0], [0.0, 0.0, 30.0]),
                state([-0.01, 0.0, 0.05], [0.0, 0.0, 30.0]),
                state([-6.0, 1.0, -7.0], [0.0, 19.0, 0.0]),
                state([-9.0, 0.0, 9.0], [0.0, 19.0, 0.0]),
            ] {
                let path = FlightPath::new(&ball, &start);
                let steps = (path.longest_s / 1e-4).ceil();
                let h = path.longest_s / steps;
                let (mut p, mut v) = (start.position_m, start.velocity_m_s);
                let a = |v| ball.free_acceleration(v, start.spin_rad_s);
                let mut done = 0.0;
                while done < steps {
                    let k1 = a(v);
                    let k2 = a(v + k1 * (0.5 * h));
                    let k3 = a(v + k2 * (0.5 * h));
                    let k4 = a(v + k3 * h);
                    p += v * h + (k1 + k2 + k3) * (h * h / 6.0);
                    v += (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
                    done += 1.0;
                }
                let (position, velocity) = path.position_and_velocity(path.longest_s);
                let error = (position - p).norm();
                assert!(error < allowed_m, "{start:?}: {error}");
                assert!((velocity - v).norm() < 10.0 * allowed_m / path.longest_s);
                assert!(
                    v.norm() * path.inverse_speed_bound < 1.0
                        && a(v).norm() < path.acceleration_bound
                );
            }
        }
    }

    /// Authority: a ball that falls from rest with drag alone: v = v_t tanh(g t/v_t), z =
    /// -(v_t^2/g) ln cosh(g t/v_t).
    #[test]
    fn val_a_fall_with_drag_is_the_closed_form() {
        let physics = Preset::named("ncaa").unwrap().physics();
        let ball = ModelParams::new(&physics).ball;
        let terminal = (ball.gravity / ball.drag).sqrt();
        let mut state = state([0.0; 3], [0.0; 3]);
        let start_z = state.position_m.z;
        let mut t = 0.0;
        while t < 3.0 {
            let path = FlightPath::new(&ball, &state);
            t += path.longest_s;
            state = path.state_after(path.longest_s);
            let x = ball.gravity * t / terminal;
            let fallen = terminal * terminal / ball.gravity * libm::log(libm::cosh(x));
            // From rest the first part has no drag.
            let error = start_z - state.position_m.z - fallen;
            assert!(error.abs() < 1e-5, "{t}: {error}");
            assert!((-state.velocity_m_s.z - terminal * libm::tanh(x)).abs() < 5e-5);
        }
    }

    #[test]
    fn val_without_air_it_is_the_parabola() {
        let ball = ModelParams::new(&Physics::paper()).ball;
        let start = state([-4.4, 0.2, 5.7], [0.0, 19.0, 0.0]);
        let path = FlightPath::new(&ball, &start);
        for t in [0.0, 0.1, 1.3] {
            let error = path.state_after(t).position_m - start.after_flight(&ball, t).position_m;
            assert!(error.norm() < 1e-14);
        }
    }
}
