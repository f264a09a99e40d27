//! The values of a physics in words: what each one is, and whether it is measured, from a rule book
//! or assumed.

use super::physics::{BoardEdge, Physics};
use super::physics_constants::{CONSTANTS, SHAPE, short_length};
use super::solids::SolidId;
use crate::units::UnitSystem;

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

const DROP_TEST: &str = "rule book: drop test of the ball";
const HOOP_LOSS: &str = "assumed: beside the ball's own loss, rule books let the ring absorb 35 to 50 % of the energy; estimates go from 0.41 to 0.65, try 0.41 to 0.70";

impl Physics {
    /// All values in the order of the README.
    #[must_use]
    pub fn values(&self, units: UnitSystem) -> Vec<PhysicsValue> {
        let mut values = Vec::new();
        let mut add = |key, value, source| values.push(PhysicsValue { key, value, source });
        for constant in &CONSTANTS {
            if let Some(value) = constant.in_words(self, units) {
                add(constant.key, value, constant.source);
            }
            // What is no constant of its own, or is set by another one.
            if constant.key == "board_centre_height" {
                let edge = match self.board_edge {
                    BoardEdge::None => "none: ends at its face".to_owned(),
                    BoardEdge::Rounded { radius_m } => short_length(radius_m, units),
                };
                let restitution = |solid| format!("{:.4}", self.restitution_on(solid));
                add("board_edge_radius", edge, SHAPE);
                add("board_restitution", restitution(SolidId::Board), DROP_TEST);
                add("hoop_restitution", restitution(SolidId::Ring), HOOP_LOSS);
            }
        }
        values
    }
}
