//! Times until predicted events, compared as fractions.

use crate::math::real::Real;
use crate::model::constants_per_ball_mass::ModelParams;

/// A step meant to end rolling or the normal force is longer than predicted by this factor. Otherwise the next
/// step could start just before the event again.
pub(crate) const OVERSHOOT: f64 = 1.03;

/// The time until an event, as a fraction. The earliest of several events is found without a division,
/// which costs as much as a dozen multiplications.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EventTime<T> {
    pub(super) numerator: T,
    /// Positive.
    pub(super) denominator: T,
}

impl<T: Real> EventTime<T> {
    /// After `time`.
    #[inline(always)]
    fn after(time: T) -> Self {
        Self {
            numerator: time,
            denominator: time.one(),
        }
    }

    /// Never.
    #[inline(always)]
    pub(crate) fn never(params: &ModelParams<T>) -> Self {
        Self::after(params.ball.never_s)
    }

    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    pub(crate) fn select(self, condition: T::Mask, other: Self) -> Self {
        Self {
            numerator: self.numerator.select(condition, other.numerator),
            denominator: self.denominator.select(condition, other.denominator),
        }
    }

    /// `self <= other`.
    #[inline(always)]
    pub(crate) fn le(self, other: Self) -> T::Mask {
        (self.numerator * other.denominator).le(other.numerator * self.denominator)
    }

    /// The earlier of two events.
    #[inline(always)]
    pub(crate) fn min(self, other: Self) -> Self {
        self.select(self.le(other), other)
    }

    /// The event, or `longest` if that is earlier.
    #[inline(always)]
    pub(crate) fn at_most(self, longest: T) -> Self {
        let earlier = self.numerator.le(longest * self.denominator);
        self.select(earlier, Self::after(longest))
    }

    /// The event at `factor` times its time.
    #[inline(always)]
    pub(super) fn scaled(self, factor: T) -> Self {
        Self {
            numerator: self.numerator * factor,
            denominator: self.denominator,
        }
    }

    /// The time.
    #[inline(always)]
    pub(crate) fn time(self) -> T {
        self.numerator / self.denominator
    }
}

/// The smallest positive zero of `c0 + c1 t + c2 t^2/2` with `c0 > 0`.
#[inline(always)]
pub(crate) fn first_root<T: Real>(params: &ModelParams<T>, c0: T, c1: T, c2: T) -> EventTime<T> {
    let discriminant = c1.squared() - c0 * c2 * 2.0;
    let slope = discriminant.positive_part().sqrt() - c1;
    let exists = discriminant.zero().le(discriminant) & slope.is_positive();
    let root = EventTime {
        numerator: c0 * 2.0,
        denominator: slope,
    };
    root.select(exists, EventTime::never(params))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Physics;
    use proptest::prelude::*;

    fn params() -> ModelParams {
        ModelParams::new(&Physics::paper())
    }

    proptest! {
        #[test]
        fn prop_the_earliest_fraction_is_the_earliest_time(
            a in (0.0..1.0, 1e-3..10.0),
            b in (0.0..1.0, 1e-3..10.0),
            longest in 1e-6..1.0,
        ) {
            let [a, b] = [a, b].map(|(numerator, denominator)| EventTime { numerator, denominator });
            let never = EventTime::never(&params());
            let close = |x: f64, y: f64| (x - y).abs() <= 1e-15 * y;
            prop_assert!(close(a.min(b).time(), a.time().min(b.time())));
            prop_assert!(close(never.min(b).time(), b.time()));
            prop_assert!(close(a.at_most(longest).time(), a.time().min(longest)));
        }
    }
}
