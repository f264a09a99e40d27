//! The first touch of the ring by a ball in free flight, found with certainty.
//!
//! It is the first root of `F(t) = (R_H - D)^2 + z^2 - reach^2`, where `D` is the distance from the
//! hoop's axis and the reach is the sum of the radii of ball and tube. The search skips the parts
//! of the arc with `|z| > reach` or `|D - R_H| > reach`. Elsewhere
//!
//! ```text
//! F'' = 2 (v_h^2 + v_z^2 - g z - R_H L^2/D^3),    L = x v_y - y v_x (constant in flight)
//! ```
//!
//! is bounded from below by some `-M`. Then the step `2 F/(sqrt(F'^2 + 2 M F) - F')` never passes a
//! root: grazes are found, however short. Where M = 0 (most shots) it is Newton's step.

use super::height_path::HeightPath;
use crate::math::real::{Mask, Real};
use crate::math::vector::{Vec2, Vec3};
use crate::model::constants_per_ball_mass::ModelParams;

/// F at which an approaching ball touches the ring, as a fraction of the square of the reach: a gap
/// of 6e-8 m. The last step goes on from there, so that the gap at a touch is less than 1e-12 m
/// where the ball does not graze the ring.
const TOUCH_TOLERANCE: f64 = 1e-6;
/// Shortest jump, s; a shorter one is left to the safe step.
const MIN_JUMP_S: f64 = 1e-9;
/// Shortest step of a ball that moves away from the ring, s.
const PARTING_STEP_S: f64 = 1e-6;
/// Limit on the iterations. The search needs one or two, seldom more than ten; a ball that parts
/// from the ring with hardly any speed can need hundreds.
const MAX_ITERATIONS: u32 = 10_000;

/// The horizontal motion of an arc: `D^2 = |p|^2 + 2 (p.v) t + |v|^2 t^2`.
pub(super) struct HorizontalMotion<T: Real> {
    speed_squared: T,
    /// p.v.
    dot: T,
    /// x v_y - y v_x.
    angular_momentum: T,
    distance_squared: T,
    /// The ball moves straight up or down.
    is_vertical: T::Mask,
    inverse_speed_squared: T,
    /// Square of the least distance from the axis, and its time.
    closest_squared: T,
    closest_time: T,
}

impl<T: Real> HorizontalMotion<T> {
    #[inline(always)]
    pub(super) fn new(params: &ModelParams<T>, p: Vec3<T>, v: Vec2<T>) -> Self {
        let (zero, one) = (params.zero(), params.one());
        let speed_squared = v.x.squared() + v.y.squared();
        let is_vertical = speed_squared.le(params.splat(1e-12));
        let inverse_speed_squared = one / one.select(is_vertical, speed_squared);
        let dot = p.x * v.x + p.y * v.y;
        let angular_momentum = p.x * v.y - p.y * v.x;
        Self {
            speed_squared,
            dot,
            angular_momentum,
            distance_squared: p.x.squared() + p.y.squared(),
            is_vertical,
            inverse_speed_squared,
            closest_squared: zero.select(
                is_vertical,
                angular_momentum.squared() * inverse_speed_squared,
            ),
            closest_time: -(dot * inverse_speed_squared),
        }
    }

    /// Square of half the time that the ball spends within `radius` of the axis; negative if it
    /// never comes so near.
    #[inline(always)]
    fn half_time_within_squared(&self, radius: T) -> T {
        (radius.squared() - self.closest_squared) * self.inverse_speed_squared
    }

    #[inline(always)]
    fn distance(&self, t: T) -> T {
        ((self.speed_squared * t + self.dot * 2.0) * t + self.distance_squared).sqrt()
    }
}

/// The parts of an arc in which no touch is possible, and the bound on F'' elsewhere.
struct SearchBounds<T> {
    /// Before this time a centre above z = reach does not fall through it.
    above_until: T,
    /// The centre rises through z = -reach, at this time or later.
    rises_through_minus_reach: T,
    /// The centre rises through z = reach, at this time or before.
    rises_through_reach: T,
    /// Times at which the centre enters and leaves the circle of radius `R_H - reach`.
    inner_enter: T,
    inner_leave: T,
    /// The part of -F''/2 that comes from the curvature of the ring.
    curvature_bound: T,
    /// The part from -z z''.
    height_bound: T,
    /// F at the start where it is negative (the small overlap that a separation leaves), zero
    /// elsewhere. It counts as zero: otherwise a ball that parts slowly would take tiny steps until
    /// it is free.
    overlap: T,
}

impl<T: Real> SearchBounds<T> {
    #[inline(always)]
    fn new(
        params: &ModelParams<T>,
        motion: &HorizontalMotion<T>,
        heights: &impl HeightPath<T>,
        (falls_to_reach, highest): (T, T),
    ) -> Self {
        let z = heights.first_height();
        let (ring_radius, reach) = (params.ring.radius, params.ring.reach);
        let inner = ring_radius - reach;
        let half_time = motion
            .half_time_within_squared(inner)
            .positive_part()
            .sqrt();
        let nearest = Real::max(inner.squared(), motion.closest_squared);
        let inward = ring_radius - motion.distance_squared.sqrt();
        let value = inward.squared() + z.squared() - reach.squared();
        let rises_through_reach = heights.rises_between(reach).1;
        Self {
            overlap: Real::min(value, value.zero()),
            height_bound: heights.acceleration_bound() * highest,
            above_until: Real::max(falls_to_reach, rises_through_reach),
            rises_through_minus_reach: heights.rises_between(-reach).0,
            rises_through_reach,
            inner_enter: (motion.closest_time - half_time)
                .select(!motion.is_vertical, -params.ball.never_s),
            inner_leave: (motion.closest_time + half_time)
                .select(!motion.is_vertical, params.ball.never_s),
            curvature_bound: ring_radius * motion.angular_momentum.squared()
                / (nearest * nearest.sqrt()),
        }
    }
}

/// Time of the first touch of the ring's circle before `search_end` (else never), and whether the
/// search reached its iteration limit. The time may be any variable in which the horizontal motion
/// is linear; `falls_to_reach` is what [`HeightPath::falls_through_after`] gives for the reach
/// above the hoop.
#[inline(always)]
pub(super) fn ring_time<T: Real>(
    params: &ModelParams<T>,
    motion: &HorizontalMotion<T>,
    heights: &impl HeightPath<T>,
    (falls_to_reach, search_end): ((T, T), T),
) -> (T, T::Mask) {
    let (zero, reach) = (params.zero(), params.ring.reach);
    let outer = params.ring.radius + reach;
    let outer_time_squared = motion.half_time_within_squared(outer);
    let half_time = outer_time_squared.positive_part().sqrt();
    let enter_time = motion.closest_time - half_time;
    let leave_time =
        (motion.closest_time + half_time).select(!motion.is_vertical, params.ball.never_s);
    let out_of_reach = !motion.is_vertical & outer_time_squared.is_negative()
        | motion.is_vertical & outer.squared().lt(motion.distance_squared);
    let stop = Real::min(search_end, leave_time);
    let mut t = enter_time.select(!motion.is_vertical, zero).positive_part();
    // Start when the ball has come near the ring and has fallen through z = reach. A ball that is
    // lower and still rising then (a release from beneath) starts when it has come near.
    let (z_then, _) = heights.height_and_rate(t);
    t = Real::max(falls_to_reach.0, t).select(reach.lt(z_then), t);

    let mut searching = t.lt(stop) & !out_of_reach;
    let mut found = params.ball.never_s;
    let mut iterations = 0;
    if searching.any() {
        let bounds = SearchBounds::new(params, motion, heights, falls_to_reach);
        while searching.any() && iterations < MAX_ITERATIONS {
            iterations += 1;
            let (touches, next) = search_step(params, motion, &bounds, heights, t);
            t = next.select(searching, t);
            searching = searching & t.lt(stop);
            found = t.select(touches & searching, found);
            searching = searching & !touches;
        }
    }
    (found, searching)
}

/// Whether the ball touches the ring right after the time `t`, and when; or the next time to look
/// at.
#[inline(always)]
fn search_step<T: Real>(
    params: &ModelParams<T>,
    motion: &HorizontalMotion<T>,
    bounds: &SearchBounds<T>,
    heights: &impl HeightPath<T>,
    t: T,
) -> (T::Mask, T) {
    let (zero, reach) = (params.zero(), params.ring.reach);
    let (z_t, vz_t) = heights.height_and_rate(t);
    let distance = motion.distance(t);
    let inward = params.ring.radius - distance;
    let value = inward.squared() + z_t.squared() - reach.squared() - bounds.overlap;
    let half_slope = z_t * vz_t
        - inward * (motion.speed_squared * t + motion.dot) / Real::max(distance, reach * 1e-3);
    let fall_squared = zero.select(vz_t.is_positive(), vz_t.squared());
    let half_bound =
        (bounds.curvature_bound + bounds.height_bound - motion.speed_squared - fall_squared)
            .positive_part();

    // With h = F'/2 and b = M/2: F + 2 h s - b s^2 >= 0 up to its first root s, F/(root - h) for a
    // closing ball and (root + h)/b otherwise.
    let root = (half_slope.squared() + half_bound * value.positive_part()).sqrt();
    let closing = half_slope.le(zero);
    let bounded = half_bound.is_positive();
    let numerator = value.select(
        closing,
        (half_slope + root).select(bounded, params.ball.never_s),
    );
    let denominator = (root - half_slope).select(closing, half_bound.select(bounded, params.one()));
    // A ball that parts with hardly any speed must get away from the ring. What this step passes
    // over is a graze of less than 1e-9 m.
    let min_step = zero.select(closing, params.splat(PARTING_STEP_S));
    let safe = t + Real::max(numerator / denominator, min_step);
    let touches = closing & value.le(reach.squared() * TOUCH_TOLERANCE);

    // Jumps over parts where no touch is possible.
    let below = z_t.lt(-reach) & vz_t.is_positive();
    let inside = distance.lt(params.ring.radius - reach);
    let above = reach.lt(z_t);
    let jump = Real::max(
        Real::max(
            bounds.above_until.select(above, zero),
            bounds.rises_through_minus_reach.select(below, zero),
        ),
        bounds.inner_leave.select(inside, zero),
    );
    let jumps = (t + MIN_JUMP_S).lt(jump);
    // The bound holds up to the inner circle and, for a rising ball, up to z = reach. Beyond them
    // comes a part to jump over.
    let reaches_inner = t.lt(bounds.inner_enter) & bounds.inner_enter.lt(safe);
    let reaches_top =
        t.lt(bounds.rises_through_reach) & bounds.rises_through_reach.lt(safe) & !reaches_inner;
    let step = bounds
        .inner_leave
        .select(reaches_inner, bounds.above_until.select(reaches_top, safe));
    (touches, safe.select(touches, jump.select(jumps, step)))
}
