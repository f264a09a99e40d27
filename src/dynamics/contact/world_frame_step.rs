//! Contact in the world frame, in long steps: with two solids at once, or with any part of one.
//!
//! Both normal forces obey linear equations as long as their directions and what does not depend on
//! them are constant ([`super::coupled_oscillators`]). The motion with these forces is the base of
//! a step. What they leave out (the turning of the frames, the direction of the slip, the friction
//! of rolling, the change of drag) is the remainder: an acceleration, evaluated in the middle and
//! at the end of the step, that acts on the base as two changes of velocity with Simpson's
//! weights (at the start it is zero). The base responds to the first of them through the same
//! linear equations.
//!
//! A step ends at the first event of either contact: its slip or its roll ends, its force reaches
//! zero, the ball parts. A solid that the ball does not touch has no stiffness, no damping and no
//! friction.

use super::contact_pair::{ContactPair, FIRST, Response, SECOND, for_both};
use super::coupled_oscillators::{CoupledOscillators, CoupledStart, SlipModel};
use super::friction::{DIRECTION_SLIP_FRACTION, FrictionState, SLIP_TOLERANCE_M_S};
use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{ContactVector, Solid};

/// A step meant to end the slip may leave this fraction of it, and this much (m/s): the other
/// contact turns the slip as it decreases. An impulse of friction then sets the rest to zero.
const SLIP_REMAINDER: (f64, f64) = (0.2, 1e-3);
/// Shortest step, as a fraction of the longest. (Otherwise two sliding contacts could stop each
/// other's slip in ever shorter steps.)
const SHORTEST_STEP: f64 = 2e-4;

/// The result of one step.
pub(crate) struct WorldContactStep<T: Real> {
    /// Length of the step, s.
    pub(crate) dt: T,
    /// Whether the ball leaves each solid at the end of the step.
    pub(crate) separates: [T::Mask; 2],
    /// Impulses of both contacts per unit of mass, m/s.
    pub(crate) impulses: [Vec3<T>; 2],
}

/// How friction acts at both contacts throughout a step.
struct FrictionMode<T: Real> {
    rolling: [T::Mask; 2],
    /// Contacts at zero slip that cannot roll from now on.
    fails_now: [T::Mask; 2],
    /// Contacts that slide, but so slowly that friction acts against the direction in which they
    /// would slip without it.
    slip_follows_rate: [T::Mask; 2],
    /// Friction at the start.
    frictions: [Vec2<T>; 2],
    /// Slips at the start, 0 where they have ended.
    slip_speeds: [T; 2],
    /// Directions of the slips, or in which the contacts would slip.
    directions: [Vec2<T>; 2],
}

/// The forces of a step as if their directions did not change.
struct BaseForces<T: Real> {
    /// The acceleration by gravity and air.
    free: Vec3<T>,
    oscillators: CoupledOscillators<T>,
    /// Acceleration for a unit of each normal force, with the sliding friction that goes with it.
    per_force: [Response<T>; 2],
    /// The part of it by sliding friction.
    sliding: [Response<T>; 2],
    /// Acceleration by the friction of rolling contacts.
    rolling: [Response<T>; 2],
}

/// Where a step ends.
struct StepEnd<T: Real> {
    /// In units of the longest step.
    tau: T,
    separates: [T::Mask; 2],
    /// Where the force of each contact ends: before the compression of an outgoing ball does.
    zero_force: [T; 2],
    ends_slip: [T::Mask; 2],
}

/// The solids that a ball touches, and the limits of its next step.
#[derive(Clone, Copy)]
pub(crate) struct WorldContact<T: Real> {
    /// Whether the ball touches each solid.
    pub(crate) touching: [T::Mask; 2],
    /// The longest step, s, and the fraction of it that this one takes at most.
    pub(crate) step_s: T,
    pub(crate) fraction: T,
}

/// Advances a ball in contact by one step.
#[inline(always)]
pub(crate) fn step<T: Real, A: Solid<T>, B: Solid<T>>(
    params: &ModelParams<T>,
    solids: (&A, &B),
    state: &mut BallState<T>,
    friction: &mut [FrictionState<T>; 2],
    contact: &WorldContact<T>,
) -> WorldContactStep<T> {
    let WorldContact {
        touching, step_s, ..
    } = *contact;
    let mut pair = ContactPair::new(params, solids, state, touching);
    // Slips that have ended are set to zero by an impulse of friction.
    let at_zero_slip = for_both!(i => {
        let slip = pair.kinematics[i].slip();
        let is_small = slip.norm_squared().le(friction[i].slip_tolerance.squared());
        touching[i] & (friction[i].rolling | is_small)
    });
    let mut impulses = [Vec3::splat(params.zero()); 2];
    if (at_zero_slip[FIRST] | at_zero_slip[SECOND]).any() {
        impulses = remove_slips(params, state, &mut pair, at_zero_slip);
    }
    let mode = FrictionMode::new(params, &pair, friction, at_zero_slip, step_s);
    let free = params
        .ball
        .free_acceleration(state.velocity_m_s, state.spin_rad_s);
    let base = BaseForces::new(params, &pair, &mode, free, step_s);
    let end = first_event(params, &pair, &mode, &base, contact);
    let (dt, half) = (end.tau * step_s, end.tau * 0.5);

    // The remainder in the middle, and at the end. The end is predicted with twice the remainder of
    // the middle (Kutta's third-order rule).
    let middle = base.advance(state, half);
    let on = (solids, touching);
    let at_middle = remainder(params, on, &middle, &mode, &base, half);
    let mut rest = sum(at_middle[FIRST], at_middle[SECOND]);
    if params.ball.has_air {
        rest.0 = rest.0 + base.change_of_free_acceleration(params, &middle);
    }
    let mut next = base.advance(state, end.tau);
    let mut last = next;
    last.position_m = last.position_m.add_scaled(rest.0, dt * dt * (1.0 / 3.0));
    kick(&mut last, rest, dt * 2.0);
    let at_end = remainder(params, on, &last, &mode, &base, end.tau);

    // The base, the kick in the middle with the forces that it causes, and the kick at the end.
    let (weight_middle, weight_end) = (dt * (4.0 / 6.0), dt * (1.0 / 6.0));
    next.position_m = next.position_m.add_scaled(rest.0, weight_middle * dt * 0.5);
    kick(&mut next, rest, weight_middle);
    let caused = base.after_kick(params, &pair, rest.0, weight_middle);
    if params.ball.has_air {
        let change = base.change_of_free_acceleration(params, &last);
        next.velocity_m_s = next.velocity_m_s.add_scaled(change, weight_end);
    }
    for i in [FIRST, SECOND] {
        let (impulse, path) = caused.impulse_and_displacement(i, half);
        let (linear, angular) = base.per_force[i];
        next.position_m = next.position_m.add_scaled(linear, path);
        kick(&mut next, (linear, angular), impulse);
        kick(&mut next, at_end[i], weight_end);
        let (base_impulse, _) = base.oscillators.impulse_and_displacement(i, end.tau);
        impulses[i] = impulses[i]
            .add_scaled(linear, base_impulse + impulse)
            .add_scaled(base.rolling[i].0, dt)
            .add_scaled(at_middle[i].0, weight_middle)
            .add_scaled(at_end[i].0, weight_end);
        let pulls = end.zero_force[i].lt(end.tau);
        if pulls.any() {
            // Without the sliding friction that the base has while N is negative.
            let (at_zero_force, _) = base
                .oscillators
                .impulse_and_displacement(i, end.zero_force[i]);
            let negative = (at_zero_force - base_impulse).select(pulls, params.zero());
            kick(&mut next, base.sliding[i], negative);
            impulses[i] = impulses[i].add_scaled(base.sliding[i].0, negative);
        }
    }
    *state = next;
    for i in [FIRST, SECOND] {
        let (fraction, min_remainder) = SLIP_REMAINDER;
        let left = Real::max(mode.slip_speeds[i] * fraction, params.splat(min_remainder));
        let failed = friction[i].rolling_failed | mode.fails_now[i];
        friction[i] = FrictionState {
            rolling: mode.rolling[i],
            rolling_failed: failed & !base.oscillators.is_loading(i),
            slip_tolerance: left.select(end.ends_slip[i], params.splat(SLIP_TOLERANCE_M_S)),
        };
    }
    WorldContactStep {
        dt,
        separates: end.separates,
        impulses,
    }
}

impl<T: Real> FrictionMode<T> {
    /// A contact at zero slip rolls if its friction suffices. If it does not suffice for one, that
    /// one slides, and the other is solved for again.
    #[inline(always)]
    fn new(
        params: &ModelParams<T>,
        pair: &ContactPair<T>,
        friction: &[FrictionState<T>; 2],
        at_zero_slip: [T::Mask; 2],
        step_s: T,
    ) -> Self {
        let slips = for_both!(i => pair.kinematics[i].slip());
        let sizes = for_both!(i => slips[i].norm());
        let limits = for_both!(i => pair.friction_limit(i));
        let failed = for_both!(i => friction[i].rolling_failed);
        let against_slip = for_both!(i => {
            friction_against(limits[i], unit(slips[i], sizes[i]))
        });
        // The friction that rolling would need. Just after a roll has failed the slip is tiny, and
        // turns against this faster than a step resolves.
        let candidates = for_both!(i => at_zero_slip[i] | failed[i]);
        let required = pair.frictions(params, candidates, against_slip);
        let follows = for_both!(i => {
            let rate = required[i].norm() * pair.kinematics[i].inverse_effective_mass(&params.ball);
            at_zero_slip[i] | (failed[i] & sizes[i].le(rate * step_s * 0.5))
        });
        let directions = for_both!(i => {
            let against_required = unit(-required[i], required[i].norm());
            against_required.select(follows[i], unit(slips[i], sizes[i]))
        });
        let sliding = for_both!(i => friction_against(limits[i], directions[i]));
        let mut rolling = for_both!(i => at_zero_slip[i] & !failed[i]);
        let mut fails_now = [params.splat_mask(false); 2];
        let mut frictions = required;
        if (failed[FIRST] | failed[SECOND]).any() {
            frictions = pair.frictions(params, rolling, sliding);
        }
        // At most two passes: each ends the roll of one contact.
        loop {
            let [first, second] = for_both!(i => {
                let excess = frictions[i].norm() - limits[i];
                excess.select(rolling[i], -params.ball.never_s)
            });
            let fails = [
                second.le(first) & first.is_positive(),
                first.lt(second) & second.is_positive(),
            ];
            if !(fails[FIRST] | fails[SECOND]).any() {
                break;
            }
            for i in [FIRST, SECOND] {
                rolling[i] = rolling[i] & !fails[i];
                fails_now[i] = fails_now[i] | fails[i];
            }
            frictions = pair.frictions(params, rolling, sliding);
        }
        Self {
            rolling,
            fails_now,
            frictions,
            slip_follows_rate: for_both!(i => follows[i] & !rolling[i]),
            slip_speeds: for_both!(i => params.zero().select(candidates[i], sizes[i])),
            directions,
        }
    }
}

impl<T: Real> BaseForces<T> {
    #[inline(always)]
    fn new(
        params: &ModelParams<T>,
        pair: &ContactPair<T>,
        mode: &FrictionMode<T>,
        free: Vec3<T>,
        step_s: T,
    ) -> Self {
        let zero = params.zero();
        let none = Vec2::splat(zero);
        let sliding = for_both!(i => {
            let slides = pair.normal_forces[i].is_positive() & !mode.rolling[i];
            let mu = pair.materials[i].friction_coefficient;
            let against = friction_against(mu, mode.directions[i]);
            pair.response_to_friction(i, against.select(slides, none))
        });
        let per_force = for_both!(i => (pair.axes[i][0] + sliding[i].0, sliding[i].1));
        let rolling = for_both!(i => {
            pair.response_to_friction(i, mode.frictions[i].select(mode.rolling[i], none))
        });
        let start = CoupledStart {
            materials: &pair.materials,
            coupling: for_both!(i => pair.axes[i][0].dot(per_force[1 - i].0)),
            compressions: for_both!(i => pair.kinematics[i].compression),
            velocities: for_both!(i => pair.kinematics[i].velocity.normal),
            accelerations: for_both!(i => {
                let kinematics = &pair.kinematics[i];
                kinematics.gravity.normal
                    + kinematics.frame_acceleration()
                    + pair.axes[i][0].dot(rolling[1 - i].0)
            }),
        };
        Self {
            free,
            oscillators: CoupledOscillators::new(step_s, &start),
            per_force,
            sliding,
            rolling,
        }
    }

    /// The state at `tau` with these forces.
    #[inline(always)]
    fn advance(&self, from: &BallState<T>, tau: T) -> BallState<T> {
        let dt = tau * self.oscillators.step_s();
        let half_square = dt * dt * 0.5;
        let mut state = BallState {
            position_m: from
                .position_m
                .add_scaled(from.velocity_m_s, dt)
                .add_scaled(self.free, half_square),
            velocity_m_s: from.velocity_m_s.add_scaled(self.free, dt),
            spin_rad_s: from.spin_rad_s,
        };
        for i in [FIRST, SECOND] {
            let (impulse, path) = self.oscillators.impulse_and_displacement(i, tau);
            let ((linear, angular), rolling) = (self.per_force[i], self.rolling[i]);
            state.position_m = state
                .position_m
                .add_scaled(linear, path)
                .add_scaled(rolling.0, half_square);
            state.velocity_m_s = state
                .velocity_m_s
                .add_scaled(linear, impulse)
                .add_scaled(rolling.0, dt);
            state.spin_rad_s = state
                .spin_rad_s
                .add_scaled(angular, impulse)
                .add_scaled(rolling.1, dt);
        }
        state
    }

    /// How much the acceleration by gravity and air has changed since the start of the step.
    #[inline(always)]
    fn change_of_free_acceleration(
        &self,
        params: &ModelParams<T>,
        state: &BallState<T>,
    ) -> Vec3<T> {
        params
            .ball
            .free_acceleration(state.velocity_m_s, state.spin_rad_s)
            - self.free
    }

    /// The normal forces that follow from a kick of `linear` times `dt`.
    #[inline(always)]
    fn after_kick(
        &self,
        params: &ModelParams<T>,
        pair: &ContactPair<T>,
        linear: Vec3<T>,
        dt: T,
    ) -> CoupledOscillators<T> {
        let zero = params.zero();
        let start = CoupledStart {
            materials: &pair.materials,
            coupling: for_both!(i => pair.axes[i][0].dot(self.per_force[1 - i].0)),
            compressions: [zero; 2],
            velocities: for_both!(i => pair.axes[i][0].dot(linear) * dt),
            accelerations: [zero; 2],
        };
        CoupledOscillators::new(self.oscillators.step_s(), &start)
    }
}

/// The first event of a step.
#[inline(always)]
fn first_event<T: Real>(
    params: &ModelParams<T>,
    pair: &ContactPair<T>,
    mode: &FrictionMode<T>,
    base: &BaseForces<T>,
    contact: &WorldContact<T>,
) -> StepEnd<T> {
    let one = params.one();
    let oscillators = &base.oscillators;
    let parting = for_both!(i => oscillators.compression_series(i));
    let separates = for_both!(i => parting[i].first_root(one, contact.touching[i]));
    let until = Real::min(separates[FIRST].1, separates[SECOND].1);
    // An outgoing ball reaches zero force this much before zero compression.
    let relaxation = for_both!(i => pair.materials[i].relaxation_time / oscillators.step_s());
    let zero_force = for_both!(i => {
        let earlier = (separates[i].1 - relaxation[i]).positive_part();
        earlier.select(separates[i].0, one)
    });
    let changing = for_both!(i => {
        let kinematics = &pair.kinematics[i];
        let (direction, speed) = (mode.directions[i], mode.slip_speeds[i]);
        let per_vn = kinematics.slip_rate_per_vn().dot(direction);
        let from_rolling = pair.slip_rate(i, base.rolling[1 - i]);
        let still = kinematics.frictionless_slip_rate() + from_rolling;
        let slip = SlipModel {
            speed,
            rate: still.dot(direction) - per_vn * kinematics.velocity.normal,
            per_vn,
            per_force: [
                pair.slip_rate(i, base.per_force[FIRST]).dot(direction),
                pair.slip_rate(i, base.per_force[SECOND]).dot(direction),
            ],
        };
        let mu = pair.materials[i].friction_coefficient;
        // What rolling needs is hard to predict with two contacts; its limit is not.
        let reserve = oscillators.force_series(i, mu, mode.frictions[i].norm());
        reserve.select(mode.rolling[i], &oscillators.slip_series(i, &slip))
    });
    let changes = for_both!(i => {
        let slides = mode.slip_speeds[i].is_positive() & pair.normal_forces[i].is_positive();
        changing[i].first_root(Real::min(until, zero_force[i]), mode.rolling[i] | slides)
    });
    let change = Real::min(changes[FIRST].1, changes[SECOND].1);
    let tau = Real::min(until, change);
    let at = |event: &(T::Mask, T)| event.0 & event.1.le(tau);
    let [first_parts, second_parts] = [at(&separates[FIRST]), at(&separates[SECOND])];
    let [first_changes, second_changes] = [at(&changes[FIRST]), at(&changes[SECOND])];
    let any = first_parts | second_parts | first_changes | second_changes;
    let mut refined = tau;
    if any.any() {
        let earliest = parting[FIRST]
            .select(first_parts, &parting[SECOND])
            .select(first_parts | second_parts, &changing[FIRST])
            .select(
                first_parts | second_parts | first_changes,
                &changing[SECOND],
            );
        refined = earliest.refined_root(tau).select(any, tau);
    }
    let cut = contact.fraction.lt(refined);
    StepEnd {
        tau: Real::max(contact.fraction.select(cut, refined), one * SHORTEST_STEP),
        separates: [first_parts & !cut, second_parts & !cut],
        zero_force,
        ends_slip: [
            first_changes & !mode.rolling[FIRST] & !cut,
            second_changes & !mode.rolling[SECOND] & !cut,
        ],
    }
}

/// A vector of the length `size` as a vector of the length one.
#[inline(always)]
fn unit<T: Real>(vector: Vec2<T>, size: T) -> Vec2<T> {
    let inverse = size.one() / size.select(size.is_positive(), size.one());
    Vec2::new(vector.x * inverse, vector.y * inverse)
}

/// Friction of the size `limit` against a direction of slip.
#[inline(always)]
fn friction_against<T: Real>(limit: T, direction: Vec2<T>) -> Vec2<T> {
    Vec2::new(-(limit * direction.x), -(limit * direction.y))
}

#[inline(always)]
fn sum<T: Real>(a: Response<T>, b: Response<T>) -> Response<T> {
    (a.0 + b.0, a.1 + b.1)
}

/// Adds an acceleration times `dt` to the velocities.
#[inline(always)]
fn kick<T: Real>(state: &mut BallState<T>, (linear, angular): Response<T>, dt: T) {
    state.velocity_m_s = state.velocity_m_s.add_scaled(linear, dt);
    state.spin_rad_s = state.spin_rad_s.add_scaled(angular, dt);
}

/// The forces of each contact at a stage minus those of the base.
#[inline(always)]
fn remainder<T: Real, A: Solid<T>, B: Solid<T>>(
    params: &ModelParams<T>,
    on: ((&A, &B), [T::Mask; 2]),
    state: &BallState<T>,
    mode: &FrictionMode<T>,
    base: &BaseForces<T>,
    tau: T,
) -> [Response<T>; 2] {
    tau.outlined(
        #[inline(always)]
        || remainder_at(params, on, state, mode, base, tau),
    )
}

#[inline(always)]
fn remainder_at<T: Real, A: Solid<T>, B: Solid<T>>(
    params: &ModelParams<T>,
    (solids, touching): ((&A, &B), [T::Mask; 2]),
    state: &BallState<T>,
    mode: &FrictionMode<T>,
    base: &BaseForces<T>,
    tau: T,
) -> [Response<T>; 2] {
    let pair = ContactPair::new(params, solids, state, touching);
    let sliding = for_both!(i => {
        let (slip, initial) = (pair.kinematics[i].slip(), mode.directions[i]);
        let threshold = mode.slip_speeds[i] * DIRECTION_SLIP_FRACTION;
        let has_direction = threshold.lt(slip.dot(initial));
        let inverse = params.one() / slip.norm().select(has_direction, params.one());
        let now = Vec2::new(slip.x * inverse, slip.y * inverse);
        friction_against(pair.friction_limit(i), now.select(has_direction, initial))
    });
    let mut sliding = sliding;
    if (mode.slip_follows_rate[FIRST] | mode.slip_follows_rate[SECOND]).any() {
        let constrained = for_both!(i => mode.rolling[i] | mode.slip_follows_rate[i]);
        let required = pair.frictions(params, constrained, sliding);
        sliding = for_both!(i => {
            let against_required = unit(-required[i], required[i].norm());
            let now = friction_against(pair.friction_limit(i), against_required);
            now.select(mode.slip_follows_rate[i], sliding[i])
        });
    }
    let frictions = pair.frictions(params, mode.rolling, sliding);
    for_both!(i => {
        let force = ContactVector { normal: pair.normal_forces[i], tangent: frictions[i] };
        let (linear, angular) = pair.response(i, force);
        let size = base.oscillators.force(i, tau);
        let negative = (-size).positive_part();
        let (base_linear, base_angular) = base.per_force[i];
        let (sliding_linear, sliding_angular) = base.sliding[i];
        let (rolling_linear, rolling_angular) = base.rolling[i];
        (
            linear.add_scaled(base_linear, -size).add_scaled(sliding_linear, -negative) - rolling_linear,
            angular.add_scaled(base_angular, -size).add_scaled(sliding_angular, -negative) - rolling_angular,
        )
    })
}

/// For how long the ball has rolled on both solids without a break, after a step of `dt`, s.
#[inline(always)]
pub(crate) fn rolling_time<T: Real>(friction: &[FrictionState<T>; 2], before: T, dt: T) -> T {
    (before + dt).select(
        friction[FIRST].rolling & friction[SECOND].rolling,
        dt.zero(),
    )
}

/// Removes the slips of the contacts at zero slip together; returns the impulses per unit of mass.
#[inline(always)]
fn remove_slips<T: Real>(
    params: &ModelParams<T>,
    state: &mut BallState<T>,
    pair: &mut ContactPair<T>,
    at_zero_slip: [T::Mask; 2],
) -> [Vec3<T>; 2] {
    let zero = params.zero();
    let right_side =
        for_both!(i => (-pair.kinematics[i].slip()).select(at_zero_slip[i], Vec2::splat(zero)));
    let slip_impulses = pair.solve(params, at_zero_slip, right_side);
    let impulses = for_both!(i => {
        let response = pair.response_to_friction(i, slip_impulses[i]);
        kick(state, response, params.one());
        response.0
    });
    pair.set_motion(state, at_zero_slip[FIRST] | at_zero_slip[SECOND]);
    impulses
}
