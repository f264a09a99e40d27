//! Shots in flight side by side, one in each lane.

use super::lane_block::{LaneBlock, set_bit};
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::dynamics::integrators::shot_progress::ShotProgress;
use crate::math::real::{LaneBits, MAX_F64_LANES, Real, SimdReal};
use crate::math::real_record::{RealRecord, RecordReader, RecordWriter};
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{CONTACT_NUMBERS, ContactFrameState, FramedPart, Solid};

/// A shot in flight, or one in each lane.
#[derive(Clone, Copy)]
pub(super) struct FlyingShots<T: Real> {
    pub(super) state: BallState<T>,
    pub(super) time_s: T,
    pub(super) crossing: HoopCrossing<T>,
}

/// Numbers and truth values of a [`FlyingShots`].
pub(super) const NUMBERS: usize = 10;
pub(super) const TRUTHS: usize = 2;

impl<T: Real> RealRecord<T> for FlyingShots<T> {
    #[inline(always)]
    fn read(from: &mut impl RecordReader<T>) -> Self {
        Self {
            state: RealRecord::read(from),
            time_s: from.number(),
            crossing: RealRecord::read(from),
        }
    }

    #[inline(always)]
    fn write(&self, to: &mut impl RecordWriter<T>) {
        self.state.write(to);
        to.number(self.time_s);
        self.crossing.write(to);
    }
}

/// The flights of a block. A ball that comes from the ring or has reached it has its state in the
/// frame of that contact.
#[repr(C, align(64))]
pub(super) struct FlightBlock {
    pub(super) lanes: LaneBlock<f64, NUMBERS, TRUTHS>,
    ring_motion: LaneBlock<f64, CONTACT_NUMBERS, 0>,
    /// The ball comes from the ring: `ring_motion` holds.
    from_ring: LaneBits,
}

impl FlightBlock {
    pub(super) fn new() -> Self {
        Self {
            lanes: LaneBlock::new(),
            ring_motion: LaneBlock::new(),
            from_ring: 0,
        }
    }

    /// Puts shots into some lanes, as long as `next` gives any.
    #[inline(always)]
    pub(super) fn fill(
        &mut self,
        lanes: LaneBits,
        params: &ModelParams,
        shots: &mut [ShotProgress],
        mut next: impl FnMut() -> Option<u32>,
    ) {
        let (ring_motion, from_ring) = (&mut self.ring_motion, &mut self.from_ring);
        self.lanes.fill(
            lanes,
            #[inline(always)]
            |lane| {
                let slot = next()?;
                let shot = &mut shots[slot as usize];
                let is_from_ring = shot.frame == Some(FramedPart::RingCircle);
                set_bit(from_ring, lane, is_from_ring);
                if is_from_ring {
                    ring_motion.set(lane, &shot.motion);
                } else {
                    shot.update_state(params);
                }
                let flying = FlyingShots {
                    state: shot.state,
                    time_s: shot.time_s,
                    crossing: shot.crossing,
                };
                Some((slot, shot.steps, flying))
            },
        );
    }

    /// Puts shots at their release into the lanes; those that are left repeat the last one, and
    /// count as occupied too.
    #[inline(always)]
    pub(super) fn fill_at_release(&mut self, params: &ModelParams, starts: &[BallState]) {
        self.from_ring = 0;
        let last = starts.len() - 1;
        self.lanes.fill(
            LaneBits::MAX >> (LaneBits::BITS as usize - MAX_F64_LANES),
            #[inline(always)]
            |lane| {
                let state = starts[lane.min(last)];
                let flying = FlyingShots {
                    state,
                    time_s: 0.0,
                    crossing: HoopCrossing::at_release(params, &state),
                };
                Some((0, 0, flying))
            },
        );
    }

    /// The shot in a lane.
    #[inline(always)]
    fn shot(&self, lane: usize) -> FlyingShots<f64> {
        self.lanes.get(lane)
    }

    /// The time of the shot in a lane, s.
    #[inline(always)]
    pub(super) fn time_s(&self, lane: usize) -> f64 {
        self.shot(lane).time_s
    }

    /// Writes the shot in a lane to its memory, and frees the lane. If it is `on_ring`, it has its
    /// motion in the frame of that contact. The contacts in the memory are not updated.
    #[inline(always)]
    pub(super) fn remove(&mut self, lane: usize, shot: &mut ShotProgress, on_ring: bool) {
        let flown = self.shot(lane);
        if on_ring {
            shot.motion = self.ring_motion.get(lane);
        } else {
            shot.state = flown.state;
            shot.frame = None;
        }
        shot.time_s = flown.time_s;
        shot.crossing = flown.crossing;
        shot.steps = self.lanes.steps(lane);
        self.lanes.vacate(lane);
    }

    /// The shots; those that come from the ring have left its frame.
    #[inline(always)]
    pub(super) fn load<T: SimdReal<Element = f64>>(
        &self,
        simd: T::Simd,
        params: &ModelParams<T>,
    ) -> FlyingShots<T> {
        let mut shots: FlyingShots<T> = self.lanes.load(simd);
        if self.from_ring & self.lanes.occupied() != 0 {
            let motion: ContactFrameState<T> = self.ring_motion.load(simd);
            let from_ring = T::mask_from_bits(simd, self.from_ring);
            let state = params.ring.to_world(&params.ball, &motion);
            shots.state = state.select(from_ring, shots.state);
        }
        shots
    }

    /// Stores the shots after a flight: none comes from the ring any more. Where `on_ring` is not
    /// empty, the shots have reached the ring there, and are stored in its frame as well.
    #[inline(always)]
    pub(super) fn store<T: SimdReal<Element = f64>>(
        &mut self,
        params: &ModelParams<T>,
        shots: &FlyingShots<T>,
        on_ring: LaneBits,
    ) {
        self.lanes.store(shots);
        self.from_ring = 0;
        if on_ring != 0 {
            let motion = params.ring.to_contact(&params.ball, &shots.state);
            self.ring_motion.store(&motion);
        }
    }
}
