//! The normal force of a contact, and when it ends.

use super::event_time::{EventTime, OVERSHOOT, first_root};
use crate::math::real::Real;
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::{ContactKinematics, Material};

/// Normal acceleration that counts as zero, m/s^2 (a bounce reaches a thousand).
pub(crate) const FORCE_TOLERANCE_M_S2: f64 = 0.5;
/// Compression at which an outgoing ball has left the solid, m.
const SEPARATED_M: f64 = 1e-7;
/// The same for a ball faster than [`FAST_M_S`].
const SEPARATED_FAST_M: f64 = 2e-5;
/// Speed away from the solid that counts as fast, m/s.
const FAST_M_S: f64 = 0.1;

/// The normal force of a contact per unit of mass, and its derivatives in time.
pub(crate) struct NormalForce<T> {
    /// N, m/s^2.
    pub(crate) value: T,
    /// N'.
    pub(crate) rate: T,
    /// N''.
    pub(crate) second_derivative: T,
    /// u''.
    pub(crate) compression_acceleration: T,
}

impl<T: Real> NormalForce<T> {
    /// `acceleration` is that of the centre along the normal, with all forces and the turning of the
    /// frame.
    #[inline(always)]
    pub(crate) fn new(
        material: &Material<T>,
        kinematics: &ContactKinematics<T>,
        value: T,
        acceleration: T,
    ) -> Self {
        let compression_acceleration = -acceleration;
        let rate = material.damping * compression_acceleration
            - material.stiffness * kinematics.velocity.normal;
        let second_derivative =
            material.stiffness * compression_acceleration - material.damping * rate;
        Self {
            value,
            rate,
            second_derivative,
            compression_acceleration,
        }
    }

    /// Time until the force ends: until it is zero (an outgoing ball reaches zero force before zero
    /// compression) or, if it is zero already or is not predicted to reach zero, until the compression is zero.
    #[inline(always)]
    pub(crate) fn time_to_end(
        &self,
        params: &ModelParams<T>,
        material: &Material<T>,
        kinematics: &ContactKinematics<T>,
    ) -> EventTime<T> {
        let pressing = params.splat(FORCE_TOLERANCE_M_S2).lt(self.value);
        let (u, du, ddu) = (
            kinematics.compression.positive_part(),
            -kinematics.velocity.normal,
            self.compression_acceleration,
        );
        // Does N + N' t + N'' t^2/2 have a zero ahead?
        let real = (self.value * self.second_derivative * 2.0).le(self.rate.squared());
        let falls = self.rate.is_negative() | self.second_derivative.is_negative();
        let force_ends = pressing & real & falls;
        let end = first_root(
            params,
            self.value.select(force_ends, u),
            self.rate.select(force_ends, du),
            self.second_derivative.select(force_ends, ddu),
        );
        let time = end.time();
        let found = time.lt(params.ball.never_s) & !force_ends;
        // Where the compression ends: one Newton step on its Taylor polynomial, with u''' = -N' and
        // u'''' = -N''.
        let t = time.select(found, params.zero());
        let d3 = -self.rate;
        let d4 = -self.second_derivative;
        let value = u + t * (du + t * (ddu * 0.5 + t * (d3 * (1.0 / 6.0) + t * d4 * (1.0 / 24.0))));
        let slope = du + t * (ddu + t * (d3 * 0.5 + t * d4 * (1.0 / 6.0)));
        let refined = EventTime {
            numerator: value - t * slope,
            denominator: -slope,
        };
        let valid = slope.is_negative() & refined.numerator.is_positive() & found;
        // Where the force ends: a little beyond it, but not so far that a ball with little damping would
        // already have separated.
        let beyond = Real::min(
            end.numerator * OVERSHOOT,
            end.numerator + material.relaxation_time * end.denominator,
        );
        let coarse = EventTime {
            numerator: beyond.select(force_ends, end.numerator),
            denominator: end.denominator,
        };
        refined.select(valid, coarse)
    }
}

/// Whether the ball has left the solid: it moves away, and the rest of the compression takes at most 0.2 ms.
#[inline(always)]
pub(crate) fn has_separated<T: Real>(kinematics: &ContactKinematics<T>) -> T::Mask {
    let v = kinematics.velocity.normal;
    let fast = v.splat(FAST_M_S).lt(v);
    let threshold = v.splat(SEPARATED_FAST_M).select(fast, v.splat(SEPARATED_M));
    v.is_positive() & kinematics.compression.le(threshold)
}
