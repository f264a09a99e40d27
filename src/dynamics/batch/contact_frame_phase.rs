//! The contacts of a batch with one solid: the shots of a block step together.

use super::batch_state::{Batch, ContactRecord};
use super::lane_block::{LaneBlock, bit, bits_in, lanes_in};
use super::workspace::Phase;
use crate::dynamics::contact::contact_frame_step::Contact;
use crate::dynamics::integrators::shot_in_frame::{FRAME_NUMBERS, FRAME_TRUTHS, ShotInFrame};
use crate::dynamics::integrators::shot_progress::{ContactState, ShotProgress};
use crate::dynamics::outcome::Ending;
use crate::math::real::{LaneBits, SimdReal};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{FramedPart, Solid};
use fearless_simd::Simd;

/// Shots on a part of a solid in lanes.
#[derive(Clone, Copy)]
struct OnPart {
    part: FramedPart,
    time_limit_s: f64,
}

impl ContactRecord for OnPart {
    type OfShot = ShotInFrame<f64>;

    #[inline(always)]
    fn read(&self, shot: &mut ShotProgress) -> ShotInFrame<f64> {
        ShotInFrame::of(shot, self.part.solid(), self.time_limit_s)
    }

    #[inline(always)]
    fn write(&self, shot: &mut ShotProgress, record: ShotInFrame<f64>) {
        record.write_to(shot, self.part);
    }
}

impl<S: Simd, const WIDTH: u8> Batch<'_, S, WIDTH> {
    /// Steps the shots on one solid until they part, touch `other` or end.
    #[inline(always)]
    pub(super) fn single_contact<T, A, B>(&mut self, params: &ModelParams<T>, solid: &A, other: &B)
    where
        T: SimdReal<Simd = S>,
        A: Solid<T>,
        B: Solid<T>,
    {
        let oscillator = &self.limits.oscillators[A::PART as usize].map(
            #[inline(always)]
            |value| T::broadcast(self.simd, value),
        );
        let contact = Contact {
            params,
            solid,
            oscillator,
        };
        let on = OnPart {
            part: A::PART,
            time_limit_s: self.limits.time_limit_s,
        };
        self.run_contacts::<T, FRAME_NUMBERS, FRAME_TRUTHS>(
            (Phase::InFrame(A::PART), T::LANES),
            on,
            #[inline(always)]
            |batch, block, given_up| batch.step_on(on, &contact, other, block, given_up),
        );
    }

    /// Steps every lane, and takes the shots whose contact has ended out of their lanes.
    #[inline(always)]
    fn step_on<T: SimdReal<Simd = S>, A: Solid<T>, B: Solid<T>>(
        &mut self,
        on: OnPart,
        contact: &Contact<'_, T, A>,
        other: &B,
        block: &mut LaneBlock<T::Element, FRAME_NUMBERS, FRAME_TRUTHS>,
        given_up: LaneBits,
    ) {
        let shots: ShotInFrame<T> = block.load(self.simd);
        let (next, step) = shots.step(contact, other, T::mask_from_bits(self.simd, given_up));
        block.store(&next);
        let accepted = T::mask_to_bits(step.accepted);
        let [a, b, c] = step.ends.masks();
        let ends = [
            bits_in::<T>(accepted, a),
            bits_in::<T>(accepted, b),
            bits_in::<T>(accepted, c),
        ];
        let ended = ends[0] | ends[1] | ends[2];
        let made = bits_in::<T>(ended, step.made);
        let flies = bits_in::<T>(accepted, step.flies);
        let arrived = bits_in::<T>(accepted, step.arrived);
        let leaves_frame = bits_in::<T>(accepted, step.leaves_frame);
        let done = ended | flies | arrived | leaves_frame | given_up;
        for lane in lanes_in(done & block.occupied()) {
            let write = |shot: &mut ShotProgress, own| on.write(shot, own);
            let slot = block.take(lane, &mut self.workspace.slots, write);
            let shot = &mut self.workspace.slots[slot as usize];
            if bit(given_up, lane) {
                self.workspace.finish(slot, Ending::Unresolved, false);
            } else if bit(ended, lane) {
                let rules = ends.map(|rule| bit(rule, lane));
                self.finish_shot_in_contact(slot, rules, bit(made, lane));
            } else if bit(flies, lane) {
                shot.end_single_contact(ContactState::Free);
                self.workspace.queue_mut(Phase::Flight).push(slot);
            } else if bit(arrived, lane) {
                shot.arrive(self.params, B::ID);
                self.workspace.queue_mut(Phase::InWorld).push(slot);
            } else {
                shot.leave_frame(self.params, A::ID);
                self.workspace.enqueue(slot);
            }
        }
    }
}
