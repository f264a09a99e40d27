//! Side by side with published results: `docs/validation.md` is what this campaign prints.
#![allow(clippy::disallowed_methods)]

mod common;

use bankshot::dynamics::Simulator;
use bankshot::plan::Plan;
use bankshot::probability::best;
use bankshot::probability::estimate::Sampler;
use bankshot::probability::{Silent, grid, monte_carlo};
use bankshot::profile::{self, Profile};
use bankshot::units::DEGREE_RAD;
use common::{load, nominal};

fn at(profile: &Profile, distance_m: f64, angle_deg: f64, release_height_m: f64) -> Profile {
    let mut profile = profile.clone();
    profile.place.distance_m = distance_m;
    profile.place.angle_rad = angle_deg * DEGREE_RAD;
    profile.shooter.release_height_m = release_height_m;
    let below = release_height_m - profile.physics.hoop_height_m;
    profile.search = profile::Search {
        standard_error: 0.0005,
        ..profile::Search::around(distance_m, below)
    };
    profile
}

/// The speed at which the parabola passes the plane of the hoop at its centre.
fn centre_speed(profile: &Profile, pitch_rad: f64) -> f64 {
    let s = profile.place.distance_m;
    let over = profile.height_above_hoop_m() + s * pitch_rad.tan();
    s / pitch_rad.cos() * (0.5 * profile.physics.gravity_m_s2 / over).sqrt()
}

/// Pearson's coefficient.
fn correlation(pairs: &[(f64, f64)]) -> f64 {
    let n = pairs.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(&|pair| pair.0), mean(&|pair| pair.1));
    let about = |of: &dyn Fn(f64, f64) -> f64| {
        pairs
            .iter()
            .map(|pair| of(pair.0 - x, pair.1 - y))
            .sum::<f64>()
    };
    about(&|x, y| x * y) / (about(&|x, _| x * x) * about(&|_, y| y * y)).sqrt()
}

#[test]
#[ignore = "a campaign of one minute: cargo test --test val_published -- --ignored --nocapture"]
fn campaign_published() {
    let college = load("free_throw");
    let simulator = Simulator::new(&college.physics).unwrap();
    let plan = Plan::new(&college).unwrap();
    let shot = nominal(23.6, 53.5, 0.0, 3.0);

    println!("## Methods: 23.6 ft/s, 53.5 deg, 3 rev/s, free throw");
    let sobol = Sampler::new(&college, &simulator).estimate(&shot, 0.0003, 1, &Silent);
    let plain = monte_carlo::estimate(&college, &simulator, &shot, 1_000_000, 1, &Silent);
    let shifted = grid::shifted(&college, &plan, &simulator, &shot, 24, 1, &Silent);
    for (name, found) in [
        ("sobol", sobol),
        ("monte-carlo", plain),
        ("grid, n = 24", shifted),
    ] {
        println!(
            "| {name} | {:.4} | {:.4} | {} |",
            found.probability, found.standard_error, found.shots
        );
    }
    let mut worst = 0.0_f64;
    for n in 36..=44 {
        let sum = grid::to_the_letter(&college, &plan, &simulator, &shot, n, &Silent);
        let off = sum.probability - sobol.probability;
        worst = worst.max(off.abs());
        println!(
            "| paper-grid, n = {n} | {:.4} | {off:+.4} | |",
            sum.probability
        );
    }
    assert!(worst > 5.0 * sobol.standard_error, "no aliasing to be seen");

    println!("## Tran and Silverberg 2008: 7 ft release, 3 rev/s");
    let mut precise = college.clone();
    precise.search.standard_error = 0.0005;
    let best = best::find(&precise, &Silent).unwrap().direct.unwrap();
    let mut centre = best.nominal;
    centre.speed_m_s = centre_speed(&college, centre.pitch_rad);
    let at_centre = Sampler::new(&college, &simulator).estimate(&centre, 0.0005, 1, &Silent);
    println!(
        "best {:.1} deg, {:.2} ft/s, {:.1} in past the centre, P {:.4} +- {:.4}; at the centre {:.2} ft/s, P {:.4} +- {:.4}",
        best.nominal.pitch_rad / DEGREE_RAD,
        best.nominal.speed_m_s / 0.3048,
        best.aim_past_centre_m.unwrap() / 0.0254,
        best.estimate.probability,
        best.estimate.standard_error,
        centre.speed_m_s / 0.3048,
        at_centre.probability,
        at_centre.standard_error
    );

    println!("## Brancazio 1981 and Schwark 2004");
    let schwark = at(&college, 4.09, 0.0, college.physics.hoop_height_m - 1.30);
    let least = 45.0 + 0.5 * (1.30_f64 / 4.09).atan() / DEGREE_RAD;
    let best = best::find(&schwark, &Silent).unwrap().direct.unwrap();
    println!(
        "4.09 m, 1.30 m below: least speed at {least:.1} deg; best {:.1} deg, {:.2} m/s, P {:.4}",
        best.nominal.pitch_rad / DEGREE_RAD,
        best.nominal.speed_m_s,
        best.estimate.probability
    );

    println!("## Slegers 2021: free throws from 4.19 m by the scatter of speed and of pitch");
    // Their players' scatter: 0.05 to 0.13 m/s, and 1.3 deg give or take 0.26.
    let mut found = Vec::new();
    for speed_m_s in [0.05, 0.07, 0.09, 0.11, 0.13] {
        for pitch_deg in [1.04, 1.3, 1.56] {
            let mut player = at(&college, 4.19, 0.0, 7.0 * 0.3048);
            player.shooter.errors.c10_m_s = speed_m_s;
            player.shooter.errors.c20_rad = pitch_deg * DEGREE_RAD;
            let best = best::find(&player, &Silent).unwrap().direct.unwrap();
            let p = best.estimate.probability;
            println!("| {speed_m_s} m/s | {pitch_deg} deg | {p:.3} |");
            found.push((speed_m_s, pitch_deg, p));
        }
    }
    let (speed, pitch): (Vec<_>, Vec<_>) = (
        found.iter().map(|&(speed, _, p)| (speed, p)).collect(),
        found.iter().map(|&(_, pitch, p)| (pitch, p)).collect(),
    );
    println!(
        "correlation of P with the scatter of speed {:.2}, of pitch {:.2}",
        correlation(&speed),
        correlation(&pitch)
    );

    println!("## Silverberg, Tran and Adams 2011: bank less direct");
    for (distance_ft, angle_deg) in [
        (6.0, 0.0),
        (6.0, 30.0),
        (6.0, 60.0),
        (9.0, 45.0),
        (12.0, 20.0),
        (12.0, 50.0),
        (13.75, 0.0),
        (18.0, 50.0),
    ] {
        let place = at(&college, distance_ft * 0.3048, angle_deg, 7.0 * 0.3048);
        let best = best::find(&place, &Silent).unwrap();
        let (direct, bank) = (best.direct.unwrap().estimate, best.bank.unwrap().estimate);
        println!(
            "| {distance_ft} ft | {angle_deg} deg | {:.3} | {:.3} | {:+.3} +- {:.3} |",
            direct.probability,
            bank.probability,
            bank.probability - direct.probability,
            libm::hypot(direct.standard_error, bank.standard_error)
        );
    }
}
