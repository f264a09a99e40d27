//! A batch that is being simulated, and what its phases share.

use super::lane_block::{LaneBlock, lanes_in};
use super::workspace::{BatchWorkspace, Phase};
use crate::dynamics::end_rules::{ShotLimits, first_ending};
use crate::dynamics::integrators::event_driven::{self, MAX_PHASES};
use crate::dynamics::integrators::shot_progress::ShotProgress;
use crate::dynamics::outcome::Ending;
use crate::math::real::{LaneBits, SimdReal};
use crate::math::real_record::RealRecord;
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

/// What is kept in lanes of the shots of a phase of contact.
pub(super) trait ContactRecord {
    /// That of one shot.
    type OfShot: RealRecord<f64>;
    /// Reads it.
    fn read(&self, shot: &mut ShotProgress) -> Self::OfShot;
    /// Writes it back.
    fn write(&self, shot: &mut ShotProgress, record: Self::OfShot);
}

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

    /// Runs the shots that wait for a phase of contact until none is left, or another phase can use
    /// the lanes better: one that fills `lanes_elsewhere` goes before lanes that are not full.
    /// `step` steps all lanes (those that it is given are given up), and takes out the shots whose
    /// contact has ended.
    #[inline(always)]
    pub(super) fn run_contacts<T, const NUMBERS: usize, const TRUTHS: usize>(
        &mut self,
        (phase, lanes_elsewhere): (Phase, usize),
        record: impl ContactRecord,
        mut step: impl FnMut(&mut Self, &mut LaneBlock<T::Element, NUMBERS, TRUTHS>, LaneBits),
    ) where
        T: SimdReal<Simd = S>,
    {
        let mut block = LaneBlock::new();
        loop {
            let (slots, queue) = self.workspace.slots_and_queue(phase);
            block.fill(
                T::ALL & !block.occupied(),
                #[inline(always)]
                |_| {
                    let slot = queue.pop()?;
                    let shot = &mut slots[slot as usize];
                    Some((slot, shot.steps, record.read(shot)))
                },
            );
            if block.occupied() == 0 {
                return;
            }
            let is_full = block.occupied() == T::ALL;
            if !is_full && self.workspace.other_phase_fills(lanes_elsewhere, phase) {
                break;
            }
            let given_up = block.count_step(self.limits.max_steps);
            step(self, &mut block, given_up);
            let occupied = block.occupied().count_ones() as usize;
            if self.workspace.others_go_first(phase, occupied, T::LANES) {
                break;
            }
        }
        for lane in lanes_in(block.occupied()) {
            let write = |shot: &mut ShotProgress, own| record.write(shot, own);
            let slot = block.take(lane, &mut self.workspace.slots, write);
            self.workspace.enqueue(slot);
        }
    }

    /// Records the end of a shot in contact: by a rule, or given up if none of them holds.
    #[inline(always)]
    pub(super) fn finish_shot_in_contact(&mut self, slot: u32, end: [bool; 3], made: bool) {
        let ending = first_ending(end).unwrap_or(Ending::Unresolved);
        let made = ending == Ending::Fell && made;
        self.workspace.finish(slot, ending, made);
    }
}
