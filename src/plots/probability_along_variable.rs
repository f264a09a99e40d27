//! P along one variable of a nominal shot.

use super::axes::Axes;
use super::svg::{Anchor, INK, Plot, Svg, shortened};
use crate::present::probability_along_variable::ProbabilityAlong;

/// Left and upper edge of the panel, and its width and height, px.
const PANEL: ((f64, f64), (f64, f64)) = ((70.0, 84.0), (470.0, 260.0));

/// Letters in a line above the panel.
const PLACE_LETTERS: usize = 88;
/// Letters in a line below the panel.
const LINE_LETTERS: usize = 95;

/// Draws the curve; `None` with fewer than two values.
#[must_use]
pub fn draw(along: &ProbabilityAlong<'_>) -> Option<Plot> {
    let points = &along.points;
    let values: Vec<f64> = points
        .iter()
        .map(|point| along.value(&point.nominal))
        .collect();
    let [first, .., last] = values[..] else {
        return None;
    };
    // Points and bars do not lie on the frame.
    let x_margin = 0.03 * (last - first);
    let chances = points.iter().map(|point| point.estimate.probability);
    let over_draws = points.iter().filter_map(|point| point.over_draws);
    let ends = over_draws.flat_map(|over| [over.probability.low, over.probability.high]);
    let (lowest, highest) = chances
        .chain(ends)
        .fold((1.0_f64, 0.0_f64), |(low, high), p| {
            (low.min(p), high.max(p))
        });
    let y_margin = (0.08 * (highest - lowest)).max(0.005);
    let (corner, size) = PANEL;
    let axes = Axes {
        corner,
        size,
        x: (first - x_margin, last + x_margin),
        y: ((lowest - y_margin).max(0.0), (highest + y_margin).min(1.0)),
    };
    let mut svg = Svg::new(corner.0 + size.0 + 30.0, corner.1 + size.1 + 84.0);
    let name = along.name().replace('_', " ");
    let shooter = shortened(&along.profile.shooter().name, 40);
    let title = format!("{shooter}: one shot along its {name}");
    svg.heading((20.0, 26.0), 16.0, Anchor::Start, &title);
    let place = along.profile.location();
    let place = place.in_words(along.profile.output().units);
    let place = format!("{place}; {}", along.fixed_values());
    for (i, line) in textwrap::wrap(&place, PLACE_LETTERS).iter().enumerate() {
        svg.text((20.0, 44.0 + 15.0 * i as f64), 11.0, Anchor::Start, line);
    }
    axes.draw_grid(&mut svg);
    let at = |i: usize| axes.pixel((values[i], points[i].estimate.probability));
    let line = format!("stroke=\"{INK}\" stroke-width=\"2\" fill=\"none\"");
    svg.polyline((0..points.len()).map(at), &line);
    let bar = format!("stroke=\"{INK}\" stroke-width=\"1\" fill=\"none\"");
    for (i, point) in points.iter().enumerate() {
        svg.circle(at(i), 3.0, &format!("fill=\"{INK}\""));
        if let Some(over) = &point.over_draws {
            let end = |p: f64| axes.pixel((values[i], p));
            svg.polyline(
                [end(over.probability.low), end(over.probability.high)],
                &bar,
            );
        }
    }
    let own = along.own_value();
    let own = own.filter(|own| (axes.x.0..=axes.x.1).contains(own));
    if let Some(own) = own {
        let line = format!("stroke=\"{INK}\" stroke-dasharray=\"4 3\" fill=\"none\"");
        svg.polyline(
            [axes.pixel((own, axes.y.0)), axes.pixel((own, axes.y.1))],
            &line,
        );
    }
    let label = format!("{name} ({})", along.unit().name);
    axes.draw(&mut svg, "", &label, "probability");
    let of_line = own.map_or("", |_| "Dashed: the value in the profile. ");
    let of_bars = match along.draws_in_words() {
        "" => String::new(),
        words => words.replacen("95 %", "Bars, 95 %", 1),
    };
    let below = format!("{of_line}{of_bars}");
    for (i, line) in textwrap::wrap(&below, LINE_LETTERS).iter().enumerate() {
        let y = corner.1 + size.1 + 56.0 + 15.0 * i as f64;
        svg.text((20.0, y), 11.0, Anchor::Start, line);
    }
    let caption =
        format!("Probability that one shot goes in, with its {name} changed alone. {below}");
    Some(Plot {
        name: "probability_along_variable".to_owned(),
        svg: svg.finish(&caption),
        caption,
    })
}
