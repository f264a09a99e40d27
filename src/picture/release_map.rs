//! Maps over speed and pitch angle: how shots end, and P.

use super::colours::{MADE, NOTHING, of_kind, sequential};
use super::frame::{Frame, colour_bar, legend};
use super::svg::Svg;
use crate::dynamics::Kind;
use crate::probability::release_map::Cells;
use crate::units::{DEGREE_RAD, System};

/// Size of a map, pixels.
pub const SIZE: (f64, f64) = (400.0, 300.0);
/// The whole size of a map with its axes and its key, pixels.
pub const WHOLE: (f64, f64) = (70.0 + SIZE.0 + 150.0, 34.0 + SIZE.1 + 52.0);

/// The frame of a map whose whole size begins at a corner.
#[must_use]
pub fn frame(corner: (f64, f64), cells: &Cells, units: System) -> Frame {
    let (_, foot) = units.length();
    Frame {
        corner: (corner.0 + 70.0, corner.1 + 34.0),
        size: SIZE,
        x: (cells.speed_m_s.0 / foot, cells.speed_m_s.1 / foot),
        y: (
            cells.pitch_rad.0 / DEGREE_RAD,
            cells.pitch_rad.1 / DEGREE_RAD,
        ),
    }
}

fn draw(
    svg: &mut Svg,
    frame: &Frame,
    cells: &Cells,
    title: &str,
    units: System,
    colours: &[[u8; 3]],
) {
    // Pictures begin at the top, maps at the lowest pitch angle.
    let pixels: Vec<[u8; 4]> = colours
        .chunks(cells.columns)
        .rev()
        .flatten()
        .map(|[r, g, b]| [*r, *g, *b, 255])
        .collect();
    svg.pixels(
        frame.corner,
        frame.size,
        (cells.columns, cells.rows),
        &pixels,
    );
    let (long, _) = units.length();
    frame.axes(
        svg,
        title,
        &format!("speed ({long}/s)"),
        "pitch angle (deg)",
    );
}

/// Draws how shots end, as the paper's Figs. 12 to 15.
pub fn of_outcomes(
    svg: &mut Svg,
    corner: (f64, f64),
    title: &str,
    cells: &Cells,
    units: System,
    kinds: &[Kind],
) {
    let frame = frame(corner, cells, units);
    let colours: Vec<[u8; 3]> = kinds.iter().map(|&kind| of_kind(kind)).collect();
    draw(svg, &frame, cells, title, units, &colours);
    let mut names: Vec<(String, [u8; 3])> = MADE
        .iter()
        .filter(|(kind, _, _)| kinds.contains(kind))
        .map(|(_, name, colour)| ((*name).to_owned(), *colour))
        .collect();
    names.push(("missed".to_owned(), NOTHING));
    legend(svg, (frame.end().0 + 14.0, frame.corner.1 + 10.0), &names);
}

/// Draws P.
pub fn of_probabilities(
    svg: &mut Svg,
    corner: (f64, f64),
    title: &str,
    cells: &Cells,
    units: System,
    values: &[f64],
) {
    let colours: Vec<[u8; 3]> = values.iter().map(|&p| sequential(p)).collect();
    of_values(
        svg,
        corner,
        title,
        (cells, units),
        &colours,
        ("P", (0.0, 1.0)),
        sequential,
    );
}

/// Draws any colours with a bar that explains them.
pub fn of_values(
    svg: &mut Svg,
    corner: (f64, f64),
    title: &str,
    (cells, units): (&Cells, System),
    colours: &[[u8; 3]],
    (name, range): (&str, (f64, f64)),
    colour: impl Fn(f64) -> [u8; 3],
) {
    let frame = frame(corner, cells, units);
    draw(svg, &frame, cells, title, units, colours);
    let beside = (frame.end().0 + 16.0, frame.corner.1 + 18.0);
    colour_bar(svg, beside, 220.0, range, name, colour);
}
