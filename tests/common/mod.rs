//! Helpers that the library tests share.
#![allow(dead_code, unreachable_pub)]

use bankshot::config;
use bankshot::dynamics::{BatchWorkspace, Integrator, Release, Simulator, Verdict};
use bankshot::model::{BallState, Physics};
use bankshot::shooter::{Location, Nominal, Profile, TableGrid};
use bankshot::units::{DEGREE_RAD, FOOT_M, REV_RAD};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

/// The profile `configs/NAME.toml` with the paper's physics, which the numbers of the tests belong
/// to.
pub fn load(name: &str) -> Profile {
    let path = format!("{}/configs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    config::parse_profile(&std::fs::read_to_string(&path).unwrap(), &path)
        .unwrap()
        .with(|settings| settings.physics = Physics::paper())
        .unwrap()
}

/// The guard of `configs/bank_wing.toml` 12 ft from the hoop at 50 deg, where the paper's physics
/// favours the bank shot.
pub fn guard_on_the_wing() -> Profile {
    at(&load("bank_wing"), 12.0 * FOOT_M, 50.0)
}

/// The same profile at another location.
pub fn at(profile: &Profile, distance_m: f64, angle_deg: f64) -> Profile {
    profile
        .moved_to(Location {
            distance_m,
            angle_rad: angle_deg * DEGREE_RAD,
        })
        .unwrap()
}

/// The same profile with another table and another standard error.
pub fn with_search(profile: &Profile, grid: TableGrid, standard_error: f64) -> Profile {
    profile
        .with(|settings| {
            settings.grid = grid;
            settings.search.standard_error = Some(standard_error);
        })
        .unwrap()
}

/// A nominal shot without rifle and side spin, in the units of the paper.
pub fn nominal(speed_ft_s: f64, pitch_deg: f64, polar_deg: f64, backspin_rev_s: f64) -> Nominal {
    Nominal {
        speed_m_s: speed_ft_s * FOOT_M,
        pitch_rad: pitch_deg * DEGREE_RAD,
        polar_rad: polar_deg * DEGREE_RAD,
        backspin_rad_s: backspin_rev_s * REV_RAD,
        ..Nominal::default()
    }
}

/// A release 13.75 ft from the hoop, 3 ft below it, in the units of the paper.
pub fn release(
    court_deg: f64,
    speed_ft_s: f64,
    pitch_deg: f64,
    polar_deg: f64,
    backspin_rev_s: f64,
) -> Release {
    Release {
        distance_m: 13.75 * FOOT_M,
        court_angle_rad: court_deg * DEGREE_RAD,
        height_above_hoop_m: -3.0 * FOOT_M,
        speed_m_s: speed_ft_s * FOOT_M,
        pitch_rad: pitch_deg * DEGREE_RAD,
        polar_rad: polar_deg * DEGREE_RAD,
        backspin_rad_s: backspin_rev_s * REV_RAD,
        rifle_spin_rad_s: 0.0,
        side_spin_rad_s: 0.0,
    }
}

/// Free throws, straight on: speed 22..27 ft/s, pitch 40..65 deg, polar angle -3..3 deg and
/// backspin 0..5 rev/s, all uniform.
pub fn free_throw_uniform(count: usize, seed: u64) -> Vec<Release> {
    uniform(count, seed, 0.0, 0.0)
}

/// The same spread about the bank angle from 67.5 deg.
pub fn side_uniform(count: usize, seed: u64) -> Vec<Release> {
    uniform(count, seed, 67.5, 62.107)
}

/// The same spread about a mean polar angle, from a court angle.
pub fn uniform(count: usize, seed: u64, court_deg: f64, polar_deg: f64) -> Vec<Release> {
    let mut random = ChaCha12Rng::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    (0..count)
        .map(|_| {
            let speed = between(22.0, 27.0);
            let pitch = between(40.0, 65.0);
            let polar = between(polar_deg - 3.0, polar_deg + 3.0);
            release(court_deg, speed, pitch, polar, between(0.0, 5.0))
        })
        .collect()
}

/// Shots from everywhere: over the board, past its edges, from below, at the rim, with fast spin,
/// already in contact.
pub fn wild(count: usize, seed: u64) -> Vec<Release> {
    let mut random = ChaCha12Rng::seed_from_u64(seed);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    (0..count)
        .map(|_| Release {
            distance_m: between(0.2, 8.0),
            court_angle_rad: between(-1.5, 1.5),
            height_above_hoop_m: between(-2.0, 1.5),
            speed_m_s: between(0.0, 16.0),
            pitch_rad: between(-1.5, 1.57),
            polar_rad: between(-2.0, 2.0),
            backspin_rad_s: between(-60.0, 60.0),
            rifle_spin_rad_s: between(-60.0, 60.0),
            side_spin_rad_s: between(-60.0, 60.0),
        })
        .collect()
}

pub fn states(releases: &[Release]) -> Vec<BallState> {
    releases.iter().map(Release::state).collect()
}

pub fn event_driven(physics: &Physics, steps_per_contact: u32) -> Simulator {
    Simulator::with_integrator(physics, Integrator::event_driven(steps_per_contact)).unwrap()
}

pub fn paper_rk4(physics: &Physics, dt_max_s: f64, dt_min_s: f64) -> Simulator {
    Simulator::with_integrator(physics, Integrator::PaperRk4 { dt_max_s, dt_min_s }).unwrap()
}

/// The verdicts of all releases, in order, on all threads.
pub fn verdicts(simulator: &Simulator, releases: &[Release]) -> Vec<Verdict> {
    use rayon::prelude::*;
    let starts = states(releases);
    starts
        .par_chunks(1000)
        .flat_map_iter(|chunk| {
            let mut workspace = BatchWorkspace::default();
            simulator.verdicts(chunk, &mut workspace).unwrap().to_vec()
        })
        .collect()
}

/// The number of releases on which two simulators disagree about made or missed.
pub fn disagreements(a: &Simulator, b: &Simulator, releases: &[Release]) -> usize {
    let (a, b) = (verdicts(a, releases), verdicts(b, releases));
    a.iter().zip(&b).filter(|(a, b)| a.made != b.made).count()
}

/// Runs `work` on a pool of its own.
pub fn on_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap()
        .install(work)
}

/// A `TableGrid` from its four numbers of points.
pub fn grid(speed: usize, pitch: usize, polar: usize, backspin: usize) -> TableGrid {
    TableGrid {
        speed,
        pitch,
        polar,
        backspin,
    }
}
