//! The integrator of the paper, to the letter: variable-step RK4 of Eqs. 16 and 17 with friction by
//! the sliding law alone.
//!
//! The step is halved on the way into a contact until it is `dt_min`, stays there in contact, and
//! doubles on the way out up to `dt_max` (the paper's tuned bisection; its Table 1 is lost, the text
//! gives 0.015 and 0.0005 s). Contact is looked for at the stages and ends of steps only, so a graze
//! between them is not seen. The errata of
//! `docs/model.md` are applied: the sign of u_B', the full moment of the ring's friction, friction
//! only while N > 0, and no contact from behind the board.

use super::exact::Rules;
use super::flight;
use super::outcome::{Contacts, Ending, Touched, Verdict};
use super::passage::Passage;
use super::state::{Law, Rate, State, Triple};
use super::surface::{Board, Ring, Surface, Touch};
use super::watch::Watch;

/// The steps of the paper's method.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Steps {
    pub(crate) dt_max_s: f64,
    pub(crate) dt_min_s: f64,
}

/// Which surfaces are pressed (CONDB and CONDH of Eq. 17).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pressed {
    board: bool,
    ring: bool,
}

impl Pressed {
    fn at(law: &Law, state: &State) -> Self {
        let board = state.position_m.0 < law.board_touch_x && flight::on_board(law, state);
        let Triple(x, y, z) = state.position_m;
        let ring = z.abs() < law.radius && {
            let inward = law.ring_radius - (x * x + y * y).sqrt();
            inward * inward + z * z < law.radius * law.radius
        };
        Self { board, ring }
    }

    fn any(self) -> bool {
        self.board || self.ring
    }
}

/// Acceleration and angular acceleration that one surface gives a sliding ball.
fn sliding<S: Surface<f64>>(
    law: &Law,
    surface: S,
    (touch, frame): (Touch, S::Frame),
) -> (Triple<f64>, Triple<f64>) {
    let normal = touch.normal(law);
    let slip = touch.slip();
    let size = (slip.0 * slip.0 + slip.1 * slip.1).sqrt();
    let limit = law.friction * normal.max(0.0);
    let per = if size > 0.0 { limit / size } else { 0.0 };
    let friction = (-per * slip.0, -per * slip.1);
    let twist = touch.lever * law.mass_over_inertia;
    (
        surface.to_space(frame, Triple(normal, friction.0, friction.1)),
        surface.to_space(frame, Triple(0.0, twist * friction.1, -twist * friction.0)),
    )
}

/// The right-hand side of Eq. 17, and what is pressed there.
fn rate(law: &Law, state: &State) -> (Rate, Pressed) {
    let pressed = Pressed::at(law, state);
    let mut linear = Triple(0.0, 0.0, -law.gravity);
    let mut angular = Triple(0.0, 0.0, 0.0);
    if pressed.board {
        let (a, alpha) = sliding(law, Board, Board.meet(law, state));
        linear = linear.plus(a, 1.0);
        angular = angular.plus(alpha, 1.0);
    }
    if pressed.ring {
        let (a, alpha) = sliding(law, Ring, Ring.meet(law, state));
        linear = linear.plus(a, 1.0);
        angular = angular.plus(alpha, 1.0);
    }
    let rate = Rate {
        velocity_m_s: state.velocity_m_s,
        acceleration_m_s2: linear,
        spin_rate_rad_s2: angular,
    };
    (rate, pressed)
}

/// One step; also whether a contact was felt at any of its stages.
fn rk4(law: &Law, state: &State, dt: f64) -> (State, bool) {
    let (k1, at_1) = rate(law, state);
    let (k2, at_2) = rate(law, &state.advanced(&k1, 0.5 * dt));
    let (k3, at_3) = rate(law, &state.advanced(&k2, 0.5 * dt));
    let (k4, at_4) = rate(law, &state.advanced(&k3, dt));
    let felt = at_1.any() || at_2.any() || at_3.any() || at_4.any();
    (state.combined([&k1, &k2, &k3, &k4], dt), felt)
}

/// Runs one shot to its end.
pub(crate) fn run<W: Watch>(
    law: &Law,
    rules: &Rules,
    steps: Steps,
    start: State,
    watch: &mut W,
) -> Verdict {
    let mut state = start;
    let mut time_s = 0.0;
    let mut contacts = Contacts::default();
    let mut passage = Passage::at_release(law, &start);
    let mut pressed = Pressed::at(law, &state);
    let mut dt = steps.dt_max_s;
    let ending = loop {
        let (next, felt) = rk4(law, &state, dt);
        let now = Pressed::at(law, &next);
        if (felt || now.any()) && !pressed.any() && dt > steps.dt_min_s {
            dt = (0.5 * dt).max(steps.dt_min_s);
            continue;
        }
        let falls = next.position_m.2 < -law.radius && next.velocity_m_s.2 < 0.0 && !pressed.any();
        let fall = flight::falling_time(law, state.position_m.2, state.velocity_m_s.2, -law.radius);
        if falls && fall <= dt {
            watch.flight(law, time_s, fall, &state);
        } else if pressed.any() {
            watch.step(time_s, dt, (&state, &next), [Triple(0.0, 0.0, 0.0); 2]);
        } else {
            watch.flight(law, time_s, dt, &state);
        }
        passage.step(law, &state, &next, true);
        time_s += dt;
        note_changes(&mut contacts, watch, time_s, (pressed, now), &next);
        let below = state.position_m.2 >= -law.radius || state.velocity_m_s.2 >= 0.0;
        let before = std::mem::replace(&mut state, next);
        pressed = now;
        if state.position_m.0 < law.board_face_x {
            break Ending::BehindBoard;
        }
        if state.position_m.2 < -law.radius && state.velocity_m_s.2 < 0.0 && below {
            // Where the last step crossed z = -R, by the parabola of that step.
            let fall =
                flight::falling_time(law, before.position_m.2, before.velocity_m_s.2, -law.radius);
            let rose = before.position_m.2 > -law.radius
                || before.velocity_m_s.2.powi(2)
                    + 2.0 * law.gravity * (before.position_m.2 + law.radius)
                    > 0.0;
            if !pressed.any() && fall <= dt {
                state = before.flown(law, fall);
                time_s += fall - dt;
            }
            break if rose {
                Ending::Fell
            } else {
                Ending::NeverRose
            };
        }
        if time_s > rules.time_limit_s {
            break Ending::TimeLimit;
        }
        dt = if pressed.any() {
            steps.dt_min_s
        } else {
            (2.0 * dt).min(steps.dt_max_s)
        };
    };
    let made = ending == Ending::Fell && passage.made(law, &state);
    Verdict {
        made,
        ending,
        contacts,
        time_s,
    }
}

fn note_changes<W: Watch>(
    contacts: &mut Contacts,
    watch: &mut W,
    time_s: f64,
    (was, now): (Pressed, Pressed),
    state: &State,
) {
    for (before, after, surface) in [
        (was.board, now.board, Touched::Board),
        (was.ring, now.ring, Touched::Ring),
    ] {
        if after && !before {
            contacts.push(surface);
            watch.touch(time_s, surface, state);
        } else if before && !after {
            watch.part(time_s, surface, state);
        }
    }
}
