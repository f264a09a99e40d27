//! Shots side by side in the lanes of vectors, one in each.

use crate::dynamics::integrators::shot_progress::ShotProgress;
use crate::math::real::{LaneBits, LaneElement, MAX_LANES, SimdReal};
use crate::math::real_record::{RealRecord, RecordReader, RecordWriter};

/// Numbers and truth values of the shots in the lanes between two steps. A lane without a shot
/// keeps those of the last one, and steps on without harm.
///
/// Every row starts at a cache line, so that no vector lies across two of them.
#[repr(C, align(64))]
pub(super) struct LaneBlock<E, const NUMBERS: usize, const TRUTHS: usize> {
    numbers: [[E; MAX_LANES]; NUMBERS],
    slots: [u32; MAX_LANES],
    /// [`ShotProgress::steps`].
    steps: [u32; MAX_LANES],
    truths: [LaneBits; TRUTHS],
    /// The lanes that have a shot.
    occupied: LaneBits,
}

/// The lanes whose bits are set, in order.
pub(super) fn lanes_in(mut bits: LaneBits) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (bits != 0).then(|| {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            lane
        })
    })
}

/// The bit of one lane.
#[inline(always)]
pub(super) fn bit(bits: LaneBits, lane: usize) -> bool {
    bits >> lane & 1 == 1
}

/// Sets the bit of one lane.
#[inline(always)]
pub(super) fn set_bit(bits: &mut LaneBits, lane: usize, value: bool) {
    *bits = *bits & !(1 << lane) | LaneBits::from(value) << lane;
}

/// The bits of a mask in some lanes.
#[inline(always)]
pub(super) fn bits_in<T: SimdReal>(lanes: LaneBits, mask: T::Mask) -> LaneBits {
    T::mask_to_bits(mask) & lanes
}

impl<E: LaneElement, const NUMBERS: usize, const TRUTHS: usize> LaneBlock<E, NUMBERS, TRUTHS> {
    pub(super) fn new() -> Self {
        Self {
            numbers: [[E::default(); MAX_LANES]; NUMBERS],
            slots: [0; MAX_LANES],
            steps: [0; MAX_LANES],
            truths: [0; TRUTHS],
            occupied: 0,
        }
    }

    /// The lanes that have a shot.
    #[inline(always)]
    pub(super) fn occupied(&self) -> LaneBits {
        self.occupied
    }

    /// The slots of the shots.
    #[inline(always)]
    pub(super) fn slots(&self) -> [u32; MAX_LANES] {
        self.slots
    }

    /// The steps in contact of the shot in a lane so far.
    #[inline(always)]
    pub(super) fn steps(&self, lane: usize) -> u32 {
        self.steps[lane]
    }

    /// Puts shots into some lanes, as long as `next` gives any: a slot, the steps so far, and what
    /// is kept of it.
    #[inline(always)]
    pub(super) fn fill<R: RealRecord<f64>>(
        &mut self,
        lanes: LaneBits,
        mut next: impl FnMut(usize) -> Option<(u32, u32, R)>,
    ) {
        // Local copies stay in registers.
        let (mut truths, mut occupied) = (self.truths, self.occupied);
        for lane in lanes_in(lanes) {
            let Some((slot, steps, record)) = next(lane) else {
                break;
            };
            let rows = (&mut self.numbers, &mut truths);
            record.write(&mut Cursor::new(rows, OneLane(lane)));
            self.slots[lane] = slot;
            self.steps[lane] = steps;
            set_bit(&mut occupied, lane, true);
        }
        (self.truths, self.occupied) = (truths, occupied);
    }

    /// Sets what is kept of the shot in a lane.
    #[inline(always)]
    pub(super) fn set<R: RealRecord<f64>>(&mut self, lane: usize, record: &R) {
        let rows = (&mut self.numbers, &mut self.truths);
        record.write(&mut Cursor::new(rows, OneLane(lane)));
    }

    /// Counts a step of every lane; returns the lanes that have reached `max_steps`. (A lane
    /// without a shot may be among them.)
    #[inline(always)]
    pub(super) fn count_step(&mut self, max_steps: u32) -> LaneBits {
        let mut reached = 0;
        for (lane, steps) in self.steps.iter_mut().enumerate() {
            *steps = steps.wrapping_add(1);
            reached |= LaneBits::from(*steps >= max_steps) << lane;
        }
        reached
    }

    /// What is kept of the shot in a lane.
    #[inline(always)]
    pub(super) fn get<R: RealRecord<f64>>(&self, lane: usize) -> R {
        R::read(&mut Cursor::new(self, OneLane(lane)))
    }

    /// Takes the shot out of a lane: `write` writes what is kept of it to its memory. Returns its
    /// slot.
    #[inline(always)]
    pub(super) fn take<R: RealRecord<f64>>(
        &mut self,
        lane: usize,
        shots: &mut [ShotProgress],
        write: impl FnOnce(&mut ShotProgress, R),
    ) -> u32 {
        let slot = self.slots[lane];
        let shot = &mut shots[slot as usize];
        shot.steps = self.steps[lane];
        write(shot, self.get(lane));
        self.vacate(lane);
        slot
    }

    /// Frees a lane.
    #[inline(always)]
    pub(super) fn vacate(&mut self, lane: usize) {
        set_bit(&mut self.occupied, lane, false);
    }

    /// What is kept of the shots in all lanes.
    #[inline(always)]
    pub(super) fn load<T: SimdReal<Element = E>, R: RealRecord<T>>(&self, simd: T::Simd) -> R {
        R::read(&mut Cursor::new(self, AllLanes(simd)))
    }

    #[inline(always)]
    pub(super) fn store<T: SimdReal<Element = E>, R: RealRecord<T>>(&mut self, shots: &R) {
        shots.write(&mut Cursor::new(self, AllLanes(())));
    }
}

/// Goes through the rows of a block, in one lane or in all.
struct Cursor<Block, Lanes> {
    block: Block,
    lanes: Lanes,
    /// The next row of numbers, and the next bits.
    row: usize,
    bits: usize,
}

struct OneLane(usize);
struct AllLanes<S>(S);

impl<Block, Lanes> Cursor<Block, Lanes> {
    #[inline(always)]
    fn new(block: Block, lanes: Lanes) -> Self {
        let (row, bits) = (0, 0);
        Self {
            block,
            lanes,
            row,
            bits,
        }
    }

    #[inline(always)]
    fn next_row(&mut self) -> usize {
        self.row += 1;
        self.row - 1
    }

    #[inline(always)]
    fn next_bits(&mut self) -> usize {
        self.bits += 1;
        self.bits - 1
    }
}

impl<E: LaneElement, const NUMBERS: usize, const TRUTHS: usize> RecordReader<f64>
    for Cursor<&LaneBlock<E, NUMBERS, TRUTHS>, OneLane>
{
    #[inline(always)]
    fn number(&mut self) -> f64 {
        self.block.numbers[self.next_row()][self.lanes.0].to_f64()
    }

    #[inline(always)]
    fn truth(&mut self) -> bool {
        bit(self.block.truths[self.next_bits()], self.lanes.0)
    }
}

impl<E: LaneElement, const NUMBERS: usize, const TRUTHS: usize> RecordWriter<f64>
    for Cursor<(&mut [[E; MAX_LANES]; NUMBERS], &mut [LaneBits; TRUTHS]), OneLane>
{
    #[inline(always)]
    fn number(&mut self, number: f64) {
        let row = self.next_row();
        self.block.0[row][self.lanes.0] = E::from_f64(number);
    }

    #[inline(always)]
    fn truth(&mut self, truth: bool) {
        let bits = self.next_bits();
        set_bit(&mut self.block.1[bits], self.lanes.0, truth);
    }
}

impl<T: SimdReal, const NUMBERS: usize, const TRUTHS: usize> RecordReader<T>
    for Cursor<&LaneBlock<T::Element, NUMBERS, TRUTHS>, AllLanes<T::Simd>>
{
    #[inline(always)]
    fn number(&mut self) -> T {
        T::load(self.lanes.0, &self.block.numbers[self.next_row()])
    }

    #[inline(always)]
    fn truth(&mut self) -> T::Mask {
        T::mask_from_bits(self.lanes.0, self.block.truths[self.next_bits()])
    }
}

impl<T: SimdReal, const NUMBERS: usize, const TRUTHS: usize> RecordWriter<T>
    for Cursor<&mut LaneBlock<T::Element, NUMBERS, TRUTHS>, AllLanes<()>>
{
    #[inline(always)]
    fn number(&mut self, number: T) {
        let row = self.next_row();
        number.store(&mut self.block.numbers[row]);
    }

    #[inline(always)]
    fn truth(&mut self, truth: T::Mask) {
        let bits = self.next_bits();
        self.block.truths[bits] = T::mask_to_bits(truth);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::batch::flight_block::{self, FlyingShots};
    use crate::dynamics::integrators::shot_in_frame::{FRAME_NUMBERS, FRAME_TRUTHS, ShotInFrame};
    use crate::dynamics::integrators::shot_in_world::{ShotInWorld, WORLD_NUMBERS, WORLD_TRUTHS};
    use crate::math::real_record::counts;
    use crate::math::vector::Vec3;
    use crate::model::constants_per_ball_mass::ModelParams;
    use crate::model::solids::CONTACT_NUMBERS;
    use crate::model::{BallState, Physics, SolidId};

    /// The rows of the blocks are as many as the records have fields.
    #[test]
    fn contract_records_fill_the_rows_of_their_blocks() {
        let params = ModelParams::new(&Physics::paper());
        let start = BallState {
            position_m: Vec3::new(4.0, 0.0, -1.0),
            velocity_m_s: Vec3::new(-4.0, 0.0, 6.0),
            spin_rad_s: Vec3::new(0.0, 10.0, 0.0),
        };
        let shot = ShotProgress::at_release(&params, start);
        let in_frame = ShotInFrame::of(&shot, SolidId::Ring, 10.0);
        assert_eq!(counts(&in_frame), (FRAME_NUMBERS, FRAME_TRUTHS));
        let in_world = ShotInWorld::of(&shot);
        assert_eq!(counts(&in_world), (WORLD_NUMBERS, WORLD_TRUTHS));
        let flying = FlyingShots {
            state: shot.state,
            time_s: shot.time_s,
            crossing: shot.crossing,
        };
        let rows = (flight_block::NUMBERS, flight_block::TRUTHS);
        assert_eq!(counts(&flying), rows);
        assert_eq!(counts(&shot.motion), (CONTACT_NUMBERS, 0));
    }
}
