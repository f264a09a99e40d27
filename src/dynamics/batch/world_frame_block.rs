//! Shots in flight or in contact in the world frame side by side, one in each lane.

use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::end_rules::ShotEndFlags;
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::dynamics::integrators::event_driven::ShotProgress;
use crate::math::real::{LaneArray, LaneBits, MAX_F64_LANES, SimdReal};
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{CONTACT_VALUES, ContactFrameState, FramedPart, Solid};
use crate::model::{BallState, SolidId};
use std::array::from_fn;

const ZEROS: LaneArray = [0.0; MAX_F64_LANES];

/// The state of the shots in the lanes between two steps. A lane without a shot keeps the values of
/// the last one, and steps on without harm.
///
/// Every row starts at a cache line, so that no vector lies across two of them.
#[repr(C, align(64))]
pub(super) struct WorldFrameBlock {
    /// The nine state variables.
    state: [LaneArray; 9],
    /// The values of [`ContactFrameState`] of a ball that comes from the ring or has reached it.
    ring_motion: [LaneArray; CONTACT_VALUES],
    times_s: LaneArray,
    /// [`FrictionState::slip_tolerance`] of each solid.
    slip_tolerances: [LaneArray; SolidId::COUNT],
    rolling_times_s: LaneArray,
    /// [`ShotProgress::step_fraction`].
    step_fractions: LaneArray,
    slots: [u32; ZEROS.len()],
    /// [`ShotProgress::steps`].
    steps: [u32; ZEROS.len()],
    flags: LaneFlags,
}

/// The Boolean values of each lane. A local copy stays in registers.
#[derive(Clone, Copy, Default)]
struct LaneFlags {
    has_been_above: LaneBits,
    rose_through: LaneBits,
    rolling: [LaneBits; SolidId::COUNT],
    rolling_failed: [LaneBits; SolidId::COUNT],
    /// [`ShotProgress::touching`].
    touching: [LaneBits; SolidId::COUNT],
    /// The ball comes from the ring: `ring_motion` holds.
    from_ring: LaneBits,
    /// The lane has a shot.
    occupied: LaneBits,
}

/// The shots as SIMD numbers.
#[derive(Clone, Copy)]
pub(super) struct LaneShots<T: SimdReal> {
    pub(super) state: BallState<T>,
    pub(super) crossing: HoopCrossing<T>,
    pub(super) time_s: T,
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

/// Counts a step of every lane; returns the lanes that have reached `max_steps`.
#[inline(always)]
pub(super) fn count_step(steps: &mut [u32], max_steps: u32) -> LaneBits {
    let mut reached = 0;
    for (lane, steps) in steps.iter_mut().enumerate() {
        *steps = steps.wrapping_add(1);
        reached |= LaneBits::from(*steps >= max_steps) << lane;
    }
    reached
}

impl WorldFrameBlock {
    pub(super) fn new() -> Self {
        Self {
            state: [ZEROS; 9],
            ring_motion: [ZEROS; CONTACT_VALUES],
            times_s: ZEROS,
            slip_tolerances: [ZEROS; SolidId::COUNT],
            rolling_times_s: ZEROS,
            step_fractions: ZEROS,
            slots: [0; ZEROS.len()],
            steps: [0; ZEROS.len()],
            flags: LaneFlags::default(),
        }
    }

    /// The lanes that have a shot.
    #[inline(always)]
    pub(super) fn occupied(&self) -> LaneBits {
        self.flags.occupied
    }

    /// Puts shots into some lanes, as long as `next` gives any.
    #[inline(always)]
    pub(super) fn fill(
        &mut self,
        lanes: LaneBits,
        params: &ModelParams,
        slots: &mut [ShotProgress],
        mut next: impl FnMut() -> Option<u32>,
    ) {
        let mut flags = self.flags;
        for lane in lanes_in(lanes) {
            let Some(slot) = next() else {
                break;
            };
            let shot = &mut slots[slot as usize];
            let from_ring = shot.frame == Some(FramedPart::RingCircle);
            set_bit(&mut flags.from_ring, lane, from_ring);
            if from_ring {
                for (row, value) in self.ring_motion.iter_mut().zip(shot.motion.to_array()) {
                    row[lane] = value;
                }
            } else {
                shot.update_state(params);
            }
            self.insert(lane, slot, shot, &mut flags);
        }
        self.flags = flags;
    }

    /// Puts shots at their release into the lanes; those that are left repeat the last one.
    #[inline(always)]
    pub(super) fn fill_at_release(&mut self, starts: &[BallState]) {
        self.flags = LaneFlags::default();
        self.times_s = ZEROS;
        self.steps = [0; ZEROS.len()];
        let last = starts.len() - 1;
        for lane in 0..ZEROS.len() {
            let start = &starts[lane.min(last)];
            for (row, value) in self.state.iter_mut().zip(start.to_array()) {
                row[lane] = value;
            }
            let is_above = start.position_m.z >= 0.0;
            set_bit(&mut self.flags.has_been_above, lane, is_above);
        }
    }

    /// The time of the shot in a lane, s.
    #[inline(always)]
    pub(super) fn time_s(&self, lane: usize) -> f64 {
        self.times_s[lane]
    }

    /// The slots of the shots.
    #[inline(always)]
    pub(super) fn slots(&self) -> [u32; MAX_F64_LANES] {
        self.slots
    }

    /// The slot of the shot in a lane.
    #[inline(always)]
    pub(super) fn slot(&self, lane: usize) -> u32 {
        self.slots[lane]
    }

    #[inline(always)]
    fn insert(&mut self, lane: usize, slot: u32, shot: &ShotProgress, flags: &mut LaneFlags) {
        if shot.frame.is_none() {
            for (row, value) in self.state.iter_mut().zip(shot.state.to_array()) {
                row[lane] = value;
            }
        }
        self.times_s[lane] = shot.time_s;
        self.slots[lane] = slot;
        self.steps[lane] = shot.steps;
        set_bit(
            &mut flags.has_been_above,
            lane,
            shot.crossing.has_been_above,
        );
        set_bit(&mut flags.rose_through, lane, shot.crossing.rose_through);
        set_bit(&mut flags.occupied, lane, true);
    }

    /// Copies the contacts of the shots in some lanes from their slots.
    #[inline(always)]
    pub(super) fn load_contacts_of(&mut self, lanes: LaneBits, slots: &[ShotProgress]) {
        let mut flags = self.flags;
        for lane in lanes_in(lanes & flags.occupied) {
            let shot = &slots[self.slots[lane] as usize];
            for (i, friction) in shot.friction.iter().enumerate() {
                set_bit(&mut flags.rolling[i], lane, friction.rolling);
                set_bit(&mut flags.rolling_failed[i], lane, friction.rolling_failed);
                set_bit(&mut flags.touching[i], lane, shot.touching[i]);
                self.slip_tolerances[i][lane] = friction.slip_tolerance;
            }
            self.rolling_times_s[lane] = shot.rolling_time_s;
            self.step_fractions[lane] = shot.step_fraction;
        }
        self.flags = flags;
    }

    /// Counts a step of every lane; returns the lanes that have reached `max_steps`. (A lane
    /// without a shot may be among them.)
    #[inline(always)]
    pub(super) fn count_step(&mut self, max_steps: u32) -> LaneBits {
        count_step(&mut self.steps, max_steps)
    }

    /// Frees a lane. The memory of its shot is not updated.
    #[inline(always)]
    pub(super) fn vacate(&mut self, lane: usize) {
        set_bit(&mut self.flags.occupied, lane, false);
    }

    /// Writes state, time and counters of the shot in a lane to its memory, and frees the lane. The
    /// contacts in the memory are not updated.
    #[inline(always)]
    pub(super) fn remove(&mut self, lane: usize, shot: &mut ShotProgress) {
        let vector = |i: usize| {
            Vec3::new(
                self.state[i][lane],
                self.state[i + 1][lane],
                self.state[i + 2][lane],
            )
        };
        shot.state = BallState {
            position_m: vector(0),
            velocity_m_s: vector(3),
            spin_rad_s: vector(6),
        };
        shot.frame = None;
        self.remove_without_state(lane, shot);
    }

    /// The same for a ball that has reached the ring: with its motion in the frame of the contact.
    #[inline(always)]
    pub(super) fn remove_on_ring(&mut self, lane: usize, shot: &mut ShotProgress) {
        shot.motion = ContactFrameState::from_array(from_fn(
            #[inline(always)]
            |i| self.ring_motion[i][lane],
        ));
        self.remove_without_state(lane, shot);
    }

    #[inline(always)]
    fn remove_without_state(&mut self, lane: usize, shot: &mut ShotProgress) {
        shot.time_s = self.times_s[lane];
        shot.steps = self.steps[lane];
        shot.crossing = HoopCrossing {
            has_been_above: bit(self.flags.has_been_above, lane),
            rose_through: bit(self.flags.rose_through, lane),
        };
        set_bit(&mut self.flags.occupied, lane, false);
    }

    /// Friction of the shot in a lane at a solid.
    #[inline(always)]
    pub(super) fn friction(&self, solid: SolidId, lane: usize) -> FrictionState {
        FrictionState {
            rolling: bit(self.flags.rolling[solid.index()], lane),
            rolling_failed: bit(self.flags.rolling_failed[solid.index()], lane),
            slip_tolerance: self.slip_tolerances[solid.index()][lane],
        }
    }

    /// Writes the contacts of the shot in a lane to its memory.
    #[inline(always)]
    pub(super) fn remove_contacts(&self, lane: usize, shot: &mut ShotProgress) {
        shot.friction = SolidId::ALL.map(|solid| self.friction(solid, lane));
        shot.touching = self.flags.touching.map(|bits| bit(bits, lane));
        shot.rolling_time_s = self.rolling_times_s[lane];
        shot.step_fraction = self.step_fractions[lane];
    }

    /// The solids that the balls touch.
    #[inline(always)]
    pub(super) fn load_touching<T: SimdReal<Element = f64>>(
        &self,
        simd: T::Simd,
    ) -> [T::Mask; SolidId::COUNT] {
        let [board, ring] = self.flags.touching;
        [
            T::mask_from_bits(simd, board),
            T::mask_from_bits(simd, ring),
        ]
    }

    #[inline(always)]
    pub(super) fn load_step_fractions<T: SimdReal<Element = f64>>(&self, simd: T::Simd) -> T {
        T::load(simd, &self.step_fractions)
    }

    #[inline(always)]
    pub(super) fn store_step_fractions<T: SimdReal<Element = f64>>(&mut self, fractions: T) {
        fractions.store(&mut self.step_fractions);
    }

    /// The state of balls that come from the ring, from the frame of that contact.
    #[inline(always)]
    pub(super) fn leave_ring<T: SimdReal<Element = f64>>(
        &self,
        simd: T::Simd,
        params: &ModelParams<T>,
        state: &mut BallState<T>,
    ) {
        if self.flags.from_ring & self.flags.occupied != 0 {
            let motion = ContactFrameState::from_array(from_fn(
                #[inline(always)]
                |i| T::load(simd, &self.ring_motion[i]),
            ));
            let from_ring = T::mask_from_bits(simd, self.flags.from_ring);
            *state = params
                .ring
                .to_world(&params.ball, &motion)
                .select(from_ring, *state);
        }
    }

    /// Stores the motion of balls that have reached the ring.
    #[inline(always)]
    pub(super) fn store_ring_motion<T: SimdReal<Element = f64>>(
        &mut self,
        motion: &ContactFrameState<T>,
    ) {
        for (row, value) in self.ring_motion.iter_mut().zip(motion.to_array()) {
            value.store(row);
        }
    }

    #[inline(always)]
    pub(super) fn load<T: SimdReal<Element = f64>>(&self, simd: T::Simd) -> LaneShots<T> {
        let row = |i: usize| T::load(simd, &self.state[i]);
        let vector = |i: usize| Vec3::new(row(i), row(i + 1), row(i + 2));
        LaneShots {
            state: BallState {
                position_m: vector(0),
                velocity_m_s: vector(3),
                spin_rad_s: vector(6),
            },
            crossing: HoopCrossing {
                has_been_above: T::mask_from_bits(simd, self.flags.has_been_above),
                rose_through: T::mask_from_bits(simd, self.flags.rose_through),
            },
            time_s: T::load(simd, &self.times_s),
        }
    }

    #[inline(always)]
    pub(super) fn store<T: SimdReal<Element = f64>>(&mut self, shots: &LaneShots<T>) {
        let BallState {
            position_m: p,
            velocity_m_s: v,
            spin_rad_s: w,
        } = shots.state;
        let values = [p.x, p.y, p.z, v.x, v.y, v.z, w.x, w.y, w.z];
        for (row, value) in self.state.iter_mut().zip(values) {
            value.store(row);
        }
        self.flags.has_been_above = T::mask_to_bits(shots.crossing.has_been_above);
        self.flags.rose_through = T::mask_to_bits(shots.crossing.rose_through);
        shots.time_s.store(&mut self.times_s);
    }

    /// Stores shots in flight; none of them comes from the ring any more.
    #[inline(always)]
    pub(super) fn store_without_frames<T: SimdReal<Element = f64>>(
        &mut self,
        shots: &LaneShots<T>,
    ) {
        self.store(shots);
        self.flags.from_ring = 0;
    }

    #[inline(always)]
    pub(super) fn load_friction<T: SimdReal<Element = f64>>(
        &self,
        simd: T::Simd,
        solid: SolidId,
    ) -> FrictionState<T> {
        FrictionState {
            rolling: T::mask_from_bits(simd, self.flags.rolling[solid.index()]),
            rolling_failed: T::mask_from_bits(simd, self.flags.rolling_failed[solid.index()]),
            slip_tolerance: T::load(simd, &self.slip_tolerances[solid.index()]),
        }
    }

    #[inline(always)]
    pub(super) fn store_friction<T: SimdReal<Element = f64>>(
        &mut self,
        solid: SolidId,
        friction: &FrictionState<T>,
    ) {
        self.flags.rolling[solid.index()] = T::mask_to_bits(friction.rolling);
        self.flags.rolling_failed[solid.index()] = T::mask_to_bits(friction.rolling_failed);
        friction
            .slip_tolerance
            .store(&mut self.slip_tolerances[solid.index()]);
    }

    #[inline(always)]
    pub(super) fn load_rolling_times<T: SimdReal<Element = f64>>(&self, simd: T::Simd) -> T {
        T::load(simd, &self.rolling_times_s)
    }

    #[inline(always)]
    pub(super) fn store_rolling_times<T: SimdReal<Element = f64>>(&mut self, rolling_times_s: T) {
        rolling_times_s.store(&mut self.rolling_times_s);
    }
}

impl<T: SimdReal<Element = f64>> LaneShots<T> {
    /// Updates time and hoop crossing after a step of `dt` from `before`, in the lanes of
    /// `stepped`; returns the shots that end.
    #[inline(always)]
    pub(super) fn after_step(
        &mut self,
        params: &ModelParams<T>,
        before: &BallState<T>,
        (dt, stepped): (T, T::Mask),
        time_limit_s: f64,
    ) -> ShotEndFlags<T> {
        self.time_s = self.time_s + dt.select(stepped, params.zero());
        let was_below = before.position_m.z.is_negative();
        self.crossing
            .after_step(params, was_below, &self.state, stepped);
        let too_late = params.splat(time_limit_s).lt(self.time_s);
        ShotEndFlags::new(params, &self.state, too_late)
    }
}
