//! The table of the physical constants: one row has all that is known of a constant. The reader of
//! `[physics]`, its ranges, its JSON schema and the list of `check --details` are made of it.

use super::physics::Physics;
use crate::units::{Dimension, FOOT_M, INCH_M, UnitSystem};
use std::f64::consts::PI;

/// One constant of a physics.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    /// Its key in the `[physics]` table.
    pub key: &'static str,
    /// What it is.
    pub meaning: &'static str,
    /// Its dimension.
    pub dimension: Dimension,
    /// How it may be written.
    pub example: &'static str,
    /// Its range, SI units. The ranges are wide: what is outside is a slip of units, or a body
    /// whose bounces the integrator would follow without end.
    pub range: (f64, f64),
    /// The range in words.
    pub allowed: &'static str,
    /// How it is printed.
    pub(super) shown: Shown,
    /// Where the presets of balls in play have theirs from.
    pub(super) source: &'static str,
    /// Its value.
    pub get: fn(&Physics) -> f64,
    /// Sets it.
    pub set: fn(&mut Physics, f64),
}

/// How a constant is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// Not at all: one of the numerics, or told by another value.
    Never,
    /// In inches or centimetres.
    Short,
    /// In inches or centimetres, with the circumference.
    Around,
    /// In feet or metres.
    Long,
    /// In grams.
    Grams,
    /// As it is.
    Plain,
    /// With so many decimals and a unit.
    Decimals(usize, &'static str),
}

impl Constant {
    /// The value of a physics with its unit, for people; `None` for one that is not printed.
    pub(super) fn in_words(&self, physics: &Physics, units: UnitSystem) -> Option<String> {
        let value = (self.get)(physics);
        Some(match self.shown {
            Shown::Never => return None,
            Shown::Short => short_length(value, units),
            Shown::Around => format!(
                "{} ({} around)",
                short_length(value, units),
                short_length(2.0 * PI * value, units)
            ),
            Shown::Long => match units {
                UnitSystem::Imperial => format!("{:.3} ft", value / FOOT_M),
                UnitSystem::Metric => format!("{value:.3} m"),
            },
            Shown::Grams => format!("{:.1} g", value * 1000.0),
            Shown::Plain => format!("{value}"),
            Shown::Decimals(decimals, unit) => format!("{value:.decimals$}{unit}"),
        })
    }
}

/// A length as rule books print it: metric ones have centimetres.
pub(super) fn short_length(metres: f64, units: UnitSystem) -> String {
    match units {
        UnitSystem::Imperial => format!("{:.3} in", metres / INCH_M),
        UnitSystem::Metric => format!("{:.3} cm", 100.0 * metres),
    }
}

// Where a value of the balls in play comes from.
const BALL_RULES: &str = "rule book: size of the ball";
const HOOP_RULES: &str = "rule book: equipment";
const SHOTS: &str =
    "assumed: between 0.41 +- 0.035 (measured, 27 three-point shots) and 0.47 to 0.54 (spheres)";
const NO_LIFT: &str = "measured: none in 27 three-point shots (0.00 +- 0.05)";
const SHELL: &str = "assumed: a thin shell";
const FRICTION: &str =
    "assumed: leather on painted steel or glass; new composite balls have up to 0.8";
const STIFFNESS: &str = "assumed: the paper's";
pub(super) const SHAPE: &str = "assumed: typical equipment";
const ROOM: &str = "assumed: a gym near sea level; give altitude and temperature";
const STANDARD: &str = "standard gravity";
const NONE: &str = "";

const LENGTH: (f64, f64) = (0.01, 10.0);
const LENGTHS: &str = "from 0.01 m to 10 m";
const STIFF: (f64, f64) = (0.1, 1e9);
const STIFFS: &str = "from 0.1 to 1e9 N/m, with a bounce that lasts 0.1 ms to 0.5 s";
const DAMP: (f64, f64) = (0.0, 1e6);
const DAMPS: &str = "from 0 to 1e6 kg/s";
const RUB: (f64, f64) = (0.0, 10.0);
const RUBS: &str = "from 0 to 10 (rubber on a dry board has about 1)";

macro_rules! constants {
    ($($key:literal $($field:ident).+: $meaning:literal, $dimension:ident $example:literal,
       $range:expr, $allowed:expr, $shown:expr, $source:expr;)+) => {
        [$(Constant {
            key: $key,
            meaning: $meaning,
            dimension: Dimension::$dimension,
            example: $example,
            range: $range,
            allowed: $allowed,
            shown: $shown,
            source: $source,
            get: |physics| physics.$($field).+,
            set: |physics, value| physics.$($field).+ = value,
        }),+]
    };
}

/// All constants, in the order in which they are listed.
pub const CONSTANTS: [Constant; 23] = constants! {
    "ball_radius" ball_radius_m: "Radius of the ball.", Length "4.7 in",
        LENGTH, LENGTHS, Shown::Around, BALL_RULES;
    "ball_mass" ball_mass_kg: "Mass of the ball.", Mass "22 oz",
        (0.001, 100.0), "from 1 g to 100 kg", Shown::Grams, BALL_RULES;
    "inertia_ratio" inertia_ratio:
        "Moment of inertia over mass and squared radius; 2/3 for a thin shell.", Number "0.667",
        (0.1, 1.0), "from 0.1 to 1 (a solid sphere has 0.4, a thin shell 0.667)",
        Shown::Decimals(4, ""), SHELL;
    "ring_radius" ring_radius_m: "Radius of the circle in the middle of the ring's rod.",
        Length "9.3125 in", LENGTH, LENGTHS, Shown::Short, HOOP_RULES;
    "ring_tube_diameter" ring_tube_diameter_m: "Thickness of the ring's rod.", Length "0.625 in",
        (0.0, 1.0), "from 0 to 1 m", Shown::Short, HOOP_RULES;
    "bracket_width" bracket_width_m: "Width of the bracket between ring and board.", Length "6 in",
        (0.0, 10.0), "from 0 to 10 m", Shown::Short, SHAPE;
    "hoop_height" hoop_height_m: "Height of the ring's upper edge above the floor.", Length "10 ft",
        LENGTH, LENGTHS, Shown::Long, HOOP_RULES;
    "board_distance" board_distance_m: "From the hoop's centre to the board's face.", Length "15 in",
        LENGTH, LENGTHS, Shown::Short, HOOP_RULES;
    "board_width" board_width_m: "Width of the board.", Length "6 ft",
        LENGTH, LENGTHS, Shown::Short, HOOP_RULES;
    "board_height" board_height_m: "Height of the board itself.", Length "3.5 ft",
        LENGTH, LENGTHS, Shown::Short, HOOP_RULES;
    "board_centre_height" board_centre_height_m: "Height of the board's middle above the ring.",
        Length "15 in", (-10.0, 10.0), "within 10 m", Shown::Short, HOOP_RULES;
    "board_damping" board_contact.damping_kg_s: "The damping of the board alone.", Damping "20 kg/s",
        DAMP, DAMPS, Shown::Never, NONE;
    "hoop_damping" hoop_contact.damping_kg_s: "The damping of the hoop alone.", Damping "20 kg/s",
        DAMP, DAMPS, Shown::Never, NONE;
    "board_friction" board_contact.friction: "The friction of the board alone.", Number "0.5",
        RUB, RUBS, Shown::Plain, FRICTION;
    "hoop_friction" hoop_contact.friction: "The friction of the hoop alone.", Number "0.5",
        RUB, RUBS, Shown::Plain, FRICTION;
    "board_stiffness" board_contact.stiffness_n_m: "The stiffness of the board alone.",
        Stiffness "29000 N/m", STIFF, STIFFS, Shown::Decimals(0, " N/m"), STIFFNESS;
    "hoop_stiffness" hoop_contact.stiffness_n_m: "The stiffness of the hoop alone.",
        Stiffness "29000 N/m", STIFF, STIFFS, Shown::Decimals(0, " N/m"), STIFFNESS;
    "air_density" air.density_kg_m3: "Density of the air.", Density "1.19 kg/m^3",
        (0.0, 10.0), "from 0 to 10 kg/m^3 (air at sea level has about 1.2)",
        Shown::Decimals(4, " kg/m^3"), ROOM;
    "drag_coefficient" air.drag_coefficient: "Drag of the ball in air; 0 for none.", Number "0.45",
        (0.0, 5.0), "from 0 to 5 (a smooth sphere has about 0.5)", Shown::Plain, SHOTS;
    "lift_slope" air.lift_slope: "Lift coefficient over the spin ratio; 0 for none.", Number "0",
        (-2.0, 2.0), "from -2 to 2 (textbooks have 1; none is seen in games)",
        Shown::Plain, NO_LIFT;
    "gravity" gravity_m_s2: "Gravity.", Acceleration "9.81 m/s^2",
        (1e-9, 1000.0), "from 1e-9 to 1000 m/s^2", Shown::Decimals(5, " m/s^2"), STANDARD;
    "time_limit" time_limit_s: "A shot that lasts longer is missed.", Time "10 s",
        (0.01, 60.0), "from 0.01 s to 60 s", Shown::Never, NONE;
    "lodged_after" lodged_after_s: "A ball that stays in contact so long is lodged.", Time "3 s",
        (0.0, 60.0), "from 0 to 60 s", Shown::Never, NONE;
};
