//! Pictures: the same bytes at any time and thread count, none of the docs' stale, no name that breaks them.

mod common;

use bankshot::dynamics::Simulator;
use bankshot::picture::sweep_maps::{Picture, Sweep};
use bankshot::picture::{comparison, figures, report, svg};
use bankshot::probability::estimate::Sampler;
use bankshot::probability::release_map::{Cells, probabilities};
use bankshot::probability::{Silent, best};
use bankshot::sweep::Configuration;
use bankshot::sweep::configuration::{Texts, parse_sweep};
use bankshot::sweep::jobs::Jobs;
use bankshot::sweep::row::{COLUMNS, Cell, Row, place_of};
use bankshot::sweep::run::evaluate;
use bankshot::units::DEGREE_RAD;
use common::{load, nominal};
use std::collections::BTreeMap;
use std::fs;

fn on(threads: usize, draw: impl FnOnce() -> Vec<Picture> + Send) -> Vec<Picture> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(draw)
}

#[test]
fn contract_the_figures_of_the_docs_are_not_stale() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/pictures");
    let one = on(1, || figures::all().unwrap());
    assert_eq!(one, on(3, || figures::all().unwrap()));
    assert_eq!(one.len(), 9);
    for picture in one {
        let path = format!("{folder}/{}.svg", picture.name);
        let kept = fs::read_to_string(&path).unwrap_or_default();
        // Not assert_eq: a page of differences would help nobody.
        assert!(
            kept == picture.svg,
            "{path} is stale: run `bankshot figures --out docs/pictures`"
        );
    }
}

#[test]
fn contract_a_map_of_release_space_is_the_same_on_any_thread_count() {
    let mut profile = load("bank_wing");
    profile.grid = bankshot::profile::Grid {
        speed: 20,
        pitch: 12,
        polar: 12,
        backspin: 4,
    };
    profile.search.standard_error = 0.01;
    let simulator = Simulator::new(&profile.physics).unwrap();
    let shots = report::shots_of(&profile, &best::find(&profile, &Silent).unwrap());
    let draw = || vec![comparison::in_release_space(&profile, &simulator, &shots).unwrap()];
    let one = on(1, draw);
    assert_eq!(one, on(2, draw));
    let png = svg::to_png(&one[0].svg, 1.0).unwrap();
    assert_eq!(png, svg::to_png(&one[0].svg, 1.0).unwrap());
    assert!(png.len() > 10_000);
}

#[test]
fn val_p_over_release_space_is_p_of_its_shots() {
    // Against Sobol, at nine cells about a good shot: the map's own error is about 0.003 a cell.
    let profile = load("free_throw");
    let simulator = Simulator::new(&profile.physics).unwrap();
    let shot = nominal(23.6, 53.5, 0.0, 3.0);
    let cells = Cells {
        speed_m_s: (23.0 * 0.3048, 24.2 * 0.3048),
        pitch_rad: (48.0 * DEGREE_RAD, 59.0 * DEGREE_RAD),
        columns: 120,
        rows: 90,
    };
    let map = probabilities(&profile, &simulator, &shot, &cells);
    let sampler = Sampler::new(&profile, &simulator);
    let mut square = 0.0;
    for (column, row) in [
        (20, 15),
        (60, 15),
        (100, 15),
        (20, 45),
        (60, 45),
        (100, 45),
        (20, 75),
        (60, 75),
        (100, 75),
    ] {
        let (speed_m_s, pitch_rad) = cells.at(f64::from(column), f64::from(row));
        let at = bankshot::profile::Nominal {
            speed_m_s,
            pitch_rad,
            ..shot
        };
        let p = sampler.estimate(&at, 0.001, 3, &Silent).probability;
        let by = map[(row * 120 + column) as usize] - p;
        assert!(by.abs() < 0.02, "{column} {row}: {by}");
        square += by * by / 9.0;
    }
    assert!(square.sqrt() < 0.006, "{}", square.sqrt());
}

#[test]
fn contract_names_cannot_break_a_picture() {
    let evil = "<script>alert(\"1\")</script> & 'x' \u{0} ]]> ".repeat(20);
    let mut drawing = svg::Svg::new(300.0, 100.0);
    drawing.heading((10.0, 20.0), 14.0, svg::Anchor::Start, &evil);
    let text = drawing.finish(&evil);
    assert!(!text.contains("<script"));
    assert!(svg::to_png(&text, 1.0).is_ok());
}

/// The results behind `docs/pictures/bank_and_direct.svg`, SI units, from `bankshot sweep configs/half_court.toml`:
/// `SELECT job, kind, status, probability, standard_error, pitch_rad, backspin_rad_s FROM results ORDER BY job`.
fn half_court_rows() -> BTreeMap<u64, Row> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/data/half_court.csv");
    let mut reader = csv::Reader::from_path(path).unwrap();
    let columns = [
        "kind",
        "status",
        "probability",
        "standard_error",
        "pitch",
        "backspin",
    ];
    reader
        .records()
        .map(|record| {
            let record = record.unwrap();
            let job = record[0].parse().unwrap();
            let mut cells = vec![Cell::Null; COLUMNS.len()];
            for (i, name) in columns.into_iter().enumerate() {
                let text = &record[i + 1];
                cells[place_of(name)] = match text.parse::<f64>() {
                    Ok(value) => Cell::Real(value),
                    Err(_) if text.is_empty() => Cell::Null,
                    Err(_) => Cell::Text(text.to_owned()),
                };
            }
            (job, Row { job, cells })
        })
        .collect()
}

fn half_court() -> Configuration {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/configs");
    let read = |name: &str| fs::read_to_string(format!("{folder}/{name}")).unwrap();
    let texts = Texts {
        sweep: read("half_court.toml"),
        shooter: Some(read("free_throw.toml")),
        places: None,
    };
    parse_sweep(&texts, "half_court.toml").unwrap()
}

#[test]
fn contract_the_map_of_the_half_court_is_not_stale() {
    let configuration = half_court();
    let rows = half_court_rows();
    let jobs = Jobs::new(&configuration);
    assert_eq!(rows.len(), jobs.count());
    // The results: two places computed again, bit for bit.
    for place in [101, 303] {
        for (kind, row) in evaluate(&configuration, &jobs, place, &[0, 1])
            .unwrap()
            .iter()
            .enumerate()
        {
            let kept = &rows[&jobs.number(place, kind)];
            for name in [
                "kind",
                "status",
                "probability",
                "standard_error",
                "pitch",
                "backspin",
            ] {
                assert_eq!(
                    kept.get(name),
                    row.get(name),
                    "docs/data/half_court.csv is stale"
                );
            }
        }
    }
    // The drawing.
    let picture = Sweep::new(&configuration, &rows).bank_and_direct().unwrap();
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/docs/pictures/bank_and_direct.svg"
    );
    let stale = "is stale: run `cargo test --test pictures -- --ignored` and look at it";
    assert!(
        fs::read_to_string(path).unwrap_or_default() == picture.svg,
        "{path} {stale}"
    );
}

#[test]
#[ignore = "writes docs/pictures/bank_and_direct.svg from docs/data/half_court.csv"]
fn campaign_draw_the_half_court() {
    let picture = Sweep::new(&half_court(), &half_court_rows())
        .bank_and_direct()
        .unwrap();
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/docs/pictures/bank_and_direct.svg"
    );
    fs::write(path, picture.svg).unwrap();
}

#[test]
fn contract_the_pictures_of_the_tutorial_are_not_stale() {
    let root = env!("CARGO_MANIFEST_DIR");
    let folder = tempfile::TempDir::new().unwrap();
    let status = std::process::Command::new("sh")
        .arg(format!("{root}/docs/pictures/redraw.sh"))
        .arg(folder.path())
        .env("BANKSHOT", env!("CARGO_BIN_EXE_bankshot"))
        .status()
        .unwrap();
    assert!(status.success());
    for name in ["tutorial_before.svg", "tutorial_after.svg"] {
        let kept = fs::read_to_string(format!("{root}/docs/pictures/{name}")).unwrap_or_default();
        let drawn = fs::read_to_string(folder.path().join(name)).unwrap();
        assert!(
            kept == drawn,
            "{name} is stale: run docs/pictures/redraw.sh"
        );
    }
}
