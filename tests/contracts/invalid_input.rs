//! Values that are not finite, and integrators that cannot step, are errors. They are never
//! simulated.

use crate::common::{free_throw_uniform, on_threads, states};
use bankshot::dynamics::{
    BatchWorkspace, Ending, InstructionSet, Integrator, Release, Simulator, SimulatorError, Verdict,
};
use bankshot::math::vector::Vec3;
use bankshot::model::{BallState, Physics};

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// The fields of a release.
const FIELDS: [fn(&mut Release) -> &mut f64; 9] = [
    |r| &mut r.distance_m,
    |r| &mut r.court_angle_rad,
    |r| &mut r.height_above_hoop_m,
    |r| &mut r.speed_m_s,
    |r| &mut r.pitch_rad,
    |r| &mut r.polar_rad,
    |r| &mut r.backspin_rad_s,
    |r| &mut r.rifle_spin_rad_s,
    |r| &mut r.side_spin_rad_s,
];

/// A valid release with one field that is not finite, for each field and each such value.
fn invalid_releases() -> Vec<Release> {
    let valid = free_throw_uniform(1, 1)[0];
    FIELDS
        .iter()
        .flat_map(|field| {
            NOT_FINITE.map(|value| {
                let mut release = valid;
                *field(&mut release) = value;
                release
            })
        })
        .collect()
}

/// The same for the nine state variables.
fn invalid_states() -> Vec<BallState> {
    let valid = free_throw_uniform(1, 1)[0].state().to_array();
    (0..9)
        .flat_map(|i| {
            NOT_FINITE.map(|value| {
                let mut all = valid;
                all[i] = value;
                let [px, py, pz, vx, vy, vz, wx, wy, wz] = all;
                BallState {
                    position_m: Vec3::new(px, py, pz),
                    velocity_m_s: Vec3::new(vx, vy, vz),
                    spin_rad_s: Vec3::new(wx, wy, wz),
                }
            })
        })
        .collect()
}

fn simulators() -> [Simulator; 2] {
    [Integrator::EVENT_DRIVEN, Integrator::PAPER_RK4]
        .map(|integrator| Simulator::with_integrator(&Physics::paper(), integrator).unwrap())
}

#[test]
fn contract_a_single_release_that_is_not_finite_is_an_error() {
    for simulator in simulators() {
        for release in invalid_releases() {
            let error = simulator.simulate(&release).unwrap_err();
            assert_eq!(error.index, 0);
            assert!(!error.state.is_finite());
            assert!(error.to_string().contains("not finite"), "{error}");
            assert!(simulator.trace(&release, 0.01).is_err(), "{release:?}");
        }
    }
}

#[test]
fn contract_a_single_state_that_is_not_finite_is_an_error() {
    for simulator in simulators() {
        for state in invalid_states() {
            assert_eq!(simulator.simulate_state(state).unwrap_err().index, 0);
            assert!(simulator.trace_state(state, 0.01).is_err(), "{state:?}");
        }
    }
}

#[test]
fn contract_verdicts_name_the_first_state_that_is_not_finite() {
    for simulator in simulators() {
        for (_, instructions) in InstructionSet::available() {
            let simulator = simulator.clone().with_instructions(instructions);
            let mut workspace = BatchWorkspace::default();
            for (i, state) in invalid_states().into_iter().enumerate() {
                let mut starts = states(&free_throw_uniform(40, 2));
                (starts[i], starts[39]) = (state, state);
                let error = simulator.verdicts(&starts, &mut workspace).unwrap_err();
                assert_eq!(error.index, i);
            }
            // The workspace serves again after an error.
            let starts = states(&free_throw_uniform(40, 2));
            let found = simulator.verdicts(&starts, &mut workspace).unwrap();
            assert_eq!(found.len(), 40);
        }
    }
}

#[test]
fn contract_simulate_batch_names_the_first_release_that_is_not_finite() {
    let [simulator, _] = simulators();
    for threads in [1, 2, 7] {
        for (i, release) in invalid_releases().into_iter().enumerate() {
            let mut releases = free_throw_uniform(40, 3);
            (releases[i], releases[39]) = (release, release);
            let found = on_threads(threads, || simulator.simulate_batch(&releases));
            assert_eq!(found.unwrap_err().index, i);
        }
    }
}

#[test]
fn contract_integrators_that_cannot_step_are_refused() {
    let paper = |dt_max_s, dt_min_s| Integrator::PaperRk4 { dt_max_s, dt_min_s };
    let no_steps = Integrator::event_driven(0);
    for (integrator, wrong) in [
        (no_steps, "steps_per_contact"),
        (paper(0.015, 0.0), "dt_min"),
        (paper(0.015, -0.0005), "dt_min"),
        (paper(0.015, f64::NAN), "dt_min"),
        (paper(f64::INFINITY, f64::INFINITY), "dt_min"),
        (paper(0.0, 0.0005), "dt_max"),
        (paper(0.0001, 0.0005), "dt_max"),
        (paper(f64::NAN, 0.0005), "dt_max"),
        (paper(f64::INFINITY, 0.0005), "dt_max"),
    ] {
        let error = Simulator::with_integrator(&Physics::paper(), integrator).unwrap_err();
        assert!(
            matches!(error, SimulatorError::Integrator { key, .. } if key == wrong),
            "{integrator:?}: {error}"
        );
        assert!(error.to_string().contains(wrong), "{error}");
    }
}

#[test]
fn contract_physics_that_cannot_be_simulated_is_refused() {
    let physics = Physics {
        gravity_m_s2: f64::NAN,
        ..Physics::paper()
    };
    let error = Simulator::new(&physics).unwrap_err();
    assert!(matches!(&error, SimulatorError::Physics(error) if error.key == "gravity"));
}

#[test]
fn contract_every_constant_has_a_range() {
    // Each of these was accepted once, and its shots took minutes.
    let paper = Physics::paper;
    for (physics, key) in [
        (
            paper().with_contacts(|contact| contact.friction = 1e6),
            "friction",
        ),
        (
            Physics {
                inertia_ratio: 1e-6,
                ..paper()
            },
            "inertia_ratio",
        ),
        (
            paper().with_contacts(|contact| contact.stiffness_n_m = 1e308),
            "stiffness",
        ),
        (
            Physics {
                ball_mass_kg: 0.01,
                ..paper().with_contacts(|contact| contact.stiffness_n_m = 1e9)
            },
            "stiffness",
        ),
        (
            Physics {
                time_limit_s: 1e6,
                ..paper()
            },
            "time_limit",
        ),
        (
            Physics {
                ball_radius_m: 1e-6,
                ..paper()
            },
            "ball_radius",
        ),
    ] {
        let errors = physics.errors();
        assert!(
            errors.iter().any(|error| error.key == key),
            "{key}: {errors:?}"
        );
    }
}

#[test]
fn contract_a_shot_without_end_is_given_up_as_unresolved_in_the_lanes_too() {
    // A ball that lies on ring and board for a minute, under a great gravity and with no rule of
    // lodging.
    let physics = Physics {
        ball_mass_kg: 0.008,
        gravity_m_s2: 1000.0,
        time_limit_s: 60.0,
        lodged_after_s: 0.0,
        board_width_m: 10.0,
        ..Physics::paper()
    };
    let simulator = Simulator::new(&physics).unwrap();
    let starts: Vec<BallState> = (0..40)
        .map(|i| {
            let release = Release {
                distance_m: 4.96,
                court_angle_rad: 0.861,
                height_above_hoop_m: -0.766,
                speed_m_s: 81.03 + 0.1 * f64::from(i - 20),
                pitch_rad: 0.652,
                polar_rad: 0.796,
                backspin_rad_s: 4.0,
                rifle_spin_rad_s: 17.1,
                side_spin_rad_s: -10.2,
            };
            release.state()
        })
        .collect();
    let alone: Vec<Verdict> = starts
        .iter()
        .map(|start| simulator.simulate_state(*start).unwrap().verdict)
        .collect();
    let given_up = alone
        .iter()
        .filter(|verdict| verdict.ending == Ending::Unresolved);
    assert!(given_up.count() > 0, "{:?}", alone[0]);
    let mut workspace = BatchWorkspace::default();
    assert_eq!(simulator.verdicts(&starts, &mut workspace).unwrap(), alone);
}
