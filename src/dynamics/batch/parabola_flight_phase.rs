//! The free flights of a batch that are parabolas, a block at a time.

use super::batch_state::Batch;
use super::flight_block::FlightBlock;
use super::lane_block::{bit, lanes_in, set_bit};
use super::workspace::Phase;
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::end_rules::{flight_ending, rose_to_ring};
use crate::dynamics::flight::FlightEvents;
use crate::dynamics::integrators::event_driven::{self, MAX_PHASES, solids_touched_at_release};
use crate::dynamics::outcome::{ContactSequence, Ending, Verdict};
use crate::math::real::{LaneBits, MAX_F64_LANES, SimdReal};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::FramedPart;
use crate::model::{BallState, SolidId};
use fearless_simd::Simd;

/// Flies every shot that waits for flight, to its end or its next touch.
///
/// One module for each phase: they compile in parallel.
#[inline(never)]
pub(super) fn fly<S, T, const WIDTH: u8>(batch: &mut Batch<S, WIDTH>)
where
    S: Simd,
    T: SimdReal<Simd = S, Element = f64>,
{
    batch.simd.vectorize(
        #[inline(always)]
        || batch.fly_all::<T>(),
    );
}

/// Flies the first arcs of shots that have not started yet, as long as there are free slots.
#[inline(never)]
pub(super) fn fly_from_release<S, T, const WIDTH: u8>(
    batch: &mut Batch<S, WIDTH>,
    starts: &[BallState],
) where
    S: Simd,
    T: SimdReal<Simd = S, Element = f64>,
{
    batch.simd.vectorize(
        #[inline(always)]
        || batch.fly_first_arcs::<T>(starts),
    );
}

impl<S: Simd, const WIDTH: u8> Batch<'_, S, WIDTH> {
    #[inline(always)]
    fn fly_all<T: SimdReal<Simd = S, Element = f64>>(&mut self) {
        let params = &self.lane_params::<T>();
        let queue = self.workspace.take_flights();
        let mut block = FlightBlock::new();
        for slots in queue.chunks(T::LANES) {
            // Lanes without a shot repeat the last one.
            let last = slots[slots.len() - 1];
            let mut next = slots.iter().copied().chain(std::iter::repeat(last));
            let shots_in_progress = &mut self.workspace.slots;
            block.fill(T::ALL, self.params, shots_in_progress, || next.next());
            let end = self.fly_lanes(params, &mut block);
            let real_lanes = T::ALL >> (T::LANES - slots.len());
            self.finish_flights(&mut block, slots, real_lanes, &end);
        }
        self.workspace.return_queue(queue);
    }

    /// Flies the first arcs of shots at their release. Those that touch nothing never take a slot.
    #[inline(always)]
    fn fly_first_arcs<T: SimdReal<Simd = S, Element = f64>>(&mut self, starts: &[BallState]) {
        let params = &self.lane_params::<T>();
        let mut block = FlightBlock::new();
        loop {
            let shots = self.workspace.next_starts(T::LANES);
            if shots.is_empty() {
                return;
            }
            let starts = &starts[shots.clone()];
            block.fill_at_release(self.params, starts);
            let end = self.fly_lanes(params, &mut block);
            self.finish_first_flights(&mut block, (shots.start, starts), T::ALL, &end);
        }
    }

    /// Takes the shots of a block out of their lanes after the first part of their flight. `first`
    /// is the number of the first of them; `ended` tells whose flight has ended. The others wait
    /// for the next part.
    #[inline(always)]
    pub(super) fn finish_first_flights(
        &mut self,
        block: &mut FlightBlock,
        (first, starts): (usize, &[BallState]),
        ended: LaneBits,
        end: &FlightEnd,
    ) {
        let mut flying = 0;
        for (lane, start) in starts.iter().enumerate() {
            if solids_touched_at_release(self.params, start).contains(&true) {
                self.workspace.verdicts[first + lane] =
                    event_driven::run(self.params, self.limits, *start, &mut ());
            } else {
                set_bit(&mut flying, lane, true);
            }
        }
        let [on_board, on_ring] = end.touches;
        let goes_on = on_board | on_ring | end.needs_scalar | !ended;
        for lane in lanes_in(flying & !goes_on) {
            let ending = end.ending(lane);
            self.workspace.verdicts[first + lane] = Verdict {
                made: ending == Ending::Fell && bit(end.made, lane),
                ending,
                contacts: ContactSequence::default(),
                time_s: block.time_s(lane),
            };
        }
        let mut slots = [0; MAX_F64_LANES];
        for lane in lanes_in(flying & goes_on) {
            let slot = self
                .workspace
                .occupy(self.params, first + lane, &starts[lane]);
            slots[lane] = slot;
            if !bit(ended, lane) {
                block.remove(lane, &mut self.workspace.slots[slot as usize], false);
                self.workspace.queue_mut(Phase::Flight).push(slot);
            }
        }
        self.finish_flights(block, &slots, flying & goes_on & ended, end);
    }

    /// Flies the lanes of a block to the ends of their arcs.
    #[inline(always)]
    fn fly_lanes<T: SimdReal<Simd = S, Element = f64>>(
        &self,
        params: &ModelParams<T>,
        block: &mut FlightBlock,
    ) -> FlightEnd {
        let mut shots = block.load::<T>(self.simd, params);
        let start = shots.state;
        let flight = FlightEvents::new(params, &start);
        let dt = flight.first_end();
        shots.crossing.after_flight(params, &start, dt);
        shots.state = start.after_flight(&params.ball, dt);
        shots.time_s = shots.time_s + dt;
        let late = params.splat(self.limits.time_limit_s).lt(shots.time_s);
        let end = FlightEnd {
            needs_scalar: T::mask_to_bits(flight.beside_board.lt(dt) | flight.unresolved | late),
            made: T::mask_to_bits(shots.crossing.is_made(params, &shots.state)),
            touches: [
                T::mask_to_bits(flight.touch_of(SolidId::Board).le(dt)),
                T::mask_to_bits(flight.touch_of(SolidId::Ring).le(dt)),
            ],
            in_frame: [T::ALL; SolidId::COUNT],
            rose: T::mask_to_bits(rose_to_ring(params, &shots.state)),
            behind_board: 0,
        };
        block.store(params, &shots, end.ring_motions() & !end.needs_scalar);
        end
    }

    /// Takes the shots of a block out of their lanes after a flight, grouped by outcome: a branch
    /// in each lane would be mispredicted too often.
    #[inline(always)]
    pub(super) fn finish_flights(
        &mut self,
        block: &mut FlightBlock,
        slots: &[u32],
        real_lanes: LaneBits,
        end: &FlightEnd,
    ) {
        let mut remaining = real_lanes;
        for lane in lanes_in(real_lanes) {
            let shot = &mut self.workspace.slots[slots[lane] as usize];
            if bit(end.needs_scalar, lane) || shot.phases >= MAX_PHASES {
                remaining &= !(1 << lane);
                block.lanes.vacate(lane);
                self.run_scalar(slots[lane]);
                continue;
            }
            shot.phases += 1;
            block.remove(lane, shot, bit(end.ring_motions(), lane));
        }
        let new_friction = FrictionState::new(self.params);
        for solid in [SolidId::Ring, SolidId::Board] {
            let touches = end.touches[solid.index()];
            for lane in lanes_in(remaining & touches) {
                let shot = &mut self.workspace.slots[slots[lane] as usize];
                shot.contacts.push(solid);
                shot.friction[solid.index()] = new_friction;
                if solid == SolidId::Ring && bit(end.ring_motions(), lane) {
                    shot.begin_single_contact(FramedPart::RingCircle);
                } else {
                    shot.step_fraction = 1.0;
                    shot.set_touching(self.params, SolidId::ALL.map(|id| id == solid));
                }
                self.workspace.enqueue(slots[lane]);
            }
            remaining &= !touches;
        }
        for lane in lanes_in(remaining) {
            let ending = end.ending(lane);
            let made = ending == Ending::Fell && bit(end.made, lane);
            self.workspace.finish(slots[lane], ending, made);
        }
    }
}

/// How the flights of a block ended, lane by lane.
pub(super) struct FlightEnd {
    /// Left to the scalar code, which repeats the flight from its start.
    pub(super) needs_scalar: LaneBits,
    pub(super) made: LaneBits,
    /// The ball touches each solid, and the part of it that a frame of contact describes.
    pub(super) touches: [LaneBits; SolidId::COUNT],
    pub(super) in_frame: [LaneBits; SolidId::COUNT],
    pub(super) rose: LaneBits,
    pub(super) behind_board: LaneBits,
}

impl FlightEnd {
    /// How the shot in a lane that touches nothing ended.
    fn ending(&self, lane: usize) -> Ending {
        if bit(self.behind_board, lane) {
            Ending::BehindBoard
        } else {
            flight_ending(bit(self.rose, lane))
        }
    }

    /// The shots that have their motion in the frame of the ring.
    pub(super) fn ring_motions(&self) -> LaneBits {
        let ring = SolidId::Ring.index();
        self.touches[ring] & self.in_frame[ring]
    }
}
