//! Contact with one solid: RK4 steps that end on the events of friction.
//!
//! A bounce slides, rolls, slides again and, where the normal force is negative just before the ball
//! parts, has no friction. The force has a kink or a jump at each change, so no step spans one. The times
//! until the slip reaches zero, rolling needs more than mu N, N reaches zero and the ball parts are
//! predicted from the derivatives at the start of the step. The step is the shortest of them.
//!
//! Sliding is the paper's law (Eqs. 3 and 13). Rolling is its exact limit (a Filippov sliding mode; the
//! paper's Appendix 2 approaches it by chattering): the friction that keeps the slip at zero.

use super::event_time::EventTime;
use super::friction::{FrictionBalance, FrictionState, SLIP_DIRECTION_LOST, zero_slip_after};
use super::normal_force::{NormalForce, PARTING_STEP_S, has_parted};
use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::model_params::ModelParams;
use crate::model::solids::{ContactFrame, ContactKinematics, ContactVector, Solid};
use crate::model::{BallState, StateDerivative};

/// Least slip speed that counts as zero after a step meant to end the slip, m/s: what the shortest step at
/// the strongest friction overshoots by.
const SLIP_ENDED_M_S: f64 = 2e-4;
/// Shortest step, s.
pub(super) const SHORTEST_STEP_S: f64 = 1e-9;

/// The result of one step.
pub(crate) struct SingleContactStep<R: Real> {
    /// Length of the step, s.
    pub(crate) dt: R,
    /// The ball has left the solid; it was moved to zero compression, and no time is counted.
    pub(crate) parted: R::Mask,
}

/// The derivative of the state under a normal and friction acceleration given along (n, 1, 2).
#[inline(always)]
fn derivative<R: Real, F: ContactFrame<R>>(
    params: &ModelParams<R>,
    state: &BallState<R>,
    (kinematics, frame): (&ContactKinematics<R>, F),
    contact: ContactVector<R>,
) -> StateDerivative<R> {
    let a = frame.to_space(contact);
    let lever_over_inertia = kinematics.lever * params.ball.mass_over_inertia;
    let torque = Vec2::new(
        lever_over_inertia * contact.tangent.y,
        -(lever_over_inertia * contact.tangent.x),
    );
    StateDerivative {
        velocity_m_s: state.velocity_m_s,
        acceleration_m_s2: Vec3::new(a.x, a.y, a.z - params.ball.gravity),
        angular_acceleration_rad_s2: frame.tangent_to_space(torque),
    }
}

/// The direction that counts as that of the slip within one step.
#[derive(Clone, Copy)]
struct SlipDirection<R> {
    initial: Vec2<R>,
    /// Slip along the initial direction below which that direction is used.
    threshold: R,
}

/// The derivative at one stage of a step, in the mode that holds for the whole step.
#[inline(always)]
fn stage<R: Real, S: Solid<R>>(
    params: &ModelParams<R>,
    solid: &S,
    state: &BallState<R>,
    rolling: R::Mask,
    direction: SlipDirection<R>,
) -> StateDerivative<R> {
    let (kinematics, frame) = solid.contact(&params.ball, state);
    let normal = kinematics.normal_acceleration(solid.material());
    let limit = solid.material().friction * normal.positive_part();
    let (slip, initial) = (kinematics.slip(), direction.initial);
    let clear = direction.threshold.lt(slip.dot(initial));
    // Friction as a fraction, for a single division. Sliding: mu N slip/|slip|. Rolling: the slip rate to
    // cancel over the slip rate that a unit of friction makes.
    let mut numerator = Vec2::new(
        limit * slip.x.select(clear, initial.x),
        limit * slip.y.select(clear, initial.y),
    );
    let mut denominator = slip.norm().select(clear, params.one());
    if rolling.any() {
        numerator = kinematics
            .frictionless_slip_rate()
            .select(rolling, numerator);
        denominator = kinematics
            .slip_compliance(&params.ball)
            .select(rolling, denominator);
    }
    let factor = -(params.one() / denominator);
    let contact = ContactVector {
        normal,
        tangent: Vec2::new(factor * numerator.x, factor * numerator.y),
    };
    derivative(params, state, (&kinematics, frame), contact)
}

/// Removes the slip by friction's own impulse. The angular momentum about the contact point is kept.
#[inline(always)]
fn remove_slip<R: Real, F: ContactFrame<R>>(
    params: &ModelParams<R>,
    state: &mut BallState<R>,
    (kinematics, frame): (&mut ContactKinematics<R>, F),
    impulse_per_slip: R,
    stuck: R::Mask,
) {
    let zero = params.zero();
    let slip = kinematics.slip();
    let impulse = Vec2::new(
        (-(impulse_per_slip * slip.x)).select(stuck, zero),
        (-(impulse_per_slip * slip.y)).select(stuck, zero),
    );
    let lever_over_inertia = kinematics.lever * params.ball.mass_over_inertia;
    let turn = Vec2::new(
        lever_over_inertia * impulse.y,
        -(lever_over_inertia * impulse.x),
    );
    kinematics.velocity.tangent = kinematics.velocity.tangent + impulse;
    kinematics.spin.tangent = kinematics.spin.tangent + turn;
    let one = params.one();
    let dv = frame.tangent_to_space(impulse);
    let dw = frame.tangent_to_space(turn);
    state.velocity_m_s = state.velocity_m_s.add_scaled(dv, one);
    state.spin_rad_s = state.spin_rad_s.add_scaled(dw, one);
}

/// Advances the ball in contact with `solid` by one step of at most `longest`, or finds that it has
/// parted.
///
/// `time_to_other` gives, for the state and the acceleration of the ball, the time until something outside this contact
/// (a touch of another solid) must end the step.
#[inline(always)]
pub(crate) fn step<R: Real, S: Solid<R>>(
    params: &ModelParams<R>,
    solid: &S,
    state: &mut BallState<R>,
    friction: &mut FrictionState<R>,
    longest: R,
    time_to_other: impl FnOnce(&BallState<R>, Vec3<R>) -> EventTime<R>,
) -> SingleContactStep<R> {
    let material = solid.material();
    let (mut kinematics, frame) = solid.contact(&params.ball, state);
    let parted = has_parted(&kinematics);
    if parted.all() {
        finish_parting(params, solid, state, (&kinematics, frame), parted);
        return SingleContactStep {
            dt: params.zero(),
            parted,
        };
    }

    // 1. Which balls stick: those that roll, and those whose slip has ended.
    let slip = kinematics.slip();
    let stuck = (friction.rolling | slip.norm_squared().le(friction.zero_slip.squared())) & !parted;
    let slip_compliance = kinematics.slip_compliance(&params.ball);
    // Only stuck contacts need it.
    let mut impulse_per_slip = params.one();
    if stuck.any() {
        impulse_per_slip = params.one() / slip_compliance;
        remove_slip(
            params,
            state,
            (&mut kinematics, frame),
            impulse_per_slip,
            stuck,
        );
    }
    let normal = kinematics.normal_acceleration(material);
    let limit = material.friction * normal.positive_part();
    let normal_acceleration = normal + kinematics.gravity.normal + kinematics.frame_acceleration();
    let force = NormalForce::new(material, &kinematics, normal, normal_acceleration);

    // 2. The direction of the slip (or the direction in which a stuck ball would slip), and friction.
    let slip_rate = kinematics.frictionless_slip_rate();
    let driving = slip_rate.select(stuck, slip);
    let driving_size = driving.norm();
    let per_size = params.one() / driving_size.select(driving_size.is_positive(), params.one());
    let direction = Vec2::new(driving.x * per_size, driving.y * per_size);
    let need = impulse_per_slip * driving_size;
    let suffices = need.le(limit);
    let loading = force.rate.is_positive();
    let exceeded = (friction.exceeded | (stuck & !suffices)) & !loading;
    let rolling = stuck & suffices & !exceeded;
    let slip_speed = params.zero().select(stuck, driving_size);
    let stage_direction = SlipDirection {
        initial: direction,
        threshold: slip_speed * SLIP_DIRECTION_LOST,
    };
    let friction_size = -need.select(rolling, limit);

    // 3. The step ends at the first event.
    let end_of_force = force.time_to_end(params, material, &kinematics);
    let balance = FrictionBalance {
        slip: slip_speed,
        slip_rate: slip_rate.dot(direction) - limit * slip_compliance,
        slip_compliance,
        reserve: limit - need,
        d_need_d_compression_acceleration: impulse_per_slip
            * kinematics.d_slip_rate_d_compression_rate(direction),
    };
    let change = balance.time_to_change(params, material.friction, &force, rolling);
    let contact = ContactVector {
        normal,
        tangent: Vec2::new(friction_size * direction.x, friction_size * direction.y),
    };
    let k1 = derivative(params, state, (&kinematics, frame), contact);
    let end = end_of_force
        .min(time_to_other(state, k1.acceleration_m_s2))
        .at_most(longest);
    let ends_slip = change.le(end) & !rolling;
    let dt = Real::max(change.min(end).time(), params.splat(SHORTEST_STEP_S));

    // 4. The classical RK4 step.
    let half = dt * 0.5;
    let k2 = stage(
        params,
        solid,
        &state.euler_step(&k1, half),
        rolling,
        stage_direction,
    );
    let k3 = stage(
        params,
        solid,
        &state.euler_step(&k2, half),
        rolling,
        stage_direction,
    );
    let k4 = stage(
        params,
        solid,
        &state.euler_step(&k3, dt),
        rolling,
        stage_direction,
    );
    let next = state.runge_kutta_step([&k1, &k2, &k3, &k4], dt);

    if parted.any() {
        finish_parting(params, solid, state, (&kinematics, frame), parted);
    }
    *state = state.select(parted, next);
    *friction = FrictionState {
        rolling,
        exceeded,
        zero_slip: zero_slip_after(ends_slip, slip_speed, SLIP_ENDED_M_S),
    };
    SingleContactStep {
        dt: params.zero().select(parted, dt),
        parted,
    }
}

/// Moves a ball that has parted to zero compression, forwards or backwards.
#[inline(always)]
fn finish_parting<R: Real, S: Solid<R>>(
    params: &ModelParams<R>,
    solid: &S,
    state: &mut BallState<R>,
    (kinematics, frame): (&ContactKinematics<R>, S::Frame),
    parted: R::Mask,
) {
    let most = params.splat(PARTING_STEP_S);
    let dt = kinematics.compression / kinematics.velocity.normal.select(parted, params.one());
    let dt = Real::max(Real::min(dt, most), -most).select(parted, params.zero());
    let contact = ContactVector {
        normal: kinematics.normal_acceleration(solid.material()),
        tangent: Vec2::splat(params.zero()),
    };
    let last = derivative(params, state, (kinematics, frame), contact);
    *state = state.euler_step(&last, dt);
}
