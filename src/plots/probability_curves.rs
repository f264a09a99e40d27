//! P along each variable of the best shots.

use super::axes::Axes;
use super::colormaps::{Rgb, hex};
use super::colour_key::draw_legend;
use super::svg::Plot;
use super::svg::{Anchor, Svg, shortened};
use crate::analysis::probability_curves::ProbabilityCurve;
use crate::shooter::{NominalVariable, Profile, ShotKind};
use crate::units::Unit;

/// The curves of the best shot of a kind.
type Curves<'a> = (ShotKind, &'a [ProbabilityCurve]);

/// Colours of direct and bank shots.
const KIND_COLOURS: [(ShotKind, Rgb); 2] = [
    (ShotKind::Direct, [0, 114, 178]),
    (ShotKind::Bank, [184, 92, 0]),
];
/// Width and height of a panel with its labels, px.
const PANEL: (f64, f64) = (300.0, 240.0);

/// The curve of a kind along a variable: value in the unit of results and P.
fn curve_of(
    curves: &[Curves<'_>],
    kind: ShotKind,
    variable: NominalVariable,
    size: f64,
) -> Vec<(f64, f64)> {
    let of_kind = curves.iter().filter(|(other, _)| *other == kind);
    let of_variable = of_kind
        .flat_map(|(_, curves)| curves.iter())
        .filter(|curve| curve.variable == variable);
    let points = of_variable.flat_map(|curve| &curve.points);
    points
        .map(|point| (point.value / size, point.probability))
        .collect()
}

fn draw_panel(
    svg: &mut Svg,
    (corner, top): ((f64, f64), f64),
    curves: &[Curves<'_>],
    variable: NominalVariable,
    unit: Unit,
) {
    let of_kinds = KIND_COLOURS.map(|(kind, colour)| {
        let curve = curve_of(curves, kind, variable, unit.size);
        (curve, colour)
    });
    let values = of_kinds.iter().flat_map(|(curve, _)| curve);
    let ends = values.fold(
        (f64::INFINITY, f64::NEG_INFINITY),
        |(low, high), (value, _)| (low.min(*value), high.max(*value)),
    );
    let axes = Axes {
        corner,
        size: (PANEL.0 - 85.0, PANEL.1 - 90.0),
        x: ends,
        y: (0.0, top),
    };
    axes.draw_grid(svg);
    svg.clipped(axes.corner, axes.size, |svg| {
        for (curve, colour) in of_kinds {
            let style = format!(
                "stroke=\"{}\" stroke-width=\"2\" fill=\"none\"",
                hex(colour)
            );
            svg.polyline(curve.iter().map(|point| axes.pixel(*point)), &style);
        }
    });
    let name = variable.name();
    axes.draw(svg, name, &format!("{name} ({})", unit.name), "probability");
}

/// Draws the curves of the best shots; `None` if there are none.
#[must_use]
pub fn draw(profile: &Profile, curves: &[Curves<'_>]) -> Option<Plot> {
    let all = curves.iter().flat_map(|(_, curves)| curves.iter());
    let mut variables: Vec<NominalVariable> = Vec::new();
    let mut largest: f64 = 0.05;
    for curve in all {
        if !variables.contains(&curve.variable) {
            variables.push(curve.variable);
        }
        let probabilities = curve.points.iter().map(|point| point.probability);
        largest = probabilities.fold(largest, f64::max);
    }
    if variables.is_empty() {
        return None;
    }
    let (width, height) = PANEL;
    let total_width = variables.len() as f64 * width;
    let mut svg = Svg::new(total_width + 110.0, height + 60.0);
    let name = shortened(&profile.shooter().name, 60);
    let title = format!("The best shots, one value changed at a time: {name}");
    svg.heading((20.0, 24.0), 15.0, Anchor::Start, &title);
    let top = (1.08 * largest).min(1.0);
    for (i, variable) in variables.iter().enumerate() {
        let unit = profile.output().units.unit(variable.dimension());
        let corner = (70.0 + i as f64 * width, 70.0);
        draw_panel(&mut svg, (corner, top), curves, *variable, unit);
    }
    let names: Vec<(String, Rgb)> = KIND_COLOURS
        .iter()
        .filter(|(kind, _)| curves.iter().any(|(other, _)| other == kind))
        .map(|(kind, colour)| (kind.name().to_owned(), *colour))
        .collect();
    draw_legend(&mut svg, (total_width + 12.0, 74.0), &names);
    let caption = "Probability that the best shots go in, with one value changed at a time.";
    Some(Plot {
        name: "curves".to_owned(),
        caption: caption.to_owned(),
        svg: svg.finish(caption),
    })
}
