//! The number of threads and the instruction set change no bit of any result.

use crate::common::{free_throw_uniform, grid, load, nominal, on_threads, with_search};
use bankshot::analysis::miss_breakdown::classify_misses;
use bankshot::best_shot;
use bankshot::dynamics::{InstructionSet, Outcome, Simulator};
use bankshot::model::Physics;
use bankshot::probability::{Sampler, Silent, monte_carlo};

const THREADS: [usize; 3] = [1, 2, 7];

#[test]
fn contract_simulate_batch_equals_single_shots_in_order() {
    let simulator = Simulator::new(&Physics::paper()).unwrap();
    let releases = free_throw_uniform(3000, 46);
    let single: Vec<Outcome> = releases
        .iter()
        .map(|release| simulator.simulate(release).unwrap())
        .collect();
    for threads in THREADS {
        let batch = on_threads(threads, || simulator.simulate_batch(&releases)).unwrap();
        assert_eq!(batch, single, "{threads} threads");
    }
    assert_eq!(simulator.simulate_batch(&[]), Ok(Vec::new()));
}

#[test]
fn contract_threads_and_instruction_sets_change_no_bit_of_p() {
    let (profile, shot) = (
        load("errors_in_all_nine_variables"),
        nominal(23.6, 53.5, 0.0, 3.0),
    );
    let find = |threads: usize, instructions: InstructionSet| {
        let profile = profile.clone().with_instructions(instructions);
        on_threads(threads, || {
            let sobol = Sampler::new(&profile).estimate(&shot, 0.002, 1, &Silent);
            let plain = monte_carlo::estimate(&profile, &shot, 20_000, 1, &Silent);
            let missed = classify_misses(&profile, &shot, &sobol, 1);
            (sobol, plain, missed)
        })
    };
    let one = find(1, InstructionSet::SCALAR);
    for (name, instructions) in InstructionSet::available() {
        for threads in THREADS {
            assert_eq!(
                one,
                find(threads, instructions),
                "{name}, {threads} threads"
            );
        }
    }
}

#[test]
fn contract_threads_change_no_bit_of_the_best_shots() {
    let profile = with_search(&load("free_throw"), grid(18, 12, 12, 4), 0.004);
    // The debug text has every digit of every number.
    let find = |threads| {
        let best = on_threads(threads, || best_shot::find(&profile, &Silent));
        format!("{:?}", best.unwrap())
    };
    let one = find(1);
    assert!(one.contains("probability"));
    for threads in &THREADS[1..] {
        assert!(one == find(*threads), "{threads} threads");
    }
}
