//! The contacts of a batch in the world frame: on the bracket, at a corner of the board, on board
//! and ring at once.

use super::batch_state::Batch;
use super::workspace::Phase;
use super::world_frame_block::{WorldFrameBlock, bit, lanes_in};
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::contact::other_solid_touch::approach_in_world;
use crate::dynamics::contact::world_frame_step::{self, WorldContact};
use crate::dynamics::end_rules::is_lodged;
use crate::dynamics::outcome::Ending;
use crate::math::real::{LaneBits, SimdReal};
use crate::model::SolidId;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{BoardEdges, Solid};
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

/// What happened in the lanes of a step.
struct StepResult {
    /// The ball no longer touches, or has arrived at, each solid.
    separates: [LaneBits; SolidId::COUNT],
    arrived: [LaneBits; SolidId::COUNT],
    /// On one solid, in the part that a frame describes.
    enters_frame: LaneBits,
    /// The flags of the rules that end a shot.
    ends: [LaneBits; 3],
    made: LaneBits,
    lodged: LaneBits,
}

impl<S: Simd, const WIDTH: u8> Batch<'_, S, WIDTH> {
    #[inline(always)]
    fn contacts_in_world<T: SimdReal<Simd = S, Element = f64>>(&mut self) {
        let params = &self.lane_params::<T>();
        let phase = Phase::InWorld;
        let mut block = WorldFrameBlock::new();
        loop {
            self.refill::<T>(&mut block, phase);
            if block.occupied() == 0 {
                return;
            }
            if self.should_suspend::<T>(&block, phase) {
                self.suspend_contacts_in_world(&mut block);
                return;
            }
            let given_up = block.count_step(self.limits.max_steps);
            let result = self.step_in_world(params, &mut block, given_up);
            self.finish_contacts_in_world(&mut block, &result, given_up);
            let occupied = block.occupied().count_ones() as usize;
            if self.workspace.others_go_first(phase, occupied, T::LANES) {
                self.suspend_contacts_in_world(&mut block);
                return;
            }
        }
    }

    /// Steps every lane; those of `given_up` stay where they are.
    #[inline(always)]
    fn step_in_world<T: SimdReal<Simd = S, Element = f64>>(
        &self,
        params: &ModelParams<T>,
        block: &mut WorldFrameBlock,
        given_up: LaneBits,
    ) -> StepResult {
        let simd = self.simd;
        let solids = (&params.board, &params.ring);
        let mut shots = block.load::<T>(simd);
        let before = shots.state;
        let friction = [
            block.load_friction(simd, SolidId::Board),
            block.load_friction(simd, SolidId::Ring),
        ];
        let touching = block.load_touching::<T>(simd);
        let [with_one_s, with_both_s] = self.limits.longest_world_steps_s;
        let contact = WorldContact {
            touching,
            step_s: params
                .splat(with_both_s)
                .select(touching[0] & touching[1], params.splat(with_one_s)),
            fraction: block.load_step_fractions(simd),
        };
        let mut next_friction = friction;
        let step = world_frame_step::step(
            params,
            solids,
            &mut shots.state,
            &mut next_friction,
            &contact,
        );
        let states = (&before, &shots.state);
        let approach = approach_in_world(params, solids, touching, states, step.dt);
        let given_up = T::mask_from_bits(simd, given_up);
        let rejected = approach.repeats | given_up;
        let fraction = approach.fraction * (step.dt / contact.step_s);
        block.store_step_fractions(fraction.select(approach.repeats, params.one()));
        shots.state = before.select(rejected, shots.state);
        for i in [0, 1] {
            next_friction[i] = FrictionState::select(friction[i], rejected, next_friction[i]);
        }
        let before_s = block.load_rolling_times(simd);
        let rolling_times = world_frame_step::rolling_time(&next_friction, before_s, step.dt);
        let rolling_times = before_s.select(rejected, rolling_times);
        let lodged = is_lodged(rolling_times, self.limits.lodged_after_s) & !rejected;
        let end = shots.after_step(
            params,
            &before,
            (step.dt, !rejected),
            self.limits.time_limit_s,
        );
        block.store(&shots);
        block.store_rolling_times(rolling_times);
        for solid in SolidId::ALL {
            block.store_friction(solid, &next_friction[solid.index()]);
        }
        let acts = [solids.0.acts(&shots.state), solids.1.acts(&shots.state)];
        let separates = [
            touching[0] & (step.separates[0] | !acts[0]) & !rejected,
            touching[1] & (step.separates[1] | !acts[1]) & !rejected,
        ];
        let on = [
            (touching[0] & !separates[0]) | approach.arrived[0],
            (touching[1] & !separates[1]) | approach.arrived[1],
        ];
        let edges = BoardEdges(solids.0);
        let in_board_frame = solids.0.is_in_frame(&shots.state) | edges.is_in_frame(&shots.state);
        let enters_frame = (on[0] & !on[1] & in_board_frame)
            | (on[1] & !on[0] & solids.1.is_in_frame(&shots.state));
        let accepted = T::mask_to_bits(!rejected);
        StepResult {
            separates: [T::mask_to_bits(separates[0]), T::mask_to_bits(separates[1])],
            arrived: [
                T::mask_to_bits(approach.arrived[0]) & accepted,
                T::mask_to_bits(approach.arrived[1]) & accepted,
            ],
            enters_frame: T::mask_to_bits(enters_frame) & accepted,
            ends: end.map(
                #[inline(always)]
                |rule| T::mask_to_bits(rule) & accepted,
            ),
            made: T::mask_to_bits(shots.crossing.is_made(params, &shots.state)),
            lodged: T::mask_to_bits(lodged),
        }
    }

    /// Takes the shots whose contacts have changed out of their lanes.
    #[inline(always)]
    fn finish_contacts_in_world(
        &mut self,
        block: &mut WorldFrameBlock,
        result: &StepResult,
        given_up: LaneBits,
    ) {
        let [a, b, c] = result.ends;
        let ended = a | b | c;
        let [off_board, off_ring] = result.separates;
        let [to_board, to_ring] = result.arrived;
        let changed = off_board | off_ring | to_board | to_ring | result.enters_frame;
        let done = changed | ended | result.lodged | given_up;
        for lane in lanes_in(done & block.occupied()) {
            let slot = block.slot(lane);
            let shot = &mut self.workspace.slots[slot as usize];
            block.remove(lane, shot);
            if bit(given_up, lane) {
                self.workspace.finish(slot, Ending::Unresolved, false);
            } else if bit(ended, lane) {
                let rules = result.ends.map(|rule| bit(rule, lane));
                self.finish_shot_in_contact(slot, rules, bit(result.made, lane));
            } else if bit(result.lodged, lane) {
                self.workspace.finish(slot, Ending::Lodged, false);
            } else {
                block.remove_contacts(lane, shot);
                let mut touching = shot.touching;
                for solid in SolidId::ALL {
                    let i = solid.index();
                    touching[i] &= !bit(result.separates[i], lane);
                    if bit(result.arrived[i], lane) {
                        touching[i] = true;
                        shot.contacts.push(solid);
                        shot.friction[i] = FrictionState::new(self.params);
                    }
                }
                shot.set_touching(self.params, touching);
                self.workspace.enqueue(slot);
            }
        }
    }

    /// Takes all shots of a block out of their lanes and queues them again.
    fn suspend_contacts_in_world(&mut self, block: &mut WorldFrameBlock) {
        for lane in lanes_in(block.occupied()) {
            let slot = block.slot(lane);
            let shot = &mut self.workspace.slots[slot as usize];
            block.remove(lane, shot);
            block.remove_contacts(lane, shot);
            self.workspace.enqueue(slot);
        }
    }
}
