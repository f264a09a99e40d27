//! Whether a physics can be simulated.

use super::physics::{BoardEdge, Physics};
use super::physics_constants::CONSTANTS;
use super::physics_error::PhysicsError;
use super::solids::SolidId;

impl Physics {
    /// All constants that cannot be simulated; empty if the physics is valid.
    #[must_use]
    pub fn errors(&self) -> Vec<PhysicsError> {
        let mut errors = Vec::new();
        for constant in &CONSTANTS {
            let (value, (low, high)) = ((constant.get)(self), constant.range);
            if !(low..=high).contains(&value) {
                errors.push(PhysicsError::new(constant.key, value, constant.allowed));
            }
        }
        if errors.is_empty() {
            self.check_proportions(&mut errors);
        }
        with_common_keys(errors)
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
