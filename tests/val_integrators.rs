//! The two integrators against each other and against their own smallest steps.
//!
//! Two shots that start within 1e-9 of each other can end differently after several bounces, so
//! agreement is a rate over many shots.

mod common;

use bankshot::dynamics::{Simulator, State, Triple};
use bankshot::physics::{FOOT_M, Physics};
use common::{agreement, exact, foul, paper, side};

#[test]
fn val_exact_agrees_with_its_own_smallest_steps_on_foul() {
    let physics = Physics::paper();
    let rate = agreement(
        &exact(&physics, 8),
        &exact(&physics, 1000),
        &foul(20_000, 11),
    );
    assert!(rate >= 0.999, "{rate}");
}

#[test]
fn val_exact_agrees_with_its_own_smallest_steps_from_the_side() {
    let physics = Physics::paper();
    let rate = agreement(
        &exact(&physics, 8),
        &exact(&physics, 1000),
        &side(20_000, 12),
    );
    assert!(rate >= 0.999, "{rate}");
}

#[test]
fn val_paper_integrator_approaches_exact_as_its_steps_shrink() {
    let physics = Physics::paper();
    let reference = exact(&physics, 64);
    let shots = foul(20_000, 13);
    let at = |dt_max, dt_min| agreement(&paper(&physics, dt_max, dt_min), &reference, &shots);
    let own = at(0.015, 0.0005);
    let finer = at(0.002, 0.000_05);
    let finest = at(0.001, 0.000_01);
    assert!(own >= 0.992, "{own}");
    assert!(finer > own && finest > finer, "{own} {finer} {finest}");
    assert!(finest >= 0.999, "{finest}");
}

/// Velocity and spin of a ball that leaves the board, having slid and rolled.
fn after_bounce(simulator: &Simulator) -> [f64; 6] {
    let start = State {
        position_m: Triple(0.0, 0.0, 0.6),
        velocity_m_s: Triple(-12.0 * FOOT_M, 5.0 * FOOT_M, -3.0 * FOOT_M),
        spin_rad_s: Triple(3.0, 2.0, -1.0),
    };
    let trace = simulator.trace_from(start, 1.0);
    let parted = trace
        .events
        .iter()
        .find(|event| matches!(event.kind, bankshot::dynamics::EventKind::Part { .. }))
        .unwrap();
    let Triple(vx, vy, vz) = parted.state.velocity_m_s;
    let Triple(wx, wy, wz) = parted.state.spin_rad_s;
    [vx, vy, vz, wx, wy, wz]
}

fn distance(a: [f64; 6], b: [f64; 6]) -> f64 {
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).powi(2))
        .sum::<f64>()
        .sqrt()
}

/// Mean order over several halvings of the step; single ratios scatter with where the last step of a
/// phase happens to end.
fn order(coarse: f64, fine: f64, halvings: i32) -> f64 {
    libm::log2(coarse / fine) / f64::from(halvings)
}

#[test]
fn val_convergence_orders() {
    let physics = Physics::paper();
    let reference = after_bounce(&exact(&physics, 1024));
    let error = |n: u32| distance(after_bounce(&exact(&physics, n)), reference);
    let exact_order = order(error(4), error(16), 2);
    assert!(
        exact_order > 3.0,
        "exact: order {exact_order} ({} {})",
        error(4),
        error(16)
    );
    // The sliding law alone chatters about the roll: first order.
    let error = |dt: f64| distance(after_bounce(&paper(&physics, 0.001, dt)), reference);
    let mean = |dt: f64| {
        (0..8)
            .map(|i| error(dt * (1.0 + 0.05 * f64::from(i))))
            .sum::<f64>()
            / 8.0
    };
    let paper_order = order(mean(1e-4), mean(1.25e-5), 3);
    assert!(
        (0.6..1.6).contains(&paper_order),
        "paper: order {paper_order}"
    );
}
