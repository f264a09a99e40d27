//! Side by side with published results: `docs/validation.md` is what this campaign prints.
#![allow(clippy::disallowed_methods)]

use bankshot::dynamics::Simulator;
use bankshot::plan::Plan;
use bankshot::probability::best;
use bankshot::probability::estimate::Sampler;
use bankshot::probability::{Silent, grid, monte_carlo};
use bankshot::profile::{self, Nominal, Profile};
use bankshot::units::{DEGREE_RAD, REV_RAD};

fn load(name: &str) -> Profile {
    let path = format!("{}/configs/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    profile::parse(&std::fs::read_to_string(&path).unwrap(), &path).unwrap()
}

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

#[test]
#[ignore = "a campaign of 2 minutes: cargo test --test val_published -- --ignored --nocapture"]
fn campaign_published() {
    let college = load("free_throw");
    let simulator = Simulator::new(&college.physics).unwrap();
    let plan = Plan::new(&college).unwrap();
    let shot = Nominal {
        speed_m_s: 23.6 * 0.3048,
        pitch_rad: 53.5 * DEGREE_RAD,
        backspin_rad_s: 3.0 * REV_RAD,
        ..Nominal::default()
    };

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
            direct.standard_error.hypot(bank.standard_error)
        );
    }
}
