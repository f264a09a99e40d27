//! One shot or many, from the side, from above and facing the board.

use super::axes::Axes;
use super::polyline_thinning::thinned;
use super::svg::Plot;
use super::svg::{Anchor, FAINT, INK, Svg, shortened};
use crate::dynamics::{Event, EventKind, Trace};
use crate::math::vector::Vec3;
use crate::model::{Physics, SolidId};
use crate::units::{INCH_M, UnitSystem};
use std::f64::consts::TAU;

/// Colour of made shots.
pub const MADE_COLOUR: &str = "#0072b2";
/// Colour of missed shots.
pub const MISSED_COLOUR: &str = "#d55e00";

/// Colours of the ring's line and of the bracket's surface.
const RING_COLOUR: &str = "#cc3311";
const BRACKET_FILL: &str = "#f3c9bf";
/// Width of the drawing, px.
const WIDTH: f64 = 1060.0;
/// Segments of the ring.
const RING_SEGMENTS: i32 = 60;

/// The path of one shot.
#[derive(Clone, Copy, Debug)]
pub struct ShotPath<'a> {
    /// The shot.
    pub trace: &'a Trace,
    /// Colour of its path.
    pub colour: &'static str,
    /// Whether its events are marked. Such a path is thicker.
    pub is_detailed: bool,
}

/// Draws paths in four views. `name` is the plot's file name.
#[must_use]
pub fn draw(
    name: &str,
    title: &str,
    note: &str,
    physics: &Physics,
    units: UnitSystem,
    paths: &[ShotPath<'_>],
) -> Plot {
    let scene = Scene {
        physics,
        units,
        paths,
    };
    let panels = scene.panels();
    let bottom = |view: View| panels[view as usize].lower_right().1;
    let height = bottom(View::Above).max(bottom(View::RingFromAbove)) + 75.0;
    let mut svg = Svg::new(WIDTH, height);
    svg.heading((20.0, 26.0), 16.0, Anchor::Start, &shortened(title, 100));
    for (view, axes) in View::ALL.into_iter().zip(panels) {
        scene.draw_panel(&mut svg, &Panel { view, axes, units });
    }
    svg.footnote((20.0, height - 18.0), note);
    Plot {
        name: name.to_owned(),
        caption: title.to_owned(),
        svg: svg.finish(title),
    }
}

/// A direction of view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum View {
    Side,
    Above,
    FacingBoard,
    RingFromAbove,
}

impl View {
    const ALL: [Self; 4] = [
        Self::Side,
        Self::Above,
        Self::FacingBoard,
        Self::RingFromAbove,
    ];

    /// The title, and the labels of the horizontal and vertical axes without their unit.
    fn texts(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Side => ("from the side", "from the hoop", "above the ring"),
            Self::Above => ("from above", "from the hoop", "across"),
            Self::FacingBoard => ("facing the board", "across", "above the ring"),
            Self::RingFromAbove => ("the ring from above", "across", "from the hoop"),
        }
    }

    /// The horizontal and vertical coordinates of a point.
    fn project(self, point: Vec3<f64>) -> (f64, f64) {
        match self {
            Self::Side => (point.x, point.z),
            Self::Above => (point.x, point.y),
            Self::FacingBoard => (point.y, point.z),
            Self::RingFromAbove => (point.y, point.x),
        }
    }
}

/// The axes of one view.
struct Panel {
    view: View,
    axes: Axes,
    units: UnitSystem,
}

impl Panel {
    /// The pixel of a point of the view, m.
    fn pixel(&self, (x, y): (f64, f64)) -> (f64, f64) {
        let (_, unit_m) = self.units.length();
        self.axes.pixel((x / unit_m, y / unit_m))
    }

    /// The pixel of a point in space, m.
    fn pixel_in_space(&self, point: Vec3<f64>) -> (f64, f64) {
        self.pixel(self.view.project(point))
    }

    fn draw_board_and_ring(&self, svg: &mut Svg, physics: &Physics) {
        self.draw_bracket_and_padding(svg, physics);
        let (_, unit_m) = self.units.length();
        let rod = self
            .axes
            .pixels_of_length(physics.ring_tube_diameter_m / unit_m);
        let board = format!("stroke=\"{INK}\" stroke-width=\"2.5\" fill=\"none\"");
        let ring = format!(
            "stroke=\"{RING_COLOUR}\" stroke-width=\"{:.1}\" fill=\"none\"",
            rod.max(2.5)
        );
        let (low, high) = board_edges(physics);
        let half_width = 0.5 * physics.board_width_m;
        let face = -physics.board_distance_m;
        let radius = physics.ring_radius_m;
        let ring_edge = vec![(-radius, 0.0), (radius, 0.0)];
        let ring_circle = (0..=RING_SEGMENTS).map(|i| {
            let (sin, cos) = libm::sincos(f64::from(i) * TAU / f64::from(RING_SEGMENTS));
            (radius * cos, radius * sin)
        });
        let (board_line, ring_line): (Vec<_>, Vec<_>) = match self.view {
            View::Side => (vec![(face, low), (face, high)], ring_edge),
            View::Above => (
                vec![(face, -half_width), (face, half_width)],
                ring_circle.collect(),
            ),
            View::FacingBoard => (
                vec![
                    (-half_width, low),
                    (half_width, low),
                    (half_width, high),
                    (-half_width, high),
                    (-half_width, low),
                ],
                ring_edge,
            ),
            View::RingFromAbove => (
                vec![(-half_width, face), (half_width, face)],
                ring_circle.map(|(x, y)| (y, x)).collect(),
            ),
        };
        for (line, style) in [(board_line, board.as_str()), (ring_line, ring.as_str())] {
            svg.polyline(line.into_iter().map(|point| self.pixel(point)), style);
        }
    }

    /// The flat bracket between ring and board, and the board's edges of glass and padding.
    fn draw_bracket_and_padding(&self, svg: &mut Svg, physics: &Physics) {
        let (low, high) = board_edges(physics);
        let half_width = 0.5 * physics.board_width_m;
        let (face, ring) = (-physics.board_distance_m, -physics.ring_radius_m);
        let half_bracket = 0.5 * physics.bracket_width_m;
        let half_rod = 0.5 * physics.ring_tube_diameter_m;
        let edge = physics.board_edge.radius_m();
        let back = face - 2.0 * edge;
        let rectangle = |(x0, x1): (f64, f64), (y0, y1): (f64, f64)| {
            [(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)].map(|point| self.pixel(point))
        };
        let (bracket, board) = match self.view {
            View::Side => (
                rectangle((face, ring), (-half_rod, half_rod)),
                rectangle((back, face), (low, high)),
            ),
            View::Above => (
                rectangle((face, ring), (-half_bracket, half_bracket)),
                rectangle((back, face), (-half_width, half_width)),
            ),
            View::FacingBoard => (
                rectangle((-half_bracket, half_bracket), (-half_rod, half_rod)),
                rectangle(
                    (edge - half_width, half_width - edge),
                    (low + edge, high - edge),
                ),
            ),
            View::RingFromAbove => (
                rectangle((-half_bracket, half_bracket), (face, ring)),
                rectangle((-half_width, half_width), (back, face)),
            ),
        };
        if edge > 0.0 {
            let style = format!("stroke=\"{FAINT}\" stroke-width=\"1\" fill=\"none\"");
            svg.polyline(board, &style);
        }
        if self.view == View::FacingBoard {
            let [half_width, below, above] = BOARD_SQUARE_M;
            let square = rectangle((-half_width, half_width), (-below, above));
            let style = format!("stroke=\"{FAINT}\" stroke-width=\"1\" fill=\"none\"");
            svg.polyline(square, &style);
        }
        if physics.bracket_width_m > 0.0 {
            let style =
                format!("stroke=\"{RING_COLOUR}\" stroke-width=\"0.5\" fill=\"{BRACKET_FILL}\"");
            svg.polyline(bracket, &style);
        }
    }

    fn draw_path(&self, svg: &mut Svg, path: &ShotPath<'_>) {
        let (width, opacity) = if path.is_detailed {
            (1.8, 1.0)
        } else {
            (0.8, 0.45)
        };
        let style = format!(
            "stroke=\"{}\" stroke-width=\"{width}\" stroke-opacity=\"{opacity}\" fill=\"none\"",
            path.colour
        );
        let samples = path.trace.samples.iter();
        let points = samples.map(|sample| self.pixel_in_space(sample.state.position_m));
        svg.polyline(thinned(points), &style);
    }

    /// The outline of the ball at the release, at each touch and at the end.
    fn mark_event(&self, svg: &mut Svg, event: &Event, physics: &Physics) {
        let (_, unit_m) = self.units.length();
        let at = self.pixel_in_space(event.state.position_m);
        let radius = self.axes.pixels_of_length(physics.ball_radius_m / unit_m);
        match event.kind {
            EventKind::Release | EventKind::End => {
                let style = format!("fill=\"none\" stroke=\"{FAINT}\" stroke-dasharray=\"3 3\"");
                svg.circle(at, radius, &style);
            }
            EventKind::Touch(solid) => {
                let colour = match solid {
                    SolidId::Board => "#009e73",
                    SolidId::Ring => "#e69f00",
                };
                let outline = format!("fill=\"none\" stroke=\"{colour}\" stroke-opacity=\"0.55\"");
                svg.circle(at, radius, &outline);
                svg.circle(at, 3.0, &format!("fill=\"{colour}\""));
            }
            EventKind::Part { .. } => {}
        }
    }
}

/// The rectangle on the board: half of its width, and how far it reaches below and above the ring,
/// m. Rule books give 24 by 18 in outside, and the upper edge of its base line, 2 in wide, level
/// with the ring.
const BOARD_SQUARE_M: [f64; 3] = [12.0 * INCH_M, 2.0 * INCH_M, 16.0 * INCH_M];

/// Lowest and highest edge of the board above the ring, m.
fn board_edges(physics: &Physics) -> (f64, f64) {
    let half_height = 0.5 * physics.board_height_m;
    (
        physics.board_centre_z_m() - half_height,
        physics.board_centre_z_m() + half_height,
    )
}

/// What all views show.
struct Scene<'a> {
    physics: &'a Physics,
    units: UnitSystem,
    paths: &'a [ShotPath<'a>],
}

impl Scene<'_> {
    /// Range of x, y and z that shows all paths, the board and the ring, m.
    fn extent(&self) -> [(f64, f64); 3] {
        let physics = self.physics;
        let radius = physics.ball_radius_m;
        let mut reach = [(f64::INFINITY, f64::NEG_INFINITY); 3];
        for sample in self.paths.iter().flat_map(|path| &path.trace.samples) {
            for (range, v) in reach.iter_mut().zip(sample.state.position_m.iter()) {
                *range = (range.0.min(v - radius), range.1.max(v + radius));
            }
        }
        let (_, top) = board_edges(physics);
        let half_width = 0.5 * physics.board_width_m;
        let face = -physics.board_distance_m;
        let widened =
            |range: (f64, f64), low: f64, high: f64| (range.0.min(low), range.1.max(high));
        [
            widened(reach[0], face - 0.3, 2.0 * physics.ring_radius_m),
            widened(reach[1], -half_width - 0.2, half_width + 0.2),
            widened(reach[2], -0.8, top + 0.2),
        ]
    }

    /// The axes of each view: on the left the whole path, on the right the board and the ring.
    fn panels(&self) -> [Axes; 4] {
        let (_, unit_m) = self.units.length();
        let in_units = |range: (f64, f64)| (range.0 / unit_m, range.1 / unit_m);
        let [x, y, z] = self.extent().map(in_units);
        let physics = self.physics;
        let (_, top) = board_edges(physics);
        let half_width = 0.5 * physics.board_width_m;
        let near_x = in_units((-physics.board_distance_m - 0.15, 0.9));
        let near_y = in_units((-half_width - 0.2, half_width + 0.2));
        let near_z = in_units((-0.8, top + 0.6));
        let below = |axes: &Axes| axes.lower_right().1 + 90.0;
        let side = axes_within((75.0, 70.0), (520.0, 380.0), x, z);
        let above = axes_within((75.0, below(&side)), (520.0, 400.0), x, y);
        let facing = Axes::to_scale((690.0, 70.0), 330.0, near_y, near_z);
        let ring = Axes::to_scale((690.0, below(&facing)), 330.0, near_y, near_x);
        [side, above, facing, ring]
    }

    fn draw_panel(&self, svg: &mut Svg, panel: &Panel) {
        let axes = &panel.axes;
        axes.draw_grid(svg);
        svg.clipped(axes.corner, axes.size, |svg| {
            panel.draw_board_and_ring(svg, self.physics);
            for path in self.paths {
                panel.draw_path(svg, path);
                let events = path.trace.events.iter();
                for event in events.filter(|_| path.is_detailed) {
                    panel.mark_event(svg, event, self.physics);
                }
            }
        });
        let (long, _) = self.units.length();
        let (title, x_label, y_label) = panel.view.texts();
        axes.draw(
            svg,
            title,
            &format!("{x_label} ({long})"),
            &format!("{y_label} ({long})"),
        );
    }
}

/// Axes with the same scale along x and y that fit into a size.
fn axes_within(corner: (f64, f64), size: (f64, f64), x: (f64, f64), y: (f64, f64)) -> Axes {
    let width = size.0.min(size.1 * (x.1 - x.0) / (y.1 - y.0));
    Axes::to_scale(corner, width, x, y)
}
