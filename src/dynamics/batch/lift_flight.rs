//! Segments of flights with lift in lanes.

use crate::dynamics::flight::{FlightSegment, lift_segment};
use crate::math::real::SimdReal;
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;
use fearless_simd::Simd;

/// The segments that start at `state`. Few physics have lift: in a function of its own it does not
/// make the other flights larger.
#[inline(never)]
pub(super) fn lift_segments<S, T>(
    simd: S,
    params: &ModelParams<T>,
    state: &BallState<T>,
) -> FlightSegment<T>
where
    S: Simd,
    T: SimdReal<Simd = S>,
{
    simd.vectorize(
        #[inline(always)]
        || lift_segment(params, state),
    )
}
