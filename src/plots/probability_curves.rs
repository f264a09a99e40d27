//! P along each variable of the best shots.

use super::axes::Axes;
use super::colormaps::{Rgb, hex};
use super::colour_key::draw_legend;
use super::svg::Plot;
use super::svg::{Anchor, Svg, shortened};
use crate::shooter::Profile;

/// Colours of direct and bank shots.
const KIND_COLOURS: [(&str, Rgb); 2] = [("direct", [0, 114, 178]), ("bank", [184, 92, 0])];
/// Width and height of a panel with its labels, px.
const PANEL: (f64, f64) = (300.0, 240.0);

/// A point of a curve, as a row of `curves.csv`.
struct CurvePoint<'a> {
    kind: &'a str,
    variable: &'a str,
    value: f64,
    probability: f64,
}

/// The curves of `curves.csv`.
#[derive(Default)]
struct Curves<'a> {
    points: Vec<CurvePoint<'a>>,
    /// The variables with their units, in order.
    variables: Vec<(&'a str, &'a str)>,
}

impl<'a> Curves<'a> {
    /// From the rows of the file, without the header; skips rows that are not valid.
    fn new(rows: &'a [Vec<String>]) -> Self {
        let mut curves = Self::default();
        for row in rows {
            let [kind, variable, unit, value, probability, ..] = &row[..] else {
                continue;
            };
            let variable_with_unit = (variable.as_str(), unit.as_str());
            if !curves.variables.contains(&variable_with_unit) {
                curves.variables.push(variable_with_unit);
            }
            let (Ok(value), Ok(probability)) = (value.parse(), probability.parse()) else {
                continue;
            };
            curves.points.push(CurvePoint {
                kind,
                variable,
                value,
                probability,
            });
        }
        curves
    }

    fn largest_probability(&self) -> f64 {
        let largest = |most: f64, point: &CurvePoint<'_>| most.max(point.probability);
        self.points.iter().fold(0.05, largest)
    }

    fn range_of(&self, variable: &str) -> (f64, f64) {
        let values = self
            .points
            .iter()
            .filter(|point| point.variable == variable)
            .map(|point| point.value);
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    }

    fn draw_panel(&self, svg: &mut Svg, axes: &Axes, (variable, unit): (&str, &str)) {
        axes.draw_grid(svg);
        svg.clipped(axes.corner, axes.size, |svg| {
            for (kind, colour) in KIND_COLOURS {
                let style = format!(
                    "stroke=\"{}\" stroke-width=\"2\" fill=\"none\"",
                    hex(colour)
                );
                let curve = self
                    .points
                    .iter()
                    .filter(|point| point.kind == kind && point.variable == variable)
                    .map(|point| axes.pixel((point.value, point.probability)));
                svg.polyline(curve, &style);
            }
        });
        axes.draw(svg, variable, &format!("{variable} ({unit})"), "P");
    }
}

/// Draws the rows of `curves.csv` (kind, variable, unit, value, probability and more; the header
/// first); `None` if there are no curves.
#[must_use]
pub fn draw(profile: &Profile, rows: &[Vec<String>]) -> Option<Plot> {
    let curves = Curves::new(rows.get(1..)?);
    if curves.points.is_empty() {
        return None;
    }
    let (width, height) = PANEL;
    let total_width = curves.variables.len() as f64 * width;
    let mut svg = Svg::new(total_width + 110.0, height + 60.0);
    let name = shortened(&profile.shooter().name, 60);
    let title = format!("P along each variable of the best shots: {name}");
    svg.heading((20.0, 24.0), 15.0, Anchor::Start, &title);
    let top = (1.08 * curves.largest_probability()).min(1.0);
    for (i, variable) in curves.variables.iter().enumerate() {
        let axes = Axes {
            corner: (70.0 + i as f64 * width, 70.0),
            size: (width - 85.0, height - 90.0),
            x: curves.range_of(variable.0),
            y: (0.0, top),
        };
        curves.draw_panel(&mut svg, &axes, *variable);
    }
    let names: Vec<(String, Rgb)> = KIND_COLOURS
        .iter()
        .filter(|(kind, _)| curves.points.iter().any(|point| point.kind == *kind))
        .map(|(kind, colour)| ((*kind).to_owned(), *colour))
        .collect();
    draw_legend(&mut svg, (total_width + 12.0, 74.0), &names);
    let caption = "P along each variable of the best shots, the others fixed.";
    Some(Plot {
        name: "curves".to_owned(),
        caption: caption.to_owned(),
        svg: svg.finish(caption),
    })
}
