//! Shots per second of both integrators on the sample *foul* and from the side, by lanes; one table
//! and one whole `best`; ratios and agreement side by side; one and two threads:
//! `cargo bench --bench shots`.
#![allow(missing_docs, clippy::disallowed_methods)]

use bankshot::dynamics::{Integrator, Lanes, Release, Room, Simulator, State};
use bankshot::physics::{FOOT_M, Physics};
use bankshot::plan::Plan;
use bankshot::probability::{Silent, Table, best};
use bankshot::profile::Nominal;
use bankshot::units::{DEGREE_RAD, REV_RAD};
use criterion::{Criterion, Throughput};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
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
    let shots = 200_000;
    let samples = [
        ("foul", 0.0, 0.0),
        ("side direct", 67.5, 67.5),
        ("side bank", 67.5, 62.107),
    ];
    for (name, court, polar) in samples {
        let starts = states(&sample(shots, court, polar));
        let mut group = criterion.benchmark_group(name);
        // A part of them, so that a run ends within a second.
        let few = &starts[..20_000];
        group.throughput(Throughput::Elements(few.len() as u64));
        group.bench_function("paper, one at a time", |bencher| {
            bencher.iter(|| count(black_box(few), |start| paper.verdict_from(*start).made));
        });
        group.throughput(Throughput::Elements(shots as u64));
        for (lanes_name, lanes) in Lanes::available() {
            let simulator = exact.clone().with_lanes(lanes);
            let mut room = Room::default();
            group.bench_function(format!("exact, {lanes_name}"), |bencher| {
                bencher.iter(|| made(&simulator, black_box(&starts), &mut room));
            });
        }
        group.finish();
    }
    whole(&mut criterion);
    let million = states(&sample(1_000_000, 0.0, 0.0));
    report(
        &states(&sample(20_000, 0.0, 0.0)),
        &million[..200_000],
        &with,
    );
    threads(&exact, &million);
}

fn states(releases: &[Release]) -> Vec<State> {
    releases.iter().map(Release::state).collect()
}

fn count(starts: &[State], made: impl Fn(&State) -> bool) -> usize {
    starts.iter().filter(|start| made(start)).count()
}

/// Made shots, in one batch.
fn made(simulator: &Simulator, starts: &[State], room: &mut Room) -> usize {
    let verdicts = simulator.verdicts(starts, room);
    verdicts.iter().filter(|v| v.made).count()
}

/// One table and one whole `best` of the free throw.
fn whole(criterion: &mut Criterion) {
    let text = include_str!("../configs/free_throw.toml");
    let profile = bankshot::profile::parse(text, "free_throw.toml").unwrap();
    let plan = Plan::new(&profile).unwrap();
    let simulator = Simulator::new(&profile.physics).unwrap();
    let mut group = criterion.benchmark_group("free throw");
    group.sample_size(10);
    group.bench_function("table of the search", |bencher| {
        bencher.iter(|| Table::build(&profile, &plan, &simulator, &Silent));
    });
    let centre = Nominal {
        speed_m_s: 23.6 * FOOT_M,
        pitch_rad: 53.5 * DEGREE_RAD,
        polar_rad: 0.0,
        backspin_rad_s: 3.0 * REV_RAD,
        ..Nominal::default()
    };
    let window = plan.around(&profile, &centre).unwrap();
    group.bench_function("table of a window", |bencher| {
        bencher
            .iter(|| Table::build(&profile, &window, &simulator, &Silent).probabilities(&profile));
    });
    group.bench_function("best", |bencher| {
        bencher.iter(|| best::find(&profile, &Silent).unwrap())
    });
    group.finish();
}

/// The least time of `runs` runs of each, taken in turn so that a drifting machine hits all alike.
fn in_turn(runs: u32, tasks: &mut [(&str, Box<dyn FnMut() + '_>)]) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; tasks.len()];
    for _ in 0..runs {
        for (least, (_, task)) in least.iter_mut().zip(tasks.iter_mut()) {
            let began = Instant::now();
            task();
            *least = least.min(began.elapsed().as_secs_f64());
        }
    }
    least
}

/// Rates in batches of `many`, agreement on `few`, and ratios, side by side.
fn report(few: &[State], many: &[State], with: &dyn Fn(Integrator) -> Simulator) {
    let truth: Vec<bool> = {
        let reference = with(Integrator::Exact {
            steps_per_contact: 1000,
        });
        few.iter()
            .map(|start| reference.verdict_from(*start).made)
            .collect()
    };
    let exact = with(Integrator::EXACT);
    let mut simulators: Vec<(String, Simulator, &[State])> = Lanes::available()
        .into_iter()
        .rev()
        .map(|(name, lanes)| {
            let starts = if name == "scalar" { few } else { many };
            (
                format!("exact, {name}"),
                exact.clone().with_lanes(lanes),
                starts,
            )
        })
        .collect();
    // At equal agreement: the paper's longest step, the shortest refined until 99.9 % agree.
    for dt_min_s in [0.000_5, 0.000_1, 0.000_07, 0.000_05] {
        let paper = Integrator::Paper {
            dt_max_s: 0.015,
            dt_min_s,
        };
        let name = format!("paper, 15/{:.2} ms", 1e3 * dt_min_s);
        simulators.push((name, with(paper), few));
    }
    let mut tasks: Vec<(&str, Box<dyn FnMut() + '_>)> = Vec::new();
    for (name, simulator, starts) in &simulators {
        let mut room = Room::default();
        tasks.push((
            name,
            Box::new(move || {
                black_box(made(simulator, starts, &mut room));
            }),
        ));
    }
    let times = in_turn(5, &mut tasks);
    println!(
        "\nfoul, one core, in batches of {} (lanes) and {}; agreement on {}",
        many.len(),
        few.len(),
        few.len()
    );
    let shot_times: Vec<f64> = simulators
        .iter()
        .zip(&times)
        .map(|((_, _, starts), time)| time / starts.len() as f64)
        .collect();
    for ((name, simulator, _), time) in simulators.iter().zip(&shot_times) {
        let mut room = Room::default();
        let verdicts = simulator.verdicts(few, &mut room);
        let same = verdicts
            .iter()
            .zip(&truth)
            .filter(|(v, made)| v.made == **made);
        println!(
            "{name:18} {:>9.0} shots/s   {:.3} % agree with tiny steps   {:6.2} times the time of the first",
            1.0 / time,
            100.0 * same.count() as f64 / few.len() as f64,
            time / shot_times[0]
        );
    }
}

/// Two threads against one on a million shots, in 32 batches.
fn threads(simulator: &Simulator, starts: &[State]) {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        move || {
            pool.install(|| {
                let made: usize = starts
                    .par_chunks(starts.len() / 32)
                    .map_init(Room::default, |room, batch| made(simulator, batch, room))
                    .sum();
                black_box(made);
            });
        }
    };
    let times = in_turn(4, &mut [("one", Box::new(on(1))), ("two", Box::new(on(2)))]);
    println!(
        "\n{} shots: {:.3} s on one thread, {:.3} s on two, ratio {:.2}",
        starts.len(),
        times[0],
        times[1],
        times[0] / times[1]
    );
}
