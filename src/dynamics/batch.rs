//! Many shots at once, eight or sixteen to a step, in vector lanes.
//!
//! The shots of a batch wait in four queues, by what comes next: flight, board, ring, both. Flights are
//! closed-form and are done a pack at a time. In contact the shots of a pack step together; a lane whose ball
//! parts is refilled from the queue at once, so short and long contacts mix without waiting. What is
//! rare (the step from one contact to both, the board's edges, the time limit) leaves its lane for the
//! scalar form and comes back to a queue when it is over.
//!
//! The equations are those of the scalar form, so the verdicts are the same, bit for bit.

use super::contact::{self, Due, Grip, REACHED_M};
use super::exact::{self, MOST_STRETCHES, On, Rules, ring_gap};
use super::flight::{self, Arc};
use super::outcome::{Ending, Touched};
use super::room::{Phase, Room};
use super::seats::{Seats, bit, lanes_of};
use super::state::{Law, State, Triple};
use super::surface::{Board, Ring, Surface};
use super::wedge;
use crate::lane::{Pack, Packed, Twin};
use fearless_simd::Simd;

/// Runs the shots of `starts` to their ends; the verdicts are then in the room.
#[inline(always)]
pub(super) fn run<S: Simd>(simd: S, law: &Law, rules: &Rules, starts: &[State], room: &mut Room) {
    room.open(starts.len());
    let mut batch = Batch {
        simd,
        law,
        rules,
        room,
    };
    loop {
        batch.room.admit(law, rules, starts);
        if batch.room.is_empty() {
            return;
        }
        for phase in [Phase::Flight, Phase::Board, Phase::Ring, Phase::Both] {
            batch.phase(phase);
        }
    }
}

struct Batch<'a, S: Simd> {
    simd: S,
    law: &'a Law,
    rules: &'a Rules,
    room: &'a mut Room,
}

/// Eight shots side by side.
type Narrow<S> = Pack<S>;
/// Sixteen.
type Wide<S> = Twin<Pack<S>>;

/// Calls a method as a function of its own, compiled for the vector instructions.
macro_rules! apart {
    ($batch:ident.$work:ident::<$lanes:ty>) => {
        $batch.apart(
            #[inline(always)]
            |batch: &mut Self| batch.$work::<$lanes>(),
        )
    };
}

impl<S: Simd> Batch<'_, S> {
    /// Sixteen shots at a time pay where one register holds eight, for there they are two chains of
    /// operations that do not wait for one another. Elsewhere eight are such chains already.
    const WIDE: bool = size_of::<S::f64s>() == size_of::<[f64; 8]>();

    /// Works off the queue of a phase.
    fn phase(&mut self, phase: Phase) {
        match phase {
            Phase::Flight if Self::WIDE => apart!(self.fly::<Wide<S>>),
            Phase::Flight => apart!(self.fly::<Narrow<S>>),
            Phase::Board => {
                if Self::WIDE {
                    apart!(self.press_board::<Wide<S>>);
                }
                apart!(self.press_board::<Narrow<S>>);
            }
            Phase::Ring => {
                if Self::WIDE {
                    apart!(self.press_ring::<Wide<S>>);
                }
                apart!(self.press_ring::<Narrow<S>>);
            }
            Phase::Both => apart!(self.press_both::<Narrow<S>>),
        }
    }

    /// Does some work as a function of its own: all in one would take the compiler minutes.
    #[inline(never)]
    fn apart(&mut self, work: impl FnOnce(&mut Self)) {
        self.simd.vectorize(
            #[inline(always)]
            || work(self),
        );
    }

    /// Takes a shot through what the lanes do not do, in the scalar form, and queues it again.
    #[cold]
    fn hand_over(&mut self, slot: u32) {
        let progress = &mut self.room.slots[slot as usize];
        if progress.stretches >= MOST_STRETCHES {
            self.room.finish(slot, Ending::Unresolved, false);
            return;
        }
        progress.stretches += 1;
        match exact::stretch(self.law, self.rules, progress) {
            Some(verdict) => self.room.settle(slot, verdict),
            None => self.room.enqueue(slot),
        }
    }

    /// Flies every shot of the queue to its end or its next touch.
    #[inline(always)]
    fn fly<P: Packed<Simd = S>>(&mut self) {
        let law = self.law.map(|value| P::splat(self.simd, value));
        let law = &law;
        let queue = self.room.take_flying();
        let fresh = Grip::fresh(self.law);
        let mut seats = Seats::new();
        for slots in queue.chunks(P::WIDTH) {
            // Lanes without a shot repeat the last one.
            let mut next = slots
                .iter()
                .copied()
                .chain(std::iter::repeat(slots[slots.len() - 1]));
            seats.fill(P::ALL, &self.room.slots, || next.next());
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
            let mut left = P::ALL >> (P::WIDTH - slots.len());
            for lane in lanes_of(left) {
                let progress = &mut self.room.slots[slots[lane] as usize];
                progress.on = On::Nothing;
                if bit(special, lane) || progress.stretches >= MOST_STRETCHES {
                    left &= !(1 << lane);
                    self.hand_over(slots[lane]);
                    continue;
                }
                progress.stretches += 1;
                seats.leave(lane, progress);
            }
            // End by end: to ask each lane for its end would be to guess wrong as often as not.
            for lane in lanes_of(left & ring) {
                let progress = &mut self.room.slots[slots[lane] as usize];
                progress.contacts.push(Touched::Ring);
                progress.on = On::Ring(fresh);
                self.room.on_ring.push(slots[lane]);
            }
            for lane in lanes_of(left & board & !ring) {
                let progress = &mut self.room.slots[slots[lane] as usize];
                progress.contacts.push(Touched::Board);
                progress.on = On::Board(fresh);
                self.room.on_board.push(slots[lane]);
            }
            for lane in lanes_of(left & !ring & !board) {
                let (ending, made) = if bit(fell, lane) {
                    (Ending::Fell, bit(made, lane))
                } else {
                    (Ending::NeverRose, false)
                };
                self.room.finish(slots[lane], ending, made);
            }
        }
        self.room.give_back(queue);
    }

    #[inline(always)]
    fn press_board<P: Packed<Simd = S>>(&mut self) {
        let law = self.law.map(|value| P::splat(self.simd, value));
        let longest = law.zero.lit(self.rules.longest_step_s);
        self.press(Board, Phase::Board, On::Board, |state| {
            let gap = ring_gap(&law, state, longest);
            let leaves = !flight::on_board(&law, state) | gap.reached(&law);
            let time = move |_: &State<P>, push| gap.time(&law, push);
            (leaves, time)
        });
    }

    #[inline(always)]
    fn press_ring<P: Packed<Simd = S>>(&mut self) {
        let law = self.law.map(|value| P::splat(self.simd, value));
        let longest = law.zero.lit(self.rules.longest_step_s);
        self.press(Ring, Phase::Ring, On::Ring, |state| {
            let time =
                move |state: &State<P>, push| exact::time_to_board(&law, state, push, longest);
            (exact::board_reached(&law, state), time)
        });
    }

    /// Fills the lanes that are free with shots that wait for `phase`.
    #[inline(always)]
    fn fill<P: Packed<Simd = S>>(&mut self, seats: &mut Seats, phase: Phase) {
        let free = P::ALL & !seats.taken();
        let (slots, queue) = self.room.slots_and_queue(phase);
        seats.fill(free, slots, || queue.pop());
        seats.take_grips(free, slots);
    }

    /// Steps the shots that wait for one surface until they part, or until there are too few to fill
    /// the lanes and others to run first. `other` tells that the contact is no longer one with this
    /// surface alone, and gives the time until then.
    #[inline(always)]
    fn press<P, T, F>(
        &mut self,
        surface: T,
        phase: Phase,
        on: fn(Grip) -> On,
        other: impl Fn(&State<P>) -> (P::Mask, F),
    ) where
        P: Packed<Simd = S>,
        T: Surface<P>,
        F: FnOnce(&State<P>, Triple<P>) -> Due<P>,
    {
        let law = self.law.map(|value| P::splat(self.simd, value));
        let longest = law.zero.lit(self.rules.longest_step_s);
        let mut seats = Seats::new();
        loop {
            self.fill::<P>(&mut seats, phase);
            if seats.taken() == 0 {
                return;
            }
            let mut seated = seats.load(self.simd);
            let before = seated.state;
            let (leaves, time_to_other) = other(&before);
            // Half of the lanes can be filled as well in a narrower pack.
            let few = seats.taken().count_ones() as usize <= P::WIDTH / 2
                && P::WIDTH > Narrow::<S>::WIDTH;
            let suspended =
                few || seats.taken() != P::ALL && self.room.others_fill(Wide::<S>::WIDTH, phase);
            let leaves = P::bits(leaves);
            let out = if suspended { seats.taken() } else { leaves };
            for lane in lanes_of(out & seats.taken()) {
                let slot = seats.slot(lane);
                let progress = &mut self.room.slots[slot as usize];
                seats.leave(lane, progress);
                progress.on = on(seats.grip(0, lane));
                if bit(leaves, lane) {
                    self.hand_over(slot);
                } else {
                    self.room.queue_mut(phase).push(slot);
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
            let done = P::bits(done) & seats.taken();
            if done == 0 {
                continue;
            }
            let parted = P::bits(step.parted);
            let made = P::bits(seated.passage.made(&law, &seated.state));
            let (behind, fell) = (P::bits(ends.behind), P::bits(ends.fell));
            for lane in lanes_of(done) {
                let slot = seats.slot(lane);
                let progress = &mut self.room.slots[slot as usize];
                seats.leave(lane, progress);
                if bit(parted, lane) {
                    self.room.flying.push(slot);
                } else if bit(behind, lane) {
                    self.room.finish(slot, Ending::BehindBoard, false);
                } else if bit(fell, lane) {
                    self.room.finish(slot, Ending::Fell, bit(made, lane));
                } else {
                    self.room.finish(slot, Ending::TimeLimit, false);
                }
            }
        }
    }

    /// Steps the shots on board and ring until one contact is left or the ball has lodged.
    #[inline(always)]
    fn press_both<P: Packed<Simd = S>>(&mut self) {
        let law = self.law.map(|value| P::splat(self.simd, value));
        let longest = law.zero.lit(self.rules.longest_step_s);
        let lodged_after = match self.rules.lodged_after_s {
            after if after > 0.0 => law.zero.lit(after),
            _ => law.never,
        };
        let mut seats = Seats::new();
        loop {
            self.fill::<P>(&mut seats, Phase::Both);
            if seats.taken() == 0 {
                return;
            }
            if seats.taken() != P::ALL && self.room.others_fill(Wide::<S>::WIDTH, Phase::Both) {
                for lane in lanes_of(seats.taken()) {
                    let slot = seats.slot(lane);
                    let progress = &mut self.room.slots[slot as usize];
                    seats.leave(lane, progress);
                    progress.on = On::Both {
                        grips: [wedge::BOARD, wedge::RING].map(|i| seats.grip(i, lane)),
                        wedged_s: seats.wedged_s(lane),
                    };
                    self.room.on_both.push(slot);
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
            for lane in lanes_of((ended | lodged | left) & seats.taken()) {
                let slot = seats.slot(lane);
                let progress = &mut self.room.slots[slot as usize];
                seats.leave(lane, progress);
                if bit(ended, lane) {
                    if bit(behind, lane) {
                        self.room.finish(slot, Ending::BehindBoard, false);
                    } else if bit(fell, lane) {
                        self.room.finish(slot, Ending::Fell, bit(made, lane));
                    } else {
                        self.room.finish(slot, Ending::TimeLimit, false);
                    }
                } else if bit(lodged, lane) {
                    self.room.finish(slot, Ending::Wedged, false);
                } else {
                    let grips = [wedge::BOARD, wedge::RING].map(|i| seats.grip(i, lane));
                    let left = [bit(off_board, lane), bit(off_ring, lane)];
                    progress.on = On::after_both(left, grips, 0.0);
                    self.room.enqueue(slot);
                }
            }
        }
    }
}
