//! One map over speed and pitch angle: outcomes, P, or a difference of P.

use super::axes::Axes;
use super::colormaps::{MADE_KINDS, NO_VALUE, Rgb, of_outcome, sequential};
use super::colour_key::{ColourScale, draw_legend};
use super::svg::Svg;
use crate::analysis::release_map::ReleaseCells;
use crate::dynamics::OutcomeKind;
use crate::shooter::Nominal;
use crate::units::{DEGREE_RAD, UnitSystem};

/// Size of the axes, px.
const AXES_SIZE: (f64, f64) = (400.0, 300.0);
/// Size of a map with its axes and its key, px.
pub const MAP_SIZE: (f64, f64) = (70.0 + AXES_SIZE.0 + 150.0, 34.0 + AXES_SIZE.1 + 52.0);
/// Height of the colour bar, px.
const BAR_HEIGHT: f64 = 220.0;

/// A map over speed and pitch angle.
#[derive(Clone, Copy, Debug)]
pub struct ReleaseMap<'a> {
    /// Upper left corner, px.
    pub corner: (f64, f64),
    /// Speeds and pitch angles.
    pub cells: &'a ReleaseCells,
    /// Units of the axes.
    pub units: UnitSystem,
}

impl ReleaseMap<'_> {
    fn axes(&self) -> Axes {
        let (_, unit_m) = self.units.length();
        let (speed, pitch) = (self.cells.speed_m_s, self.cells.pitch_rad);
        Axes {
            corner: (self.corner.0 + 70.0, self.corner.1 + 34.0),
            size: AXES_SIZE,
            x: (speed.0 / unit_m, speed.1 / unit_m),
            y: (pitch.0 / DEGREE_RAD, pitch.1 / DEGREE_RAD),
        }
    }

    fn draw_cells(&self, svg: &mut Svg, title: &str, colours: &[Rgb]) {
        let (axes, cells) = (self.axes(), self.cells);
        // Images start at the top, cells at the lowest pitch angle.
        let pixels: Vec<[u8; 4]> = colours
            .chunks(cells.columns)
            .rev()
            .flatten()
            .map(|[r, g, b]| [*r, *g, *b, 255])
            .collect();
        let count = (cells.columns, cells.rows);
        svg.pixels(axes.corner, axes.size, count, &pixels);
        let (long, _) = self.units.length();
        axes.draw(
            svg,
            title,
            &format!("speed ({long}/s)"),
            "pitch angle (deg)",
        );
    }

    /// Draws the outcome of each cell, as in the paper's Figs. 12 to 15.
    pub fn draw_outcomes(&self, svg: &mut Svg, title: &str, outcomes: &[OutcomeKind]) {
        let colours: Vec<Rgb> = outcomes.iter().map(|&kind| of_outcome(kind)).collect();
        self.draw_cells(svg, title, &colours);
        let mut names: Vec<(String, Rgb)> = MADE_KINDS
            .iter()
            .filter(|(kind, _, _)| outcomes.contains(kind))
            .map(|(_, name, colour)| ((*name).to_owned(), *colour))
            .collect();
        names.push(("missed".to_owned(), NO_VALUE));
        let axes = self.axes();
        let beside = (axes.lower_right().0 + 14.0, axes.corner.1 + 10.0);
        draw_legend(svg, beside, &names);
    }

    /// Draws P of each cell.
    pub fn draw_probabilities(&self, svg: &mut Svg, title: &str, probabilities: &[f64]) {
        let colours: Vec<Rgb> = probabilities.iter().map(|&p| sequential(p)).collect();
        self.draw_colours(svg, title, &colours, &ColourScale::PROBABILITY);
    }

    /// Draws the colour of each cell, and a colour bar.
    pub fn draw_colours(
        &self,
        svg: &mut Svg,
        title: &str,
        colours: &[Rgb],
        scale: &ColourScale<'_>,
    ) {
        self.draw_cells(svg, title, colours);
        let axes = self.axes();
        let beside = (axes.lower_right().0 + 16.0, axes.corner.1 + 18.0);
        scale.draw(svg, beside, BAR_HEIGHT);
    }

    /// Draws a circle at the speed and the pitch angle of a shot, black on white.
    pub fn mark_shot(&self, svg: &mut Svg, shot: &Nominal) {
        let (_, unit_m) = self.units.length();
        let point = (shot.speed_m_s / unit_m, shot.pitch_rad / DEGREE_RAD);
        let at = self.axes().pixel(point);
        for (colour, width) in [("#ffffff", "3"), ("#000000", "1.5")] {
            let style = format!("fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\"");
            svg.circle(at, 5.0, &style);
        }
    }
}
