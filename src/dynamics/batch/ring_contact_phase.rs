//! The contacts of a batch with the ring.

use super::batch_state::Batch;
use crate::math::real::SimdReal;
use fearless_simd::Simd;

/// Steps the shots on the ring until they part or touch the board.
///
/// A function of its own in a module of its own, so that the compiler can translate the phases side by side.
#[inline(never)]
pub(super) fn ring_contact<S, T, const WIDE: bool>(batch: &mut Batch<S, WIDE>)
where
    S: Simd,
    T: SimdReal<Simd = S>,
{
    batch.simd.vectorize(
        #[inline(always)]
        || {
            let params = batch.lane_params::<T>();
            batch.single_contact(&params, &params.ring, &params.board);
        },
    );
}
