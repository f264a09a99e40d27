//! A batch gives the bits of the scalar form on every kind of vector instructions the machine has.

mod common;

use bankshot::dynamics::{Lanes, Release, Room, Simulator, State, Verdict};
use bankshot::physics::Physics;
use common::{foul, side};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

fn check(physics: &Physics, starts: &[State]) {
    let scalar = Simulator::new(physics).unwrap().with_lanes(Lanes::SCALAR);
    let truth: Vec<Verdict> = starts
        .iter()
        .map(|start| scalar.verdict_from(*start))
        .collect();
    let available = Lanes::available();
    assert!(available.len() >= 2);
    for (name, lanes) in available {
        let simulator = scalar.clone().with_lanes(lanes);
        let mut room = Room::default();
        for size in [1000, 4096, starts.len()] {
            let found: Vec<Verdict> = starts
                .chunks(size)
                .flat_map(|chunk| simulator.verdicts(chunk, &mut room).to_vec())
                .collect();
            let differ = found.iter().zip(&truth).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "{name}, batches of {size}");
        }
    }
}

#[test]
fn contract_lanes_equal_the_scalar_form_on_a_hundred_thousand_shots() {
    let shots = foul(60_000, 41).into_iter().chain(side(40_000, 42));
    let starts: Vec<State> = shots.map(|release| release.state()).collect();
    check(&Physics::paper(), &starts);
    check(
        &Physics::with_restitution(0.8457).unwrap(),
        &starts[..20_000],
    );
    // Lodged balls stepped on to the time limit.
    let patient = Physics {
        lodged_after_s: 0.0,
        ..Physics::paper()
    };
    check(&patient, &starts[..5_000]);
    // Bounces that lose nothing, or next to nothing.
    for restitution in [0.99, 1.0] {
        let physics = Physics::with_restitution(restitution).unwrap();
        check(&physics, &starts[..10_000]);
    }
    let slippery = Physics {
        friction: 0.0,
        ..Physics::paper()
    };
    check(&slippery, &starts[..10_000]);
}

#[test]
fn contract_a_batch_of_any_size_is_run_to_its_end() {
    let starts: Vec<State> = foul(3000, 45).iter().map(Release::state).collect();
    let simulator = Simulator::new(&Physics::paper()).unwrap();
    let mut room = Room::default();
    // One room for all, large batches before small ones.
    for size in [3000, 0, 1, 7, 17, 2049] {
        let found = simulator.verdicts(&starts[..size], &mut room);
        assert_eq!(found.len(), size);
        for (found, start) in found.iter().zip(&starts) {
            assert_eq!(*found, simulator.verdict_from(*start));
        }
    }
}

#[test]
fn contract_lanes_equal_the_scalar_form_on_wild_shots() {
    // Over the board, past its edges, from beneath, at the rim, spinning fast, already in contact.
    let mut random = ChaCha12Rng::seed_from_u64(43);
    let mut between = |low: f64, high: f64| low + (high - low) * random.random::<f64>();
    let starts: Vec<State> = (0..30_000)
        .map(|_| {
            Release {
                distance_m: between(0.2, 8.0),
                court_angle_rad: between(-1.5, 1.5),
                height_above_hoop_m: between(-2.0, 1.5),
                speed_m_s: between(0.0, 16.0),
                pitch_rad: between(-1.5, 1.57),
                polar_rad: between(-2.0, 2.0),
                backspin_rad_s: between(-60.0, 60.0),
                rifle_spin_rad_s: between(-60.0, 60.0),
                side_spin_rad_s: between(-60.0, 60.0),
            }
            .state()
        })
        .collect();
    check(&Physics::paper(), &starts);
    let mut without = Physics::paper();
    (without.lodged_after_s, without.time_limit_s) = (0.0, 1.5);
    check(&without, &starts[..5000]);
}
