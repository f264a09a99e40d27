//! The physics of real balls, boards and hoops, by rule book.
//!
//! What comes from where: sizes and masses from the rule books; the restitution of ball and board
//! from the rules' drop test; drag from measured three-point shots; friction, the hoop's
//! restitution, the bracket and the board's edges are assumed (`docs/model.md` has the sources).

use super::physics::{Air, BoardEdge, ContactLaw, Physics};
use super::solids::SolidId;
use crate::units::{FOOT_M, INCH_M, POUND_FORCE_N, POUND_KG, UnitSystem};
use std::f64::consts::PI;

/// A named physics.
#[derive(Clone, Copy, Debug)]
pub struct Preset {
    /// The name in the `[physics]` table.
    pub name: &'static str,
    /// What it describes.
    pub description: &'static str,
    physics: fn() -> Physics,
}

/// The preset where nobody names one: a ball in play, so that the same release has the same end
/// in every command.
pub const DEFAULT_PRESET: &str = "ncaa";

impl Default for Physics {
    /// The physics of [`DEFAULT_PRESET`].
    fn default() -> Self {
        in_play(NCAA_BALL, INCH_BOARD, 0.77)
    }
}

impl Preset {
    /// The preset of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<&'static Self> {
        PRESETS.iter().find(|preset| preset.name == name)
    }

    /// The preset whose printed values a physics has.
    #[must_use]
    pub fn of(physics: &Physics) -> Option<&'static Self> {
        let printed = |physics: &Physics| {
            let values = physics.values(UnitSystem::default()).into_iter();
            values.map(|value| value.value).collect::<Vec<_>>()
        };
        let own = printed(physics);
        PRESETS
            .iter()
            .find(|preset| printed(&preset.physics()) == own)
    }

    /// Its physics.
    #[must_use]
    pub fn physics(&self) -> Physics {
        (self.physics)()
    }
}

/// All presets.
pub const PRESETS: [Preset; 8] = [
    Preset {
        name: "paper",
        description: "the paper's ball in a vacuum at a ring without thickness",
        physics: Physics::paper,
    },
    Preset {
        name: "ncaa",
        description: "men's college basketball",
        physics: Physics::default,
    },
    Preset {
        name: "ncaa_women",
        description: "women's college basketball",
        physics: || in_play(ball(28.75 * INCH_M, 19.0 * OUNCE_KG), INCH_BOARD, 0.785),
    },
    Preset {
        name: "nba",
        description: "the NBA",
        physics: || in_play(ball(29.5 * INCH_M, 22.0 * OUNCE_KG), INCH_BOARD, 0.77),
    },
    Preset {
        name: "wnba",
        description: "the WNBA",
        physics: || in_play(ball(28.5 * INCH_M, 20.0 * OUNCE_KG), INCH_BOARD, 0.77),
    },
    Preset {
        name: "fiba",
        description: "FIBA, men (size 7)",
        physics: || in_play(ball(0.760, 0.600), FIBA_BOARD, 0.77),
    },
    Preset {
        name: "fiba_women",
        description: "FIBA, women (size 6)",
        physics: || in_play(ball(0.722, 0.530), FIBA_BOARD, 0.77),
    },
    Preset {
        name: "youth",
        description: "youth (size 5)",
        physics: || in_play(ball(0.692, 0.480), INCH_BOARD, 0.77),
    },
];

/// Ounce (avoirdupois), kg.
const OUNCE_KG: f64 = POUND_KG / 16.0;

/// Radius (m) and mass (kg) of a ball.
type Ball = (f64, f64);

const fn ball(circumference_m: f64, mass_kg: f64) -> Ball {
    (circumference_m / (2.0 * PI), mass_kg)
}

const NCAA_BALL: Ball = ball(29.75 * INCH_M, 21.0 * OUNCE_KG);

/// The sizes of board and ring, m.
#[derive(Clone, Copy)]
struct Sizes {
    /// To the centre line of the rod.
    ring_radius: f64,
    tube_diameter: f64,
    board_distance: f64,
    board_width: f64,
    board_height: f64,
    board_centre_height: f64,
    hoop_height: f64,
}

/// United States rule books: inner diameter of the ring 18 in, its centre 15 in from the board.
const INCH_BOARD: Sizes = Sizes {
    ring_radius: (9.0 + 5.0 / 16.0) * INCH_M,
    tube_diameter: 0.625 * INCH_M,
    board_distance: 15.0 * INCH_M,
    board_width: 72.0 * INCH_M,
    board_height: 42.0 * INCH_M,
    board_centre_height: 15.0 * INCH_M,
    hoop_height: 10.0 * FOOT_M,
};

/// FIBA: inner diameter 450 to 459 mm, its edge 151 mm from the board, whose lower edge is 2900 mm
/// high.
const FIBA_BOARD: Sizes = Sizes {
    ring_radius: 0.5 * 0.4545 + 0.009,
    tube_diameter: 0.018,
    board_distance: 0.151 + 0.5 * 0.4545,
    board_width: 1.800,
    board_height: 1.050,
    board_centre_height: 2.900 + 0.525 - 3.050,
    hoop_height: 3.050,
};

/// A ball in play at a real hoop.
fn in_play((radius_m, mass_kg): Ball, sizes: Sizes, board_restitution: f64) -> Physics {
    let contact = |friction| ContactLaw {
        stiffness_n_m: 2000.0 * POUND_FORCE_N / FOOT_M,
        damping_kg_s: 0.0,
        friction,
    };
    let mut physics = Physics {
        ball_radius_m: radius_m,
        ball_mass_kg: mass_kg,
        inertia_ratio: 2.0 / 3.0,
        ring_radius_m: sizes.ring_radius,
        ring_tube_diameter_m: sizes.tube_diameter,
        bracket_width_m: 6.0 * INCH_M,
        board_distance_m: sizes.board_distance,
        board_width_m: sizes.board_width,
        board_height_m: sizes.board_height,
        board_centre_height_m: sizes.board_centre_height,
        board_edge: BoardEdge::Rounded { radius_m: INCH_M },
        hoop_height_m: sizes.hoop_height,
        gravity_m_s2: 9.806_65,
        board_contact: contact(0.6),
        hoop_contact: contact(0.5),
        air: Air {
            density_kg_m3: 1.19,
            drag_coefficient: 0.45,
            lift_slope: 0.0,
        },
        ..Physics::paper()
    };
    for (solid, restitution) in [(SolidId::Board, board_restitution), (SolidId::Ring, 0.60)] {
        physics
            .set_restitution_on(solid, restitution)
            .expect("a share between 0 and 1");
    }
    physics
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_presets_are_valid_and_have_their_names() {
        for preset in &PRESETS {
            assert_eq!(preset.physics().errors(), [], "{}", preset.name);
            let named = Preset::named(preset.name).map(Preset::physics);
            assert_eq!(named, Some(preset.physics()));
        }
        assert!(Preset::named("nfl").is_none());
    }
}
