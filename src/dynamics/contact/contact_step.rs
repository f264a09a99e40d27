//! Contact with one solid: a few long steps, each in the frame of the contact.
//!
//! Along the normal the ball is a damped oscillator whose motion has a closed form as long as
//! gravity and the turning of the frame (together `G`) are constant ([`super::oscillator`]). So a
//! step can be a fifth of a bounce. What changes slowly (friction's direction, the frame, `G`) is
//! integrated with three evaluations, at the start, the middle and the end of the step, by
//! Simpson's rule; the normal force enters by its exact impulse.
//!
//! Friction slides or rolls throughout a step. The step ends where that changes, or where the ball
//! parts: at the root of a function of the closed form.
//!
//! Sliding is the paper's law (Eqs. 3 and 13). Rolling is its exact limit (a Filippov solution on
//! the surface of zero slip; the paper's Appendix 2 approaches it by chattering): the friction that
//! keeps the slip at zero.
//!
//! On the ring the steps use `d v1` and `D v2` (d the distance from the ring's circle, D that from
//! the hoop's axis) in place of v1 and v2. Without friction they change little: this halves the
//! error.

use super::friction::{DIRECTION_SLIP_FRACTION, FrictionState, SLIP_TOLERANCE_M_S};
use super::oscillator::{EventFunction, NormalMotion, Oscillator};
use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{
    ContactDistances, ContactMotion, ContactVector, FrameTurn, Material, Solid,
};

/// Shortest step, as a fraction of the longest.
const SHORTEST_STEP: f64 = 1e-6;
/// Newton steps to the end of a slip or a roll, and to the parting.
const NEWTON_STEPS: (u32, u32) = (1, 2);

/// The contact of a ball with one solid.
pub(crate) struct Contact<'a, T, S> {
    pub(crate) params: &'a ModelParams<T>,
    pub(crate) solid: &'a S,
    pub(crate) oscillator: &'a Oscillator<T>,
}

/// The result of one step.
pub(crate) struct MacroStep<T: Real> {
    pub(crate) motion: ContactMotion<T>,
    pub(crate) friction: FrictionState<T>,
    /// Length of the step, s.
    pub(crate) dt: T,
    /// The ball leaves the solid at the end of the step.
    pub(crate) parts: T::Mask,
}

/// The rates of what changes slowly, without friction.
#[derive(Clone, Copy)]
struct SlowRates<T> {
    /// On the ring those of d v1 and D v2; on a flat solid those of v1 and v2.
    v1: T,
    v2: T,
    spin: ContactVector<T>,
    coordinates: [T; 3],
}

impl<T: Real> SlowRates<T> {
    /// `self a + other b`, value by value.
    #[inline(always)]
    fn mix(&self, a: f64, other: &Self, b: f64) -> Self {
        let (p, q) = (self.spin, other.spin);
        let [p_0, p_1, p_2] = self.coordinates;
        let [q_0, q_1, q_2] = other.coordinates;
        Self {
            v1: self.v1 * a + other.v1 * b,
            v2: self.v2 * a + other.v2 * b,
            spin: ContactVector::new(
                p.normal * a + q.normal * b,
                p.tangent.x * a + q.tangent.x * b,
                p.tangent.y * a + q.tangent.y * b,
            ),
            coordinates: [p_0 * a + q_0 * b, p_1 * a + q_1 * b, p_2 * a + q_2 * b],
        }
    }
}

/// The equations of motion at one moment, without friction.
#[derive(Clone, Copy)]
struct Evaluation<T> {
    distances: ContactDistances<T>,
    /// G, m/s^2.
    normal_acceleration: T,
    rates: SlowRates<T>,
    slip: Vec2<T>,
    /// The slip rate is `still + swing v_n`.
    still: Vec2<T>,
    swing: Vec2<T>,
    slip_rate: Vec2<T>,
}

/// Friction's impulses over a step, per unit of mass: along 1 and 2 (on the ring times d and D),
/// and along both times the lever.
#[derive(Clone, Copy)]
struct FrictionImpulse<T> {
    linear: Vec2<T>,
    times_lever: Vec2<T>,
}

/// What holds throughout a step.
struct StepStart<T: Real> {
    motion: ContactMotion<T>,
    at: Evaluation<T>,
    /// N, and its positive part.
    normal: T,
    pressing: T,
    /// 1 + l^2 m/I, and its inverse.
    inverse_effective_mass: T,
    effective_mass: T,
    /// Direction of the slip, or of the slip rate at zero slip.
    direction: Vec2<T>,
    slip_speed: T,
    /// Friction that rolling needs.
    required: T,
    rolling: T::Mask,
    rolling_failed: T::Mask,
    /// The direction of the slip is that of its rate.
    follows_rate: T::Mask,
}

/// Where a step ends.
struct StepEnd<T: Real> {
    /// In units of the longest step.
    tau: T,
    parts: T::Mask,
    ends_slip: T::Mask,
}

/// Friction at one stage of a step.
struct StageFriction<T> {
    /// Sliding: minus the inverse of the slip speed. Rolling: minus the effective mass.
    factor: T,
    /// Sliding: minus the direction of the slip. Rolling: the friction itself.
    direction: Vec2<T>,
    friction: Vec2<T>,
}

#[inline(always)]
fn scaled<T: Real>(v: Vec2<T>, factor: T) -> Vec2<T> {
    Vec2::new(v.x * factor, v.y * factor)
}

/// The integral over a step of values at its start, middle and end, by Simpson's rule.
#[inline(always)]
fn simpson<T: Real>(sixth: T, start: T, middle: T, end: T) -> T {
    sixth * (start + middle * 4.0 + end)
}

#[inline(always)]
fn simpson_2<T: Real>(sixth: T, start: Vec2<T>, middle: Vec2<T>, end: Vec2<T>) -> Vec2<T> {
    Vec2::new(
        simpson(sixth, start.x, middle.x, end.x),
        simpson(sixth, start.y, middle.y, end.y),
    )
}

impl<T: Real, S: Solid<T>> Contact<'_, T, S> {
    #[inline(always)]
    fn material(&self) -> &Material<T> {
        self.solid.material()
    }

    #[inline(always)]
    fn evaluate(&self, motion: &ContactMotion<T>, distances: ContactDistances<T>) -> Evaluation<T> {
        let (v, w) = (motion.velocity, motion.spin);
        let gravity = self.solid.free_acceleration(&self.params.ball, motion);
        let slip = motion.slip(distances.lever);
        let zero = self.params.zero();
        if S::FLAT {
            let swing = Vec2::new(-w.tangent.y, w.tangent.x);
            let none = FrameTurn {
                turn: Vec2::new(zero, zero),
                torsion: zero,
            };
            return Evaluation {
                normal_acceleration: gravity.normal,
                rates: SlowRates {
                    v1: gravity.tangent.x,
                    v2: gravity.tangent.y,
                    spin: ContactVector::new(zero, zero, zero),
                    coordinates: self.solid.coordinate_rates(motion, &distances, &none),
                },
                slip,
                still: gravity.tangent,
                swing,
                slip_rate: gravity.tangent + scaled(swing, v.normal),
                distances,
            };
        }
        let frame = self.solid.frame_turn(motion, &distances);
        let FrameTurn { turn, torsion } = frame;
        let twist = distances.lever * w.normal;
        let still = Vec2::new(
            twist * turn.y + gravity.tangent.x,
            gravity.tangent.y - twist * turn.x,
        );
        let swing = Vec2::new(-(turn.x + w.tangent.y), w.tangent.x - turn.y);
        Evaluation {
            normal_acceleration: turn.x * v.tangent.x + (turn.y * v.tangent.y + gravity.normal),
            rates: SlowRates {
                v1: distances.core * (gravity.tangent.x + torsion * v.tangent.y),
                v2: distances.axis * gravity.tangent.y,
                spin: ContactVector::new(
                    turn.x * w.tangent.x + turn.y * w.tangent.y,
                    torsion * w.tangent.y - turn.x * w.normal,
                    -(torsion * w.tangent.x) - turn.y * w.normal,
                ),
                coordinates: self.solid.coordinate_rates(motion, &distances, &frame),
            },
            slip,
            still,
            swing,
            slip_rate: still + scaled(swing, v.normal),
            distances,
        }
    }

    /// The motion after `h` at the given rates, with the compression and the normal velocity given.
    #[inline(always)]
    fn advance(
        &self,
        start: &StepStart<T>,
        rates: &SlowRates<T>,
        h: T,
        (compression, normal_velocity): (T, T),
        impulse: &FrictionImpulse<T>,
    ) -> (ContactMotion<T>, ContactDistances<T>) {
        let ball = &self.params.ball;
        let from = &start.motion;
        let before = &start.at.distances;
        let coordinates = [
            rates.coordinates[0] * h + from.coordinates[0],
            rates.coordinates[1] * h + from.coordinates[1],
            rates.coordinates[2] * h + from.coordinates[2],
        ];
        let twist = scaled(impulse.times_lever, ball.mass_over_inertia);
        let spin = ContactVector::new(
            rates.spin.normal * h + from.spin.normal,
            rates.spin.tangent.x * h + (from.spin.tangent.x + twist.y),
            rates.spin.tangent.y * h + (from.spin.tangent.y - twist.x),
        );
        let distances = self.solid.distances(ball, compression, &coordinates);
        let v = from.velocity.tangent;
        let tangent = if S::FLAT {
            Vec2::new(
                v.x + rates.v1 * h + impulse.linear.x,
                v.y + rates.v2 * h + impulse.linear.y,
            )
        } else {
            Vec2::new(
                (rates.v1 * h + (v.x * before.core + impulse.linear.x)) * distances.inverse_core,
                (rates.v2 * h + (v.y * before.axis + impulse.linear.y)) * distances.inverse_axis,
            )
        };
        let motion = ContactMotion {
            compression,
            velocity: ContactVector {
                normal: normal_velocity,
                tangent,
            },
            spin,
            coordinates,
            start: from.start,
        };
        (motion, distances)
    }

    /// 1. The equations at the start, and whether the ball slides or rolls.
    #[inline(always)]
    fn start(&self, motion: &ContactMotion<T>, friction: &FrictionState<T>) -> StepStart<T> {
        let (params, material) = (self.params, self.material());
        let (zero, one) = (params.zero(), params.one());
        let mut motion = *motion;
        let distances = self
            .solid
            .distances(&params.ball, motion.compression, &motion.coordinates);
        let mass_over_inertia = params.ball.mass_over_inertia;
        let inverse_effective_mass = distances.lever.squared() * mass_over_inertia + 1.0;
        let effective_mass = one / inverse_effective_mass;
        let slip = motion.slip(distances.lever);
        let at_zero_slip =
            friction.rolling | slip.norm_squared().le(friction.slip_tolerance.squared());
        if at_zero_slip.any() {
            // Friction's own impulse removes the slip.
            let removed = scaled(slip, effective_mass.select(at_zero_slip, zero));
            let twist = scaled(removed, distances.lever * mass_over_inertia);
            let (v, w) = (&mut motion.velocity.tangent, &mut motion.spin.tangent);
            *v = *v - removed;
            *w = Vec2::new(w.x - twist.y, w.y + twist.x);
        }
        let at = self.evaluate(&motion, distances);
        let normal =
            material.stiffness * motion.compression - material.damping * motion.velocity.normal;
        let normal_rate = -(material.damping * (normal + at.normal_acceleration))
            - material.stiffness * motion.velocity.normal;
        let pressing = normal.positive_part();
        let limit = material.friction_coefficient * pressing;
        // Small slip after a failed roll follows the slip rate, and faster than a step can.
        let soon = at.slip_rate.norm_squared() * self.oscillator.soon.squared();
        let follows_rate = friction.rolling_failed & at.slip.norm_squared().le(soon);
        let slip_or_rate = at.slip_rate.select(at_zero_slip | follows_rate, at.slip);
        let size = slip_or_rate.norm();
        let direction = scaled(slip_or_rate, one / size.select(size.is_positive(), one));
        let required = effective_mass * size;
        let loading = normal_rate.is_positive();
        let (share, min_reserve) = self.oscillator.roll_reserve;
        let with_reserve = required * share + min_reserve;
        let suffices = required.select(loading, with_reserve).le(limit);
        let rolling_failed = (friction.rolling_failed | (at_zero_slip & !suffices)) & !loading;
        StepStart {
            rolling: at_zero_slip & suffices & !rolling_failed,
            rolling_failed,
            follows_rate: follows_rate | at_zero_slip,
            slip_speed: zero.select(at_zero_slip | friction.rolling_failed, size),
            motion,
            at,
            normal,
            pressing,
            inverse_effective_mass,
            effective_mass,
            direction,
            required,
        }
    }

    /// 2. The first event within `longest` (in units of the longest step).
    #[inline(always)]
    fn first_event(
        &self,
        start: &StepStart<T>,
        normal_motion: &NormalMotion<T>,
        longest: T,
    ) -> StepEnd<T> {
        let (params, material, oscillator) = (self.params, self.material(), self.oscillator);
        let (zero, one) = (params.zero(), params.one());
        let (at, v_n) = (&start.at, start.motion.velocity.normal);
        let shift = normal_motion.displacement - start.motion.compression;
        let at_end = normal_motion.after(material, oscillator, oscillator.at_end());
        let compression = EventFunction {
            displacement: one,
            velocity: zero,
            constant: -shift,
            rate: zero,
        };
        let compression_at_end = at_end.0 - shift;
        let parts = compression_at_end.le(zero);
        // Sliding: the slip along its direction. Rolling: mu N minus the friction that rolling
        // needs.
        let mu = material.friction_coefficient;
        let d_slip_rate_d_compression_rate = -at.swing.dot(start.direction);
        let required_rate = start.effective_mass * d_slip_rate_d_compression_rate;
        let mu_a = mu * start.inverse_effective_mass;
        let displacement =
            (mu * material.stiffness).select(start.rolling, d_slip_rate_d_compression_rate);
        let constant = (-start.required - required_rate * v_n).select(
            start.rolling,
            start.slip_speed - d_slip_rate_d_compression_rate * start.motion.compression
                + mu_a * v_n,
        );
        let sliding_rate = at.slip_rate.dot(start.direction)
            + d_slip_rate_d_compression_rate * v_n
            + mu_a * at.normal_acceleration;
        let change = EventFunction {
            displacement,
            velocity: (required_rate - mu * material.damping).select(start.rolling, -mu_a),
            constant: constant - displacement * shift,
            rate: zero.select(start.rolling, sliding_rate * oscillator.step_s),
        };
        let (mut tau, mut until) = (one, one);
        let mut last = change.value(at_end, one);
        if parts.any() {
            let root = compression.first_root(
                material,
                oscillator,
                normal_motion,
                (one, compression_at_end),
                NEWTON_STEPS.1,
            );
            tau = root.select(parts, one);
            // After N = 0 the formula's slip grows again: a slip that ends later does not count.
            let pressed = (tau - oscillator.relaxation).positive_part();
            until = pressed.select(parts & !start.rolling, one);
            let there = normal_motion.after(material, oscillator, oscillator.at(until));
            last = change.value(there, until).select(parts, last);
        }
        let can_change =
            start.rolling | (start.slip_speed.is_positive() & start.normal.is_positive());
        let changes = last.le(zero) & can_change;
        let mut change_first = params.splat_mask(false);
        if changes.any() {
            let root = change.first_root(
                material,
                oscillator,
                normal_motion,
                (until, last),
                NEWTON_STEPS.0,
            );
            change_first = changes & root.lt(tau);
            tau = root.select(change_first, tau);
        }
        let mut longest = longest;
        if oscillator.stops_at_zero_force {
            let zero_force = self.zero_force(start, normal_motion, tau);
            longest = Real::min(longest, zero_force);
        }
        let cut = longest.lt(tau);
        StepEnd {
            tau: Real::max(longest.select(cut, tau), one * SHORTEST_STEP),
            parts: parts & !change_first & !cut,
            ends_slip: change_first & !start.rolling & !cut,
        }
    }

    /// Where N reaches zero before `tau` (1 elsewhere).
    #[inline(always)]
    fn zero_force(&self, start: &StepStart<T>, normal_motion: &NormalMotion<T>, tau: T) -> T {
        let (material, oscillator) = (self.material(), self.oscillator);
        let one = self.params.one();
        let shift = normal_motion.displacement - start.motion.compression;
        let force = EventFunction {
            displacement: material.stiffness,
            velocity: -material.damping,
            constant: -(material.stiffness * shift),
            rate: one.zero(),
        };
        let last = force.value(
            normal_motion.after(material, oscillator, oscillator.at(tau)),
            tau,
        );
        let ends = start.normal.is_positive() & last.is_negative();
        if !ends.any() {
            return one;
        }
        let root = force.first_root(
            material,
            oscillator,
            normal_motion,
            (tau, last),
            NEWTON_STEPS.1,
        );
        // A step that starts at the root goes on.
        let ahead = one.splat(SHORTEST_STEP * 2.0).lt(root);
        root.select(ends & ahead, one)
    }

    /// Friction at a later stage, where the normal force is `normal`.
    #[inline(always)]
    fn stage_friction(
        &self,
        start: &StepStart<T>,
        at: &Evaluation<T>,
        normal: T,
    ) -> StageFriction<T> {
        let one = self.params.one();
        let threshold = start.slip_speed * DIRECTION_SLIP_FRACTION;
        let has_direction = threshold.lt(at.slip.dot(start.direction));
        let slip = at.slip.select(has_direction, start.direction);
        let numerator = at.slip_rate.select(start.follows_rate, slip);
        let size = numerator.norm();
        let size = size.select(size.is_positive(), one);
        let inverse_effective_mass =
            at.distances.lever.squared() * self.params.ball.mass_over_inertia + 1.0;
        let factor = -(one / inverse_effective_mass.select(start.rolling, size));
        let direction = scaled(numerator, factor);
        let limit = self.material().friction_coefficient * normal;
        StageFriction {
            factor,
            direction,
            friction: scaled(direction, one.select(start.rolling, limit)),
        }
    }

    /// The part of the impulse of N that is negative, at the end of a step where N is `normal` and
    /// the acceleration of the centre is `acceleration`.
    #[inline(always)]
    fn negative_impulse(&self, h: T, normal: T, normal_velocity: T, acceleration: T) -> T {
        let material = self.material();
        let (zero, one) = (self.params.zero(), self.params.one());
        let rate = -(material.damping * acceleration) - material.stiffness * normal_velocity;
        let negative = normal.is_negative() & rate.is_negative();
        if !negative.any() {
            return zero;
        }
        // Along the Taylor polynomial of N about the end, back to N = 0.
        let inverse_rate = one / rate.select(negative, one);
        // Where N only just becomes negative the polynomial does not apply; these bounds hold for
        // the exact value.
        let since = Real::min(normal * inverse_rate, h);
        let second = -(material.stiffness * acceleration) - material.damping * rate;
        let second_ratio = second * since * inverse_rate;
        let second_ratio = Real::max(Real::min(second_ratio, one), -one);
        let third_ratio = (material.stiffness * since + material.damping * second_ratio) * since;
        let impulse = normal
            * since
            * (second_ratio * (second_ratio * 0.125 + 1.0 / 6.0)
                + third_ratio * (1.0 / 24.0)
                + 0.5);
        impulse.select(negative, zero)
    }

    /// A time in units of the longest step.
    #[inline(always)]
    pub(crate) fn share_of_longest(&self, dt: T) -> T {
        dt * self.oscillator.inverse_step
    }

    /// Advances the ball by one step of at most `longest` (in units of the longest step).
    #[inline(always)]
    pub(crate) fn step(
        &self,
        motion: &ContactMotion<T>,
        friction: &FrictionState<T>,
        longest: T,
    ) -> MacroStep<T> {
        let (params, material, oscillator) = (self.params, self.material(), self.oscillator);
        let (zero, mu) = (params.zero(), material.friction_coefficient);
        let start = self.start(motion, friction);
        let (at, v_n) = (&start.at, start.motion.velocity.normal);
        let g = at.normal_acceleration;
        let shift = g * oscillator.inverse_stiffness;
        let normal_motion = NormalMotion {
            displacement: start.motion.compression + shift,
            velocity: v_n,
        };
        let end = self.first_event(&start, &normal_motion, longest);
        let rolling = start.rolling;
        let presses = start.normal.is_positive();

        // 3. The middle of the step, with G as at the start.
        let h = end.tau * oscillator.step_s;
        let half = h * 0.5;
        let [at_half, at_end] = oscillator.at_half_and_whole(end.tau);
        let (x_m, vn_m) = normal_motion.after(material, oscillator, at_half);
        let (x_e, vn_e) = normal_motion.after(material, oscillator, at_end);
        let (u_m, u_e) = (x_m - shift, x_e - shift);
        let (kh2, ch) = (material.stiffness * h * h, material.damping * h);
        let impulse = (mu * (vn_m - v_n - g * half))
            .positive_part()
            .select(presses, zero);
        let path = start.motion.compression - u_m;
        let roll_still = scaled(at.still, -start.effective_mass);
        let roll_swing = scaled(at.swing, -start.effective_mass);
        let linear = (scaled(roll_still, half) + scaled(roll_swing, path))
            .select(rolling, scaled(start.direction, -impulse));
        let mean_compression = (start.motion.compression + u_m) * 0.5;
        let mean_distances = ContactDistances {
            lever: params.ball.radius - mean_compression,
            core: self.solid.reach(&params.ball) - mean_compression,
            ..at.distances
        };
        let kick = FrictionImpulse {
            linear: self.times_distances(linear, &mean_distances),
            times_lever: scaled(linear, mean_distances.lever),
        };
        let (middle, distances_m) = self.advance(&start, &at.rates, half, (u_m, vn_m), &kick);
        let at_m = self.evaluate(&middle, distances_m);
        let change_m = at_m.normal_acceleration - g;
        let normal_m = (material.stiffness * u_m
            - material.damping * vn_m
            - change_m * (kh2 * (1.0 / 24.0) + ch * 0.25))
            .positive_part();
        let friction_m = self.stage_friction(&start, &at_m, normal_m);

        // 4. The end, with the change of G.
        let u_end = u_e - change_m * h * h * (1.0 / 3.0);
        let vn_end = vn_e + change_m * h * (-(kh2 * (1.0 / 12.0)) - ch * (1.0 / 3.0) + 1.0);
        let normal_end = material.stiffness * u_end - material.damping * vn_end;
        let lost =
            self.negative_impulse(h, normal_end, vn_end, normal_end + at_m.normal_acceleration);
        let impulse = (mu * (vn_end - v_n - h * at_m.normal_acceleration - lost))
            .positive_part()
            .select(presses, zero);
        let (path, two) = (start.motion.compression - u_end, params.splat(2.0));
        let swing_m = scaled(at_m.swing, friction_m.factor);
        let still_m = scaled(at_m.still, friction_m.factor);
        let linear = (scaled(scaled(still_m, two) - roll_still, h)
            + scaled(scaled(swing_m, two) - roll_swing, path))
        .select(
            rolling,
            scaled(scaled(friction_m.direction, two) + start.direction, impulse),
        );
        let kick = FrictionImpulse {
            linear: self.times_distances(linear, &distances_m),
            times_lever: scaled(linear, distances_m.lever),
        };
        let rates = at_m.rates.mix(2.0, &at.rates, -1.0);
        let (last, distances_e) = self.advance(&start, &rates, h, (u_end, vn_end), &kick);
        let at_e = self.evaluate(&last, distances_e);
        let normal_end = normal_end.positive_part();
        let friction_e = self.stage_friction(&start, &at_e, normal_end);

        // 5. Simpson's rule, with the exact moments of N and v_n.
        let change_e = at_e.normal_acceleration - g;
        let curve = (kh2 - ch.squared()) * (1.0 / 8.0);
        let k_v = -(ch * 0.5) - curve + kh2.squared() * (1.0 / 384.0) + 1.0;
        let k_u = half * (-(ch * 0.25) - curve * (1.0 / 3.0) + 1.0);
        let vn_1 = vn_e + h * (change_m * k_v * (2.0 / 3.0) + change_e * (1.0 / 6.0));
        let u_1 = u_e - h * change_m * k_u * (2.0 / 3.0);
        let sixth = h * (1.0 / 6.0);
        let impulse = (vn_1
            - v_n
            - simpson(sixth, g, at_m.normal_acceleration, at_e.normal_acceleration)
            - lost)
            .positive_part();
        let missing_impulse = (mu
            * (impulse - simpson(sixth, start.pressing, normal_m, normal_end)))
        .select(presses, zero);
        let missing_path = start.motion.compression - u_1 - simpson(sixth, v_n, vn_m, vn_1);
        let extra = scaled(swing_m, missing_path)
            .select(rolling, scaled(friction_m.direction, missing_impulse));
        let limit = mu * start.pressing;
        let friction_s = scaled(start.direction, (-start.required).select(rolling, -limit));
        let (d_s, d_m, d_e) = (&at.distances, &at_m.distances, &at_e.distances);
        let kick = FrictionImpulse {
            linear: simpson_2(
                sixth,
                self.times_distances(friction_s, d_s),
                self.times_distances(friction_m.friction, d_m),
                self.times_distances(friction_e.friction, d_e),
            ) + self.times_distances(extra, d_m),
            times_lever: simpson_2(
                sixth,
                scaled(friction_s, d_s.lever),
                scaled(friction_m.friction, d_m.lever),
                scaled(friction_e.friction, d_e.lever),
            ) + scaled(extra, d_m.lever),
        };
        let ends = at.rates.mix(1.0 / 6.0, &at_e.rates, 1.0 / 6.0);
        let rates = ends.mix(1.0, &at_m.rates, 4.0 / 6.0);
        let (mut next, _) = self.advance(&start, &rates, h, (u_1, vn_1), &kick);
        // A ball that parts is at zero compression, but for the error of the step.
        next.compression = zero.select(end.parts, next.compression);
        self.solid.rebase(&mut next);
        let (fraction, min_remainder) = oscillator.slip_remainder;
        let remainder = Real::max(start.slip_speed * fraction, min_remainder);
        MacroStep {
            motion: next,
            friction: FrictionState {
                rolling,
                rolling_failed: start.rolling_failed,
                slip_tolerance: remainder.select(end.ends_slip, params.splat(SLIP_TOLERANCE_M_S)),
            },
            dt: h,
            parts: end.parts,
        }
    }

    /// On the ring, the components times the distances from the circle and from the axis.
    #[inline(always)]
    fn times_distances(&self, v: Vec2<T>, distances: &ContactDistances<T>) -> Vec2<T> {
        if S::FLAT {
            v
        } else {
            Vec2::new(v.x * distances.core, v.y * distances.axis)
        }
    }
}
