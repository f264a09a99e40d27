//! P of all nominal shots from one table of shots, against Sobol points at single nominal shots.

use crate::common::{at, load, nominal};
use bankshot::probability::{NominalTable, Sampler, Silent};
use bankshot::search_space::TablePlan;
use bankshot::shooter::Nominal;
use rand::rngs::ChaCha12Rng;
use rand::{RngExt, SeedableRng};

/// A direct and a bank shot, by [`nominal`].
type Shots = [[f64; 4]; 2];

/// Shooters and court angles (deg) by which the table is judged, narrow and wide, in front and at
/// the side, with good direct and bank shots there. They stand here, so that the windows do not
/// depend on a search.
const JUDGED: [(&str, f64, Shots); 6] = [
    (
        "elite",
        0.0,
        [[24.3244, 53.4122, 0.0, 3.0], [25.7857, 51.9682, 0.0, 3.0]],
    ),
    (
        "elite",
        67.5,
        [
            [24.3377, 52.5056, 67.5196, 3.0],
            [25.2906, 51.9971, 61.6847, 2.9654],
        ],
    ),
    (
        "novice",
        0.0,
        [[24.4911, 54.7650, 0.0, 2.0], [26.2108, 59.7094, 0.0, 2.0]],
    ),
    (
        "novice",
        67.5,
        [
            [24.4372, 53.8356, 67.5020, 2.0],
            [25.3050, 52.0638, 61.6157, 2.0],
        ],
    ),
    (
        "free_throw",
        0.0,
        [[24.4142, 55.1229, 0.0, 3.0], [25.9758, 54.9975, 0.0, 3.0]],
    ),
    (
        "bank_wing",
        50.0,
        [
            [23.1488, 56.1029, 50.0548, 3.0],
            [24.2744, 54.4586, 44.6187, 3.0],
        ],
    ),
];

/// Table minus Sobol at the centres of `windows` windows about each of these shots.
fn table_errors(windows: u64) -> Vec<f64> {
    let mut random = ChaCha12Rng::seed_from_u64(99);
    let mut all = Vec::new();
    for (name, angle_deg, shots) in JUDGED {
        let profile = load(name);
        let profile = at(&profile, profile.location().distance_m, angle_deg);
        let plan = TablePlan::for_search(&profile).unwrap();
        let sampler = Sampler::new(&profile);
        let mut errors = Vec::new();
        for [speed, pitch, polar, backspin] in shots {
            let shot = nominal(speed, pitch, polar, backspin);
            for window in 0..windows {
                let sigma = &profile.shooter().dispersion;
                let mut within = |reach: f64| reach * (2.0 * random.random::<f64>() - 1.0);
                let centre = Nominal {
                    speed_m_s: shot.speed_m_s + within(0.5 * sigma.speed_m_s(shot.speed_m_s)),
                    pitch_rad: shot.pitch_rad + within(0.5 * sigma.c20_rad),
                    polar_rad: shot.polar_rad + within(0.3 * sigma.c30_rad),
                    backspin_rad_s: shot.backspin_rad_s - within(2.0).abs(),
                    ..Nominal::default()
                };
                let window_plan = plan.window(&profile, &centre).unwrap();
                let table = NominalTable::simulate(&profile, &window_plan, &Silent);
                let table = table.probabilities(&profile);
                let (p, at) = table.at(table.index_of(&centre));
                let sobol = sampler.estimate(&at, 0.0002, 1000 + window, &Silent);
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

/// Mean, root mean square, and largest size.
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
fn val_table_agrees_with_sobol_for_narrow_and_wide_shooters_in_front_and_at_the_side() {
    // The table's rms error is at most 0.001 (`campaign_table` measures it on 72 windows; the
    // 0.0002 of the Sobol reference is included). For twelve windows, 1.6 times that is exceeded by
    // 1 of 1000 choices of windows, and three times that by a single window for 1 of 30 choices.
    let [bias, rms, worst] = spread(&table_errors(1));
    assert!(
        bias.abs() < 0.001 && rms < 0.0016 && worst < 0.003,
        "{bias} {rms} {worst}"
    );
}

#[test]
#[ignore = "two minutes: cargo test --test validation campaign_table -- --ignored --nocapture"]
fn campaign_table_is_good_to_a_thousandth() {
    let [bias, rms, worst] = spread(&table_errors(6));
    assert!(
        bias.abs() < 0.0004 && rms < 0.001 && worst < 0.003,
        "{bias} {rms} {worst}"
    );
}

#[test]
fn val_table_agrees_with_sobol_at_its_nominals() {
    let profile = load("free_throw");
    let plan = TablePlan::for_search(&profile).unwrap();
    let sampler = Sampler::new(&profile);
    for shot in [
        nominal(23.6, 53.5, 0.0, 3.0),
        nominal(24.95, 54.5, 0.0, 2.0),
        nominal(23.5, 50.0, 0.8, 1.0),
    ] {
        let window = plan.window(&profile, &shot).unwrap();
        let table = NominalTable::simulate(&profile, &window, &Silent).probabilities(&profile);
        let (p, at) = table.at(table.index_of(&shot));
        let sobol = sampler.estimate(&at, 0.0004, 9, &Silent);
        println!("table minus Sobol: {:+.5}", p - sobol.probability);
        // The worst error of `campaign_table` is 0.004.
        assert!(
            (p - sobol.probability).abs() < 0.004,
            "{at:?}: {p} {sobol:?}"
        );
        assert_eq!(sobol.unresolved, 0);
    }
}
