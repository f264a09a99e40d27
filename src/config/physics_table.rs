//! The table `[physics]`: constants of the model, and the integrator.

use super::diagnostics::{ConfigError, Diagnostic};
use super::toml_reader::{TableReader, parse_toml};
use crate::dynamics::{Integrator, Precision};
use crate::model::Physics;
use crate::units::Dimension;

/// Steps of the paper's integrator that a file can give, s.
const PAPER_STEPS_S: std::ops::RangeInclusive<f64> = 1e-7..=0.1;

/// Parses a file with a `[physics]` table; everything else in it is ignored. `origin` names the file in
/// messages.
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
                    span: root.span_of(&key),
                    key,
                    message: format!("must be {}", error.allowed),
                });
            }
        }
        Some((physics, integrator))
    })
}

/// Reads the table. The constants are not checked here.
pub(super) fn read_physics(
    root: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> (Physics, Integrator) {
    let mut table = root.table("physics", diagnostics);
    let mut physics = Physics::paper();
    let preset = table.text("preset", diagnostics);
    if preset.is_some_and(|preset| preset != "paper") {
        let message = "must be \"paper\" (set restitution for a livelier or duller ball)";
        diagnostics.push(table.diagnostic("preset", message));
    }
    read_constants(&mut table, &mut physics, diagnostics);
    if let Some(restitution) = table.quantity("restitution", Dimension::Number, diagnostics) {
        if table.has("damping") {
            let message = "give either restitution or damping";
            diagnostics.push(table.diagnostic("restitution", message));
        } else if let Err(error) = physics.set_restitution(restitution) {
            let message = format!("must be {}", error.allowed);
            diagnostics.push(table.diagnostic("restitution", message));
        }
    }
    let integrator = read_integrator(&mut table, diagnostics);
    table.report_unknown_keys(diagnostics);
    (physics, integrator)
}

fn read_constants(
    table: &mut TableReader<'_, '_>,
    physics: &mut Physics,
    diagnostics: &mut Vec<Diagnostic>,
) {
    let p = physics;
    let constants: [(&'static str, Dimension, &mut f64); 15] = [
        ("ball_radius", Dimension::Length, &mut p.ball_radius_m),
        ("ball_mass", Dimension::Mass, &mut p.ball_mass_kg),
        ("inertia_ratio", Dimension::Number, &mut p.inertia_ratio),
        ("ring_radius", Dimension::Length, &mut p.ring_radius_m),
        ("board_distance", Dimension::Length, &mut p.board_distance_m),
        ("board_width", Dimension::Length, &mut p.board_width_m),
        ("board_height", Dimension::Length, &mut p.board_height_m),
        (
            "board_centre_height",
            Dimension::Length,
            &mut p.board_centre_height_m,
        ),
        ("hoop_height", Dimension::Length, &mut p.hoop_height_m),
        ("gravity", Dimension::Acceleration, &mut p.gravity_m_s2),
        ("stiffness", Dimension::Stiffness, &mut p.stiffness_n_m),
        ("damping", Dimension::Damping, &mut p.damping_kg_s),
        ("friction", Dimension::Number, &mut p.friction),
        ("time_limit", Dimension::Time, &mut p.time_limit_s),
        ("lodged_after", Dimension::Time, &mut p.lodged_after_s),
    ];
    for (key, dimension, constant) in constants {
        if let Some(value) = table.quantity(key, dimension, diagnostics) {
            *constant = value;
        }
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
