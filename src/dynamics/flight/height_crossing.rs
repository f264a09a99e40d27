//! When a parabola reaches a height.

use crate::math::real::Real;
use crate::model::model_params::ModelParams;

/// Time at which the centre falls through the height `level`. For a ball that never gets there, the time
/// of its highest point.
#[inline(always)]
pub(crate) fn falling_time<R: Real>(params: &ModelParams<R>, z: R, vz: R, level: R) -> R {
    let square = vz.squared() + params.ball.gravity * (z - level) * 2.0;
    (vz + square.positive_part().sqrt()) * params.ball.per_gravity
}

/// Time at which the centre rises through the height `level`. Meaningful only for a ball that starts below
/// and gets there.
#[inline(always)]
pub(crate) fn rising_time<R: Real>(params: &ModelParams<R>, z: R, vz: R, level: R) -> R {
    let square = vz.squared() + params.ball.gravity * (z - level) * 2.0;
    (vz - square.positive_part().sqrt()) * params.ball.per_gravity
}
