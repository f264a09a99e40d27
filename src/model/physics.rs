//! The physical constants of ball, ring and board, and their checks.
//!
//! All values are in SI units. The defaults are those of "Numerical Analysis of the Basketball Shot"
//! (J. Dyn. Sys. Meas. Control, DOI 10.1115/1.1636193), called *the paper* throughout this crate.

use super::restitution::{contact_time_s, damping_for_restitution_kg_s, restitution_of_damping};
use crate::units::{FOOT_M, INCH_M, POUND_FORCE_N, SLUG_KG};
use serde::Serialize;

/// The constants of the model: sizes, masses and contact laws (SI units).
///
/// The frame has its origin at the centre of the hoop, `x` from the backboard to the court and `z`
/// up; the front face of the board is the plane `x = -board_distance_m`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Physics {
    /// Ball radius R.
    pub ball_radius_m: f64,
    /// Ball mass m.
    pub ball_mass_kg: f64,
    /// Moment of inertia over m R^2: 2/3 for a thin spherical shell.
    pub inertia_ratio: f64,
    /// Radius of the ring's centre line, R_H.
    pub ring_radius_m: f64,
    /// Distance a of the board's face from the hoop's centre.
    pub board_distance_m: f64,
    /// Board width b.
    pub board_width_m: f64,
    /// Board height h.
    pub board_height_m: f64,
    /// Height h0 of the board's centre above the plane of the hoop.
    pub board_centre_height_m: f64,
    /// Height of the plane of the hoop above the floor.
    pub hoop_height_m: f64,
    /// Gravity g.
    pub gravity_m_s2: f64,
    /// Contact stiffness k of the ball.
    pub stiffness_n_m: f64,
    /// Contact damping c of the ball.
    pub damping_kg_s: f64,
    /// Coefficient of kinetic friction mu, the same for ring and board.
    pub friction: f64,
    /// A shot that has not ended after this time counts as lodged, s.
    pub time_limit_s: f64,
    /// A ball that rolls without slip on two solids at once for this long is lodged, s. With 0 such a
    /// ball is simulated up to the time limit.
    pub lodged_after_s: f64,
}

impl Physics {
    /// The paper's constants (its nomenclature), with its printed damping of 1.53 lb s/ft.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            ball_radius_m: 29.75 / (24.0 * std::f64::consts::PI) * FOOT_M,
            ball_mass_kg: 21.0 / 16.0 / 32.2 * SLUG_KG,
            inertia_ratio: 2.0 / 3.0,
            ring_radius_m: (9.0 + 5.0 / 16.0) * INCH_M,
            board_distance_m: 1.25 * FOOT_M,
            board_width_m: 6.0 * FOOT_M,
            board_height_m: 3.5 * FOOT_M,
            board_centre_height_m: 1.25 * FOOT_M,
            hoop_height_m: 10.0 * FOOT_M,
            gravity_m_s2: 32.2 * FOOT_M,
            stiffness_n_m: 2000.0 * POUND_FORCE_N / FOOT_M,
            damping_kg_s: 1.53 * POUND_FORCE_N / FOOT_M,
            friction: 1.0,
            time_limit_s: 10.0,
            lodged_after_s: 0.030,
        }
    }

    /// The paper's constants with another coefficient of restitution of a head-on bounce, above 0 and
    /// at most 1.
    ///
    /// # Errors
    /// `restitution` is not in that range.
    pub fn with_restitution(restitution: f64) -> Result<Self, PhysicsError> {
        let mut physics = Self::paper();
        physics.set_restitution(restitution)?;
        Ok(physics)
    }

    /// Sets the damping that gives a coefficient of restitution at the current stiffness and mass.
    ///
    /// # Errors
    /// `restitution` is not above 0 and at most 1.
    pub fn set_restitution(&mut self, restitution: f64) -> Result<(), PhysicsError> {
        if !(restitution > 0.0 && restitution <= 1.0) {
            return Err(PhysicsError::new(
                "restitution",
                restitution,
                "above 0 and at most 1",
            ));
        }
        self.damping_kg_s =
            damping_for_restitution_kg_s(restitution, self.stiffness_n_m, self.ball_mass_kg);
        Ok(())
    }

    /// Coefficient of restitution of a head-on bounce, `exp(-pi alpha/omega)` (Appendix 1).
    #[must_use]
    pub fn restitution(&self) -> f64 {
        restitution_of_damping(self.damping_kg_s, self.stiffness_n_m, self.ball_mass_kg)
    }

    /// Duration of a head-on bounce, half the damped period `pi/omega` (Appendix 1).
    #[must_use]
    pub fn contact_time_s(&self) -> f64 {
        contact_time_s(self.damping_kg_s, self.stiffness_n_m, self.ball_mass_kg)
    }

    /// All constants that cannot be simulated; empty if the physics is valid.
    #[must_use]
    pub fn errors(&self) -> Vec<PhysicsError> {
        let mut errors = Vec::new();
        for (key, value, (low, high), allowed) in self.ranges() {
            if !(low..=high).contains(&value) {
                errors.push(PhysicsError::new(key, value, allowed));
            }
        }
        if errors.is_empty() {
            self.check_proportions(&mut errors);
        }
        errors
    }

    /// The range of each constant. They are wide: what is outside is a slip of units, or a body whose bounces the
    /// integrator would follow without end.
    fn ranges(&self) -> [(&'static str, f64, (f64, f64), &'static str); 15] {
        const LENGTH: (f64, f64) = (0.01, 10.0);
        const LENGTH_TEXT: &str = "from 0.01 m to 10 m";
        [
            ("ball_radius", self.ball_radius_m, LENGTH, LENGTH_TEXT),
            (
                "ball_mass",
                self.ball_mass_kg,
                (0.001, 100.0),
                "from 1 g to 100 kg",
            ),
            (
                "inertia_ratio",
                self.inertia_ratio,
                (0.1, 1.0),
                "from 0.1 to 1 (a solid sphere has 0.4, a thin shell 0.667)",
            ),
            ("ring_radius", self.ring_radius_m, LENGTH, LENGTH_TEXT),
            ("board_distance", self.board_distance_m, LENGTH, LENGTH_TEXT),
            ("board_width", self.board_width_m, LENGTH, LENGTH_TEXT),
            ("board_height", self.board_height_m, LENGTH, LENGTH_TEXT),
            (
                "board_centre_height",
                self.board_centre_height_m,
                (-10.0, 10.0),
                "within 10 m",
            ),
            ("hoop_height", self.hoop_height_m, LENGTH, LENGTH_TEXT),
            (
                "gravity",
                self.gravity_m_s2,
                (1e-9, 1000.0),
                "from 1e-9 to 1000 m/s^2",
            ),
            (
                "stiffness",
                self.stiffness_n_m,
                (0.1, 1e9),
                "from 0.1 to 1e9 N/m, with a bounce that lasts 0.1 ms to 0.5 s",
            ),
            (
                "damping",
                self.damping_kg_s,
                (0.0, 1e6),
                "from 0 to 1e6 kg/s",
            ),
            (
                "friction",
                self.friction,
                (0.0, 10.0),
                "from 0 to 10 (rubber on a dry board has about 1)",
            ),
            (
                "time_limit",
                self.time_limit_s,
                (0.01, 60.0),
                "from 0.01 s to 60 s",
            ),
            (
                "lodged_after",
                self.lodged_after_s,
                (0.0, 60.0),
                "from 0 to 60 s",
            ),
        ]
    }

    fn check_proportions(&self, errors: &mut Vec<PhysicsError>) {
        if !(self.ball_radius_m < self.ring_radius_m) {
            errors.push(PhysicsError::new(
                "ball_radius",
                self.ball_radius_m,
                "less than the ring's radius, else no ball fits",
            ));
        }
        if !(self.board_distance_m > self.ring_radius_m) {
            errors.push(PhysicsError::new(
                "board_distance",
                self.board_distance_m,
                "more than the ring's radius, else the ring is behind the board",
            ));
        }
        let critical = 2.0 * (self.stiffness_n_m * self.ball_mass_kg).sqrt();
        if !(self.damping_kg_s < critical) {
            errors.push(PhysicsError::new(
                "damping",
                self.damping_kg_s,
                "less than critical (2 sqrt(k m)), else the ball never rebounds",
            ));
        } else if !(1e-4..=0.5).contains(&self.contact_time_s()) {
            errors.push(PhysicsError::new(
                "stiffness",
                self.stiffness_n_m,
                "such that a head-on bounce, pi/omega, lasts from 0.1 ms to 0.5 s",
            ));
        }
    }
}

impl Default for Physics {
    fn default() -> Self {
        Self::paper()
    }
}

/// A physical constant that cannot be simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("physics.{key} is {value} in SI units; it must be {allowed}")]
pub struct PhysicsError {
    /// The key of the constant in the `[physics]` table.
    pub key: &'static str,
    /// Its value, SI units.
    pub value: f64,
    /// The allowed values.
    pub allowed: &'static str,
}

impl PhysicsError {
    fn new(key: &'static str, value: f64, allowed: &'static str) -> Self {
        Self {
            key,
            value,
            allowed,
        }
    }
}
