//! Contact with two solids at once.
//!
//! The mechanics are those of the single contact, with both forces in one balance. Where both contacts
//! roll, their frictions are coupled: four linear equations keep both slips at zero.

use super::friction::{
    DIRECTION_SLIP_FRACTION, FrictionBalance, FrictionState, slip_tolerance_after,
};
use super::normal_force::{FORCE_TOLERANCE_M_S2, NormalForce, has_separated};
use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{ContactFrame, ContactKinematics, ContactVector, Material, Solid};
use crate::model::{BallState, StateDerivative};

/// Index of the first and of the second contact of a pair.
const FIRST: usize = 0;
const SECOND: usize = 1;

/// An array of the same expression for both contacts. (A closure in `map` would not be inlined, and then
/// not be compiled for the vector instructions of its caller.)
macro_rules! for_both {
    ($contact:ident => $value:expr) => {
        [
            {
                #[allow(non_upper_case_globals)]
                const $contact: usize = FIRST;
                $value
            },
            {
                #[allow(non_upper_case_globals)]
                const $contact: usize = SECOND;
                $value
            },
        ]
    };
}

/// The result of one step.
pub(crate) struct DoubleContactStep<T: Real> {
    /// Length of the step, s.
    pub(crate) dt: T,
    /// Whether the ball has left each solid. If it has left any, nothing was integrated.
    pub(crate) separated: [T::Mask; 2],
    /// Impulses of both contacts per unit of mass, m/s.
    pub(crate) impulses: [Vec3<T>; 2],
}

/// Lower bound of the slip tolerance after a step meant to end the slip, m/s. The force of the other
/// contact turns the slip as it decreases, so each such step leaves about half of it.
const SLIP_ENDED_M_S: f64 = 1e-3;

/// Shortest step, as a fraction of the longest. (Two sliding contacts can end each other's slip without end.)
const SHORTEST_STEP: f64 = 2e-4;

/// A linear and an angular acceleration of the ball.
type Response<T> = (Vec3<T>, Vec3<T>);

/// Two contacts of one state.
struct ContactPair<T> {
    kinematics: [ContactKinematics<T>; 2],
    materials: [Material<T>; 2],
    /// The directions (n, 1, 2) of each contact in space.
    axes: [[Vec3<T>; 3]; 2],
    /// Lever over the moment of inertia (per unit of mass).
    lever_over_inertia: [T; 2],
    /// Normal accelerations.
    normals: [T; 2],
}

#[inline(always)]
fn axes_of<T: Real, F: ContactFrame<T>>(params: &ModelParams<T>, frame: F) -> [Vec3<T>; 3] {
    let (zero, one) = (params.zero(), params.one());
    [
        frame.to_space(ContactVector::new(one, zero, zero)),
        frame.to_space(ContactVector::new(zero, one, zero)),
        frame.to_space(ContactVector::new(zero, zero, one)),
    ]
}

impl<T: Real> ContactPair<T> {
    #[inline(always)]
    fn new<A: Solid<T>, B: Solid<T>>(
        params: &ModelParams<T>,
        (first, second): (&A, &B),
        state: &BallState<T>,
    ) -> Self {
        let (first_kinematics, first_frame) = first.contact(&params.ball, state);
        let (second_kinematics, second_frame) = second.contact(&params.ball, state);
        let kinematics = [first_kinematics, second_kinematics];
        let materials = [*first.material(), *second.material()];
        Self {
            axes: [axes_of(params, first_frame), axes_of(params, second_frame)],
            lever_over_inertia: for_both!(i => kinematics[i].lever * params.ball.mass_over_inertia),
            normals: for_both!(i => kinematics[i].normal_force(&materials[i])),
            kinematics,
            materials,
        }
    }

    /// The slip rate at a contact from an acceleration of the ball.
    #[inline(always)]
    fn slip_rate(&self, contact: usize, (linear, angular): Response<T>) -> Vec2<T> {
        let [_, tangent_1, tangent_2] = self.axes[contact];
        let lever = self.kinematics[contact].lever;
        Vec2::new(
            tangent_1.dot(linear) - lever * tangent_2.dot(angular),
            tangent_2.dot(linear) + lever * tangent_1.dot(angular),
        )
    }

    /// The acceleration of the ball from (n, 1, 2) accelerations at a contact.
    #[inline(always)]
    fn response(&self, contact: usize, force: ContactVector<T>) -> Response<T> {
        let [normal, tangent_1, tangent_2] = self.axes[contact];
        let lever_over_inertia = self.lever_over_inertia[contact];
        let tangent = force.tangent;
        (
            (normal * force.normal)
                .add_scaled(tangent_1, tangent.x)
                .add_scaled(tangent_2, tangent.y),
            (tangent_1 * (lever_over_inertia * tangent.y))
                .add_scaled(tangent_2, -(lever_over_inertia * tangent.x)),
        )
    }

    /// The slip rate at a contact from the force of the other contact.
    #[inline(always)]
    fn slip_rate_from_other(&self, contact: usize, other: ContactVector<T>) -> Vec2<T> {
        self.slip_rate(contact, self.response(1 - contact, other))
    }

    /// The slip rate at a contact without friction there: from motion, gravity and the other contact.
    #[inline(always)]
    fn frictionless_slip_rate(&self, contact: usize, other: ContactVector<T>) -> Vec2<T> {
        self.kinematics[contact].frictionless_slip_rate()
            + self.slip_rate_from_other(contact, other)
    }

    /// The normal force of a contact alone.
    #[inline(always)]
    fn normal_only(&self, params: &ModelParams<T>, contact: usize) -> ContactVector<T> {
        ContactVector::new(self.normals[contact], params.zero(), params.zero())
    }

    /// The greatest friction of a contact.
    #[inline(always)]
    fn friction_limit(&self, contact: usize) -> T {
        self.materials[contact].friction_coefficient * self.normals[contact].positive_part()
    }

    /// The friction of both contacts; `sliding` is that of contacts that slide.
    #[inline(always)]
    fn frictions(
        &self,
        params: &ModelParams<T>,
        rolling: [T::Mask; 2],
        sliding: [Vec2<T>; 2],
    ) -> [Vec2<T>; 2] {
        if !(rolling[FIRST] | rolling[SECOND]).any() {
            return sliding;
        }
        let right_side = for_both!(i => {
            let rate = self.frictionless_slip_rate(i, self.normal_only(params, 1 - i));
            (-rate).select(rolling[i], sliding[i])
        });
        self.solve(params, rolling, right_side)
    }

    /// The tangential accelerations `a` at both contacts that change the slips of the `constrained` contacts at the
    /// rates `w`, given as `right_side`. For the other contacts `w` is the tangential acceleration itself.
    ///
    /// The tangential acceleration at a contact changes the slip there equally in both directions, by the
    /// inverse effective mass `s = 1 + lever^2 m/I`, and the slip at the other contact by a coupling matrix `C`:
    ///
    /// ```text
    /// s_1 a_1 + C_12 a_2 = w_1        (s_2 - C_21 C_12/s_1) a_2 = w_2 - C_21 w_1/s_1
    /// C_21 a_1 + s_2 a_2 = w_2   so   a_1 = (w_1 - C_12 a_2)/s_1
    /// ```
    #[inline(always)]
    fn solve(
        &self,
        params: &ModelParams<T>,
        constrained: [T::Mask; 2],
        right_side: [Vec2<T>; 2],
    ) -> [Vec2<T>; 2] {
        let [w_1, w_2] = right_side;
        let [s_1, s_2] = for_both!(i => {
            let compliance = self.kinematics[i].inverse_effective_mass(&params.ball);
            compliance.select(constrained[i], params.one())
        });
        let [c_12, c_21] = for_both!(i => self.coupling(params, i, constrained[i]));
        let inverse_s_1 = params.one() / s_1;
        let from_first = c_21.times(Vec2::new(w_1.x * inverse_s_1, w_1.y * inverse_s_1));
        let reduced = Vec2::new(w_2.x - from_first.x, w_2.y - from_first.y);
        let product = c_21.product_scaled(&c_12, inverse_s_1);
        let matrix = Matrix2 {
            a: s_2 - product.a,
            b: -product.b,
            c: -product.c,
            d: s_2 - product.d,
        };
        let a_2 = matrix.solve(params, reduced, s_2);
        let from_second = c_12.times(a_2);
        let a_1 = Vec2::new(
            (w_1.x - from_second.x) * inverse_s_1,
            (w_1.y - from_second.y) * inverse_s_1,
        );
        [a_1, a_2]
    }

    /// The slip rates at a contact for unit tangential accelerations at the other one, where `constrained`.
    #[inline(always)]
    fn coupling(
        &self,
        params: &ModelParams<T>,
        contact: usize,
        constrained: T::Mask,
    ) -> Matrix2<T> {
        let (zero, one) = (params.zero(), params.one());
        let first = self.slip_rate_from_other(contact, ContactVector::new(zero, one, zero));
        let second = self.slip_rate_from_other(contact, ContactVector::new(zero, zero, one));
        Matrix2 {
            a: first.x.select(constrained, zero),
            b: second.x.select(constrained, zero),
            c: first.y.select(constrained, zero),
            d: second.y.select(constrained, zero),
        }
    }

    /// The derivative of the state, and the linear acceleration from each contact.
    #[inline(always)]
    fn derivative(
        &self,
        params: &ModelParams<T>,
        state: &BallState<T>,
        frictions: [Vec2<T>; 2],
    ) -> (StateDerivative<T>, [Vec3<T>; 2]) {
        let [first, second] = for_both!(i => {
            let force = ContactVector {
                normal: self.normals[i],
                tangent: frictions[i],
            };
            self.response(i, force)
        });
        let linear = first.0.add_scaled(second.0, params.one());
        let derivative = StateDerivative {
            velocity_m_s: state.velocity_m_s,
            acceleration_m_s2: Vec3::new(linear.x, linear.y, linear.z - params.ball.gravity),
            angular_acceleration_rad_s2: first.1.add_scaled(second.1, params.one()),
        };
        (derivative, [first.0, second.0])
    }
}

/// A 2 x 2 matrix, row by row.
struct Matrix2<T> {
    a: T,
    b: T,
    c: T,
    d: T,
}

impl<T: Real> Matrix2<T> {
    #[inline(always)]
    fn times(&self, v: Vec2<T>) -> Vec2<T> {
        Vec2::new(self.a * v.x + self.b * v.y, self.c * v.x + self.d * v.y)
    }

    /// The product `self * other * factor`.
    #[inline(always)]
    fn product_scaled(&self, other: &Self, factor: T) -> Self {
        Self {
            a: (self.a * other.a + self.b * other.c) * factor,
            b: (self.a * other.b + self.b * other.d) * factor,
            c: (self.c * other.a + self.d * other.c) * factor,
            d: (self.c * other.b + self.d * other.d) * factor,
        }
    }

    /// The solution x of `self * x = right_side`. The matrix is singular only if both contact points
    /// coincide; then x is `right_side / compliance`, as if the contact were alone.
    #[inline(always)]
    fn solve(&self, params: &ModelParams<T>, right_side: Vec2<T>, compliance: T) -> Vec2<T> {
        let determinant = self.a * self.d - self.b * self.c;
        let regular = determinant.abs().is_positive();
        let inverse = params.one() / determinant.select(regular, compliance);
        let numerator = Vec2::new(
            self.d * right_side.x - self.b * right_side.y,
            self.a * right_side.y - self.c * right_side.x,
        );
        let numerator = numerator.select(regular, right_side);
        Vec2::new(numerator.x * inverse, numerator.y * inverse)
    }
}

/// Friction of the size `limit` against a direction of slip.
#[inline(always)]
fn friction_against<T: Real>(limit: T, direction: Vec2<T>) -> Vec2<T> {
    Vec2::new(-(limit * direction.x), -(limit * direction.y))
}

/// Advances a ball in contact with two solids by one step of at most `longest`.
#[inline(always)]
pub(crate) fn step<T: Real, A: Solid<T>, B: Solid<T>>(
    params: &ModelParams<T>,
    solids: (&A, &B),
    state: &mut BallState<T>,
    friction: &mut [FrictionState<T>; 2],
    longest: T,
) -> DoubleContactStep<T> {
    let start = *state;
    let mut pair = ContactPair::new(params, solids, state);
    let separated = for_both!(i => has_separated(&pair.kinematics[i]));
    let any_separated = separated[FIRST] | separated[SECOND];
    let no_impulse = Vec3::splat(params.zero());
    if any_separated.all() {
        return DoubleContactStep {
            dt: params.zero(),
            separated,
            impulses: [no_impulse; 2],
        };
    }

    // 1. Slips that have ended are removed by friction's own impulses.
    let at_zero_slip = for_both!(i => {
        let slip = pair.kinematics[i].slip();
        friction[i].rolling | slip.norm_squared().le(friction[i].slip_tolerance.squared())
    });
    let mut impulses = [no_impulse; 2];
    if (at_zero_slip[FIRST] | at_zero_slip[SECOND]).any() {
        impulses = remove_slips(params, solids, state, &mut pair, at_zero_slip);
    }

    // 2. Which contacts roll: those at zero slip whose friction suffices. If it does not suffice for one, that
    //    one slides, and the other is solved for again.
    let slips = for_both!(i => pair.kinematics[i].slip());
    let slip_speeds = for_both!(i => params.zero().select(at_zero_slip[i], slips[i].norm()));
    let limits = for_both!(i => pair.friction_limit(i));
    let mut rolling = for_both!(i => at_zero_slip[i] & !friction[i].rolling_failed);
    let mut fails_now = [params.splat_mask(false); 2];
    // For a contact that does not roll: the direction of its slip, or in which it would slip.
    let directions = for_both!(i => {
        let slip_rate = pair.frictionless_slip_rate(i, pair.normal_only(params, 1 - i));
        let slip_or_slip_rate = slip_rate.select(at_zero_slip[i], slips[i]);
        let size = slip_or_slip_rate.norm();
        let inverse_size = params.one() / size.select(size.is_positive(), params.one());
        Vec2::new(slip_or_slip_rate.x * inverse_size, slip_or_slip_rate.y * inverse_size)
    });
    let sliding = for_both!(i => friction_against(limits[i], directions[i]));
    let mut frictions = pair.frictions(params, rolling, sliding);
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

    // 3. The step ends at the first event of either contact.
    let (k1, force_1) = pair.derivative(params, state, frictions);
    let forces = for_both!(i => {
        let kinematics = &pair.kinematics[i];
        let acceleration =
            pair.axes[i][0].dot(k1.acceleration_m_s2) + kinematics.frame_acceleration();
        NormalForce::new(&pair.materials[i], kinematics, pair.normals[i], acceleration)
    });
    let ends = for_both!(i => {
        forces[i].time_to_end(params, &pair.materials[i], &pair.kinematics[i])
    });
    let end = ends[FIRST].min(ends[SECOND]).at_most(longest);
    let changes = for_both!(i => {
        let other = ContactVector {
            normal: pair.normals[1 - i],
            tangent: frictions[1 - i],
        };
        let slip_rate = pair.frictionless_slip_rate(i, other);
        let inverse_effective_mass = pair.kinematics[i].inverse_effective_mass(&params.ball);
        let balance = FrictionBalance {
            slip: slip_speeds[i],
            slip_rate: slip_rate.dot(directions[i]) - limits[i] * inverse_effective_mass,
            inverse_effective_mass,
            friction_reserve: Real::max(limits[i] - frictions[i].norm(), params.splat(FORCE_TOLERANCE_M_S2)),
            // With two contacts this is hard to predict; the rate of the limit is not.
            d_required_d_compression_rate: params.zero(),
        };
        balance.time_to_change(params, pair.materials[i].friction_coefficient, &forces[i], rolling[i])
    });
    let next_event = end.min(changes[FIRST]).min(changes[SECOND]);
    let dt = Real::max(next_event.time(), longest * SHORTEST_STEP);

    // 4. The classical RK4 step, in the modes that hold for the whole step.
    let mode = FrictionMode {
        rolling,
        directions,
        thresholds: for_both!(i => slip_speeds[i] * DIRECTION_SLIP_FRACTION),
    };
    let half = dt * 0.5;
    let (k2, force_2) = stage(params, solids, &state.euler_step(&k1, half), mode);
    let (k3, force_3) = stage(params, solids, &state.euler_step(&k2, half), mode);
    let (k4, force_4) = stage(params, solids, &state.euler_step(&k3, dt), mode);
    let next = state.runge_kutta_step([&k1, &k2, &k3, &k4], dt);
    let (sixth, third) = (dt * (1.0 / 6.0), dt * (1.0 / 3.0));
    for i in [FIRST, SECOND] {
        impulses[i] = impulses[i]
            .add_scaled(force_1[i], sixth)
            .add_scaled(force_2[i], third)
            .add_scaled(force_3[i], third)
            .add_scaled(force_4[i], sixth);
        let ends_slip = changes[i].le(next_event) & !rolling[i];
        let loading = forces[i].rate.is_positive();
        let rolling_failed = (friction[i].rolling_failed | fails_now[i]) & !loading;
        let slip_tolerance = slip_tolerance_after(ends_slip, slip_speeds[i], SLIP_ENDED_M_S);
        friction[i] = FrictionState {
            rolling: friction[i].rolling.select(any_separated, rolling[i]),
            rolling_failed: friction[i]
                .rolling_failed
                .select(any_separated, rolling_failed),
            slip_tolerance: friction[i]
                .slip_tolerance
                .select(any_separated, slip_tolerance),
        };
    }
    *state = start.select(any_separated, next);
    DoubleContactStep {
        dt: params.zero().select(any_separated, dt),
        separated,
        impulses,
    }
}

/// How friction acts at both contacts throughout a step.
#[derive(Clone, Copy)]
struct FrictionMode<T: Real> {
    rolling: [T::Mask; 2],
    /// Directions of the slips at the start of the step.
    directions: [Vec2<T>; 2],
    /// Slips along these directions below which they are used.
    thresholds: [T; 2],
}

/// The derivative at one stage of a step, and the linear acceleration from each contact.
#[inline(always)]
fn stage<T: Real, A: Solid<T>, B: Solid<T>>(
    params: &ModelParams<T>,
    solids: (&A, &B),
    state: &BallState<T>,
    mode: FrictionMode<T>,
) -> (StateDerivative<T>, [Vec3<T>; 2]) {
    let pair = ContactPair::new(params, solids, state);
    let sliding = for_both!(i => {
        let limit = pair.friction_limit(i);
        let (slip, initial) = (pair.kinematics[i].slip(), mode.directions[i]);
        let has_direction = mode.thresholds[i].lt(slip.dot(initial));
        let inverse = params.one() / slip.norm().select(has_direction, params.one());
        friction_against(limit, Vec2::new(slip.x * inverse, slip.y * inverse).select(has_direction, initial))
    });
    pair.derivative(params, state, pair.frictions(params, mode.rolling, sliding))
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
fn remove_slips<T: Real, A: Solid<T>, B: Solid<T>>(
    params: &ModelParams<T>,
    solids: (&A, &B),
    state: &mut BallState<T>,
    pair: &mut ContactPair<T>,
    at_zero_slip: [T::Mask; 2],
) -> [Vec3<T>; 2] {
    let zero = params.zero();
    let right_side =
        for_both!(i => (-pair.kinematics[i].slip()).select(at_zero_slip[i], Vec2::splat(zero)));
    let slip_impulses = pair.solve(params, at_zero_slip, right_side);
    let impulses = for_both!(i => {
        let impulse = ContactVector {
            normal: zero,
            tangent: slip_impulses[i],
        };
        let (linear, angular) = pair.response(i, impulse);
        state.velocity_m_s = state.velocity_m_s.add_scaled(linear, params.one());
        state.spin_rad_s = state.spin_rad_s.add_scaled(angular, params.one());
        linear
    });
    *pair = ContactPair::new(params, solids, state);
    impulses
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Physics;

    /// A ball on board and ring, moving and turning.
    fn pair() -> (ModelParams, ContactPair<f64>) {
        let params = ModelParams::new(&Physics::paper());
        let x = params.board.touch_x - 0.001;
        let off = params.ring.radius - (x * x + 0.01).sqrt();
        let z = (params.ball.radius * params.ball.radius - off * off).sqrt() - 0.001;
        let state = BallState {
            position_m: Vec3::new(x, 0.1, z),
            velocity_m_s: Vec3::new(-0.3, 0.2, -1.0),
            spin_rad_s: Vec3::new(3.0, -2.0, 1.0),
        };
        let pair = ContactPair::new(&params, (&params.board, &params.ring), &state);
        (params, pair)
    }

    #[test]
    fn prop_held_slips_change_at_the_wanted_rates() {
        let (params, pair) = pair();
        let right_side = [Vec2::new(0.7, -0.4), Vec2::new(-0.2, 0.5)];
        for constrained in [[true, true], [true, false], [false, true], [false, false]] {
            let found = pair.solve(&params, constrained, right_side);
            for i in [FIRST, SECOND] {
                let force = |contact: usize| ContactVector {
                    normal: 0.0,
                    tangent: found[contact],
                };
                let own = pair.slip_rate(i, pair.response(i, force(i)));
                let other = pair.slip_rate_from_other(i, force(1 - i));
                let expected = if constrained[i] {
                    own + other
                } else {
                    found[i]
                };
                assert!((expected - right_side[i]).norm() < 1e-12, "{constrained:?}");
            }
        }
    }

    #[test]
    fn prop_a_singular_matrix_treats_the_contact_as_if_alone() {
        let params = ModelParams::new(&Physics::paper());
        let [a, b, c, d] = [1.0, 2.0, 2.0, 4.0];
        assert_eq!(
            Matrix2 { a, b, c, d }.solve(&params, Vec2::new(3.0, 5.0), 2.0),
            Vec2::new(1.5, 2.5)
        );
    }
}
