//! Attacks with mutated input: nothing may panic, run on without end or take memory without bound.
//!
//! Each target turns random bytes into mutations of a small corpus; a failure is shrunk. An
//! ordinary run tries a few hundred, always the same. `BANKSHOT_FUZZ_TRIES=10000000 cargo test
//! --release --test fuzz -- --nocapture` is the campaign of `docs/reliability.md`; its random
//! numbers differ from run to run, unless `BANKSHOT_FUZZ_SEED` (0 to 255) fixes them.

mod text_mutation;

use bankshot::best_shot::ShotKind;
use bankshot::config::{parse_locations, parse_physics, parse_profile};
use bankshot::dynamics::{Release, Simulator};
use bankshot::files::csv_records::{CsvRecords, MAX_RECORD_BYTES};
use bankshot::files::parquet_rows::{ParquetRows, ParquetSink, column};
use bankshot::model::{BoardEdge, PRESETS, Physics};
use bankshot::present::simulation_files::outcome_columns::outcome_cells;
use bankshot::present::simulation_files::release_columns::ReleaseColumns;
use bankshot::sweep::CourtPlace;
use bankshot::sweep::result_row::ResultRow;
use bankshot::sweep::sqlite_results::{self, ResultStore};
use bankshot::sweep::sweep_toml::{SourceTexts, named_files, parse_sweep};
use parquet::basic::Type as Physical;
use proptest::test_runner::{Config as ProptestConfig, RngAlgorithm, TestRng, TestRunner};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;
use text_mutation::Script;

const PROFILES: [&str; 4] = [
    include_str!("../../configs/free_throw.toml"),
    include_str!("../../configs/errors_in_all_nine_variables.toml"),
    include_str!("../../configs/bank_wing.toml"),
    include_str!("../../configs/paper/fig_12.toml"),
];
const SWEEPS: [&str; 3] = [
    include_str!("../../configs/quick_sweep.toml"),
    include_str!("../../configs/half_court.toml"),
    include_str!("../small_sweep.toml"),
];
const RELEASES: &str = "\
note,pitch_deg,speed_ft_s,distance_ft,court_angle_deg,release_height_ft,polar_deg,backspin_rev_s
swish,52,23.5,13.75,0,7,0,0
\"a \"\"bank\"\" shot,
on two lines\",52,24.7,13.75,0,7,0,3

short,5.2e1,22.0,13.75,-0.0,7,0,3
";
const PLACES: &str = "name,x_ft,y_ft\nelbow,11,8\ncorner,1,-20\n\"the, line\",13.75,0\n";
/// Tries of all targets in an ordinary test run.
const TRIES: u32 = 3000;
/// Longest time to shrink a failure, ms.
const MAX_SHRINK_MS: u32 = 20_000;
/// Most random bytes of a try.
const MAX_SCRIPT: usize = 200;

/// Runs a target on random bytes, with its share of the tries, in thousandths.
fn attack(share: u32, target: impl Fn(&[u8])) {
    let tries = std::env::var("BANKSHOT_FUZZ_TRIES").ok();
    let is_campaign = tries.is_some();
    let tries: u32 = tries.map_or(TRIES, |tries| tries.parse().unwrap());
    let config = ProptestConfig {
        cases: (u64::from(tries) * u64::from(share) / 1000) as u32,
        failure_persistence: None,
        max_shrink_iters: 2000,
        max_shrink_time: MAX_SHRINK_MS,
        ..ProptestConfig::default()
    };
    // An ordinary run tries the same bytes every time, and so does one with a seed.
    let seed = std::env::var("BANKSHOT_FUZZ_SEED").ok();
    let seed = seed.map(|seed| seed.parse::<u8>().unwrap());
    let mut runner = match seed.or((!is_campaign).then_some(0)) {
        Some(seed) => {
            let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[seed; 32]);
            TestRunner::new_with_rng(config, rng)
        }
        None => TestRunner::new(config),
    };
    let bytes = proptest::collection::vec(proptest::num::u8::ANY, 0..MAX_SCRIPT);
    let result = runner.run(&bytes, |bytes| {
        target(&bytes);
        Ok(())
    });
    if let Err(failure) = result {
        panic!("{failure}");
    }
}

#[test]
fn fuzz_profiles() {
    attack(110, |bytes| {
        let mut script = Script::new(bytes);
        let base = script.choose(&PROFILES);
        let text = String::from_utf8_lossy(&script.mutate(base.as_bytes())).into_owned();
        match parse_profile(&text, "profile") {
            Ok(profile) => assert!(profile.settings().errors().is_empty()),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
        if let Err(error) = parse_physics(&text, "physics") {
            assert!(!error.to_string().is_empty());
        }
    });
}

#[test]
fn fuzz_sweeps() {
    attack(87, |bytes| {
        let mut script = Script::new(bytes);
        let base = script.choose(&SWEEPS);
        let mut mutated =
            |text: &str| String::from_utf8_lossy(&script.mutate(text.as_bytes())).into_owned();
        let (sweep, places) = (mutated(base), mutated(PLACES));
        let files = named_files(&sweep);
        let texts = SourceTexts {
            shooter: files.shooter.map(|_| PROFILES[0].to_owned()),
            places: files.places.map(|_| places.clone()),
            sweep,
        };
        match parse_sweep(&texts, "sweep") {
            Ok(config) => assert!(!config.places.is_empty()),
            Err(error) => assert!(!error.to_string().is_empty()),
        }
        if let Ok(locations) = parse_locations(&places) {
            let names = locations.names.len();
            assert!(names == 0 || names == locations.points_m.len());
        }
    });
}

#[test]
fn fuzz_releases() {
    let simulator = Simulator::new(&Physics::paper()).unwrap();
    attack(300, |bytes| {
        let mut script = Script::new(bytes);
        let text = script.mutate(RELEASES.as_bytes());
        let mut records = CsvRecords::new(&text[..]).unwrap();
        let mut rows = Vec::new();
        loop {
            let more = records.next_rows(3, MAX_RECORD_BYTES).unwrap();
            if more.is_empty() {
                break;
            }
            rows.extend(more);
        }
        // The lines are in order, and none is beyond the end.
        let ends = text.iter().filter(|byte| matches!(byte, b'\n' | b'\r'));
        let lines = 1 + ends.count() as u64;
        assert!(rows.windows(2).all(|pair| pair[0].number <= pair[1].number));
        assert!(rows.iter().all(|row| row.number <= lines));
        // Where every row can be read, the rows are those of the csv crate.
        if rows.iter().all(|row| row.cells.is_ok()) {
            let plain = csv::ReaderBuilder::new()
                .has_headers(false)
                .flexible(true)
                .from_reader(&text[..]);
            let plain: Vec<_> = plain.into_byte_records().map(Result::unwrap).collect();
            let ours: Vec<_> = rows.iter().map(|row| row.cells.clone().unwrap()).collect();
            assert_eq!(ours, plain);
        }
        let Some(Ok(header)) = rows.first().map(|row| row.cells.clone()) else {
            return;
        };
        let Ok(columns) = ReleaseColumns::new(&header, &[]) else {
            return;
        };
        for cells in rows.into_iter().skip(1).filter_map(|row| row.cells.ok()) {
            if let Ok(release) = columns.release(&cells, simulator.physics()) {
                let outcome = simulator.simulate(&release).unwrap();
                assert_eq!(outcome_cells(&outcome).len(), 8);
            }
        }
    });
}

/// The rows of the store that is mutated.
fn stored_rows() -> Vec<ResultRow> {
    let place = CourtPlace { x_m: 4.0, y_m: 1.0 };
    (0..3)
        .map(|job| ResultRow::failed(job, ShotKind::Bank, &place, &format!("reason {job}")))
        .collect()
}

/// The bytes of a store with a few rows.
static STORE: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("a.sqlite");
    let mut store = ResultStore::open(&path, "hash").unwrap();
    store.save_copies(&stored_rows()).unwrap();
    drop(store);
    std::fs::read(path).unwrap()
});

#[test]
fn fuzz_stores() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("fuzzed.sqlite");
    attack(2, |bytes| {
        std::fs::write(&path, Script::new(bytes).mutate(&STORE)).unwrap();
        // Damaged or not: never a result that was not saved.
        let saved = stored_rows();
        let _ = sqlite_results::read_rows(&path, "hash", 10, |row| {
            assert!(saved.contains(&row), "{row:?}");
        });
        let _ = ResultStore::open(&path, "hash");
    });
}

/// The slowest shot so far, microseconds, and the number of simulated shots.
static SLOWEST_US: AtomicU64 = AtomicU64::new(0);
static SIMULATED: AtomicU64 = AtomicU64::new(0);

#[test]
fn fuzz_physics() {
    attack(500, |bytes| {
        let mut script = Script::new(bytes);
        let physics = random_physics(&mut script);
        let Ok(simulator) = Simulator::new(&physics) else {
            return;
        };
        SIMULATED.fetch_add(4, Ordering::Relaxed);
        for _ in 0..4 {
            let release = random_release(&mut script, &physics);
            let outcome = simulator.simulate(&release).unwrap();
            let us = time_us(&simulator, &release);
            if SLOWEST_US.fetch_max(us, Ordering::Relaxed) < us && us > 5000 {
                println!(
                    "{} ms: {:?} {physics:?} {release:?}",
                    us / 1000,
                    outcome.verdict.ending
                );
            }
            assert!(
                outcome.verdict.time_s <= physics.time_limit_s * 1.001 + 1.0,
                "{:?} {physics:?} {release:?}",
                outcome.verdict
            );
            let state = release.state();
            let mut workspace = Default::default();
            let verdicts = simulator.verdicts(&[state], &mut workspace).unwrap();
            assert_eq!(verdicts[0], outcome.verdict);
        }
    });
    println!(
        "{} shots under accepted physics, the slowest in {:.1} ms",
        SIMULATED.load(Ordering::Relaxed),
        SLOWEST_US.load(Ordering::Relaxed) as f64 / 1000.0
    );
    // Only of optimised code.
    if cfg!(not(debug_assertions)) {
        assert!(SLOWEST_US.load(Ordering::Relaxed) < 50_000);
    }
}

/// The time of a shot, microseconds: the least of several if it seems long, for the machine may do
/// other work.
fn time_us(simulator: &Simulator, release: &Release) -> u64 {
    let once = || {
        let start = Instant::now();
        let _ = simulator.simulate(release);
        start.elapsed().as_micros() as u64
    };
    match once() {
        us if us < 5000 => us,
        us => (0..5).map(|_| once()).fold(us, u64::min),
    }
}

/// The paper's physics with some constants at random within their ranges or at their ends.
fn random_physics(script: &mut Script<'_>) -> Physics {
    let preset = &PRESETS[usize::from(script.byte()) % PRESETS.len()];
    let mut physics = preset.physics();
    let edge_radius_m = 0.03 * script.fraction();
    let constants: [(&mut f64, f64, f64); 21] = [
        (&mut physics.ball_radius_m, 0.01, 10.0),
        (&mut physics.ball_mass_kg, 0.001, 100.0),
        (&mut physics.inertia_ratio, 0.1, 1.0),
        (&mut physics.ring_radius_m, 0.01, 10.0),
        (&mut physics.board_distance_m, 0.01, 10.0),
        (&mut physics.board_width_m, 0.01, 10.0),
        (&mut physics.board_height_m, 0.01, 10.0),
        (&mut physics.gravity_m_s2, 0.01, 1000.0),
        (&mut physics.board_contact.stiffness_n_m, 0.1, 1e9),
        (&mut physics.board_contact.damping_kg_s, 1e-6, 1e6),
        (&mut physics.board_contact.friction, 1e-6, 10.0),
        (&mut physics.hoop_contact.stiffness_n_m, 0.1, 1e9),
        (&mut physics.hoop_contact.damping_kg_s, 1e-6, 1e6),
        (&mut physics.hoop_contact.friction, 1e-6, 10.0),
        (&mut physics.ring_tube_diameter_m, 1e-6, 0.5),
        (&mut physics.bracket_width_m, 1e-6, 1.0),
        (&mut physics.air.density_kg_m3, 1e-3, 10.0),
        (&mut physics.air.drag_coefficient, 1e-3, 5.0),
        (&mut physics.air.lift_slope, 1e-3, 2.0),
        (&mut physics.time_limit_s, 0.01, 60.0),
        (&mut physics.lodged_after_s, 1e-6, 60.0),
    ];
    for (constant, low, high) in constants {
        match script.byte() % 8 {
            1 => *constant = low,
            2 => *constant = high,
            3 => *constant = low * libm::pow(high / low, script.fraction()),
            4 | 5 => *constant *= 0.5 + script.fraction(),
            _ => {}
        }
    }
    match script.byte() % 16 {
        1 => physics = physics.with_contacts(|contact| contact.damping_kg_s = 0.0),
        2 => physics.bracket_width_m = 0.0,
        3 => physics.ring_tube_diameter_m = 0.0,
        4 => physics.air.density_kg_m3 = 0.0,
        5 => physics.board_edge = BoardEdge::None,
        6 => physics.board_edge = BoardEdge::Rounded { radius_m: 0.0 },
        7 => {
            physics.board_edge = BoardEdge::Rounded {
                radius_m: edge_radius_m,
            };
        }
        _ => {}
    }
    physics
}

/// Anywhere, or on the way to the hoop.
fn random_release(script: &mut Script<'_>, physics: &Physics) -> Release {
    let is_aimed = !script.byte().is_multiple_of(4);
    let mut between = |low: f64, high: f64| low + (high - low) * script.fraction();
    if is_aimed {
        let (distance_m, height_m) = (between(0.5, 8.0), between(-1.5, 0.5));
        let pitch_rad = between(0.5, 1.4);
        let over = distance_m * libm::tan(pitch_rad) + height_m;
        let g = physics.gravity_m_s2;
        let speed = distance_m / libm::cos(pitch_rad) * (0.5 * g / over.max(0.1)).sqrt();
        let court_angle_rad = between(-1.2, 1.2);
        return Release {
            distance_m,
            court_angle_rad,
            height_above_hoop_m: height_m,
            speed_m_s: speed * between(0.93, 1.1),
            pitch_rad,
            polar_rad: court_angle_rad + between(-0.08, 0.08),
            backspin_rad_s: between(-60.0, 60.0),
            rifle_spin_rad_s: between(-30.0, 30.0),
            side_spin_rad_s: between(-30.0, 30.0),
        };
    }
    Release {
        distance_m: between(0.1, 20.0),
        court_angle_rad: between(-1.5, 1.5),
        height_above_hoop_m: between(-3.0, 3.0),
        speed_m_s: between(0.0, 30.0),
        pitch_rad: between(-1.6, 1.6),
        polar_rad: between(-1.6, 1.6),
        backspin_rad_s: between(-200.0, 200.0),
        rifle_spin_rad_s: between(-200.0, 200.0),
        side_spin_rad_s: between(-200.0, 200.0),
    }
}

/// A small Parquet file: a text and a number.
static PARQUET: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let columns = [
        column("note", Physical::BYTE_ARRAY).unwrap(),
        column("speed_ft_s", Physical::DOUBLE).unwrap(),
    ];
    let mut sink = ParquetSink::new(Vec::new(), &columns).unwrap();
    for row in ["a,23.5", "b,", ",24"] {
        sink.push(row.split(',').collect::<Vec<_>>().into())
            .unwrap();
    }
    sink.finish().unwrap()
});

#[test]
fn fuzz_parquet() {
    let folder = tempfile::TempDir::new().unwrap();
    let path = folder.path().join("fuzzed.parquet");
    attack(1, |bytes| {
        std::fs::write(&path, Script::new(bytes).mutate(&PARQUET)).unwrap();
        let file = std::fs::File::open(&path).unwrap();
        if let Ok(mut rows) = ParquetRows::open(file) {
            while rows
                .next_rows(100, 1 << 20)
                .is_ok_and(|rows| !rows.is_empty())
            {}
        }
    });
}
