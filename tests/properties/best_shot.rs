//! Properties of the search for the best shots, over all of the nominal values and over a part of
//! them.

use crate::common::{at, grid, guard_on_the_wing, load, with_search};
use bankshot::analysis::sensitivity::SensitivityTopics;
use bankshot::best_shot::{self, BestShot, ShotKind};
use bankshot::dynamics::OutcomeKind;
use bankshot::probability::Silent;
use bankshot::shooter::{NominalVariable, Profile, SearchChoice};
use bankshot::units::{DEGREE_RAD, REV_RAD};
use std::sync::OnceLock;

/// What a search loses at most on a coarse table: P is flat at its top.
const SEARCH_LOSS: f64 = 0.003;

/// The wing, with a table small enough for a test.
fn wing() -> Profile {
    with_search(&guard_on_the_wing(), grid(30, 20, 20, 6), 0.002)
}

/// The best direct and the best bank shot.
fn find(profile: &Profile) -> [BestShot; 2] {
    let topics = SensitivityTopics {
        curves: true,
        ..SensitivityTopics::NONE
    };
    let (_, shots) = best_shot::find_kinds(profile, &ShotKind::ALL, topics, &Silent).unwrap();
    let shots: Vec<BestShot> = shots.into_iter().map(Result::unwrap).collect();
    shots.try_into().unwrap()
}

/// The best shots of [`wing`], found once for all tests.
fn best_of_wing() -> &'static [BestShot; 2] {
    static BEST: OnceLock<[BestShot; 2]> = OnceLock::new();
    BEST.get_or_init(|| find(&wing()))
}

/// Standard error of the difference of two probabilities. At 4.5 of them a comparison is a false
/// alarm for 1 of 150,000 choices of seeds.
fn error_of_difference(a: &BestShot, b: &BestShot) -> f64 {
    libm::hypot(a.estimate.standard_error, b.estimate.standard_error)
}

#[test]
fn prop_fixed_values_stay_and_cost() {
    let pitch_rad = 50.0 * DEGREE_RAD;
    let profile = wing()
        .with(|settings| {
            settings.search.choice =
                SearchChoice::only(&[NominalVariable::Speed, NominalVariable::Polar]);
            settings.nominal.pitch_rad = Some(pitch_rad);
            settings.nominal.backspin_rad_s = Some(REV_RAD);
        })
        .unwrap();
    for (free, fixed) in best_of_wing().iter().zip(&find(&profile)) {
        assert_eq!(fixed.nominal.pitch_rad, pitch_rad);
        assert_eq!(fixed.nominal.backspin_rad_s, REV_RAD);
        // The best shot has 3 rev/s, which gain about 0.1: far more than the errors.
        assert!(fixed.estimate.probability < free.estimate.probability - 0.02);
        let curves: Vec<_> = fixed.curves.iter().map(|curve| curve.variable).collect();
        assert_eq!(curves, [NominalVariable::Speed, NominalVariable::Polar]);
    }
}

#[test]
fn prop_the_best_shot_with_fixed_angles_is_found_again() {
    // With both angles fixed at the best ones, the search must find the same speed and P.
    let [_, free] = best_of_wing();
    let profile = wing()
        .with(|settings| {
            settings.search.choice =
                SearchChoice::only(&[NominalVariable::Speed, NominalVariable::Backspin]);
            settings.nominal.pitch_rad = Some(free.nominal.pitch_rad);
            settings.nominal.polar_rad = Some(free.nominal.polar_rad);
        })
        .unwrap();
    // The direct shot at these angles is no clean one.
    let fixed = best_shot::find(&profile, &Silent).unwrap().bank.unwrap();
    assert!((fixed.nominal.speed_m_s - free.nominal.speed_m_s).abs() < 0.02);
    let difference = (fixed.estimate.probability - free.estimate.probability).abs();
    assert!(difference < 4.5 * error_of_difference(&fixed, free) + SEARCH_LOSS);
}

#[test]
fn prop_a_choice_of_side_spin_costs_nothing() {
    let profile = wing()
        .with(|settings| {
            settings.search.choice = SearchChoice::only(&NominalVariable::SEARCHABLE);
            settings.shooter.max_side_spin_rad_s = 2.0 * REV_RAD;
        })
        .unwrap();
    for (free, spun) in best_of_wing().iter().zip(&find(&profile)) {
        assert!(spun.nominal.side_spin_rad_s.abs() <= 2.0 * REV_RAD);
        let least = free.estimate.probability - SEARCH_LOSS;
        assert!(spun.estimate.probability > least - 4.5 * error_of_difference(free, spun));
        let last = spun.curves.last().unwrap();
        assert_eq!(last.variable, NominalVariable::SideSpin);
    }
}

#[test]
fn prop_curves_pass_through_the_best_shot() {
    for shot in best_of_wing() {
        assert_eq!(shot.curves.len(), 4);
        for curve in &shot.curves {
            let top = curve
                .points
                .iter()
                .fold(0.0, |top: f64, point| top.max(point.probability));
            // The line passes through the table's nominal shot nearest to the best one, not through
            // the table's best.
            assert!(
                (top - shot.search_probability.unwrap()).abs() < 0.005,
                "{curve:?}"
            );
            assert!(curve.points.is_sorted_by(|a, b| a.value < b.value));
        }
    }
}

#[test]
fn prop_best_shots_are_of_their_kind_and_mirror() {
    // The points of the tables are not mirrored, so the two searches are independent.
    let profile = with_search(&guard_on_the_wing(), grid(40, 28, 28, 8), 0.0007);
    let location = profile.location();
    let mirrored = at(
        &profile,
        location.distance_m,
        -location.angle_rad / DEGREE_RAD,
    );
    let (here, there) = (find(&profile), find(&mirrored));
    for ((kind, one), two) in ShotKind::ALL.into_iter().zip(&here).zip(&there) {
        assert_eq!(ShotKind::of(&profile, &one.nominal), kind);
        assert_ne!(one.outcome.kind, OutcomeKind::Unresolved);
        let difference = (one.estimate.probability - two.estimate.probability).abs();
        let error = error_of_difference(one, two);
        println!("{kind:?}: difference {difference:.5}, standard error {error:.5}");
        // Two comparisons at 4.5 standard errors: a false alarm for 1 of 75,000 choices of seeds.
        // The rms error of the tables is 0.001.
        assert!(
            difference < 4.5 * error + 0.001,
            "{kind:?} {difference} {error}"
        );
    }
}

#[test]
fn prop_the_best_shot_is_not_below_its_own_table() {
    // A table's rms error is 0.001 (`campaign_table`), and its best entry is picked for being high.
    let profile = load("free_throw")
        .with(|settings| settings.search.standard_error = Some(0.0007))
        .unwrap();
    for shot in find(&profile) {
        let difference = shot.estimate.probability - shot.search_probability.unwrap();
        let error = shot.estimate.standard_error;
        println!("best minus table: {difference:+.5}, standard error {error:.5}");
        // Three times the rms error of the table, and 4.5 standard errors: a false alarm for fewer
        // than 1 of 1000 choices of seeds.
        assert!(difference > -0.003 - 4.5 * error, "{shot:?}");
    }
}

/// Authority: Sobol points, which have no limit of the speed. Shots that errors make faster than
/// `speed_max` count too; without them the table lost a third of P at the limit, and the search
/// kept a standard deviation away from it.
#[test]
fn regress_releases_beyond_the_greatest_nominal_speed_count() {
    let [free, _] = best_of_wing();
    let limit_m_s = free.nominal.speed_m_s - 0.02;
    let limited = wing()
        .with(|settings| settings.search.speed_max_m_s = Some(limit_m_s))
        .unwrap();
    let kinds = [ShotKind::Direct];
    let (_, mut shots) =
        best_shot::find_kinds(&limited, &kinds, SensitivityTopics::NONE, &Silent).unwrap();
    let direct = shots.pop().unwrap().unwrap();
    assert!(direct.nominal.speed_m_s <= limit_m_s);
    let lost = free.estimate.probability - direct.estimate.probability;
    assert!(lost < 0.02, "{lost}");
    let difference = direct.estimate.probability - direct.search_probability.unwrap();
    assert!(difference.abs() < 0.02, "{difference}");
}
