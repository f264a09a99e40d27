//! Colours on the court, seen from above: the hoop at the top, the shooter's right on the right.

use super::axes::Axes;
use super::colormaps::{NO_VALUE, Rgb, hex};
use super::colour_key::{ColourKey, draw_legend};
use super::court_lines::draw_court_lines;
use super::svg::{FAINT, INK, Svg};
use crate::model::Physics;
use crate::model::league_courts::Court;
use crate::units::UnitSystem;
use std::collections::BTreeSet;

/// What surrounds the court of a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapStyle {
    /// Axes with numbers, and a key.
    Plot,
    /// Nothing: the court fills the drawing.
    Poster,
}

impl MapStyle {
    /// Width of the court, px.
    fn court_width(self) -> f64 {
        match self {
            Self::Plot => 400.0,
            Self::Poster => 660.0,
        }
    }

    /// Space left and right of the court, px: for numbers and for the key.
    fn space_left_right(self) -> (f64, f64) {
        match self {
            Self::Plot => (70.0, 120.0),
            Self::Poster => (10.0, 10.0),
        }
    }

    /// Space above and below the court, px.
    fn space_above_below(self) -> (f64, f64) {
        match self {
            Self::Plot => (34.0, 52.0),
            Self::Poster => (4.0, 10.0),
        }
    }
}

/// A coloured place on the court.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColouredPlace {
    /// x, from the board towards midcourt, m.
    pub x_m: f64,
    /// y, across, m.
    pub y_m: f64,
    /// Its colour; `None` if it has no value.
    pub colour: Option<Rgb>,
}

/// What all maps of a plot share.
#[derive(Clone, Copy, Debug)]
pub struct CourtMap<'a> {
    /// The lines of the court.
    pub court: &'a Court,
    /// The board and the ring.
    pub physics: &'a Physics,
    /// Units of the axes.
    pub units: UnitSystem,
    /// Distance between neighbouring places, m; `None` if the places are not on a square grid.
    pub step_m: Option<f64>,
    /// Least distance between two places, m; 0 on a grid, and if there are very many.
    pub least_gap_m: f64,
    /// Greatest x of a place, m.
    pub far_x_m: f64,
    /// What surrounds the court.
    pub style: MapStyle,
}

impl CourtMap<'_> {
    /// The axes of a map, in its units, whose upper left corner is `corner`.
    fn axes(&self, corner: (f64, f64)) -> Axes {
        let (left, _) = self.style.space_left_right();
        let (above, _) = self.style.space_above_below();
        let corner = (corner.0 + left, corner.1 + above);
        let (_, unit_m) = self.units.length();
        let court = self.court;
        let far = (self.far_x_m + 1.0).min(court.half_line_x_m);
        let across = (-court.half_width_m / unit_m, court.half_width_m / unit_m);
        let along = (far / unit_m, court.baseline_x_m / unit_m);
        Axes::to_scale(corner, self.style.court_width(), across, along)
    }

    /// Size of a map with its axes and its key, px.
    #[must_use]
    pub fn size(&self) -> (f64, f64) {
        let (width, height) = self.axes((0.0, 0.0)).size;
        let (left, right) = self.style.space_left_right();
        let (above, below) = self.style.space_above_below();
        (left + width + right, above + height + below)
    }

    /// Draws a map whose upper left corner is `corner`. A poster has no title and no key.
    pub fn draw(
        &self,
        svg: &mut Svg,
        corner: (f64, f64),
        title: &str,
        places: &[ColouredPlace],
        key: &ColourKey<'_>,
    ) {
        let axes = self.axes(corner);
        let (long, unit_m) = self.units.length();
        svg.clipped(axes.corner, axes.size, |svg| {
            for place in places {
                self.draw_place(svg, &axes, place);
            }
            // Numbers stand on the lines of a poster.
            let ink = match self.style {
                MapStyle::Plot => INK,
                MapStyle::Poster => FAINT,
            };
            draw_court_lines(svg, (&axes, unit_m), ink, self.court, self.physics);
        });
        if self.style == MapStyle::Poster {
            return;
        }
        axes.draw(
            svg,
            title,
            &format!("across, right facing the board ({long})"),
            &format!("from the hoop's centre ({long})"),
        );
        let (right, _) = axes.lower_right();
        let beside = (right + 16.0, axes.corner.1 + 18.0);
        match key {
            ColourKey::Scale(scale) => {
                scale.draw(svg, beside, (axes.size.1 - 40.0).min(220.0));
            }
            ColourKey::Legend(names) => draw_legend(svg, beside, names),
        }
    }

    /// A square of the grid, or a circle if there is no grid.
    fn draw_place(&self, svg: &mut Svg, axes: &Axes, place: &ColouredPlace) {
        let (_, unit_m) = self.units.length();
        let colour = hex(place.colour.unwrap_or(NO_VALUE));
        let at = axes.pixel((place.y_m / unit_m, place.x_m / unit_m));
        if let Some(step_m) = self.step_m {
            let side = axes.pixels_of_length(step_m / unit_m);
            // Slightly larger than the cell, or thin gaps would show between neighbours.
            let corner = (at.0 - 0.5 * side - 0.1, at.1 - 0.5 * side - 0.1);
            let style = format!("fill=\"{colour}\" shape-rendering=\"crispEdges\"");
            svg.rect(corner, (side + 0.2, side + 0.2), &style);
        } else {
            let style = format!("fill=\"{colour}\" stroke=\"{INK}\" stroke-width=\"0.5\"");
            svg.circle(at, self.circle_radius(axes), &style);
        }
    }

    /// Radius of the circle of a place that is on no grid, px. On a poster a number is read in it,
    /// from afar, so there it is as large as its neighbours allow.
    fn circle_radius(&self, axes: &Axes) -> f64 {
        /// Radius on a plot.
        const SMALL: f64 = 6.0;
        /// Greatest radius on a poster.
        const LARGE: f64 = 17.0;
        let (_, unit_m) = self.units.length();
        match self.style {
            MapStyle::Plot => SMALL,
            MapStyle::Poster => {
                let gap = axes.pixels_of_length(self.least_gap_m / unit_m);
                (0.42 * gap).clamp(SMALL, LARGE)
            }
        }
    }

    /// Writes a short text on places (x, y), m, of a grid whose squares are wide enough; bold where
    /// asked.
    pub fn draw_numbers(
        &self,
        svg: &mut Svg,
        corner: (f64, f64),
        numbers: &[((f64, f64), String, bool)],
    ) {
        /// Narrowest square that two digits fit in, px.
        const NARROWEST: f64 = 12.0;
        let axes = self.axes(corner);
        let (_, unit_m) = self.units.length();
        let side = match self.step_m {
            Some(step_m) => axes.pixels_of_length(step_m / unit_m),
            None => (2.0 * self.circle_radius(&axes)).max(NARROWEST),
        };
        if side < NARROWEST {
            return;
        }
        for ((x_m, y_m), text, is_bold) in numbers {
            // Three digits must stay inside the square.
            let part = if text.len() > 2 { 0.46 } else { 0.62 };
            let size = (part * side).min(20.0);
            let (left, top) = axes.pixel((y_m / unit_m, x_m / unit_m));
            let at = (left, top + 0.36 * size);
            svg.number_over_lines(at, size, text, *is_bold);
        }
    }

    /// Outlines an area of grid places (x, y), m: draws the sides of its squares that have no
    /// neighbour in the area. Without a grid, draws a circle around each place.
    pub fn draw_outline(&self, svg: &mut Svg, corner: (f64, f64), area: &[(f64, f64)]) {
        let axes = self.axes(corner);
        let (_, unit_m) = self.units.length();
        let Some(step_m) = self.step_m else {
            let style = format!("fill=\"none\" stroke=\"{INK}\" stroke-width=\"2\"");
            for &(x_m, y_m) in area {
                let radius = self.circle_radius(&axes) + 3.0;
                svg.circle(axes.pixel((y_m / unit_m, x_m / unit_m)), radius, &style);
            }
            return;
        };
        let index = |v: f64| (v / step_m).round() as i64;
        let cells: BTreeSet<(i64, i64)> = area.iter().map(|&(x, y)| (index(x), index(y))).collect();
        let pixel = |i: f64, j: f64| axes.pixel((j * step_m / unit_m, i * step_m / unit_m));
        let style =
            format!("stroke=\"{INK}\" stroke-width=\"2\" fill=\"none\" stroke-linecap=\"square\"");
        svg.clipped(axes.corner, axes.size, |svg| {
            for &(i, j) in &cells {
                let (x, y) = (i as f64, j as f64);
                for (neighbour, from, to) in [
                    ((i - 1, j), (x - 0.5, y - 0.5), (x - 0.5, y + 0.5)),
                    ((i + 1, j), (x + 0.5, y - 0.5), (x + 0.5, y + 0.5)),
                    ((i, j - 1), (x - 0.5, y - 0.5), (x + 0.5, y - 0.5)),
                    ((i, j + 1), (x - 0.5, y + 0.5), (x + 0.5, y + 0.5)),
                ] {
                    if !cells.contains(&neighbour) {
                        svg.polyline([pixel(from.0, from.1), pixel(to.0, to.1)], &style);
                    }
                }
            }
        });
    }
}
