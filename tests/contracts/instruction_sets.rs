//! A batch has the bits of single shots, on every set of vector instructions that this machine has.
//!
//! The reference is [`Simulator::simulate_state`], which never uses vector instructions. The lanes
//! of sets that this machine does not have are covered by unit tests of the batch.

use crate::common::{free_throw_uniform, side_uniform, states, wild};
use bankshot::dynamics::{
    BatchWorkspace, InstructionSet, Integrator, Precision, Simulator, Verdict,
};
use bankshot::model::{BallState, BoardEdge, PRESETS, Physics, Preset};
use rayon::prelude::*;

/// Every instruction set of this machine except the scalar one.
fn vector_sets() -> Vec<(&'static str, InstructionSet)> {
    let mut sets = InstructionSet::available();
    sets.retain(|(name, _)| *name != "scalar");
    assert!(!sets.is_empty(), "no vector instructions to compare");
    sets
}

fn single_shots(simulator: &Simulator, starts: &[BallState]) -> Vec<Verdict> {
    starts
        .par_iter()
        .map(|start| simulator.simulate_state(*start).unwrap().verdict)
        .collect()
}

fn check(physics: &Physics, starts: &[BallState]) {
    let simulator = Simulator::new(physics).unwrap();
    let expected = single_shots(&simulator, starts);
    for (name, instructions) in vector_sets() {
        let simulator = simulator.clone().with_instructions(instructions);
        let mut workspace = BatchWorkspace::default();
        for size in [1000, 4096, starts.len()] {
            let found: Vec<Verdict> = starts
                .chunks(size)
                .flat_map(|chunk| simulator.verdicts(chunk, &mut workspace).unwrap().to_vec())
                .collect();
            assert_eq!(found.len(), expected.len());
            let differ = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{name}, batches of {size}");
        }
        println!("{name}: {} shots equal single shots", starts.len());
    }
}

#[test]
fn contract_vector_sets_equal_single_shots_on_a_hundred_thousand_shots() {
    let mut starts = states(&free_throw_uniform(60_000, 41));
    starts.extend(states(&side_uniform(40_000, 42)));
    check(&Physics::paper(), &starts);
    check(
        &Physics::with_restitution(0.8457).unwrap(),
        &starts[..20_000],
    );
    // Lodged balls, simulated up to the time limit.
    let without_lodged_rule = Physics {
        lodged_after_s: 0.0,
        ..Physics::paper()
    };
    check(&without_lodged_rule, &starts[..5_000]);
    // Bounces that lose nothing or almost nothing.
    for restitution in [0.99, 1.0] {
        let physics = Physics::with_restitution(restitution).unwrap();
        check(&physics, &starts[..10_000]);
    }
    let without_friction = Physics::paper().with_contacts(|contact| contact.friction = 0.0);
    check(&without_friction, &starts[..10_000]);
}

/// With air, rod, bracket, edges and materials of their own; with lift; without one of them each.
#[test]
fn contract_vector_sets_equal_single_shots_under_every_preset() {
    let starts = states(&[free_throw_uniform(6_000, 51), side_uniform(6_000, 52)].concat());
    let wild = states(&wild(6_000, 53));
    for preset in &PRESETS {
        check(&preset.physics(), &starts[..6_000]);
    }
    let ncaa = || Preset::named("ncaa").unwrap().physics();
    check(&ncaa(), &starts);
    check(&ncaa(), &wild);
    let changes: [fn(&mut Physics); 6] = [
        |physics| physics.air.lift_slope = 1.0,
        |physics| physics.air.density_kg_m3 = 0.0,
        |physics| physics.bracket_width_m = 0.3,
        |physics| physics.board_edge = BoardEdge::None,
        |physics| physics.board_edge = BoardEdge::Rounded { radius_m: 0.0 },
        |physics| physics.ring_tube_diameter_m = 0.0,
    ];
    for change in changes {
        let mut physics = ncaa();
        change(&mut physics);
        check(&physics, &starts[3_000..9_000]);
        check(&physics, &wild[..3_000]);
    }
}

#[test]
fn contract_vector_sets_equal_single_shots_on_wild_shots() {
    let starts = states(&wild(30_000, 43));
    check(&Physics::paper(), &starts);
    let short_limit = Physics {
        lodged_after_s: 0.0,
        time_limit_s: 1.5,
        ..Physics::paper()
    };
    check(&short_limit, &starts[..5000]);
}

#[test]
fn contract_a_batch_of_any_size_has_a_verdict_for_every_shot() {
    let starts = states(&free_throw_uniform(3000, 45));
    let double = Integrator::EventDriven {
        steps_per_contact: 4,
        precision: Precision::Double,
    };
    let ncaa = Preset::named("ncaa").unwrap().physics();
    for simulator in [
        Simulator::new(&Physics::paper()).unwrap(),
        Simulator::new(&ncaa).unwrap(),
        Simulator::with_integrator(&ncaa, double).unwrap(),
    ] {
        let expected = single_shots(&simulator, &starts);
        for (name, instructions) in vector_sets() {
            let simulator = simulator.clone().with_instructions(instructions);
            let mut workspace = BatchWorkspace::default();
            // One workspace for all, large batches before small ones.
            for size in [3000, 0, 1, 2, 7, 8, 9, 16, 17, 33, 1025, 2049] {
                let found = simulator.verdicts(&starts[..size], &mut workspace).unwrap();
                assert_eq!(found, &expected[..size], "{name}, batch of {size}");
            }
        }
    }
}
