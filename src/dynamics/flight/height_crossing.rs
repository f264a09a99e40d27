//! When a ball in free flight crosses a height.

use crate::math::real::Real;
use crate::model::constants_per_ball_mass::ModelParams;

/// Time at which the centre falls through the height `height`. For a ball that never rises to it,
/// the time of its highest point.
#[inline(always)]
pub(crate) fn falling_time<T: Real>(params: &ModelParams<T>, z: T, vz: T, height: T) -> T {
    let discriminant = vz.squared() + params.ball.gravity * (z - height) * 2.0;
    (vz + discriminant.positive_part().sqrt()) * params.ball.inverse_gravity
}

/// Time at which the centre rises through the height `height`. Meaningful only for a ball that
/// starts below and gets there.
#[inline(always)]
pub(crate) fn rising_time<T: Real>(params: &ModelParams<T>, z: T, vz: T, height: T) -> T {
    let discriminant = vz.squared() + params.ball.gravity * (z - height) * 2.0;
    (vz - discriminant.positive_part().sqrt()) * params.ball.inverse_gravity
}
