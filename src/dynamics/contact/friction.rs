//! How friction acts at a contact, and when it changes.

use super::event_time::{EventTime, OVERSHOOT, first_root};
use super::normal_force::NormalForce;
use crate::math::real::Real;
use crate::model::model_params::ModelParams;

/// Slip speed that counts as zero, m/s.
const ZERO_SLIP_M_S: f64 = 1e-9;
/// A step that is meant to end the slip may leave this fraction of it. Friction's own impulse removes the
/// rest. (With 0.05 there were more steps and no better agreement.)
const SLIP_REMAINDER: f64 = 0.2;
/// In a step that ends the slip, a stage with less than this fraction of the initial slip keeps the
/// initial direction: at zero slip the sliding law has none.
pub(crate) const SLIP_DIRECTION_LOST: f64 = 0.1;

/// How friction acts at a contact. It is carried from step to step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrictionState<R: Real = f64> {
    /// The ball rolls: the slip is zero and stays zero.
    pub(crate) rolling: R::Mask,
    /// Rolling needed more than mu N. The ball slides until N grows again; otherwise it would switch
    /// between the two in tiny steps.
    pub(crate) exceeded: R::Mask,
    /// Slip speed that counts as zero: what a step meant to end at zero slip may leave, m/s.
    pub(crate) zero_slip: R,
}

impl<R: Real> FrictionState<R> {
    /// A contact that has just begun.
    #[inline(always)]
    pub(crate) fn new(params: &ModelParams<R>) -> Self {
        let no = params.splat_mask(false);
        Self {
            rolling: no,
            exceeded: no,
            zero_slip: params.splat(ZERO_SLIP_M_S),
        }
    }
}

/// Slip speed that counts as zero after a step from the slip `speed`. It is larger where the step was
/// meant to end the slip: [`SLIP_REMAINDER`] of it, and at least `at_least` m/s.
#[inline(always)]
pub(crate) fn zero_slip_after<R: Real>(ends_slip: R::Mask, speed: R, at_least: f64) -> R {
    let remainder = Real::max(speed * SLIP_REMAINDER, speed.splat(at_least));
    remainder.select(ends_slip, speed.splat(ZERO_SLIP_M_S))
}

/// The quantities that decide when friction changes between sliding and rolling.
pub(crate) struct FrictionBalance<R> {
    /// Slip speed.
    pub(crate) slip: R,
    /// Rate of the slip speed while the ball slides.
    pub(crate) slip_rate: R,
    /// Rate of the slip for a unit of friction per unit of mass.
    pub(crate) slip_compliance: R,
    /// mu N less the friction that rolling needs.
    pub(crate) reserve: R,
    /// Derivative of the friction that rolling needs with respect to u''. (Its other changes are slow.)
    pub(crate) d_need_d_compression_acceleration: R,
}

impl<R: Real> FrictionBalance<R> {
    /// Time until friction changes: the slip reaches zero, or rolling needs more than mu N.
    #[inline(always)]
    pub(crate) fn time_to_change(
        &self,
        params: &ModelParams<R>,
        friction: R,
        force: &NormalForce<R>,
        rolling: R::Mask,
    ) -> EventTime<R> {
        let limit_rate = friction * force.rate;
        let slip_curve = -(limit_rate * self.slip_compliance);
        let need_rate = self.d_need_d_compression_acceleration * force.compression_acceleration;
        let c0 = self.reserve.select(rolling, self.slip);
        let c1 = (limit_rate - need_rate).select(rolling, self.slip_rate);
        let c2 = (friction * force.curve).select(rolling, slip_curve);
        let possible = c0.is_positive() | rolling;
        first_root(params, c0, c1, c2)
            .scaled(params.splat(OVERSHOOT).select(rolling, params.one()))
            .select(possible, EventTime::never(params))
    }
}
