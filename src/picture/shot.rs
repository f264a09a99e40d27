//! One shot, or a swarm of them, from the side, from above, and facing the board.

use super::frame::Frame;
use super::svg::{Anchor, FAINT, INK, Svg, shortened};
use super::sweep_maps::Picture;
use crate::dynamics::{EventKind, Touched, Trace, Triple};
use crate::physics::Physics;
use crate::units::System;

/// A path to draw.
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    /// The shot.
    pub trace: &'a Trace,
    /// Its colour.
    pub colour: &'static str,
    /// Do its events get marks, and the ball its outline?
    pub in_full: bool,
}

/// Colours of made and missed shots.
pub const MADE: &str = "#0072b2";
/// See [`MADE`].
pub const MISSED: &str = "#d55e00";

/// Two of the three coordinates.
type View = fn(Triple<f64>) -> (f64, f64);

/// Draws paths in three views.
#[must_use]
pub fn three_views(
    name: &str,
    title: &str,
    note: &str,
    physics: &Physics,
    units: System,
    paths: &[Path<'_>],
) -> Picture {
    let (long, foot) = units.length();
    let radius = physics.ball_radius_m;
    let mut reach = [(f64::INFINITY, f64::NEG_INFINITY); 3];
    for path in paths {
        for sample in &path.trace.samples {
            let Triple(x, y, z) = sample.state.position_m;
            for (range, v) in reach.iter_mut().zip([x, y, z]) {
                *range = (range.0.min(v - radius), range.1.max(v + radius));
            }
        }
    }
    // The board and the ring are always to be seen.
    let board = physics.board_centre_height_m + 0.5 * physics.board_height_m;
    let half = 0.5 * physics.board_width_m;
    let face = -physics.board_distance_m;
    let widen = |range: (f64, f64), low: f64, high: f64| (range.0.min(low), range.1.max(high));
    let x = widen(reach[0], face - 0.3, 2.0 * physics.ring_radius_m);
    let y = widen(reach[1], -half - 0.2, half + 0.2);
    let z = widen(reach[2], -0.8, board + 0.2);
    let near_z = (-0.8, board + 0.6);
    let scale = |range: (f64, f64)| (range.0 / foot, range.1 / foot);
    let side = within((75.0, 70.0), (520.0, 380.0), scale(x), scale(z));
    let above = within(
        (75.0, side.end().1 + 90.0),
        (520.0, 400.0),
        scale(x),
        scale(y),
    );
    let near_y = (-half - 0.2, half + 0.2);
    let front = Frame::to_scale((690.0, 70.0), 330.0, scale(near_y), scale(near_z));
    let close = Frame::to_scale(
        (690.0, front.end().1 + 90.0),
        330.0,
        scale(near_y),
        scale((face - 0.15, 0.9)),
    );
    let height = above.end().1.max(close.end().1) + 75.0;
    let mut svg = Svg::new(1060.0, height);
    svg.heading((20.0, 26.0), 16.0, Anchor::Start, &shortened(title, 100));
    let from_side: View = |Triple(x, _, z)| (x, z);
    let from_above: View = |Triple(x, y, _)| (x, y);
    let facing: View = |Triple(_, y, z)| (y, z);
    let near_above: View = |Triple(x, y, _)| (y, x);
    let ink = format!("stroke=\"{INK}\" stroke-width=\"2.5\" fill=\"none\"");
    let ring = "stroke=\"#cc3311\" stroke-width=\"2.5\" fill=\"none\"";
    let ring_radius = physics.ring_radius_m;
    let low = physics.board_centre_height_m - 0.5 * physics.board_height_m;
    let circle = |swap: bool| {
        (0..=60).map(move |i| {
            let (sin, cos) = libm::sincos(f64::from(i) * std::f64::consts::TAU / 60.0);
            let (a, b) = (ring_radius * cos, ring_radius * sin);
            if swap { (b, a) } else { (a, b) }
        })
    };
    for (frame, view, title, x_name, y_name, furniture) in [
        (
            &side,
            from_side,
            "from the side",
            "from the hoop",
            "above the ring",
            0,
        ),
        (
            &above,
            from_above,
            "from above",
            "from the hoop",
            "across",
            1,
        ),
        (
            &front,
            facing,
            "facing the board",
            "across",
            "above the ring",
            2,
        ),
        (
            &close,
            near_above,
            "the ring from above",
            "across",
            "from the hoop",
            3,
        ),
    ] {
        let at = |(a, b): (f64, f64)| frame.at((a / foot, b / foot));
        frame.grid(&mut svg);
        svg.clipped(frame.corner, frame.size, |svg| {
            match furniture {
                0 => {
                    svg.polyline([at((face, low)), at((face, board))], &ink);
                    svg.polyline([at((-ring_radius, 0.0)), at((ring_radius, 0.0))], ring);
                }
                1 => {
                    svg.polyline([at((face, -half)), at((face, half))], &ink);
                    svg.polyline(circle(false).map(at), ring);
                }
                2 => {
                    let corners = [(-half, low), (half, low), (half, board), (-half, board), (-half, low)];
                    svg.polyline(corners.map(at), &ink);
                    svg.polyline([at((-ring_radius, 0.0)), at((ring_radius, 0.0))], ring);
                }
                _ => {
                    svg.polyline([at((-half, face)), at((half, face))], &ink);
                    svg.polyline(circle(true).map(at), ring);
                }
            }
            for path in paths {
                let (width, opacity) = if path.in_full { (1.8, 1.0) } else { (0.8, 0.45) };
                let style = format!(
                    "stroke=\"{}\" stroke-width=\"{width}\" stroke-opacity=\"{opacity}\" fill=\"none\"",
                    path.colour
                );
                let points = path.trace.samples.iter().map(|sample| at(view(sample.state.position_m)));
                svg.polyline(thinned(points), &style);
                if !path.in_full {
                    continue;
                }
                for event in &path.trace.events {
                    let here = at(view(event.state.position_m));
                    let ball = frame.length(radius / foot);
                    match event.kind {
                        EventKind::Release | EventKind::End => {
                            let style = format!("fill=\"none\" stroke=\"{FAINT}\" stroke-dasharray=\"3 3\"");
                            svg.circle(here, ball, &style);
                        }
                        EventKind::Touch(touched) => {
                            let colour = if touched == Touched::Board { "#009e73" } else { "#e69f00" };
                            svg.circle(here, ball, &format!("fill=\"none\" stroke=\"{colour}\" stroke-opacity=\"0.55\""));
                            svg.circle(here, 3.0, &format!("fill=\"{colour}\""));
                        }
                        EventKind::Part { .. } => {}
                    }
                }
            }
        });
        frame.axes(
            &mut svg,
            title,
            &format!("{x_name} ({long})"),
            &format!("{y_name} ({long})"),
        );
    }
    svg.text((20.0, height - 18.0), 11.0, Anchor::Start, note);
    Picture {
        name: name.to_owned(),
        caption: title.to_owned(),
        svg: svg.finish(title),
    }
}

/// A frame with the same scale on both axes that fits into a size.
fn within(corner: (f64, f64), size: (f64, f64), x: (f64, f64), y: (f64, f64)) -> Frame {
    let width = size.0.min(size.1 * (x.1 - x.0) / (y.1 - y.0));
    Frame::to_scale(corner, width, x, y)
}

/// Leaves out points within a third of a pixel of the last one kept.
fn thinned(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    let mut last = None;
    for point in points {
        let far = kept
            .last()
            .is_none_or(|last: &(f64, f64)| (last.0 - point.0).hypot(last.1 - point.1) > 0.33);
        if far {
            kept.push(point);
        }
        last = Some(point);
    }
    kept.extend(last);
    kept
}
