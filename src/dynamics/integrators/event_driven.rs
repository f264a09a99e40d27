//! The default integrator: closed-form flight in which every touch is found, and contacts in long
//! steps that end at contact events (the slip reaches zero, rolling fails, the ball parts, the
//! other solid is touched).

use super::shot_in_frame::{FrameStep, ShotInFrame};
use super::shot_in_world::{ShotInWorld, WorldStep};
use super::shot_progress::{ContactState, ShotProgress};
use crate::dynamics::contact::contact_frame_step::Contact;
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::end_rules::{ShotLimits, flight_ending, rose_to_ring};
use crate::dynamics::flight::{FlightEvents, FlightPath, FlightSegment, next_segment};
use crate::dynamics::observer::{NO_IMPULSES, Observer};
use crate::dynamics::outcome::{Ending, Verdict};
use crate::math::real::{Real, ScalarReal};
use crate::math::scalar_f32::F32;
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{BoardEdges, FramedPart, Solid, TOUCH_GAP_M};
use crate::model::{BallState, SolidId};

/// Limit on the phases (flights and contacts) of one shot, so that every run ends. Never reached
/// so far.
pub(crate) const MAX_PHASES: u32 = 100_000;

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
    shot.set_touching(params, touched);
    let mut run = Run {
        params,
        limits,
        observer,
        shot,
    };
    for _ in 0..MAX_PHASES {
        if let Some(verdict) = run.phase() {
            return verdict;
        }
    }
    run.shot.verdict(Ending::Unresolved, false)
}

/// The solids that the ball touches at its release, by [`SolidId::index`].
pub(crate) fn solids_touched_at_release(
    params: &ModelParams,
    start: &BallState,
) -> [bool; SolidId::COUNT] {
    let p = start.position_m;
    if p.z.abs() > params.ring.reach && p.x > params.board.touch_x {
        return [false; SolidId::COUNT];
    }
    [
        is_touched(params, &params.board, start),
        is_touched(params, &params.ring, start),
    ]
}

fn is_touched<S: Solid<f64>>(params: &ModelParams, solid: &S, state: &BallState) -> bool {
    let (kinematics, _) = solid.contact(&params.ball, state);
    kinematics.compression > TOUCH_GAP_M && solid.acts(state)
}

/// One step of one shot. A function of its own: it is compiled once for each solid and number type,
/// not for each observer.
#[inline(never)]
fn step_in_frame<T: ScalarReal, S: Solid<T>, Other: Solid<T>>(
    contact: &Contact<'_, T, S>,
    other: &Other,
    shot: &ShotInFrame<T>,
) -> (ShotInFrame<T>, FrameStep<T>) {
    shot.step(contact, other, false)
}

/// A step in the world frame.
#[inline(never)]
fn step_in_world(
    params: &ModelParams,
    limits: &ShotLimits,
    shot: &mut ShotInWorld<f64>,
) -> WorldStep<f64> {
    shot.step(params, limits, false)
}

/// Simulates one phase of a shot: a flight or a contact, to the end of the shot or to the next
/// phase.
pub(crate) fn run_phase(
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
    let verdict = run.phase();
    *shot = run.shot;
    verdict
}

impl<O: Observer> Run<'_, O> {
    fn phase(&mut self) -> Option<Verdict> {
        let params = self.params;
        match self.shot.contact {
            ContactState::Free => {
                self.shot.update_state(params);
                self.fly()
            }
            ContactState::InFrame(part) if self.limits.single_precision => {
                let params_f32 = params.map(F32::from_f64);
                self.single_contact(&params_f32, part)
            }
            ContactState::InFrame(part) => self.single_contact(params, part),
            ContactState::InWorld => self.contact_in_world(),
        }
    }

    fn single_contact<T: ScalarReal>(
        &mut self,
        params: &ModelParams<T>,
        part: FramedPart,
    ) -> Option<Verdict> {
        let (board, ring) = (&params.board, &params.ring);
        match part {
            FramedPart::BoardFace => self.contact_with(params, board, ring),
            FramedPart::BoardEdges => self.contact_with(params, &BoardEdges(board), ring),
            FramedPart::RingCircle => self.contact_with(params, ring, board),
        }
    }

    /// One arc of free flight, to its end or to the next touch.
    fn fly(&mut self) -> Option<Verdict> {
        let params = self.params;
        if !params.has_paper_flight() {
            return self.fly_in_segments();
        }
        let mut flight = FlightEvents::new(params, &self.shot.state);
        let behind = flight.resolve_beside_board(params, &self.shot.state);
        if flight.unresolved {
            return Some(self.shot.verdict(Ending::Unresolved, false));
        }
        let dt = Real::min(flight.first_end(), behind);
        if self.shot.time_s + dt > self.limits.time_limit_s {
            self.advance_flight(self.limits.time_limit_s - self.shot.time_s);
            return Some(self.shot.verdict(Ending::TimeLimit, false));
        }
        self.advance_flight(dt);
        // The ring is searched only up to the time of the board, so at most one of the two is
        // touched.
        for solid in [SolidId::Ring, SolidId::Board] {
            if flight.touch_of(solid) <= dt {
                self.touch(solid);
                return None;
            }
        }
        if behind <= dt {
            return Some(self.shot.verdict(Ending::BehindBoard, false));
        }
        let ending = flight_ending(rose_to_ring(params, &self.shot.state));
        let made = self.shot.crossing.is_made(params, &self.shot.state);
        Some(self.shot.verdict(ending, made))
    }

    fn advance_flight(&mut self, dt: f64) {
        let shot = &mut self.shot;
        let path = FlightPath::new(&self.params.ball, &shot.state);
        self.observer.flight(self.params, shot.time_s, dt, &path);
        shot.crossing.after_flight(self.params, &shot.state, dt);
        shot.state = shot.state.after_flight(&self.params.ball, dt);
        shot.time_s += dt;
    }

    /// The flight as a sequence of segments.
    fn fly_in_segments(&mut self) -> Option<Verdict> {
        let params = self.params;
        loop {
            let segment = next_segment(params, &self.shot.state);
            if segment.unresolved {
                return Some(self.shot.verdict(Ending::Unresolved, false));
            }
            let left_s = self.limits.time_limit_s - self.shot.time_s;
            if segment.dt > left_s {
                self.advance_segment(&segment, left_s);
                return Some(self.shot.verdict(Ending::TimeLimit, false));
            }
            self.advance_segment(&segment, segment.dt);
            for solid in SolidId::ALL {
                if segment.touches[solid.index()] {
                    self.touch(solid);
                    return None;
                }
            }
            if segment.behind_board {
                return Some(self.shot.verdict(Ending::BehindBoard, false));
            }
            if segment.fell {
                let ending = flight_ending(rose_to_ring(params, &self.shot.state));
                let made = self.shot.crossing.is_made(params, &self.shot.state);
                return Some(self.shot.verdict(ending, made));
            }
        }
    }

    fn advance_segment(&mut self, segment: &FlightSegment, dt: f64) {
        let (params, shot) = (self.params, &mut self.shot);
        let path = FlightPath::new(&params.ball, &shot.state);
        self.observer.flight(params, shot.time_s, dt, &path);
        shot.crossing.after_segment(segment, true);
        shot.state = segment.end;
        shot.time_s += dt;
    }

    /// A ball in flight touches a solid.
    fn touch(&mut self, solid: SolidId) {
        let shot = &mut self.shot;
        shot.contacts.push(solid);
        shot.friction[solid.index()] = FrictionState::new(self.params);
        shot.set_touching(self.params, SolidId::ALL.map(|id| id == solid));
        shot.step_fraction = 1.0;
        let time_s = shot.time_s;
        let state = shot.state;
        self.observer.touch(time_s, solid, &state);
    }

    fn separation(&mut self, solid: SolidId) {
        let time_s = self.shot.time_s + self.shot.contact_time_s;
        self.observer.separation(time_s, solid, &self.shot.state);
    }

    /// Contact with one solid until the ball parts, touches the other solid, or the shot ends.
    fn contact_with<T: ScalarReal, S: Solid<T>, Other: Solid<T>>(
        &mut self,
        params: &ModelParams<T>,
        solid: &S,
        other: &Other,
    ) -> Option<Verdict> {
        let oscillator = &self.limits.oscillators[S::PART as usize].map(T::from_f64);
        let contact = Contact {
            params,
            solid,
            oscillator,
        };
        let limit = self.limits.time_limit_s;
        let mut shot = ShotInFrame::of(&self.shot, S::ID, limit).converted::<T>();
        loop {
            self.shot.steps += 1;
            if self.shot.steps >= self.limits.max_steps {
                return Some(self.shot.verdict(Ending::Unresolved, false));
            }
            let step;
            (shot, step) = step_in_frame(&contact, other, &shot);
            if !step.accepted {
                continue;
            }
            let before_s = self.shot.contact_time_s;
            shot.converted::<f64>().write_to(&mut self.shot, S::PART);
            self.report_contact_step(S::PART, before_s);
            if let Some(ending) = step.ends.ending() {
                return Some(self.shot.verdict(ending, step.made));
            }
            if step.flies {
                self.separation(S::ID);
                self.shot.end_single_contact(ContactState::Free);
                return None;
            }
            if step.arrived {
                self.shot.arrive(self.params, Other::ID);
                self.observer
                    .touch(self.shot.time_s, Other::ID, &self.shot.state);
                return None;
            }
            if step.leaves_frame {
                self.shot.leave_frame(self.params, S::ID);
                return None;
            }
        }
    }

    /// After a step in contact with one solid that began `before_s` after the touch: updates the
    /// state in the world frame, and reports the step.
    fn report_contact_step(&mut self, part: FramedPart, before_s: f64) {
        let shot = &mut self.shot;
        let before = shot.state;
        shot.update_state(self.params);
        // The next step starts from `motion` again; `state` is for the report.
        shot.frame = Some(part);
        let (start, dt) = (shot.time_s + before_s, shot.contact_time_s - before_s);
        let mut impulses = NO_IMPULSES;
        impulses[part.solid().index()] = self.impulse_since(&before, dt);
        self.observer
            .step(start, dt, (&before, &self.shot.state), impulses);
    }

    /// Contact in the world frame until the ball flies, goes on in the frame of a contact, is
    /// lodged, or the shot ends.
    fn contact_in_world(&mut self) -> Option<Verdict> {
        let params = self.params;
        let mut shot = ShotInWorld::of(&self.shot);
        loop {
            self.shot.steps += 1;
            if self.shot.steps >= self.limits.max_steps {
                return Some(self.shot.verdict(Ending::Unresolved, false));
            }
            let before = shot;
            let step = step_in_world(params, self.limits, &mut shot);
            if !step.accepted {
                continue;
            }
            self.observer.step(
                before.time_s,
                step.dt,
                (&before.state, &shot.state),
                step.impulses,
            );
            shot.write_to(&mut self.shot);
            if let Some(ending) = step.ends.ending() {
                return Some(self.shot.verdict(ending, step.made));
            }
            if step.lodged {
                return Some(self.shot.verdict(Ending::Lodged, false));
            }
            for solid in SolidId::ALL {
                if step.separates[solid.index()] {
                    self.separation(solid);
                }
                if step.arrived[solid.index()] {
                    self.observer.touch(shot.time_s, solid, &shot.state);
                }
            }
            self.shot
                .change_contacts(params, step.separates, step.arrived);
            if self.shot.contact != ContactState::InWorld {
                return None;
            }
            shot = ShotInWorld::of(&self.shot);
        }
    }

    /// Impulse per unit of mass of the only contact of a step: the change of velocity without that
    /// by gravity and air.
    fn impulse_since(&self, before: &BallState, dt: f64) -> Vec3<f64> {
        let (v, u) = (self.shot.state.velocity_m_s, before.velocity_m_s);
        let free = |v| self.params.ball.free_acceleration(v, before.spin_rad_s);
        v - u - (free(u) + free(v)) * (0.5 * dt)
    }
}
