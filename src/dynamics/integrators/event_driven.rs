//! The default integrator: closed-form flight in which every touch is found, and contacts in RK4 steps
//! that end at contact events (the slip reaches zero, rolling fails, the force ends, the other solid is touched).

use crate::dynamics::contact::double;
use crate::dynamics::contact::event_time::time_to_touch;
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::contact::single;
use crate::dynamics::end_rules::{
    ShotEndFlags, ShotLimits, flight_ending, is_lodged, rose_to_ring,
};
use crate::dynamics::flight::FlightEvents;
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::dynamics::observer::{Impulses, NO_IMPULSES, Observer};
use crate::dynamics::outcome::{ContactSequence, Ending, Verdict};
use crate::math::real::Real;
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{Approach, Solid, TOUCH_GAP_M};
use crate::model::{BallState, SolidId};

/// Limit on the segments (flights and contacts) of one shot, so that every run ends. Never reached so far.
pub(crate) const MAX_SEGMENTS: u32 = 100_000;

/// The contacts of the ball at present.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ContactState {
    /// In flight, or about to be.
    Free,
    /// On one solid.
    Single(SolidId, FrictionState),
    /// On board and ring.
    BoardAndRing {
        /// Friction at the board and at the ring.
        friction: [FrictionState; 2],
        /// Time for which the ball has rolled on both without a break, s.
        rolling_time_s: f64,
    },
}

impl ContactState {
    /// A double contact that has just begun.
    pub(crate) fn board_and_ring(friction: [FrictionState; 2]) -> Self {
        Self::BoardAndRing {
            friction,
            rolling_time_s: 0.0,
        }
    }

    /// After a step on board and ring that the ball may have left.
    pub(crate) fn after_double(
        [off_board, off_ring]: [bool; 2],
        friction: [FrictionState; 2],
        rolling_time_s: f64,
    ) -> Self {
        let [on_board, on_ring] = friction;
        match (off_board, off_ring) {
            (true, true) => Self::Free,
            (true, false) => Self::Single(SolidId::Ring, on_ring),
            (false, true) => Self::Single(SolidId::Board, on_board),
            (false, false) => Self::BoardAndRing {
                friction,
                rolling_time_s,
            },
        }
    }
}

/// A shot in progress.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShotProgress {
    pub(crate) state: BallState,
    pub(crate) time_s: f64,
    pub(crate) contact: ContactState,
    pub(crate) contacts: ContactSequence,
    pub(crate) crossing: HoopCrossing,
    /// Segments so far. (In a batch, a contact in the lanes is not counted; the limit is far away in any case.)
    pub(crate) segments: u32,
    /// Steps in contact so far.
    pub(crate) steps: u32,
}

impl ShotProgress {
    /// At the release.
    #[inline(always)]
    pub(crate) fn at_release(params: &ModelParams, start: BallState) -> Self {
        Self {
            state: start,
            time_s: 0.0,
            contact: ContactState::Free,
            contacts: ContactSequence::default(),
            crossing: HoopCrossing::at_release(params, &start),
            segments: 0,
            steps: 0,
        }
    }

    /// The verdict of a shot that ends like this.
    pub(crate) fn verdict(&self, params: &ModelParams, ending: Ending) -> Verdict {
        Verdict {
            made: ending == Ending::Fell && self.crossing.is_made(params, &self.state),
            ending,
            contacts: self.contacts,
            time_s: self.time_s,
        }
    }
}

/// A running shot with its observer.
struct Run<'a, O> {
    params: &'a ModelParams,
    limits: &'a ShotLimits,
    observer: &'a mut O,
    shot: ShotProgress,
}

/// Simulates one shot to its end.
pub(crate) fn run<O: Observer>(
    params: &ModelParams,
    limits: &ShotLimits,
    start: BallState,
    observer: &mut O,
) -> Verdict {
    let mut shot = ShotProgress::at_release(params, start);
    let touched = solids_touched_at_release(params, &start);
    for solid in SolidId::ALL {
        if touched[solid.index()] {
            shot.contacts.push(solid);
            observer.touch(0.0, solid, &start);
        }
    }
    let new_friction = FrictionState::new(params);
    shot.contact = match touched {
        [true, true] => ContactState::board_and_ring([new_friction; 2]),
        [true, false] => ContactState::Single(SolidId::Board, new_friction),
        [false, true] => ContactState::Single(SolidId::Ring, new_friction),
        [false, false] => ContactState::Free,
    };
    let mut run = Run {
        params,
        limits,
        observer,
        shot,
    };
    for _ in 0..MAX_SEGMENTS {
        if let Some(ending) = run.segment() {
            return run.shot.verdict(params, ending);
        }
    }
    run.shot.verdict(params, Ending::Unresolved)
}

/// The solids that the ball touches at its release, by [`SolidId::index`].
pub(crate) fn solids_touched_at_release(
    params: &ModelParams,
    start: &BallState,
) -> [bool; SolidId::COUNT] {
    let p = start.position_m;
    if p.z.abs() > params.ball.radius && p.x > params.board.touch_x {
        return [false; SolidId::COUNT];
    }
    [
        is_touched(params, &params.board, start),
        is_touched(params, &params.ring, start),
    ]
}

fn is_touched<S: Solid<f64>>(params: &ModelParams, solid: &S, state: &BallState) -> bool {
    let (kinematics, _) = solid.contact(&params.ball, state);
    kinematics.compression > TOUCH_GAP_M && solid.faces(state)
}

/// Simulates one segment of a shot: a flight or a contact, to the end of the shot or to the next segment.
pub(crate) fn run_segment(
    params: &ModelParams,
    limits: &ShotLimits,
    shot: &mut ShotProgress,
) -> Option<Verdict> {
    let mut run = Run {
        params,
        limits,
        observer: &mut (),
        shot: *shot,
    };
    let ending = run.segment();
    *shot = run.shot;
    ending.map(|ending| shot.verdict(params, ending))
}

/// Greatest acceleration that the present contact with `solid` can give the ball within a step.
#[inline(always)]
pub(crate) fn max_acceleration<T: Real, S: Solid<T>>(
    params: &ModelParams<T>,
    solid: &S,
    state: &BallState<T>,
    longest: T,
) -> T {
    let (kinematics, _) = solid.contact(&params.ball, state);
    let material = solid.material();
    let normal_speed = kinematics.velocity.normal.abs();
    let compression = kinematics.compression.positive_part() + normal_speed * longest;
    let normal = material.stiffness * compression + material.damping * normal_speed;
    normal * (material.friction_coefficient + 1.0) + params.ball.gravity
}

impl<O: Observer> Run<'_, O> {
    fn segment(&mut self) -> Option<Ending> {
        let params = self.params;
        match self.shot.contact {
            ContactState::Free => self.fly(),
            ContactState::Single(SolidId::Board, friction) => {
                self.single_contact(&params.board, &params.ring, friction)
            }
            ContactState::Single(SolidId::Ring, friction) => {
                self.single_contact(&params.ring, &params.board, friction)
            }
            ContactState::BoardAndRing {
                friction,
                rolling_time_s,
            } => self.double_contact((&params.board, &params.ring), friction, rolling_time_s),
        }
    }

    /// One arc of free flight, to its end or to the next touch.
    fn fly(&mut self) -> Option<Ending> {
        let params = self.params;
        let mut flight = FlightEvents::new(params, &self.shot.state);
        let behind = flight.resolve_beside_board(params, &self.shot.state);
        let dt = Real::min(flight.first_end(), behind);
        if self.shot.time_s + dt > self.limits.time_limit_s {
            self.advance_flight(self.limits.time_limit_s - self.shot.time_s);
            return Some(Ending::TimeLimit);
        }
        self.advance_flight(dt);
        if flight.unresolved {
            return Some(Ending::Unresolved);
        }
        // The ring is searched only up to the time of the board, so at most one of the two is touched.
        for solid in [SolidId::Ring, SolidId::Board] {
            if flight.touch_of(solid) <= dt {
                self.touch(solid);
                let new_friction = FrictionState::new(params);
                self.shot.contact = ContactState::Single(solid, new_friction);
                return None;
            }
        }
        if behind <= dt {
            return Some(Ending::BehindBoard);
        }
        Some(flight_ending(rose_to_ring(params, &self.shot.state)))
    }

    fn advance_flight(&mut self, dt: f64) {
        let shot = &mut self.shot;
        self.observer
            .flight(self.params, shot.time_s, dt, &shot.state);
        shot.crossing.after_flight(self.params, &shot.state, dt);
        shot.state = shot.state.after_flight(&self.params.ball, dt);
        shot.time_s += dt;
    }

    fn touch(&mut self, solid: SolidId) {
        self.shot.contacts.push(solid);
        self.observer
            .touch(self.shot.time_s, solid, &self.shot.state);
    }

    fn part(&mut self, solid: SolidId) {
        self.observer
            .part(self.shot.time_s, solid, &self.shot.state);
    }

    /// Contact with one solid until the ball parts, touches the other solid, or the shot ends.
    fn single_contact<S: Solid<f64>, Other: Solid<f64>>(
        &mut self,
        solid: &S,
        other: &Other,
        mut friction: FrictionState,
    ) -> Option<Ending> {
        let params = self.params;
        let longest = self.limits.longest_step_s;
        loop {
            let before = self.shot.state;
            if !solid.faces(&before) {
                self.part(S::ID);
                self.shot.contact = ContactState::Free;
                return None;
            }
            let bound = max_acceleration(params, solid, &before, longest);
            let approach = other.approach(&params.ball, &before, bound, longest);
            if approach.has_arrived() {
                self.touch(Other::ID);
                let mut both = [FrictionState::new(params); SolidId::COUNT];
                both[S::ID.index()] = friction;
                self.shot.contact = ContactState::board_and_ring(both);
                return None;
            }
            let step = single::step(
                params,
                solid,
                &mut self.shot.state,
                &mut friction,
                longest,
                |state, acceleration| time_to_touch(params, &approach, state, acceleration),
            );
            self.shot.steps += 1;
            if step.separated {
                self.part(S::ID);
                self.shot.contact = ContactState::Free;
                return None;
            }
            let mut impulses = NO_IMPULSES;
            impulses[S::ID.index()] = self.impulse_since(&before, step.dt);
            if let Some(ending) = self.after_step(step.dt, &before, impulses) {
                return Some(ending);
            }
            if self.shot.steps >= self.limits.max_steps {
                return Some(Ending::Unresolved);
            }
        }
    }

    /// Contact with two solids until the ball parts from one of them, is lodged, or the shot ends.
    fn double_contact<A: Solid<f64>, B: Solid<f64>>(
        &mut self,
        solids: (&A, &B),
        mut friction: [FrictionState; 2],
        mut rolling_time_s: f64,
    ) -> Option<Ending> {
        let params = self.params;
        loop {
            let before = self.shot.state;
            let step = double::step(
                params,
                solids,
                &mut self.shot.state,
                &mut friction,
                self.limits.longest_step_s,
            );
            let separated = [
                step.separated[0] || !solids.0.faces(&self.shot.state),
                step.separated[1] || !solids.1.faces(&self.shot.state),
            ];
            for (separated, solid) in separated.into_iter().zip([A::ID, B::ID]) {
                if separated {
                    self.part(solid);
                }
            }
            if step.dt > 0.0 {
                let ending = self.after_step(step.dt, &before, step.impulses);
                rolling_time_s = double::rolling_time(&friction, rolling_time_s, step.dt);
                if ending.is_some() {
                    return ending;
                }
                if is_lodged(rolling_time_s, self.limits.lodged_after_s) {
                    return Some(Ending::Lodged);
                }
            }
            self.shot.steps += 1;
            if self.shot.steps >= self.limits.max_steps {
                return Some(Ending::Unresolved);
            }
            if separated.contains(&true) {
                self.shot.contact = ContactState::after_double(separated, friction, rolling_time_s);
                return None;
            }
        }
    }

    /// Impulse per unit of mass of the only contact of a step: the change of velocity without gravity.
    fn impulse_since(&self, before: &BallState, dt: f64) -> Vec3<f64> {
        let (v, u) = (self.shot.state.velocity_m_s, before.velocity_m_s);
        Vec3::new(
            v.x - u.x,
            v.y - u.y,
            v.z - u.z + self.params.ball.gravity * dt,
        )
    }

    fn after_step(&mut self, dt: f64, before: &BallState, impulses: Impulses) -> Option<Ending> {
        let shot = &mut self.shot;
        self.observer
            .step(shot.time_s, dt, (before, &shot.state), impulses);
        shot.time_s += dt;
        shot.crossing
            .after_step(self.params, before, &shot.state, true);
        let limit = self.limits.time_limit_s;
        ShotEndFlags::new(self.params, &shot.state, shot.time_s, limit).ending()
    }
}
