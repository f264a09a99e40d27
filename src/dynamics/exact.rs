//! The default integrator: closed-form flight with touches found for certain, and contacts in RK4
//! steps that end on the events of friction.

use super::contact::{self, Grip, REACHED_M, SHORTEST_S};
use super::flight::{self, Arc};
use super::outcome::{Contacts, Ending, Touched, Verdict};
use super::passage::Passage;
use super::state::{Law, State, Triple};
use super::surface::{Board, Ring, Surface};
use super::watch::Watch;
use super::wedge;

/// Bound on the flights and contacts of one shot, so that every run ends; never reached so far.
const MOST_STRETCHES: u32 = 100_000;

/// What the ball touches at present.
#[derive(Clone, Copy, Debug)]
enum On {
    Nothing,
    Board(Grip),
    Ring(Grip),
    Both([Grip; 2]),
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
    state: State,
    time_s: f64,
    on: On,
    contacts: Contacts,
    passage: Passage,
    /// Time for which board and ring have both been rolled on without a break.
    wedged_s: f64,
}

/// Runs one shot to its end.
pub(crate) fn run<W: Watch>(law: &Law, rules: &Rules, start: State, watch: &mut W) -> Verdict {
    let mut shot = Shot {
        law,
        rules,
        watch,
        state: start,
        time_s: 0.0,
        on: On::Nothing,
        contacts: Contacts::default(),
        passage: Passage::at_release(law, &start),
        wedged_s: 0.0,
    };
    shot.begin();
    for _ in 0..MOST_STRETCHES {
        let ending = match shot.on {
            On::Nothing => shot.fly(),
            On::Board(grip) => shot.press_board(grip),
            On::Ring(grip) => shot.press_ring(grip),
            On::Both(grips) => shot.press_both(grips),
        };
        if let Some(ending) = ending {
            return shot.verdict(ending);
        }
    }
    shot.verdict(Ending::Unresolved)
}

impl<W: Watch> Shot<'_, W> {
    fn verdict(&self, ending: Ending) -> Verdict {
        let made = ending == Ending::Fell && self.passage.made(self.law, &self.state);
        Verdict {
            made,
            ending,
            contacts: self.contacts,
            time_s: self.time_s,
        }
    }

    /// A ball that is already pressed against something starts in contact.
    fn begin(&mut self) {
        let (board, ()) = Board.meet(self.law, &self.state);
        let (ring, _) = Ring.meet(self.law, &self.state);
        let on_board = board.compression > REACHED_M && flight::on_board(self.law, &self.state);
        let on_ring = ring.compression > REACHED_M;
        let fresh = Grip::fresh(self.law);
        if on_board {
            self.touch(Touched::Board);
            self.on = On::Board(fresh);
        }
        if on_ring {
            self.touch(Touched::Ring);
            self.on = if on_board {
                On::Both([fresh; 2])
            } else {
                On::Ring(fresh)
            };
        }
    }

    /// One arc of free flight, up to its end or the next touch.
    fn fly(&mut self) -> Option<Ending> {
        let law = self.law;
        let mut arc = Arc::from(law, &self.state);
        let mut behind = law.never;
        if arc.beside_board < arc.end.min(arc.board).min(arc.ring) {
            let (enters, face) = flight::beside_board(law, &self.state, arc.beside_board);
            (arc.board, behind) = (enters, face);
            arc.seek_ring(law, &self.state, arc.end.min(enters).min(face));
        }
        let dt = arc.end.min(arc.board).min(arc.ring).min(behind);
        if self.time_s + dt > self.rules.time_limit_s {
            self.advance_flight(self.rules.time_limit_s - self.time_s);
            return Some(Ending::TimeLimit);
        }
        self.advance_flight(dt);
        if arc.unresolved {
            return Some(Ending::Unresolved);
        }
        if arc.ring <= dt {
            self.touch(Touched::Ring);
            self.on = On::Ring(Grip::fresh(law));
        } else if arc.board <= dt {
            self.touch(Touched::Board);
            self.on = On::Board(Grip::fresh(law));
        } else if behind <= dt {
            return Some(Ending::BehindBoard);
        } else {
            let rose = self.state.position_m.2 > -law.radius - REACHED_M;
            return Some(if rose {
                Ending::Fell
            } else {
                Ending::NeverRose
            });
        }
        None
    }

    fn advance_flight(&mut self, dt: f64) {
        self.watch.flight(self.law, self.time_s, dt, &self.state);
        self.passage.flight(self.law, &self.state, dt);
        self.state = self.state.flown(self.law, dt);
        self.time_s += dt;
    }

    fn touch(&mut self, surface: Touched) {
        self.contacts.push(surface);
        self.watch.touch(self.time_s, surface, &self.state);
    }

    fn part(&mut self, surface: Touched) {
        self.watch.part(self.time_s, surface, &self.state);
    }

    fn press_board(&mut self, mut grip: Grip) -> Option<Ending> {
        let law = self.law;
        loop {
            if !flight::on_board(law, &self.state) {
                self.part(Touched::Board);
                self.on = On::Nothing;
                return None;
            }
            if ring_gap(law, &self.state).is_some_and(|gap| gap.reached()) {
                self.touch(Touched::Ring);
                self.on = On::Both([grip, Grip::fresh(law)]);
                self.wedged_s = 0.0;
                return None;
            }
            let before = self.state;
            let step = contact::step(
                law,
                Board,
                &mut self.state,
                &mut grip,
                self.rules.longest_step_s,
                |state, acceleration| {
                    ring_gap(law, state).map_or(law.never, |gap| gap.time(law, acceleration))
                },
            );
            if step.parted {
                self.part(Touched::Board);
                self.on = On::Nothing;
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
            let gap = self.state.position_m.0 - law.board_touch_x;
            if gap <= REACHED_M
                && self.state.velocity_m_s.0 < 0.0
                && flight::on_board(law, &self.state)
            {
                self.touch(Touched::Board);
                self.on = On::Both([Grip::fresh(law), grip]);
                self.wedged_s = 0.0;
                return None;
            }
            let before = self.state;
            let step = contact::step(
                law,
                Ring,
                &mut self.state,
                &mut grip,
                self.rules.longest_step_s,
                |state, acceleration| {
                    let gap = state.position_m.0 - law.board_touch_x;
                    contact::first_root(
                        law,
                        gap.max(REACHED_M),
                        state.velocity_m_s.0,
                        acceleration.0,
                    )
                },
            );
            if step.parted {
                self.part(Touched::Ring);
                self.on = On::Nothing;
                return None;
            }
            let impulse = self.impulse(&before, step.dt);
            if let Some(ending) = self.after_step(step.dt, &before, [NONE, impulse]) {
                return Some(ending);
            }
        }
    }

    fn press_both(&mut self, mut grips: [Grip; 2]) -> Option<Ending> {
        let law = self.law;
        loop {
            let before = self.state;
            let step = wedge::step(law, &mut self.state, &mut grips, self.rules.longest_step_s);
            let off_board = step.left_board || !flight::on_board(law, &self.state);
            if off_board {
                self.part(Touched::Board);
            }
            if step.left_ring {
                self.part(Touched::Ring);
            }
            match (off_board, step.left_ring) {
                (true, true) => self.on = On::Nothing,
                (true, false) => self.on = On::Ring(grips[1]),
                (false, true) => self.on = On::Board(grips[0]),
                (false, false) => {}
            }
            if step.dt > 0.0 {
                let ending = self.after_step(step.dt, &before, step.impulses);
                let rolls = grips[0].rolling && grips[1].rolling;
                self.wedged_s = if rolls { self.wedged_s + step.dt } else { 0.0 };
                let after = self.rules.lodged_after_s;
                if ending.is_some() {
                    return ending;
                }
                if after > 0.0 && self.wedged_s >= after {
                    return Some(Ending::Wedged);
                }
            }
            if off_board || step.left_ring {
                return None;
            }
        }
    }

    /// Impulse per unit of mass of the one contact of a step: what gravity does not explain.
    fn impulse(&self, before: &State, dt: f64) -> Triple<f64> {
        let Triple(vx, vy, vz) = self.state.velocity_m_s;
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
            .step(self.time_s, dt, (before, &self.state), impulses);
        self.time_s += dt;
        self.passage.step(self.law, before, &self.state);
        let law = self.law;
        if self.state.position_m.0 < law.board_face_x {
            Some(Ending::BehindBoard)
        } else if self.state.position_m.2 < -law.radius && self.state.velocity_m_s.2 < 0.0 {
            Some(Ending::Fell)
        } else if self.time_s > self.rules.time_limit_s {
            Some(Ending::TimeLimit)
        } else {
            None
        }
    }
}

const NONE: Triple<f64> = Triple(0.0, 0.0, 0.0);

/// The ring seen by a ball that is in contact with the board.
struct Gap {
    gap: f64,
    opening: f64,
    bending: f64,
    normal: Triple<f64>,
}

/// The gap to the ring, where it is near enough to matter within a step.
fn ring_gap(law: &Law, state: &State) -> Option<Gap> {
    let near = 2.0 * law.radius;
    let Triple(x, y, z) = state.position_m;
    let reach = law.ring_radius + near;
    if z.abs() > near || x * x + y * y > reach * reach {
        return None;
    }
    let (touch, frame) = Ring.meet(law, state);
    Some(Gap {
        gap: -touch.compression,
        opening: touch.v.0,
        bending: touch.bending(),
        normal: Ring.to_space(frame, Triple(1.0, 0.0, 0.0)),
    })
}

impl Gap {
    fn reached(&self) -> bool {
        self.gap <= REACHED_M && self.opening < 0.0
    }

    /// Time until the gap closes.
    fn time(&self, law: &Law, acceleration: Triple<f64>) -> f64 {
        let Triple(x, y, z) = acceleration;
        let along = self.normal.0 * x + self.normal.1 * y + self.normal.2 * z;
        contact::first_root(
            law,
            self.gap.max(REACHED_M),
            self.opening,
            along + self.bending,
        )
        .max(SHORTEST_S)
    }
}
