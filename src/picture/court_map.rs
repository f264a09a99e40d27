//! Values over the court, drawn with its lines: seen from above, the hoop at the top, the shooter's right on
//! the right.

use super::colours::NOTHING;
use super::frame::{Frame, colour_bar, hex, legend};
use super::svg::{Anchor, FAINT, INK, Svg};
use crate::court::Court;
use crate::physics::Physics;
use crate::units::System;

/// A place and its colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// From the board to the court, m.
    pub x_m: f64,
    /// Across, m.
    pub y_m: f64,
    /// Its colour; none where there is nothing to show.
    pub colour: Option<[u8; 3]>,
}

/// What explains the colours.
pub enum Key<'a> {
    /// A scale from the first to the last value, with its name.
    Bar(&'a str, (f64, f64), &'a dyn Fn(f64) -> [u8; 3]),
    /// Names.
    Names(&'a [(String, [u8; 3])]),
}

/// What all maps of a picture share.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a> {
    /// The lines.
    pub court: &'a Court,
    /// The board and the ring.
    pub physics: &'a Physics,
    /// Units of the axes.
    pub units: System,
    /// Distance of neighbours, m; none where the places are no grid.
    pub step_m: Option<f64>,
    /// Farthest place from the baseline, m.
    pub far_x_m: f64,
}

/// Width of a map, pixels.
pub const WIDTH: f64 = 400.0;
/// Room beside a map for its axis and for its key, pixels.
pub const BESIDE: (f64, f64) = (70.0, 120.0);
/// Room above and below a map, pixels.
pub const ABOVE_BELOW: (f64, f64) = (34.0, 52.0);

impl Ground<'_> {
    /// The frame of a map at a corner, in the units of the axes.
    #[must_use]
    pub fn frame(&self, corner: (f64, f64)) -> Frame {
        let (_, foot) = self.units.length();
        let court = self.court;
        let far = (self.far_x_m + 1.0).min(court.half_line_x_m);
        let y = (-court.half_width_m / foot, court.half_width_m / foot);
        let x = (far / foot, court.baseline_x_m / foot);
        Frame::to_scale(corner, WIDTH, y, x)
    }

    /// The whole size of a map with its axes and its key, pixels.
    #[must_use]
    pub fn size(&self) -> (f64, f64) {
        let frame = self.frame((0.0, 0.0));
        (
            BESIDE.0 + frame.size.0 + BESIDE.1,
            ABOVE_BELOW.0 + frame.size.1 + ABOVE_BELOW.1,
        )
    }

    /// Draws a map whose whole size begins at a corner.
    pub fn draw(
        &self,
        svg: &mut Svg,
        corner: (f64, f64),
        title: &str,
        spots: &[Spot],
        key: &Key<'_>,
    ) {
        let frame = self.frame((corner.0 + BESIDE.0, corner.1 + ABOVE_BELOW.0));
        let (long, foot) = self.units.length();
        svg.clipped(frame.corner, frame.size, |svg| {
            for spot in spots {
                let colour = hex(spot.colour.unwrap_or(NOTHING));
                let at = frame.at((spot.y_m / foot, spot.x_m / foot));
                if let Some(step_m) = self.step_m {
                    let side = frame.length(step_m / foot);
                    // A little larger, so that no seams show.
                    let corner = (at.0 - 0.5 * side - 0.1, at.1 - 0.5 * side - 0.1);
                    svg.rect(
                        corner,
                        (side + 0.2, side + 0.2),
                        &format!("fill=\"{colour}\" shape-rendering=\"crispEdges\""),
                    );
                } else {
                    let style = format!("fill=\"{colour}\" stroke=\"{INK}\" stroke-width=\"0.5\"");
                    svg.circle(at, 6.0, &style);
                }
            }
            self.lines(svg, &frame);
        });
        frame.axes(
            svg,
            title,
            &format!("across, right facing the board ({long})"),
            &format!("from the hoop's centre ({long})"),
        );
        let (right, _) = frame.end();
        let beside = (right + 16.0, frame.corner.1 + 18.0);
        match key {
            Key::Bar(name, range, colour) => {
                let height = (frame.size.1 - 40.0).min(220.0);
                colour_bar(svg, beside, height, *range, name, colour);
            }
            Key::Names(names) => legend(svg, beside, names),
        }
    }

    /// Draws the border of an area: the sides of its squares at which it ends.
    pub fn outline(&self, svg: &mut Svg, corner: (f64, f64), inside: &[(f64, f64)]) {
        let Some(step_m) = self.step_m else { return };
        let frame = self.frame((corner.0 + BESIDE.0, corner.1 + ABOVE_BELOW.0));
        let (_, foot) = self.units.length();
        let cell = |v: f64| (v / step_m).round() as i64;
        let cells: std::collections::BTreeSet<(i64, i64)> =
            inside.iter().map(|&(x, y)| (cell(x), cell(y))).collect();
        let at = |i: f64, j: f64| frame.at((j * step_m / foot, i * step_m / foot));
        let style =
            format!("stroke=\"{INK}\" stroke-width=\"2\" fill=\"none\" stroke-linecap=\"square\"");
        svg.clipped(frame.corner, frame.size, |svg| {
            for &(i, j) in &cells {
                let (x, y) = (i as f64, j as f64);
                for (neighbour, from, to) in [
                    ((i - 1, j), (x - 0.5, y - 0.5), (x - 0.5, y + 0.5)),
                    ((i + 1, j), (x + 0.5, y - 0.5), (x + 0.5, y + 0.5)),
                    ((i, j - 1), (x - 0.5, y - 0.5), (x + 0.5, y - 0.5)),
                    ((i, j + 1), (x - 0.5, y + 0.5), (x + 0.5, y + 0.5)),
                ] {
                    if !cells.contains(&neighbour) {
                        svg.polyline([at(from.0, from.1), at(to.0, to.1)], &style);
                    }
                }
            }
        });
    }

    fn lines(&self, svg: &mut Svg, frame: &Frame) {
        let (_, foot) = self.units.length();
        let court = self.court;
        let at = |x: f64, y: f64| frame.at((y / foot, x / foot));
        let style = format!("stroke=\"{INK}\" stroke-width=\"1\" fill=\"none\"");
        let arc = |centre_x: f64, radius: f64, from: f64, to: f64| {
            (0..=72).map(move |i| {
                let angle = from + (to - from) * f64::from(i) / 72.0;
                let (sin, cos) = libm::sincos(angle);
                (centre_x + radius * cos, radius * sin)
            })
        };
        let mut draw = |points: Vec<(f64, f64)>, style: &str| {
            svg.polyline(points.into_iter().map(|(x, y)| at(x, y)), style);
        };
        let pi = std::f64::consts::PI;
        let lane = court.lane_half_width_m;
        let (base, line) = (court.baseline_x_m, court.free_throw_x_m);
        draw(
            vec![(base, -lane), (line, -lane), (line, lane), (base, lane)],
            &style,
        );
        draw(
            arc(line, court.circle_radius_m, -0.5 * pi, 0.5 * pi).collect(),
            &style,
        );
        let dashed =
            format!("stroke=\"{FAINT}\" stroke-width=\"1\" stroke-dasharray=\"4 4\" fill=\"none\"");
        draw(
            arc(line, court.circle_radius_m, 0.5 * pi, 1.5 * pi).collect(),
            &dashed,
        );
        draw(
            arc(0.0, court.restricted_radius_m, -0.5 * pi, 0.5 * pi).collect(),
            &style,
        );
        let corner = court.three_corner_y_m;
        let turn = libm::atan2(corner, court.three_break_x_m());
        let mut three = vec![(base, -corner)];
        three.extend(arc(0.0, court.three_radius_m, -turn, turn));
        three.push((base, corner));
        draw(three, &style);
        let half = 0.5 * self.physics.board_width_m;
        let board = -self.physics.board_distance_m;
        let thick = format!("stroke=\"{INK}\" stroke-width=\"3\" fill=\"none\"");
        draw(vec![(board, -half), (board, half)], &thick);
        let ring = "stroke=\"#d55e00\" stroke-width=\"2\" fill=\"none\"";
        draw(
            arc(0.0, self.physics.ring_radius_m, 0.0, 2.0 * pi).collect(),
            ring,
        );
        draw(
            arc(
                court.half_line_x_m,
                court.circle_radius_m,
                0.5 * pi,
                1.5 * pi,
            )
            .collect(),
            &style,
        );
    }
}

/// A line under a picture that says where it comes from.
pub fn footnote(svg: &mut Svg, at: (f64, f64), text: &str) {
    svg.text(at, 11.0, Anchor::Start, text);
}
