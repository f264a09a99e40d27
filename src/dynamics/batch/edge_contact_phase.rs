//! The contacts of a batch with the edges of the board.

use super::batch_state::Batch;
use crate::math::real::SimdReal;
use crate::model::solids::BoardEdges;
use fearless_simd::Simd;

/// Steps the shots on an edge until they leave it, touch the ring or end, or another phase can
/// use the lanes better.
///
/// One module for each phase: they compile in parallel.
#[inline(never)]
pub(super) fn edge_contact<S, T, const WIDTH: u8>(batch: &mut Batch<S, WIDTH>)
where
    S: Simd,
    T: SimdReal<Simd = S>,
{
    batch.simd.vectorize(
        #[inline(always)]
        || {
            let params = batch.lane_params::<T>();
            batch.single_contact(&params, &BoardEdges(&params.board), &params.ring);
        },
    );
}
