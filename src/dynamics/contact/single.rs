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
use super::friction::{DIRECTION_SLIP_FRACTION, FrictionBalance, FrictionState, zero_slip_after};
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
pub(crate) struct SingleContactStep<T: Real> {
    /// Length of the step, s.
    pub(crate) dt: T,
    /// The ball has left the solid; it was moved to zero compression, and no time is counted.
    pub(crate) parted: T::Mask,
}

/// The derivative of the state under a normal and friction acceleration given along (n, 1, 2).
#[inline(always)]
fn derivative<T: Real, F: ContactFrame<T>>(
    params: &ModelParams<T>,
    state: &BallState<T>,
    (kinematics, frame): (&ContactKinematics<T>, F),
    contact: ContactVector<T>,
) -> StateDerivative<T> {
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
struct SlipDirection<T> {
    initial: Vec2<T>,
    /// Slip along the initial direction below which that direction is used.
    threshold: T,
}

/// The derivative at one stage of a step, in the mode that holds for the whole step.
#[inline(always)]
fn stage<T: Real, S: Solid<T>>(
    params: &ModelParams<T>,
    solid: &S,
    state: &BallState<T>,
    rolling: T::Mask,
    direction: SlipDirection<T>,
) -> StateDerivative<T> {
    let (kinematics, frame) = solid.contact(&params.ball, state);
    let normal = kinematics.normal_acceleration(solid.material());
    let limit = solid.material().friction_coefficient * normal.positive_part();
    let (slip, initial) = (kinematics.slip(), direction.initial);
    let has_direction = direction.threshold.lt(slip.dot(initial));
    // Friction as a fraction, for a single division. Sliding: mu N slip/|slip|. Rolling: the slip rate to
    // cancel over the slip rate that a unit of friction makes.
    let mut numerator = Vec2::new(
        limit * slip.x.select(has_direction, initial.x),
        limit * slip.y.select(has_direction, initial.y),
    );
    let mut denominator = slip.norm().select(has_direction, params.one());
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
fn remove_slip<T: Real, F: ContactFrame<T>>(
    params: &ModelParams<T>,
    state: &mut BallState<T>,
    (kinematics, frame): (&mut ContactKinematics<T>, F),
    impulse_per_slip: T,
    stuck: T::Mask,
) {
    let zero = params.zero();
    let slip = kinematics.slip();
    let impulse = Vec2::new(
        (-(impulse_per_slip * slip.x)).select(stuck, zero),
        (-(impulse_per_slip * slip.y)).select(stuck, zero),
    );
    let lever_over_inertia = kinematics.lever * params.ball.mass_over_inertia;
    let angular_impulse = Vec2::new(
        lever_over_inertia * impulse.y,
        -(lever_over_inertia * impulse.x),
    );
    kinematics.velocity.tangent = kinematics.velocity.tangent + impulse;
    kinematics.spin.tangent = kinematics.spin.tangent + angular_impulse;
    let one = params.one();
    let delta_velocity = frame.tangent_to_space(impulse);
    let delta_spin = frame.tangent_to_space(angular_impulse);
    state.velocity_m_s = state.velocity_m_s.add_scaled(delta_velocity, one);
    state.spin_rad_s = state.spin_rad_s.add_scaled(delta_spin, one);
}

/// Advances the ball in contact with `solid` by one step of at most `longest`, or finds that it has
/// parted.
///
/// `time_to_other` gives, for the state and the acceleration of the ball, the time until something outside this contact
/// (a touch of another solid) must end the step.
#[inline(always)]
pub(crate) fn step<T: Real, S: Solid<T>>(
    params: &ModelParams<T>,
    solid: &S,
    state: &mut BallState<T>,
    friction: &mut FrictionState<T>,
    longest: T,
    time_to_other: impl FnOnce(&BallState<T>, Vec3<T>) -> EventTime<T>,
) -> SingleContactStep<T> {
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
    let limit = material.friction_coefficient * normal.positive_part();
    let normal_acceleration = normal + kinematics.gravity.normal + kinematics.frame_acceleration();
    let force = NormalForce::new(material, &kinematics, normal, normal_acceleration);

    // 2. The direction of the slip (or the direction in which a stuck ball would slip), and friction.
    let slip_rate = kinematics.frictionless_slip_rate();
    let driving = slip_rate.select(stuck, slip);
    let driving_rate = driving.norm();
    let inverse_size = params.one() / driving_rate.select(driving_rate.is_positive(), params.one());
    let direction = Vec2::new(driving.x * inverse_size, driving.y * inverse_size);
    let required_friction = impulse_per_slip * driving_rate;
    let suffices = required_friction.le(limit);
    let loading = force.rate.is_positive();
    let rolling_failed = (friction.rolling_failed | (stuck & !suffices)) & !loading;
    let rolling = stuck & suffices & !rolling_failed;
    let slip_speed = params.zero().select(stuck, driving_rate);
    let stage_direction = SlipDirection {
        initial: direction,
        threshold: slip_speed * DIRECTION_SLIP_FRACTION,
    };
    let friction_size = -required_friction.select(rolling, limit);

    // 3. The step ends at the first event.
    let end_of_force = force.time_to_end(params, material, &kinematics);
    let balance = FrictionBalance {
        slip: slip_speed,
        slip_rate: slip_rate.dot(direction) - limit * slip_compliance,
        slip_compliance,
        friction_reserve: limit - required_friction,
        d_required_d_compression_acceleration: impulse_per_slip
            * kinematics.d_slip_rate_d_compression_rate(direction),
    };
    let change = balance.time_to_change(params, material.friction_coefficient, &force, rolling);
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
        rolling_failed,
        zero_slip: zero_slip_after(ends_slip, slip_speed, SLIP_ENDED_M_S),
    };
    SingleContactStep {
        dt: params.zero().select(parted, dt),
        parted,
    }
}

/// Moves a ball that has parted to zero compression, forwards or backwards.
#[inline(always)]
fn finish_parting<T: Real, S: Solid<T>>(
    params: &ModelParams<T>,
    solid: &S,
    state: &mut BallState<T>,
    (kinematics, frame): (&ContactKinematics<T>, S::Frame),
    parted: T::Mask,
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
