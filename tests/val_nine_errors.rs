//! P under all nine errors: methods against each other, correlations, stated errors, threads and lanes.

mod common;

use bankshot::dynamics::{Lanes, Simulator, State};
use bankshot::plan::Plan;
use bankshot::probability::estimate::{About, Sampler};
use bankshot::probability::sobol::Key;
use bankshot::probability::{Silent, grid, misses, monte_carlo};
use bankshot::profile::{Correlation, Nominal, Profile};
use bankshot::units::DEGREE_RAD;
use common::{load, nominal};
use rand::SeedableRng;
use rand::rngs::ChaCha12Rng;
use rand_distr::{Distribution, StandardNormal};

fn nine() -> (Profile, Nominal) {
    let profile = load("nine_errors");
    (profile, nominal(23.6, 53.5, 0.0, 3.0))
}

#[test]
fn val_grid_monte_carlo_and_sobol_agree_on_six_shots() {
    // Eighteen comparisons at 4.5 standard errors; the grid's error comes from four offsets only, so it
    // is taken as 0.0012 at least.
    let place = |distance_ft: f64, angle_deg: f64| {
        let mut profile = load("free_throw");
        profile.place.distance_m = distance_ft * 0.3048;
        profile.place.angle_rad = angle_deg * DEGREE_RAD;
        profile
    };
    for (name, profile, shot) in [
        ("direct", place(13.75, 0.0), nominal(23.6, 53.5, 0.0, 3.0)),
        ("bank", place(13.75, 0.0), nominal(24.97, 54.2, 0.0, 3.0)),
        (
            "side bank",
            place(12.0, 50.0),
            nominal(23.57, 54.9, 44.67, 3.0),
        ),
        (
            "three-pointer",
            place(23.75, 30.0),
            nominal(29.2, 50.0, 30.0, 2.0),
        ),
        ("near", place(5.0, 20.0), nominal(17.3, 65.0, 20.0, 1.0)),
        // A little hard, to the side: the ball runs round the ring.
        (
            "swirl-prone",
            place(13.75, 0.0),
            nominal(23.9, 48.0, 1.6, 2.0),
        ),
    ] {
        let simulator = Simulator::new(&profile.physics).unwrap();
        let plan = Plan::new(&profile).unwrap();
        let sampler = Sampler::new(&profile, &simulator);
        let sobol = sampler.estimate(&shot, 0.0006, 3, &Silent);
        let plain = monte_carlo::estimate(&profile, &simulator, &shot, 200_000, 4, &Silent);
        let shifted = grid::shifted(&profile, &plan, &simulator, &shot, 20, 5, &Silent);
        let values = [
            (sobol.probability, sobol.standard_error),
            (plain.probability, plain.standard_error),
            (shifted.probability, shifted.standard_error.max(0.0012)),
        ];
        println!("{name:14} {values:.4?}");
        assert!(sobol.probability > 0.02, "{name}: {values:?}");
        for (i, (p, error)) in values.iter().enumerate() {
            for (q, other) in &values[..i] {
                let sigma = (error * error + other * other).sqrt();
                assert!((p - q).abs() < 4.5 * sigma, "{name}: {values:?}");
            }
        }
    }
}

#[test]
fn val_correlated_errors_match_a_rotation_of_independent_ones() {
    // Two normals with correlation r are the sum and the difference of independent ones with variances
    // (1 + r)/2 and (1 - r)/2. Four comparisons at 4.5 standard errors.
    let (mut profile, shot) = nine();
    let simulator = Simulator::new(&profile.physics).unwrap();
    for (first, second, r) in [(0, 1, 0.5), (0, 1, -0.5), (1, 8, 0.5), (2, 7, -0.5)] {
        profile.shooter.errors.correlation = Correlation::new(&[(first, second, r)]).unwrap();
        let sampler = Sampler::new(&profile, &simulator);
        let sobol = sampler.estimate(&shot, 0.0006, 3, &Silent);
        let mut independent = profile.clone();
        independent.shooter.errors.correlation = Correlation::NONE;
        let about = About::new(&independent, &shot);
        let mut random = ChaCha12Rng::seed_from_u64(8);
        let samples = 200_000;
        let starts: Vec<State> = (0..samples)
            .map(|_| {
                let mut z: [f64; 9] = std::array::from_fn(|_| StandardNormal.sample(&mut random));
                let sum = (0.5 * (1.0 + r)).sqrt() * z[first];
                let difference = (0.5 * (1.0 - r)).sqrt() * z[second];
                (z[first], z[second]) = (sum + difference, sum - difference);
                about.with_normals(z).state()
            })
            .collect();
        let mut room = Default::default();
        let made = starts.chunks(4096).map(|batch| {
            let verdicts = simulator.verdicts(batch, &mut room);
            verdicts.iter().filter(|verdict| verdict.made).count()
        });
        let p = made.sum::<usize>() as f64 / f64::from(samples);
        let variance = p * (1.0 - p) / f64::from(samples) + sobol.standard_error.powi(2);
        assert!(
            (p - sobol.probability).abs() < 4.5 * variance.sqrt(),
            "{first} {second} {r}: {p} {sobol:?}"
        );
    }
}

#[test]
fn val_fifty_scrambles_scatter_as_they_say() {
    // The sum of the squared deviations from their mean over the stated variance is about chi-squared
    // with 49 degrees of freedom: 0.45 to 1.85 times 49 holds for all but 1 in 2000 choices of seeds.
    let (profile, shot) = nine();
    let simulator = Simulator::new(&profile.physics).unwrap();
    let sampler = Sampler::new(&profile, &simulator);
    let found: Vec<_> = (0..50)
        .map(|seed| sampler.estimate(&shot, 0.002, 1000 + seed, &Silent))
        .collect();
    let mean = found.iter().map(|e| e.probability).sum::<f64>() / 50.0;
    let stated = found.iter().map(|e| e.standard_error.powi(2)).sum::<f64>() / 50.0;
    let square: f64 = found.iter().map(|e| (e.probability - mean).powi(2)).sum();
    let ratio = square / stated / 49.0;
    println!("scatter over stated error: {:.3}", ratio.sqrt());
    assert!((0.45..1.85).contains(&ratio), "{ratio}");
}

#[test]
fn val_without_errors_all_nine_give_the_one_shots_outcome() {
    let (mut profile, _) = nine();
    let errors = &mut profile.shooter.errors;
    (errors.c10_m_s, errors.c20_rad, errors.c30_rad) = (0.0, 0.0, 0.0);
    (errors.c40_rad_s, errors.rifle_spin_rad_s) = (0.0, 0.0);
    (errors.side_spin_rad_s, errors.distance_m) = (0.0, 0.0);
    (errors.court_angle_rad, errors.height_m) = (0.0, 0.0);
    let simulator = Simulator::new(&profile.physics).unwrap();
    let plan = Plan::new(&profile).unwrap();
    for (shot, p) in [
        (nominal(23.6, 52.0, 0.0, 0.0), 1.0),
        (nominal(23.0, 52.0, 0.0, 0.0), 0.0),
    ] {
        let sampler = Sampler::new(&profile, &simulator);
        let sobol = sampler.estimate(&shot, 0.001, 1, &Silent);
        let plain = monte_carlo::estimate(&profile, &simulator, &shot, 1000, 1, &Silent);
        let shifted = grid::shifted(&profile, &plan, &simulator, &shot, 20, 1, &Silent);
        for found in [sobol, plain, shifted] {
            assert_eq!((found.probability, found.standard_error), (p, 0.0));
        }
        assert_eq!(sobol.interval_95(), (p, p));
    }
}

#[test]
fn contract_threads_and_lanes_change_no_bit_of_p() {
    let (profile, shot) = nine();
    let find = |threads: usize, lanes: Lanes| {
        let simulator = Simulator::new(&profile.physics).unwrap().with_lanes(lanes);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let sampler = Sampler::new(&profile, &simulator);
            let sobol = sampler.estimate(&shot, 0.002, 1, &Silent);
            let plain = monte_carlo::estimate(&profile, &simulator, &shot, 20_000, 1, &Silent);
            let sorted = misses::sort(&profile, &simulator, &shot, &sobol, 1);
            (sobol, plain, sorted)
        })
    };
    let one = find(1, Lanes::SCALAR);
    for (name, lanes) in Lanes::available() {
        for threads in [1, 2, 7] {
            assert_eq!(one, find(threads, lanes), "{name} {threads}");
        }
    }
}

#[test]
fn prop_shares_of_made_and_missed_sum_to_one() {
    let (profile, shot) = nine();
    let simulator = Simulator::new(&profile.physics).unwrap();
    let sobol = Sampler::new(&profile, &simulator).estimate(&shot, 0.002, 1, &Silent);
    let missed = misses::sort(&profile, &simulator, &shot, &sobol, 1);
    let sum: f64 = missed.named().iter().map(|(_, share)| share).sum();
    assert!((sum + sobol.probability - 1.0).abs() < 1e-12);
    // A free throw from the middle is missed to either side alike.
    assert!((missed.left - missed.right).abs() < 0.01, "{missed:?}");
}

#[test]
fn contract_a_sample_is_found_again_by_its_number() {
    let (profile, shot) = nine();
    let simulator = Simulator::new(&profile.physics).unwrap();
    let sampler = Sampler::new(&profile, &simulator);
    let scramble = sampler.scramble(Key {
        seed: 7,
        replicate: 5,
    });
    let found = sampler.sample(&shot, 7, 64 * 32 + 5);
    assert_eq!(found, sampler.release(&shot, 64, &scramble));
    // Monte Carlo: the first samples of a stream, counted one by one.
    let one = monte_carlo::estimate(&profile, &simulator, &shot, 300, 7, &Silent);
    let made = (0..300)
        .filter(|&index| {
            let release = monte_carlo::sample(&profile, &shot, 7, index);
            simulator.verdict(&release).made
        })
        .count();
    assert_eq!(one.probability, made as f64 / 300.0);
}
