//! The paper's Figs. 7 to 15 from the profiles in `configs/paper/`.

use super::release_map::{MAP_SIZE, ReleaseMap};
use super::shot_views::{self, MADE_COLOUR, ShotPath};
use super::svg::Plot;
use super::svg::{Anchor, Svg};
use crate::analysis::release_map::{ReleaseCells, outcomes};
use crate::config::{ConfigError, parse_profile};
use crate::dynamics::{Integrator, Simulator, SimulatorError, StateError};
use crate::math::vector::Vec3;
use crate::model::{BallState, Physics};
use crate::shooter::{Nominal, Profile};
use crate::units::{DEGREE_RAD, FOOT_M, REV_RAD, UnitSystem};

/// Spacing of the trajectories in flight, s.
const INTERVAL_S: f64 = 0.005;
/// Steps of the swirl per head-on contact time: more than for a shot, because the ball stays in
/// contact for several turns.
const SWIRL_STEPS: u32 = 64;
/// Downward speed that ends the swirl of Fig. 11, m/s. Without any disturbance it would go on.
const SWIRL_DISTURBANCE_M_S: f64 = 1e-6;
/// Tilt delta of the swirl in Fig. 11, rad.
const SWIRL_DELTA_RAD: f64 = 87.5 * DEGREE_RAD;

/// The single shots of the paper: figure, profile, title.
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

/// The maps of the paper: figure, profile, title, polar angle (deg), backspin (rev/s).
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

/// Why a figure cannot be drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// Its profile is not valid.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// Its physics cannot be simulated.
    #[error(transparent)]
    Simulator(#[from] SimulatorError),
    /// Its release is not finite.
    #[error(transparent)]
    State(#[from] StateError),
}

/// Draws all figures in order.
///
/// # Errors
/// A profile of the figures is not valid.
pub fn draw_all() -> Result<Vec<Plot>, FigureError> {
    let mut plots = Vec::new();
    for (name, text, title) in SHOTS {
        plots.push(draw_shot(name, &parse_profile(text, name)?, title)?);
    }
    plots.push(draw_swirl(&Physics::paper())?);
    for (name, text, title, polar_deg, backspin_rev_s) in MAPS {
        let nominal = Nominal {
            polar_rad: polar_deg * DEGREE_RAD,
            backspin_rad_s: backspin_rev_s * REV_RAD,
            ..Nominal::default()
        };
        plots.push(draw_map(name, &parse_profile(text, name)?, title, &nominal));
    }
    Ok(plots)
}

fn draw_shot(name: &str, profile: &Profile, title: &str) -> Result<Plot, FigureError> {
    let nominal = profile.fixed_nominal();
    let trace = profile
        .simulator()
        .trace(&profile.release(&nominal), INTERVAL_S)?;
    let note = format!(
        "{:.2} ft/s, pitch {:.1} deg, polar {:.3} deg, backspin {:.0} rev/s, 13.75 ft from the hoop at 67.5 deg: {}. Marks: touches of the board (green) and the ring (yellow).",
        nominal.speed_m_s / FOOT_M,
        nominal.pitch_rad / DEGREE_RAD,
        nominal.polar_rad / DEGREE_RAD,
        nominal.backspin_rad_s / REV_RAD,
        trace.outcome.kind.name()
    );
    let path = ShotPath {
        trace: &trace,
        colour: MADE_COLOUR,
        is_detailed: true,
    };
    let units = UnitSystem::Imperial;
    Ok(shot_views::draw(
        name,
        title,
        &note,
        profile.physics(),
        units,
        &[path],
    ))
}

/// The state of a ball that swirls steadily around the inside of the ring (section IV of the paper)
/// with the tilt delta, and with the spin of a ball that rolls. The paper prints its sign and lever
/// arm wrong; see `docs/model.md`.
fn swirl_start(physics: &Physics, delta_rad: f64) -> BallState {
    let (sin, cos) = libm::sincos(delta_rad);
    let weight_n = physics.ball_mass_kg * physics.gravity_m_s2;
    let lever_m = physics.ball_radius_m - weight_n / (physics.hoop_contact.stiffness_n_m * cos);
    let circle_m = physics.ring_radius_m - lever_m * sin;
    let speed_m_s = -(physics.gravity_m_s2 * (sin / cos) * circle_m).sqrt();
    BallState {
        position_m: Vec3::new(0.0, circle_m, lever_m * cos),
        velocity_m_s: Vec3::new(speed_m_s, 0.0, -SWIRL_DISTURBANCE_M_S),
        spin_rad_s: Vec3::new(0.0, 0.0, speed_m_s / (lever_m * sin)),
    }
}

fn draw_swirl(physics: &Physics) -> Result<Plot, FigureError> {
    let integrator = Integrator::event_driven(SWIRL_STEPS);
    let simulator = Simulator::with_integrator(physics, integrator)?;
    let trace = simulator.trace_state(swirl_start(physics, SWIRL_DELTA_RAD), INTERVAL_S)?;
    let path = ShotPath {
        trace: &trace,
        colour: MADE_COLOUR,
        is_detailed: true,
    };
    let note = "The steady swirl of section IV, delta = 87.5 deg: the ball rolls round the inside of the ring for several turns, then drops through.";
    Ok(shot_views::draw(
        "fig_11",
        "Fig. 11: a swirl",
        note,
        physics,
        UnitSystem::Imperial,
        &[path],
    ))
}

fn draw_map(name: &str, profile: &Profile, title: &str, nominal: &Nominal) -> Plot {
    let cells = ReleaseCells {
        speed_m_s: (21.0 * FOOT_M, 29.0 * FOOT_M),
        pitch_rad: (35.0 * DEGREE_RAD, 70.0 * DEGREE_RAD),
        columns: 800,
        rows: 600,
    };
    let kinds = outcomes(profile, nominal, &cells);
    let mut svg = Svg::new(MAP_SIZE.0, MAP_SIZE.1 + 16.0);
    let map = ReleaseMap {
        corner: (0.0, 4.0),
        cells: &cells,
        units: UnitSystem::Imperial,
    };
    map.draw_outcomes(&mut svg, title, &kinds);
    svg.text(
        (20.0, MAP_SIZE.1 + 8.0),
        10.0,
        Anchor::Start,
        "13.75 ft from the hoop, released 7 ft above the floor; every pixel is one shot.",
    );
    Plot {
        name: name.to_owned(),
        caption: title.to_owned(),
        svg: svg.finish(title),
    }
}
