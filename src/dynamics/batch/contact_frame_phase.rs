//! The contacts of a batch with one solid: the shots of a block step together.

use super::batch_state::Batch;
use super::contact_frame_block::{ContactFrameBlock, ContactShots};
use super::workspace::Phase;
use super::world_frame_block::{bit, lanes_in};
use crate::dynamics::contact::contact_frame_step::Contact;
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::contact::other_solid_touch::{GapAtEnd, has_arrived, passed};
use crate::dynamics::end_rules::ShotEndFlags;
use crate::dynamics::integrators::event_driven::ContactState;
use crate::dynamics::outcome::Ending;
use crate::math::real::{LaneBits, LaneElement, Mask, SimdReal};
use crate::model::SolidId;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::Solid;
use fearless_simd::Simd;

/// What happened in the lanes of a step.
struct StepResult {
    separates: LaneBits,
    /// On the other solid.
    arrived: LaneBits,
    /// Where the solid does not act.
    beside: LaneBits,
    /// Beyond the part of the solid that the frame describes.
    leaves_frame: LaneBits,
    /// The flags of the rules that end a shot.
    ends: [LaneBits; 3],
    made: LaneBits,
    given_up: LaneBits,
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
        let phase = Phase::InFrame(A::PART);
        let oscillator = &self.limits.oscillators[A::PART as usize].map(
            #[inline(always)]
            |value| T::broadcast(self.simd, value),
        );
        let contact = Contact {
            params,
            solid,
            oscillator,
        };
        let mut block = ContactFrameBlock::<T::Element>::new(A::PART);
        loop {
            let free = T::ALL & !block.occupied();
            let (slots, queue) = self.workspace.slots_and_queue(phase);
            let limit = self.limits.time_limit_s;
            block.fill(free, limit, slots, || queue.pop());
            if block.occupied() == 0 {
                return;
            }
            if block.occupied() != T::ALL && self.workspace.other_phase_fills(T::LANES, phase) {
                self.suspend_contacts(&mut block);
                return;
            }
            let given_up = block.count_step(self.limits.max_steps);
            let result = step_lanes(&contact, other, &mut block, self.simd, given_up);
            self.finish_contacts(&mut block, B::ID, &result);
            let occupied = block.occupied().count_ones() as usize;
            if self.workspace.others_go_first(phase, occupied, T::LANES) {
                self.suspend_contacts(&mut block);
                return;
            }
        }
    }

    /// Takes all shots of a block out of their lanes and queues them again.
    #[inline(always)]
    fn suspend_contacts<E: LaneElement>(&mut self, block: &mut ContactFrameBlock<E>) {
        let phase = Phase::InFrame(block.part());
        for lane in lanes_in(block.occupied()) {
            let slot = block.slot(lane);
            block.remove(lane, &mut self.workspace.slots[slot as usize]);
            self.workspace.queue_mut(phase).push(slot);
        }
    }

    /// Takes the shots whose contact has ended out of their lanes.
    #[inline(always)]
    fn finish_contacts<E: LaneElement>(
        &mut self,
        block: &mut ContactFrameBlock<E>,
        other: SolidId,
        result: &StepResult,
    ) {
        let [a, b, c] = result.ends;
        let ended = a | b | c;
        let done = (result.separates
            | result.arrived
            | result.beside
            | result.leaves_frame
            | ended
            | result.given_up)
            & block.occupied();
        for lane in lanes_in(done) {
            let slot = block.slot(lane);
            let shot = &mut self.workspace.slots[slot as usize];
            block.remove(lane, shot);
            if bit(result.given_up, lane) {
                self.workspace.finish(slot, Ending::Unresolved, false);
            } else if bit(ended, lane) {
                let made = bit(result.made, lane);
                self.finish_shot_in_contact(slot, result.ends.map(|rule| bit(rule, lane)), made);
            } else if bit(result.separates, lane) {
                shot.end_single_contact(ContactState::Free);
                self.workspace.queue_mut(Phase::Flight).push(slot);
            } else if bit(result.arrived, lane) {
                shot.arrive(self.params, other);
                self.workspace.queue_mut(Phase::InWorld).push(slot);
            } else if !bit(result.beside, lane) {
                shot.leave_frame(self.params, block.part().solid());
                self.workspace.enqueue(slot);
            } else {
                shot.end_single_contact(ContactState::Free);
                self.workspace.queue_mut(Phase::Flight).push(slot);
            }
        }
    }
}

/// Steps every lane.
#[inline(always)]
fn step_lanes<T: SimdReal, A: Solid<T>, B: Solid<T>>(
    contact: &Contact<'_, T, A>,
    other: &B,
    block: &mut ContactFrameBlock<T::Element>,
    simd: T::Simd,
    given_up: LaneBits,
) -> StepResult {
    let (params, solid) = (contact.params, contact.solid);
    let shots = block.load::<T>(simd);
    let step = contact.step(&shots.motion, &shots.friction, shots.step_fraction);
    let after = solid.to_world(&params.ball, &step.motion);
    let path = (shots.motion.speed_bound() + step.motion.speed_bound()) * step.dt;
    let end = GapAtEnd::new(params, other, &after, path);
    let (mut repeats, mut fraction) = (end.is_near, params.one());
    if end.is_near.any() {
        let before = solid.to_world(&params.ball, &shots.motion);
        (repeats, fraction) = passed(params, other, &before, &end, step.dt);
    }
    let rejected = repeats | T::mask_from_bits(simd, given_up);
    let mut next = ContactShots {
        motion: step.motion,
        friction: step.friction,
        step_fraction: params.one(),
        contact_time_s: shots.contact_time_s + step.dt,
        crossing: shots.crossing,
    };
    let was_below = solid.is_below_hoop(&shots.motion);
    next.crossing
        .after_step(params, was_below, &after, !rejected);
    let mut accepted = T::ALL;
    if T::mask_to_bits(rejected) != 0 {
        accepted = T::mask_to_bits(!rejected);
        let repeated_fraction = contact.fraction_of_longest(fraction * step.dt);
        next.motion = shots.motion.select(rejected, next.motion);
        next.friction = FrictionState::select(shots.friction, rejected, next.friction);
        next.step_fraction = repeated_fraction.select(repeats, next.step_fraction);
        next.contact_time_s = shots.contact_time_s.select(rejected, next.contact_time_s);
    }
    let too_late = block.allowed_times_s::<T>(simd).lt(next.contact_time_s);
    let ends = ShotEndFlags::new(params, &after, too_late);
    block.store(&next);
    StepResult {
        separates: T::mask_to_bits(step.separates) & accepted,
        arrived: T::mask_to_bits(has_arrived(params, other, &after)) & accepted,
        beside: T::mask_to_bits(!solid.acts(&after)) & accepted,
        leaves_frame: T::mask_to_bits(!solid.is_in_frame(&after)) & accepted,
        ends: ends.map(
            #[inline(always)]
            |rule| T::mask_to_bits(rule) & accepted,
        ),
        made: T::mask_to_bits(next.crossing.is_made(params, &after)),
        given_up,
    }
}
