//! Maps over speed and pitch angle, and names in drawings.

use super::common::{grid, guard_on_the_wing, load, nominal, on_threads, with_search};
use bankshot::analysis::release_map::{ReleaseCells, probabilities};
use bankshot::best_shot;
use bankshot::plots::bank_direct_release_map;
use bankshot::plots::rasterise::to_png;
use bankshot::plots::shot_with_probability::PlottedShot;
use bankshot::plots::svg::{Anchor, Svg};
use bankshot::probability::{Sampler, Silent};
use bankshot::shooter::Nominal;
use bankshot::units::{DEGREE_RAD, FOOT_M};

#[test]
fn contract_a_map_of_release_space_is_the_same_on_any_number_of_threads() {
    let profile = with_search(&guard_on_the_wing(), grid(20, 12, 12, 4), 0.01);
    let shots = PlottedShot::of_best(&best_shot::find(&profile, &Silent).unwrap());
    let draw = || bank_direct_release_map::draw_probabilities(&profile, &shots).unwrap();
    let one = on_threads(1, draw);
    assert_eq!(one, on_threads(2, draw));
    let png = to_png(&one.svg, 1.0).unwrap();
    assert_eq!(png, to_png(&one.svg, 1.0).unwrap());
    assert!(png.len() > 10_000);
}

#[test]
fn val_p_of_a_release_map_is_p_of_its_shots() {
    // Against Sobol points, at nine cells about a good shot. The map's own error is about 0.003 in
    // a cell.
    let profile = load("free_throw");
    let shot = nominal(23.6, 53.5, 0.0, 3.0);
    let cells = ReleaseCells {
        speed_m_s: (23.0 * FOOT_M, 24.2 * FOOT_M),
        pitch_rad: (48.0 * DEGREE_RAD, 59.0 * DEGREE_RAD),
        columns: 120,
        rows: 90,
    };
    let map = probabilities(&profile, &shot, &cells);
    let sampler = Sampler::new(&profile);
    let mut mean_square = 0.0;
    for row in [15, 45, 75] {
        for column in [20, 60, 100] {
            let (speed_m_s, pitch_rad) = cells.centre(f64::from(column), f64::from(row));
            let at_cell = Nominal {
                speed_m_s,
                pitch_rad,
                ..shot
            };
            let p = sampler.estimate(&at_cell, 0.001, 3, &Silent).probability;
            let difference = map[(row * 120 + column) as usize] - p;
            assert!(difference.abs() < 0.02, "{column} {row}: {difference}");
            mean_square += difference * difference / 9.0;
        }
    }
    assert!(mean_square.sqrt() < 0.006, "{}", mean_square.sqrt());
}

#[test]
fn contract_names_cannot_break_a_drawing() {
    let name = "<script>alert(\"1\")</script> & 'x' \u{0} ]]> ".repeat(20);
    let mut drawing = Svg::new(300.0, 100.0);
    drawing.heading((10.0, 20.0), 14.0, Anchor::Start, &name);
    let text = drawing.finish(&name);
    assert!(!text.contains("<script"));
    assert!(to_png(&text, 1.0).is_ok());
}
