//! Many shots at once, eight or sixteen to a step, in vector lanes.
//!
//! The shots of a batch wait in four queues, by what comes next: flight, board, ring, both. Flights are
//! closed-form and are done a pack at a time. In contact the shots of a pack step together; a lane whose ball
//! parts is refilled from the queue at once, so short and long contacts mix without waiting. What is
//! rare (the board's edges, the time limit) leaves its lane for the scalar form and comes back to a
//! queue when it is over.
//!
//! The equations are those of the scalar form, so the verdicts are the same, bit for bit.

use super::contact::REACHED_M;
use super::contact::{self, Due, Grip};
use super::exact::{self, MOST_STRETCHES, On, Progress, Rules, ring_gap};
use super::flight::{self, Arc};
use super::outcome::{Contacts, Ending, Touched, Verdict};
use super::seats::{Seats, bit, lanes_of};
use super::state::{Law, State, Triple};
use super::surface::{Board, Ring, Surface};
use super::wedge;
use crate::lane::{Pack, Packed, Twin};
use fearless_simd::Simd;

/// Room for a batch, to be used again and again: nothing is allocated once it has grown.
#[derive(Debug, Default)]
pub struct Room {
    shots: Vec<Progress>,
    pub(super) verdicts: Vec<Verdict>,
    flying: Vec<u32>,
    on_board: Vec<u32>,
    on_ring: Vec<u32>,
    on_both: Vec<u32>,
    queue: Vec<u32>,
}

/// Runs the shots of `starts` to their ends; the verdicts are then in the room. Sixteen at a time where
/// one register holds eight, so that two chains of operations run side by side; else eight, which
/// then are such chains already.
#[inline(always)]
pub(super) fn run_as_wide_as_pays<S: Simd>(
    simd: S,
    law: &Law,
    rules: &Rules,
    starts: &[State],
    room: &mut Room,
) {
    if size_of::<S::f64s>() == size_of::<[f64; 8]>() {
        run::<Twin<Pack<S>>>(simd, law, rules, starts, room);
    } else {
        run::<Pack<S>>(simd, law, rules, starts, room);
    }
}

#[inline(always)]
fn run<P: Packed>(simd: P::Simd, law: &Law, rules: &Rules, starts: &[State], room: &mut Room) {
    room.shots.clear();
    room.shots
        .extend(starts.iter().map(|start| Progress::at_release(law, *start)));
    room.verdicts.clear();
    room.verdicts.resize(starts.len(), PENDING);
    let lanes = law.map(|value| P::splat(simd, value));
    let mut batch: Batch<P> = Batch {
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
        batch.phase(Phase::Flight);
        batch.phase(Phase::Board);
        batch.phase(Phase::Ring);
        batch.phase(Phase::Both);
    }
}

/// What the shots of a queue wait for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Phase {
    Flight,
    Board,
    Ring,
    Both,
}

impl Room {
    fn queues(&self) -> [(Phase, &Vec<u32>); 4] {
        [
            (Phase::Flight, &self.flying),
            (Phase::Board, &self.on_board),
            (Phase::Ring, &self.on_ring),
            (Phase::Both, &self.on_both),
        ]
    }

    fn is_done(&self) -> bool {
        self.queues().iter().all(|(_, queue)| queue.is_empty())
    }

    /// The shots that wait for a phase.
    fn waiting(&mut self, phase: Phase) -> &mut Vec<u32> {
        match phase {
            Phase::Flight => &mut self.flying,
            Phase::Board => &mut self.on_board,
            Phase::Ring => &mut self.on_ring,
            Phase::Both => &mut self.on_both,
        }
    }

    /// Is there enough to do elsewhere to leave a phase of which not all lanes can be filled?
    fn others_fill(&self, lanes: usize, phase: Phase) -> bool {
        let fills = |(other, queue): &(Phase, &Vec<u32>)| *other != phase && queue.len() >= lanes;
        self.queues().iter().any(fills)
    }

    /// Queues a shot for what it is on.
    fn wait(&mut self, shot: u32) {
        let phase = match self.shots[shot as usize].on {
            On::Nothing => Phase::Flight,
            On::Board(_) => Phase::Board,
            On::Ring(_) => Phase::Ring,
            On::Both { .. } => Phase::Both,
        };
        self.waiting(phase).push(shot);
    }
}

struct Batch<'a, P: Packed> {
    simd: P::Simd,
    law: &'a Law,
    lanes: Law<P>,
    rules: &'a Rules,
    room: &'a mut Room,
}

impl<P: Packed> Batch<'_, P> {
    /// Works off the queue of a phase, as a function of its own: all four in one take the compiler
    /// minutes.
    #[inline(never)]
    fn phase(&mut self, phase: Phase) {
        match phase {
            Phase::Flight => self.simd.vectorize(
                #[inline(always)]
                || self.fly(),
            ),
            Phase::Board => self.simd.vectorize(
                #[inline(always)]
                || self.press_board(),
            ),
            Phase::Ring => self.simd.vectorize(
                #[inline(always)]
                || self.press_ring(),
            ),
            Phase::Both => self.simd.vectorize(
                #[inline(always)]
                || self.press_both(),
            ),
        }
    }

    /// Takes a shot through what the lanes do not do, in the scalar form, and queues it again.
    #[cold]
    fn hand_over(&mut self, shot: u32) {
        let progress = &mut self.room.shots[shot as usize];
        if progress.stretches >= MOST_STRETCHES {
            self.finish(shot, Ending::Unresolved, false);
            return;
        }
        progress.stretches += 1;
        match exact::stretch(self.law, self.rules, progress) {
            Some(verdict) => self.room.verdicts[shot as usize] = verdict,
            None => self.room.wait(shot),
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
        let mut seats = Seats::new();
        for shots in queue.chunks(P::WIDTH) {
            for lane in 0..P::WIDTH {
                // Lanes without a shot repeat the last one.
                let shot = shots[lane.min(shots.len() - 1)];
                seats.take(lane, shot, &self.room.shots[shot as usize]);
            }
            let law = &self.lanes;
            let mut seated = seats.load(self.simd);
            let start = seated.state;
            let arc = Arc::from(law, &start);
            let dt = arc.end.least(arc.board).least(arc.ring);
            seated.passage.flight(law, &start, dt);
            seated.state = start.flown(law, dt);
            seated.time_s = seated.time_s + dt;
            let late = law.zero.lit(self.rules.time_limit_s).lt(seated.time_s);
            let special = P::bits(arc.beside_board.lt(dt) | arc.unresolved | late);
            let made = P::bits(seated.passage.made(law, &seated.state));
            let ring = P::bits(arc.ring.le(dt));
            let board = P::bits(arc.board.le(dt));
            let rose_to = law.zero.lit(-1.0) * law.radius - REACHED_M;
            let fell = P::bits(rose_to.lt(seated.state.position_m.2));
            seats.store(&seated);
            for (lane, &shot) in shots.iter().enumerate() {
                let progress = &mut self.room.shots[shot as usize];
                progress.on = On::Nothing;
                if bit(special, lane) || progress.stretches >= MOST_STRETCHES {
                    self.hand_over(shot);
                    continue;
                }
                progress.stretches += 1;
                seats.leave(lane, progress);
                if bit(ring, lane) {
                    progress.contacts.push(Touched::Ring);
                    progress.on = On::Ring(fresh);
                    self.room.on_ring.push(shot);
                } else if bit(board, lane) {
                    progress.contacts.push(Touched::Board);
                    progress.on = On::Board(fresh);
                    self.room.on_board.push(shot);
                } else if bit(fell, lane) {
                    self.finish(shot, Ending::Fell, bit(made, lane));
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
        let longest = law.zero.lit(self.rules.longest_step_s);
        self.press(Board, Phase::Board, On::Board, |state| {
            let gap = ring_gap(&law, state, longest);
            let leaves = !flight::on_board(&law, state) | gap.reached(&law);
            let time = move |_: &State<P>, push| gap.time(&law, push);
            (leaves, time)
        });
    }

    #[inline(always)]
    fn press_ring(&mut self) {
        let law = self.lanes;
        let longest = law.zero.lit(self.rules.longest_step_s);
        self.press(Ring, Phase::Ring, On::Ring, |state| {
            let time =
                move |state: &State<P>, push| exact::time_to_board(&law, state, push, longest);
            (exact::board_reached(&law, state), time)
        });
    }

    /// Fills the lanes that are free with shots that wait for `phase`.
    #[inline(always)]
    fn fill(&mut self, seats: &mut Seats, phase: Phase) {
        for lane in lanes_of(P::ALL & !seats.taken) {
            let Some(shot) = self.room.waiting(phase).pop() else {
                break;
            };
            seats.take(lane, shot, &self.room.shots[shot as usize]);
        }
    }

    /// Steps the shots that wait for one surface until they part, or until there are too few to fill
    /// the lanes and others to run first. `other` tells that the contact is no longer one with this
    /// surface alone, and gives the time until then.
    #[inline(always)]
    fn press<T, F>(
        &mut self,
        surface: T,
        phase: Phase,
        on: fn(Grip) -> On,
        other: impl Fn(&State<P>) -> (P::Mask, F),
    ) where
        T: Surface<P>,
        F: FnOnce(&State<P>, Triple<P>) -> Due<P>,
    {
        let law = self.lanes;
        let longest = law.zero.lit(self.rules.longest_step_s);
        let mut seats = Seats::new();
        loop {
            self.fill(&mut seats, phase);
            if seats.taken == 0 {
                return;
            }
            let mut seated = seats.load(self.simd);
            let before = seated.state;
            let (leaves, time_to_other) = other(&before);
            let suspended = seats.taken != P::ALL && self.room.others_fill(P::WIDTH, phase);
            let leaves = P::bits(leaves);
            let out = if suspended { seats.taken } else { leaves };
            for lane in lanes_of(out & seats.taken) {
                let shot = seats.shot(lane);
                let progress = &mut self.room.shots[shot as usize];
                seats.leave(lane, progress);
                progress.on = on(seats.grip(0, lane));
                if bit(leaves, lane) {
                    self.hand_over(shot);
                } else {
                    self.room.waiting(phase).push(shot);
                }
            }
            if suspended {
                return;
            }
            let mut grip = seats.load_grip(self.simd, 0);
            let step = contact::step(
                &law,
                surface,
                &mut seated.state,
                &mut grip,
                longest,
                time_to_other,
            );
            let ends = seated.after_step(&law, &before, step.dt, self.rules.time_limit_s);
            seats.store(&seated);
            seats.store_grip(0, &grip);
            let done = step.parted | ends.behind | ends.fell | ends.late;
            let done = P::bits(done) & seats.taken;
            if done == 0 {
                continue;
            }
            let parted = P::bits(step.parted);
            let made = P::bits(seated.passage.made(&law, &seated.state));
            let (behind, fell) = (P::bits(ends.behind), P::bits(ends.fell));
            for lane in lanes_of(done) {
                let shot = seats.shot(lane);
                let progress = &mut self.room.shots[shot as usize];
                seats.leave(lane, progress);
                if bit(parted, lane) {
                    self.room.flying.push(shot);
                } else if bit(behind, lane) {
                    self.finish(shot, Ending::BehindBoard, false);
                } else if bit(fell, lane) {
                    self.finish(shot, Ending::Fell, bit(made, lane));
                } else {
                    self.finish(shot, Ending::TimeLimit, false);
                }
            }
        }
    }

    /// Steps the shots on board and ring until one contact is left or the ball has lodged.
    #[inline(always)]
    fn press_both(&mut self) {
        let law = self.lanes;
        let longest = law.zero.lit(self.rules.longest_step_s);
        let lodged_after = match self.rules.lodged_after_s {
            after if after > 0.0 => law.zero.lit(after),
            _ => law.never,
        };
        let mut seats = Seats::new();
        loop {
            self.fill(&mut seats, Phase::Both);
            if seats.taken == 0 {
                return;
            }
            if seats.taken != P::ALL && self.room.others_fill(P::WIDTH, Phase::Both) {
                for lane in lanes_of(seats.taken) {
                    let shot = seats.shot(lane);
                    let progress = &mut self.room.shots[shot as usize];
                    seats.leave(lane, progress);
                    progress.on = On::Both {
                        grips: [wedge::BOARD, wedge::RING].map(|i| seats.grip(i, lane)),
                        wedged_s: seats.wedged_s(lane),
                    };
                    self.room.on_both.push(shot);
                }
                return;
            }
            let mut seated = seats.load(self.simd);
            let before = seated.state;
            let mut grips = [
                seats.load_grip(self.simd, wedge::BOARD),
                seats.load_grip(self.simd, wedge::RING),
            ];
            let step = wedge::step(&law, &mut seated.state, &mut grips, longest);
            let off_board = step.left[wedge::BOARD] | !flight::on_board(&law, &seated.state);
            let off_ring = step.left[wedge::RING];
            let stepped = law.zero.lt(step.dt);
            let wedged = wedge::wedged(&law, &grips, seats.load_wedged(self.simd), step.dt);
            let lodged = P::bits(lodged_after.le(wedged) & stepped);
            let ends = seated.after_step(&law, &before, step.dt, self.rules.time_limit_s);
            seats.store(&seated);
            seats.store_wedged(wedged);
            for i in [wedge::BOARD, wedge::RING] {
                seats.store_grip(i, &grips[i]);
            }
            let ended = P::bits((ends.behind | ends.fell | ends.late) & stepped);
            let left = P::bits(off_board | off_ring);
            let made = P::bits(seated.passage.made(&law, &seated.state));
            let (behind, fell) = (P::bits(ends.behind), P::bits(ends.fell));
            let (off_board, off_ring) = (P::bits(off_board), P::bits(off_ring));
            for lane in lanes_of((ended | lodged | left) & seats.taken) {
                let shot = seats.shot(lane);
                let progress = &mut self.room.shots[shot as usize];
                seats.leave(lane, progress);
                if bit(ended, lane) {
                    if bit(behind, lane) {
                        self.finish(shot, Ending::BehindBoard, false);
                    } else if bit(fell, lane) {
                        self.finish(shot, Ending::Fell, bit(made, lane));
                    } else {
                        self.finish(shot, Ending::TimeLimit, false);
                    }
                } else if bit(lodged, lane) {
                    self.finish(shot, Ending::Wedged, false);
                } else {
                    let grips = [wedge::BOARD, wedge::RING].map(|i| seats.grip(i, lane));
                    let left = [bit(off_board, lane), bit(off_ring, lane)];
                    progress.on = On::after_both(left, grips, 0.0);
                    self.room.wait(shot);
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
