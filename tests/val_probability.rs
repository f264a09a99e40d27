//! Probabilities: table, Sobol and Monte Carlo against each other, the bracket, the thread count.

mod common;

use bankshot::dynamics::{Kind, Simulator};
use bankshot::plan::Plan;
use bankshot::probability::best::{self, ShotKind};
use bankshot::probability::estimate::Sampler;
use bankshot::probability::{Silent, Table, monte_carlo};
use bankshot::profile::{self, Nominal, Profile};
use bankshot::units::DEGREE_RAD;
use common::{load, nominal};
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

#[test]
fn val_sobol_agrees_with_plain_monte_carlo() {
    // Four comparisons at 4.5 standard errors: a false alarm in about 3e-5 of all seeds.
    let profile = load("free_throw");
    let simulator = Simulator::new(&profile.physics).unwrap();
    let sampler = Sampler::new(&profile, &simulator);
    for shot in [
        nominal(23.6, 53.5, 0.0, 3.0),
        nominal(24.95, 54.5, 0.0, 3.0),
        nominal(23.3, 48.0, 1.0, 0.0),
        nominal(24.4, 58.0, -0.7, 1.5),
    ] {
        let sobol = sampler.estimate(&shot, 0.001, 5, &Silent);
        let plain = monte_carlo::estimate(&profile, &simulator, &shot, 200_000, 6, &Silent);
        let (p, error) = (plain.probability, plain.standard_error);
        let sigma = (error * error + sobol.standard_error.powi(2)).sqrt();
        assert!(
            (p - sobol.probability).abs() < 4.5 * sigma,
            "{shot:?}: {p} {sobol:?}"
        );
        assert!(sobol.standard_error <= 0.001);
        let shares = sobol.shares;
        assert!((shares.swish + shares.ring + shares.banked() - sobol.probability).abs() < 1e-12);
    }
}

/// Places and shooters by which the table is judged: narrow and wide, in front and at the side.
const JUDGED: [(&str, f64); 6] = [
    ("elite", 0.0),
    ("elite", 67.5),
    ("novice", 0.0),
    ("novice", 67.5),
    ("free_throw", 0.0),
    ("bank_wing", 50.0),
];

/// Table less Sobol at the centres of `windows` windows about each of the best direct and bank shots.
fn table_errors(windows: u64) -> Vec<f64> {
    let mut random = ChaCha12Rng::seed_from_u64(99);
    let mut all = Vec::new();
    for (name, angle_deg) in JUDGED {
        let mut profile = load(name);
        profile.place.angle_rad = angle_deg * DEGREE_RAD;
        let simulator = Simulator::new(&profile.physics).unwrap();
        let plan = Plan::new(&profile).unwrap();
        let sampler = Sampler::new(&profile, &simulator);
        let best = best::find(&profile, &Silent).unwrap();
        let mut errors = Vec::new();
        for shot in [best.direct.unwrap().nominal, best.bank.unwrap().nominal] {
            for window in 0..windows {
                let sigma = &profile.shooter.errors;
                let mut within = |reach: f64| reach * (2.0 * random.random::<f64>() - 1.0);
                let centre = Nominal {
                    speed_m_s: shot.speed_m_s + within(0.5 * sigma.speed_m_s(shot.speed_m_s)),
                    pitch_rad: shot.pitch_rad + within(0.5 * sigma.c20_rad),
                    polar_rad: shot.polar_rad + within(0.3 * sigma.c30_rad),
                    backspin_rad_s: shot.backspin_rad_s - within(2.0).abs(),
                    ..Nominal::default()
                };
                let window_plan = plan.around(&profile, &centre).unwrap();
                let table = Table::build(&profile, &window_plan, &simulator, &Silent);
                let table = table.probabilities(&profile);
                let (p, at) = table.at(table.index_of(&centre));
                let sobol = sampler.estimate(&at, 0.0004, 1000 + window, &Silent);
                assert_eq!(sobol.unresolved, 0);
                errors.push(p - sobol.probability);
            }
        }
        let [bias, rms, worst] = spread(&errors);
        println!("{name:12} {angle_deg:4} deg: bias {bias:+.5} rms {rms:.5} worst {worst:.5}");
        all.extend(errors);
    }
    let [bias, rms, worst] = spread(&all);
    println!(
        "all {:4}             : bias {bias:+.5} rms {rms:.5} worst {worst:.5}",
        all.len()
    );
    all
}

#[test]
fn val_table_agrees_with_sobol_for_narrow_and_wide_shooters_in_front_and_at_the_side() {
    // The table's rms error is 0.001 at most (`campaign_table` measures it on 72 windows; the
    // reference's 0.0004 is included). Twelve windows scatter about that: 1.6 times it would be exceeded
    // by chance in 1 of 1000 choices of windows, three times it by any one of twelve in 1 of 30.
    let [bias, rms, worst] = spread(&table_errors(1));
    assert!(
        bias.abs() < 0.001 && rms < 0.0016 && worst < 0.003,
        "{bias} {rms} {worst}"
    );
}

#[test]
#[ignore = "a campaign of one minute: cargo test --test val_probability campaign_table -- --ignored --nocapture"]
fn campaign_table_is_good_to_a_thousandth() {
    let [bias, rms, worst] = spread(&table_errors(6));
    assert!(
        bias.abs() < 0.0004 && rms < 0.001 && worst < 0.004,
        "{bias} {rms} {worst}"
    );
}

#[test]
fn val_table_agrees_with_sobol_at_its_nominals() {
    let profile = load("free_throw");
    let simulator = Simulator::new(&profile.physics).unwrap();
    let plan = Plan::new(&profile).unwrap();
    let sampler = Sampler::new(&profile, &simulator);
    for shot in [
        nominal(23.6, 53.5, 0.0, 3.0),
        nominal(24.95, 54.5, 0.0, 2.0),
        nominal(23.5, 50.0, 0.8, 1.0),
    ] {
        let window = plan.around(&profile, &shot).unwrap();
        let table = Table::build(&profile, &window, &simulator, &Silent).probabilities(&profile);
        let (p, at) = table.at(table.index_of(&shot));
        let sobol = sampler.estimate(&at, 0.0004, 9, &Silent);
        assert!(
            (p - sobol.probability).abs() < 0.004,
            "{at:?}: {p} {sobol:?}"
        );
        assert_eq!(sobol.unresolved, 0);
    }
}

/// Mean, root of the mean square, and largest size.
fn spread(errors: &[f64]) -> [f64; 3] {
    let n = errors.len() as f64;
    [
        errors.iter().sum::<f64>() / n,
        (errors.iter().map(|error| error * error).sum::<f64>() / n).sqrt(),
        errors
            .iter()
            .fold(0.0_f64, |worst, error| worst.max(error.abs())),
    ]
}

#[test]
fn val_without_errors_the_probability_is_the_one_shots_outcome() {
    let mut profile = load("free_throw");
    let errors = &mut profile.shooter.errors;
    (
        errors.c10_m_s,
        errors.c20_rad,
        errors.c30_rad,
        errors.c40_rad_s,
    ) = (0.0, 0.0, 0.0, 0.0);
    let simulator = Simulator::new(&profile.physics).unwrap();
    let sampler = Sampler::new(&profile, &simulator);
    for (shot, p) in [
        (nominal(23.6, 52.0, 0.0, 0.0), 1.0),
        (nominal(23.0, 52.0, 0.0, 0.0), 0.0),
    ] {
        let estimate = sampler.estimate(&shot, 0.001, 1, &Silent);
        assert_eq!((estimate.probability, estimate.standard_error), (p, 0.0));
    }
}

#[test]
fn prop_no_made_shot_lies_outside_the_bracket() {
    for name in ["free_throw", "bank_wing", "three_pointer"] {
        let profile = load(name);
        let plan = Plan::new(&profile).unwrap();
        let simulator = Simulator::new(&profile.physics).unwrap();
        let wide = plan.wide_sample(&profile, &simulator, 300_000);
        assert!(wide.outside > 100_000, "{wide:?}");
        assert_eq!(wide.made_outside, 0, "{name}: {wide:?}");
    }
}

fn small(name: &str) -> Profile {
    let mut profile = load(name);
    profile.grid = profile::Grid {
        speed: 24,
        pitch: 16,
        polar: 16,
        backspin: 6,
    };
    profile.search.standard_error = 0.004;
    profile
}

#[test]
fn contract_the_thread_count_changes_no_bit() {
    let profile = small("free_throw");
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let best = pool.install(|| best::find(&profile, &Silent)).unwrap();
        bankshot::output::best::json(&profile, &best, Default::default()).to_string()
    };
    let one = run(1);
    assert_eq!(one, run(2));
    assert_eq!(one, run(7));
}

#[test]
fn prop_best_shots_are_of_their_kind_and_mirror() {
    let profile = small("bank_wing");
    let mut mirrored = profile.clone();
    mirrored.place.angle_rad = -profile.place.angle_rad;
    let simulator = Simulator::new(&profile.physics).unwrap();
    let (a, b) = (
        best::find(&profile, &Silent).unwrap(),
        best::find(&mirrored, &Silent).unwrap(),
    );
    for (kind, one, two) in [
        (ShotKind::Direct, a.direct.unwrap(), b.direct.unwrap()),
        (ShotKind::Bank, a.bank.unwrap(), b.bank.unwrap()),
    ] {
        assert_eq!(ShotKind::of(&profile, &simulator, &one.nominal), kind);
        assert_ne!(one.outcome.kind, Kind::Unresolved);
        // The grids are not mirrored, so the two searches are independent; P is flat at its top.
        let difference = (one.estimate.probability - two.estimate.probability).abs();
        assert!(difference < 0.02, "{kind:?} {difference}");
    }
}

#[test]
fn prop_best_is_not_below_its_own_table() {
    let profile = small("free_throw");
    let best = best::find(&profile, &Silent).unwrap();
    for shot in [best.direct.unwrap(), best.bank.unwrap()] {
        // The small table's own error is about 0.01; its best entry is picked for being high.
        assert!(
            shot.estimate.probability > shot.table_probability - 0.03,
            "{shot:?}"
        );
    }
}

#[test]
#[ignore = "a campaign of two minutes: cargo test --test val_probability campaign_best -- --ignored --nocapture"]
fn campaign_best_is_within_three_thousandths_of_a_brute_force_search() {
    // Brute force: a table of 3.6 million shots over everything the shooter may intend, and the thirty best of
    // its nominal shots of each kind, no two of them neighbours, integrated to 0.0005.
    let places = [
        ("free_throw", 13.75, 0.0),
        ("free_throw", 6.0, 30.0),
        ("free_throw", 9.0, 60.0),
        ("bank_wing", 12.0, 50.0),
        ("bank_wing", 18.0, 50.0),
        ("elite", 20.0, 0.0),
        ("elite", 15.0, 75.0),
        ("novice", 10.0, 20.0),
        ("school", 13.75, -45.0),
        ("three_pointer", 22.0, 10.0),
    ];
    for (name, distance_ft, angle_deg) in places {
        let mut profile = load(name);
        profile.place.distance_m = distance_ft * 0.3048;
        profile.place.angle_rad = angle_deg * DEGREE_RAD;
        profile.search = profile::Search {
            standard_error: 0.0005,
            ..profile::Search::around(profile.place.distance_m, profile.height_above_hoop_m())
        };
        let simulator = Simulator::new(&profile.physics).unwrap();
        let sampler = Sampler::new(&profile, &simulator);
        let best = best::find(&profile, &Silent).unwrap();
        let mut wide = profile.clone();
        wide.grid = profile::Grid {
            speed: 120,
            pitch: 90,
            polar: 84,
            backspin: 10,
        };
        let plan = Plan::new(&wide).unwrap();
        let table = Table::build(&wide, &plan, &simulator, &Silent).probabilities(&wide);
        let mut order: Vec<usize> = (0..table.values.len()).collect();
        order.sort_by(|&a, &b| table.values[b].total_cmp(&table.values[a]));
        let counts = table.counts();
        let index_of = |i: usize| {
            let (rest, speed) = (i / counts[3], i % counts[3]);
            let (rest, spin) = (rest / counts[2], rest % counts[2]);
            [rest / counts[1], rest % counts[1], spin, speed]
        };
        for (kind, found) in [(ShotKind::Direct, best.direct), (ShotKind::Bank, best.bank)] {
            let mut chosen: Vec<[usize; 4]> = Vec::new();
            let mut brute = 0.0_f64;
            for &i in &order {
                let index = index_of(i);
                let near = |other: &[usize; 4]| (0..4).all(|k| index[k].abs_diff(other[k]) <= 1);
                let (p, shot) = table.at(index);
                if chosen.len() == 30 || p == 0.0 {
                    break;
                }
                if chosen.iter().any(near) || ShotKind::of(&profile, &simulator, &shot) != kind {
                    continue;
                }
                chosen.push(index);
                let estimate = sampler.estimate(&shot, 0.0005, 31, &Silent);
                brute = brute.max(estimate.probability);
            }
            let p = found.map_or(0.0, |shot| shot.estimate.probability);
            println!(
                "{name:13} {distance_ft:5} ft {angle_deg:5} deg {:6}: best {p:.4}, brute force {brute:.4}, {:+.4}",
                kind.name(),
                p - brute
            );
            assert!(p > brute - 0.003, "{name} {kind:?}: {p} {brute}");
        }
    }
}
