//! The contacts of a batch with board and ring at once.

use super::batch_state::Batch;
use super::lane_block::{LaneBlock, bit, lanes_in};
use super::workspace::Phase;
use crate::dynamics::contact::double_contact_step;
use crate::dynamics::end_rules::is_lodged;
use crate::dynamics::outcome::Ending;
use crate::math::real::SimdReal;
use crate::model::SolidId;
use crate::model::solids::Solid;
use fearless_simd::Simd;

/// Steps the shots on board and ring until one contact is left or the ball is lodged.
///
/// The phases stand in separate modules, so that the compiler translates them in parallel.
#[inline(never)]
pub(super) fn board_and_ring<S, T, const WIDE: bool>(batch: &mut Batch<S, WIDE>)
where
    S: Simd,
    T: SimdReal<Simd = S, Element = f64>,
{
    batch.simd.vectorize(
        #[inline(always)]
        || batch.double_contact::<T>(),
    );
}

impl<S: Simd, const WIDE: bool> Batch<'_, S, WIDE> {
    #[inline(always)]
    fn double_contact<T: SimdReal<Simd = S, Element = f64>>(&mut self) {
        let params = &self.lane_params::<T>();
        let solids = (&params.board, &params.ring);
        let longest = params.splat(self.limits.longest_step_s);
        let phase = Phase::BoardAndRing;
        let mut block = LaneBlock::new();
        loop {
            self.refill::<T>(&mut block, phase);
            if block.occupied() == 0 {
                return;
            }
            if self.should_suspend::<T>(&block, phase) {
                self.suspend_double_contacts(&mut block);
                return;
            }
            let mut shots = block.load::<T>(self.simd);
            let before = shots.state;
            let mut friction = [
                block.load_friction(self.simd, SolidId::Board),
                block.load_friction(self.simd, SolidId::Ring),
            ];
            let step =
                double_contact_step::step(params, solids, &mut shots.state, &mut friction, longest);
            let separated = [
                step.parts[0] | !solids.0.faces(&shots.state),
                step.parts[1] | !solids.1.faces(&shots.state),
            ];
            let before_s = block.load_rolling_times(self.simd);
            let rolling_times = double_contact_step::rolling_time(&friction, before_s, step.dt);
            let lodged = is_lodged(rolling_times, self.limits.lodged_after_s);
            let end = shots.after_step(params, &before, step.dt, self.limits.time_limit_s);
            block.store(&shots);
            block.store_rolling_times(rolling_times);
            for solid in SolidId::ALL {
                block.store_friction(solid, &friction[solid.index()]);
            }
            let ended = T::mask_to_bits(end.any());
            let lodged = T::mask_to_bits(lodged);
            let separated = [T::mask_to_bits(separated[0]), T::mask_to_bits(separated[1])];
            let made = T::mask_to_bits(shots.crossing.is_made(params, &shots.state));
            let end = end.map(
                #[inline(always)]
                |mask| T::mask_to_bits(mask),
            );
            let given_up = block.count_step(self.limits.max_steps);
            let done = ended | lodged | given_up | separated[0] | separated[1];
            for lane in lanes_in(done & block.occupied()) {
                let slot = block.slot(lane);
                let shot = &mut self.workspace.slots[slot as usize];
                block.remove(lane, shot);
                if bit(ended, lane) {
                    self.finish_shot_in_contact(
                        slot,
                        end.map(|rule| bit(rule, lane)),
                        bit(made, lane),
                    );
                } else if bit(lodged, lane) {
                    self.workspace.finish(slot, Ending::Lodged, false);
                } else if bit(given_up, lane) {
                    self.workspace.finish(slot, Ending::Unresolved, false);
                } else {
                    shot.friction = SolidId::ALL.map(|solid| block.friction(solid, lane));
                    let separated = separated.map(|separated| bit(separated, lane));
                    shot.leave(self.params, separated);
                    self.workspace.enqueue(slot);
                }
            }
        }
    }

    /// Takes all shots of a block out of their lanes and queues them again.
    fn suspend_double_contacts(&mut self, block: &mut LaneBlock) {
        for lane in lanes_in(block.occupied()) {
            let slot = block.slot(lane);
            let shot = &mut self.workspace.slots[slot as usize];
            block.remove(lane, shot);
            shot.friction = SolidId::ALL.map(|solid| block.friction(solid, lane));
            shot.rolling_time_s = block.rolling_time_s(lane);
            self.workspace.enqueue(slot);
        }
    }
}
