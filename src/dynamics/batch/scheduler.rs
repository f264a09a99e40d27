//! Runs the shots of a batch, eight or sixteen to a step.
//!
//! The shots wait in queues by phase: flight, contact with one solid, contact with two. Flights are closed
//! form and are done a block at a time. In contact the shots of a block step together. Finished lanes are
//! refilled at once, so short and long contacts mix without waiting. Rare events (from one contact to two,
//! the board's edges, the time limit) are handed to the scalar form and come back to a queue after it.
//!
//! The equations are those of the scalar form, so the verdicts are the same, bit for bit.

use super::lane_block::{LaneBlock, bit, lanes_in};
use super::workspace::{BatchWorkspace, Phase};
use crate::dynamics::contact::event_time::time_to_touch;
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::contact::{double, single};
use crate::dynamics::end_rules::{ContactEnd, RunLimits, flight_ending, is_lodged, rose_to_ring};
use crate::dynamics::flight::FlightArc;
use crate::dynamics::integrators::event_driven::{
    self, ContactState, MAX_SEGMENTS, max_acceleration,
};
use crate::dynamics::outcome::Ending;
use crate::math::real::{LaneBits, SimdReal};
use crate::math::simd::F64x8;
use crate::math::simd_unrolled::Unrolled;
use crate::model::model_params::ModelParams;
use crate::model::solids::{Approach, Solid};
use crate::model::{BallState, SolidId};
use fearless_simd::{Level, Simd};

/// Runs the shots that start at `starts` to their ends. The verdicts are then in the workspace.
pub(crate) fn run(
    level: Level,
    params: &ModelParams,
    limits: &RunLimits,
    starts: &[BallState],
    workspace: &mut BatchWorkspace,
) {
    // `dispatch!` would also compile the shots for SSE4.2. That would take a third more time to compile and
    // gain little over SSE2.
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = level.as_avx512() {
        Batch::<_, true>::run(simd, params, limits, starts, workspace);
    } else if let Some(simd) = level.as_avx2() {
        Batch::<_, false>::run(simd, params, limits, starts, workspace);
    } else {
        let simd = level.as_sse2().expect("every x86-64 has SSE2");
        Batch::<_, false>::run(simd, params, limits, starts, workspace);
    }
    #[cfg(not(target_arch = "x86_64"))]
    fearless_simd::dispatch!(level, simd => {
        Batch::<_, false>::run(simd, params, limits, starts, workspace)
    });
}

/// A batch that is being simulated.
///
/// `WIDE` steps sixteen lanes instead of eight. This pays off with AVX-512, where one register holds eight
/// lanes: two independent registers hide the latency of operations. With narrower registers eight lanes are
/// several registers already.
struct Batch<'a, S: Simd, const WIDE: bool> {
    simd: S,
    params: &'a ModelParams,
    limits: &'a RunLimits,
    workspace: &'a mut BatchWorkspace,
}

/// Eight lanes.
type Narrow<S> = F64x8<S>;
/// Sixteen lanes.
type Wide<S> = Unrolled<F64x8<S>>;

/// Calls a method as a separate function, compiled for the vector instructions.
macro_rules! vectorized {
    ($batch:ident.$method:ident::<$lanes:ty>($($argument:expr),*)) => {
        $batch.vectorized(
            #[inline(always)]
            |batch: &mut Self| batch.$method::<$lanes>($($argument),*),
        )
    };
}

impl<S: Simd, const WIDE: bool> Batch<'_, S, WIDE> {
    fn run(
        simd: S,
        params: &ModelParams,
        limits: &RunLimits,
        starts: &[BallState],
        workspace: &mut BatchWorkspace,
    ) {
        workspace.reset(starts.len());
        let mut batch = Batch::<S, WIDE> {
            simd,
            params,
            limits,
            workspace,
        };
        loop {
            batch.workspace.start_shots(params, limits, starts);
            if batch.workspace.is_idle() {
                return;
            }
            for phase in Phase::ALL {
                batch.work_off(phase);
            }
        }
    }

    /// Works off the queue of a phase.
    fn work_off(&mut self, phase: Phase) {
        match phase {
            Phase::Flight if WIDE => vectorized!(self.fly::<Wide<S>>()),
            Phase::Flight => vectorized!(self.fly::<Narrow<S>>()),
            Phase::Single(SolidId::Board) => {
                if WIDE {
                    vectorized!(self.board_contact::<Wide<S>>());
                }
                vectorized!(self.board_contact::<Narrow<S>>());
            }
            Phase::Single(SolidId::Ring) => {
                if WIDE {
                    vectorized!(self.ring_contact::<Wide<S>>());
                }
                vectorized!(self.ring_contact::<Narrow<S>>());
            }
            Phase::BoardAndRing => vectorized!(self.double_contact::<Narrow<S>>()),
        }
    }

    /// Runs some work as a separate function. (All in one function would take the compiler minutes.)
    #[inline(never)]
    fn vectorized(&mut self, work: impl FnOnce(&mut Self)) {
        self.simd.vectorize(
            #[inline(always)]
            || work(self),
        );
    }

    #[inline(always)]
    fn lane_params<R: SimdReal<Simd = S>>(&self) -> ModelParams<R> {
        self.params.map(
            #[inline(always)]
            |value| R::broadcast(self.simd, value),
        )
    }

    /// Runs one segment of a shot in the scalar form and queues it again.
    #[cold]
    fn run_scalar(&mut self, slot: u32) {
        let shot = &mut self.workspace.slots[slot as usize];
        if shot.segments >= MAX_SEGMENTS {
            self.workspace.finish(slot, Ending::Unresolved, false);
            return;
        }
        shot.segments += 1;
        match event_driven::run_segment(self.params, self.limits, shot) {
            Some(verdict) => self.workspace.record(slot, verdict),
            None => self.workspace.enqueue(slot),
        }
    }

    /// Flies every shot of the queue to its end or its next touch.
    #[inline(always)]
    fn fly<R: SimdReal<Simd = S>>(&mut self) {
        let params = &self.lane_params::<R>();
        let queue = self.workspace.take_flights();
        let mut block = LaneBlock::new();
        for slots in queue.chunks(R::LANES) {
            // Lanes without a shot repeat the last one.
            let last = slots[slots.len() - 1];
            let mut next = slots.iter().copied().chain(std::iter::repeat(last));
            block.fill(R::ALL, &self.workspace.slots, || next.next());
            let mut shots = block.load::<R>(self.simd);
            let start = shots.state;
            let arc = FlightArc::new(params, &start);
            let dt = arc.first_end();
            shots.crossing.after_flight(params, &start, dt);
            shots.state = start.after_flight(&params.ball, dt);
            shots.time_s = shots.time_s + dt;
            let late = params.splat(self.limits.time_limit_s).lt(shots.time_s);
            let end = FlightEnd {
                rare: R::mask_to_bits(arc.beside_board.lt(dt) | arc.unresolved | late),
                made: R::mask_to_bits(shots.crossing.is_made(params, &shots.state)),
                touches: [
                    R::mask_to_bits(arc.touch_of(SolidId::Board).le(dt)),
                    R::mask_to_bits(arc.touch_of(SolidId::Ring).le(dt)),
                ],
                rose: R::mask_to_bits(rose_to_ring(params, &shots.state)),
            };
            block.store(&shots);
            let occupied = R::ALL >> (R::LANES - slots.len());
            self.finish_flights(&mut block, slots, occupied, &end);
        }
        self.workspace.return_queue(queue);
    }

    /// Takes the shots of a block out of their lanes after a flight, grouped by outcome: a branch in each
    /// lane would be mispredicted too often.
    #[inline(always)]
    fn finish_flights(
        &mut self,
        block: &mut LaneBlock,
        slots: &[u32],
        occupied: LaneBits,
        end: &FlightEnd,
    ) {
        let mut remaining = occupied;
        for lane in lanes_in(occupied) {
            let shot = &mut self.workspace.slots[slots[lane] as usize];
            shot.contact = ContactState::Free;
            if bit(end.rare, lane) || shot.segments >= MAX_SEGMENTS {
                remaining &= !(1 << lane);
                self.run_scalar(slots[lane]);
                continue;
            }
            shot.segments += 1;
            block.remove(lane, shot);
        }
        let new = FrictionState::new(self.params);
        // If the ball touches both at once, the ring counts.
        for solid in [SolidId::Ring, SolidId::Board] {
            let touches = end.touches[solid.index()];
            for lane in lanes_in(remaining & touches) {
                let shot = &mut self.workspace.slots[slots[lane] as usize];
                shot.contacts.push(solid);
                shot.contact = ContactState::Single(solid, new);
                self.workspace
                    .queue_mut(Phase::Single(solid))
                    .push(slots[lane]);
            }
            remaining &= !touches;
        }
        for lane in lanes_in(remaining) {
            let ending = flight_ending(bit(end.rose, lane));
            let made = ending == Ending::Fell && bit(end.made, lane);
            self.workspace.finish(slots[lane], ending, made);
        }
    }

    #[inline(always)]
    fn board_contact<R: SimdReal<Simd = S>>(&mut self) {
        let params = self.lane_params::<R>();
        self.single_contact(&params, &params.board, &params.ring);
    }

    #[inline(always)]
    fn ring_contact<R: SimdReal<Simd = S>>(&mut self) {
        let params = self.lane_params::<R>();
        self.single_contact(&params, &params.ring, &params.board);
    }

    /// Fills the free lanes with shots that wait for `phase`.
    #[inline(always)]
    fn refill<R: SimdReal<Simd = S>>(&mut self, block: &mut LaneBlock, phase: Phase) {
        let free = R::ALL & !block.occupied();
        let (slots, queue) = self.workspace.slots_and_queue(phase);
        block.fill(free, slots, || queue.pop());
        block.load_friction_of(free, slots);
    }

    /// Whether to leave a phase whose lanes cannot be filled, because another phase has enough shots.
    #[inline(always)]
    fn should_suspend<R: SimdReal<Simd = S>>(&self, block: &LaneBlock, phase: Phase) -> bool {
        block.occupied() != R::ALL && self.workspace.other_phase_fills(Wide::<S>::LANES, phase)
    }

    /// Steps the shots on one solid until they part or touch `other`, or until too few are left to fill
    /// the lanes.
    #[inline(always)]
    fn single_contact<R, A, B>(&mut self, params: &ModelParams<R>, solid: &A, other: &B)
    where
        R: SimdReal<Simd = S>,
        A: Solid<R>,
        B: Solid<R>,
    {
        let phase = Phase::Single(A::ID);
        let longest = params.splat(self.limits.longest_step_s);
        let mut block = LaneBlock::new();
        loop {
            self.refill::<R>(&mut block, phase);
            if block.occupied() == 0 {
                return;
            }
            let mut shots = block.load::<R>(self.simd);
            let before = shots.state;
            let bound = max_acceleration(params, solid, &before, longest);
            let approach = other.approach(&params.ball, &before, bound, longest);
            let leaves = R::mask_to_bits(!solid.faces(&before) | approach.has_arrived());
            // Half of the lanes fit into a narrower block.
            let few = block.occupied().count_ones() as usize <= R::LANES / 2
                && R::LANES > Narrow::<S>::LANES;
            let suspended = few || self.should_suspend::<R>(&block, phase);
            let removed = if suspended { block.occupied() } else { leaves };
            for lane in lanes_in(removed & block.occupied()) {
                let slot = block.slot(lane);
                let shot = &mut self.workspace.slots[slot as usize];
                block.remove(lane, shot);
                shot.contact = ContactState::Single(A::ID, block.friction(A::ID, lane));
                if bit(leaves, lane) {
                    self.run_scalar(slot);
                } else {
                    self.workspace.queue_mut(phase).push(slot);
                }
            }
            if suspended {
                return;
            }
            let mut friction = block.load_friction::<R>(self.simd, A::ID);
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
            let done = R::mask_to_bits(step.parted | end.any()) & block.occupied();
            if done == 0 {
                continue;
            }
            let parted = R::mask_to_bits(step.parted);
            let made = R::mask_to_bits(shots.crossing.is_made(params, &shots.state));
            let end = end.map(
                #[inline(always)]
                |mask| R::mask_to_bits(mask),
            );
            for lane in lanes_in(done) {
                let slot = block.slot(lane);
                block.remove(lane, &mut self.workspace.slots[slot as usize]);
                if bit(parted, lane) {
                    self.workspace.queue_mut(Phase::Flight).push(slot);
                } else {
                    self.finish_contact(slot, end.map(|rule| bit(rule, lane)), bit(made, lane));
                }
            }
        }
    }

    /// Records the end of a shot in contact.
    #[inline(always)]
    fn finish_contact(&mut self, slot: u32, end: [bool; 3], made: bool) {
        if let Some(ending) = ContactEnd::ending(end) {
            let made = ending == Ending::Fell && made;
            self.workspace.finish(slot, ending, made);
        }
    }

    /// Steps the shots on board and ring until one contact is left or the ball is lodged.
    #[inline(always)]
    fn double_contact<R: SimdReal<Simd = S>>(&mut self) {
        let params = &self.lane_params::<R>();
        let solids = (&params.board, &params.ring);
        let longest = params.splat(self.limits.longest_step_s);
        let phase = Phase::BoardAndRing;
        let mut block = LaneBlock::new();
        loop {
            self.refill::<R>(&mut block, phase);
            if block.occupied() == 0 {
                return;
            }
            if self.should_suspend::<R>(&block, phase) {
                self.suspend_double_contacts(&mut block);
                return;
            }
            let mut shots = block.load::<R>(self.simd);
            let before = shots.state;
            let mut friction = [
                block.load_friction(self.simd, SolidId::Board),
                block.load_friction(self.simd, SolidId::Ring),
            ];
            let step = double::step(params, solids, &mut shots.state, &mut friction, longest);
            let left = [
                step.parted[0] | !solids.0.faces(&shots.state),
                step.parted[1] | !solids.1.faces(&shots.state),
            ];
            let stepped = step.dt.is_positive();
            let rolling_times =
                double::rolling_time(&friction, block.load_rolling_times(self.simd), step.dt);
            let lodged = is_lodged(rolling_times, self.limits.lodged_after_s) & stepped;
            let end = shots.after_step(params, &before, step.dt, self.limits.time_limit_s);
            block.store(&shots);
            block.store_rolling_times(rolling_times);
            for solid in SolidId::ALL {
                block.store_friction(solid, &friction[solid.index()]);
            }
            let ended = R::mask_to_bits(end.any() & stepped);
            let lodged = R::mask_to_bits(lodged);
            let left = [R::mask_to_bits(left[0]), R::mask_to_bits(left[1])];
            let made = R::mask_to_bits(shots.crossing.is_made(params, &shots.state));
            let end = end.map(
                #[inline(always)]
                |mask| R::mask_to_bits(mask),
            );
            let done = ended | lodged | left[0] | left[1];
            for lane in lanes_in(done & block.occupied()) {
                let slot = block.slot(lane);
                let shot = &mut self.workspace.slots[slot as usize];
                block.remove(lane, shot);
                if bit(ended, lane) {
                    self.finish_contact(slot, end.map(|rule| bit(rule, lane)), bit(made, lane));
                } else if bit(lodged, lane) {
                    self.workspace.finish(slot, Ending::Lodged, false);
                } else {
                    let friction = SolidId::ALL.map(|solid| block.friction(solid, lane));
                    let left = left.map(|left| bit(left, lane));
                    shot.contact = ContactState::after_double(left, friction, 0.0);
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
            shot.contact = ContactState::BoardAndRing {
                friction: SolidId::ALL.map(|solid| block.friction(solid, lane)),
                rolling_time_s: block.rolling_time_s(lane),
            };
            self.workspace.enqueue(slot);
        }
    }
}

/// How the flights of a block ended, lane by lane.
struct FlightEnd {
    /// Left to the scalar form.
    rare: LaneBits,
    made: LaneBits,
    /// The ball touches each solid.
    touches: [LaneBits; SolidId::COUNT],
    rose: LaneBits,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::{Release, Simulator};
    use crate::model::Physics;
    use crate::units::{DEGREE_RAD, FOOT_M};

    /// Sixteen lanes also run (slowly) without AVX-512, so this test runs everywhere.
    fn check<S: Simd>(simd: S) {
        let simulator = Simulator::new(&Physics::paper()).unwrap();
        let (params, limits) = (&simulator.params, &simulator.limits);
        let starts: Vec<_> = (0..3000u32)
            .map(|i| {
                let fraction = |n: u32| f64::from((i * n) % 3000) / 3000.0;
                Release {
                    distance_m: 13.75 * FOOT_M,
                    court_angle_rad: 0.0,
                    height_above_hoop_m: -3.0 * FOOT_M,
                    speed_m_s: (22.0 + 5.0 * fraction(7)) * FOOT_M,
                    pitch_rad: (40.0 + 25.0 * fraction(13)) * DEGREE_RAD,
                    polar_rad: (6.0 * fraction(11) - 3.0) * DEGREE_RAD,
                    backspin_rad_s: 30.0 * fraction(17),
                    rifle_spin_rad_s: 0.0,
                    side_spin_rad_s: 0.0,
                }
                .state()
            })
            .collect();
        let mut workspace = BatchWorkspace::default();
        Batch::<S, true>::run(simd, params, limits, &starts, &mut workspace);
        let sixteen = workspace.verdicts.clone();
        let alone: Vec<_> = starts
            .iter()
            .map(|start| simulator.verdict(*start))
            .collect();
        assert!(alone.iter().any(|v| v.made) && alone.iter().any(|v| !v.made));
        assert_eq!(sixteen, alone);
        Batch::<S, false>::run(simd, params, limits, &starts, &mut workspace);
        assert_eq!(workspace.verdicts, alone);
    }

    #[test]
    fn contract_sixteen_lanes_give_the_verdicts_of_single_shots() {
        #[cfg(target_arch = "x86_64")]
        check(Level::baseline().as_sse2().unwrap());
        #[cfg(not(target_arch = "x86_64"))]
        fearless_simd::dispatch!(Level::baseline(), simd => check(simd));
    }
}
