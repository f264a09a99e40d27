//! Times of both integrators by instruction set, of one table and one whole `best`, the agreement
//! of the integrators, and the gain of a second thread: `cargo bench --bench shots`.
//!
//! Variants that are compared run in turn, for several rounds, so that a machine that becomes
//! slower or faster affects all of them. The time of a variant is the least of its rounds.

use bankshot::best_shot;
use bankshot::config::parse_profile;
use bankshot::dynamics::{BatchWorkspace, InstructionSet, Integrator, Release, Simulator};
use bankshot::model::{BallState, Physics, Preset};
use bankshot::probability::{NominalTable, Silent};
use bankshot::search_space::TablePlan;
use bankshot::shooter::Nominal;
use bankshot::units::{DEGREE_RAD, FOOT_M, REV_RAD};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use std::hint::black_box;
use std::time::Instant;

/// Rounds of each comparison.
const ROUNDS: u32 = 5;
/// Shots of a batch of the event-driven integrator.
const BATCH: usize = 200_000;
/// Shots of slow variants, the first ones of the same sample.
const SMALL_BATCH: usize = 20_000;
/// Shots of the comparison of one and two threads.
const THREAD_SHOTS: usize = 1_000_000;
/// The samples: name, court angle and mean polar angle, deg.
const SAMPLES: [(&str, f64, f64); 3] = [
    ("free_throw_uniform", 0.0, 0.0),
    ("side_uniform_direct", 67.5, 67.5),
    ("side_uniform_bank", 67.5, 62.107),
];

fn main() {
    let physics = Physics::paper();
    for (name, court_deg, polar_deg) in SAMPLES {
        compare_integrators(&physics, name, &uniform(BATCH, court_deg, polar_deg));
    }
    for (name, court_deg, polar_deg) in SAMPLES {
        compare_presets(name, court_deg, polar_deg);
    }
    for (preset, faster) in [("paper", 1.0), ("ncaa", 1.03)] {
        compare_batch_sizes(preset, faster);
    }
    compare_agreement(&physics, &uniform(BATCH, 0.0, 0.0));
    time_free_throw();
    compare_threads(&physics, &uniform(THREAD_SHOTS, 0.0, 0.0));
}

/// Uniform releases 13.75 ft away: speed 22..27 ft/s, pitch 40..65 deg, polar angle within 3 deg of
/// its mean, backspin 0..5 rev/s.
fn uniform(count: usize, court_deg: f64, polar_deg: f64) -> Vec<BallState> {
    releases(count, court_deg, polar_deg)
        .iter()
        .map(Release::state)
        .collect()
}

fn releases(count: usize, court_deg: f64, polar_deg: f64) -> Vec<Release> {
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

/// A variant of a comparison.
struct Variant<'a> {
    name: String,
    run: Box<dyn FnMut() + 'a>,
}

impl<'a> Variant<'a> {
    fn new(name: impl Into<String>, run: impl FnMut() + 'a) -> Self {
        Self {
            name: name.into(),
            run: Box::new(run),
        }
    }

    fn seconds(&mut self) -> f64 {
        let began = Instant::now();
        (self.run)();
        began.elapsed().as_secs_f64()
    }
}

/// The least time of each variant, s. All variants run once in each round, after one round without
/// measurement.
fn least_times_s(variants: &mut [Variant<'_>]) -> Vec<f64> {
    let mut least = vec![f64::INFINITY; variants.len()];
    for round in 0..=ROUNDS {
        for (least, variant) in least.iter_mut().zip(variants.iter_mut()) {
            let seconds = variant.seconds();
            if round > 0 {
                *least = least.min(seconds);
            }
        }
    }
    least
}

/// One simulator of a comparison of rates, with the shots that it simulates.
struct Contender<'a> {
    name: String,
    simulator: Simulator,
    starts: &'a [BallState],
}

impl<'a> Contender<'a> {
    fn paper(physics: &Physics, dt_min_s: f64, starts: &'a [BallState]) -> Self {
        let integrator = Integrator::PaperRk4 {
            dt_max_s: 0.015,
            dt_min_s,
        };
        Self {
            name: format!("paper, steps 15 to {:.2} ms", 1e3 * dt_min_s),
            simulator: Simulator::with_integrator(physics, integrator).unwrap(),
            starts,
        }
    }

    /// The event-driven integrator on every instruction set of this machine, the best one first.
    fn event_driven(physics: &Physics, starts: &'a [BallState]) -> Vec<Self> {
        let simulator = Simulator::new(physics).unwrap();
        let sets = InstructionSet::available().into_iter().rev();
        sets.map(|(name, instructions)| Self {
            name: format!("event-driven, {name}"),
            simulator: simulator.clone().with_instructions(instructions),
            starts: if name == "scalar" {
                &starts[..SMALL_BATCH]
            } else {
                starts
            },
        })
        .collect()
    }

    fn variant(&self) -> Variant<'_> {
        let mut workspace = BatchWorkspace::default();
        Variant::new(&self.name, move || {
            black_box(count_made(&self.simulator, self.starts, &mut workspace));
        })
    }
}

/// The number of made shots, in one batch.
fn count_made(
    simulator: &Simulator,
    starts: &[BallState],
    workspace: &mut BatchWorkspace,
) -> usize {
    let verdicts = simulator.verdicts(starts, workspace).unwrap();
    verdicts.iter().filter(|verdict| verdict.made).count()
}

/// The least time of a shot of each contender, s.
fn shot_times_s(contenders: &[Contender<'_>]) -> Vec<f64> {
    let mut variants: Vec<Variant<'_>> = contenders.iter().map(Contender::variant).collect();
    let times = least_times_s(&mut variants);
    let shots = contenders.iter().map(|contender| contender.starts.len());
    times
        .iter()
        .zip(shots)
        .map(|(time, shots)| time / shots as f64)
        .collect()
}

/// Shots per second of both integrators on one thread, by instruction set.
fn compare_integrators(physics: &Physics, sample: &str, starts: &[BallState]) {
    let mut contenders = Contender::event_driven(physics, starts);
    contenders.push(Contender::paper(physics, 0.0005, &starts[..SMALL_BATCH]));
    let times = shot_times_s(&contenders);
    println!("\n{sample}, one thread");
    for (contender, time) in contenders.iter().zip(&times) {
        println!(
            "  {:27} {:>9.0} shots/s {:>8.2} times the first's time (batch of {})",
            contender.name,
            1.0 / time,
            time / times[0],
            contender.starts.len()
        );
    }
}

/// Rates of the free throw sample in batches of several sizes. At the end of each batch lanes stay
/// empty.
fn compare_batch_sizes(preset: &str, faster: f64) {
    let simulator = Simulator::new(&Preset::named(preset).unwrap().physics()).unwrap();
    let mut shots = releases(BATCH, 0.0, 0.0);
    for shot in &mut shots {
        shot.speed_m_s *= faster;
    }
    let starts: Vec<BallState> = shots.iter().map(Release::state).collect();
    let sizes = [BATCH, 8192, 1024, 256];
    let mut variants: Vec<Variant<'_>> = sizes
        .iter()
        .map(|size| {
            let (simulator, starts) = (&simulator, &starts);
            let mut workspace = BatchWorkspace::default();
            Variant::new(format!("batches of {size}"), move || {
                for batch in starts.chunks(*size) {
                    black_box(simulator.verdicts(batch, &mut workspace).unwrap());
                }
            })
        })
        .collect();
    println!("\nfree_throw_uniform under {preset}, one thread");
    let least = least_times_s(&mut variants);
    for (variant, seconds) in variants.iter().zip(least) {
        let rate = BATCH as f64 / seconds;
        println!("  {:28} {rate:>10.0} shots/s", variant.name);
    }
}

/// Shots per second under the preset `ncaa` (speeds 3 % higher) and under the paper's, by
/// instruction set.
fn compare_presets(sample: &str, court_deg: f64, polar_deg: f64) {
    let in_play = Preset::named("ncaa").unwrap().physics();
    let releases = releases(SMALL_BATCH, court_deg, polar_deg);
    let of_paper: Vec<_> = releases.iter().map(Release::state).collect();
    let of_ncaa: Vec<_> = releases
        .iter()
        .map(|release| {
            let mut release = *release;
            release.speed_m_s *= 1.03;
            release.height_above_hoop_m = 7.0 * FOOT_M - in_play.hoop_plane_height_m();
            release.state()
        })
        .collect();
    let mut contenders = Contender::event_driven(&Physics::paper(), &of_paper);
    contenders.extend(Contender::event_driven(&in_play, &of_ncaa));
    let times = shot_times_s(&contenders);
    println!("\n{sample}, one thread, batches of {SMALL_BATCH}: ncaa against paper");
    let (paper, ncaa) = times.split_at(times.len() / 2);
    for ((contender, paper), ncaa) in contenders.iter().zip(paper).zip(ncaa) {
        println!(
            "  {:27} {:>9.0} shots/s of ncaa, {:.2} of paper's",
            contender.name,
            1.0 / ncaa,
            paper / ncaa
        );
    }
}

/// Rates and the share of shots on which an integrator agrees with the event-driven one at tiny
/// steps. The shortest step of the paper's integrator decreases until 99.9 % agree.
fn compare_agreement(physics: &Physics, starts: &[BallState]) {
    let few = &starts[..SMALL_BATCH];
    let tiny_steps = Integrator::event_driven(1000);
    let reference = made(
        &Simulator::with_integrator(physics, tiny_steps).unwrap(),
        few,
    );
    let mut contenders = Contender::event_driven(physics, starts);
    for dt_min_s in [0.000_5, 0.000_1, 0.000_07, 0.000_05] {
        contenders.push(Contender::paper(physics, dt_min_s, few));
    }
    let times = shot_times_s(&contenders);
    println!("\nfree_throw_uniform, one thread; agreement on {SMALL_BATCH} shots");
    for (contender, time) in contenders.iter().zip(&times) {
        let found = made(&contender.simulator, few);
        let same = found.iter().zip(&reference).filter(|(a, b)| a == b).count();
        println!(
            "  {:27} {:>9.0} shots/s {:>8.2} times the first's time, {:.3} % agree with tiny steps",
            contender.name,
            1.0 / time,
            time / times[0],
            100.0 * same as f64 / few.len() as f64
        );
    }
}

/// Whether each shot is made.
fn made(simulator: &Simulator, starts: &[BallState]) -> Vec<bool> {
    let mut workspace = BatchWorkspace::default();
    let verdicts = simulator.verdicts(starts, &mut workspace).unwrap();
    verdicts.iter().map(|verdict| verdict.made).collect()
}

/// One table of the search, one table of a window, and one whole `best` of the free throw, on all
/// threads.
fn time_free_throw() {
    let text = include_str!("../configs/free_throw.toml");
    let profile = parse_profile(text, "free_throw.toml").unwrap();
    let plan = TablePlan::for_search(&profile).unwrap();
    let centre = Nominal {
        speed_m_s: 23.6 * FOOT_M,
        pitch_rad: 53.5 * DEGREE_RAD,
        backspin_rad_s: 3.0 * REV_RAD,
        ..Nominal::default()
    };
    let window = plan.window(&profile, &centre).unwrap();
    let mut variants = [
        Variant::new("table of the search", || {
            black_box(NominalTable::simulate(&profile, &plan, &Silent));
        }),
        Variant::new("table of a window", || {
            let table = NominalTable::simulate(&profile, &window, &Silent);
            black_box(table.probabilities(&profile));
        }),
        Variant::new("best", || {
            black_box(best_shot::find(&profile, &Silent).unwrap());
        }),
    ];
    let times = least_times_s(&mut variants);
    println!(
        "\nfree_throw.toml, {} threads",
        rayon::current_num_threads()
    );
    for (variant, time) in variants.iter().zip(&times) {
        println!(
            "  {:27} {:>9.1} ms {:>8.2} times the first's time",
            variant.name,
            1e3 * time,
            time / times[0]
        );
    }
}

/// Two threads against one, in 32 batches.
fn compare_threads(physics: &Physics, starts: &[BallState]) {
    let simulator = Simulator::new(physics).unwrap();
    let simulate = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let simulator = &simulator;
        move || {
            let made: usize = pool.install(|| {
                starts
                    .par_chunks(starts.len() / 32)
                    .map_init(BatchWorkspace::default, |workspace, batch| {
                        count_made(simulator, batch, workspace)
                    })
                    .sum()
            });
            black_box(made);
        }
    };
    let mut variants = [
        Variant::new("one thread", simulate(1)),
        Variant::new("two threads", simulate(2)),
    ];
    let times = least_times_s(&mut variants);
    println!("\nfree_throw_uniform, {} shots", starts.len());
    for (variant, time) in variants.iter().zip(&times) {
        println!(
            "  {:27} {time:>9.3} s, one thread takes {:.2} times as long",
            variant.name,
            times[0] / time
        );
    }
}
