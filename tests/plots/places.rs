//! The picture and the table of the named places in docs/places.md. `examples/draw_places.rs`
//! writes them.

use bankshot::model::league_courts::League;
use bankshot::model::named_places::{NamedPlace, named_places};
use bankshot::units::{DEGREE_RAD, FOOT_M, at_most_two_decimals};
use std::fmt::Write;

/// Pixels of a metre, and the margin.
const SCALE: f64 = 44.0;
const MARGIN: f64 = 24.0;

/// The picture of a court.
pub(crate) fn draw() -> String {
    let court = League::Ncaa.court();
    let width = 2.0 * (SCALE * court.half_width_m + MARGIN);
    let far_m = court.three_radius_m + 0.8;
    let height = SCALE * (far_m - court.baseline_x_m) + 2.0 * MARGIN;
    let at = |x_m: f64, y_m: f64| {
        (
            0.5 * width + SCALE * y_m,
            MARGIN + SCALE * (x_m - court.baseline_x_m),
        )
    };
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" width=\"{width:.0}\" height=\"{height:.0}\" font-family=\"sans-serif\" font-size=\"13\">\n<title>The places of the NCAA court that have a name</title>\n<rect width=\"{width:.0}\" height=\"{height:.0}\" fill=\"#fff\"/>\n"
    );
    let mut line = |points: &[(f64, f64)]| {
        let points: Vec<String> = points
            .iter()
            .map(|(x, y)| at(*x, *y))
            .map(|(px, py)| format!("{px:.1},{py:.1}"))
            .collect();
        let points = points.join(" ");
        writeln!(
            svg,
            "<polyline points=\"{points}\" fill=\"none\" stroke=\"#999\"/>"
        )
        .unwrap();
    };
    let (base, lane, throw) = (
        court.baseline_x_m,
        court.lane_half_width_m,
        court.free_throw_x_m,
    );
    let wide = court.half_width_m;
    line(&[(far_m, -wide), (base, -wide), (base, wide), (far_m, wide)]);
    line(&[(base, -lane), (throw, -lane), (throw, lane), (base, lane)]);
    let arc = |middle_m: f64, radius_m: f64, half_angle: f64| -> Vec<(f64, f64)> {
        (-40..=40)
            .map(|step| half_angle * f64::from(step) / 40.0)
            .map(|angle| {
                (
                    middle_m + radius_m * libm::cos(angle),
                    radius_m * libm::sin(angle),
                )
            })
            .collect()
    };
    let corner = court.three_corner_y_m;
    let half = libm::atan2(corner, court.three_break_x_m());
    let mut three = vec![(base, -corner)];
    three.extend(arc(0.0, court.three_radius_m, half));
    three.push((base, corner));
    line(&three);
    line(&arc(
        throw,
        court.circle_radius_m,
        0.5 * std::f64::consts::PI,
    ));
    line(&arc(0.0, 0.24, std::f64::consts::PI));
    line(&[(-0.381, -0.914), (-0.381, 0.914)]);
    for place in named_places(League::Ncaa) {
        let (x, y) = at(place.x_m, place.y_m);
        // The side is plain from the picture; on the right the label has room within the lane.
        let name = place.name.trim_start_matches("left ");
        let name = match place.name.strip_prefix("right ") {
            Some(_) => "",
            None => name,
        };
        writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" fill=\"#0072b2\"/>"
        )
        .unwrap();
        writeln!(
            svg,
            "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" fill=\"#222\">{name}</text>",
            if name == "baseline" {
                y + 20.0
            } else {
                y - 9.0
            }
        )
        .unwrap();
    }
    svg + "</svg>\n"
}

/// The table: distance and court angle on each court, and the source.
pub(crate) fn table() -> String {
    let mut text = String::from(
        "| place | NCAA | NBA | FIBA | high school | source |\n|---|---|---|---|---|---|\n",
    );
    let all: Vec<Vec<NamedPlace>> = League::ALL.into_iter().map(named_places).collect();
    for (number, place) in all[0].iter().enumerate() {
        if place.name.starts_with("left ") {
            continue;
        }
        let cells: Vec<String> = all
            .iter()
            .zip(League::ALL)
            .map(|(places, league)| {
                let of = &places[number];
                let distance_m = libm::hypot(of.x_m, of.y_m);
                let distance = match league {
                    League::Fiba => format!("{distance_m:.2} m"),
                    _ => format!("{} ft", at_most_two_decimals(distance_m / FOOT_M)),
                };
                match of.y_m == 0.0 {
                    true => distance,
                    false => format!(
                        "{distance}, {:.0} deg",
                        libm::atan2(of.y_m, of.x_m) / DEGREE_RAD
                    ),
                }
            })
            .collect();
        let name = place.name.trim_start_matches("right ");
        writeln!(
            text,
            "| {name} | {} | {} |",
            cells.join(" | "),
            place.of.source()
        )
        .unwrap();
    }
    text
}
