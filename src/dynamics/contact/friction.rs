//! How friction acts at a contact, and when it changes.

use super::event_time::{EventTime, OVERSHOOT, first_root};
use super::normal_force::NormalForce;
use crate::math::real::{Mask, Real};
use crate::model::constants_per_ball_mass::ModelParams;

/// A slip speed up to this counts as zero, m/s.
pub(crate) const SLIP_TOLERANCE_M_S: f64 = 1e-9;
/// A step that is meant to end the slip may leave this fraction of it. Friction's own impulse removes the
/// rest. (With 0.05 there were more steps and no better agreement.)
const SLIP_REMAINDER: f64 = 0.2;
/// In a step that ends the slip, a stage with less than this fraction of the initial slip keeps the
/// initial direction: at zero slip the sliding law has none.
pub(crate) const DIRECTION_SLIP_FRACTION: f64 = 0.1;

/// How friction acts at a contact. It is carried from step to step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionState<T: Real = f64> {
    /// The ball rolls: the slip is zero and stays zero.
    pub(crate) rolling: T::Mask,
    /// Rolling needed more than mu N. The ball slides until N grows again; otherwise it would switch
    /// between the two in tiny steps.
    pub(crate) rolling_failed: T::Mask,
    /// A slip speed up to this counts as zero: what a step meant to end at zero slip may leave, m/s.
    pub(crate) slip_tolerance: T,
}

impl<T: Real> FrictionState<T> {
    /// A contact that has just begun.
    #[inline(always)]
    pub(crate) fn new(params: &ModelParams<T>) -> Self {
        let no_lanes = params.splat_mask(false);
        Self {
            rolling: no_lanes,
            rolling_failed: no_lanes,
            slip_tolerance: params.splat(SLIP_TOLERANCE_M_S),
        }
    }
}

impl<T: Real> FrictionState<T> {
    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, condition: T::Mask, other: Self) -> Self {
        Self {
            rolling: Mask::select(self.rolling, condition, other.rolling),
            rolling_failed: Mask::select(self.rolling_failed, condition, other.rolling_failed),
            slip_tolerance: self.slip_tolerance.select(condition, other.slip_tolerance),
        }
    }
}

impl<T: Real<Mask = bool>> FrictionState<T> {
    /// The same in another number type.
    #[inline(always)]
    pub(crate) fn map<U: Real<Mask = bool>>(&self, convert: impl Fn(T) -> U) -> FrictionState<U> {
        FrictionState {
            rolling: self.rolling,
            rolling_failed: self.rolling_failed,
            slip_tolerance: convert(self.slip_tolerance),
        }
    }
}

/// The slip speed up to which the slip counts as zero after a step from the slip `speed`. It is larger where
/// the step was meant to end the slip: [`SLIP_REMAINDER`] of it, and at least `at_least` m/s.
#[inline(always)]
pub(crate) fn slip_tolerance_after<T: Real>(ends_slip: T::Mask, speed: T, at_least: f64) -> T {
    let remainder = Real::max(speed * SLIP_REMAINDER, speed.splat(at_least));
    remainder.select(ends_slip, speed.splat(SLIP_TOLERANCE_M_S))
}

/// The quantities that decide when friction changes between sliding and rolling.
pub(crate) struct FrictionBalance<T> {
    /// Slip speed.
    pub(crate) slip: T,
    /// Rate of the slip speed while the ball slides.
    pub(crate) slip_rate: T,
    /// Rate of the slip for a unit of friction per unit of mass.
    pub(crate) inverse_effective_mass: T,
    /// mu N less the friction that rolling needs.
    pub(crate) friction_reserve: T,
    /// Derivative of the friction that rolling needs with respect to u'. (Its other changes are slow.)
    pub(crate) d_required_d_compression_rate: T,
}

impl<T: Real> FrictionBalance<T> {
    /// Time until friction changes: the slip reaches zero, or rolling needs more than mu N.
    #[inline(always)]
    pub(crate) fn time_to_change(
        &self,
        params: &ModelParams<T>,
        friction_coefficient: T,
        force: &NormalForce<T>,
        rolling: T::Mask,
    ) -> EventTime<T> {
        let limit_rate = friction_coefficient * force.rate;
        let slip_second_derivative = -(limit_rate * self.inverse_effective_mass);
        let required_rate = self.d_required_d_compression_rate * force.compression_acceleration;
        let c0 = self.friction_reserve.select(rolling, self.slip);
        let c1 = (limit_rate - required_rate).select(rolling, self.slip_rate);
        let c2 = (friction_coefficient * force.second_derivative)
            .select(rolling, slip_second_derivative);
        let possible = c0.is_positive() | rolling;
        first_root(params, c0, c1, c2)
            .scaled(params.splat(OVERSHOOT).select(rolling, params.one()))
            .select(possible, EventTime::never(params))
    }
}
