//! The physical constants of ball, ring and board, and their checks.
//!
//! All values are in SI units. The defaults are those of "Numerical Analysis of the Basketball
//! Shot" (J. Dyn. Sys. Meas. Control, DOI 10.1115/1.1636193), called *the paper* throughout this
//! crate.

use super::restitution::{contact_time_s, damping_for_restitution_kg_s, restitution_of_damping};
use super::solids::SolidId;
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
    /// Diameter of the rod of ring and bracket; 0 for the paper's ring of no thickness.
    pub ring_tube_diameter_m: f64,
    /// Width of the flat bracket between ring and board; 0 for none.
    pub bracket_width_m: f64,
    /// Distance a of the board's face from the hoop's centre.
    pub board_distance_m: f64,
    /// Board width b.
    pub board_width_m: f64,
    /// Board height h.
    pub board_height_m: f64,
    /// Height h0 of the board's centre above the ring's upper edge.
    pub board_centre_height_m: f64,
    /// How the board acts on a ball at its edges.
    pub board_edge: BoardEdge,
    /// Height of the ring's upper edge above the floor.
    pub hoop_height_m: f64,
    /// Gravity g.
    pub gravity_m_s2: f64,
    /// The contact of the ball with the board.
    pub board_contact: ContactLaw,
    /// The contact of the ball with the hoop: ring and bracket.
    pub hoop_contact: ContactLaw,
    /// The air.
    pub air: Air,
    /// A shot that has not ended after this time counts as lodged, s.
    pub time_limit_s: f64,
    /// A ball that rolls without slip on two solids at once for this long is lodged, s. With 0 such
    /// a ball is simulated up to the time limit.
    pub lodged_after_s: f64,
}

impl Physics {
    /// The paper's constants (its nomenclature), with its printed damping of 1.53 lb s/ft: a ring
    /// without thickness, no bracket, no air.
    #[must_use]
    pub fn paper() -> Self {
        let contact = ContactLaw {
            stiffness_n_m: 2000.0 * POUND_FORCE_N / FOOT_M,
            damping_kg_s: 1.53 * POUND_FORCE_N / FOOT_M,
            friction: 1.0,
        };
        Self {
            ball_radius_m: 29.75 / (24.0 * std::f64::consts::PI) * FOOT_M,
            ball_mass_kg: 21.0 / 16.0 / 32.2 * SLUG_KG,
            inertia_ratio: 2.0 / 3.0,
            ring_radius_m: (9.0 + 5.0 / 16.0) * INCH_M,
            ring_tube_diameter_m: 0.0,
            bracket_width_m: 0.0,
            board_distance_m: 1.25 * FOOT_M,
            board_width_m: 6.0 * FOOT_M,
            board_height_m: 3.5 * FOOT_M,
            board_centre_height_m: 1.25 * FOOT_M,
            board_edge: BoardEdge::None,
            hoop_height_m: 10.0 * FOOT_M,
            gravity_m_s2: 32.2 * FOOT_M,
            board_contact: contact,
            hoop_contact: contact,
            air: Air::NONE,
            time_limit_s: 10.0,
            lodged_after_s: 0.030,
        }
    }

    /// The paper's constants with another coefficient of restitution of a head-on bounce, above 0
    /// and at most 1.
    ///
    /// # Errors
    /// `restitution` is not in that range.
    pub fn with_restitution(restitution: f64) -> Result<Self, PhysicsError> {
        let mut physics = Self::paper();
        physics.set_restitution(restitution)?;
        Ok(physics)
    }

    /// Sets the damping of both contacts that gives a coefficient of restitution at their
    /// stiffness.
    ///
    /// # Errors
    /// `restitution` is not above 0 and at most 1.
    pub fn set_restitution(&mut self, restitution: f64) -> Result<(), PhysicsError> {
        for solid in SolidId::ALL {
            self.set_restitution_on(solid, restitution)?;
        }
        Ok(())
    }

    /// The same for the contact with one solid.
    ///
    /// # Errors
    /// `restitution` is not above 0 and at most 1.
    pub fn set_restitution_on(
        &mut self,
        solid: SolidId,
        restitution: f64,
    ) -> Result<(), PhysicsError> {
        if !(restitution > 0.0 && restitution <= 1.0) {
            return Err(PhysicsError::new(
                "restitution",
                restitution,
                "above 0 and at most 1",
            ));
        }
        let mass_kg = self.ball_mass_kg;
        let contact = self.contact_mut(solid);
        contact.damping_kg_s =
            damping_for_restitution_kg_s(restitution, contact.stiffness_n_m, mass_kg);
        Ok(())
    }

    /// The contact of the ball with a solid.
    #[must_use]
    pub fn contact(&self, solid: SolidId) -> &ContactLaw {
        match solid {
            SolidId::Board => &self.board_contact,
            SolidId::Ring => &self.hoop_contact,
        }
    }

    /// The contact of the ball with a solid.
    pub fn contact_mut(&mut self, solid: SolidId) -> &mut ContactLaw {
        match solid {
            SolidId::Board => &mut self.board_contact,
            SolidId::Ring => &mut self.hoop_contact,
        }
    }

    /// The same physics with both contacts changed.
    #[must_use]
    pub fn with_contacts(mut self, change: impl Fn(&mut ContactLaw)) -> Self {
        for solid in SolidId::ALL {
            change(self.contact_mut(solid));
        }
        self
    }

    /// Coefficient of restitution of a head-on bounce off a solid, `exp(-pi alpha/omega)` (Appendix
    /// 1).
    #[must_use]
    pub fn restitution_on(&self, solid: SolidId) -> f64 {
        let contact = self.contact(solid);
        restitution_of_damping(
            contact.damping_kg_s,
            contact.stiffness_n_m,
            self.ball_mass_kg,
        )
    }

    /// Coefficient of restitution of a head-on bounce off the board.
    #[must_use]
    pub fn restitution(&self) -> f64 {
        self.restitution_on(SolidId::Board)
    }

    /// Duration of a head-on bounce off a solid, half the damped period `pi/omega` (Appendix 1).
    #[must_use]
    pub fn contact_time_on_s(&self, solid: SolidId) -> f64 {
        let contact = self.contact(solid);
        contact_time_s(
            contact.damping_kg_s,
            contact.stiffness_n_m,
            self.ball_mass_kg,
        )
    }

    /// Duration of the shortest head-on bounce, s.
    #[must_use]
    pub fn contact_time_s(&self) -> f64 {
        SolidId::ALL
            .map(|solid| self.contact_time_on_s(solid))
            .into_iter()
            .fold(f64::INFINITY, f64::min)
    }

    /// The speed from which on a head-on ball is pressed in by more than its radius, m/s: undamped,
    /// `R sqrt(k/m)` at the softer solid. The model of a contact ends there: the ball's centre
    /// passes the surface and it leaves on the other side.
    #[must_use]
    pub fn max_contact_speed_m_s(&self) -> f64 {
        let softest = SolidId::ALL
            .map(|solid| self.contact(solid).stiffness_n_m)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        self.ball_radius_m * (softest / self.ball_mass_kg).sqrt()
    }

    /// The least speed at which a ball reaches the hoop from a distance and a height above the
    /// floor, in a vacuum, m/s (Brancazio 1981).
    #[must_use]
    pub fn least_speed_to_hoop_m_s(&self, distance_m: f64, height_m: f64) -> f64 {
        let rise = self.hoop_plane_height_m() - height_m;
        let reach = libm::hypot(rise, distance_m);
        (self.gravity_m_s2 * (rise + reach)).max(0.0).sqrt()
    }

    /// Radius of the rod of ring and bracket, m.
    #[must_use]
    pub fn ring_tube_radius_m(&self) -> f64 {
        0.5 * self.ring_tube_diameter_m
    }

    /// Height of the plane z = 0, that of the ring's centre line, above the floor, m.
    #[must_use]
    pub fn hoop_plane_height_m(&self) -> f64 {
        self.hoop_height_m - self.ring_tube_radius_m()
    }

    /// z of the board's centre, m.
    #[must_use]
    pub fn board_centre_z_m(&self) -> f64 {
        self.board_centre_height_m + self.ring_tube_radius_m()
    }

    /// Gravity less the buoyancy of the ball, m/s^2.
    #[must_use]
    pub fn gravity_less_buoyancy_m_s2(&self) -> f64 {
        let radius = self.ball_radius_m;
        let volume_m3 = 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
        self.gravity_m_s2 * (1.0 - self.air.density_kg_m3 * volume_m3 / self.ball_mass_kg)
    }

    /// Deceleration by drag over the square of the speed, `rho A C_d/(2 m)`, 1/m.
    #[must_use]
    pub fn drag_per_m(&self) -> f64 {
        self.half_air_mass_per_m() * self.air.drag_coefficient
    }

    /// Acceleration by lift over the product of spin and speed, `rho A R C/(2 m)` for `C_L = C R
    /// w/v`.
    #[must_use]
    pub fn lift_factor(&self) -> f64 {
        self.half_air_mass_per_m() * self.ball_radius_m * self.air.lift_slope
    }

    /// `rho A/(2 m)`, 1/m.
    fn half_air_mass_per_m(&self) -> f64 {
        let area_m2 = std::f64::consts::PI * self.ball_radius_m * self.ball_radius_m;
        0.5 * self.air.density_kg_m3 * area_m2 / self.ball_mass_kg
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
        with_common_keys(errors)
    }

    /// The range of each constant. They are wide: what is outside is a slip of units, or a body
    /// whose bounces the integrator would follow without end.
    fn ranges(&self) -> [(&'static str, f64, (f64, f64), &'static str); 23] {
        const LENGTH: (f64, f64) = (0.01, 10.0);
        const LENGTH_TEXT: &str = "from 0.01 m to 10 m";
        const STIFFNESS: (f64, f64) = (0.1, 1e9);
        const STIFFNESS_TEXT: &str =
            "from 0.1 to 1e9 N/m, with a bounce that lasts 0.1 ms to 0.5 s";
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
                "board_stiffness",
                self.board_contact.stiffness_n_m,
                STIFFNESS,
                STIFFNESS_TEXT,
            ),
            (
                "board_damping",
                self.board_contact.damping_kg_s,
                (0.0, 1e6),
                "from 0 to 1e6 kg/s",
            ),
            (
                "board_friction",
                self.board_contact.friction,
                (0.0, 10.0),
                "from 0 to 10 (rubber on a dry board has about 1)",
            ),
            (
                "hoop_stiffness",
                self.hoop_contact.stiffness_n_m,
                STIFFNESS,
                STIFFNESS_TEXT,
            ),
            (
                "hoop_damping",
                self.hoop_contact.damping_kg_s,
                (0.0, 1e6),
                "from 0 to 1e6 kg/s",
            ),
            (
                "hoop_friction",
                self.hoop_contact.friction,
                (0.0, 10.0),
                "from 0 to 10 (rubber on a dry board has about 1)",
            ),
            (
                "ring_tube_diameter",
                self.ring_tube_diameter_m,
                (0.0, 1.0),
                "from 0 to 1 m",
            ),
            (
                "bracket_width",
                self.bracket_width_m,
                (0.0, 10.0),
                "from 0 to 10 m",
            ),
            (
                "air_density",
                self.air.density_kg_m3,
                (0.0, 10.0),
                "from 0 to 10 kg/m^3 (air at sea level has about 1.2)",
            ),
            (
                "drag_coefficient",
                self.air.drag_coefficient,
                (0.0, 5.0),
                "from 0 to 5 (a smooth sphere has about 0.5)",
            ),
            (
                "lift_slope",
                self.air.lift_slope,
                (-2.0, 2.0),
                "from -2 to 2 (textbooks have 1; none is seen in games)",
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
        let tube = self.ring_tube_radius_m();
        if !(self.ball_radius_m + tube < self.ring_radius_m) {
            errors.push(PhysicsError::new(
                "ball_radius",
                self.ball_radius_m,
                "less than the ring's inner radius, else no ball fits",
            ));
        }
        if !(tube < self.ball_radius_m) {
            errors.push(PhysicsError::new(
                "ring_tube_diameter",
                self.ring_tube_diameter_m,
                "less than the ball's diameter",
            ));
        }
        if !(self.board_distance_m > self.ring_radius_m + tube) {
            errors.push(PhysicsError::new(
                "board_distance",
                self.board_distance_m,
                "more than the ring's outer radius, else the ring is behind the board",
            ));
        }
        if !(self.bracket_width_m < 2.0 * self.ring_radius_m) {
            errors.push(PhysicsError::new(
                "bracket_width",
                self.bracket_width_m,
                "less than the ring's diameter",
            ));
        }
        if let BoardEdge::Rounded { radius_m } = self.board_edge {
            let most = 0.5 * self.board_width_m.min(self.board_height_m);
            if !(0.0..=most).contains(&radius_m) {
                errors.push(PhysicsError::new(
                    "board_edge_radius",
                    radius_m,
                    "from 0 to half the board's width and height",
                ));
            }
        }
        if !(self.gravity_less_buoyancy_m_s2() > 0.5 * self.gravity_m_s2) {
            errors.push(PhysicsError::new(
                "air_density",
                self.air.density_kg_m3,
                "so low that buoyancy is less than half the weight (air has about 1.2 kg/m^3)",
            ));
        }
        // With less the air would hold or turn the ball for the whole time limit.
        if self.air.density_kg_m3 > 0.0 && !(self.gravity_m_s2 >= 1.0) {
            errors.push(PhysicsError::new(
                "gravity",
                self.gravity_m_s2,
                "1 m/s^2 or more in air (air_density = 0 switches it off)",
            ));
        }
        for solid in SolidId::ALL {
            self.check_contact(solid, errors);
        }
    }

    fn check_contact(&self, solid: SolidId, errors: &mut Vec<PhysicsError>) {
        let contact = self.contact(solid);
        let [stiffness, damping] = match solid {
            SolidId::Board => ["board_stiffness", "board_damping"],
            SolidId::Ring => ["hoop_stiffness", "hoop_damping"],
        };
        let critical = 2.0 * (contact.stiffness_n_m * self.ball_mass_kg).sqrt();
        if !(contact.damping_kg_s < critical) {
            errors.push(PhysicsError::new(
                damping,
                contact.damping_kg_s,
                "less than critical (2 sqrt(k m)), else the ball never rebounds",
            ));
        } else if !(1e-4..=0.5).contains(&self.contact_time_on_s(solid)) {
            errors.push(PhysicsError::new(
                stiffness,
                contact.stiffness_n_m,
                "such that a head-on bounce, pi/omega, lasts from 0.1 ms to 0.5 s",
            ));
        }
    }
}

/// The contact of the ball with one solid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ContactLaw {
    /// Stiffness k.
    pub stiffness_n_m: f64,
    /// Damping c.
    pub damping_kg_s: f64,
    /// Coefficient of kinetic friction mu.
    pub friction: f64,
}

/// How the board acts on a ball at its edges.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum BoardEdge {
    /// The paper's board: it acts only on a ball whose centre is in front of its rectangle.
    None,
    /// A plate with rounded edges of this radius; 0 for sharp edges.
    Rounded {
        /// Radius of the edge, m.
        radius_m: f64,
    },
}

impl BoardEdge {
    /// Radius of the edge, m.
    #[must_use]
    pub fn radius_m(self) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Rounded { radius_m } => radius_m,
        }
    }
}

/// The air around the ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Air {
    /// Density rho, kg/m^3.
    pub density_kg_m3: f64,
    /// Drag coefficient C_d.
    pub drag_coefficient: f64,
    /// Lift coefficient over the spin parameter R w/v.
    pub lift_slope: f64,
}

impl Air {
    /// A vacuum.
    pub const NONE: Self = Self {
        density_kg_m3: 0.0,
        drag_coefficient: 0.45,
        lift_slope: 0.0,
    };
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

/// The same errors, where one of the board's contact and one of the hoop's with the same value
/// become one of the key that sets both.
fn with_common_keys(mut errors: Vec<PhysicsError>) -> Vec<PhysicsError> {
    const COMMON: [(&str, &str, &str); 3] = [
        ("stiffness", "board_stiffness", "hoop_stiffness"),
        ("damping", "board_damping", "hoop_damping"),
        ("friction", "board_friction", "hoop_friction"),
    ];
    for (common, board, hoop) in COMMON {
        let position = |key| errors.iter().position(|error| error.key == key);
        if let (Some(first), Some(second)) = (position(board), position(hoop)) {
            let same = errors[first].value.to_bits() == errors[second].value.to_bits();
            if same && errors[first].allowed == errors[second].allowed {
                errors[first].key = common;
                errors.remove(second);
            }
        }
    }
    errors
}
