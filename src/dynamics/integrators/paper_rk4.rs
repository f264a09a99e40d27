//! The paper's integrator with its errata corrected: variable-step RK4 of Eqs. 16 and 17, with
//! friction by the sliding law alone.
//!
//! On the way into a contact the step is halved until it is `dt_min`. It stays there in contact,
//! and doubles on the way out up to `dt_max`. (This is the paper's tuned bisection. Its Table 1 is
//! lost; the text gives 0.015 and 0.0005 s.) Contact is detected only at the stages and ends of
//! steps, so a graze between them is missed. The errata of `docs/model.md` are applied: the sign of
//! u_B', the full moment of the ring's friction, friction only while N > 0, and no contact from
//! behind the board.

use crate::dynamics::end_rules::{ShotEndFlags, ShotLimits, fell_below_ring, flight_ending};
use crate::dynamics::flight::FlightPath;
use crate::dynamics::flight::height_crossing::falling_time;
use crate::dynamics::hoop_crossing::HoopCrossing;
use crate::dynamics::observer::{NO_IMPULSES, Observer};
use crate::dynamics::outcome::{ContactSequence, Ending, Verdict};
use crate::math::vector::{RealVector, Vec3};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::Solid;
use crate::model::{BallState, SolidId, StateDerivative};

/// The steps of the paper's method.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepRange {
    pub(crate) dt_max_s: f64,
    pub(crate) dt_min_s: f64,
}

/// The solids that press the ball (CONDB and CONDH of Eq. 17), by [`SolidId::index`].
#[derive(Clone, Copy, Debug, PartialEq)]
struct ActiveContacts([bool; SolidId::COUNT]);

impl ActiveContacts {
    fn new(params: &ModelParams, state: &BallState) -> Self {
        fn presses<S: Solid<f64>>(params: &ModelParams, solid: &S, state: &BallState) -> bool {
            let (gap, _) = solid.gap(&params.ball, state);
            gap < 0.0 && solid.acts(state)
        }
        Self([
            presses(params, &params.board, state),
            presses(params, &params.ring, state),
        ])
    }

    fn any(self) -> bool {
        self.0.contains(&true)
    }

    fn by(self, solid: SolidId) -> bool {
        self.0[solid.index()]
    }
}

/// Linear and angular acceleration that a solid gives a sliding ball.
fn sliding_response<S: Solid<f64>>(
    params: &ModelParams,
    solid: &S,
    state: &BallState,
) -> (Vec3<f64>, Vec3<f64>) {
    let (kinematics, [n, tangent_1, tangent_2]) = solid.contact(&params.ball, state);
    let normal = kinematics.normal_force(solid.material());
    let slip = kinematics.slip();
    let speed = slip.norm();
    let limit = solid.material().friction_coefficient * normal.max(0.0);
    let friction_per_slip = if speed > 0.0 { limit / speed } else { 0.0 };
    let (friction_1, friction_2) = (-friction_per_slip * slip.x, -friction_per_slip * slip.y);
    let lever_over_inertia = kinematics.lever * params.ball.mass_over_inertia;
    (
        n * normal + tangent_1 * friction_1 + tangent_2 * friction_2,
        tangent_1 * (lever_over_inertia * friction_2)
            - tangent_2 * (lever_over_inertia * friction_1),
    )
}

/// The right-hand side of Eq. 17, and the solids that press the ball there.
fn derivative(params: &ModelParams, state: &BallState) -> (StateDerivative, ActiveContacts) {
    let active = ActiveContacts::new(params, state);
    let mut linear = params
        .ball
        .free_acceleration(state.velocity_m_s, state.spin_rad_s);
    let mut angular = Vec3::zeros();
    for solid in SolidId::ALL {
        if !active.by(solid) {
            continue;
        }
        let (a, alpha) = match solid {
            SolidId::Board => sliding_response(params, &params.board, state),
            SolidId::Ring => sliding_response(params, &params.ring, state),
        };
        linear = linear + a;
        angular = angular + alpha;
    }
    let derivative = StateDerivative {
        velocity_m_s: state.velocity_m_s,
        acceleration_m_s2: linear,
        angular_acceleration_rad_s2: angular,
    };
    (derivative, active)
}

/// One RK4 step, and whether a contact was detected at any of its stages.
fn rk4(params: &ModelParams, state: &BallState, dt: f64) -> (BallState, bool) {
    let (k1, at_1) = derivative(params, state);
    let (k2, at_2) = derivative(params, &state.euler_step(&k1, 0.5 * dt));
    let (k3, at_3) = derivative(params, &state.euler_step(&k2, 0.5 * dt));
    let (k4, at_4) = derivative(params, &state.euler_step(&k3, dt));
    let detected = at_1.any() || at_2.any() || at_3.any() || at_4.any();
    (state.runge_kutta_step([&k1, &k2, &k3, &k4], dt), detected)
}

/// A running shot with its observer.
struct Run<'a, O> {
    params: &'a ModelParams,
    limits: &'a ShotLimits,
    observer: &'a mut O,
    state: BallState,
    time_s: f64,
    active: ActiveContacts,
    contacts: ContactSequence,
    crossing: HoopCrossing,
}

/// Simulates one shot to its end.
pub(crate) fn run<O: Observer>(
    params: &ModelParams,
    limits: &ShotLimits,
    steps: StepRange,
    start: BallState,
    observer: &mut O,
) -> Verdict {
    let mut run = Run {
        params,
        limits,
        observer,
        state: start,
        time_s: 0.0,
        active: ActiveContacts::new(params, &start),
        contacts: ContactSequence::default(),
        crossing: HoopCrossing::at_release(params, &start),
    };
    let mut dt = steps.dt_max_s;
    let ending = loop {
        let (next, detected) = rk4(params, &run.state, dt);
        let active = ActiveContacts::new(params, &next);
        if (detected || active.any()) && !run.active.any() && dt > steps.dt_min_s {
            dt = (0.5 * dt).max(steps.dt_min_s);
            continue;
        }
        if let Some(ending) = run.accept(next, active, dt) {
            break ending;
        }
        dt = if active.any() {
            steps.dt_min_s
        } else {
            (2.0 * dt).min(steps.dt_max_s)
        };
    };
    Verdict {
        made: ending == Ending::Fell && run.crossing.is_made(params, &run.state),
        ending,
        contacts: run.contacts,
        time_s: run.time_s,
    }
}

impl<O: Observer> Run<'_, O> {
    /// Takes a step of `dt` to the state `next`; returns how the shot ends with it, if it does.
    fn accept(&mut self, next: BallState, active: ActiveContacts, dt: f64) -> Option<Ending> {
        let params = self.params;
        let before = self.state;
        let fall = self.falling_time(&before);
        let path = FlightPath::new(&params.ball, &before);
        let falls = fell_below_ring(params, &next) && !self.active.any();
        if falls && fall <= dt {
            self.observer.flight(params, self.time_s, fall, &path);
        } else if self.active.any() {
            self.observer
                .step(self.time_s, dt, (&before, &next), NO_IMPULSES);
        } else {
            self.observer.flight(params, self.time_s, dt, &path);
        }
        let was_below = before.position_m.z < 0.0;
        self.crossing.after_step(params, was_below, &next, true);
        self.time_s += dt;
        self.report_changes(active, &next);
        self.state = next;
        self.active = active;
        let limit = self.limits.time_limit_s;
        let ending = ShotEndFlags::new(params, &next, limit < self.time_s).ending()?;
        if ending != Ending::Fell {
            return Some(ending);
        }
        if fell_below_ring(params, &before) {
            // It was released below the ring and has never risen.
            return Some(Ending::NeverRose);
        }
        // Where the last step crossed z = -reach, by the parabola of that step.
        if !active.any() && fall <= dt {
            self.state = path.state_after(fall);
            self.time_s += fall - dt;
        }
        Some(flight_ending(self.rises_above_ring(&before)))
    }

    /// Time at which a parabola from a state falls through z = -reach, s.
    fn falling_time(&self, state: &BallState) -> f64 {
        let (z, vz) = (state.position_m.z, state.velocity_m_s.z);
        falling_time(self.params, z, vz, -self.params.ring.reach)
    }

    /// Whether a parabola from a state reaches z = -reach.
    fn rises_above_ring(&self, state: &BallState) -> bool {
        let (z, vz) = (state.position_m.z, state.velocity_m_s.z);
        let reach = self.params.ring.reach;
        z > -reach || vz * vz + 2.0 * self.params.ball.gravity * (z + reach) > 0.0
    }

    fn report_changes(&mut self, active: ActiveContacts, state: &BallState) {
        for solid in SolidId::ALL {
            match (self.active.by(solid), active.by(solid)) {
                (false, true) => {
                    self.contacts.push(solid);
                    self.observer.touch(self.time_s, solid, state);
                }
                (true, false) => self.observer.separation(self.time_s, solid, state),
                _ => {}
            }
        }
    }
}
