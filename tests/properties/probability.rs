//! Properties of the bracket, of the shares of made and missed shots, and of the windows of a shot.

use crate::common::{at, load, nominal};
use bankshot::analysis::miss_breakdown::classify_misses;
use bankshot::analysis::sensitivity::{self, SensitivityTopics};
use bankshot::model::Preset;
use bankshot::probability::{Sampler, Silent};
use bankshot::search_space::{TablePlan, sample_wide};
use bankshot::shooter::Nominal;
use bankshot::units::FOOT_M;

#[test]
fn prop_no_made_shot_lies_outside_the_bracket() {
    for name in ["free_throw", "bank_wing", "three_pointer"] {
        let profile = load(name);
        let plan = TablePlan::for_search(&profile).unwrap();
        let wide = sample_wide(&profile, &plan, 300_000);
        assert!(wide.outside > 100_000, "{wide:?}");
        assert_eq!(wide.made_outside, 0, "{name}: {wide:?}");
    }
}

/// Beside the hoop a ball can rise into the near side of the ring, and come down from the board's
/// edges: these shots were outside the bracket once (40 of 200,000 and 34 of 100,000).
#[test]
fn regress_no_made_shot_from_beside_the_hoop_lies_outside_the_bracket() {
    for preset in ["paper", "ncaa"] {
        let profile = at(&load("free_throw"), 3.0 * FOOT_M, 88.0)
            .with(|settings| settings.physics = Preset::named(preset).unwrap().physics())
            .unwrap();
        let plan = TablePlan::for_search(&profile).unwrap();
        let wide = sample_wide(&profile, &plan, 200_000);
        assert!(wide.outside > 50_000, "{wide:?}");
        assert_eq!(wide.made_outside, 0, "{preset}: {wide:?}");
    }
}

#[test]
fn prop_shares_of_made_and_missed_sum_to_one() {
    let (profile, shot) = (
        load("errors_in_all_nine_variables"),
        nominal(23.6, 53.5, 0.0, 3.0),
    );
    let sobol = Sampler::new(&profile).estimate(&shot, 0.002, 1, &Silent);
    let missed = classify_misses(&profile, &shot, &sobol, 1);
    let sum: f64 = missed.named().iter().map(|(_, share)| share).sum();
    assert!((sum + sobol.probability - 1.0).abs() < 1e-12);
    // A free throw from the middle is missed equally often to both sides. The shares come from
    // 16,384 shots and are below 0.1, so their difference has a standard error of 0.0035 at most
    // (less with Sobol points). 0.01 is 2.9 of them: a false alarm for 1 of 250 choices of seeds at
    // most.
    assert!((missed.left - missed.right).abs() < 0.01, "{missed:?}");
    assert!(missed.left < 0.1 && missed.right < 0.1, "{missed:?}");
}

#[test]
fn prop_windows_end_where_the_shot_is_missed_and_are_symmetric() {
    let (profile, shot) = (load("free_throw"), nominal(23.6, 53.5, 0.0, 3.0));
    let topics = SensitivityTopics {
        windows: true,
        ..SensitivityTopics::NONE
    };
    let found = sensitivity::analyse(&profile, &shot, topics, &Silent);
    let is_made = |shot: &Nominal| {
        let outcome = profile.simulator().simulate(&profile.release(shot));
        outcome.unwrap().verdict.made
    };
    let (low, high) = found.windows[0].ends.unwrap();
    let at = |speed_m_s: f64| Nominal { speed_m_s, ..shot };
    for (end, outwards) in [(low, -1e-5), (high, 1e-5)] {
        assert!(is_made(&at(end)) && !is_made(&at(end + outwards)), "{end}");
    }
    let (left, right) = found.windows[2].ends.unwrap();
    assert!((left + right).abs() < 1e-4, "{left} {right}");
    // A shot straight at the hoop can be off to the side by less than the radius of the ring.
    assert!(right * profile.location().distance_m < profile.physics().ring_radius_m);
}
