//! The `[physics]` table: constants of the model and the integrator.

use super::fault::Fault;
use super::keys::Keys;
use super::read::check;
use crate::dynamics::Integrator;
use crate::physics::Physics;
use crate::units::Dimension;

pub(super) fn read_physics(
    root: &mut Keys<'_, '_>,
    faults: &mut Vec<Fault>,
) -> (Physics, Integrator) {
    let mut keys = root.table("physics", faults);
    let mut physics = Physics::paper();
    if keys
        .text("preset", faults)
        .is_some_and(|preset| preset != "paper")
    {
        faults.push(keys.fault(
            "preset",
            "must be \"paper\" (set restitution for a livelier or duller ball)",
        ));
    }
    let before = faults.len();
    {
        let p = &mut physics;
        let settings: [(&'static str, Dimension, &mut f64); 15] = [
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
        for (key, dimension, place) in settings {
            if let Some(value) = keys.quantity(key, dimension, faults) {
                *place = value;
            }
        }
    }
    if let Some(restitution) = keys.quantity("restitution", Dimension::Number, faults) {
        if keys.has("damping") {
            faults.push(keys.fault("restitution", "give either restitution or damping"));
        } else if let Err(error) = physics.set_restitution(restitution) {
            faults.push(keys.fault("restitution", format!("must be {}", error.allowed)));
        }
    }
    for error in physics.faults() {
        let told = faults[before..]
            .iter()
            .any(|fault| fault.key == keys.name(error.key));
        if !told {
            faults.push(keys.fault(error.key, format!("must be {}", error.allowed)));
        }
    }
    let integrator = read_integrator(&mut keys, faults);
    keys.finish(faults);
    (physics, integrator)
}

fn read_integrator(keys: &mut Keys<'_, '_>, faults: &mut Vec<Fault>) -> Integrator {
    let name = keys
        .text("integrator", faults)
        .unwrap_or_else(|| "exact".to_owned());
    let steps = keys
        .count("steps_per_contact", 2..=100_000, faults)
        .unwrap_or(8);
    let dt_max = keys
        .quantity("dt_max", Dimension::Time, faults)
        .unwrap_or(0.015);
    let dt_min = keys
        .quantity("dt_min", Dimension::Time, faults)
        .unwrap_or(0.0005);
    for (key, value) in [("dt_max", dt_max), ("dt_min", dt_min)] {
        check(
            keys,
            key,
            Some(value),
            |dt| (1e-7..=0.1).contains(&dt),
            "from 1e-7 s to 0.1 s",
            faults,
        );
    }
    if dt_min > dt_max {
        faults.push(keys.fault("dt_min", "must not be more than dt_max"));
    }
    match name.as_str() {
        "exact" => Integrator::Exact {
            steps_per_contact: u32::try_from(steps).unwrap_or(8),
        },
        "paper" => Integrator::Paper {
            dt_max_s: dt_max,
            dt_min_s: dt_min,
        },
        _ => {
            faults.push(keys.fault("integrator", "must be \"exact\" or \"paper\""));
            Integrator::EXACT
        }
    }
}
