//! The height of a ball in flight as a function of time, or of another variable that grows with
//! time.

use crate::math::real::Real;
use crate::model::constants_per_ball_mass::ModelParams;

use super::height_crossing::{falling_time, rising_time};

/// A height z(t) that is concave in t.
pub(super) trait HeightPath<T: Real> {
    /// z at t = 0.
    fn first_height(&self) -> T;
    /// z and its rate at `t`.
    fn height_and_rate(&self, t: T) -> (T, T);
    /// A time before which it does not fall through `height`, and a bound on its height from then
    /// on, which is little more than `height`. If it does not fall through it: never, or for a
    /// parabola the time of the highest point.
    fn falls_through_after(&self, height: T) -> (T, T);
    /// A lower and an upper bound on the time at which it rises through `height`. From the upper
    /// bound to the highest point it is above `height`. If it does not rise through it: any two
    /// times before the highest point.
    fn rises_between(&self, height: T) -> (T, T);
    /// A bound on -z''.
    fn acceleration_bound(&self) -> T;
}

/// Free fall.
pub(super) struct Parabola<'a, T> {
    pub(super) params: &'a ModelParams<T>,
    pub(super) z: T,
    pub(super) vz: T,
}

impl<T: Real> HeightPath<T> for Parabola<'_, T> {
    #[inline(always)]
    fn height_and_rate(&self, t: T) -> (T, T) {
        let ball = &self.params.ball;
        (
            self.z + self.vz * t - ball.half_gravity * t * t,
            self.vz - ball.gravity * t,
        )
    }

    #[inline(always)]
    fn first_height(&self) -> T {
        self.z
    }

    /// The exact time. For a ball that never rises to the height, that of its highest point.
    #[inline(always)]
    fn falls_through_after(&self, height: T) -> (T, T) {
        let time = falling_time(self.params, self.z, self.vz, height);
        (time, height)
    }

    #[inline(always)]
    fn rises_between(&self, height: T) -> (T, T) {
        let time = rising_time(self.params, self.z, self.vz, height);
        (time, time)
    }

    #[inline(always)]
    fn acceleration_bound(&self) -> T {
        self.params.ball.gravity
    }
}
