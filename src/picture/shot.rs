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

/// How far a drawn path may run beside the points that it leaves out, pixels.
const TOLERANCE: f64 = 0.2;

/// Leaves out points that change a path by less than [`TOLERANCE`] (Ramer 1972, Douglas and Peucker 1973).
fn thinned(points: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let points: Vec<(f64, f64)> = points.collect();
    let mut keep = vec![false; points.len()];
    let mut spans = vec![(0, points.len().saturating_sub(1))];
    while let Some((first, last)) = spans.pop() {
        for end in [first, last] {
            if let Some(keep) = keep.get_mut(end) {
                *keep = true;
            }
        }
        let farthest = (first + 1..last)
            .map(|i| (beside(points[i], points[first], points[last]), i))
            .fold((TOLERANCE, None), |(most, at), (distance, i)| {
                if distance > most {
                    (distance, Some(i))
                } else {
                    (most, at)
                }
            });
        if let (_, Some(i)) = farthest {
            spans.extend([(first, i), (i, last)]);
        }
    }
    let kept = points.iter().zip(keep);
    kept.filter_map(|(point, keep)| keep.then_some(*point))
        .collect()
}

/// Distance of a point from the line between two others.
fn beside(p: (f64, f64), a: (f64, f64), b: (f64, f64)) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let square = dx * dx + dy * dy;
    let part = if square > 0.0 {
        (((p.0 - a.0) * dx + (p.1 - a.1) * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let (x, y) = (p.0 - a.0 - part * dx, p.1 - a.1 - part * dy);
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prop_a_thinned_path_stays_beside_its_points() {
        let points: Vec<(f64, f64)> = (0..500)
            .map(|i| {
                let t = f64::from(i);
                (
                    t,
                    0.01 * (t - 250.0) * (t - 250.0) * if i > 400 { -1.0 } else { 1.0 },
                )
            })
            .collect();
        let kept = thinned(points.iter().copied());
        assert!(kept.len() > 10 && kept.len() < 200, "{}", kept.len());
        assert_eq!((kept[0], kept[kept.len() - 1]), (points[0], points[499]));
        for point in points {
            let near = kept
                .windows(2)
                .map(|pair| beside(point, pair[0], pair[1]))
                .fold(f64::INFINITY, f64::min);
            assert!(near <= TOLERANCE + 1e-12, "{point:?} {near}");
        }
        assert_eq!(thinned(std::iter::empty()), []);
        assert_eq!(thinned([(1.0, 2.0)].into_iter()), [(1.0, 2.0)]);
    }
}
