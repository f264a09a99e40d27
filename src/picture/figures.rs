//! The paper's Figs. 7 to 15 from the configurations in `configs/paper/`.

use super::release_map::{self, WHOLE};
use super::shot::{self, Path, three_views};
use super::svg::{Anchor, Svg};
use super::sweep_maps::Picture;
use crate::dynamics::{Simulator, State, Triple};
use crate::physics::{FOOT_M, Physics, PhysicsError};
use crate::probability::release_map::{Cells, outcomes};
use crate::profile::{self, Nominal, Profile, ProfileError};
use crate::units::{DEGREE_RAD, REV_RAD, System};

/// Spacing of trajectories in flight, s.
const INTERVAL_S: f64 = 0.005;
/// Turns of the swirl that are drawn at most, and the step of its contact, as a part of the head-on contact time.
const SWIRL_STEPS: u32 = 64;

/// Shots that the paper draws: figure, configuration, title.
const SHOTS: [(&str, &str, &str); 4] = [
    (
        "fig_07",
        include_str!("../../configs/paper/fig_07.toml"),
        "Fig. 7: a direct swish from the side",
    ),
    (
        "fig_08",
        include_str!("../../configs/paper/fig_08.toml"),
        "Fig. 8: a bank shot from the side",
    ),
    (
        "fig_09",
        include_str!("../../configs/paper/fig_09.toml"),
        "Fig. 9: a direct shot that bounces again and again",
    ),
    (
        "fig_10",
        include_str!("../../configs/paper/fig_10.toml"),
        "Fig. 10: a bank shot that bounces off board and ring",
    ),
];

/// Maps that the paper draws: figure, configuration, title, polar angle (deg), backspin (rev/s).
const MAPS: [(&str, &str, &str, f64, f64); 4] = [
    (
        "fig_12",
        include_str!("../../configs/paper/fig_12.toml"),
        "Fig. 12: direct foul shots without spin",
        0.0,
        0.0,
    ),
    (
        "fig_13",
        include_str!("../../configs/paper/fig_13.toml"),
        "Fig. 13: direct foul shots, 3 rev/s of backspin",
        0.0,
        3.0,
    ),
    (
        "fig_14",
        include_str!("../../configs/paper/fig_14.toml"),
        "Fig. 14: direct side shots, 3 rev/s of backspin",
        67.5,
        3.0,
    ),
    (
        "fig_15",
        include_str!("../../configs/paper/fig_15.toml"),
        "Fig. 15: bank side shots, 3 rev/s of backspin",
        62.107,
        3.0,
    ),
];

/// Why a figure could not be made.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// Its configuration is not sound.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// Its physics cannot be simulated.
    #[error(transparent)]
    Physics(#[from] PhysicsError),
}

/// All of them, in their order.
///
/// # Errors
/// When a configuration of the figures is not sound.
pub fn all() -> Result<Vec<Picture>, FigureError> {
    let mut pictures = Vec::new();
    for (name, text, title) in SHOTS {
        pictures.push(one_shot(name, &profile::parse(text, name)?, title)?);
    }
    pictures.push(swirl(&Physics::paper())?);
    for (name, text, title, polar, spin) in MAPS {
        pictures.push(one_map(
            name,
            &profile::parse(text, name)?,
            title,
            polar,
            spin,
        )?);
    }
    Ok(pictures)
}

fn one_shot(name: &str, profile: &Profile, title: &str) -> Result<Picture, FigureError> {
    let simulator = Simulator::with_integrator(&profile.physics, profile.integrator)?;
    let nominal = profile.held();
    let trace = simulator.trace(&profile.release(&nominal), INTERVAL_S);
    let note = format!(
        "{:.2} ft/s, pitch {:.1} deg, polar {:.3} deg, backspin {:.0} rev/s, 13.75 ft from the hoop at 67.5 deg: {}. Marks: touches of the board (green) and the ring (yellow).",
        nominal.speed_m_s / FOOT_M,
        nominal.pitch_rad / DEGREE_RAD,
        nominal.polar_rad / DEGREE_RAD,
        nominal.backspin_rad_s / REV_RAD,
        trace.outcome.kind.name()
    );
    let path = Path {
        trace: &trace,
        colour: shot::MADE,
        in_full: true,
    };
    Ok(three_views(
        name,
        title,
        &note,
        &profile.physics,
        System::Imperial,
        &[path],
    ))
}

/// Where and how the ball swirls steadily round the ring: the state of the paper's section IV for the angle
/// delta, with the spin of a ball that rolls (its printed sign and arm are misprints; `docs/model.md`).
#[must_use]
pub fn swirl_start(physics: &Physics, delta_rad: f64) -> State {
    let (sin, cos) = libm::sincos(delta_rad);
    let weight_n = physics.ball_mass_kg * physics.gravity_m_s2;
    let lever = physics.ball_radius_m - weight_n / (physics.stiffness_n_m * cos);
    let circle = physics.ring_radius_m - lever * sin;
    let speed = -(physics.gravity_m_s2 * (sin / cos) * circle).sqrt();
    State {
        position_m: Triple(0.0, circle, lever * cos),
        velocity_m_s: Triple(speed, 0.0, 0.0),
        spin_rad_s: Triple(0.0, 0.0, speed / (lever * sin)),
    }
}

fn swirl(physics: &Physics) -> Result<Picture, FigureError> {
    let steps = crate::dynamics::Integrator::Exact {
        steps_per_contact: SWIRL_STEPS,
    };
    let simulator = Simulator::with_integrator(physics, steps)?;
    let trace = simulator.trace_from(swirl_start(physics, 87.5 * DEGREE_RAD), INTERVAL_S);
    let path = Path {
        trace: &trace,
        colour: shot::MADE,
        in_full: true,
    };
    let note = "The steady swirl of section IV, delta = 87.5 deg: the ball rolls round the inside of the ring for several turns, then drops through.";
    Ok(three_views(
        "fig_11",
        "Fig. 11: a swirl",
        note,
        physics,
        System::Imperial,
        &[path],
    ))
}

fn one_map(
    name: &str,
    profile: &Profile,
    title: &str,
    polar_deg: f64,
    spin_rev_s: f64,
) -> Result<Picture, FigureError> {
    let simulator = Simulator::with_integrator(&profile.physics, profile.integrator)?;
    let cells = Cells {
        speed_m_s: (21.0 * FOOT_M, 29.0 * FOOT_M),
        pitch_rad: (35.0 * DEGREE_RAD, 70.0 * DEGREE_RAD),
        columns: 800,
        rows: 600,
    };
    let nominal = Nominal {
        polar_rad: polar_deg * DEGREE_RAD,
        backspin_rad_s: spin_rev_s * REV_RAD,
        ..Nominal::default()
    };
    let kinds = outcomes(profile, &simulator, &nominal, &cells);
    let mut svg = Svg::new(WHOLE.0, WHOLE.1 + 16.0);
    release_map::of_outcomes(
        &mut svg,
        (0.0, 4.0),
        title,
        &cells,
        System::Imperial,
        &kinds,
    );
    svg.text(
        (20.0, WHOLE.1 + 8.0),
        10.0,
        Anchor::Start,
        "13.75 ft from the hoop, released 7 ft above the floor; every pixel is one shot.",
    );
    Ok(Picture {
        name: name.to_owned(),
        caption: title.to_owned(),
        svg: svg.finish(title),
    })
}
