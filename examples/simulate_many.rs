//! The time that the integrator alone takes for many shots:
//! `cargo run --release --example simulate_many [SHOTS] [THREADS]`. The releases are those of
//! `python/benches/simulate_many.py`, which measures what the Python package adds to it.

use bankshot::dynamics::{BatchWorkspace, Release, Simulator};
use bankshot::model::{BallState, Preset};
use bankshot::units::{DEGREE_RAD, FOOT_M, REV_RAD};
use rayon::prelude::*;
use std::time::Instant;

/// Shots that one thread takes at a time.
const AT_A_TIME: usize = 65_536;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let mut number = |usual: usize| {
        arguments
            .next()
            .map_or(usual, |n| n.parse().expect("a number"))
    };
    let (shots, threads) = (number(10_000_000), number(0));
    let simulator = Simulator::new(&Preset::named("ncaa").expect("a preset").physics());
    let simulator = simulator.expect("a preset can be simulated");
    // Additive recurrences: uniform, and the same in any language.
    let states: Vec<BallState> = (0..shots)
        .map(|i| {
            let u = |step: f64| (i as f64 * step).fract();
            Release {
                distance_m: 13.75 * FOOT_M,
                court_angle_rad: 0.0,
                height_above_hoop_m: 7.0 * FOOT_M - simulator.physics().hoop_plane_height_m(),
                speed_m_s: (22.66 + 5.15 * u(0.618_033_988_749_894_9)) * FOOT_M,
                pitch_rad: (40.0 + 25.0 * u(0.754_877_666_246_692_7)) * DEGREE_RAD,
                polar_rad: (-3.0 + 6.0 * u(0.569_840_290_998_053_3)) * DEGREE_RAD,
                backspin_rad_s: 5.0 * u(0.414_213_562_373_095_1) * REV_RAD,
                rifle_spin_rad_s: 0.0,
                side_spin_rad_s: 0.0,
            }
            .state()
        })
        .collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let start = Instant::now();
    let made: usize = pool.expect("threads").install(|| {
        states
            .par_chunks(AT_A_TIME)
            .map_init(BatchWorkspace::default, |workspace, states| {
                let verdicts = simulator.verdicts(states, workspace).expect("finite");
                verdicts.iter().filter(|verdict| verdict.made).count()
            })
            .sum()
    });
    println!(
        "{shots} shots, {made} made, {:.3} s",
        start.elapsed().as_secs_f64()
    );
}
