//! A profile is checked as a whole, and cannot disagree with its simulator.

use crate::common::{at, load};
use bankshot::config;
use bankshot::dynamics::{InstructionSet, Integrator};
use bankshot::model::Physics;
use bankshot::shooter::{NominalVariable, Profile, ProfileError, SearchChoice};
use bankshot::units::FOOT_M;

fn assert_agrees(profile: &Profile) {
    assert_eq!(profile.simulator().physics(), profile.physics());
    assert_eq!(profile.simulator().physics(), &profile.settings().physics);
    assert_eq!(
        profile.simulator().integrator(),
        profile.settings().integrator
    );
}

#[test]
fn contract_a_profile_agrees_with_its_simulator_after_every_change() {
    let profile = load("free_throw");
    assert_agrees(&profile);
    let physics = Physics::with_restitution(0.95).unwrap();
    let other = profile
        .with(|settings| {
            settings.physics = physics.clone();
            settings.integrator = Integrator::PAPER_RK4;
        })
        .unwrap();
    assert_agrees(&other);
    assert_eq!(other.physics(), &physics);
    assert_eq!(other.simulator().integrator(), Integrator::PAPER_RK4);
    assert_ne!(other.hash(), profile.hash());
    // The original is unchanged.
    assert_eq!(profile.physics(), &Physics::paper());
    for changed in [
        at(&other, 15.0 * FOOT_M, 30.0),
        other.clone().with_instructions(InstructionSet::SCALAR),
        other.settings().at(other.location()).unwrap(),
    ] {
        assert_agrees(&changed);
        assert_eq!(changed.physics(), &physics);
    }
}

#[test]
fn contract_all_settings_out_of_range_are_reported_at_once() {
    let profile = load("free_throw");
    let change = |settings: &mut bankshot::shooter::ProfileSettings| {
        settings.shooter.release_height_m = f64::NAN;
        settings.shooter.dispersion.c20_rad = -0.1;
        settings.nominal.speed_m_s = Some(f64::INFINITY);
        settings.physics.gravity_m_s2 = 0.0;
        settings.integrator = Integrator::event_driven(0);
        settings.grid.pitch = 1;
        settings.search.standard_error = Some(0.0);
        settings.search.choice = SearchChoice::only(&[NominalVariable::Polar]);
    };
    let mut settings = profile.settings().clone();
    change(&mut settings);
    let ProfileError::Settings(errors) = settings.at(profile.location()).unwrap_err() else {
        panic!("not an error of the settings");
    };
    let keys: Vec<&str> = errors.iter().map(|error| error.key.as_str()).collect();
    let expected = [
        "shooter.release_height",
        "shooter.errors.c20",
        "nominal.speed",
        "physics.gravity",
        "physics.steps_per_contact",
        "grid.pitch",
        "search.standard_error",
        "search.choose",
    ];
    for key in expected {
        assert!(keys.contains(&key), "{key} is not in {keys:?}");
    }
    for key in &keys {
        assert!(expected.contains(key), "{key} is valid");
    }
    assert_eq!(settings.errors(), errors);
    // `with` makes the same check.
    assert_eq!(
        profile.with(change).unwrap_err(),
        ProfileError::Settings(errors)
    );
}

#[test]
fn contract_impossible_choices_of_a_search_are_refused() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/configs/bank_wing.toml");
    let profile = std::fs::read_to_string(path).unwrap();
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
        let error = config::parse_profile(&text, "test")
            .unwrap_err()
            .to_string();
        assert!(error.contains(message), "{search}: {error}");
    }
}
