//! Two contacts of one state: their geometry, and their friction.
//!
//! Where both contacts roll, their frictions are coupled: four linear equations keep both slips at
//! zero.

use crate::math::real::{Mask, Real};
use crate::math::vector::{RealVector, Vec2, Vec3};
use crate::model::BallState;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{ContactKinematics, ContactVector, Material, Solid};

/// Index of the first and of the second contact of a pair.
pub(super) const FIRST: usize = 0;
pub(super) const SECOND: usize = 1;

/// An array of the same expression for both contacts. (A closure in `map` would not be inlined, and
/// then not be compiled for the vector instructions of its caller.)
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
pub(super) use for_both;

/// A linear and an angular acceleration of the ball.
pub(super) type Response<T> = (Vec3<T>, Vec3<T>);

/// Two contacts of one state.
pub(super) struct ContactPair<T> {
    pub(super) kinematics: [ContactKinematics<T>; 2],
    pub(super) materials: [Material<T>; 2],
    /// The directions (n, 1, 2) of each contact in the world frame.
    pub(super) axes: [[Vec3<T>; 3]; 2],
    /// Lever over the moment of inertia (per unit of mass).
    lever_over_inertia: [T; 2],
    /// Normal forces per unit of mass, m/s^2.
    pub(super) normal_forces: [T; 2],
}

impl<T: Real> ContactPair<T> {
    #[inline(always)]
    pub(super) fn new<A: Solid<T>, B: Solid<T>>(
        params: &ModelParams<T>,
        (first, second): (&A, &B),
        state: &BallState<T>,
        touching: [T::Mask; 2],
    ) -> Self {
        let (first_kinematics, first_axes) = first.contact(&params.ball, state);
        let (second_kinematics, second_axes) = second.contact(&params.ball, state);
        let kinematics = [first_kinematics, second_kinematics];
        let materials = [
            first.material().where_touching(touching[FIRST]),
            second.material().where_touching(touching[SECOND]),
        ];
        Self {
            axes: [first_axes, second_axes],
            lever_over_inertia: for_both!(i => kinematics[i].lever * params.ball.mass_over_inertia),
            normal_forces: for_both!(i => kinematics[i].normal_force(&materials[i])),
            kinematics,
            materials,
        }
    }

    /// The slip rate at a contact from an acceleration of the ball.
    #[inline(always)]
    pub(super) fn slip_rate(&self, contact: usize, (linear, angular): Response<T>) -> Vec2<T> {
        let [_, tangent_1, tangent_2] = self.axes[contact];
        let lever = self.kinematics[contact].lever;
        Vec2::new(
            tangent_1.dot(linear) - lever * tangent_2.dot(angular),
            tangent_2.dot(linear) + lever * tangent_1.dot(angular),
        )
    }

    /// The acceleration of the ball from (n, 1, 2) accelerations at a contact.
    #[inline(always)]
    pub(super) fn response(&self, contact: usize, force: ContactVector<T>) -> Response<T> {
        let (linear, angular) = self.response_to_friction(contact, force.tangent);
        (
            linear.add_scaled(self.axes[contact][0], force.normal),
            angular,
        )
    }

    /// Response to friction alone.
    #[inline(always)]
    pub(super) fn response_to_friction(&self, contact: usize, friction: Vec2<T>) -> Response<T> {
        let [_, tangent_1, tangent_2] = self.axes[contact];
        let lever_over_inertia = self.lever_over_inertia[contact];
        (
            (tangent_1 * friction.x).add_scaled(tangent_2, friction.y),
            (tangent_1 * (lever_over_inertia * friction.y))
                .add_scaled(tangent_2, -(lever_over_inertia * friction.x)),
        )
    }

    /// Takes the velocities of a state at the same position, where `changed`.
    #[inline(always)]
    pub(super) fn set_motion(&mut self, state: &BallState<T>, changed: T::Mask) {
        for i in [FIRST, SECOND] {
            // A closure would not be inlined.
            let axes = &self.axes[i];
            let kinematics = &mut self.kinematics[i];
            kinematics.velocity =
                ContactVector::along(axes, state.velocity_m_s).select(changed, kinematics.velocity);
            kinematics.spin =
                ContactVector::along(axes, state.spin_rad_s).select(changed, kinematics.spin);
            self.normal_forces[i] = self.kinematics[i].normal_force(&self.materials[i]);
        }
    }

    /// The slip rate at a contact without any friction: from motion, gravity and the normal force
    /// of the other contact.
    #[inline(always)]
    fn frictionless_slip_rate(&self, contact: usize) -> Vec2<T> {
        let [_, tangent_1, tangent_2] = self.axes[contact];
        let other = 1 - contact;
        let (normal, force) = (self.axes[other][0], self.normal_forces[other]);
        self.kinematics[contact].frictionless_slip_rate()
            + Vec2::new(tangent_1.dot(normal) * force, tangent_2.dot(normal) * force)
    }

    /// The greatest friction of a contact.
    #[inline(always)]
    pub(super) fn friction_limit(&self, contact: usize) -> T {
        self.materials[contact].friction_coefficient * self.normal_forces[contact].positive_part()
    }

    /// The friction of both contacts; `sliding` is that of contacts that slide.
    #[inline(always)]
    pub(super) fn frictions(
        &self,
        params: &ModelParams<T>,
        rolling: [T::Mask; 2],
        sliding: [Vec2<T>; 2],
    ) -> [Vec2<T>; 2] {
        if !(rolling[FIRST] | rolling[SECOND]).any() {
            return sliding;
        }
        let right_side = for_both!(i => {
            (-self.frictionless_slip_rate(i)).select(rolling[i], sliding[i])
        });
        self.solve(params, rolling, right_side)
    }

    /// The tangential accelerations `a` at both contacts that change the slips of the `constrained`
    /// contacts at the rates `w`, given as `right_side`. For the other contacts `w` is the
    /// tangential acceleration itself.
    ///
    /// The tangential acceleration at a contact changes the slip there equally in both directions,
    /// by the inverse effective mass `b = 1 + lever^2 m/I`, and the slip at the other contact by a
    /// coupling matrix `C`:
    ///
    /// ```text
    /// b_1 a_1 + C_12 a_2 = w_1        (b_2 - C_21 C_12/b_1) a_2 = w_2 - C_21 w_1/b_1
    /// C_21 a_1 + b_2 a_2 = w_2   so   a_1 = (w_1 - C_12 a_2)/b_1
    /// ```
    #[inline(always)]
    pub(super) fn solve(
        &self,
        params: &ModelParams<T>,
        constrained: [T::Mask; 2],
        right_side: [Vec2<T>; 2],
    ) -> [Vec2<T>; 2] {
        let [w_1, w_2] = right_side;
        let [b_1, b_2] = for_both!(i => {
            let inverse_effective_mass = self.kinematics[i].inverse_effective_mass(&params.ball);
            inverse_effective_mass.select(constrained[i], params.one())
        });
        let [c_12, c_21] = self.couplings(params, constrained);
        let inverse_b_1 = params.one() / b_1;
        let from_first = c_21.times(Vec2::new(w_1.x * inverse_b_1, w_1.y * inverse_b_1));
        let reduced = Vec2::new(w_2.x - from_first.x, w_2.y - from_first.y);
        let product = c_21.product_scaled(&c_12, inverse_b_1);
        let matrix = Matrix2 {
            a: b_2 - product.a,
            b: -product.b,
            c: -product.c,
            d: b_2 - product.d,
        };
        let a_2 = matrix.solve(params, reduced, b_2);
        let from_second = c_12.times(a_2);
        let a_1 = Vec2::new(
            (w_1.x - from_second.x) * inverse_b_1,
            (w_1.y - from_second.y) * inverse_b_1,
        );
        [a_1, a_2]
    }

    /// The slip rates at each contact for unit tangential accelerations at the other one, where
    /// `constrained`: with g the lever here times the lever there over the moment of inertia, and
    /// `d_ij` the scalar product of the direction i here and j there,
    ///
    /// ```text
    /// C = | d_11 + g d_22   d_12 - g d_21 |
    ///     | d_21 - g d_12   d_22 + g d_11 |
    /// ```
    #[inline(always)]
    fn couplings(&self, params: &ModelParams<T>, constrained: [T::Mask; 2]) -> [Matrix2<T>; 2] {
        let zero = params.zero();
        let [[_, first_1, first_2], [_, second_1, second_2]] = self.axes;
        let (d_11, d_12) = (first_1.dot(second_1), first_1.dot(second_2));
        let (d_21, d_22) = (first_2.dot(second_1), first_2.dot(second_2));
        // Seen from the second contact, i and j change places.
        let mixed = [(d_12, d_21), (d_21, d_12)];
        for_both!(i => {
            let g = self.kinematics[i].lever * self.lever_over_inertia[1 - i];
            let (d_12, d_21) = mixed[i];
            Matrix2 {
                a: (d_11 + g * d_22).select(constrained[i], zero),
                b: (d_12 - g * d_21).select(constrained[i], zero),
                c: (d_21 - g * d_12).select(constrained[i], zero),
                d: (d_22 + g * d_11).select(constrained[i], zero),
            }
        })
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

    /// The solution x of `self * x = right_side`. The matrix is singular only if both contact
    /// points coincide; then x is `right_side / compliance`, as if the contact were alone.
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
        let pair = ContactPair::new(&params, (&params.board, &params.ring), &state, [true; 2]);
        (params, pair)
    }

    #[test]
    fn prop_constrained_slips_change_at_the_wanted_rates() {
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
                let other = pair.slip_rate(i, pair.response(1 - i, force(1 - i)));
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
