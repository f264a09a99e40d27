//! The contacts of a batch in the world frame: on the bracket, at a corner of the board, on board
//! and ring at once.

use super::batch_state::{Batch, ContactRecord, SixteenLanes};
use super::lane_block::{LaneBlock, bit, bits_in, lanes_in};
use super::workspace::Phase;
use crate::dynamics::integrators::shot_in_world::{ShotInWorld, WORLD_NUMBERS, WORLD_TRUTHS};
use crate::dynamics::integrators::shot_progress::ShotProgress;
use crate::dynamics::outcome::Ending;
use crate::math::real::{LaneBits, SimdReal};
use crate::model::constants_per_ball_mass::ModelParams;
use fearless_simd::Simd;

/// Steps the shots in contact in the world frame until they fly, go on in the frame of a contact,
/// or end.
///
/// One module for each phase: they compile in parallel.
#[inline(never)]
pub(super) fn in_world<S, T, const WIDTH: u8>(batch: &mut Batch<S, WIDTH>)
where
    S: Simd,
    T: SimdReal<Simd = S, Element = f64>,
{
    batch.simd.vectorize(
        #[inline(always)]
        || batch.contacts_in_world::<T>(),
    );
}

/// Shots in contact in the world frame in lanes.
#[derive(Clone, Copy)]
struct InWorld<'a> {
    params: &'a ModelParams,
}

impl ContactRecord for InWorld<'_> {
    type OfShot = ShotInWorld<f64>;

    #[inline(always)]
    fn read(&self, shot: &mut ShotProgress) -> ShotInWorld<f64> {
        shot.update_state(self.params);
        ShotInWorld::of(shot)
    }

    #[inline(always)]
    fn write(&self, shot: &mut ShotProgress, record: ShotInWorld<f64>) {
        record.write_to(shot);
    }
}

impl<S: Simd, const WIDTH: u8> Batch<'_, S, WIDTH> {
    #[inline(always)]
    fn contacts_in_world<T: SimdReal<Simd = S, Element = f64>>(&mut self) {
        let params = &self.lane_params::<T>();
        let lanes = SixteenLanes::<S>::LANES;
        let record = InWorld {
            params: self.params,
        };
        self.run_contacts::<T, WORLD_NUMBERS, WORLD_TRUTHS>(
            (Phase::InWorld, lanes),
            record,
            #[inline(always)]
            |batch, block, given_up| batch.step_in_world(params, record, block, given_up),
        );
    }

    /// Steps every lane, and takes the shots whose contacts have changed out of their lanes.
    #[inline(always)]
    fn step_in_world<T: SimdReal<Simd = S, Element = f64>>(
        &mut self,
        params: &ModelParams<T>,
        record: InWorld<'_>,
        block: &mut LaneBlock<f64, WORLD_NUMBERS, WORLD_TRUTHS>,
        given_up: LaneBits,
    ) {
        let mut shots: ShotInWorld<T> = block.load(self.simd);
        let rejected = T::mask_from_bits(self.simd, given_up);
        let step = shots.step(params, self.limits, rejected);
        block.store(&shots);
        let accepted = T::mask_to_bits(step.accepted);
        let [a, b, c] = step.ends.masks();
        let ends = [
            bits_in::<T>(accepted, a),
            bits_in::<T>(accepted, b),
            bits_in::<T>(accepted, c),
        ];
        let ended = ends[0] | ends[1] | ends[2];
        let made = bits_in::<T>(ended, step.made);
        let ([off_board, off_ring], [to_board, to_ring]) = (step.separates, step.arrived);
        let left = [
            bits_in::<T>(accepted, off_board),
            bits_in::<T>(accepted, off_ring),
        ];
        let arrived = [
            bits_in::<T>(accepted, to_board),
            bits_in::<T>(accepted, to_ring),
        ];
        let enters_frame = bits_in::<T>(accepted, step.enters_frame);
        let lodged = bits_in::<T>(accepted, step.lodged);
        let changed = left[0] | left[1] | arrived[0] | arrived[1] | enters_frame;
        let done = changed | ended | lodged | given_up;
        for lane in lanes_in(done & block.occupied()) {
            let write = |shot: &mut ShotProgress, own| record.write(shot, own);
            let slot = block.take(lane, &mut self.workspace.slots, write);
            if bit(given_up, lane) {
                self.workspace.finish(slot, Ending::Unresolved, false);
            } else if bit(ended, lane) {
                let rules = ends.map(|rule| bit(rule, lane));
                self.finish_shot_in_contact(slot, rules, bit(made, lane));
            } else if bit(lodged, lane) {
                self.workspace.finish(slot, Ending::Lodged, false);
            } else {
                let [left, arrived] = [left, arrived].map(|solids| solids.map(|b| bit(b, lane)));
                let shot = &mut self.workspace.slots[slot as usize];
                shot.change_contacts(self.params, left, arrived);
                self.workspace.enqueue(slot);
            }
        }
    }
}
