//! What the integration tests share.
#![allow(dead_code, unreachable_pub)]

use bankshot::dynamics::{Integrator, Release, Simulator};
use bankshot::physics::{FOOT_M, Physics};
use bankshot::profile::{self, Nominal, Profile};
use bankshot::units::{DEGREE_RAD, REV_RAD};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

/// A profile of `configs/`.
pub fn load(name: &str) -> Profile {
    let path = format!("{}/configs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    profile::parse(&std::fs::read_to_string(&path).unwrap(), &path).unwrap()
}

/// A nominal shot without rifle and side spin, in the units of the paper.
pub fn nominal(speed_ft_s: f64, pitch_deg: f64, polar_deg: f64, backspin_rev_s: f64) -> Nominal {
    Nominal {
        speed_m_s: speed_ft_s * 0.3048,
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

/// The sample *foul*: straight on, uniform in speed 22..27 ft/s, pitch 40..65 deg, polar -3..3 deg and
/// backspin 0..5 rev/s.
pub fn foul(count: usize, seed: u64) -> Vec<Release> {
    uniform(count, seed, 0.0, 0.0)
}

/// The same spread about the bank angle from 67.5 deg.
pub fn side(count: usize, seed: u64) -> Vec<Release> {
    uniform(count, seed, 67.5, 62.107)
}

fn uniform(count: usize, seed: u64, court_deg: f64, polar_deg: f64) -> Vec<Release> {
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

pub fn exact(physics: &Physics, steps_per_contact: u32) -> Simulator {
    Simulator::with_integrator(physics, Integrator::Exact { steps_per_contact }).unwrap()
}

pub fn paper(physics: &Physics, dt_max_s: f64, dt_min_s: f64) -> Simulator {
    Simulator::with_integrator(physics, Integrator::Paper { dt_max_s, dt_min_s }).unwrap()
}

/// Part of the releases on which two simulators agree about made or missed.
pub fn agreement(a: &Simulator, b: &Simulator, releases: &[Release]) -> f64 {
    use rayon::prelude::*;
    let same = releases
        .par_iter()
        .filter(|r| a.verdict(r).made == b.verdict(r).made)
        .count();
    same as f64 / releases.len() as f64
}
