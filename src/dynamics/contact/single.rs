//! Contact with one solid: RK4 steps that end at contact events.
//!
//! A bounce slides, rolls, slides again and, where the normal force is negative just before the ball
//! separates, has no friction. The force has a kink or a jump at each change, so no step spans one. The times
//! until the slip reaches zero, rolling needs more than mu N, N reaches zero and the ball separates are
//! predicted from the derivatives at the start of the step. The step is the shortest of them.
//!
//! Sliding is the paper's law (Eqs. 3 and 13). Rolling is its exact limit (a Filippov solution on the surface of zero slip; the
//! paper's Appendix 2 approaches it by chattering): the friction that keeps the slip at zero.

use super::event_time::EventTime;
use super::friction::{
    DIRECTION_SLIP_FRACTION, FrictionBalance, FrictionState, slip_tolerance_after,
};
use super::normal_force::{NormalForce, SEPARATION_STEP_S, has_separated};
use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{ContactFrame, ContactKinematics, ContactVector, Solid};
use crate::model::{BallState, StateDerivative};

/// Lower bound of the slip tolerance after a step meant to end the slip, m/s: what the shortest step at
/// the strongest friction overshoots by.
const SLIP_ENDED_M_S: f64 = 2e-4;
/// Shortest step, s.
pub(super) const SHORTEST_STEP_S: f64 = 1e-9;

/// The result of one step.
pub(crate) struct SingleContactStep<T: Real> {
    /// Length of the step, s.
    pub(crate) dt: T,
    /// The ball has left the solid; it was moved to zero compression, and no time is counted.
    pub(crate) separated: T::Mask,
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
    let normal = kinematics.normal_force(solid.material());
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
            .inverse_effective_mass(&params.ball)
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
    at_zero_slip: T::Mask,
) {
    let zero = params.zero();
    let slip = kinematics.slip();
    let impulse = Vec2::new(
        (-(impulse_per_slip * slip.x)).select(at_zero_slip, zero),
        (-(impulse_per_slip * slip.y)).select(at_zero_slip, zero),
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
/// separated.
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
    let separated = has_separated(&kinematics);
    if separated.all() {
        finish_separation(params, solid, state, (&kinematics, frame), separated);
        return SingleContactStep {
            dt: params.zero(),
            separated,
        };
    }

    // 1. Which balls stick: those that roll, and those whose slip has ended.
    let slip = kinematics.slip();
    let at_zero_slip =
        (friction.rolling | slip.norm_squared().le(friction.slip_tolerance.squared())) & !separated;
    let inverse_effective_mass = kinematics.inverse_effective_mass(&params.ball);
    // Only contacts at zero slip need it.
    let mut impulse_per_slip = params.one();
    if at_zero_slip.any() {
        impulse_per_slip = params.one() / inverse_effective_mass;
        remove_slip(
            params,
            state,
            (&mut kinematics, frame),
            impulse_per_slip,
            at_zero_slip,
        );
    }
    let normal = kinematics.normal_force(material);
    let limit = material.friction_coefficient * normal.positive_part();
    let normal_acceleration = normal + kinematics.gravity.normal + kinematics.frame_acceleration();
    let force = NormalForce::new(material, &kinematics, normal, normal_acceleration);

    // 2. The direction of the slip (or the direction in which a ball at zero slip would slip), and friction.
    let slip_rate = kinematics.frictionless_slip_rate();
    let slip_or_slip_rate = slip_rate.select(at_zero_slip, slip);
    let slip_or_slip_rate_size = slip_or_slip_rate.norm();
    let inverse_size = params.one()
        / slip_or_slip_rate_size.select(slip_or_slip_rate_size.is_positive(), params.one());
    let direction = Vec2::new(
        slip_or_slip_rate.x * inverse_size,
        slip_or_slip_rate.y * inverse_size,
    );
    let required_friction = impulse_per_slip * slip_or_slip_rate_size;
    let suffices = required_friction.le(limit);
    let loading = force.rate.is_positive();
    let rolling_failed = (friction.rolling_failed | (at_zero_slip & !suffices)) & !loading;
    let rolling = at_zero_slip & suffices & !rolling_failed;
    let slip_speed = params.zero().select(at_zero_slip, slip_or_slip_rate_size);
    let stage_direction = SlipDirection {
        initial: direction,
        threshold: slip_speed * DIRECTION_SLIP_FRACTION,
    };
    let friction_along_direction = -required_friction.select(rolling, limit);

    // 3. The step ends at the first event.
    let end_of_force = force.time_to_end(params, material, &kinematics);
    let balance = FrictionBalance {
        slip: slip_speed,
        slip_rate: slip_rate.dot(direction) - limit * inverse_effective_mass,
        inverse_effective_mass,
        friction_reserve: limit - required_friction,
        d_required_d_compression_rate: impulse_per_slip
            * kinematics.d_slip_rate_d_compression_rate(direction),
    };
    let change = balance.time_to_change(params, material.friction_coefficient, &force, rolling);
    let contact = ContactVector {
        normal,
        tangent: Vec2::new(
            friction_along_direction * direction.x,
            friction_along_direction * direction.y,
        ),
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

    if separated.any() {
        finish_separation(params, solid, state, (&kinematics, frame), separated);
    }
    *state = state.select(separated, next);
    *friction = FrictionState {
        rolling,
        rolling_failed,
        slip_tolerance: slip_tolerance_after(ends_slip, slip_speed, SLIP_ENDED_M_S),
    };
    SingleContactStep {
        dt: params.zero().select(separated, dt),
        separated,
    }
}

/// Moves a ball that has separated to zero compression, forwards or backwards.
#[inline(always)]
fn finish_separation<T: Real, S: Solid<T>>(
    params: &ModelParams<T>,
    solid: &S,
    state: &mut BallState<T>,
    (kinematics, frame): (&ContactKinematics<T>, S::Frame),
    separated: T::Mask,
) {
    let max_shift_s = params.splat(SEPARATION_STEP_S);
    let dt = kinematics.compression / kinematics.velocity.normal.select(separated, params.one());
    let dt = Real::max(Real::min(dt, max_shift_s), -max_shift_s).select(separated, params.zero());
    let contact = ContactVector {
        normal: kinematics.normal_force(solid.material()),
        tangent: Vec2::splat(params.zero()),
    };
    let last = derivative(params, state, (kinematics, frame), contact);
    *state = state.euler_step(&last, dt);
}
