//! The lines of the court, the board and the ring from above.

use super::axes::Axes;
use super::svg::{FAINT, INK, Svg};
use crate::model::Physics;
use crate::model::league_courts::Court;
use std::f64::consts::PI;

/// Segments of an arc.
const ARC_SEGMENTS: i32 = 72;
const SOLID: &str = "stroke-width=\"1\" fill=\"none\"";
const DASHED: &str = "stroke-width=\"1\" stroke-dasharray=\"4 4\" fill=\"none\"";

/// A pen that draws in metres on the court.
struct CourtPen<'a> {
    svg: &'a mut Svg,
    axes: &'a Axes,
    /// Size of the unit of the axes, m.
    unit_m: f64,
}

impl CourtPen<'_> {
    fn line(&mut self, points: impl IntoIterator<Item = (f64, f64)>, style: &str) {
        let (axes, unit_m) = (self.axes, self.unit_m);
        let pixels = points
            .into_iter()
            .map(|(x, y)| axes.pixel((y / unit_m, x / unit_m)));
        self.svg.polyline(pixels, style);
    }
}

/// Points of an arc about a point on the middle line of the court; angles from the x axis, rad.
fn arc(centre_x_m: f64, radius_m: f64, (from, to): (f64, f64)) -> impl Iterator<Item = (f64, f64)> {
    (0..=ARC_SEGMENTS).map(move |i| {
        let angle = from + (to - from) * f64::from(i) / f64::from(ARC_SEGMENTS);
        let (sin, cos) = libm::sincos(angle);
        (centre_x_m + radius_m * cos, radius_m * sin)
    })
}

/// Draws the lines of the court in a colour, the board and the ring; `unit_m` is the unit of the
/// axes.
pub(super) fn draw_court_lines(
    svg: &mut Svg,
    (axes, unit_m): (&Axes, f64),
    ink: &str,
    court: &Court,
    physics: &Physics,
) {
    let mut pen = CourtPen { svg, axes, unit_m };
    let solid = format!("stroke=\"{ink}\" {SOLID}");
    draw_lane(&mut pen, court, &solid);
    let towards_midcourt = (-0.5 * PI, 0.5 * PI);
    let towards_board = (0.5 * PI, 1.5 * PI);
    pen.line(
        arc(0.0, court.restricted_radius_m, towards_midcourt),
        &solid,
    );
    draw_three_point_line(&mut pen, court, &solid);
    draw_board_and_ring(&mut pen, physics);
    let midcourt_circle = arc(court.half_line_x_m, court.circle_radius_m, towards_board);
    pen.line(midcourt_circle, &solid);
}

/// The lane and the circle at the free-throw line, whose half towards the board is dashed.
fn draw_lane(pen: &mut CourtPen<'_>, court: &Court, solid: &str) {
    let half_width = court.lane_half_width_m;
    let (baseline, line) = (court.baseline_x_m, court.free_throw_x_m);
    let corners = [
        (baseline, -half_width),
        (line, -half_width),
        (line, half_width),
        (baseline, half_width),
    ];
    pen.line(corners, solid);
    let radius = court.circle_radius_m;
    pen.line(arc(line, radius, (-0.5 * PI, 0.5 * PI)), solid);
    let dashed = format!("stroke=\"{FAINT}\" {DASHED}");
    pen.line(arc(line, radius, (0.5 * PI, 1.5 * PI)), &dashed);
}

fn draw_three_point_line(pen: &mut CourtPen<'_>, court: &Court, style: &str) {
    let corner_y = court.three_corner_y_m;
    let end = libm::atan2(corner_y, court.three_break_x_m());
    let mut points = vec![(court.baseline_x_m, -corner_y)];
    points.extend(arc(0.0, court.three_radius_m, (-end, end)));
    points.push((court.baseline_x_m, corner_y));
    pen.line(points, style);
}

fn draw_board_and_ring(pen: &mut CourtPen<'_>, physics: &Physics) {
    let half_width = 0.5 * physics.board_width_m;
    let face_x = -physics.board_distance_m;
    let board = format!("stroke=\"{INK}\" stroke-width=\"3\" fill=\"none\"");
    pen.line([(face_x, -half_width), (face_x, half_width)], &board);
    let ring = "stroke=\"#d55e00\" stroke-width=\"2\" fill=\"none\"";
    pen.line(arc(0.0, physics.ring_radius_m, (0.0, 2.0 * PI)), ring);
}
