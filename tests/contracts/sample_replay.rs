//! A sample is found again by its number.

use crate::common::{load, nominal};
use bankshot::math::sobol::ScrambleKey;
use bankshot::probability::{REPLICATES, Sampler, Silent, monte_carlo};

#[test]
fn contract_a_sobol_sample_is_found_again_by_its_number() {
    let (profile, shot) = (
        load("errors_in_all_nine_variables"),
        nominal(23.6, 53.5, 0.0, 3.0),
    );
    let sampler = Sampler::new(&profile);
    let scramble = sampler.scramble(ScrambleKey {
        seed: 7,
        replicate: 5,
    });
    let found = sampler.sample(&shot, 7, 64 * REPLICATES + 5);
    assert_eq!(found, sampler.release(&shot, 64, &scramble));
}

#[test]
fn contract_a_monte_carlo_sample_is_found_again_by_its_number() {
    // The first samples of a stream, counted one by one.
    let (profile, shot) = (
        load("errors_in_all_nine_variables"),
        nominal(23.6, 53.5, 0.0, 3.0),
    );
    let estimate = monte_carlo::estimate(&profile, &shot, 300, 7, &Silent);
    let made = (0..300)
        .filter(|&index| {
            let release = monte_carlo::sample(&profile, &shot, 7, index);
            let outcome = profile.simulator().simulate(&release);
            outcome.unwrap().verdict.made
        })
        .count();
    assert_eq!(estimate.probability, made as f64 / 300.0);
    let first = monte_carlo::first_samples(&profile, &shot, 7, 5000);
    assert_eq!(first.len(), 5000);
    for index in [0, 299, 4095, 4096, 4999] {
        let release = monte_carlo::sample(&profile, &shot, 7, index as u64);
        assert_eq!(first[index], release, "{index}");
    }
}
