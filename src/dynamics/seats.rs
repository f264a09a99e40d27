//! Eight or sixteen shots side by side: taken into the lanes one by one, stepped together, and taken out.

use super::contact::Grip;
use super::exact::{On, Progress};
use super::passage::Passage;
use super::state::{Law, State, Triple};
use super::wedge::{BOARD, RING};
use crate::lane::{Bits, Numbers, Packed};

const EMPTY: Numbers = [0.0; Bits::BITS as usize];

/// What is kept of the shots of a pack between two steps. Lanes that nobody sits in hold what was left there,
/// and are stepped on without harm.
pub(super) struct Seats {
    /// The nine state variables.
    block: [Numbers; 9],
    times: Numbers,
    /// Slips that count as none, on the one surface, or on board and ring.
    no_slips: [Numbers; 2],
    wedged_s: Numbers,
    slots: [u32; EMPTY.len()],
    flags: Flags,
}

/// What is true or false of each lane. Worked on as a copy, it stays in registers.
#[derive(Clone, Copy, Default)]
struct Flags {
    above: Bits,
    rose_through: Bits,
    rolling: [Bits; 2],
    spent: [Bits; 2],
    /// The lane is taken.
    taken: Bits,
}

/// The shots as packs.
#[derive(Clone, Copy)]
pub(super) struct Seated<P: Packed> {
    pub(super) state: State<P>,
    pub(super) passage: Passage<P>,
    pub(super) time_s: P,
}

/// The lanes whose bits are set, in order.
pub(super) fn lanes_of(mut bits: Bits) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (bits != 0).then(|| {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            lane
        })
    })
}

/// One lane's bit.
#[inline(always)]
pub(super) fn bit(bits: Bits, lane: usize) -> bool {
    bits >> lane & 1 == 1
}

/// Sets one lane's bit.
#[inline(always)]
fn put(bits: &mut Bits, lane: usize, value: bool) {
    *bits = *bits & !(1 << lane) | Bits::from(value) << lane;
}

impl Seats {
    pub(super) fn new() -> Self {
        Self {
            block: [EMPTY; 9],
            times: EMPTY,
            no_slips: [EMPTY; 2],
            wedged_s: EMPTY,
            slots: [0; EMPTY.len()],
            flags: Flags::default(),
        }
    }

    /// The lanes that are taken.
    #[inline(always)]
    pub(super) fn taken(&self) -> Bits {
        self.flags.taken
    }

    /// Takes shots into some lanes, as long as `next` gives any.
    #[inline(always)]
    pub(super) fn fill(
        &mut self,
        lanes: Bits,
        slots: &[Progress],
        mut next: impl FnMut() -> Option<u32>,
    ) {
        let mut flags = self.flags;
        for lane in lanes_of(lanes) {
            let Some(slot) = next() else {
                break;
            };
            self.take(lane, slot, &slots[slot as usize], &mut flags);
        }
        self.flags = flags;
    }

    /// The shot in a lane.
    #[inline(always)]
    pub(super) fn slot(&self, lane: usize) -> u32 {
        self.slots[lane]
    }

    #[inline(always)]
    fn take(&mut self, lane: usize, slot: u32, progress: &Progress, flags: &mut Flags) {
        let State {
            position_m: p,
            velocity_m_s: v,
            spin_rad_s: w,
        } = progress.state;
        let values = [p.0, p.1, p.2, v.0, v.1, v.2, w.0, w.1, w.2];
        for (row, value) in self.block.iter_mut().zip(values) {
            row[lane] = value;
        }
        self.times[lane] = progress.time_s;
        self.slots[lane] = slot;
        put(&mut flags.above, lane, progress.passage.above);
        put(&mut flags.rose_through, lane, progress.passage.rose_through);
        put(&mut flags.taken, lane, true);
    }

    /// Takes the grips of the shots in some lanes in.
    #[inline(always)]
    pub(super) fn take_grips(&mut self, lanes: Bits, slots: &[Progress]) {
        let mut flags = self.flags;
        for lane in lanes_of(lanes & flags.taken) {
            let mut set = |which: usize, grip: &Grip| {
                put(&mut flags.rolling[which], lane, grip.rolling);
                put(&mut flags.spent[which], lane, grip.spent);
                self.no_slips[which][lane] = grip.no_slip;
            };
            match &slots[self.slots[lane] as usize].on {
                On::Nothing => {}
                On::Board(grip) | On::Ring(grip) => set(0, grip),
                On::Both { grips, wedged_s } => {
                    set(BOARD, &grips[BOARD]);
                    set(RING, &grips[RING]);
                    self.wedged_s[lane] = *wedged_s;
                }
            }
        }
        self.flags = flags;
    }

    /// Takes the shot of a lane out; what it is on is left to say.
    #[inline(always)]
    pub(super) fn leave(&mut self, lane: usize, progress: &mut Progress) {
        let triple = |i: usize| {
            Triple(
                self.block[i][lane],
                self.block[i + 1][lane],
                self.block[i + 2][lane],
            )
        };
        progress.state = State {
            position_m: triple(0),
            velocity_m_s: triple(3),
            spin_rad_s: triple(6),
        };
        progress.time_s = self.times[lane];
        progress.passage = Passage {
            above: bit(self.flags.above, lane),
            rose_through: bit(self.flags.rose_through, lane),
        };
        put(&mut self.flags.taken, lane, false);
    }

    /// The first grip of a lane, or both.
    #[inline(always)]
    pub(super) fn grip(&self, which: usize, lane: usize) -> Grip {
        Grip {
            rolling: bit(self.flags.rolling[which], lane),
            spent: bit(self.flags.spent[which], lane),
            no_slip: self.no_slips[which][lane],
        }
    }

    pub(super) fn wedged_s(&self, lane: usize) -> f64 {
        self.wedged_s[lane]
    }

    #[inline(always)]
    pub(super) fn load<P: Packed>(&self, simd: P::Simd) -> Seated<P> {
        let pack = |i: usize| P::load(simd, &self.block[i]);
        let triple = |i: usize| Triple(pack(i), pack(i + 1), pack(i + 2));
        Seated {
            state: State {
                position_m: triple(0),
                velocity_m_s: triple(3),
                spin_rad_s: triple(6),
            },
            passage: Passage {
                above: P::mask_of(simd, self.flags.above),
                rose_through: P::mask_of(simd, self.flags.rose_through),
            },
            time_s: P::load(simd, &self.times),
        }
    }

    #[inline(always)]
    pub(super) fn store<P: Packed>(&mut self, seated: &Seated<P>) {
        let State {
            position_m: p,
            velocity_m_s: v,
            spin_rad_s: w,
        } = seated.state;
        let packs = [p.0, p.1, p.2, v.0, v.1, v.2, w.0, w.1, w.2];
        for (row, pack) in self.block.iter_mut().zip(packs) {
            pack.store(row);
        }
        self.flags.above = P::bits(seated.passage.above);
        self.flags.rose_through = P::bits(seated.passage.rose_through);
        seated.time_s.store(&mut self.times);
    }

    #[inline(always)]
    pub(super) fn load_grip<P: Packed>(&self, simd: P::Simd, which: usize) -> Grip<P> {
        Grip {
            rolling: P::mask_of(simd, self.flags.rolling[which]),
            spent: P::mask_of(simd, self.flags.spent[which]),
            no_slip: P::load(simd, &self.no_slips[which]),
        }
    }

    #[inline(always)]
    pub(super) fn store_grip<P: Packed>(&mut self, which: usize, grip: &Grip<P>) {
        self.flags.rolling[which] = P::bits(grip.rolling);
        self.flags.spent[which] = P::bits(grip.spent);
        grip.no_slip.store(&mut self.no_slips[which]);
    }

    #[inline(always)]
    pub(super) fn load_wedged<P: Packed>(&self, simd: P::Simd) -> P {
        P::load(simd, &self.wedged_s)
    }

    #[inline(always)]
    pub(super) fn store_wedged<P: Packed>(&mut self, wedged_s: P) {
        wedged_s.store(&mut self.wedged_s);
    }
}

/// How a step in contact ended the shot, lane by lane.
pub(super) struct Ends<P: Packed> {
    pub(super) behind: P::Mask,
    pub(super) fell: P::Mask,
    pub(super) late: P::Mask,
}

impl<P: Packed> Seated<P> {
    /// Brings time and passage up to a step of `dt` from `before`, and tells what ends with it.
    #[inline(always)]
    pub(super) fn after_step(
        &mut self,
        law: &Law<P>,
        before: &State<P>,
        dt: P,
        time_limit_s: f64,
    ) -> Ends<P> {
        let state = &self.state;
        self.time_s = self.time_s + dt;
        self.passage.step(law, before, state, law.zero.lt(dt));
        Ends {
            behind: state.position_m.0.lt(law.board_face_x),
            fell: state.position_m.2.lt(-law.radius) & state.velocity_m_s.2.lt(law.zero),
            late: law.zero.lit(time_limit_s).lt(self.time_s),
        }
    }
}
