//! The step that a ball can take without touching a convex body.

use crate::math::real::Real;

/// Gap at which an approaching ball touches, m.
pub(super) const TOUCH_M: f64 = 1e-11;
/// Shortest step of a ball that moves away.
pub(super) const PARTING_STEP: f64 = 1e-6;

/// Whether a ball with a gap G and its rate touches, and a step within which the gap cannot close:
/// `G'' >= -A`, with A the `acceleration_bound`.
#[inline(always)]
pub(super) fn gap_step<T: Real>(gap: T, rate: T, acceleration_bound: T) -> (T::Mask, T) {
    let zero = gap.zero();
    let closing = rate.is_negative();
    let open = gap.positive_part();
    let bound = Real::max(acceleration_bound, gap.splat(1e-9));
    let root = (rate.squared() + bound * open * 2.0).sqrt();
    let numerator = (open * 2.0).select(closing, rate + root);
    let denominator = (root - rate).select(closing, bound);
    let min_step = zero.select(closing, gap.splat(PARTING_STEP));
    let touches = closing & gap.le(gap.splat(TOUCH_M));
    (touches, Real::max(numerator / denominator, min_step))
}
