//! The table `[physics]`: constants of the model, and the integrator.

use super::diagnostics::{ConfigError, Diagnostic, Problem};
use super::toml_reader::{TableReader, parse_toml};
use crate::dynamics::{Integrator, Precision};
use crate::model::{BoardEdge, CONSTANTS, DEFAULT_PRESET, PRESETS, Physics, Preset, SolidId};
use crate::units::{Dimension, suggestion};

/// Steps of the paper's integrator that a file can give, s.
const PAPER_STEPS_S: std::ops::RangeInclusive<f64> = 1e-7..=0.1;

/// Parses a file with a `[physics]` table; everything else in it is ignored. `origin` names the
/// file in messages.
///
/// # Errors
/// Everything that is wrong with the table.
pub fn parse_physics(text: &str, origin: &str) -> Result<(Physics, Integrator), ConfigError> {
    parse_toml(text, origin, |mut root, diagnostics| {
        if !root.has("physics") {
            let message = "there is no [physics] table in this file";
            diagnostics.push(root.diagnostic("physics", message));
        }
        let before = diagnostics.len();
        let (physics, integrator) = read_physics(&mut root, diagnostics);
        for error in physics.errors() {
            let key = format!("physics.{}", error.key);
            if diagnostics[before..].iter().all(|other| other.key != key) {
                diagnostics.push(Diagnostic {
                    span: root.as_written(&key).1,
                    key,
                    message: format!("must be {}", error.allowed),
                    problem: Problem::Other,
                });
            }
        }
        Some((physics, integrator))
    })
}

/// Whether a text has a physics and no shooter.
#[cfg(feature = "app")]
#[must_use]
pub fn is_physics_alone(text: &str) -> bool {
    text.parse::<toml::Table>()
        .is_ok_and(|table| table.contains_key("physics") && !table.contains_key("shooter"))
}

/// Reads the table. The constants are not checked here.
pub(super) fn read_physics(
    root: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> (Physics, Integrator) {
    let mut table = root.table("physics", diagnostics);
    let name = table.text("preset", diagnostics);
    let preset = Preset::named(name.as_deref().unwrap_or(DEFAULT_PRESET));
    if preset.is_none() {
        let names: Vec<_> = PRESETS.iter().map(|preset| preset.name).collect();
        let meant = suggestion(name.as_deref().unwrap_or_default(), names.iter().copied());
        let message = format!("must be one of {}{meant}", names.join(", "));
        diagnostics.push(table.diagnostic("preset", message));
    }
    let mut physics = preset.map_or_else(Physics::default, Preset::physics);
    read_constants(&mut table, &mut physics, diagnostics);
    let default = preset.filter(|preset| preset.name != "paper");
    read_contacts(&mut table, &mut physics, default, diagnostics);
    let integrator = read_integrator(&mut table, diagnostics);
    table.report_unknown_keys(diagnostics);
    (physics, integrator)
}

fn read_constants(
    table: &mut TableReader<'_, '_>,
    physics: &mut Physics,
    diagnostics: &mut Vec<Diagnostic>,
) {
    // Those of the contacts can be given for both at once.
    let of_contacts = ContactKeys::ALL.iter().flat_map(|of| of.keys);
    let of_contacts: Vec<&str> = of_contacts.collect();
    for constant in CONSTANTS {
        if of_contacts.contains(&constant.key) {
            continue;
        }
        if let Some(value) = table.quantity(constant.key, constant.dimension, diagnostics) {
            (constant.set)(physics, value);
        }
    }
    read_altitude(table, physics, diagnostics);
    if let Some(radius_m) = table.quantity("board_edge_radius", Dimension::Length, diagnostics) {
        physics.board_edge = BoardEdge::Rounded { radius_m };
    }
}

/// The density of dry air at an altitude of the standard atmosphere and at a temperature.
fn read_altitude(
    table: &mut TableReader<'_, '_>,
    physics: &mut Physics,
    diagnostics: &mut Vec<Diagnostic>,
) {
    const ALTITUDES_M: std::ops::RangeInclusive<f64> = -500.0..=9000.0;
    const USUAL_TEMPERATURE_K: f64 = 293.15;
    let altitude_m = table.quantity("altitude", Dimension::Length, diagnostics);
    let temperature = table.text("temperature", diagnostics);
    if altitude_m.is_none() && temperature.is_none() {
        return;
    }
    let given = if altitude_m.is_some() {
        "altitude"
    } else {
        "temperature"
    };
    if table.has("air_density") {
        let message = format!("give either {given} or air_density");
        diagnostics.push(table.diagnostic(given, message));
    }
    let altitude_m = altitude_m.unwrap_or(0.0);
    if !ALTITUDES_M.contains(&altitude_m) {
        diagnostics.push(table.diagnostic("altitude", "must be from -500 m to 9000 m"));
        return;
    }
    let kelvin = match temperature.as_deref() {
        None => Some(USUAL_TEMPERATURE_K),
        Some(text) => kelvin(text).filter(|kelvin| (200.0..=350.0).contains(kelvin)),
    };
    let Some(kelvin) = kelvin else {
        let message = "must be from -70 C to 70 C, such as \"72 F\", \"22 C\" or \"295 K\"";
        diagnostics.push(table.diagnostic("temperature", message));
        return;
    };
    physics.air.density_kg_m3 = density_of_air_kg_m3(altitude_m, kelvin);
}

/// The temperature of a text such as `72 F`, in K.
fn kelvin(text: &str) -> Option<f64> {
    let text = text.trim();
    let (number, unit) = text.split_at(text.len().checked_sub(1)?);
    let value: f64 = number
        .trim_end()
        .trim_end_matches('\u{b0}')
        .trim_end()
        .parse()
        .ok()?;
    match unit {
        "K" => Some(value),
        "C" => Some(value + 273.15),
        "F" => Some((value + 459.67) / 1.8),
        _ => None,
    }
}

/// The density of dry air with the pressure of the International Standard Atmosphere (ISO 2533) at
/// an altitude.
fn density_of_air_kg_m3(altitude_m: f64, kelvin: f64) -> f64 {
    const GAS_CONSTANT: f64 = 287.053;
    let pressure_pa = 101_325.0 * libm::pow(1.0 - 2.255_77e-5 * altitude_m, 5.255_88);
    pressure_pa / (GAS_CONSTANT * kelvin)
}

/// The keys of one constant of the contacts: for both, for the board's, for the hoop's.
struct ContactKeys {
    dimension: Dimension,
    keys: [&'static str; 3],
}

impl ContactKeys {
    const ALL: [Self; 4] = [
        Self::STIFFNESS,
        Self::DAMPING,
        Self::FRICTION,
        Self::RESTITUTION,
    ];
    const STIFFNESS: Self = Self {
        dimension: Dimension::Stiffness,
        keys: ["stiffness", "board_stiffness", "hoop_stiffness"],
    };
    const DAMPING: Self = Self {
        dimension: Dimension::Damping,
        keys: ["damping", "board_damping", "hoop_damping"],
    };
    const FRICTION: Self = Self {
        dimension: Dimension::Number,
        keys: ["friction", "board_friction", "hoop_friction"],
    };
    const RESTITUTION: Self = Self {
        dimension: Dimension::Number,
        keys: ["restitution", "board_restitution", "hoop_restitution"],
    };

    /// The values for board and hoop, each with its key.
    fn read(
        &self,
        table: &mut TableReader<'_, '_>,
        diagnostics: &mut Vec<Diagnostic>,
    ) -> [Option<(&'static str, f64)>; SolidId::COUNT] {
        let mut read = |key| Some((key, table.quantity(key, self.dimension, diagnostics)?));
        let [common, board, hoop] = self.keys.map(&mut read);
        for (key, _) in [board, hoop].into_iter().flatten() {
            if common.is_some() {
                let message = format!("give either {} or {key}", self.keys[0]);
                diagnostics.push(table.diagnostic(key, message));
            }
        }
        [board.or(common), hoop.or(common)]
    }
}

/// Reads the contacts with board and hoop. A `preset` whose contacts are defined by their
/// restitutions keeps those when mass or stiffness change.
fn read_contacts(
    table: &mut TableReader<'_, '_>,
    physics: &mut Physics,
    preset: Option<&Preset>,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let stiffness = ContactKeys::STIFFNESS.read(table, diagnostics);
    let damping = ContactKeys::DAMPING.read(table, diagnostics);
    let friction = ContactKeys::FRICTION.read(table, diagnostics);
    let restitution = ContactKeys::RESTITUTION.read(table, diagnostics);
    let mut refused = Vec::new();
    for solid in SolidId::ALL {
        let i = solid.index();
        let contact = physics.contact_mut(solid);
        let set = |constant: &mut f64, value: Option<(&str, f64)>| {
            *constant = value.map_or(*constant, |(_, value)| value);
        };
        set(&mut contact.stiffness_n_m, stiffness[i]);
        set(&mut contact.damping_kg_s, damping[i]);
        set(&mut contact.friction, friction[i]);
        match (restitution[i], damping[i]) {
            (Some((key, _)), Some((other, _))) => {
                refused.push((key, format!("give either {key} or {other}")));
            }
            (Some((key, value)), None) => {
                if let Err(error) = physics.set_restitution_on(solid, value) {
                    refused.push((key, format!("must be {}", error.allowed)));
                }
            }
            (None, None) => {
                if let Some(preset) = preset {
                    let usual = preset.physics().restitution_on(solid);
                    physics
                        .set_restitution_on(solid, usual)
                        .expect("the restitution of a preset");
                }
            }
            (None, Some(_)) => {}
        }
    }
    refused.dedup();
    for (key, message) in refused {
        diagnostics.push(table.diagnostic(key, message));
    }
}

fn read_integrator(
    table: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Integrator {
    let name = table.text("integrator", diagnostics);
    let steps = table
        .count("steps_per_contact", 2..=100_000, diagnostics)
        .and_then(|steps| u32::try_from(steps).ok());
    let precision = match table.text("precision", diagnostics).as_deref() {
        None | Some("auto") => Precision::Automatic,
        Some("f64") => Precision::Double,
        Some(_) => {
            let message = "must be \"auto\" or \"f64\"";
            diagnostics.push(table.diagnostic("precision", message));
            Precision::Automatic
        }
    };
    let mut step = |key| {
        let value = table.quantity(key, Dimension::Time, diagnostics)?;
        if PAPER_STEPS_S.contains(&value) {
            return Some(value);
        }
        diagnostics.push(table.diagnostic(key, "must be from 1e-7 s to 0.1 s"));
        None
    };
    let dt_max_s = step("dt_max").unwrap_or(0.015);
    let dt_min_s = step("dt_min").unwrap_or(0.0005);
    if dt_min_s > dt_max_s {
        diagnostics.push(table.diagnostic("dt_min", "must not be more than dt_max"));
    }
    match name.as_deref() {
        None | Some("exact") => Integrator::EventDriven {
            steps_per_contact: steps.unwrap_or(4),
            precision,
        },
        Some("paper") => Integrator::PaperRk4 { dt_max_s, dt_min_s },
        Some(_) => {
            let message = "must be \"exact\" or \"paper\"";
            diagnostics.push(table.diagnostic("integrator", message));
            Integrator::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Authority: the tables of ISO 2533 at 0 and 1500 m, and Denver's density as published for its
    /// summer.
    #[test]
    fn val_density_of_air() {
        assert!((density_of_air_kg_m3(0.0, 288.15) - 1.225).abs() < 1e-3);
        assert!((density_of_air_kg_m3(1500.0, 278.4) - 1.0581).abs() < 1e-3);
        assert!((density_of_air_kg_m3(1609.3, 295.0) - 0.985).abs() < 0.01);
        assert_eq!(kelvin("22 C"), Some(295.15));
        assert!((kelvin("72 \u{b0}F").unwrap() - 295.372).abs() < 1e-3);
        assert_eq!(kelvin("22"), None);
    }
}
