//! The free flights of a batch in segments: in air, or at solids with edges and bracket.

use super::batch_state::Batch;
use super::flight_block::{FlightBlock, FlyingShots};
use super::lift_flight::lift_segments;
use super::parabola_flight_phase::FlightEnd;
use super::workspace::Phase;
use crate::dynamics::end_rules::rose_to_ring;
use crate::dynamics::flight::{drag_segment, far_segment, is_far};
use crate::math::real::{Mask, SimdReal};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::Solid;
use crate::model::{BallState, SolidId};
use fearless_simd::Simd;

/// Starts shots, as long as there are free slots, and flies every shot that waits for flight to its
/// end or its next touch.
///
/// One module for each phase: they compile in parallel.
#[inline(never)]
pub(super) fn fly_in_segments<S, T, const WIDTH: u8>(
    batch: &mut Batch<S, WIDTH>,
    starts: &[BallState],
) where
    S: Simd,
    T: SimdReal<Simd = S, Element = f64>,
{
    batch.simd.vectorize(
        #[inline(always)]
        || {
            batch.fly_in_segments::<T>(starts);
        },
    );
}

impl<S: Simd, const WIDTH: u8> Batch<'_, S, WIDTH> {
    /// Flies the shots that have not started yet, as long as there are free slots, and then those
    /// that wait, a segment at a time.
    #[inline(always)]
    fn fly_in_segments<T: SimdReal<Simd = S, Element = f64>>(&mut self, starts: &[BallState]) {
        let params = &self.lane_params::<T>();
        let mut queue = self.workspace.take_flights();
        let mut first_flights = FlightBlock::new();
        let mut later_flights = FlightBlock::new();
        loop {
            let numbers = self.workspace.next_starts(T::LANES);
            let starts = &starts[numbers.clone()];
            let at_release = !numbers.is_empty();
            let block = if at_release {
                first_flights.fill_at_release(self.params, starts);
                &mut first_flights
            } else {
                queue.append(self.workspace.queue_mut(Phase::Flight));
                let free = T::ALL & !later_flights.lanes.occupied();
                let shots_in_progress = &mut self.workspace.slots;
                later_flights.fill(free, self.params, shots_in_progress, || queue.pop());
                if later_flights.lanes.occupied() == 0 {
                    break;
                }
                &mut later_flights
            };
            let mut shots = block.load::<T>(self.simd, params);
            let mut flight = SegmentedFlight::new(params);
            if at_release {
                self.fly_far_segments(params, &mut shots);
            }
            self.fly_one_segment(params, &mut shots, &mut flight);
            let end = flight.end(params, &shots);
            block.store(params, &shots, end.ring_motions() & !end.needs_scalar);
            let ended = !T::mask_to_bits(flight.flying);
            if at_release {
                self.finish_first_flights(block, (numbers.start, starts), ended, &end);
            } else {
                let slots = block.lanes.slots();
                self.finish_flights(block, &slots, ended & block.lanes.occupied(), &end);
            }
        }
        self.workspace.return_queue(queue);
    }

    /// Flies shots side by side from their releases until each of them is near ring and board, or
    /// falls before it is.
    #[inline(always)]
    fn fly_far_segments<T: SimdReal<Simd = S, Element = f64>>(
        &self,
        params: &ModelParams<T>,
        shots: &mut FlyingShots<T>,
    ) {
        let time_limit = params.splat(self.limits.time_limit_s);
        let mut far = params.splat_mask(!params.ball.has_lift);
        loop {
            far = far & is_far(params, &shots.state);
            if !far.any() {
                return;
            }
            let (segment, stays_far) = far_segment(params, &shots.state);
            let time_s = shots.time_s + segment.dt;
            far = far & stays_far & time_s.le(time_limit);
            shots.crossing.after_segment(&segment, far);
            shots.state = segment.end.select(far, shots.state);
            shots.time_s = time_s.select(far, shots.time_s);
        }
    }

    #[inline(always)]
    fn fly_one_segment<T: SimdReal<Simd = S, Element = f64>>(
        &self,
        params: &ModelParams<T>,
        shots: &mut FlyingShots<T>,
        flight: &mut SegmentedFlight<T>,
    ) {
        let flying = flight.flying;
        let segment = if params.ball.has_lift {
            lift_segments(self.simd, params, &shots.state)
        } else {
            drag_segment(params, &shots.state)
        };
        let dt = segment.dt.select(flying, params.zero());
        shots.crossing.after_segment(&segment, flying);
        shots.state = segment.end.select(flying, shots.state);
        shots.time_s = shots.time_s + dt;
        let late = params.splat(self.limits.time_limit_s).lt(shots.time_s);
        for i in [0, 1] {
            flight.touches[i] = flight.touches[i] | (segment.touches[i] & flying);
        }
        flight.behind_board = flight.behind_board | (segment.behind_board & flying);
        flight.needs_scalar = flight.needs_scalar | ((segment.unresolved | late) & flying);
        flight.flying = flying & !segment.ends() & !late;
    }
}

/// Flights in segments: where they still go on, and how they have ended elsewhere.
struct SegmentedFlight<T: SimdReal> {
    flying: T::Mask,
    touches: [T::Mask; SolidId::COUNT],
    behind_board: T::Mask,
    needs_scalar: T::Mask,
}

impl<T: SimdReal> SegmentedFlight<T> {
    #[inline(always)]
    fn new(params: &ModelParams<T>) -> Self {
        let none = params.splat_mask(false);
        Self {
            flying: params.splat_mask(true),
            touches: [none; SolidId::COUNT],
            behind_board: none,
            needs_scalar: none,
        }
    }

    #[inline(always)]
    fn end(&self, params: &ModelParams<T>, shots: &FlyingShots<T>) -> FlightEnd {
        let [on_board, on_ring] = self.touches;
        FlightEnd {
            needs_scalar: T::mask_to_bits(self.needs_scalar),
            made: T::mask_to_bits(shots.crossing.is_made(params, &shots.state)),
            touches: [T::mask_to_bits(on_board), T::mask_to_bits(on_ring)],
            in_frame: [
                T::mask_to_bits(params.board.is_in_frame(&shots.state)),
                T::mask_to_bits(params.ring.is_in_frame(&shots.state)),
            ],
            rose: T::mask_to_bits(rose_to_ring(params, &shots.state)),
            behind_board: T::mask_to_bits(self.behind_board),
        }
    }
}
