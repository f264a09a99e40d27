//! The normal motion of a ball on two solids, as power series.
//!
//! The force at each contact changes the normal velocities at both. With the directions of both
//! forces as at the start of a step, the compressions p and the normal velocities q obey
//!
//! ```text
//! p' = -q        q' = M N + G        N = k p - c q
//! ```
//!
//! `M` has ones on its diagonal; `G` is what does not depend on the normal forces. The series in
//! `tau = t/H`, the time in units of the longest step, follow term by term.

use super::contact_pair::{FIRST, SECOND, for_both};
use super::oscillator::parabola_root;
use crate::math::real::{Mask, Real};
use crate::model::solids::Material;

/// Terms of the series of the force. (With a sixth of a bounce for a step on two solids, and a
/// quarter on one, the next term is below 1e-5.)
const TERMS: usize = 8;
/// Newton steps to an event.
const NEWTON_STEPS: u32 = 2;

/// What the motion starts from.
pub(super) struct CoupledStart<'a, T> {
    pub(super) materials: &'a [Material<T>; 2],
    /// The normal acceleration at one contact for a unit of normal force at the other.
    pub(super) coupling: [T; 2],
    /// Compressions p, m.
    pub(super) compressions: [T; 2],
    /// Normal velocities q, m/s.
    pub(super) velocities: [T; 2],
    /// G, m/s^2.
    pub(super) accelerations: [T; 2],
}

/// The series of the normal forces and of the normal velocities.
pub(super) struct CoupledOscillators<T> {
    /// H, s.
    step_s: T,
    /// Coefficients of N, m/s^2.
    forces: [[T; TERMS]; 2],
    /// Coefficients of q, m/s.
    velocities: [[T; TERMS]; 2],
    /// p at the start, m.
    compressions: [T; 2],
}

/// A function of tau. An event happens where it falls through zero.
pub(super) struct EventSeries<T>([T; TERMS + 1]);

/// The slip along its direction while its rate is `rate + per_vn v_n + per_force N`.
pub(super) struct SlipModel<T> {
    pub(super) speed: T,
    /// Its rate without normal forces and normal velocity, m/s^2.
    pub(super) rate: T,
    /// Its change per displacement along the normal, 1/s.
    pub(super) per_vn: T,
    /// Its rate for a unit of normal force at each contact.
    pub(super) per_force: [T; 2],
}

impl<T: Real> CoupledOscillators<T> {
    #[inline(always)]
    pub(super) fn new(step_s: T, start: &CoupledStart<'_, T>) -> Self {
        let zero = step_s.zero();
        let (p, q) = (start.compressions, start.velocities);
        let (k, c) = (
            for_both!(i => start.materials[i].stiffness),
            for_both!(i => start.materials[i].damping),
        );
        let mut series = Self {
            step_s,
            forces: [[zero; TERMS]; 2],
            velocities: [[zero; TERMS]; 2],
            compressions: p,
        };
        let mut velocity = q;
        let mut force = for_both!(i => k[i] * p[i] - c[i] * q[i]);
        for term in 0..TERMS {
            for i in [0, 1] {
                series.forces[i][term] = force[i];
                series.velocities[i][term] = velocity[i];
            }
            let acceleration = for_both!(i => force[i] + start.coupling[i] * force[1 - i]);
            let acceleration = if term == 0 {
                for_both!(i => acceleration[i] + start.accelerations[i])
            } else {
                acceleration
            };
            let factor = 1.0 / (term + 1) as f64;
            let next = for_both!(i => step_s * acceleration[i] * factor);
            force = for_both!(i => -(k[i] * (step_s * velocity[i] * factor)) - c[i] * next[i]);
            velocity = next;
        }
        series
    }

    /// H, s.
    #[inline(always)]
    pub(super) fn step_s(&self) -> T {
        self.step_s
    }

    /// N of a contact at `tau`, m/s^2.
    #[inline(always)]
    pub(super) fn force(&self, contact: usize, tau: T) -> T {
        let terms = &self.forces[contact];
        let mut sum = terms[TERMS - 1];
        for term in terms[..TERMS - 1].iter().rev() {
            sum = sum * tau + *term;
        }
        sum
    }

    /// The first and the second integral of N over time, m/s and m.
    #[inline(always)]
    pub(super) fn impulse_and_displacement(&self, contact: usize, tau: T) -> (T, T) {
        let terms = &self.forces[contact];
        let (mut impulse, mut path) = (tau.zero(), tau.zero());
        for term in (0..TERMS).rev() {
            let (n, n_1) = ((term + 1) as f64, (term + 2) as f64);
            impulse = impulse * tau + terms[term] * (1.0 / n);
            path = path * tau + terms[term] * (1.0 / (n * n_1));
        }
        let time = self.step_s * tau;
        (impulse * time, path * time * time)
    }

    /// Whether the normal force of a contact grows.
    #[inline(always)]
    pub(super) fn is_loading(&self, contact: usize) -> T::Mask {
        self.forces[contact][1].is_positive()
    }

    /// The compression of a contact.
    #[inline(always)]
    pub(super) fn compression_series(&self, contact: usize) -> EventSeries<T> {
        let mut terms = [self.compressions[contact]; TERMS + 1];
        for term in 0..TERMS {
            let factor = self.step_s * (-1.0 / (term + 1) as f64);
            terms[term + 1] = self.velocities[contact][term] * factor;
        }
        EventSeries(terms)
    }

    /// `factor N - constant` of a contact.
    #[inline(always)]
    pub(super) fn force_series(&self, contact: usize, factor: T, constant: T) -> EventSeries<T> {
        let mut terms = [factor.zero(); TERMS + 1];
        for (term, force) in terms.iter_mut().zip(&self.forces[contact]) {
            *term = *force * factor;
        }
        terms[0] = terms[0] - constant;
        EventSeries(terms)
    }

    /// The slip of a contact along its direction at the start.
    #[inline(always)]
    pub(super) fn slip_series(&self, contact: usize, slip: &SlipModel<T>) -> EventSeries<T> {
        let EventSeries(compression) = self.compression_series(contact);
        let [first, second] = slip.per_force;
        let mut terms = [slip.speed; TERMS + 1];
        for term in 0..TERMS {
            let factor = self.step_s * (1.0 / (term + 1) as f64);
            let force = first * self.forces[0][term] + second * self.forces[1][term];
            terms[term + 1] = force * factor - slip.per_vn * compression[term + 1];
        }
        terms[1] = terms[1] + slip.rate * self.step_s;
        EventSeries(terms)
    }
}

impl<T: Real> EventSeries<T> {
    /// `self` where `condition` holds, `other` elsewhere.
    #[inline(always)]
    pub(super) fn select(&self, condition: T::Mask, other: &Self) -> Self {
        let mut terms = self.0;
        for (term, other) in terms.iter_mut().zip(&other.0) {
            *term = term.select(condition, *other);
        }
        Self(terms)
    }

    #[inline(always)]
    fn value_and_slope(&self, tau: T) -> (T, T) {
        let mut value = self.0[TERMS];
        let mut slope = tau.zero();
        for term in self.0[..TERMS].iter().rev() {
            slope = slope * tau + value;
            value = value * tau + *term;
        }
        (value, slope)
    }

    /// Whether the function falls to zero within (0, `until`] where `possible`, and about where (1
    /// elsewhere).
    #[inline(always)]
    pub(super) fn first_root(&self, until: T, possible: T::Mask) -> (T::Mask, T) {
        let one = until.one();
        let (last, _) = self.value_and_slope(until);
        let falls = possible & last.le(until.zero());
        if !falls.any() {
            return (falls, one);
        }
        let first = self.0[0].positive_part();
        let root = parabola_root(first, self.0[1] * until, last) * until;
        (falls, root.select(falls, one))
    }

    /// The root near `tau`.
    #[inline(always)]
    pub(super) fn refined_root(&self, mut tau: T) -> T {
        for _ in 0..NEWTON_STEPS {
            let (value, slope) = self.value_and_slope(tau);
            let usable = slope.is_negative();
            let next = tau - value / slope.select(usable, tau.one());
            let inside = next.is_positive() & next.le(tau.one());
            tau = next.select(usable & inside, tau);
        }
        tau
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Physics;
    use crate::model::constants_per_ball_mass::ModelParams;

    /// Authority: the same equations by RK4 in 2000 steps.
    #[test]
    fn val_the_series_are_the_coupled_oscillation() {
        let params = ModelParams::new(&Physics::paper());
        let materials = [params.board.material, params.ring.material];
        let step_s = Physics::paper().contact_time_s() / 5.0;
        for coupling in [[0.0, 0.0], [0.6, 0.6], [-0.4, 0.9]] {
            let start = CoupledStart {
                materials: &materials,
                coupling,
                compressions: [0.004, 0.001],
                velocities: [-1.0, 2.0],
                accelerations: [30.0, -20.0],
            };
            let series = CoupledOscillators::new(step_s, &start);
            let force = |y: [f64; 4], i: usize| {
                materials[i].stiffness * y[i] - materials[i].damping * y[2 + i]
            };
            let rates = |y: [f64; 4]| {
                let n = [force(y, 0), force(y, 1)];
                [
                    -y[2],
                    -y[3],
                    n[0] + coupling[0] * n[1] + start.accelerations[0],
                    n[1] + coupling[1] * n[0] + start.accelerations[1],
                ]
            };
            let mut y = [0.004, 0.001, -1.0, 2.0];
            let steps = 2000;
            let h = step_s / f64::from(steps);
            let euler = |y: [f64; 4], k: [f64; 4], h: f64| [0, 1, 2, 3].map(|i| y[i] + h * k[i]);
            for _ in 0..steps {
                let k1 = rates(y);
                let k2 = rates(euler(y, k1, 0.5 * h));
                let k3 = rates(euler(y, k2, 0.5 * h));
                let k4 = rates(euler(y, k3, h));
                y = [0, 1, 2, 3].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]));
            }
            for i in [0, 1] {
                let (p, _) = series.compression_series(i).value_and_slope(1.0);
                assert!((p - y[i]).abs() < 1e-7, "{coupling:?} {i}: {p} {}", y[i]);
                let n = series.force(i, 1.0);
                assert!((n - force(y, i)).abs() < 0.03, "{coupling:?} {i}: {n}");
                // The velocity of the centre along the normal is the sum of the impulses.
                let impulse = |i: usize| series.impulse_and_displacement(i, 1.0).0;
                let q = start.velocities[i]
                    + start.accelerations[i] * step_s
                    + impulse(i)
                    + coupling[i] * impulse(1 - i);
                assert!(
                    (q - y[2 + i]).abs() < 1e-5,
                    "{coupling:?} {i}: {q} {}",
                    y[2 + i]
                );
                let path = |i: usize| series.impulse_and_displacement(i, 1.0).1;
                let moved = start.velocities[i] * step_s
                    + 0.5 * start.accelerations[i] * step_s * step_s
                    + path(i)
                    + coupling[i] * path(1 - i);
                assert!((start.compressions[i] - moved - y[i]).abs() < 1e-7);
            }
        }
    }
}
