//! The physical constants of ball, ring and board, and their checks.
//!
//! All values are in SI units. The defaults are those of "Numerical Analysis of the Basketball
//! Shot" (J. Dyn. Sys. Meas. Control, DOI 10.1115/1.1636193), called *the paper* throughout this
//! crate.

use super::physics_error::PhysicsError;
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

    /// Sets the restitution of the contact with one solid.
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
