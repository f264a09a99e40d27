//! The shots in contact with one solid, side by side in lanes.

use super::world_frame_block::{bit, count_step, lanes_in, set_bit};
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::dynamics::integrators::event_driven::ShotProgress;
use crate::math::real::{LaneBits, LaneElement, MAX_LANES, SimdReal};
use crate::model::solids::{CONTACT_VALUES, ContactFrameState, FramedPart};
use std::array::from_fn;

type Row<E> = [E; MAX_LANES];

/// The state of the shots in the lanes between two steps. A lane without a shot keeps the values of
/// the last one, and steps on without harm.
///
/// Every row starts at a cache line, so that no vector lies across two of them.
#[repr(C, align(64))]
pub(super) struct ContactFrameBlock<E> {
    /// The values of [`ContactFrameState`].
    motion: [Row<E>; CONTACT_VALUES],
    slip_tolerances: Row<E>,
    /// [`ShotProgress::step_fraction`], [`ShotProgress::contact_time_s`], and the time left at the
    /// start of the contact.
    step_fractions: Row<E>,
    contact_times_s: Row<E>,
    allowed_times_s: Row<E>,
    slots: [u32; MAX_LANES],
    /// [`ShotProgress::steps`].
    steps: [u32; MAX_LANES],
    flags: ContactFlags,
    part: FramedPart,
}

/// The Boolean values of each lane. A local copy stays in registers.
#[derive(Clone, Copy, Default)]
struct ContactFlags {
    has_been_above: LaneBits,
    rose_through: LaneBits,
    rolling: LaneBits,
    rolling_failed: LaneBits,
    /// The lane has a shot.
    occupied: LaneBits,
}

/// The shots as SIMD numbers.
#[derive(Clone, Copy)]
pub(super) struct ContactShots<T: SimdReal> {
    pub(super) motion: ContactFrameState<T>,
    pub(super) friction: FrictionState<T>,
    pub(super) step_fraction: T,
    pub(super) contact_time_s: T,
    pub(super) crossing: HoopCrossing<T>,
}

impl<E: LaneElement> ContactFrameBlock<E> {
    pub(super) fn new(part: FramedPart) -> Self {
        let zeros = [E::default(); MAX_LANES];
        Self {
            part,
            motion: [zeros; CONTACT_VALUES],
            slip_tolerances: zeros,
            step_fractions: zeros,
            contact_times_s: zeros,
            allowed_times_s: zeros,
            slots: [0; MAX_LANES],
            steps: [0; MAX_LANES],
            flags: ContactFlags::default(),
        }
    }

    /// The lanes that have a shot.
    #[inline(always)]
    pub(super) fn occupied(&self) -> LaneBits {
        self.flags.occupied
    }

    /// The part of a solid that the shots are on.
    #[inline(always)]
    pub(super) fn part(&self) -> FramedPart {
        self.part
    }

    /// The slot of the shot in a lane.
    #[inline(always)]
    pub(super) fn slot(&self, lane: usize) -> u32 {
        self.slots[lane]
    }

    /// Puts shots into some lanes, as long as `next` gives any.
    #[inline(always)]
    pub(super) fn fill(
        &mut self,
        lanes: LaneBits,
        time_limit_s: f64,
        shots: &[ShotProgress],
        mut next: impl FnMut() -> Option<u32>,
    ) {
        let mut flags = self.flags;
        for lane in lanes_in(lanes) {
            let Some(slot) = next() else {
                break;
            };
            let shot = &shots[slot as usize];
            for (row, value) in self.motion.iter_mut().zip(shot.motion.to_array()) {
                row[lane] = E::from_f64(value);
            }
            let friction = &shot.friction[self.part.solid().index()];
            self.slip_tolerances[lane] = E::from_f64(friction.slip_tolerance);
            self.step_fractions[lane] = E::from_f64(shot.step_fraction);
            self.contact_times_s[lane] = E::from_f64(shot.contact_time_s);
            self.allowed_times_s[lane] = E::from_f64(time_limit_s - shot.time_s);
            self.slots[lane] = slot;
            self.steps[lane] = shot.steps;
            set_bit(
                &mut flags.has_been_above,
                lane,
                shot.crossing.has_been_above,
            );
            set_bit(&mut flags.rose_through, lane, shot.crossing.rose_through);
            set_bit(&mut flags.rolling, lane, friction.rolling);
            set_bit(&mut flags.rolling_failed, lane, friction.rolling_failed);
            set_bit(&mut flags.occupied, lane, true);
        }
        self.flags = flags;
    }

    /// Counts a step of every lane; returns the lanes that have reached `max_steps`. (A lane
    /// without a shot may be among them.)
    #[inline(always)]
    pub(super) fn count_step(&mut self, max_steps: u32) -> LaneBits {
        count_step(&mut self.steps, max_steps)
    }

    /// Takes the shot out of a lane.
    #[inline(always)]
    pub(super) fn remove(&mut self, lane: usize, shot: &mut ShotProgress) {
        shot.motion = ContactFrameState::from_array(from_fn(
            #[inline(always)]
            |i| self.motion[i][lane].to_f64(),
        ));
        shot.frame = Some(self.part);
        shot.friction[self.part.solid().index()] = FrictionState {
            rolling: bit(self.flags.rolling, lane),
            rolling_failed: bit(self.flags.rolling_failed, lane),
            slip_tolerance: self.slip_tolerances[lane].to_f64(),
        };
        shot.step_fraction = self.step_fractions[lane].to_f64();
        shot.contact_time_s = self.contact_times_s[lane].to_f64();
        shot.steps = self.steps[lane];
        shot.crossing = HoopCrossing {
            has_been_above: bit(self.flags.has_been_above, lane),
            rose_through: bit(self.flags.rose_through, lane),
        };
        set_bit(&mut self.flags.occupied, lane, false);
    }

    #[inline(always)]
    pub(super) fn load<T: SimdReal<Element = E>>(&self, simd: T::Simd) -> ContactShots<T> {
        ContactShots {
            motion: ContactFrameState::from_array(from_fn(
                #[inline(always)]
                |i| T::load(simd, &self.motion[i]),
            )),
            friction: FrictionState {
                rolling: T::mask_from_bits(simd, self.flags.rolling),
                rolling_failed: T::mask_from_bits(simd, self.flags.rolling_failed),
                slip_tolerance: T::load(simd, &self.slip_tolerances),
            },
            step_fraction: T::load(simd, &self.step_fractions),
            contact_time_s: T::load(simd, &self.contact_times_s),
            crossing: HoopCrossing {
                has_been_above: T::mask_from_bits(simd, self.flags.has_been_above),
                rose_through: T::mask_from_bits(simd, self.flags.rose_through),
            },
        }
    }

    /// The time that was left at the start of each contact, s.
    #[inline(always)]
    pub(super) fn allowed_times_s<T: SimdReal<Element = E>>(&self, simd: T::Simd) -> T {
        T::load(simd, &self.allowed_times_s)
    }

    #[inline(always)]
    pub(super) fn store<T: SimdReal<Element = E>>(&mut self, shots: &ContactShots<T>) {
        for (row, value) in self.motion.iter_mut().zip(shots.motion.to_array()) {
            value.store(row);
        }
        shots
            .friction
            .slip_tolerance
            .store(&mut self.slip_tolerances);
        shots.step_fraction.store(&mut self.step_fractions);
        shots.contact_time_s.store(&mut self.contact_times_s);
        self.flags.rolling = T::mask_to_bits(shots.friction.rolling);
        self.flags.rolling_failed = T::mask_to_bits(shots.friction.rolling_failed);
        self.flags.has_been_above = T::mask_to_bits(shots.crossing.has_been_above);
        self.flags.rose_through = T::mask_to_bits(shots.crossing.rose_through);
    }
}
