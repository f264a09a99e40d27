//! The plots of `docs/pictures` are up to date.

use super::common::on_threads;
use super::half_court::{HalfCourt, result_columns};
use bankshot::plots::paper_figures;
use bankshot::plots::sweep_bank_direct_map;
use bankshot::plots::sweep_results::SweepResults;
use bankshot::probability::Silent;
use bankshot::sweep::job_list::Jobs;
use bankshot::sweep::run::compute_jobs;
use std::fs;
use std::process::Command;

const PICTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/pictures");

/// Checks that `docs/pictures/NAME.svg` is equal to `drawn`.
#[track_caller]
fn assert_up_to_date(name: &str, drawn: &str) {
    let path = format!("{PICTURES}/{name}.svg");
    let kept = fs::read_to_string(&path).unwrap_or_default();
    // assert_eq would print a page of differences.
    assert!(
        kept == drawn,
        "{path} is out of date: run docs/pictures/redraw.sh and look at it"
    );
}

#[test]
fn contract_the_paper_figures_of_the_docs_are_up_to_date_on_any_number_of_threads() {
    let one = on_threads(1, || paper_figures::draw_all().unwrap());
    assert_eq!(one, on_threads(3, || paper_figures::draw_all().unwrap()));
    assert_eq!(one.len(), 9);
    for plot in one {
        assert_up_to_date(&plot.name, &plot.svg);
    }
}

#[test]
fn contract_the_half_court_map_of_the_docs_is_up_to_date() {
    let HalfCourt { config, rows } = HalfCourt::load();
    let results = SweepResults::new(&config, &rows);
    let plot = sweep_bank_direct_map::draw(&results).unwrap();
    assert_up_to_date("bank_and_direct", &plot.svg);
}

#[test]
fn contract_the_terminal_of_the_readme_is_up_to_date() {
    assert_up_to_date("terminal", &super::terminal::draw().unwrap());
}

#[test]
fn contract_the_half_court_results_of_the_docs_are_up_to_date() {
    let HalfCourt { config, rows } = HalfCourt::load();
    let columns = result_columns();
    let jobs = Jobs::new(&config);
    assert_eq!(rows.len(), jobs.count());
    // One spot computed again, bit for bit.
    let spot = 303;
    let computed = compute_jobs(&config, &jobs, spot, &[0, 1], &Silent).unwrap();
    assert_eq!(computed.len(), 2);
    for (kind, row) in computed.iter().enumerate() {
        let kept = &rows[&jobs.number(spot, kind)];
        for &column in &columns {
            assert_eq!(
                kept.cells()[column],
                row.cells()[column],
                "docs/data/half_court.csv is out of date"
            );
        }
    }
}

#[test]
fn contract_the_plots_of_the_tutorial_are_up_to_date() {
    let folder = tempfile::TempDir::new().unwrap();
    let status = Command::new("sh")
        .arg(format!("{PICTURES}/redraw.sh"))
        .arg(folder.path())
        .env("BANKSHOT", env!("CARGO_BIN_EXE_bankshot"))
        .status()
        .unwrap();
    assert!(status.success());
    for name in [
        "tutorial_before",
        "tutorial_after",
        "make_zone",
        "reliability",
    ] {
        let drawn = fs::read_to_string(folder.path().join(format!("{name}.svg")));
        assert_up_to_date(name, &drawn.unwrap());
    }
}

/// The picture and the table of docs/places.md are those of the program's places.
#[test]
fn contract_the_named_places_are_up_to_date() {
    assert_up_to_date("places", &super::places::draw());
    let page = std::fs::read_to_string("docs/places.md").unwrap();
    assert!(
        page.contains(&super::places::table()),
        "run the example draw_places"
    );
}
