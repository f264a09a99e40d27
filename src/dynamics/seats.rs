//! Eight shots side by side: taken into the lanes one by one, stepped together, and taken out.

use super::contact::Grip;
use super::exact::{On, Progress};
use super::passage::Passage;
use super::state::{Law, State, Triple};
use super::wedge::{BOARD, RING};
use crate::lane::{Lane, Pack, PackMask, WIDTH};
use fearless_simd::Simd;

/// What is kept of eight shots between two steps. Lanes that nobody sits in hold what was left there,
/// and are stepped on without harm.
pub(super) struct Seats {
    /// The nine state variables.
    block: [[f64; WIDTH]; 9],
    times: [f64; WIDTH],
    above: u8,
    rose_through: u8,
    /// On the one surface, or on board and ring.
    grips: [GripSeats; 2],
    wedged_s: [f64; WIDTH],
    shots: [u32; WIDTH],
    /// The lanes that are taken.
    pub(super) taken: u8,
}

#[derive(Clone, Copy)]
struct GripSeats {
    rolling: u8,
    spent: u8,
    no_slip: [f64; WIDTH],
}

/// Eight shots as packs.
#[derive(Clone, Copy)]
pub(super) struct Seated<S: Simd> {
    pub(super) state: State<Pack<S>>,
    pub(super) passage: Passage<Pack<S>>,
    pub(super) time_s: Pack<S>,
}

/// The lanes whose bits are set, in order.
pub(super) fn lanes_of(mut bits: u8) -> impl Iterator<Item = usize> {
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
pub(super) fn bit(bits: u8, lane: usize) -> bool {
    bits >> lane & 1 == 1
}

/// Sets one lane's bit.
#[inline(always)]
fn put(bits: &mut u8, lane: usize, value: bool) {
    *bits = *bits & !(1 << lane) | u8::from(value) << lane;
}

impl Seats {
    pub(super) fn new() -> Self {
        let grip = GripSeats {
            rolling: 0,
            spent: 0,
            no_slip: [0.0; WIDTH],
        };
        Self {
            block: [[0.0; WIDTH]; 9],
            times: [0.0; WIDTH],
            above: 0,
            rose_through: 0,
            grips: [grip; 2],
            wedged_s: [0.0; WIDTH],
            shots: [0; WIDTH],
            taken: 0,
        }
    }

    /// The shot in a lane.
    #[inline(always)]
    pub(super) fn shot(&self, lane: usize) -> u32 {
        self.shots[lane]
    }

    /// Takes a shot in, with its grips.
    #[inline(always)]
    pub(super) fn take(&mut self, lane: usize, shot: u32, progress: &Progress) {
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
        put(&mut self.above, lane, progress.passage.above);
        put(&mut self.rose_through, lane, progress.passage.rose_through);
        match &progress.on {
            On::Nothing => {}
            On::Board(grip) | On::Ring(grip) => self.grips[0].set(lane, grip),
            On::Both { grips, wedged_s } => {
                self.grips[BOARD].set(lane, &grips[BOARD]);
                self.grips[RING].set(lane, &grips[RING]);
                self.wedged_s[lane] = *wedged_s;
            }
        }
        self.shots[lane] = shot;
        put(&mut self.taken, lane, true);
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
            above: bit(self.above, lane),
            rose_through: bit(self.rose_through, lane),
        };
        put(&mut self.taken, lane, false);
    }

    /// The first grip of a lane, or both.
    #[inline(always)]
    pub(super) fn grip(&self, which: usize, lane: usize) -> Grip {
        let grip = &self.grips[which];
        Grip {
            rolling: bit(grip.rolling, lane),
            spent: bit(grip.spent, lane),
            no_slip: grip.no_slip[lane],
        }
    }

    pub(super) fn wedged_s(&self, lane: usize) -> f64 {
        self.wedged_s[lane]
    }

    #[inline(always)]
    pub(super) fn load<S: Simd>(&self, simd: S) -> Seated<S> {
        let pack = |i: usize| Pack::load(simd, &self.block[i]);
        let triple = |i: usize| Triple(pack(i), pack(i + 1), pack(i + 2));
        Seated {
            state: State {
                position_m: triple(0),
                velocity_m_s: triple(3),
                spin_rad_s: triple(6),
            },
            passage: Passage {
                above: PackMask::from_bits(simd, self.above),
                rose_through: PackMask::from_bits(simd, self.rose_through),
            },
            time_s: Pack::load(simd, &self.times),
        }
    }

    #[inline(always)]
    pub(super) fn store<S: Simd>(&mut self, seated: &Seated<S>) {
        let State {
            position_m: p,
            velocity_m_s: v,
            spin_rad_s: w,
        } = seated.state;
        let packs = [p.0, p.1, p.2, v.0, v.1, v.2, w.0, w.1, w.2];
        for (row, pack) in self.block.iter_mut().zip(packs) {
            pack.store(row);
        }
        self.above = seated.passage.above.to_bits();
        self.rose_through = seated.passage.rose_through.to_bits();
        seated.time_s.store(&mut self.times);
    }

    #[inline(always)]
    pub(super) fn load_grip<S: Simd>(&self, simd: S, which: usize) -> Grip<Pack<S>> {
        let grip = &self.grips[which];
        Grip {
            rolling: PackMask::from_bits(simd, grip.rolling),
            spent: PackMask::from_bits(simd, grip.spent),
            no_slip: Pack::load(simd, &grip.no_slip),
        }
    }

    #[inline(always)]
    pub(super) fn store_grip<S: Simd>(&mut self, which: usize, grip: &Grip<Pack<S>>) {
        let seats = &mut self.grips[which];
        seats.rolling = grip.rolling.to_bits();
        seats.spent = grip.spent.to_bits();
        grip.no_slip.store(&mut seats.no_slip);
    }

    #[inline(always)]
    pub(super) fn load_wedged<S: Simd>(&self, simd: S) -> Pack<S> {
        Pack::load(simd, &self.wedged_s)
    }

    #[inline(always)]
    pub(super) fn store_wedged<S: Simd>(&mut self, wedged_s: Pack<S>) {
        wedged_s.store(&mut self.wedged_s);
    }
}

impl GripSeats {
    #[inline(always)]
    fn set(&mut self, lane: usize, grip: &Grip) {
        put(&mut self.rolling, lane, grip.rolling);
        put(&mut self.spent, lane, grip.spent);
        self.no_slip[lane] = grip.no_slip;
    }
}

/// How a step in contact ended the shot, lane by lane.
pub(super) struct Ends<S: Simd> {
    pub(super) behind: PackMask<S>,
    pub(super) fell: PackMask<S>,
    pub(super) late: PackMask<S>,
}

impl<S: Simd> Seated<S> {
    /// Brings time and passage up to a step of `dt` from `before`, and tells what ends with it.
    #[inline(always)]
    pub(super) fn after_step(
        &mut self,
        law: &Law<Pack<S>>,
        before: &State<Pack<S>>,
        dt: Pack<S>,
        time_limit_s: f64,
    ) -> Ends<S> {
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
