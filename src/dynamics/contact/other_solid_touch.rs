//! The approach of a ball in contact to another solid.
//!
//! A step ignores the other solid. After it, the gap to that solid within the step is taken from
//! the cubic Hermite interpolant between both ends. A step that passed the solid is repeated,
//! shortened to the root of the cubic. The cubic errs by at most a few micrometres (`h^4/384` times
//! the fourth derivative of the gap, which is that of an oscillation of the contact). So a step
//! whose cubic comes closer than [`GRAZE_M`] is repeated too, shortened to the closest point: no
//! touch is lost.

use crate::math::real::{Mask, Real};
use crate::model::constants_per_ball_mass::ModelParams;
use crate::model::solids::Solid;
use crate::model::{BallState, SolidId};

/// Gap at which an approached solid counts as touched, m. A compression of this size changes the
/// speed of a bounce by less than 1e-6 m/s.
pub(crate) const ARRIVED_M: f64 = 2e-6;
/// Greatest overlap that counts as a new touch, m. With a deeper one the ball has come in front of
/// the paper's board from beside it, and the contact would begin fully compressed: it is ignored.
const MAX_OVERLAP_M: f64 = 1e-4;
/// A step that comes closer to a solid than this is repeated up to the closest point, m.
const GRAZE_M: f64 = 1e-5;
/// The least and the greatest fraction of a step that is repeated.
const MIN_FRACTION: f64 = 0.02;
const MAX_FRACTION: f64 = 0.98;
/// Newton steps to the root of the cubic.
const NEWTON_STEPS: u32 = 4;

/// Whether a ball in contact has reached another solid.
#[inline(always)]
pub(crate) fn has_arrived<T: Real, S: Solid<T>>(
    params: &ModelParams<T>,
    other: &S,
    state: &BallState<T>,
) -> T::Mask {
    let (gap, rate) = other.gap(&params.ball, state);
    let begins = params.splat(-MAX_OVERLAP_M).lt(gap) & gap.le(params.splat(ARRIVED_M));
    begins & rate.is_negative() & other.acts(state)
}

/// The gap to a solid at the end of a step, and its rate.
pub(crate) struct GapAtEnd<T: Real> {
    gap: T,
    rate: T,
    /// The step may have come to the solid.
    pub(crate) is_near: T::Mask,
}

impl<T: Real> GapAtEnd<T> {
    /// After a step to `after` on a path of at most `max_displacement`.
    #[inline(always)]
    pub(crate) fn new<O: Solid<T>>(
        params: &ModelParams<T>,
        other: &O,
        after: &BallState<T>,
        max_displacement: T,
    ) -> Self {
        let (gap, rate) = other.gap(&params.ball, after);
        Self {
            gap,
            rate,
            is_near: gap.lt(max_displacement) & other.acts(after),
        }
    }
}

/// Where a step of `dt` from `before` passes `other`, and after which part of the step it reaches
/// it (1 elsewhere).
#[inline(always)]
pub(crate) fn passed<T: Real, O: Solid<T>>(
    params: &ModelParams<T>,
    other: &O,
    before: &BallState<T>,
    end: &GapAtEnd<T>,
    dt: T,
) -> (T::Mask, T) {
    let one = params.one();
    let (gap_0, rate_0) = other.gap(&params.ball, before);
    let (gap_1, rate_1, near) = (end.gap, end.rate, end.is_near);
    let is_separated = params.splat(-ARRIVED_M).lt(gap_0);
    // gap_0 + a s + c s^2 + d s^3 at the fraction s of the step.
    let (a, b, change) = (rate_0 * dt, rate_1 * dt, gap_1 - gap_0);
    let c = change * 3.0 - a * 2.0 - b;
    let d = a + b - change * 2.0;
    let cubic = Cubic {
        gap: gap_0,
        a,
        c,
        d,
    };
    let passes = gap_1.lt(params.splat(-ARRIVED_M));
    let turns = a.is_negative() & b.is_positive();
    let root = (c.squared() - a * d * 3.0).positive_part().sqrt();
    let denominator = c + root;
    let closest = -a / denominator.select(denominator.is_positive(), one);
    let grazes = turns & !passes & cubic.value(closest).lt(params.splat(GRAZE_M));
    let mut fraction = gap_0.positive_part() / (gap_0 - gap_1).select(passes, one);
    for _ in 0..NEWTON_STEPS {
        let slope = cubic.slope(fraction);
        let falls = slope.is_negative();
        let next = fraction - cubic.value(fraction) / slope.select(falls, one);
        fraction = Real::max(
            Real::min(next.select(falls, fraction * 0.5), one),
            one.zero(),
        );
    }
    let fraction = closest.select(grazes, fraction);
    let fraction = Real::max(Real::min(fraction, one * MAX_FRACTION), one * MIN_FRACTION);
    let repeats = near & is_separated & (passes | grazes);
    (repeats, fraction.select(repeats, one))
}

/// How a step in the world frame came to the solids that the ball did not touch.
pub(crate) struct Approach<T: Real> {
    /// The step passed a solid, and is to be repeated.
    pub(crate) repeats: T::Mask,
    /// The fraction of it that is to be repeated; 1 elsewhere.
    pub(crate) fraction: T,
    /// The ball has arrived at each solid.
    pub(crate) arrived: [T::Mask; SolidId::COUNT],
}

/// The approach to other solids in a step of `dt` from the first state to the second.
#[inline(always)]
pub(crate) fn approach_in_world<T: Real, A: Solid<T>, B: Solid<T>>(
    params: &ModelParams<T>,
    solids: (&A, &B),
    touching: [T::Mask; SolidId::COUNT],
    (before, after): (&BallState<T>, &BallState<T>),
    dt: T,
) -> Approach<T> {
    let none = params.splat_mask(false);
    let mut approach = Approach {
        repeats: none,
        fraction: params.one(),
        arrived: [none; SolidId::COUNT],
    };
    let [on_first, on_second] = touching;
    if (on_first & on_second).all() {
        return approach;
    }
    let (v, u) = (before.velocity_m_s, after.velocity_m_s);
    let bound = v.x.abs() + v.y.abs() + v.z.abs() + (u.x.abs() + u.y.abs() + u.z.abs());
    let path = bound * dt;
    approach.look_at(params, solids.0, on_first, (before, after), (dt, path));
    approach.look_at(params, solids.1, on_second, (before, after), (dt, path));
    approach
}

impl<T: Real> Approach<T> {
    #[inline(always)]
    fn look_at<S: Solid<T>>(
        &mut self,
        params: &ModelParams<T>,
        solid: &S,
        is_touching: T::Mask,
        (before, after): (&BallState<T>, &BallState<T>),
        (dt, path): (T, T),
    ) {
        let end = GapAtEnd::new(params, solid, after, path);
        let looks = end.is_near & !is_touching;
        if !looks.any() {
            return;
        }
        let (repeats, fraction) = passed(params, solid, before, &end, dt);
        let repeats = repeats & looks;
        self.repeats = self.repeats | repeats;
        self.fraction = Real::min(fraction.select(repeats, self.fraction), self.fraction);
        self.arrived[S::ID.index()] = has_arrived(params, solid, after) & looks;
    }
}

/// The gap during a step.
struct Cubic<T> {
    gap: T,
    a: T,
    c: T,
    d: T,
}

impl<T: Real> Cubic<T> {
    #[inline(always)]
    fn value(&self, fraction: T) -> T {
        self.gap + fraction * (self.a + fraction * (self.c + fraction * self.d))
    }

    #[inline(always)]
    fn slope(&self, fraction: T) -> T {
        self.a + fraction * (self.c * 2.0 + fraction * self.d * 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::vector::Vec3;
    use crate::model::Physics;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]
        /// A ball on the ring that comes near the board and turns back within a step, as a
        /// parabola.
        #[test]
        fn prop_no_touch_of_the_other_solid_within_a_step_is_missed(
            gap in 1e-6..0.02_f64,
            rate in -6.0..-1e-3_f64,
            acceleration in -500.0..1500.0_f64,
            dt in 1e-4..4e-3_f64,
        ) {
            let params = ModelParams::new(&Physics::paper());
            let at = |t: f64| BallState {
                position_m: Vec3::new(
                    params.board.touch_x + gap + rate * t + 0.5 * acceleration * t * t,
                    0.03,
                    0.1,
                ),
                velocity_m_s: Vec3::new(rate + acceleration * t, 0.2, -0.5),
                spin_rad_s: Vec3::zeros(),
            };
            let (before, after) = (at(0.0), at(dt));
            let speed = |state: &BallState| state.velocity_m_s.abs().sum();
            let path = (speed(&before) + speed(&after)) * dt;
            let end = GapAtEnd::new(&params, &params.board, &after, path);
            let (repeats, fraction) = passed(&params, &params.board, &before, &end, dt);
            let turn = (-rate / acceleration).clamp(0.0, dt);
            let gap_at = |t: f64| params.board.gap(&params.ball, &at(t)).0;
            let min_gap = gap_at(turn).min(gap_at(dt));
            if min_gap < -2.0 * ARRIVED_M {
                prop_assert!(repeats);
            }
            if repeats {
                // The shorter step goes to the touch or to the closest point, or is one of several
                // towards it.
                let reached = gap_at(fraction * dt);
                prop_assert!(fraction < 1.0 && reached > min_gap - 1e-9);
                // A touch in the first hundredths of the step is passed by the shortest step.
                prop_assert!(reached < gap_at(0.0) + 1e-9 || fraction <= MIN_FRACTION);
            }
        }
    }
}
