//! The sensitivity of a shot, against separate estimates with other seeds.

use crate::common::{load, nominal};
use bankshot::analysis::sensitivity::{self, Sensitivity, SensitivityTopics};
use bankshot::probability::{Sampler, Silent};
use bankshot::shooter::{Nominal, Profile, ReleaseVariable};

fn free_throw() -> (Profile, Nominal) {
    (load("free_throw"), nominal(23.6, 53.5, 0.0, 3.0))
}

fn analyse(profile: &Profile, shot: &Nominal) -> Sensitivity {
    sensitivity::analyse(profile, shot, SensitivityTopics::ALL, &Silent)
}

#[test]
fn val_the_cost_of_an_error_is_the_difference_of_two_separate_estimates() {
    // Eight comparisons at 4.5 standard errors: a false alarm for 1 of 18,000 choices of seeds.
    let (profile, shot) = free_throw();
    let found = analyse(&profile, &shot);
    assert_eq!(found.errors.len(), 4);
    assert_eq!(found.errors[0].variable, ReleaseVariable::Speed);
    let p = |profile: &Profile| Sampler::new(profile).estimate(&shot, 0.0006, 77, &Silent);
    let own = p(&profile);
    for cost in &found.errors {
        for (factor, gain) in [(0.0, cost.without), (0.9, cost.a_tenth_less)] {
            let other = profile
                .with(|settings| {
                    let dispersion = &mut settings.shooter.dispersion;
                    *dispersion = dispersion.scaled(cost.variable, factor);
                })
                .unwrap();
            let changed = p(&other);
            let by = changed.probability - own.probability;
            let of_both = libm::hypot(changed.standard_error, own.standard_error);
            let error = libm::hypot(of_both, gain.standard_error);
            assert!(
                (by - gain.value).abs() < 4.5 * error,
                "{:?} {factor}: {by} {gain:?}",
                cost.variable
            );
        }
    }
}

#[test]
fn val_backspin_helps_a_free_throw_and_more_of_it_helps_more() {
    // Authority: the paper (Figs. 12 and 13) finds wider bands with 3 rev/s than without.
    let (profile, shot) = free_throw();
    let found = analyse(&profile, &shot);
    let gains: Vec<f64> = found
        .backspins
        .iter()
        .map(|other| other.gain.value)
        .collect();
    assert!(gains.is_sorted(), "{gains:?}");
    let best = found.backspin_gain().unwrap();
    assert!(best.value > 10.0 * best.standard_error, "{best:?}");
    // The shot has the last of these backspins. It can gain only by its re-optimised speed.
    assert!(gains[4].abs() < 0.01, "{gains:?}");
}
