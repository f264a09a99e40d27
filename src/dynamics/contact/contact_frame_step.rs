//! Contact with one solid: a few long steps, each in the frame of the contact.
//!
//! Along the normal the ball is a damped oscillator whose motion has a closed form as long as
//! gravity and the turning of the frame (together `G`) are constant ([`super::oscillator`]). So a
//! step can be a quarter of a bounce. What changes slowly (friction's direction, the frame, `G`) is
//! integrated with three evaluations, at the start, the middle and the end of the step, by
//! Simpson's rule; the normal force enters by its exact impulse.
//!
//! Within a step the contact either slides or rolls. The step ends where that changes, or where the
//! ball leaves: at the root of a function of the closed form.
//!
//! Sliding is the paper's law (Eqs. 3 and 13). Rolling is its exact limit (a Filippov solution on
//! the surface of zero slip; the paper's Appendix 2 approaches it by chattering): the friction that
//! keeps the slip at zero.
//!
//! On the ring the steps use `d v1` and `D v2` (d the distance from the ring's circle, D that from
//! the hoop's axis) in place of v1 and v2. Without friction they change little: this halves the
//! error. At an edge of the board d is the distance from the core, and D is 1.

use super::friction::{DIRECTION_SLIP_FRACTION, FrictionState, SLIP_TOLERANCE_M_S};
use super::oscillator::{EventFunction, NormalMotion, Oscillator};
use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{
    ContactDistances, ContactFrameState, ContactVector, FrameTurn, Material, Solid,
};

/// Shortest step, as a fraction of the longest.
const SHORTEST_STEP: f64 = 1e-6;
/// Newton steps to the end of a slip or a roll.
const NEWTON_STEPS_TO_CHANGE: u32 = 1;
/// Newton steps to the parting, and to the end of the normal force.
const NEWTON_STEPS_TO_PARTING: u32 = 2;

/// The contact of a ball with one solid.
pub(crate) struct Contact<'a, T, S> {
    pub(crate) params: &'a ModelParams<T>,
    pub(crate) solid: &'a S,
    pub(crate) oscillator: &'a Oscillator<T>,
}

/// The result of one step.
pub(crate) struct MacroStep<T: Real> {
    pub(crate) motion: ContactFrameState<T>,
    pub(crate) friction: FrictionState<T>,
    /// Length of the step, s.
    pub(crate) dt: T,
    /// The ball leaves the solid at the end of the step.
    pub(crate) separates: T::Mask,
}

/// The rates of what changes slowly, without friction. On a flat solid the spin and the third
/// coordinate do not change.
#[derive(Clone, Copy)]
struct SlowRates<T> {
    /// On the ring those of d v1 and D v2; on a flat solid those of v1 and v2.
    v1: T,
    v2: T,
    spin: ContactVector<T>,
    coordinates: [T; 3],
}

/// The equations of motion at one moment, without friction.
#[derive(Clone, Copy)]
struct Evaluation<T> {
    distances: ContactDistances<T>,
    /// G, m/s^2.
    normal_acceleration: T,
    rates: SlowRates<T>,
    slip: Vec2<T>,
    /// The slip rate is linear in v_n: its value at v_n = 0, and what it gains per v_n.
    slip_rate_at_zero_vn: Vec2<T>,
    slip_rate_per_vn: Vec2<T>,
    slip_rate: Vec2<T>,
}

/// Impulses of friction over a step, per unit of mass: along 1 and 2 (on the ring times d and D),
/// and the same times the lever, which change the spin.
#[derive(Clone, Copy)]
struct FrictionImpulse<T> {
    linear: Vec2<T>,
    times_lever: Vec2<T>,
}

/// What holds throughout a step.
struct StepStart<T: Real> {
    motion: ContactFrameState<T>,
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
    separates: T::Mask,
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

/// The normal motion of a step with G as at its start.
struct NormalStep<T: Real> {
    /// Length of the step and half of it, s.
    h: T,
    half: T,
    /// k h^2 and c h.
    k_h2: T,
    c_h: T,
    /// Compression (m) and normal velocity (m/s) in the middle and at the end.
    middle: (T, T),
    end: (T, T),
    /// N is positive at the start.
    presses: T::Mask,
}

/// The equations at a later stage of a step.
struct Stage<T> {
    at: Evaluation<T>,
    /// The positive part of N, m/s^2.
    normal: T,
    friction: StageFriction<T>,
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
    fn evaluate(
        &self,
        motion: &ContactFrameState<T>,
        distances: ContactDistances<T>,
    ) -> Evaluation<T> {
        let (v, w) = (motion.velocity, motion.spin);
        let free = self.solid.free_acceleration(&self.params.ball, motion);
        let slip = motion.slip(distances.lever);
        let zero = self.params.zero();
        if S::FLAT {
            let slip_rate_per_vn = Vec2::new(-w.tangent.y, w.tangent.x);
            let none = FrameTurn {
                turn: Vec2::new(zero, zero),
                torsion: zero,
            };
            return Evaluation {
                normal_acceleration: free.normal,
                rates: SlowRates {
                    v1: free.tangent.x,
                    v2: free.tangent.y,
                    spin: ContactVector::new(zero, zero, zero),
                    coordinates: self.solid.coordinate_rates(motion, &distances, &none),
                },
                slip,
                slip_rate_at_zero_vn: free.tangent,
                slip_rate_per_vn,
                slip_rate: free.tangent + scaled(slip_rate_per_vn, v.normal),
                distances,
            };
        }
        let frame = self.solid.frame_turn(motion, &distances);
        let FrameTurn { turn, torsion } = frame;
        let lever_spin = distances.lever * w.normal;
        let slip_rate_at_zero_vn = Vec2::new(
            lever_spin * turn.y + free.tangent.x,
            free.tangent.y - lever_spin * turn.x,
        );
        let slip_rate_per_vn = Vec2::new(-(turn.x + w.tangent.y), w.tangent.x - turn.y);
        Evaluation {
            normal_acceleration: turn.x * v.tangent.x + (turn.y * v.tangent.y + free.normal),
            rates: SlowRates {
                v1: distances.core * (free.tangent.x + torsion * v.tangent.y),
                v2: distances.axis * free.tangent.y,
                spin: ContactVector::new(
                    turn.x * w.tangent.x + turn.y * w.tangent.y,
                    torsion * w.tangent.y - turn.x * w.normal,
                    -(torsion * w.tangent.x) - turn.y * w.normal,
                ),
                coordinates: self.solid.coordinate_rates(motion, &distances, &frame),
            },
            slip,
            slip_rate_at_zero_vn,
            slip_rate_per_vn,
            slip_rate: slip_rate_at_zero_vn + scaled(slip_rate_per_vn, v.normal),
            distances,
        }
    }

    /// The sum of two rates, each times its weight.
    #[inline(always)]
    fn mix(
        &self,
        (first, a): (&SlowRates<T>, f64),
        (second, b): (&SlowRates<T>, f64),
    ) -> SlowRates<T> {
        let mut mixed = *first;
        let (p, q) = (&mut mixed.coordinates, &second.coordinates);
        (p[0], p[1]) = (p[0] * a + q[0] * b, p[1] * a + q[1] * b);
        mixed.v1 = first.v1 * a + second.v1 * b;
        mixed.v2 = first.v2 * a + second.v2 * b;
        if !S::FLAT {
            p[2] = p[2] * a + q[2] * b;
            let (p, q) = (&first.spin, &second.spin);
            mixed.spin = ContactVector::new(
                p.normal * a + q.normal * b,
                p.tangent.x * a + q.tangent.x * b,
                p.tangent.y * a + q.tangent.y * b,
            );
        }
        mixed
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
    ) -> (ContactFrameState<T>, ContactDistances<T>) {
        let ball = &self.params.ball;
        let from = &start.motion;
        let before = &start.at.distances;
        let mut coordinates = [
            rates.coordinates[0] * h + from.coordinates[0],
            rates.coordinates[1] * h + from.coordinates[1],
            from.coordinates[2],
        ];
        let spin_change = scaled(impulse.times_lever, ball.mass_over_inertia);
        let mut spin = ContactVector::new(
            from.spin.normal,
            from.spin.tangent.x + spin_change.y,
            from.spin.tangent.y - spin_change.x,
        );
        if !S::FLAT {
            coordinates[2] = rates.coordinates[2] * h + coordinates[2];
            spin = ContactVector::new(
                rates.spin.normal * h + spin.normal,
                rates.spin.tangent.x * h + spin.tangent.x,
                rates.spin.tangent.y * h + spin.tangent.y,
            );
        }
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
        let motion = ContactFrameState {
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
    fn start(&self, motion: &ContactFrameState<T>, friction: &FrictionState<T>) -> StepStart<T> {
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
            // An impulse of friction sets the slip to zero.
            let removed = scaled(slip, effective_mass.select(at_zero_slip, zero));
            let spin_change = scaled(removed, distances.lever * mass_over_inertia);
            let (v, w) = (&mut motion.velocity.tangent, &mut motion.spin.tangent);
            *v = *v - removed;
            *w = Vec2::new(w.x - spin_change.y, w.y + spin_change.x);
        }
        let at = self.evaluate(&motion, distances);
        let normal =
            material.stiffness * motion.compression - material.damping * motion.velocity.normal;
        let normal_rate = -(material.damping * (normal + at.normal_acceleration))
            - material.stiffness * motion.velocity.normal;
        let pressing = normal.positive_part();
        let limit = material.friction_coefficient * pressing;
        // After a roll has failed: if the slip rate can reverse the slip within half a step,
        // friction acts against the slip rate, not against the slip.
        let max_slip_squared = at.slip_rate.norm_squared() * self.oscillator.half_step_s.squared();
        let follows_rate = friction.rolling_failed & at.slip.norm_squared().le(max_slip_squared);
        let slip_or_rate = at.slip_rate.select(at_zero_slip | follows_rate, at.slip);
        let size = slip_or_rate.norm();
        let direction = scaled(slip_or_rate, one / size.select(size.is_positive(), one));
        let required = effective_mass * size;
        let loading = normal_rate.is_positive();
        let (factor, min_margin) = self.oscillator.rolling_margin;
        let with_margin = required * factor + min_margin;
        let suffices = required.select(loading, with_margin).le(limit);
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
        let separates = compression_at_end.le(zero);
        // Sliding: the slip along its direction. Rolling: mu N minus the friction that rolling
        // needs.
        let mu = material.friction_coefficient;
        let d_slip_rate_d_compression_rate = -at.slip_rate_per_vn.dot(start.direction);
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
        if separates.any() {
            let root = compression.first_root(
                material,
                oscillator,
                normal_motion,
                (one, compression_at_end),
                NEWTON_STEPS_TO_PARTING,
            );
            tau = root.select(separates, one);
            // Beyond N = 0 the formula does not hold: an end of the slip there is ignored.
            let pressed = (tau - oscillator.relaxation).positive_part();
            until = pressed.select(separates & !start.rolling, one);
            let there = normal_motion.after(material, oscillator, oscillator.at(until));
            last = change.value(there, until).select(separates, last);
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
                NEWTON_STEPS_TO_CHANGE,
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
            separates: separates & !change_first & !cut,
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
            NEWTON_STEPS_TO_PARTING,
        );
        // A root at the start of the step is ignored.
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

    /// The integral of min(N, 0) over a step, at whose end N is `normal` and the acceleration of
    /// the centre is `acceleration`.
    #[inline(always)]
    fn negative_impulse(&self, h: T, normal: T, normal_velocity: T, acceleration: T) -> T {
        let material = self.material();
        let (zero, one) = (self.params.zero(), self.params.one());
        let rate = -(material.damping * acceleration) - material.stiffness * normal_velocity;
        let negative = normal.is_negative() & rate.is_negative();
        if !negative.any() {
            return zero;
        }
        // By the Taylor polynomial of N about the end, back to N = 0.
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
    pub(crate) fn fraction_of_longest(&self, dt: T) -> T {
        dt * self.oscillator.inverse_step
    }

    /// Advances the ball by one step of at most `longest` (in units of the longest step): the
    /// start, the first event, the middle, the end, and Simpson's rule over the three.
    #[inline(always)]
    pub(crate) fn step(
        &self,
        motion: &ContactFrameState<T>,
        friction: &FrictionState<T>,
        longest: T,
    ) -> MacroStep<T> {
        let oscillator = self.oscillator;
        let start = self.start(motion, friction);
        let shift = start.at.normal_acceleration * oscillator.inverse_stiffness;
        let normal_motion = NormalMotion {
            displacement: start.motion.compression + shift,
            velocity: start.motion.velocity.normal,
        };
        let end = self.first_event(&start, &normal_motion, longest);
        let normal = self.normal_step(&start, (&normal_motion, shift), end.tau);
        let middle = self.middle_stage(&start, &normal);
        let (last, negative_impulse) = self.end_stage(&start, &normal, &middle);
        let mut next = self.simpson_step(&start, &normal, (&middle, &last), negative_impulse);
        // A ball that leaves has zero compression, up to the error of the step.
        next.compression = self.params.zero().select(end.separates, next.compression);
        self.solid.rebase(&mut next);
        let (fraction, min_remainder) = oscillator.slip_remainder;
        let remainder = Real::max(start.slip_speed * fraction, min_remainder);
        let usual = self.params.splat(SLIP_TOLERANCE_M_S);
        MacroStep {
            motion: next,
            friction: FrictionState {
                rolling: start.rolling,
                rolling_failed: start.rolling_failed,
                slip_tolerance: remainder.select(end.ends_slip, usual),
            },
            dt: normal.h,
            separates: end.separates,
        }
    }

    /// The normal motion of a step of length `tau`, with G as at the start.
    #[inline(always)]
    fn normal_step(
        &self,
        start: &StepStart<T>,
        (normal_motion, shift): (&NormalMotion<T>, T),
        tau: T,
    ) -> NormalStep<T> {
        let (material, oscillator) = (self.material(), self.oscillator);
        let h = tau * oscillator.step_s;
        let [at_half, at_end] = oscillator.at_half_and_whole(tau);
        let (x_m, vn_m) = normal_motion.after(material, oscillator, at_half);
        let (x_e, vn_e) = normal_motion.after(material, oscillator, at_end);
        NormalStep {
            h,
            half: h * 0.5,
            k_h2: material.stiffness * h * h,
            c_h: material.damping * h,
            middle: (x_m - shift, vn_m),
            end: (x_e - shift, vn_e),
            presses: start.normal.is_positive(),
        }
    }

    /// 3. The middle of the step, with G as at the start.
    ///
    /// If G grows linearly, by dG until the middle, the compression there is less by `dG h^2/24`
    /// and the velocity greater by `dG h/4`. The force N has both corrections.
    #[inline(always)]
    fn middle_stage(&self, start: &StepStart<T>, normal: &NormalStep<T>) -> Stage<T> {
        let (params, material) = (self.params, self.material());
        let (at, v_n) = (&start.at, start.motion.velocity.normal);
        let (half, (u_m, vn_m)) = (normal.half, normal.middle);
        let normal_impulse = (material.friction_coefficient
            * (vn_m - v_n - at.normal_acceleration * half))
            .positive_part()
            .select(normal.presses, params.zero());
        let path = start.motion.compression - u_m;
        let rolling_constant = scaled(at.slip_rate_at_zero_vn, -start.effective_mass);
        let rolling_per_vn = scaled(at.slip_rate_per_vn, -start.effective_mass);
        let linear = (scaled(rolling_constant, half) + scaled(rolling_per_vn, path))
            .select(start.rolling, scaled(start.direction, -normal_impulse));
        let mean_compression = (start.motion.compression + u_m) * 0.5;
        let mean_distances = ContactDistances {
            lever: params.ball.radius - mean_compression,
            core: self.solid.reach(&params.ball) - mean_compression,
            ..at.distances
        };
        let impulse = self.friction_impulse(linear, &mean_distances);
        let (motion, distances) = self.advance(start, &at.rates, half, (u_m, vn_m), &impulse);
        let at_m = self.evaluate(&motion, distances);
        let change = at_m.normal_acceleration - at.normal_acceleration;
        let force = (material.stiffness * u_m
            - material.damping * vn_m
            - change * (normal.k_h2 * (1.0 / 24.0) + normal.c_h * 0.25))
            .positive_part();
        Stage {
            friction: self.stage_friction(start, &at_m, force),
            at: at_m,
            normal: force,
        }
    }

    /// 4. The end of the step, and the part of the impulse of N that is negative.
    ///
    /// G grows linearly, by dG until the middle. To the first order in k h^2 and c h, the
    /// compression is less by `dG h^2/3` and the velocity greater by `dG h (1 - k h^2/12 - c h/3)`.
    #[inline(always)]
    fn end_stage(
        &self,
        start: &StepStart<T>,
        normal: &NormalStep<T>,
        middle: &Stage<T>,
    ) -> (Stage<T>, T) {
        let (params, material) = (self.params, self.material());
        let (at, v_n) = (&start.at, start.motion.velocity.normal);
        let (h, (u_e, vn_e)) = (normal.h, normal.end);
        let at_m = &middle.at;
        let change = at_m.normal_acceleration - at.normal_acceleration;
        let u = u_e - change * h * h * (1.0 / 3.0);
        let vn =
            vn_e + change * h * (-(normal.k_h2 * (1.0 / 12.0)) - normal.c_h * (1.0 / 3.0) + 1.0);
        let force = material.stiffness * u - material.damping * vn;
        let negative = self.negative_impulse(h, force, vn, force + at_m.normal_acceleration);
        let normal_impulse = (material.friction_coefficient
            * (vn - v_n - h * at_m.normal_acceleration - negative))
            .positive_part()
            .select(normal.presses, params.zero());
        let (path, two) = (start.motion.compression - u, params.splat(2.0));
        let rolling_constant = scaled(at.slip_rate_at_zero_vn, -start.effective_mass);
        let rolling_per_vn = scaled(at.slip_rate_per_vn, -start.effective_mass);
        let per_vn_m = scaled(at_m.slip_rate_per_vn, middle.friction.factor);
        let constant_m = scaled(at_m.slip_rate_at_zero_vn, middle.friction.factor);
        let linear = (scaled(scaled(constant_m, two) - rolling_constant, h)
            + scaled(scaled(per_vn_m, two) - rolling_per_vn, path))
        .select(
            start.rolling,
            scaled(
                scaled(middle.friction.direction, two) + start.direction,
                normal_impulse,
            ),
        );
        let impulse = self.friction_impulse(linear, &at_m.distances);
        let rates = self.mix((&at_m.rates, 2.0), (&at.rates, -1.0));
        let (motion, distances) = self.advance(start, &rates, h, (u, vn), &impulse);
        let at_e = self.evaluate(&motion, distances);
        let force = force.positive_part();
        let stage = Stage {
            friction: self.stage_friction(start, &at_e, force),
            at: at_e,
            normal: force,
        };
        (stage, negative)
    }

    /// 5. Simpson's rule, with the exact moments of N and v_n.
    ///
    /// A change of G in the middle acts during the second half of the step. The response is that of
    /// the oscillator: `1 - c t + (c^2 - k) t^2/2 + k^2 t^4/24` in velocity, and the integral of
    /// that in compression, with `t = h/2`.
    #[inline(always)]
    fn simpson_step(
        &self,
        start: &StepStart<T>,
        normal: &NormalStep<T>,
        (middle, last): (&Stage<T>, &Stage<T>),
        negative_impulse: T,
    ) -> ContactFrameState<T> {
        let mu = self.material().friction_coefficient;
        let (at, at_m, at_e) = (&start.at, &middle.at, &last.at);
        let (g, v_n) = (at.normal_acceleration, start.motion.velocity.normal);
        let NormalStep { h, k_h2, c_h, .. } = *normal;
        let ((_, vn_m), (u_e, vn_e)) = (normal.middle, normal.end);
        let (change_m, change_e) = (at_m.normal_acceleration - g, at_e.normal_acceleration - g);
        let second_order = (k_h2 - c_h.squared()) * (1.0 / 8.0);
        let velocity_response = -(c_h * 0.5) - second_order + k_h2.squared() * (1.0 / 384.0) + 1.0;
        let path_response = normal.half * (-(c_h * 0.25) - second_order * (1.0 / 3.0) + 1.0);
        let vn_1 = vn_e + h * (change_m * velocity_response * (2.0 / 3.0) + change_e * (1.0 / 6.0));
        let u_1 = u_e - h * change_m * path_response * (2.0 / 3.0);
        let sixth = h * (1.0 / 6.0);
        let normal_impulse = (vn_1
            - v_n
            - simpson(sixth, g, at_m.normal_acceleration, at_e.normal_acceleration)
            - negative_impulse)
            .positive_part();
        // What the exact impulse and displacement have beyond Simpson's rule acts in the direction
        // of the middle.
        let missing_impulse = (mu
            * (normal_impulse - simpson(sixth, start.pressing, middle.normal, last.normal)))
        .select(normal.presses, self.params.zero());
        let missing_displacement = start.motion.compression - u_1 - simpson(sixth, v_n, vn_m, vn_1);
        let per_vn_m = scaled(at_m.slip_rate_per_vn, middle.friction.factor);
        let missing = scaled(per_vn_m, missing_displacement).select(
            start.rolling,
            scaled(middle.friction.direction, missing_impulse),
        );
        let limit = mu * start.pressing;
        let friction_s = scaled(
            start.direction,
            (-start.required).select(start.rolling, -limit),
        );
        let (d_s, d_m, d_e) = (&at.distances, &at_m.distances, &at_e.distances);
        let impulse = FrictionImpulse {
            linear: simpson_2(
                sixth,
                self.times_distances(friction_s, d_s),
                self.times_distances(middle.friction.friction, d_m),
                self.times_distances(last.friction.friction, d_e),
            ) + self.times_distances(missing, d_m),
            times_lever: simpson_2(
                sixth,
                scaled(friction_s, d_s.lever),
                scaled(middle.friction.friction, d_m.lever),
                scaled(last.friction.friction, d_e.lever),
            ) + scaled(missing, d_m.lever),
        };
        let ends = self.mix((&at.rates, 1.0 / 6.0), (&at_e.rates, 1.0 / 6.0));
        let rates = self.mix((&ends, 1.0), (&at_m.rates, 4.0 / 6.0));
        self.advance(start, &rates, h, (u_1, vn_1), &impulse).0
    }

    /// The impulse `linear`, at fixed distances.
    #[inline(always)]
    fn friction_impulse(
        &self,
        linear: Vec2<T>,
        distances: &ContactDistances<T>,
    ) -> FrictionImpulse<T> {
        FrictionImpulse {
            linear: self.times_distances(linear, distances),
            times_lever: scaled(linear, distances.lever),
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
