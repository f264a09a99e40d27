//! The contacts of a batch with one solid: the shots of a block step together.

use super::batch_state::{Batch, Narrow};
use super::lane_block::{LaneBlock, bit, lanes_in};
use super::workspace::Phase;
use crate::dynamics::contact::event_time::time_to_touch;
use crate::dynamics::contact::single;
use crate::dynamics::integrators::event_driven::{ContactState, max_acceleration};
use crate::math::real::SimdReal;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{Approach, Solid};
use fearless_simd::Simd;

impl<S: Simd, const WIDE: bool> Batch<'_, S, WIDE> {
    /// Steps the shots on one solid until they part or touch `other`, or until too few are left to fill
    /// the lanes.
    #[inline(always)]
    pub(super) fn single_contact<T, A, B>(&mut self, params: &ModelParams<T>, solid: &A, other: &B)
    where
        T: SimdReal<Simd = S>,
        A: Solid<T>,
        B: Solid<T>,
    {
        let phase = Phase::Single(A::ID);
        let longest = params.splat(self.limits.longest_step_s);
        let mut block = LaneBlock::new();
        loop {
            self.refill::<T>(&mut block, phase);
            if block.occupied() == 0 {
                return;
            }
            let mut shots = block.load::<T>(self.simd);
            let before = shots.state;
            let bound = max_acceleration(params, solid, &before, longest);
            let approach = other.approach(&params.ball, &before, bound, longest);
            let needs_scalar = T::mask_to_bits(!solid.faces(&before) | approach.has_arrived());
            // Half of the lanes fit into a narrower block.
            let few = block.occupied().count_ones() as usize <= T::LANES / 2
                && T::LANES > Narrow::<S>::LANES;
            let suspended = few || self.should_suspend::<T>(&block, phase);
            let removed = if suspended {
                block.occupied()
            } else {
                needs_scalar
            };
            for lane in lanes_in(removed & block.occupied()) {
                let slot = block.slot(lane);
                let shot = &mut self.workspace.slots[slot as usize];
                block.remove(lane, shot);
                shot.contact = ContactState::Single(A::ID, block.friction(A::ID, lane));
                if bit(needs_scalar, lane) {
                    self.run_scalar(slot);
                } else {
                    self.workspace.queue_mut(phase).push(slot);
                }
            }
            if suspended {
                return;
            }
            let mut friction = block.load_friction::<T>(self.simd, A::ID);
            let step = single::step(
                params,
                solid,
                &mut shots.state,
                &mut friction,
                longest,
                #[inline(always)]
                |state, acceleration| time_to_touch(params, &approach, state, acceleration),
            );
            let end = shots.after_step(params, &before, step.dt, self.limits.time_limit_s);
            block.store(&shots);
            block.store_friction(A::ID, &friction);
            let given_up = block.count_step(self.limits.max_steps);
            let done = (T::mask_to_bits(step.separated | end.any()) | given_up) & block.occupied();
            if done == 0 {
                continue;
            }
            let separated = T::mask_to_bits(step.separated);
            let made = T::mask_to_bits(shots.crossing.is_made(params, &shots.state));
            let end = end.map(
                #[inline(always)]
                |mask| T::mask_to_bits(mask),
            );
            for lane in lanes_in(done) {
                let slot = block.slot(lane);
                block.remove(lane, &mut self.workspace.slots[slot as usize]);
                if bit(separated, lane) {
                    self.workspace.queue_mut(Phase::Flight).push(slot);
                } else {
                    self.finish_shot_in_contact(
                        slot,
                        end.map(|rule| bit(rule, lane)),
                        bit(made, lane),
                    );
                }
            }
        }
    }
}
