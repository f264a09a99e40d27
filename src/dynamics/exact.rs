//! The default integrator: closed-form flight with touches found for certain, and contacts in RK4
//! steps that end on the events of friction.

use super::contact::{self, Due, Grip, REACHED_M};
use super::flight::{self, Arc};
use super::outcome::{Contacts, Ending, Touched, Verdict};
use super::passage::Passage;
use super::state::{Law, State, Triple};
use super::surface::{Board, Ring, Surface};
use super::watch::Watch;
use super::wedge;
use crate::lane::{Lane, Mask};

/// Bound on the flights and contacts of one shot, so that every run ends; never reached so far.
pub(crate) const MOST_STRETCHES: u32 = 100_000;

/// What the ball touches at present.
#[derive(Clone, Copy, Debug)]
pub(crate) enum On {
    /// Flying, or about to.
    Nothing,
    Board(Grip),
    Ring(Grip),
    Both {
        /// At the board and at the ring.
        grips: [Grip; 2],
        /// Time for which both have been rolled on without a break, s.
        wedged_s: f64,
    },
}

impl On {
    /// Both, just now.
    pub(crate) fn both(grips: [Grip; 2]) -> Self {
        Self::Both {
            grips,
            wedged_s: 0.0,
        }
    }

    /// After a step on both, of which one or two have been left.
    pub(crate) fn after_both(left: [bool; 2], grips: [Grip; 2], wedged_s: f64) -> Self {
        match left {
            [true, true] => Self::Nothing,
            [true, false] => Self::Ring(grips[wedge::RING]),
            [false, true] => Self::Board(grips[wedge::BOARD]),
            [false, false] => Self::Both { grips, wedged_s },
        }
    }
}

/// How far a shot has come.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Progress {
    pub(crate) state: State,
    pub(crate) time_s: f64,
    pub(crate) on: On,
    pub(crate) contacts: Contacts,
    pub(crate) passage: Passage,
    /// Flights and contacts so far.
    pub(crate) stretches: u32,
}

impl Progress {
    /// At the release.
    #[inline(always)]
    pub(crate) fn at_release(law: &Law, start: State) -> Self {
        Self {
            state: start,
            time_s: 0.0,
            on: On::Nothing,
            contacts: Contacts::default(),
            passage: Passage::at_release(law, &start),
            stretches: 0,
        }
    }
}

/// Limits that belong to the run and not to the equations.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rules {
    /// Longest step in contact, s.
    pub(crate) longest_step_s: f64,
    pub(crate) time_limit_s: f64,
    /// 0 for never.
    pub(crate) lodged_after_s: f64,
}

/// A shot on its way.
struct Shot<'a, W> {
    law: &'a Law,
    rules: &'a Rules,
    watch: &'a mut W,
    now: Progress,
}

/// Runs one shot to its end.
pub(crate) fn run<W: Watch>(law: &Law, rules: &Rules, start: State, watch: &mut W) -> Verdict {
    let mut progress = Progress::at_release(law, start);
    let (on_board, on_ring) = pressed_at_start(law, &start);
    let fresh = Grip::fresh(law);
    for (touched, on) in [(on_board, Touched::Board), (on_ring, Touched::Ring)] {
        if touched {
            progress.contacts.push(on);
            watch.touch(0.0, on, &start);
        }
    }
    progress.on = match (on_board, on_ring) {
        (true, true) => On::both([fresh; 2]),
        (true, false) => On::Board(fresh),
        (false, true) => On::Ring(fresh),
        (false, false) => On::Nothing,
    };
    resume(law, rules, progress, watch)
}

/// Is a ball already pressed against board or ring when it starts?
pub(crate) fn pressed_at_start(law: &Law, start: &State) -> (bool, bool) {
    let Triple(x, _, z) = start.position_m;
    if z.abs() > law.radius && x > law.board_touch_x {
        return (false, false);
    }
    let (board, ()) = Board.meet(law, start);
    let (ring, _) = Ring.meet(law, start);
    let on_board = board.compression > REACHED_M && flight::on_board(law, start);
    (on_board, ring.compression > REACHED_M)
}

/// Runs a shot on to its end.
pub(crate) fn resume<W: Watch>(
    law: &Law,
    rules: &Rules,
    progress: Progress,
    watch: &mut W,
) -> Verdict {
    let mut shot = Shot {
        law,
        rules,
        watch,
        now: progress,
    };
    for _ in 0..MOST_STRETCHES {
        if let Some(ending) = shot.stretch() {
            return shot.verdict(ending);
        }
    }
    shot.verdict(Ending::Unresolved)
}

/// Runs a shot on through one flight or contact, to its end or to what comes next.
pub(crate) fn stretch(law: &Law, rules: &Rules, progress: &mut Progress) -> Option<Verdict> {
    let mut shot = Shot {
        law,
        rules,
        watch: &mut (),
        now: *progress,
    };
    let ending = shot.stretch();
    *progress = shot.now;
    ending.map(|ending| shot.verdict(ending))
}

impl<W: Watch> Shot<'_, W> {
    fn stretch(&mut self) -> Option<Ending> {
        match self.now.on {
            On::Nothing => self.fly(),
            On::Board(grip) => self.press_board(grip),
            On::Ring(grip) => self.press_ring(grip),
            On::Both { grips, wedged_s } => self.press_both(grips, wedged_s),
        }
    }

    fn verdict(&self, ending: Ending) -> Verdict {
        let made = ending == Ending::Fell && self.now.passage.made(self.law, &self.now.state);
        Verdict {
            made,
            ending,
            contacts: self.now.contacts,
            time_s: self.now.time_s,
        }
    }

    /// One arc of free flight, up to its end or the next touch.
    fn fly(&mut self) -> Option<Ending> {
        let law = self.law;
        let mut arc = Arc::from(law, &self.now.state);
        let mut behind = law.never;
        if arc.beside_board < arc.end.min(arc.board).min(arc.ring) {
            let (enters, face) = flight::beside_board(law, &self.now.state, arc.beside_board);
            (arc.board, behind) = (enters, face);
            arc.seek_ring(law, &self.now.state, arc.end.min(enters).min(face));
        }
        let dt = arc.end.least(arc.board).least(arc.ring).least(behind);
        if self.now.time_s + dt > self.rules.time_limit_s {
            self.advance_flight(self.rules.time_limit_s - self.now.time_s);
            return Some(Ending::TimeLimit);
        }
        self.advance_flight(dt);
        if arc.unresolved {
            return Some(Ending::Unresolved);
        }
        if arc.ring <= dt {
            self.touch(Touched::Ring);
            self.now.on = On::Ring(Grip::fresh(law));
        } else if arc.board <= dt {
            self.touch(Touched::Board);
            self.now.on = On::Board(Grip::fresh(law));
        } else if behind <= dt {
            return Some(Ending::BehindBoard);
        } else {
            let rose = self.now.state.position_m.2 > -law.radius - REACHED_M;
            return Some(if rose {
                Ending::Fell
            } else {
                Ending::NeverRose
            });
        }
        None
    }

    fn advance_flight(&mut self, dt: f64) {
        self.watch
            .flight(self.law, self.now.time_s, dt, &self.now.state);
        self.now.passage.flight(self.law, &self.now.state, dt);
        self.now.state = self.now.state.flown(self.law, dt);
        self.now.time_s += dt;
    }

    fn touch(&mut self, surface: Touched) {
        self.now.contacts.push(surface);
        self.watch.touch(self.now.time_s, surface, &self.now.state);
    }

    fn part(&mut self, surface: Touched) {
        self.watch.part(self.now.time_s, surface, &self.now.state);
    }

    fn press_board(&mut self, mut grip: Grip) -> Option<Ending> {
        let law = self.law;
        loop {
            if !flight::on_board(law, &self.now.state) {
                self.part(Touched::Board);
                self.now.on = On::Nothing;
                return None;
            }
            let longest = self.rules.longest_step_s;
            let gap = ring_gap(law, &self.now.state, longest);
            if gap.reached(law) {
                self.touch(Touched::Ring);
                self.now.on = On::both([grip, Grip::fresh(law)]);
                return None;
            }
            let before = self.now.state;
            let step = contact::step(
                law,
                Board,
                &mut self.now.state,
                &mut grip,
                longest,
                |_, acceleration| gap.time(law, acceleration),
            );
            if step.parted {
                self.part(Touched::Board);
                self.now.on = On::Nothing;
                return None;
            }
            let impulse = self.impulse(&before, step.dt);
            if let Some(ending) = self.after_step(step.dt, &before, [impulse, NONE]) {
                return Some(ending);
            }
        }
    }

    fn press_ring(&mut self, mut grip: Grip) -> Option<Ending> {
        let law = self.law;
        loop {
            if board_reached(law, &self.now.state) {
                self.touch(Touched::Board);
                self.now.on = On::both([Grip::fresh(law), grip]);
                return None;
            }
            let longest = self.rules.longest_step_s;
            let before = self.now.state;
            let step = contact::step(
                law,
                Ring,
                &mut self.now.state,
                &mut grip,
                longest,
                |state, acceleration| time_to_board(law, state, acceleration, longest),
            );
            if step.parted {
                self.part(Touched::Ring);
                self.now.on = On::Nothing;
                return None;
            }
            let impulse = self.impulse(&before, step.dt);
            if let Some(ending) = self.after_step(step.dt, &before, [NONE, impulse]) {
                return Some(ending);
            }
        }
    }

    fn press_both(&mut self, mut grips: [Grip; 2], mut wedged_s: f64) -> Option<Ending> {
        let law = self.law;
        loop {
            let before = self.now.state;
            let step = wedge::step(
                law,
                &mut self.now.state,
                &mut grips,
                self.rules.longest_step_s,
            );
            let off_board = step.left[wedge::BOARD] || !flight::on_board(law, &self.now.state);
            let off_ring = step.left[wedge::RING];
            if off_board {
                self.part(Touched::Board);
            }
            if off_ring {
                self.part(Touched::Ring);
            }
            if step.dt > 0.0 {
                let ending = self.after_step(step.dt, &before, step.impulses);
                wedged_s = wedge::wedged(law, &grips, wedged_s, step.dt);
                let after = self.rules.lodged_after_s;
                if ending.is_some() {
                    return ending;
                }
                if after > 0.0 && wedged_s >= after {
                    return Some(Ending::Wedged);
                }
            }
            if off_board || off_ring {
                self.now.on = On::after_both([off_board, off_ring], grips, wedged_s);
                return None;
            }
        }
    }

    /// Impulse per unit of mass of the one contact of a step: what gravity does not explain.
    fn impulse(&self, before: &State, dt: f64) -> Triple<f64> {
        let Triple(vx, vy, vz) = self.now.state.velocity_m_s;
        let Triple(ux, uy, uz) = before.velocity_m_s;
        Triple(vx - ux, vy - uy, vz - uz + self.law.gravity * dt)
    }

    fn after_step(
        &mut self,
        dt: f64,
        before: &State,
        impulses: [Triple<f64>; 2],
    ) -> Option<Ending> {
        self.watch
            .step(self.now.time_s, dt, (before, &self.now.state), impulses);
        self.now.time_s += dt;
        self.now
            .passage
            .step(self.law, before, &self.now.state, true);
        let law = self.law;
        if self.now.state.position_m.0 < law.board_face_x {
            Some(Ending::BehindBoard)
        } else if self.now.state.position_m.2 < -law.radius && self.now.state.velocity_m_s.2 < 0.0 {
            Some(Ending::Fell)
        } else if self.now.time_s > self.rules.time_limit_s {
            Some(Ending::TimeLimit)
        } else {
            None
        }
    }
}

const NONE: Triple<f64> = Triple(0.0, 0.0, 0.0);

/// Has a ball on the ring reached the board?
#[inline(always)]
pub(crate) fn board_reached<L: Lane>(law: &Law<L>, state: &State<L>) -> L::Mask {
    let gap = state.position_m.0 - law.board_touch_x;
    gap.le(law.zero.lit(REACHED_M))
        & state.velocity_m_s.0.lt(law.zero)
        & flight::on_board(law, state)
}

/// Time until a ball on the ring reaches the board's plane, if it can be within `longest`.
#[inline(always)]
pub(crate) fn time_to_board<L: Lane>(
    law: &Law<L>,
    state: &State<L>,
    acceleration: Triple<L>,
    longest: L,
) -> Due<L> {
    let gap = (state.position_m.0 - law.board_touch_x).most(law.zero.lit(REACHED_M));
    let motion = (gap, state.velocity_m_s.0, acceleration.0);
    contact::first_root_within(law, motion, longest)
}

/// The ring seen by a ball that is in contact with the board.
#[derive(Clone, Copy)]
pub(crate) struct Gap<L: Lane> {
    /// The ring is near enough to matter within a step; else the rest means nothing.
    near: L::Mask,
    gap: L,
    opening: L,
    bending: L,
    normal: Triple<L>,
}

/// The gap to the ring, for steps of at most `longest`.
#[inline(always)]
pub(crate) fn ring_gap<L: Lane>(law: &Law<L>, state: &State<L>, longest: L) -> Gap<L> {
    let Triple(vx, vy, vz) = state.velocity_m_s;
    // The way of a step: the velocity's, and what the hardest push of the board within it can add.
    let speed = vx.abs() + vy.abs() + vz.abs();
    let squeeze = (law.board_touch_x - state.position_m.0).most(law.zero) + vx.abs() * longest;
    let push = law.stiffness * squeeze + law.damping * vx.abs();
    let most = push * (law.friction + 1.0) + law.gravity;
    let way = (speed + most * longest * 0.5) * longest;
    let inward = law.ring_radius - state.axis_square().sqrt();
    let distance_square = inward.squared() + state.position_m.2.squared();
    let near = distance_square.le((law.radius + way).squared());
    if !near.any() {
        let zero = law.zero;
        let normal = Triple(zero, zero, zero);
        return Gap {
            near,
            gap: zero,
            opening: zero,
            bending: zero,
            normal,
        };
    }
    let (touch, frame) = Ring.meet(law, state);
    Gap {
        near,
        gap: -touch.compression,
        opening: touch.v.0,
        bending: touch.bending(),
        normal: Ring.to_space(frame, Triple(law.one, law.zero, law.zero)),
    }
}

impl<L: Lane> Gap<L> {
    /// Has the ball reached the ring?
    #[inline(always)]
    pub(crate) fn reached(&self, law: &Law<L>) -> L::Mask {
        self.near & self.gap.le(law.zero.lit(REACHED_M)) & self.opening.lt(law.zero)
    }

    /// Time until the gap closes.
    #[inline(always)]
    pub(crate) fn time(&self, law: &Law<L>, acceleration: Triple<L>) -> Due<L> {
        if !self.near.any() {
            return Due::never(law);
        }
        let Triple(x, y, z) = acceleration;
        let along = self.normal.0 * x + self.normal.1 * y + self.normal.2 * z;
        let gap = self.gap.most(law.zero.lit(REACHED_M));
        let time = contact::first_root(law, gap, self.opening, along + self.bending);
        time.when(self.near, Due::never(law))
    }
}
