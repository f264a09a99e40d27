//! A batch that is being simulated, and what its phases share.

use super::workspace::{BatchWorkspace, Phase};
use super::world_frame_block::WorldFrameBlock;
use crate::dynamics::end_rules::{ShotLimits, first_ending};
use crate::dynamics::integrators::event_driven::{self, MAX_PHASES};
use crate::dynamics::outcome::Ending;
use crate::math::real::SimdReal;
use crate::math::simd::{F32x16, F64x8};
use crate::math::unrolled_simd::Unrolled;
use crate::model::constants_per_ball_mass::ModelParams;
use fearless_simd::Simd;

/// A batch that is being simulated.
///
/// `WIDTH` is [`WIDE`] or [`NARROW`].
pub(super) struct Batch<'a, S: Simd, const WIDTH: u8> {
    pub(super) simd: S,
    pub(super) params: &'a ModelParams,
    pub(super) limits: &'a ShotLimits,
    pub(super) workspace: &'a mut BatchWorkspace,
}

/// Sixteen lanes instead of eight. This pays off with AVX-512, where one register holds eight
/// lanes: two independent registers hide the latency of operations.
pub(super) const WIDE: u8 = 2;
/// Eight lanes; with AVX2 they are several registers already.
pub(super) const NARROW: u8 = 1;
pub(super) type EightLanes<S> = F64x8<S>;
pub(super) type SixteenLanes<S> = Unrolled<F64x8<S>>;
pub(super) type SixteenLanesF32<S> = F32x16<S>;
pub(super) type ThirtyTwoLanesF32<S> = Unrolled<F32x16<S>>;

impl<S: Simd, const WIDTH: u8> Batch<'_, S, WIDTH> {
    /// The parameters in every lane, as near as the lanes can hold them.
    #[inline(always)]
    pub(super) fn lane_params<T: SimdReal<Simd = S>>(&self) -> ModelParams<T> {
        self.params.map(
            #[inline(always)]
            |value| T::broadcast(self.simd, value),
        )
    }

    /// Simulates one phase of a shot with the scalar code and queues the shot again.
    #[cold]
    pub(super) fn run_scalar(&mut self, slot: u32) {
        let shot = &mut self.workspace.slots[slot as usize];
        if shot.phases >= MAX_PHASES {
            self.workspace.finish(slot, Ending::Unresolved, false);
            return;
        }
        shot.phases += 1;
        match event_driven::run_phase(self.params, self.limits, shot) {
            Some(verdict) => self.workspace.record(slot, verdict),
            None => self.workspace.enqueue(slot),
        }
    }

    /// Fills the free lanes with shots that wait for `phase`.
    #[inline(always)]
    pub(super) fn refill<T: SimdReal<Simd = S>>(
        &mut self,
        block: &mut WorldFrameBlock,
        phase: Phase,
    ) {
        let free = T::ALL & !block.occupied();
        let (slots, queue) = self.workspace.slots_and_queue(phase);
        block.fill(free, self.params, slots, || queue.pop());
        block.load_contacts_of(free, slots);
    }

    /// Whether to leave a phase whose lanes cannot be filled, because another phase has enough
    /// shots.
    #[inline(always)]
    pub(super) fn should_suspend<T: SimdReal<Simd = S>>(
        &self,
        block: &WorldFrameBlock,
        phase: Phase,
    ) -> bool {
        block.occupied() != T::ALL
            && self
                .workspace
                .other_phase_fills(SixteenLanes::<S>::LANES, phase)
    }

    /// Records the end of a shot in contact: by a rule, or given up if none of them holds.
    #[inline(always)]
    pub(super) fn finish_shot_in_contact(&mut self, slot: u32, end: [bool; 3], made: bool) {
        let ending = first_ending(end).unwrap_or(Ending::Unresolved);
        let made = ending == Ending::Fell && made;
        self.workspace.finish(slot, ending, made);
    }
}
