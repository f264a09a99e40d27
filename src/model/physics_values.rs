//! The values of a physics in words: what each one is, and whether it is measured, from a rule book
//! or assumed.

use super::physics::{BoardEdge, ContactLaw, Physics};
use super::restitution::restitution_of_damping;
use crate::units::{FOOT_M, INCH_M, UnitSystem};
use std::f64::consts::PI;

/// One value of a physics.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PhysicsValue {
    /// Its key in the `[physics]` table.
    pub key: &'static str,
    /// The number with its unit.
    pub value: String,
    /// Where the presets of balls in play have theirs from.
    pub source: &'static str,
}

/// Where a value of the balls in play comes from.
const BALL_RULES: &str = "rule book: size of the ball";
const HOOP_RULES: &str = "rule book: equipment";
const DROP_TEST: &str = "rule book: drop test of the ball";
const SHOTS: &str =
    "assumed: between 0.41 +- 0.035 (measured, 27 three-point shots) and 0.47 to 0.54 (spheres)";
const NO_LIFT: &str = "measured: none in 27 three-point shots (0.00 +- 0.05)";
const SHELL: &str = "assumed: a thin shell";
const HOOP_LOSS: &str = "assumed: beside the ball's own loss, rule books let the ring absorb 35 to 50 % of the energy; estimates go from 0.41 to 0.65, try 0.41 to 0.70";
const FRICTION: &str =
    "assumed: leather on painted steel or glass; new composite balls have up to 0.8";
const STIFFNESS: &str = "assumed: the paper's";
const SHAPE: &str = "assumed: usual equipment";
const ROOM: &str = "assumed: a gym near sea level; give altitude and temperature";
const STANDARD: &str = "standard gravity";

impl Physics {
    /// All values in the order of the README.
    #[must_use]
    pub fn values(&self, units: UnitSystem) -> Vec<PhysicsValue> {
        // Metric rule books have centimetres.
        let length = |metres: f64| match units {
            UnitSystem::Imperial => format!("{:.3} in", metres / INCH_M),
            UnitSystem::Metric => format!("{:.3} cm", 100.0 * metres),
        };
        let restitution = |contact: &ContactLaw| {
            let c = restitution_of_damping(
                contact.damping_kg_s,
                contact.stiffness_n_m,
                self.ball_mass_kg,
            );
            format!("{c:.4}")
        };
        let edge = match self.board_edge {
            BoardEdge::None => "none: ends at its face".to_owned(),
            BoardEdge::Rounded { radius_m } => length(radius_m),
        };
        let (board, hoop) = (&self.board_contact, &self.hoop_contact);
        let stiffness = |n_m: f64| format!("{n_m:.0} N/m");
        let rows = [
            (
                "ball_radius",
                format!(
                    "{} ({} around)",
                    length(self.ball_radius_m),
                    length(2.0 * PI * self.ball_radius_m)
                ),
                BALL_RULES,
            ),
            (
                "ball_mass",
                format!("{:.1} g", self.ball_mass_kg * 1000.0),
                BALL_RULES,
            ),
            ("inertia_ratio", format!("{:.4}", self.inertia_ratio), SHELL),
            ("ring_radius", length(self.ring_radius_m), HOOP_RULES),
            (
                "ring_tube_diameter",
                length(self.ring_tube_diameter_m),
                HOOP_RULES,
            ),
            ("bracket_width", length(self.bracket_width_m), SHAPE),
            (
                "hoop_height",
                match units {
                    UnitSystem::Imperial => format!("{:.3} ft", self.hoop_height_m / FOOT_M),
                    UnitSystem::Metric => format!("{:.3} m", self.hoop_height_m),
                },
                HOOP_RULES,
            ),
            ("board_distance", length(self.board_distance_m), HOOP_RULES),
            ("board_width", length(self.board_width_m), HOOP_RULES),
            ("board_height", length(self.board_height_m), HOOP_RULES),
            (
                "board_centre_height",
                length(self.board_centre_height_m),
                HOOP_RULES,
            ),
            ("board_edge_radius", edge, SHAPE),
            ("board_restitution", restitution(board), DROP_TEST),
            ("hoop_restitution", restitution(hoop), HOOP_LOSS),
            ("board_friction", format!("{}", board.friction), FRICTION),
            ("hoop_friction", format!("{}", hoop.friction), FRICTION),
            ("board_stiffness", stiffness(board.stiffness_n_m), STIFFNESS),
            ("hoop_stiffness", stiffness(hoop.stiffness_n_m), STIFFNESS),
            (
                "air_density",
                format!("{:.4} kg/m^3", self.air.density_kg_m3),
                ROOM,
            ),
            (
                "drag_coefficient",
                format!("{}", self.air.drag_coefficient),
                SHOTS,
            ),
            ("lift_slope", format!("{}", self.air.lift_slope), NO_LIFT),
            (
                "gravity",
                format!("{:.5} m/s^2", self.gravity_m_s2),
                STANDARD,
            ),
        ];
        rows.map(|(key, value, source)| PhysicsValue { key, value, source })
            .into()
    }
}
