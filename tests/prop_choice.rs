//! The search over a chosen part of the nominal values.

mod common;

use bankshot::probability::Silent;
use bankshot::probability::best::{self, Best};
use bankshot::profile::{self, Choice, Grid, Profile};
use bankshot::units::{DEGREE_RAD, REV_RAD};
use common::load;

/// The wing, on a grid small enough for a test.
fn wing() -> Profile {
    let mut profile = load("bank_wing");
    profile.grid = Grid {
        speed: 30,
        pitch: 20,
        polar: 20,
        backspin: 6,
    };
    profile.search.standard_error = 0.002;
    profile
}

fn find(profile: &Profile) -> Best {
    best::find(profile, &Silent).unwrap()
}

#[test]
fn prop_what_is_held_stays_and_costs() {
    let free = find(&wing());
    let mut profile = wing();
    profile.search.choose = Choice::only(&["speed", "polar"]);
    let pitch_rad = 50.0 * DEGREE_RAD;
    profile.nominal.pitch_rad = Some(pitch_rad);
    profile.nominal.backspin_rad_s = Some(REV_RAD);
    (profile.search.pitch_min_rad, profile.search.pitch_max_rad) = (pitch_rad, pitch_rad);
    let held = find(&profile);
    for (free, held) in [(free.direct, held.direct), (free.bank, held.bank)] {
        let (free, held) = (free.unwrap(), held.unwrap());
        assert_eq!(held.nominal.pitch_rad, pitch_rad);
        assert_eq!(held.nominal.backspin_rad_s, REV_RAD);
        // The college guard's best has 3 rev/s, worth about a tenth: far more than the errors.
        assert!(held.estimate.probability < free.estimate.probability - 0.02);
        let curves: Vec<_> = held.curves.iter().map(|curve| curve.nominal).collect();
        assert_eq!(curves, ["speed", "polar"]);
    }
}

#[test]
fn prop_a_held_best_is_found_again() {
    // Holding the two angles at the best must find its speed and its P again.
    let free = find(&wing()).bank.unwrap();
    let mut profile = wing();
    profile.search.choose = Choice::only(&["speed", "backspin"]);
    profile.nominal.pitch_rad = Some(free.nominal.pitch_rad);
    profile.nominal.polar_rad = Some(free.nominal.polar_rad);
    profile.search.pitch_min_rad = free.nominal.pitch_rad;
    profile.search.pitch_max_rad = free.nominal.pitch_rad;
    let held = find(&profile).bank.unwrap();
    assert!((held.nominal.speed_m_s - free.nominal.speed_m_s).abs() < 0.02);
    // Within 4.5 standard errors, and what a grid this coarse may lose.
    let error = libm::hypot(held.estimate.standard_error, free.estimate.standard_error);
    assert!((held.estimate.probability - free.estimate.probability).abs() < 4.5 * error + 0.003);
}

#[test]
fn prop_side_spin_never_costs_when_it_may_be_left_out() {
    let free = find(&wing());
    let mut profile = wing();
    profile.search.choose.side_spin = true;
    profile.shooter.max_side_spin_rad_s = 2.0 * REV_RAD;
    let spun = find(&profile);
    for (free, spun) in [(free.direct, spun.direct), (free.bank, spun.bank)] {
        let (free, spun) = (free.unwrap(), spun.unwrap());
        assert!(spun.nominal.side_spin_rad_s.abs() <= 2.0 * REV_RAD);
        let error = libm::hypot(free.estimate.standard_error, spun.estimate.standard_error);
        assert!(spun.estimate.probability > free.estimate.probability - 4.5 * error - 0.003);
        assert_eq!(spun.curves.last().unwrap().nominal, "side_spin");
    }
}

#[test]
fn prop_curves_pass_through_the_best() {
    let best = find(&wing());
    for shot in [best.direct.unwrap(), best.bank.unwrap()] {
        assert_eq!(shot.curves.len(), 4);
        for curve in &shot.curves {
            let top = curve
                .points
                .iter()
                .fold(0.0, |top: f64, &(_, p)| top.max(p));
            // The line through the station nearest to the best, beside the table's best.
            assert!((top - shot.table_probability).abs() < 0.005, "{curve:?}");
            assert!(curve.points.is_sorted_by(|a, b| a.0 < b.0));
        }
    }
}

#[test]
fn contract_choices_that_cannot_be_are_refused() {
    let profile = std::fs::read_to_string("configs/bank_wing.toml").unwrap();
    for (search, message) in [
        ("choose = []", "must name one or more"),
        ("choose = [\"spin\"]", "must name one or more"),
        ("choose = \"speed\"", "must be a list of texts"),
        ("choose = [\"polar\"]", "leaves speed out"),
        ("choose = [\"speed\"]", "leaves pitch out"),
        (
            "choose = [\"speed\", \"pitch\", \"side_spin\"]",
            "max_side_spin",
        ),
    ] {
        let text = format!("{profile}\n[search]\n{search}\n");
        let error = profile::parse(&text, "test").unwrap_err().to_string();
        assert!(error.contains(message), "{search}: {error}");
    }
}
