//! The default integrator: closed-form flight in which every touch is found, and contacts in long
//! steps that end at contact events (the slip reaches zero, rolling fails, the ball parts, the
//! other solid is touched).

use crate::dynamics::contact::contact_frame_step::{Contact, MacroStep};
use crate::dynamics::contact::friction::FrictionState;
use crate::dynamics::contact::other_solid_touch::{
    GapAtEnd, approach_in_world, has_arrived, passed,
};
use crate::dynamics::contact::world_frame_step::{self, WorldContact, WorldContactStep};
use crate::dynamics::end_rules::{
    ShotEndFlags, ShotLimits, flight_ending, is_lodged, rose_to_ring,
};
use crate::dynamics::flight::{FlightEvents, FlightPath, FlightSegment, next_segment};
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::dynamics::observer::{Impulses, NO_IMPULSES, Observer};
use crate::dynamics::outcome::{ContactSequence, Ending, Verdict};
use crate::math::real::{Real, ScalarReal};
use crate::math::scalar_f32::F32;
use crate::math::vector::Vec3;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{
    BoardEdges, CONTACT_VALUES, ContactFrameState, FramedPart, Solid, TOUCH_GAP_M,
};
use crate::model::{BallState, SolidId};

/// Limit on the phases (flights and contacts) of one shot, so that every run ends. Never reached
/// so far.
pub(crate) const MAX_PHASES: u32 = 100_000;

/// The contacts of the ball at present.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ContactState {
    /// In flight, or about to be.
    Free,
    /// On the face or an edge of the board, or on the ring's circle alone: in the frame of the
    /// contact.
    InFrame(FramedPart),
    /// On the bracket, at a corner of the board, or on both solids: in the world frame.
    InWorld,
}

/// A shot in progress.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShotProgress {
    /// In the world frame. If `frame` names a part, `motion` holds the state and this is out of
    /// date, except right after a step was reported.
    pub(crate) state: BallState,
    /// The ball in the frame of a contact.
    pub(crate) motion: ContactFrameState,
    pub(crate) frame: Option<FramedPart>,
    pub(crate) contact: ContactState,
    /// The solids that a ball in contact in the world frame touches, by [`SolidId::index`].
    pub(crate) touching: [bool; SolidId::COUNT],
    /// Friction at the board and at the ring.
    pub(crate) friction: [FrictionState; SolidId::COUNT],
    /// Length of the next step in contact, in units of the longest.
    pub(crate) step_fraction: f64,
    /// Time in the present contact with one solid; not yet counted in `time_s`.
    pub(crate) contact_time_s: f64,
    /// Time for which the ball has rolled on both solids without a break, s.
    pub(crate) rolling_time_s: f64,
    pub(crate) time_s: f64,
    pub(crate) contacts: ContactSequence,
    pub(crate) crossing: HoopCrossing,
    /// Phases so far. (In a batch, a contact in the lanes is not counted; the limit is far away
    /// in any case.)
    pub(crate) phases: u32,
    /// Steps in contact so far.
    pub(crate) steps: u32,
}

impl ShotProgress {
    /// At the release.
    #[inline(always)]
    pub(crate) fn at_release(params: &ModelParams, start: BallState) -> Self {
        let friction = FrictionState::new(params);
        Self {
            state: start,
            motion: ContactFrameState::from_array([0.0; CONTACT_VALUES]),
            frame: None,
            contact: ContactState::Free,
            touching: [false; SolidId::COUNT],
            friction: [friction; SolidId::COUNT],
            step_fraction: 1.0,
            contact_time_s: 0.0,
            rolling_time_s: 0.0,
            time_s: 0.0,
            contacts: ContactSequence::default(),
            crossing: HoopCrossing::at_release(params, &start),
            phases: 0,
            steps: 0,
        }
    }

    /// Begins a contact with one solid. `motion` and `friction` are set by the caller.
    #[inline(always)]
    pub(crate) fn begin_single_contact(&mut self, part: FramedPart) {
        self.contact = ContactState::InFrame(part);
        self.frame = Some(part);
        self.step_fraction = 1.0;
        self.contact_time_s = 0.0;
    }

    /// Ends a contact with one solid; the ball is free, or on both solids.
    #[inline(always)]
    pub(crate) fn end_single_contact(&mut self, contact: ContactState) {
        self.contact = contact;
        self.time_s += self.contact_time_s;
        self.contact_time_s = 0.0;
        self.rolling_time_s = 0.0;
    }

    /// The ball leaves the part of `solid` that the frame of the contact describes.
    pub(crate) fn leave_frame(&mut self, params: &ModelParams, solid: SolidId) {
        self.end_single_contact(ContactState::InWorld);
        self.update_state(params);
        self.step_fraction = 1.0;
        self.set_touching(params, SolidId::ALL.map(|id| id == solid));
    }

    /// The ball now also touches `arrived`.
    pub(crate) fn arrive(&mut self, params: &ModelParams, arrived: SolidId) {
        self.end_single_contact(ContactState::InWorld);
        self.update_state(params);
        self.touching = [true; SolidId::COUNT];
        self.step_fraction = 1.0;
        self.contacts.push(arrived);
        self.friction[arrived.index()] = FrictionState::new(params);
    }

    /// Sets the solids that the ball touches: it then flies, or is in contact in the frame of one
    /// solid where there is one.
    pub(crate) fn set_touching(&mut self, params: &ModelParams, touching: [bool; SolidId::COUNT]) {
        self.touching = touching;
        self.contact = ContactState::InWorld;
        let (board, ring) = (&params.board, &params.ring);
        let edges = BoardEdges(board);
        match touching {
            [false, false] => self.contact = ContactState::Free,
            [true, false] if board.is_in_frame(&self.state) => {
                self.motion = board.to_contact(&params.ball, &self.state);
                self.begin_single_contact(FramedPart::BoardFace);
            }
            [true, false] if edges.is_in_frame(&self.state) => {
                self.motion = edges.to_contact(&params.ball, &self.state);
                self.begin_single_contact(FramedPart::BoardEdges);
            }
            [false, true] if ring.is_in_frame(&self.state) => {
                self.motion = ring.to_contact(&params.ball, &self.state);
                self.begin_single_contact(FramedPart::RingCircle);
            }
            _ => {}
        }
    }

    /// Brings `state` up to date.
    #[inline(always)]
    pub(crate) fn update_state(&mut self, params: &ModelParams) {
        match self.frame {
            None => return,
            Some(FramedPart::BoardFace) => {
                self.state = params.board.to_world(&params.ball, &self.motion);
            }
            Some(FramedPart::BoardEdges) => {
                self.state = BoardEdges(&params.board).to_world(&params.ball, &self.motion);
            }
            Some(FramedPart::RingCircle) => {
                self.state = params.ring.to_world(&params.ball, &self.motion);
            }
        }
        self.frame = None;
    }

    /// The verdict of a shot that ends like this; `made` counts only for a ball that fell.
    pub(crate) fn verdict(&self, ending: Ending, made: bool) -> Verdict {
        Verdict {
            made: ending == Ending::Fell && made,
            ending,
            contacts: self.contacts,
            time_s: self.time_s + self.contact_time_s,
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
fn single_step<T: ScalarReal, S: Solid<T>>(
    contact: &Contact<'_, T, S>,
    motion: &ContactFrameState<T>,
    friction: &FrictionState<T>,
    fraction: T,
) -> MacroStep<T> {
    contact.step(motion, friction, fraction)
}

/// The same in the world frame.
#[inline(never)]
fn world_step<A: Solid<f64>, B: Solid<f64>>(
    params: &ModelParams,
    solids: (&A, &B),
    state: &mut BallState,
    friction: &mut [FrictionState; SolidId::COUNT],
    contact: &WorldContact<f64>,
) -> WorldContactStep<f64> {
    world_frame_step::step(params, solids, state, friction, contact)
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
            ContactState::InWorld => self.contact_in_world((&params.board, &params.ring)),
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

    /// The same as a sequence of segments.
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
        let mut motion = self.shot.motion.map(T::from_f64);
        let mut friction = self.shot.friction[S::ID.index()].map(T::from_f64);
        let mut fraction = T::from_f64(self.shot.step_fraction);
        let mut elapsed = T::from_f64(self.shot.contact_time_s);
        let allowed = T::from_f64(self.limits.time_limit_s - self.shot.time_s);
        loop {
            self.shot.steps += 1;
            if self.shot.steps >= self.limits.max_steps {
                return Some(self.shot.verdict(Ending::Unresolved, false));
            }
            let step = single_step(&contact, &motion, &friction, fraction);
            let after = solid.to_world(&params.ball, &step.motion);
            let path = (motion.speed_bound() + step.motion.speed_bound()) * step.dt;
            let end = GapAtEnd::new(params, other, &after, path);
            let mut repeats = false;
            fraction = params.one();
            if end.is_near {
                let before = solid.to_world(&params.ball, &motion);
                (repeats, fraction) = passed(params, other, &before, &end, step.dt);
            }
            if repeats {
                fraction = contact.fraction_of_longest(fraction * step.dt);
                continue;
            }
            let was_below = solid.is_below_hoop(&motion);
            (motion, friction) = (step.motion, step.friction);
            elapsed += step.dt;
            let shot = &mut self.shot;
            shot.friction[S::ID.index()] = friction.map(T::to_f64);
            shot.motion = motion.map(T::to_f64);
            let mut crossing = HoopCrossing::<T> {
                has_been_above: shot.crossing.has_been_above,
                rose_through: shot.crossing.rose_through,
            };
            crossing.after_step(params, was_below, &after, true);
            shot.crossing = HoopCrossing {
                has_been_above: crossing.has_been_above,
                rose_through: crossing.rose_through,
            };
            self.report_contact_step(S::PART, elapsed.to_f64());
            if let Some(ending) = ShotEndFlags::new(params, &after, allowed.lt(elapsed)).ending() {
                let made = crossing.is_made(params, &after);
                return Some(self.shot.verdict(ending, made));
            }
            if step.separates {
                self.separation(S::ID);
                self.shot.end_single_contact(ContactState::Free);
                return None;
            }
            if has_arrived(params, other, &after) {
                self.shot.arrive(self.params, Other::ID);
                self.observer
                    .touch(self.shot.time_s, Other::ID, &self.shot.state);
                return None;
            }
            if !solid.acts(&after) {
                self.separation(S::ID);
                self.shot.end_single_contact(ContactState::Free);
                return None;
            }
            if !solid.is_in_frame(&after) {
                self.shot.leave_frame(self.params, S::ID);
                return None;
            }
        }
    }

    /// After a step in contact with one solid: updates the state in the world frame, and reports
    /// the step.
    fn report_contact_step(&mut self, part: FramedPart, contact_time_s: f64) {
        let shot = &mut self.shot;
        let before = shot.state;
        shot.frame = Some(part);
        shot.update_state(self.params);
        // The next step starts from `motion` again; `state` is for the report.
        shot.frame = Some(part);
        let (start, dt) = (
            shot.time_s + shot.contact_time_s,
            contact_time_s - shot.contact_time_s,
        );
        shot.contact_time_s = contact_time_s;
        let mut impulses = NO_IMPULSES;
        impulses[part.solid().index()] = self.impulse_since(&before, dt);
        self.observer
            .step(start, dt, (&before, &self.shot.state), impulses);
    }

    /// Contact in the world frame until the ball flies, goes on in the frame of a contact, is
    /// lodged, or the shot ends.
    fn contact_in_world<A: Solid<f64>, B: Solid<f64>>(
        &mut self,
        solids: (&A, &B),
    ) -> Option<Verdict> {
        let params = self.params;
        loop {
            let before = self.shot.state;
            let (mut after, mut friction) = (before, self.shot.friction);
            let [with_one_s, with_both_s] = self.limits.longest_world_steps_s;
            let on_both = self.shot.touching == [true; SolidId::COUNT];
            let contact = WorldContact {
                touching: self.shot.touching,
                step_s: if on_both { with_both_s } else { with_one_s },
                fraction: self.shot.step_fraction,
            };
            self.shot.steps += 1;
            if self.shot.steps >= self.limits.max_steps {
                return Some(self.shot.verdict(Ending::Unresolved, false));
            }
            let step = world_step(params, solids, &mut after, &mut friction, &contact);
            let touching = contact.touching;
            let approach = approach_in_world(params, solids, touching, (&before, &after), step.dt);
            self.shot.step_fraction = approach.fraction;
            if approach.repeats {
                self.shot.step_fraction *= step.dt / contact.step_s;
                continue;
            }
            let shot = &mut self.shot;
            (shot.state, shot.friction) = (after, friction);
            let ending = self.after_step(step.dt, &before, step.impulses);
            let shot = &mut self.shot;
            shot.rolling_time_s =
                world_frame_step::rolling_time(&shot.friction, shot.rolling_time_s, step.dt);
            if let Some(ending) = ending {
                let made = shot.crossing.is_made(params, &shot.state);
                return Some(shot.verdict(ending, made));
            }
            if is_lodged(shot.rolling_time_s, self.limits.lodged_after_s) {
                return Some(shot.verdict(Ending::Lodged, false));
            }
            let acts = [solids.0.acts(&after), solids.1.acts(&after)];
            let mut now = touching;
            for solid in SolidId::ALL {
                let i = solid.index();
                if touching[i] && (step.separates[i] || !acts[i]) {
                    now[i] = false;
                    self.separation(solid);
                }
                if approach.arrived[i] {
                    now[i] = true;
                    self.shot.contacts.push(solid);
                    self.shot.friction[i] = FrictionState::new(params);
                    let time_s = self.shot.time_s;
                    self.observer.touch(time_s, solid, &after);
                }
            }
            self.shot.set_touching(params, now);
            if self.shot.contact != ContactState::InWorld {
                return None;
            }
        }
    }

    /// Impulse per unit of mass of the only contact of a step: the change of velocity without that
    /// by gravity and air.
    fn impulse_since(&self, before: &BallState, dt: f64) -> Vec3<f64> {
        let (v, u) = (self.shot.state.velocity_m_s, before.velocity_m_s);
        let free = |v| self.params.ball.free_acceleration(v, before.spin_rad_s);
        v - u - (free(u) + free(v)) * (0.5 * dt)
    }

    fn after_step(&mut self, dt: f64, before: &BallState, impulses: Impulses) -> Option<Ending> {
        let shot = &mut self.shot;
        self.observer
            .step(shot.time_s, dt, (before, &shot.state), impulses);
        shot.time_s += dt;
        let was_below = before.position_m.z < 0.0;
        shot.crossing
            .after_step(self.params, was_below, &shot.state, true);
        let too_late = self.limits.time_limit_s < shot.time_s;
        ShotEndFlags::new(self.params, &shot.state, too_late).ending()
    }
}
