//! The JSON schema of profiles and sweeps, for editors.
//!
//! The reader of each table is what decides; a test holds the keys here against those that it
//! knows.

use crate::model::{CONSTANTS, PRESETS};
use crate::units::Dimension;
use serde_json::{Map, Value, json};

/// What a value is written as.
#[derive(Clone, Copy)]
enum Written {
    /// A number and its unit, with an example.
    Quantity(&'static str),
    Text,
    Number,
    /// A whole number of at least this.
    Whole(u64),
    /// One of these words.
    Word(&'static [&'static str]),
    /// A list of these words.
    Words(&'static [&'static str]),
    /// A list of texts.
    Texts,
    /// A list of quantities.
    Quantities(&'static str),
    /// The name of a preset.
    Preset,
}

use Written::{Number, Preset, Quantities, Quantity, Text, Texts, Whole, Word, Words};

type Key = (&'static str, Written, &'static str);

const SHOOTER: &[Key] = &[
    ("name", Text, "The shooter, for titles and the folder."),
    (
        "release_height",
        Quantity("7 ft"),
        "Height of the ball's centre above the floor at the release. Required.",
    ),
    (
        "max_backspin",
        Quantity("3 rev/s"),
        "Most backspin that the search may choose. Required.",
    ),
    (
        "max_side_spin",
        Quantity("1 rev/s"),
        "Most side spin that the search may choose; none by default.",
    ),
];

const SPEED_SD: &str = "Standard deviation of the speed.";
const PITCH_SD: &str = "Standard deviation of the pitch angle.";
const POLAR_SD: &str = "Standard deviation of the polar angle (left and right).";
const BACKSPIN_SD: &str = "Standard deviation of the backspin.";
const GROWTH: &str = "How a standard deviation grows with the value (Eq. 28 of the paper).";

const ERRORS: &[Key] = &[
    ("speed", Quantity("0.25 ft/s"), SPEED_SD),
    ("c10", Quantity("0.25 ft/s"), SPEED_SD),
    ("pitch", Quantity("1.2 deg"), PITCH_SD),
    ("c20", Quantity("1.2 deg"), PITCH_SD),
    ("polar", Quantity("1.22 deg"), POLAR_SD),
    ("c30", Quantity("1.22 deg"), POLAR_SD),
    ("backspin", Quantity("0.3 rev/s"), BACKSPIN_SD),
    ("c40", Quantity("0.3 rev/s"), BACKSPIN_SD),
    ("c11", Number, GROWTH),
    ("c12", Quantity("0.001 s/ft"), GROWTH),
    ("c41", Number, GROWTH),
    ("c42", Quantity("0.01 s/rev"), GROWTH),
    (
        "rifle_spin",
        Quantity("0.2 rev/s"),
        "Standard deviation of the spin about the direction of the shot.",
    ),
    (
        "side_spin",
        Quantity("0.2 rev/s"),
        "Standard deviation of the spin about the vertical.",
    ),
    (
        "distance",
        Quantity("1 in"),
        "Standard deviation of the distance of the release.",
    ),
    (
        "court_angle",
        Quantity("0.2 deg"),
        "Standard deviation of the court angle of the release.",
    ),
    (
        "height",
        Quantity("0.5 in"),
        "Standard deviation of the height of the release.",
    ),
];

const LOCATION: &[Key] = &[
    (
        "distance",
        Quantity("13.75 ft"),
        "Distance on the floor from the hoop's centre.",
    ),
    (
        "angle",
        Quantity("0 deg"),
        "From the court's long axis: 0 straight in front, 90 along the baseline on the right, facing the board.",
    ),
    (
        "x",
        Quantity("12 ft"),
        "Instead of distance and angle: out from the hoop's centre.",
    ),
    (
        "y",
        Quantity("3 ft"),
        "Instead of distance and angle: to the right, facing the board.",
    ),
    (
        "place",
        Text,
        "Instead of distance and angle: the name of a place, such as left elbow.",
    ),
    (
        "court",
        Word(&["ncaa", "nba", "fiba", "high_school"]),
        "With place: the court [default: that of the physics].",
    ),
];

const NOMINAL: &[Key] = &[
    ("speed", Quantity("24 ft/s"), "Speed of the release."),
    (
        "pitch",
        Quantity("53 deg"),
        "Angle of the release above the horizontal.",
    ),
    (
        "polar",
        Quantity("0 deg"),
        "Direction of the release from the court's long axis.",
    ),
    ("backspin", Quantity("2 rev/s"), "Backspin."),
    (
        "rifle_spin",
        Quantity("0 rev/s"),
        "Spin about the direction of the shot.",
    ),
    ("side_spin", Quantity("0 rev/s"), "Spin about the vertical."),
];

const SEARCH: &[Key] = &[
    (
        "choose",
        Words(&["speed", "pitch", "polar", "backspin", "side_spin"]),
        "Variables that the search chooses; the others stay at [nominal].",
    ),
    (
        "pitch_min",
        Quantity("40 deg"),
        "Least pitch angle of the search.",
    ),
    (
        "pitch_max",
        Quantity("65 deg"),
        "Greatest pitch angle of the search.",
    ),
    (
        "speed_max",
        Quantity("30 ft/s"),
        "Greatest speed of the search.",
    ),
    (
        "standard_error",
        Number,
        "Wanted standard error of each probability; 0.001 by default.",
    ),
    (
        "climb_samples",
        Whole(1),
        "Sobol points for each step of the search; 2048 by default.",
    ),
    ("seed", Whole(0), "Random seed; 1 by default."),
];

const GRID: &[Key] = &[
    (
        "speed",
        Whole(2),
        "Points of the table along the speed; 56 by default.",
    ),
    (
        "pitch",
        Whole(2),
        "Points along the pitch angle; 36 by default.",
    ),
    (
        "polar",
        Whole(2),
        "Points along the polar angle; 36 by default.",
    ),
    (
        "backspin",
        Whole(1),
        "Points along the backspin; 12 by default.",
    ),
];

/// What the table of the physics has beside [`CONSTANTS`].
const MORE_OF_PHYSICS: &[Key] = &[
    ("preset", Preset, "The ball and the hoop."),
    (
        "restitution",
        Number,
        "Speed after a head-on bounce over that before, of board and hoop.",
    ),
    ("board_restitution", Number, "The same of the board alone."),
    ("hoop_restitution", Number, "The same of the hoop alone."),
    (
        "damping",
        Quantity("20 kg/s"),
        "Instead of restitution: the damping of the ball.",
    ),
    (
        "stiffness",
        Quantity("29000 N/m"),
        "Stiffness of the contacts.",
    ),
    ("friction", Number, "Coefficient of friction."),
    (
        "board_edge_radius",
        Quantity("1 in"),
        "Radius of the board's rounded edges.",
    ),
    (
        "altitude",
        Quantity("5280 ft"),
        "Instead of air_density: height above the sea.",
    ),
    (
        "temperature",
        Quantity("72 F"),
        "Temperature of the air, with altitude.",
    ),
    (
        "integrator",
        Word(&["exact", "paper"]),
        "How shots are integrated; exact by default.",
    ),
    (
        "steps_per_contact",
        Whole(1),
        "Steps of the exact integrator; 4 by default.",
    ),
    (
        "dt_max",
        Quantity("1 ms"),
        "Longest step of the paper's integrator.",
    ),
    (
        "dt_min",
        Quantity("0.1 ms"),
        "Shortest step of the paper's integrator.",
    ),
    (
        "precision",
        Word(&["auto", "f64"]),
        "Precision of contacts; auto by default.",
    ),
];

/// The keys of the physics.
fn keys_of_physics() -> Vec<Key> {
    let constants = CONSTANTS.iter().map(|constant| {
        let written = match constant.dimension {
            Dimension::Number => Number,
            _ => Quantity(constant.example),
        };
        (constant.key, written, constant.meaning)
    });
    MORE_OF_PHYSICS.iter().copied().chain(constants).collect()
}

const OUTPUT: &[Key] = &[
    ("folder", Text, "Where runs are kept; results by default."),
    (
        "units",
        Word(&["imperial", "metric"]),
        "Units of the results; imperial by default.",
    ),
];

const SWEEP: &[Key] = &[
    ("name", Text, "The sweep, for titles and the folder."),
    (
        "shooter",
        Text,
        "Instead of [shooter]: a profile in the folder of this file.",
    ),
    (
        "court",
        Word(&["ncaa", "nba", "fiba", "high_school"]),
        "The floor lines; ncaa by default.",
    ),
    (
        "compute",
        Words(&["direct", "bank", "spin", "errors"]),
        "Kinds of shots, the gain from spin, the cost of each error.",
    ),
    (
        "region",
        Word(&[
            "half_court",
            "rectangle",
            "arcs",
            "three_point_line",
            "places",
        ]),
        "The places.",
    ),
    (
        "step",
        Quantity("1 ft"),
        "Distance between places of a grid, or along the three-point line.",
    ),
    (
        "within",
        Word(&["court", "three_point_line"]),
        "How far a half court reaches.",
    ),
    (
        "x",
        Quantities("4 ft"),
        "From and to, out from the hoop, of a rectangle.",
    ),
    (
        "y",
        Quantities("-8 ft"),
        "From and to, across, of a rectangle.",
    ),
    ("distances", Quantities("8 ft"), "Radii of arcs."),
    (
        "angles",
        Quantities("-50 deg"),
        "Least and greatest court angle of arcs.",
    ),
    (
        "angle_step",
        Quantity("10 deg"),
        "Angle between places of an arc.",
    ),
    (
        "places",
        Text,
        "A CSV file with columns such as x_ft and y_ft, or distance_ft and court_angle_deg.",
    ),
    (
        "names",
        Texts,
        "Names of places, such as left elbow; all: every place of the court that has a name.",
    ),
];

const TABLES: [(&str, &str, &[Key]); 7] = [
    ("shooter", "Who shoots.", SHOOTER),
    ("location", "From where.", LOCATION),
    (
        "nominal",
        "A shot: that of `shot` and `trace`, and what `best` keeps fixed.",
        NOMINAL,
    ),
    ("search", "How the best shot is sought.", SEARCH),
    ("grid", "How fine the table of the search is.", GRID),
    ("output", "Where results go.", OUTPUT),
    ("sweep", "The places of a sweep.", SWEEP),
];

/// The schema (JSON Schema, draft 7: editors of TOML read that).
#[must_use]
pub fn schema() -> Value {
    let mut tables = Map::new();
    for (name, description, keys) in TABLES {
        tables.insert(name.to_owned(), table(description, keys));
    }
    let physics = table("The ball and the hoop.", &keys_of_physics());
    tables.insert("physics".to_owned(), physics);
    let correlation = json!({
        "type": "object",
        "description": "Correlations between errors, from -1 to 1; keys such as speed_pitch.",
        "additionalProperties": { "type": "number", "minimum": -1, "maximum": 1 },
    });
    tables["shooter"]["properties"]["errors"] = table(
        "Standard deviations of the release errors. Required.",
        ERRORS,
    );
    tables["shooter"]["properties"]["correlation"] = correlation;
    json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "A shooter's profile or a sweep of bankshot",
        "type": "object",
        "properties": tables,
        "additionalProperties": false,
    })
}

fn table(description: &str, keys: &[Key]) -> Value {
    let properties: Map<String, Value> = keys
        .iter()
        .map(|(key, written, description)| {
            let mut value = written.schema();
            value["description"] = (*description).into();
            ((*key).to_owned(), value)
        })
        .collect();
    json!({
        "type": "object",
        "description": description,
        "properties": properties,
        "additionalProperties": false,
    })
}

impl Written {
    fn schema(self) -> Value {
        match self {
            Quantity(example) => json!({ "type": "string", "examples": [example] }),
            Text => json!({ "type": "string" }),
            Number => json!({ "type": ["number", "string"] }),
            Whole(least) => json!({ "type": "integer", "minimum": least }),
            Word(words) => json!({ "enum": words }),
            Texts => json!({
                "type": "array",
                "items": { "type": "string" },
            }),
            Words(words) => json!({
                "type": "array", "items": { "enum": words }, "uniqueItems": true, "minItems": 1,
            }),
            Quantities(example) => json!({
                "type": "array", "items": { "type": "string", "examples": [example] }, "minItems": 1,
            }),
            Preset => {
                let names: Vec<&str> = PRESETS.iter().map(|preset| preset.name).collect();
                json!({ "enum": names })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{parse_physics, parse_profile};
    use crate::model::Physics;
    use crate::units::{self, UnitSystem};

    /// The keys that the reader of a table says it knows.
    fn known_keys(table: &str) -> Vec<String> {
        let text = format!("[{table}]\nzzz = 1\n");
        let error = parse_profile(&text, "test").unwrap_err();
        let key = format!("{table}.zzz");
        let found = error.diagnostics.iter().find(|one| one.key == key);
        let message = &found.unwrap_or_else(|| panic!("{error}")).message;
        let (_, names) = message.split_once("known are ").unwrap();
        let mut names: Vec<String> = names.split(", ").map(str::to_owned).collect();
        names.sort();
        names
    }

    #[test]
    fn contract_the_schema_has_the_keys_that_the_reader_knows() {
        let physics = keys_of_physics();
        let tables = TABLES.map(|(table, _, keys)| (table, keys));
        for (table, keys) in tables.into_iter().chain([("physics", &physics[..])]) {
            if table == "sweep" {
                continue;
            }
            let mut keys: Vec<String> = keys.iter().map(|(key, ..)| (*key).to_owned()).collect();
            if table == "shooter" {
                keys.extend(["errors", "correlation"].map(str::to_owned));
            }
            keys.sort();
            assert_eq!(keys, known_keys(table), "{table}");
        }
        let mut errors: Vec<&str> = ERRORS.iter().map(|(key, ..)| *key).collect();
        errors.sort_unstable();
        assert_eq!(errors, known_keys("shooter.errors"));
    }

    /// A row of [`CONSTANTS`] is all that a constant needs: it is read, has its range, is in the
    /// schema and, unless it is one of the numerics or told by another value, is listed.
    #[test]
    fn contract_a_row_of_the_table_is_all_that_a_constant_needs() {
        let usual = Physics::default();
        let listed = usual.values(UnitSystem::Imperial);
        for constant in CONSTANTS {
            let key = constant.key;
            let text = format!("[physics]\n{key} = \"{}\"\n", constant.example);
            let (read, _) = parse_physics(&text, "test").unwrap();
            let known = units::parse(constant.example, constant.dimension).unwrap();
            assert_eq!((constant.get)(&read), known, "{key}");
            let mut beyond = usual.clone();
            (constant.set)(&mut beyond, 2.0 * constant.range.1);
            let errors = beyond.errors();
            assert!(errors.iter().any(|error| error.key == key), "{key}");
            let in_schema = &schema()["properties"]["physics"]["properties"][key];
            assert_eq!(in_schema["description"], constant.meaning);
            let is_listed = listed.iter().any(|value| value.key == key);
            let is_hidden = key.ends_with("_damping") || constant.dimension == Dimension::Time;
            assert_eq!(is_listed, !is_hidden, "{key}");
        }
    }

    /// Every example is what the reader takes.
    #[test]
    fn contract_the_examples_of_the_schema_are_valid() {
        let good = "[shooter]\nrelease_height = \"7 ft\"\nmax_backspin = \"3 rev/s\"\n[shooter.errors]\nspeed = \"0.25 ft/s\"\n\
                    pitch = \"1.2 deg\"\npolar = \"1.22 deg\"\nbackspin = \"0.3 rev/s\"\n[location]\ndistance = \"13.75 ft\"\n\
                    angle = \"0 deg\"\n";
        let physics = keys_of_physics();
        for (table, keys) in [
            ("nominal", NOMINAL),
            ("search", SEARCH),
            ("physics", &physics[..]),
        ] {
            for (key, written, _) in keys {
                let Quantity(example) = written else { continue };
                let text = format!("{good}[{table}]\n{key} = \"{example}\"\n");
                let named = format!("{table}.{key}");
                if let Err(error) = parse_profile(&text, "test") {
                    let of_key = error.diagnostics.iter().find(|one| one.key == named);
                    // Some keys need another beside them; none may have a faulty example.
                    let message = of_key.map_or("", |one| one.message.as_str());
                    let is_faulty = message.contains("unit") || message.contains("number");
                    assert!(!is_faulty, "{named} = {example}: {message}");
                }
            }
        }
    }
}
