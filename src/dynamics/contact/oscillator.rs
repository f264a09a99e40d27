//! The normal motion of a ball pressed against a solid, in closed form.
//!
//! With a constant acceleration `G` along the normal besides the normal force, the compression
//! obeys `u'' + c u' + k u = -G`: a damped oscillation about `-G/k`. With `x = u + G/k` and `v =
//! -u'`
//!
//! ```text
//! x(t) = x0 (C + a S) - v0 S        C = exp(-a t) cos(w t)          a = c/2
//! v(t) = v0 (C - a S) + k x0 S      S = exp(-a t) sin(w t)/w        w^2 = k - a^2
//! ```
//!
//! `C` and `S` are polynomials of `tau = t/H`, the time in units of the longest step. Their
//! coefficients are the same for all shots. They interpolate at Chebyshev nodes: with three steps
//! in a bounce they err by 1e-7 at most.

use crate::math::real::Real;
use crate::model::solids::Material;

/// Degree of the polynomials, without their constant terms.
const DEGREE: usize = 6;
/// [`Oscillator::rolling_margin`] with [`COARSE_STEPS`]: relative, and in m/s^2. This and the next
/// were tuned for the agreement of made and missed with steps that are 250 times finer.
const ROLLING_MARGIN: (f64, f64) = (0.1, 2.0);
/// [`Oscillator::slip_remainder`] with [`COARSE_STEPS`].
const SLIP_REMAINDER: (f64, f64) = (0.25, 2e-4);
/// Steps per contact at which both hold; with finer steps they are smaller.
const COARSE_STEPS: f64 = 5.0;
/// With at most this many steps a contact, the last step may cross N = 0. Its error (1e-4 m/s) does
/// not fall with the step. So with more steps, a step also ends at N = 0.
const MAX_STEPS_CROSSING_ZERO_FORCE: f64 = 10.0;

/// The oscillation over steps of at most `step_s`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oscillator<T = f64> {
    /// The longest step H, s.
    pub(crate) step_s: T,
    /// 1/H, 1/s.
    pub(crate) inverse_step: T,
    /// Coefficients of (C - 1)/tau and S/tau, from the lowest.
    cosine: [T; DEGREE],
    sine: [T; DEGREE],
    /// C and S at tau = 1.
    end: (T, T),
    /// a, 1/s.
    half_damping: T,
    /// w^2, 1/s^2.
    frequency_squared: T,
    /// 1/k, s^2.
    pub(crate) inverse_stiffness: T,
    /// c/k in units of H: about the time from zero force to zero compression of an outgoing ball.
    pub(crate) relaxation: T,
    /// A factor, and a margin in m/s^2: while N falls, a roll ends where mu N is less than the
    /// factor times the friction that rolling needs, plus the margin. Otherwise a tiny step would
    /// follow, to the point where mu N is too small.
    pub(crate) rolling_margin: (T, T),
    /// A step that ends the slip may leave this fraction of it, and at least this much (m/s).
    /// An impulse of friction then sets the rest to zero.
    pub(crate) slip_remainder: (T, T),
    /// Half a step, s.
    pub(crate) half_step_s: T,
    /// A step also ends where the normal force reaches zero.
    pub(crate) stops_at_zero_force: bool,
}

impl Oscillator {
    /// For `steps` steps in half an undamped period.
    pub(crate) fn new(material: &Material<f64>, steps: f64) -> Self {
        let (stiffness, damping) = (material.stiffness, material.damping);
        let step_s = std::f64::consts::PI / (stiffness.sqrt() * steps);
        let half_damping = 0.5 * damping;
        let kh2 = stiffness * step_s * step_s;
        let series = |f0: f64, f1: f64| polynomial(damping * step_s, kh2, f0, f1 * step_s);
        let (cosine, sine) = (series(1.0, -half_damping), series(0.0, 1.0));
        // The error of a step falls with its square, and so must this.
        let coarseness = (COARSE_STEPS / steps) * (COARSE_STEPS / steps);
        Self {
            step_s,
            inverse_step: 1.0 / step_s,
            end: (1.0 + cosine.iter().sum::<f64>(), sine.iter().sum()),
            cosine,
            sine,
            half_damping,
            frequency_squared: stiffness - half_damping * half_damping,
            inverse_stiffness: 1.0 / stiffness,
            relaxation: damping / stiffness / step_s,
            rolling_margin: (
                1.0 + ROLLING_MARGIN.0 * coarseness,
                ROLLING_MARGIN.1 * coarseness,
            ),
            slip_remainder: (
                SLIP_REMAINDER.0 * COARSE_STEPS / steps,
                SLIP_REMAINDER.1 * COARSE_STEPS / steps,
            ),
            half_step_s: 0.5 * step_s,
            stops_at_zero_force: steps > MAX_STEPS_CROSSING_ZERO_FORCE,
        }
    }

    /// The oscillator with `f` applied to every constant.
    #[inline(always)]
    pub(crate) fn map<T: Real>(&self, f: impl Fn(f64) -> T) -> Oscillator<T> {
        Oscillator {
            step_s: f(self.step_s),
            inverse_step: f(self.inverse_step),
            cosine: self.cosine.map(&f),
            sine: self.sine.map(&f),
            end: (f(self.end.0), f(self.end.1)),
            half_damping: f(self.half_damping),
            frequency_squared: f(self.frequency_squared),
            inverse_stiffness: f(self.inverse_stiffness),
            relaxation: f(self.relaxation),
            rolling_margin: (f(self.rolling_margin.0), f(self.rolling_margin.1)),
            slip_remainder: (f(self.slip_remainder.0), f(self.slip_remainder.1)),
            half_step_s: f(self.half_step_s),
            stops_at_zero_force: self.stops_at_zero_force,
        }
    }
}

impl<T: Real> Oscillator<T> {
    /// C and S at `tau`.
    #[inline(always)]
    pub(crate) fn at(&self, tau: T) -> (T, T) {
        let (c, s) = (&self.cosine, &self.sine);
        let (mut cosine, mut sine) = (c[DEGREE - 1], s[DEGREE - 1]);
        for j in (0..DEGREE - 1).rev() {
            cosine = cosine * tau + c[j];
            sine = sine * tau + s[j];
        }
        (cosine * tau + 1.0, sine * tau)
    }

    /// C and S at tau = 1.
    #[inline(always)]
    pub(crate) fn at_end(&self) -> (T, T) {
        self.end
    }

    /// C and S at the half of `tau` and at `tau`.
    #[inline(always)]
    pub(crate) fn at_half_and_whole(&self, tau: T) -> [(T, T); 2] {
        let (cosine, sine) = self.at(tau * 0.5);
        let double = (
            cosine.squared() - sine.squared() * self.frequency_squared,
            sine * cosine * 2.0,
        );
        [(cosine, sine), double]
    }
}

/// Coefficients of `(f(tau) - f0)/tau`, where `f'' = -ch f' - kh2 f`, `f(0) = f0` and `f'(0) = f1`.
fn polynomial(ch: f64, kh2: f64, f0: f64, f1: f64) -> [f64; DEGREE] {
    /// Terms of the Taylor series, enough for the longest step.
    const TERMS: u32 = 30;
    let quotient = |tau: f64| {
        let (mut before, mut term) = (f0, f1);
        let (mut sum, mut power) = (f1, 1.0);
        for n in 2..TERMS {
            let n = f64::from(n);
            (before, term) = (
                term,
                -(ch * (n - 1.0) * term + kh2 * before) / (n * (n - 1.0)),
            );
            power *= tau;
            sum += term * power;
        }
        sum
    };
    let nodes: [f64; DEGREE] = std::array::from_fn(|i| {
        let angle = (i as f64 + 0.5) * std::f64::consts::PI / DEGREE as f64;
        0.5 - 0.5 * libm::cos(angle)
    });
    // Newton's divided differences, expanded from the last node inwards.
    let mut differences = nodes.map(quotient);
    for level in 1..DEGREE {
        for i in (level..DEGREE).rev() {
            differences[i] = (differences[i] - differences[i - 1]) / (nodes[i] - nodes[i - level]);
        }
    }
    let mut coefficients = [0.0; DEGREE];
    for i in (0..DEGREE).rev() {
        for j in (0..DEGREE).rev() {
            let lower = if j > 0 {
                coefficients[j - 1]
            } else {
                differences[i]
            };
            coefficients[j] = lower - nodes[i] * coefficients[j];
        }
    }
    coefficients
}

/// The normal motion from the start of a step.
#[derive(Clone, Copy)]
pub(crate) struct NormalMotion<T> {
    /// x at the start, m.
    pub(crate) displacement: T,
    /// v at the start, m/s.
    pub(crate) velocity: T,
}

impl<T: Real> NormalMotion<T> {
    /// x and v after a time with the given C and S.
    #[inline(always)]
    pub(crate) fn after(
        &self,
        material: &Material<T>,
        oscillator: &Oscillator<T>,
        (cosine, sine): (T, T),
    ) -> (T, T) {
        let damped = sine * oscillator.half_damping;
        (
            self.displacement * (cosine + damped) - self.velocity * sine,
            self.velocity * (cosine - damped) + material.stiffness * (self.displacement * sine),
        )
    }
}

/// A function `displacement x + velocity v + constant + rate tau` of the normal motion. An event
/// happens where it falls through zero.
#[derive(Clone, Copy)]
pub(crate) struct EventFunction<T> {
    pub(crate) displacement: T,
    pub(crate) velocity: T,
    pub(crate) constant: T,
    pub(crate) rate: T,
}

impl<T: Real> EventFunction<T> {
    /// The value where the normal motion is at `(x, v)`.
    #[inline(always)]
    pub(crate) fn value(&self, (x, v): (T, T), tau: T) -> T {
        self.displacement * x + self.velocity * v + self.constant + self.rate * tau
    }

    /// The derivative with respect to tau.
    #[inline(always)]
    fn slope(&self, material: &Material<T>, step_s: T, (x, v): (T, T)) -> T {
        let acceleration = material.stiffness * x - material.damping * v;
        (self.velocity * acceleration - self.displacement * v) * step_s + self.rate
    }

    /// The first tau in (0, `until`] at which the function is zero. It must not be negative at 0,
    /// and its value `last` at `until` must not be positive: the root of a parabola, then Newton
    /// steps.
    #[inline(always)]
    pub(crate) fn first_root(
        &self,
        material: &Material<T>,
        oscillator: &Oscillator<T>,
        motion: &NormalMotion<T>,
        (until, last): (T, T),
        newton_steps: u32,
    ) -> T {
        let (zero, one) = (until.zero(), until.one());
        let start = (motion.displacement, motion.velocity);
        let first = self.value(start, zero).positive_part();
        let slope = self.slope(material, oscillator.step_s, start) * until;
        let mut tau = parabola_root(first, slope, last) * until;
        for _ in 0..newton_steps {
            let now = motion.after(material, oscillator, oscillator.at(tau));
            let slope = self.slope(material, oscillator.step_s, now);
            let usable = slope.is_negative();
            let next = tau - self.value(now, tau) / slope.select(usable, one);
            // Where the function is nearly level a step may lead anywhere: then the parabola is
            // better.
            let inside = next.is_positive() & next.le(until);
            tau = next.select(usable & inside, tau);
        }
        tau
    }
}

/// The first root in [0, 1] of the parabola with the value `first` (not negative) and the slope
/// `slope` at 0, and the value `last` (not positive) at 1.
#[inline(always)]
pub(super) fn parabola_root<T: Real>(first: T, slope: T, last: T) -> T {
    let (zero, one) = (first.zero(), first.one());
    let curve = last - first - slope;
    let root = (slope.squared() - first * curve * 4.0)
        .positive_part()
        .sqrt();
    let falls = curve.is_negative();
    let numerator = (slope + root).select(falls, first * 2.0);
    let denominator = (curve * -2.0).select(falls, root - slope);
    let denominator = denominator.select(denominator.is_positive(), one);
    Real::max(Real::min(numerator / denominator, one), zero)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Physics;
    use crate::model::constants_per_ball_mass::ModelParams;

    /// Authority: the closed form.
    #[test]
    fn val_the_polynomials_are_the_oscillation() {
        for restitution in [1.0, 0.8, 0.3, 0.01] {
            let physics = Physics::with_restitution(restitution).unwrap();
            let material = ModelParams::new(&physics).board.material;
            let a = 0.5 * material.damping;
            let w = (material.stiffness - a * a).sqrt();
            for (steps, allowed) in [(3.0, 2e-6), (5.0, 1e-7), (1000.0, 1e-15)] {
                let oscillator = Oscillator::new(&material, steps);
                for i in 0..=20 {
                    let tau = 0.05 * f64::from(i);
                    let t = tau * oscillator.step_s;
                    let decay = libm::exp(-a * t);
                    let (cosine, sine) = (decay * libm::cos(w * t), decay * libm::sin(w * t) / w);
                    let (c, s) = oscillator.at(tau);
                    assert!((c - cosine).abs() <= allowed, "{restitution} {steps} {tau}");
                    assert!(
                        ((s - sine) * w).abs() <= allowed,
                        "{restitution} {steps} {tau}"
                    );
                    let [_, (c, s)] = oscillator.at_half_and_whole(tau);
                    assert!((c - cosine).abs() <= allowed && ((s - sine) * w).abs() <= allowed);
                }
            }
        }
    }
}
