//! The contacts of a batch with the face of the board.

use super::batch_state::Batch;
use crate::math::real::SimdReal;
use fearless_simd::Simd;

/// Steps the shots on the face until they leave it, touch the ring or end, or another phase can
/// use the lanes better.
///
/// One module for each phase: they compile in parallel.
#[inline(never)]
pub(super) fn board_contact<S, T, const WIDTH: u8>(batch: &mut Batch<S, WIDTH>)
where
    S: Simd,
    T: SimdReal<Simd = S>,
{
    batch.simd.vectorize(
        #[inline(always)]
        || {
            let params = batch.lane_params::<T>();
            batch.single_contact(&params, &params.board, &params.ring);
        },
    );
}
