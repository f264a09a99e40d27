//! What a shooter learns from a shot, against separate estimates.

mod common;

use bankshot::dynamics::Simulator;
use bankshot::probability::Silent;
use bankshot::probability::estimate::Sampler;
use bankshot::probability::lessons::{self, Topics};
use bankshot::profile::{self, Nominal, Profile};
use common::{load, nominal};

fn free_throw() -> (Profile, Nominal) {
    (load("free_throw"), nominal(23.6, 53.5, 0.0, 3.0))
}

#[test]
fn val_what_an_error_costs_is_the_difference_of_two_separate_estimates() {
    // Eight comparisons at 4.5 standard errors.
    let (profile, shot) = free_throw();
    let simulator = Simulator::new(&profile.physics).unwrap();
    let learned = lessons::draw(&profile, &simulator, &shot, Topics::ALL, &Silent);
    assert_eq!(learned.costs.len(), 4);
    assert_eq!(learned.costs[0].error, "speed");
    let p =
        |profile: &Profile| Sampler::new(profile, &simulator).estimate(&shot, 0.0006, 77, &Silent);
    let own = p(&profile);
    for cost in &learned.costs {
        let place = profile::ERROR_NAMES
            .iter()
            .position(|name| *name == cost.error)
            .unwrap();
        for (times, gain) in [(0.0, cost.without), (0.9, cost.a_tenth_less)] {
            let mut other = profile.clone();
            other.shooter.errors.scale(place, times);
            let changed = p(&other);
            let by = changed.probability - own.probability;
            let variance = changed.standard_error.powi(2)
                + own.standard_error.powi(2)
                + gain.standard_error.powi(2);
            assert!(
                (by - gain.by).abs() < 4.5 * variance.sqrt(),
                "{} {times}: {by} {gain:?}",
                cost.error
            );
        }
    }
}

#[test]
fn prop_windows_end_where_the_shot_is_missed_and_mirror() {
    let (profile, shot) = free_throw();
    let simulator = Simulator::new(&profile.physics).unwrap();
    let learned = lessons::draw(&profile, &simulator, &shot, Topics::ALL, &Silent);
    let made = |shot: &Nominal| simulator.verdict(&profile.release(shot)).made;
    let (low, high) = learned.windows[0].ends.unwrap();
    let at = |speed_m_s: f64| Nominal { speed_m_s, ..shot };
    for (end, outwards) in [(low, -1e-5), (high, 1e-5)] {
        assert!(made(&at(end)) && !made(&at(end + outwards)), "{end}");
    }
    let (left, right) = learned.windows[2].ends.unwrap();
    assert!((left + right).abs() < 1e-4, "{left} {right}");
    // Straight at the hoop a shot may be aside by less than half the play between ball and ring.
    let play = profile.physics.ring_radius_m;
    assert!(right * profile.place.distance_m < play);
}

#[test]
fn val_backspin_helps_a_free_throw_and_more_of_it_helps_more() {
    // The paper (Figs. 12 and 13) finds wider bands with 3 rev/s than without.
    let (profile, shot) = free_throw();
    let simulator = Simulator::new(&profile.physics).unwrap();
    let learned = lessons::draw(&profile, &simulator, &shot, Topics::ALL, &Silent);
    let gains: Vec<f64> = learned
        .spins
        .iter()
        .map(|changed| changed.gain.by)
        .collect();
    assert!(gains.is_sorted(), "{gains:?}");
    let worth = learned.spin_is_worth().unwrap();
    assert!(worth.by > 10.0 * worth.standard_error, "{worth:?}");
    // At the shot's own spin nothing is gained but by aiming anew.
    assert!(gains[4].abs() < 0.01, "{gains:?}");
}
