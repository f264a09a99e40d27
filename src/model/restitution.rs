//! Damping and restitution of the linear visco-elastic ball (the paper's Appendix 1).
//!
//! With `alpha = c/(2m)` and `omega = sqrt(k/m - alpha^2)`, a head-on contact lasts `pi/omega` and
//! returns the fraction `gamma = exp(-pi alpha/omega)` of the speed.
//!
//! Solved for c: with `L = -ln(gamma)/pi`, `alpha = L omega` and `omega^2 (1 + L^2) = k/m`, so
//! `c = 2 L sqrt(k m/(1 + L^2))`. (The paper's `c = 1.53` for `gamma = 0.8457` does not satisfy its
//! own formula: 0.8457 gives 0.96194, and 1.53 gives 0.76557.)

use std::f64::consts::PI;

/// Damping c that gives a head-on bounce the restitution `gamma` (0 to 1), in kg/s.
#[must_use]
pub fn damping_for_restitution_kg_s(gamma: f64, stiffness_n_m: f64, mass_kg: f64) -> f64 {
    let decrement = -libm::log(gamma) / PI;
    2.0 * decrement * (stiffness_n_m * mass_kg / (1.0 + decrement * decrement)).sqrt()
}

/// Restitution of a head-on bounce with damping `c`, 0 to 1.
#[must_use]
pub fn restitution_of_damping(damping_kg_s: f64, stiffness_n_m: f64, mass_kg: f64) -> f64 {
    let alpha = damping_kg_s / (2.0 * mass_kg);
    libm::exp(-alpha * contact_time_s(damping_kg_s, stiffness_n_m, mass_kg))
}

/// Duration of a head-on bounce: half the damped period, in s.
#[must_use]
pub fn contact_time_s(damping_kg_s: f64, stiffness_n_m: f64, mass_kg: f64) -> f64 {
    let alpha = damping_kg_s / (2.0 * mass_kg);
    PI / (stiffness_n_m / mass_kg - alpha * alpha).sqrt()
}
