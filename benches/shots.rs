//! Shots per second of both integrators on the sample *foul* and from the side, one core, and their
//! ratio, in one run: `cargo bench --bench shots`.
#![allow(missing_docs, clippy::disallowed_methods)]

use bankshot::dynamics::{Integrator, Release, Simulator};
use bankshot::physics::{FOOT_M, Physics};
use bankshot::units::{DEGREE_RAD, REV_RAD};
use criterion::{BatchSize, Criterion, Throughput};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use std::hint::black_box;
use std::time::Instant;

/// Uniform releases 13.75 ft away: speed 22..27 ft/s, pitch 40..65 deg, backspin 0..5 rev/s.
fn sample(count: usize, court_deg: f64, polar_deg: f64) -> Vec<Release> {
    let mut random = ChaCha12Rng::seed_from_u64(1);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    (0..count)
        .map(|_| Release {
            distance_m: 13.75 * FOOT_M,
            court_angle_rad: court_deg * DEGREE_RAD,
            height_above_hoop_m: -3.0 * FOOT_M,
            speed_m_s: between(22.0, 27.0) * FOOT_M,
            pitch_rad: between(40.0, 65.0) * DEGREE_RAD,
            polar_rad: between(polar_deg - 3.0, polar_deg + 3.0) * DEGREE_RAD,
            backspin_rad_s: between(0.0, 5.0) * REV_RAD,
            rifle_spin_rad_s: 0.0,
            side_spin_rad_s: 0.0,
        })
        .collect()
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args().sample_size(20);
    let physics = Physics::paper();
    let with = |integrator| Simulator::with_integrator(&physics, integrator).unwrap();
    let exact = with(Integrator::EXACT);
    let paper = with(Integrator::PAPER);
    let paper_fine = with(Integrator::Paper {
        dt_max_s: 0.001,
        dt_min_s: 0.000_01,
    });
    let shots = 2000;
    for (name, court, polar) in [
        ("foul", 0.0, 0.0),
        ("side direct", 67.5, 67.5),
        ("side bank", 67.5, 62.107),
    ] {
        let releases = sample(shots, court, polar);
        let mut group = criterion.benchmark_group(name);
        group.throughput(Throughput::Elements(shots as u64));
        for (label, simulator) in [("exact", &exact), ("paper", &paper)] {
            group.bench_function(label, |bencher| {
                bencher.iter_batched(
                    || (),
                    |()| {
                        releases
                            .iter()
                            .filter(|release| simulator.verdict(black_box(release)).made)
                            .count()
                    },
                    BatchSize::SmallInput,
                );
            });
        }
        group.finish();
    }
    report(
        &sample(20_000, 0.0, 0.0),
        &[
            ("exact", &exact),
            ("paper", &paper),
            ("paper, fine", &paper_fine),
        ],
        &with,
    );
}

/// Rates and agreement side by side, taken in turn so that a drifting machine hits all alike.
fn report(
    releases: &[Release],
    simulators: &[(&str, &Simulator)],
    with: &dyn Fn(Integrator) -> Simulator,
) {
    let reference = with(Integrator::Exact {
        steps_per_contact: 1000,
    });
    let truth: Vec<bool> = releases
        .iter()
        .map(|release| reference.verdict(release).made)
        .collect();
    let mut best = vec![f64::INFINITY; simulators.len()];
    let mut agree = vec![0.0; simulators.len()];
    for _ in 0..5 {
        for (i, (_, simulator)) in simulators.iter().enumerate() {
            let began = Instant::now();
            let same = releases
                .iter()
                .zip(&truth)
                .filter(|(r, made)| simulator.verdict(r).made == **made)
                .count();
            best[i] = best[i].min(began.elapsed().as_secs_f64());
            agree[i] = same as f64 / releases.len() as f64;
        }
    }
    println!("\nfoul, one core, {} shots", releases.len());
    for (i, (name, _)) in simulators.iter().enumerate() {
        println!(
            "{name:12} {:>9.0} shots/s   {:.3} % agree with tiny steps   exact is {:.2} times as fast",
            releases.len() as f64 / best[i],
            100.0 * agree[i],
            best[i] / best[0]
        );
    }
}
