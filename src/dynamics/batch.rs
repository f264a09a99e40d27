//! Many shots at once, eight to a step, in vector lanes.
//!
//! The shots of a batch wait in three queues, by what comes next: flight, board, ring. Flights are
//! closed-form and are done eight at a time. In contact eight shots step together; a lane whose ball
//! parts is refilled from the queue at once, so short and long contacts mix without waiting. What is
//! rare (both surfaces at once, the board's edges, the time limit) leaves its lane for the scalar form
//! and comes back to a queue when it is over.
//!
//! The equations are those of the scalar form, so the verdicts are the same, bit for bit.

use super::contact::{self, Grip, REACHED_M};
use super::exact::{self, MOST_STRETCHES, On, Progress, Rules, ring_gap};
use super::flight::{self, Arc};
use super::outcome::{Contacts, Ending, Touched, Verdict};
use super::passage::Passage;
use super::state::{Law, State, Triple};
use super::surface::{Board, Ring, Surface};
use crate::lane::{Lane, Pack, PackMask, WIDTH};
use fearless_simd::Simd;

/// Nine state variables of eight shots.
type Block = [[f64; WIDTH]; 9];

/// Room for a batch, to be used again and again: nothing is allocated once it has grown.
#[derive(Debug, Default)]
pub struct Room {
    shots: Vec<Progress>,
    pub(super) verdicts: Vec<Verdict>,
    flying: Vec<u32>,
    on_board: Vec<u32>,
    on_ring: Vec<u32>,
    queue: Vec<u32>,
}

/// Runs the shots of `starts` to their ends; the verdicts are then in the room.
#[inline(always)]
pub(super) fn run<S: Simd>(simd: S, law: &Law, rules: &Rules, starts: &[State], room: &mut Room) {
    room.shots.clear();
    room.shots
        .extend(starts.iter().map(|start| Progress::at_release(law, *start)));
    room.verdicts.clear();
    room.verdicts.resize(starts.len(), PENDING);
    let lanes = law.map(|value| Pack::splat(simd, value));
    let mut batch = Batch {
        simd,
        law,
        lanes,
        rules,
        room,
    };
    for (shot, start) in starts.iter().enumerate() {
        if exact::pressed_at_start(law, start) == (false, false) {
            batch.room.flying.push(shot as u32);
        } else {
            batch.room.verdicts[shot] = exact::run(law, rules, *start, &mut ());
        }
    }
    while !batch.room.is_done() {
        batch.fly();
        batch.press_board();
        batch.press_ring();
    }
}

impl Room {
    fn is_done(&self) -> bool {
        self.flying.is_empty() && self.on_board.is_empty() && self.on_ring.is_empty()
    }

    /// The shots that wait for a surface.
    fn waiting(&mut self, touched: Touched) -> &mut Vec<u32> {
        match touched {
            Touched::Board => &mut self.on_board,
            Touched::Ring => &mut self.on_ring,
        }
    }

    /// Is there enough to do elsewhere to leave lanes on `touched` that cannot all be filled?
    fn others_fill_lanes(&mut self, touched: Touched) -> bool {
        let other = match touched {
            Touched::Board => Touched::Ring,
            Touched::Ring => Touched::Board,
        };
        self.flying.len() >= WIDTH || self.waiting(other).len() >= WIDTH
    }
}

struct Batch<'a, S: Simd> {
    simd: S,
    law: &'a Law,
    lanes: Law<Pack<S>>,
    rules: &'a Rules,
    room: &'a mut Room,
}

/// The bits of up to eight lanes that are set, in order.
fn lanes_of(mut bits: u8) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (bits != 0).then(|| {
            let lane = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            lane
        })
    })
}

fn set(block: &mut Block, lane: usize, state: &State) {
    let (p, v, w) = (state.position_m, state.velocity_m_s, state.spin_rad_s);
    let values = [p.0, p.1, p.2, v.0, v.1, v.2, w.0, w.1, w.2];
    for (row, value) in block.iter_mut().zip(values) {
        row[lane] = value;
    }
}

fn get(block: &Block, lane: usize) -> State {
    let triple = |i: usize| Triple(block[i][lane], block[i + 1][lane], block[i + 2][lane]);
    State {
        position_m: triple(0),
        velocity_m_s: triple(3),
        spin_rad_s: triple(6),
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, block: &Block) -> State<Pack<S>> {
    let pack = |i: usize| Pack::load(simd, &block[i]);
    let triple = |i: usize| Triple(pack(i), pack(i + 1), pack(i + 2));
    State {
        position_m: triple(0),
        velocity_m_s: triple(3),
        spin_rad_s: triple(6),
    }
}

#[inline(always)]
fn store<S: Simd>(state: &State<Pack<S>>, block: &mut Block) {
    let (p, v, w) = (state.position_m, state.velocity_m_s, state.spin_rad_s);
    for (row, value) in block
        .iter_mut()
        .zip([p.0, p.1, p.2, v.0, v.1, v.2, w.0, w.1, w.2])
    {
        value.store(row);
    }
}

/// Sets one lane's bit.
fn put(bits: &mut u8, lane: usize, value: bool) {
    *bits = *bits & !(1 << lane) | u8::from(value) << lane;
}

impl<S: Simd> Batch<'_, S> {
    /// Takes a shot through what the lanes do not do, in the scalar form, and queues it again.
    #[cold]
    fn hand_over(&mut self, shot: u32) {
        let progress = &mut self.room.shots[shot as usize];
        loop {
            if progress.stretches >= MOST_STRETCHES {
                self.finish(shot, Ending::Unresolved, false);
                return;
            }
            progress.stretches += 1;
            if let Some(verdict) = exact::stretch(self.law, self.rules, progress) {
                self.room.verdicts[shot as usize] = verdict;
                return;
            }
            match progress.on {
                On::Nothing => self.room.flying.push(shot),
                On::Board(_) => self.room.on_board.push(shot),
                On::Ring(_) => self.room.on_ring.push(shot),
                On::Both(_) => continue,
            }
            return;
        }
    }

    fn finish(&mut self, shot: u32, ending: Ending, made: bool) {
        let progress = &self.room.shots[shot as usize];
        self.room.verdicts[shot as usize] = Verdict {
            made,
            ending,
            contacts: progress.contacts,
            time_s: progress.time_s,
        };
    }

    /// A queue to work off, with an empty one in its place; to be given back to `room.queue`.
    fn take_queue(&mut self, of: impl Fn(&mut Room) -> &mut Vec<u32>) -> Vec<u32> {
        let spare = std::mem::take(&mut self.room.queue);
        std::mem::replace(of(self.room), spare)
    }

    fn give_back(&mut self, mut queue: Vec<u32>) {
        queue.clear();
        self.room.queue = queue;
    }

    /// Flies every shot of the queue to its end or its next touch.
    #[inline(always)]
    fn fly(&mut self) {
        let queue = self.take_queue(|room| &mut room.flying);
        let fresh = Grip::fresh(self.law);
        let mut block: Block = [[0.0; WIDTH]; 9];
        for shots in queue.chunks(WIDTH) {
            let (mut above, mut rose) = (0, 0);
            for lane in 0..WIDTH {
                // Lanes without a shot repeat the last one.
                let progress = &self.room.shots[shots[lane.min(shots.len() - 1)] as usize];
                set(&mut block, lane, &progress.state);
                put(&mut above, lane, progress.passage.above);
                put(&mut rose, lane, progress.passage.rose_through);
            }
            let law = &self.lanes;
            let start = load(self.simd, &block);
            let mut passage = Passage {
                above: PackMask::from_bits(self.simd, above),
                rose_through: PackMask::from_bits(self.simd, rose),
            };
            let arc = Arc::from(law, &start);
            let dt = arc.end.least(arc.board).least(arc.ring);
            passage.flight(law, &start, dt);
            let end = start.flown(law, dt);
            let made = passage.made(law, &end).to_bits();
            let special = (arc.beside_board.lt(dt) | arc.unresolved).to_bits();
            let ring = arc.ring.le(dt).to_bits();
            let board = arc.board.le(dt).to_bits();
            let rose_to = law.zero.lit(-1.0) * law.radius - REACHED_M;
            let fell = rose_to.lt(end.position_m.2).to_bits();
            let (above, rose) = (passage.above.to_bits(), passage.rose_through.to_bits());
            let mut durations = [0.0; WIDTH];
            dt.store(&mut durations);
            store(&end, &mut block);
            for (lane, &shot) in shots.iter().enumerate() {
                let bit = |bits: u8| bits >> lane & 1 == 1;
                let progress = &mut self.room.shots[shot as usize];
                let late = progress.time_s + durations[lane] > self.rules.time_limit_s;
                progress.on = On::Nothing;
                if bit(special) || late || progress.stretches >= MOST_STRETCHES {
                    self.hand_over(shot);
                    continue;
                }
                progress.stretches += 1;
                progress.state = get(&block, lane);
                progress.time_s += durations[lane];
                progress.passage = Passage {
                    above: bit(above),
                    rose_through: bit(rose),
                };
                if bit(ring) {
                    progress.contacts.push(Touched::Ring);
                    progress.on = On::Ring(fresh);
                    self.room.on_ring.push(shot);
                } else if bit(board) {
                    progress.contacts.push(Touched::Board);
                    progress.on = On::Board(fresh);
                    self.room.on_board.push(shot);
                } else if bit(fell) {
                    self.finish(shot, Ending::Fell, bit(made));
                } else {
                    self.finish(shot, Ending::NeverRose, false);
                }
            }
        }
        self.give_back(queue);
    }

    #[inline(always)]
    fn press_board(&mut self) {
        let law = self.lanes;
        self.press(Board, Touched::Board, |state| {
            let gap = ring_gap(&law, state);
            let leaves = !flight::on_board(&law, state) | gap.reached(&law);
            let time = move |_: &State<Pack<S>>, acceleration| gap.time(&law, acceleration);
            (leaves, time)
        });
    }

    #[inline(always)]
    fn press_ring(&mut self) {
        let law = self.lanes;
        self.press(Ring, Touched::Ring, |state| {
            let time =
                move |state: &State<Pack<S>>, push| exact::time_to_board(&law, state, push);
            (exact::board_reached(&law, state), time)
        });
    }

    /// Steps the shots that wait for one surface until they part, or until there are too few to fill
    /// the lanes and others to run first. `other` tells that the contact is no longer one with this
    /// surface alone, and gives the time until then.
    #[inline(always)]
    fn press<T, F>(
        &mut self,
        surface: T,
        touched: Touched,
        other: impl Fn(&State<Pack<S>>) -> (PackMask<S>, F),
    ) where
        T: Surface<Pack<S>>,
        F: FnOnce(&State<Pack<S>>, Triple<Pack<S>>) -> Pack<S>,
    {
        let law = self.lanes;
        let simd = self.simd;
        let longest = law.zero.lit(self.rules.longest_step_s);
        let fresh = Grip::fresh(self.law);
        let mut block: Block = [[0.0; WIDTH]; 9];
        let mut no_slip = [fresh.no_slip; WIDTH];
        let mut times = [0.0; WIDTH];
        let mut shots = [0_u32; WIDTH];
        let (mut rolling, mut spent, mut above, mut rose, mut active) = (0_u8, 0, 0, 0, 0_u8);
        loop {
            for lane in lanes_of(!active) {
                let Some(shot) = self.room.waiting(touched).pop() else {
                    break;
                };
                let progress = &self.room.shots[shot as usize];
                let grip = match progress.on {
                    On::Board(grip) | On::Ring(grip) => grip,
                    On::Nothing | On::Both(_) => fresh,
                };
                set(&mut block, lane, &progress.state);
                times[lane] = progress.time_s;
                put(&mut above, lane, progress.passage.above);
                put(&mut rose, lane, progress.passage.rose_through);
                put(&mut rolling, lane, grip.rolling);
                put(&mut spent, lane, grip.spent);
                put(&mut active, lane, true);
                no_slip[lane] = grip.no_slip;
                shots[lane] = shot;
            }
            if active == 0 {
                return;
            }
            let before = load(simd, &block);
            let (leaves, time_to_other) = other(&before);
            let suspended = active != u8::MAX && self.room.others_fill_lanes(touched);
            let leaves = leaves.to_bits() & active;
            let out = if suspended { active } else { leaves };
            for lane in lanes_of(out) {
                let bit = |bits: u8| bits >> lane & 1 == 1;
                let shot = shots[lane];
                let grip = Grip {
                    rolling: bit(rolling),
                    spent: bit(spent),
                    no_slip: no_slip[lane],
                };
                let progress = &mut self.room.shots[shot as usize];
                progress.state = get(&block, lane);
                progress.time_s = times[lane];
                progress.passage = Passage {
                    above: bit(above),
                    rose_through: bit(rose),
                };
                progress.on = match touched {
                    Touched::Board => On::Board(grip),
                    Touched::Ring => On::Ring(grip),
                };
                put(&mut active, lane, false);
                if bit(leaves) {
                    self.hand_over(shot);
                } else {
                    self.room.waiting(touched).push(shot);
                }
            }
            if suspended {
                return;
            }
            let mut state = before;
            let mut grip = Grip {
                rolling: PackMask::from_bits(simd, rolling),
                spent: PackMask::from_bits(simd, spent),
                no_slip: Pack::load(simd, &no_slip),
            };
            let mut passage = Passage {
                above: PackMask::from_bits(simd, above),
                rose_through: PackMask::from_bits(simd, rose),
            };
            let step = contact::step(
                &law,
                surface,
                &mut state,
                &mut grip,
                longest,
                time_to_other,
            );
            let time = Pack::load(simd, &times) + step.dt;
            passage.step(&law, &before, &state);
            let behind = state.position_m.0.lt(law.board_face_x);
            let fell = state.position_m.2.lt(-law.radius) & state.velocity_m_s.2.lt(law.zero);
            let late = law.zero.lit(self.rules.time_limit_s).lt(time);
            let parted = step.parted.to_bits();
            store(&state, &mut block);
            time.store(&mut times);
            grip.no_slip.store(&mut no_slip);
            (rolling, spent) = (grip.rolling.to_bits(), grip.spent.to_bits());
            (above, rose) = (passage.above.to_bits(), passage.rose_through.to_bits());
            let ends = (behind | fell | late).to_bits();
            let done = (parted | ends) & active;
            if done == 0 {
                continue;
            }
            let made = passage.made(&law, &state).to_bits();
            let [behind, fell] = [behind, fell].map(PackMask::to_bits);
            for lane in lanes_of(done) {
                let bit = |bits: u8| bits >> lane & 1 == 1;
                let shot = shots[lane];
                let progress = &mut self.room.shots[shot as usize];
                progress.state = get(&block, lane);
                progress.time_s = times[lane];
                progress.passage = Passage {
                    above: bit(above),
                    rose_through: bit(rose),
                };
                put(&mut active, lane, false);
                if bit(parted) {
                    self.room.flying.push(shot);
                } else if bit(behind) {
                    self.finish(shot, Ending::BehindBoard, false);
                } else if bit(fell) {
                    self.finish(shot, Ending::Fell, bit(made));
                } else {
                    self.finish(shot, Ending::TimeLimit, false);
                }
            }
        }
    }
}

/// A verdict to be overwritten.
const PENDING: Verdict = Verdict {
    made: false,
    ending: Ending::Unresolved,
    contacts: Contacts::NONE,
    time_s: 0.0,
};
